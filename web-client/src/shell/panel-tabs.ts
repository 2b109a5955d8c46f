// The tabs of the side panel. The browser stores the chosen tab.

import { html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { formatCount } from "../core/locale";
import { Kept } from "../core/kept";
import { keyCapsOf } from "../ui/keys/command-keys";
import type { IconName } from "../ui/icons";
import { tabList } from "../ui/panel/tab-list";
import { texts } from "../texts";
import type { OpenModelSession } from "./open-model-session";

/** The tabs in their order. */
export const kTabs = ["layers", "records", "view", "comments", "activity"] as const;
export type PanelTab = (typeof kTabs)[number];

const kGlyphs: Readonly<Record<PanelTab, IconName>> = {
  layers: "layers",
  records: "table",
  view: "eye",
  comments: "comment",
  activity: "clock",
};

const kTitles: Readonly<Record<PanelTab, string>> = {
  layers: texts.layers.title,
  records: texts.records_panel.title,
  view: texts.view.title,
  comments: texts.comments.title,
  activity: texts.activity.title,
};

export const tabTitle = (tab: PanelTab): string => kTitles[tab];

export class PanelTabs {
  private readonly _chosen = new Kept<PanelTab>(() => localStorage, "strata.panel_tab", "layers");

  constructor(private readonly _host: ReactiveControllerHost) {}

  get chosen(): PanelTab {
    const { value } = this._chosen;
    return kTabs.includes(value) ? value : "layers";
  }

  choose(tab: PanelTab): void {
    if (tab === this.chosen) return;
    this._chosen.value = tab;
    this._host.requestUpdate();
  }

  /** Renders the tabs. `panel` is the id of the element with the content of the chosen tab. */
  render(session: OpenModelSession, panel: string): TemplateResult {
    return tabList({
      label: texts.model.panel,
      panel,
      choices: kTabs.map((value) => ({
        value,
        glyph: kGlyphs[value],
        text: kTitles[value],
        key: keyCapsOf(`tab.${value}`).join(" + "),
        badge: badge(value, session),
      })),
      chosen: this.chosen,
      choose: (value) => this.choose(value),
    });
  }
}

function badge(tab: PanelTab, session: OpenModelSession): TemplateResult | typeof nothing {
  const { comments, activity, reviews, appearance } = session;
  switch (tab) {
    case "comments": {
      const { openCount, unreadCount } = comments;
      const words = texts.comments;
      if (openCount === 0 && unreadCount === 0) return nothing;
      const said = [
        openCount > 0 ? words.open_count(openCount) : "",
        unreadCount > 0 ? words.unread(unreadCount) : "",
      ];
      const text = said.filter(Boolean).join(", ");
      return openCount > 0
        ? html`<span class="badge ${unreadCount > 0 ? "news" : ""}" role="img" aria-label=${text}>${formatCount(openCount)}</span>`
        : dot(text);
    }
    case "activity":
      if (session.canPaint && reviews.count > 0) {
        const text = texts.review.waiting(reviews.count);
        return html`<span class="badge" role="img" aria-label=${text}>${formatCount(reviews.count)}</span>`;
      }
      return activity.unseen ? dot(texts.activity.unseen) : nothing;
    case "view":
      return appearance.isDefault ? nothing : dot(texts.view.changed, "own");
    default:
      return nothing;
  }
}

const dot = (label: string, style = ""): TemplateResult =>
  html`<span class="badge dot ${style}" role="img" aria-label=${label}></span>`;
