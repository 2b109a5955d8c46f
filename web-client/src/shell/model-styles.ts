import { css } from "lit";

export const modelStyles = css`
  :host {
    display: block;
  }
  .page {
    display: grid;
    grid-template:
      "header header header" 3.375rem
      "rail stage panel" minmax(0, 1fr)
      / auto minmax(0, 1fr) var(--panel);
    height: 100dvh;
    overflow: hidden;
  }
  .page.with-table {
    grid-template:
      "header header header" 3.375rem
      "rail stage panel" minmax(0, 1fr)
      "rail table panel" min(var(--table), 75dvh)
      / auto minmax(0, 1fr) var(--panel);
  }
  .page.without-panel {
    grid-template-columns: auto minmax(0, 1fr) 0;
  }
  .table {
    grid-area: table;
    position: relative;
    display: grid;
    min-width: 0;
    min-height: 0;
    border-top: var(--edge) solid var(--line-strong);
  }
  header {
    grid-area: header;
    display: flex;
    align-items: center;
    gap: var(--space-2);
    padding: 0 var(--space-3);
    border-bottom: var(--edge) solid var(--line);
    background: var(--surface);
  }
  .home {
    display: grid;
    place-items: center;
    flex: none;
    padding: var(--space-1);
    border-radius: var(--radius);
  }
  .logo {
    width: 2rem;
    height: 2rem;
  }
  h1 {
    font-size: var(--text-title-3);
    padding-left: var(--space-2);
  }
  .tools {
    display: contents;
  }
  strata-tool-rail {
    grid-area: rail;
  }
  main {
    grid-area: stage;
    position: relative;
    min-width: 0;
    min-height: 0;
  }
  strata-stage,
  strata-survey-overlay,
  strata-past-overlay {
    position: absolute;
    inset: 0 0 var(--past-height, 0) 0; /* above the history */
  }
  strata-comment-card {
    position: absolute;
    inset: 0;
    z-index: 4; /* over the pointer's readout */
    pointer-events: none;
  }
  header button.icon {
    position: relative;
  }
  .unread {
    position: absolute;
    top: 3px;
    right: 3px;
    width: 0.5625rem;
    height: 0.5625rem;
    border-radius: 50%;
    background: var(--news);
  }
  .scale-chip {
    min-height: var(--control-small);
    padding: 0 var(--space-3);
    border-color: transparent;
    border-radius: var(--radius-round);
    background: var(--warn-soft);
    color: var(--warn);
    font-size: var(--text-small);
    font-weight: 600;
  }
  .saving {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    padding: var(--space-1) var(--space-3) var(--space-1) var(--space-2);
    border-radius: var(--radius-round);
    font-size: var(--text-small);
    color: var(--ink-soft);
    white-space: nowrap;
  }
  .saving svg.glyph {
    width: 1.0625rem;
    height: 1.0625rem;
  }
  .saving.saved svg {
    color: var(--calm);
  }
  .saving.not-saved {
    background: var(--danger-soft);
    color: var(--danger);
    font-weight: 600;
  }
  strata-picture-bar {
    position: absolute;
    z-index: 2;
    top: 0.625rem;
    right: 0.625rem;
    max-width: calc(100% - 1.25rem);
    bottom: 0.625rem; /* does not receive clicks itself */
  }
  .banner {
    position: absolute;
    z-index: 5;
    top: 0.875rem;
    left: 50%;
    transform: translateX(-50%);
    display: flex;
    align-items: center;
    gap: var(--space-3);
    width: max-content;
    max-width: calc(100% - 1.75rem);
    padding: var(--space-2) var(--space-2) var(--space-2) var(--space-3);
    border: var(--edge) solid var(--warn);
    border-radius: var(--radius);
    background: var(--warn-soft);
    color: var(--warn);
    box-shadow: var(--shadow);
  }
  .banner button {
    color: var(--ink);
  }
  .readings {
    display: grid;
    gap: var(--space-2);
    justify-items: end;
    pointer-events: none;
    position: absolute;
    right: 4.75rem; /* left of the bar on the stage, which tall cards would otherwise cover */
    bottom: calc(0.875rem + var(--past-height, 0px));
    max-width: min(21.25rem, calc(100% - 17.625rem));
  }
  .splitter {
    position: absolute;
    z-index: 1;
    inset: 0 auto 0 0;
    width: 0.4375rem;
    cursor: col-resize;
    touch-action: none;
  }
  .splitter.across {
    inset: -3px 0 auto 0;
    z-index: 6;
    width: auto;
    height: 0.4375rem;
    cursor: row-resize;
  }
  .splitter:hover {
    background: var(--accent-soft);
  }
  aside {
    grid-area: panel;
    position: relative;
    min-height: 0;
    border-left: var(--edge) solid var(--line);
    background: var(--surface);
  }
  aside {
    display: grid;
    grid-template: auto auto minmax(0, 1fr) / minmax(0, 1fr);
  }
  .scroll {
    grid-row: 3; /* below the jobs, if there are any */
    position: relative; /* otherwise visually hidden content would lengthen the page */
    overflow: hidden auto;
    padding: 0 var(--space-3) var(--space-6);
  }
  aside section {
    padding: var(--space-4) 0 var(--space-4);
  }
  aside section + section {
    border-top: var(--edge) solid var(--line);
  }

  @media (max-width: 820px) {
    .page,
    .page.without-panel {
      grid-template:
        "header" 3.125rem
        "stage" minmax(0, 1fr)
        "panel" auto
        "chip" auto
        "rail" auto
        / minmax(0, 1fr);
    }
    .page.with-table {
      grid-template:
        "header" 3.125rem
        "stage" minmax(0, 1fr)
        "table" 52dvh
        "chip" auto
        "rail" auto
        / minmax(0, 1fr);
    }
    .page.with-table aside {
      display: none;
    }
    .splitter {
      display: none;
    }
    aside {
      max-height: 44dvh;
      border-left: 0;
      border-top: var(--edge) solid var(--line);
      border-radius: var(--radius-large) var(--radius-large) 0 0;
      box-shadow: var(--shadow-above);
      z-index: 2;
    }
    .scroll {
      padding: 0 var(--space-4) var(--space-2);
    }
    strata-tool-rail {
      padding-bottom: max(0.375rem, env(safe-area-inset-bottom));
      z-index: 3;
    }
    .saving span,
    .commands, /* available through the help */
    .scale-chip {
      display: none;
    }
    .saving.not-saved span {
      display: inline;
    }
    .people {
      padding: 0 var(--space-half) 0 var(--space-2);
    }
    .saving {
      padding: var(--space-1) var(--space-2);
    }
    header {
      gap: var(--space-half);
      padding: 0 var(--space-2);
    }
    h1 {
      font-size: var(--text-large);
    }
    .readings {
      z-index: 3; /* above the bar on the stage */
      right: 0.625rem;
      bottom: calc(0.625rem + var(--past-height, 0px));
      max-width: calc(100% - 1.25rem);
    }
  }
`;
