// Requests for dialogs of the page. Several features send them.

import type { Column, TourEntry, View } from "../core/protocol.gen";
import type { Layer } from "../core/types";

/** The dialog that imports terms. `table` is the list to import into. Null makes a new list. */
export type TermsRequest = { dialog: "terms"; table: number | null; file: File | null };

/** The form of a record. If `key` is null, it makes a record and calls `made` with its key. */
export interface RecordRequest {
  dialog: "record";
  layer: Layer;
  key: number | null;
  made?: (key: number) => void;
}

export type TablePanelRequest =
  | TermsRequest
  | RecordRequest
  | { dialog: "delete-record"; layer: Layer; key: number }
  | { dialog: "column"; table: number; column: Column | null }
  | { dialog: "csv"; table: number; file: File }
  | { dialog: "photos"; table: number; files: File[] };

/**
 * The editor of a tour, or the dialog with its links for kiosks. If `tour` is null, the editor
 * makes a new tour.
 */
export type TourRequest =
  { dialog: "tour"; tour: TourEntry | null } | { dialog: "kiosks"; tour: TourEntry };

/**
 * The dialog that saves or describes a view, or the figure dialog. Without `view`, they refer to
 * the current view.
 */
export interface ViewRequest {
  dialog: "view" | "figure";
  view: View | null;
  /** The figure dialog opens with the rollout of the last dialog. */
  unrolled?: true;
}

/** The dialogs of the selection. */
export interface SelectionRequest {
  dialog: "selections" | "save-selection" | "selection-statistics";
}

/**
 * The dialog that unrolls the model, the dialogs for a condition report, for bills, for a 3D model and for GIS
 * programs, or the photographs.
 */
export interface ModelDialogRequest {
  dialog: "rollout" | "report" | "bills" | "export" | "gis" | "linked" | "photographs";
}
