#!/usr/bin/python3
"""Measures how a site of several nodes survives faults of a node and of the database.

    STRATA_BINARY=build/release/bin/strata tests/bench/node_faults.py [--rounds N] [--json FILE] [--only NAME,…]

Three nodes and one PostgreSQL run on this machine. Each node has its own connection to PostgreSQL,
which the script can cut. Two painters send strokes to one model while each fault happens:

kill       kill -9 of the node that owns the model
drain      SIGTERM to this node
hang       SIGSTOP of this node; SIGCONT after the painters have continued
cut        no byte passes between this node and PostgreSQL; the held bytes arrive later
postgres   kill -9 of PostgreSQL, which is started again immediately

A painter waits for an answer for ANSWER_S, and then sends the same stroke to the next node.
Painting continues when each painter has an acknowledgement of a stroke that it sent after the
fault. After each round the painters stop, and their acknowledgements are compared with the journal
in the database:

lost       acknowledged strokes that are not in the journal
doubled    strokes in the journal that no painter sent, or that are there more than once
late       strokes that the hanging or separated node acknowledged after the end of its lease

Prints a Markdown table. Exits with 1 if a stroke was lost, doubled or late. Needs Debian's Python
with pytest, because it uses the helpers of the end-to-end tests.
"""
import argparse
import http.client
import json
import os
import random
import signal
import sys
import threading
import time
import uuid

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.latencies import percentile
from support.live_client import AWAY
from support.machine import gl_renderer, machine
from support.meshes import folded_grid
from support.nodes import Site
from support.strata_server import LONG_S, wait_for

NODES, PAINTERS = 3, 2
ANSWER_S = 1.0
LEASE_S = 3.0
PROMISE_S = {"kill": 5, "drain": 1, "hang": 5, "cut": 5, "postgres": None}
SPARE_STROKES = 5  # of each painter, before the fault


class Stroke:
    """An acknowledged stroke. `sent` and `at` are the times of the attempt that succeeded."""

    def __init__(self, sequence, node, sent):
        self.sequence, self.node, self.sent, self.at = sequence, node, sent, time.monotonic()


class Painter(threading.Thread):
    """Paints until `stopping` is set. At the end, every stroke that it sent is acknowledged."""

    def __init__(self, site, model, first, seed):
        super().__init__(daemon=True)
        self.site, self.model, self.node = site, model, first
        self.random = random.Random(seed)
        self.camera = camera_from(model, (0, -0.2, 1))
        self.strokes = []
        self.failure = None
        self.stopping = threading.Event()
        self.links = {}

    def run(self):
        try:
            while not self.stopping.is_set():
                self.strokes.append(self.paint())
        except Exception as error:  # pylint: disable=broad-except
            self.failure = error

    def paint(self):
        x, y = self.random.uniform(200, 400), self.random.uniform(150, 330)
        edit = {
            "op": "stroke",
            "camera": self.camera,
            "radius_px": 8,
            "path": [[x, y], [x + 30, y + 20]],
            "value": self.random.randint(1, 6),
        }
        headers = {"Idempotency-Key": str(uuid.uuid4())}
        end = time.monotonic() + LONG_S
        while time.monotonic() < end:
            node, sent = self.node, time.monotonic()
            answer = self.send(node, edit, headers)
            if answer is not None and answer.status == 200:
                return Stroke(answer.json()["sequence"], node, sent)
            if answer is not None and answer.status == 307:
                self.node = self.site.node_at(answer.headers["Location"])
                continue
            if answer is not None and answer.status not in (429, 503):
                raise AssertionError(f"{edit} got {answer}")
            nodes = self.site.nodes
            self.node = nodes[(nodes.index(node) + 1) % len(nodes)]
            time.sleep(0.02)
        raise AssertionError(f"a stroke got no answer in {LONG_S} s")

    def send(self, node, edit, headers):
        """Returns the response, or None if there is none in time."""
        link = self.links.get(node) or http.client.HTTPConnection(
            node.host, node.own_port, timeout=ANSWER_S
        )
        self.links[node] = link
        path = f"/models/{self.model['id']}/layers/marks/edits"
        try:
            return node.post(path, edit, headers=headers, connection=link)
        except AWAY:
            self.links.pop(node).close()
            return None


