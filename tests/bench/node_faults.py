#!/usr/bin/python3
"""Measures how a site of several nodes survives faults of a node, of the database and of disks.

    STRATA_BINARY=build/release/bin/strata tests/bench/node_faults.py [--rounds N] [--json FILE] [--only NAME,…]

Three nodes and one PostgreSQL run on this machine. Each node has its own connection to PostgreSQL
and its own address for browsers, which the script can cut. Two painters send strokes to one model
while each fault happens. *The owner* is the node that owns the model:

kill           kill -9 of the owner
drain          SIGTERM to the owner
hang           SIGSTOP of the owner; SIGCONT after the painters have continued
cut            no byte passes between the owner and PostgreSQL; the held bytes arrive later
browsers       no byte passes between the painters and the owner for 4 s
gl             the driver of the owner reports the loss of the GL context
memory         the owner gets no more memory from the kernel, and must draw large pictures
clock_forward  the wall clock of the owner jumps forward by one hour, and back after 4 s
clock_back     the wall clock of the owner jumps back by one hour, and forward after 4 s
full_files     the disk of the folder --files is full during uploads
full_uploads   the disk of the folder --data is full during uploads
postgres       kill -9 of PostgreSQL, which is started again immediately
postgres_hang  SIGSTOP of all processes of PostgreSQL for 4 s
slow_disk      each write and sync of PostgreSQL takes 50 ms longer, for 4 s
full_database  the disk of PostgreSQL is full until the database refuses strokes, or until
               PostgreSQL ends, which is then started again

A library in front of the C library causes the faults of clocks, disks and GL
(tests/e2e/support/faulty_libc.c). So the script needs no rights on the machine.

A painter waits for an answer for ANSWER_S, and then sends the same stroke to the next node.
Painting continues when each painter has an acknowledgement of a stroke that it sent after the
fault (after its end for `browsers`, `postgres_hang` and `full_database`). After each round the
painters stop, and their acknowledgements are compared with the journal in the database:

lost          acknowledged strokes that are not in the journal
doubled       strokes in the journal that no painter sent, or that are there more than once
late          strokes that a node acknowledged after its lease, or without its database
wrong_texels  texels that differ from a replay of all strokes in their order

With --json, the results are added to those of earlier runs in this file. Prints the sums of all
runs as a Markdown table. Exits with 1 if a stroke was lost, doubled or late, if a texel is wrong,
if a node used more than MOST_MB of memory, or if a round did not end. Needs Debian's Python with
pytest, because it uses the helpers of the end-to-end tests, and a C compiler.
"""
import argparse
import os
import signal
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.fault_load import ANSWER_S, Journal, Load
from support.fault_record import FaultRecord
from support.faulty_libc import limit_memory, unlimit_memory
from support.live_client import AWAY
from support.machine import gl_renderer, machine
from support.nodes import Site
from support.process_memory import resident_mb
from support.strata_server import LONG_S, wait_for

NODES, PAINTERS = 3, 2
LEASE_S = 3.0
LONGER_THAN_LEASE_S = LEASE_S + 1
HOUR_S = 3600
DELAY_S = 0.05
ROUNDS_A_MODEL = 25  # a replay takes long if a model has many strokes
UPLOAD = b"%PDF-1.4\n" + bytes(range(256)) * 8192


class FaultSite(Site):
    """A site with one table for uploads."""

    def __init__(self, seed):
        super().__init__(NODES, seed, links=True, faults=True)
        self.files = os.path.join(self.postgres.data, "files")
        self.options = ("--files", self.files)

    def __enter__(self):
        super().__enter__()
        columns = [{"name": "Report", "kind": "document"}]
        self.ok("POST", "/projects/default/tables", {"name": "Finds", "columns": columns})
        self.ok("POST", "/tables/finds/records", {"values": {}})
        return self


# --- the faults: each returns its measurements, with times in seconds


def until_ready(node):
    begun = time.monotonic()
    wait_for(node.is_ready, "the node to be ready again")
    return time.monotonic() - begun


def kill(_, load, owner):
    since = time.monotonic()
    owner.kill()
    found = {"went_on_s": load.went_on(since, owner)}
    owner.start()
    until_ready(owner)
    return found


def drain(_, load, owner):
    since = time.monotonic()
    owner.process.send_signal(signal.SIGTERM)
    assert owner.process.wait(LONG_S) == 0, "SIGTERM did not end the node well"
    ended_s = time.monotonic() - since
    found = {"went_on_s": load.went_on(since, owner), "ended_s": ended_s}
    owner.start()
    until_ready(owner)
    return found


def until(moment):
    """Waits although there is no condition, because the fault must last."""
    time.sleep(max(0, moment - time.monotonic()))


