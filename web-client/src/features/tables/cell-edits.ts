// Cells that this person wrote and that are not in the table yet: on their way, refused, or changed
// by somebody else meanwhile.

import { ApiError, type Api } from "../../net/api";
import { same_value } from "../../domain/cells";
import type { CellValue, TableRecord } from "../../core/protocol.gen";
import { texts } from "../../texts";

export interface CellEdit {
  key: number;
  slug: string;
  /**
   * What the cell may hold that it goes onto: as the person saw it, and what they wrote into it
   * since.
   */
  onto: CellValue[];
  value: CellValue;
  state: "saving" | "refused" | "conflict";
  problem: string;
  /** Of a conflict: what the cell holds now, and who wrote it. */
  theirs: { value: CellValue; user: string; time: string } | null;
}

export interface CellEditsHost {
  table: number;
  row(key: number): TableRecord | null;
  put(record: TableRecord): void;
  changed(): void;
}

const kMostTries = 3; // where others write other cells of the record at the same time
const id_of = (key: number, slug: string): string => `${key} ${slug}`;

export class CellEdits {
  private readonly edits_ = new Map<string, CellEdit>();
  // by record: one change after the other
  private readonly chains_ = new Map<number, Promise<void>>();

  constructor(
    private readonly api_: Api,
    private readonly host_: CellEditsHost,
  ) {}

  of(key: number, slug: string): CellEdit | null {
    return this.edits_.get(id_of(key, slug)) ?? null;
  }
  /** Those that wait for the person. */
  get open(): CellEdit[] {
    return [...this.edits_.values()].filter((edit) => edit.state !== "saving");
  }
  get saving(): boolean {
    return this.edits_.size > this.open.length;
  }

  write(key: number, slug: string, value: CellValue, base: CellValue): Promise<void> {
    const before = this.of(key, slug);
    const under_way = before?.state === "saving" ? before : null;
    if (same_value(value, base)) {
      if (!under_way) this.forget(key, slug);
      return Promise.resolve();
    }
    const onto = under_way ? [...under_way.onto, under_way.value, base] : [base];
    return this.send({ key, slug, onto, value, state: "saving", problem: "", theirs: null });
  }

  /** Theirs stays, or what was refused is given up. */
  forget(key: number, slug: string): void {
    if (this.edits_.delete(id_of(key, slug))) this.host_.changed();
  }

  /** Mine goes over theirs. */
  insist(edit: CellEdit): Promise<void> {
    return this.send({
      ...edit,
      onto: [edit.theirs?.value ?? null],
      state: "saving",
      theirs: null,
    });
  }

  private send(edit: CellEdit): Promise<void> {
    this.edits_.set(id_of(edit.key, edit.slug), edit);
    this.host_.changed();
    const chain = (this.chains_.get(edit.key) ?? Promise.resolve()).then(() => this.send_now(edit));
    this.chains_.set(edit.key, chain);
    return chain;
  }

  private async send_now(edit: CellEdit): Promise<void> {
    const { key, slug, value } = edit;
    if (this.of(key, slug) !== edit) return; // written again since
    try {
      for (let tries = 1; ; ++tries) {
        const row =
          this.host_.row(key) ?? (await this.api_.record({ table: this.host_.table }, key));
        if (!edit.onto.some((value) => same_value(row.values[slug], value))) {
          await this.tell_conflict(edit, row);
          return;
        }
        try {
          this.host_.put(
            await this.api_.change_record(this.host_.table, key, {
              version: row.version,
              values: { [slug]: value },
            }),
          );
          break;
        } catch (error) {
          if (!(error instanceof ApiError) || error.status !== 412 || tries === kMostTries)
            throw error;
          // another cell of it may be all that changed
          this.host_.put(await this.api_.record({ table: this.host_.table }, key));
        }
      }
      if (this.of(key, slug) === edit) this.forget(key, slug);
    } catch (error) {
      edit.state = "refused";
      edit.problem = error instanceof ApiError ? error.message : texts.problems.unexpected;
      this.host_.changed();
    }
  }

  private async tell_conflict(edit: CellEdit, row: TableRecord): Promise<void> {
    const [newest] = await this.api_.record_edits(this.host_.table, edit.key, 1);
    edit.state = "conflict";
    edit.theirs = {
      value: row.values[edit.slug] ?? null,
      user: newest?.user ?? "",
      time: newest?.time ?? "",
    };
    this.host_.changed();
  }
}
