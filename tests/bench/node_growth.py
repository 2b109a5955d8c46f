#!/usr/bin/python3
"""Measures how a site grows with its nodes: painters of different models, viewers at rest, and the
viewers of one model at all nodes.

    STRATA_BINARY=build/release/bin/strata tests/bench/node_growth.py [--nodes 1,2,3] [--share CORES]
        [--painters N] [--viewers N] [--seconds S] [--followers on,off] [--cells N] [--json FILE]

One PostgreSQL and the nodes run on this machine, behind nginx with the configuration of
docs/how-to/run-several-nodes.md. Each node may use the same share of the processors (--share; a
control group limits it), so a node has the same speed in all cases, as if it had its own machine.
PostgreSQL, nginx and the clients use the rest. Each case starts new nodes. Two loads:

models   each painter has its own model; the viewers are distributed over these models. Of several
         models, the script chooses those that nginx distributes evenly over the nodes, as it does
         on average with many models.
one      one painter; all viewers look at the same model, and nginx distributes them over the nodes.
         With --followers off, the nodes send the viewers to the owner.

A painter sends the next batch of a stroke PAUSE_S after it has the pixels of the last one. Viewers
have different views and do not move. Each client acknowledges frames and does not decode them.

own pixels     time from the message with a batch to the first whole frame that shows it
viewers        the same time, for each batch and each viewer of this model
frames         whole frames that all clients received, for each second
ms a frame     processor time of all nodes for each of these frames
MiB a model    growth of the memory of all nodes for each open model, including one view
MiB a viewer   the same for each viewer after that
all drawn      time until all viewers have a picture, after the first of them connected
at rest        cores that all nodes use while nobody paints

Prints Markdown tables. Exits with 1 if a client was disconnected, a batch was refused, or a painter
has changed no texel. Needs Debian's Python with pytest, because it uses the helpers of the
end-to-end tests, and root.
"""
import argparse
import bisect
import collections
import contextlib
import http.client
import itertools
import json
import math
import os
import random
import re
import sys
import tempfile
import threading
import time
import types
import uuid

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.latencies import summary
from support.live_client import AWAY, Connections, Refused
from support.live_line import Line
from support.machine import family_seconds, gl_renderer, machine, processor_seconds
from support.meshes import folded_grid
from support.nginx import Nginx, free_port, site_of_nodes
from support.nodes import Node, SharedPostgres
from support.process_memory import resident_mb, rests
from support.processor_share import ProcessorShare
from support.strata_server import wait_for

NAMES = "abc"
TOKEN = "the owner of the nodes has a token of its own"
WIDTH, HEIGHT = 1280, 720
RADIUS_PX, BATCH_PX, BATCHES = 20, 12, 20  # of a stroke
PAUSE_S = 0.03
REST_S = 5
RESOLUTION = 2048
CHOICE = 3  # models for each painter


class Nodes(contextlib.ExitStack):
    """Nodes behind nginx, each with its share of the processors. Use it in a `with` block."""

    def __init__(self, postgres, count, share, spread=False, options=()):
        super().__init__()
        self.postgres, self.share, self.spread = postgres, share, spread
        self.port = free_port()
        url = f"http://127.0.0.1:{self.port}/node/"
        self.nodes = [Node(postgres, TOKEN, url + name, options) for name in NAMES[:count]]
        self.front = types.SimpleNamespace(host="127.0.0.1", port=self.port, tls=None, token=TOKEN)
        self.nginx = self.log = None

    def __enter__(self):
        super().__enter__()
        try:
            for node in self.nodes:
                self.enter_context(node)
                wait_for(node.is_ready, "a node to be ready")
                self.enter_context(ProcessorShare(node.process.pid, self.share))
            folder = self.enter_context(tempfile.TemporaryDirectory(dir="/tmp"))
            os.chmod(folder, 0o755)
            self.log = os.path.join(folder, "access.log")
            self.nginx = self.enter_context(Nginx(folder, self._site(), self.port))
        except BaseException:
            self.close()
            raise
        return self

    def _site(self):
        """Returns the configuration of nginx, which also logs the node of each request."""
        site = site_of_nodes(self.port, [node.own_port for node in self.nodes], self.spread)
        logged, found = re.subn(
            r"(?m)^(  client_max_body_size .*)$", rf"\1\n  access_log {self.log} node;", site
        )
        assert found == 1
        return "log_format node '$upstream_addr';\n" + logged

    def choose(self, models, count):
        """Returns `count` of the models, and the same number of them for each node, if possible.
        Opens no model, because the requests are refused."""
        places = collections.defaultdict(list)
        for number, model in enumerate(models, 1):
            with contextlib.closing(http.client.HTTPConnection("127.0.0.1", self.port)) as link:
                link.request("GET", f"/api/v1/models/{model['id']}")
                assert link.getresponse().status == 401
            places[wait_for(lambda: self._logged(number), "the log of nginx")].append(model)
        turns = itertools.zip_longest(*places.values())
        return [model for turn in turns for model in turn if model][:count]

    def _logged(self, count):
        """Returns the last line of the log of nginx when it has so many lines."""
        with open(self.log, encoding="ascii") as file:
            lines = file.read().split()
        return lines[-1] if len(lines) >= count else None

    def stop(self):
        """Ends the nodes, so their models have no owner when the next case begins."""
        for node in self.nodes:
            assert node.stop() == 0, "SIGTERM did not end the node well"
            node.assert_clean_log()

    def mb(self):
        """Returns the memory of all nodes once they rest."""
        for node in self.nodes:
            wait_for(lambda: rests(node), "a node to rest")
        return sum(resident_mb(node) for node in self.nodes)

    def connections(self):
        return [int(node.metric("strata_open_sockets")) for node in self.nodes]

    def seconds(self):
        """Returns the processor seconds of all parts until now."""
        return {
            "nodes": [processor_seconds(node.process.pid) for node in self.nodes],
            "postgresql": family_seconds(self.postgres.process.pid),
            "nginx": family_seconds(self.nginx.process.pid),
            "clients": time.process_time(),
        }


