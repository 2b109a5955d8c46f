#!/usr/bin/python3
"""Measures a site whose journal has grown for years.

    STRATA_BINARY=build/release/bin/strata tests/bench/growth.py [--edits N] [--models N] [--layers N]
        [--merge] [--json FILE]

Makes the models, layers and edits with SQL: copies of one imported model, whose layers share a
tenth of the edits in one large model. The edits are spread over two years and several people. Each
edit has two revisions, copies of a real stroke, which paint and remove the same texels in turn. As
in a real journal, every 64th revision of a tile has a key tile.
With --merge, the edits are batches of strokes (20 for each stroke), and the server merges the
strokes of the large model before the measurement. The script also prints the size of the journal
before and after the merge.

Measures the first request that opens the large model, a state a year ago, and the lists of the page
and of the API. Reads each list several times, and uses the median. Exits with 1 if a goal is
missed. Needs Debian's Python with pytest, because it uses the helpers of the end-to-end tests.
"""
import argparse
import datetime
import json
import os
import statistics
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.live_client import LiveClient
from support.machine import machine
from support.meshes import folded_grid
from support.strata_server import StrataServer, wait_for

OPEN_S, LIST_MS = 2.0, 200
TIMES = 5
PEOPLE = ("ada", "ben", "cleo", "dora", "emil", "fritz", "gina", "hugo")
BATCHES = 20  # of a stroke
KEY_TILE_EVERY = 64  # revisions of a tile, as in server/room/pipeline/edit_pipeline.cpp
MODEL = "sheet"
TABLES = ("edits", "tile_revisions", "tile_segments", "edit_batches")

# The columns of a table that the database does not generate.
COLUMNS = """SELECT string_agg(quote_ident(column_name), ', ' ORDER BY ordinal_position)
FROM information_schema.columns WHERE table_schema = 'public' AND table_name = '{table}'
AND is_identity = 'NO' AND is_generated = 'NEVER' AND column_name <> ALL ('{{{without}}}')"""


def copy_models(server, count):
    columns = server.sql(COLUMNS.format(table="all_models", without="name,slug"))
    server.sql(
        f"INSERT INTO all_models (name, slug, {columns}) SELECT 'Copy ' || n, 'copy-' || n, {columns} "
        f"FROM all_models, generate_series(2, {count}) n WHERE slug = '{MODEL}'"
    )


def copy_layers(server, count):
    """Gives each model about the same number of layers."""
    columns = server.sql(COLUMNS.format(table="all_layers", without="model_id,name,slug,sequence"))
    server.sql(
        f"INSERT INTO all_layers (model_id, name, slug, {columns}) "
        f"SELECT m.id, 'Copy ' || n, 'copy-' || n, {columns} FROM (SELECT * FROM all_layers ORDER BY id LIMIT 1) l, "
        f"generate_series(2, {count}) n JOIN (SELECT id, row_number() OVER (ORDER BY id) - 1 AS place, "
        "count(*) OVER () AS models FROM all_models) m ON m.place = n % m.models"
    )


