"""Starts, ends and describes a cluster of Strata on one machine: etcd, three PostgreSQL members run
by Patroni, three nodes, and nginx. The scripts `up`, `down`, `status` and `kill` in this folder call
it. It needs only Python's standard library. All processes listen on 127.0.0.1, and all their files
are in one folder."""

import argparse
import contextlib
import json
import os
import pathlib
import pwd
import secrets
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEPS = ROOT / "build" / "deps"  # where scripts/setup.sh unpacks packages
POSTGRES = pathlib.Path("/usr/lib/postgresql/15/bin")
NAMES = "abc"
MEMBERS = [f"postgres-{name}" for name in NAMES]
NODES = [f"node-{name}" for name in NAMES]
PARTS = ["etcd", *MEMBERS, *NODES, "nginx"]
FIRST_PORT = 18080
FOLDER = os.environ.get("STRATA_CLUSTER") or ROOT / "data" / "cluster"
LONG_S = 120
LOCAL = urllib.request.build_opener(urllib.request.ProxyHandler({}))

# Settings of Patroni for all members, and options of initdb. docker/cluster/patroni.yaml has the
# same.
DCS = {
    # If the primary dies, a standby takes over when this time has passed.
    "ttl": 20,
    "loop_wait": 3,
    "retry_timeout": 5,
    # A commit succeeds only after a standby has it, so a standby that takes over has every edit that
    # the server reported as saved. If there is no standby, commits wait.
    "synchronous_mode": True,
    "synchronous_mode_strict": True,
    "postgresql": {
        "use_pg_rewind": True,
        "use_slots": True,
        "parameters": {
            "jit": "off",
            "max_connections": 200,
            # A standby reconnects to a new primary without a long pause.
            "wal_retrieve_retry_interval": "1s",
        },
    },
}
INITDB = [{"encoding": "UTF8"}, {"locale": "C.UTF-8"}, "data-checksums"]


class Failure(Exception):
    """An error that the user can understand without a stack trace."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def fetch(url):
    """Returns the status and the body of a response, or (0, b"") if nothing answers."""
    try:
        with LOCAL.open(url, timeout=3) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, b""
    except OSError:
        return 0, b""


def find_ports(count):
    """Returns the first port of a block of free ports, below those that the kernel gives to
    clients."""
    for first in range(FIRST_PORT, 32000, 20):
        with contextlib.ExitStack() as stack:
            try:
                for port in range(first, first + count):
                    taken = stack.enter_context(socket.socket())
                    taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                    taken.bind(("127.0.0.1", port))
            except OSError:
                continue
            return first
    raise Failure("There are no free ports.")


def start_of(pid):
    """Returns the time when a process started, which tells it from a later process with the same
    id. Returns None if the process has ended."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text("ascii").rsplit(")", 1)[1].split()
    except OSError:
        return None
    return None if fields[0] in "ZX" else fields[19]


def children_of(pid):
    children = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if (folder / "stat").read_text("utf-8").rsplit(")", 1)[1].split()[1] == str(pid):
                children.append(int(folder.name))
    return children


def send(pid, kind):
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, kind)


def quoted(value):
    """Returns a value of a libpq connection string."""
    return "'" + str(value).replace("\\", "\\\\").replace("'", "\\'") + "'"