class Cores:
    """Measures the cores that all parts use from now until `end`."""

    def __init__(self, nodes):
        self.nodes, self.begun, self.before = nodes, time.monotonic(), nodes.seconds()

    def end(self):
        after, seconds = self.nodes.seconds(), time.monotonic() - self.begun
        each = [b - a for a, b in zip(self.before.pop("nodes"), after.pop("nodes"))]
        return {
            "nodes_s": sum(each),
            "nodes": [round(used / seconds, 3) for used in each],
            **{part: round((after[part] - self.before[part]) / seconds, 3) for part in after},
        }


class Client:
    """A connection to a model through nginx, and the view of this client."""

    faults = []  # of all clients

    def __init__(self, nodes, model, camera, token=TOKEN):
        self.model, self.camera = model, camera
        self.answered = threading.Condition()
        self.sequences = {}  # of batches that were applied, by their number
        self.connections = Connections(nodes.front, model["id"], token)
        live = wait_for(self._welcomed, "a connection")
        self.line = Line(live, self._hears, self.faults.append)
        self.line.reader.start()
        self.line.send({"op": "camera", "seq": 1, "moving": False, **camera})

    def _welcomed(self):
        """Returns a connection to a node that shows this client the model, or None. The next
        attempt follows a message `moved`."""
        try:
            live = self.connections.connect()
            live.hello(accept=["jpeg"])
            return live
        except Refused as refused:
            if refused.status != 503:
                raise
        except AWAY:
            pass
        return None

    def _hears(self, _, message):
        if message["op"] == "applied" and "stroke" in message:
            with self.answered:
                self.sequences[message["stroke"], message["n"]] = message
                self.answered.notify_all()
        elif message["op"] in ("unsaved", "problem", "moved"):
            self.faults.append(f"a client got {message}")

    def until_drawn(self):
        wait_for(lambda: self.line.frames, "a picture")

    def until_shown(self, sequence):
        wait_for(
            lambda: self.line.shown >= sequence, f"a picture with edit {sequence}", every_s=0.002
        )

    def shown_at(self, sequence):
        """Returns the time of the first frame with this edit."""
        frames = self.line.frames
        return frames[bisect.bisect_left(frames, sequence, key=lambda frame: frame[1])][0]

    def frames_between(self, begun, end):
        return sum(begun < at <= end for at, _ in list(self.line.frames))

    def leave(self):
        """Returns whether the server had not closed the connection before."""
        stayed = self.line.ended is None
        self.line.give_up("close")
        return stayed


