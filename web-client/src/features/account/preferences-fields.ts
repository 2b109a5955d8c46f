// <strata-preferences>: what a person may choose for the page at this browser, and the dialog that
// holds it.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, query } from "lit/decorators.js";
import { kPageLanguages } from "../../core/locale";
import { name_of_language } from "../../core/languages";
import { ask } from "../../ui/dialog";
import {
  chosen_language,
  chosen_theme,
  keep_language,
  keep_theme,
  kThemes,
} from "../../ui/preferences";
import { discard_unsaved, unsaved_changes } from "../../session/sessions";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

/** As at the head of a list: "Español". */
const titled = (name: string): string => name.slice(0, 1).toUpperCase() + name.slice(1);

@customElement("strata-preferences")
export class StrataPreferences extends LitElement {
  @query("select[name=theme]") private theme_!: HTMLSelectElement;
  @query("select[name=language]") private language_!: HTMLSelectElement;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(170px, 1fr));
        gap: 12px;
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.settings;
    const chosen = chosen_language();
    return html`<label class="field">
      <span>${words.language}</span>
      <select name="language" @change=${() => void this.change_language()}>
        <option value="" ?selected=${chosen === null}>${words.as_browser}</option>
        ${kPageLanguages.map(
          (language) =>
            html`<option value=${language} lang=${language} ?selected=${language === chosen}>${titled(name_of_language(language))}</option>`,
        )}
      </select>
    </label>
    <label class="field">
      <span>${words.theme}</span>
      <select name="theme" @change=${() => keep_theme(kThemes.find((theme) => theme === this.theme_.value) ?? "system")}>
        ${kThemes.map((theme) => html`<option value=${theme} ?selected=${theme === chosen_theme()}>${words.themes[theme]}</option>`)}
      </select>
    </label>`;
  }

  /** All words are set while the page is loaded, so it is loaded anew. */
  private async change_language(): Promise<void> {
    const words = texts.settings;
    const wanted = kPageLanguages.find((language) => language === this.language_.value) ?? null;
    const lost = unsaved_changes();
    if (
      lost > 0 &&
      !(await ask({
        heading: words.reload_title,
        lead: words.reload_lead(lost),
        yes: words.reload,
        danger: true,
      }))
    ) {
      this.language_.value = chosen_language() ?? "";
      return;
    }
    discard_unsaved();
    keep_language(wanted);
    location.reload();
  }
}

@customElement("strata-preferences-dialog")
export class StrataPreferencesDialog extends LitElement {
  static override styles = shared_styles;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${texts.settings.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <strata-preferences></strata-preferences>
    </strata-dialog>`;
  }
}
