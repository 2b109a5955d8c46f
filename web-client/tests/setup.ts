// Node 18 has the Web Crypto API, but not as a global variable.
import { webcrypto } from "node:crypto";
import { loadLaterTexts, loadTexts } from "../src/texts";

if (!("crypto" in globalThis)) Object.defineProperty(globalThis, "crypto", { value: webcrypto });

await loadTexts("en", true, []);
await loadLaterTexts();
