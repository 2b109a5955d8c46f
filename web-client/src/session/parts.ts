// Interfaces that the parts of an open model offer to other features. The implementing classes are
// in the folders of their features; other features use only these interfaces.

import type {
  Highlight,
  LayerOverride,
  Light,
  LookShown,
  Plane,
  Table,
  TableRecord,
} from "../core/protocol.gen";
import type { Layer } from "../core/types";
import type { SectionChoice } from "../math/section";

export interface LayersPart {
  readonly all: Layer[];
  readonly selected: Layer | null;
  find(id: number | null): Layer | null;
  select(layer: Layer): void;
  visible(layer: Layer): boolean;
  setVisible(layer: Layer, visible: boolean): void;
  /** Null: no highlight. */
  setHighlight(layerId: number, highlight: Highlight | null): void;
  /** The settings that a named view keeps. */
  toKeep(): LayerOverride[];
  /**
   * Applies the settings of a named view, without other highlights; layers that it does not contain
   * get their defaults. Returns a function that restores the previous settings, without the
   * temporary highlights.
   */
  showView(view: { layers: LayerOverride[] }): () => void;
}

export interface TablesPart {
  /** The table that is open below the stage. */
  readonly view: {
    readonly layerId: number;
    readonly tableId: number;
    readonly highlight: Highlight | null;
    readonly rows: { put(record: TableRecord): void };
  } | null;
  /** Null until it is loaded; the call requests it. */
  find(id: number): Table | null;
  /** The name of a record; null where it has none, or it is not loaded yet. */
  label(id: number, key: number): string | null;
  /** Whether the record is known not to exist. */
  lacks(id: number, key: number): boolean;
  open(layer: Layer): void;
  /** Scrolls to the record's row in the table of its layer. */
  showRow(layer: Layer, key: number): void;
  /** Undoes or redoes this person's latest change of the table. */
  undo(table: number): Promise<void>;
  redo(table: number): Promise<void>;
}

export interface CommentsPart {
  /** Opens the thread of a comment and moves the camera to it. */
  goTo(id: number): void;
}

export interface AppearancePart {
  readonly section: SectionChoice;
  /** The settings that a named view keeps, without the section, which belongs to the camera. */
  toKeep(): { looks: LookShown[]; light: Light };
  /** Applies the settings of a named view. Returns a function that restores the previous ones. */
  showView(view: { camera: { section?: Plane[] }; looks?: LookShown[]; light: Light }): () => void;
}

export interface PaintingPart {
  readonly brush: { valueFor(layer: Layer): number };
  /** A drawing is in progress, so the camera stays fixed. */
  stroking: boolean;
  /** Makes the selected layer visible; null if none is selected. The user was shown the reason. */
  chosenLayer(): Layer | null;
}
