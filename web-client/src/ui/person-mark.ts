// The initials of a user, in the color of the user's account.

import { css, html, type TemplateResult } from "lit";
import { initials, type Named } from "../domain/people";
import { styled } from "./styled";

export const personMarkStyles = css`
  .person-mark {
    display: inline-grid;
    place-items: center;
    flex: none;
    width: 26px;
    height: 26px;
    border-radius: 50%;
    background: var(--mark-settled);
    color: var(--mark-light);
    font-size: var(--text-tiny);
    font-weight: 700;
    letter-spacing: 0.02em;
  }
`;

export const personMark = (person: Named): TemplateResult =>
  html`<span class="person-mark" aria-hidden="true" ${styled({ background: person.color ?? null })}>${initials(person)}</span>`;
