"""Reads the schema files into one bundle and gives every schema a type that the language writers support."""

import copy
import json
import pathlib
from dataclasses import dataclass, field

# The order affects only the generated files. Common definitions come first.
FILES = ["common", "client", "server", "http"]
MAX_INT32 = 2**31 - 1


class SchemaError(Exception):
    """Raised if a schema uses a feature that the writers do not support. The message contains the
    position."""


@dataclass
class Type:
    """kind: string, uuid, number, int32, int64, boolean, const, enum, array, map, nullable, ref, union, scalar_union, any, object."""

    kind: str
    name: str = ""  # ref: name of the definition; enum: name of the enum
    items: "Type | None" = None
    count: "int | None" = None  # array: the fixed length
    # enum: the texts or numbers; const: the value; union: the names of the definitions
    values: list = field(default_factory=list)
    members: list = field(default_factory=list)  # object: the members
    choices: list = field(default_factory=list)  # any: the types
    description: str = ""


@dataclass
class Member:
    name: str
    type: Type
    required: bool
    default: object  # None if the schema has no default
    description: str


@dataclass
class Definition:
    name: str
    file: str
    schema: dict
    type: Type
    title: str
    description: str

    @property
    def cpp_type(self):
        return self.schema.get("x-cpp-type")

    @property
    def op(self):
        """The value of `op` of a message, or None for other objects."""
        op = self.schema.get("properties", {}).get("op", {})
        return op.get("const")


class Protocol:
    """All definitions, by name. Names are unique in all files."""

    def __init__(self, folder: pathlib.Path):
        self.definitions: dict[str, Definition] = {}
        self.unions: dict[str, list[str]] = {}  # names of the definitions in each union
        sources = {name: json.loads((folder / f"{name}.schema.json").read_text()) for name in FILES}
        self.schemas: dict[str, dict] = {}
        for file, source in sources.items():
            for name, schema in source["definitions"].items():
                if name in self.schemas:
                    raise SchemaError(f"{file}: {name} is defined twice")
                self.schemas[name] = localize(schema)
        for file, source in sources.items():
            for name in source["definitions"]:
                schema = self.schemas[name]
                self.require_bounds(schema, name)
                self.definitions[name] = Definition(
                    name,
                    file,
                    schema,
                    self.type_of(schema, name),
                    schema.get("title", ""),
                    schema.get("description", ""),
                )
            if "x-union" in source:
                self.unions[source["x-union"]] = [
                    n for n in source["definitions"] if self.definitions[n].op
                ]

    def type_of(self, schema: dict, where: str) -> Type:
        description = schema.get("description", "")
        if "$ref" in schema:
            name = schema["$ref"].removeprefix("#/definitions/")
            if name not in self.schemas:
                raise SchemaError(f"{where}: unknown definition {name}")
            if self.schemas[name].get("format") == "uuid":
                return Type("uuid", description=description)
            return Type("ref", name=name, description=description)
        if "const" in schema:
            return Type("const", values=[schema["const"]])
        if "oneOf" in schema and "type" not in schema:
            return self.one_of(schema["oneOf"], where)
        kind = schema.get("type")
        if "enum" in schema and kind == "string":
            return Type("enum", name=where, values=schema["enum"])
        if kind == "string":
            return Type("uuid" if schema.get("format") == "uuid" else "string")
        if kind == "integer":
            bounds = schema.get("enum") or [schema["minimum"], schema["maximum"]]
            return Type(
                "int32" if -MAX_INT32 <= min(bounds) and max(bounds) <= MAX_INT32 else "int64",
                values=schema.get("enum", []),
            )
        if kind in ("number", "boolean"):
            return Type(kind)
        if kind == "array":
            fixed = schema["minItems"] if schema["minItems"] == schema["maxItems"] else None
            return Type("array", items=self.type_of(schema["items"], where + "Item"), count=fixed)
        if kind == "object" and isinstance(schema.get("additionalProperties"), dict):
            return Type("map", items=self.type_of(schema["additionalProperties"], where + "Value"))
        if kind == "object":
            required = schema.get("required", [])
            members = []
            for name, member in schema["properties"].items():
                inner = self.type_of(member, where + camel(name))
                members.append(
                    Member(
                        name,
                        inner,
                        name in required,
                        member.get("default"),
                        member.get("description", ""),
                    )
                )
            return Type("object", name=where, members=members)
        raise SchemaError(f"{where}: no type is known for {json.dumps(schema)[:200]}")

    def one_of(self, choices: list, where: str) -> Type:
        if len(choices) == 2 and choices[1] == {"type": "null"}:
            return Type("nullable", items=self.type_of(choices[0], where))
        if all("$ref" in choice for choice in choices):
            names = [choice["$ref"].removeprefix("#/definitions/") for choice in choices]
            if any("const" not in self.schemas[name]["properties"].get("op", {}) for name in names):
                raise SchemaError(
                    f"{where}: every choice of a union of objects needs a constant `op`"
                )
            return Type("union", values=names)
        if [choice.get("type") for choice in choices] == ["integer", "string"]:
            return Type("scalar_union")
        # Definitions with such choices have `x-cpp-type`. Their values stay unchanged.
        if all("type" in choice for choice in choices):
            return Type(
                "any",
                choices=[
                    Type("null") if choice["type"] == "null" else self.type_of(choice, where)
                    for choice in choices
                ],
            )
        raise SchemaError(f"{where}: this oneOf is not known")

    def require_bounds(self, schema: dict, where: str):
        """Checks that every number, text and list has bounds and that no object allows additional members."""
        needed = {
            "integer": ("minimum", "maximum"),
            "number": ("minimum|exclusiveMinimum", "maximum"),
            "string": ("maxLength",),
            "array": ("minItems", "maxItems", "items"),
            "object": ("additionalProperties",),
        }
        kind = schema.get("type")
        if "enum" not in schema and "const" not in schema:
            for keyword in needed.get(kind, ()):
                if not any(choice in schema for choice in keyword.split("|")):
                    raise SchemaError(f"{where}: {keyword} is missing")
        if kind == "object" and schema["additionalProperties"] is True:
            raise SchemaError(f"{where}: additionalProperties must be false or a schema")
        for name, member in schema.get("properties", {}).items():
            self.require_bounds(member, f"{where}.{name}")
        for child in [
            schema.get("items"),
            schema.get("additionalProperties"),
            *schema.get("oneOf", []),
        ]:
            if isinstance(child, dict):
                self.require_bounds(child, where + "[]")

    def dependencies(self, type_: Type) -> set[str]:
        """Returns the names of the definitions to which a type refers."""
        if type_.kind == "ref":
            return {type_.name}
        if type_.kind == "union":
            return set(type_.values)
        found = set()
        for inner in [type_.items, *[member.type for member in type_.members]]:
            if inner:
                found |= self.dependencies(inner)
        return found

    def in_order(self) -> list[Definition]:
        """Returns the definitions in an order in which each one follows the definitions to which it refers.
        A definition may contain itself only through one with `x-cpp-type`, whose C++ type is complete.
        """
        begun: set[str] = set()
        done: dict[str, Definition] = {}

        def visit(name):
            if name not in begun:
                begun.add(name)
                for other in sorted(self.dependencies(self.definitions[name].type)):
                    visit(other)
                done[name] = self.definitions[name]

        for name in self.definitions:
            visit(name)
        return list(done.values())


