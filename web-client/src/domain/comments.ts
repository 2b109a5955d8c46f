// Threads of comments and the parts of their texts. This file has no user interface.

import type { Comment, Point3 } from "../core/protocol.gen";

/** The first comment of a thread, which has a position. */
export type FirstComment = Comment & { position: Point3; normal: Point3 };

export interface Thread {
  first: FirstComment;
  replies: Comment[]; // sorted by id
  newest: number; // id of the newest comment
}

export type ThreadState = "open" | "resolved" | "all";

export interface ThreadFilter {
  state: ThreadState;
  /** If set, only threads that this user wrote in or that mention this user. */
  of: string | null;
  words: string;
}

const isFirst = (comment: Comment): comment is FirstComment =>
  comment.thread === undefined && comment.position !== undefined && comment.normal !== undefined;

/** Groups comments into threads, the thread with the newest comment first. */
export function threadsOf(comments: Iterable<Comment>): Thread[] {
  const threads = new Map<number, Thread>();
  const all = [...comments].sort((a, b) => a.id - b.id);
  for (const comment of all)
    if (isFirst(comment))
      threads.set(comment.id, { first: comment, replies: [], newest: comment.id });
  for (const comment of all) {
    const thread = comment.thread === undefined ? undefined : threads.get(comment.thread);
    if (!thread) continue;
    thread.replies.push(comment);
    thread.newest = comment.id;
  }
  return [...threads.values()].sort((a, b) => b.newest - a.newest);
}

export const commentsIn = ({ first, replies }: Thread): Comment[] => [first, ...replies];

/**
 * Finds threads by words. Each word must occur in a text or an author's name of the thread,
 * ignoring case.
 */
export function findThreads(
  threads: readonly Thread[],
  { state, of, words }: ThreadFilter,
): Thread[] {
  const wanted = words
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  return threads.filter((thread) => {
    if (state !== "all" && thread.first.state !== state) return false;
    const comments = commentsIn(thread);
    if (of !== null && !comments.some(({ user, text }) => user === of || mentions(text, of)))
      return false;
    const said = comments
      .map(({ user, full_name: fullName, text }) =>
        `${user} ${fullName ?? ""} ${text}`.toLowerCase(),
      )
      .join(" ");
    return wanted.every((word) => said.includes(word));
  });
}

export type TextPart =
  | { kind: "text"; text: string }
  | { kind: "link"; text: string; href: string }
  | { kind: "mention"; text: string };

const kParts = /\bhttps?:\/\/[^\s<>"]+|(?<![A-Za-z0-9._@-])@[A-Za-z0-9][A-Za-z0-9._@-]*/giu;

/** Splits a text into plain text, web addresses and the @names of `people`. */
export function textParts(text: string, people: ReadonlySet<string>): TextPart[] {
  const known = new Set([...people].map((name) => name.toLowerCase()));
  const parts: TextPart[] = [];
  const add = (part: TextPart): void => {
    const last = parts[parts.length - 1];
    if (part.kind === "text" && last?.kind === "text") last.text += part.text;
    else if (part.text !== "") parts.push(part);
  };
  let at = 0;
  for (const found of text.matchAll(kParts)) {
    add({ kind: "text", text: text.slice(at, found.index) });
    const whole = found[0].startsWith("@") ? mentionIn(found[0], known) : linkIn(found[0]);
    if (whole === "") add({ kind: "text", text: found[0] });
    else if (whole.startsWith("@")) add({ kind: "mention", text: whole });
    else add({ kind: "link", text: whole, href: new URL(whole).href });
    if (whole !== "") add({ kind: "text", text: found[0].slice(whole.length) });
    at = found.index + found[0].length;
  }
  add({ kind: "text", text: text.slice(at) });
  return parts;
}

export const mentions = (text: string, name: string): boolean =>
  textParts(text, new Set([name])).some(({ kind }) => kind === "mention");

/**
 * Returns the longest known name at the start of `found`, because punctuation may follow a name.
 * Returns an empty text if no user has the name.
 */
function mentionIn(found: string, known: ReadonlySet<string>): string {
  for (let whole = found; whole.length > 1; whole = whole.slice(0, -1)) {
    if (known.has(whole.slice(1).toLowerCase())) return whole;
    if (!/[._@-]$/.test(whole)) break;
  }
  return "";
}

/**
 * Removes punctuation that belongs to the sentence. Returns an empty text if `found` is not a web
 * address.
 */
function linkIn(found: string): string {
  let whole = found;
  for (;;) {
    const last = whole[whole.length - 1] ?? "";
    const opened = last === ")" ? "(" : last === "]" ? "[" : "";
    const unpaired = opened !== "" && whole.split(last).length > whole.split(opened).length;
    if (!/[.,;:!?'*_]/.test(last) && !unpaired) break;
    whole = whole.slice(0, -1);
  }
  try {
    const { protocol, hostname } = new URL(whole);
    return /^https?:$/.test(protocol) && hostname !== "" ? whole : "";
  } catch {
    return "";
  }
}

/** The comments that a user has read: all up to `upto`, and in a thread those up to its own mark. */
export interface ReadMarks {
  upto: number;
  threads: Record<string, number>;
}

/** Whether the thread has an unread comment by another user. */
export function isUnread(thread: Thread, { upto, threads }: ReadMarks, me: string): boolean {
  const seen = Math.max(upto, threads[thread.first.id] ?? 0);
  return commentsIn(thread).some(({ id, user, deleted }) => id > seen && user !== me && !deleted);
}

export const withThreadRead = ({ upto, threads }: ReadMarks, thread: Thread): ReadMarks => ({
  upto,
  threads: { ...threads, [thread.first.id]: thread.newest },
});