class Painter(threading.Thread):
    """Paints in the middle of the view of a client until `stopping` is set."""

    def __init__(self, client, seed):
        super().__init__(daemon=True)
        self.client, self.random = client, random.Random(seed)
        self.batches = []  # (time of the message, sequence) of batches that changed texels
        self.stopping = threading.Event()

    def run(self):
        try:
            value = self.random.randint(1, 6)
            while not self.stopping.is_set():
                value = value % 6 + 1
                self.stroke(value)
        except BaseException as error:  # pylint: disable=broad-except
            self.client.faults.append(f"a painter ended: {error!r}")

    def stroke(self, value):
        line, stroke = self.client.line, str(uuid.uuid4())
        begin = {"op": "stroke.begin", "id": str(uuid.uuid4()), "stroke": stroke, "layer": "marks"}
        begin.update(camera=self.client.camera, radius_px=RADIUS_PX, value=value)
        line.send(begin)
        x, y = (self.random.uniform(0.4, 0.6) * side for side in (WIDTH, HEIGHT))
        direction = self.random.uniform(0, 2 * math.pi)
        for n in range(BATCHES):
            if self.stopping.is_set():
                break
            path = [[x, y]]
            direction += self.random.uniform(-0.5, 0.5)
            x, y = x + BATCH_PX * math.cos(direction), y + BATCH_PX * math.sin(direction)
            self.batch(stroke, n, [*path, [x, y]])
            time.sleep(PAUSE_S)
        line.send({"op": "stroke.end", "id": str(uuid.uuid4()), "stroke": stroke})

    def batch(self, stroke, n, path):
        client, sent = self.client, time.monotonic()
        message = {"op": "stroke.extend", "id": str(uuid.uuid4()), "stroke": stroke, "n": n}
        client.line.send({**message, "path": path})
        with client.answered:
            applied = client.answered.wait_for(
                lambda: client.sequences.get((stroke, n)) or client.faults, 180
            )
        assert applied and not client.faults, "a batch was not applied"
        if applied["texels_changed"] > 0:
            client.until_shown(applied["sequence"])
            self.batches.append((sent, applied["sequence"]))


def view(model, number, of):
    """Returns one of `of` different views of the front."""
    angle = 2 * math.pi * number / of
    tilt = 0.15 + 0.5 * (number * 0.618 % 1)
    return camera_from(model, (tilt * math.cos(angle), tilt * math.sin(angle), 1), WIDTH, HEIGHT)


def paint(nodes, clients, viewers, seconds, seed):
    """Lets all clients paint. Returns the times and rates until the viewers have the last pixels.
    Each case needs another seed: a stroke that is painted again changes no texels."""
    painters = [Painter(client, f"{seed} {number}") for number, client in enumerate(clients)]
    cores, begun = Cores(nodes), time.monotonic()
    for painter in painters:
        painter.start()
    time.sleep(seconds)
    for painter in painters:
        painter.stopping.set()
    for painter in painters:
        painter.join()
    painted_s = time.monotonic() - begun
    assert not Client.faults, Client.faults[:5]
    assert all(painter.batches for painter in painters), "a painter has changed no texel"
    own, others = [], []
    for painter in painters:
        client = painter.client
        own += [client.shown_at(sequence) - sent for sent, sequence in painter.batches]
        for viewer in viewers:
            if viewer.model is client.model:
                viewer.until_shown(painter.batches[-1][1])
                others += [viewer.shown_at(sequence) - sent for sent, sequence in painter.batches]
    used, end = cores.end(), time.monotonic()
    frames = sum(client.frames_between(begun, end) for client in [*clients, *viewers])
    return {
        "batches_a_second": round(len(own) / painted_s, 1),
        "own_pixels": summary(own),
        "viewers": summary(others),
        "frames_a_second": round(frames / (end - begun), 1),
        "frame_ms": round(1000 * used.pop("nodes_s") / frames, 1),
        "cores": used,
    }


def measure(nodes, models, asked, seed, token=TOKEN):
    """Opens the models with one painter each, distributes the viewers over them, and paints."""
    empty_mb, clients, viewers = nodes.mb(), [], []
    for model in models:
        clients.append(Client(nodes, model, camera_from(model, (0, -0.2, 1), WIDTH, HEIGHT)))
        clients[-1].until_drawn()
    models_mb, alone = nodes.mb(), nodes.connections()
    begun = time.monotonic()
    for number in range(asked.viewers):
        model = models[number % len(models)]
        viewers.append(Client(nodes, model, view(model, number, asked.viewers), token))
    for viewer in viewers:
        viewer.until_drawn()
    drawn_s = time.monotonic() - begun
    viewers_mb = nodes.mb()
    rest = Cores(nodes)
    time.sleep(REST_S)
    resting = rest.end()
    found = {
        "painters_a_node": alone,
        "viewers_a_node": [b - a for a, b in zip(alone, nodes.connections())],
        "empty_mib_a_node": round(empty_mb / len(nodes.nodes)),
        "mib_a_model": round((models_mb - empty_mb) / len(models), 1),
        "mib_a_viewer": round((viewers_mb - models_mb) / max(1, len(viewers)), 1),
        "all_drawn_s": round(drawn_s, 1),
        "rest_cores": round(sum(resting["nodes"]), 3),
        **paint(nodes, clients, viewers, asked.seconds, seed),
    }
    stayed = [client.leave() for client in [*viewers, *clients]]
    assert all(stayed) and not Client.faults, (stayed, Client.faults[:5])
    nodes.stop()
    return found


