// Lines and points on the surface. The page creates columns for them. A crack is drawn by dragging
// and by clicks, and a sample by a click. The table shows their lengths, the 3D view shows the
// lines and points, and undo removes them. In the form of a record, users can remove a line and
// draw more lines.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, rgb } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const kCrack = "#ff00ff";
const kSample = "#00e0ff";

const base = "/models/demo-pot";
const L = `${base}/layers/damages`;
const button = (name) => page.getByRole("button", { name, exact: true });
const notice = (text) => page.locator("strata-notices").getByText(text).last().waitFor();
const row = (text) => panel.locator(".line", { hasText: text });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const record = (key) => server.json("GET", `${L}/records/${key}`);
const marks = async (key, column) => (await record(key)).values[column] ?? [];
const shows = (color, what) =>
  wait_for(async () => (await browser.count(rgb(color))) > 40, what, 150);
const hides = (color, what) =>
  wait_for(async () => (await browser.count(rgb(color))) === 0, what, 150);
const distance = (a, b) => Math.hypot(...a.map((value, axis) => value - b[axis]));
const length_of = ({ coordinates }) =>
  coordinates.slice(1).reduce((sum, place, at) => sum + distance(place, coordinates[at]), 0);
/** Returns the length of one of the page's pixels on the object, according to the scale bar. */
async function metres_per_pixel() {
  const { width } = await page.locator("strata-stage .scale i").boundingBox();
  return metres_of(await page.locator("strata-stage .scale").innerText()) / width;
}
async function click_at(x, y, count = 1) {
  const box = await browser.stage_box();
  await page.mouse.click(box.x + x * box.width, box.y + y * box.height, { clickCount: count });
}
function metres_of(text) {
  const [, number, unit] = /([\d.]+) (mm|cm|m)/.exec(text);
  return Number(number) * { mm: 0.001, cm: 0.01, m: 1 }[unit];
}
async function make_column(name, kind) {
  const dialog = page.locator("strata-column-dialog");
  await button(words.tables.more).click();
  await page.getByRole("menuitem", { name: words.tables.new_column }).click();
  await dialog.getByLabel(words.column_dialog.name).fill(name);
  await dialog.getByLabel(words.column_dialog.kind).selectOption(kind);
  await dialog.getByRole("button", { name: words.column_dialog.create }).click();
  await panel.getByRole("columnheader", { name }).waitFor();
}

let browser,
  page,
  server,
  panel,
  form,
  so_far,
  metres_per,
  by_clicks,
  others,
  kept,
  frame,
  draw,
  cracks;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  panel = page.locator("strata-table-panel");
  form = page.locator("strata-record-dialog");
  so_far = page.locator("strata-stage .length");
  await server.start();
  await server.json("POST", `${base}/layers`, {
    name: "Damages",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name", required: true, unique: true }],
    palette: {
      mode: "categorical",
      points: [
        { at: 1, color: kCrack },
        { at: 2, color: kSample },
      ],
    },
  });
  for (const name of ["North crack", "Sample A"])
    await server.json("POST", "/tables/damages/records", { values: { name } });
  for (const other of ["pieces", "cracks"])
    await server.json("PATCH", `${base}/layers/${other}`, { visible: false });
  metres_per = { mm: 0.001, cm: 0.01, m: 1 }[(await server.json("GET", base)).unit];

  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await button(words.layers.select("Damages")).click();
  await page.keyboard.press("t");
  await panel.getByText(words.tables.records(2)).waitFor();
});

test("the tools are there once the table has columns for them", async () => {
  assert.deepEqual(
    [await button(words.tools.line).count(), await button(words.tools.point).count()],
    [0, 0],
  );
  await make_column("Cracks", "line");
  await make_column("Samples", "point");
  await panel.getByRole("columnheader", { name: words.tables.length }).waitFor();
  await panel.getByRole("columnheader", { name: words.tables.points }).waitFor();
  await button(words.tools.line).click();
});

test("a drag across the pot is a line, as long as it looks, in the record's colour", async () => {
  await hides(kCrack, "nothing drawn yet");
  await browser.drag([
    [0.42, 0.57],
    [0.5, 0.55],
    [0.58, 0.57],
  ]);
  await notice(/drawn for “North crack”\./);
  await shows(kCrack, "the line on the pot");
  const [crack] = await marks(1, "cracks");
  const box = await browser.stage_box();
  const drawn_m = 2 * Math.hypot(0.08 * box.width, 0.02 * box.height) * (await metres_per_pixel());
  const length_m = length_of(crack) * metres_per;
  assert.ok(
    length_m > 0.75 * drawn_m && length_m < 1.6 * drawn_m,
    `${length_m} m where ${drawn_m} m were drawn`,
  );
  assert.ok(
    crack.coordinates.length > 3 && crack.coordinates.length < 200,
    `${crack.coordinates.length} places`,
  );
  assert.ok(Math.abs((await record(1)).length_m - length_m) < 1e-9);
  await wait_for(
    async () => /1 line · ([\d.]+ [mc]?m)[\s\S]*\1/.test(await row("North crack").innerText()),
    "the length beside the area",
  );
  await shot("mark-line");
});

