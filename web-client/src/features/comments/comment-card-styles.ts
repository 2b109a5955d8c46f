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
    font-size: 0.9rem;
  }
  section:focus {
    outline: none;
  }
  .head {
    gap: 2px;
    padding: 0.375rem 0.375rem 0.375rem 0.8125rem;
    border-bottom: var(--edge) solid var(--line);
  }
  h2 {
    font-size: 1.02rem;
  }
  .head button {
    min-height: 2rem;
    padding: 0 0.5rem;
    font-size: 0.86rem;
  }
  .head button.icon {
    width: 2rem;
    padding: 0;
  }
  .list {
    display: grid;
    align-content: start;
    gap: 0.8125rem;
    padding: 0.6875rem 0.8125rem;
    overflow: hidden auto;
    overscroll-behavior: contain;
  }
  article {
    display: grid;
    grid-template-columns: auto minmax(0, 1fr);
    gap: 3px 0.5625rem;
  }
  article > .person-mark {
    grid-row: span 2;
  }
  .by {
    display: flex;
    flex-wrap: wrap;
    align-items: baseline;
    gap: 2px 0.5rem;
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
    gap: 0.875rem;
  }
  .acts button.link {
    font-size: 0.82rem;
  }
  .about,
  .settled {
    font-size: 0.84rem;
    color: var(--ink-soft);
  }
  .about button.link {
    white-space: normal;
    text-align: left;
  }
  .settled {
    display: flex;
    gap: 0.375rem;
    align-items: center;
    color: var(--calm);
  }
  .settled svg.glyph {
    width: 1rem;
    height: 1rem;
  }
  form {
    display: grid;
    gap: 0.5rem;
    padding: 0.625rem 0.8125rem 0.75rem;
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
      max-height: 48dvh; /* the target of the camera stays visible above it */
      border-radius: 1rem 1rem 0 0;
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
