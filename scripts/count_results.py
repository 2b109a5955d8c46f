#!/usr/bin/env python3
"""count_results.py FOLDER: adds up the test reports in a folder and prints "passed failed skipped".

GoogleTest and Vitest write JUnit-like XML with every case. For tests without such a file, the
script reads CTest's own report (ctest.junit). These are programs that do not use GoogleTest, and
programs that ended before they could write the file."""
import pathlib
import sys
import xml.etree.ElementTree as ET


def count_cases(root):
    passed = failed = skipped = 0
    for case in root.iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif (
            case.find("skipped") is not None
            or case.get("status") in ("notrun", "disabled")
            or case.get("result") == "skipped"
        ):
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def main():
    folder = pathlib.Path(sys.argv[1])
    total = [0, 0, 0]
    reported = set()
    for path in sorted(folder.glob("*.xml")):
        counts = count_cases(ET.parse(path).getroot())
        reported.add(path.stem)
        total = [a + b for a, b in zip(total, counts)]
    ctest = folder / "ctest.junit"
    if ctest.exists():
        for case in ET.parse(ctest).getroot().iter("testcase"):
            ran_wrong = case.find("failure") is not None or case.get("status") == "fail"
            if case.get("name") in reported:
                # Also reports a failure if all cases of a program passed, but the program failed
                # afterward, for example because of a leak report.
                if ran_wrong and total[1] == 0:
                    total[1] += 1
            elif ran_wrong:
                total[1] += 1
            elif case.find("skipped") is not None:
                total[2] += 1
            else:
                total[0] += 1
    print(*total)


main()
