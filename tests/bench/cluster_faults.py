#!/usr/bin/env python3
"""Measures how soon painting continues after faults of the example of a cluster (examples/cluster),
and counts lost and doubled strokes. Two painters and a viewer use the cluster through nginx.

    STRATA_BINARY=build/release/bin/strata tests/bench/cluster_faults.py [--rounds N]

Each round kills the node that has the model, and then the PostgreSQL primary, which has commits that
no standby has received. Prints a Markdown table:

seconds    from the kill until both painters have a saved stroke that they began after the kill
viewer     seconds without a frame, from the kill until then
lost       strokes that were reported as saved, and that the history does not contain
doubled    strokes in the history that are there twice, or whose save was never reported

A round takes one to two minutes. `./test` unpacks the programs that this needs.
"""
import argparse
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cluster_site import ClusterSite, paint_at, seconds_until_all_paint
from support.latencies import percentile
from support.strata_server import wait_for


def kill_node(site, painted):
    owner = wait_for(lambda: site.owner(painted.model["id"]), "a node with the model")
    return owner, lambda: None


def kill_primary(site, _):
    primary = wait_for(site.cluster.primary, "a primary")
    return primary, lambda: site.leave_commits_unconfirmed(primary)


EVENTS = {"node killed": kill_node, "primary killed": kill_primary}


def measure(site, event, seed):
    """Returns (seconds, viewer, saved, lost, doubled)."""
    painted, painters, viewer = paint_at(site, seed)
    seconds_until_all_paint(painted, painters, time.monotonic())
    wait_for(lambda: viewer.frames, "a frame")
    part, prepare = EVENTS[event](site, painted)
    prepare()
    site.cluster.kill(part)
    begun = time.monotonic()
    seconds = seconds_until_all_paint(painted, painters, begun)
    wait_for(lambda: viewer.frames_since(begun + seconds), "a frame")
    gap = viewer.longest_gap(begun, time.monotonic())
    painted.end_painting(painters)
    viewer.leaving.set()
    viewer.join(60)
    # Starts the part again, and waits until the cluster is whole.
    site.run("examples/cluster/up")
    rows = painted.history()
    lost = len(painted.book.edits.keys() - rows.keys())
    doubled = len(rows.keys() - painted.book.edits.keys())
    doubled += len(rows) - len({row["id"] for _, row in rows.values()})
    return seconds, gap, len(painted.book.edits), lost, doubled


def table(results):
    lines = [
        "| event | rounds | seconds, p50 | p95 | viewer, p50 | p95 | saved strokes | lost | doubled |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for event, rows in results.items():
        seconds, gaps, saved, lost, doubled = zip(*rows)
        times = [
            f"{percentile(values, share):.1f}"
            for values in (seconds, gaps)
            for share in (0.5, 0.95)
        ]
        counts = [str(sum(values)) for values in (saved, lost, doubled)]
        lines.append(f"| {' | '.join([event, str(len(rows)), *times, *counts])} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    # A merge replaces the strokes that the script compares.
    os.environ["STRATA_MERGE_AFTER"] = "0"
    results = {event: [] for event in EVENTS}
    with ClusterSite() as site:
        site.run("examples/cluster/up")
        for number in range(asked.rounds):
            for event, rows in results.items():
                rows.append(measure(site, event, asked.seed + number))
                print(f"round {number + 1}, {event}: {rows[-1]}", file=sys.stderr, flush=True)
    print(table(results))


if __name__ == "__main__":
    main()
