import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import ts from "typescript";
import { describe, expect, it } from "vitest";

const kSource = join(__dirname, "../../src");

/** Parts of the session that an element changes but does not show. */
const kOnlyChanged: Readonly<Record<string, readonly string[]>> = {
  "features/past/past-bar.ts": ["lit"],
  "features/surveys/class-changes.ts": ["view"],
  "features/tables/table-panel.ts": ["painting"],
};

interface Element {
  follows: Set<string>;
  reads: Set<string>;
}

function parse(code: string): ts.SourceFile {
  return ts.createSourceFile("element.ts", code, ts.ScriptTarget.Latest, true);
}

/** Returns the names in `SessionPart`, without those of the session itself. */
function partsOfSession(): Set<string> {
  const parts = new Set<string>();
  const code = readFileSync(join(kSource, "session/model-session.ts"), "utf8");
  const visit = (node: ts.Node): void => {
    if (ts.isLiteralTypeNode(node) && ts.isStringLiteral(node.literal))
      parts.add(node.literal.text);
    ts.forEachChild(node, visit);
  };
  ts.forEachChild(parse(code), (node) => {
    if (ts.isTypeAliasDeclaration(node) && node.name.text === "SessionPart") visit(node);
  });
  parts.delete("session");
  return parts;
}

/**
 * Finds `session.<part>` and `const { <part> } = session`. Returns null if the element follows no
 * part, or all.
 */
function elementOf(code: string, parts: ReadonlySet<string>): Element | null {
  const follows = new Set<string>();
  const reads = new Set<string>();
  const isSession = (node: ts.Expression): boolean =>
    (ts.isIdentifier(node) && node.text === "session") ||
    (ts.isPropertyAccessExpression(node) && node.name.text === "session");
  const read = (name: string): void => void (parts.has(name) && reads.add(name));
  const visit = (node: ts.Node): void => {
    if (
      ts.isCallExpression(node) &&
      ts.isIdentifier(node.expression) &&
      node.expression.text === "followSession"
    ) {
      for (const argument of node.arguments)
        if (ts.isStringLiteral(argument)) follows.add(argument.text);
    } else if (ts.isPropertyAccessExpression(node) && isSession(node.expression)) {
      read(node.name.text);
    } else if (
      ts.isVariableDeclaration(node) &&
      node.initializer &&
      isSession(node.initializer) &&
      ts.isObjectBindingPattern(node.name)
    ) {
      for (const { propertyName, name } of node.name.elements)
        read((propertyName ?? name).getText());
    }
    ts.forEachChild(node, visit);
  };
  visit(parse(code));
  return follows.size > 0 ? { follows, reads } : null;
}

const missing = ({ follows, reads }: Element): string[] =>
  [...reads].filter((part) => !follows.has(part));

describe("An element that follows parts of the session", () => {
  const parts = partsOfSession();
  const elements = new Map(
    readdirSync(kSource, { recursive: true, encoding: "utf8" })
      .filter((file) => file.endsWith(".ts"))
      .flatMap((file): [string, Element][] => {
        const element = elementOf(readFileSync(join(kSource, file), "utf8"), parts);
        return element ? [[file.replaceAll("\\", "/"), element]] : [];
      }),
  );

  it("follows every part that it reads", () => {
    expect(parts.size).toBeGreaterThan(15);
    expect(elements.size).toBeGreaterThan(30);
    const unfollowed = [...elements].flatMap(([file, element]) =>
      missing(element)
        .filter((part) => !kOnlyChanged[file]?.includes(part))
        .map((part) => `${file} reads ${part}`),
    );
    expect(unfollowed).toEqual([]);
  });

  it("is noticed where it does not", () => {
    const planted = (body: string): string[] =>
      missing(elementOf(`followSession(this, "view");\n${body}`, parts)!);
    expect(planted("this.session.layers.all;")).toEqual(["layers"]);
    expect(planted("const { tables: named, view } = this.session;")).toEqual(["tables"]);
    expect(planted("session.view.camera; other.layers; this.session.model;")).toEqual([]);
  });

  it("has no exception that is not needed", () => {
    for (const [file, exceptions] of Object.entries(kOnlyChanged))
      expect(missing(elements.get(file)!)).toEqual(exceptions);
  });
});
