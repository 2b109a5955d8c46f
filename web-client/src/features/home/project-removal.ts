// Deleting a project. The server keeps one that still holds something, so what may go with it goes
// first: tables, but never models.

import { ApiError, type Api } from "../../net/api";
import type { Project, Table } from "../../core/protocol.gen";

/** What is typed is what the project is called, as far as that can be seen. */
export const is_name_of = (typed: string, { name }: Project): boolean =>
  as_seen(typed) !== "" && as_seen(typed) === as_seen(name);
const as_seen = (text: string): string => text.normalize().trim().replace(/\s+/g, " ");

/**
 * With the tables, which no layer may show any more. What is gone already is well, so that it can
 * be tried again.
 */
export async function remove_project(
  api: Pick<Api, "delete_project" | "delete_table">,
  project: Project,
  tables: readonly Table[],
): Promise<void> {
  await remove_tables(tables, (table) => api.delete_table(table.id));
  await gone(api.delete_project(project.slug));
}

/** The server keeps a table that another one's columns name; which do is found by trying. */
async function remove_tables(
  tables: readonly Table[],
  remove: (table: Table) => Promise<void>,
): Promise<void> {
  for (let left = tables; left.length > 0;) {
    const named: Table[] = [];
    let refusal: ApiError | null = null;
    for (const table of left) {
      try {
        await gone(remove(table));
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 409) throw error;
        named.push(table);
        refusal = error;
      }
    }
    if (refusal && named.length === left.length) throw refusal;
    left = named;
  }
}

async function gone(work: Promise<void>): Promise<void> {
  try {
    await work;
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 404) throw error;
  }
}
