// The page at /kiosk/{secret}. The main.ts of the site starts this page and loads no other code.

import { Api } from "../net/api";
import { sayOwnProblemsIn } from "../core/problems";
import { kioskFetch } from "./as-kiosk";
import { keepOnPage, stayAwake } from "./guard";
import "./kiosk-page";
import { KioskSession } from "./kiosk-session";
import { phonePlaceOf } from "./phone";
import { KioskStore, openBrowserCache, startWorker } from "./store";

/** Returns the part of the path after /kiosk/, or null. */
export const secretOf = (path: string): string | null =>
  /^\/kiosk\/([^/]{1,200})\/?$/.exec(path)?.[1] ?? null;

export function startKiosk(): void {
  // Visitors see no messages about failed calls.
  sayOwnProblemsIn({
    unreachable: ["The server is away", ""],
    statuses: {},
    other_status: (status) => `Status ${status}`,
    other_status_detail: "",
    unreadable: "Not readable",
    unreadable_detail: (what) => what,
  });
  const secret = secretOf(location.pathname) ?? "";
  const phone = phonePlaceOf(location.hash);
  const session = new KioskSession({
    phone,
    api: new Api(kioskFetch),
    secret,
    store: new KioskStore({ openCache: openBrowserCache, secret }),
    reload: () => location.reload(),
  });
  const page = document.createElement("strata-kiosk");
  page.session = session;
  document.querySelector("strata-app")?.replaceWith(page);
  if (!phone) keepOnPage(); // visitors may leave the page on their own phones
  void stayAwake();
  void startWorker();
  document.addEventListener("visibilitychange", () => {
    void stayAwake();
    if (document.visibilityState === "visible") session.lookAgain();
  });
  addEventListener("online", () => session.lookAgain());
  session.open();
}
