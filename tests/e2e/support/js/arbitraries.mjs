// Values for fast-check from JSON Schemas, valid and invalid ones. Valid values respect members,
// types and limits. The caller provides values that a schema cannot describe, such as existing
// layers or the syntax of a condition: `words.by_name` for members and parameters,
// `words.by_schema` for the contract's components.
import { load_module } from "./modules.mjs";

export const fc = load_module("fast-check");

// added to the minimum of a schema; other tests cover the limits of long lists
const kManyItems = 3;
const kMostNested = 2;
const kStrangeTexts = [
  "",
  " ",
  "-1",
  "0",
  "1e999",
  "NaN",
  "null",
  "true",
  "..",
  "../../etc/passwd",
  "%00",
  "%",
  "a\u0000b",
  "\u202eabc",
  "ß💥e\u0301",
  "'",
  '"',
  "\\",
  "';--",
  "${x}",
  "<b>x</b>",
  "a,b;c\td",
  "2024-02-30",
  "0x10",
  "\ufeffa",
  "\ud800",
  "a".repeat(300),
  "ä".repeat(5000),
  "99999999999999999999",
  "(".repeat(2000),
  "not ".repeat(900),
];
const kStrangeNumbers = [
  -1,
  0,
  0.5,
  255,
  256,
  65536,
  2 ** 31,
  2 ** 32,
  2 ** 53,
  2 ** 63,
  -(2 ** 63),
  1e15,
  -1e15,
  1e38,
  1.7e308,
  -1.7e308,
  5e-324,
];

export const strange_text = fc.oneof(
  fc.constantFrom(...kStrangeTexts),
  fc.string({ unit: "binary", maxLength: 40 }),
);
export const strange_number = fc.constantFrom(...kStrangeNumbers);
export const strange_value = fc.oneof(
  strange_text,
  strange_number,
  fc.constantFrom(
    null,
    true,
    false,
    [],
    {},
    [[]],
    [null],
    { a: 1 },
    Array(40).fill(1),
    JSON.parse("[".repeat(40) + "]".repeat(40)),
  ),
);

const kWords = ["Apse", "loose", "12.5", "x", "crack 3", "Päivä", "北壁", "note"];

function text_of({ minLength = 0, maxLength = 200, pattern }) {
  if (pattern)
    return fc
      .stringMatching(new RegExp(pattern))
      .filter((text) => text.length >= minLength && text.length <= maxLength);
  const fits = (text) => [...text].length >= minLength && [...text].length <= maxLength;
  return fc.oneof(
    { weight: 4, arbitrary: fc.constantFrom(...kWords.filter(fits)) },
    { weight: 1, arbitrary: fc.string({ minLength, maxLength: Math.min(maxLength, 30) }) },
  );
}

function number_of({ type, minimum = -1e6, exclusiveMinimum, maximum = 1e6 }) {
  const low = Math.max(exclusiveMinimum ?? minimum, -1e15);
  const high = Math.min(maximum, 1e15);
  const small = fc
    .integer({
      min: Math.max(Math.ceil(low), -10),
      max: Math.max(Math.min(Math.floor(high), 10), Math.ceil(low)),
    })
    .filter((n) => exclusiveMinimum === undefined || n > low);
  if (type === "integer")
    return fc.oneof(
      { weight: 4, arbitrary: small },
      { weight: 1, arbitrary: fc.integer({ min: Math.ceil(low), max: Math.floor(high) }) },
    );
  return fc.oneof(
    {
      weight: 2,
      arbitrary: fc.double({
        min: low,
        max: high,
        minExcluded: exclusiveMinimum !== undefined,
        noNaN: true,
      }),
    },
    { weight: high < 1 ? 0 : 3, arbitrary: small },
  );
}

/**
 * Makes objects with some of the optional members, and rarely with all. Most of them exclude one
 * another in ways that a schema does not describe.
 */
