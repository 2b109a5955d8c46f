#!/usr/bin/python3
"""Measures whether the memory of a server stays flat in a week of painting and of a kiosk.

    STRATA_BINARY=build/release/bin/strata tests/bench/week.py [--days N] [--json FILE]

The week passes at the highest speed of the machine. A day consists of this work:

strokes  4000: four people paint for five hours, a stroke every 18 s
stops    2400: a kiosk plays its tour for eight hours, a stop every 12 s. Each stop is a movement of
         the camera, followed by a picture at rest.

Two painters send the strokes, one of them over live connections: a connection for each stroke, as
if somebody opened the model each time. The kiosk has its own live connection for each tour.

The script samples the memory of the server (VmRSS, without PostgreSQL) 200 times a day. It judges the
growth after the first day in two ways:

line   the slope of the line of least squares through all samples
days   the median of the growth from each day to the next, of the median of a day. A single step up
       or down, for example when an allocator returns memory, does not change this value.

Prints both in MB a day, and the speed: the simulated seconds for each second of the run. Exits with
1 if one of the two is more than MOST_MB_A_DAY, if an edit was lost or doubled, or if somebody could
not continue. Needs Debian's Python with pytest, because it uses the helpers of the end-to-end tests.

For the page of a kiosk in a browser, run e2e_kiosk_test with the values for a week in
tests/e2e/browser/kiosk_test.mjs.
"""
import argparse
import json
import math
import os
import statistics
import sys
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.kiosk_site import make_kiosk
from support.live_client import LAST_RECTANGLE, LiveClient
from support.machine import gl_renderer, machine
from support.painted_model import PaintedModel
from support.painters import HttpPainter, LivePainter
from support.process_memory import resident_mb
from support.strata_server import LONG_S, StrataServer

STROKES, STOPS = 4000, 2400  # of a day
STEPS = 8  # cameras of a movement
DIRECTIONS = ([0, -0.2, 1], [0.8, 0.3, 0.6], [-0.7, -0.9, 0.5])  # of the stops
SAMPLES_A_DAY = 200
SETTLED_DAYS = 1  # allocators and caches grow until then
FEWEST_DAYS = 3  # the growth from the second day to the third
MOST_MB_A_DAY = 5.0


class Progress:
    """The work of one kind that was done. Nobody works ahead of the others by more than a hundredth
    of a day."""

    def __init__(self):
        self.changed = threading.Condition()
        self.done = {"strokes": 0, "stops": 0}
        self.a_day = {"strokes": STROKES, "stops": STOPS}
        self.failure = None
        self.leaving = False

    def days(self):
        return min(self.done[kind] / self.a_day[kind] for kind in self.done)

    def add(self, kind):
        """Returns False if the work is over."""
        with self.changed:
            self.done[kind] += 1
            self.changed.notify_all()
            ahead = lambda: self.done[kind] / self.a_day[kind] - self.days() > 0.01
            self.changed.wait_for(lambda: self.leaving or not ahead())
            return not self.leaving

    def fail(self, error):
        with self.changed:
            self.failure = self.failure or error
            self.changed.notify_all()

    def wait_until(self, days, faults):
        """`faults`: those of the painters."""
        with self.changed:
            reached = lambda: self.failure or faults or self.days() >= days
            is_over = self.changed.wait_for(reached, LONG_S)
        assert not self.failure and not faults, self.failure or faults[:5]
        assert is_over, f"no progress in {LONG_S} s"

    def leave(self):
        with self.changed:
            self.leaving = True
            self.changed.notify_all()


class CountsStrokes:
    """For a painter of this week."""

    progress = None

    def paint(self):
        super().paint()
        self.progress.add("strokes")


class WeekHttpPainter(CountsStrokes, HttpPainter):
    pass


class WeekLivePainter(CountsStrokes, LivePainter):
    pass


class KioskScreen(threading.Thread):
    def __init__(self, server, model, secret, progress):
        super().__init__(daemon=True)
        self.server, self.model, self.secret, self.progress = server, model, secret, progress

    def run(self):
        try:
            while self.play_tour():
                pass
        except Exception as error:  # pylint: disable=broad-except
            self.progress.fail(f"kiosk: {error!r}")

    def play_tour(self):
        """Returns False if the work is over."""
        with LiveClient(self.server, self.model["id"], token=self.secret) as live:
            live.hello(accept=["jpeg"])
            seq, at = 0, DIRECTIONS[-1]
            for direction in DIRECTIONS:
                for step in range(1, STEPS + 1):
                    seq += 1
                    part = (1 - math.cos(math.pi * step / STEPS)) / 2
                    between = [a + (b - a) * part for a, b in zip(at, direction)]
                    camera = camera_from(self.model, between, 640, 480)
                    live.send({"op": "camera", "seq": seq, "moving": step < STEPS, **camera})
                    while True:
                        frame = live.receive_until("frame")
                        if frame["camera_seq"] >= seq and frame["flags"] & LAST_RECTANGLE:
                            break
                at = direction
                if not self.progress.add("stops"):
                    return False
        return True