class Load:
    """Painters of one round."""

    def __init__(self, site, model, seed):
        self.painters = [
            Painter(site, model, site.nodes[number % NODES], f"{seed} {number}")
            for number in range(PAINTERS)
        ]
        for painter in self.painters:
            painter.start()
        self.wait(lambda painter: len(painter.strokes) >= SPARE_STROKES, "the first strokes")

    def wait(self, condition, what):
        def reached():
            for painter in self.painters:
                if painter.failure:
                    raise painter.failure
            return all(condition(painter) for painter in self.painters)

        wait_for(reached, what)

    def went_on(self, since, without=None):
        """Waits until each painter has an acknowledgement, from a node other than `without`, of a
        stroke that it sent after `since`. Returns the longest of these times."""

        def first(painter):
            for stroke in list(painter.strokes):
                if stroke.sent >= since and stroke.node is not without:
                    return stroke
            return None

        self.wait(first, "painting to go on")
        return max(first(painter).at for painter in self.painters) - since

    def acknowledged_by(self, node, begin, end):
        return sum(
            stroke.node is node and begin <= stroke.at < end
            for painter in self.painters
            for stroke in list(painter.strokes)
        )

    def end(self):
        """Returns the strokes of all painters."""
        for painter in self.painters:
            painter.stopping.set()
        for painter in self.painters:
            painter.join(LONG_S)
            assert not painter.is_alive(), "a painter still waits for an answer"
            if painter.failure:
                raise painter.failure
        return [stroke for painter in self.painters for stroke in painter.strokes]


# --- the faults: each returns its measurements in seconds, and `late` if it applies


def until_ready(node):
    begun = time.monotonic()
    wait_for(node.is_ready, "the node to be ready again")
    return time.monotonic() - begun


def kill(_, load, owner):
    since = time.monotonic()
    owner.kill()
    found = {"went_on_s": load.went_on(since, owner)}
    owner.start()
    until_ready(owner)
    return found


def drain(_, load, owner):
    since = time.monotonic()
    owner.process.send_signal(signal.SIGTERM)
    assert owner.process.wait(LONG_S) == 0, "SIGTERM did not end the node well"
    ended_s = time.monotonic() - since
    found = {"went_on_s": load.went_on(since, owner), "ended_s": ended_s}
    owner.start()
    until_ready(owner)
    return found


def separated(load, owner, begin, end):
    """The owner cannot renew its lease between `begin` and `end`. After the end of the lease,
    painters must get no acknowledgement from the owner."""
    since = time.monotonic()
    begin()
    went_on_s = load.went_on(since, owner)
    # after the lease, also if the painters have continued earlier
    wait_for(lambda: time.monotonic() > since + LEASE_S + 1, "the lease to be over")
    late = load.acknowledged_by(owner, since + LEASE_S, time.monotonic())
    end()
    return {"went_on_s": went_on_s, "ready_again_s": until_ready(owner), "late": late}


def hang(_, load, owner):
    return separated(load, owner, owner.freeze, owner.thaw)


def cut(_, load, owner):
    return separated(load, owner, owner.database.cut, owner.database.mend)


def postgres(site, load, _):
    since = time.monotonic()
    site.postgres.kill()
    # Before this time, a response about an earlier commit may have arrived.
    killed = time.monotonic()
    site.postgres.restart()
    restarted_s = time.monotonic() - since
    went_on_s = load.went_on(killed) + killed - since
    for node in site.nodes:
        until_ready(node)
    return {"went_on_s": went_on_s, "restarted_s": restarted_s}


