// Every address of the kiosk has `as=kiosk`: the server then uses the kiosk's own cookie, never
// that of a user who is signed in in the same browser.

import type { Fetch } from "../net/api";

const kPatienceMs = 30_000; // after this time without an answer the server counts as unreachable

export const asKiosk = (address: string): string =>
  `${address}${address.includes("?") ? "&" : "?"}as=kiosk`;

export const patientFetch: Fetch = (address, init) =>
  fetch(address, { ...init, signal: AbortSignal.timeout(kPatienceMs) });
export const kioskFetch: Fetch = (address, init) => patientFetch(asKiosk(address), init);

/** The address of a still picture of a view. */
export const pictureOfView = (model: string, view: string): string =>
  asKiosk(`/api/v1/models/${encodeURIComponent(model)}/views/${encodeURIComponent(view)}/picture`);
