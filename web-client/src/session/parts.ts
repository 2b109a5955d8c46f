// What a part of an open model offers to the parts of other features. The classes that do it lie in
// the folders of their features; who needs another feature's part knows it by these interfaces.

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
  /** Null: no records before others. */
  setHighlight(layerId: number, highlight: Highlight | null): void;
  /** What a named view keeps of all this. */
  toKeep(): LayerOverride[];
  /**
   * As a named view has it, and no records before those of the view; layers that it does not name
   * as everyone sees them at first. Returns the way back, without the records that were looked at.
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
  /** Null until it is here; it is asked for. */
  find(id: number): Table | null;
  /** What a record of the table is called; null where it has no name, or none that is known yet. */
  label(id: number, key: number): string | null;
  /** Whether it is known that the table has no such record. */
  lacks(id: number, key: number): boolean;
  open(layer: Layer): void;
  /** Brings the record's row into sight, in the table of its layer. */
  showRow(layer: Layer, key: number): void;
  /** This person's newest change of the table is taken back, or the one that was comes again. */
  undo(table: number): Promise<void>;
  redo(table: number): Promise<void>;
}

export interface CommentsPart {
  /** Opens the thread of a comment and goes there. */
  goTo(id: number): void;
}

export interface AppearancePart {
  readonly section: SectionChoice;
  /** What a named view keeps of all this, apart from the section, which is the camera's. */
  toKeep(): { looks: LookShown[]; light: Light };
  /** As a named view has it. Returns the way back. */
  showView(view: { camera: { section?: Plane[] }; looks?: LookShown[]; light: Light }): () => void;
}

export interface PaintingPart {
  readonly brush: { valueFor(layer: Layer): number };
  /** Something is drawn: the camera stays. */
  stroking: boolean;
  /** It is made visible; null: there is none to add to, and the person was told why. */
  chosenLayer(): Layer | null;
}
