"""Slow and silent clients. Each waits in a separate thread while the other attempts run."""
import concurrent.futures
import os
import re
import resource
import socket
import ssl
import subprocess
import tempfile
import time

from attempts.tools import M
from support.certificates import make_certificate, trusting
from support.live_client import Closed, LiveClient
from support.meshes import folded_grid
from support.process_memory import PeakGrowth
from support.strata_server import LONG_S, StrataServer, wait_for

# The server's options for these attempts, in seconds. The table lists the results for the default
# options.
TRIED_WITH = {"head-timeout": 2, "idle-timeout": 4, "stall-timeout": 3, "recheck-every": 1}
LATE_S = 45  # the tolerance for a busy machine; less than most of the default limits
CONNECTIONS = 2048


def until_closed(link, every_s=None, drop=b"x", limit_s=LONG_S):
    """Returns the seconds until the server closes the connection. Sends `drop` at intervals."""
    start = time.monotonic()
    link.settimeout(every_s or limit_s)
    while time.monotonic() - start < limit_s:
        try:
            if not link.recv(65536):
                break
        except TimeoutError:
            if every_s:
                try:
                    link.sendall(drop)
                except OSError:
                    break
        except OSError:
            break
    return time.monotonic() - start


def connected(server, first=b""):
    link = socket.create_connection((server.host, server.port), timeout=LONG_S)
    if first:
        link.sendall(first)
    return link


def without_option(name):
    """Returns the default of an option, from the program's help."""
    told = subprocess.run(
        [os.environ["STRATA_BINARY"], "serve", "--help"], capture_output=True, text=True, check=True
    ).stdout
    return int(re.search(rf"--{name} .*=(\d+) ", told)[1])


def options():
    return [word for name, s in TRIED_WITH.items() for word in (f"--{name}", str(s))]


def cut(section, what, took, option, limit_s, keeps):
    """Checks that the connection was cut off in time, and that `limit_s` is the default."""
    tried_s = TRIED_WITH[option]
    is_cut = tried_s / 2 <= took <= tried_s + LATE_S and without_option(option) == limit_s
    section.tried(
        what,
        f"cut off after {limit_s} s" if is_cut else f"after {took:.0f} s",
        f"cut off after {limit_s} s",
        keeps,
        f"{round(took)} s with `--{option} {tried_s}` (limit {tried_s + LATE_S})",
    )


def post(server, path, length, *more):
    return (
        "\r\n".join(
            (
                f"POST /api/v1{path} HTTP/1.1",
                f"Host: {server.host}",
                "Content-Type: application/json",
                f"Content-Length: {length}",
            )
            + more
        ).encode()
        + b"\r\n\r\n"
    )


def drops_of_a_body(server):
    """Sends 200 bodies, one byte per second. Returns the seconds until one connection ends, while
    the server serves others."""
    begin = post(server, "/login", 1000) + b"{"
    links = [connected(server, begin) for _ in range(199)]
    with concurrent.futures.ThreadPoolExecutor(1) as hand:
        last = hand.submit(lambda: until_closed(connected(server, begin), 1, b" "))
        while not last.done():
            time.sleep(1)
            for link in links:
                try:
                    link.sendall(b" ")
                except OSError:
                    pass  # the server has already closed the connection
            assert server.get("//livez").status == 200 and server.get(M).status == 200
    for link in links:
        link.close()
    return last.result()


def deaf(server):
    """Opens a live connection that responds to no ping. Returns the seconds until its end."""
    with LiveClient(server, "sheet") as connection:
        connection.hello(dpr=1, accept=["jpeg"])
        start = time.monotonic()
        connection.socket.settimeout(LONG_S)
        while connection.socket.recv(65536):
            pass
        return time.monotonic() - start


def expired(server):
    """Opens a live connection whose token expires. Returns its close code and the seconds until
    then."""
    token = server.ok("POST", "/me/tokens", {"name": "old", "days": 1}).json()
    with LiveClient(server, "sheet", token=token["secret"]) as connection:
        connection.hello(dpr=1, accept=["jpeg"])
        server.sql(
            f"UPDATE tokens SET expires = now() - interval '1 second' WHERE id = {token['token']['id']}"
        )
        start = time.monotonic()
        try:
            while True:
                connection.receive()
        except Closed as closed:
            return closed.code, time.monotonic() - start


def slow_readers(server):
    """Starts downloads without reading them. Returns the statuses of others' downloads and of other
    requests at the same time."""
    links = []
    for _ in range(6):
        link = socket.socket()
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        link.settimeout(LONG_S)
        link.connect((server.host, server.port))
        link.sendall(
            f"GET /api/v1{M}/layers/marks/texels.csv HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {server.token}\r\n\r\n".encode()
        )
        links.append(link)
    wait_for(
        lambda: server.get(M + "/layers/marks/texels.csv?cell=20mm").status == 503,
        "the downloads to take their places",
    )
    others = {server.get(M).status, server.get(M + "/layers/marks/statistics").status}
    for link in links:
        link.close()
    wait_for(
        lambda: server.get(M + "/layers/marks/texels.csv?cell=20mm").status == 200,
        "the places to be free again",
    )
    return others


