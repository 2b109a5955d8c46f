// Reports the phrases of avoid.json in the documents and in the comments of the source. textlint
// reads Markdown completely, but only the comments of a source file.
//
//   node plain.mjs [FILE…]    without files: all that git tracks

import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { extname } from "node:path";
import { fileURLToPath } from "node:url";
import { TextlintKernel } from "@textlint/kernel";
import markdown from "@textlint/textlint-plugin-markdown";
import text from "@textlint/textlint-plugin-text";
import { commentsOf, kCommented } from "./comments.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const avoided = JSON.parse(readFileSync(new URL("avoid.json", import.meta.url), "utf8")).map(
  ({ avoid, write, case: exact }) => ({ pattern: new RegExp(avoid, exact ? "gm" : "gim"), write }),
);

function plainEnglish({ Syntax, report, RuleError, getSource, locator }) {
  return {
    [Syntax.Str](node) {
      for (const { pattern, write } of avoided)
        for (const found of getSource(node).matchAll(pattern))
          report(
            node,
            new RuleError(`“${found[0].trim()}”: ${write}`, {
              padding: locator.at(found.index),
            }),
          );
    },
  };
}

const kernel = new TextlintKernel();
const options = (file, ext) => ({
  ext,
  filePath: file,
  plugins: [
    { pluginId: "markdown", plugin: markdown.default ?? markdown },
    { pluginId: "text", plugin: text.default ?? text },
  ],
  rules: [{ ruleId: "plain-english", rule: plainEnglish }],
});

// Three kinds of files are skipped. The changelog keeps the texts of earlier releases. A migration
// must not change after it was applied. The texts of generated files come from their source.
const skipped =
  /(^|\/)(node_modules|generated|fixtures|corpus|migrations)\/|\.gen\.ts$|^CHANGELOG\.md$/;
const files =
  process.argv.length > 2
    ? process.argv.slice(2)
    : execFileSync("git", ["ls-files"], { cwd: root, encoding: "utf8" }).trim().split("\n");

let faults = 0;
let read = 0;
for (const file of files) {
  const kind = extname(file) || file.split("/").pop();
  if (skipped.test(file) || !(kind === ".md" || kCommented(kind))) continue;
  const source = readFileSync(`${root}/${file}`, "utf8");
  const { messages } = await (kind === ".md"
    ? kernel.lintText(source, options(file, ".md"))
    : kernel.lintText(commentsOf(source, kind), options(file, ".txt")));
  read += 1;
  for (const { loc, message } of messages) {
    console.error(`${file}:${loc.start.line}: ${message}`);
    faults += 1;
  }
}
console.error(`${read} files read, ${faults} phrases that the guide to style avoids`);
process.exitCode = faults > 0 || read === 0 ? 1 : 0;
