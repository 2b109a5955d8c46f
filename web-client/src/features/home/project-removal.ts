// Deletes a project. The server refuses to delete a project that is not empty, so its tables are
// deleted first. Models are never deleted.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { Project, Table } from "../../core/protocol.gen";

/** Returns whether the typed text is the project's name, apart from invisible differences. */
export const isNameOf = (typed: string, { name }: Project): boolean =>
  asSeen(typed) !== "" && asSeen(typed) === asSeen(name);
const asSeen = (text: string): string => text.normalize().trim().replace(/\s+/g, " ");

/**
 * Deletes the project and its tables, which no layer may use at that time. A part that is already
 * deleted is not an error, so the call can be repeated.
 */
export async function removeProject(
  api: Api,
  project: Project,
  tables: readonly Table[],
): Promise<void> {
  await removeTables(tables, (table) =>
    api.deleteAsRead("DELETE /tables/{table}", { path: { table: table.id } }),
  );
  await gone(api.deleteAsRead("DELETE /projects/{project}", { path: { project: project.slug } }));
}

/**
 * The server refuses to delete a table that columns of other tables refer to, so this function
 * makes several passes.
 */
async function removeTables(
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
