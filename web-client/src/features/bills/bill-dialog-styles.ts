// The styles of <strata-bill-dialog>.

import { css } from "lit";
import { sharedStyles } from "../../ui/styles";
import { billFieldStyles } from "./bill-fields";

export const billDialogStyles = [
  sharedStyles,
  billFieldStyles,
  css`
    .editor {
      display: grid;
      grid-template-columns: minmax(0, 1fr);
      gap: var(--space-3);
    }
    .bar {
      display: flex;
      flex-wrap: wrap;
      align-items: end;
      gap: var(--space-3);
    }
    .bar .field {
      flex: 1 1 12rem;
    }
    .tools {
      flex-wrap: wrap;
    }
    .face {
      display: inline-flex;
      align-items: center;
      gap: var(--space-2);
      padding: 0 var(--space-3);
    }
    .state {
      display: flex;
      flex-wrap: wrap;
      align-items: center;
      gap: var(--space-1) var(--space-4);
    }
    progress {
      width: 6rem;
      accent-color: var(--accent);
    }
    .warn {
      color: var(--warn);
      font-size: var(--text-small);
    }
    .parts {
      display: grid;
      grid-template-columns: minmax(15rem, 22rem) minmax(0, 1fr);
      gap: var(--space-5);
      padding-top: var(--space-3);
      border-top: var(--edge) solid var(--line);
    }
    .tree,
    .item {
      max-height: calc(100dvh - 19rem);
      min-height: 12rem;
      margin: calc(-1 * var(--space-1));
      padding: var(--space-1);
      overflow: auto;
    }
    .item,
    .proof {
      display: grid;
      grid-template-columns: minmax(0, 1fr);
      align-content: start;
      gap: var(--space-4);
      min-width: 0;
    }
    .proof {
      gap: var(--space-2);
    }
    .middle {
      padding: var(--space-6) 0;
      text-align: center;
    }
    .back {
      display: none;
      justify-self: start;
    }
    .told {
      flex: 1 1 100%;
      display: flex;
      flex-wrap: wrap;
      gap: var(--space-1) var(--space-3);
      padding: var(--space-2) var(--space-3);
      border-radius: var(--radius-small);
      background: var(--warn-soft);
      color: var(--ink);
      font-size: var(--text-small);
    }
    @media (max-width: 760px) {
      .parts {
        grid-template-columns: minmax(0, 1fr);
      }
      .tree,
      .item {
        max-height: none;
        min-height: 0;
        overflow: visible;
      }
      .editor:not(.in-item) .item,
      .in-item .tree,
      .in-item .bar {
        display: none;
      }
      .back {
        display: inline-flex;
      }
    }
  `,
];
