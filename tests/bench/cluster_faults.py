#!/usr/bin/python3
"""Measures how soon painting continues after faults of the example of a cluster (examples/cluster),
and counts lost and doubled strokes. Two painters and a viewer use the cluster through nginx.

    STRATA_BINARY=build/release/bin/strata tests/bench/cluster_faults.py [--rounds N] [--json FILE] [--only NAME,…]

cluster_node     kill -9 of the node that has the model
cluster_primary  kill -9 of the PostgreSQL primary, which has commits that no standby has received

Painting continues when both painters have a saved stroke that they began after the kill. *No frame*
is the longest time without a frame of the viewer from the kill until then. Then the strokes are
compared with the history:

lost          strokes that were reported as saved, and that the history does not contain
doubled       strokes in the history that are there twice, or whose save was never reported
wrong_texels  1 if texels differ from a replay of the strokes in their order

With --json, the results are added to those of earlier runs in this file, which can be the file of
node_faults.py. Prints the sums of all runs as a Markdown table. Exits with 1 if a number above is
not 0, or if a round did not end. A round takes one to two minutes. `./test` unpacks the programs
that this needs.
"""
import argparse
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cluster_site import ClusterSite, paint_at, seconds_until_all_paint
from support.fault_record import FaultRecord
from support.machine import gl_renderer, machine
from support.painted_model import LAYERS
from support.strata_server import wait_for


def kill_node(site, painted):
    owner = wait_for(lambda: site.owner(painted.model["id"]), "a node with the model")
    return owner, lambda: None


def kill_primary(site, _):
    primary = wait_for(site.cluster.primary, "a primary")
    return primary, lambda: site.leave_commits_unconfirmed(primary)


FAULTS = {"cluster_node": kill_node, "cluster_primary": kill_primary}


def one_round(site, name, seed):
    painted, painters, viewer = paint_at(site, seed)
    seconds_until_all_paint(painted, painters, time.monotonic())
    wait_for(lambda: viewer.frames, "a frame")
    part, prepare = FAULTS[name](site, painted)
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
    found = {"went_on_s": seconds, "no_frame_s": gap, "lost": lost, "doubled": doubled}
    return painted, {**found, "strokes": len(painted.book.edits)}


def replay(painted):
    """Returns whether texels differ from a replay."""
    try:
        painted.compare_with_replay({name: painted.texels(name) for name, *_ in LAYERS})
    except AssertionError as error:
        print(error, file=sys.stderr, flush=True)
        return True
    return False


def run(record, chosen, rounds, seed):
    name = "start"
    try:
        with ClusterSite() as site:
            site.run("examples/cluster/up")
            for _ in range(rounds):
                for name in chosen:
                    painted, found = one_round(site, name, seed + record.rounds(name))
                    record.add(name, found)
                    record.add_replay(found["strokes"], int(replay(painted)))
    except Exception as error:
        record.add_failure(name, error)
        raise


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json")
    parser.add_argument("--only", default=",".join(FAULTS))
    asked = parser.parse_args()
    chosen = asked.only.split(",")
    unknown = set(chosen) - set(FAULTS)
    if unknown:
        parser.error(f"no such fault: {', '.join(sorted(unknown))}")
    if asked.rounds < 1:
        parser.error("--rounds must be 1 or more")
    # A merge replaces the strokes that the script compares.
    os.environ["STRATA_MERGE_AFTER"] = "0"
    facts = {**machine(), "renderer": gl_renderer(os.environ["STRATA_BINARY"])}
    record = FaultRecord(asked.json, facts)
    run(record, chosen, asked.rounds, asked.seed)
    print("\n" + record.summary())
    return 1 if record.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