def make_edits(server, count):
    """A tenth of the edits is in the large model. The trigger of the activity is off, because it
    would run for each statement with all rows: the script adds lines of the activity itself. The
    texels of a layer are painted after its odd revisions. The first layer has the real stroke too.
    """
    server.sql(
        f"""
        SET session_replication_role = replica;
        CREATE TEMP TABLE place AS SELECT m.id AS model_id, m.place, l.id AS layer_id,
          row_number() OVER (PARTITION BY m.id ORDER BY l.id) - 1 AS layer_place, count(*) OVER (PARTITION BY m.id) AS layers
          FROM (SELECT id, row_number() OVER (ORDER BY id) - 1 AS place FROM all_models) m JOIN all_layers l ON l.model_id = m.id;
        CREATE TEMP TABLE share AS SELECT model_id, sequence AS begin,
          CASE WHEN place = 0 THEN {count} / 10 ELSE {count} * 9 / 10 / greatest((SELECT count(*) FROM all_models) - 1, 1) END AS edits
          FROM (SELECT DISTINCT model_id, place FROM place) p JOIN all_models m ON m.id = p.model_id;
        CREATE TEMP TABLE made AS SELECT s.model_id, s.begin + n AS sequence, p.layer_id, n, s.edits,
            row_number() OVER (PARTITION BY p.layer_id ORDER BY n) + (p.layer_id = (SELECT min(id) FROM all_layers))::integer AS revision
          FROM share s CROSS JOIN LATERAL generate_series(1, s.edits) n
          JOIN place p ON p.model_id = s.model_id AND p.layer_place = (n / {2 * BATCHES}) % p.layers;
        INSERT INTO edits (model_id, sequence, id, layer_id, stroke, user_name, op, record, answer, time)
          SELECT model_id, sequence, gen_random_uuid(), layer_id,
            md5(model_id || ' ' || n / {BATCHES})::uuid, ('{{{",".join(PEOPLE)}}}'::text[])[1 + n / {BATCHES} % {len(PEOPLE)}], 'stroke',
            jsonb_build_object('op', 'stroke', 'value', 7, 'n', n % {BATCHES}, 'path', jsonb_build_array(jsonb_build_array(n % 640, 9))),
            jsonb_build_object('sequence', sequence, 'texels_changed', 1000, 'area_m2', 0.001),
            now() - interval '2 years' + interval '2 years' * n / edits - interval '1 hour'
          FROM made;
        INSERT INTO tile_revisions (layer_id, tile_y, tile_x, sequence, difference, key_tile)
          SELECT m.layer_id, r.tile_y, r.tile_x, m.sequence, r.difference,
            CASE WHEN m.revision % {KEY_TILE_EVERY} = 1 THEN r.key_tile END
          FROM made m CROSS JOIN stroke_of_layer r;
        UPDATE all_models m SET sequence = s.begin + s.edits FROM share s WHERE s.model_id = m.id;
        UPDATE all_layers l SET sequence = d.last FROM (SELECT layer_id, max(sequence) AS last FROM made GROUP BY layer_id) d
          WHERE d.layer_id = l.id;
        INSERT INTO activities (project_id, model_id, layer_id, subject, user_name, kind, op, begun, time, count, texels, area_m2, visibility)
          SELECT 1, e.model_id, e.layer_id, 'Copy', e.user_name, 'edit', 'stroke', e.time, e.time, 1, 1000, 0.001, 'public'
          FROM edits e WHERE e.sequence % {BATCHES} = 0;
        """
    )
    for table in (*TABLES, "activities", "all_models", "all_layers"):
        server.sql(f"VACUUM ANALYZE {table}")


def sizes(server):
    return {
        table: round(int(server.sql(f"SELECT pg_total_relation_size('{table}')")) / 1e6, 1)
        for table in TABLES
    }


def seconds(work):
    begun = time.monotonic()
    work()
    return time.monotonic() - begun


def merge(server):
    """Keeps the large model open until its strokes are merged."""
    newest = int(server.sql(f"SELECT sequence FROM all_models WHERE slug = '{MODEL}'"))

    def is_merged():
        # The server ends a connection that does not answer, so each question opens the model.
        with LiveClient(server, MODEL) as live:
            live.hello()
            merged = server.sql(
                f"SELECT coalesce(max(j.sequence), 0) FROM merged_journals j "
                f"JOIN all_models m ON m.id = j.model_id WHERE m.slug = '{MODEL}'"
            )
        return int(merged) >= newest

    begun = time.monotonic()
    wait_for(is_merged, "the strokes to be merged", 3600, 5)
    print(f"merged {newest} edits in {time.monotonic() - begun:.0f} s", flush=True)
    for table in TABLES:
        server.sql(f"VACUUM (FULL, ANALYZE) {table}")


