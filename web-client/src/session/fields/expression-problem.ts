// Shows a mistake in a condition or formula: the text with the wrong characters underlined, the
// server's message, and a button for each correction. Use it with `expressionProblemStyles`.

import { css, html, nothing, type TemplateResult } from "lit";
import { markedAt, type Mistake } from "../../domain/completion";
import { texts } from "../../texts";

export interface Correction {
  /** The text that replaces the wrong characters. */
  text: string;
  /** A description, if the text alone is not clear. */
  hint?: string;
}

export interface ExpressionProblem {
  /** The whole text of the condition. */
  text: string;
  message: string;
  /** Null if the problem has no position in the text. */
  mistake: Mistake | null;
  corrections: readonly Correction[];
  correct(by: string): void;
}

export const expressionProblemStyles = css`
  .mistake {
    display: grid;
    gap: var(--space-2);
  }
  .mistake pre {
    margin: 0;
    padding: var(--space-2) var(--space-2);
    white-space: pre-wrap;
    word-break: break-word;
    font: var(--text-small) var(--mono);
    border-radius: var(--radius-small);
    background: var(--calm-soft);
    color: var(--ink);
  }
  .mistake mark {
    background: none;
    color: inherit;
    text-decoration: underline wavy var(--danger) 2px;
    text-underline-offset: 3px;
    white-space: pre;
  }
  .mistake .corrections {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-2);
  }
  .mistake .corrections button {
    min-height: 1.875rem;
    padding: 0 var(--space-3);
  }
  @media (pointer: coarse) {
    .mistake .corrections button {
      min-height: 2.75rem;
    }
  }
  .mistake .corrections code {
    font: var(--text-small) var(--mono);
  }
`;

export function expressionProblem({
  text,
  message,
  mistake,
  corrections,
  correct,
}: ExpressionProblem): TemplateResult {
  const [before, at, after] = markedAt(text, mistake?.offset ?? 0, mistake?.length);
  return html`<div class="mistake">
    ${mistake ? html`<pre aria-hidden="true">${before}<mark>${at}</mark>${after}</pre>` : nothing}
    <p class="error" role="alert">${message}</p>
    ${
      corrections.length === 0
        ? nothing
        : html`<div class="corrections" role="group" aria-label=${texts.expressions.corrections}>
          ${corrections.map(
            ({ text: by, hint }) =>
              html`<button type="button" aria-label=${texts.expressions.use(by)} @click=${() => correct(by)}>
                <code>${by}</code>${hint ? html` <span>${hint}</span>` : nothing}
              </button>`,
          )}
        </div>`
    }
  </div>`;
}
