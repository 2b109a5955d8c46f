import { css } from "lit";

/** What stands below a card's picture. */
export const card_styles = css`
  .about {
    display: grid;
    gap: 2px;
    padding: 13px 16px 15px;
  }
  .about b {
    font: 600 1.08rem/1.3 var(--serif);
  }
  .about .faint {
    color: var(--ink-soft);
    font-size: 0.86rem;
  }
`;

export const home_styles = css`
  :host {
    display: block;
    min-height: 100dvh;
  }
  header {
    display: flex;
    align-items: center;
    gap: 14px;
    padding: 12px clamp(16px, 4vw, 56px);
    border-bottom: var(--edge) solid var(--line);
    background: var(--surface);
  }
  .brand {
    display: flex;
    align-items: center;
    gap: 11px;
    color: inherit;
    text-decoration: none;
    font: 600 1.25rem var(--serif);
  }
  .logo {
    width: 34px;
    height: 34px;
  }
  .tagline {
    color: var(--ink-soft);
    font-size: 0.9rem;
  }
  main {
    max-width: 1720px;
    margin: 0 auto;
    padding: clamp(20px, 4vw, 44px) clamp(16px, 4vw, 56px) 64px;
  }
  .no-password {
    margin-bottom: 22px;
    padding: 10px 16px;
    border-radius: 12px;
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
    gap: 14px;
    margin-bottom: 24px;
  }
  .up {
    display: flex;
    width: max-content;
    max-width: 100%;
    align-items: center;
    gap: 6px;
    min-height: 36px;
    margin-bottom: 6px;
    color: var(--ink-soft);
    text-decoration: none;
  }
  .up:hover {
    color: var(--ink);
    text-decoration: underline;
  }
  .description {
    max-width: 74ch;
    margin: -10px 0 24px;
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
    margin-left: -8px;
  }
  .into {
    display: flex;
    align-items: center;
    gap: 8px;
    min-width: 0;
  }
  .into span {
    flex: none;
  }
  .into select {
    width: auto;
    min-width: 0;
    max-width: 260px;
  }
  h1 {
    font-size: clamp(1.6rem, 3vw, 2.1rem);
    overflow-wrap: anywhere;
  }
  h1:focus {
    outline: none; /* it only says where one is */
  }
  .projects li > a {
    height: 100%;
  }
  .gallery {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(min(270px, 100%), 1fr));
    gap: 22px;
    margin: 0;
    padding: 0;
    list-style: none;
  }
  li {
    position: relative;
  }
  li > a {
    display: block;
    overflow: hidden;
    border: var(--edge) solid var(--line);
    border-radius: 12px;
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
    margin-top: 6px;
    padding: 2px 9px;
    border-radius: 99px;
    background: var(--warn-soft);
    color: var(--warn);
    font-size: 0.78rem;
    font-weight: 600;
  }
  .options {
    position: absolute;
    top: 10px;
    right: 10px;
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
      min-height: 44px;
    }
  }
  .empty {
    display: grid;
    justify-items: center;
    gap: 14px;
    max-width: 460px;
    margin: 8vh auto;
    text-align: center;
  }
  .empty .logo {
    width: 64px;
    height: 64px;
  }
  .empty h1 {
    font-size: 1.45rem;
  }
  .empty p {
    color: var(--ink-soft);
  }
  .imports {
    display: grid;
    gap: 10px;
    margin-bottom: 26px;
  }
  .import {
    display: flex;
    align-items: center;
    gap: 16px;
    padding: 13px 16px;
    border: var(--edge) solid var(--line);
    border-radius: 12px;
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
    height: 6px;
    margin-top: 9px;
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
      max-width: calc(100% - 42px); /* its menu stands beside it */
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