function object_of(contract, schema, words, open) {
  const members = Object.entries(schema.properties ?? {});
  if (members.length === 0) {
    const values =
      typeof schema.additionalProperties === "object"
        ? arbitrary_of(contract, schema.additionalProperties, words, open)
        : fc.constant(1);
    return schema.additionalProperties === false
      ? fc.constant({})
      : fc.dictionary(fc.constantFrom("es", "pt-BR", "name", "depth"), values, { maxKeys: 2 });
  }
  const required = schema.required ?? [];
  const possible = members
    .map(([name, member]) => [
      name,
      words.by_name[name] ?? arbitrary_of(contract, member, words, open),
    ])
    .filter(([, values]) => values !== null);
  const names = possible.map(([name]) => name);
  if (!required.every((name) => names.includes(name))) return null;
  const optional = names.filter((name) => !required.includes(name));
  const all = fc.record(Object.fromEntries(possible));
  const fewest = Math.max(0, (schema.minProperties ?? 0) - required.length);
  return fc
    .tuple(
      all,
      fc.subarray(optional, {
        minLength: Math.min(fewest, optional.length),
        maxLength: Math.min(Math.max(fewest, 2), optional.length),
      }),
    )
    .map(([value, chosen]) =>
      Object.fromEntries(
        Object.entries(value).filter(([name]) => required.includes(name) || chosen.includes(name)),
      ),
    );
}

/**
 * `oneOf` and `anyOf` next to `properties` list the allowed combinations of members. Each choice
 * becomes a separate schema.
 */
function choices_of(contract, schema) {
  const word = schema.oneOf ? "oneOf" : "anyOf";
  const { [word]: choices, ...rest } = schema;
  if (!schema.properties) return choices;
  const named = new Set(choices.flatMap((choice) => choice.required ?? []));
  return choices.map((choice) => {
    const required = [...new Set([...(rest.required ?? []), ...(choice.required ?? [])])];
    const kept = Object.entries({ ...rest.properties, ...choice.properties }).filter(
      ([name]) => required.includes(name) || !named.has(name),
    );
    return { ...rest, required, properties: Object.fromEntries(kept) };
  });
}

/**
 * Returns null for values that contain values of the same schema in more than kMostNested levels.
 * `open` are the schemas that contain this one.
 */
export function arbitrary_of(contract, schema, words, open = []) {
  const component = schema.$ref?.split("/").at(-1);
  if (component && words.by_schema[component]) return words.by_schema[component];
  if (component) {
    if (open.filter((each) => each === component).length === kMostNested) return null;
    open = [...open, component];
  }
  const { description, default: ignored, ...meant } = contract.resolve(schema);
  if ("const" in meant) return fc.constant(meant.const);
  if (meant.enum) return fc.constantFrom(...meant.enum);
  if (meant.oneOf || meant.anyOf) {
    const choices = choices_of(contract, meant)
      .map((choice) => arbitrary_of(contract, choice, words, open))
      .filter((choice) => choice !== null);
    return choices.length > 0 ? fc.oneof(...choices) : null;
  }
  switch (meant.type) {
    case "null":
      return fc.constant(null);
    case "boolean":
      return fc.boolean();
    case "string":
      return text_of(meant);
    case "integer":
    case "number":
      return number_of(meant);
    case "array": {
      const fewest = meant.minItems ?? 0;
      const items = arbitrary_of(contract, meant.items ?? {}, words, open);
      if (items === null) return fewest > 0 ? null : fc.constant([]);
      return fc.array(items, {
        minLength: fewest,
        maxLength: Math.min(meant.maxItems ?? Infinity, fewest + kManyItems),
        size: "max",
      });
    }
    case "object":
      return object_of(contract, meant, words, open);
    default:
      return fc.constantFrom(1, "x", null);
  }
}

/** Returns the path to every value in a JSON value. */
function places_of(value, way = []) {
  if (value === null || typeof value !== "object") return [way];
  return [way, ...Object.entries(value).flatMap(([name, item]) => places_of(item, [...way, name]))];
}

function with_change(value, [name, ...rest], change) {
  if (name === undefined) return change(value);
  const copy = Array.isArray(value) ? [...value] : { ...value };
  const item = with_change(value[name], rest, change);
  if (item === undefined && !Array.isArray(copy)) delete copy[name];
  else copy[name] = item ?? null;
  return copy;
}

/** Makes values with one error: another value, a missing member, or an additional one. */
export function damaged(arbitrary) {
  return fc
    .tuple(
      arbitrary,
      fc.nat(),
      fc.constantFrom("replace", "drop", "add"),
      strange_value,
      strange_text,
    )
    .map(([value, n, how, strange, name]) => {
      const places = places_of(value);
      return with_change(value, places[n % places.length], (item) => {
        if (how === "drop" && places.length > 1) return undefined;
        if (how === "add" && item !== null && typeof item === "object" && !Array.isArray(item))
          return { ...item, [name || "extra"]: strange };
        return strange;
      });
    });
}
