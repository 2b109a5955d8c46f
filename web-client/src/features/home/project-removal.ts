// Deleting a project. The server keeps one that still holds something, so what may go with it goes
// first: tables, but never models.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { Project, Table } from "../../core/protocol.gen";

/** What is typed is what the project is called, as far as that can be seen. */
export const isNameOf = (typed: string, { name }: Project): boolean =>
  asSeen(typed) !== "" && asSeen(typed) === asSeen(name);
const asSeen = (text: string): string => text.normalize().trim().replace(/\s+/g, " ");

/**
 * With the tables, which no layer may show any more. What is gone already is well, so that it can
 * be tried again.
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

/** The server keeps a table that another one's columns name; which do is found by trying. */
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
