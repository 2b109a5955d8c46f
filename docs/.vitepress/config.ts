// Builds the guide, a site of the Markdown files in this folder. The server serves it at /guide.
import { fileURLToPath } from "node:url";
import { transformerStyleToClass } from "@shikijs/transformers";
import { defineConfig } from "vitepress";
import { thirdPartyNotices } from "../../web-client/notices";
import { titled } from "./titles";
import { withoutInline } from "./without-inline";
import { alignedByClass, linksToPublicFiles, linksWithinTheGuide } from "./markdown";

const file = (path: string): string => fileURLToPath(new URL(path, import.meta.url));
const base = "/guide/"; // the address at which the server serves the guide
const classes = transformerStyleToClass({ classPrefix: "code-" });

// The order of the pages in the side bar. The build fails if a page is missing in this list or in
// the folder.
const howTo = {
  "Work on the surface": [
    "use-the-page",
    "paint-a-layer",
    "clean-up-regions",
    "measure",
    "measure-distances",
    "find-cracks",
    "find-stones",
    "interpolate-readings",
    "import-point-clouds",
    "import-several-scans",
    "import-maps",
  ],
  "Keep records": ["keep-records", "use-lists-of-terms", "attach-files", "use-photographs"],
  "Work with others": [
    "work-together",
    "comment",
    "review-edits",
    "follow-activity",
    "read-the-audit-log",
    "see-the-past",
    "compare-surveys",
    "bill-quantities",
    "compare-observers",
    "rate-damage",
    "use-the-trash",
  ],
  "Show results": ["save-views", "print-figures", "write-a-condition-report", "export-to-3d-programs", "connect-gis-programs", "publish-linked-data", "deposit-a-project", "make-tours", "run-a-kiosk", "show-the-demo"],
  Scripts: ["write-scripts", "run-an-analysis", "query-with-sql"],
  Administration: [
    "install",
    "operate-a-site",
    "run-several-nodes",
    "move-to-three-nodes",
    "watch-the-server",
    "back-up-and-restore",
    "keep-files-outside-the-database",
    "manage-people",
    "sign-in-with-openid-connect",
    "limit-visibility",
  ],
};
const reference = [
  "glossary",
  "keyboard",
  "conditions",
  "queries",
  "computed-layers",
  "tables",
  "formats",
  "sample-exports",
  "deposits",
  "settings",
  "http",
  "errors",
  "security",
];
const explanation = ["texels", "areas", "history", "review", "layers-and-records"];

export default defineConfig({
  lang: "en",
  title: "Strata",
  description: "GIS layers on the surface of 3D heritage models",
  base,
  head: [["link", { rel: "icon", href: "/favicon.svg", type: "image/svg+xml" }]],
  cleanUrls: true,
  // With this option, VitePress would add a style element, which the security policy forbids.
  appearance: { disableTransition: false },
  srcExclude: ["developer/**"],
  metaChunk: true,
  markdown: {
    codeTransformers: [classes],
    config: (md) => {
      linksWithinTheGuide(md);
      linksToPublicFiles(md, base);
      alignedByClass(md);
    },
  },
  vite: {
    plugins: [thirdPartyNotices()],
    resolve: {
      alias: [
        { find: /^.*\/VPAlgoliaSearchBox\.vue$/, replacement: file("theme/nothing.ts") },
        { find: "@docsearch/css", replacement: file("theme/search-button.css") },
      ],
    },
  },
  buildEnd: withoutInline(() => classes.getCSS()),
  themeConfig: {
    nav: [
      { text: "Get started", link: "/get-started" },
      { text: "How to", link: "/how-to/", activeMatch: "/how-to/" },
      { text: "Reference", link: "/reference/", activeMatch: "/reference/" },
      { text: "Explanation", link: "/explanation/", activeMatch: "/explanation/" },
    ],
    sidebar: [
      { text: "Get started", link: "/get-started" },
      ...Object.entries(howTo).map(([text, pages]) => ({
        text,
        items: titled("how-to", pages),
      })),
      { text: "Reference", items: titled("reference", reference) },
      { text: "Explanation", items: titled("explanation", explanation) },
    ],
    outline: [2, 3],
    search: { provider: "local" },
    docFooter: { prev: "Previous", next: "Next" },
  },
});
