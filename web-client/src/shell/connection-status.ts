// The connection status on the model page. It shows whether all changes are saved, and a banner
// while the server or its database is unreachable.

import { html, nothing, type TemplateResult } from "lit";
import type { ModelSession } from "../session/model-session";
import { texts } from "../texts";
import { icon } from "../ui/icons";

export function savingStatus({ saving, connectionState }: ModelSession): TemplateResult {
  const { waiting, failing } = saving;
  const lost = connectionState !== "open";
  const state = waiting === 0 ? "saved" : failing || lost ? "not-saved" : "saving";
  const words = {
    saved: texts.saving.saved,
    saving: texts.saving.saving,
    "not-saved": texts.saving.not_saved(waiting),
  }[state];
  return html`<div
    class="saving ${state}"
    role="status"
    data-state=${state}
    title=${state === "not-saved" ? texts.saving.not_saved_hint : words}
  >
    ${icon(state === "saved" ? "check" : state === "saving" ? "cloud" : "warning")}<span>${words}</span>
  </div>`;
}

export function lostBanner(session: ModelSession): TemplateResult | typeof nothing {
  if (session.databaseLost) return databaseBanner(session);
  const reconnects = session.connectionState === "connecting" && session.view.framesDrawn > 0;
  if (session.connectionState !== "lost" && !reconnects) return nothing;
  const { waiting } = session.saving;
  const words = session.moved ? texts.connection.moved : texts.connection.lost;
  return html`<div class="banner" role="alert">
    ${icon("warning")}
    <span class="grow">${words} ${waiting > 0 ? texts.connection.kept(waiting) : ""}</span>
    <button @click=${() => session.checkConnection()}>${texts.connection.retry}</button>
  </div>`;
}

/** The view still works, and the page connects to another node by itself, so there is no button. */
function databaseBanner({ saving: { waiting } }: ModelSession): TemplateResult {
  const words = texts.connection;
  return html`<div class="banner" role="alert">
    ${icon("warning")}
    <span class="grow">${words.database_lost} ${waiting > 0 ? words.kept(waiting) : ""}</span>
  </div>`;
}
