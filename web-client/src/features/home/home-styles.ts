import { css } from "lit";

/** Styles of the part below a card's picture. */
export const cardStyles = css`
  .about {
    display: grid;
    gap: 2px;
    padding: 0.8125rem 1rem 0.9375rem;
  }
  .about b {
    font: 600 1.08rem/1.3 var(--serif);
  }
  .about .faint {
    color: var(--ink-soft);
    font-size: 0.86rem;
  }
`;

export const homeStyles = css`
  :host {
    display: block;
    min-height: 100dvh;
  }
  header {
    display: flex;
    align-items: center;
    gap: 0.875rem;
    padding: 0.75rem clamp(1rem, 4vw, 3.5rem);
    border-bottom: var(--edge) solid var(--line);
    background: var(--surface);
  }
  .brand {
    display: flex;
    align-items: center;
    gap: 0.6875rem;
    color: inherit;
    text-decoration: none;
    font: 600 1.25rem var(--serif);
  }
  .logo {
    width: 2.125rem;
    height: 2.125rem;
  }
  .tagline {
    color: var(--ink-soft);
    font-size: 0.9rem;
  }
  main {
    max-width: 107.5rem;
    margin: 0 auto;
    padding: clamp(1.25rem, 4vw, 2.75rem) clamp(1rem, 4vw, 3.5rem) 4rem;
  }
  .no-password {
    margin-bottom: 1.375rem;
    padding: 0.625rem 1rem;
    border-radius: 0.75rem;
    background: var(--calm-soft);
    color: var(--calm);
  }
  .no-password button.link {
    display: inline;
    padding: 0;
    color: inherit;
    font-weight: 600;
  }
  .title {
    display: flex;
    align-items: baseline;
    flex-wrap: wrap;
    gap: 0.875rem;
    margin-bottom: 1.5rem;
  }
  .up {
    display: flex;
    width: max-content;
    max-width: 100%;
    align-items: center;
    gap: 0.375rem;
    min-height: 2.25rem;
    margin-bottom: 0.375rem;
    color: var(--ink-soft);
    text-decoration: none;
  }
  .up:hover {
    color: var(--ink);
    text-decoration: underline;
  }
  .description {
    max-width: 74ch;
    margin: -0.625rem 0 1.5rem;
    color: var(--ink-soft);
    overflow-wrap: anywhere;
  }
  .title button,
  .title strata-menu,
  .into {
    align-self: center;
  }
  .title strata-menu {
    display: flex;
    margin-left: -0.5rem;
  }
  .into {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    min-width: 0;
  }
  .into span {
    flex: none;
  }
  .into select {
    width: auto;
    min-width: 0;
    max-width: 16.25rem;
  }
  h1 {
    font-size: clamp(1.6rem, 3vw, 2.1rem);
    overflow-wrap: anywhere;
  }
  h1:focus {
    outline: none; /* only the target of the focus, not a control */
  }
  .projects li > a {
    height: 100%;
  }
  .gallery {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(min(16.875rem, 100%), 1fr));
    gap: 1.375rem;
    margin: 0;
    padding: 0;
    list-style: none;
  }
  @media (min-width: 2560px) {
    main {
      max-width: none;
    }
    .gallery {
      grid-template-columns: repeat(auto-fill, minmax(23rem, 1fr));
    }
  }
  li {
    position: relative;
  }
  li > a {
    display: block;
    overflow: hidden;
    border: var(--edge) solid var(--line);
    border-radius: 0.75rem;
    background: var(--surface);
    color: inherit;
    text-decoration: none;
    transition:
      box-shadow 160ms,
      border-color 160ms;
  }
  li > a:hover {
    border-color: var(--line-strong);
    box-shadow: var(--shadow);
  }
  .chip {
    justify-self: start;
    margin-top: 0.375rem;
    padding: 2px 0.5625rem;
    border-radius: 99px;
    background: var(--warn-soft);
    color: var(--warn);
    font-size: 0.78rem;
    font-weight: 600;
  }
  .options {
    position: absolute;
    top: 0.625rem;
    right: 0.625rem;
    opacity: 0;
    transition: opacity 120ms;
  }
  li:hover .options,
  li:focus-within .options {
    opacity: 1;
  }
  @media (hover: none) {
    .options {
      opacity: 1;
    }
  }
  @media (pointer: coarse) {
    .up {
      min-height: 2.75rem;
    }
  }
  .empty {
    display: grid;
    justify-items: center;
    gap: 0.875rem;
    max-width: 28.75rem;
    margin: 8vh auto;
    text-align: center;
  }
  .empty .logo {
    width: 4rem;
    height: 4rem;
  }
  .empty h1 {
    font-size: 1.45rem;
  }
  .empty p {
    color: var(--ink-soft);
  }
  .imports {
    display: grid;
    gap: 0.625rem;
    margin-bottom: 1.625rem;
  }
  .import {
    display: flex;
    align-items: center;
    gap: 1rem;
    padding: 0.8125rem 1rem;
    border: var(--edge) solid var(--line);
    border-radius: 0.75rem;
    background: var(--surface);
  }
  .import b {
    display: block;
  }
  .import .said {
    color: var(--ink-soft);
    font-size: 0.9rem;
    overflow-wrap: anywhere;
  }
  .import.failed {
    border-color: var(--danger);
    background: var(--danger-soft);
  }
  .import.failed .said {
    color: var(--ink);
  }
  .bar {
    height: 0.375rem;
    margin-top: 0.5625rem;
    border-radius: 3px;
    background: var(--line);
    overflow: hidden;
  }
  .bar i {
    display: block;
    height: 100%;
    border-radius: 3px;
    background: var(--accent);
    transition: width 200ms;
  }
  @media (max-width: 620px) {
    .tagline {
      display: none;
    }
    header {
      justify-content: space-between;
    }
    .title .hint {
      flex-basis: auto;
    }
    .title h1 {
      max-width: calc(100% - 2.625rem); /* leaves room for its menu */
    }
    .into {
      flex: 1 1 100%;
    }
    .into select {
      flex: 1;
      max-width: none;
    }
  }
`;
