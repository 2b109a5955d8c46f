#!/usr/bin/env python3
"""stream_test.py STRATA_BENCH STRATA: `strata-bench stream --quick` measures a real server, and its
figures can be drawn. The test checks which numbers exist and which are zero. It does not check times."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = [
    ("active", 2, 3, "turn", False),
    ("active", 2, 3, "paint", False),
    ("active", 2, 3, "turn and paint", False),
    ("stalled", 2, 3, "turn and paint", True),
    ("idle", 0, 3, "rest", False),
]


def check_times(times, what):
    assert (
        times
        and times["runs"] > 0
        and 0 < times["ms_min"] <= times["ms_median"] <= times["ms_p95"] <= times["ms_max"]
    ), (what, times)


def check_run(row, run):
    turns, paints = "turn" in row["hands"], "paint" in row["hands"]
    assert (
        run["seconds"] >= 2 and run["cores"]["server"] >= 0 and run["server_mib"]["peak"] > 10
    ), run
    rates = run["frames_per_s"]
    assert bool(rates["turning"]) == turns and bool(rates["painting"]) == paints, rates
    assert not row["idle"] or rates["idle"]["viewers"] == row["idle"], rates
    if turns:
        check_times(run["camera_to_last_byte"], "camera_to_last_byte")
        # The camera and its frame both cross the link.
        assert run["camera_to_last_byte"]["ms_min"] >= 20, run["camera_to_last_byte"]
        refined = run["last_camera_to_full_quality"]
        check_times(refined, "last_camera_to_full_quality")
        assert (
            refined["runs"] == rates["turning"]["viewers"]
        ), "whoever holds still sees the model in full quality"
    if paints:
        strokes = run["strokes"]
        assert (
            strokes["batches_per_s"] > 0 and strokes["refused"] == 0 and strokes["unanswered"] == 0
        ), strokes
        check_times(strokes["to_own_pixels"], "to_own_pixels")
        check_times(
            strokes["to_others_pixels"]["turning" if turns else "still"], "to_others_pixels"
        )
        if row["idle"]:
            check_times(strokes["to_others_pixels"]["idle"], "idle viewers' pixels")
            assert run["bytes_per_s"]["all_idle"] > 0, run
    if row["hands"] == "rest":
        assert (
            run["bytes_per_s"]["all_idle"] == 0 and rates["idle"]["max"] == 0
        ), "something is sent to viewers at rest"


def main():
    bench, server = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "stream.json"
        # A slow machine would still refine frames when the viewers start to rest.
        subprocess.run(
            [bench, "stream", "--quick", "--server", server, "--json", result],
            check=True,
            env={**os.environ, "STRATA_SAMPLES_AT_REST": "1"},
        )
        data = json.loads(result.read_text())
        assert (
            data["method"] == "stream"
            and data["triangles"] > 10_000
            and data["machine"]["gl_renderer"]
        ), data
        found = [
            (row["part"], row["active"], row["idle"], row["hands"], row["stalled"])
            for row in data["results"]
        ]
        assert found == CASES, found
        for row in data["results"]:
            assert len(row["runs"]) == 1, row
            check_run(row, row["runs"][0])
        drawn = subprocess.run(
            [sys.executable, HERE.parent / "draw_stream.py", result, folder],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for figure in ("times", "rates"):
            assert (Path(folder) / f"stream-{figure}.svg").read_text().startswith("<svg"), figure
        for title in (
            "**Active viewers**",
            "**Viewers at rest**",
            "**A viewer that reads nothing**",
        ):
            assert title in drawn, drawn
    # The benchmark refuses an invalid link before it starts.
    refused = subprocess.run([bench, "stream", "--links", "80ms"], capture_output=True, text=True)
    assert refused.returncode == 2 and "80ms" in refused.stderr, refused


main()
