// The server's tests read the same fixtures (tests/unit/protocol/messages_test.cpp). Both must
// agree.
import Ajv from "ajv";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";

import bundle from "../../../protocol/generated/schemas.json";
import { parse_server_message } from "../../src/core/protocol.gen";

interface Fixture {
  name: string;
  schema: string;
  json?: unknown;
  text?: string;
  /**
   * Whether the schema accepts a message that the server refuses. A schema cannot describe some
   * reasons, such as singular matrices.
   */
  schema_passes?: boolean;
}

const folder = fileURLToPath(new URL("../../../protocol/fixtures", import.meta.url));
function fixtures(kind: "valid" | "invalid"): Fixture[] {
  return readdirSync(join(folder, kind)).map((file) => ({
    name: file.replace(".json", ""),
    ...(JSON.parse(readFileSync(join(folder, kind, file), "utf8")) as Omit<Fixture, "name">),
  }));
}

const ajv = new Ajv({ strict: true, strictTypes: false, strictRequired: false });
ajv.addSchema(bundle, "strata");
function passes(schema: string, value: unknown): boolean {
  const validate = ajv.getSchema(`strata#/definitions/${schema}`);
  if (!validate) throw new Error(`no schema ${schema}`);
  return validate(value) as boolean;
}

describe("messages", () => {
  for (const { name, schema, json } of fixtures("valid"))
    it(`the valid fixture "${name}" passes`, () => {
      expect(passes(schema, json)).toBe(true);
    });

  for (const { name, schema, json, schema_passes: schemaPasses } of fixtures("invalid").filter(
    (f) => f.schema !== "ClientMessage",
  ))
    it(`the invalid fixture "${name}" is ${schemaPasses ? "left to the server" : "refused"}`, () => {
      expect(passes(schema, json)).toBe(schemaPasses ?? false);
    });

  const fromServer = [
    "Welcome",
    "Applied",
    "Saved",
    "Unsaved",
    "LayerEvent",
    "ModelEvent",
    "RecordEvent",
  ];
  for (const { name, json } of fixtures("valid").filter((f) => fromServer.includes(f.schema)))
    it(`the server's message "${name}" is read`, () => {
      expect(parse_server_message(JSON.stringify(json))).toEqual(json);
    });

  it("a message with an unknown op throws", () => {
    for (const text of ['{"op":"later"}', "{}", "null", "[]", '"applied"', "{"])
      expect(() => parse_server_message(text)).toThrow();
  });
});
