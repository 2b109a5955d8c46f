// Every address of the kiosk says `as=kiosk`: its own cookie counts then, and never that of a
// person who is signed in in the same browser.

import type { Fetch } from "../net/api";

const kPatienceMs = 30_000; // a server that does not answer at all is away

export const asKiosk = (address: string): string =>
  `${address}${address.includes("?") ? "&" : "?"}as=kiosk`;

export const patientFetch: Fetch = (address, init) =>
  fetch(address, { ...init, signal: AbortSignal.timeout(kPatienceMs) });
export const kioskFetch: Fetch = (address, init) => patientFetch(asKiosk(address), init);

/** Of a still picture of what a view shows. */
export const pictureOfView = (model: string, view: string): string =>
  asKiosk(`/api/v1/models/${encodeURIComponent(model)}/views/${encodeURIComponent(view)}/picture`);