test("what was drawn is taken back by the notice, and by keys", async () => {
  await page.locator("strata-notices").getByRole("button", { name: words.model.undo }).click();
  await hides(kCrack, "the line to be gone");
  assert.deepEqual(await marks(1, "cracks"), []);
  await page.keyboard.press("Control+Shift+Z");
  await shows(kCrack, "the line again");
  await page.keyboard.press("Control+Z");
  await hides(kCrack, "and gone");
});

test("clicks are its places; a double click ends it, Escape gives it up; how long it is so far stands at the pointer", async () => {
  await click_at(0.42, 0.56);
  await click_at(0.5, 0.6);
  await browser.point(0.52, 0.58);
  await so_far.waitFor();
  await page.keyboard.press("Escape");
  assert.equal(await so_far.count(), 0);
  await click_at(0.42, 0.56);
  await click_at(0.5, 0.6);
  await browser.point(0.52, 0.58);
  await so_far.waitFor();
  const short = metres_of(await so_far.innerText());
  await browser.point(0.56, 0.56);
  await wait_for(
    async () => metres_of(await so_far.innerText()) > short,
    "the length to grow with the line",
  );
  await shot("mark-line-by-clicks");
  await click_at(0.56, 0.56, 2);
  await shows(kCrack, "the line of clicks");
  [by_clicks, ...others] = await marks(1, "cracks");
  assert.deepEqual([others, await so_far.count()], [[], 0]);
});

test("and told while it is drawn what the line then has", async () => {
  await click_at(0.42, 0.56);
  await click_at(0.5, 0.6);
  await browser.point(0.56, 0.56);
  const made_m = length_of(by_clicks) * metres_per;
  await wait_for(
    async () => Math.abs(metres_of(await so_far.innerText()) / made_m - 1) < 0.02,
    `the length to be ${made_m} m`,
  );
  await page.keyboard.press("Escape");
});

test("where there is no surface there is no line, and a notice says so", async () => {
  await browser.drag([
    [0.02, 0.1],
    [0.1, 0.12],
  ]);
  await notice(words.comments.missed);
});

test("a click sets a point, for the record that is chosen", async () => {
  await row("Sample A").getByRole("rowheader").click();
  await button(words.tables.paint_with).click();
  await page.keyboard.press("s");
  await click_at(0.54, 0.66);
  await notice(words.marks.point_set("Sample A"));
  await button(words.tables.choose_none).click();
  await shows(kSample, "the point on the pot");
  await row("Sample A").getByText("1 point", { exact: true }).waitFor();
  await wait_for(
    async () => (await row("Sample A").getByRole("gridcell").last().innerText()).trim() === "1",
    "the number of points",
  );
  await shot("mark-point");
});

test("a record that has a line or a point alone is gone to, also after the page was loaded again", async () => {
  const view_of = async () =>
    new URL(page.url()).searchParams.toString() +
    (await page.locator("strata-stage .scale").innerText());
  const goes_to = async (name) => {
    await page.keyboard.press("v");
    await page.locator("strata-stage .surface").focus();
    await page.keyboard.press("Home");
    await row(name).getByRole("rowheader").click();
    const go = panel.getByRole("button", { name: words.tables.fly });
    await wait_for(
      async () => (await go.isEnabled()) && (await go.getAttribute("title")) === words.tables.fly,
      "the way there",
    );
    const before = await view_of();
    await go.click();
    await wait_for(async () => (await view_of()) !== before, "the camera to be there");
    await shot(`mark-gone-to-${name.split(" ")[0].toLowerCase()}`);
    await button(words.tables.choose_none).click();
  };
  await goes_to("Sample A");
  await page.reload();
  await browser.drawn();
  await button(words.layers.select("Damages")).click();
  if (!(await panel.count())) await page.keyboard.press("t");
  await goes_to("Sample A");
  await goes_to("North crack");
  const bare = await server.json("POST", "/tables/damages/records", {
    values: { name: "Nothing" },
  });
  await row("Nothing").getByRole("rowheader").click();
  await panel
    .getByRole("button", { name: words.tables.fly })
    .and(page.locator(`[title="${words.tables.nothing_here}"]`))
    .waitFor();
  await server.request("DELETE", `/tables/damages/records/${bare.key}`);
  await wait_for(async () => (await row("Nothing").count()) === 0, "the record to be gone");
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("Home");
});

