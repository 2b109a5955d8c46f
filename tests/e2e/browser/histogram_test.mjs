// The histogram of a measurement: the colours' range is moved by keys and by the pointer, and is
// everyone's then.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/browser.mjs";
import { StrataServer, wait_for } from "../support/strata-server.mjs";

const browser = await Browser.open();
const { page } = browser;
const server = new StrataServer({ demo: true });
const base = "/models/demo-pot";
const slider = (name) => page.getByRole("slider", { name });
const palette = async () => (await server.json("GET", `${base}/layers/wet`)).palette;

try {
  await server.start();
  const points = [
    { at: 0, color: "#440154ff" },
    { at: 1, color: "#fde725ff" },
  ];
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
  ]) {
    await server.json("POST", `${base}/layers/wet/edits`, {
      op: "fill",
      mode: "where",
      where,
      value,
    });
  }
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  await page.getByRole("button", { name: "Options for Wet" }).click();
  await page.getByRole("menuitem", { name: "Areas…" }).click();

  await slider("Colours begin at").focus();
  for (let n = 0; n < 20; ++n) await page.keyboard.press("ArrowRight");
  await wait_for(async () => (await palette()).min > 0.2, "the lower limit");
  const box = await slider("Colours end at").boundingBox();
  await page.mouse.move(box.x + box.width - 7, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  await wait_for(async () => (await palette()).max < 0.7, "the upper limit");
  const moved = await palette();
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

  const mean = await page.locator("strata-statistics-dialog dd").first().textContent();
  await server.json("POST", `${base}/layers/wet/edits`, {
    op: "fill",
    mode: "where",
    where: "true",
    value: 0.3,
  });
  await server.json("POST", `${base}/layers/wet/edits`, {
    op: "fill",
    mode: "where",
    where: "valid(cracks)",
    value: 0.4,
  });
  await wait_for(
    async () => (await page.locator("strata-statistics-dialog dd").first().textContent()) !== mean,
    "what others paint to be counted",
  );

  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
} finally {
  await browser.close();
  await server.remove();
}
