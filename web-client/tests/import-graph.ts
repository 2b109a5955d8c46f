// Finds the imports between the page's files, including types, and checks them.

import { readdirSync, readFileSync } from "node:fs";
import { join, posix } from "node:path";
import ts from "typescript";

export interface Import {
  to: string;
  /** Whether the import exists only for types, and not at run time. */
  typeOnly: boolean;
}
/** The imports of each file. The key is the file's path in `src`, separated by `/`. */
export type ImportGraph = ReadonlyMap<string, readonly Import[]>;

/**
 * Lower folders are first. A file imports only from its own folder and from the folders before it.
 */
const kFolders = [
  "core",
  "texts",
  "math",
  "net",
  "domain",
  "ui",
  "tools",
  "session",
  "features",
  "shell",
];
/** The folders of the kiosk page, which does not load the texts of the workbench page. */
const kOfKiosk = ["core", "math", "net", "domain", "ui", "tools", "session", "kiosk"];
/** The file that loads either the workbench or the kiosk. */
const kEntry = "shell/main.ts";
/** The interface that names the parts of all features. */
const kSession = "session/model-session.ts";

export function readImports(root: string): ImportGraph {
  const files = readdirSync(root, { recursive: true, encoding: "utf8" })
    .map((file) => file.replaceAll("\\", "/"))
    .filter((file) => file.endsWith(".ts"));
  const known = new Set(files);
  return new Map(
    files.map((file) => {
      const found = importsOf(file, readFileSync(join(root, file), "utf8"));
      return [file, found.flatMap((each) => resolve(each, known))];
    }),
  );
}

/** Returns the targets of imports. In the code they are relative to the file's folder. */
export function importsOf(file: string, code: string): Import[] {
  const found: Import[] = [];
  const add = (specifier: ts.Node | undefined, typeOnly: boolean): void => {
    if (specifier && ts.isStringLiteralLike(specifier) && specifier.text.startsWith("."))
      found.push({ to: posix.join(posix.dirname(file), specifier.text), typeOnly });
  };
  const visit = (node: ts.Node): void => {
    if (ts.isImportDeclaration(node)) add(node.moduleSpecifier, isOfTypes(node.importClause));
    else if (ts.isExportDeclaration(node)) add(node.moduleSpecifier, node.isTypeOnly);
    else if (ts.isImportTypeNode(node) && ts.isLiteralTypeNode(node.argument))
      add(node.argument.literal, true);
    else if (ts.isCallExpression(node) && node.expression.kind === ts.SyntaxKind.ImportKeyword)
      add(node.arguments[0], false);
    ts.forEachChild(node, visit);
  };
  visit(ts.createSourceFile(file, code, ts.ScriptTarget.Latest, true));
  return found;
}

function isOfTypes(clause: ts.ImportClause | undefined): boolean {
  if (!clause || clause.isTypeOnly) return clause !== undefined;
  const { namedBindings: named } = clause;
  return (
    !clause.name &&
    named !== undefined &&
    ts.isNamedImports(named) &&
    named.elements.length > 0 &&
    named.elements.every((each) => each.isTypeOnly)
  );
}

function resolve({ to, typeOnly }: Import, known: ReadonlySet<string>): Import[] {
  const file = [`${to}.ts`, `${to}/index.ts`].find((each) => known.has(each));
  return file ? [{ to: file, typeOnly }] : [];
}

const folderOf = (file: string): string => file.slice(0, file.indexOf("/"));
const featureOf = (file: string): string => file.split("/")[1]!;

function mayImport(from: string, { to, typeOnly }: Import): boolean {
  const [own, other] = [folderOf(from), folderOf(to)];
  // this folder contains the page of the contract
  if (own === "docs" || other === "docs") return own === other;
  if (own === "kiosk") return kOfKiosk.includes(other);
  if (other === "kiosk") return from === kEntry;
  if (own === "features" && other === "features") return featureOf(from) === featureOf(to);
  if (from === kSession && other === "features") return typeOnly;
  return kFolders.includes(own) && kFolders.indexOf(other) <= kFolders.indexOf(own);
}

/** Returns imports from a lower folder to a higher one, and between features. */
export const wrongImports = (graph: ImportGraph): string[] =>
  [...graph].flatMap(([from, imports]) =>
    imports.filter((each) => !mayImport(from, each)).map(({ to }) => `${from} imports ${to}`),
  );

/** Returns circular imports, with one circle for each file that is reached twice. */
export function circles(graph: ImportGraph): string[] {
  const found: string[] = [];
  const done = new Set<string>();
  const visit = (file: string, way: readonly string[]): void => {
    const at = way.indexOf(file);
    if (at >= 0) found.push([...way.slice(at), file].join(" → "));
    if (at >= 0 || done.has(file)) return;
    for (const { to } of graph.get(file) ?? []) visit(to, [...way, file]);
    done.add(file);
  };
  for (const file of graph.keys()) visit(file, []);
  return found;
}
