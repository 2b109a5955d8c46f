// The selection on the page: wand and polygon select together, the border is changed, and the
// selection is saved, loaded after a reload, painted, renamed and deleted. A polygon follows the
// contour of the pot, and a lasso moves to it. Strokes inside and outside find a sherd.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const base = "/models/demo-pot";
const kUnits = { "mm²": 1e-6, "cm²": 1e-4, "m²": 1 };
const kName = "Front and handle side";

const button = (name) => page.getByRole("button", { name, exact: true });
const radio = (name) => page.getByRole("radio", { name, exact: true });
const selection = () => page.getByRole("group", { name: words.selection.title, exact: true });
const list = () => page.locator("strata-selections-dialog");
const row = (name) => list().locator("li", { hasText: name });
const saved = async () => (await server.json("GET", `${base}/selections`)).selections;
const painted_m2 = async () => (await server.json("GET", `${base}/layers/test/statistics`)).area_m2;
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `selections_${name}.png`) });
};

/** Returns the displayed area of the selection in m², or null while it is measured. */
async function shown_m2() {
  const text = await selection().getByRole("status").innerText();
  const found = /([\d.,]+)\s*(mm²|cm²|m²)/.exec(text);
  return found ? Number(found[1].replaceAll(",", "")) * kUnits[found[2]] : null;
}
/** Waits until the selection is measured and has another area than before. */
const other_than = (before, what) =>
  wait_for(async () => {
    const area = await shown_m2();
    return area !== null && area !== before ? area : null;
  }, what);

async function click(...points) {
  const box = await browser.stage_box();
  for (const [x, y] of points)
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
}
async function polygon(points) {
  await click(...points);
  await page.keyboard.press("Enter");
}
async function from_menu(item) {
  await selection().getByRole("button", { name: words.selection.more, exact: true }).click();
  await selection().getByRole("menuitem", { name: item, exact: true }).click();
}
async function change_border(mm, way) {
  await selection().getByRole("button", { name: words.selection.border.open, exact: true }).click();
  const controls = page.getByRole("dialog", { name: words.selection.border.title });
  await controls.getByLabel(words.selection.border.length).fill(mm);
  await controls.getByRole("button", { name: way, exact: true }).click();
  return controls;
}
/** Checks that nearly all paint is on one sherd, and undoes it. */
async function undo_on_one_sherd() {
  await browser.saved();
  const { layers, area_m2 } = await server.json("POST", `${base}/select`, {
    within: { where: "valid(test)" },
    layers: ["pieces"],
  });
  const most = Math.max(...layers.pieces.keys.map((each) => each.area_m2));
  assert.ok(most > 0.9 * area_m2, `only ${most} of ${area_m2} m² are on one sherd`);
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.equal(await painted_m2(), 0);
}
async function choose_layer() {
  await browser.drawn();
  await button(words.layers.select("Test")).click();
}

let browser, page, server, kept_m2;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  await server.start();
  const palette = { mode: "categorical", points: [{ at: 1, color: "#ff00ffff", label: "Test" }] };
  await server.json("POST", `${base}/layers`, {
    name: "Test",
    type: "u8",
    resolution: 2048,
    palette,
  });
  // otherwise the page asks to confirm the scale
  await server.json("PATCH", base, { scale_verified: true });
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await choose_layer();
});

test("the wand selects, and a polygon is added to it with the button", async () => {
  await page.keyboard.press("Shift+G");
  await radio(words.wand.ways.normal).click();
  await click([0.5, 0.5]);
  const first = await other_than(null, "the first part");
  await radio(words.selection.modes.add).click();
  await page.keyboard.press("a");
  assert.equal(await shown_m2(), first, "the selection changed with the tool");
  await polygon([
    [0.36, 0.52],
    [0.4, 0.52],
    [0.4, 0.6],
    [0.36, 0.6],
  ]);
  assert.ok((await other_than(first, "the added part")) > first);
  await shot("added");
});

test("a polygon with Alt is subtracted", async () => {
  const before = await shown_m2();
  await page.keyboard.down("Alt");
  await click([0.49, 0.48], [0.51, 0.48], [0.51, 0.52], [0.49, 0.52]);
  await page.keyboard.up("Alt");
  await page.keyboard.press("Enter");
  assert.ok((await other_than(before, "the subtracted part")) < before);
});

