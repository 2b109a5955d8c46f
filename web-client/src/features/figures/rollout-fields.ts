// The fields for the surface of a rollout, in the dialogs of pictures and figures.

import { css, html, nothing, type TemplateResult } from "lit";
import type { Model } from "../../core/types";
import { texts } from "../../texts";
import { numberInput } from "../../ui/number-input";
import {
  withAxisFields,
  wrongField,
  type RolloutField,
  type RolloutInput,
  type TypedPoint,
} from "./rollout-request";

const words = texts.rollouts;
const kSides = ["auto", "outside", "inside"] as const;
const kShapes = ["auto", "cylinder", "cone", "general_cylinder"] as const;
const kAxes = ["auto", "vertical", "own"] as const;

export const rolloutStyles = css`
  fieldset.point {
    display: grid;
    grid-template-columns: repeat(3, minmax(0, 1fr));
    gap: var(--space-1) var(--space-2);
    margin: 0;
    padding: 0;
    border: 0;
    min-width: 0;
  }
  fieldset.point > p {
    grid-column: 1 / -1;
  }
`;

/** Calls `change` with the whole input. */
export function rolloutFields(
  input: RolloutInput,
  model: Pick<Model, "bounds" | "up">,
  change: (input: RolloutInput) => void,
): TemplateResult {
  const set = (part: Partial<RolloutInput>): void => change({ ...input, ...part });
  const chooseAxis = (axis: RolloutInput["axis"]): void => {
    const next = { ...input, axis };
    change(axis === "own" ? withAxisFields(next, model) : next);
  };
  return html`<label class="field">
      <span>${words.side}</span>
      <select name="side" @change=${(event: Event) => set({ side: valueFor(event) as RolloutInput["side"] })}>
        ${kSides.map((side) => html`<option value=${side} ?selected=${side === input.side}>${words.sides[side]}</option>`)}
      </select>
    </label>
    <label class="field">
      <span>${words.shape}</span>
      <select name="shape" @change=${(event: Event) => set({ shape: valueFor(event) as RolloutInput["shape"] })}>
        ${kShapes.map((shape) => html`<option value=${shape} ?selected=${shape === input.shape}>${words.shapes[shape]}</option>`)}
      </select>
    </label>
    <label class="field">
      <span>${words.axis}</span>
      <select name="axis" @change=${(event: Event) => chooseAxis(valueFor(event) as RolloutInput["axis"])}>
        ${kAxes.map((axis) => html`<option value=${axis} ?selected=${axis === input.axis}>${words.axes[axis]}</option>`)}
      </select>
    </label>
    ${
      input.axis === "own"
        ? html`${pointFields("point", words.point, words.wrong_point, input, set)}
          ${pointFields("direction", words.direction, words.wrong_direction, input, set)}`
        : nothing
    }
    ${rolloutNumber("cut", `${words.cut} (°)`, words.cut_hint, words.wrong_cut, input, set)}
    <label class="check">
      <input type="checkbox" name="relief" .checked=${input.relief} @change=${(event: Event) => set({ relief: (event.target as HTMLInputElement).checked })} />
      ${words.relief}
    </label>`;
}

/** Returns a field for a number that may be empty. */
export function rolloutNumber(
  name: "cut" | "pixel",
  label: string,
  hint: string,
  problem: string,
  input: RolloutInput,
  set: (part: Partial<RolloutInput>) => void,
): TemplateResult {
  const wrong = wrongField(input) === name;
  return html`<label class="field">
    <span>${label}</span>
    ${numberInput({ value: input[name], name, wrong, typed: (text) => set({ [name]: text }) })}
    ${wrong ? html`<p class="error" role="alert">${problem}</p>` : html`<p class="hint">${hint}</p>`}
  </label>`;
}

function pointFields(
  name: Extract<RolloutField, "point" | "direction">,
  label: string,
  problem: string,
  input: RolloutInput,
  set: (part: Partial<RolloutInput>) => void,
): TemplateResult {
  const wrong = wrongField(input) === name;
  const typed = input[name];
  const write = (index: number, text: string): void => {
    const parts = typed.map((part, i) => (i === index ? text : part));
    set({ [name]: parts as unknown as TypedPoint });
  };
  return html`<fieldset class="point">
    <legend class="caption">${label}</legend>
    ${["x", "y", "z"].map((axis, index) =>
      numberInput({
        value: typed[index]!,
        name: `${name}_${axis}`,
        label: `${label}, ${axis}`,
        wrong,
        typed: (text) => write(index, text),
      }),
    )}
    ${wrong ? html`<p class="error" role="alert">${problem}</p>` : nothing}
  </fieldset>`;
}

const valueFor = (event: Event): string => (event.target as HTMLSelectElement).value;
