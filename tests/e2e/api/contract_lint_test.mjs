// Checks the contract with Redocly's recommended rules for OpenAPI. The rules that the server
// enforces are then also visible to other generators and validators.
import assert from "node:assert/strict";
import { join } from "node:path";
import { kRoot, load_module } from "../support/js/modules.mjs";

const { createConfig, lint } = load_module("@redocly/openapi-core");

/**
 * Operations with another success status. The owner's link and the sign-in with a provider
 * redirect (303), and a live connection becomes a WebSocket (101).
 */
const kWithoutSuccess = [
  "#/paths/~1login/get/responses",
  "#/paths/~1sign-in~1{provider}/get/responses",
  "#/paths/~1sign-in~1{provider}~1callback/get/responses",
  "#/paths/~1api~1v1~1models~1{model}~1live/get/responses",
];

/**
 * Responses that the generator adds to the operations of the JSON file (`generator/openapi.py`).
 */
const kByGenerator = [
  "#/components/responses/UnknownHost",
  "#/components/responses/HeaderTooLarge",
  "#/components/responses/UnchangedAnswer",
  "#/components/responses/VersionMissing",
];
const is_known = ({ ruleId, location: [{ pointer }] }, file) =>
  (ruleId === "operation-2xx-response" && kWithoutSuccess.includes(pointer)) ||
  (ruleId === "no-unused-components" && file === "openapi.yaml" && kByGenerator.includes(pointer));

const config = await createConfig({ extends: ["recommended"] });
for (const file of ["openapi.yaml", "generated/openapi.json"]) {
  const found = await lint({ ref: join(kRoot, "protocol", file), config });
  const faults = found.filter((fault) => !is_known(fault, file));
  assert.deepEqual(
    faults.map(
      ({ severity, ruleId, message, location }) =>
        `${file} ${location[0].pointer}: ${severity} ${ruleId}: ${message}`,
    ),
    [],
  );
}
console.log("the contract is valid");
