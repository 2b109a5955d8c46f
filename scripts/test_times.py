#!/usr/bin/env python3
"""test_times.py FOLDER: writes the time of each test to times.txt in FOLDER, longest first, and
prints the 20 longest.

The file lists the tests of CTest by name, and the cases of their reports in the folder
(`test: case`)."""
import pathlib
import sys
import xml.etree.ElementTree as ET

LONGEST = 20


def times_of(report):
    """Yields (seconds, name) of each case of one JUnit file."""
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
