// The heading of a part of the side panel that folds: `.heading` with an `h2`, whose button says with aria-expanded whether it is open.

import { css } from "lit";

export const folding_heading_styles = css`
  .heading {
    display: flex;
    align-items: center;
    gap: 8px;
  }
  h2 {
    flex: 1;
    font-size: 1.08rem;
  }
  h2 button {
    width: 100%;
    justify-content: flex-start;
    gap: 8px;
    min-height: 36px;
    margin-left: -8px;
    padding: 0 8px;
    font: inherit;
  }
  h2 svg.glyph {
    transform: rotate(90deg);
    transition: transform 120ms;
  }
  h2 button[aria-expanded="true"] svg.glyph {
    transform: rotate(180deg);
  }
`;
