// Styles of the pages before the sign-in: a card in the middle.

import { css } from "lit";

export const entryStyles = css`
  :host {
    display: grid;
    place-items: center;
    min-height: 100dvh;
    padding: 1.25rem;
  }
  main {
    width: min(26.25rem, 100%);
  }
  .card {
    display: grid;
    gap: 1.125rem;
    padding: 2.25rem 2.125rem 2rem;
    border: var(--edge) solid var(--line);
    border-radius: 1rem;
    background: var(--surface);
    box-shadow: var(--shadow);
  }
  form {
    display: grid;
    gap: 1rem;
  }
  .logo {
    width: 2.75rem;
    height: 2.75rem;
  }
  .brand {
    display: flex;
    align-items: center;
    gap: 0.875rem;
  }
  .brand b {
    font: 600 1.5rem/1.1 var(--serif);
  }
  .brand span {
    display: block;
    font-size: 0.85rem;
    color: var(--ink-soft);
  }
  h1 {
    font-size: 1.2rem;
    overflow-wrap: anywhere;
  }
  h1 + p {
    margin-top: 0.375rem;
  }
  strata-preferences {
    padding-top: 1rem;
    border-top: var(--edge) solid var(--line);
  }
  code {
    font: 0.8rem var(--mono);
    overflow-wrap: anywhere;
  }
  @media (max-width: 480px) {
    .card {
      padding: 1.75rem 1.375rem 1.625rem;
    }
  }
`;
