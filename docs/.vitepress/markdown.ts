// Changes the way in which VitePress renders the Markdown of the guide.
import { posix } from "node:path";
import type { MarkdownRenderer } from "vitepress";

function isOutside(page: string, target: string): boolean {
  if (/^([a-z]+:|[#/])/.test(target)) return false;
  const path = posix.normalize(posix.join(posix.dirname(page), target));
  return path.startsWith("..") || path.startsWith("developer/");
}

/**
 * Replaces links to files outside the guide by plain text. These links are for readers of the
 * repository.
 */
export function linksWithinTheGuide(md: MarkdownRenderer): void {
  md.core.ruler.push("links-within-the-guide", (state) => {
    const page = (state.env as { relativePath?: string }).relativePath ?? "";
    for (const block of state.tokens) {
      let isDropped = false;
      block.children = (block.children ?? []).filter((token) => {
        if (token.type === "link_open") isDropped = isOutside(page, token.attrGet("href") ?? "");
        const drops = isDropped && (token.type === "link_open" || token.type === "link_close");
        if (token.type === "link_close") isDropped = false;
        return !drops;
      });
    }
  });
}

/**
 * Links to files in the folder public by their address in the guide. In the repository, these links
 * are relative.
 */
export function linksToPublicFiles(md: MarkdownRenderer, base: string): void {
  md.core.ruler.push("links-to-public-files", (state) => {
    for (const { children } of state.tokens)
      for (const token of children ?? []) {
        const [, file] = /^(?:\.\.\/)+public\/(.+)$/.exec(token.attrGet("href") ?? "") ?? [];
        if (!file) continue;
        token.attrSet("href", `${base}${file}`);
        token.attrSet("target", "_self"); // VitePress takes other links for links to pages
      }
  });
}

/** Aligns cells of tables with a class, because the security policy forbids style attributes. */
export function alignedByClass(md: MarkdownRenderer): void {
  md.core.ruler.push("aligned-by-class", (state) => {
    for (const token of state.tokens) {
      const side = /^text-align:(\w+)$/.exec(token.attrGet("style") ?? "")?.[1];
      if (!side) continue;
      token.attrs = (token.attrs ?? []).filter(([name]) => name !== "style");
      token.attrJoin("class", `align-${side}`);
    }
  });
}
