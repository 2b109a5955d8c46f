// The dialogs and the selection of the model page. They are a separate part (`page-parts.ts`), so the page is shown
// before they are loaded.

import "../features/bills/bills-dialog";
import "../features/layers/cleanup-dialog";
import "../features/layers/color-dialog";
import "../features/tables/column-dialog";
import "../features/tables/csv-dialog";
import "../features/records/delete-record-dialog";
import "../features/deposits/deposit-dialog";
import "../features/exports/export-dialog";
import "../features/figures/figure-dialog";
import "../features/figures/rollout-dialog";
import "../features/gis/gis-dialog";
import "../features/linked/linked-dialog";
import "../features/account/kiosks-dialog";
import "../features/layers/layer-dialog";
import "../features/layers/map-dialog";
import "../features/layers/orthophoto-dialog";
import "../features/photographs/photograph-dialog";
import "../features/photographs/photographs-dialog";
import "../features/layers/pieces-dialog";
import "../features/records/photos-dialog";
import "../features/records/record-dialog";
import "../features/reports/report-dialog";
import "../features/home/scale-dialog";
import "../features/surveys/changes-dialog";
import "./command-palette";
import "./help-dialog";
import "./model-details";
import "../features/layers/statistics-dialog";
import "../features/layers/template-dialog";
import "../features/tables/terms-dialog";
import "../features/tours/tour-dialog";
import "../features/layers/transfer-dialog";
import "../features/views/view-dialog";
import "../features/layers/where-dialog";
import "../features/painting/save-selection-dialog";
import "../features/painting/selection-bar";
import "../features/painting/selection-panel";
import "../features/painting/selection-statistics";
import "../features/painting/selections-dialog";
import "../features/painting/wand-panel";

export { EdgeSnapper } from "../features/painting/edge-snapper";
export { sharpFrames } from "../features/painting/sharp-frame";
export { makeStrokes, selectionOf } from "../features/painting/selection-of";
export { selectionOverlay } from "../features/painting/selection-overlay";
export { strokesOverlay } from "../features/painting/strokes-overlay";

export { placeOverlay } from "../features/photographs/place-overlay";
export { modelDialog } from "./open-dialog";
