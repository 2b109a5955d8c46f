// Painting on the unrolled picture of the pot: strokes, areas and the eraser, with mouse and finger,
// and lines and points of records.
// The server saves each of them as one edit, and the picture shows it, also across the cut.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { with_samples } from "../support/js/marks.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const base = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

const dialog = ({ page }) => page.locator("strata-rollout-dialog");
const radio = (who, name) => dialog(who).getByRole("radio", { name, exact: true });
const picture = (who) => dialog(who).locator("figure img");
const painted_mm2 = async () =>
  1e6 * (await server.json("GET", `${base}/layers/test/statistics`)).area_m2;
const edits = async () => (await server.json("GET", `${base}/layers/test/edits`)).total;
const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `unrolled_${name}.png`) });
};

/** Returns the parts of the painted pixels in the left, middle and right third of the picture. */
async function painted_thirds(who) {
  await dialog(who).locator('figure[aria-busy="false"]').waitFor();
  return picture(who).evaluate(async (img) => {
    await img.decode();
    const [width, height] = [img.naturalWidth, img.naturalHeight];
    const canvas = new OffscreenCanvas(width, height).getContext("2d");
    canvas.drawImage(img, 0, 0);
    const { data } = canvas.getImageData(0, 0, width, height);
    const thirds = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      const [red, green, blue, alpha] = data.slice(at, at + 4);
      if (alpha > 0 && Math.min(red, blue) > 60 && green < 0.4 * Math.min(red, blue))
        ++thirds[Math.floor((3 * ((at / 4) % width)) / width)];
    }
    return thirds;
  });
}
/** Waits until the picture shows a condition on its painted thirds. */
const shown = (who, is_so, what) =>
  wait_for(async () => {
    const thirds = await painted_thirds(who);
    return is_so(thirds) ? thirds : null;
  }, what);

/** Paints a dab on the left, which must be the only edit since `before`, and undoes it. */
async function paint_only_a_dab(who, before) {
  await drag(who, [0.15, 0.5]);
  // The page sends edits in the order of drawing, so an earlier one is already saved.
  const [, middle] = await shown(who, ([left]) => left > 0, "the dab");
  assert.equal(middle, 0);
  assert.equal(await edits(), before + 1);
  await dialog(who).getByRole("button", { name: words.model.undo, exact: true }).click();
  await shown(who, (thirds) => Math.max(...thirds) === 0, "a picture without paint");
}

/** Returns a place of the picture, as shares of its width and height, on the page. */
async function place(who, [x, y]) {
  await picture(who).scrollIntoViewIfNeeded();
  const box = await picture(who).boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}
async function drag(who, ...path) {
  const [from, ...rest] = path;
  await who.page.mouse.move(...(await place(who, from)));
  await who.page.mouse.down();
  for (const each of rest) await who.page.mouse.move(...(await place(who, each)), { steps: 8 });
  await who.page.mouse.up();
}

async function open(who) {
  await who.page.goto(`${server.url}/models/${id}`);
  await who.drawn();
  await open_tab(who.page, words, words.layers.title);
  await who.page.getByRole("button", { name: words.layers.select("Test"), exact: true }).click();
  await open_tab(who.page, words, words.view.title);
  await who.page
    .locator("strata-view-panel")
    .getByRole("button", { name: words.figures.unroll })
    .click();
  await dialog(who).locator('figure[aria-busy="false"] img').waitFor();
}

let ada, phone, server, id;

test.beforeAll(async () => {
  [ada, phone] = [await Browser.open(), await Browser.open(kPhone)];
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
  ({ id } = await server.json("PATCH", base, { scale_verified: true }));
  for (const who of [ada, phone]) await who.page.goto(server.link);
  await open(ada);
});

