// Messages to the user, which <strata-notices> shows. A notice describes the event and the next
// step.

import { ApiError } from "../net/api-error";
import type { ProblemBody } from "../core/types";
import { texts } from "../texts";

export type NoticeKind = "info" | "success" | "problem";

export interface Notice {
  id: number;
  kind: NoticeKind;
  title: string;
  detail: string;
  link: NoticeLink | null;
}

/** A link or an action. */
export type NoticeLink = { label: string } & ({ href: string } | { act: () => void });

type Listener = (notices: readonly Notice[]) => void;

const kShownMs: Record<NoticeKind, number> = { info: 5000, success: 4000, problem: 12_000 };
const kShownToActMs = 12_000;
const kMostNotices = 4;

class Notices {
  private _notices: Notice[] = [];
  private _nextId = 1;
  private readonly _listeners = new Set<Listener>();

  subscribe(listener: Listener): () => void {
    this._listeners.add(listener);
    listener(this._notices);
    return () => this._listeners.delete(listener);
  }

  /** Shows a notice and returns its id. */
  show(kind: NoticeKind, title: string, detail = "", link: NoticeLink | null = null): number {
    // A notice replaces an earlier notice with the same text, unless the earlier notice has an
    // action.
    const same = this._notices.find(
      (notice) =>
        notice.title === title &&
        notice.detail === detail &&
        !(notice.link && "act" in notice.link),
    );
    if (same) this.dismiss(same.id);
    const notice = { id: this._nextId++, kind, title, detail, link };
    this._notices = [...this._notices, notice].slice(-kMostNotices);
    this.tell();
    setTimeout(
      () => this.dismiss(notice.id),
      link && "act" in link ? kShownToActMs : kShownMs[kind],
    );
    return notice.id;
  }

  problem(problem: Pick<ProblemBody, "title" | "detail" | "field">): void {
    this.show("problem", problem.title, problem.detail ?? "");
  }

  error(error: unknown): void {
    if (error instanceof ApiError) this.problem(error.problem);
    else this.show("problem", texts.problems.unexpected, texts.problems.unexpected_detail);
  }

  dismiss(id: number): void {
    const kept = this._notices.filter((notice) => notice.id !== id);
    if (kept.length === this._notices.length) return;
    this._notices = kept;
    this.tell();
  }

  private tell(): void {
    for (const listener of this._listeners) listener(this._notices);
  }
}

export const notices = new Notices();
