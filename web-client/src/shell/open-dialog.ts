// Renders the requested dialog of the model page. The dialog elements belong to the part
// `model_dialogs`.

import { html, nothing, type TemplateResult } from "lit";
import type { Photograph, TourEntry } from "../core/protocol.gen";
import type { Layer, Me, Model } from "../core/types";
import type { LayerPanelRequest } from "../features/layers/layer-panel";
import type { WhereRequest } from "../features/painting/brush-panel";
import type { ModelSession } from "../session/model-session";
import type {
  ModelDialogRequest,
  SelectionRequest,
  TablePanelRequest,
  TourRequest,
  ViewRequest,
} from "../session/requests";
import type { AccountRequest } from "../ui/account-menu";
import type { PanelTab } from "./panel-tabs";

export type OpenDialog =
  | LayerPanelRequest
  | TablePanelRequest
  | ViewRequest
  | ModelDialogRequest
  | WhereRequest
  | SelectionRequest
  | Extract<TourRequest, { dialog: "kiosks" }>
  | { dialog: "photograph"; photograph: Photograph }
  | { dialog: "scale" | "help" | "about" | "deposit" | "orthophoto" | "commands" | "changes" };

/** The interface of the page for its commands and dialogs. */
export interface PageHost {
  session: ModelSession;
  me: Me;
  /** Whether the user can manage links for kiosks. */
  seesToKiosks: boolean;
  /** Replaces the open dialog. Null closes it. */
  show(dialog: OpenDialog | null): void;
  /** Closes the side panel if it covers the model. */
  aside(): void;
  /** Shows a tab of the side panel. Null shows or hides the panel. */
  panel(tab: PanelTab | null): void;
  account(request: AccountRequest): void;
  /** Opens the editor of a tour. Null makes a new tour. */
  editTour(tour: TourEntry | null): void;
  signedOut(): void;
  startTour(): void;
  sayWhoDownloads(who: Model["source_download"]): void;
}

