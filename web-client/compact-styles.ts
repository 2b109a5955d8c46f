// Removes comments and indentation from css`…` templates in the build. The minifier does not change
// template strings.
import MagicString from "magic-string";
import type { Plugin } from "vite";

const kStyles = /\bcss`([^`]*)`/g;
const kSurplus = /\s*\/\*[^]*?\*\/\s*|\s*([{};])\s*|\s+/g;

export function compactStyles(): Plugin {
  return {
    name: "compact-styles",
    apply: "build",
    enforce: "pre",
    transform(code, id) {
      if (!id.endsWith(".ts") || id.includes("/node_modules/")) return null;
      const text = new MagicString(code);
      for (const { 0: whole, 1: style, index } of code.matchAll(kStyles))
        for (const surplus of style!.matchAll(kSurplus)) {
          const begin = index + whole.indexOf("`") + 1 + surplus.index;
          text.update(begin, begin + surplus[0].length, surplus[1] ?? " ");
        }
      return { code: text.toString(), map: text.generateMap({ hires: "boundary" }) };
    },
  };
}
