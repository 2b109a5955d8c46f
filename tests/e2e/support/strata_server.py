"""A separate Strata server for a test: real PostgreSQL, real GL, any free port, a temporary data
folder.

Reads STRATA_BINARY. Functions here wait for conditions, up to LONG_S, and never for a fixed time.
"""
import ctypes
import http.client
import json
import os
import re
import secrets
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import urllib.parse

from .contract import Contract

LONG_S = 180
IN_MEMORY = "/dev/shm"
OFTEN = ["--recheck-every", "1"]  # tests do not wait for the default interval
ROOM_BYTES = 8 << 30  # enough for several concurrent tests, one of which writes gigabytes

# Requests that the server refuses for tokens of scripts. It also refuses them for the owner's
# token once an administrator has a password.
OF_ACCOUNTS = re.compile(r"/(users|groups|me/)|/projects/[^/]+/(members|groups)(/|$)|.*/kiosks$")


def _place_of_data():
    """Returns a folder in memory if there is space, because a disk is slow for a database. All
    users can access the folder."""
    wanted = os.environ.get("STRATA_TEST_TMP")
    if wanted:
        return wanted
    roomy = os.access(IN_MEMORY, os.W_OK) and shutil.disk_usage(IN_MEMORY).free > ROOM_BYTES
    return IN_MEMORY if roomy else "/tmp"


def wait_for(condition, what, limit_s=LONG_S, every_s=0.02):
    """Waits for the first true result of `condition`, and returns it."""
    end = time.monotonic() + limit_s
    while True:
        found = condition()
        if found:
            return found
        if time.monotonic() > end:
            raise AssertionError(f"waited {limit_s} s for {what}")
        time.sleep(every_s)


