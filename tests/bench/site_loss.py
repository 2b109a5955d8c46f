#!/usr/bin/python3
"""Measures the loss of a whole site: how much work is not in its archive, and how long a restore
takes.

    STRATA_BINARY=build/release/bin/strata tests/bench/site_loss.py [--losses N] [--edits N]
        [--folder FOLDER] [--json FILE]

A server with a large database (about 3 GB for 1 000 000 edits) keeps an archive (strata serve
--archive), and two painters paint. The site is lost at random moments. From such a moment on,
nothing reaches the archive: the script keeps the archive as it is then, with hard links. Afterwards
it restores the site from each of these archives, starts a server, and compares the edits of the
restored site with the strokes that were acknowledged before the loss:

work lost    time from the acknowledgement of the first lost stroke until the loss
strokes      acknowledged strokes in this time: they are lost
gaps         lost strokes that are older than a stroke in the restored site
doubled      edits of the restored site that no painter sent, or that are there more than once
restore      time of `strata restore`, which reads the copy and the changes from the cache of the disk
picture      time from the start of the restore until the new server has drawn a picture

Prints a Markdown table. Exits with 1 if there was a gap, a doubled edit, or more than PROMISE_S of
lost work. Needs Debian's Python with pytest, because it uses the helpers of the end-to-end tests.
"""
import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import threading
import time
import uuid

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from growth import MODEL, make_site
from support.latencies import percentile
from support.machine import machine
from support.strata_server import StrataServer, wait_for

PROMISE_S = 60
PAINTERS = 2
PAUSE_S = 0.2  # between two strokes of a painter
BETWEEN_LOSSES_S = (10, 50)
EDITS = f"/models/{MODEL}/layers/cracks/edits"


class Painter(threading.Thread):
    """Paints until `stopping` is set."""

    def __init__(self, server, camera, seed):
        super().__init__(daemon=True)
        self.server, self.camera, self.random = server, camera, random.Random(seed)
        self.saved = []  # (time, sequence) of acknowledged strokes
        self.failure = None
        self.stopping = threading.Event()

    def run(self):
        try:
            link = self.server.connect()
            while not self.stopping.wait(PAUSE_S):
                x, y = self.random.uniform(200, 440), self.random.uniform(140, 340)
                edit = {
                    "op": "stroke",
                    "value": self.random.randint(1, 6),
                    "camera": self.camera,
                    "radius_px": 8,
                    "path": [[x, y], [x + 30, y + 20]],
                }
                key = {"Idempotency-Key": str(uuid.uuid4())}
                done = self.server.ok("POST", EDITS, edit, headers=key, connection=link).json()
                self.saved.append((time.monotonic(), done["sequence"]))
        except BaseException as error:  # pylint: disable=broad-except
            self.failure = error


class Loss:
    """The archive at the moment of a loss."""

    def __init__(self, archive, folder):
        self.at, self.folder = time.monotonic(), folder
        # Its owner is the user of PostgreSQL.
        for path, _, files in os.walk(archive):
            there = os.path.normpath(os.path.join(folder, os.path.relpath(path, archive)))
            os.mkdir(there, 0o700)
            owner = os.stat(path)
            os.chown(there, owner.st_uid, owner.st_gid)
            for name in files:
                if not name.endswith(".part"):
                    os.link(os.path.join(path, name), os.path.join(there, name))

    def compare(self, saved, known, found):
        """`saved`: all acknowledged strokes. `known`: the sequences before the painters began.
        `found`: the sequences of the restored site."""
        before = sorted((at, sequence) for at, sequence in saved if at <= self.at)
        assert before, "nothing was painted before the loss"
        there, sent = set(found), {sequence for _, sequence in saved}
        lost = [(at, sequence) for at, sequence in before if sequence not in there]
        return {
            "work_lost_s": self.at - lost[0][0] if lost else 0.0,
            "saved": len(before),
            "strokes": len(lost),
            "gaps": sum(sequence < max(there) for _, sequence in lost),
            "doubled": len(found) - len(there) + len(there - sent - known),
        }


def sequences(server):
    """Returns the sequences of all edits of the large model."""
    told = server.sql(
        "SELECT string_agg(e.sequence::text, ' ') FROM edits e JOIN all_models m "
        f"ON m.id = e.model_id WHERE m.slug = '{MODEL}'"
    )
    return list(map(int, told.split()))


