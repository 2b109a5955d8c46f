// Styles of <strata-comment-card>.

import { css } from "lit";

export const commentCardStyles = css`
  section {
    position: absolute;
    pointer-events: auto;
    display: grid;
    grid-template: auto minmax(0, 1fr) auto / minmax(0, 1fr);
    width: min(20.625rem, calc(100% - 1.75rem));
    max-height: min(30rem, calc(100% - 1.75rem));
    border: var(--edge) solid var(--line);
    border-radius: var(--radius);
    background: var(--raised);
    box-shadow: var(--shadow);
    font-size: var(--text-small);
  }
  section:focus {
    outline: none;
  }
  .head {
    gap: var(--space-half);
    padding: var(--space-2) var(--space-2) var(--space-2) var(--space-3);
    border-bottom: var(--edge) solid var(--line);
  }
  h2 {
    font-size: var(--text-large);
  }
  .head button {
    min-height: 2rem;
    padding: 0 var(--space-2);
    font-size: var(--text-small);
  }
  .head button.icon {
    width: 2rem;
    padding: 0;
  }
  .list {
    display: grid;
    align-content: start;
    gap: var(--space-3);
    padding: var(--space-3) var(--space-3);
    overflow: hidden auto;
    overscroll-behavior: contain;
  }
  article {
    display: grid;
    grid-template-columns: auto minmax(0, 1fr);
    gap: var(--space-1) var(--space-2);
  }
  article > .person-mark {
    grid-row: span 2;
  }
  .by {
    display: flex;
    flex-wrap: wrap;
    align-items: baseline;
    gap: var(--space-half) var(--space-2);
    min-height: 1.25rem;
  }
  .by b {
    overflow-wrap: anywhere;
  }
  .by a {
    text-decoration: none;
  }
  .by a:hover,
  .by a:focus-visible {
    text-decoration: underline;
  }
  article .words.gone {
    color: var(--ink-soft);
    font-style: italic;
  }
  .acts {
    grid-column: 2;
    gap: var(--space-3);
  }
  .acts button.link {
    font-size: var(--text-small);
  }
  .about,
  .settled {
    font-size: var(--text-small);
    color: var(--ink-soft);
  }
  .about button.link {
    white-space: normal;
    text-align: left;
  }
  .settled {
    display: flex;
    gap: var(--space-2);
    align-items: center;
    color: var(--calm);
  }
  .settled svg.glyph {
    width: 1rem;
    height: 1rem;
  }
  form {
    display: grid;
    gap: var(--space-2);
    padding: var(--space-2) var(--space-3) var(--space-3);
  }
  article form {
    grid-column: 2;
    padding: 0;
  }
  .foot {
    border-top: var(--edge) solid var(--line);
  }
  textarea {
    min-height: 3.625rem;
    max-height: 12.5rem;
    field-sizing: content;
    resize: none;
    unicode-bidi: plaintext;
  }
  form .row {
    justify-content: flex-end;
  }
  form .row button {
    min-height: 2.125rem;
  }
  @media (max-width: 820px) {
    section {
      position: fixed;
      inset: auto 0 0 0 !important;
      width: auto;
      max-height: 48dvh; /* the target of the camera stays visible above the card */
      border-radius: var(--radius-large) var(--radius-large) 0 0;
      border-bottom: 0;
      padding-bottom: env(safe-area-inset-bottom);
      box-shadow: var(--shadow-above);
    }
  }
  @media (pointer: coarse) {
    .head button {
      min-height: 2.5rem;
    }
    .head button.icon {
      width: 2.5rem;
    }
    .acts button.link {
      min-height: 2rem;
    }
  }
`;
