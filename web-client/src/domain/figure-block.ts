// The title block of a figure: the texts of its fields, and the member of the request.

import type { FigureTitleBlock } from "../core/protocol.gen";

/** Fields that the user can fill in, with the largest number of characters of each. */
export const kBlockFields = {
  organization: 200,
  project: 200,
  object: 200,
  author: 200,
  checked_by: 200,
  date: 60,
  status: 100,
  number: 100,
  sheet: 30,
} as const;
export type BlockField = keyof typeof kBlockFields;
export const kBlockFieldNames = Object.keys(kBlockFields) as readonly BlockField[];

/** The texts as typed. If a text is empty, the server uses its default. */
export type BlockTexts = Readonly<Record<BlockField, string>>;

/** Texts that are the same for most figures of a user, so the browser stores them. */
export const kKeptBlockFields = ["organization", "author"] as const;
export type KeptBlockTexts = Readonly<Record<(typeof kKeptBlockFields)[number], string>>;

export const emptyBlock = (): BlockTexts =>
  Object.fromEntries(kBlockFieldNames.map((name) => [name, ""])) as Record<BlockField, string>;

/** Reads texts from the browser's storage. An empty text replaces an invalid one. */
export function keptBlockTexts(kept: unknown): KeptBlockTexts {
  const known = (typeof kept === "object" && kept !== null ? kept : {}) as Record<string, unknown>;
  const textOf = (name: BlockField): string => {
    const text = known[name];
    return typeof text === "string" && text.length <= kBlockFields[name] ? text : "";
  };
  return { organization: textOf("organization"), author: textOf("author") };
}

export function titleBlock(written: BlockTexts): FigureTitleBlock {
  const filled = kBlockFieldNames.flatMap((name) => {
    const text = written[name].trim();
    return text === "" ? [] : [[name, text]];
  });
  return Object.fromEntries(filled) as FigureTitleBlock;
}
