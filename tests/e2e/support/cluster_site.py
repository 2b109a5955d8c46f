"""The example of a cluster (examples/cluster) as a test uses it: painters and a viewer who reach it
through nginx, faults, and the seconds until painting continues."""
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

from support.cameras import camera_from
from support.contract import Contract
from support.live_client import AWAY, LAST_RECTANGLE, Connections, Refused
from support.painted_model import PaintedModel
from support.painters import HttpPainter, LivePainter
from support.strata_server import LONG_S, StrataServer, _place_of_data, wait_for

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "examples" / "cluster"))
from cluster import MEMBERS, NODES, Cluster  # noqa: E402

OF_NGINX = (502, 504)  # no node has answered, or its answer is lost
PAUSE_S = 0.05  # between two strokes of a painter


class ContractOfSite(Contract):
    """Does not contain the answers of nginx itself."""

    def check(self, method, target, answer):
        if answer.status not in OF_NGINX:
            super().check(method, target, answer)


class Gate(StrataServer):
    """The address of the site, which nginx serves. Follows redirections to nodes, and tries again
    while no node can answer. So a change needs an Idempotency-Key."""

    def __init__(self, cluster, token):  # pylint: disable=super-init-not-called
        self.host, self.port, self.tls = "127.0.0.1", cluster.port("nginx"), None
        self.token, self.session, self.contract = token, None, ContractOfSite()

    def request(self, method, path, body=None, connection=None, **more):
        end = time.monotonic() + LONG_S
        target = path
        while True:
            try:
                answer = super().request(method, target, body, **more)
            except AWAY:
                answer = None
            if answer is not None and answer.status == 307:
                target = (
                    "/"
                    + urllib.parse.urlsplit(answer.headers["Location"])
                    ._replace(scheme="", netloc="")
                    .geturl()
                )
                continue
            if answer is not None and answer.status not in (503, *OF_NGINX):
                return answer
            target = path
            assert time.monotonic() < end, f"{method} {path} got no answer in {LONG_S} s: {answer}"
            time.sleep(0.05)


class Times:
    """The times at which each stroke of one painter began and was saved."""

    def __init__(self):
        self.strokes = []

    def first_since(self, begun):
        """Returns the time at which the first stroke that began later was saved, or None."""
        return next((saved for start, saved in list(self.strokes) if start > begun), None)


class SitePainter(HttpPainter):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.times = Times()

    def paint(self):
        begun = time.monotonic()
        super().paint()
        self.times.strokes.append((begun, time.monotonic()))
        time.sleep(PAUSE_S)


class LiveSitePainter(LivePainter):
    TRY_AGAIN = (429, 503, *OF_NGINX)

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.times = Times()
        self.connections = Connections(self.server, self.model)

    def connect(self):
        return self.connections.connect()

    paint_stroke = LivePainter.paint

    def paint(self):
        begun = time.monotonic()
        self.paint_stroke()
        self.times.strokes.append((begun, time.monotonic()))
        time.sleep(PAUSE_S)


class Viewer(threading.Thread):
    """Turns the camera all the time, connects again when it loses the connection, and stores the
    time of each frame."""

    def __init__(self, painted):
        super().__init__(daemon=True, name="viewer")
        self.connections = Connections(painted.server, painted.model["id"])
        self.model, self.fault = painted.model, painted.book.fault
        self.frames, self.leaving = [], threading.Event()

    def run(self):
        try:
            while not self.leaving.is_set():
                try:
                    with self.connections.connect() as live:
                        self.watch(live)
                except Refused as refused:
                    assert refused.status in LiveSitePainter.TRY_AGAIN, refused
                except AWAY:
                    pass
                time.sleep(0.05)
        except Exception as error:  # pylint: disable=broad-except
            self.fault(f"viewer: {error!r}")

    def watch(self, live):
        live.hello(accept=["jpeg"])
        seq = 0
        while not self.leaving.is_set():
            seq += 1
            angle = seq / 20
            camera = camera_from(self.model, (math.sin(angle) / 2, -0.2, 1), 320, 240)
            live.send({"op": "camera", "seq": seq, "moving": True, **camera})
            while True:
                frame = live.receive_until("frame")
                if frame["flags"] & LAST_RECTANGLE:
                    self.frames.append(time.monotonic())
                    if frame["camera_seq"] >= seq:
                        break
            time.sleep(0.1)

    def frames_since(self, begun):
        return [at for at in list(self.frames) if at > begun]

    def longest_gap(self, begun, end):
        """Returns the seconds without a frame."""
        times = [begun, *(at for at in list(self.frames) if begun < at < end), end]
        return max(after - before for before, after in zip(times, times[1:]))


