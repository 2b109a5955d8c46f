// Cell edits of this user that are not in the table yet: edits that are being saved, were refused,
// or conflict with another user's change.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecord, changeRecord, lastEditOf } from "../../net/records";
import { sameValue } from "../../domain/cells";
import type { CellValue, TableRecord } from "../../core/protocol.gen";
import { texts } from "../../texts";

export interface CellEdit {
  key: number;
  slug: string;
  /**
   * The values that the cell may have before the write: the displayed value, and values that this
   * user wrote later.
   */
  onto: CellValue[];
  value: CellValue;
  state: "saving" | "refused" | "conflict";
  problem: string;
  /** After a conflict, the cell's current value and its author. */
  theirs: { value: CellValue; user: string; time: string } | null;
}

export interface CellEditsHost {
  table: number;
  row(key: number): TableRecord | null;
  put(record: TableRecord): void;
  changed(): void;
}

const kMostTries = 3; // for simultaneous changes to other cells of the record
const idOf = (key: number, slug: string): string => `${key} ${slug}`;

export class CellEdits {
  private readonly _edits = new Map<string, CellEdit>();
  // keyed by record; changes run one at a time
  private readonly _chains = new Map<number, Promise<void>>();

  constructor(
    private readonly _api: Api,
    private readonly _host: CellEditsHost,
  ) {}

  of(key: number, slug: string): CellEdit | null {
    return this._edits.get(idOf(key, slug)) ?? null;
  }
  /** The edits that require the user's decision. */
  get open(): CellEdit[] {
    return [...this._edits.values()].filter((edit) => edit.state !== "saving");
  }
  get saving(): boolean {
    return this._edits.size > this.open.length;
  }

  write(key: number, slug: string, value: CellValue, base: CellValue): Promise<void> {
    const before = this.of(key, slug);
    const underWay = before?.state === "saving" ? before : null;
    if (sameValue(value, base)) {
      if (!underWay) this.forget(key, slug);
      return Promise.resolve();
    }
    const onto = underWay ? [...underWay.onto, underWay.value, base] : [base];
    return this.send({ key, slug, onto, value, state: "saving", problem: "", theirs: null });
  }

  /** Keeps the other user's value, or discards a refused edit. */
  forget(key: number, slug: string): void {
    if (this._edits.delete(idOf(key, slug))) this._host.changed();
  }

  /** Overwrites the other user's value. */
  insist(edit: CellEdit): Promise<void> {
    return this.send({
      ...edit,
      onto: [edit.theirs?.value ?? null],
      state: "saving",
      theirs: null,
    });
  }

  private send(edit: CellEdit): Promise<void> {
    this._edits.set(idOf(edit.key, edit.slug), edit);
    this._host.changed();
    const chain = (this._chains.get(edit.key) ?? Promise.resolve()).then(() => this.sendNow(edit));
    this._chains.set(edit.key, chain);
    return chain;
  }

  private async sendNow(edit: CellEdit): Promise<void> {
    const { key, slug, value } = edit;
    if (this.of(key, slug) !== edit) return; // the user has edited the cell again
    try {
      for (let tries = 1; ; ++tries) {
        const row =
          this._host.row(key) ?? (await readRecord(this._api, { table: this._host.table }, key));
        if (!edit.onto.some((value) => sameValue(row.values[slug], value))) {
          await this.tellConflict(edit, row);
          return;
        }
        try {
          this._host.put(
            await changeRecord(this._api, this._host.table, key, {
              version: row.version,
              values: { [slug]: value },
            }),
          );
          break;
        } catch (error) {
          if (!(error instanceof ApiError) || error.status !== 412 || tries === kMostTries)
            throw error;
          // the change may affect only another cell of the record
          this._host.put(await readRecord(this._api, { table: this._host.table }, key));
        }
      }
      if (this.of(key, slug) === edit) this.forget(key, slug);
    } catch (error) {
      edit.state = "refused";
      edit.problem = error instanceof ApiError ? error.message : texts.problems.unexpected;
      this._host.changed();
    }
  }

  private async tellConflict(edit: CellEdit, row: TableRecord): Promise<void> {
    const newest = await lastEditOf(this._api, this._host.table, edit.key);
    edit.state = "conflict";
    edit.theirs = {
      value: row.values[edit.slug] ?? null,
      user: newest?.user ?? "",
      time: newest?.time ?? "",
    };
    this._host.changed();
  }
}
