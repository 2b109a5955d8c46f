// Checks of a page for users with a keyboard, a screen reader, strong light or a small window.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { kRoot, load_module } from "./modules.mjs";

const kAxe = readFileSync(
  join(kRoot, "web-client", "node_modules", "axe-core", "axe.min.js"),
  "utf8",
);
load_module("axe-core");

/**
 * Returns the serious and critical findings of axe-core, one per line. `rules` limits them to these
 * rules. Parts of the page that match a selector of `exclude` are not checked.
 */
export async function findings(page, rules = null, exclude = []) {
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(kAxe);
  const violations = await page.evaluate(
    async ([only, left_out]) =>
      (
        await globalThis.axe.run(left_out.length > 0 ? { exclude: left_out } : document, {
          resultTypes: ["violations"],
          ...(only ? { runOnly: { type: "rule", values: only } } : {}),
        })
      ).violations,
    [rules, exclude],
  );
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .flatMap(({ id, nodes }) =>
      nodes.map(
        ({ target, html, any, all }) =>
          `${id}: ${target.flat().join(" ")} ${html.slice(0, 120)} ${[...any, ...all]
            .map(({ message }) => message)
            .join("; ")
            .slice(0, 200)}`,
      ),
    );
}

/** Rules about visible texts as names, landmarks, and heads of tables. */
export const kHeadRules = [
  "label-content-name-mismatch",
  "region",
  "landmark-one-main",
  "empty-table-header",
];

/**
 * Returns all findings of these rules, of any severity, one per line. Includes rules that axe-core
 * does not apply by default.
 */
export async function violations(page, rules) {
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(kAxe);
  const found = await page.evaluate(
    async (values) =>
      (
        await globalThis.axe.run(document, {
          resultTypes: ["violations"],
          runOnly: { type: "rule", values },
        })
      ).violations,
    rules,
  );
  return found.flatMap(({ id, nodes }) =>
    nodes.map(({ target, html }) => `${id}: ${target.flat().join(" ")} ${html.slice(0, 160)}`),
  );
}

/** Functions that also search in shadow roots. */
const kDeep = `
  const deep_all = (root = document) => [...root.querySelectorAll("*")].flatMap((each) => [each, ...(each.shadowRoot ? deep_all(each.shadowRoot) : [])]);
  const deep_active = () => { let at = document.activeElement; while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement; return at; };
  const told = (each) => each.localName + (each.id ? "#" + each.id : "") + (each.className && typeof each.className === "string" ? "." + each.className.trim().replace(/\\s+/g, ".") : "") +
    " “" + (each.getAttribute("aria-label") ?? each.textContent ?? "").trim().slice(0, 40) + "”";
`;
const evaluate = (page, body) => page.evaluate(`(() => { ${kDeep} ${body} })()`);

/**
 * Returns the elements that are wider than their container: the document, whole dialogs and menus,
 * texts outside their control, and buttons of a dialog or of the introduction in more than one row.
 */
