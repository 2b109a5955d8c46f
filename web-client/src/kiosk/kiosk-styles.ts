// Styles of the kiosk: large and calm, with all controls in the lower half. Targets are at least 15
// mm (57 CSS pixels), and larger on touch-only screens. Upright screens have the object above the
// texts, wide screens next to them.

import { css } from "lit";

export const kioskStyles = css`
  :host {
    --target: 60px;
    --gap: clamp(10px, 1.3vmin, 20px);
    --rim: clamp(16px, 2.6vmin, 44px);
    position: fixed;
    inset: 0;
    display: grid;
    --words: 40; /* largest share of the height for texts, in percent */
    grid-template: minmax(0, 1fr) auto / minmax(0, 1fr);
    background: linear-gradient(rgb(241 240 236), rgb(214 211 204)); /* the server's background */
    color: var(--ink);
    font: clamp(17px, 1.7vmin + 7px, 34px) / 1.5 var(--sans);
    overflow: hidden;
    user-select: none;
    -webkit-user-select: none;
    -webkit-touch-callout: none;
    -webkit-tap-highlight-color: transparent;
    touch-action: none;
    overscroll-behavior: none;
  }
  @media (pointer: coarse) {
    :host {
      --target: 68px;
    }
  }
  * {
    box-sizing: border-box;
  }
  h1,
  h2,
  p,
  dl,
  dd {
    margin: 0;
  }
  h1,
  h2 {
    font: 600 1.75em/1.15 var(--serif);
    letter-spacing: -0.01em;
    text-wrap: balance;
    outline: none;
  }
  button {
    min-width: var(--target);
    min-height: var(--target);
    padding: 0.3em 1em;
    border: 2px solid var(--line);
    border-radius: calc(var(--target) / 2);
    background: var(--raised);
    color: var(--ink);
    font: 600 1em/1.2 var(--sans);
    touch-action: manipulation;
  }
  button:active {
    background: var(--accent-soft);
  }
  button:focus-visible {
    outline: 4px solid var(--accent);
    outline-offset: 3px;
  }
  button[aria-pressed="true"] {
    border-color: var(--calm);
    color: var(--calm);
    background: var(--calm-soft);
  }
  .layers button[aria-pressed="true"],
  button.main {
    border-color: var(--calm);
    background: var(--calm);
    color: var(--calm-ink);
  }
  button:disabled {
    visibility: hidden;
  }
  svg {
    width: 1.4em;
    height: 1.4em;
    flex: none;
    fill: none;
    stroke: currentColor;
    stroke-width: 2;
    stroke-linecap: round;
    stroke-linejoin: round;
  }
  .turns:dir(rtl) {
    transform: scaleX(-1);
  }

  strata-kiosk-stage {
    grid-area: 1 / 1;
  }
  .sign {
    grid-area: 1 / 1;
    justify-self: center;
    align-self: end;
    z-index: 1;
    margin: var(--rim);
    padding: 0.35em 1.1em;
    border-radius: 99px;
    background: rgb(255 255 255 / 0.8);
    font-size: 0.85em;
    text-align: center;
    pointer-events: none;
  }
  .sign.away {
    align-self: start;
  }
  .place-of-tap {
    grid-area: 1 / 1;
    position: relative;
    z-index: 1;
    overflow: hidden;
    pointer-events: none;
  }
  /* a dot at the tapped place, and the text above it, inside the stage */
  .place-of-tap::before {
    content: "";
    position: absolute;
    left: calc(var(--x) - 0.45em);
    top: calc(var(--y) - 0.45em);
    width: 0.9em;
    height: 0.9em;
    box-sizing: border-box;
    border: 3px solid #fff;
    border-radius: 50%;
    background: var(--calm);
    box-shadow: 0 1px 6px rgb(32 41 42 / 0.4);
  }
  .place-of-tap p {
    position: absolute;
    left: clamp(9.5em, var(--x), 100% - 9.5em);
    bottom: clamp(0.5em, 100% - var(--y) + 1em, 100% - 5em);
    display: grid;
    width: max-content;
    max-width: 18em;
    padding: 0.45em 1em;
    border-radius: 1em;
    background: var(--raised);
    box-shadow: 0 4px 24px rgb(32 41 42 / 0.24);
    text-align: center;
    line-height: 1.25;
    overflow-wrap: anywhere;
    transform: translateX(-50%);
  }
  .place-of-tap span {
    color: var(--ink-soft);
    font-size: 0.8em;
  }

  .panel {
    grid-area: 2 / 1;
    position: relative;
    max-height: calc(var(--words) * 1dvh); /* as tall as its text; a longer text scrolls */
    display: flex;
    flex-direction: column;
    gap: var(--gap);
    padding: var(--rim);
    padding-bottom: max(var(--rim), env(safe-area-inset-bottom));
    border-radius: 28px 28px 0 0;
    background: var(--surface);
    box-shadow: 0 -8px 40px rgb(32 41 42 / 0.1);
    touch-action: pan-y;
  }
  .words {
    flex: 1 1 auto;
    min-height: 0;
    overflow-y: auto;
    overscroll-behavior: contain;
    scrollbar-width: thin;
    touch-action: pan-y;
  }
  .words p {
    margin-top: 0.5em;
    max-width: 42em;
    white-space: pre-line;
    overflow-wrap: anywhere;
  }
  .where {
    color: var(--ink-soft);
    font-size: 0.85em;
    font-variant-numeric: tabular-nums;
  }
  .row {
    display: flex;
    flex: none;
    align-items: center;
    gap: var(--gap);
  }
  .row.scrolls {
    overflow: auto hidden;
    overscroll-behavior: contain;
    scrollbar-width: none;
    touch-action: pan-x;
    margin: -6px calc(-1 * var(--rim));
    padding: 6px var(--rim);
  }
  .row.layers {
    touch-action: pan-y; /* a horizontal swipe selects the next layer */
  }
  .row.scrolls button {
    flex: none;
    max-width: 18em;
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
  }
  .row.scrolls > .label {
    flex: none;
    color: var(--ink-soft);
    font-size: 0.85em;
  }
  .steps {
    justify-content: space-between;
  }
  .steps button {
    display: inline-flex;
    align-items: center;
    justify-content: center;
    gap: 0.4em;
    min-width: calc(2.2 * var(--target));
  }
  .dots {
    display: flex;
    flex-wrap: wrap;
    justify-content: center;
    gap: 0.5em;
  }
  .dots i {
    width: 0.5em;
    height: 0.5em;
    border-radius: 50%;
    background: var(--line-strong);
    opacity: 0.45;
  }
  .dots i.here {
    background: var(--calm);
    opacity: 1;
    transform: scale(1.5);
  }

  .card {
    position: absolute;
    inset: auto 0 0;
    z-index: 2;
    height: max(100%, calc(var(--words) * 1dvh)); /* over the bottom of the fixed picture */
    display: flex;
    flex-direction: column;
    gap: var(--gap);
    padding: inherit;
    border-radius: inherit;
    background: var(--raised);
  }
  .card dl {
    display: grid;
    grid-template-columns: minmax(6em, auto) minmax(0, 1fr);
    gap: 0.3em 1.4em;
    margin-top: 0.7em;
  }
  .card dt {
    color: var(--ink-soft);
  }
  .card dd {
    overflow-wrap: anywhere;
    white-space: pre-line;
  }
  .pictures button {
    padding: 0;
    border-radius: 14px;
    overflow: hidden;
    line-height: 0;
  }
  .pictures img {
    height: clamp(96px, 14vmin, 220px);
    min-width: var(--target);
    object-fit: cover;
    pointer-events: none;
  }
  .ends {
    justify-content: flex-end;
  }

  .over {
    position: fixed;
    inset: 0;
    z-index: 5;
    display: flex;
    flex-direction: column;
    align-items: center;
    justify-content: flex-end;
    gap: calc(2 * var(--gap));
    padding: calc(2 * var(--rim));
    text-align: center;
  }
  .enlarged {
    background: rgb(16 20 20 / 0.94);
  }
  .enlarged img {
    flex: 1;
    min-height: 0;
    max-width: 100%;
    object-fit: contain;
  }
  .asking {
    background: rgb(20 24 24 / 0.45);
  }
  .asking section {
    display: grid;
    gap: calc(1.5 * var(--gap));
    justify-items: center;
    width: min(100%, 26em);
    margin-bottom: 4vh;
    padding: calc(1.2 * var(--rim)) var(--rim);
    border-radius: 28px;
    background: var(--raised);
    box-shadow: var(--shadow);
  }
  .count {
    font: 600 3.4em/1 var(--serif);
    color: var(--calm);
    font-variant-numeric: tabular-nums;
  }

  .begin {
    position: fixed;
    inset: 0;
    z-index: 4;
    display: flex;
    flex-direction: column;
    justify-content: flex-end;
    align-items: center;
    gap: 0.5em;
    padding: var(--rim);
    padding-bottom: calc(1.5 * var(--rim));
    border: 0;
    border-radius: 0;
    background: none;
  }
  .begin:active {
    background: none;
  }
  .begin:focus-visible {
    outline-offset: -8px;
  }
  .begin b {
    display: grid;
    place-items: center;
    min-height: calc(1.25 * var(--target));
    padding: 0.3em 2em;
    border-radius: 99px;
    background: var(--calm);
    color: var(--calm-ink);
    font-size: 1.15em;
    animation: breathe 4s ease-in-out infinite;
  }
  .begin span {
    color: var(--ink-soft);
    font-size: 0.85em;
    font-weight: 400;
    text-wrap: balance;
  }
  @keyframes breathe {
    50% {
      transform: scale(1.035);
    }
  }
  @media (prefers-reduced-motion: reduce) {
    .begin b {
      animation: none;
    }
  }
  .panel.resting {
    padding-bottom: calc(2.5 * var(--rim) + 1.25 * var(--target) + 3em); /* for the invitation */
    text-align: center;
  }
  .panel.resting .words {
    flex: 0 1 auto;
    margin-block: auto;
    overflow: hidden;
  }
  .panel.resting .words p {
    margin-inline: auto;
  }
  .tour {
    color: var(--accent);
    font: 600 0.95em var(--sans);
    letter-spacing: 0.02em;
  }

  .alone {
    grid-area: 1 / 1 / -1 / -1;
    place-self: center;
    display: grid;
    gap: 0.8em;
    max-width: 32em;
    padding: var(--rim);
    text-align: center;
  }

  @media (orientation: portrait) and (max-height: 1300px) {
    :host {
      --words: 50;
    }
  }
  @media (max-width: 600px) and (orientation: portrait) {
    :host {
      --target: 58px;
      --words: 58;
    }
    .dots,
    .row.scrolls > .label {
      display: none;
    }
  }

  @media (orientation: landscape) {
    :host {
      grid-template: minmax(0, 1fr) / minmax(360px, 36fr) minmax(0, 64fr);
    }
    strata-kiosk-stage,
    .place-of-tap,
    .sign {
      grid-area: 1 / 2;
    }
    .panel {
      grid-area: 1 / 1;
      align-self: end;
      max-height: calc(100% - 2 * var(--rim));
      margin: var(--rim);
      margin-inline-end: 0;
      border-radius: 28px;
      box-shadow: 0 8px 40px rgb(32 41 42 / 0.12);
    }
    .begin {
      inset-inline-end: auto;
      width: 36%;
      min-width: 360px;
      padding: calc(2.5 * var(--rim)) calc(2 * var(--rim));
      padding-inline-end: var(--rim);
    }
    .begin::before {
      position: fixed;
      inset: 0;
      content: "";
    }
  }
  @media (orientation: landscape) and (max-width: 1300px) {
    .dots,
    .row.scrolls > .label {
      display: none;
    }
    .steps button {
      min-width: calc(1.6 * var(--target));
      padding-inline: 0.8em;
    }
  }
  @media (orientation: landscape) and (max-height: 560px) {
    :host {
      --rim: 8px;
      --gap: 6px;
      --target: 58px;
    }
    .panel {
      overflow-y: auto;
    }
    .panel > .words {
      flex: none;
    }
  }
`;
