// One open model on this page, as the elements of all features know it: its parts, each with its own
// purpose, and what concerns several of them. `shell/open-model-session` puts the parts together.
// This is the only file outside `shell/` that names the parts of all features; it imports types
// alone, and no part imports this file (`session/parts` has what parts know of each other).

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
import type { LayerJobs } from "./layer-jobs";
import type { LayerList } from "../features/layers/layer-list";
import type { MarkDrawing } from "../features/records/mark-drawing";
import type { Measuring } from "../features/measuring/measuring";
import type { Painting } from "../features/painting/painting";
import type { PeopleCursors } from "../features/presence/people-cursors";
import type { PointerWatch } from "./pointer-watch";
import type { RecordEditors } from "./record-editors";
import type { RecordHover } from "../features/records/record-hover";
import type { Reviews } from "../features/review/reviews";
import type { Tables } from "../features/tables/tables";
import type { Together } from "../features/presence/together";
import type { ToolShapes } from "../features/painting/tool-shapes";
import type { Tours } from "../features/tours/tours";
import type { ViewControl } from "./view-control";
import type { Views } from "../features/views/views";

/**
 * What may change by itself. `session`: the model, the connection, or what this person may do, of
 * which all elements are told.
 */
export type SessionPart =
  | "session"
  | "saving"
  | keyof Pick<
      ModelSession,
      | "view"
      | "layers"
      | "jobs"
      | "appearance"
      | "pointer"
      | "painting"
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
      | "views"
      | "tours"
      | "tools"
    >;

export interface ModelSession {
  readonly model: Model | null;
  readonly deleted: boolean;
  /** The server no longer knows who this is. */
  readonly signedOut: boolean;
  readonly role: Role;
  /** The name of who looks. */
  readonly user: string;
  readonly session: string;
  readonly connectionState: ConnectionState;
  readonly saving: SavingState;
  readonly view: ViewControl;
  readonly layers: LayerList;
  readonly jobs: LayerJobs;
  readonly appearance: Appearance;
  readonly pointer: PointerWatch;
  readonly painting: Painting;
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
  readonly tours: Tours;
  readonly figures: Figures;
  readonly face: FacePick;
  readonly tools: ToolManager;
  readonly api: Api;
  readonly modelId: string;
  readonly gestures: GestureHandler;
  /** Told of every change, or of those of some parts and of the session itself. */
  subscribe(listener: () => void, parts?: readonly SessionPart[]): () => void;
  /**
   * Ends the connection; what is not saved is sent when the same person comes back to the model.
   */
  discard(): void;
  checkConnection(): void;
  readonly canPaint: boolean;
  readonly canCurate: boolean;
  /**
   * To this person: curators change locked layers, too, but for those that are as they were
   * computed.
   */
  isLocked(layer: Layer): boolean;
  /** The chosen layer, where a tool is in hand that would change its texels but may not. */
  readonly lockedTarget: Layer | null;
  /** The table of the layer that is painted on: shown, or no longer. */
  toggleTable(): void;
  chooseTool(name: ToolName): void;
  /** What is drawn next goes into this column of the record. */
  drawMarks(layer: Layer, key: number, column: Column): void;
  /** Strokes; with tools that add to records, changes of the table. */
  undo(): void;
  redo(): void;
  /** Behind the model; null: as the server has it. */
  setBackground(background: Background | null): void;
  /** A layer that this person made: it is what they paint on next. */
  addCreated(layer: Layer): void;
  /** Layers that work made for this person: the first is what they look at next. */
  showMade(ids: readonly number[]): void;
  changeModel(change: ModelPatch): Promise<void>;
  reloadModel(): Promise<void>;
  /**
   * Shows the model as if it had this unit and up direction, without keeping them; null: as it has
   * them.
   */
  previewScale(scale: ModelScale | null): void;
  /** The unit of the lengths on the screen. */
  readonly shownUnit: Model["unit"];
}
