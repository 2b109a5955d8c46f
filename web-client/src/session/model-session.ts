// The interface of one open model for the elements of all features. It consists of parts with one
// purpose each, and of members that concern several parts. `shell/open-model-session` assembles the
// parts. This is the only file outside `shell/` that names the parts of all features. It imports
// only types, and no part imports it. The interfaces between parts are in `session/parts`.

import type { Api } from "../net/api";
import type { ConnectionState, SavingState } from "../net/connection";
import type { GestureHandler } from "../ui/input";
import type { Background } from "../core/protocol.gen";
import type { Column, Layer, Model, ModelPatch, Role } from "../core/types";
import type { Activities } from "../features/activity/activity";
import type { ToolName } from "../tools/tool";
import type { ToolManager } from "../tools/tool-manager";
import type { Appearance } from "../features/appearance/appearance";
import type { Comments } from "../features/comments/comments";
import type { FacePick } from "../features/figures/face-pick";
import type { Figures } from "../features/figures/figures";
import type { ModelScale } from "./editable-model";
import type { FileJobs } from "./file-jobs";
import type { LayerJobs } from "./layer-jobs";
import type { LitArea } from "./lit-area";
import type { LayerList } from "../features/layers/layer-list";
import type { MarkDrawing } from "../features/records/mark-drawing";
import type { Measuring } from "../features/measuring/measuring";
import type { FrameMessage } from "../net/frame-header";
import type { Painting } from "../features/painting/painting";
import type { Selection } from "../features/painting/selection";
import type { Strokes } from "../features/painting/strokes";
import type { ModelExports } from "../features/exports/exports";
import type { Photographs } from "../features/photographs/photographs";
import type { Past } from "../features/past/past";
import type { Visits } from "../features/past/visits";
import type { PeopleCursors } from "../features/presence/people-cursors";
import type { PointerWatch } from "./pointer-watch";
import type { RecordEditors } from "./record-editors";
import type { SavedSelections } from "./saved-selections";
import type { RecordHover } from "../features/records/record-hover";
import type { Reports } from "../features/reports/reports";
import type { Reviews } from "../features/review/reviews";
import type { Surveys } from "../features/surveys/surveys";
import type { Tables } from "../features/tables/tables";
import type { Together } from "../features/presence/together";
import type { ToolShapes } from "../features/painting/tool-shapes";
import type { Tours } from "../features/tours/tours";
import type { ViewControl } from "./view-control";
import type { Views } from "../features/views/views";

/**
 * The parts with separate change signals. `session` signals changes to the model, the connection,
 * or this user's rights. All elements receive this signal.
 */
export type SessionPart =
  | "session"
  | "saving"
  | keyof Pick<
      ModelSession,
      | "view"
      | "lit"
      | "layers"
      | "jobs"
      | "appearance"
      | "pointer"
      | "painting"
      | "past"
      | "shapes"
      | "tables"
      | "editors"
      | "marks"
      | "measuring"
      | "comments"
      | "activity"
      | "reviews"
      | "hovered"
      | "together"
      | "photographs"
      | "views"
      | "surveys"
      | "tours"
      | "tools"
    >;

export interface ModelSession {
  readonly model: Model | null;
  readonly deleted: boolean;
  /** Whether the server no longer recognizes this user's session. */
  readonly signedOut: boolean;
  readonly role: Role;
  /** The name of this user. */
  readonly user: string;
  readonly session: string;
  readonly connectionState: ConnectionState;
  readonly moved: boolean; // another node of the site has the model; the page connects to it
  readonly databaseLost: boolean; // the node has lost its database, and still draws the model
  readonly saving: SavingState;
  readonly view: ViewControl;
  readonly lit: LitArea;
  readonly layers: LayerList;
  readonly jobs: LayerJobs;
  readonly appearance: Appearance;
  readonly pointer: PointerWatch;
  readonly painting: Painting;
  /** The selection of polygon, lasso, wand and strokes; null until it is loaded. */
  selection: Selection | null;
  /** The strokes inside and outside of an area; null until they are loaded. */
  readonly strokes: Strokes | null;
  savedSelections: SavedSelections | null; // made at its first use
  photographs: Photographs | null; // made at its first use
  readonly past: Past;
  readonly visits: Visits;
  readonly shapes: ToolShapes;
  readonly tables: Tables;
  readonly editors: RecordEditors;
  readonly marks: MarkDrawing;
  readonly measuring: Measuring;
  readonly comments: Comments;
  readonly activity: Activities;
  readonly reviews: Reviews;
  readonly hovered: RecordHover;
  readonly together: Together;
  readonly cursors: PeopleCursors;
  readonly views: Views;
  readonly surveys: Surveys;
  readonly tours: Tours;
  readonly files: FileJobs;
  readonly figures: Figures;
  readonly reports: Reports;
  readonly exports: ModelExports;
  readonly face: FacePick;
  readonly tools: ToolManager;
  readonly api: Api;
  readonly modelId: string;
  readonly gestures: GestureHandler;
  /**
   * Calls `listener` after every change, or only after changes to these parts and to the session
   * itself.
   */
  subscribe(listener: () => void, parts?: readonly SessionPart[]): () => void;
  /** Calls the listeners of a part after a change. */
  changed(part: SessionPart): void;
  /** Ends the connection. Unsaved changes are sent when the same user opens the model again. */
  discard(): void;
  checkConnection(): void;
  readonly canPaint: boolean;
  readonly canCurate: boolean;
  /**
   * Whether the layer is locked for this user. Curators can change locked layers, except layers
   * that still have their computed values.
   */
  isLocked(layer: Layer): boolean;
  /** The selected layer, if the active tool would change its texels but may not. */
  readonly lockedTarget: Layer | null;
  /** Opens or closes the table of the selected layer. */
  toggleTable(): void;
  chooseTool(name: ToolName): void;
  /** Adds the next drawings to this column of the record. */
  drawMarks(layer: Layer, key: number, column: Column): void;
  /** Undoes a stroke. With tools that add to records, undoes a change to the table. */
  undo(): void;
  redo(): void;
  /** Sets the background of the model. Null restores the server's default. */
  setBackground(background: Background | null): void;
  /**
   * Reports that a frame of the second view is on the screen. This view shows an earlier state next
   * to the newest one.
   */
  thenDrawn(part: FrameMessage): void;
  /** Adds and selects a layer that this user has created. */
  addCreated(layer: Layer): void;
  /** Shows the layers that a job made for this user, and selects the first one. */
  showMade(ids: readonly number[]): void;
  changeModel(change: ModelPatch): Promise<void>;
  reloadModel(): Promise<void>;
  /**
   * Displays the model with this unit and up direction, without saving them. Null restores the
   * model's own unit and up direction.
   */
  previewScale(scale: ModelScale | null): void;
  /** The unit of the displayed lengths. */
  readonly shownUnit: Model["unit"];
}
