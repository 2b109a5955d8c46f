// Names that are completed behind an @ in a comment.

import type { ProjectPerson } from "../core/protocol.gen";

/** What is written behind the @ before the caret, and where the @ stands. */
export interface MentionBegun {
  at: number;
  word: string;
}

const kBegun = /(?<![A-Za-z0-9._@-])@([A-Za-z0-9._@-]*)$/;
const kMostPeople = 6;

/** Nothing: the caret does not stand behind one; an address of a mail is none. */
export function mentionBegun(text: string, caret: number): MentionBegun | null {
  const found = kBegun.exec(text.slice(0, caret));
  return found ? { at: found.index, word: found[1]! } : null;
}

/**
 * Those whose name begins so, then those with a part of name or full name that does, in any case
 * and without regard to accents.
 */
export function peopleLike(people: readonly ProjectPerson[], word: string): ProjectPerson[] {
  const wanted = plain(word);
  const begins = people.filter(({ user }) => plain(user).startsWith(wanted));
  const within = people.filter(({ user, full_name: fullName }) =>
    `${user} ${fullName}`.split(/[\s._@-]+/).some((part) => plain(part).startsWith(wanted)),
  );
  return [...new Set([...begins, ...within])].slice(0, kMostPeople);
}

const plain = (text: string): string => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();
