// Pages of the guide link to files of the source that are not part of the guide, for readers of the
// repository. In the guide these links become plain text.
import { posix } from "node:path";
import type { MarkdownRenderer } from "vitepress";

function isOutside(page: string, target: string): boolean {
  if (/^([a-z]+:|[#/])/.test(target)) return false;
  const path = posix.normalize(posix.join(posix.dirname(page), target));
  return path.startsWith("..") || path.startsWith("developer/");
}

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
