#!/usr/bin/env python3
"""Sums the work of the fuzzers over all runs, in a file next to the corpus that the runs keep.

    tests/fuzz/hours.py FILE run NAME LOG PROGRAM…   runs a fuzzer, and adds its work to the file
    tests/fuzz/hours.py FILE                         prints the sums as a Markdown table

The seconds are those of the processor. Another run of a fuzzer continues with the corpus of the
runs before it. A finding is a run that did not end with 0. A run without inputs is one, too.
"""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

GOAL_H = 24
UNITS = re.compile(r"^#(\d+)\s", re.MULTILINE)  # the number of inputs, in lines of libFuzzer


def read(file):
    return json.loads(file.read_text("utf-8")) if file.exists() else {}


def processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(file, name, log, command):
    """Returns the exit status of the fuzzer."""
    before = processor_s()
    with open(log, "wb") as out:
        status = subprocess.run(command, check=False, stdout=out, stderr=out).returncode
    inputs = max(map(int, UNITS.findall(log.read_text("utf-8", "replace"))), default=0)
    if inputs == 0:
        status = status or 1
    sums = read(file)
    mine = sums.setdefault(name, {"runs": 0, "seconds": 0.0, "inputs": 0, "findings": 0})
    mine["runs"] += 1
    mine["seconds"] = round(mine["seconds"] + processor_s() - before, 1)
    mine["inputs"] += inputs
    mine["findings"] += status != 0
    unfinished = file.with_suffix(".new")
    unfinished.write_text(json.dumps(sums, indent=1, sort_keys=True) + "\n", "utf-8")
    os.replace(unfinished, file)
    return status


def table(sums):
    lines = ["| fuzzer | runs | processor hours | inputs | findings |", "|---|---|---|---|---|"]
    for name, each in sorted(sums.items()):
        hours, inputs = each["seconds"] / 3600, f"{each['inputs']:,}".replace(",", " ")
        lines.append(f"| {name} | {each['runs']} | {hours:.2f} | {inputs} | {each['findings']} |")
    hours = sum(each["seconds"] for each in sums.values()) / 3600
    lines += ["", f"{hours:.1f} processor hours of fuzzing in all runs (goal: {GOAL_H})"]
    return "\n".join(lines)


def main():
    file, *rest = sys.argv[1:]
    if rest[:1] == ["run"]:
        name, log, *command = rest[1:]
        sys.exit(run(pathlib.Path(file), name, pathlib.Path(log), command))
    print(table(read(pathlib.Path(file))))


if __name__ == "__main__":
    main()