test("the border grows by a length, and a wrong length is refused", async () => {
  const before = await shown_m2();
  const controls = await change_border("0", words.selection.border.grow);
  await controls.getByRole("alert").getByText(words.selection.border.wrong).waitFor();
  await shot("border");
  await page.keyboard.press("Escape");
  await controls.waitFor({ state: "hidden" });
  assert.equal(await shown_m2(), before, "Escape in the controls changed the selection");
  await change_border("3", words.selection.border.grow);
  const grown = await other_than(before, "the grown selection");
  assert.ok(grown > before);
  await page.keyboard.press("Escape");
  await from_menu(words.selection.undo);
  assert.equal(await other_than(grown, "the undone change"), before);
  await from_menu(words.selection.redo);
  kept_m2 = await other_than(before, "the redone change");
  assert.equal(kept_m2, grown);
  assert.equal(await painted_m2(), 0, "a selection painted by itself");
});

test("its statistics show its size and the layer's values", async () => {
  await from_menu(words.selection.statistics);
  const dialog = page.locator("strata-selection-statistics");
  await dialog.getByText(words.selection.in_layer("Test")).waitFor();
  await shot("statistics");
  await dialog.getByRole("button", { name: words.close, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
});

test("it is saved for everyone", async () => {
  await from_menu(words.selection.save);
  const dialog = page.locator("strata-save-selection-dialog");
  await dialog.getByLabel(words.saved_selections.fields.name).fill(kName);
  await dialog.getByLabel(words.saved_selections.for_everyone).check();
  await shot("save");
  await dialog.getByRole("button", { name: words.save, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
  const [made] = await saved();
  assert.deepEqual([made.name, made.audience, made.within.grow_mm], [kName, "everyone", 3]);
  assert.deepEqual(
    made.within.parts.map(({ combine }) => combine ?? "add"),
    ["add", "add", "subtract"],
  );
});

test("after a reload it is loaded from the list, and has the same area", async () => {
  await page.reload();
  await choose_layer();
  await page.keyboard.press("Shift+G");
  await button(words.selection.saved).click();
  await row(kName).getByText(words.saved_selections.audiences.everyone).waitFor();
  await row(kName).locator("button.go").click();
  await list().waitFor({ state: "detached" });
  assert.equal(await other_than(null, "the loaded selection"), kept_m2);
  await page.locator("strata-stage .lit").waitFor();
  await shot("loaded");
});

test("it is painted as one edit", async () => {
  await selection().getByRole("button", { name: words.selection.fill, exact: true }).click();
  await selection().waitFor({ state: "detached" });
  const area_m2 = await painted_m2();
  assert.ok(Math.abs(area_m2 / kept_m2 - 1) < 0.02, `${area_m2} m² instead of ${kept_m2} m²`);
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.equal(await painted_m2(), 0);
});

/** Returns a function for the place of the pot's contour on the left, at a height in the view. */
async function left_contour() {
  await browser.rested();
  const box = await browser.stage_box();
  const { data, width } = await browser.picture(box);
  return (height) => {
    const row = Math.round(height * box.height);
    const pixel = (x) => [0, 1, 2].map((c) => data[4 * (row * width + x) + c]);
    const differs = (x) => pixel(x).some((value, c) => Math.abs(value - pixel(4)[c]) > 40);
    return [...Array(width).keys()].find(differs) / width;
  };
}

test("a polygon that snaps to edges follows the contour of the pot", async () => {
  await page.keyboard.press("Shift+A");
  const left = (await left_contour())(0.5);
  const outline = page.locator("strata-stage svg.over polygon");
  const points = () => outline.getAttribute("points");
  await click([left, 0.5]);
  await browser.point(left + 0.08, 0.32);
  await outline.waitFor();
  const count = async () => (await points()).split(" ").length;
  await wait_for(async () => (await count()) > 3, "a path along the contour");
  await shot("snapped");
  await click([left + 0.08, 0.32]);
  const fixed = await points();
  await page.keyboard.press("Shift+A");
  await browser.point(0.5, 0.45);
  await wait_for(async () => (await points()) !== fixed, "the segment to the pointer");
  await click([0.5, 0.45]);
  await page.keyboard.press("Enter");
  assert.ok((await other_than(null, "the area at the contour")) > 0);
  assert.equal(await page.locator("strata-stage svg.over circle").count(), 0);
  await page.keyboard.press("Escape");
  await selection().waitFor({ state: "detached" });
});

test("a lasso that snaps to edges moves to the contour of the pot", async () => {
  await page.keyboard.press("l");
  await page.keyboard.press("Shift+A");
  const contour = await left_contour();
  const left = contour(0.5);
  const box = await browser.stage_box();
  const outside = left - 8 / box.width;
  await browser.drag([
    [outside, 0.42],
    [outside, 0.58],
    [left + 0.1, 0.58],
    [left + 0.1, 0.42],
  ]);
  const outline = page.locator("strata-stage svg.over polygon").first();
  const points = (await outline.getAttribute("points"))
    .split(" ")
    .map((point) => point.split(",").map(Number));
  await shot("fitted");
  const onLeft = points.filter(
    ([x, y]) => x < left * box.width + 30 && Math.abs(y / box.height - 0.5) < 0.05,
  );
  assert.ok(onLeft.length > 3, `${onLeft.length} points are near the contour`);
  for (const [x, y] of onLeft) {
    const right = contour(y / box.height) * box.width;
    assert.ok(Math.abs(x - right) < 3, `${x}, ${y} instead of ${right}`);
  }
  assert.ok((await other_than(null, "the area of the lasso")) > 0);
  await page.keyboard.press("Shift+A");
  await page.keyboard.press("Escape");
  await selection().waitFor({ state: "detached" });
});

test("strokes inside and outside find a sherd, are undone, accepted and painted", async () => {
  await page.keyboard.press("Shift+L");
  await browser.rested();
  const next = (state) => selection().getByText(words.strokes.next[state], { exact: true });
  const strokes = page.locator("strata-stage svg.over polyline[stroke-linecap]");
  await next("none").waitFor();
  await browser.drag([
    [0.44, 0.58],
    [0.52, 0.6],
    [0.46, 0.7],
  ]);
  await next("no_outside").waitFor();
  await shot("strokes_inside");
  await button(words.strokes.give_up).click();
  await next("none").waitFor();
  assert.equal(await strokes.count(), 0, "a discarded stroke is still shown");
  await browser.drag([
    [0.44, 0.58],
    [0.52, 0.6],
    [0.46, 0.7],
  ]);
  await page.keyboard.down("Alt");
  await browser.drag([
    [0.28, 0.62],
    [0.34, 0.7],
  ]);
  await page.keyboard.up("Alt");
  const first = await other_than(null, "the area between the strokes");
  await radio(words.strokes.outside).click();
  await browser.drag([
    [0.58, 0.58],
    [0.64, 0.6],
  ]);
  const second = await other_than(first, "the area with the third stroke");
  assert.ok(second < first, `${second} is not less than ${first}`);
  await from_menu(words.strokes.undo);
  assert.equal(await other_than(second, "the area after the undone stroke"), first);
  await from_menu(words.strokes.redo);
  assert.equal(await other_than(first, "the area of the repeated stroke"), second);
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("Control+z");
  assert.equal(await other_than(second, "the area after the stroke was undone again"), first);
  await page.locator("strata-stage .lit").waitFor();
  await browser.close_notices();
  await shot("strokes_found");
  assert.equal(await button(words.selection.discard).count(), 0, "one cross for two things");
  await button(words.strokes.accept).click();
  await strokes.first().waitFor({ state: "detached" });
  assert.equal(await shown_m2(), first);
  assert.equal(await painted_m2(), 0, "strokes painted by themselves");
  await page.keyboard.press("Enter");
  await next("none").waitFor();
  await undo_on_one_sherd();
  await page.keyboard.press("l");
});

test("the brush of the wand selects a sherd across its rim, and Alt takes surface away", async () => {
  await page.keyboard.press("Shift+G");
  await page.keyboard.press("Shift+G"); // again: the brush
  assert.ok(await radio(words.wand.brush).isChecked());
  await radio(words.wand.ways.value).click();
  const { name } = await server.json("GET", `${base}/layers/pieces`);
  await page
    .locator("strata-wand-panel label.field", { hasText: words.wand.layer })
    .locator("select")
    .selectOption({ label: name });
  const width = page.locator("strata-wand-panel").getByLabel(`${words.brush.width}, px`);
  await width.fill("60");
  await width.press("Enter");
  await browser.rested();
  await browser.drag([
    [0.46, 0.6],
    [0.53, 0.6],
    [0.53, 0.68],
    [0.46, 0.68],
  ]);
  const first = await other_than(null, "the area under the brush");
  await page.locator("strata-stage .lit").waitFor();
  assert.ok(await radio(words.selection.modes.add).isChecked());
  await shot("brushed");
  // past the rim of the sherd: only a part of what the brush passes is added
  await browser.drag([
    [0.5, 0.64],
    [0.73, 0.66],
  ]);
  const second = await other_than(first, "the area of two strokes");
  assert.ok(second > first, `${second} is not more than ${first}`);
  await shot("brushed_to_the_rim");
  await page.keyboard.down("Alt");
  await browser.drag([
    [0.46, 0.6],
    [0.48, 0.6],
  ]);
  await page.keyboard.up("Alt");
  const third = await other_than(second, "the area after taking away");
  assert.ok(third < second, `${third} is not less than ${second}`);
  await from_menu(words.selection.undo);
  assert.equal(await other_than(third, "the area after undo"), second);
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("Enter");
  await selection().waitFor({ state: "detached" });
  await undo_on_one_sherd();
  await radio(words.wand.clicks).click();
  await page.keyboard.press("l");
});

test("on a layer of records, a selection becomes a record, and finds its records", async () => {
  await server.json("POST", `${base}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name", required: true }],
    palette: { mode: "categorical", points: [{ at: 1, color: "#2c6a63" }] },
  });
  await server.json("POST", "/tables/finds/records", { values: { name: "Elsewhere" } });
  await button(words.layers.select("Finds")).click();
  await page.keyboard.press("a");
  await polygon([
    [0.4, 0.55],
    [0.5, 0.55],
    [0.5, 0.65],
    [0.4, 0.65],
  ]);
  const area_m2 = await other_than(null, "the polygon");
  await from_menu(words.selection.new_record);
  const form = page.locator("strata-record-dialog");
  await form.getByLabel("Name").fill("Spiral");
  await shot("record");
  await form.getByRole("button", { name: words.save, exact: true }).click();
  await form.waitFor({ state: "detached" });
  await selection().waitFor({ state: "detached" });
  await browser.saved();
  const spiral = await wait_for(async () => {
    const { records } = await server.json("GET", `${base}/layers/finds/records`);
    const found = records.find(({ values }) => values.name === "Spiral");
    return found?.area_m2 > 0 ? found : null;
  }, "the painted record");
  assert.ok(Math.abs(spiral.area_m2 / area_m2 - 1) < 0.02, `${spiral.area_m2}, not ${area_m2} m²`);
  await polygon([
    [0.45, 0.6],
    [0.6, 0.6],
    [0.6, 0.7],
  ]);
  await other_than(null, "the second polygon");
  await from_menu(words.selection.show_records);
  const table = page.locator("strata-table-panel");
  await table.getByText("Spiral").waitFor();
  assert.equal(
    await table.getByRole("textbox", { name: words.tables.filter }).inputValue(),
    `key in (${spiral.key})`,
  );
  assert.equal(await table.getByText("Elsewhere").count(), 0);
  await shot("records");
  await page.keyboard.press("Escape");
  await table.getByRole("button", { name: words.tables.close }).click();
  await table.waitFor({ state: "detached" });
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("Escape");
  await selection().waitFor({ state: "detached" });
});

test("it is renamed and deleted in the list", async () => {
  await button(words.selection.saved).click();
  const options = (name) => row(name).getByRole("button", { name: words.layers.options(name) });
  await options(kName).click();
  await row(kName).getByRole("menuitem", { name: words.saved_selections.rename }).click();
  await list().getByLabel(words.saved_selections.fields.name).fill("Obverse");
  await list().getByRole("button", { name: words.save, exact: true }).click();
  await row("Obverse").waitFor();
  assert.equal((await saved())[0].name, "Obverse");
  await options("Obverse").click();
  await row("Obverse").getByRole("menuitem", { name: words.layers.delete }).click();
  await page
    .locator("strata-dialog")
    .getByRole("button", { name: words.delete, exact: true })
    .click();
  await list().getByText(words.saved_selections.none).waitFor();
  assert.deepEqual(await saved(), []);
});

test("the page has nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints([]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
