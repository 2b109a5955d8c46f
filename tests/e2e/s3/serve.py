"""Runs OpenStack Swift as an S3 server for tests: serve.py FOLDER.

Swift is a real object store. Its S3 interface checks signatures (version 4) and the hash of each
body. The servers of accounts, containers, objects and the proxy run in this one process. Objects
are in memory. The program makes the bucket `strata`, and prints the port of the S3 interface and a
port without any check, on which tests change objects (`/v1/AUTH_museum/strata/KEY`).
"""
import ctypes
import logging
import os
import sys
import urllib.request

import eventlet

eventlet.monkey_patch()

from swift.common import utils, wsgi  # noqa: E402
from swift.common.http_protocol import SwiftHttpProtocol  # noqa: E402
from swift.common.ring import RingBuilder  # noqa: E402

SECRET_KEY = "a-secret-key-of-the-tests"  # the access key is museum:strata
BUCKET = "/v1/AUTH_museum/strata"
KINDS = ("account", "container", "object")

PROXY = """
[DEFAULT]
swift_dir = {folder}
[pipeline:main]
pipeline = catch_errors s3api tempauth proxy-server
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
[filter:catch_errors]
use = egg:swift#catch_errors
[filter:s3api]
use = egg:swift#s3api
allow_multipart_uploads = no
dns_compliant_bucket_names = yes
location = us-east-1
[filter:tempauth]
use = egg:swift#tempauth
user_museum_strata = {secret} .admin
"""

UNCHECKED = """
[DEFAULT]
swift_dir = {folder}
[pipeline:main]
pipeline = catch_errors proxy-server
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
[filter:catch_errors]
use = egg:swift#catch_errors
"""

STORAGE = """
[DEFAULT]
swift_dir = {folder}
devices = {folder}/devices
mount_check = false
[pipeline:main]
pipeline = server
[app:server]
use = egg:swift#{app}
"""


class Quiet:
    def write(self, _):
        pass


class Cache:
    """Replaces memcached, in which Swift stores the signed-in users."""

    def __init__(self):
        self.values = {}

    def get(self, key, **_):
        return self.values.get(key)

    def set(self, key, value, **_):
        self.values[key] = value

    def delete(self, key, **_):
        self.values.pop(key, None)


CACHE = Cache()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def start(config, listener):
    swift = wsgi.loadapp(config)

    def app(environ, start_response):
        environ["swift.cache"] = CACHE
        return swift(environ, start_response)

    eventlet.spawn(
        eventlet.wsgi.server,
        listener,
        app,
        Quiet(),
        protocol=SwiftHttpProtocol,
        capitalize_response_headers=False,
    )
    return listener.getsockname()[1]


def listen():
    return eventlet.listen(("127.0.0.1", 0))


def main(folder):
    ctypes.CDLL(None).prctl(1, 9)  # PR_SET_PDEATHSIG
    logging.disable(logging.CRITICAL)
    utils.HASH_PATH_SUFFIX, utils.HASH_PATH_PREFIX = b"tests", b""
    os.makedirs(os.path.join(folder, "devices", "disk"))
    listeners = {kind: listen() for kind in KINDS}
    for kind, listener in listeners.items():
        ring = RingBuilder(1, 1, 0)
        place = {"ip": "127.0.0.1", "port": listener.getsockname()[1], "device": "disk"}
        ring.add_dev({"id": 0, "region": 1, "zone": 1, "weight": 1, **place})
        ring.rebalance()
        ring.get_ring().save(os.path.join(folder, f"{kind}.ring.gz"))

    def config(name, text, **more):
        path = os.path.join(folder, f"{name}.conf")
        write(path, text.format(folder=folder, **more))
        return path

    for kind, listener in listeners.items():
        app = "mem_object" if kind == "object" else kind
        start(config(kind, STORAGE, app=app), listener)
    port = start(config("proxy", PROXY, secret=SECRET_KEY), listen())
    unchecked = start(config("unchecked", UNCHECKED), listen())
    made = urllib.request.Request(f"http://127.0.0.1:{unchecked}{BUCKET}", method="PUT")
    urllib.request.urlopen(made, timeout=60).close()
    print(port, unchecked, flush=True)
    while True:
        eventlet.sleep(3600)


if __name__ == "__main__":
    main(sys.argv[1])
