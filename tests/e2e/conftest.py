"""Fixtures of all end-to-end tests. The cases of a file are one sequence on one server, in their
order. The first failure ends the sequence."""
import types

import pytest
from support.strata_server import StrataServer


@pytest.fixture(scope="module")
def server():
    """A server for all cases of a file. Files override this fixture to add initial data."""
    with StrataServer() as started:
        yield started


@pytest.fixture(scope="module")
def story():
    """Values that a case stores for later cases of its file."""
    return types.SimpleNamespace()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    """A failure shows the logs of the running servers."""
    outcome = yield
    report = outcome.get_result()
    if report.failed:
        for server in StrataServer.running:
            report.sections.append((f"log of the server at {server.url}", server.end_of_log()))
