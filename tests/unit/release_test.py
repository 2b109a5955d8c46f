#!/usr/bin/env python3
"""Every file that names the release has the version of CMakeLists.txt."""

import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def found(file: str, pattern: str) -> str | None:
    match = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    return match.group(1) if match else None


def main() -> int:
    release = found("CMakeLists.txt", r"^project\(strata VERSION ([0-9.]+) ")
    lock = json.loads((ROOT / "web-client/package-lock.json").read_text(encoding="utf-8"))
    named = {
        "protocol/openapi.yaml": found("protocol/openapi.yaml", r"^  version: (\S+)$"),
        "web-client/package.json": found("web-client/package.json", r'^  "version": "([^"]+)",$'),
        "web-client/package-lock.json": lock["version"],
        "CHANGELOG.md (the newest release)": found("CHANGELOG.md", r"^## ([0-9.]+) \("),
    }
    wrong = {file: version for file, version in named.items() if version != release}
    for file, version in wrong.items():
        print(f"{file} names the release {version}; CMakeLists.txt names {release}.")
    return 1 if wrong or release is None else 0


if __name__ == "__main__":
    sys.exit(main())