test("the shape of the fitted surface can be chosen", async () => {
  const fitted = dialog(ada).getByText(words.rollouts.general_cylinder(""), { exact: false });
  await dialog(ada).locator('select[name="shape"]').selectOption("general_cylinder");
  await fitted.waitFor();
  await dialog(ada).locator('figure[aria-busy="false"] img').waitFor();
  await shot(ada, "any_cross_section");
  await dialog(ada).locator('select[name="shape"]').selectOption("auto");
  await fitted.waitFor({ state: "detached" });
  await dialog(ada).locator('figure[aria-busy="false"] img').waitFor();
});

test("a stroke is one edit with the width on the object, and can be undone", async () => {
  await radio(ada, words.tools.brush).click();
  await dialog(ada).getByText(words.picture_tools.paints("Test", "Test")).waitFor();
  await dialog(ada).locator('[name="width"]').fill("12");
  const before = await edits();
  await drag(ada, [0.45, 0.5], [0.55, 0.5]);
  const [left, middle, right] = await shown(ada, ([, middle]) => middle > 0, "the stroke");
  assert.deepEqual([left, right], [0, 0]);
  assert.ok(middle > 100, `${middle} pixels`);
  assert.equal(await edits(), before + 1);
  const area = await painted_mm2();
  await dialog(ada).locator('[name="width"]').fill("24");
  await drag(ada, [0.45, 0.5], [0.55, 0.5]);
  await wait_for(async () => (await edits()) === before + 2, "the wider stroke");
  await wait_for(async () => (await painted_mm2()) > 1.5 * area, "a larger area");
  await shot(ada, "stroke");
  for (const left of [area, 0]) {
    await dialog(ada).getByRole("button", { name: words.model.undo, exact: true }).click();
    await wait_for(async () => Math.abs((await painted_mm2()) - left) < 1e-6, "the undo");
  }
  await shown(ada, (thirds) => Math.max(...thirds) === 0, "a picture without paint");
  await dialog(ada).getByRole("button", { name: words.model.redo, exact: true }).click();
  await shown(ada, ([, middle]) => middle > 0, "the stroke again");
  await dialog(ada).getByRole("button", { name: words.model.undo, exact: true }).click();
  await shown(ada, ([, middle]) => middle === 0, "a picture without paint");
});

test("a line and a point belong to a record, and are on the surface", async () => {
  const marks = await with_samples(server, base);
  await dialog(ada).locator('select[name="layer"]').selectOption("Samples");
  await radio(ada, words.tools.line).click();
  await drag(ada, [0.4, 0.5], [0.5, 0.55]);
  await wait_for(async () => (await marks("cracks")).length > 0, "the line");
  await radio(ada, words.tools.point).click();
  await drag(ada, [0.6, 0.5]);
  await wait_for(async () => (await marks("places")).length === 1, "the point");
  await dialog(ada).locator('figure[aria-busy="false"] img').waitFor();
  // The picture does not show them, so they stay over it.
  const drawn = dialog(ada).locator("strata-picture-canvas svg");
  await drawn.locator("polyline").waitFor();
  assert.equal(await drawn.locator("circle").count(), 1);
  await shot(ada, "line");
  const places = [...(await marks("cracks")), ...(await marks("places"))].flatMap(
    ({ coordinates }) => coordinates,
  );
  assert.ok(places.length >= 3);
  for (const place of places) {
    const { distance } = await server.json(
      "GET",
      `${base}/position?coords=POINT(${place.join(" ")})`,
    );
    assert.ok(distance < 0.01, `${distance} from the surface`);
  }
  const [[first], last] = [(await marks("cracks"))[0].coordinates, places.at(-2)];
  assert.ok(Math.abs(first[2] - last[2]) > 1, "the line goes down");
  await dialog(ada).getByRole("button", { name: words.model.undo, exact: true }).click();
  await wait_for(async () => (await marks("places")).length === 0, "the undone point");
  await wait_for(async () => (await drawn.locator("circle").count()) === 0, "no point");
  await dialog(ada).locator('select[name="layer"]').selectOption("Test");
  await radio(ada, words.tools.brush).click();
});

