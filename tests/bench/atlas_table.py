#!/usr/bin/env python3
"""Prints the results of `strata-bench atlas --all --json FILE` as the tables of results/atlas.md:
the scans, the files of other test suites, then the broken files.

  tests/bench/atlas_table.py FILE
"""
import json
import sys

HEAD = [
    "mesh",
    "triangles",
    "coordinates",
    "charts",
    "used",
    "mean stretch",
    "largest texel / mean at 2048² · 4096² · 8192²",
    "texels with two owners",
    "s",
    "processor s",
]


def spaced(number):
    return f"{number:,}".replace(",", " ")


def seconds(value):
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}"


def cells(row):
    if "refused" in row:
        return [f"`{row['mesh']}`", "refused: " + row["refused"]]
    resolutions = row["resolutions"]
    return [
        f"`{row['mesh']}`",
        spaced(row["triangles"]),
        "the file's" if row["source"] == "file" else "made",
        str(row["charts"]),
        f"{100 * row['coverage']:.1f} %",
        f"{row['stretch_mean']:.2f}",
        " · ".join(f"{r['max_over_mean']:.2f}" for r in resolutions),
        " · ".join(spaced(r["shared_texels"]) for r in resolutions)
        if any(r["shared_texels"] for r in resolutions)
        else "0",
        seconds(row["seconds"]),
        seconds(row["cpu_seconds"]),
    ]


def print_table(rows):
    print("| " + " | ".join(HEAD) + " |")
    print("|---" * len(HEAD) + "|")
    for row in rows:
        line = cells(row)
        print("| " + " | ".join(line + [""] * (len(HEAD) - len(line))) + " |")
    print()


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)["results"]
    print_table([row for row in rows if not row["mesh"].startswith(("peers/", "nasty/"))])
    for folder in ("peers/", "nasty/"):
        print_table([row for row in rows if row["mesh"].startswith(folder)])


main()