def separated(load, owner, begin, end):
    """The owner cannot renew its lease between `begin` and `end`. After the end of the lease,
    painters must get no acknowledgement from the owner."""
    since = time.monotonic()
    begin()
    went_on_s = load.went_on(since, owner)
    # after the lease, also if the painters have continued earlier
    until(since + LONGER_THAN_LEASE_S)
    late = load.acknowledged_by(owner, since + LEASE_S, time.monotonic())
    end()
    return {"went_on_s": went_on_s, "ready_again_s": until_ready(owner), "late": late}


def hang(_, load, owner):
    return separated(load, owner, owner.freeze, owner.thaw)


def cut(_, load, owner):
    return separated(load, owner, owner.database.cut, owner.database.mend)


def browsers(_, load, owner):
    """The owner keeps its lease, so other nodes can only redirect to it."""
    owner.clients.cut()
    # Before this time, a response may have been on its way.
    cut_off = time.monotonic() + ANSWER_S
    until(cut_off + LEASE_S)
    mended = time.monotonic()
    assert load.acknowledged_by(owner, cut_off, mended) == 0, "the link was not cut"
    owner.clients.mend()
    return {"went_on_s": load.went_on(mended)}


def gl(_, load, owner):
    lines = len(owner.log)
    owner.faults.lose_gl()
    wait_for(
        lambda: any("GPU context was lost" in line for line in owner.log[lines:]),
        "the loss of the GL context",
    )
    return {"went_on_s": load.went_on(time.monotonic())}


def large_picture(node, model):
    """Requests a picture that needs much memory. Returns the response, or None if the node closes
    the connection without one."""
    camera = camera_from(model, (0, -0.2, 1), 8192, 8192)
    try:
        return node.post(f"/models/{model['id']}/frame", {"camera": camera})
    except TimeoutError:
        raise  # the node has neither refused nor ended
    except AWAY:
        return None


def memory(site, load, owner):
    """The node must refuse, or end as if it was killed."""
    limit_memory(owner.process.pid)
    answer = large_picture(owner, load.painters[0].model)
    assert answer is None or answer.status == 503, answer
    went_on_s = load.went_on(time.monotonic())
    has_ended = owner.process.poll() is not None
    if has_ended:
        owner.kill()
        owner.start()
    else:
        unlimit_memory(owner.process.pid)
    until_ready(owner)
    return {
        "went_on_s": went_on_s,
        "refused": int(answer is not None),
        "process_ended": int(has_ended),
    }


def jump(site, load, owner, seconds):
    """Leases use the clock of the database and monotonic clocks, so the model stays."""
    # Edits of earlier rounds have such times, too.
    edits = f"FROM edits WHERE model_id = {load.painters[0].model['id']}"
    newest = site.postgres.sql(f"SELECT max(sequence) {edits}")
    since = time.monotonic()
    owner.faults.jump_clock(seconds)
    went_on_s = load.went_on(since)
    until(since + LONGER_THAN_LEASE_S)
    direction = "> 1800" if seconds > 0 else "< -1800"
    jumped = site.postgres.sql(
        f"SELECT count(*) {edits} AND sequence > {newest} "
        f"AND extract(epoch FROM time - now()) {direction}"
    )
    assert int(jumped) > 0, "the clock did not jump"
    back = time.monotonic()
    owner.faults.jump_clock(0)
    went_on_s = max(went_on_s, load.went_on(back))
    moved = site.owner(load.painters[0].model["id"]) is not owner
    return {"went_on_s": went_on_s, "moved": int(moved)}


def clock_forward(site, load, owner):
    return jump(site, load, owner, HOUR_S)


def clock_back(site, load, owner):
    return jump(site, load, owner, -HOUR_S)


def upload(node, name):
    """Each upload has another content, because equal contents are stored once."""
    path = f"/tables/finds/records/1/attachments?name={name}.pdf&column=report"
    headers = {"Content-Type": "application/pdf"}
    return node.post(path, UPLOAD + name.encode(), headers=headers)


def full_folder(load, owner, folder):
    name = f"report-{time.monotonic_ns()}"
    since = time.monotonic()
    owner.faults.fill_disk(folder)
    refused = upload(owner, name)
    assert refused.status == 507, refused
    assert refused.json()["type"] == "/problems#storage_full", refused
    went_on_s = load.went_on(since)
    owner.faults.empty_disk()
    stored = upload(owner, name)
    assert stored.status == 201, stored
    file = stored.json()["attachments"][-1]["id"]
    assert owner.ok("GET", f"/attachments/{file}").body == UPLOAD + name.encode()
    owner.ok("DELETE", f"/attachments/{file}")
    return {"went_on_s": went_on_s, "refused": 1}


def full_files(site, load, owner):
    return full_folder(load, owner, site.files)


def full_uploads(_, load, owner):
    return full_folder(load, owner, owner.data)


