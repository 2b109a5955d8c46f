"""Checks the server's responses with its own contract (openapi.json): the status, and the JSON of
the body, member by member."""
import gzip
import json
import os
import re

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))

FORBIDDEN_OF_ANY_CALL = (b"Not allowed for kiosks", b'"field":"Origin"')

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def address_of(path):
    """Returns a path of the contract as `StrataServer.request` takes it."""
    return path.removeprefix("/api/v1") if path.startswith("/api/v1/") else "/" + path


def _is_type(value, name):
    if name in ("number", "integer"):
        return not isinstance(value, bool) and (
            isinstance(value, int)
            or (isinstance(value, float) and (name == "number" or value.is_integer()))
        )
    return isinstance(value, TYPES[name])


class Contract:
    def __init__(self, file=os.path.join(ROOT, "protocol", "generated", "openapi.json")):
        with open(file, encoding="utf-8") as opened:
            self.document = json.load(opened)
        self.paths = [
            (re.compile(re.sub(r"\\{[^/]*?\\}", "[^/]+", re.escape(path)) + "$"), operations)
            for path, operations in self.document["paths"].items()
        ]
        self.paths.sort(key=lambda entry: entry[0].pattern.count("[^/]+"))

    def _resolve(self, node):
        while "$ref" in node:
            target = self.document
            for part in node["$ref"].lstrip("#/").split("/"):
                target = target[part]
            node = target
        return node

    def check(self, method, target, answer):
        """Raises an error if the contract does not contain the response."""
        path, method = target.split("?")[0], "GET" if method == "HEAD" else method
        operation = next(
            (
                operations[method.lower()]
                for pattern, operations in self.paths
                if pattern.match(path) and method.lower() in operations
            ),
            None,
        )
        if operation is None:
            assert answer.status >= 400 or not path.startswith(
                "/api/"
            ), f"{method} {path} is not in the contract: {answer}"
            return
        described = operation["responses"].get(str(answer.status))
        if described is None:
            forbidden = answer.status == 403 and any(
                why in answer.body for why in FORBIDDEN_OF_ANY_CALL
            )
            # A call can reach a node that does not have the model that it needs.
            moved = answer.status == 307 and b"/problems#moved" in answer.body
            assert (
                forbidden or moved
            ), f"{method} {path}: the contract has no {answer.status}: {answer}"
            return
        media_type = (answer.headers.get("Content-Type") or "").split(";")[0]
        content = self._resolve(described).get("content", {})
        coding = answer.headers.get("Content-Encoding")
        if not answer.body or not content or coding == "br":  # Python has no decoder for br
            return
        body = gzip.decompress(answer.body) if coding == "gzip" else answer.body
        assert (
            media_type in content or "*/*" in content
        ), f"{method} {path} {answer.status}: {media_type} is not in the contract"
        if media_type.endswith(("/json", "+json")) and "schema" in content.get(media_type, {}):
            wrong = list(self.faults(content[media_type]["schema"], json.loads(body), "body"))
            assert (
                not wrong
            ), f"{method} {path} {answer.status} is not as in the contract:\n" + "\n".join(
                wrong[:10]
            )

    def faults(self, schema, value, where):
        """Returns the errors of the value against the JSON Schema. Supports only the keywords that
        the contract uses."""
        schema = self._resolve(schema)
        for word, enough in (("oneOf", lambda n: n == 1), ("anyOf", lambda n: n >= 1)):
            if word in schema:
                fits = sum(not list(self.faults(choice, value, where)) for choice in schema[word])
                if not enough(fits):
                    yield f"{where}: fits {fits} of its alternatives"
        kinds = schema.get("type")
        if kinds and not any(
            _is_type(value, kind) for kind in (kinds if isinstance(kinds, list) else [kinds])
        ):
            yield f"{where}: {value!r:.80} is not {kinds}"
            return
        if "enum" in schema and value not in schema["enum"]:
            yield f"{where}: {value!r:.80} is none of {schema['enum']}"
        if "const" in schema and value != schema["const"]:
            yield f"{where}: {value!r:.80} is not {schema['const']!r}"
        if isinstance(value, dict):
            yield from self._object_faults(schema, value, where)
        elif isinstance(value, list):
            if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
                yield f"{where}: {len(value)} items"
            for index, item in enumerate(value):
                yield from self.faults(schema.get("items", {}), item, f"{where}[{index}]")
        elif isinstance(value, str):
            if not schema.get("minLength", 0) <= len(value) <= schema.get("maxLength", len(value)):
                yield f"{where}: {len(value)} characters"
            if "pattern" in schema and not re.search(schema["pattern"], value):
                yield f"{where}: {value!r:.80} does not match {schema['pattern']}"
        elif not isinstance(value, bool) and isinstance(value, (int, float)):
            if not schema.get("minimum", value) <= value <= schema.get(
                "maximum", value
            ) or value <= schema.get("exclusiveMinimum", value - 1):
                yield f"{where}: {value} is out of range"

    def _object_faults(self, schema, value, where):
        members = schema.get("properties", {})
        for name in schema.get("required", []):
            if name not in value:
                yield f"{where}: {name} is missing"
        if (
            not schema.get("minProperties", 0)
            <= len(value)
            <= schema.get("maxProperties", len(value))
        ):
            yield f"{where}: {len(value)} members"
        others = schema.get("additionalProperties", True)
        for name, item in value.items():
            if name in members:
                yield from self.faults(members[name], item, f"{where}.{name}")
            elif others is False:
                yield f"{where}: {name} is not in the contract"
            elif isinstance(others, dict):
                yield from self.faults(others, item, f"{where}.{name}")
