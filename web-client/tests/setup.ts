// Node 18 has the web's crypto, but not as a global.
import { webcrypto } from "node:crypto";
import { load_texts } from "../src/texts";

if (!("crypto" in globalThis)) Object.defineProperty(globalThis, "crypto", { value: webcrypto });

await load_texts("en", true, []);
