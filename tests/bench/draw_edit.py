#!/usr/bin/env python3
"""draw_edit.py RESULT.json [OUT_DIR]: draws the paper's figures from `strata-bench edit --json`.

Writes OUT_DIR/NAME-radius-MODEL.svg (milliseconds over the tool's radius, one panel for each
texture size), NAME-models.svg (all models at 70 and 200 px) and NAME-bytes.svg (bytes between CPU
and GPU for each edit). NAME is the name of the result without `.json`. Prints the tables of
results/edits.md and results/edits-h200.md as Markdown. Needs only Python.
"""
import json
import math
import sys
from html import escape
from pathlib import Path

# Colors that color-blind readers can distinguish (Okabe and Ito), and dashes for grayscale prints.
METHODS = {
    "tiles": ("Tiles (Strata)", "#0072b2", "", 3),
    "paper": ("Paper: TEA + TPA", "#d55e00", "", 1.6),
    "paper-compute": ("Paper, padding as compute", "#e69f00", "2 3", 1.6),
    "octree": ("Octree as published", "#009e73", "8 4", 1.6),
    "octree-fair": ("Octree, fair variant", "#cc79a7", "8 3 2 3", 1.6),
}
FONT = 'font-family="DejaVu Sans, Arial, sans-serif" font-size="12"'


LEGEND_WIDTH = 960


class Log:
    """A logarithmic axis of pixels."""

    def __init__(self, values, low_px, high_px):
        low, high = min(values), max(values)
        self.first, self.last = math.floor(math.log10(low)), math.ceil(math.log10(high * 1.0001))
        self.low_px, self.high_px = low_px, high_px

    def __call__(self, value):
        share = (math.log10(value) - self.first) / (self.last - self.first)
        return self.low_px + share * (self.high_px - self.low_px)

    def ticks(self):
        return [10.0**e for e in range(self.first, self.last + 1)]


def text(x, y, content, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{escape(str(content))}</text>'


def line(x0, y0, x1, y1, style='stroke="#bbb"'):
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" {style}/>'


def save(path, width, height, body, title):
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" {FONT} fill="#222">'
        f'<title>{escape(title)}</title><rect width="{width}" height="{height}" fill="#fff"/>'
        + "\n".join(body)
        + "</svg>\n"
    )
    print(f"wrote {path}", file=sys.stderr)


def short(value):
    if value >= 1:
        return f"{value:,.0f}"
    return f"{value:g}"


def legend(methods, x, y):
    out = []
    for method in methods:
        label, color, dash, width = METHODS[method]
        out.append(
            line(
                x,
                y - 4,
                x + 28,
                y - 4,
                f'stroke="{color}" stroke-width="{width}" stroke-dasharray="{dash}"',
            )
        )
        out.append(text(x + 34, y, label, "start"))
        x += 48 + 7.2 * len(label)
    return out


def present(rows):
    return [m for m in METHODS if any(r["method"] == m for r in rows)]


