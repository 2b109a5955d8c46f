// Facts that a user needs before editing a layer: the users who can change it, and whether edits
// are reviewed.

import { html, nothing, type TemplateResult } from "lit";
import { isAsComputed, type Layer } from "../../core/types";
import type { LayerAnalysis } from "../../core/protocol.gen";
import { unlockLabel } from "../../session/layer-lock";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { texts } from "../../texts";

export function whoIsLocked(session: ModelSession, layer: Layer): string {
  const words = texts.layers;
  if (isAsComputed(layer)) return words.locked_computed;
  return session.isLocked(layer) ? words.locked_to_you : words.locked_to_others;
}

export function layerNotes(
  session: ModelSession,
  layer: Layer,
  unlock: () => void,
): TemplateResult {
  return html`${layer.locked ? lockNote(session, layer, unlock) : nothing} ${layer.edited_by_hand === true ? handNote(layer) : nothing}
  ${layer.review ? reviewNote(session, layer) : nothing} ${layer.analysis ? analysisNote(layer.analysis) : nothing}`;
}

const lockNote = (session: ModelSession, layer: Layer, unlock: () => void): TemplateResult =>
  html`<p class="locked">
    ${icon("lock")}<span>${whoIsLocked(session, layer)}</span>
    ${session.canCurate ? html`<button class="link" @click=${unlock}>${unlockLabel(layer)}</button>` : nothing}
  </p>`;

const handNote = (layer: Layer): TemplateResult =>
  html`<p class="locked by-hand">
    ${icon("edit")}<span>${layer.expression === undefined ? texts.layers.by_hand : `${texts.layers.by_hand} ${texts.layers.by_hand_formula}`}</span>
  </p>`;

const analysisNote = ({ name, step, of }: LayerAnalysis): TemplateResult =>
  html`<p class="locked">${icon("chart")}<span>${texts.layers.in_analysis(step, of, name)}</span></p>`;

function reviewNote({ canCurate, reviews }: ModelSession, layer: Layer): TemplateResult {
  const waiting = reviews.waitingOn(layer);
  return html`<p class="locked">
    ${icon("shield")}<span>${canCurate ? texts.review.asked : texts.review.asked_of_you} ${waiting > 0 ? texts.review.waiting(waiting) : nothing}</span>
  </p>`;
}