def measure(server, camera):
    """Returns pairs of a name, and seconds or milliseconds with the goal."""
    model = f"/models/{MODEL}"
    layer = model + "/layers/cracks"
    year_ago = (
        datetime.datetime.now(datetime.timezone.utc) - datetime.timedelta(days=365)
    ).strftime("%Y-%m-%dT%H:%M:%SZ")
    found = []
    frame = {"camera": camera, "format": "png"}
    found.append(
        ("open the model", seconds(lambda: server.ok("POST", model + "/frame", frame)), OPEN_S)
    )
    for name, path in (
        ("statistics a year ago", f"{layer}/statistics?at={year_ago}"),
        ("texels a year ago", f"{layer}/texels.npy?at={year_ago}"),
    ):
        found.append((name, seconds(lambda path=path: server.ok("GET", path)), OPEN_S))
    for path in (
        "/projects",
        "/models",
        "/models?limit=100",
        model + "/layers",
        layer + "/edits?limit=100",
        layer + "/edits?limit=100&offset=300",
        layer + "/review",
        model + "/timeline",
        model + "/timeline/steps",
        model + "/undo",
        model + "/snapshots",
        model + "/comments",
        "/projects/default/activity",
        "/projects/default/bin",
    ):
        times = [seconds(lambda path=path: server.ok("GET", path)) for _ in range(TIMES)]
        found.append((path, statistics.median(times), LIST_MS / 1000))
    return found


def make_site(server, models, layers, edits):
    """Returns a camera of the large model, and the seconds that the edits took."""
    server.import_model(
        folded_grid(fold=0.001), MODEL + ".ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", f"/models/{MODEL}/layers", {"name": "Cracks", "type": "u8"})
    camera = camera_from(server.get(f"/models/{MODEL}").json(), (0, 0, 1), up=(0, 1, 0))
    stroke = {
        "op": "stroke",
        "value": 7,
        "camera": camera,
        "radius_px": 20,
        "path": [[300, 240]],
    }
    server.ok("POST", f"/models/{MODEL}/layers/cracks/edits", stroke)
    assert server.stop() == 0
    server.start()
    server.sql(
        "CREATE TABLE stroke_of_layer AS SELECT tile_y, tile_x, difference, key_tile FROM tile_revisions "
        "ORDER BY tile_y, tile_x LIMIT 2"
    )
    copy_models(server, models)
    copy_layers(server, layers)
    return camera, seconds(lambda: make_edits(server, edits))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--edits", type=int, default=1_000_000)
    parser.add_argument("--models", type=int, default=300)
    parser.add_argument("--layers", type=int, default=2000)
    parser.add_argument("--merge", action="store_true", help="let the server merge the strokes")
    parser.add_argument("--json", help="write the results to this file")
    options = parser.parse_args()
    os.environ["STRATA_MERGE_AFTER"] = "1" if options.merge else "0"
    with StrataServer() as server:
        camera, took = make_site(server, options.models, options.layers, options.edits)
        before = sizes(server)
        print(f"made {options.edits} edits in {took:.0f} s; MB: {before}", flush=True)
        after = None
        if options.merge:
            merge(server)
            after = sizes(server)
            print(f"MB after the merge of the large model: {after}", flush=True)
            assert server.stop() == 0
            server.start()
        found = measure(server, camera)
    print("| what | time | goal |\n|---|---|---|")
    for name, took, goal in found:
        print(f"| `{name}` | {took * 1000:.0f} ms | {goal * 1000:.0f} ms |")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(
                {
                    "machine": machine(),
                    "edits": options.edits,
                    "models": options.models,
                    "layers": options.layers,
                    "mb": before,
                    "mb_merged": after,
                    "seconds": {name: took for name, took, _ in found},
                },
                file,
                indent=1,
            )
    return int(any(took > goal for _, took, goal in found))


if __name__ == "__main__":
    sys.exit(main())
