#!/usr/bin/env python3
"""draw_stream.py RESULT.json [OUT_DIR]: draws figures and tables of `strata-bench stream --json`.

Writes OUT_DIR/NAME-times.svg (from a camera and from a stroke to pixels, over the number of active
viewers, one panel for each link), NAME-rates.svg (frames per second of a viewer, and frames per
processor second of the server) and, if the peer was measured, NAME-peer.svg. NAME is the name of
the result without `.json`. Prints the tables of results/streaming.md as Markdown. Values are
medians of the runs of a case. Whiskers of times end at the 95th percentile, and whiskers of other
values end at the lowest and the highest run. Needs only Python."""
import json
import statistics
import sys
from pathlib import Path

from draw_edit import Log, line, save, short, text

# Measured values: title, color (Okabe and Ito), dash, path within a run, and actions of the
# viewers.
BOTH = "turn and paint"
TIMES = (
    ("camera → last byte", "#0072b2", "", ("camera_to_last_byte",), ("turn",)),
    ("camera → last byte, others paint", "#56b4e9", "8 4", ("camera_to_last_byte",), (BOTH,)),
    ("stroke → own pixels", "#d55e00", "", ("strokes", "to_own_pixels"), ("paint",)),
    (
        "stroke → others' pixels",
        "#009e73",
        "2 3",
        ("strokes", "to_others_pixels", "still"),
        ("paint",),
    ),
    (
        "stroke → who turns",
        "#cc79a7",
        "8 3 2 3",
        ("strokes", "to_others_pixels", "turning"),
        (BOTH,),
    ),
)
RATES = (
    (
        "turning: pictures a second of a viewer",
        "#0072b2",
        "",
        ("frames_per_s", "turning", "median"),
        "turn",
    ),
    (
        "painting: the same of a viewer",
        "#d55e00",
        "",
        ("frames_per_s", "painting", "median"),
        "paint",
    ),
    (
        "turning: pictures of a second of the server's processors",
        "#56b4e9",
        "8 4",
        ("frames_per_cpu_s",),
        "turn",
    ),
    (
        "painting: the same of a second of processors",
        "#e69f00",
        "2 3",
        ("frames_per_cpu_s",),
        "paint",
    ),
)
PANEL, LEFT, TOP, BOTTOM, LEGEND = 300, 62, 44, 290, 20


def values(row, *path):
    """Returns the values of all runs that have a value."""
    found = []
    for run in row["runs"]:
        for name in path:
            run = run.get(name) if isinstance(run, dict) else None
        if run is not None:
            found.append(run)
    return found


def middle(row, *path):
    found = values(row, *path)
    return statistics.median(found) if found else None


def cell(value, form="{:,.0f}"):
    return "" if value is None else form.format(value)


def with_spread(row, *path, form="{:,.1f}"):
    found = values(row, *path)
    if not found:
        return ""
    shown = form.format(statistics.median(found))
    low, high = form.format(min(found)), form.format(max(found))
    return shown if low == high else f"{shown} ({low}–{high})"


def times(row, *path):
    """p50 / p95 in milliseconds."""
    half = middle(row, *path, "ms_median")
    return "" if half is None else f"{half:,.0f} / {middle(row, *path, 'ms_p95'):,.0f}"


def rows_of(data, part):
    return [row for row in data["results"] if row["part"] == part]


def active_rows(data, link, hands):
    return sorted(
        (row for row in rows_of(data, "active") if row["link"] == link and row["hands"] == hands),
        key=lambda row: row["active"],
    )


def axes(body, y, x0, numbers, x, title):
    for tick in y.ticks():
        body.append(line(x0, y(tick), x0 + PANEL - 24, y(tick), 'stroke="#ddd"'))
        if x0 == LEFT:
            body.append(text(x0 - 6, y(tick) + 4, short(tick), "end"))
    body += [text(x(number), BOTTOM + 18, number) for number in numbers]
    body.append(text(x0 + (PANEL - 24) / 2, BOTTOM + 36, title))


def curve(body, points, color, dash):
    """Draws points (x, y, whisker's low and high y)."""
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y, _, _ in points)
    body.append(
        f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2" stroke-dasharray="{dash}"/>'
    )
    for x, y, low, high in points:
        body += [
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.8" fill="{color}"/>',
            line(x, low, x, high, f'stroke="{color}" stroke-opacity="0.6"'),
        ]


def legend(body, kinds):
    for number, (title, color, dash, *_) in enumerate(kinds):
        y = BOTTOM + 62 + LEGEND * number
        body += [
            line(
                LEFT,
                y - 4,
                LEFT + 28,
                y - 4,
                f'stroke="{color}" stroke-width="2" stroke-dasharray="{dash}"',
            ),
            text(LEFT + 34, y, title, "start"),
        ]


