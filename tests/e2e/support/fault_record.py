"""The results of programs that cause faults, summed over all runs in one JSON file."""
import datetime
import json
import os
import time

from support.latencies import percentile

MOST_MB = 800  # memory of a node
COUNTS = ("lost", "doubled", "late", "wrong_texels")  # must be 0
OTHER_TIMES = (
    ("ended_s", "node ended"),
    ("ready_again_s", "node ready again"),
    ("restarted_s", "PostgreSQL answers"),
    ("no_frame_s", "no frame"),
)
OTHER_COUNTS = (
    ("refused", "refused"),
    ("process_ended", "processes ended"),
    ("moved", "models moved"),
)


class FaultRecord:
    """Without a path, the results are only in memory. The file is complete after each round, so a
    run can be interrupted."""

    def __init__(self, path, machine):
        self.path, self.begun = path, time.monotonic()
        self.facts = read_facts(path)
        self.run = {"begun": _now(), "hours": 0, **machine}
        self.facts["runs"].append(self.run)
        self.wrong = 0  # findings of this run

    def rounds(self, fault):
        return len(self.facts["faults"].get(fault, []))

    def add(self, fault, result):
        self.facts["faults"].setdefault(fault, []).append(result)
        self._count(result)
        print(f"{fault}, round {self.rounds(fault)}: {json.dumps(result)}", flush=True)

    def add_replay(self, strokes, wrong_texels):
        result = {"strokes": strokes, "wrong_texels": wrong_texels}
        self.facts["replays"].append(result)
        self._count(result)
        print(f"replay: {json.dumps(result)}", flush=True)

    def add_failure(self, fault, error):
        """A round that did not end, for example because painting did not continue."""
        failure = {"fault": fault, "at": _now(), "error": str(error)[:2000]}
        self.facts["failures"].append(failure)
        self.wrong += 1
        self._save()

    def _count(self, result):
        self.wrong += sum(result.get(key, 0) for key in COUNTS)
        self.wrong += result.get("memory_mb", 0) > MOST_MB
        self._save()

    def _save(self):
        self.run["hours"] = round((time.monotonic() - self.begun) / 3600, 3)
        if not self.path:
            return
        unfinished = self.path + ".new"
        with open(unfinished, "w", encoding="utf-8") as file:
            json.dump(self.facts, file, indent=1)
        os.replace(unfinished, self.path)

    def summary(self):
        return summary(self.facts)


def read_facts(path):
    """Returns the results of all runs."""
    if path and os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    return {"runs": [], "faults": {}, "replays": [], "failures": []}


def summary(facts):
    """Returns a Markdown table and the sums of all runs."""
    strokes = sum(each["strokes"] for each in facts["replays"])
    wrong = sum(each["wrong_texels"] for each in facts["replays"])
    hours = sum(run["hours"] for run in facts["runs"])
    lines = [
        "| fault | rounds | painting continues after, p50 | p95 | longest | also measured "
        "| acknowledged | lost | doubled | late | memory of a node |",
        "|" + "---|" * 11,
        *(_row(fault, rounds) for fault, rounds in sorted(facts["faults"].items())),
        "",
        f"{strokes} strokes were painted again in order: {wrong} texels differ. "
        f"{len(facts['failures'])} rounds failed. {hours:.1f} hours in {len(facts['runs'])} runs.",
    ]
    lines += [f"{each['fault']} failed: {each['error']}" for each in facts["failures"]]
    return "\n".join(lines)


def _now():
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")


def _row(fault, rounds):
    column = lambda key: [each[key] for each in rounds if key in each]
    times = column("went_on_s")
    others = [
        f"{title} {percentile(column(key), 0.5):.1f} / {percentile(column(key), 0.95):.1f} s"
        for key, title in OTHER_TIMES
        if column(key)
    ]
    others += [f"{title} {sum(column(key))}" for key, title in OTHER_COUNTS if column(key)]
    sums = [str(sum(column(key))) for key in ("strokes", "lost", "doubled")]
    cells = [
        fault,
        str(len(rounds)),
        *(f"{percentile(times, share):.2f} s" for share in (0.5, 0.95, 1)),
        ", ".join(others) or "–",
        *sums,
        str(sum(column("late"))) if column("late") else "–",
        f"≤ {max(column('memory_mb')):.0f} MB" if column("memory_mb") else "–",
    ]
    return f"| {' | '.join(cells)} |"
