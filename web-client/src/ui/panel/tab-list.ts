// Tabs: a row of buttons. The chosen button is the name of the panel below it. The row is a single
// Tab stop. Arrow keys, Home and End choose immediately (the tabs pattern of ARIA).

import { css, html, nothing, type TemplateResult } from "lit";
import { icon, type IconName } from "../icons";
import { arrowStep } from "../keyboard";

export interface TabChoice<T extends string> {
  value: T;
  glyph: IconName;
  text: string;
  /** The key that chooses the tab. */
  key: string;
  /** Content at the corner of the icon. */
  badge?: unknown;
}

export interface TabList<T extends string> {
  label: string;
  /** The id of the element with the content of the chosen tab. */
  panel: string;
  choices: readonly TabChoice<T>[];
  chosen: T;
  choose(value: T): void;
}

export const tabId = (value: string): string => `tab-${value}`;

export function tabList<T extends string>({
  label,
  panel,
  choices,
  chosen,
  choose,
}: TabList<T>): TemplateResult {
  return html`<div class="tabs" role="tablist" aria-label=${label} @keydown=${onTabKey}>
    ${choices.map(
      ({ value, glyph, text, key, badge }) =>
        html`<button
          type="button"
          role="tab"
          id=${tabId(value)}
          data-tab=${value}
          aria-selected=${value === chosen}
          aria-controls=${value === chosen ? panel : nothing}
          tabindex=${value === chosen ? 0 : -1}
          title="${text} (${key})"
          @click=${() => choose(value)}
        >
          <span class="glyphs">${icon(glyph)}${badge ?? nothing}</span><span class="text">${text}</span>
        </button>`,
    )}
  </div>`;
}

function onTabKey(event: KeyboardEvent): void {
  const tabs = [
    ...(event.currentTarget as HTMLElement).querySelectorAll<HTMLElement>("[role=tab]"),
  ];
  const at = tabs.indexOf(event.target as HTMLElement);
  if (at < 0 || event.ctrlKey || event.metaKey || event.altKey) return;
  const isAcross = event.key === "ArrowLeft" || event.key === "ArrowRight";
  const to =
    event.key === "Home"
      ? 0
      : event.key === "End"
        ? tabs.length - 1
        : isAcross
          ? arrowStep(event.key, at, tabs.length)
          : null;
  if (to === null) return;
  event.preventDefault();
  tabs[to]!.click();
  tabs[to]!.focus();
}

export const tabListStyles = css`
  .tabs {
    display: flex;
    container-type: inline-size;
    padding: var(--space-1) var(--space-2) 0;
    border-bottom: var(--edge) solid var(--line);
  }
  .tabs button {
    flex: 1 1 auto;
    display: grid;
    justify-items: center;
    gap: var(--space-half);
    min-width: 2.75rem;
    min-height: 2.875rem;
    padding: var(--space-1) var(--space-half) var(--space-1);
    border: 0;
    border-bottom: 3px solid transparent;
    border-radius: var(--radius-small) var(--radius-small) 0 0;
    background: transparent;
    color: var(--ink-soft);
    font-size: var(--text-tiny);
    line-height: 1.2;
  }
  .tabs button:hover {
    background: var(--hover);
    color: var(--ink);
  }
  .tabs button[aria-selected="true"] {
    border-bottom-color: var(--accent);
    color: var(--ink);
    font-weight: 600;
  }
  .tabs button:focus-visible {
    outline-offset: -2px;
  }
  .tabs .glyphs {
    position: relative;
    display: grid;
  }
  .tabs .glyphs .badge {
    position: absolute;
    top: -0.25rem;
    left: calc(100% - 0.4375rem);
    min-width: 1rem;
    padding: 0 var(--space-1);
    border-radius: 99px;
    background: var(--chosen);
    color: var(--chosen-ink);
    box-shadow: 0 0 0 1px var(--line-strong);
    font: 600 var(--text-tiny) / var(--space-4) var(--sans, inherit);
    text-align: center;
  }
  .tabs .glyphs .badge.news {
    box-shadow: 0 0 0 2px var(--news);
  }
  .tabs .glyphs .badge.dot {
    min-width: 0;
    width: 0.5625rem;
    height: 0.5625rem;
    padding: 0;
    top: -1px;
    background: var(--news);
    box-shadow: none;
  }
  .tabs .glyphs .badge.own {
    background: var(--accent);
  }
  @container (max-width: 19.5rem) {
    .tabs .text {
      position: absolute;
      width: 1px;
      height: 1px;
      overflow: hidden;
      clip-path: inset(50%);
    }
  }
`;
