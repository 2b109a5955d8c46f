// Layers that are computed from the shape, and layers that are transferred from another scan, as a
// user makes them on the page.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const pictures = process.env.STRATA_TEST_OUTPUT;
const button = (name) => page.getByRole("button", { name, exact: true });
const base = "/models/demo-pot";

/** Saves a screenshot for people to check. The test does not compare it. */
async function keep_picture(name) {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: join(pictures, `shape-${name}.png`) });
}

/**
 * Returns a hill of `cells` × `cells` squares, 100 mm wide, as a PLY with an additional number at
 * each vertex.
 */
function hill(cells) {
  const at = Array.from({ length: cells + 1 }, (_, i) => (100 * i) / cells);
  const vertices = at.flatMap((y) =>
    at.map((x) => `${x} ${y} ${20 * Math.exp(-((x - 50) ** 2 + (y - 50) ** 2) / 600)} ${x / 100}`),
  );
  const faces = [];
  for (let y = 0; y < cells; ++y)
    for (let x = 0; x < cells; ++x) {
      const a = y * (cells + 1) + x;
      faces.push(`3 ${a} ${a + 1} ${a + cells + 2}`, `3 ${a} ${a + cells + 2} ${a + cells + 1}`);
    }
  const head = [
    "ply",
    "format ascii 1.0",
    `element vertex ${vertices.length}`,
    "property float x",
    "property float y",
    "property float z",
    "property float quality",
    `element face ${faces.length}`,
    "property list uchar int vertex_indices",
    "end_header",
  ];
  return [...head, ...vertices, ...faces, ""].join("\n");
}

async function import_hill(name, cells) {
  const started = await fetch(
    `${server.url}/api/v1/models?filename=${name}.ply&name=${name}&unit=mm`,
    {
      method: "POST",
      headers: {
        Authorization: `Bearer ${server.token}`,
        "Content-Type": "application/octet-stream",
      },
      body: hill(cells),
    },
  );
  assert.equal(started.status, 202, await started.clone().text());
  const { id } = await started.json();
  const job = await wait_for(async () => {
    const now = await server.json("GET", `/jobs/${id}`);
    return now.state === "done" || now.state === "failed" ? now : null;
  }, `the import of ${name}`);
  assert.equal(job.state, "done");
  await server.json("PATCH", `/models/${job.model}`, { scale_verified: true });
  return job.model;
}

async function start_computing(kind, fields = {}) {
  await button(words.layers.new).click();
  await page.getByRole("radio", { name: /From the shape/ }).click();
  await page.getByLabel(words.shape.kind).selectOption({ label: kind });
  for (const [label, value] of Object.entries(fields)) await page.getByLabel(label).fill(value);
}

let browser, page, server, now;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  await server.start();
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
});

test("a layer is computed from the shape", async () => {
  await start_computing("Curvature", { "Within a radius of": "0" });
  await button(words.layer_dialog.compute).click();
  await page.getByText(words.shape.bad_length).waitFor();
  await page.getByLabel(words.shape.lengths.radius.label).fill("4");
  await keep_picture("dialog");
  await button(words.layer_dialog.compute).click();
  await page.getByText(words.shape.started("Curvature")).waitFor();
  await button(words.layers.select("Curvature")).waitFor();
  const layer = await server.json("GET", `${base}/layers/curvature`);
  assert.equal(layer.unit, "1/mm");
  // the description shows that the layer is selected
  await page
    .getByText(/Quadric|quadric that best fits the surface within 4 mm/)
    .first()
    .waitFor();
  assert.equal(
    await page.getByRole("progressbar").count(),
    0,
    "the row of the work goes when it is done",
  );
  const statistics = await server.json("GET", `${base}/layers/curvature/statistics`);
  const model = await server.json("GET", base);
  assert.ok(
    Math.abs(statistics.area_m2 / model.area_m2 - 1) < 0.01,
    `${statistics.area_m2} of ${model.area_m2} m² have a curvature`,
  );
  await browser.settled();
  await keep_picture("curvature");
});

