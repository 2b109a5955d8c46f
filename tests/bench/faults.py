#!/usr/bin/python3
"""Causes all faults for hours, on sites of nodes while people paint. The results of all runs are
summed in one file, so several runs together can reach the numbers of rounds below.

    STRATA_BINARY=build/release/bin/strata tests/bench/faults.py --hours 8 --json faults.json

The program alternates between three parts, each on a new site of its own. It always continues
with the part that lacks most:

kills    1000 kills of nodes (node_faults.py --only kill)
nodes    100 rounds of each other fault of node_faults.py
primary  200 kills of the PostgreSQL primary (cluster_faults.py --only cluster_primary)

A part takes 5 to 15 minutes, so the last one can end later than the hours. Prints the sums of all
runs as a Markdown table. Exits with 1 if a part of this run found something wrong or did not end.
After three such parts one after the other, the program ends.
"""
import argparse
import ctypes
import os
import pathlib
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "e2e"))
import node_faults
from support.fault_record import read_facts, summary

MOST_FAILURES = 3


def stop_with_parent():
    """A part ends its servers if the program is stopped."""
    ctypes.CDLL(None).prctl(1, signal.SIGINT)  # PR_SET_PDEATHSIG


class Part:
    def __init__(self, script, faults, rounds, wanted):
        """`rounds`: of each fault, in one go. `wanted`: rounds of each fault in all runs."""
        self.script, self.faults, self.rounds, self.wanted = script, faults, rounds, wanted

    def share_done(self, facts):
        return min(len(facts["faults"].get(fault, [])) for fault in self.faults) / self.wanted

    def run(self, path):
        """Returns the exit status."""
        command = [sys.executable, str(HERE / self.script), "--json", path]
        command += ["--rounds", str(self.rounds), "--only", ",".join(self.faults)]
        print(f"--- {' '.join(command[1:])}", flush=True)
        return subprocess.run(command, check=False, preexec_fn=stop_with_parent).returncode


PARTS = [
    Part("node_faults.py", ["kill"], 50, 1000),
    Part("node_faults.py", [name for name in node_faults.FAULTS if name != "kill"], 4, 100),
    Part("cluster_faults.py", ["cluster_primary"], 5, 200),
]


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--hours", type=float, required=True)
    reads.add_argument("--json", required=True)
    asked = reads.parse_args()
    if not asked.hours > 0:
        reads.error("--hours must be more than 0")
    if not os.access(os.environ.get("STRATA_BINARY", ""), os.X_OK):
        reads.error("STRATA_BINARY must be the path of the program strata")
    end = time.monotonic() + 3600 * asked.hours
    failed = in_a_row = 0
    while time.monotonic() < end and in_a_row < MOST_FAILURES:
        facts = read_facts(asked.json)
        part = min(PARTS, key=lambda part: part.share_done(facts))
        status = part.run(asked.json)
        failed += status != 0
        in_a_row = in_a_row + 1 if status else 0
    print("\n" + summary(read_facts(asked.json)))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
