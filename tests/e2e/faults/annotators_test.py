#!/usr/bin/env python3
"""Users with different cameras paint one layer and are disconnected at random. No edit is lost or
doubled. The texels equal the result of a serial replay of the acknowledged edits on a new server,
in the order of their sequence.

annotators_test.py [--seconds 600] [--seed N] [--people 8] [--turning 4] [--model pot|FILE]
[--json FILE]

Each user signs in and has a separate view. The users paint strokes, polygons and fills, undo and
redo, over the live connection and over HTTP. After a few seconds to tens of seconds, the test ends
each connection normally, with a reset or with an incomplete message, or leaves it open while the
user opens the next connection. On the new connection, the user repeats, with the same ids,
all edits that are not known to be durable, and sometimes durable edits too. The printed times and
processor seconds, also in FILE, do not affect the result."""
import argparse
import collections
import datetime
import http.client
import json
import math
import os
import queue
import sys
import threading
import time

from support.annotators import Annotator
from support.browsers import join
from support.cameras import camera_from
from support.latencies import histogram, latencies, summary
from support.ledger import Ledger
from support.live_client import LiveClient
from support.live_line import WAYS, Line
from support.machine import Watch, gl_renderer, machine
from support.meshes import bumpy_ball
from support.npy import Raster
from support.strata_server import LONG_S, StrataServer, wait_for

LAYER = "findings"
LEAST_CUTS = 2  # the minimum for each user, regardless of the machine's speed
LEAST_EDITS = 200
SAMPLE_EVERY_S = 5


class Site:
    """A server with one model, a layer that all users paint, and its users."""

    def __init__(self, server, asked):
        self.server, self.people, self.turning, self.pace = (
            server,
            asked.people,
            asked.turning,
            asked.pace,
        )
        self.window, self.cut_every = asked.window, asked.cut_every
        if asked.model == "pot":
            self.model = server.ok("GET", "/models/demo-pot").json()
        elif asked.model:
            with open(asked.model, "rb") as file:
                self.model = server.import_model(
                    file.read(), os.path.basename(asked.model), unit=asked.unit, name="Model"
                )
        else:
            self.model = server.import_model(bumpy_ball(), "ball.ply", unit="mm", name="Model")
        self.path = f"/models/{self.model['id']}/layers/"
        self.before = max(
            (layer["sequence"] for layer in server.ok("GET", self.path[:-1]).json()["layers"]),
            default=0,
        )
        made = server.ok(
            "POST",
            self.path[:-1],
            {"name": "Findings", "type": "u8", "resolution": asked.resolution},
        ).json()
        self.layer = made["slug"]
        assert self.layer == LAYER, made
        self.path += LAYER
        self.ledger = Ledger()
        self.stopping, self.leaving = threading.Event(), threading.Event()

    def sign_in(self, number):
        return join(
            self.server,
            self.server.ok(
                "POST", "/users", {"user": f"painter{number}", "role": "annotator"}
            ).json(),
        )

    def camera(self, angle):
        around = (math.cos(angle), math.sin(angle), 0.35)
        if self.model["up"] == "z":
            return camera_from(self.model, around, *self.window)
        return camera_from(
            self.model, (around[1], around[2], around[0]), *self.window, up=(0, 1, 0)
        )

    def ask_and_go(self, browser, path, body, key):
        """Sends a request without waiting for the response."""
        link = http.client.HTTPConnection(self.server.host, self.server.port, timeout=LONG_S)
        content = json.dumps(body).encode() if body else b""
        link.request(
            "POST",
            "/api/v1" + path,
            body=content,
            headers={
                "Origin": self.server.url,
                "Cookie": browser.cookie,
                "Content-Type": "application/json",
                "Idempotency-Key": key,
            },
        )
        link.close()

    def texels(self):
        return Raster(self.server.ok("GET", self.path + "/texels.npy").body)

    def history(self):
        found = []
        while True:
            page = self.server.ok("GET", f"{self.path}/edits?limit=1000&offset={len(found)}").json()
            found += page["edits"]
            if not page["edits"] or len(found) >= page["total"]:
                return found[::-1]


def check_faults(ledger):
    assert not ledger.faults, "\n".join(ledger.faults[:10])