def draw(data, path, title, unit, kinds, points_of):
    """Draws a panel for each link; `points_of` (row, kind) returns value, low and high, or None."""
    links = list(dict.fromkeys(row["link"] for row in rows_of(data, "active")))
    numbers = sorted({row["active"] for row in rows_of(data, "active")})
    found = {}
    for link in links:
        for kind in kinds:
            hands = kind[4] if isinstance(kind[4], tuple) else (kind[4],)
            rows = [row for each in hands for row in active_rows(data, link, each)]
            found[link, kind] = [
                (row["active"], *point) for row in rows if (point := points_of(row, kind))
            ]
    every = [
        value for points in found.values() for point in points for value in point[1:] if value > 0
    ]
    if not every:
        return
    y = Log(every, BOTTOM, TOP)
    width, height = LEFT + PANEL * len(links) + 10, BOTTOM + 70 + LEGEND * len(kinds)
    body = [text(10, 20, title, "start", 'font-weight="bold"'), text(10, TOP - 8, unit, "start")]
    for place, link in enumerate(links):
        x0 = LEFT + place * PANEL
        x = (
            lambda number, x0=x0: x0
            + 20
            + numbers.index(number) * (PANEL - 64) / max(1, len(numbers) - 1)
        )
        axes(body, y, x0, numbers, x, f"active viewers, {link}")
        for shift, kind in enumerate(kinds):
            points = [
                (x(number) + 2 * (shift - len(kinds) / 2), y(value), y(low), y(high))
                for number, value, low, high in found[link, kind]
                if value > 0
            ]
            if points:
                curve(body, points, *kind[1:3])
    legend(body, kinds)
    save(path, max(width, 560), height, body, title)


def time_point(row, kind):
    half, most = middle(row, *kind[3], "ms_median"), middle(row, *kind[3], "ms_p95")
    return half and (half, half, most)


def rate_point(row, kind):
    found = values(row, *kind[3])
    if not found or statistics.median(found) <= 0:
        return None  # not possible on a logarithmic axis; the table contains it
    return statistics.median(found), min(value for value in found if value > 0), max(found)


def peer_title(row):
    return f"{'ParaView' if row['program'] == 'paraview' else 'Strata'}, {row['layers'] or 'no'} layer{'s' if row['layers'] != 1 else ''}, {row['hands']}"


def draw_peer(data, path):
    rows = rows_of(data, "peer")
    if not any(row["program"] == "paraview" for row in rows):
        return
    most = max(max(values(row, "frames_per_cpu_s")) for row in rows)
    x = lambda value: 250 + value / most * 320
    body = [
        text(
            10,
            20,
            f"Pictures of a second of processors, one viewer, {data['window']}",
            "start",
            'font-weight="bold"',
        )
    ]
    for number, row in enumerate(rows):
        y, found = 44 + 30 * number, values(row, "frames_per_cpu_s")
        color = "#d55e00" if row["program"] == "paraview" else "#0072b2"
        body += [
            text(242, y + 13, peer_title(row), "end"),
            f'<rect x="250" y="{y}" width="{x(statistics.median(found)) - 250:.1f}" height="18" fill="{color}"/>',
            line(x(min(found)), y + 9, x(max(found)), y + 9, 'stroke="#222"'),
            text(x(max(found)) + 6, y + 13, f"{statistics.median(found):.1f}", "start"),
        ]
    save(path, 640, 60 + 30 * len(rows), body, "Pictures of a second of processors")


def table(title, heads, rows):
    if not rows:
        return []
    return [f"\n**{title}**\n", "| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"] + [
        "| " + " | ".join(row) + " |" for row in rows
    ]


def active_table(data):
    out = []
    for row in rows_of(data, "active"):
        server = middle(row, "cores", "server")
        out.append(
            [
                row["link"],
                str(row["active"]),
                row["hands"],
                cell(middle(row, "frames_per_s", "turning", "min"), "{:.1f}"),
                with_spread(row, "frames_per_s", "turning", "median"),
                with_spread(row, "frames_per_s", "painting", "median"),
                times(row, "camera_to_last_byte"),
                times(row, "last_camera_to_full_quality"),
                times(row, "strokes", "to_own_pixels"),
                times(row, "strokes", "to_others_pixels", "still"),
                times(row, "strokes", "to_others_pixels", "turning"),
                cell(middle(row, "strokes", "batches_per_s")),
                cell(middle(row, "bytes_per_s", "an_active_viewer", "median") / 1000),
                with_spread(row, "frames_per_cpu_s"),
                cell(server / row["active"], "{:.2f}"),
                cell(middle(row, "cores", "postgresql"), "{:.2f}"),
                cell(middle(row, "server_mib", "peak")),
            ]
        )
    return table(
        "Active viewers",
        [
            "link",
            "active",
            "action",
            "turning, frames/s: slowest viewer",
            "median viewer",
            "painting, frames/s",
            "camera → last byte, p50 / p95 ms",
            "last camera → full quality",
            "stroke → own pixels",
            "→ others', still",
            "→ others', turning",
            "batches/s",
            "KB/s a viewer",
            "frames a CPU second",
            "cores a viewer",
            "PostgreSQL cores",
            "MiB",
        ],
        out,
    )


