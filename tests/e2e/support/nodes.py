"""Several server processes (nodes) over one PostgreSQL, on the loopback interface."""
import ctypes
import glob
import os
import pwd
import random
import re
import secrets
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import urllib.parse

from support import faulty_libc
from support.links import DatabaseLink, Link
from support.live_client import AWAY
from support.missing import missing
from support.nginx import free_port
from support.painters import HttpPainter
from support.strata_server import LONG_S, Requests, StrataServer, _place_of_data, wait_for

# Lines that the logs of nodes may contain while other nodes are killed, stopped or frozen.
FAULT_WORDS = [
    "could not be renewed",
    "could not join the site again",
    "messages of other nodes",
    "people at this node could not be sent",
    "models of other nodes cannot be followed",
    "of another node is not up to date",
    "changes at other nodes may be missing",
    "may have lost them to other nodes",
    "has claimed model",
    "has deleted model",
    "a commit failed and is tried again",
    "undid",
]


class SharedPostgres:
    """A PostgreSQL that no server owns, so it survives all of them."""

    def __init__(self, demo=False):
        self.demo = demo
        self.data = tempfile.mkdtemp(prefix="strata-nodes-", dir=_place_of_data())
        os.chmod(self.data, 0o755)
        self.process = None
        self.faults = None  # a FaultyProcess

    @property
    def folder(self):
        return os.path.join(self.data, "postgres")

    @property
    def dsn(self):
        return f"host='{self.folder}' port=5432 user=strata dbname=strata"

    def __enter__(self):
        prepared = os.environ.get("STRATA_TEST_PREPARED")
        if prepared:
            # copies owners and modes, because PostgreSQL requires both
            source = os.path.join(prepared, "demo" if self.demo else "empty", ".")
            subprocess.run(["cp", "-a", source, self.data], check=True)
        else:
            command = ["demo", "--pot-only"] if self.demo else ["migrate"]
            subprocess.run(
                [os.environ["STRATA_BINARY"], *command, "--data", self.data],
                check=True,
                capture_output=True,
            )
        self._launch()
        wait_for(self.answers, "PostgreSQL to answer")
        return self

    def _launch(self):
        cluster = os.path.join(self.folder, "pgdata")
        with open(os.path.join(cluster, "PG_VERSION"), encoding="ascii") as file:
            version = file.read().strip()
        found = glob.glob(f"/usr/lib/postgresql/{version}/bin/postgres")
        program = found[0] if found else shutil.which("postgres")
        if not program:
            missing(f"PostgreSQL {version} is not installed")
        owner = os.stat(cluster).st_uid
        account = pwd.getpwuid(owner)

        def become_owner():
            if os.geteuid() == 0:
                os.initgroups(account.pw_name, account.pw_gid)
                os.setgid(account.pw_gid)
                os.setuid(owner)
            # must follow setuid, which clears this setting
            ctypes.CDLL(None).prctl(1, signal.SIGQUIT)  # PR_SET_PDEATHSIG

        options = [
            "listen_addresses=",
            f"hba_file={os.path.join(self.folder, 'access.conf')}",
            "unix_socket_permissions=0700",
            "max_connections=200",
            "jit=off",
            "log_min_messages=warning",
        ]
        self.process = subprocess.Popen(
            [program, "-D", cluster, "-k", self.folder, "-p", "5432"]
            + [word for option in options for word in ("-c", option)],
            preexec_fn=become_owner,
            cwd="/",
            env={**os.environ, **(self.faults.environment if self.faults else {})},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def processes(self):
        """Returns the ids of all processes of PostgreSQL, the first one first."""
        first = self.process.pid
        with open(f"/proc/{first}/task/{first}/children", encoding="ascii") as file:
            return [first, *map(int, file.read().split())]

    def freeze(self):
        """Stops all processes. Returns their ids for `thaw`."""
        # The first process stops first, so it starts no others.
        os.kill(self.process.pid, signal.SIGSTOP)
        frozen = self.processes()
        for pid in frozen[1:]:
            os.kill(pid, signal.SIGSTOP)
        return frozen

    def thaw(self, frozen):
        for pid in reversed(frozen):
            os.kill(pid, signal.SIGCONT)

    def kill(self):
        """Sends kill -9. PostgreSQL's other processes end by themselves soon after."""
        self.process.kill()
        self.process.wait()

    def restart(self):
        """Starts PostgreSQL after `kill`, and returns when it answers. PostgreSQL refuses to start
        while processes of the killed server remain."""

        def answers():
            if self.process.poll() is not None:
                self._launch()
            return self.psql("SELECT 1").returncode == 0

        wait_for(answers, "PostgreSQL to answer again")

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)  # a fast shutdown
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.send_signal(signal.SIGQUIT)
            self.process.wait(LONG_S)
        shutil.rmtree(self.data, ignore_errors=True)

    def psql(self, statement):
        return subprocess.run(
            ["psql", "-X", "-At", "-d", self.dsn, "-v", "ON_ERROR_STOP=1", "-c", statement],
            capture_output=True,
            text=True,
            check=False,
        )

    def answers(self):
        assert self.process.poll() is None, "PostgreSQL ended"
        return self.psql("SELECT 1").returncode == 0

    def sql(self, statement):
        """Returns the result without the column names."""
        done = self.psql(statement)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()


