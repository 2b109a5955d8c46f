// Rules for the audit log that need no request to the server.

import type { AuditAction, AuditEntry } from "../core/protocol.gen";

/** All actions, in the order of the filter. The compiler reports a missing or unknown action. */
const kOrder: Record<AuditAction, true> = {
  sign_in: true,
  sign_in_failed: true,
  sign_out: true,
  password_changed: true,
  account_created: true,
  account_deleted: true,
  account_renamed: true,
  account_disabled: true,
  account_enabled: true,
  role_changed: true,
  member_added: true,
  member_removed: true,
  group_created: true,
  group_renamed: true,
  token_created: true,
  token_revoked: true,
  link_created: true,
  oidc_bound: true,
  export: true,
  deletion: true,
  erased: true,
  restored: true,
  visibility_changed: true,
  kiosk_created: true,
  kiosk_changed: true,
  kiosk_deleted: true,
  setting_changed: true,
  audit_purged: true,
};
export const kAuditActions = Object.keys(kOrder) as AuditAction[];

/** The entered filter. Days are as in date fields (2026-05-04), in the browser's time zone. */
export interface AuditFilter {
  actor: string;
  action: AuditAction | "";
  from: string;
  to: string; // the last day
}
export const kNoFilter: AuditFilter = { actor: "", action: "", from: "", to: "" };

export const isFiltered = (filter: AuditFilter): boolean =>
  Object.values(filter).some((value) => value !== "");

/** The query of the call for these rows. */
export interface AuditQuery {
  actor?: string;
  action?: AuditAction;
  from?: string;
  to?: string;
}

/** Returns the time at which the day begins, or the day `later` days after it. */
function beginOf(day: string, later = 0): string | null {
  const [, year, month, date] = /^(\d{4})-(\d\d)-(\d\d)$/.exec(day) ?? [];
  if (date === undefined) return null;
  const begin = new Date(Number(year), Number(month) - 1, Number(date) + later);
  return Number.isNaN(begin.getTime()) ? null : begin.toISOString();
}

export function queryOf({ actor, action, from, to }: AuditFilter): AuditQuery {
  const query: AuditQuery = {};
  if (actor.trim()) query.actor = actor.trim();
  if (action) query.action = action;
  const first = beginOf(from);
  const end = beginOf(to, 1);
  if (first) query.from = first;
  if (end) query.to = end;
  return query;
}

/** Returns the change of a role, a visibility or a setting: "viewer → curator". */
export function changeIn({ details }: AuditEntry, nameOf: (value: string) => string): string {
  const [before, after] = (["before", "after"] as const).map((key) => {
    const value = details[key];
    return value === undefined ? "" : nameOf(value.toString());
  });
  return before && after ? `${before} → ${after}` : before || after || "";
}
