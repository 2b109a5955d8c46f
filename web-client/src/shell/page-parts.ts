// Parts of the page that are loaded at their first use, or when the page is idle. Their elements
// are rendered only after the load, because an element that is defined later is connected before
// its properties are set.

import { notices } from "../ui/notices";
import { texts } from "../texts";

export type PagePart =
  | "home"
  | "model"
  | "model_dialogs"
  | "table"
  | "measuring"
  | "activity"
  | "comments"
  | "past"
  | "surveys"
  | "parts"
  | "scans"
  | "join"
  | "sign_in"
  | "account"
  | "people"
  | "nodes"
  | "kiosks"
  | "bills"
  | "preferences";

/** The import of each part. It is injected, because a part may request another part. */
export type PartLoads = Readonly<Record<PagePart, () => Promise<unknown>>>;

let loads: PartLoads;
export function setPartLoads(known: PartLoads): void {
  loads = known;
}

const here = new Map<PagePart, unknown>();
const loading = new Map<PagePart, Promise<void>>();

function load(part: PagePart): Promise<void> {
  const underWay = loading.get(part);
  if (underWay) return underWay;
  const loaded = loads[part]()
    .then((module) => void here.set(part, module))
    .finally(() => loading.delete(part));
  loading.set(part, loaded);
  return loaded;
}

/**
 * Whether the part can be rendered. If not, the part is loaded, and `host` is rendered again after
 * that. Files belong to one build. If the server was updated after the page was loaded, a part may
 * be missing, and the user must reload the page.
 */
export function hasPart(part: PagePart, host: { requestUpdate(): void }): boolean {
  if (here.has(part)) return true;
  load(part).then(() => host.requestUpdate(), tellMissing);
  return false;
}

/** Uses the exports of a part, immediately or after the part is loaded. */
export function withPart<Exports>(part: PagePart, use: (exports: Exports) => void): void {
  if (here.has(part)) use(here.get(part) as Exports);
  else load(part).then(() => use(here.get(part) as Exports), tellMissing);
}

function tellMissing(): void {
  const link = { label: texts.connection.reload, act: () => location.reload() };
  notices.show("problem", texts.connection.part_missing, texts.connection.part_missing_hint, link);
}

/** Returns the exports of a loaded part. */
export const partOf = (part: PagePart): unknown => here.get(part);

/**
 * Loads a part when the page is idle. A failure is not reported, because the part is requested
 * again when it is needed.
 */
export function loadPartLater(part: PagePart): void {
  const begin = (): void => {
    if (!here.has(part)) load(part).catch(() => {});
  };
  if ("requestIdleCallback" in window) requestIdleCallback(begin, { timeout: 5000 });
  else setTimeout(begin, 500); // for Safari
}