class ClusterSite:
    """The example of a cluster in a temporary folder. Use it in a `with` block; `up` starts it."""

    def __init__(self):
        self.token = "the owner of the cluster has a token of its own"
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="strata-cluster-", dir=_place_of_data()))
        self.folder.chmod(0o755)
        self.cluster = Cluster(self.folder)
        self.gate = self.guard = None

    def __enter__(self):
        # If the test is killed, for example by CTest, this process ends the cluster.
        self.guard = subprocess.Popen(
            [
                *("sh", "-c", 'read -r end; "$0" --folder "$1" && rm -rf "$1"'),
                *(self.command("down"), self.folder),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        StrataServer.running.append(self)  # a failure shows its logs
        return self

    def __exit__(self, *_):
        StrataServer.running.remove(self)
        self.guard.communicate()
        shutil.rmtree(self.folder, ignore_errors=True)

    @staticmethod
    def command(name):
        return str(ROOT / "examples" / "cluster" / name)

    def environment(self):
        return {
            **os.environ,
            "STRATA_SAMPLES_AT_REST": "1",
            "STRATA_OWNER_TOKEN": self.token,
            "STRATA_CLUSTER": str(self.folder),
        }

    def run(self, line):
        """Runs a line of shell in the folder of the project. Returns its output."""
        done = subprocess.run(
            ["bash", "-c", line],
            cwd=ROOT,
            env=self.environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, f"{line}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        self.cluster = Cluster(self.folder)  # its settings
        if self.cluster.settings and not self.gate:
            self.gate = Gate(self.cluster, self.token)
        return done.stdout

    @property
    def url(self):
        return self.folder

    def end_of_log(self):
        ends = []
        for log in sorted((self.folder / "logs").glob("*.log")):
            lines = log.read_text("utf-8", "replace").splitlines()[-40:]
            ends.append("\n".join([f"--- {log.name}", *lines]))
        return "\n".join(ends)

    # --- faults

    def owner(self, model):
        """Returns the node that owns the model according to the database, or None."""
        primary = self.cluster.primary()
        url = primary and self.cluster.psql(
            primary,
            "SELECT n.url FROM models m JOIN nodes n ON n.id = m.owner_node "
            f"WHERE m.id = {int(model)} AND n.lease_until > clock_timestamp() AND NOT n.draining",
            database="strata",
        )
        return f"node-{url[-1]}" if url else None

    def leave_commits_unconfirmed(self, primary):
        """Stops the replication of the primary, and then makes it write commits that no standby
        has. So pg_rewind must repair its PostgreSQL when it starts again."""
        senders = wait_for(
            lambda: self.cluster.psql(primary, "SELECT pid FROM pg_stat_replication").split(),
            "a standby that receives from the primary",
        )
        for pid in senders:
            os.kill(int(pid), signal.SIGSTOP)
        self.cluster.psql(
            primary,
            "SET synchronous_commit = local; SELECT pg_logical_emit_message(true, 'test', 'lost')",
        )


def paint_at(site, seed):
    """Imports a model, and starts two painters and a viewer who use it through nginx."""
    painted = PaintedModel(site.gate, seed)
    painters = painted.painters([SitePainter, LiveSitePainter])
    viewer = Viewer(painted)
    for thread in (*painters, viewer):
        thread.start()
    return painted, painters, viewer


def seconds_until_all_paint(painted, painters, begun):
    """Waits until each painter has a saved stroke that began later. Returns the seconds."""

    def done():
        assert not painted.book.faults, painted.book.faults[:5]
        found = [painter.times.first_since(begun) for painter in painters]
        return found if all(found) else None

    return max(wait_for(done, "everybody to paint")) - begun


__all__ = [
    "MEMBERS",
    "NODES",
    "ClusterSite",
    "paint_at",
    "seconds_until_all_paint",
]
