// Maps from files on the page: a shapefile with names, a scanned map by its colors, and a raster of
// numbers. An orthophoto becomes a surface image, which is then renamed and moved. The file also
// tests the dialogs' texts about the files, and refusals.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { findings } from "../support/js/accessible.mjs";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kSupport = join(dirname(fileURLToPath(import.meta.url)), "..", "support");
const kMagenta = "#ff00ffff"; // no part of the pot has this hue
const file = (name) => join(folder, name);

const base = "/models/demo-pot";
const layer = (name) => server.json("GET", `${base}/layers/${name}`);
const statistics = (name) => server.json("GET", `${base}/layers/${name}/statistics`);
const button = (name) => page.getByRole("button", { name, exact: true });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
async function open_dialog(name) {
  await button(`Options for ${name}`).click();
  await page.getByRole("menuitem", { name: words.layers.paint_file }).click();
}
async function give(...names) {
  await dialog.locator("input[type=file]").setInputFiles(names.map(file));
}
async function seen_from_front() {
  await page.getByLabel(words.maps.along).selectOption({ value: "+y" });
}
async function paint() {
  await button(words.maps.paint).click();
  await page
    .getByText(/m² changed\./)
    .first()
    .waitFor();
  await dialog.waitFor({ state: "detached" });
}

/** Makes files that cover the front of the model, in x and z, seen along y. */
function make_files({ min, max }) {
  const [x, z, size] = [(min[0] + max[0]) / 2, (min[2] + max[2]) / 2, max[0] - min[0]];
  const code = `
import json, sys
from maps import *
from pictures import png
folder, x, z, size = sys.argv[1], *map(float, sys.argv[2:])
def put(name, content): open(folder + "/" + name, "wb").write(content)
s = size / 8
put("walls.shp", shp([[square(x - 2 * s, z, s)], [square(x + s, z, s)]]))
put("walls.dbf", dbf([("ID", "N", 6, ["7", "9"]), ("STATE", "C", 10, ["Salt", "Moss"])]))
paper = lambda u, v: (190, 40, 40) if 12 <= u < 28 and 20 <= v < 44 else (40, 60, 180) if 36 <= u < 52 and 20 <= v < 44 else (238, 232, 218)
put("plan.png", png(64, 64, paper))
place = lambda pixels: "%r\\n0\\n0\\n%r\\n%r\\n%r\\n" % (size / pixels, -size / pixels, x - size / 2 + size / pixels / 2, z + size / 2 - size / pixels / 2)
put("plan.pgw", place(64).encode())
put("depth.tif", tiff(16, 16, lambda u, v: 0.5 * u, nodata="-9999", scale=size / 16, origin=(x - size / 2, z + size / 2)))
put("utm.tif", tiff(16, 16, lambda u, v: 100 + u, kind="B", scale=size / 16, origin=(x - size / 2, z + size / 2), epsg=25830))
put("photo.png", png(32, 32, lambda u, v: (255, 0, 255)))
put("photo.pgw", place(32).encode())
`;
  execFileSync("python3", ["-c", code, folder, String(x), String(z), String(size)], {
    env: { ...process.env, PYTHONPATH: kSupport },
  });
  writeFileSync(file("values.csv"), "0.5\n0.25\n");
  writeFileSync(file("notes.doc"), "?");
}

let browser, page, server, folder, dialog;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  folder = mkdtempSync(join(tmpdir(), "strata-maps-"));
  dialog = page.locator("strata-map-dialog, strata-orthophoto-dialog");
  await server.start();
  make_files((await server.json("GET", base)).bounds);
  await server.json("POST", `${base}/layers`, {
    name: "States",
    type: "u8",
    resolution: 2048,
    palette: { mode: "categorical", points: [{ at: 4, color: kMagenta, label: "Moss" }] },
  });
  await server.json("POST", `${base}/layers`, { name: "Depth", type: "f32", resolution: 2048 });
  const look = await fetch(`${server.url}/api/v1${base}/looks?name=Infrared`, {
    method: "POST",
    headers: { Authorization: `Bearer ${server.token}` },
    body: readFileSync(file("plan.png")),
  });
  assert.equal(look.status, 201, await look.clone().text());
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = button(words.scale.later);
  if (await later.isVisible()) await later.click();
});