def paint(site, seconds, seed):
    """All users paint for this time, and until each was disconnected and a response was repeated.
    Returns the annotators and the measurements."""
    browsers = [site.sign_in(number) for number in range(site.people)]
    annotators = [
        Annotator(site, number, browser, f"{seed} {number}")
        for number, browser in enumerate(browsers)
    ]
    ledger = site.ledger
    for annotator in annotators:
        annotator.start()
    wait_for(
        lambda: ledger.faults or all(a.line and a.line.frames for a in annotators),
        "everybody to see a frame",
    )
    watch, begun, sampled = Watch(site.server), time.monotonic(), 0.0

    def enough():
        nonlocal sampled
        now = time.monotonic()
        if now > sampled + SAMPLE_EVERY_S:
            sampled = now
            watch.sample()
        if ledger.faults:
            return True
        return (
            now - begun > seconds
            and all(sum(a.cuts.values()) >= LEAST_CUTS for a in annotators)
            and ledger.repeats > 0
            and len(ledger.saved()) >= LEAST_EDITS
        )

    wait_for(enough, "enough to be painted", limit_s=seconds + 3 * LONG_S)
    measured = watch.end(site.people)
    measured["bytes_received_a_viewer_and_second"] = round(
        sum(line.live.bytes_received for a in annotators for line in a.lines)
        / site.people
        / measured["seconds"]
    )
    measured["frames_a_second"] = {
        kind: round(
            sum(len(line.frames) for a in annotators if a.turning == turning for line in a.lines)
            / max(1, sum(a.turning == turning for a in annotators))
            / measured["seconds"],
            1,
        )
        for kind, turning in (("still", False), ("turning", True))
    }
    site.stopping.set()
    check_faults(ledger)
    wait_for(
        lambda: ledger.faults or all(a.drained.is_set() for a in annotators),
        "all that was sent to be durable",
        limit_s=3 * LONG_S,
    )
    check_faults(ledger)
    newest = max(
        change.answer[0]
        for change in ledger.changes.values()
        if change.answer and change.answer[1] > 0
    )
    wait_for(
        lambda: ledger.faults or all(a.line.shown >= newest for a in annotators),
        f"everybody to see edit {newest}",
    )
    site.leaving.set()
    for annotator in annotators:
        annotator.join(LONG_S)
        assert not annotator.is_alive(), annotator.name
        for line in annotator.hanging:
            line.live.socket.close()
    check_faults(ledger)
    return annotators, measured


def check_history(site):
    """Checks that the history contains each saved change once, and no other change. Returns the
    changes in the order of their sequence."""
    ledger, rows = site.ledger, site.history()
    sequences = [row["sequence"] for row in rows]
    assert sequences == list(
        range(site.before + 1, site.before + 1 + len(rows))
    ), "the sequences have gaps"
    saved = ledger.saved()
    of_live = {change.id: change for change in saved if not change.by_http}
    of_http = {change.answer[0]: change for change in saved if change.by_http}
    # An undo was refused at first, because there was nothing to undo. Later, when an undo was
    # possible, the server read a copy of the message from a connection that had stayed open.
    of_copies = {
        change.id: change
        for change in ledger.changes.values()
        if change.refused and not change.by_http and len(change.lines) > 1
    }
    ordered = []
    for row in rows:
        change = (
            of_live.pop(row["id"], None)
            or of_http.pop(row["sequence"], None)
            or of_copies.pop(row["id"], None)
        )
        assert change, f"nobody was told that {row} is saved, or it is there twice"
        assert row["user"] == change.user, (row, change.message)
        if change.answer:
            assert (row["sequence"], row["texels_changed"]) == change.answer[:2], (
                row,
                change.answer,
            )
        change.sequence, change.texels = row["sequence"], row["texels_changed"]
        ordered.append(change)
    lost = [*of_live.values(), *of_http.values()]
    assert (
        not lost
    ), f"{len(lost)} changes were told saved and are not in the history: {[c.message for c in lost[:3]]}"
    waiting = [c for c in ledger.changes.values() if not (c.saved_at or c.promised or c.refused)]
    assert not waiting, f"{len(waiting)} changes were never answered"
    in_history = {change.id for change in ordered}
    for stroke, n in ledger.claims:
        missing = [k for k in range(n + 1) if ledger.batches[stroke, k].id not in in_history]
        assert (
            not missing
        ), f"a welcome said that stroke {stroke} is saved up to {n}; {missing} are not"
    return ordered


