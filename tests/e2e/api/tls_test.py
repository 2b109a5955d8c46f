"""https: by the server itself with certificate files and their renewal, and behind nginx with the
project's configuration."""
import os
import shutil
import socket
import ssl
import subprocess
import tempfile

import pytest
from support.certificates import make_certificate, trusting
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.nginx import Nginx, free_port, site_of
from support.strata_server import StrataServer, wait_for

PASSWORD = "a heron and six otters"


def shown_by(server):
    """Returns the subject of the certificate that a new connection gets."""
    untrusting = ssl.create_default_context()
    untrusting.check_hostname, untrusting.verify_mode = False, ssl.CERT_NONE
    with socket.create_connection((server.host, server.port)) as plain, untrusting.wrap_socket(
        plain
    ) as link:
        shown = ssl.DER_cert_to_PEM_cert(link.getpeercert(binary_form=True))
    told = subprocess.run(
        ["openssl", "x509", "-noout", "-subject"],
        input=shown,
        capture_output=True,
        text=True,
        check=True,
    )
    return told.stdout.rpartition("=")[2].strip()


def sign_in(server):
    """Signs in through the page. Returns the whole line of the cookie. `server.url` is the address
    that the browser sends."""
    invitation = (
        server.ok("POST", "/users", {"user": "hana", "role": "annotator"})
        .json()["path"]
        .partition("#")[2]
    )
    joined = server.ok(
        "POST",
        "/invitations/accept",
        {"invitation": invitation, "password": PASSWORD},
        headers={"Origin": server.url},
        token=False,
    )
    server.ok(
        "POST",
        "/logout",
        headers={"Origin": server.url, "Cookie": joined.headers["Set-Cookie"].split(";")[0]},
        token=False,
    )
    return server.ok(
        "POST",
        "/login",
        {"user": "hana", "password": PASSWORD},
        headers={"Origin": server.url},
        token=False,
    ).headers["Set-Cookie"]


