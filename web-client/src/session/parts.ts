// Interfaces that the parts of an open model offer to other features. The classes that implement
// them are in the folders of their features. Other features use only these interfaces.

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
  /** Sets the highlight of a layer. Null removes it. */
  setHighlight(layerId: number, highlight: Highlight | null): void;
  /** Returns the settings that a saved view stores. */
  toKeep(): LayerOverride[];
  /**
   * Applies the settings of a saved view and removes other highlights. Layers that the view does
   * not contain get their defaults. Returns a function that restores the previous settings, without
   * the temporary highlights.
   */
  showView(view: { layers: LayerOverride[] }): () => void;
}

export interface TablesPart {
  /** The open table below the stage. */
  readonly view: {
    readonly layerId: number;
    readonly tableId: number;
    readonly highlight: Highlight | null;
    readonly rows: { put(record: TableRecord): void };
  } | null;
  /** Returns the table, or null until it is loaded. The first call requests it. */
  find(id: number): Table | null;
  /**
   * Returns the name of a record. Returns null if the record has no name, or if it is not loaded
   * yet.
   */
  label(id: number, key: number): string | null;
  /** Whether it is known that the record does not exist. */
  lacks(id: number, key: number): boolean;
  open(layer: Layer): void;
  /** Scrolls to the record's row in the table of its layer. */
  showRow(layer: Layer, key: number): void;
  /** Opens the table of the layer with these records only. */
  showRows(layer: Layer, keys: readonly number[]): void;
  /** Undoes or redoes this user's latest change to the table. */
  undo(table: number): Promise<void>;
  redo(table: number): Promise<void>;
}

export interface CommentsPart {
  /** Opens the thread of a comment and moves the camera to it. */
  goTo(id: number): void;
}

export interface AppearancePart {
  readonly section: SectionChoice;
  readonly hiddenParts: ReadonlySet<number>;
  /**
   * Returns the settings that a saved view stores, without the section and the hidden parts, which
   * belong to the camera.
   */
  toKeep(): { looks: LookShown[]; light: Light };
  /**
   * Applies the settings of a saved view. Returns a function that restores the previous settings.
   */
  showView(view: {
    camera: { section?: Plane[]; hidden_parts?: number[] };
    looks?: LookShown[];
    light: Light;
  }): () => void;
}

export interface PaintingPart {
  readonly brush: { valueFor(layer: Layer): number };
  /** Whether a drawing is in progress, during which the camera does not move. */
  stroking: boolean;
  /**
   * Makes the selected layer visible and returns it. Shows a notice and returns null if no layer is
   * selected.
   */
  chosenLayer(): Layer | null;
}