class Replay:
    """Repeats the edits one by one on a new server, by the same users. Each edit is durable before
    the next is sent."""

    def __init__(self, site):
        self.site, self.answers, self.begun = site, queue.Queue(), set()
        self.lines = {}
        for number in range(site.people):
            browser = site.sign_in(number)
            live = LiveClient(
                site.server,
                site.model["id"],
                token="",
                cookie=browser.cookie,
                origin=site.server.url,
            )
            live.hello()
            self.lines[f"painter{number}"] = line = Line(
                live, self.hears, lambda text: self.answers.put({"op": "fault", "detail": text})
            )
            line.reader.start()

    def hears(self, _, message):
        if message["op"] in ("saved", "problem", "unsaved"):
            self.answers.put(message)

    def paint(self, change, shift):
        line = self.lines[change.user]
        if change.begin and change.begin["stroke"] not in self.begun:
            self.begun.add(change.begin["stroke"])
            line.send(change.begin)
        line.send(change.message)
        answer = self.answers.get(timeout=LONG_S)
        now, then = (answer.get("sequence"), answer.get("texels_changed")), (
            change.sequence + shift,
            change.texels,
        )
        assert (
            answer["op"] == "saved" and now == then
        ), f"{change.message} as edit {change.sequence} changed {change.texels} texels; in the replay: {answer}"
        if change.answer:
            assert math.isclose(answer["area_m2"], change.answer[2], rel_tol=1e-9, abs_tol=1e-15), (
                change.answer,
                answer,
            )

    def run(self, changes, shift):
        for change in changes:
            self.paint(change, shift)
        for line in self.lines.values():
            line.give_up("close")


def compare(site, other, what):
    first, second = site.texels(), other.texels()
    wrong = first.differences(second) if first.digest != second.digest else []
    assert (
        first.digest == second.digest
    ), f"{len(wrong)} texels differ from {what}, for example {wrong[:3]}"
    return first


def report(ledger, annotators, ordered, painted):
    kinds = collections.Counter(change.kind for change in ordered)
    cuts = {way: sum(a.cuts[way] for a in annotators) for way in WAYS}
    found, away = latencies(ledger, annotators)
    return {
        "edits": {
            "saved": len(ordered),
            "by_kind": dict(kinds),
            "by_http": sum(c.by_http for c in ordered),
            "learned_from_a_welcome": sum(c.promised and not c.saved_at for c in ordered),
            "sent_again": sum(len(c.lines) - 1 for c in ordered),
            "repeats_answered_alike": ledger.repeats,
            "put_off": ledger.put_off,
            "unsaved": ledger.unsaved,
            "refused": dict(
                collections.Counter(c.refused for c in ledger.changes.values() if c.refused)
            ),
            "texels_painted_at_the_end": painted,
        },
        "connections": {
            "opened": sum(len(a.lines) for a in annotators),
            "cut_off": cuts,
            "ended_by_the_server": [str(code) for code in ledger.dropped],
        },
        "latency": {
            "stroke_to_applied": summary(found["applied"]),
            "stroke_to_saved": summary(found["saved"]),
            "stroke_to_others_pixels": {
                kind: summary(found[kind]) for kind in ("still", "turning")
            },
            "stroke_to_own_pixels": summary(found["own"]),
            "others_cut_off_meanwhile": away,
        },
        "histogram": {kind: histogram(found[kind]) for kind in ("still", "turning", "saved")},
    }


