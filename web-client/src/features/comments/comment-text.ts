// Renders the text of a comment: lines as written, addresses as links, and @names of users marked.

import { css, html, type TemplateResult } from "lit";
import { textParts } from "../../domain/comments";

export const commentTextStyles = css`
  .words {
    margin: 0;
    white-space: pre-wrap;
    overflow-wrap: anywhere;
    unicode-bidi: plaintext;
  }
  .words a {
    color: var(--accent);
  }
  .words .mention {
    padding: 0 var(--space-1);
    border-radius: var(--radius-tiny);
    background: var(--accent-soft);
    font-weight: 600;
  }
`;

export function commentText(text: string, people: ReadonlySet<string>): TemplateResult {
  const parts = textParts(text, people).map((part) => {
    if (part.kind === "link")
      return html`<a href=${part.href} target="_blank" rel="noopener noreferrer nofollow">${part.text}</a>`;
    return part.kind === "mention" ? html`<span class="mention">${part.text}</span>` : part.text;
  });
  // no white space between the tags, because spaces are part of the text
  return html`<p class="words">${parts}</p>`;
}
