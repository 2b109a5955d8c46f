// Prints the report of Khronos' validator about a glTF file, as JSON. The argument is the file.
import { readFile } from "node:fs/promises";
import validator from "gltf-validator";

const report = await validator.validateBytes(new Uint8Array(await readFile(process.argv[2])), {
  maxIssues: 100,
});
console.log(JSON.stringify(report));
