import { css } from "lit";

export const model_styles = css`
  :host {
    display: block;
  }
  .page {
    display: grid;
    grid-template:
      "header header header" 54px
      "rail stage panel" minmax(0, 1fr)
      / auto minmax(0, 1fr) var(--panel);
    height: 100dvh;
    overflow: hidden;
  }
  .page.with-table {
    grid-template:
      "header header header" 54px
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
    gap: 8px;
    padding: 0 12px;
    border-bottom: var(--edge) solid var(--line);
    background: var(--surface);
  }
  .home {
    display: grid;
    place-items: center;
    flex: none;
    padding: 4px;
    border-radius: 9px;
  }
  .logo {
    width: 32px;
    height: 32px;
  }
  h1 {
    font-size: 1.15rem;
    padding-left: 6px;
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
  strata-stage {
    position: absolute;
    inset: 0;
  }
  strata-comment-card {
    position: absolute;
    inset: 0;
    z-index: 4; /* over what tells of the pointer */
    pointer-events: none;
  }
  header button.icon {
    position: relative;
  }
  .unread {
    position: absolute;
    top: 3px;
    right: 3px;
    width: 9px;
    height: 9px;
    border-radius: 50%;
    background: var(--news);
  }
  .scale-chip {
    min-height: 28px;
    padding: 0 12px;
    border-color: transparent;
    border-radius: 99px;
    background: var(--warn-soft);
    color: var(--warn);
    font-size: 0.84rem;
    font-weight: 600;
  }
  .saving {
    display: flex;
    align-items: center;
    gap: 6px;
    padding: 4px 11px 4px 8px;
    border-radius: 99px;
    font-size: 0.86rem;
    color: var(--ink-soft);
    white-space: nowrap;
  }
  .saving svg.glyph {
    width: 17px;
    height: 17px;
  }
  .saving.saved svg {
    color: var(--calm);
  }
  .saving.not-saved {
    background: var(--danger-soft);
    color: var(--danger);
    font-weight: 600;
  }
  .banner {
    position: absolute;
    z-index: 5;
    top: 14px;
    left: 50%;
    transform: translateX(-50%);
    display: flex;
    align-items: center;
    gap: 12px;
    width: max-content;
    max-width: calc(100% - 28px);
    padding: 8px 8px 8px 14px;
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
    gap: 8px;
    justify-items: end;
    pointer-events: none;
    position: absolute;
    right: 14px;
    bottom: 14px;
    max-width: min(340px, calc(100% - 220px));
  }
  .splitter {
    position: absolute;
    z-index: 1;
    inset: 0 auto 0 0;
    width: 7px;
    cursor: col-resize;
    touch-action: none;
  }
  .splitter.across {
    inset: -3px 0 auto 0;
    z-index: 6;
    width: auto;
    height: 7px;
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
  .scroll {
    position: relative; /* what is hidden for eyes in it would lengthen the page otherwise */
    height: 100%;
    overflow: hidden auto;
    padding: 0 14px 24px;
  }
  aside section {
    padding: 15px 0 17px;
  }
  aside section + section {
    border-top: var(--edge) solid var(--line);
  }

  @media (max-width: 820px) {
    .page,
    .page.without-panel {
      grid-template:
        "header" 50px
        "stage" minmax(0, 1fr)
        "panel" auto
        "rail" auto
        / minmax(0, 1fr);
    }
    .page.with-table {
      grid-template:
        "header" 50px
        "stage" minmax(0, 1fr)
        "table" 52dvh
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
      display: grid;
      max-height: 44dvh;
      border-left: 0;
      border-top: var(--edge) solid var(--line);
      border-radius: 16px 16px 0 0;
      box-shadow: var(--shadow-above);
      z-index: 2;
    }
    .scroll {
      padding: 0 16px 10px;
    }
    strata-tool-rail {
      padding-bottom: max(6px, env(safe-area-inset-bottom));
      z-index: 3;
    }
    .saving span,
    .scale-chip {
      display: none;
    }
    .saving.not-saved span {
      display: inline;
    }
    .people {
      padding: 0 2px 0 9px;
    }
    .saving {
      padding: 4px 6px;
    }
    header {
      gap: 2px;
      padding: 0 6px;
    }
    h1 {
      font-size: 1.02rem;
    }
    .readings {
      right: 10px;
      bottom: 10px;
      max-width: calc(100% - 20px);
    }
  }
`;