test("a drag along the silhouette is one line on the surface that was begun", async () => {
  await row("North crack").getByRole("rowheader").click();
  await button(words.tables.paint_with).click();
  await button(words.tables.choose_none).click();
  await button(words.tools.line).click();
  kept = (await marks(1, "cracks")).length;
  let camera = null;
  page.on("request", (request) => {
    if (request.method() === "POST" && request.url().endsWith("/profile"))
      camera = request.postDataJSON().camera ?? camera;
  });
  await click_at(0.42, 0.56);
  await browser.point(0.46, 0.58);
  await wait_for(() => camera, "the camera of what is drawn");
  await page.keyboard.press("Escape");
  frame = await browser.stage_box();
  const scale = camera.width / frame.width;
  /** Returns the pot's edge in a row of the 3D view, in pixels of the page. */
  const edge_at = async (y) => {
    const path = [
      [1, y * scale],
      [camera.width / 2, y * scale],
    ];
    const { samples } = await server.json("POST", `${base}/profile`, { camera, path, layers: [] });
    const at = samples.findIndex(({ point }) => point.hit);
    return ((at / (samples.length - 1)) * (camera.width / 2 - 1) + 1) / scale;
  };
  const [top, bottom] = [0.5 * frame.height, 0.62 * frame.height];
  const way = [];
  for (let y = top; y <= bottom; y += 3)
    way.push([(await edge_at(y)) + 3 + 7 * Math.sin((y - top) / 6), y]);
  draw = async (points) => {
    await page.mouse.move(frame.x + points[0][0], frame.y + points[0][1]);
    await page.mouse.down();
    for (const [x, y] of points.slice(1))
      await page.mouse.move(frame.x + x, frame.y + y, { steps: 2 });
    await page.mouse.up();
  };
  await draw(way);
  await wait_for(async () => (await marks(1, "cracks")).length > kept, "the line along the edge");
  const along = (await marks(1, "cracks")).slice(kept);
  await shot("mark-along-the-edge");
  assert.equal(along.length, 1, `${along.length} lines of one drag`);
  assert.equal(
    await page
      .locator("strata-notices")
      .getByText(/was split into/)
      .count(),
    0,
  );
  const way_m =
    way.slice(1).reduce((sum, at, index) => sum + distance(at, way[index]), 0) *
    (await metres_per_pixel());
  const along_m = length_of(along[0]) * metres_per;
  assert.ok(
    along_m > 0.5 * way_m && along_m < 2.5 * way_m,
    `${along_m} m where ${way_m} m were drawn`,
  );
  // Between the clicked points the line follows the surface, which the camera sees at an angle. A
  // step may be long, but passes neither through the pot nor to surfaces behind it.
  const places = along[0].coordinates;
  const radius = ([x, y]) => Math.hypot(x, y) * metres_per; // z is the axis of the pot
  const steps = places.slice(1).map((place, at) => [places[at], place]);
  const longest = Math.max(...steps.map(([from, to]) => distance(from, to))) * metres_per;
  assert.ok(longest < 80 * (await metres_per_pixel()), `a step of ${longest} m`);
  const deepest = Math.max(
    ...steps.map(
      ([from, to]) =>
        (radius(from) + radius(to)) / 2 - radius([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2]),
    ),
  );
  assert.ok(deepest < 0.0015, `a step that leads ${deepest} m below the surface`);
  await page
    .locator("strata-notices")
    .getByRole("button", { name: words.model.undo })
    .last()
    .click();
  await wait_for(async () => (await marks(1, "cracks")).length === kept, "the line to be gone");
});

test("a line that crosses an edge for good is cut, says so, and is taken back as a whole", async () => {
  const middle = 0.5 * frame.width;
  await draw([
    [middle, 0.6 * frame.height],
    [middle, 0.45 * frame.height],
    [middle, 0.3 * frame.height],
    [middle, 0.24 * frame.height],
  ]);
  const cut = page.locator("strata-notices .notice", {
    hasText: /The line crossed an edge and was split into \d pieces\./,
  });
  await cut.waitFor();
  const pieces = (await marks(1, "cracks")).length - kept;
  assert.match(
    await cut.innerText(),
    new RegExp(`split into ${pieces} pieces[^]*drawn for “North crack”`),
  );
  await shot("mark-cut");
  await cut.getByRole("button", { name: words.model.undo }).click();
  await wait_for(
    async () => (await marks(1, "cracks")).length === kept,
    "all of its pieces to be gone",
  );
  await page.keyboard.press("v");
});

test("the form lists what the record has, and takes one out", async () => {
  await row("North crack").getByRole("rowheader").click();
  await button(words.tables.edit).click();
  cracks = form.getByRole("group", { name: "Cracks" });
  await cracks.getByRole("button", { name: /^Remove / }).waitFor();
  await shot("mark-form");
  await cracks.getByRole("button", { name: /^Remove / }).click();
  await button(words.save).click();
  await hides(kCrack, "the line to be gone");
  await wait_for(
    async () => !/ m/.test(await row("North crack").innerText()),
    "the length to be gone, too",
  );
});

test("and leads to drawing more, after it has kept what was written", async () => {
  await button(words.tables.edit).click();
  await form.locator("textarea").fill("Long crack");
  await cracks.getByRole("button", { name: words.marks.draw }).click();
  await wait_for(async () => (await form.count()) === 0, "the form to close");
  assert.equal(await button(words.tools.line).getAttribute("aria-pressed"), "true");
  await browser.drag([
    [0.54, 0.56],
    [0.62, 0.57],
  ]);
  await notice(/drawn for “Long crack”\./);
  await shows(kCrack, "the next line");
  await button(words.tables.choose_none).click();
  await page.keyboard.press("v");
  await shot("marks");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
