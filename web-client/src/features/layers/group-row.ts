// The heading of a group in the list of layers. It folds the group, and shows or hides all of its
// layers.

import { css, html, nothing, type TemplateResult } from "lit";
import { groupNames } from "../../domain/layer-groups";
import type { Layer } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { askText } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";

export const groupRowStyles = css`
  li.group {
    display: flex;
    align-items: center;
    gap: var(--space-half);
    margin-top: var(--space-1);
  }
  li.group .fold {
    flex: 1;
    justify-content: flex-start;
    min-width: 0;
    padding: 0 var(--space-2);
    font-weight: 600;
  }
  .fold svg.glyph {
    width: 1rem;
    height: 1rem;
  }
  .fold[aria-expanded="true"] svg.glyph {
    transform: rotate(90deg);
  }
  .fold .count {
    color: var(--ink-soft);
    font-size: var(--text-small);
    font-weight: 400;
  }
  li.layer.inside {
    margin-inline-start: var(--space-4);
  }
`;

export interface GroupRow {
  session: ModelSession;
  name: string;
  /** All layers of the group, although the list may show only some of them. */
  layers: readonly Layer[];
  isFolded: boolean;
  /** Null while the group cannot be folded. */
  fold: (() => void) | null;
}

/** Renders the content of the group's list item. */
export function groupRow({ session, name, layers, isFolded, fold }: GroupRow): TemplateResult {
  const words = texts.layers;
  const visible = layers.some((layer) => session.layers.visible(layer));
  const label = visible ? words.hide(name) : words.show(name);
  return html`<button class="quiet fold" aria-expanded=${!isFolded} ?disabled=${!fold} title=${name} @click=${() => fold?.()}>
      ${icon("chevron")}<span class="ellipsis">${name}</span><span class="count">${layers.length}</span>
    </button>
    <button class="icon quiet" aria-pressed=${visible} aria-label=${label} title=${label} @click=${() => session.layers.setAllVisible(layers, !visible)}>
      ${icon(visible ? "eye" : "eye_off")}
    </button>
    ${
      session.canCurate
        ? html`<strata-menu label=${words.options(name)}>
            <button class="quiet" role="menuitem" @click=${() => void rename(session, name, layers)}>${icon("edit")}${words.group_rename}</button>
            <button class="quiet" role="menuitem" @click=${() => void regroup(session, layers, "")}>${icon("close")}${words.group_dissolve}</button>
          </strata-menu>`
        : nothing
    }`;
}

async function rename(
  session: ModelSession,
  name: string,
  layers: readonly Layer[],
): Promise<void> {
  const words = texts.layers;
  const answer = await askText({
    heading: words.group_rename,
    label: words.group,
    text: name,
    yes: texts.save,
  });
  const next = answer?.slice(0, kMaxGroup).trim();
  if (next && next !== name) await regroup(session, layers, next);
}

const kMaxGroup = 60; // maximum length of a group's name

/** Renders the field `group` of a form, with the names of the other groups as suggestions. */
export const groupField = (session: ModelSession, layer: Layer | undefined): TemplateResult =>
  html`<label class="field">
    <span>${texts.layers.group}</span>
    <input
      type="text"
      name="group"
      list="groups"
      maxlength=${kMaxGroup}
      autocomplete="off"
      .value=${layer?.group ?? ""}
      placeholder=${texts.layers.group_hint}
    />
    <datalist id="groups">${groupNames(session.layers.all).map((name) => html`<option value=${name}></option>`)}</datalist>
  </label>`;

/** Puts the layers into a group for all users. An empty name removes them from their group. */
export async function regroup(
  session: ModelSession,
  layers: readonly Layer[],
  group: string,
): Promise<void> {
  try {
    for (const layer of layers)
      if ((layer.group ?? "") !== group) await session.layers.change(layer, { group });
  } catch (error) {
    notices.error(error);
  }
}
