// All requested changes that are not known to be durable yet, in their order. Ids never change, so
// a repeated message is painted only once.

import { newId } from "../core/ids";
import type {
  EditRequest,
  Redo,
  StrokeBegin,
  StrokeEnd,
  StrokeExtend,
  Undo,
} from "../core/protocol.gen";

export type ChangeMessage = StrokeBegin | StrokeExtend | StrokeEnd | EditRequest | Undo | Redo;
export type SingleChange = EditRequest | Undo | Redo;

interface StrokeEntry {
  kind: "stroke";
  begin: StrokeBegin;
  parts: StrokeExtend[]; // unsaved parts, sorted by n
  end: StrokeEnd | null;
}
interface SingleEntry {
  kind: "single";
  message: SingleChange;
}
type Entry = StrokeEntry | SingleEntry;

export class Outbox {
  private _entries: Entry[] = [];

  /** `dropped` is called with the ids of messages that no longer wait. */
  constructor(private readonly _dropped: (ids: string[]) => void = () => {}) {}

  /** The number of changes that are not durable. */
  get waiting(): number {
    return this._entries.reduce(
      (sum, entry) => sum + (entry.kind === "stroke" ? entry.parts.length : 1),
      0,
    );
  }

  add(message: ChangeMessage): void {
    switch (message.op) {
      case "stroke.begin":
        this._entries.push({ kind: "stroke", begin: message, parts: [], end: null });
        break;
      case "stroke.extend":
        this.stroke(message.stroke)?.parts.push(message);
        break;
      case "stroke.end": {
        const entry = this.stroke(message.stroke);
        if (entry) this.shrink(() => (entry.end = message), [message]);
        break;
      }
      default:
        this._entries.push({ kind: "single", message });
    }
  }

  /**
   * Inserts the changes of an earlier page before those of this page, and ends the earlier page's
   * unfinished strokes. Returns the number of changes that were not waiting yet.
   */
  adopt(messages: readonly ChangeMessage[]): number {
    const before = this.waiting;
    const left = messages.filter((message) => !this.has(message.id));
    const own = this._entries;
    this._entries = [];
    for (const message of left) this.add(message);
    for (const entry of [...this._entries])
      if (entry.kind === "stroke" && !entry.end)
        this.add({ op: "stroke.end", id: newId(), stroke: entry.begin.stroke });
    this._entries.push(...own);
    return this.waiting - before;
  }

  hasStroke(stroke: string): boolean {
    return this.stroke(stroke) !== undefined;
  }

  /** Whether a message with this id is waiting. */
  has(id: string): boolean {
    return this._entries.some((entry) =>
      entry.kind === "single"
        ? entry.message.id === id
        : entry.begin.id === id ||
          entry.end?.id === id ||
          entry.parts.some((part) => part.id === id),
    );
  }

  saved(answer: {
    id?: string | undefined;
    stroke?: string | undefined;
    n?: number | undefined;
  }): void {
    this.shrink(() => {
      if (answer.stroke !== undefined && answer.n !== undefined) {
        const entry = this.stroke(answer.stroke);
        if (entry) entry.parts = entry.parts.filter((part) => part.n !== answer.n);
      } else if (answer.id !== undefined) {
        this._entries = this._entries.filter(
          (entry) => entry.kind !== "single" || entry.message.id !== answer.id,
        );
      }
    });
  }

  /** Whether the message is a batch of a stroke, and an earlier batch of this stroke is waiting. */
  followsWaitingBatch(id: string): boolean {
    return this._entries.some(
      (entry) => entry.kind === "stroke" && entry.parts.findIndex((part) => part.id === id) > 0,
    );
  }

  /** Removes the batches of the stroke up to n, which the server has saved. */
  savedThrough(stroke: string, n: number): void {
    const entry = this.stroke(stroke);
    if (entry) this.shrink(() => (entry.parts = entry.parts.filter((part) => part.n > n)));
  }

  /**
   * Discards a message that the server will never accept. Returns the ids of all discarded
   * messages.
   */
  giveUp(id: string): string[] {
    return this.shrink(() => {
      for (const entry of this._entries)
        if (entry.kind === "stroke") entry.parts = entry.parts.filter((part) => part.id !== id);
      this._entries = this._entries.filter(
        (entry) => (entry.kind === "single" ? entry.message.id : entry.begin.id) !== id,
      );
    });
  }

  /** Discards everything. Later batches of an unfinished stroke are not accepted. */
  clear(): void {
    this.shrink(() => (this._entries = []));
  }

  /** Returns the messages to send again, in order. */
  messages(): ChangeMessage[] {
    return this._entries.flatMap((entry): ChangeMessage[] =>
      entry.kind === "single"
        ? [entry.message]
        : [entry.begin, ...entry.parts, ...(entry.end ? [entry.end] : [])],
    );
  }

  private stroke(stroke: string): StrokeEntry | undefined {
    return this._entries.find(
      (entry): entry is StrokeEntry => entry.kind === "stroke" && entry.begin.stroke === stroke,
    );
  }

  /**
   * Applies a change and removes ended strokes whose batches are all saved. Returns the ids of the
   * removed messages, including messages in `besides`, which arrived in the meantime.
   */
  private shrink(change: () => void, besides: readonly ChangeMessage[] = []): string[] {
    const before = [...this.messages(), ...besides];
    change();
    this._entries = this._entries.filter(
      (entry) => entry.kind === "single" || entry.end === null || entry.parts.length > 0,
    );
    const left = new Set(this.messages());
    const gone = before.filter((message) => !left.has(message)).map((message) => message.id);
    if (gone.length > 0) this._dropped(gone);
    return gone;
  }
}
