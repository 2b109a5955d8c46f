#!/usr/bin/env python3
"""test_times.py FOLDER: writes times.txt there, how long each test took, longest first, and prints the 20 longest.

A test of CTest stands with its name, and so do the cases that its report in the folder has (`test: case`)."""
import pathlib
import sys
import xml.etree.ElementTree as ET

LONGEST = 20


def times_of(report):
    """Of one JUnit file: (seconds, name) of each case."""
    for case in ET.parse(report).getroot().iter("testcase"):
        name = case.get("name")
        if report.name != "ctest.junit":
            name = f"{report.stem}: {name}"
        yield float(case.get("time") or 0), name


def main():
    folder = pathlib.Path(sys.argv[1])
    tests = sorted(times_of(folder / "ctest.junit"), reverse=True)
    cases = sorted(
        (each for report in folder.glob("*.xml") for each in times_of(report)), reverse=True
    )
    lines = [f"{seconds:8.1f} s  {name}" for seconds, name in tests]
    (folder / "times.txt").write_text(
        "\n".join([*lines, "", *(f"{seconds:8.1f} s  {name}" for seconds, name in cases)]) + "\n",
        encoding="utf-8",
    )
    print(f"The {LONGEST} longest tests (all: {folder}/times.txt):")
    print("\n".join(lines[:LONGEST]))


if __name__ == "__main__":
    main()
