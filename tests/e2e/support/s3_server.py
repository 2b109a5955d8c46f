"""An S3 server for tests: OpenStack Swift (tests/e2e/s3)."""
import os
import shutil
import subprocess
import tempfile
import urllib.request

from .contract import ROOT
from .missing import missing
from .strata_server import LONG_S, _end_with_parent

SERVE = os.path.join(ROOT, "tests", "e2e", "s3", "serve")


class S3Server:
    """Has the bucket `strata`. `environment` contains the keys of the bucket."""

    environment = {
        "AWS_ACCESS_KEY_ID": "museum:strata",
        "AWS_SECRET_ACCESS_KEY": "a-secret-key-of-the-tests",
        "AWS_REGION": "us-east-1",
    }

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="strata-s3-")
        self.process = None

    def __enter__(self):
        self.process = subprocess.Popen(
            [SERVE, os.path.join(self.folder, "swift")],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            preexec_fn=_end_with_parent,
        )
        ports = self.process.stdout.readline().split()
        if len(ports) != 2:
            self.stop()
            missing("Swift is not installed: ./test unpacks it (scripts/setup.sh)")
        self.endpoint = f"http://127.0.0.1:{ports[0]}"
        self.unchecked = f"http://127.0.0.1:{ports[1]}/v1/AUTH_museum/strata"
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def keys(self):
        with urllib.request.urlopen(self.unchecked, timeout=LONG_S) as answer:
            return answer.read().decode().split()

    def read(self, key):
        with urllib.request.urlopen(f"{self.unchecked}/{key}", timeout=LONG_S) as answer:
            return answer.read()

    def replace(self, key, content):
        """Changes an object directly in the store, as another program does."""
        request = urllib.request.Request(f"{self.unchecked}/{key}", data=content, method="PUT")
        urllib.request.urlopen(request, timeout=LONG_S).close()
