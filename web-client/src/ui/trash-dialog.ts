// <strata-bin-dialog>: the trash of a project, in which users restore or erase deleted items.
// openTrash() opens it.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import { formatBytes } from "../domain/measure";
import { called } from "../domain/people";
import type { BinEntry, BinList, Project } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { toldRestored } from "./trash";
import { ask } from "./dialog";
import { icon, type IconName } from "./icons";
import { notices } from "./notices";
import { rowList, rowListStyles, type ListedRow } from "./row-list";
import { sharedStyles } from "./styles";
import { texts } from "../texts";
import { toldAgo, toldDate } from "../domain/times";

const words = texts.bin;
const kAtOnce = 100;
const kIcons: Record<BinEntry["kind"], IconName> = {
  layer: "layers",
  model: "cube",
  record: "table",
};

@customElement("strata-bin-dialog")
export class StrataTrashDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) project!: Pick<Project, "slug" | "name">;
  answer: (isChanged: boolean) => void = () => {};

  @state() private _trash: BinList | null = null;
  @state() private _note: { kind: "error" | "done"; text: string } | null = null;
  @state() private _busy = false;
  private _changed = false;

  static override styles = [
    sharedStyles,
    rowListStyles,
    css`
      .done {
        color: var(--calm);
      }
      .more {
        justify-self: start;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt(() => this.read());
  }

  override render(): TemplateResult {
    const { _trash: trash, _note: note } = this;
    return html`<strata-dialog broad heading=${words.title_of(this.project.name)} way_out=${texts.close} @closed=${() => this.finish()}>
      ${trash ? html`<p class="hint">${trash.days === 0 ? words.not_kept_lead : words.lead(trash.days)}</p>` : nothing}
      <p class=${note?.kind ?? "done"} role=${note?.kind === "error" ? "alert" : "status"} tabindex="-1" ?hidden=${!note}>${note?.text}</p>
      ${
        trash
          ? this.entries(trash)
          : html`<p class="hint" role="status" ?hidden=${note !== null}>${texts.loading}</p>
            ${note ? html`<div><button @click=${() => void this.attempt(() => this.read())}>${texts.try_again}</button></div>` : nothing}`
      }
    </strata-dialog>`;
  }

  private entries({ entries, total }: BinList): TemplateResult {
    if (entries.length === 0) return html`<p>${words.none}</p>`;
    return html`${rowList(entries, (entry) => this.row(entry))}
      ${entries.length < total ? html`<button class="more" ?disabled=${this._busy} @click=${() => void this.attempt(() => this.readMore())}>${words.more}</button>` : nothing}`;
  }

  private row(entry: BinEntry): ListedRow {
    const { kind, name, user, full_name: fullName, deleted, erased, bytes } = entry;
    const where = entry.model_name ?? entry.table_name;
    const facts = [
      words.deleted_when(
        toldAgo(deleted),
        user === undefined
          ? undefined
          : called({ user, ...(fullName ? { full_name: fullName } : {}) }),
      ),
      words.erased_on(toldDate(erased)),
      bytes === undefined ? "" : formatBytes(bytes),
    ];
    return {
      name,
      glyph: icon(kIcons[kind]),
      about: html`<span class="hint">${kind === "model" || where === undefined ? words.kinds[kind] : words.where[kind](where)}</span>
        <span class="hint">${facts.filter(Boolean).join(" · ")}</span>`,
      tools: html`<button ?disabled=${this._busy} aria-label=${words.restore_of(name)} @click=${() => void this.restore(entry)}>${icon("undo")}${words.restore}</button>
        ${
          kind === "record"
            ? nothing
            : html`<button class="icon quiet" ?disabled=${this._busy} aria-label=${words.erase_of(name)} title=${words.erase} @click=${() => void this.erase(entry)}>${icon("trash")}</button>`
        }`,
    };
  }

  private async read(): Promise<void> {
    this._trash = await this.api.json("GET /projects/{project}/bin", {
      path: { project: this.project.slug },
      query: { limit: kAtOnce, offset: 0 },
    });
  }

  private async readMore(): Promise<void> {
    const known = this._trash?.entries ?? [];
    const next = await this.api.json("GET /projects/{project}/bin", {
      path: { project: this.project.slug },
      query: { limit: kAtOnce, offset: known.length },
    });
    const ids = new Set(known.map(({ id }) => id)); // new items may have shifted the entries
    this._trash = {
      ...next,
      entries: [...known, ...next.entries.filter(({ id }) => !ids.has(id))],
    };
  }

  private restore(entry: BinEntry): Promise<void> {
    return this.attempt(async () => {
      const restored = await this.api.json("POST /projects/{project}/bin/{entry}/restore", {
        path: { project: this.project.slug, entry: entry.id },
      });
      this.takeOut(entry, toldRestored(restored));
    });
  }

  private async erase(entry: BinEntry): Promise<void> {
    if (
      !(await ask({
        heading: words.erase_title(entry.name),
        lead: words.erase_lead,
        yes: words.erase_yes,
        danger: true,
      }))
    )
      return;
    await this.attempt(async () => {
      await this.api.send("DELETE /projects/{project}/bin/{entry}", {
        path: { project: this.project.slug, entry: entry.id },
      });
      this.takeOut(entry, words.erased(entry.name));
    });
  }

  /** Removes an item from the list. Moves the focus to the result, for keyboard users. */
  private takeOut({ id }: BinEntry, text: string): void {
    if (this._trash)
      this._trash = {
        ...this._trash,
        entries: this._trash.entries.filter((each) => each.id !== id),
        total: this._trash.total - 1,
      };
    this._changed = true;
    this._note = { kind: "done", text };
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLElement>("p[tabindex]")?.focus(),
    );
  }

  private async attempt(task: () => Promise<void>): Promise<void> {
    if (this._busy) return;
    this._busy = true;
    this._note = null;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._note = { kind: "error", text: error.message };
      // Another user may have restored or erased the item first.
      if (error.status === 404 && this._trash) await this.read().catch(() => {});
    } finally {
      this._busy = false;
    }
  }

  private finish(): void {
    this.answer(this._changed);
    this.remove();
  }
}

/** Opens the trash of a project. Resolves to true if an item was restored or erased. */
export function openTrash(api: Api, project: Pick<Project, "slug" | "name">): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataTrashDialog();
    Object.assign(element, { api, project, answer: resolve });
    document.body.append(element);
  });
}

/** Opens the trash of the open model's project. */
export async function openTrashOf({
  api,
  model,
}: {
  api: Api;
  model: Pick<Model, "project"> | null;
}): Promise<void> {
  if (!model) return;
  try {
    await openTrash(
      api,
      (await api.versioned("GET /projects/{project}", { path: { project: model.project } })).value,
    );
  } catch (error) {
    notices.error(error);
  }
}
