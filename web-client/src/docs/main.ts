// Shows the contract of the API with the components of Redoc. Redoc's own page loads an image from
// another site and starts a search worker from a string. The server's content security policy
// forbids both, so this page omits them. It has its own menu, because Redoc's menu items are not
// inside a menu element.
import { autorun } from "mobx";
import { type ComponentProps, createElement, useEffect, useState } from "react";
import { createRoot } from "react-dom/client";
import {
  ApiContentWrap,
  ApiInfo,
  AppStore,
  BackgroundStub,
  ContentItems,
  OptionsProvider,
  type OperationModel,
  RedocWrap,
  StickyResponsiveSidebar,
  StoreProvider,
  ThemeProvider,
} from "redoc";
import "./docs.css";
import { kTheme } from "./theme";

const kContract = "/api/v1/openapi.json";

type Menu = AppStore["menu"];
type Item = Menu["items"][number];
type Contents = ComponentProps<typeof ContentItems>["items"]; // also the type of the menu items

const isOperation = (item: Item): item is OperationModel => item.type === "operation";

function MenuLink({ item, active, menu }: { item: Item; active: boolean; menu: Menu }) {
  const method = isOperation(item)
    ? createElement("span", { className: `method ${item.httpVerb}` }, item.httpVerb)
    : null;
  return createElement(
    "a",
    {
      href: `#${item.id}`,
      "aria-current": active ? "location" : undefined,
      onClick: () => menu.closeSidebar(), // in a small window, the menu covers the content
    },
    method,
    " ",
    item.sidebarLabel,
  );
}

function MenuOfContents({ menu }: { menu: Menu }) {
  const [active, setActive] = useState("");
  useEffect(() => autorun(() => setActive(menu.activeItem?.id ?? "")), [menu]);
  const entry = (item: Item) =>
    createElement(
      "li",
      { key: item.id },
      createElement(MenuLink, { item, active: item.id === active, menu }),
    );
  const groups = menu.items.map((group) =>
    createElement(
      "details",
      { key: group.id, open: [group, ...group.items].some(({ id }) => id === active) },
      createElement("summary", null, group.sidebarLabel),
      createElement("ul", null, group.items.map(entry)),
    ),
  );
  return createElement("nav", { "aria-label": "Operations" }, groups);
}

function Contract({ store }: { store: AppStore }) {
  useEffect(() => {
    store.onDidMount();
    return () => store.dispose();
  }, [store]);
  const { menu, options } = store;
  const page = createElement(
    RedocWrap,
    { className: "redoc-wrap" },
    createElement(
      StickyResponsiveSidebar,
      { menu, className: "menu-content" },
      createElement(MenuOfContents, { menu }),
    ),
    createElement(
      ApiContentWrap,
      { className: "api-content", as: "main" },
      createElement(ApiInfo, { store }),
      createElement(ContentItems, { items: menu.items as Contents }),
    ),
    createElement(BackgroundStub),
  );
  return createElement(
    ThemeProvider,
    { theme: options.theme },
    createElement(
      StoreProvider,
      { value: store },
      createElement(OptionsProvider, { value: options }, page),
    ),
  );
}

/** Adds accessible names to Redoc's select boxes for media types and examples. */
function nameChoices(place: Element): void {
  for (const choice of place.querySelectorAll("select:not([aria-label])"))
    choice.setAttribute(
      "aria-label",
      choice.textContent?.includes("/") ? "Content type" : "Example",
    );
}

const place = document.querySelector("#contract")!;
const response = await fetch(kContract);
if (response.ok) {
  const options = {
    theme: kTheme,
    disableSearch: true,
    nativeScrollbars: true,
  };
  const store = new AppStore(
    (await response.json()) as ConstructorParameters<typeof AppStore>[0],
    kContract,
    options,
    false,
  );
  new MutationObserver(() => nameChoices(place)).observe(place, { childList: true, subtree: true });
  createRoot(place).render(createElement(Contract, { store }));
} else {
  place.textContent = `The contract cannot be read (${response.status}). Reload the page to try again.`;
}