def lose(server, archive, camera, asked, folder):
    """Lets painters paint, and returns the losses, the acknowledged strokes, and the sequences
    before them."""
    known = set(sequences(server))
    painters = [Painter(server, camera, f"{asked.seed} {n}") for n in range(PAINTERS)]
    for painter in painters:
        painter.start()
    chance, losses = random.Random(asked.seed), []
    # In the first minute, less work than in others can be lost.
    end = time.monotonic() + PROMISE_S
    for number in range(asked.losses):
        end += chance.uniform(*BETWEEN_LOSSES_S)
        while time.monotonic() < end:
            for painter in painters:
                if painter.failure:
                    raise painter.failure
            time.sleep(0.01)
        losses.append(Loss(archive, os.path.join(folder, f"lost-{number}")))
        print(f"loss {number + 1} of {asked.losses}", file=sys.stderr, flush=True)
    for painter in painters:
        painter.stopping.set()
    for painter in painters:
        painter.join()
        if painter.failure:
            raise painter.failure
    return losses, [stroke for painter in painters for stroke in painter.saved], known


def restore(loss, camera):
    """Returns the times, and the sequences of the restored site."""
    server = StrataServer()
    try:
        command = [server.binary, "restore", "--archive", loss.folder, "--data", server.data]
        begun = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done
        restored_s = time.monotonic() - begun
        server.start()
        server.ok("POST", f"/models/{MODEL}/frame", {"camera": camera, "format": "png"})
        picture_s = time.monotonic() - begun
        found = sequences(server)
        assert server.stop() == 0
    finally:
        server.remove()
    return {"restore_s": restored_s, "picture_s": picture_s}, found


def table(found, gb):
    column = lambda key: [each[key] for each in found]
    two = (
        lambda key, unit, by=1.0: " / ".join(
            f"{percentile(column(key), share) / by:.1f}" for share in (0.5, 0.95, 1)
        )
        + f" {unit}"
    )
    cells = {
        "database": f"{gb:.1f} GB",
        "losses": str(len(found)),
        "work lost, p50 / p95 / longest": two("work_lost_s", "s"),
        "strokes": f"{sum(column('strokes'))} of {sum(column('saved'))}",
        "gaps": str(sum(column("gaps"))),
        "doubled": str(sum(column("doubled"))),
        "restore": two("restore_s", "s"),
        "restore of a GB": two("restore_s", "s", gb),
        "picture": two("picture_s", "s"),
    }
    return "\n".join(
        [f"| {' | '.join(cells)} |", "|" + "---|" * len(cells), f"| {' | '.join(cells.values())} |"]
    )


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--losses", type=int, default=20)
    reads.add_argument("--edits", type=int, default=300_000)
    reads.add_argument("--models", type=int, default=100)
    reads.add_argument("--layers", type=int, default=600)
    reads.add_argument("--folder", default="/tmp", help="a folder on the disk to measure")
    reads.add_argument("--seed", type=int, default=1)
    reads.add_argument("--json")
    asked = reads.parse_args()
    # A merge replaces the strokes that the script compares.
    os.environ["STRATA_MERGE_AFTER"] = "0"
    with tempfile.TemporaryDirectory(prefix="strata-loss-", dir=asked.folder) as folder:
        os.chmod(folder, 0o755)
        os.environ["STRATA_TEST_TMP"] = folder
        archive = os.path.join(folder, "archive")
        with StrataServer() as server:
            camera, took = make_site(server, asked.models, asked.layers, asked.edits)
            print(f"made {asked.edits} edits in {took:.0f} s", file=sys.stderr, flush=True)
            gb = int(server.sql("SELECT pg_database_size('strata')")) / 1e9
            assert server.stop() == 0
            server.options = ["--archive", archive]
            server.start()
            copies = os.path.join(archive, "copies")
            wait_for(
                lambda: [name for name in os.listdir(copies) if not name.endswith(".part")],
                "the first copy",
                3600,
            )
            losses, saved, known = lose(server, archive, camera, asked, folder)
        found = []
        for loss in losses:
            times, restored = restore(loss, camera)
            found.append({**times, **loss.compare(saved, known, restored)})
            print(json.dumps(found[-1]), file=sys.stderr, flush=True)
    print(table(found, gb))
    if asked.json:
        facts = {"machine": machine(), "seed": asked.seed, "gb": round(gb, 2), "losses": found}
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(facts, file, indent=1)
    bad = any(each["gaps"] or each["doubled"] for each in found)
    return int(bad or max(each["work_lost_s"] for each in found) > PROMISE_S)


if __name__ == "__main__":
    sys.exit(main())
