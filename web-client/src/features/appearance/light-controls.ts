// <strata-light-controls>: the kind and direction of the light in this user's view.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { LightMode, Point3 } from "../../core/protocol.gen";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/light-pad";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./light-sliders";
import { controlStyles } from "./control-styles";

const kLights: readonly LightMode[] = ["museum", "headlight", "raking", "unlit"];

@customElement("strata-light-controls")
export class StrataLightControls extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "appearance");
  }

  static override styles = [sharedStyles, controlStyles];

  override render(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    return html`${radioGroup({
      label: words.light,
      class: "segments",
      choices: kLights.map((mode) => ({
        value: mode,
        content: words.lights[mode],
        title: words.light_hints[mode],
      })),
      chosen: appearance.light.mode,
      choose: (mode) => appearance.setLight({ mode }),
    })}
      ${
        appearance.light.mode === "raking"
          ? html`<strata-light-pad
            .direction=${appearance.light.direction}
            @direction=${(event: CustomEvent<Point3>) => appearance.setLight({ direction: event.detail })}
          ></strata-light-pad>`
          : nothing
      }
      <strata-light-sliders .session=${this.session}></strata-light-sliders>`;
  }
}