test("a shapefile tells its attributes, and names become classes", async () => {
  await open_dialog("States");
  await shot("maps-empty");
  await give("walls.shp", "walls.dbf");
  await page.getByText("2 areas · 2 attributes").waitFor();
  await page.getByLabel(words.maps.attribute).selectOption("STATE");
  await page.getByText(words.maps.samples("Salt, Moss")).waitFor();
  await page.getByText(words.maps.names_become).waitFor();
  await seen_from_front();
  await shot("maps-shapefile");
  await paint();
  const states = await statistics("states");
  assert.deepEqual(states.keys.map(({ key }) => key).sort(), [1, 4]);
  assert.deepEqual(
    (await layer("states")).palette.points.map(({ at, label }) => [at, label]),
    [
      [1, "Salt"],
      [4, "Moss"],
    ],
  );
  await browser.saved();
  await wait_for(
    async () => (await browser.count(rgb(kMagenta))) > 500,
    "the moss on the pot",
    150,
  );
});

test("numbers with the names of another attribute", async () => {
  await open_dialog("States");
  await give("walls.shp", "walls.dbf");
  await page.getByLabel(words.maps.attribute).selectOption("ID");
  await page.getByLabel(words.maps.names).selectOption("STATE");
  await seen_from_front();
  await paint();
  assert.deepEqual((await statistics("states")).keys.map(({ key }) => key).sort(), [7, 9]);
});

test("a scanned map: its colours are found, and get values", async () => {
  await open_dialog("States");
  await give("plan.png", "plan.pgw");
  await page.getByText(words.maps.world_known).waitFor();
  const values = page.locator("strata-map-colors input[type=text]");
  await wait_for(async () => (await values.count()) === 3, "the three colours");
  assert.deepEqual(await Promise.all([0, 1, 2].map((i) => values.nth(i).isDisabled())), [
    true,
    false,
    false,
  ]);
  await values.nth(1).fill("");
  await seen_from_front();
  await button(words.maps.paint).click();
  await page.getByRole("alert").getByText(words.maps.colors_wrong).waitFor();
  await values.nth(1).fill("4");
  await values.nth(2).fill("11");
  await shot("maps-colours");
  await paint();
  assert.deepEqual(
    (await statistics("states")).keys
      .map(({ key }) => key)
      .sort((a, b) => a - b)
      .filter((key) => key === 4 || key === 11),
    [4, 11],
  );
});

test("a raster of numbers lies where it says", async () => {
  await open_dialog("Depth");
  await give("depth.tif");
  await page.getByText("16 × 16 px · 1 band").waitFor();
  await page.getByText(words.maps.mode_hints.band).waitFor();
  await seen_from_front();
  await shot("maps-raster");
  await paint();
  const depth = await statistics("depth");
  assert.ok(
    depth.texels > 1000 && depth.min >= 0 && depth.max <= 7.5,
    JSON.stringify(depth).slice(0, 200),
  );
});

test("a map with a coordinate system on a model without one is asked about", async () => {
  await open_dialog("Depth");
  await give("utm.tif");
  await page.getByText("16 × 16 px · 1 band · EPSG:25830").waitFor();
  await seen_from_front();
  await button(words.maps.paint).click();
  const question = page.getByRole("alertdialog", {
    name: /The map is in EPSG:25830, but this model has no coordinate system/,
  });
  await question.waitFor();
  await wait_for(
    () =>
      question
        .getByRole("button", { name: words.maps.crs.no, exact: true })
        .evaluate((each) => each.matches(":focus")),
    "the keyboard in the question",
  );
  assert.ok(await button(words.maps.paint).isDisabled());
  assert.deepEqual(await findings(page), []);
  await shot("maps-coordinate-system");
  await question.getByRole("button", { name: words.maps.crs.no, exact: true }).click();
  await question.waitFor({ state: "detached" });
  assert.ok((await statistics("depth")).max <= 7.5, "nothing was painted");
  await button(words.maps.paint).click();
  await button(words.maps.crs.yes).click();
  await dialog.waitFor({ state: "detached" });
  assert.equal((await statistics("depth")).max, 115);
});

test("who may only paint adds no names to the legend, and paints those that are there", async () => {
  const annotator = (await server.add_person("ann", "annotator")).token;
  const as_annotator = (query) => {
    const form = new FormData();
    for (const name of ["walls.shp", "walls.dbf"])
      form.append("files", new Blob([readFileSync(file(name))]), name);
    return fetch(`${server.url}/api/v1${base}/layers/few/polygons?along=%2By&${query}`, {
      method: "POST",
      headers: { Authorization: `Bearer ${annotator}` },
      body: form,
    });
  };
  await server.json("POST", `${base}/layers`, {
    name: "Few",
    type: "u8",
    visible: false,
    palette: { mode: "categorical", points: [{ at: 1, color: kMagenta, label: "Salt" }] },
  });
  const refused = await as_annotator("attribute=STATE");
  assert.equal(refused.status, 403);
  assert.match((await refused.json()).detail, /does not contain: Moss/);
  assert.equal((await layer("few")).palette.points.length, 1);
  assert.equal((await statistics("few")).texels, 0);
  assert.equal((await as_annotator("attribute=ID")).status, 200);
});