FAULTS = {"kill": kill, "drain": drain, "hang": hang, "cut": cut, "postgres": postgres}


class Journal:
    """Compares all acknowledgements with the journal, after each round."""

    def __init__(self, site, model):
        self.site, self.model = site, model
        self.acknowledged = []
        self.lost = self.doubled = 0  # in all rounds

    def check(self, strokes):
        """Adds the strokes of a round. Returns the numbers of lost and doubled strokes in it."""
        self.acknowledged += [stroke.sequence for stroke in strokes]
        found = self.site.postgres.sql(
            f"SELECT coalesce(string_agg(sequence::text, ' '), '') FROM edits WHERE model_id = {self.model['id']}"
        )
        journal = set(map(int, found.split()))
        known = set(self.acknowledged)
        # if two acknowledgements have the same sequence, one of the strokes is lost
        lost = len(known - journal) + len(self.acknowledged) - len(known)
        doubled = len(journal - known)
        in_round = {"lost": lost - self.lost, "doubled": doubled - self.doubled}
        self.lost, self.doubled = lost, doubled
        return in_round


def one_round(site, model, journal, name, seed):
    load = Load(site, model, seed)
    owner = wait_for(lambda: site.owner(model["id"]), "a node that owns the model")
    found = FAULTS[name](site, load, owner)
    strokes = load.end()
    return {**found, **journal.check(strokes), "strokes": len(strokes)}


def table(found):
    lines = [
        "| fault | promise | painting continues after, p50 | p95 | other times, p50 / p95 | acknowledged | lost | doubled | late |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, rounds in found.items():
        column = lambda key: [each[key] for each in rounds if key in each]
        others = [
            f"{title} {percentile(column(key), 0.5):.1f} / {percentile(column(key), 0.95):.1f} s"
            for key, title in (
                ("ended_s", "node ended"),
                ("ready_again_s", "node ready again"),
                ("restarted_s", "PostgreSQL answers"),
            )
            if column(key)
        ]
        times = column("went_on_s")
        promise = f"≤ {PROMISE_S[name]} s" if PROMISE_S[name] else "—"
        late = str(sum(column("late"))) if column("late") else "—"
        sums = " | ".join(str(sum(column(key))) for key in ("strokes", "lost", "doubled"))
        lines.append(
            f"| {name} | {promise} | {percentile(times, 0.5):.2f} s | {percentile(times, 0.95):.2f} s "
            f"| {', '.join(others) or '—'} | {sums} | {late} |"
        )
    return "\n".join(lines)


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--rounds", type=int, default=20)
    reads.add_argument("--seed", type=int, default=1)
    reads.add_argument("--json")
    reads.add_argument("--only", default=",".join(FAULTS))
    asked = reads.parse_args()
    chosen = asked.only.split(",")
    found = {name: [] for name in chosen}
    with Site(NODES, asked.seed, links=True) as site:
        model = site.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        layer = {"name": "marks", "type": "u8", "resolution": 2048}
        site.ok("POST", f"/models/{model['id']}/layers", layer)
        journal = Journal(site, model)
        # one round of each fault in turn, so a slow hour of the machine affects all faults
        for number in range(asked.rounds):
            for name in chosen:
                result = one_round(site, model, journal, name, f"{asked.seed} {number} {name}")
                found[name].append(result)
                print(f"round {number + 1}, {name}: {json.dumps(result)}", flush=True)
        renderer = gl_renderer(site.nodes[0].binary)
    print("\n" + table(found))
    if asked.json:
        facts = {
            "machine": {**machine(), "renderer": renderer},
            "seed": asked.seed,
            "nodes": NODES,
            "painters": PAINTERS,
            "answer_s": ANSWER_S,
            "faults": found,
        }
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(facts, file, indent=1)
    faults = sum(
        each.get(key, 0)
        for rounds in found.values()
        for each in rounds
        for key in ("lost", "doubled", "late")
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
