// Messages to the person, shown by <strata-notices>. A notice says what happened and what to do.

import { ApiError } from "../net/api";
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

/** Where it leads, or what it does. */
export type NoticeLink = { label: string } & ({ href: string } | { act: () => void });

type Listener = (notices: readonly Notice[]) => void;

const kShown_ms: Record<NoticeKind, number> = { info: 5000, success: 4000, problem: 12_000 };
const kShownToAct_ms = 12_000;
const kMostNotices = 4;

class Notices {
  private notices_: Notice[] = [];
  private next_id_ = 1;
  private readonly listeners_ = new Set<Listener>();

  subscribe(listener: Listener): () => void {
    this.listeners_.add(listener);
    listener(this.notices_);
    return () => this.listeners_.delete(listener);
  }

  /** Returns its id. */
  show(kind: NoticeKind, title: string, detail = "", link: NoticeLink | null = null): number {
    // what one may do stays
    const same = this.notices_.find(
      (notice) =>
        notice.title === title &&
        notice.detail === detail &&
        !(notice.link && "act" in notice.link),
    );
    if (same) this.dismiss(same.id);
    const notice = { id: this.next_id_++, kind, title, detail, link };
    this.notices_ = [...this.notices_, notice].slice(-kMostNotices);
    this.tell();
    setTimeout(
      () => this.dismiss(notice.id),
      link && "act" in link ? kShownToAct_ms : kShown_ms[kind],
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
    const kept = this.notices_.filter((notice) => notice.id !== id);
    if (kept.length === this.notices_.length) return;
    this.notices_ = kept;
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners_) listener(this.notices_);
  }
}

export const notices = new Notices();
