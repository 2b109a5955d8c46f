"""Every kind of file that leaves Strata is opened by a program or library of others."""
import pytest
from support.sample_exports import EXPORTS, write
from support.sample_report import make_site
from support.strata_server import StrataServer


@pytest.fixture(scope="module")
def server():
    with StrataServer(demo=True) as started:
        make_site(started)
        yield started


def test_programs_of_others_open_every_export(server, tmp_path):
    names = write(server, tmp_path)
    lines = (tmp_path / "opened.md").read_text(encoding="utf-8").splitlines()
    assert len(lines) == len(names) + 2 == len(EXPORTS) + 2
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*names, "opened.md"])
