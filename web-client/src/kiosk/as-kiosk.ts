// Adds `as=kiosk` to every address that the kiosk requests. For such a request, the server uses
// only the kiosk's own cookie, and not the cookie of a signed-in user of the same browser.

import type { Fetch } from "../net/api";

const kPatienceMs = 30_000; // without a response in this time, a request fails

export const asKiosk = (address: string): string =>
  `${address}${address.includes("?") ? "&" : "?"}as=kiosk`;

export const patientFetch: Fetch = (address, init) =>
  fetch(address, { ...init, signal: AbortSignal.timeout(kPatienceMs) });
export const kioskFetch: Fetch = (address, init) => patientFetch(asKiosk(address), init);

/** Returns the address of a still image of a view. */
export const pictureOfView = (model: string, view: string): string =>
  asKiosk(`/api/v1/models/${encodeURIComponent(model)}/views/${encodeURIComponent(view)}/picture`);