def draw_radius(rows, model, path):
    textures = sorted({r["texture"] for r in rows})
    panel, top, bottom, left = 300, 60, 330, 62
    panel = max(panel, (LEGEND_WIDTH - left) // len(textures))
    width, height = left + panel * len(textures) + 10, 400
    y = Log([r["ms_median"] for r in rows], bottom, top)
    radii = sorted({r["radius"] for r in rows})
    body = [
        text(
            10,
            20,
            f"Milliseconds an edit: {model}, {rows[0]['triangles']:,} triangles",
            "start",
            'font-weight="bold"',
        )
    ]
    body += legend(present(rows), 10, 42)
    for number, texture in enumerate(textures):
        x0 = left + number * panel
        x = lambda r: x0 + 14 + (r - radii[0]) / max(1, radii[-1] - radii[0]) * (panel - 50)
        for tick in y.ticks():
            body.append(line(x0, y(tick), x0 + panel - 22, y(tick), 'stroke="#ddd"'))
            if number == 0:
                body.append(text(x0 - 6, y(tick) + 4, short(tick), "end"))
        for radius in radii:
            body.append(text(x(radius), bottom + 18, radius))
        body.append(
            text(
                x0 + (panel - 22) / 2,
                bottom + 36,
                f"tool radius in pixels, {texture}² or depth {texture.bit_length() - 1}",
            )
        )
        for method in present(rows):
            points = sorted(
                (r["radius"], r["ms_median"])
                for r in rows
                if r["method"] == method and r["texture"] == texture
            )
            if not points:
                continue
            _, color, dash, stroke = METHODS[method]
            path_points = " ".join(f"{x(r):.1f},{y(ms):.1f}" for r, ms in points)
            body.append(
                f'<polyline points="{path_points}" fill="none" stroke="{color}" stroke-width="{stroke}" stroke-dasharray="{dash}"/>'
            )
            body += [
                f'<circle cx="{x(r):.1f}" cy="{y(ms):.1f}" r="2.6" fill="{color}"/>'
                for r, ms in points
            ]
    save(path, width, height, body, f"Milliseconds an edit of {model}")


def draw_bars(rows, models, value_of, groups, title, unit, path):
    """Draws one group of bars for each pair of radius and texture size. A group has a cluster for
    each model, and a cluster has a bar for each method. `value_of` returns the value of a row on
    the logarithmic axis."""
    methods = present(rows)
    bar, gap, top, bottom, left = 8, 12, 60, 300, 70
    cluster = bar * len(methods) + gap
    group_width = max(cluster * len(models) + 24, (LEGEND_WIDTH - left) // len(groups))
    width, height = left + group_width * len(groups) + 10, 390
    y = Log([value_of(r) for r in rows if value_of(r) > 0], bottom, top)
    body = [text(10, 20, title, "start", 'font-weight="bold"')] + legend(methods, 10, 42)
    for tick in y.ticks():
        body += [
            line(left, y(tick), width - 10, y(tick), 'stroke="#ddd"'),
            text(left - 6, y(tick) + 4, short(tick), "end"),
        ]
    body.append(text(left - 6, bottom + 18, unit, "end"))
    for g, (radius, texture) in enumerate(groups):
        for m, model in enumerate(models):
            x0 = left + 12 + g * group_width + m * cluster
            for i, method in enumerate(methods):
                found = [
                    r
                    for r in rows
                    if (r["method"], r["model"], r["texture"], r["radius"])
                    == (method, model, texture, radius)
                ]
                if not found or value_of(found[0]) <= 0:
                    continue
                high = y(value_of(found[0]))
                body.append(
                    f'<rect x="{x0 + i * bar}" y="{high:.1f}" width="{bar - 1}" height="{bottom - high:.1f}" fill="{METHODS[method][1]}"/>'
                )
            label_x, label_y = x0 + bar * len(methods) / 2, bottom + 14
            body.append(
                text(
                    label_x,
                    label_y,
                    model,
                    "end",
                    f'transform="rotate(-35 {label_x:.0f} {label_y})" font-size="11"',
                )
            )
        body.append(
            text(left + g * group_width + group_width / 2, bottom + 78, f"{texture}², {radius} px")
        )
    save(path, width, height, body, title)


def tables(data):
    rows, out = data["results"], []
    for model in dict.fromkeys(r["model"] for r in rows):
        of_model = [r for r in rows if r["model"] == model]
        methods = present(of_model)
        out.append(f"\n**{model}, {of_model[0]['triangles']:,} triangles**\n")
        others = [m for m in methods if m != "tiles"]
        out.append(
            "| texture | r px | texels | tiles ms | / floor | "
            + " | ".join(f"{m} ms (×)" for m in others)
            + " | surface texels that differ (off: tiles + paper) |"
        )
        out.append("|---" * (6 + len(others)) + "|")
        for texture in sorted({r["texture"] for r in of_model}):
            for radius in sorted({r["radius"] for r in of_model}):
                of = {
                    r["method"]: r
                    for r in of_model
                    if (r["texture"], r["radius"]) == (texture, radius)
                }
                if not of:
                    continue
                tiles = of.get("tiles", {})
                cells = [f"{texture}²", str(radius)]
                if tiles:
                    ratio = tiles["ms_median"] / tiles["floor_ms"] if tiles.get("floor_ms") else 0
                    cells += [f"{tiles['texels']:,}", f"{tiles['ms_median']:.2f}", f"{ratio:.1f}"]
                else:
                    cells += ["", "", ""]
                for method in others:
                    r = of.get(method)
                    factor = (
                        f" (**{r['ms_median'] / tiles['ms_median']:.1f}**)" if r and tiles else ""
                    )
                    cells.append(f"{r['ms_median']:.1f}{factor}" if r else "not run")
                cells.append(
                    f"{tiles['surface_texels_differ']} of {tiles['surface_texels']:,} ({tiles['tiles_off']} + {tiles['paper_off']})"
                    if "surface_texels" in tiles
                    else ""
                )
                out.append("| " + " | ".join(cells) + " |")
    if data.get("creation"):
        out.append("\n**Made before the first edit**\n")
        out.append(
            "| model | texture | method | seconds | model MB | structure MB | one layer MB |\n|---|---|---|---|---|---|---|"
        )
        for c in data["creation"]:
            if c["method"] in ("paper-compute", "octree-fair"):
                continue  # same structures as the base methods
            megabytes = " | ".join(
                f"{c[k] / 1e6:.1f}" for k in ("model_bytes", "structure_bytes", "layer_bytes")
            )
            out.append(
                f"| {c['model']} | {c['texture']}² | {c['method']} | {c['seconds']:.2f} | {megabytes} |"
            )
    moved = [r for r in rows if r["radius"] == 70]
    if moved:
        out.append("\n**Bytes between CPU and GPU for each edit, r = 70 px**\n")
        methods = present(moved)
        out.append(
            "| model | texture | "
            + " | ".join(methods)
            + " |\n"
            + "|---" * (2 + len(methods))
            + "|"
        )
        for model in dict.fromkeys(r["model"] for r in moved):
            for texture in sorted({r["texture"] for r in moved if r["model"] == model}):
                of = {
                    r["method"]: r["bytes_up"] + r["bytes_down"]
                    for r in moved
                    if (r["model"], r["texture"]) == (model, texture)
                }
                out.append(
                    f"| {model} | {texture}² | "
                    + " | ".join(f"{of[m]:,}" if m in of else "not run" for m in methods)
                    + " |"
                )
    for missing in data.get("not_run", []):
        out.append(f"\nNot run: {missing['model']}, {missing['texture']}²: {missing['why']}")
    return "\n".join(out)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    out = Path(sys.argv[2]) if len(sys.argv) == 3 else source.parent
    data = json.loads(source.read_text())
    rows = data["results"]
    if not rows:
        sys.exit(f"{source} holds no results")
    models = list(dict.fromkeys(r["model"] for r in rows))
    for model in models:
        draw_radius(
            [r for r in rows if r["model"] == model],
            model,
            out / f"{source.stem}-radius-{model.split(':')[0]}.svg",
        )
    textures = sorted({r["texture"] for r in rows})
    groups = [
        (radius, texture)
        for radius in (70, 200)
        for texture in textures
        if any((r["radius"], r["texture"]) == (radius, texture) for r in rows)
    ]
    if groups:
        chosen = [r for r in rows if (r["radius"], r["texture"]) in groups]
        draw_bars(
            chosen,
            models,
            lambda r: r["ms_median"],
            groups,
            "Milliseconds an edit, model by model",
            "ms",
            out / f"{source.stem}-models.svg",
        )
        draw_bars(
            [r for r in chosen if r["radius"] == groups[0][0]],
            models,
            lambda r: r["bytes_up"] + r["bytes_down"],
            [g for g in groups if g[0] == groups[0][0]],
            "Bytes between CPU and GPU an edit",
            "bytes",
            out / f"{source.stem}-bytes.svg",
        )
    print(tables(data))


if __name__ == "__main__":
    main()
