// Adds `as=kiosk` to every address that the kiosk requests. The server then uses the kiosk's own
// cookie, never the cookie of a user who is signed in in the same browser.

import type { Fetch } from "../net/api";

const kPatienceMs = 30_000; // without a response in this time, the server counts as unreachable

export const asKiosk = (address: string): string =>
  `${address}${address.includes("?") ? "&" : "?"}as=kiosk`;

export const patientFetch: Fetch = (address, init) =>
  fetch(address, { ...init, signal: AbortSignal.timeout(kPatienceMs) });
export const kioskFetch: Fetch = (address, init) => patientFetch(asKiosk(address), init);

/** Returns the address of a still image of a view. */
export const pictureOfView = (model: string, view: string): string =>
  asKiosk(`/api/v1/models/${encodeURIComponent(model)}/views/${encodeURIComponent(view)}/picture`);
