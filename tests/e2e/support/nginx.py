"""nginx with one of the project's own configurations, for tests behind a proxy."""
import itertools
import os
import re
import shutil
import socket
import subprocess

from support.missing import missing
from support.strata_server import _end_with_parent, wait_for

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
HOW_TO = "docs/how-to/run-several-nodes.md"


def nginx_binary():
    unpacked = os.path.join(ROOT, "build", "deps", "usr", "sbin", "nginx")
    found = (
        unpacked
        if os.path.exists(unpacked)
        else shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin")
    )
    return found or missing("nginx is not installed")


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def site_of(file, replacements):
    """Returns the configuration in a file of the project, with the values of a test. Each pattern
    must occur exactly once."""
    with open(os.path.join(ROOT, file), encoding="utf-8") as opened:
        site = opened.read()
    for pattern, ours in replacements:
        site, found = re.subn(pattern, ours, site)
        assert found == 1, pattern
    return site


def site_of_nodes(port, ports, spread=False):
    """Returns the example of a configuration (examples/nodes/nginx.conf) for the nodes a, b, … on
    these ports, at most three. With `spread`, it distributes the live connections over all nodes
    (docs/how-to/run-several-nodes.md)."""
    replacements = [(r"listen 80;", f"listen 127.0.0.1:{port};")]
    for usual, name, own in itertools.zip_longest((8081, 8082, 8083), "abc", ports):
        if own is None:
            replacements += [
                (rf" *server 127\.0\.0\.1:{usual} .*\n", ""),
                (rf" *location /node/{name}/ .*\n", ""),
            ]
        else:
            replacements += [
                (rf"server 127\.0\.0\.1:{usual} ", f"server 127.0.0.1:{own} "),
                (rf"http://127\.0\.0\.1:{usual}/;", f"http://127.0.0.1:{own}/;"),
            ]
    if spread:
        with open(os.path.join(ROOT, HOW_TO), encoding="utf-8") as page:
            [line] = re.findall(
                r"^  '~\^/api/v1/models/\[.*/live\$' .*;$", page.read(), re.MULTILINE
            )
        replacements.append((r"\n(  '~\^/api/v1/models/)", lambda at: f"\n{line}\n{at[1]}"))
    return site_of("examples/nodes/nginx.conf", replacements)


class Nginx:
    """A running nginx. `port` is a port on which it listens."""

    def __init__(self, folder, site, port):
        self.folder, self.site, self.port = folder, site, port
        self.process = None

    def __enter__(self):
        temporary = "".join(
            f"{kind}_temp_path {self.folder}/{kind};"
            for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
        )
        conf = os.path.join(self.folder, "nginx.conf")
        user = "user root;" if os.geteuid() == 0 else ""
        with open(conf, "w", encoding="utf-8") as file:
            file.write(
                f"daemon off; pid {self.folder}/nginx.pid; error_log {self.folder}/error.log; {user}\n"
                f"events {{}}\nhttp {{ access_log off; {temporary}\n{self.site} }}\n"
            )
        self.process = subprocess.Popen(
            [nginx_binary(), "-p", self.folder, "-c", conf],
            preexec_fn=_end_with_parent,
            stderr=subprocess.DEVNULL,
        )
        wait_for(self.answers, "nginx to listen")
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def answers(self):
        log = os.path.join(self.folder, "error.log")
        if self.process.poll() is not None:
            with open(log, encoding="utf-8") as file:
                raise AssertionError(f"nginx ended: {file.read()}")
        try:
            socket.create_connection(("127.0.0.1", self.port)).close()
            return True
        except ConnectionRefusedError:
            return False