export function modelDialog(dialog: OpenDialog, host: PageHost): TemplateResult | typeof nothing {
  const { session } = host;
  const closed = (): void => host.show(null);
  switch (dialog.dialog) {
    case "create":
      return html`<strata-layer-dialog .session=${session} @closed=${closed}></strata-layer-dialog>`;
    case "template":
      return html`<strata-template-dialog .session=${session} @closed=${closed}></strata-template-dialog>`;
    case "terms":
      return html`<strata-terms-dialog .session=${session} .table=${dialog.table} .file=${dialog.file} @closed=${closed}></strata-terms-dialog>`;
    case "transfer":
      return html`<strata-transfer-dialog .session=${session} @closed=${closed}></strata-transfer-dialog>`;
    case "edit":
      return html`<strata-layer-dialog .session=${session} .layer=${newest(session, dialog.layer)} @closed=${closed}></strata-layer-dialog>`;
    case "colors":
      return html`<strata-color-dialog .session=${session} .layer=${newest(session, dialog.layer)} @closed=${closed}></strata-color-dialog>`;
    case "statistics":
      return html`<strata-statistics-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        @closed=${closed}
      ></strata-statistics-dialog>`;
    case "where":
      return html`<strata-where-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        @closed=${closed}
      ></strata-where-dialog>`;
    case "cleanup":
      return html`<strata-cleanup-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        @closed=${closed}
      ></strata-cleanup-dialog>`;
    case "pieces":
      return html`<strata-pieces-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        @closed=${closed}
      ></strata-pieces-dialog>`;
    case "record":
      return html`<strata-record-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        .key=${dialog.key}
        .made=${dialog.made ?? null}
        @closed=${closed}
      ></strata-record-dialog>`;
    case "delete-record":
      return html`<strata-delete-record-dialog
        .session=${session}
        .table=${dialog.layer.table ?? 0}
        .key=${dialog.key}
        @closed=${closed}
      ></strata-delete-record-dialog>`;
    case "column": {
      const table = session.tables.find(dialog.table);
      if (!table) return nothing;
      return html`<strata-column-dialog .session=${session} .table=${table} .column=${dialog.column} @closed=${closed}></strata-column-dialog>`;
    }
    case "csv":
      return html`<strata-csv-dialog .session=${session} .table=${dialog.table} .file=${dialog.file} @closed=${closed}></strata-csv-dialog>`;
    case "photos":
      return html`<strata-photos-dialog .session=${session} .table=${dialog.table} .files=${dialog.files} @closed=${closed}></strata-photos-dialog>`;
    case "map":
      return html`<strata-map-dialog
        .session=${session}
        .layer=${newest(session, dialog.layer)}
        @closed=${closed}
      ></strata-map-dialog>`;
    case "changes":
      return html`<strata-changes-dialog .session=${session} @closed=${closed}></strata-changes-dialog>`;
    case "view":
      return html`<strata-view-dialog .session=${session} .view=${dialog.view} @closed=${closed}></strata-view-dialog>`;
    case "figure":
      return html`<strata-figure-dialog
        .session=${session}
        .view=${dialog.view}
        .unrolled=${dialog.unrolled ?? false}
        @aside=${host.aside}
        @correct=${() => host.show({ dialog: "scale" })}
        @closed=${closed}
      ></strata-figure-dialog>`;
    case "rollout":
      return html`<strata-rollout-dialog
        .session=${session}
        @figure=${() => host.show({ dialog: "figure", view: null, unrolled: true })}
        @closed=${closed}
      ></strata-rollout-dialog>`;
    case "photographs":
      return html`<strata-photographs-dialog
        .session=${session}
        @opened=${({ detail }: CustomEvent<Photograph>) => host.show({ dialog: "photograph", photograph: detail })}
        @closed=${closed}
      ></strata-photographs-dialog>`;
    case "photograph":
      return html`<strata-photograph-dialog
        .session=${session}
        .photograph=${dialog.photograph}
        @closed=${() => host.show({ dialog: "photographs" })}
      ></strata-photograph-dialog>`;
    case "report":
      return html`<strata-report-dialog .session=${session} @closed=${closed}></strata-report-dialog>`;
    case "bills":
      return session.model
        ? html`<strata-bills-dialog .api=${session.api} project=${session.model.project} @closed=${closed}></strata-bills-dialog>`
        : nothing;
    case "export":
      return html`<strata-export-dialog .session=${session} @closed=${closed}></strata-export-dialog>`;
    case "deposit":
      return html`<strata-deposit-dialog .session=${session} @closed=${closed}></strata-deposit-dialog>`;
    case "gis":
      return html`<strata-gis-dialog .session=${session} @closed=${closed}></strata-gis-dialog>`;
    case "linked":
      return html`<strata-linked-dialog .session=${session} @closed=${closed}></strata-linked-dialog>`;
    case "kiosks":
      return session.model
        ? html`<strata-kiosks-dialog
            .api=${session.api}
            .tour=${{ project: session.model.project, model: session.model.slug, ...dialog.tour }}
            @closed=${closed}
            @signed-out=${() => host.signedOut()}
          ></strata-kiosks-dialog>`
        : nothing;
    case "selections":
      return html`<strata-selections-dialog
        .session=${session}
        @request=${(event: CustomEvent<SelectionRequest>) => host.show(event.detail)}
        @closed=${closed}
      ></strata-selections-dialog>`;
    case "save-selection":
      return html`<strata-save-selection-dialog .session=${session} @closed=${closed}></strata-save-selection-dialog>`;
    case "selection-statistics":
      return html`<strata-selection-statistics .session=${session} @closed=${closed}></strata-selection-statistics>`;
    case "orthophoto":
      return html`<strata-orthophoto-dialog .session=${session} @closed=${closed}></strata-orthophoto-dialog>`;
    case "scale":
      return html`<strata-scale-dialog .session=${session} @closed=${closed}></strata-scale-dialog>`;
    case "commands":
      return html`<strata-command-palette .host=${host} @closed=${closed}></strata-command-palette>`;
    case "help":
      return html`<strata-help-sheet .host=${host} @closed=${closed} @tour=${() => host.startTour()}></strata-help-sheet>`;
    case "about":
      return session.model
        ? html`<strata-about-sheet
            .model=${session.model}
            .viewer=${session.role}
            .correctable=${session.canCurate}
            .session=${session}
            @download-for=${(event: CustomEvent<Model["source_download"]>) => host.sayWhoDownloads(event.detail)}
            @closed=${closed}
            @correct=${() => host.show({ dialog: "scale" })}
            @deposit=${() => host.show({ dialog: "deposit" })}
          ></strata-about-sheet>`
        : nothing;
  }
}

/** Returns the current version of the layer, because the request may contain an older one. */
const newest = (session: ModelSession, layer: Layer): Layer =>
  session.layers.all.find((each) => each.id === layer.id) ?? layer;
