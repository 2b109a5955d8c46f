// A tree of terms as rows from top to bottom, and its keyboard control.

import { plainText } from "../../core/search";
import type { ListedTerm } from "../../core/protocol.gen";

export interface TermRow {
  term: ListedTerm;
  /** Whether terms of this tree are below it. */
  parent: boolean;
  folded: boolean;
  /** Position among the siblings, from 1, and their number. */
  place: number;
  of: number;
}

const kMostUnfolded = 60; // a larger tree is folded at first

/** Keys of the terms that are folded at first: in a large tree all except those above `chosen`. */
export function foldedAtFirst(terms: readonly ListedTerm[], chosen: number): Set<number> {
  const folded = new Set<number>();
  if (terms.length <= kMostUnfolded) return folded;
  terms.forEach((term, index) => {
    if (hasBelow(terms, index)) folded.add(term.key);
  });
  for (const above of pathTo(terms, chosen)) folded.delete(above.key);
  return folded;
}

/** The terms above a term, the topmost first. */
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
 * The terms with all of the words in their names, ignoring case and accents, together with their
 * ancestors, which do not `match`.
 */
export function termsWith(terms: readonly ListedTerm[], words: string): ListedTerm[] {
  const wanted = plainText(words)
    .split(/\s+/)
    .filter((word) => word !== "");
  const matches = terms.map(({ name }) => wanted.every((word) => plainText(name).includes(word)));
  const shown = new Set<number>();
  let depth = 0; // of the shown term below; its ancestors have smaller depths
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

/** `terms`: each before its children. */
export function rowsOf(terms: readonly ListedTerm[], folded: ReadonlySet<number>): TermRow[] {
  const rows: TermRow[] = [];
  let hiddenBelow = Infinity; // depth of the folded term that hides the following ones
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

/** Siblings have the same depth, without a smaller depth between them. */
function numberSiblings(rows: readonly TermRow[]): void {
  const open: TermRow[][] = []; // by depth: the siblings so far
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
 * The effect of a key at a row (-1: none): moves to another row, folds or unfolds its term. Null:
 * the tree does not use the key. `page`: number of visible rows.
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
