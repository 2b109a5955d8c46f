import { css } from "lit";

/** Styles of the part of a card below its thumbnail. */
export const cardStyles = css`
  .about {
    display: grid;
    gap: var(--space-half);
    padding: var(--space-3) var(--space-4) var(--space-4);
  }
  .about b {
    font: 600 var(--text-large)/1.3 var(--serif);
  }
  .about .faint {
    color: var(--ink-soft);
    font-size: var(--text-small);
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
    gap: var(--space-3);
    padding: var(--space-3) clamp(1rem, 4vw, 3.5rem);
    border-bottom: var(--edge) solid var(--line);
    background: var(--surface);
  }
  .brand {
    display: flex;
    align-items: center;
    gap: var(--space-3);
    color: inherit;
    text-decoration: none;
    font: 600 var(--text-title-2) var(--serif);
  }
  .logo {
    width: 2.125rem;
    height: 2.125rem;
  }
  .tagline {
    color: var(--ink-soft);
    font-size: var(--text-small);
  }
  main {
    max-width: 107.5rem;
    margin: 0 auto;
    padding: clamp(1.25rem, 4vw, 2.75rem) clamp(1rem, 4vw, 3.5rem) 4rem;
  }
  .no-password {
    margin-bottom: var(--space-6);
    padding: var(--space-2) var(--space-4);
    border-radius: var(--radius);
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
    gap: var(--space-3);
    margin-bottom: var(--space-6);
  }
  .up {
    display: flex;
    width: max-content;
    max-width: 100%;
    align-items: center;
    gap: var(--space-2);
    min-height: var(--control);
    margin-bottom: var(--space-2);
    color: var(--ink-soft);
    text-decoration: none;
  }
  .up:hover {
    color: var(--ink);
    text-decoration: underline;
  }
  .description {
    max-width: 74ch;
    margin: calc(-1 * var(--space-2)) 0 var(--space-6);
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
    margin-left: calc(-1 * var(--space-2));
  }
  .into {
    display: flex;
    align-items: center;
    gap: var(--space-2);
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
    outline: none; /* this element only receives the focus and is not a control */
  }
  .projects li > a {
    height: 100%;
  }
  .gallery {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(min(16.875rem, 100%), 1fr));
    gap: var(--space-6);
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
    border-radius: var(--radius);
    background: var(--surface);
    color: inherit;
    text-decoration: none;
    transition:
      box-shadow var(--fast),
      border-color var(--fast);
  }
  li > a:hover {
    border-color: var(--line-strong);
    box-shadow: var(--shadow);
  }
  .dates {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-1);
    margin-top: var(--space-2);
  }
  .dates a {
    padding: var(--space-half) var(--space-2);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-round);
    color: inherit;
    font-size: var(--text-small);
    text-decoration: none;
  }
  .dates a:hover {
    border-color: var(--line-strong);
    text-decoration: underline;
  }
  @media (pointer: coarse) {
    .dates a {
      min-height: var(--control-touch);
      align-content: center;
    }
  }
  .chip {
    justify-self: start;
    margin-top: var(--space-2);
    padding: var(--space-half) var(--space-2);
    border-radius: var(--radius-round);
    background: var(--warn-soft);
    color: var(--warn);
    font-size: var(--text-tiny);
    font-weight: 600;
  }
  .options {
    position: absolute;
    top: 0.625rem;
    right: 0.625rem;
    opacity: 0;
    transition: opacity var(--fast);
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
      min-height: var(--control-touch);
    }
  }
  .empty {
    display: grid;
    justify-items: center;
    gap: var(--space-3);
    max-width: 28.75rem;
    margin: 8vh auto;
    text-align: center;
  }
  .empty .logo {
    width: 4rem;
    height: 4rem;
  }
  .empty h1 {
    font-size: var(--text-title-2);
  }
  .empty p {
    color: var(--ink-soft);
  }
  .imports {
    display: grid;
    gap: var(--space-2);
    margin-bottom: var(--space-6);
  }
  .import {
    display: flex;
    align-items: center;
    gap: var(--space-4);
    padding: var(--space-3) var(--space-4);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius);
    background: var(--surface);
  }
  .import b {
    display: block;
  }
  .import .said {
    color: var(--ink-soft);
    font-size: var(--text-small);
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
    margin-top: var(--space-2);
    border-radius: var(--radius-tiny);
    background: var(--line);
    overflow: hidden;
  }
  .bar i {
    display: block;
    height: 100%;
    border-radius: var(--radius-tiny);
    background: var(--accent);
    transition: width var(--slow);
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
      max-width: calc(100% - 2.625rem); /* leaves space for the card's menu */
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
