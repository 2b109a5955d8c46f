// Every address of the kiosk says `as=kiosk`: its own cookie counts then, and never that of a
// person who is signed in in the same browser.

import type { Fetch } from "../net/api";

const kPatience_ms = 30_000; // a server that does not answer at all is away

export const as_kiosk = (address: string): string =>
  `${address}${address.includes("?") ? "&" : "?"}as=kiosk`;

export const patient_fetch: Fetch = (address, init) =>
  fetch(address, { ...init, signal: AbortSignal.timeout(kPatience_ms) });
export const kiosk_fetch: Fetch = (address, init) => patient_fetch(as_kiosk(address), init);

/** Of a still picture of what a view shows. */
export const picture_of_view = (model: string, view: string): string =>
  as_kiosk(`/api/v1/models/${encodeURIComponent(model)}/views/${encodeURIComponent(view)}/picture`);
