#!/usr/bin/env python3
"""The units of several files, which only a release build has, compile. In a joined unit, names of
unnamed namespaces can collide or hide others (cmake/strata_module.cmake). Arguments: the source
folder, an output folder, then the arguments of cmake. Checks the syntax only, without optimizing."""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys


def check(unit):
    """Returns the compiler's errors in a unit."""
    command = shlex.split(unit["command"])
    at = command.index("-o")
    del command[at : at + 2]
    command = [part for part in command if part != "-c" and not part.startswith("-O")]
    # The precompiled header is read as a plain header.
    told = subprocess.run(
        [*command, "-w", "-Wno-invalid-pch", "-O0", "-fsyntax-only"],
        cwd=unit["directory"],
        capture_output=True,
        text=True,
    )
    return told.stderr if told.returncode != 0 else ""


def main():
    source, output, *options = sys.argv[1:]
    subprocess.run(
        ["cmake", "--preset", "release", "-S", source, "-B", output, *options],
        cwd=source,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    with open(os.path.join(output, "compile_commands.json"), encoding="utf-8") as file:
        units = [unit for unit in json.load(file) if "/Unity/" in unit["file"]]
    assert len(units) > 5, "the release build has units of several files"
    subprocess.run(
        ["ninja", "-C", output, "cmake_object_order_depends_target_strata_app"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = [told for told in pool.map(check, units) if told]
    print(f"{len(units)} units, {len(errors)} with errors")
    print("\n".join(errors)[:20_000])
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
