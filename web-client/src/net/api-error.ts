// Represents each failure of a call, including a lost network, as an error with a problem for the
// user.

import { ownProblems } from "../core/problems";
import type { ProblemBody } from "../core/types";

export class ApiError extends Error {
  constructor(readonly problem: ProblemBody) {
    super(problem.detail ?? problem.title);
    this.name = "ApiError";
  }
  get status(): number {
    return this.problem.status;
  }
}

export const cancelled = (): ApiError => new ApiError({ status: 499, title: "Cancelled" });

export function unreachable(): ApiError {
  const [title, detail] = ownProblems().unreachable;
  return new ApiError({ status: 0, title, detail });
}

/**
 * Returns the problem in a response's text. For other texts, returns a problem that describes the
 * status in plain words.
 */
export function problemOfText(status: number, text: string): ProblemBody {
  try {
    const body = JSON.parse(text) as Partial<ProblemBody> | null;
    if (body && typeof body.title === "string") {
      return {
        status: typeof body.status === "number" ? body.status : status,
        title: body.title,
        ...(body.detail ? { detail: String(body.detail) } : {}),
        ...(body.field ? { field: String(body.field) } : {}),
        ...(typeof body.offset === "number" ? { offset: body.offset } : {}),
        ...(typeof body.length === "number" ? { length: body.length } : {}),
        ...(Array.isArray(body.suggestions) ? { suggestions: body.suggestions.map(String) } : {}),
        ...(typeof body.reason === "string" ? { reason: body.reason } : {}),
        ...(body.rows ? { rows: body.rows } : {}),
      };
    }
  } catch {
    // The text is not JSON but a proxy's page, or it is empty. The status is sufficient.
  }
  const words = ownProblems();
  const [title, detail] = words.statuses[status] ?? [
    words.other_status(status),
    words.other_status_detail,
  ];
  return { status, title, detail };
}
