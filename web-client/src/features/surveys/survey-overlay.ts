// <strata-survey-overlay>: another survey of the object next to the open one, on its side of a
// divider. The earlier survey is at the left.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { toldSurveyDate } from "../../domain/surveys";
import { FrameCanvas } from "../../net/frame-canvas";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { comparedStyles } from "../../ui/swipe-divider";
import { texts } from "../../texts";
import type { OtherSurvey } from "./other-survey";

const words = texts.surveys;

@customElement("strata-survey-overlay")
export class StrataSurveyOverlay extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("canvas") private _canvas!: HTMLCanvasElement | null;
  private _shown: OtherSurvey | null = null;

  constructor() {
    super();
    followSession(this, "surveys");
  }

  static override styles = [
    sharedStyles,
    comparedStyles,
    css`
      .label.right {
        right: 6rem; /* left of the cube and the bar on the stage */
      }
      @media (max-width: 820px) {
        .label {
          top: 7rem; /* below the date bar */
        }
        .label.right {
          right: 0.75rem;
        }
      }
    `,
  ];

  override updated(changed: PropertyValues<this>): void {
    super.updated(changed);
    const canvas = this._canvas;
    const other = canvas && this.session.surveys.other;
    if (other === this._shown) return;
    this.leaveFrames();
    this._shown = other;
    if (!other) return;
    const frames = new FrameCanvas(canvas, {
      drawn: (part) => other.frameDrawn(part),
      failed: (reason) => notices.show("problem", texts.problems.picture, reason),
    });
    other.onFrame = (part) => frames.push(part);
    other.onResetFrames = () => frames.reset();
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.requestUpdate();
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.leaveFrames();
  }

  /** The server draws no further frames without acknowledgments, also while none is shown. */
  private leaveFrames(): void {
    const shown = this._shown;
    this._shown = null;
    if (!shown) return;
    shown.onFrame = (part) => shown.frameDrawn(part);
    shown.onResetFrames = () => {};
  }

  override render(): TemplateResult | typeof nothing {
    const { surveys } = this.session;
    const { other, current, otherIsEarlier: isLeft } = surveys;
    if (!other || !current) return nothing;
    const share = surveys.divider * 100;
    const [left, right] = isLeft ? [other.survey, current] : [current, other.survey];
    const label = (survey: typeof left, side: "left" | "right"): TemplateResult => {
      const isOther = survey !== current;
      const text = [
        toldSurveyDate(survey.date),
        isOther && other.lost ? texts.connection.lost : "",
      ];
      return html`<span class="label ${side} ${isOther ? "" : "open"} ellipsis">${text.filter(Boolean).join(": ")}</span>`;
    };
    return html`<canvas
        width="2"
        height="2"
        ?hidden=${!other.drawn}
        ${styled({ "clip-path": isLeft ? `inset(0 ${100 - share}% 0 0)` : `inset(0 0 0 ${share}%)` })}
      ></canvas>
      ${label(left, "left")} ${label(right, "right")}
      ${other.drawn ? nothing : html`<p class="visually-hidden" role="status">${words.loading(toldSurveyDate(other.survey.date))}</p>`}
      <strata-swipe-divider
        label=${words.divider(toldSurveyDate(left.date), toldSurveyDate(right.date))}
        .share=${surveys.divider}
        @divide=${({ detail }: CustomEvent<number>) => surveys.setDivider(detail)}
      ></strata-swipe-divider>`;
  }
}
