import { describe, expect, it } from "vitest";

import { fakeApi } from "../../fake-api";
import { isNameOf, removeProject } from "../../../src/features/home/project-removal";
import { ApiError } from "../../../src/net/api-error";
import type { Project, Table } from "../../../src/core/protocol.gen";

const villa: Project = { id: 4, name: "Villa  Ñuño", slug: "villa", description: "" };
const table = (id: number): Table => ({ id }) as Table;

/** A fake server with one project, and with tables that refer to other tables. */
class FakeServer {
  readonly done: (number | string)[] = [];
  /** Errors that the server returns first, once for each table. */
  readonly faults = new Map<number, ApiError>();

  readonly api = fakeApi({
    "DELETE /tables/{table}": ({ path }) => this.deleteTable(path.table),
    "DELETE /projects/{project}": ({ path }) => this.deleteProject(path.project),
  });

  constructor(
    private readonly _names: Map<number, number[]>,
    private _hasProject = true,
  ) {}

  async deleteTable(id: number | string): Promise<void> {
    const at = Number(id);
    const fault = this.faults.get(at);
    this.faults.delete(at);
    if (fault) throw fault;
    if (!this._names.has(at)) throw new ApiError({ status: 404, title: "Not found" });
    for (const [other, named] of this._names)
      if (other !== at && named.includes(at))
        throw new ApiError({ status: 409, title: "Table in use", detail: `named by ${other}` });
    this._names.delete(at);
    this.done.push(at);
  }
  async deleteProject(slug: number | string): Promise<void> {
    if (this._names.size > 0)
      throw new ApiError({ status: 409, title: "Conflict", detail: "still has tables" });
    if (!this._hasProject) throw new ApiError({ status: 404, title: "Not found" });
    this._hasProject = false;
    this.done.push(slug);
  }
}

describe("deleting a project", () => {
  it("takes its tables along, those that others name after these", async () => {
    const server = new FakeServer(
      new Map([
        [1, []],
        [2, [1]],
        [3, [2, 3]],
      ]),
    );
    await removeProject(server.api, villa, [table(1), table(2), table(3)]);
    expect(server.done).toEqual([3, 2, 1, "villa"]);
  });

  it("says why where tables name each other in a circle, and leaves the project", async () => {
    const server = new FakeServer(
      new Map([
        [1, [2]],
        [2, [1]],
        [3, []],
      ]),
    );
    await expect(
      removeProject(server.api, villa, [table(1), table(2), table(3)]),
    ).rejects.toMatchObject({ status: 409, problem: { title: "Table in use" } });
    expect(server.done).toEqual([3]);
  });

  it("goes on where another attempt ended", async () => {
    const server = new FakeServer(
      new Map([
        [1, []],
        [2, []],
      ]),
    );
    server.faults.set(2, new ApiError({ status: 503, title: "Busy" }));
    await expect(removeProject(server.api, villa, [table(1), table(2)])).rejects.toMatchObject({
      status: 503,
    });
    expect(server.done).toEqual([1]);
    await removeProject(server.api, villa, [table(1), table(2)]);
    expect(server.done).toEqual([1, 2, "villa"]);
    await removeProject(server.api, villa, []); // another user has already deleted the project
  });

  it("fails where there is more in it than was shown", async () => {
    const server = new FakeServer(new Map([[1, []]]));
    await expect(removeProject(server.api, villa, [])).rejects.toMatchObject({
      status: 409,
      problem: { detail: "still has tables" },
    });
  });
});

describe("the name that is typed", () => {
  it("is the project's as it is seen", () => {
    expect(isNameOf("Villa Ñuño", villa)).toBe(true);
    // some keyboards produce composed letters
    expect(isNameOf("  Villa N\u0303un\u0303o ", villa)).toBe(true);
    for (const other of ["", "villa ñuño", "Villa", "Villa Ñuño 2"])
      expect(isNameOf(other, villa)).toBe(false);
    expect(isNameOf(" ", { ...villa, name: "\u2003" })).toBe(false);
  });
});
