"""Who connects and then takes their time: each waits in a thread of its own while the other attempts go on."""
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

# The options of the server by which these attempts are made, in seconds: the answers tell what is
# without them.
TRIED_WITH = {"head-timeout": 2, "idle-timeout": 4, "stall-timeout": 3, "recheck-every": 1}
LATE_S = 45  # a busy machine may be late by this; less than what most wait without an option
CONNECTIONS = 2048


def until_closed(link, every_s=None, drop=b"x", limit_s=LONG_S):
    """Seconds until the server ends the connection, which gets a drop more every so often."""
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
    """What the program says to do where an option is not given."""
    told = subprocess.run(
        [os.environ["STRATA_BINARY"], "serve", "--help"], capture_output=True, text=True, check=True
    ).stdout
    return int(re.search(rf"--{name} .*=(\d+) ", told)[1])


def options():
    return [word for name, s in TRIED_WITH.items() for word in (f"--{name}", str(s))]


def cut(section, what, took, option, limit_s, keeps):
    """`limit_s` is documented, and holds without the option."""
    tried_s = TRIED_WITH[option]
    is_cut = tried_s / 2 <= took <= tried_s + LATE_S and without_option(option) == limit_s
    section.tried(
        what,
        f"cut off after {limit_s} s" if is_cut else f"after {took:.0f} s",
        f"cut off after {limit_s} s",
        keeps,
        f"{round(took)} s with `--{option} {tried_s}` (held to {tried_s + LATE_S})",
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
    """200 bodies of a byte each second: seconds until one of them is ended, while others are served."""
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
                    pass  # it has been ended
            assert server.get("//livez").status == 200 and server.get(M).status == 200
    for link in links:
        link.close()
    return last.result()


def deaf(server):
    """A live connection that answers no ping: seconds until it is ended."""
    with LiveClient(server, "sheet") as connection:
        connection.hello(dpr=1, accept=["jpeg"])
        start = time.monotonic()
        connection.socket.settimeout(LONG_S)
        while connection.socket.recv(65536):
            pass
        return time.monotonic() - start


def expired(server):
    """A live connection whose session comes of age: its close code and the seconds until then."""
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
    """Downloads that nobody reads: the statuses of others' downloads meanwhile, and of other questions."""
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
    """More connections than there may be, none of which says anything: what happens to the next one, and how long until there is room again."""
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
    """Nothing, half a greeting, and words that are none: seconds until each is ended."""
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
    # What must last while others are tried, at one without the options.
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
                "A connection that says nothing",
                silent.result(),
                "head-timeout",
                10,
                "10 s from connecting to the end of the first head",
            )
            cut(
                section,
                "A head of which a line comes each second (slow-loris)",
                max(head.result() for head in heads),
                "head-timeout",
                10,
                "10 s from connecting to the end of the first head, however it trickles",
            )
            cut(
                section,
                "A second head that comes letter by letter on a connection that was served",
                second.result(),
                "idle-timeout",
                60,
                "60 s from an answer to the end of the next head",
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
                "A body that stops, of a call that was refused",
                refused.result(),
                "stall-timeout",
                60,
                "60 s without a byte",
            )
            cut(
                section,
                "200 bodies that come a byte a second",
                drops.result(),
                "stall-timeout",
                60,
                "a body has a minute, and a second more for each kilobyte; others are served meanwhile",
            )
            section.tried(
                "6 downloads that nobody reads",
                readers.result(),
                200,
                "4 streams at once: **further downloads get 503** until one ends, or does not move for 60 s; all else is served",
            )
            code, took = of_age.result()
            held_s = TRIED_WITH["recheck-every"] + 15 + LATE_S
            assert took <= held_s and without_option("recheck-every") == 30, took
            section.tried(
                "A live connection whose token comes of age",
                code,
                1008,
                "asked again every 30 s, and what is remembered is 10 s old at most",
                f"{round(took)} s with `--recheck-every {TRIED_WITH['recheck-every']}` (held to {held_s})",
            )
            cut(
                section,
                "A live connection that answers no ping",
                no_pong.result(),
                "idle-timeout",
                60,
                "pinged after 30 s, ended after 60",
            )
        if crowded:
            took, memory = crowded
            assert took <= 10 + LATE_S, took
            section.tried(
                f"{CONNECTIONS + 100} silent connections from one address",
                "those above 2048 are closed, room after 10 s",
                "those above 2048 are closed, room after 10 s",
                f"{CONNECTIONS} connections in all, **none by address** (see above)",
                f"{round(took)} s (held to {10 + LATE_S}); {memory}",
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
                "A connection that says nothing, half a greeting, or a greeting and nothing more",
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
            section.tried("TLS 1.0 and 1.1", spoken, "refused", "1.2 and 1.3 alone")
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
                "ECDHE with AES-GCM or ChaCha20-Poly1305 alone",
            )
            link = connected(
                server,
                f"GET /x HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nCookie: strata_session=x\r\n\r\n".encode(),
            )
            head = link.recv(65536).decode()
            section.tried(
                "Plain http at the same port",
                int(head.split()[1]),
                308,
                "sent on to https; nothing is served openly",
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
                "A change from a page of the same name that came by http",
                forged.status,
                403,
                "by https the server's own pages are those by https",
            )
            assert (
                whole.startswith("__Host-strata_session=")
                and "; Path=/;" in whole
                and "Domain" not in whole
            ), whole
            plain = cookie.removeprefix("__Host-")
            section.tried(
                "A cookie that a neighbouring host of the same domain has set",
                server.get("/me", token=False, headers={"Cookie": plain}).status,
                401,
                "by https its name is `__Host-…`, which browsers take from this host alone",
            )
            lasts = server.get("//", token=False).headers["Strict-Transport-Security"]
            section.tried(
                "A later visit by http",
                lasts,
                "max-age=31536000",
                "Strict-Transport-Security: browsers ask by https for a year",
            )
            section.tried(
                "The cookie on its way by http",
                "Secure" if "; Secure" in whole else whole,
                "Secure",
                "browsers send it by https alone",
            )
            server.assert_clean_log()
