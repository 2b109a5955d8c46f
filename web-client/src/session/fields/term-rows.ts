// Converts a tree of terms to rows from top to bottom, and handles its keys.

import { plainText } from "../../core/search";
import type { ListedTerm } from "../../core/protocol.gen";

export interface TermRow {
  term: ListedTerm;
  /** Whether the term has children in this tree. */
  parent: boolean;
  folded: boolean;
  /** The position among the siblings, from 1, and the number of siblings. */
  place: number;
  of: number;
}

const kMostUnfolded = 60; // a larger tree is folded initially

/**
 * Returns the keys of the terms that are folded initially. In a large tree, these are all terms
 * except those above `chosen`.
 */
export function foldedAtFirst(terms: readonly ListedTerm[], chosen: number): Set<number> {
  const folded = new Set<number>();
  if (terms.length <= kMostUnfolded) return folded;
  terms.forEach((term, index) => {
    if (hasBelow(terms, index)) folded.add(term.key);
  });
  for (const above of pathTo(terms, chosen)) folded.delete(above.key);
  return folded;
}

/** Returns the ancestors of a term, the topmost first. */
export function pathTo(terms: readonly ListedTerm[], key: number): ListedTerm[] {
  const path: ListedTerm[] = [];
  let index = terms.findIndex((term) => term.key === key);
  for (let depth = terms[index]?.depth ?? 0; index >= 0 && depth > 0; --index) {
    const term = terms[index]!;
    if (term.depth < depth) {
      path.unshift(term);
      depth = term.depth;
    }
  }
  return path;
}

/**
 * Returns the terms with all of the words in their names, ignoring case and accents, and the
 * ancestors of these terms. `match` is false for ancestors that do not match themselves.
 */
export function termsWith(terms: readonly ListedTerm[], words: string): ListedTerm[] {
  const wanted = plainText(words)
    .split(/\s+/)
    .filter((word) => word !== "");
  const matches = terms.map(({ name }) => wanted.every((word) => plainText(name).includes(word)));
  const shown = new Set<number>();
  let depth = 0; // depth of the next shown term; its ancestors have smaller depths
  for (let index = terms.length - 1; index >= 0; --index) {
    const term = terms[index]!;
    if (matches[index] || term.depth < depth) {
      shown.add(index);
      depth = term.depth;
    } else {
      depth = Math.min(depth, term.depth);
    }
  }
  return terms.flatMap((term, index) =>
    shown.has(index) ? { ...term, match: matches[index]! } : [],
  );
}

/** Returns the visible rows of the tree. Each term in `terms` precedes its children. */
export function rowsOf(terms: readonly ListedTerm[], folded: ReadonlySet<number>): TermRow[] {
  const rows: TermRow[] = [];
  let hiddenBelow = Infinity; // depth of the folded term that hides the following terms
  terms.forEach((term, index) => {
    if (term.depth > hiddenBelow) return;
    const parent = hasBelow(terms, index);
    const row = { term, parent, folded: parent && folded.has(term.key), place: 0, of: 0 };
    hiddenBelow = row.folded ? term.depth : Infinity;
    rows.push(row);
  });
  numberSiblings(rows);
  return rows;
}

const hasBelow = (terms: readonly ListedTerm[], index: number): boolean =>
  (terms[index + 1]?.depth ?? 0) > terms[index]!.depth;

/**
 * Numbers the siblings. Siblings have the same depth, and no term between them has a smaller depth.
 */
function numberSiblings(rows: readonly TermRow[]): void {
  const open: TermRow[][] = []; // siblings so far, by depth
  const close = (depth: number): void => {
    for (const siblings of open.splice(depth)) for (const row of siblings) row.of = siblings.length;
  };
  for (const row of rows) {
    const { depth } = row.term;
    close(depth + 1);
    const siblings = (open[depth] ??= []);
    siblings.push(row);
    row.place = siblings.length;
  }
  close(0);
}

/**
 * Returns the effect of a key at a row: it moves to another row, or folds or unfolds the row's
 * term. `at` is -1 if no row is current. `page` is the number of visible rows. Returns null if the
 * tree does not use the key.
 */
export function treeStep(
  key: string,
  rows: readonly TermRow[],
  at: number,
  page: number,
): { at: number } | { fold: boolean } | null {
  const row = rows[at];
  const by = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page }[key];
  if (by !== undefined) {
    if (rows.length === 0) return null;
    const from = row ? at : by > 0 ? -1 : rows.length;
    return { at: Math.min(rows.length - 1, Math.max(0, from + by)) };
  }
  switch (key) {
    case "ArrowRight":
      if (!row?.parent) return null;
      return row.folded ? { fold: false } : { at: at + 1 };
    case "ArrowLeft": {
      if (!row) return null;
      if (row.parent && !row.folded) return { fold: true };
      let above = at - 1;
      while (above >= 0 && rows[above]!.term.depth >= row.term.depth) --above;
      return above < 0 ? null : { at: above };
    }
    default:
      return null;
  }
}
