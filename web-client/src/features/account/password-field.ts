// A password field with a button that shows the password. It is a template and not an element
// because password managers look for fields in the same form.

import { css, html, nothing, type TemplateResult } from "lit";
import { icon } from "../../ui/icons";
import { texts } from "../../texts";

export interface PasswordField {
  name: string;
  label: string;
  autocomplete: "current-password" | "new-password";
  problem?: string;
  /** The id of the error message, if the message is outside the field. */
  wrongBy?: string;
  hint?: string;
}

export const passwordStyles = css`
  .password {
    display: grid;
    gap: var(--space-1);
  }
  .password label {
    font-size: var(--text-tiny);
    font-weight: 600;
    color: var(--ink-soft);
  }
  .password .inside {
    position: relative;
  }
  .password input {
    padding-right: var(--space-12);
  }
  .password button {
    position: absolute;
    right: 1px;
    top: 1px;
    width: 2.375rem;
    min-height: calc(100% - 2px);
    color: var(--ink-soft);
  }
`;

export function passwordField({
  name,
  label,
  autocomplete,
  problem = "",
  wrongBy = "",
  hint = "",
}: PasswordField): TemplateResult {
  return html`<div class="password">
    <label for=${name}>${label}</label>
    <div class="inside">
      <input
        id=${name}
        name=${name}
        type="password"
        autocomplete=${autocomplete}
        autocapitalize="off"
        spellcheck="false"
        maxlength="1024"
        aria-invalid=${problem || wrongBy ? "true" : "false"}
        aria-describedby="${name}_hint ${name}_problem ${wrongBy}"
      />
      <button type="button" class="icon quiet" aria-pressed="false" aria-label=${texts.password.show} title=${texts.password.show} @click=${toggle}>
        ${icon("eye")}
      </button>
    </div>
    ${hint && !problem ? html`<span class="hint" id="${name}_hint">${hint}</span>` : nothing}
    <span class="error" id="${name}_problem" role="alert" ?hidden=${!problem}>${problem}</span>
  </div>`;
}

function toggle(event: Event): void {
  const button = event.currentTarget as HTMLButtonElement;
  const input = button.parentElement!.querySelector("input")!;
  const shown = input.type === "password";
  input.type = shown ? "text" : "password";
  button.setAttribute("aria-pressed", String(shown));
  button.title = shown ? texts.password.hide : texts.password.show;
}