test("what is no map, and numbers for vertices", async () => {
  await open_dialog("Depth");
  await give("notes.doc");
  await page.getByRole("alert").getByText(words.maps.unknown("notes.doc")).waitFor();
  await give("walls.dbf");
  await page.getByRole("alert").getByText("walls.dbf is not a map on its own").waitFor();
  await give("values.csv");
  await page.getByText(words.maps.vertices_hint).waitFor();
  await button(words.maps.paint).click();
  await page.getByRole("alert").waitFor();
  await shot("maps-vertices");
  await page.keyboard.press("Escape");
});

test("outlines of a layer are saved for a map", async () => {
  const saved = async (command) => {
    await button(words.layers.options("pieces")).click();
    if (command === "Save outlines as GeoJSON") await shot("maps-outlines");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("menuitem", { name: command, exact: true }).click(),
    ]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  };
  const pieces = (await server.json("GET", `${base}/layers`)).layers.find(
    ({ name }) => name === "pieces",
  );
  const json = await saved(words.rasters.save_outlines.geojson);
  const outlines = JSON.parse(json.bytes.toString());
  assert.deepEqual(
    [json.name, outlines.name],
    [`demo-pot-${pieces.slug}.geojson`, `demo-pot-${pieces.slug}`],
  );
  const painted = (await statistics(pieces.slug)).keys.map(({ key }) => key);
  const areas = outlines.features.filter(({ properties }) => properties.kind === "areas");
  assert.deepEqual(
    areas.map(({ properties }) => properties.key ?? properties.value),
    painted,
  );
  assert.ok(areas.some(({ geometry }) => geometry.coordinates.length > 0));
  const gpkg = await saved(words.rasters.save_outlines.gpkg);
  assert.deepEqual(
    [gpkg.name, gpkg.bytes.subarray(0, 15).toString()],
    [`demo-pot-${pieces.slug}.gpkg`, "SQLite format 3"],
  );
});

test("an orthophoto becomes a look", async () => {
  for (const { id } of (await server.json("GET", `${base}/layers`)).layers)
    await server.json("PATCH", `${base}/layers/${id}`, { visible: false });
  await open_tab(page, words, words.view.title);
  await button(words.view.look_more).click();
  await page.getByRole("menuitem", { name: words.orthophoto.open }).click();
  await give("photo.png", "photo.pgw");
  await page.getByLabel(words.orthophoto.name, { exact: true }).waitFor();
  assert.equal(await page.getByLabel(words.orthophoto.name, { exact: true }).inputValue(), "photo");
  await page.getByLabel(words.orthophoto.name, { exact: true }).fill("Ortho");
  await seen_from_front();
  await shot("maps-orthophoto");
  await button(words.orthophoto.add).click();
  await dialog.waitFor({ state: "detached" });
  await button(words.layers.hide("Ortho")).waitFor();
  await wait_for(
    async () => (await browser.count(rgb(kMagenta))) > 5000,
    "the orthophoto on the pot",
    300,
  );
  await shot("maps-look");
});

test("it is renamed and moved", async () => {
  const names = () => page.locator("strata-view-panel li .name").allTextContents();
  await button(words.layers.options("Ortho")).click();
  await page.getByRole("menuitem", { name: words.view.look_rename }).click();
  await page.getByLabel(words.view.look_name, { exact: true }).fill("Front 2024");
  await page.keyboard.press("Enter");
  await button(words.layers.options("Front 2024")).waitFor();
  assert.deepEqual(await names(), ["Front 2024", "Infrared"]);
  await button(words.layers.options("Front 2024")).click();
  await page.getByRole("menuitem", { name: words.layers.down }).click();
  await wait_for(async () => (await names())[1] === "Front 2024", "the look below the other");
  await wait_for(
    async () => (await server.json("GET", `${base}/looks`)).looks.at(-1).name === "Infrared",
    "the server to know",
  );
  await shot("maps-looks");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints(["422", "415"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  rmSync(folder, { recursive: true, force: true });
  await browser?.close();
  await server?.remove();
});
