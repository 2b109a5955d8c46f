// Pieces of the page that are loaded when they are first shown, or once nothing else is to be done.
// Their elements are rendered when they are here and not before: an element that is defined later
// is connected before it has what was set on it.

import { notices } from "../ui/notices";
import { texts } from "../texts";

export type PagePart =
  | "home"
  | "model"
  | "model_dialogs"
  | "join"
  | "sign_in"
  | "account"
  | "people"
  | "kiosks"
  | "preferences";

/** The import of each. They are passed in, because a piece may ask for another one itself. */
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
 * Whether it may be rendered. Where not, it is loaded, and `host` is rendered again when it is
 * here. Files of a build go with it: a page that was opened before an update of the server may miss
 * a piece, and is loaded anew by its person.
 */
export function hasPart(part: PagePart, host: { requestUpdate(): void }): boolean {
  if (here.has(part)) return true;
  load(part).then(
    () => host.requestUpdate(),
    () => {
      const link = { label: texts.connection.reload, act: () => location.reload() };
      notices.show(
        "problem",
        texts.connection.part_missing,
        texts.connection.part_missing_hint,
        link,
      );
    },
  );
  return false;
}

/** What a part that is here exports. */
export const partOf = (part: PagePart): unknown => here.get(part);

/**
 * Loads it while the person looks at something else. Nothing is said when it fails: it is asked for
 * again when it is needed.
 */
export function loadPartLater(part: PagePart): void {
  const begin = (): void => {
    if (!here.has(part)) load(part).catch(() => {});
  };
  if ("requestIdleCallback" in window) requestIdleCallback(begin, { timeout: 5000 });
  else setTimeout(begin, 500); // Safari
}