export const overflows = (page) =>
  evaluate(
    page,
    `const found = [];
     const root = document.scrollingElement;
     if (root.scrollWidth > root.clientWidth) found.push("document: " + root.scrollWidth + " in " + root.clientWidth);
     const scrolls = (each) => /auto|scroll/.test(getComputedStyle(each).overflowX);
     for (const each of deep_all()) {
       if (!each.checkVisibility() || each.getClientRects().length === 0) continue;
       const box = each.getBoundingClientRect();
       if (each.matches("dialog[open], [popover]:popover-open")) {
         if (box.left < -0.5 || box.right > innerWidth + 0.5) found.push(told(each) + " leaves the window");
         if (each.scrollWidth > each.clientWidth + 1) found.push(told(each) + ": " + each.scrollWidth + " in " + each.clientWidth);
       }
       if (each.matches("button, input:not([hidden]), select, textarea, a[href], output")) {
         for (let at = each.assignedSlot ?? each.parentNode; at && at !== document; at = at.assignedSlot ?? at.parentNode ?? at.host) {
           if (!(at instanceof Element)) continue;
           if (scrolls(at)) break;
           if (getComputedStyle(at).overflowX === "hidden" && box.right > at.getBoundingClientRect().right + 1) {
             found.push(told(each) + " is cut off by " + told(at).slice(0, 40));
             break;
           }
         }
       }
       if (each.matches("dialog[open] footer, section > .choices")) {
         const slotted = each.querySelector("slot[name=actions]")?.assignedElements() ?? [];
         const buttons = [...each.querySelectorAll("button"), ...slotted.filter((button) => button.matches("button"))];
         const rows = new Set(buttons.map((button) => Math.round(button.getBoundingClientRect().top)));
         if (rows.size > 1) found.push("buttons in " + rows.size + " rows: " + buttons.map(told).join(", "));
       }
       const inside = each.closest("dialog[open]");
       if (inside && each.matches(".content, footer") && each.scrollWidth > each.clientWidth + 1) found.push(told(each) + ": " + each.scrollWidth + " in " + each.clientWidth);
       // the target of a press may be larger than its visible part
       const reach = Math.max(0, -parseFloat(getComputedStyle(each, "::before").right) || 0);
       if (each.matches("button") && !each.querySelector("slot") && each.scrollWidth > each.clientWidth + 1 + reach && !each.querySelector(".ellipsis") && getComputedStyle(each).overflowX === "visible")
         found.push(told(each) + " has " + each.scrollWidth + " in " + each.clientWidth);
     }
     return found;`,
  );

export const active = (page) =>
  evaluate(page, "const at = deep_active(); return at === document.body ? '' : told(at);");

/**
 * Visits all stops of the Tab key. Returns the controls that it does not reach, and those without
 * visible focus. Elements that disappear during the walk, such as notices, are not required.
 */
export async function walk(page) {
  await evaluate(
    page,
    `window.reached = new Set();
     window.unseen = [];
     document.activeElement?.blur();
     // A dialog that is not modal does not keep the focus, so the walk begins in the dialog.
     deep_all().findLast((each) => each.matches("dialog[open]:not(:modal)"))?.focus();`,
  );
  const count = await evaluate(
    page,
    `const top = [...deep_all()].filter((each) => each.matches("dialog[open]")).at(-1);
     const within = (each) => { for (let at = each; at; at = at.parentNode ?? at.host) if (at === top) return true; return !top; };
     const flat = (each) => { for (let at = each; at; at = at.assignedSlot ?? at.parentNode ?? at.host) if (at === top) return true; return !top; };
     const is_inert = (each) => { for (let at = each; at; at = at.assignedSlot ?? at.parentNode ?? at.host) if (at.inert) return true; return false; };
     window.wanted = deep_all().filter((each) => each.matches("a[href], button, input, select, textarea, summary, [tabindex]") && !each.disabled && each.tabIndex >= 0 &&
       each.checkVisibility({ visibilityProperty: true }) && each.getClientRects().length > 0 && (within(each) || flat(each)) &&
       !is_inert(each) && !(each.shadowRoot?.delegatesFocus));
     return window.wanted.length;`,
  );
  for (let presses = 0; presses < 2 * count + 10; ++presses) {
    await page.keyboard.press("Tab");
    const done = await evaluate(
      page,
      `const at = deep_active();
       if (at && at !== document.body) {
         if (window.reached.has(at) && window.wanted.every((each) => window.reached.has(each) || !each.isConnected)) return true;
         window.reached.add(at);
         // The focus may be visible on the element, on the field around it, or on its active cell.
         const shown = [at, at.parentElement, at.parentElement?.parentElement, at.querySelector(".cell.active")].filter(Boolean).map((each) => getComputedStyle(each));
         const ring = ({ outlineStyle, outlineWidth, boxShadow }) => (outlineStyle !== "none" && parseFloat(outlineWidth) >= 2) || boxShadow.includes("2px inset");
         if (!shown.some(ring)) window.unseen.push(told(at));
       }
       return false;`,
    );
    if (done) break;
  }
  return evaluate(
    page,
    `// Of radio buttons one is a stop.
     const radios = new Set([...window.reached].filter((each) => each.type === "radio").map((each) => each.name));
     return { unreached: window.wanted.filter((each) => each.isConnected && !window.reached.has(each) && !(each.type === "radio" && radios.has(each.name))).map(told), unseen: window.unseen, stops: window.reached.size };`,
  );
}