def idle_table(data):
    out = []
    for row in rows_of(data, "idle"):
        out.append(
            [
                str(row["idle"]),
                row["idle_views"],
                f"{row['active']} {row['hands']}" if row["active"] else "nobody",
                cell(middle(row, "bytes_per_s", "all_idle")),
                cell(middle(row, "bytes_per_s", "all_idle_on_the_wire")),
                cell(middle(row, "frames_per_s", "idle", "median"), "{:.2f}"),
                with_spread(row, "cores", "server", form="{:.3f}"),
                times(row, "strokes", "to_others_pixels", "idle"),
                times(row, "strokes", "to_own_pixels"),
                times(row, "camera_to_last_byte"),
                cell(middle(row, "server_mib", "peak")),
            ]
        )
    return table(
        "Viewers at rest",
        [
            "idle",
            "views",
            "active",
            "bytes/s to all idle",
            "with WebSocket's",
            "frames/s an idle viewer",
            "server's cores",
            "stroke → idle viewers' pixels, p50 / p95 ms",
            "→ own pixels",
            "camera → last byte",
            "MiB",
        ],
        out,
    )


def stalled_table(data):
    out = []
    for row in rows_of(data, "stalled"):
        beside = next(
            (
                r
                for r in rows_of(data, "active")
                if (r["link"], r["active"], r["hands"])
                == (row["link"], row["active"], row["hands"])
            ),
            None,
        )
        for what, each in (("", beside), ("one stalled", row)):
            if each:
                out.append(
                    [
                        str(row["active"]),
                        row["hands"],
                        what or "all read",
                        with_spread(each, "frames_per_s", "turning", "median"),
                        with_spread(each, "frames_per_s", "painting", "median"),
                        times(each, "camera_to_last_byte"),
                        times(each, "strokes", "to_own_pixels"),
                        with_spread(each, "frames_per_cpu_s"),
                        cell(middle(each, "server_mib", "peak")),
                    ]
                )
    return table(
        "A viewer that reads nothing",
        [
            "active",
            "action",
            "",
            "turning, frames/s",
            "painting, frames/s",
            "camera → last byte, p50 / p95 ms",
            "stroke → own pixels",
            "frames a CPU second",
            "MiB",
        ],
        out,
    )


def peer_table(data):
    rows = rows_of(data, "peer")
    peer = next((row for row in rows if row["program"] == "paraview"), None)
    out = []
    for row in rows:
        path = "camera_to_picture" if row["program"] == "paraview" else "camera_to_last_byte"
        cells = [
            peer_title(row),
            with_spread(row, "frames_per_s")
            if row is peer
            else with_spread(row, "frames_per_s", "turning", "median"),
            times(row, path),
            with_spread(row, "frames_per_cpu_s"),
        ]
        if peer:
            cells += [
                ""
                if row is peer
                else f"**{middle(row, 'frames_per_cpu_s') / middle(peer, 'frames_per_cpu_s'):.1f}**",
                ""
                if row is peer
                else f"**{middle(row, path, 'ms_p95') / middle(peer, 'camera_to_picture', 'ms_p95'):.2f}**",
            ]
        out.append(cells)
    return table(
        f"One viewer compared with ParaView's web engine, {data['triangles']:,} triangles",
        ["", "frames/s", "camera → picture, p50 / p95 ms", "frames a CPU second"]
        + (["× ParaView's", "p95 / ParaView's"] if peer else []),
        out,
    )


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    out = Path(sys.argv[2]) if len(sys.argv) == 3 else source.parent
    data = json.loads(source.read_text())
    about = f"{data['model'].split('/')[-1]}, {data['triangles']:,} triangles, {data['layers']} layer{'s' if data['layers'] != 1 else ''}, {data['window']}"
    draw(
        data,
        out / f"{source.stem}-times.svg",
        f"From a camera and from a stroke to pixels: {about}",
        "milliseconds: medians, up to the 95th percentile",
        TIMES,
        time_point,
    )
    draw(
        data,
        out / f"{source.stem}-rates.svg",
        f"Pictures: {about}",
        "pictures a second",
        RATES,
        rate_point,
    )
    draw_peer(data, out / f"{source.stem}-peer.svg")
    print("\n".join(active_table(data) + idle_table(data) + stalled_table(data) + peer_table(data)))
    for missing in data.get("not_run", []):
        print(f"\nNot run: {missing['program']}: {missing['why']}")


if __name__ == "__main__":
    main()
