import { readdirSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";
import { circles, importsOf, readImports, wrongImports, type Import } from "./import-graph";

const kSource = join(__dirname, "../src");
const graph = readImports(kSource);

const value = (to: string): Import => ({ to, typeOnly: false });
const type = (to: string): Import => ({ to, typeOnly: true });
const planted = (from: string, to: Import): string[] =>
  wrongImports(new Map([...graph, [from, [...(graph.get(from) ?? []), to]]]));

describe("The imports of the page", () => {
  it("are all read", () => {
    expect(graph.size).toBeGreaterThan(200);
    expect(graph.get("shell/main.ts")).toContainEqual(value("shell/strata-app.ts"));
    expect(graph.get("session/model-session.ts")).toContainEqual(type("features/views/views.ts"));
    const code = `
      import "./a";
      import b, { type B } from "../b";
      import { type C } from "./c";
      export { d } from "./d";
      export type { E } from "./e";
      const f: typeof import("./f") = await import("./g");
      import { html } from "lit";`;
    expect(importsOf("ui/x.ts", code)).toEqual([
      value("ui/a"),
      value("b"),
      type("ui/c"),
      value("ui/d"),
      type("ui/e"),
      type("ui/f"),
      value("ui/g"),
    ]);
  });

  it("lead from features to what they share, and never the other way or to other features", () => {
    expect(wrongImports(graph)).toEqual([]);
  });

  it("form no circle, not even of types", () => {
    expect(circles(graph)).toEqual([]);
  });

  it("are refused where they lead the wrong way", () => {
    const of = (from: string, to: string): string[] => [`${from} imports ${to}`];
    for (const [from, to] of [
      ["features/comments/comments.ts", "features/layers/layer-list.ts"],
      ["ui/dialog.ts", "features/home/home-page.ts"],
      ["core/types.ts", "net/api.ts"],
      ["session/view-control.ts", "features/views/views.ts"],
      ["features/views/views.ts", "shell/stage.ts"],
      ["kiosk/show.ts", "texts/index.ts"],
      ["ui/styles.ts", "kiosk/stage.ts"],
      ["shell/stage.ts", "kiosk/stage.ts"],
      ["shell/stage.ts", "docs/theme.ts"],
      ["docs/main.ts", "core/types.ts"],
      ["loose.ts", "core/types.ts"],
    ] as const) {
      expect(planted(from, type(to))).toEqual(of(from, to));
      expect(planted(from, value(to))).toEqual(of(from, to));
    }
    const session = ["session/model-session.ts", "features/views/views.ts"] as const;
    expect(planted(session[0], value(session[1]))).toEqual(of(...session));
  });

  it("are refused where they form a circle", () => {
    const withCircle = new Map([...graph, ["math/vector.ts", [type("math/camera.ts")]]]);
    expect(circles(withCircle).length).toBeGreaterThan(0);
    expect(circles(withCircle)[0]).toContain("math/vector.ts");
  });
});

describe("The folders of the page", () => {
  it("hold 40 files at most", () => {
    for (const root of [kSource, __dirname])
      for (const entry of readdirSync(root, { recursive: true, withFileTypes: true }))
        if (entry.isDirectory()) {
          const files = readdirSync(join(entry.parentPath ?? entry.path, entry.name), {
            withFileTypes: true,
          });
          expect(files.filter((file) => file.isFile()).length).toBeLessThanOrEqual(40);
        }
  });
});