test("it is locked; unlocked, it can be taken back like a stroke", async () => {
  await button(words.layers.unlock_computed).first().click();
  await wait_for(
    async () => (await button(words.layers.unlock_computed).count()) === 0,
    "the layer to be unlocked",
  );
  await page.keyboard.press("b");
  await page.keyboard.press("Control+z");
  await wait_for(
    async () => (await server.json("GET", `${base}/layers/curvature/statistics`)).texels === 0,
    "the layer to be empty",
  );
});

test("long work shows how far it is, and is cancelled", async () => {
  await start_computing(words.shape.kinds.ambient_occlusion.title, {
    Name: "Never",
    [words.shape.lengths.distance.label]: "30",
    [words.shape.rays]: "7",
  });
  await button(words.layer_dialog.compute).click();
  await page.getByText(words.shape.bad_rays(16, 1024)).waitFor();
  await page.getByLabel(words.shape.rays).fill("128");
  // the highest resolution takes longest
  await page
    .getByRole("radiogroup", { name: words.layer_dialog.detail })
    .getByRole("radio")
    .last()
    .click();
  await button(words.layer_dialog.compute).click();
  await page.getByRole("progressbar", { name: "Never" }).waitFor();
  await button(words.layer_jobs.cancel("Never")).click();
  await page.getByRole("progressbar", { name: "Never" }).waitFor({ state: "detached" });
  assert.ok(
    !(await server.json("GET", `${base}/layers`)).layers.some(({ name }) => name === "Never"),
  );
});

test("the sun of a summer needs the latitude and the direction of north", async () => {
  const { latitude, north, from, to } = words.shape.sun;
  await start_computing(words.shape.kinds.sun_energy.title, { [latitude.label]: "91" });
  await button(words.layer_dialog.compute).click();
  await page.getByText(latitude.wrong).waitFor();
  await page.getByLabel(latitude.label).fill("37.9");
  await button(words.layer_dialog.compute).click();
  await page.getByText(/direction of north is not known/).waitFor();
  await page.getByLabel(north.label).fill("20");
  await page.getByLabel(from).selectOption({ label: "June" });
  await page.getByLabel(to).selectOption({ label: "August" });
  await keep_picture("sun-dialog");
  await button(words.layer_dialog.compute).click();
  await button(words.layers.select(words.shape.kinds.sun_energy.title)).waitFor();
  const layer = await server.json("GET", `${base}/layers/energy-of-the-sun`);
  assert.equal(layer.unit, "kWh/m²");
  const [edit] = await wait_for(async () => {
    const { edits } = await server.json("GET", `${base}/layers/energy-of-the-sun/edits`);
    return edits.length > 0 ? edits : null;
  }, "the edit of the layer");
  const { kind, latitude_deg, north_deg, from: first, to: last } = edit.recipe;
  assert.deepEqual(
    [kind, latitude_deg, north_deg, first, last],
    ["sun_energy", 37.9, 20, "06-01", "08-31"],
  );
  await browser.settled();
  await keep_picture("sun");
});

test("driving rain needs the wind rose, the wind and the rain", async () => {
  const { wind_shares, wind_speed_m_s } = words.shape.rain;
  const { title } = words.shape.kinds.driving_rain;
  await start_computing(title, { [wind_shares.label]: "1 2 3" });
  await button(words.layer_dialog.compute).click();
  await page.getByText(wind_shares.wrong).waitFor();
  await page.getByLabel(wind_shares.label).fill("10 8 6 8 14 28 18 8");
  await page.getByLabel(wind_speed_m_s.label).fill("4.5");
  await page.locator('input[name="rain_mm"]').fill("760");
  await page.locator('input[name="north"]').fill("20");
  await keep_picture("rain-dialog");
  await button(words.layer_dialog.compute).click();
  await button(words.layers.select(title)).waitFor();
  const layer = await server.json("GET", `${base}/layers/driving-rain`);
  assert.equal(layer.unit, "l/m²");
  const [edit] = await wait_for(async () => {
    const { edits } = await server.json("GET", `${base}/layers/driving-rain/edits`);
    return edits.length > 0 ? edits : null;
  }, "the edit of the layer");
  assert.deepEqual(edit.recipe.wind_shares, [10, 8, 6, 8, 14, 28, 18, 8]);
  assert.deepEqual([edit.recipe.rain_mm, edit.recipe.north_deg], [760, 20]);
  await browser.settled();
  await keep_picture("rain");
});

