"""Writes openapi.json: openapi.yaml with the schemas of protocol/messages inlined as components."""

import json
import pathlib

import yaml  # Debian: python3-yaml

from .schemas import Protocol, strip


def point_to_components(node):
    """Replaces references to the schema files by references to components."""
    if isinstance(node, dict):
        result = {}
        for key, value in node.items():
            if key == "$ref" and "/definitions/" in value:
                result[key] = "#/components/schemas/" + value.rsplit("/", 1)[1]
            else:
                result[key] = point_to_components(value)
        return result
    return [point_to_components(value) for value in node] if isinstance(node, list) else node


# Responses that every call may have. The description in openapi.yaml explains them. In addition,
# calls with a JSON body may have 415, and reads may have 406.
OF_ANY_CALL = {
    "421": "UnknownHost",
    "429": "TooFast",
    "431": "HeaderTooLarge",
    "503": "Unavailable",
}


def add_common_answers(document) -> None:
    for path, item in document["paths"].items():
        for method, operation in item.items():
            if method == "parameters" or path.endswith("/live"):
                continue
            answers = dict(OF_ANY_CALL)
            if "application/json" in operation.get("requestBody", {}).get("content", {}):
                answers["415"] = "UnknownFormat"
            if method == "get":
                answers["406"] = "NotAcceptable"
            for status, name in answers.items():
                operation["responses"].setdefault(
                    status, {"$ref": "#/components/responses/" + name}
                )
            operation["responses"] = dict(sorted(operation["responses"].items()))


# Reads whose responses have no ETag of their content. Some responses are sent only once, as a
# stream of events, or contain the time. Other responses must not be stored. In the remaining cases, the ETag is the
# version of a record for If-Match, but the response contains more than the record.
WITHOUT_ANSWER_ETAG = (
    "/sign-in/providers",
    "/login",
    "/live",
    "/events",
    "/me/models/{model}/view",
    "/layers/{layer}/records/{key}",
    "/attachments",
    "/bills/{bill}/file",
)


def add_validators(document) -> None:
    """Adds the ETag and 304 to reads, and 428 to changes of versioned entities, so openapi.yaml need not repeat them."""
    for path, item in document["paths"].items():
        for method, operation in item.items():
            if method == "parameters" or not path.startswith("/api/"):
                continue
            parameters, answers = operation.setdefault("parameters", []), operation["responses"]
            if (
                method == "get"
                and "304" not in answers
                and "200" in answers
                and not path.endswith(WITHOUT_ANSWER_ETAG)
            ):
                parameters.append({"$ref": "#/components/parameters/if_none_match"})
                answers["200"].setdefault("headers", {})["ETag"] = {
                    "$ref": "#/components/headers/AnswerETag"
                }
                answers["304"] = {"$ref": "#/components/responses/UnchangedAnswer"}
            is_versioned = {
                "$ref": "#/components/parameters/if_match"
            } in parameters and method in ("patch", "put", "delete")
            if is_versioned and not path.startswith("/api/v1/tools"):
                answers["428"] = {"$ref": "#/components/responses/VersionMissing"}
            if not parameters:
                del operation["parameters"]
            operation["responses"] = dict(sorted(answers.items()))


def references(node) -> set[str]:
    if isinstance(node, dict):
        found = {node["$ref"]} if isinstance(node.get("$ref"), str) else set()
        return found.union(*[references(value) for value in node.values()])
    return set().union(*[references(value) for value in node]) if isinstance(node, list) else set()


def write(protocol: Protocol, source: pathlib.Path) -> str:
    document = point_to_components(yaml.safe_load(source.read_text()))
    add_common_answers(document)
    add_validators(document)
    schemas = document.setdefault("components", {}).setdefault("schemas", {})
    prefix = "#/components/schemas/"
    wanted = [ref for ref in references(document) if ref.startswith(prefix)]
    while wanted:
        name = wanted.pop().removeprefix(prefix)
        if name not in schemas:
            if name not in protocol.schemas:
                raise SystemExit(f"{source.name}: there is no schema {name}")
            schemas[name] = point_to_components(
                strip(protocol.schemas[name], lambda key: key.startswith("x-"))
            )
            wanted += [ref for ref in references(schemas[name]) if ref.startswith(prefix)]
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    for ref in references(document):
        resolve(document, ref)
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def resolve(document, ref: str):
    node = document
    for part in ref.removeprefix("#/").split("/"):
        if part not in node:
            raise SystemExit(f"openapi.yaml: {ref} leads nowhere")
        node = node[part]