def make_models(postgres, count, cells):
    """Returns the models, and the token of a viewer."""
    with Node(postgres, TOKEN) as node:
        models = []
        for number in range(count):
            name = f"Sheet {number}"
            made = node.import_model(
                folded_grid(cells, fold=0.2), "sheet.ply", unit="mm", name=name
            )
            layer = {"name": "marks", "type": "u8", "resolution": RESOLUTION}
            node.ok("POST", f"/models/{made['id']}/layers", layer)
            models.append(node.ok("GET", f"/models/{made['id']}").json())
        token = node.add_person("vera", "viewer")
        assert node.stop() == 0
    return models, token


def times(found):
    return f"{found['ms_p50']:.0f} / {found['ms_p95']:.0f} ms" if found["count"] else "–"


COLUMNS = {
    "own pixels, p50 / p95": lambda found: times(found["own_pixels"]),
    "viewers, p50 / p95": lambda found: times(found["viewers"]),
    "batches/s": lambda found: f"{found['batches_a_second']:.0f}",
    "frames/s": lambda found: f"{found['frames_a_second']:.0f}",
    "ms a frame": lambda found: f"{found['frame_ms']:.0f}",
    "cores of the nodes": lambda found: " + ".join(
        f"{used:.2f}" for used in found["cores"]["nodes"]
    ),
    "all drawn": lambda found: f"{found['all_drawn_s']:.1f} s",
    "at rest": lambda found: f"{found['rest_cores']:.3f}",
}
OF_MEMORY = {
    "MiB a model": lambda found: f"{found['mib_a_model']:.0f}",
    "MiB a viewer": lambda found: f"{found['mib_a_viewer']:.1f}",
}


def table(rows, first, columns):
    """`rows`: pairs of the first cells and the figures."""
    lines = [f"| {' | '.join([*first, *columns])} |", "|" + "---|" * (len(first) + len(columns))]
    for cells, found in rows:
        lines.append(f"| {' | '.join([*cells, *(cell(found) for cell in columns.values())])} |")
    return "\n".join(lines)


def per_node(counts):
    return " + ".join(map(str, counts))


def print_tables(found):
    rows = [
        (
            (
                str(case["nodes"]),
                per_node(case["painters_a_node"]),
                per_node(case["viewers_a_node"]),
            ),
            case,
        )
        for case in found
        if case["load"] == "models"
    ]
    if rows:
        print("\nPainters of different models:\n")
        heads = ("nodes", "painters at each node", "viewers at each node")
        print(table(rows, heads, {**COLUMNS, **OF_MEMORY}))
    rows = [
        ((str(case["nodes"]), case["followers"], per_node(case["viewers_a_node"])), case)
        for case in found
        if case["load"] == "one"
    ]
    if rows:
        print("\nViewers of one model:\n")
        print(table(rows, ("nodes", "followers", "viewers at each node"), COLUMNS))


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    share = round(0.6 * os.cpu_count() / len(NAMES), 2)
    reads.add_argument("--nodes", default="1,2,3")
    reads.add_argument("--share", type=float, default=share, help=f"cores a node, here {share}")
    reads.add_argument("--painters", type=int, default=6)
    reads.add_argument("--viewers", type=int, default=30)
    reads.add_argument("--seconds", type=float, default=15)
    reads.add_argument("--followers", default="on,off", help='"" leaves out this load')
    reads.add_argument(
        "--cells", type=int, default=150, help="the models have 2 · cells² triangles"
    )
    reads.add_argument("--seed", type=int, default=1)
    reads.add_argument("--json")
    asked = reads.parse_args()
    counts = list(map(int, asked.nodes.split(",")))
    found = []

    def note(**case):
        found.append(case)
        print(json.dumps(case), file=sys.stderr, flush=True)

    with SharedPostgres() as postgres:
        models, vera = make_models(postgres, CHOICE * asked.painters, asked.cells)
        for count in counts:
            with Nodes(postgres, count, asked.share) as nodes:
                chosen = nodes.choose(models, asked.painters)
                figures = measure(nodes, chosen, asked, f"{asked.seed} {len(found)}")
                note(load="models", nodes=count, **figures)
        for count in counts:
            for followers in filter(None, asked.followers.split(",")):
                options = ["--followers", followers]
                with Nodes(postgres, count, asked.share, spread=True, options=options) as nodes:
                    seed = f"{asked.seed} {len(found)}"
                    figures = measure(nodes, models[:1], asked, seed, vera)
                    note(load="one", nodes=count, followers=followers, **figures)
    print_tables(found)
    if asked.json:
        facts = {
            "machine": {**machine(), "renderer": gl_renderer(os.environ["STRATA_BINARY"])},
            "options": {name: value for name, value in vars(asked).items() if name != "json"},
            "triangles": 2 * asked.cells**2,
            "view": [WIDTH, HEIGHT],
            "cases": found,
        }
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(facts, file, indent=1)


if __name__ == "__main__":
    main()