test("what cannot be computed says why", async () => {
  await start_computing("Distance to the edge");
  await button(words.layer_dialog.compute).click();
  await page.getByText(/This model is closed/).waitFor();
  await keep_picture("failed");
  await button(words.layer_jobs.dismiss("Distance to the edge")).click();
});

test("layers are brought over from another scan, with a report", async () => {
  const then = await import_hill("Then", 40);
  now = await import_hill("Now", 57);
  const made = await server.json("POST", `/models/${then}/layers`, {
    name: "Terraces",
    type: "u8",
    compute: { kind: "height" },
  });
  await wait_for(
    async () => (await server.json("GET", `/jobs/${made.id}`)).state === "done",
    "the terraces",
  );
  await page.goto(new URL("/projects/default", server.url).href);
  await page.getByRole("link", { name: /Now/ }).click();
  await browser.drawn();
  await button(words.layers.more).click();
  await page.getByRole("menuitem", { name: words.transfer.open }).click();
  await page.locator("strata-transfer-dialog select").selectOption({ label: "Then" });
  await page.getByRole("checkbox", { name: "Terraces" }).waitFor();
  await page.getByLabel(words.transfer.angle).fill("0");
  await button(words.transfer.start).click();
  await page.getByText(words.transfer.bad_angle).waitFor();
  await page.getByLabel(words.transfer.angle).fill("45");
  await keep_picture("transfer-dialog");
  await button(words.transfer.start).click();
  await page.getByText(/of this surface has a counterpart/).waitFor();
  const row = page.getByRole("row", { name: /Terraces/ });
  assert.match(await row.innerText(), /cm²\s+0 %/);
  await button(words.layers.select("Terraces")).waitFor();
  const [brought] = (await server.json("GET", `/models/${now}/layers/terraces/edits`)).edits;
  assert.equal(brought.recipe.max_angle, 45, JSON.stringify(brought));
  await browser.settled();
  await keep_picture("transferred");
});

test("numbers of the scan's file become a layer", async () => {
  await start_computing("Values from the scan's file");
  await button(words.layer_dialog.compute).click();
  await button(words.layers.select("quality")).waitFor();
  await browser.settled();
  await keep_picture("quality");
});

test("a table of numbers for the vertices of the scan is painted", async () => {
  const numbers = hill(57)
    .split("end_header\n")[1]
    .split("\n")
    .slice(0, 58 * 58)
    .map((line) => Number(line.split(" ")[3]) * 10);
  await button(words.layers.options("quality")).click();
  await page.getByRole("menuitem", { name: words.layers.unlock_computed }).click();
  await wait_for(
    async () => !(await server.json("GET", `/models/${now}/layers/quality`)).locked,
    "the layer to be unlocked",
  );
  await button(words.layers.options("quality")).click();
  await page.getByRole("menuitem", { name: words.layers.paint_file }).click();
  await page.locator("strata-map-dialog input[type=file]").setInputFiles({
    name: "tenfold.csv",
    mimeType: "text/csv",
    buffer: Buffer.from(numbers.join("\n")),
  });
  await page.getByText(words.maps.vertices_hint).waitFor();
  await button(words.maps.paint).click();
  await page.locator("strata-map-dialog").waitFor({ state: "detached" });
  const tenfold = await server.json("GET", `/models/${now}/layers/quality/statistics`);
  assert.ok(
    Math.abs(tenfold.max - 10) < 0.1 && tenfold.min >= 0,
    JSON.stringify({ ...tenfold, histogram: [] }),
  );

  browser.assert_no_complaints(["status of 422"]);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