def kiosk_of(server, model):
    """Makes a tour and a kiosk. Returns the secret of its link."""
    path = f"/models/{model['id']}"
    stops = []
    for number, direction in enumerate(DIRECTIONS, 1):
        camera = camera_from(model, direction, 640, 480)
        server.ok("POST", path + "/views", {"name": f"View {number}", "camera": camera})
        stops.append({"view": f"view-{number}", "title": {"en": f"Stop {number}"}})
    tour = {"name": "Around", "text": "", "languages": ["en"], "idle_s": 90, "stops": stops}
    made = server.ok("POST", path + "/tours", tour).json()
    return make_kiosk(server, f"{path}/tours/{made['slug']}")[1]


def slope(samples):
    """Returns the slope of the line of least squares through (days, MB)."""
    days = sum(at for at, _ in samples) / len(samples)
    mb = sum(each for _, each in samples) / len(samples)
    spread = sum((at - days) ** 2 for at, _ in samples)
    return sum((at - days) * (each - mb) for at, each in samples) / spread


def daily_growth(samples):
    """Returns the median of the growth from each day to the next, in MB."""
    days = [samples[at : at + SAMPLES_A_DAY] for at in range(0, len(samples), SAMPLES_A_DAY)]
    medians = [statistics.median(mb for _, mb in day) for day in days]
    return statistics.median(after - before for before, after in zip(medians, medians[1:]))


def work(server, days):
    """Returns the samples as (days, MB), and the seconds of the work."""
    painted = PaintedModel(server, 1)
    painters = painted.painters([WeekHttpPainter, WeekLivePainter])
    progress = Progress()
    screen = KioskScreen(server, painted.model, kiosk_of(server, painted.model), progress)
    for painter in painters:
        painter.progress = progress
    begun, samples = time.monotonic(), []
    for thread in (*painters, screen):
        thread.start()
    for number in range(1, days * SAMPLES_A_DAY + 1):
        progress.wait_until(number / SAMPLES_A_DAY, painted.book.faults)
        samples.append((number / SAMPLES_A_DAY, resident_mb(server)))
        if number % SAMPLES_A_DAY == 0:
            print(f"day {number // SAMPLES_A_DAY}: {samples[-1][1]:.0f} MB", flush=True)
    seconds = time.monotonic() - begun
    progress.leave()
    painted.end_painting(painters)
    screen.join(LONG_S)
    assert not screen.is_alive() and not progress.failure, progress.failure or "the kiosk hangs"
    edits = server.sql(f"SELECT sequence FROM models WHERE id = {painted.model['id']}")
    assert int(edits) == len(painted.book.edits), f"{edits} edits, {len(painted.book.edits)} saved"
    return samples, seconds


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--days", type=int, default=7)
    reads.add_argument("--json")
    asked = reads.parse_args()
    if asked.days < FEWEST_DAYS:
        reads.error(f"--days must be {FEWEST_DAYS} or more")
    with StrataServer() as server:
        samples, seconds = work(server, asked.days)
        assert server.stop() == 0
    later = [sample for sample in samples if sample[0] > SETTLED_DAYS]
    found = {
        "days": asked.days,
        "speed": round(asked.days * 86400 / seconds),
        "first_mb": round(later[0][1]),
        "last_mb": round(later[-1][1]),
        "most_mb": round(max(mb for _, mb in later)),
        "line_mb_a_day": round(slope(later), 2),
        "days_mb_a_day": round(daily_growth(later), 2),
    }
    print(
        f"{found['days']} days at {found['speed']} times the speed: {found['first_mb']} MB after "
        f"the first day, {found['last_mb']} MB at the end, at most {found['most_mb']} MB; "
        f"{found['line_mb_a_day']:+.2f} MB a day (line), {found['days_mb_a_day']:+.2f} MB a day "
        f"(days); limit {MOST_MB_A_DAY}"
    )
    if asked.json:
        facts = {**machine(), "renderer": gl_renderer(server.binary)}
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump({"machine": facts, **found, "samples": samples}, file, indent=1)
    return int(max(found["line_mb_a_day"], found["days_mb_a_day"]) > MOST_MB_A_DAY)


if __name__ == "__main__":
    sys.exit(main())