def table(result):
    latency, load = result["latency"], result["processors"]
    lines = [f"{'':34} {'count':>7} {'p50':>8} {'p95':>8} {'max':>9}  ms"]
    for name, row in (
        ("stroke → applied", latency["stroke_to_applied"]),
        ("stroke → durable", latency["stroke_to_saved"]),
        ("stroke → own pixels", latency["stroke_to_own_pixels"]),
        ("stroke → others' pixels, still", latency["stroke_to_others_pixels"]["still"]),
        ("stroke → others' pixels, turning", latency["stroke_to_others_pixels"]["turning"]),
    ):
        if row["count"]:
            lines.append(
                f"{name:34} {row['count']:7} {row['ms_p50']:8.1f} {row['ms_p95']:8.1f} {row['ms_max']:9.1f}"
            )
    lines += [
        f"cores used: {load['cores_used']}",
        f"cores a viewer: {load['cores_a_viewer']}, by thread {load['cores_a_viewer_by_thread']}",
        f"bytes a viewer and second: {load['bytes_received_a_viewer_and_second']}, frames a second {load['frames_a_second']}, load average {load['load_average']}",
        f"edits: {result['edits']}",
        f"connections: {result['connections']}",
    ]
    return "\n".join(lines)


def arguments(words):
    parser = argparse.ArgumentParser()
    parser.add_argument(
        "--seconds", type=float, default=float(os.environ.get("STRATA_ANNOTATORS_SECONDS", "30"))
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=int(os.environ.get("STRATA_SEED", "1")),
    )
    parser.add_argument("--people", type=int, default=8)
    parser.add_argument(
        "--turning", type=int, default=4, help="so many turn their camera all the time"
    )
    parser.add_argument(
        "--pace", type=float, default=8, help="messages a second of who draws a stroke"
    )
    parser.add_argument("--window", default="640x480", help="pixels of each view")
    parser.add_argument(
        "--cut-every", default="1,8", help="seconds between cuts of one person, from and to"
    )
    parser.add_argument(
        "--model", help="pot: that of the demo project; or a file; a generated ball where absent"
    )
    parser.add_argument("--unit", default="mm")
    parser.add_argument("--resolution", type=int, default=2048)
    parser.add_argument("--json", help="write what was measured here")
    asked = parser.parse_args(words)
    asked.window = tuple(map(int, asked.window.split("x")))
    asked.cut_every = tuple(map(float, asked.cut_every.split(",")))
    return asked


def test_nothing_is_lost_or_doubled_and_the_texels_are_those_of_a_serial_replay():
    measure(arguments([]))


def measure(asked):
    print(
        f"seed {asked.seed}: {asked.people} people for {asked.seconds:g} s, {asked.turning} of them turn their camera",
        flush=True,
    )
    demo, of_machine = asked.model == "pot", machine()
    with StrataServer(demo=demo) as server:
        site = Site(server, asked)
        annotators, measured = paint(site, asked.seconds, asked.seed)
        ordered = check_history(site)
        print(f"{len(ordered)} edits are in the history, each once and without a gap", flush=True)
        with StrataServer(demo=demo) as fresh:
            other = Site(fresh, asked)
            begun = time.monotonic()
            Replay(other).run(ordered, other.before - site.before)
            replayed_s = time.monotonic() - begun
            raster = compare(site, other, "the serial replay")
        assert server.stop() == 0
        server.start()
        assert site.texels().digest == raster.digest, "the texels are not those of the journal"
        server.assert_clean_log()
    painted = sum(valid for _, valid in raster.texel.iter_unpack(raster.content))
    result = {
        "machine": {
            **of_machine,
            "gl_renderer": gl_renderer(server.binary),
            "date": datetime.date.today().isoformat(),
        },
        "run": {
            "seed": asked.seed,
            "seconds": asked.seconds,
            "people": asked.people,
            "turning": asked.turning,
            "pace": asked.pace,
            "window": list(asked.window),
            "cut_every_s": list(asked.cut_every),
            "model": os.path.basename(asked.model or "ball"),
            "triangles": site.model["triangles"],
            "resolution": asked.resolution,
        },
        "processors": measured,
        **report(site.ledger, annotators, ordered, painted),
        "replay": {
            "seconds": round(replayed_s, 1),
            "texels": raster.width * raster.height,
            "differences": 0,
        },
    }
    print(table(result))
    print(
        f"all {raster.width * raster.height} texels are those of the serial replay ({replayed_s:.0f} s), and of the journal after a restart"
    )
    if asked.json:
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    measure(arguments(sys.argv[1:]))
