// Requests for dialogs of the page that several features send.

import type { Column, TourEntry, View } from "../core/protocol.gen";
import type { Layer } from "../core/types";

/** `table`: the list to import into; null: a new one. */
export type TermsRequest = { dialog: "terms"; table: number | null; file: File | null };

export type TablePanelRequest =
  | TermsRequest
  | { dialog: "record"; layer: Layer; key: number | null }
  | { dialog: "delete-record"; layer: Layer; key: number }
  | { dialog: "column"; table: number; column: Column | null }
  | { dialog: "csv"; table: number; file: File }
  | { dialog: "photos"; table: number; files: File[] };

/** The editor of a tour (without `tour`: of a new one), or its links for kiosks. */
export type TourRequest =
  { dialog: "tour"; tour: TourEntry | null } | { dialog: "kiosks"; tour: TourEntry };

/**
 * The dialog that saves a view or describes an existing one; without `view`: the current view. Or
 * the figure dialog; without `view`: for the current view.
 */
export interface ViewRequest {
  dialog: "view" | "figure";
  view: View | null;
}