class Cluster:
    """The cluster in a folder. Its settings are in the file cluster.json."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        self.file = self.folder / "cluster.json"
        self.settings = json.loads(self.file.read_text("utf-8")) if self.file.exists() else None

    # --- addresses

    def port(self, part, second=False):
        """`second`: the port of etcd for other members, and of Patroni's interface."""
        places = ["nginx", *NODES, "etcd", "", *MEMBERS]
        place = places.index(part)
        if second:
            place += 1 if part == "etcd" else len(MEMBERS)
        return self.settings["port"] + place

    PORTS = 2 + len(NODES) + 2 + 2 * len(MEMBERS)

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port('nginx')}"

    @property
    def dsn(self):
        """Names all members. libpq connects to the one that accepts changes, the primary."""
        return self._dsn(MEMBERS, "strata", "strata") + " target_session_attrs=read-write"

    def _dsn(self, members, user, database):
        ports = ",".join(str(self.port(member)) for member in members)
        hosts = ",".join("127.0.0.1" for _ in members)
        password = quoted(self.settings["passwords"][user])
        return f"host={hosts} port={ports} dbname={database} user={user} password={password}"

    def psql(self, member, statement, database="postgres"):
        """Runs a statement at a member as PostgreSQL's superuser. Returns its rows as text."""
        done = subprocess.run(
            [POSTGRES / "psql", "-X", "-At", "-v", "ON_ERROR_STOP=1", "-c", statement],
            env={**self._superuser(member), "PGDATABASE": database},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            raise Failure(f"{member}: {done.stderr.strip()}")
        return done.stdout.strip()

    def _superuser(self, member):
        return {
            **os.environ,
            "PGHOST": "127.0.0.1",
            "PGPORT": str(self.port(member)),
            "PGUSER": "postgres",
            "PGDATABASE": "postgres",
            "PGPASSWORD": self.settings["passwords"]["postgres"],
            "PGCONNECT_TIMEOUT": "5",
        }

    # --- processes

    def log(self, part):
        return self.folder / "logs" / f"{part}.log"

    def pid(self, part):
        """Returns the process id of a part that runs, or None."""
        try:
            pid, start = (self.folder / "pids" / part).read_text("ascii").split()
        except OSError:
            return None
        return int(pid) if start_of(pid) == start else None

    def postmaster(self, member):
        """Returns the process id of the member's PostgreSQL, or None."""
        data = self.folder / member / "data"
        try:
            pid = int((data / "postmaster.pid").read_text("ascii").split("\n", 1)[0])
            # PostgreSQL works in its data folder. Another process may have its old id.
            here = os.readlink(f"/proc/{pid}/cwd") == str(data)
        except (OSError, ValueError):
            return None
        return pid if here and start_of(pid) else None

    def pids(self, part):
        found = [self.pid(part), self.postmaster(part) if part in MEMBERS else None]
        return [pid for pid in found if pid]

    def spawn(self, part, command, as_postgres=True, **environment):
        """Starts a process that stays when this program ends. PostgreSQL refuses to run as root."""
        user = {}
        if os.geteuid() == 0 and as_postgres:
            user = {"user": "postgres", "group": "postgres", "extra_groups": []}
        with open(self.log(part), "ab") as log:
            process = subprocess.Popen(
                [str(word) for word in command],
                cwd="/",
                env={**os.environ, **environment},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
                **user,
            )
        # A process that has already ended has no start.
        (self.folder / "pids" / part).write_text(
            f"{process.pid} {start_of(process.pid)}\n", "ascii"
        )

    def wait_for(self, condition, what, parts):
        """Waits for the first true result of `condition`. Fails if one of `parts` has ended."""
        end = time.monotonic() + LONG_S
        while not (found := condition()):
            ended = [part for part in parts if not self.pid(part)]
            late = time.monotonic() > end
            if ended or late:
                why = f"{ended[0]} has ended" if ended else f"waited {LONG_S} s"
                tails = []
                for part in ended or parts:
                    lines = self.log(part).read_text("utf-8", "replace").splitlines()[-15:]
                    tails.append("\n".join([f"The last lines of {self.log(part)}:", *lines]))
                raise Failure("\n".join([f"{what}: {why}.", *tails]))
            time.sleep(0.1)
        return found

    # --- the state of PostgreSQL

    def members(self):
        """Returns Patroni's description of the members, by name. Any Patroni that runs has it."""
        for member in MEMBERS:
            _, body = fetch(f"http://127.0.0.1:{self.port(member, second=True)}/cluster")
            if body:
                return {each["name"]: each for each in json.loads(body)["members"]}
        return {}

    def primary(self):
        """Returns the member that accepts changes, or None. Asks each Patroni about itself, because
        the description of the cluster names a dead primary until its lock expires."""
        for member in MEMBERS:
            if fetch(f"http://127.0.0.1:{self.port(member, second=True)}/primary")[0] == 200:
                return member
        return None

    def is_whole(self):
        """Returns whether all members follow the primary, and one of them synchronously."""
        found = self.members()
        roles = sorted(each["role"] for each in found.values())
        return (
            self.primary()
            and roles == ["leader", "replica", "sync_standby"]
            and all(each["state"] in ("running", "streaming") for each in found.values())
            and len({each.get("timeline") for each in found.values()}) == 1
        )

    # --- up

    def up(self, strata=None, backup=None):
        """Starts the parts that do not run. `backup`: the folder of a backup for a new cluster."""
        if backup and self.settings and self.settings["has_database"]:
            raise Failure(
                f"The cluster in {self.folder} already has a site. Restore the backup to another "
                "cluster: choose a new folder with --folder."
            )
        self._prepare(strata)
        self._start_etcd()
        self._start_members()
        self._make_database(backup)
        self._start_nodes()
        self._start_nginx()

    def _prepare(self, strata):
        for name in ("", "pids", "logs"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        for name in ("etcd", *MEMBERS):
            self._make_private(self.folder / name)
        os.chmod(self.folder, 0o755)
        if os.geteuid() == 0:
            entered = subprocess.run(
                ["test", "-x", self.folder / "etcd"], user="postgres", group="postgres", check=False
            )
            if entered.returncode != 0:
                raise Failure(
                    f"PostgreSQL runs as user postgres, which cannot enter {self.folder}. "
                    "Choose another folder with --folder."
                )
        if self.settings is None:
            self.settings = {
                "port": find_ports(self.PORTS),
                "passwords": {
                    name: secrets.token_hex(12)
                    for name in ("postgres", "replicator", "rewinder", "strata", "owner")
                },
                "has_database": False,
            }
        known = [strata, os.environ.get("STRATA_BINARY"), self.settings.get("strata")]
        known += [ROOT / "build" / "release" / "bin" / "strata", shutil.which("strata")]
        found = next((each for each in known if each and os.access(each, os.X_OK)), None)
        if not found:
            raise Failure(
                "There is no server program. ./run builds it. You can also name it with --strata."
            )
        self.settings["strata"] = str(pathlib.Path(found).resolve())
        self._save()

    def _save(self):
        with open(
            os.open(self.file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w", encoding="utf-8"
        ) as file:
            json.dump(self.settings, file, indent=1)

    def _make_private(self, path, content=None):
        """Makes a folder or file that only the user of PostgreSQL can read."""
        if content is None:
            path.mkdir(exist_ok=True)
        else:
            path.write_text(content, "utf-8")
        path.chmod(0o700 if content is None else 0o600)
        if os.geteuid() == 0:
            account = pwd.getpwnam("postgres")
            os.chown(path, account.pw_uid, account.pw_gid)

    def _start_etcd(self):
        clients, peers = (
            f"http://127.0.0.1:{self.port('etcd', second)}" for second in (False, True)
        )
        if not self.pid("etcd"):
            unpacked = DEPS / "usr" / "bin" / "etcd"
            command = [unpacked if unpacked.exists() else "etcd", "--name", "etcd"]
            command += ["--data-dir", self.folder / "etcd" / "data", "--logger", "zap"]
            command += ["--listen-client-urls", clients, "--advertise-client-urls", clients]
            command += ["--listen-peer-urls", peers, "--initial-advertise-peer-urls", peers]
            self.spawn("etcd", [*command, "--initial-cluster", f"etcd={peers}"])
        self.wait_for(lambda: fetch(clients + "/health")[0] == 200, "etcd did not start", ["etcd"])
        say("etcd: ready")

    def _configuration(self, member):
        """Returns the configuration of Patroni for a member. JSON is a subset of YAML."""
        passwords = self.settings["passwords"]
        rest = f"127.0.0.1:{self.port(member, second=True)}"
        address = f"127.0.0.1:{self.port(member)}"
        accounts = {"superuser": "postgres", "replication": "replicator", "rewind": "rewinder"}
        return {
            "scope": "strata",
            "name": member,
            "restapi": {"listen": rest, "connect_address": rest},
            "etcd3": {"host": f"127.0.0.1:{self.port('etcd')}"},
            "bootstrap": {
                "dcs": DCS,
                "initdb": INITDB,
            },
            "postgresql": {
                "listen": address,
                "connect_address": address,
                "data_dir": str(self.folder / member / "data"),
                "bin_dir": str(POSTGRES),
                "pgpass": str(self.folder / member / "pgpass"),
                "authentication": {
                    kind: {"username": name, "password": passwords[name]}
                    for kind, name in accounts.items()
                },
                "parameters": {"unix_socket_directories": ""},
                "pg_hba": [
                    "host all all 127.0.0.1/32 scram-sha-256",
                    "host replication replicator 127.0.0.1/32 scram-sha-256",
                ],
            },
        }

    def _start_member(self, member):
        if self.pid(member):
            return
        file = self.folder / member / "patroni.json"
        self._make_private(file, json.dumps(self._configuration(member), indent=1))
        unpacked = DEPS / "usr" / "bin" / "patroni"
        python_path = str(DEPS / "usr" / "lib" / "python3" / "dist-packages")
        command = [unpacked if unpacked.exists() else "/usr/bin/patroni", file]
        self.spawn(
            member,
            ["/usr/bin/python3", *command],
            PYTHONPATH=python_path,
            PYTHONDONTWRITEBYTECODE="1",
        )

    def _start_members(self):
        if not any((self.folder / member / "data").exists() for member in MEMBERS):
            # The first member makes the database, and the others copy it.
            self._start_member(MEMBERS[0])
            self.wait_for(self.primary, "PostgreSQL has no primary", MEMBERS[:1])
            say(f"{MEMBERS[0]}: is the primary")
        for member in MEMBERS:
            self._start_member(member)
        self.wait_for(self.is_whole, "PostgreSQL is not complete", MEMBERS)
        for name, each in sorted(self.members().items()):
            say(f"{name}: {each['role'].replace('_', ' ')}")

    def _make_database(self, backup):
        if self.settings["has_database"]:
            return
        primary = self.primary()
        if not self.psql(primary, "SELECT 1 FROM pg_database WHERE datname = 'strata'"):
            password = {"STRATA_DATABASE_PASSWORD": self.settings["passwords"]["strata"]}
            script = ROOT / "docker" / "postgres" / "make_database.sh"
            self._run([script], {**self._superuser(primary), **password})
        strata = self.settings["strata"]
        database = {**os.environ, "STRATA_DATABASE": self.dsn}
        if backup:
            self._run([strata, "restore", backup], database)
            del self.settings["passwords"]["owner"]  # the backup contains the accounts
        else:
            self._run([strata, "migrate"], database)
            self._run(
                [strata, "user", "password", "owner", "--password-stdin"],
                database,
                self.settings["passwords"]["owner"],
            )
        self.settings["has_database"] = True
        self._save()
        say("database: restored from the backup" if backup else "database: made")

    def _run(self, command, environment, words=""):
        done = subprocess.run(
            command, env=environment, input=words, capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise Failure(f"{pathlib.Path(command[0]).name} failed:\n{done.stderr.strip()}")

    def _start_nodes(self):
        for node in NODES:
            if not self.pid(node):
                address = f"{self.url}/node/{node[-1]}"
                command = [self.settings["strata"], "serve", "--node-url", address]
                command += ["--listen", f"127.0.0.1:{self.port(node)}", "--origin", self.url]
                command += ["--data", self.folder / node]
                # The connection string contains a password, so it is not an argument.
                self.spawn(node, command, as_postgres=False, STRATA_DATABASE=self.dsn)
        for node in NODES:
            self.wait_for(lambda: self.is_ready(node), f"{node} did not start", [node])
            say(f"{node}: ready")

    def is_ready(self, node):
        return fetch(f"http://127.0.0.1:{self.port(node)}/readyz")[0] == 200

    def _start_nginx(self):
        if not self.pid("nginx"):
            folder = self.folder / "nginx"
            folder.mkdir(exist_ok=True)
            site = (ROOT / "examples" / "nodes" / "nginx.conf").read_text("utf-8")
            site = site.replace("listen 80;", f"listen 127.0.0.1:{self.port('nginx')};")
            for usual, node in zip((8081, 8082, 8083), NODES):
                site = site.replace(f"127.0.0.1:{usual}", f"127.0.0.1:{self.port(node)}")
            temporary = "".join(
                f"{kind}_temp_path {folder}/{kind};"
                for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
            )
            user = "user root;" if os.geteuid() == 0 else ""
            conf = folder / "nginx.conf"
            conf.write_text(
                f"daemon off; pid {folder}/nginx.pid; error_log {self.log('nginx')}; {user}\n"
                f"events {{}}\nhttp {{ access_log off; {temporary}\n{site} }}\n",
                "utf-8",
            )
            unpacked = DEPS / "usr" / "sbin" / "nginx"
            program = unpacked if unpacked.exists() else "/usr/sbin/nginx"
            self.spawn("nginx", [program, "-p", folder, "-c", conf], as_postgres=False)
        self.wait_for(
            lambda: fetch(self.url + "/readyz")[0] == 200, "nginx did not start", ["nginx"]
        )
        say("nginx: ready")

    # --- down and faults

    def down(self):
        """Ends all processes. Those that need others end first."""
        self._end(["nginx"])
        self._end(NODES)
        # Patroni stops its PostgreSQL. If Patroni was killed, PostgreSQL may still run. The primary
        # ends last, so that no standby takes over.
        primary = self.primary()
        self._end([member for member in MEMBERS if member != primary])
        self._end([primary] if primary else [])
        self._end(["etcd"])

    def _end(self, parts):
        for kind, limit_s in ((signal.SIGTERM, 60), (signal.SIGKILL, 60)):
            end = time.monotonic() + limit_s
            for part in parts:
                own = self.pid(part)
                for pid in [own] if own and kind == signal.SIGTERM else self.pids(part):
                    send(pid, kind)
            while any(self.pids(part) for part in parts) and time.monotonic() < end:
                time.sleep(0.05)
        left = [part for part in parts if self.pids(part)]
        if left:
            raise Failure(f"These parts did not end: {', '.join(left)}.")
        if parts:
            say(f"{', '.join(parts)}: ended")

    def kill(self, part):
        """Ends a part as if its machine had failed: all its processes at once."""
        pids = self.pids(part)
        if not pids:
            raise Failure(f"{part} does not run.")
        for pid in [*pids, *(child for pid in pids for child in children_of(pid))]:
            send(pid, signal.SIGKILL)
        while self.pids(part):
            time.sleep(0.01)

    # --- status

    def rows(self):
        """Returns for each part its name, its address, its state and its process ids."""
        members = self.members()
        primary = self.primary()
        for part in PARTS:
            pids = self.pids(part)
            address = f"127.0.0.1:{self.port(part)}"
            if not pids:
                state = "does not run"
            elif part in MEMBERS:
                role = members.get(part, {}).get("role", "unknown")
                state = "primary" if part == primary else role.replace("_", " ")
            elif part in NODES:
                state = "ready" if self.is_ready(part) else "not ready"
            else:
                state = "runs"
            yield part, address, state, " ".join(map(str, pids))


def print_status(cluster):
    rows = [("part", "address", "state", "process ids"), *cluster.rows()]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    return 0 if all(row[3] for row in rows) else 1


def print_hints(cluster):
    is_usual = cluster.folder == pathlib.Path(FOLDER).resolve()
    more = "" if is_usual else f" --folder {shlex.quote(str(cluster.folder))}"
    here = pathlib.Path(os.path.relpath(pathlib.Path(__file__).parent))
    password = cluster.settings["passwords"].get("owner", "as on the site of the backup")
    print(
        f"""The cluster runs.

  page      {cluster.url}/
  user      owner
  password  {password}
  files     {cluster.folder}

Try this while you paint:

  {here}/status{more}          # the state of all parts
  {here}/kill{more} node-a     # another node opens its models within 5 seconds
  {here}/kill{more} primary    # a standby becomes the primary within 45 seconds
  {here}/up{more}              # starts the parts that do not run
  {here}/down{more}            # ends all parts, and keeps the data"""
    )


def main():
    parser = argparse.ArgumentParser(prog="examples/cluster/…")
    parser.add_argument("command", choices=["up", "down", "status", "kill"])
    parser.add_argument("part", nargs="?", choices=[*PARTS, "primary"], help="only for kill")
    parser.add_argument(
        "--folder",
        default=FOLDER,
        help="default: $STRATA_CLUSTER, or data/cluster in the folder of the project",
    )
    parser.add_argument("--strata", help="the server program; default: that of ./run")
    parser.add_argument("--restore", metavar="BACKUP", help="up: make the site from this backup")
    asked = parser.parse_intermixed_args()
    if (asked.command == "kill") != (asked.part is not None):
        parser.error("kill needs a part, and the other commands need none")
    cluster = Cluster(asked.folder)
    if not cluster.settings and asked.command != "up":
        raise Failure(f"There is no cluster in {cluster.folder}.")
    if asked.command == "up":
        cluster.up(asked.strata, asked.restore)
        print_hints(cluster)
    elif asked.command == "down":
        cluster.down()
    elif asked.command == "kill":
        part = cluster.primary() if asked.part == "primary" else asked.part
        if part is None:
            raise Failure("PostgreSQL has no primary at the moment.")
        cluster.kill(part)
        say(f"{part}: killed")
    else:
        return print_status(cluster)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"{failure}")
