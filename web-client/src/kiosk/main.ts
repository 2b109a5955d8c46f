// The page at /kiosk/{secret}. Started by the page's own main.ts, of which it loads nothing else.

import { Api } from "../net/api";
import { say_own_problems_in } from "../core/problems";
import { kiosk_fetch } from "./as-kiosk";
import { keep_on_page, stay_awake } from "./guard";
import "./kiosk-page";
import { KioskSession } from "./kiosk-session";
import { KioskStore, open_browser_shelf, start_worker } from "./store";

/** Behind /kiosk/; null: there is none. */
export const secret_of = (path: string): string | null =>
  /^\/kiosk\/([^/]{1,200})\/?$/.exec(path)?.[1] ?? null;

export function start_kiosk(): void {
  // Visitors are told of no call that failed.
  say_own_problems_in({
    unreachable: ["The server is away", ""],
    statuses: {},
    other_status: (status) => `Status ${status}`,
    other_status_detail: "",
    unreadable: "Not readable",
    unreadable_detail: (what) => what,
  });
  const secret = secret_of(location.pathname) ?? "";
  const session = new KioskSession({
    api: new Api(kiosk_fetch),
    secret,
    store: new KioskStore({ open_shelf: open_browser_shelf, secret }),
    reload: () => location.reload(),
  });
  const page = document.createElement("strata-kiosk");
  page.session = session;
  document.querySelector("strata-app")?.replaceWith(page);
  keep_on_page();
  void stay_awake();
  void start_worker();
  document.addEventListener("visibilitychange", () => {
    void stay_awake();
    if (document.visibilityState === "visible") session.look_again();
  });
  addEventListener("online", () => session.look_again());
  session.open();
}
