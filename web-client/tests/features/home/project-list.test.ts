import { describe, expect, it } from "vitest";

import { isOneOfSeveral, listProjects } from "../../../src/features/home/project-list";
import type { Project } from "../../../src/core/protocol.gen";
import type { Model, Role } from "../../../src/core/types";

const project = (slug: string, name = slug, role: Role = "viewer"): Project => ({
  id: slug.length,
  slug,
  name,
  description: "",
  role,
});
const model = (id: number, of: string): Model => ({ id, project: of }) as Model;
const listed = (projects: Project[], models: Model[]): string[] =>
  listProjects(projects, models).map(({ project: { slug }, models: own }) =>
    [slug, ...own.map(({ id }) => id)].join(" "),
  );

describe("projects to choose among", () => {
  it("have their models, and come by name, the empty ones last", () => {
    const projects = [
      project("default", "Default", "curator"),
      project("site-10", "Site 10"),
      project("void", "A void"),
      project("site-9", "site 9"),
    ];
    expect(
      listed(projects, [model(4, "site-10"), model(2, "site-9"), model(3, "site-10")]),
    ).toEqual(["site-9 2", "site-10 4 3", "void"]);
  });

  it("leave out the one that every site has while it is empty and there are others", () => {
    const models = [model(1, "villa")];
    expect(listed([project("default"), project("villa")], models)).toEqual(["villa 1"]);
    expect(
      listed([project("default"), project("villa")], [...models, model(2, "default")]),
    ).toEqual(["default 2", "villa 1"]);
    expect(listed([project("default")], [])).toEqual(["default"]);
  });

  it("tell whether one of them stands beside others", () => {
    expect(isOneOfSeveral("villa", [project("default"), project("villa")])).toBe(true);
    expect(isOneOfSeveral("gone", [project("default"), project("villa")])).toBe(false);
    expect(isOneOfSeveral("default", [project("default"), project("villa")])).toBe(true);
    expect(isOneOfSeveral("villa", [project("default"), project("villa"), project("site")])).toBe(
      true,
    );
    expect(isOneOfSeveral("default", [project("default")])).toBe(false);
  });

  it("may be none", () => {
    expect(listed([], [])).toEqual([]);
  });
});
