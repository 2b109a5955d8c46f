// Whole areas: the selection of polygon and lasso, connected fill, and fill with a condition. The
// file tests the page during drawing, the painted areas, and their undo.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kMagenta = "#ff00ffff"; // no part of the pot has this hue

const base = "/models/demo-pot";
const edits = async () => (await server.json("GET", `${base}/layers/test/edits?limit=1000`)).total;
const statistics = (layer) => server.json("GET", `${base}/layers/${layer}/statistics`);
const button = (name) => page.getByRole("button", { name, exact: true });
const radio = (name) => page.getByRole("radio", { name, exact: true });
const selection = () => page.getByRole("group", { name: words.selection.title });
const selected = () => selection().getByText(/m²/).first().waitFor();
const magenta = () => browser.count(rgb(kMagenta));
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};

/** Converts points from shares of the stage to pixels of the page. */
async function pixels(points) {
  const box = await browser.stage_box();
  return points.map(([x, y]) => [box.x + x * box.width, box.y + y * box.height]);
}
async function click(...points) {
  for (const [x, y] of await pixels(points)) await page.mouse.click(x, y);
}
async function area_px(points) {
  const corners = await pixels(points);
  const twice = corners.reduce((sum, [x, y], i) => {
    const [next_x, next_y] = corners[(i + 1) % corners.length];
    return sum + x * next_y - next_x * y;
  }, 0);
  return Math.abs(twice) / 2;
}
async function away() {
  await browser.point(0.99, 0.01);
}
async function painted(expected_px, what) {
  await browser.saved();
  await away();
  await wait_for(async () => (await magenta()) > expected_px * 0.5, what, 150);
  const pixels_painted = await magenta();
  console.log(`  ${what}: ${pixels_painted} pixels of ${Math.round(expected_px)}`);
  assert.ok(
    Math.abs(pixels_painted / expected_px - 1) < 0.1,
    `${what}: ${pixels_painted} pixels instead of ${expected_px}`,
  );
}
async function taken_back(what) {
  await page.keyboard.press("Control+z");
  await browser.saved();
  await wait_for(async () => (await magenta()) === 0, `${what} to be taken back`, 150);
}

let cameras = 0; // number of cameras that the page sent; a frame may show an older camera

let browser, page, server, corners, now;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  page.on("websocket", (socket) =>
    socket.on(
      "framesent",
      ({ payload }) => (cameras += JSON.parse(payload).op === "camera" ? 1 : 0),
    ),
  );
  await server.start();
  const palette = { mode: "categorical", points: [{ at: 1, color: kMagenta, label: "Test" }] };
  await server.json("POST", `${base}/layers`, {
    name: "Test",
    type: "u8",
    resolution: 4096,
    palette,
  });
  for (const { id, slug } of (await server.json("GET", `${base}/layers`)).layers) {
    await server.json("PATCH", `${base}/layers/${id}`, { visible: slug === "test" });
  }
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await button(words.layers.select("Test")).click();
});

test("a polygon is closed with Enter, which selects its inside; Enter again paints it", async () => {
  corners = [
    [0.44, 0.5],
    [0.56, 0.52],
    [0.54, 0.68],
    [0.46, 0.62],
  ];
  await page.keyboard.press("a");
  await click(...corners);
  await browser.point(0.5, 0.6);
  await page.locator("strata-stage svg.over polygon").waitFor();
  await shot("polygon");
  const held = cameras;
  await page.keyboard.press("Home");
  assert.equal(await edits(), 0, "painted before it was closed");
  await page.keyboard.press("Enter");
  assert.equal(cameras, held, "the camera moved while the outline was drawn");
  await selected();
  await page.locator("strata-stage .lit").waitFor();
  await shot("selection");
  assert.equal(await edits(), 0, "painted before it was confirmed");
  await page.keyboard.press("Enter");
  await page
    .getByText(/m² changed\./)
    .first()
    .waitFor();
  await selection().waitFor({ state: "hidden" });
  await painted(await area_px(corners), "the polygon");
  await taken_back("the polygon");
});

test("a click on the first corner closes it; Backspace takes a corner back, Escape all", async () => {
  await click(...corners, [0.1, 0.1]);
  await page.keyboard.press("Backspace");
  await click(corners[0]);
  await selection().getByRole("button", { name: words.selection.fill, exact: true }).click();
  await painted(await area_px(corners), "the polygon again");
  await taken_back("the polygon");
  const known = await edits();
  await click(...corners);
  await page.keyboard.press("Escape");
  await browser.saved();
  assert.equal(await page.locator("strata-stage svg.over polygon").count(), 0);
  assert.equal(await edits(), known, "an outline that was given up painted");
});

