// The initials of a person, in their colour.

import { css, html, type TemplateResult } from "lit";
import { color_of_person } from "../core/comments";
import { initials } from "../core/people";
import { styled } from "./styled";

export const person_mark_styles = css`
  .person-mark {
    display: inline-grid;
    place-items: center;
    flex: none;
    width: 26px;
    height: 26px;
    border-radius: 50%;
    color: var(--mark-light);
    font-size: 0.72rem;
    font-weight: 700;
    letter-spacing: 0.02em;
  }
`;

export const person_mark = (user: string): TemplateResult =>
  html`<span class="person-mark" aria-hidden="true" ${styled({ background: color_of_person(user) })}>${initials({ user, full_name: "" })}</span>`;