class Node(StrataServer):
    """A server process of a site. It keeps its address when it starts again. `database` has a
    `dsn`. Painters of a test that cuts links use `client_port`."""

    def __init__(self, database, token, url=None, options=()):
        super().__init__()
        self.database = database
        self.share = None  # STRATA_SHARE at the next start
        self.own_port = self.client_port = free_port()
        self.listen = f"127.0.0.1:{self.own_port}"
        self.clients = None  # a Link between browsers and this node
        self.faults = None  # a FaultyProcess
        self.node_url = url or f"http://127.0.0.1:{self.own_port}"
        self.token = token
        self.options = [
            *("--database", database.dsn, "--node-url", self.node_url),
            *options,
        ]
        self.frozen = False

    def _fill(self):
        """The data are in the shared PostgreSQL. The folder contains only uploads."""

    def environment(self):
        own = {"STRATA_SHARE": self.share} if self.share else {}
        faults = self.faults.environment if self.faults else {}
        return {**super().environment(), **own, **faults}

    def is_ready(self):
        try:
            return self.get("//readyz").status == 200
        except AWAY:
            return False

    def kill(self):
        self.frozen = False
        super().kill()

    @property
    def runs(self):
        return self.process is not None and self.process.poll() is None and self.port is not None

    def freeze(self):
        self.process.send_signal(signal.SIGSTOP)
        self.frozen = True

    def thaw(self):
        self.process.send_signal(signal.SIGCONT)
        self.frozen = False

    def metric(self, name):
        text = self.ok("GET", "//metrics", token=False).body.decode()
        return float(re.search(rf"^{name} (\S+)$", text, re.MULTILINE)[1])


