"""Checks of bags (RFC 8493) and RO-Crates (1.1) that do not use the code of the server."""
import csv
import hashlib
import io
import json
import os
import re
import urllib.parse
import zipfile

LINE = re.compile(r"^([0-9a-f]{64}) [ *](.+)$")


def unpack(content, folder):
    """Unpacks the zip of a bag, and returns the folder of the bag."""
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        assert packed.testzip() is None
        names = packed.namelist()
        assert len(names) == len({name.lower() for name in names}), "two names differ only by case"
        tops = {name.partition("/")[0] for name in names}
        assert len(tops) == 1, tops
        packed.extractall(folder)
    return os.path.join(folder, tops.pop())


def files_under(folder):
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def sums_in(text):
    sums = {}
    for line in text.splitlines():
        digest, path = LINE.match(line).groups()
        for code, character in (("%0A", "\n"), ("%0D", "\r"), ("%25", "%")):
            path = path.replace(code, character)
        assert path not in sums, path
        sums[path] = digest
    return sums


def check_bag(bag):
    """Checks that the bag is complete and valid (RFC 8493, section 3). Returns bag-info."""
    files = files_under(bag)
    assert files["bagit.txt"] == b"BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n"
    payload = sums_in(files["manifest-sha256.txt"].decode())
    assert set(payload) == {path for path in files if path.startswith("data/")}
    tags = sums_in(files["tagmanifest-sha256.txt"].decode())
    assert set(tags) == {
        path
        for path in files
        if not path.startswith("data/") and not path.startswith("tagmanifest-")
    }
    for path, digest in {**payload, **tags}.items():
        assert hashlib.sha256(files[path]).hexdigest() == digest, path
    info = dict(line.split(": ", 1) for line in files["bag-info.txt"].decode().splitlines())
    size, count = info["Payload-Oxum"].split(".")
    assert int(count) == len(payload)
    assert int(size) == sum(len(files[path]) for path in payload)
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", info["Bagging-Date"])
    return info


def check_crate(root):
    """Checks the rules of RO-Crate 1.1 (sections 4.1, 5 and 6). Returns the entities by id."""
    files = files_under(root)
    crate = json.loads(files["ro-crate-metadata.json"])
    context = crate["@context"]
    assert "https://w3id.org/ro/crate/1.1/context" in context
    entities = {}
    for entity in crate["@graph"]:  # flattened: each entity once, without entities inside
        assert entity["@id"] not in entities, entity["@id"]
        assert "@type" in entity, entity
        entities[entity["@id"]] = entity
    descriptor = entities["ro-crate-metadata.json"]
    assert descriptor["@type"] == "CreativeWork"
    assert descriptor["conformsTo"] == {"@id": "https://w3id.org/ro/crate/1.1"}
    assert descriptor["about"] == {"@id": "./"}
    dataset = entities["./"]
    assert dataset["@type"] == "Dataset"
    for member in ("name", "description", "datePublished", "license"):
        assert dataset[member], member
    assert re.match(r"\d{4}-\d\d-\d\dT", dataset["datePublished"])
    for entity in entities.values():
        for value in entity.values():
            for each in value if isinstance(value, list) else [value]:
                if isinstance(each, dict):
                    assert set(each) == {"@id"}, each
                    reference = each["@id"]
                    assert reference in entities or reference.startswith("http"), reference
    listed = {part["@id"] for part in dataset["hasPart"]}
    for path, content in files.items():
        if path in ("ro-crate-metadata.json", "ro-crate-preview.html"):
            continue
        entity = entities[urllib.parse.quote(path)]
        assert entity["@type"] == "File" and entity["@id"] in listed, entity
        assert entity["contentSize"] == str(len(content))
        assert entity["sha256"] == hashlib.sha256(content).hexdigest()
        assert "/" in entity["encodingFormat"]
    for identifier in listed:
        if not identifier.endswith("/"):
            assert urllib.parse.unquote(identifier) in files, identifier
    assert files["ro-crate-preview.html"].startswith(b"<!DOCTYPE html>")
    return entities


def check_csvw(root, path):
    """Checks that a CSV has the columns of its metadata (CSV on the Web). Returns its rows."""
    with open(os.path.join(root, path), encoding="utf-8") as file:
        metadata = json.load(file)
    assert metadata["@context"] == "http://www.w3.org/ns/csvw"
    rows = []
    for table in metadata["tables"]:
        place = os.path.join(root, os.path.dirname(path), table["url"])
        with open(place, encoding="utf-8-sig", newline="") as file:
            read = csv.DictReader(file)
            titles = [column["titles"] for column in table["tableSchema"]["columns"]]
            assert read.fieldnames == titles
            assert table["tableSchema"]["primaryKey"] in titles
            rows += list(read)
    return rows