test("a wrong width stays at its field", async () => {
  await dialog(ada).locator('[name="width"]').fill("wide");
  await dialog(ada).getByText(words.picture_tools.wrong_width).waitFor();
  const before = await edits();
  await drag(ada, [0.4, 0.5], [0.6, 0.5]);
  await dialog(ada).locator('[name="width"]').fill("12");
  await paint_only_a_dab(ada, before);
});

test("Escape cancels a stroke and does not close the dialog", async () => {
  const before = await edits();
  await ada.page.mouse.move(...(await place(ada, [0.4, 0.5])));
  await ada.page.mouse.down();
  await ada.page.mouse.move(...(await place(ada, [0.5, 0.5])), { steps: 4 });
  await ada.page.keyboard.press("Escape");
  await ada.page.mouse.move(...(await place(ada, [0.6, 0.5])), { steps: 4 });
  await ada.page.mouse.up();
  await paint_only_a_dab(ada, before);
});

test("a stroke at one end of the picture continues at the other end", async () => {
  await drag(ada, [0.004, 0.4], [0.004, 0.6]);
  const [left, , right] = await shown(ada, ([left]) => left > 0, "the stroke");
  assert.ok(left > 50 && right > 50, `${left} pixels on the left, ${right} on the right`);
  await dialog(ada).getByRole("button", { name: words.model.undo, exact: true }).click();
  await shown(ada, (thirds) => Math.max(...thirds) === 0, "a picture without paint");
});

test("an area has clicked corners, and Escape discards it before it closes the dialog", async () => {
  await radio(ada, words.picture_tools.area).click();
  const corners = [
    [0.4, 0.4],
    [0.6, 0.4],
    [0.6, 0.6],
    [0.4, 0.6],
  ];
  const click = async (corner) => ada.page.mouse.click(...(await place(ada, corner)));
  const before = await edits();
  for (const corner of corners.slice(0, 2)) await click(corner);
  await ada.page.keyboard.press("Escape");
  await ada.page.keyboard.press("Enter");
  assert.ok(await dialog(ada).getByRole("dialog").isVisible());
  for (const corner of corners) await click(corner);
  await shot(ada, "corners");
  await click(corners[0]);
  const [, middle] = await shown(ada, ([, middle]) => middle > 0, "the area");
  assert.ok(middle > 1000, `${middle} pixels`);
  assert.equal(await edits(), before + 1);
});

test("the eraser removes an outline that was drawn in one go", async () => {
  await dialog(ada).getByRole("checkbox", { name: words.areas.erases, exact: true }).check();
  await drag(ada, [0.35, 0.35], [0.65, 0.35], [0.65, 0.65], [0.35, 0.65], [0.35, 0.4]);
  await shown(ada, (thirds) => Math.max(...thirds) === 0, "a picture without paint");
  assert.equal(await painted_mm2(), 0);
});

test("an enlarged picture has more pixels, and can be painted", async () => {
  await radio(ada, words.tools.brush).click();
  await dialog(ada).getByRole("checkbox", { name: words.areas.erases, exact: true }).uncheck();
  const width = () => picture(ada).evaluate((img) => img.naturalWidth);
  const before = await width();
  await radio(ada, "2 ×").click();
  await wait_for(async () => (await width()) > 1.9 * before, "a larger picture");
  const canvas = dialog(ada).locator("strata-picture-canvas");
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  await ada.page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await shown(ada, (thirds) => thirds[0] + thirds[1] > 20, "the dab");
  await shot(ada, "enlarged");
});

test("a finger paints on a phone", async () => {
  await open(phone);
  const before = await painted_mm2();
  await radio(phone, words.tools.brush).click();
  await dialog(phone).locator('[name="width"]').fill("20");
  await phone.page.touchscreen.tap(...(await place(phone, [0.7, 0.5])));
  await wait_for(async () => (await painted_mm2()) > before + 100, "the dab");
  await shot(phone, "phone");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [ada, phone]) who.assert_no_complaints([]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, phone]) await who?.close();
  await server?.remove();
});