def crowd(server):
    """Opens more silent connections than the limit, and checks that the server closes the last one.
    Returns the time until the server accepts a connection again, and the memory."""
    links = []
    with PeakGrowth(server) as growth:
        try:
            for _ in range(CONNECTIONS + 100):
                links.append(connected(server))
        except OSError:
            pass
        opened = len(links)
        late = links[-1]
        late.settimeout(LONG_S)
        late_end = late.recv(1)
        start = time.monotonic()

        def answers():
            try:
                return server.get("//livez").status == 200
            except OSError:
                return False

        wait_for(answers, "room for another connection")
        took = time.monotonic() - start
    for link in links:
        link.close()
    assert opened > CONNECTIONS and late_end == b"", (opened, late_end)
    return took, growth.checked(128)


def half_open_tls(server):
    """Sends nothing, half a ClientHello, and a whole one. Returns the seconds until each connection
    ends."""
    greeting = ssl.MemoryBIO()
    client = ssl.create_default_context().wrap_bio(ssl.MemoryBIO(), greeting, server_hostname="x")
    try:
        client.do_handshake()
    except ssl.SSLWantReadError:
        pass
    hello = greeting.read()
    with concurrent.futures.ThreadPoolExecutor(3) as hands:
        return list(
            hands.map(
                lambda first: until_closed(connected(server, first)), (b"", hello[:20], hello)
            )
        )


def allow_descriptors(count):
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < count:
        print(
            f"only {hard} descriptors may be open: too many connections are not tried", flush=True
        )
        return False
    if soft < count:
        resource.setrlimit(resource.RLIMIT_NOFILE, (count, hard))
    return True


