// Styles of the pages before sign-in: a card in the middle of the page.

import { css } from "lit";

export const entryStyles = css`
  :host {
    display: grid;
    place-items: center;
    min-height: 100dvh;
    padding: var(--space-5);
  }
  main {
    width: min(26.25rem, 100%);
  }
  .card {
    display: grid;
    gap: var(--space-4);
    padding: var(--space-8) var(--space-8) var(--space-8);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-large);
    background: var(--surface);
    box-shadow: var(--shadow);
  }
  form {
    display: grid;
    gap: var(--space-4);
  }
  .logo {
    width: 2.75rem;
    height: 2.75rem;
  }
  .brand {
    display: flex;
    align-items: center;
    gap: var(--space-3);
  }
  .brand b {
    font: 600 var(--text-title-2)/1.1 var(--serif);
  }
  .brand span {
    display: block;
    font-size: var(--text-small);
    color: var(--ink-soft);
  }
  h1 {
    font-size: var(--text-title-3);
    overflow-wrap: anywhere;
  }
  h1 + p {
    margin-top: var(--space-2);
  }
  strata-preferences {
    padding-top: var(--space-4);
    border-top: var(--edge) solid var(--line);
  }
  code {
    font: var(--text-tiny) var(--mono);
    overflow-wrap: anywhere;
  }
  @media (max-width: 480px) {
    .card {
      padding: var(--space-6) var(--space-6) var(--space-6);
    }
  }
`;
