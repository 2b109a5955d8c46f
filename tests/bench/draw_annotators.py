#!/usr/bin/env python3
"""draw_annotators.py RESULT.json [OUT.svg]: draws the time until strokes are seen and saved, as
`annotators_test.py --json` measured it, and prints its table.

The figure (NAME.svg next to the result) shows the share of strokes that were seen or saved, over
the milliseconds since each stroke was sent. Prints the table of results/annotators.md. Needs only
Python."""
import json
import sys
from pathlib import Path

from draw_edit import Log, line, save, short, text

LINES = {
    "saved": ("durable", "#009e73", "8 4"),
    "still": ("others see it, camera at rest", "#0072b2", ""),
    "turning": ("others see it, camera turning", "#d55e00", "2 3"),
}
LEFT, RIGHT, TOP, BOTTOM = 60, 620, 50, 300


def draw(data, path):
    run, found = data["run"], {
        name: rows
        for name, rows in data["histogram"].items()
        if rows and sum(row["count"] for row in rows)
    }
    x = Log([row["ms"] for rows in found.values() for row in rows], LEFT, RIGHT)
    y = lambda share: BOTTOM - share * (BOTTOM - TOP)
    body = [
        text(
            10,
            20,
            f"{run['people']} people paint one layer for {run['seconds']:.0f} s",
            "start",
            'font-weight="bold"',
        )
    ]
    for share in (0, 0.25, 0.5, 0.75, 0.95, 1):
        body += [
            line(LEFT, y(share), RIGHT, y(share), 'stroke="#ddd"'),
            text(LEFT - 6, y(share) + 4, f"{100 * share:.0f} %", "end"),
        ]
    for tick in x.ticks():
        body += [
            line(x(tick), TOP, x(tick), BOTTOM, 'stroke="#eee"'),
            text(x(tick), BOTTOM + 18, short(tick)),
        ]
    body.append(
        text((LEFT + RIGHT) / 2, BOTTOM + 38, "milliseconds since the stroke's message was sent")
    )
    at = LEFT
    for name, (title, color, dash) in ((n, each) for n, each in LINES.items() if n in found):
        total, sum_here, points = sum(row["count"] for row in found[name]), 0, []
        for row in found[name]:
            sum_here += row["count"]
            points.append(f"{x(row['ms']):.1f},{y(sum_here / total):.1f}")
        body.append(
            f'<polyline points="{" ".join(points)}" fill="none" stroke="{color}" stroke-width="2.2" stroke-dasharray="{dash}"/>'
        )
        body += [
            line(
                at,
                38,
                at + 28,
                38,
                f'stroke="{color}" stroke-width="2.2" stroke-dasharray="{dash}"',
            ),
            text(at + 34, 42, title, "start"),
        ]
        at += 60 + 6.8 * len(title)
    save(path, RIGHT + 60, BOTTOM + 50, body, "How soon strokes are seen and saved")


def table(data):
    latency = data["latency"]
    rows = (
        ("`applied` reaches the author", latency["stroke_to_applied"]),
        ("`saved` reaches the author: durable", latency["stroke_to_saved"]),
        ("the author's own pixels", latency["stroke_to_own_pixels"]),
        ("others' pixels, camera at rest", latency["stroke_to_others_pixels"]["still"]),
        ("others' pixels, camera turning", latency["stroke_to_others_pixels"]["turning"]),
    )
    out = [
        "| from a stroke's message to | counted | p50 ms | p95 ms | p99 ms | longest ms |",
        "|---|---|---|---|---|---|",
    ]
    out += [
        f"| {what} | {row['count']:,} | {row['ms_p50']:,.0f} | {row['ms_p95']:,.0f} | {row['ms_p99']:,.0f} | {row['ms_max']:,.0f} |"
        for what, row in rows
        if row["count"]
    ]
    return "\n".join(out)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    data = json.loads(source.read_text())
    draw(data, Path(sys.argv[2]) if len(sys.argv) == 3 else source.with_suffix(".svg"))
    print(table(data))


if __name__ == "__main__":
    main()
