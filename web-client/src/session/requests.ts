// Which dialog an element asks the page for, where several features do.

import type { Column, TourEntry, View } from "../core/protocol.gen";
import type { Layer } from "../core/types";

/** `table`: the list that gets them; null: a new one. */
export type TermsRequest = { dialog: "terms"; table: number | null; file: File | null };

export type TablePanelRequest =
  | TermsRequest
  | { dialog: "record"; layer: Layer; key: number | null }
  | { dialog: "delete-record"; layer: Layer; key: number }
  | { dialog: "column"; table: number; column: Column | null }
  | { dialog: "csv"; table: number; file: File }
  | { dialog: "photos"; table: number; files: File[] };

/** The tour's editor (without `tour`, of a new one), or its links for kiosks. */
export type TourRequest =
  { dialog: "tour"; tour: TourEntry | null } | { dialog: "kiosks"; tour: TourEntry };

/**
 * The dialog that names a view; without `view` what is seen is kept as a new one. Or the one that
 * draws it to scale; without `view` what is seen.
 */
export interface ViewRequest {
  dialog: "view" | "figure";
  view: View | null;
}
