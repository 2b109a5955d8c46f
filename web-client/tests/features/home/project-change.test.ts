import { describe, expect, it } from "vitest";

import { fakeApi } from "../../fake-api";
import { ProjectChange } from "../../../src/features/home/project-dialog";
import { ApiError } from "../../../src/net/api-error";
import type { Versioned } from "../../../src/net/api";
import type { Project } from "../../../src/core/protocol.gen";

/** A fake server with one project. */
class FakeServer {
  now: Project = { id: 4, name: "Villa", slug: "villa", description: "Frescoes" };
  version = 1;
  /** Runs after the next read of the project. */
  meanwhile: (() => void) | null = null;

  readonly api = fakeApi({
    "GET /projects/{project}": () => this.project(),
    "PATCH /projects/{project}": ({ path, body, header }) =>
      this.changeProject(path.project, body, header["If-Match"]),
  });

  readonly project = async (): Promise<Versioned<Project>> => {
    const answer = { value: { ...this.now }, etag: `"${this.version}"` };
    this.meanwhile?.();
    this.meanwhile = null;
    return answer;
  };
  changeProject = async (
    _: number | string,
    change: Partial<Project>,
    etag: string,
  ): Promise<Project> => {
    if (etag !== `"${this.version}"`)
      throw new ApiError({ status: 412, title: "Changed meanwhile" });
    return this.put(change);
  };
  put(change: Partial<Project>): Project {
    ++this.version;
    return (this.now = { ...this.now, ...change });
  }
}

const wanted = { name: "Villa Giulia", text: "Frescoes" };

describe("a change of a project", () => {
  it("is made of the project that this person sees", async () => {
    const server = new FakeServer();
    // the project as the server lists it
    const seen = { ...server.now, role: "administrator" } as Project;
    expect(await new ProjectChange(server.api, seen).save(wanted, false)).toMatchObject({
      name: "Villa Giulia",
    });
    expect(server.version).toBe(2);
  });

  it("is not put over another's that this person has not seen, until they say so once more", async () => {
    for (const other of [
      { name: "Villa Julia" },
      { description: "Mosaics" },
      { require_if_match: true },
    ]) {
      const server = new FakeServer();
      const change = new ProjectChange(server.api, { ...server.now });
      server.put(other);
      expect(await change.save(wanted, false)).toBeNull();
      expect(server.now).toMatchObject(other);
      expect(change.name).toBe(server.now.name);
      expect(await change.save(wanted, false)).toMatchObject({
        name: "Villa Giulia",
        description: "Frescoes",
        require_if_match: false,
      });
    }
  });

  it("is told of each change between reading and writing, too", async () => {
    const server = new FakeServer();
    const change = new ProjectChange(server.api, { ...server.now });
    server.meanwhile = () => server.put({ name: "First" });
    expect([await change.save(wanted, false), change.name]).toEqual([null, "First"]);
    server.put({ name: "Second" });
    expect([await change.save(wanted, false), change.name]).toEqual([null, "Second"]);
    expect(await change.save(wanted, false)).toMatchObject({ name: "Villa Giulia" });
  });

  it("says what else goes wrong", async () => {
    const server = new FakeServer();
    server.changeProject = () =>
      Promise.reject(new ApiError({ status: 403, title: "Not allowed" }));
    await expect(
      new ProjectChange(server.api, server.now).save(wanted, false),
    ).rejects.toMatchObject({
      status: 403,
    });
  });
});
