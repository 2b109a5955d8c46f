// The dialogs of a model's page, which is shown without them: they come in a piece of their own
// (`page-parts.ts`).

import "./color-dialog";
import "./column-dialog";
import "./csv-dialog";
import "./delete-record-dialog";
import "./figure-dialog";
import "./kiosks-dialog";
import "./layer-dialog";
import "./map-dialog";
import "./orthophoto-dialog";
import "./photos-dialog";
import "./record-dialog";
import "./scale-dialog";
import "./sheets";
import "./statistics-dialog";
import "./template-dialog";
import "./terms-dialog";
import "./tour-dialog";
import "./transfer-dialog";
import "./view-dialog";
import "./where-dialog";