def check_everything(server):
    """Sends the requests of a browser and of a script, from signing in to a frame."""
    server.import_model(folded_grid(21), "sheet.ply", name="Sheet", unit="mm")
    whole = sign_in(server)
    assert "Secure" in whole and "HttpOnly" in whole, whole
    cookie = whole.split(";")[0]
    assert server.ok("GET", "/me", headers={"Cookie": cookie}, token=False).json()["user"] == "hana"
    # the request and the response are larger than every buffer between client and server
    points = [[x % 100, x // 1000, 0.5] for x in range(100_000)]
    answer = server.ok(
        "POST",
        "/models/sheet/positions",
        {"points": points, "layers": []},
        headers={"Accept": "text/csv"},
    )
    assert answer.body.count(b"\r\n") == 100_001
    assert (
        server.get("/openapi.json", headers={"Accept-Encoding": "gzip"}).headers["Content-Encoding"]
        == "gzip"
    )
    for origin, secret in ((server.url, {"token": "", "cookie": cookie}), (None, {})):
        with LiveClient(server, "sheet", origin=origin, **secret) as live:
            welcome = live.hello()
            assert welcome["op"] == "welcome", welcome
    refused = server.request(
        "POST",
        "/models/sheet/layers",
        {"name": "x", "type": "u8"},
        token=False,
        headers={"Cookie": cookie, "Origin": "https://elsewhere.example"},
    )
    assert refused.status == 403, refused


@pytest.fixture
def folder():
    with tempfile.TemporaryDirectory(prefix="strata-tls-", dir="/tmp") as folder:
        os.chmod(folder, 0o755)
        yield folder


CAMERA = {
    "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -300, 1],
    "projection": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -20.2, 0],
    "width": 64,
    "height": 64,
}


def test_bad_files(folder):
    chain, key = make_certificate(folder, "good")
    other = make_certificate(folder, "other")[1]
    locked = os.path.join(folder, "locked.key")
    subprocess.run(
        ["openssl", "pkey", "-aes128", "-passout", "pass:secret", "-in", key, "-out", locked],
        check=True,
        capture_output=True,
    )
    cases = [
        ([chain, folder + "/none"], "none`: the file does not exist"),
        ([folder, key], "the file does not exist"),
        ([key, key], "contains no certificate"),
        ([chain, chain], "not the key of the certificate"),
        ([chain, other], "not the key of the certificate"),
        ([chain, make_certificate(folder, "rsa", "rsa")[1]], "not the key of the certificate"),
        ([chain, locked], "has a passphrase"),
    ]
    data = tempfile.mkdtemp(dir=folder)
    os.chmod(data, 0o755)
    binary = os.environ["STRATA_BINARY"]
    for (cert, its_key), told in cases:
        done = subprocess.run(
            [
                binary,
                "serve",
                "--data",
                data,
                "--listen",
                "127.0.0.1:0",
                "--tls-cert",
                cert,
                "--tls-key",
                its_key,
            ],
            capture_output=True,
            text=True,
            stdin=subprocess.DEVNULL,
            check=False,
        )
        assert done.returncode == 1 and told in done.stderr, (cert, its_key, done)
    half = subprocess.run(
        [binary, "serve", "--data", data, "--tls-cert", chain],
        capture_output=True,
        text=True,
        check=False,
    )
    assert half.returncode == 2 and "--tls-key" in half.stderr, half


def test_https_from_files(folder):
    chain, key = make_certificate(folder, "first")
    with StrataServer(options=["--tls-cert", chain, "--tls-key", key]) as server:
        server.tls = trusting(chain)
        assert server.link.startswith("https://"), server.link
        check_everything(server)
        old = ssl.create_default_context(cafile=chain)
        old.maximum_version = ssl.TLSVersion.TLSv1_2
        with socket.create_connection((server.host, server.port)) as plain, old.wrap_socket(
            plain, server_hostname=server.host
        ) as link:
            assert link.version() == "TLSv1.2"

        # The server redirects requests to http://. Connections that send random bytes, or nothing,
        # have no effect on the server.
        with socket.create_connection((server.host, server.port)) as plain:
            plain.sendall(
                f"GET /pot?x=1 HTTP/1.1\r\nHost: {server.host}:{server.port}\r\n\r\n".encode()
            )
            head = plain.makefile("rb").read().decode()
        assert (
            head.startswith("HTTP/1.1 308 ") and f"Location: {server.url}/pot?x=1\r\n" in head
        ), head
        silent = socket.create_connection((server.host, server.port))
        with socket.create_connection((server.host, server.port)) as plain:
            plain.sendall(b"\x16\x03\x01\x00\x05hello" + os.urandom(600))
            plain.shutdown(socket.SHUT_WR)
            plain.makefile("rb").read()
        assert server.get("/me").status == 200
        silent.close()

        # the command line can connect to a server on its own machine, regardless of the name in the
        # certificate
        scan = os.path.join(folder, "cli.ply")
        with open(scan, "wb") as file:
            file.write(folded_grid(5))
        subprocess.run(
            [server.binary, "import", scan, "--server", server.url, "--token", server.token],
            check=True,
            capture_output=True,
        )
        assert server.get("/models/cli").status == 200

        # During renewal the files are written one after the other. New connections get the new
        # certificate, and open connections stay open.
        with LiveClient(server, "sheet") as live:
            live.hello()
            renewed = make_certificate(folder, "second", "rsa")
            shutil.copy(renewed[0], chain)
            assert shown_by(server) == "first"  # the new key is still missing
            shutil.copy(renewed[1], key)
            wait_for(lambda: shown_by(server) == "second", "the renewed certificate")
            server.tls = trusting(chain)
            live.send(
                {
                    "op": "pick",
                    "id": "00000000-0000-4000-8000-000000000001",
                    "camera": CAMERA,
                    "x": 1,
                    "y": 1,
                }
            )
            live.receive_until("picked")
        with open(chain, "w", encoding="ascii") as file:
            file.write("not a certificate")
        wait_for(
            lambda: shown_by(server) == "second"
            and any(
                "keeps its current certificate" in line and chain in line for line in server.log
            ),
            "the log to tell",
        )
        assert server.stop() == 0
        server.assert_clean_log(warnings=("the server keeps its current certificate",))


def test_https_behind_nginx(folder):
    chain, key = make_certificate(folder, "proxy")
    with StrataServer() as server:
        port, plain_port = free_port(), free_port()
        site = site_of(
            "docker/nginx/strata.conf",
            (
                (r"listen 443 ssl;", f"listen 127.0.0.1:{port} ssl;"),
                (r"listen 80;", f"listen 127.0.0.1:{plain_port};"),
                (r"/etc/letsencrypt/live/museum.example/fullchain.pem", chain),
                (r"/etc/letsencrypt/live/museum.example/privkey.pem", key),
                (r"127\.0\.0\.1:8080", f"127.0.0.1:{server.port}"),
            ),
        )
        with Nginx(folder, site, port):
            upstream, server.port = server.port, port  # all further requests use the proxy
            server.tls = trusting(chain)
            check_everything(server)
            with socket.create_connection(("127.0.0.1", plain_port)) as plain:
                plain.sendall(b"GET /pot HTTP/1.0\r\nHost: museum.example\r\n\r\n")
                head = plain.makefile("rb").read().decode()
            assert " 301 " in head and "Location: https://museum.example/pot" in head, head
            server.port = upstream
        server.assert_clean_log()
