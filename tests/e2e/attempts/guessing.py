"""Guesses of names, passwords and links. The server listens only on this machine, so it trusts the
X-Forwarded-For of its proxy. Each attempt uses a different address."""
import concurrent.futures
import itertools
import time

from attempts.tools import person, statuses
from support.browsers import PASSWORD
from support.process_memory import PeakGrowth
from support.strata_server import wait_for

MOST = 400  # number of guesses if there were no limit
# concurrent guesses; the server hashes this number of passwords at the same time and refuses more
HANDS = 2
OF_ADDRESS = "60 at once, then two a second, for each address"
FASTEST_SHARE = 0.25  # share of the time for a known name


def sign_in(server, user, password, address):
    return server.post(
        "/login",
        {"user": user, "password": password},
        token=False,
        headers={"X-Forwarded-For": address, "Origin": server.url},
    )


def token_guess(server, address):
    return server.post(
        "/login",
        {"token": "x" * 43},
        token=False,
        headers={"X-Forwarded-For": address, "Origin": server.url},
    )


def is_slowed(answer):
    return answer.status == 429 and b"too many attempts" in answer.body


def until_slowed(tries):
    """Returns the responses up to the first 429. Makes several guesses at the same time, because
    the server needs time for each password."""
    answers = []
    with concurrent.futures.ThreadPoolExecutor(HANDS) as hands:
        for batch in zip(*[iter(tries)] * HANDS):
            answers += hands.map(lambda ask: ask(), batch)
            if any(is_slowed(answer) for answer in answers):
                break
    assert answers[0].status != 429, answers[0]
    return answers


def let_through(answers):
    return f"{sum(answer.status != 429 for answer in answers)} checked"


def while_slowed(guess, ask, expected):
    """Returns the response to `ask` directly after a guess that the limit refused. Repeats the
    guess and `ask` if the limit has allowed a guess in between."""

    def tried():
        if not is_slowed(guess()):
            return None
        answer = ask()
        return answer if answer.status == expected else None

    return wait_for(tried, f"{expected} while guesses are limited")


def passwords(server, section):
    person(server, "vera", "viewer")
    numbers = itertools.count(1)

    def guess():
        return sign_in(server, "vera", f"guess {next(numbers)}", "10.1.0.1")

    answers = until_slowed(guess for _ in range(MOST))
    section.tried(
        "Guesses of one user's password from one address",
        statuses(answers),
        {401, 429},
        "10 at once, then one in 10 s, for each name from an address",
        let_through(answers),
    )
    right = while_slowed(guess, lambda: sign_in(server, "vera", PASSWORD, "10.1.0.1"), 429)
    assert right.headers["Retry-After"], right
    section.tried(
        "… and then the correct password from that address",
        right.status,
        429,
        "too many guesses from an address also delay the user at that address",
    )
    section.tried(
        "… and at the same time from another address",
        sign_in(server, "vera", PASSWORD, "10.1.0.2").status,
        200,
        "the lower limit of a name is separate for each address",
    )
    # The server does not hash tokens, so even a slow machine reaches the limit of the address.
    answers = until_slowed(lambda: token_guess(server, "10.1.0.3") for _ in range(MOST))
    section.tried(
        "Guesses of the owner's token from one address",
        statuses(answers),
        {401, 429},
        OF_ADDRESS,
        let_through(answers),
    )
    with concurrent.futures.ThreadPoolExecutor(20) as hands:
        answers = list(
            hands.map(lambda n: sign_in(server, f"somebody{n}", "password1", "10.1.0.3"), range(20))
        )
    assert 429 in statuses(answers) and statuses(answers) <= {401, 429}, answers
    section.tried(
        "… and one password for 20 names from that address",
        "limited",
        "limited",
        OF_ADDRESS,
        let_through(answers),
    )
    answers = until_slowed(
        lambda n=n: token_guess(server, f"10.9.{n // 250}.{n % 250}, 10.1.0.4") for n in range(MOST)
    )
    section.tried(
        "… with invented addresses before the real one in X-Forwarded-For",
        statuses(answers),
        {401, 429},
        "only the last address of the header counts, and only from a proxy on this machine",
        let_through(answers),
    )


