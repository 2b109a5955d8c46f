"""Runs psql as an analyst does."""
import csv
import io
import os
import socket
import subprocess


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Reader:
    """A psql session with the server's password for readers."""

    def __init__(self, server, port):
        with open(os.path.join(server.data, "sql-password"), encoding="ascii") as file:
            self.password = file.read().strip()
        self.port = port

    def command(self, user="strata_reader", database="strata"):
        return [
            "psql",
            "-X",
            "-h",
            "127.0.0.1",
            "-p",
            str(self.port),
            "-U",
            user,
            "-d",
            database,
            "-v",
            "ON_ERROR_STOP=1",
        ]

    def environment(self, password=None):
        return {**os.environ, "PGPASSWORD": password or self.password, "PGCONNECT_TIMEOUT": "60"}

    def run(self, *statements, password=None, **more):
        command = (
            self.command(**more)
            + ["--csv"]
            + [word for statement in statements for word in ("-c", statement)]
        )
        return subprocess.run(
            command, capture_output=True, text=True, check=False, env=self.environment(password)
        )

    def rows(self, *statements):
        done = self.run(*statements)
        assert done.returncode == 0, (statements, done.stderr)
        return list(csv.DictReader(io.StringIO(done.stdout)))

    def refused(self, *statements, why, **more):
        done = self.run(*statements, **more)
        assert done.returncode != 0 and why in done.stderr, (statements, done.stdout, done.stderr)
