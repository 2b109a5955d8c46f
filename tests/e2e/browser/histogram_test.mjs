// The histogram of a measurement: keys and the pointer move the range of the colors, which then
// changes for all users.
import assert from "node:assert/strict";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const base = "/models/demo-pot";
const points = [
  { at: 0, color: "#440154ff" },
  { at: 1, color: "#fde725ff" },
];
const slider = (page, name) => page.getByRole("slider", { name });
const palette_of = async (server) => (await server.json("GET", `${base}/layers/wet`)).palette;
const fill = (server, where, value) =>
  server.json("POST", `${base}/layers/wet/edits`, { op: "fill", mode: "where", where, value });
const mean_of = (page) => page.locator("strata-statistics-dialog dd").first().textContent();

test.beforeAll(async ({ server, desk }) => {
  await server.json("POST", `${base}/layers`, {
    name: "Wet",
    type: "f32",
    unit: "%",
    resolution: 2048,
    palette: { mode: "linear", min: 0, max: 1, points },
  });
  for (const [value, where] of [
    [0.2, "true"],
    [0.5, "valid(cracks)"],
    [0.9, "pieces > 6"],
  ])
    await fill(server, where, value);
  const { page } = desk;
  await page.goto(server.link);
  await page.getByRole("link", { name: w.home.open("Demo pot") }).click();
  await desk.drawn();
  await page.getByRole("button", { name: w.layers.options("Wet") }).click();
  await page.getByRole("menuitem", { name: w.layers.statistics }).click();
});

test("keys move the lower end of the colours' range", async ({ server, page }) => {
  await slider(page, w.statistics.range_from).focus();
  for (let n = 0; n < 20; ++n) await page.keyboard.press("ArrowRight");
  await wait_for(async () => (await palette_of(server)).min > 0.2, "the lower limit");
});

test("the pointer moves the upper end", async ({ server, page }) => {
  const box = await slider(page, w.statistics.range_to).boundingBox();
  await page.mouse.move(box.x + box.width - 7, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  await wait_for(async () => (await palette_of(server)).max < 0.7, "the upper limit");
});

test("the colours stay, and their range is everyone's", async ({ server, page }) => {
  const moved = await palette_of(server);
  assert.deepEqual(
    moved.points.map(({ color }) => color),
    points.map(({ color }) => color),
  );
  assert.deepEqual(
    moved.points.map(({ at }) => at),
    [moved.min, moved.max],
  );
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, "histogram.png") });
});

test("what others paint is counted", async ({ server, page }) => {
  const mean = await mean_of(page);
  await fill(server, "true", 0.3);
  await fill(server, "valid(cracks)", 0.4);
  await wait_for(async () => (await mean_of(page)) !== mean, "what others paint to be counted");
});

test("classes of ratings have damage indices", async ({ server, page }) => {
  await server.json("POST", `${base}/layers`, {
    name: "Ratings",
    type: "u8",
    palette: {
      mode: "categorical",
      min: 0,
      max: 5,
      points: [0, 1, 5].map((at) => ({ at, color: "#440154ff", label: `Damage ${at}` })),
    },
  });
  for (const [value, where] of [
    [0, "true"],
    [1, "pieces > 3"],
    [5, "valid(cracks)"],
  ])
    await server.json("POST", `${base}/layers/ratings/edits`, {
      op: "fill",
      mode: "where",
      where,
      value,
    });
  const { keys, area_m2, mean, root_mean_square } = await server.json(
    "GET",
    `${base}/layers/ratings/statistics`,
  );
  const sum = (of) => keys.reduce((all, key) => all + of(key.key) * key.area_m2, 0) / area_m2;
  const linear = sum((rating) => rating);
  const progressive = Math.sqrt(sum((rating) => rating ** 2));
  assert.ok(linear > 0 && progressive > linear, `${linear}, ${progressive}`);
  assert.ok(Math.abs(mean - linear) < 1e-9, `${mean}, ${linear}`);
  assert.ok(Math.abs(root_mean_square - progressive) < 1e-9, `${root_mean_square}`);

  const dialog = page.locator("strata-statistics-dialog");
  await dialog.getByRole("button", { name: w.close, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
  await page.getByRole("button", { name: w.layers.options("Ratings") }).click();
  await page.getByRole("menuitem", { name: w.layers.statistics }).click();
  const shown = dialog.locator("dl");
  await shown.getByText(w.statistics.damage_index.progressive).waitFor();
  const numbers = await shown.locator("dd").allTextContents();
  assert.equal(numbers.length, 2);
  assert.ok(Math.abs(Number(numbers[0]) - linear) < 0.001, numbers[0]);
  assert.ok(Math.abs(Number(numbers[1]) - progressive) < 0.001, numbers[1]);
});

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well();
