"""The example of a cluster (examples/cluster), with the commands of the page of the guide. Two
painters and a viewer use it through nginx while the node that has the model is killed, and while
the PostgreSQL primary is killed. Times are printed, because the machine of a test may be slow."""
import os
import pathlib
import re
import time

import pytest
from support.cluster_site import (
    MEMBERS,
    NODES,
    ROOT,
    ClusterSite,
    paint_at,
    seconds_until_all_paint,
)
from support.painted_model import LAYERS
from support.strata_server import wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))
PAGE = ROOT / "docs" / "how-to" / "move-to-three-nodes.md"
PEOPLE_BEFORE = "ada"


def commands_of_the_page():
    """Returns the lines of each code block that the test can run, in their order."""
    part = PAGE.read_text("utf-8").split("\n## Try it on one machine\n")[1].split("\n## ")[0]
    blocks = re.findall(r"^ *```\n(.*?)^ *```$", part, re.M | re.S)
    return [[line.strip() for line in block.splitlines()] for block in blocks]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    print(f"STRATA_SEED={SEED}")
    with ClusterSite() as prepared:
        programs = tmp_path_factory.mktemp("programs")
        (programs / "strata").symlink_to(pathlib.Path(os.environ["STRATA_BINARY"]).resolve())
        prepared.programs = programs
        yield prepared


def run(site, line):
    """Runs a line of the page. Its data folder and backup are in the folder of the test."""
    for usual in ("/var/lib/strata", "/backups"):
        line = line.replace(usual, str(site.folder / usual[1:].replace("/", "-")))
    return site.run(f"PATH={site.programs}:$PATH; {line}")


def test_the_commands_of_the_page_start_a_cluster_with_the_site_of_a_backup(site, story):
    story.blocks = commands_of_the_page()
    prepared = os.environ.get("STRATA_TEST_PREPARED")
    if prepared:
        run(site, f"cp -a {prepared}/empty /var/lib/strata")
    else:
        run(site, "strata migrate --data /var/lib/strata")
    run(site, f"strata user add {PEOPLE_BEFORE} --role annotator --data /var/lib/strata")
    run(site, "mkdir /backups")
    for line in story.blocks[0]:
        print(line, flush=True)
        story.told = run(site, line)
    people = run(site, f"strata user list --database {site.cluster.dsn!r}")
    assert re.search(rf"^{PEOPLE_BEFORE} ", people, re.M), people


def test_the_commands_that_follow_name_what_they_did(site, story):
    for line in story.blocks[1]:
        story.told = run(site, line)
    for part in ("etcd", *MEMBERS, *NODES, "nginx"):
        assert re.search(rf"^{part} +127\.0\.0\.1:\d+ +\w[\w ]* +\d+", story.told, re.M), story.told
    assert len(re.findall("primary", story.told)) == 1, story.told


def test_up_starts_nothing_twice(site):
    before = {part: site.cluster.pids(part) for part in ("etcd", *MEMBERS, *NODES, "nginx")}
    assert site.cluster.url in run(site, "examples/cluster/up")
    assert before == {part: site.cluster.pids(part) for part in before}


def test_everybody_paints_through_nginx(site, story):
    story.painted, story.painters, story.viewer = paint_at(site, SEED)
    took_s = seconds_until_all_paint(story.painted, story.painters, time.monotonic())
    print(f"the first strokes took {took_s:.2f} s")
    wait_for(lambda: story.viewer.frames, "a frame")


def test_painting_continues_after_the_node_of_the_model_was_killed(site, story):
    owner = wait_for(lambda: site.owner(story.painted.model["id"]), "a node with the model")
    run(site, f"examples/cluster/kill {owner}")
    begun = time.monotonic()
    took_s = seconds_until_all_paint(story.painted, story.painters, begun)
    wait_for(lambda: story.viewer.frames_since(begun), "a frame")
    print(f"{owner} killed: painting continued after {took_s:.2f} s")
    new = wait_for(lambda: site.owner(story.painted.model["id"]), "a node with the model")
    assert new != owner
    for line in story.blocks[2][1:]:
        run(site, line)
    assert site.cluster.is_ready(owner)


def test_painting_continues_after_the_primary_was_killed(site, story):
    story.old = site.cluster.primary()
    site.leave_commits_unconfirmed(story.old)
    assert story.blocks[3][0] == "examples/cluster/kill primary"
    run(site, story.blocks[3][0])
    begun = time.monotonic()
    took_s = seconds_until_all_paint(story.painted, story.painters, begun)
    wait_for(lambda: story.viewer.frames_since(begun), "a frame")
    gap_s = story.viewer.longest_gap(begun, time.monotonic())
    print(f"{story.old} killed: painting continued after {took_s:.2f} s")
    print(f"{story.old} killed: the viewer had no frame for {gap_s:.2f} s")
    assert site.cluster.primary() not in (None, story.old)


def test_the_old_primary_is_rewound_and_follows(site, story):
    log = site.cluster.log(story.old)
    before = len(log.read_bytes())
    for line in story.blocks[3][1:]:
        run(site, line)
    told = log.read_bytes()[before:].decode()
    assert "running pg_rewind from" in told and "pg_rewind exit code=0" in told, told[-3000:]
    assert site.cluster.members()[story.old]["role"] in ("replica", "sync_standby")


def test_everybody_paints_again(story):
    seconds_until_all_paint(story.painted, story.painters, time.monotonic())
    story.painted.end_painting(story.painters)
    story.viewer.leaving.set()
    story.viewer.join(60)
    assert not story.painted.book.faults, story.painted.book.faults


def test_every_saved_edit_is_in_the_history_once_and_no_other(story):
    found = story.painted.check_history()
    ids = [row["id"] for _, row in found.values()]
    assert len(set(ids)) == len(ids), "an edit is in the history twice"
    assert sorted(found) == sorted(
        story.painted.book.edits
    ), "an edit is in the history that nobody sent, or that nobody was told is saved"
    print(f"{len(found)} edits survived")


def test_the_texels_are_those_of_a_replay(story):
    story.painted.compare_with_replay({name: story.painted.texels(name) for name, *_ in LAYERS})


def test_down_ends_all_processes(site, story):
    assert story.blocks[4] == ["examples/cluster/down"]
    run(site, story.blocks[4][0])
    left = [part for part in ("etcd", *MEMBERS, *NODES, "nginx") if site.cluster.pids(part)]
    assert not left
    for node in NODES:
        errors = re.findall(r"^\S+ E .*$", site.cluster.log(node).read_text("utf-8"), re.M)
        assert not errors, errors[:10]
