// Node 18 has the web's crypto, but not as a global.
import { webcrypto } from "node:crypto";
import { loadTexts } from "../src/texts";

if (!("crypto" in globalThis)) Object.defineProperty(globalThis, "crypto", { value: webcrypto });

await loadTexts("en", true, []);
