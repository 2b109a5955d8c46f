// The kiosk's tour on a visitor's phone: the address in the screen's QR code, and the data that the
// phone reads from it.

import { svg, type TemplateResult } from "lit";
import { encode } from "uqr";

/**
 * The current position of the screen. It is in the address after #, which browsers never send to
 * the server.
 */
export interface PhonePlace {
  stop: number; // index of the stop
  language: string;
}

export const phoneAddress = (
  origin: string,
  path: string,
  { stop, language }: PhonePlace,
): string => `${origin}${path}#stop=${stop + 1}&language=${encodeURIComponent(language)}`;

/** Returns the position in an address, or null if the address is not from a QR code. */
export function phonePlaceOf(hash: string): PhonePlace | null {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const stop = Number(given.get("stop"));
  return Number.isInteger(stop) && stop >= 1 && stop <= 1000
    ? { stop: stop - 1, language: given.get("language") ?? "" }
    : null;
}

/** Draws the QR code as one path of squares, with the empty margin that scanners need. */
export function codeOf(text: string): TemplateResult {
  const { data, size } = encode(text, { ecc: "M", border: 3 });
  const squares = data.flatMap((row, y) =>
    row.flatMap((dark, x) => (dark ? [`M${x} ${y}h1v1h-1z`] : [])),
  );
  return svg`<svg viewBox="0 0 ${size} ${size}" shape-rendering="crispEdges" aria-hidden="true"><path d=${squares.join("")} /></svg>`;
}