def many_addresses(server, section):
    """Many machines guess one user's password. Some of the guesses need no hash, so even a busy
    machine reaches the limit."""
    rosa = person(server, "rosa", "viewer")
    assert sign_in(server, "rosa", PASSWORD, "10.2.0.1").status == 200
    numbers = itertools.count(1)

    def guess():
        n = next(numbers)
        return sign_in(server, "rosa", f"guess {n}", f"10.3.{n // 250}.{n % 250 + 1}")

    def quick_guess(n):
        away = {"Cookie": rosa.cookie, "Origin": server.url, "X-Forwarded-For": f"10.10.0.{n}"}
        return server.post(
            "/me/password", {"password": "twelve otters and a heron"}, token=False, headers=away
        )

    quick = [quick_guess(n + 1) for n in range(50)]
    assert statuses(quick) == {422}, quick
    answers = quick + until_slowed(guess for _ in range(MOST))
    section.tried(
        "One name from dozens of addresses, one guess from each, by signing in (401) and with a copied session (422)",
        statuses(answers),
        {401, 422, 429},
        "60 at once, then one in 2 s, for each name from all addresses",
        let_through(answers),
    )
    known = while_slowed(guess, lambda: sign_in(server, "rosa", PASSWORD, "10.2.0.1"), 200)
    section.tried(
        "… and at the same time the user, at an address with an earlier sign-in",
        known.status,
        200,
        "guesses from other addresses do not delay the user at an address with an earlier sign-in",
    )
    homes = itertools.count(1)
    new = while_slowed(
        guess, lambda: sign_in(server, "rosa", PASSWORD, f"10.4.0.{next(homes)}"), 429
    )
    section.tried(
        "… and the user, at a new address",
        new.status,
        429,
        "**the user waits** until the guesses stop; open sessions still work",
    )


def links(server, section):
    """Guesses secrets of 256 bits. The server limits these guesses, too."""
    zoe = person(server, "zoe", "viewer")
    stolen = {"Cookie": zoe.cookie, "Origin": server.url, "X-Forwarded-For": "10.5.0.1"}
    answers = until_slowed(
        lambda n=n: server.post(
            "/me/password",
            {"current": f"guess {n}", "password": "twelve otters and a heron"},
            token=False,
            headers=stolen,
        )
        for n in range(MOST)
    )
    section.tried(
        "A user's current password, with a copied session",
        statuses(answers),
        {422, 429},
        "as for signing in: 10 at once, then one in 10 s",
        let_through(answers),
    )
    away = {"X-Forwarded-For": "10.5.0.3", "Origin": server.url}
    answers = until_slowed(
        lambda: server.post("/auth/kiosk", {"link": "x" * 43}, token=False, headers=away)
        for _ in range(MOST)
    )
    section.tried(
        "Guesses of kiosk links",
        statuses(answers),
        {401, 429},
        "256 random bits; " + OF_ADDRESS,
        let_through(answers),
    )
    answers = [
        server.post(
            "/invitations/show",
            {"invitation": "x" * 43},
            token=False,
            headers={"X-Forwarded-For": "10.5.0.5", "Origin": server.url},
        )
        for _ in range(100)
    ]
    section.tried(
        "Guesses of invitations",
        statuses(answers),
        401,
        "256 random bits; **no limit**",
        "all 100 checked",
    )
    answers = until_slowed(
        lambda: server.get(
            "//login?link=" + "x" * 43, token=False, headers={"X-Forwarded-For": "10.5.0.4"}
        )
        for _ in range(MOST)
    )
    section.tried(
        "Guesses of owner links",
        statuses(answers),
        {401, 429},
        "256 random bits; " + OF_ADDRESS,
        let_through(answers),
    )


def names(server, section):
    """Checks whether a response shows that a name has an account."""
    person(server, "yara", "viewer")

    def timed(user, n):
        start = time.monotonic()
        answer = sign_in(server, user, "not the password", f"10.6.0.{n}")
        return time.monotonic() - start, answer

    tries = {
        user: [timed(user, 10 * n + at) for n in range(4)]
        for at, user in enumerate(("yara", "nobody-at-all"))
    }
    known, unknown = (min(took for took, _ in tries[user]) for user in tries)
    assert (
        unknown >= FASTEST_SHARE * known
    ), f"an unknown name takes {unknown:.4f} s, a known one {known:.4f} s"
    bodies = {answer.body for each in tries.values() for _, answer in each}
    section.tried(
        "Finding out which names have an account, by the answer or by its time",
        f"{told_status(tries)}, {len(bodies)} wording",
        "401, 1 wording",
        "the server also hashes a password for unknown names",
        f"fastest of 4: an unknown name takes {unknown / known:.1f} times as long as a known one (limit {FASTEST_SHARE})",
    )


def told_status(tries):
    return ", ".join(
        str(each) for each in {answer.status for answers in tries.values() for _, answer in answers}
    )


def at_once(server, section):
    with PeakGrowth(server) as growth, concurrent.futures.ThreadPoolExecutor(40) as crowd:
        answers = list(
            crowd.map(
                lambda n: sign_in(server, f"crowd{n}", "password1", f"10.7.0.{n + 1}"), range(40)
            )
        )
    assert statuses(answers) <= {401, 429}, answers
    section.tried(
        "40 sign-ins at once from 40 addresses",
        "all answered",
        "all answered" if server.get("//livez").status == 200 else "",
        "Argon2id needs 64 MiB for each password: two at once, the others wait 2 s at most (429)",
        growth.checked(512),
    )


def attempts(server, table):
    section = table.section("Guessing")
    for attempt in (passwords, many_addresses, links, names, at_once):
        attempt(server, section)
