#!/usr/bin/env python3
"""The third-party notices name all compiled-in and linked libraries. Argument: the build folder."""
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Examples of header-only, static and shared libraries.
EXPECTED = (
    "nlohmann-json3-dev",
    "libcli11-dev",
    "libglm-dev",
    "libeigen3-dev",
    "libvalijson-dev",
    "libspdlog-dev",
    "libboost1.81-dev",
    "libdraco",
    "libopen3d",
    "libsimdjson",
    "libpq5",
    "libssl3",
)


def main():
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "notices.txt")
        subprocess.run(
            [
                sys.executable,
                os.path.join(ROOT, "scripts", "third_party_notices.py"),
                sys.argv[1],
                output,
            ],
            check=True,
        )
        with open(output, encoding="utf-8") as file:
            text = file.read()
    heads = [
        line for line in text.splitlines() if line.startswith("lib") or line.startswith("nlohmann")
    ]
    for name in EXPECTED:
        assert any(name in line for line in heads), f"{name} has no notice"
    for strange in ("libc6", "libgtest-dev", "libbenchmark-dev"):
        assert not any(
            strange == word.strip() for line in heads for word in line.split(",")
        ), f"{strange} is not part of the program"
    assert "Permission is hereby granted, free of charge" in text and "Apache License" in text
    page = os.path.join(ROOT, "web-client", "dist", "third-party-notices.txt")
    if os.path.exists(page):
        with open(page, encoding="utf-8") as file:
            notices = file.read()
        fonts = ("@fontsource-variable/inter ", "@fontsource-variable/source-serif-4 ")
        for name in ("lit-html ", "redoc ", "react ", "styled-components ", *fonts):
            assert name in notices, f"{name}has no notice"
    print(f"{len(heads)} heads")


if __name__ == "__main__":
    main()
