// Requests of the contract's operations, made by fast-check. Most are valid, and others have an
// error. The object describes the request, so a failing request is readable: {path: {model:
// "wall"}, query: [["at", "3"]], headers, body: {json} | {text} | {hex} | {file} | null}.
import { arbitrary_of, damaged, fc, strange_number, strange_text } from "./arbitraries.mjs";
import {
  content_of,
  header_words,
  mostly,
  one,
  particulars,
  path_words,
  query_words,
  words,
} from "./vocabulary.mjs";

/** Returns a value once in `times` cases, and null otherwise. */
const once_in = (times, arbitrary) =>
  fc.oneof({ weight: times - 1, arbitrary: fc.constant(null) }, { weight: 1, arbitrary });
/**
 * A text for addresses. The headers of a request have at most 8 KiB, so a request with a longer
 * text would reach no operation.
 */
const strange_word = fc.oneof(
  strange_text.map((text) => text.slice(0, 300)),
  strange_number.map(String),
);

function body_of(contract, operation, { words: own = words, content = {} }) {
  const kinds = Object.keys(operation.body.content).map((type) => {
    if (type === "application/json") {
      const schema = operation.body.content[type].schema;
      return fc
        .oneof(
          { weight: 4, arbitrary: arbitrary_of(contract, schema, own) },
          { weight: 1, arbitrary: damaged(arbitrary_of(contract, schema, own)) },
        )
        .map((value) => ({ type, body: { json: value } }));
    }
    const bodies = content[type] ?? content_of[type];
    return bodies.map((body) =>
      type === "multipart/form-data"
        ? { type: `${type}; boundary=XyZ`, body: { form: [body.file] } }
        : { type, body },
    );
  });
  return operation.body.required
    ? fc.oneof(...kinds)
    : fc.oneof(fc.constant({ type: null, body: null }), ...kinds);
}

/** Operations with dependent parameters have some combinations that belong together. */
function query_of(operation, own) {
  const parameters = operation.parameters.filter((each) => each.in === "query");
  const each = parameters.map(({ name, schema, required }) => {
    const good =
      own.query?.[name] ??
      query_words[name] ??
      arbitrary_of({ resolve: (node) => node }, schema, words).map(String);
    const pair = good.map((text) => [name, text]);
    return required ? pair : once_in(3, pair);
  });
  const any = fc.tuple(...each).map((given) => given.filter((pair) => pair !== null));
  return own.queries ? fc.oneof(own.queries.map(Object.entries), any) : any;
}

function headers_of(operation) {
  const declared = operation.parameters
    .filter((each) => each.in === "header")
    .map(({ name }) => [name, once_in(6, header_words[name])]);
  const types = [...operation.responses.values()].flatMap((response) =>
    Object.keys(response.content ?? {}),
  );
  return fc
    .tuple(fc.record(Object.fromEntries(declared)), once_in(2, one(...types, "*/*")))
    .map(([headers, accept]) => ({ ...headers, Accept: accept }));
}

/** An error that affects the whole request. */
const mishap = fc.oneof(
  fc.record({ what: one("a parameter replaced"), n: fc.nat(), text: strange_word }),
  fc.record({ what: one("a parameter dropped", "a parameter twice"), n: fc.nat() }),
  fc.record({ what: one("a parameter too many"), text: strange_word }),
  fc.record({ what: one("the path replaced"), n: fc.nat(), text: strange_word }),
  fc.record({
    what: one(
      "no body",
      "another content type",
      "text cut short",
      "text after the end",
      "NaN",
      "bytes that are no UTF-8",
      "no token",
      "a wrong token",
      "a viewer's token",
      "a foreign origin",
      "an odd Accept",
    ),
  }),
);

function with_mishap(call, mishap) {
  if (!mishap) return call;
  const { what, n = 0, text } = mishap;
  const { path, query, headers, body } = call;
  const names = Object.keys(path);
  const at = query.length > 0 ? n % query.length : 0;
  const as_text = body?.json === undefined ? null : JSON.stringify(body.json);
  switch (what) {
    case "a parameter replaced":
      return { ...call, query: query.map(([name, value], i) => [name, i === at ? text : value]) };
    case "a parameter dropped":
      return { ...call, query: query.filter((_, i) => i !== at) };
    case "a parameter twice":
      return { ...call, query: query.length > 0 ? [...query, query[at]] : query };
    case "a parameter too many":
      return { ...call, query: [...query, ["extra", text]] };
    case "the path replaced":
      return names.length > 0
        ? { ...call, path: { ...path, [names[n % names.length]]: text } }
        : call;
    case "no body":
      return { ...call, body: null };
    case "another content type":
      return { ...call, headers: { ...headers, "Content-Type": "text/plain" } };
    case "text cut short":
      return as_text ? { ...call, body: { text: as_text.slice(0, -1) } } : call;
    case "text after the end":
      return as_text ? { ...call, body: { text: `${as_text} {}` } } : call;
    case "NaN":
      return as_text
        ? { ...call, body: { text: as_text.replace(/-?\d+(\.\d+)?|true|false/, "NaN") } }
        : call;
    case "bytes that are no UTF-8":
      return as_text
        ? {
            ...call,
            body: {
              hex: Buffer.concat([
                Buffer.from(as_text.slice(0, -1)),
                Buffer.from([0xff, 0x22]),
              ]).toString("hex"),
            },
          }
        : call;
    case "no token":
      return { ...call, token: null };
    case "a wrong token":
      return { ...call, token: "nobody's" };
    case "a viewer's token":
      return { ...call, token: "(a viewer's token)" };
    case "a foreign origin":
      return { ...call, headers: { ...headers, Origin: "https://elsewhere.example" } };
    case "an odd Accept":
      return { ...call, headers: { ...headers, Accept: "image/webp" } };
    default:
      throw new Error(what);
  }
}

const kept = (record) =>
  Object.fromEntries(Object.entries(record).filter(([, value]) => value !== null));

export function calls_of(contract, operation) {
  const own = particulars[operation.id] ?? {};
  const in_path = operation.parameters
    .filter((each) => each.in === "path")
    .map(({ name }) => [
      name,
      own.path?.[name] ??
        (name === "model" && operation.path.includes("{layer}")
          ? mostly("wall")
          : path_words[name]),
    ]);
  return fc
    .record({
      path: fc.record(Object.fromEntries(in_path)),
      query: query_of(operation, own),
      headers: headers_of(operation),
      content: operation.body
        ? body_of(contract, operation, own)
        : fc.constant({ type: null, body: null }),
      mishap: once_in(3, mishap),
    })
    .map(({ path, query, headers, content, mishap: wrong }) =>
      with_mishap(
        {
          operation: operation.id,
          path,
          query,
          headers: kept({ "Content-Type": content.type, ...headers }),
          body: content.body,
          token: "(the owner's token)",
        },
        wrong,
      ),
    );
}
