// Styles of the kiosk. All controls are in the lower half. Touch targets are at least 15 mm (57 CSS
// pixels), and larger on touch-only and large screens. Portrait screens show the object above the
// texts, and wide screens show it next to the texts. The text is readable at a distance of 2 m.

import { css } from "lit";

export const kioskStyles = css`
  :host {
    --target: max(60px, 5vmin);
    --gap: clamp(10px, 1.3vmin, 28px);
    --rim: clamp(16px, 2.8vmin, 64px);
    --round: clamp(22px, 2.6vmin, 56px);
    --room: #dedad3; /* background of the object, as drawn by the server */
    --room-top: #edebe7;
    --surface: color-mix(in srgb, var(--room) 22%, #fff);
    --raised: #fff;
    --ink: #20292a;
    --ink-soft: color-mix(in srgb, var(--ink) 80%, var(--surface));
    --line: color-mix(in srgb, var(--ink) 20%, var(--surface));
    --line-strong: color-mix(in srgb, var(--ink) 55%, var(--surface));
    --accent: #2c6a63;
    --accent-ink: #fff;
    --accent-soft: color-mix(in srgb, var(--accent) 16%, var(--raised));
    --heading: var(--serif);
    --shade: rgb(16 20 20 / 0.16);
    position: fixed;
    inset: 0;
    display: grid;
    --words: 38; /* largest part of the height for texts, in percent */
    grid-template: minmax(0, 1fr) auto / minmax(0, 1fr);
    background: var(--room); /* as at the lower end of the stage, so no edge is visible */
    color: var(--ink);
    font: clamp(17px, 1.75vmin + 8px, 48px) / 1.45 var(--sans);
    overflow: hidden;
    user-select: none;
    -webkit-user-select: none;
    -webkit-touch-callout: none;
    -webkit-tap-highlight-color: transparent;
    touch-action: none;
    overscroll-behavior: none;
    color-scheme: light;
  }
  :host([data-mode="dark"]) {
    color-scheme: dark;
    --raised: color-mix(in srgb, var(--room) 84%, #fff);
    --line: color-mix(in srgb, var(--ink) 26%, var(--surface));
    --shade: rgb(0 0 0 / 0.4);
  }
  @media (pointer: coarse) {
    :host {
      --target: max(68px, 5vmin);
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
    font: 600 1.9em/1.12 var(--heading);
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
    border-color: var(--accent);
    background: var(--accent-soft);
  }
  .layers button[aria-pressed="true"],
  button.main {
    border-color: var(--accent);
    background: var(--accent);
    color: var(--accent-ink);
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
  .logo {
    grid-area: 1 / 1;
    z-index: 1;
    place-self: start;
    max-width: min(38%, 26em);
    height: clamp(44px, 6vmin, 130px);
    margin: var(--rim);
    object-fit: contain;
    object-position: left top;
    pointer-events: none;
  }
  .phone {
    grid-area: 1 / 1;
    z-index: 1;
    place-self: end;
    width: clamp(96px, 12vmin, 240px);
    margin: var(--rim);
    padding: 0.3em;
    border-radius: calc(var(--round) / 2);
    background: #fff;
    color: #10181a;
    font: 600 clamp(12px, 1.4vmin, 26px) / 1.2 var(--sans);
    text-align: center;
    pointer-events: none;
  }
  .phone svg {
    display: block;
    width: 100%;
    height: auto;
    fill: #000;
    stroke: none;
  }
  .sign {
    grid-area: 1 / 1;
    justify-self: center;
    align-self: end;
    z-index: 1;
    margin: var(--rim);
    padding: 0.35em 1.1em;
    border-radius: 99px;
    background: color-mix(in srgb, var(--raised) 84%, transparent);
    font-size: 0.85em;
    text-align: center;
    pointer-events: none;
  }
  .phone ~ .sign {
    justify-self: start; /* the QR code is at the end */
    max-width: calc(100% - clamp(96px, 12vmin, 240px) - 4 * var(--rim));
    border-radius: var(--round);
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
  /* A dot at the tapped point, with the text above it, inside the stage. */
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
    background: var(--accent);
    box-shadow: 0 1px 6px rgb(0 0 0 / 0.4);
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
    box-shadow: 0 4px 24px rgb(0 0 0 / 0.24);
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
    max-height: calc(var(--words) * 1dvh); /* as tall as its text; longer text scrolls */
    display: flex;
    flex-direction: column;
    gap: var(--gap);
    padding: var(--rim);
    padding-bottom: max(var(--rim), env(safe-area-inset-bottom));
    border-radius: var(--round) var(--round) 0 0;
    background: var(--surface);
    box-shadow: 0 -8px 40px var(--shade);
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
  .words .where {
    display: flex;
    align-items: center;
    gap: 0.9em;
    margin: 0 0 0.2em;
    color: var(--ink-soft);
    font-size: 0.85em;
    font-variant-numeric: tabular-nums;
  }
  .choices {
    display: flex;
    flex: none;
    flex-wrap: wrap;
    gap: var(--gap) calc(2.5 * var(--gap));
  }
  .choices > .row {
    max-width: calc(100% + 2 * var(--rim));
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
  .choices > .row.scrolls:not(:first-child) {
    margin-inline-start: 0;
    padding-inline-start: 0;
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
  .row.languages {
    flex: 1 1 0;
    justify-content: safe center;
    gap: calc(var(--gap) / 2);
    min-width: 0;
    margin-inline: 0;
    padding-inline: 6px;
  }
  .row.languages button {
    padding-inline: 0.8em;
    font-size: 0.9em;
  }
  .steps > button {
    display: inline-flex;
    align-items: center;
    justify-content: center;
    gap: 0.4em;
    min-width: calc(2.2 * var(--target));
  }
  .dots {
    display: flex;
    gap: 0.35em;
  }
  .dots i {
    width: 1.5em;
    height: 0.28em;
    border-radius: 99px;
    background: var(--line-strong);
    opacity: 0.45;
  }
  .dots i.here {
    background: var(--accent);
    opacity: 1;
  }

  .card {
    position: absolute;
    inset: auto 0 0;
    z-index: 2;
    height: max(100%, calc(var(--words) * 1dvh)); /* over the lower part of the fixed image */
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
  .row.media button {
    min-height: clamp(72px, 9vmin, 190px);
  }
  .row.media img {
    display: block;
    height: clamp(72px, 9vmin, 190px);
  }
  .row.media :is(.sound, .video) {
    display: inline-flex;
    align-items: center;
    gap: 0.6em;
    padding: 0 1.2em;
    line-height: 1.2;
  }
  .row.media span {
    overflow: hidden;
    text-overflow: ellipsis;
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
    border-radius: var(--round);
    background: var(--raised);
    box-shadow: var(--shadow);
  }
  .count {
    font: 600 3.4em/1 var(--heading);
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
    background: var(--accent);
    color: var(--accent-ink);
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
  /* Without a visitor, the screen shows the object and its title on the background color, for
     passers-by. */
  .panel.resting {
    padding-top: 0;
    /* space for the invitation */
    padding-bottom: calc(2.2 * var(--rim) + 1.25 * var(--target) + 2em);
    background: none;
    box-shadow: none;
    text-align: center;
  }
  .panel.resting .words {
    flex: 0 1 auto;
    overflow: hidden;
  }
  .panel.resting h1 {
    font-size: 2.3em;
  }
  .panel.resting .words p {
    margin-inline: auto;
  }
  .panel.resting h1 + p {
    display: -webkit-box;
    overflow: hidden;
    -webkit-box-orient: vertical;
    -webkit-line-clamp: 3;
    line-clamp: 3;
    white-space: normal; /* without empty lines */
  }
  .words .tour {
    margin: 0 0 0.3em;
    color: var(--ink-soft);
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
      --gap: 8px;
    }
    .row.scrolls > .label,
    .phone {
      display: none;
    }
    .steps {
      flex-wrap: wrap;
    }
    .row.languages {
      flex-basis: 100%;
      order: -1;
      justify-content: start;
      margin-inline: calc(-1 * var(--rim));
      padding-inline: var(--rim);
    }
  }

  @media (orientation: landscape) {
    :host {
      grid-template: minmax(0, 1fr) / minmax(360px, 34fr) minmax(0, 66fr);
      background: linear-gradient(var(--room-top), var(--room)); /* next to the stage */
    }
    .steps {
      flex-wrap: wrap;
    }
    .row.languages {
      flex-basis: 100%;
      order: -1;
      justify-content: start;
      margin-inline: calc(-1 * var(--rim));
      padding-inline: var(--rim);
    }
    strata-kiosk-stage,
    .place-of-tap,
    .phone,
    .sign {
      grid-area: 1 / 2;
    }
    .panel {
      grid-area: 1 / 1;
      align-self: end;
      max-height: calc(100% - 2 * var(--rim));
      margin: var(--rim);
      margin-inline-end: 0;
      border-radius: var(--round);
      box-shadow: 0 8px 40px var(--shade);
    }
    .begin {
      inset-inline-end: auto;
      width: 34%;
      min-width: 360px;
      padding: calc(2.5 * var(--rim)) calc(2 * var(--rim));
      padding-inline-end: var(--rim);
    }
    .panel.resting h1 + p {
      -webkit-line-clamp: 5;
      line-clamp: 5;
    }
    .begin::before {
      position: fixed;
      inset: 0;
      content: "";
    }
  }
  @media (orientation: landscape) and (max-width: 1300px) {
    .row.scrolls > .label {
      display: none;
    }
    .steps > button {
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
