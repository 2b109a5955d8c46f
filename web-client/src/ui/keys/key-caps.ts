// Shows the names of keys in a text as key caps.

import { html, type TemplateResult } from "lit";

/** A part of a text: a key, or the words between keys. */
export interface KeyPiece {
  text: string;
  isKey: boolean;
}

const kSeparators = /( · |, | \+ | – )/;

/**
 * Splits a text such as "Ctrl + Enter · C, then click". A key is a single character or one of
 * `names`, if it is alone between separators.
 */
export function keyPieces(text: string, names: readonly string[]): KeyPiece[] {
  const pieces: KeyPiece[] = [];
  for (const part of text.split(kSeparators)) {
    const isKey = names.includes(part) || /^[^\s·]$/.test(part);
    const last = pieces.at(-1);
    if (!isKey && last && !last.isKey) last.text += part;
    else if (part !== "") pieces.push({ text: part, isKey });
  }
  return pieces;
}

/** Renders a text with key caps. The key names in `names` are separated by " · ". */
export const keyCaps = (text: string, names: string): (TemplateResult | string)[] =>
  keyPieces(text, names.split(" · ")).map(({ text, isKey }) =>
    isKey ? html`<kbd>${text}</kbd>` : text,
  );
