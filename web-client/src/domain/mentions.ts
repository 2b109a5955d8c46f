// Completion of names after an @ in a comment.

import { plainText } from "../core/search";
import type { ProjectPerson } from "../core/protocol.gen";

/** The text after the @ before the caret, and the position of the @. */
export interface MentionBegun {
  at: number;
  word: string;
}

const kBegun = /(?<![A-Za-z0-9._@-])@([A-Za-z0-9._@-]*)$/;
const kMostPeople = 6;

/** Null: the caret is not in a mention; the @ of a mail address is not one. */
export function mentionBegun(text: string, caret: number): MentionBegun | null {
  const found = kBegun.exec(text.slice(0, caret));
  return found ? { at: found.index, word: found[1]! } : null;
}

/**
 * Finds people whose user name starts with the word, then those with a part of the user or full
 * name that does, ignoring case and accents.
 */
export function peopleLike(people: readonly ProjectPerson[], word: string): ProjectPerson[] {
  const wanted = plainText(word);
  const begins = people.filter(({ user }) => plainText(user).startsWith(wanted));
  const within = people.filter(({ user, full_name: fullName }) =>
    `${user} ${fullName}`.split(/[\s._@-]+/).some((part) => plainText(part).startsWith(wanted)),
  );
  return [...new Set([...begins, ...within])].slice(0, kMostPeople);
}
