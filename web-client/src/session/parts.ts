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
  set_visible(layer: Layer, visible: boolean): void;
  /** Null: no records before others. */
  set_highlight(layer_id: number, highlight: Highlight | null): void;
  /** What a named view keeps of all this. */
  to_keep(): LayerOverride[];
  /**
   * As a named view has it, and no records before those of the view; layers that it does not name
   * as everyone sees them at first. Returns the way back, without the records that were looked at.
   */
  show_view(view: { layers: LayerOverride[] }): () => void;
}

export interface TablesPart {
  /** The table that is open below the stage. */
  readonly view: {
    readonly layer_id: number;
    readonly table_id: number;
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
  show_row(layer: Layer, key: number): void;
  /** This person's newest change of the table is taken back, or the one that was comes again. */
  undo(table: number): Promise<void>;
  redo(table: number): Promise<void>;
}

export interface CommentsPart {
  /** Opens the thread of a comment and goes there. */
  go_to(id: number): void;
}

export interface AppearancePart {
  readonly section: SectionChoice;
  /** What a named view keeps of all this, apart from the section, which is the camera's. */
  to_keep(): { looks: LookShown[]; light: Light };
  /** As a named view has it. Returns the way back. */
  show_view(view: { camera: { section?: Plane[] }; looks?: LookShown[]; light: Light }): () => void;
}

export interface PaintingPart {
  readonly brush: { value_of(layer: Layer): number };
  /** Something is drawn: the camera stays. */
  stroking: boolean;
  /** It is made visible; null: there is none to add to, and the person was told why. */
  chosen_layer(): Layer | null;
}
