// The server's own contract (openapi.json), for making requests and checking responses. In the
// Python tests, contract.py checks responses with a smaller part of JSON Schema.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { kRoot, load_module } from "./modules.mjs";

const kMethods = ["get", "put", "post", "patch", "delete"];
const kFormats = {
  uuid: /^[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}$/i,
  "date-time": (text) =>
    /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)$/.test(text) &&
    !Number.isNaN(Date.parse(text)),
};

const media_type_of = (headers) =>
  (headers["content-type"] ?? "").split(";")[0].trim().toLowerCase();

/**
 * Parses a parameter's text by the type of its schema. A text of another type stays a text, so the
 * schema refuses it.
 */
function read_parameter(schema, text) {
  if (schema.type === "boolean") return { true: true, false: false }[text] ?? text;
  if (schema.type !== "integer" && schema.type !== "number") return text;
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : text;
}

export class Contract {
  constructor(file = join(kRoot, "protocol", "generated", "openapi.json")) {
    this.document = JSON.parse(readFileSync(file, "utf8"));
    const Ajv = load_module("ajv/dist/2020.js").default;
    this.ajv = new Ajv({ strict: false, allErrors: true, formats: kFormats });
    this.ajv.addSchema(this.document, "contract");
    this.compiled = new Map();
    this.operations = Object.entries(this.document.paths).flatMap(([path, item]) =>
      kMethods
        .filter((method) => item[method])
        .map((method) => this.#operation(path, method, item)),
    );
  }

  /** Returns the target of a reference within the document. Returns other nodes unchanged. */
  resolve(node) {
    while (node.$ref)
      node = node.$ref
        .slice(2)
        .split("/")
        .reduce((at, name) => at[name.replaceAll("~1", "/").replaceAll("~0", "~")], this.document);
    return node;
  }

  #operation(path, method, item) {
    const { operationId, parameters = [], requestBody, responses, security } = item[method];
    return {
      id: operationId,
      method: method.toUpperCase(),
      path,
      parameters: [...(item.parameters ?? []), ...parameters].map((each) => {
        const parameter = this.resolve(each);
        return { ...parameter, schema: this.resolve(parameter.schema) };
      }),
      body: requestBody && {
        required: requestBody.required ?? false,
        content: requestBody.content,
      },
      responses: new Map(
        Object.entries(responses).map(([status, response]) => [
          Number(status),
          this.resolve(response),
        ]),
      ),
      is_open: security?.length === 0,
    };
  }

  /** Returns the errors of a value against a schema of the document. */
  faults_of(schema, value) {
    if (!this.compiled.has(schema)) {
      const text = JSON.stringify(schema).replaceAll('"$ref":"#/', '"$ref":"contract#/');
      this.compiled.set(schema, this.ajv.compile(JSON.parse(text)));
    }
    const validate = this.compiled.get(schema);
    return validate(value)
      ? []
      : validate.errors.map(
          ({ instancePath, message, params }) =>
            `${instancePath || "it"} ${message} ${JSON.stringify(params)}`,
        );
  }

  /** Returns the errors of a response: {status, headers, body: Buffer}. */
  faults_of_answer(operation, { status, headers, body }) {
    if (status >= 500) return [`${status} is the server's own fault`];
    const described = operation.responses.get(status);
    if (!described) return [`the contract has no ${status}`];
    const faults = [];
    for (const [name, header] of Object.entries(described.headers ?? {})) {
      const text = headers[name.toLowerCase()];
      const schema = this.resolve(this.resolve(header).schema);
      if (text !== undefined)
        faults.push(
          ...this.faults_of(schema, read_parameter(schema, String(text))).map(
            (fault) => `${name}: ${fault}`,
          ),
        );
    }
    const content = described.content ?? {};
    if (body.length === 0)
      return Object.keys(content).length === 0 ||
        "text/csv" in content ||
        "application/x-ndjson" in content
        ? faults
        : [...faults, "there is no body"];
    const media_type = media_type_of(headers);
    const known = content[media_type] ?? content["*/*"];
    if (!known) return [...faults, `the contract has no ${media_type || "body"} of ${status}`];
    if (status >= 400 && media_type !== "application/problem+json")
      faults.push(`${media_type} is no problem`);
    if (!/[/+]json$/.test(media_type) || !known.schema) return faults;
    let value = null;
    try {
      value = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(body));
    } catch (error) {
      return [...faults, `the body is no JSON: ${error.message}`];
    }
    if (status >= 400 && value.status !== status) faults.push(`the problem says ${value.status}`);
    return [...faults, ...this.faults_of(known.schema, value)];
  }

  /**
   * Returns the errors in a request's parameters and JSON according to the contract. The server
   * must not execute such a request. The server may ignore a parameter without a value.
   */
  faults_of_request(operation, { query, headers, body }) {
    const faults = [];
    const known = new Map(
      operation.parameters.filter((each) => each.in === "query").map((each) => [each.name, each]),
    );
    for (const [name, text] of query) {
      const parameter = known.get(name);
      if (!parameter) faults.push(`there is no parameter ${name}`);
      else if (text !== "")
        faults.push(
          ...this.faults_of(parameter.schema, read_parameter(parameter.schema, text)).map(
            (fault) => `${name}: ${fault}`,
          ),
        );
    }
    if (new Set(query.map(([name]) => name)).size < query.length)
      faults.push("a parameter is given twice");
    for (const { name, required } of known.values())
      if (required && !query.some(([given]) => given === name)) faults.push(`${name} is missing`);
    if (!operation.body) return faults;
    if (body === null || body.length === 0)
      return operation.body.required && !("text/csv" in operation.body.content)
        ? [...faults, "there is no body"]
        : faults;
    const json = operation.body.content["application/json"];
    if (!json || media_type_of(headers) !== "application/json") return faults;
    try {
      return [
        ...faults,
        ...this.faults_of(
          json.schema,
          JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(body)),
        ),
      ];
    } catch (error) {
      return [...faults, `the body is no JSON: ${error.message}`];
    }
  }
}
