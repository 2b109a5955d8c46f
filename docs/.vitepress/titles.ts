// Makes the entries of the side bar from the titles of the pages.
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const docs = fileURLToPath(new URL("..", import.meta.url));
const listed = new Map<string, Set<string>>();

export function titled(folder: string, pages: string[]): { text: string; link: string }[] {
  const seen = listed.get(folder) ?? new Set(["index"]);
  listed.set(folder, seen);
  return pages.map((page) => {
    seen.add(page);
    const title = /^# (.+)$/m.exec(readFileSync(`${docs}/${folder}/${page}.md`, "utf8"))?.[1];
    if (!title) throw new Error(`docs/${folder}/${page}.md has no title`);
    return { text: title, link: `/${folder}/${page}` };
  });
}

// Throws an error if the side bar does not list a page.
export function checkAllListed(): void {
  for (const [folder, seen] of listed)
    for (const file of readdirSync(`${docs}/${folder}`))
      if (file.endsWith(".md") && !seen.has(file.slice(0, -".md".length)))
        throw new Error(`docs/.vitepress/config.ts does not list docs/${folder}/${file}`);
}
