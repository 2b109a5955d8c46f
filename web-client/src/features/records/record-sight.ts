// Finds the record under the pointer, from the visible layers and the active tool.

import type { Picked } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import type { LayersPart } from "../../session/parts";
import type { ToolName } from "../../tools/tool";
import type { RecordAt } from "./record-hover";

export interface RecordSightHost {
  layers: Pick<LayersPart, "all" | "selected" | "visible">;
  /** Returns the latest response for the position under the pointer. */
  picked(): Picked | null;
  tool(): ToolName;
  /** Returns the record whose card is open. */
  card(): RecordAt | null;
}

export class RecordSight {
  constructor(private readonly _host: RecordSightHost) {}

  /**
   * Returns the selected layer if it has a record at the point, or otherwise the topmost layer with
   * a record.
   */
  layerWithRecord(picked: Picked): Layer | null {
    const { selected, all } = this._host.layers;
    if (selected && this.showsRecord(selected, picked)) return selected;
    return [...all].reverse().find((layer) => this.showsRecord(layer, picked)) ?? null;
  }

  /** The record whose card a tap would open; null if that card is already open. */
  get here(): RecordAt | null {
    const picked = this._host.picked();
    const layer = picked && this.layerOfTap(picked);
    const key = layer ? picked.values?.[layer.slug]?.value : undefined;
    const card = this._host.card();
    return !layer || key === undefined || (card?.layer.id === layer.id && card.key === key)
      ? null
      : { layer, key };
  }

  private layerOfTap(picked: Picked): Layer | null {
    const tool = this._host.tool();
    const { selected } = this._host.layers;
    if (tool === "orbit" || tool === "pan") return this.layerWithRecord(picked);
    return tool === "pick" && selected && this.showsRecord(selected, picked) ? selected : null;
  }

  private showsRecord(layer: Layer, { values }: Picked): boolean {
    return (
      layer.table !== undefined &&
      this._host.layers.visible(layer) &&
      values?.[layer.slug]?.valid === true
    );
  }
}
