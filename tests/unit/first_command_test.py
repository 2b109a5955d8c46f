#!/usr/bin/env python3
"""`./run` refuses wrong use with a reason before it installs packages, and its steps show their
progress, in a log and in a terminal."""
import os
import pty
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NINJA = "[1/3] Building one\n[2/3] Building two\nwarning: of two\n[3/3] Linking\n"
APT = "Reading package lists\ndlstatus:1:12.5:Retrieving file 1\npmstatus:cmake:73.1:Installing cmake\n"


def run(*arguments, **environment):
    return subprocess.run(
        [os.path.join(ROOT, "run"), *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, **environment},
    )


def check_usage(folder):
    text = os.path.join(folder, "notes.txt")
    with open(text, "w", encoding="utf-8") as file:
        file.write("no mesh\n")
    for arguments, environment, reason in (
        (["--fast"], {}, "unknown option: --fast"),
        ([os.path.join(folder, "none.ply")], {}, "no such file"),
        ([folder], {}, "not a file"),
        ([text], {}, "is not a PLY, OBJ, STL, glTF, GLB or zip file"),
        ([], {"STRATA_BUILD_JOBS": "many"}, "STRATA_BUILD_JOBS"),
    ):
        result = run(*arguments, **environment)
        assert result.returncode == 2, (arguments, result)
        assert reason in result.stderr and "--help" in result.stderr, (arguments, result.stderr)
        assert result.stdout == "", result.stdout
    for option in ("--help", "-h"):
        assert "Usage: ./run" in run(option).stdout


def shell(folder, script, text=""):
    """Runs a script that sources setup.sh; returns its result with its standard error."""
    command = f'set -euo pipefail; . "{ROOT}/scripts/setup.sh"\n{script}'
    return subprocess.run(
        ["bash", "-c", command], cwd=folder, input=text, capture_output=True, text=True, timeout=60
    )


def check_log(folder):
    told = shell(
        folder,
        "progress_log_every=0; number_steps 2; begin_step Server; show_ninja_progress 3 9000; end_step",
        NINJA,
    ).stderr.splitlines()
    assert told[0] == "[1/2] Server: 1 of 3 units, 33 %, about 10 s left", told
    assert told[-2].startswith("[1/2] Server: 3 of 3 units, 100 %"), told
    assert told[-1].startswith("[1/2] Server: done in "), told
    with open(os.path.join(folder, "build", "setup.log"), encoding="utf-8") as file:
        assert "warning: of two\n" in file.read(), "what the tools print is kept"

    told = shell(folder, "progress_log_every=0; begin_step Packages; show_apt_progress", APT).stderr
    assert told == "Packages: downloading, 12 %\nPackages: installing, 73 %\n", told

    told = shell(
        folder,
        "progress_log_every=0; begin_step Server; show_ninja_progress 30 1000",
        "[1/3] Building one\n[2/3] Building Unity/unity_0_cxx.cxx.o\n[3/3] Building Unity/unity_1_cxx.cxx.o\n",
    ).stderr.splitlines()
    percents = [re.search(r" (\d+) %", line).group(1) for line in told]
    assert percents == ["3", "50", "96"], f"a unit of several files counts for more: {told}"

    quiet = shell(folder, "begin_step Server; show_ninja_progress 3 9000", NINJA).stderr
    assert len(quiet.splitlines()) == 1, "a log gets a line now and then"


def check_failure(folder):
    failing = '(cat; exit 1) | show_ninja_progress 3 1000 || fail_step "The build failed."'
    lines = "".join(f"[{i}/100] Building {i}\n" for i in range(1, 50))
    result = shell(
        folder, f"begin_step Server; {failing}", f"{lines}FAILED: a.o\na.cpp:1: error: no\n"
    )
    assert result.returncode == 1
    told = result.stderr
    assert "FAILED: a.o\na.cpp:1: error: no\n" in told and "Building 40" not in told, told
    assert "The build failed." in told and "build/setup.log" in told, told


def check_terminal(folder):
    control, terminal = pty.openpty()
    subprocess.run(
        [
            "bash",
            "-c",
            f'set -euo pipefail; . "{ROOT}/scripts/setup.sh"; begin_step Server; show_ninja_progress 3 1000; end_step',
        ],
        cwd=folder,
        input=NINJA.encode(),
        stderr=terminal,
        timeout=60,
        check=True,
        env={**os.environ, "TERM": "xterm"},
    )
    os.close(terminal)
    told = os.read(control, 65536).decode()
    os.close(control)
    assert told.count("\n") == 1, f"a step is one line: {told!r}"
    assert "\r\x1b[KServer: 2 of 3 units, 66 %" in told, repr(told)
    assert max(len(each) for each in told.split("\r")) < 80, "a line of a narrow terminal"


def main():
    with tempfile.TemporaryDirectory() as folder:
        check_usage(folder)
        check_log(folder)
        check_failure(folder)
        check_terminal(folder)
    print("./run tells what it does and what is wrong")


if __name__ == "__main__":
    sys.exit(main())
