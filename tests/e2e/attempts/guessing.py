"""Guessing names, passwords and links. The server listens on this machine only, so it believes its proxy's X-Forwarded-For: each attempt comes from an address of its own."""
import concurrent.futures
import itertools
import time

from attempts.tools import person, statuses
from support.browsers import PASSWORD
from support.process_memory import PeakGrowth
from support.strata_server import wait_for

MOST = 400  # tries, when nothing slows them down
HANDS = 2  # as many as the server hashes passwords for at once: more would be refused for that
OF_ADDRESS = "60 at once, then two a second, from an address"
FASTEST_SHARE = 0.25  # of the time that a known name takes


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
    return answer.status == 429 and b"too many tries" in answer.body


def until_slowed(tries):
    """The answers until one is 429; several at a time, since each password takes the server a while."""
    answers = []
    with concurrent.futures.ThreadPoolExecutor(HANDS) as hands:
        for batch in zip(*[iter(tries)] * HANDS):
            answers += hands.map(lambda ask: ask(), batch)
            if any(is_slowed(answer) for answer in answers):
                break
    assert answers[0].status != 429, answers[0]
    return answers


def let_through(answers):
    return f"{sum(answer.status != 429 for answer in answers)} looked at"


def while_slowed(guess, ask, expected):
    """The answer to `ask` right after a guess was held up; again where the limit had let one through meanwhile."""

    def tried():
        if not is_slowed(guess()):
            return None
        answer = ask()
        return answer if answer.status == expected else None

    return wait_for(tried, f"{expected} while guesses are held up")


def passwords(server, section):
    person(server, "vera", "viewer")
    numbers = itertools.count(1)

    def guess():
        return sign_in(server, "vera", f"guess {next(numbers)}", "10.1.0.1")

    answers = until_slowed(guess for _ in range(MOST))
    section.tried(
        "Passwords for one name from one address",
        statuses(answers),
        {401, 429},
        "10 at once, then one in 10 s, for a name from an address",
        let_through(answers),
    )
    right = while_slowed(guess, lambda: sign_in(server, "vera", PASSWORD, "10.1.0.1"), 429)
    assert right.headers["Retry-After"], right
    section.tried(
        "… and then the right one from there",
        right.status,
        429,
        "as long as guesses from that address are too many, its own person waits, too",
    )
    section.tried(
        "… and from somewhere else meanwhile",
        sign_in(server, "vera", PASSWORD, "10.1.0.2").status,
        200,
        "the name is slowed down at the guesser's address first",
    )
    # Tokens cost the server no hash, so that a slow machine reaches the address's limit, too.
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
        "… and one password for 20 names from there",
        "held up",
        "held up",
        OF_ADDRESS,
        let_through(answers),
    )
    answers = until_slowed(
        lambda n=n: token_guess(server, f"10.9.{n // 250}.{n % 250}, 10.1.0.4") for n in range(MOST)
    )
    section.tried(
        "… with other addresses made up before it in X-Forwarded-For",
        statuses(answers),
        {401, 429},
        "the last address of the header counts, and only of a proxy on this machine",
        let_through(answers),
    )


def many_addresses(server, section):
    """A net of machines guesses one person's password. Some of the tries are of the kind that costs no hash, so that a busy machine reaches the limit, too."""
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
        "One name from dozens of addresses, a try from each, signing in (401) and with a copied session (422)",
        statuses(answers),
        {401, 422, 429},
        "60 at once, then one in 2 s, for a name from everywhere",
        let_through(answers),
    )
    known = while_slowed(guess, lambda: sign_in(server, "rosa", PASSWORD, "10.2.0.1"), 200)
    section.tried(
        "… and meanwhile the person herself, where she signed in before",
        known.status,
        200,
        "whoever was right from an address is not held up there by others",
    )
    homes = itertools.count(1)
    new = while_slowed(
        guess, lambda: sign_in(server, "rosa", PASSWORD, f"10.4.0.{next(homes)}"), 429
    )
    section.tried(
        "… and from an address where she never was",
        new.status,
        429,
        "**she waits** with the guessers, until they stop; sessions that are open go on",
    )


def links(server, section):
    """Secrets of 256 bits, whose guesses are slowed down all the same."""
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
        "The password that somebody has now, with their session at hand",
        statuses(answers),
        {422, 429},
        "as signing in: 10 at once, then one in 10 s",
        let_through(answers),
    )
    away = {"X-Forwarded-For": "10.5.0.3", "Origin": server.url}
    answers = until_slowed(
        lambda: server.post("/auth/kiosk", {"link": "x" * 43}, token=False, headers=away)
        for _ in range(MOST)
    )
    section.tried(
        "Guesses of links of kiosks",
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
        "256 random bits; **not slowed down**",
        "all of 100 looked at",
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
    """Whether an answer tells who has an account."""
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
        "Names that have an account, told by the answer or by how long it takes",
        f"{told_status(tries)}, {len(bodies)} wording",
        "401, 1 wording",
        "a password is hashed for unknown names, too",
        f"the quickest of 4: unknown {unknown / known:.1f} times known (held to {FASTEST_SHARE})",
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
        "40 sign-ins at one moment from 40 addresses",
        "all answered",
        "all answered" if server.get("//livez").status == 200 else "",
        "Argon2id takes 64 MiB a password: two at once, the others wait 2 s at most (429)",
        growth.checked(512),
    )


def attempts(server, table):
    section = table.section("Guessing")
    for attempt in (passwords, many_addresses, links, names, at_once):
        attempt(server, section)
