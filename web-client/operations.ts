// Writes the operations of the contract to docs.html, for browsers without JavaScript.
import { readFileSync } from "node:fs";
import type { Plugin } from "vite";

const kContract = new URL("../protocol/generated/openapi.json", import.meta.url);
const kEntities: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;" };

const escaped = (text: string) => text.replace(/[&<>]/g, (each) => kEntities[each]!);

function listOfOperations(): string {
  const { paths } = JSON.parse(readFileSync(kContract, "utf8")) as {
    paths: Record<string, Record<string, { summary?: string }>>;
  };
  return Object.entries(paths)
    .flatMap(([path, item]) =>
      Object.entries(item)
        .filter(([, operation]) => operation.summary !== undefined)
        .map(
          ([method, { summary }]) =>
            `<li><code>${method.toUpperCase()} ${escaped(path)}</code> ${escaped(summary!)}</li>`,
        ),
    )
    .join("\n          ");
}

export function operationsWithoutScript(): Plugin {
  return {
    name: "operations-without-script",
    transformIndexHtml: (html) => html.replace("<!-- operations -->", listOfOperations),
  };
}
