#!/usr/bin/env python3
"""Prints the given C++ files whose code differs from a commit. Ignores changes to comments, texts
and layout.

  scripts/changed_code.py COMMIT FILE…
"""

import re
import subprocess
import sys

# Matches a raw string, a string, a character, or a comment.
TOKEN = re.compile(
    r'(?P<text>R"(?P<mark>[^\s()\\]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\')'
    r"|//[^\n]*|/\*.*?\*/",
    re.DOTALL,
)


def code_of(source):
    without = TOKEN.sub(lambda found: '""' if found["text"] else " ", source)
    # Join adjacent strings, because clang-format splits strings.
    return re.sub(r'""(\s*"")+', '""', re.sub(r"\s+", "", without))


def main():
    commit, files = sys.argv[1], sys.argv[2:]
    for name in files:
        before = subprocess.run(["git", "show", f"{commit}:{name}"], capture_output=True)
        with open(name, encoding="utf-8") as file:
            now = code_of(file.read())
        if before.returncode != 0 or code_of(before.stdout.decode("utf-8", "replace")) != now:
            print(name)


if __name__ == "__main__":
    main()
