#!/usr/bin/env python3
"""scripts/check_commits accepts valid subjects and names the faults of others."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/check_commits"
GOOD = [
    "core: Read numbers of any length",
    "net, room: Answer at once",
    "web-client: Keep what was typed\n\nThe reason.",
    "e2e/browser: Wait for the picture",
]
BAD = {
    "Read numbers of any length": "area: Imperative summary",
    "core: read numbers": "capital letter",
    "core: Read numbers.": "full stop",
    "core: " + "Read " + "very " * 15 + "long": "72 are allowed",
    "core: Read numbers\nof any length": "below the subject is empty",
}


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "scripts").mkdir()
        copy = shutil.copy(SCRIPT, root / "scripts/check_commits")

        def check(*arguments):
            return subprocess.run([copy, *arguments], capture_output=True, text=True, check=False)

        assert check().returncode == 77, "a folder without history is skipped"

        def git(*arguments):
            who = ["-c", "user.name=Ada", "-c", "user.email=ada@example.org"]
            subprocess.run(["git", *who, *arguments], cwd=root, check=True, capture_output=True)

        def commit(message):
            git("commit", "--allow-empty", "--cleanup=verbatim", "-m", message)

        git("init", "-q")
        commit("a first one that is not looked at")
        git("tag", "base")
        for message in GOOD:
            commit(message)
        good = check("base")
        assert good.returncode == 0, good.stderr
        for message, reason in BAD.items():
            git("tag", "-f", "before")
            commit(message)
            bad = check("before")
            assert bad.returncode == 1 and reason in bad.stderr, (message, bad.stderr)
        assert check("nowhere").returncode == 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
