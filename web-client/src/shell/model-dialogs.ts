// The dialogs of the model page. They are a separate part (`page-parts.ts`), so the page is shown
// before they are loaded.

import "../features/layers/cleanup-dialog";
import "../features/layers/color-dialog";
import "../features/tables/column-dialog";
import "../features/tables/csv-dialog";
import "../features/records/delete-record-dialog";
import "../features/figures/figure-dialog";
import "../features/account/kiosks-dialog";
import "../features/layers/layer-dialog";
import "../features/layers/map-dialog";
import "../features/layers/orthophoto-dialog";
import "../features/layers/pieces-dialog";
import "../features/records/photos-dialog";
import "../features/records/record-dialog";
import "../features/home/scale-dialog";
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

export { modelDialog } from "./open-dialog";
