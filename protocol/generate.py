#!/usr/bin/env python3
"""Generates all files that are derived from protocol/messages and protocol/openapi.yaml.

  protocol/generate.py            writes the files that changed
  protocol/generate.py --check    writes nothing; exits 1 and names the files that are stale

Needs Debian's python3 and python3-yaml, nothing else.
"""

import argparse
import json
import pathlib
import sys

sys.dont_write_bytecode = True

from generator import (  # noqa: E402  (after dont_write_bytecode on purpose)
    cpp,
    openapi,
    schemas,
    typescript,
)

HERE = pathlib.Path(__file__).resolve().parent


def results() -> dict[pathlib.Path, str]:
    protocol = schemas.Protocol(HERE / "messages")
    writer = cpp.Writer(protocol)
    generated = HERE / "generated"
    header = writer.header()  # first: it collects the enums that the source defines
    return {
        generated / "cpp/protocol/messages.h": header,
        generated / "cpp/protocol/messages.cpp": writer.source(),
        generated / "cpp/protocol/schemas.cpp": writer.schemas(),
        generated
        / "schemas.json": json.dumps(schemas.bundle(protocol), indent=1, ensure_ascii=False)
        + "\n",
        generated / "openapi.json": openapi.write(protocol, HERE / "openapi.yaml"),
        HERE.parent / "web-client/src/core/protocol.gen.ts": typescript.write(protocol),
    }


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit 1 when a result is stale"
    )
    arguments = parser.parse_args()
    try:
        wanted = results()
    except schemas.SchemaError as error:
        print(f"protocol/messages: {error}", file=sys.stderr)
        return 1
    stale = [path for path, text in wanted.items() if not path.exists() or path.read_text() != text]
    for path in stale:
        shown = path.relative_to(HERE.parent)
        if arguments.check:
            print(f"stale: {shown}: run protocol/generate.py", file=sys.stderr)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(wanted[path])
            print(f"wrote {shown}")
    return 1 if arguments.check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