def _end_with_parent():
    """Kills the server if the test is killed (by CTest's time limit)."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class Answer:
    """An HTTP response."""

    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)

    def __repr__(self):
        return f"<{self.status} {self.body[:400]!r}>"


class Requests:
    """Shorter calls of `request`."""

    def get(self, path, **more):
        return self.request("GET", path, **more)

    def post(self, path, body=None, **more):
        return self.request("POST", path, body, **more)

    def ok(self, method, path, body=None, expect=(200, 201, 202, 204), **more):
        answer = self.request(method, path, body, **more)
        assert answer.status in expect, f"{method} {path}: {answer}"
        return answer


class StrataServer(Requests):
    running = []  # the servers in `with` blocks, whose logs a failure shows

    def __init__(self, demo=False, options=()):
        self.binary = os.environ["STRATA_BINARY"]
        self.token = secrets.token_hex(24)
        self.options = list(options)  # options of `serve`
        # The folder is open to all users. PostgreSQL does not run as root, so its user needs
        # access.
        self.data = tempfile.mkdtemp(prefix="strata-e2e-", dir=_place_of_data())
        os.chmod(self.data, 0o755)
        self.process = None
        self.session = None  # the owner's session, for requests about accounts
        self.tls = None  # an ssl.SSLContext if the server uses https
        self.contract = Contract()
        self.host, self.port, self.link = "127.0.0.1", None, None
        self.listen = "127.0.0.1:0"
        self.log = []
        self.changed = threading.Condition()
        self.demo = demo

    def _fill(self):
        """Copies the result of tests/support/prepare, or makes the data if that script did not run.
        Keeps the files that a test has put into the folder."""
        if os.listdir(self.data):
            return
        prepared = os.environ.get("STRATA_TEST_PREPARED")
        if prepared:
            kind = "demo" if self.demo else "empty"
            # copies owners and modes, because PostgreSQL requires both
            subprocess.run(["cp", "-a", os.path.join(prepared, kind, "."), self.data], check=True)
        elif self.demo:
            done = subprocess.run(
                [self.binary, "demo", "--pot-only", "--data", self.data],
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode != 0:
                raise AssertionError(f"strata demo failed: {done.stderr}")

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.remove()
            raise
        self.running.append(self)
        return self

    def __exit__(self, *failure):
        self.running.remove(self)
        ended = self.process and self.process.poll()
        if self.process and ended is None:
            self.kill()
        if failure[0]:
            print(
                "the server " + (f"had ended with {ended}" if ended is not None else "was running")
            )
            print("--- log of the server\n" + self.end_of_log(), flush=True)
        self.remove()

    def end_of_log(self):
        return "\n".join(self.log[-200:])

    def remove(self):
        # The kernel ends PostgreSQL after its server has ended. Until then PostgreSQL may write.
        wait_for(lambda: self.postmaster() is None, "the private PostgreSQL to end")
        shutil.rmtree(self.data, ignore_errors=True)

    def environment(self):
        # Without refinement, frames at rest always have the same pixels.
        return {"STRATA_SAMPLES_AT_REST": "1", **os.environ, "STRATA_OWNER_TOKEN": self.token}

    def start(self):
        """Starts the server, or starts it again, and returns when it listens."""
        self._fill()
        self.process = subprocess.Popen(
            [
                self.binary,
                "serve",
                "--data",
                self.data,
                "--listen",
                self.listen,
                *([] if OFTEN[0] in self.options else OFTEN),
                *self.options,
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=self.environment(),
            preexec_fn=_end_with_parent,
        )
        threading.Thread(target=self._read_log, args=(self.process.stderr,), daemon=True).start()
        port = link = None
        for line in self.process.stdout:
            if line.startswith("listening on "):
                port = urllib.parse.urlsplit(line.split()[-1]).port
            if line.startswith(("owner link: ", "sign in at: ")):
                link = line.split()[-1]
                break
        if not port or not link:
            raise AssertionError(
                f"the server ended with {self.process.wait()}:\n" + "\n".join(self.log[-50:])
            )
        with self.changed:
            self.port, self.link = port, link
            self.changed.notify_all()
        return self

    def _read_log(self, stream):
        for line in stream:
            self.log.append(line.rstrip("\n"))

    @property
    def url(self):
        return f"{'https' if self.tls else 'http'}://{self.host}:{self.port}"

    def kill(self):
        """Sends kill -9, and waits for the end."""
        with self.changed:
            self.port = None
        self.process.kill()
        self.process.wait()

    def stop(self):
        """Sends SIGTERM. Returns the exit status."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(LONG_S)

    def postmaster(self):
        """Returns the process id of the private PostgreSQL, or None."""
        try:
            with open(
                os.path.join(self.data, "postgres", "pgdata", "postmaster.pid"), encoding="ascii"
            ) as file:
                pid = int(file.readline())
            with open(f"/proc/{pid}/stat", encoding="ascii") as file:
                return None if file.read().rsplit(")", 1)[1].split()[0] == "Z" else pid
        except (OSError, ValueError):
            return None

    def assert_clean_log(self, warnings=()):
        """Checks that the log has no errors. Warnings and lines of libraries are allowed if they
        contain one of the given words, about a fault that the test caused."""
        bad = []
        for line in self.log:
            level = line.split(" ")[1:2]
            if level == ["E"] or (level == ["W"] and not any(word in line for word in warnings)):
                bad.append(line)
            elif (
                level
                and level[0] not in ("I", "D", "W", "E")
                and not any(word in line for word in warnings)
            ):
                bad.append(line)  # from a crash, a sanitizer or a library, not from the log
        assert not bad, "the log of the server is not clean:\n" + "\n".join(bad[:50])

    def sql(self, statement):
        """Runs SQL in the private database, for effects that the API does not offer. Returns the
        result without the column names."""
        with open(
            os.path.join(self.data, "postgres", "pgdata", "postmaster.pid"), encoding="ascii"
        ) as file:
            port = file.read().splitlines()[3]
        psql = [
            "psql",
            "-X",
            "-At",
            "-h",
            os.path.join(self.data, "postgres"),
            "-p",
            port,
            "-U",
            "strata",
            "-d",
            "strata",
            "-v",
            "ON_ERROR_STOP=1",
            "-c",
            statement,
        ]
        return subprocess.run(psql, check=True, capture_output=True, text=True).stdout.strip()

    # --- HTTP

    def connect(self):
        port = self.port
        if port is None:
            raise ConnectionRefusedError("the server is down")
        if self.tls:
            return http.client.HTTPSConnection(self.host, port, timeout=LONG_S, context=self.tls)
        return http.client.HTTPConnection(self.host, port, timeout=LONG_S)

    def owners_secret(self, path):
        """Returns the secret for a request as the owner: the token or, for accounts, a session. The
        session stays valid for accounts even after an administrator has set a password."""
        if not OF_ACCOUNTS.match(path):
            return self.token
        if self.session is None:
            self.sign_in_owner({"token": self.token})
        return self.session

    def sign_in_owner(self, login):
        signed = self.ok("POST", "/login", login, token=False)
        self.session = signed.headers["Set-Cookie"].split(";")[0].partition("=")[2]

    def request(self, method, path, body=None, headers=None, token=True, connection=None):
        """Sends a request. The contract must contain its response. `path` follows /api/v1 unless it
        starts with //. A dict or list as body is sent as JSON."""
        target = path[1:] if path.startswith("//") else "/api/v1" + path
        sent = {}
        if token:
            sent["Authorization"] = "Bearer " + (
                token if isinstance(token, str) else self.owners_secret(path)
            )
        if isinstance(body, (dict, list)):
            body = json.dumps(body).encode()
            sent["Content-Type"] = "application/json"
        sent.update(headers or {})
        link = connection or self.connect()
        try:
            link.request(method, target, body=body, headers=sent)
            answer = link.getresponse()
            read = Answer(answer.status, answer.headers, answer.read())
            self.contract.check(method, target, read)
            return read
        finally:
            if connection is None:
                link.close()

    def wait_for_job(self, job, limit_s=LONG_S):
        return wait_for(
            lambda: (lambda now: now if now["state"] not in ("queued", "running") else None)(
                self.ok("GET", f"/jobs/{job}").json()
            ),
            f"job {job}",
            limit_s,
        )

    def add_person(self, user, role):
        """Creates a user. Returns a token for the user's scripts."""
        invitation = (
            self.ok("POST", "/users", {"user": user, "role": role}).json()["path"].partition("#")[2]
        )
        of_page = {"Origin": self.url}
        joined = self.ok(
            "POST",
            "/invitations/accept",
            {"invitation": invitation, "password": f"{user} and seven blue herons"},
            headers=of_page,
            token=False,
        )
        of_page["Cookie"] = joined.headers["Set-Cookie"].split(";")[0]
        return self.ok(
            "POST", "/me/tokens", {"name": "tests"}, headers=of_page, token=False
        ).json()["secret"]

    def import_model(self, content, filename, **query):
        """Imports a model and returns it."""
        asked = urllib.parse.urlencode({"filename": filename, **query})
        job = self.wait_for_job(self.ok("POST", "/models?" + asked, content).json()["id"])
        assert job["state"] == "done", job
        return self.ok("GET", f"/models/{job['model']}").json()
