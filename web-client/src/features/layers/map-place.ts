// Parts of dialogs for the placement of a flat map: its viewing direction, and the position of a
// picture.

import { html, nothing, type TemplateResult } from "lit";
import { formatNumber } from "../../domain/measure";
import type { MapContents } from "../../core/types";
import { kAlong, type Along } from "../../domain/along";
import { texts } from "../../texts";

const words = texts.maps;

export const directionField = (chosen: Along, choose: (along: Along) => void): TemplateResult =>
  html`<label class="field">
    <span>${words.along}</span>
    <select name="along" @change=${(event: Event) => choose((event.target as HTMLSelectElement).value as Along)}>
      ${kAlong.map((along) => html`<option value=${along} ?selected=${along === chosen}>${words.direction[along]}</option>`)}
    </select>
  </label>`;

/**
 * Renders the field for the numbers of a world file, or a note if the picture contains its
 * position.
 */
export const worldField = (
  contents: MapContents,
  text: string,
  type: (text: string) => void,
): TemplateResult =>
  contents.world
    ? html`<p class="hint">${words.world_known}</p>`
    : html`<label class="field">
        <span>${words.world}</span>
        <textarea
          name="world"
          rows="2"
          placeholder="0.5, 0, 0, -0.5, 100, 200"
          .value=${text}
          @input=${(event: Event) => type((event.target as HTMLTextAreaElement).value)}
        ></textarea>
      </label>`;

/** Renders a line with a summary of the files. */
export function foundLine(contents: MapContents): TemplateResult {
  const { kind, polygons, columns, width, height, bands, bounds, crs } = contents;
  const parts =
    kind === "polygons"
      ? [words.polygons(polygons ?? 0), words.columns(columns?.length ?? 0)]
      : [`${width} × ${height} px`, ...(bands && !contents.is_rgb ? [words.bands(bands)] : [])];
  if (crs) parts.push(crs);
  const number = (value: number): string => formatNumber(value, 6);
  return html`<p class="found">
    ${parts.join(" · ")}${
      bounds
        ? html`<br /><span class="hint"
            >${words.bounds(number(bounds[0]), number(bounds[2]), number(bounds[1]), number(bounds[3]))}</span
          >`
        : nothing
    }
  </p>`;
}

export const progressLine = (share: number | null, after: string): TemplateResult =>
  html`<div role="status">
    <progress max="1" .value=${share ?? 0} ?hidden=${share === null}></progress>
    <p class="hint">${share === null || share >= 1 ? after : words.sending(Math.round(share * 100))}</p>
  </div>`;
