// <strata-preferences>: the page's settings in this browser, and the dialog that contains them.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, query } from "lit/decorators.js";
import { kPageLanguages } from "../../core/locale";
import { nameOfLanguage } from "../../core/languages";
import { ask } from "../../ui/dialog";
import {
  chosenLanguage,
  chosenTheme,
  keepLanguage,
  keepTheme,
  kThemes,
} from "../../ui/preferences";
import { discardUnsaved, unsavedChanges } from "../../session/sessions";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

/** Capitalizes the first letter, as at the start of a line: "Español". */
const titled = (name: string): string => name.slice(0, 1).toUpperCase() + name.slice(1);

@customElement("strata-preferences")
export class StrataPreferences extends LitElement {
  @query("select[name=theme]") private _theme!: HTMLSelectElement;
  @query("select[name=language]") private _language!: HTMLSelectElement;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(170px, 1fr));
        gap: var(--space-3);
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.settings;
    const chosen = chosenLanguage();
    return html`<label class="field">
      <span>${words.language}</span>
      <select name="language" @change=${() => void this.changeLanguage()}>
        <option value="" ?selected=${chosen === null}>${words.as_browser}</option>
        ${kPageLanguages.map(
          (language) =>
            html`<option value=${language} lang=${language} ?selected=${language === chosen}>${titled(nameOfLanguage(language))}</option>`,
        )}
      </select>
    </label>
    <label class="field">
      <span>${words.theme}</span>
      <select name="theme" @change=${() => keepTheme(kThemes.find((theme) => theme === this._theme.value) ?? "system")}>
        ${kThemes.map((theme) => html`<option value=${theme} ?selected=${theme === chosenTheme()}>${words.themes[theme]}</option>`)}
      </select>
    </label>`;
  }

  /** The page sets all texts when it loads, so a new language requires a reload. */
  private async changeLanguage(): Promise<void> {
    const words = texts.settings;
    const wanted = kPageLanguages.find((language) => language === this._language.value) ?? null;
    const lost = unsavedChanges();
    if (
      lost > 0 &&
      !(await ask({
        heading: words.reload_title,
        lead: words.reload_lead(lost),
        yes: words.reload,
        danger: true,
      }))
    ) {
      this._language.value = chosenLanguage() ?? "";
      return;
    }
    discardUnsaved();
    keepLanguage(wanted);
    location.reload();
  }
}

@customElement("strata-preferences-dialog")
export class StrataPreferencesDialog extends LitElement {
  static override styles = sharedStyles;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${texts.settings.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <strata-preferences></strata-preferences>
    </strata-dialog>`;
  }
}