class Site(Requests):
    """The nodes of a site. Use it in a `with` block. Calls of `ok`, `get` and `post` go to a random
    running node and follow redirections, so a site can replace a server in the helpers of tests.
    With `links`, each node has its own DatabaseLink (`node.database`) and a link for browsers
    (`node.clients`). With `faults`, PostgreSQL and each node have a FaultyProcess."""

    def __init__(self, count, seed=1, urls=None, options=(), demo=False, links=False, faults=False):
        self.postgres = SharedPostgres(demo)
        self.random = random.Random(seed)
        self.lock = threading.Lock()
        self.token = secrets.token_hex(24)
        self.host, self.tls = "127.0.0.1", None
        self.count, self.urls, self.options = count, urls, options
        self.with_links, self.links = links, []
        self.with_faults, self.faults_folder = faults, os.path.join(self.postgres.data, "faults")
        self.nodes = []

    def faults_of(self, disk):
        """Returns a new FaultyProcess."""
        library = os.path.join(self.faults_folder, "faulty_libc.so")
        return faulty_libc.FaultyProcess(library, self.faults_folder, disk)

    def __enter__(self):
        if self.with_faults:
            os.makedirs(self.faults_folder)
            faulty_libc.build(self.faults_folder)
            self.postgres.faults = self.faults_of(self.postgres.folder)
        self.postgres.__enter__()
        try:
            for number in range(self.count):
                url = self.urls[number] if self.urls else None
                database = self.postgres
                if self.with_links:
                    database = DatabaseLink(self.postgres)
                    self.links.append(database)
                node = Node(database, self.token, url, self.options)
                if self.with_links:
                    node.clients = Link(("127.0.0.1", node.own_port))
                    node.client_port = node.clients.port
                    self.links.append(node.clients)
                if self.with_faults:
                    node.faults = self.faults_of(node.data)
                self.nodes.append(node)
                node.__enter__()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *failure):
        for node in self.nodes:
            if node in StrataServer.running:
                node.__exit__(*failure)
        for link in self.links:
            link.close()
        self.postgres.__exit__()

    def running(self):
        return [node for node in self.nodes if node.runs and not node.frozen]

    def any(self):
        with self.lock:
            running = self.running()
            if not running:
                raise ConnectionRefusedError("no node runs")
            return self.random.choice(running)

    @property
    def port(self):
        return self.any().port

    def connect(self):
        return self.any().connect()

    def node_at(self, location):
        """Returns the node to which a redirection leads."""
        return next(node for node in self.nodes if location.startswith(node.node_url + "/"))

    def request(self, method, path, body=None, **more):
        """Follows redirections, and tries again while nodes end and start. A change needs an
        Idempotency-Key, because the answer to the first attempt may have been lost."""
        end = time.monotonic() + LONG_S
        node = None
        while True:
            answer = None
            try:
                node = node or self.any()
                answer = node.request(method, path, body, **more)
            except AWAY:
                node = None
            if answer is not None and answer.status == 307:
                node = self.node_at(answer.headers["Location"])
                if node.runs and not node.frozen:
                    continue
                answer, node = None, None
            if answer is not None and answer.status != 503:
                return answer
            node = None
            assert time.monotonic() < end, f"{method} {path} got no answer in {LONG_S} s"
            time.sleep(0.05)

    def owner(self, model):
        """Returns the node that owns the model according to the database, or None if no node owns
        it."""
        url = self.postgres.sql(
            "SELECT n.url FROM models m JOIN nodes n ON n.id = m.owner_node "
            f"WHERE m.id = {int(model)} AND n.lease_until > clock_timestamp() AND NOT n.draining"
        )
        return next((node for node in self.nodes if node.node_url == url), None)

    def epoch(self, model):
        return int(
            self.postgres.sql(f"SELECT owner_epoch FROM models WHERE id = {int(model)}") or 0
        )

    def import_model(self, content, filename, **query):
        """Imports a model at a node and returns it. The job runs at that node."""
        node = self.any()
        asked = urllib.parse.urlencode({"filename": filename, **query})
        job = node.wait_for_job(node.ok("POST", "/models?" + asked, content).json()["id"])
        assert job["state"] == "done", job
        return self.ok("GET", f"/models/{job['model']}").json()


class NodeHttpPainter(HttpPainter):
    """Sends each edit to a random node, with the same key until it is saved. Follows
    about half of the redirections, so nodes that do not have the model get many edits."""

    TRY_AGAIN = (307, 429, 503)
    node = None  # the node to which the last response redirected

    def send(self, path, edit, headers):
        node, self.node = self.node, None
        try:
            answer = (node or self.server.any()).post(path, edit, headers=headers)
        except AWAY:
            return None
        if answer.status == 307 and self.random.random() < 0.5:
            self.node = self.server.node_at(answer.headers["Location"])
        return answer