test("an outline is subtracted with Alt, a corner is moved, and Escape discards all", async () => {
  const known = await edits();
  const hole = [
    [0.48, 0.54],
    [0.52, 0.54],
    [0.5, 0.6],
  ];
  await click(...corners);
  await page.keyboard.press("Enter");
  await selected();
  await page.keyboard.down("Alt");
  await click(...hole);
  await page.keyboard.up("Alt");
  await page.keyboard.press("Enter");
  await selected();
  const moved = [0.58, 0.5];
  await browser.drag([corners[1], moved]);
  await selected();
  await shot("subtracted");
  assert.equal(await edits(), known, "a selection painted by itself");
  await page.keyboard.press("Enter");
  const [first, , ...rest] = corners;
  await painted(
    (await area_px([first, moved, ...rest])) - (await area_px(hole)),
    "the polygon with a hole and a moved corner",
  );
  await taken_back("the selection");
  await click(...corners);
  await page.keyboard.press("Enter");
  await selected();
  await page.keyboard.press("Escape");
  await selection().waitFor({ state: "hidden" });
  await browser.saved();
  assert.equal(await page.locator("strata-stage .lit").count(), 0);
});

test("a lasso paints what the drag went round", async () => {
  await page.keyboard.press("l");
  const round = Array.from({ length: 25 }, (_, i) => [
    0.5 + 0.06 * Math.cos(i / 4),
    0.58 + 0.09 * Math.sin(i / 4),
  ]);
  await browser.drag(round);
  await selected();
  await page.keyboard.press("Enter");
  await painted(await area_px(round.slice(0, 25)), "the lasso");
  await shot("lasso");
});

test("what is connected is erased by one click, and what is not stays", async () => {
  await page.keyboard.press("b");
  await browser.drag([
    [0.35, 0.6],
    [0.37, 0.6],
  ]);
  await browser.saved();
  await away();
  const both = (await statistics("test")).area_m2;
  await page.keyboard.press("g");
  await radio(words.areas.erases).click();
  await shot("bucket");
  await click([0.5, 0.58]);
  await browser.saved();
  const left = (await statistics("test")).area_m2;
  assert.ok(left > 0 && left < both * 0.5, `${left} m² of ${both} are left`);
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.equal((await statistics("test")).area_m2, both);
  await click([0.02, 0.02]);
  await page.getByText("There is no surface at this position").waitFor();
  await page.keyboard.press("b");
});

test("the wand selects similar surface, and its tolerance changes the selection", async () => {
  const before = (await statistics("test")).area_m2;
  await page.keyboard.press("Shift+G");
  await click([0.5, 0.5]);
  await selected();
  await shot("wand");
  const size = () => selection().getByRole("status").innerText();
  const first = await size();
  await selection().getByRole("slider").fill("120");
  await wait_for(async () => (await size()) !== first, "another selection");
  await selected();
  await button(words.selection.fill).click();
  await selection().waitFor({ state: "detached" });
  assert.ok((await statistics("test")).area_m2 > before);
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.equal((await statistics("test")).area_m2, before);
  await click([0.5, 0.5]);
  await selected();
  await page.keyboard.press("Escape");
  await selection().waitFor({ state: "detached" });
  await page.keyboard.press("b");
});

test("a condition over other layers; a wrong one says where it is wrong", async () => {
  await button(words.areas.where).click();
  const condition = page.getByLabel(words.areas.condition);
  await condition.fill("cracks >");
  await page.keyboard.press("Enter");
  await page
    .getByRole("alert")
    .getByText(/at character 9/)
    .waitFor();
  await shot("where");
  await condition.fill("valid(crakcs)");
  await button(words.expressions.use("cracks")).click();
  assert.equal(await condition.inputValue(), "valid(cracks)");
  await page.getByText(/^True on .+ of the surface\.$/).waitFor();
  await page.locator("strata-stage .lit").waitFor();
  await shot("where_lit");
  await condition.fill("");
  await button(words.expressions.insert).click();
  await page.getByRole("combobox", { name: words.expressions.search }).fill("hairline");
  await page.keyboard.press("Enter");
  assert.match(await condition.inputValue(), /^cracks = \d+$/);
  await button(words.expressions.insert).click();
  await condition.fill("not ");
  await condition.press("End");
  await condition.pressSequentially("cra");
  await page
    .getByRole("option", { name: /^cracks/ })
    .first()
    .waitFor();
  await condition.press("Tab");
  assert.equal(await condition.inputValue(), "not cracks");
  await condition.fill("valid(cracks)");
  await button(words.areas.apply).click();
  // the dialog closes after the edit is durable
  await page.getByRole("heading", { name: /where…/ }).waitFor({ state: "hidden" });
  const cracks = (await statistics("cracks")).area_m2;
  now = (await statistics("test")).area_m2;
  assert.ok(now > cracks * 0.9, `${now} m² for cracks of ${cracks} m²`);
});

test("the whole piece under a point is the whole pot, and that is one step back", async () => {
  await page.keyboard.press("g");
  await radio(words.areas.paints).click();
  await radio(words.areas.island).click();
  await click([0.5, 0.58]);
  await browser.saved();
  const whole = (await server.json("GET", base)).area_m2;
  await wait_for(async () => (await statistics("test")).area_m2 > whole * 0.999, "the whole pot");
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.ok(Math.abs((await statistics("test")).area_m2 / now - 1) < 1e-9);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints(["422"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
