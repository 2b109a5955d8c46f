// The addresses of the page: /, /projects/{slug}, /models/{id}, and /join#SECRET for invited users.
// /kiosk/SECRET is another page (kiosk/).

/**
 * The route of an address. `project` is the project with the listed models. Null lists the models
 * of all projects.
 */
export type Route =
  { page: "home"; project: string | null } | { page: "join" } | { page: "model"; model: string };

const kHome: Route = { page: "home", project: null };

export function routeOf(path: string): Route {
  if (/^\/join\/?$/.test(path)) return { page: "join" };
  const found = /^\/(models|projects)\/([^/?#]+)\/?$/.exec(path);
  if (!found) return kHome;
  try {
    const name = decodeURIComponent(found[2]!);
    return found[1] === "models" ? { page: "model", model: name } : { page: "home", project: name };
  } catch {
    return kHome;
  }
}

/** Whether the address belongs to the kiosk page, which loads no code of this page. */
export const isKiosk = (path: string): boolean => path.startsWith("/kiosk/");

export const pathNow = (): string => location.pathname;
const addressNow = (): string => location.pathname + location.search + location.hash;
export const pathOfProject = (slug: string): string => `/projects/${encodeURIComponent(slug)}`;
export const pathOfModel = (id: number | string): string => `/models/${encodeURIComponent(id)}`;

/** Returns the id of the comment in an address. */
export function commentOf(hash: string): number | null {
  const found = /^#comment=([1-9]\d{0,15})$/.exec(hash);
  return found ? Number(found[1]) : null;
}
export const hashOfComment = (id: number): string => `#comment=${id}`;

/** Returns the slug or id of the saved view in an address. */
export function viewOf(hash: string): string | null {
  const found = /^#view=([^&]{1,400})$/.exec(hash);
  try {
    return found ? decodeURIComponent(found[1]!) : null;
  } catch {
    return null;
  }
}
export const hashOfView = (slug: string): string => `#view=${encodeURIComponent(slug)}`;

type Question = () => Promise<boolean>;

const listeners = new Set<() => void>();
let shown = ""; // the address of the displayed content
let held: Question | null = null;
let asking = false;

function arrive(): void {
  shown = addressNow();
  listeners.forEach((each) => each());
}

/** Changes the address to the address of the displayed content, without navigation. */
export function putHash(hash: string): void {
  if (hash === location.hash) return;
  history.replaceState(history.state, "", `${location.pathname}${location.search}${hash}`);
  shown = addressNow();
}

export function onNavigate(listener: () => void): void {
  if (listeners.size === 0) {
    shown = addressNow();
    addEventListener("popstate", onHistory);
  }
  listeners.add(listener);
}

/**
 * Calls `mayLeave` before the page shows other content and loses unsaved input. Returns a function
 * that removes `mayLeave`.
 */
export function holdPage(mayLeave: Question): () => void {
  held = mayLeave;
  return () => {
    if (held === mayLeave) held = null;
  };
}

/** Asks whether the page may close for a reason other than navigation. */
export const mayLeavePage = async (): Promise<boolean> => held === null || held();

async function leave(go: () => void): Promise<void> {
  if (asking) return;
  asking = true;
  try {
    if (!(await mayLeavePage())) return;
    held = null; // the user has already discarded the input
    go();
  } finally {
    asking = false;
  }
}

const withoutPlace = (address: string): string => address.split(/[?#]/)[0]!;
const isHeldFrom = (path: string): boolean =>
  held !== null && withoutPlace(path) !== withoutPlace(shown);

/** Handles back and forward. The browser has already navigated when it sends the event. */
function onHistory(): void {
  if (!isHeldFrom(location.pathname)) return arrive();
  history.pushState(null, "", shown);
  void leave(() => history.back());
}

export function navigate(path: string): void {
  const go = (): void => {
    history.pushState(null, "", path);
    arrive();
  };
  if (isHeldFrom(path)) void leave(go);
  else go();
}

/** Navigates and replaces the history entry. */
export function replaceAddress(path: string): void {
  history.replaceState(null, "", path);
  arrive();
}

/** Handles a click on a link. Navigates without a reload, unless the user requests a new tab. */
export function follow(event: MouseEvent): void {
  if (
    event.defaultPrevented ||
    event.button !== 0 ||
    event.metaKey ||
    event.ctrlKey ||
    event.shiftKey
  )
    return;
  const link = event.currentTarget as HTMLAnchorElement;
  event.preventDefault();
  navigate(link.getAttribute("href") ?? "/");
}