def make_sheet(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Marks", "type": "u8"})
    server.ok(
        "POST",
        M + "/layers/marks/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 1},
    )


def plain(table):
    section = table.section("Slow and idle connections")
    may_crowd = allow_descriptors(2 * CONNECTIONS + 1000)
    # one server has the defaults, for attempts that must last while others run
    with StrataServer() as patient, StrataServer(options=options()) as server:
        for each in (patient, server):
            make_sheet(each)
        crowded = crowd(patient) if may_crowd else None
        kept_alive = b"GET /livez HTTP/1.1\r\nHost: x\r\n\r\n"
        with concurrent.futures.ThreadPoolExecutor(16) as hands:
            silent = hands.submit(lambda: until_closed(connected(server)))
            heads = [
                hands.submit(
                    lambda: until_closed(
                        connected(server, b"GET / HTTP/1.1\r\nHost: x\r\n"), 1, b"X: y\r\n"
                    )
                )
                for _ in range(3)
            ]
            second = hands.submit(
                lambda: until_closed(connected(server, kept_alive + b"GET / HT"), 1, b"T")
            )
            body = hands.submit(
                lambda: until_closed(connected(server, post(server, "/login", 1000) + b"{"))
            )
            refused = hands.submit(
                lambda: until_closed(connected(server, post(server, "/users", 1000)))
            )
            no_pong, of_age, drops = (
                hands.submit(each, server) for each in (deaf, expired, drops_of_a_body)
            )
            readers = hands.submit(slow_readers, patient)
            cut(
                section,
                "A connection without data",
                silent.result(),
                "head-timeout",
                10,
                "10 s from the connection to the end of the first headers",
            )
            cut(
                section,
                "Headers that arrive one line each second (slow-loris)",
                max(head.result() for head in heads),
                "head-timeout",
                10,
                "10 s from the connection to the end of the first headers, at any speed",
            )
            cut(
                section,
                "Second headers that arrive one character at a time on a used connection",
                second.result(),
                "idle-timeout",
                60,
                "60 s from an answer to the end of the next headers",
            )
            cut(
                section,
                "A body that stops",
                body.result(),
                "stall-timeout",
                60,
                "60 s without a byte",
            )
            cut(
                section,
                "A body that stops, in a call that is refused",
                refused.result(),
                "stall-timeout",
                60,
                "60 s without a byte",
            )
            cut(
                section,
                "200 bodies that arrive one byte a second",
                drops.result(),
                "stall-timeout",
                60,
                "a body has a minute, and a second more for each kilobyte; others are served at the same time",
            )
            section.tried(
                "6 downloads that the client does not read",
                readers.result(),
                200,
                "4 streams at once: **further downloads get 503** until one ends, or makes no progress for 60 s; all other requests are served",
            )
            code, took = of_age.result()
            held_s = TRIED_WITH["recheck-every"] + 15 + LATE_S
            assert took <= held_s and without_option("recheck-every") == 30, took
            section.tried(
                "A live connection whose token expires",
                code,
                1008,
                "checked again every 30 s; cached rights are at most 10 s old",
                f"{round(took)} s with `--recheck-every {TRIED_WITH['recheck-every']}` (limit {held_s})",
            )
            cut(
                section,
                "A live connection that answers no ping",
                no_pong.result(),
                "idle-timeout",
                60,
                "ping after 30 s, end after 60 s",
            )
        if crowded:
            took, memory = crowded
            assert took <= 10 + LATE_S, took
            section.tried(
                f"{CONNECTIONS + 100} silent connections from one address",
                "connections above 2048 are closed, new ones are possible after 10 s",
                "connections above 2048 are closed, new ones are possible after 10 s",
                f"{CONNECTIONS} connections in total, **no limit for each address** (see above)",
                f"{round(took)} s (limit {10 + LATE_S}); {memory}",
            )
        for each in (patient, server):
            assert each.get("//livez").status == 200 and each.stop() == 0
            each.assert_clean_log()


def tls(table):
    section = table.section("https")
    with tempfile.TemporaryDirectory(prefix="strata-attempts-", dir="/tmp") as folder:
        os.chmod(folder, 0o755)
        chain, key = make_certificate(folder, "attempts")
        with StrataServer(options=["--tls-cert", chain, "--tls-key", key, *options()]) as server:
            server.tls = trusting(chain)
            took = half_open_tls(server)
            cut(
                section,
                "A connection without data, with half a ClientHello, or with only a ClientHello",
                max(took),
                "head-timeout",
                10,
                "10 s for the handshake",
            )
            old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
            old.load_verify_locations(chain)
            old.minimum_version, old.maximum_version = ssl.TLSVersion.TLSv1, ssl.TLSVersion.TLSv1_1
            old.set_ciphers("ALL:@SECLEVEL=0")
            try:
                with old.wrap_socket(connected(server), server_hostname=server.host) as link:
                    spoken = link.version()
            except (ssl.SSLError, OSError):
                spoken = "refused"
            section.tried("TLS 1.0 and 1.1", spoken, "refused", "only 1.2 and 1.3")
            offered = set()
            for weak in (
                "AES128-SHA",
                "AES256-SHA",
                "AES128-GCM-SHA256",
                "ECDHE-ECDSA-AES128-SHA",
                "ECDHE-RSA-AES128-SHA",
                "ECDHE-ECDSA-AES256-SHA384",
                "ECDHE-RSA-AES256-SHA384",
            ):
                old.minimum_version = old.maximum_version = ssl.TLSVersion.TLSv1_2
                old.set_ciphers(weak + ":@SECLEVEL=0")
                try:
                    with old.wrap_socket(connected(server), server_hostname=server.host):
                        offered.add(weak)
                except (ssl.SSLError, OSError):
                    pass
            section.tried(
                "TLS 1.2 without forward secrecy, or with a cipher that authenticates separately",
                sorted(offered) or "refused",
                "refused",
                "only ECDHE with AES-GCM or ChaCha20-Poly1305",
            )
            link = connected(
                server,
                f"GET /x HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nCookie: strata_session=x\r\n\r\n".encode(),
            )
            head = link.recv(65536).decode()
            section.tried(
                "Plain http on the same port",
                int(head.split()[1]),
                308,
                "redirect to https; the server serves nothing without encryption",
            )
            assert (
                head.startswith("HTTP/1.1 308 Permanent Redirect\r\n")
                and f"Location: {server.url}/x\r\n" in head
            ), head
            whole = server.post("/login", {"token": server.token}, token=False).headers[
                "Set-Cookie"
            ]
            cookie = whole.split(";")[0]
            forged = server.request(
                "PATCH",
                "/me",
                {"full_name": "x"},
                token=False,
                headers={"Cookie": cookie, "Origin": f"http://{server.host}:{server.port}"},
            )
            section.tried(
                "A change from a page with the same name that was loaded by http",
                forged.status,
                403,
                "with https, only pages loaded by https are the server's own",
            )
            assert (
                whole.startswith("__Host-strata_session=")
                and "; Path=/;" in whole
                and "Domain" not in whole
            ), whole
            plain = cookie.removeprefix("__Host-")
            section.tried(
                "A cookie set by another host of the same domain",
                server.get("/me", token=False, headers={"Cookie": plain}).status,
                401,
                "with https its name is `__Host-…`, which browsers accept only from this host",
            )
            lasts = server.get("//", token=False).headers["Strict-Transport-Security"]
            section.tried(
                "A later visit by http",
                lasts,
                "max-age=31536000",
                "Strict-Transport-Security: browsers use https for a year",
            )
            section.tried(
                "The cookie in a request by http",
                "Secure" if "; Secure" in whole else whole,
                "Secure",
                "browsers send it only by https",
            )
            server.assert_clean_log()
