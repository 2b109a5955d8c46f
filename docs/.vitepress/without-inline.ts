// The server's content security policy forbids scripts and styles inside pages. This file moves the
// scripts and styles that VitePress writes into its pages to separate files.
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { SiteConfig } from "vitepress";
import { compress } from "../../web-client/compress";
import { checkAllListed } from "./titles";

function* files(folder: string): Generator<string> {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const file = join(folder, entry.name);
    if (entry.isDirectory()) yield* files(file);
    else yield file;
  }
}

export function withoutInline(codeStyles: () => string): (site: SiteConfig) => void {
  return (site) => {
    checkAllListed();
    const asset = (text: string, kind: "js" | "css"): string => {
      const hash = createHash("sha256").update(text).digest("hex").slice(0, 8);
      writeFileSync(join(site.outDir, "assets", `inline.${hash}.${kind}`), text);
      return `/guide/assets/inline.${hash}.${kind}`;
    };
    const styles = `<link rel="stylesheet" href="${asset(codeStyles(), "css")}">`;
    for (const file of files(site.outDir))
      if (file.endsWith(".html"))
        writeFileSync(
          file,
          readFileSync(file, "utf8")
            .replace(
              /<script(?![^>]*\ssrc=)[^>]*>([\s\S]*?)<\/script>/g,
              (_, code: string) => `<script src="${asset(code, "js")}"></script>`,
            )
            // theme/strata.css replaces these styles.
            .replace(/ style="[^"]*"/g, "")
            .replace("</head>", `${styles}</head>`),
        );
    compress(site.outDir);
  };
}