def localize(schema):
    """Replaces references to other files by references inside the bundle."""
    if isinstance(schema, dict):
        return {
            k: ("#" + v.split("#")[1] if k == "$ref" else localize(v)) for k, v in schema.items()
        }
    return [localize(v) for v in schema] if isinstance(schema, list) else schema


def camel(name: str) -> str:
    return "".join(
        part[:1].upper() + part[1:] for part in name.replace(".", "_").replace("-", "_").split("_")
    )


def strip(schema, drop):
    """Returns a copy without the keywords that `drop` selects. Names of members are not keywords."""
    if isinstance(schema, list):
        return [strip(v, drop) for v in schema]
    if not isinstance(schema, dict):
        return schema
    result = {}
    for key, value in schema.items():
        if key == "properties":
            result[key] = {name: strip(member, drop) for name, member in value.items()}
        elif not drop(key):
            result[key] = strip(value, drop)
    return result


def as_draft_07(schema):
    """Replaces `dependentRequired` of JSON Schema 2020-12 (and OpenAPI 3.1) by `dependencies`, its name in draft-07."""
    if isinstance(schema, list):
        return [as_draft_07(v) for v in schema]
    if not isinstance(schema, dict):
        return schema
    renamed = {"dependentRequired": "dependencies"} if "properties" in schema else {}
    return {renamed.get(key, key): as_draft_07(value) for key, value in schema.items()}


def bundle(protocol: Protocol) -> dict:
    """Returns one draft-07 document for test tools such as ajv, without the keywords and formats of this project."""
    drop = lambda key: key.startswith("x-") or key == "format"
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "definitions": {
            name: as_draft_07(strip(schema, drop)) for name, schema in protocol.schemas.items()
        },
    }


def bundle_for_validation(protocol: Protocol) -> dict:
    """Returns the schemas with which the server validates messages. A choice by `op` becomes if/then, so an error names
    the invalid member instead of all choices. Titles and descriptions are left out."""
    drop = lambda key: key.startswith("x-") or key in (
        "format",
        "title",
        "description",
        "default",
        "$schema",
    )
    definitions = {}
    for name, definition in protocol.definitions.items():
        schema = as_draft_07(strip(copy.deepcopy(definition.schema), drop))
        if definition.type.kind == "union":
            ops = [protocol.definitions[choice].op for choice in definition.type.values]
            schema = {
                "type": "object",
                "required": ["op"],
                "properties": {"op": {"type": "string", "enum": ops}},
                "allOf": [
                    {
                        "if": {"required": ["op"], "properties": {"op": {"const": op}}},
                        "then": {"$ref": "#/definitions/" + choice},
                    }
                    for op, choice in zip(ops, definition.type.values)
                ],
            }
        definitions[name] = schema
    return {"definitions": definitions}
