// Of the pages before the sign-in: a card in the middle.

import { css } from "lit";

export const entry_styles = css`
  :host {
    display: grid;
    place-items: center;
    min-height: 100dvh;
    padding: 20px;
  }
  main {
    width: min(420px, 100%);
  }
  .card {
    display: grid;
    gap: 18px;
    padding: 36px 34px 32px;
    border: var(--edge) solid var(--line);
    border-radius: 16px;
    background: var(--surface);
    box-shadow: var(--shadow);
  }
  form {
    display: grid;
    gap: 16px;
  }
  .logo {
    width: 44px;
    height: 44px;
  }
  .brand {
    display: flex;
    align-items: center;
    gap: 14px;
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
    margin-top: 6px;
  }
  strata-preferences {
    padding-top: 16px;
    border-top: var(--edge) solid var(--line);
  }
  code {
    font: 0.8rem var(--mono);
    overflow-wrap: anywhere;
  }
  @media (max-width: 480px) {
    .card {
      padding: 28px 22px 26px;
    }
  }
`;
