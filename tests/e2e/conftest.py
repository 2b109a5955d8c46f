"""Fixtures of all end-to-end tests. The cases of a file tell one story of one server, in their order, and the first that fails ends it."""
import types

import pytest
from support.strata_server import StrataServer


@pytest.fixture(scope="module")
def server():
    """A server for all cases of a file, which override this to put into it what they begin with."""
    with StrataServer() as started:
        yield started


@pytest.fixture(scope="module")
def story():
    """What a case hands on to later ones of its file."""
    return types.SimpleNamespace()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    """A failure shows the logs of the servers that run."""
    outcome = yield
    report = outcome.get_result()
    if report.failed:
        for server in StrataServer.running:
            report.sections.append((f"log of the server at {server.url}", server.end_of_log()))
