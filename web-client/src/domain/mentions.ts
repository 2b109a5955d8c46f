// Completes names after an @ in a comment.

import { plainText } from "../core/search";
import type { ProjectPerson } from "../core/protocol.gen";

/** The text after the @ before the caret, and the position of the @. */
export interface MentionBegun {
  at: number;
  word: string;
}

const kBegun = /(?<![A-Za-z0-9._@-])@([A-Za-z0-9._@-]*)$/;
const kMostPeople = 6;

/**
 * Returns the mention at the caret, or null. The @ of an email address does not start a mention.
 */
export function mentionBegun(text: string, caret: number): MentionBegun | null {
  const found = kBegun.exec(text.slice(0, caret));
  return found ? { at: found.index, word: found[1]! } : null;
}

/**
 * Finds users whose user name starts with the word. They are followed by users whose user name or
 * full name contains a part that starts with it. Ignores case and accents.
 */
export function peopleLike(people: readonly ProjectPerson[], word: string): ProjectPerson[] {
  const wanted = plainText(word);
  const begins = people.filter(({ user }) => plainText(user).startsWith(wanted));
  const within = people.filter(({ user, full_name: fullName }) =>
    `${user} ${fullName}`.split(/[\s._@-]+/).some((part) => plainText(part).startsWith(wanted)),
  );
  return [...new Set([...begins, ...within])].slice(0, kMostPeople);
}
