import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";
import { compactStyles } from "./compact-styles";
import { compressedBeside } from "./compress";
import { thirdPartyNotices } from "./notices";
import { operationsWithoutScript } from "./operations";

// The server's address during development of the page with `npm run dev`.
const server = process.env["STRATA_SERVER"] ?? "http://127.0.0.1:8080";

// Replaces the Redoc modules that read other contract formats.
const unused = fileURLToPath(new URL("src/docs/unused.ts", import.meta.url));

export default defineConfig({
  plugins: [compactStyles(), operationsWithoutScript(), thirdPartyNotices(), compressedBeside()],
  resolve: {
    alias: {
      "@redocly/openapi-core/lib/bundle": unused,
      "@redocly/openapi-core/lib/config/config": unused,
      yaml: unused,
    },
  },
  build: {
    outDir: "dist",
    target: "es2022",
    sourcemap: true,
    manifest: true, // the import graph, for the test of the page size
    // The server's content security policy allows only files of the same origin, so the build
    // inlines no files into the page.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    rollupOptions: {
      input: { index: "index.html", docs: "docs.html", "kiosk-worker": "src/kiosk/worker.ts" },
      // A service worker needs a constant address.
      output: {
        entryFileNames: ({ name }) =>
          name === "kiosk-worker" ? "kiosk-worker.js" : "assets/[name]-[hash].js",
      },
    },
  },
  server: {
    proxy: {
      "/api": { target: server, ws: true },
      "/login": { target: server },
      "/id": { target: server },
      "/ogc": { target: server },
      "/sign-in": { target: server },
    },
  },
  test: {
    include: ["tests/**/*.test.ts"],
    setupFiles: ["tests/setup.ts"],
    // The machine may also run other checks.
    testTimeout: 20_000,
    environment: "node",
  },
});
