// Pieces of the page that are loaded when they are first shown, or once nothing else is to be done. Their elements may be rendered
// before: Lit takes over what was set on them.

import { notices } from "./notices";
import { texts } from "./texts";

const kParts = {
  home: () => import("./home-page"),
  model: () => import("./model-page"),
  model_dialogs: () => import("./model-dialogs"),
  join: () => import("./join-page"),
  sign_in: () => import("./sign-in"),
  account: () => import("./account-dialog"),
  people: () => import("./people-dialog"),
  kiosks: () => import("./kiosks-dialog"),
  preferences: () => import("./preferences-fields"),
};
export type PagePart = keyof typeof kParts;

const loading = new Map<PagePart, Promise<unknown>>();

/** Loads it, once. Files of a build go with it: a page that was opened before an update of the server may miss a piece, and is loaded anew. */
export function load_part(part: PagePart): void {
  if (loading.has(part)) return;
  const loaded = kParts[part]().catch(() => {
    loading.delete(part);
    const link = { label: texts.connection.reload, act: () => location.reload() };
    notices.show("problem", texts.connection.part_missing, texts.connection.part_missing_hint, link);
  });
  loading.set(part, loaded);
}

/** Loads it while the person looks at something else. Nothing is said when it fails: it is asked for again when it is needed. */
export function load_part_later(part: PagePart): void {
  const load = (): void => {
    if (!loading.has(part)) void kParts[part]().catch(() => {});
  };
  if ("requestIdleCallback" in window) requestIdleCallback(load, { timeout: 5000 });
  else setTimeout(load, 500); // Safari
}