def postgres(site, load, _):
    since = time.monotonic()
    site.postgres.kill()
    # Before this time, a response about an earlier commit may have arrived.
    killed = time.monotonic()
    site.postgres.restart()
    restarted_s = time.monotonic() - since
    went_on_s = load.went_on(killed) + killed - since
    for node in site.nodes:
        until_ready(node)
    return {"went_on_s": went_on_s, "restarted_s": restarted_s}


def postgres_hang(site, load, _):
    begun = time.monotonic()
    frozen = site.postgres.freeze()
    # Before this time, a response about an earlier commit may have arrived.
    stopped = time.monotonic() + ANSWER_S
    until(begun + LONGER_THAN_LEASE_S)
    thawed = time.monotonic()
    late = sum(load.acknowledged_by(node, stopped, thawed) for node in site.nodes)
    site.postgres.thaw(frozen)
    found = {"went_on_s": load.went_on(thawed), "late": late}
    for node in site.nodes:
        until_ready(node)
    return found


def slow_disk(site, load, _):
    since = time.monotonic()
    site.postgres.faults.slow_disk(DELAY_S)
    # PostgreSQL measures the time, because psql needs about as long to start
    site.postgres.sql(
        "DO $$ DECLARE begun timestamptz := clock_timestamp(); BEGIN "
        "PERFORM pg_logical_emit_message(true, 'test', 'slow'); COMMIT; "
        f"IF clock_timestamp() - begun < interval '{DELAY_S} s' THEN "
        "RAISE 'the disk is not slow'; END IF; END $$"
    )
    went_on_s = load.went_on(since)
    until(since + LONGER_THAN_LEASE_S)
    went_on_s = max(went_on_s, load.went_on(time.monotonic()))
    site.postgres.faults.slow_disk(0)
    return {"went_on_s": went_on_s}


def full_database(site, load, _):
    """PostgreSQL refuses a change that needs more space in a table. It ends if its write-ahead log
    needs more space."""
    site.postgres.faults.fill_disk()

    def has_effect():
        load.check()
        return load.refused(507) > 0 or site.postgres.process.poll() is not None

    wait_for(has_effect, "a stroke that the full disk refuses")
    site.postgres.faults.empty_disk()
    since = time.monotonic()
    has_ended = site.postgres.process.poll() is not None
    if has_ended:
        site.postgres.restart()
    found = {"went_on_s": load.went_on(since), "refused": load.refused(507)}
    for node in site.nodes:
        until_ready(node)
    return {**found, "process_ended": int(has_ended)}


FAULTS = [kill, drain, hang, cut, browsers, gl, memory, clock_forward, clock_back]
FAULTS += [full_files, full_uploads, postgres, postgres_hang, slow_disk, full_database]
FAULTS = {fault.__name__: fault for fault in FAULTS}


def one_round(site, journal, name, seed):
    load = Load(site, journal.model, seed, PAINTERS)
    owner = wait_for(lambda: site.owner(journal.model["id"]), "a node that owns the model")
    found = FAULTS[name](site, load, owner)
    strokes = load.end()
    memory_mb = max(resident_mb(node) for node in site.nodes)
    return {
        **found,
        **journal.check(strokes),
        "strokes": len(strokes),
        "memory_mb": round(memory_mb),
    }


def replay(journal, record):
    if journal is not None:
        record.add_replay(len(journal.strokes), journal.wrong_texels())


def run(record, chosen, rounds, seed):
    name = "start"
    try:
        with FaultSite(seed) as site:
            journal = None
            # one round of each fault in turn, so a slow hour of the machine affects all faults
            for _ in range(rounds):
                for name in chosen:
                    if journal is None or journal.rounds >= ROUNDS_A_MODEL:
                        replay(journal, record)
                        journal = Journal(site)
                    round_seed = f"{seed} {record.rounds(name)} {name}"
                    record.add(name, one_round(site, journal, name, round_seed))
            name = "replay"
            replay(journal, record)
    except Exception as error:
        record.add_failure(name, error)
        raise


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--rounds", type=int, default=20)
    reads.add_argument("--seed", type=int, default=1)
    reads.add_argument("--json")
    reads.add_argument("--only", default=",".join(FAULTS))
    asked = reads.parse_args()
    chosen = asked.only.split(",")
    unknown = set(chosen) - set(FAULTS)
    if unknown:
        reads.error(f"no such fault: {', '.join(sorted(unknown))}")
    if asked.rounds < 1:
        reads.error("--rounds must be 1 or more")
    facts = {**machine(), "renderer": gl_renderer(os.environ["STRATA_BINARY"])}
    record = FaultRecord(asked.json, facts)
    run(record, chosen, asked.rounds, asked.seed)
    print("\n" + record.summary())
    return 1 if record.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
