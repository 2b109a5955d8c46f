// What the rules of a bill can choose: the tables and models of the project, the layers of its
// models, and the classes of tables and layers.

import type { Column, Table } from "../../core/protocol.gen";
import { completeLayer, type Layer, type Model } from "../../core/types";
import { labelOf, labelOfRecord } from "../../domain/cells";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";

/** The classes in a column of a table, for a condition. */
export interface ClassColumn {
  column: Pick<Column, "slug" | "kind">;
  name: string;
  classes: readonly { value: string; label: string }[];
}

export class BillSources {
  tables: readonly Table[] = [];
  models: readonly Model[] = [];
  problem = "";
  private readonly _layers = new Map<number, readonly Layer[]>();
  private readonly _terms = new Map<number, ClassColumn["classes"]>();

  constructor(
    private readonly _api: Api,
    private readonly _project: string,
    private readonly _changed: () => void,
  ) {}

  async load(): Promise<void> {
    await this.attempt(async () => {
      const { _api: api, _project: project } = this;
      const [tables, models] = await Promise.all([
        api.all("GET /projects/{project}/tables", "tables", { path: { project } }),
        api.all("GET /models", "models"),
      ]);
      this.tables = tables;
      this.models = models.filter((model) => model.project === project);
    });
  }

  /** Returns the layers of a model. The first call requests them. */
  layers(model: number): readonly Layer[] {
    const known = this._layers.get(model);
    if (known) return known;
    this._layers.set(model, []);
    void this.attempt(async () => {
      const call = "GET /models/{model}/layers";
      const layers = await this._api.all(call, "layers", { path: { model } });
      this._layers.set(model, layers.map(completeLayer));
    });
    return [];
  }

  /** The slugs of all layers that are known by now. */
  get layerSlugs(): readonly string[] {
    const all = [...this._layers.values()].flat().map(({ slug }) => slug);
    return [...new Set(all)].sort();
  }

  /** Returns the columns of a table whose values are classes. For a term list, these are its terms. */
  classColumns(table: Table): ClassColumn[] {
    const [code] = table.columns.filter(({ slug }) => slug === "code");
    if (table.kind === "terms" && code)
      return [{ column: code, name: labelOf(table), classes: this.terms(table) }];
    return table.columns
      .filter(({ kind }) => kind === "enumeration")
      .map((column) => ({
        column,
        name: labelOf(column),
        classes: (column.choices ?? []).map((choice) => ({ value: choice, label: choice })),
      }));
  }

  private terms(table: Table): ClassColumn["classes"] {
    const known = this._terms.get(table.id);
    if (known) return known;
    this._terms.set(table.id, []);
    void this.attempt(async () => {
      const call = "GET /tables/{table}/records";
      const records = await this._api.all(call, "records", { path: { table: table.id } });
      this._terms.set(
        table.id,
        records.flatMap((record) => {
          const { code } = record.values;
          return typeof code === "string"
            ? [{ value: code, label: labelOfRecord(table, record) }]
            : [];
        }),
      );
    });
    return [];
  }

  private async attempt(work: () => Promise<void>): Promise<void> {
    try {
      await work();
      this.problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem = error.message;
    }
    this._changed();
  }
}
