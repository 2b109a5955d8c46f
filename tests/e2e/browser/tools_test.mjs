// Brush shapes on the page: made from a picture by file and by drop, selected by mouse and by keys,
// used for painting, renamed, and deleted by another user. The tests also cover the largest angle
// of the surfaces that a brush paints.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { encode_png } from "../support/js/png.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kOutput = process.env.STRATA_TEST_OUTPUT ?? "/tmp/strata-tools";
mkdirSync(kOutput, { recursive: true });
const shape = (name) => picker.getByRole("radio", { name, exact: true });
const shot = async (name, of = browser) =>
  writeFileSync(join(kOutput, `tools-${name}.png`), await of.settled());

/** Returns a dark shape on white paper. */
function drawing(inside) {
  const side = 200;
  const data = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; ++y)
    for (let x = 0; x < side; ++x) {
      const level = inside(((x + 0.5) * 2) / side - 1, 1 - ((y + 0.5) * 2) / side) ? 20 : 255;
      data.set([level, level, level, 255], (y * side + x) * 4);
    }
  return Buffer.from(encode_png({ width: side, height: side, data }));
}
const star = drawing(
  (x, y) => Math.hypot(x, y) < 0.45 + 0.4 * Math.cos(5 * (Math.atan2(y, x) - Math.PI / 2)),
);
const leaf = drawing(
  (x, y) => Math.hypot(x - 0.5, y + 0.5) < 1.15 && Math.hypot(x + 0.5, y - 0.5) < 1.15,
);

let browser, page, server, picker, dialog, newest, paint, id;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });

  picker = page.locator("strata-shape-picker");
  dialog = page.locator("strata-shape-dialog");
  await server.start();
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  await page.keyboard.press("b");
  newest = async () => {
    const layers = (await server.json("GET", "/models/demo-pot/layers")).layers;
    const edits = await Promise.all(
      layers.map(({ id }) => server.json("GET", `/models/demo-pot/layers/${id}/edits?limit=1`)),
    );
    return edits.flatMap(({ edits }) => edits).sort((a, b) => b.sequence - a.sequence)[0];
  };
  paint = async (points) => {
    const known = (await newest()).sequence;
    await browser.drag(points);
    return wait_for(async () => {
      const edit = await newest();
      return edit.sequence > known ? edit : null;
    }, "the stroke in the history");
  };
});

test("the brush is round at first", async () => {
  assert.equal(await shape("Round").getAttribute("aria-checked"), "true");
});

test("a picture becomes a shape: what of it is seen beforehand", async () => {
  await picker
    .locator("input[type=file]")
    .setInputFiles({ name: "five_pointed_star.png", mimeType: "image/png", buffer: star });
  await dialog.getByRole("radio", { name: words.shapes.parts.dark, checked: true }).waitFor();
  assert.equal(await dialog.getByLabel(words.shapes.name).inputValue(), "five pointed star");
  const painted_share = () =>
    dialog.locator("canvas").evaluate((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.filter((value, at) => at % 4 === 3 && value > 0).length / (data.length / 4);
    });
  const share = await painted_share();
  assert.ok(share > 0.15 && share < 0.4, String(share));
  await dialog.getByRole("radio", { name: words.shapes.parts.light }).click();
  assert.ok(Math.abs((await painted_share()) - (1 - share)) < 0.01);
  await dialog.getByRole("radio", { name: words.shapes.parts.dark }).click();
  await shot("dialog");
  await dialog.getByLabel(words.shapes.name).fill("Star");
  await dialog.getByRole("button", { name: words.shapes.add }).click();
  await dialog.waitFor({ state: "detached" });
  await wait_for(
    async () => (await shape("Star").getAttribute("aria-checked")) === "true",
    "the new shape to be chosen",
  );
});

test("the pointer shows the shape, and the stroke is of it", async () => {
  await page.getByLabel("Width, px").fill("150");
  await page.keyboard.press("Tab");
  await browser.point(0.5, 0.5);
  const cursor = page.locator("strata-stage .shape-cursor");
  assert.ok(Math.abs((await cursor.boundingBox()).width - 150) < 1);
  await shot("cursor");
  [{ id }] = (await server.json("GET", "/tools")).tools;
  const dab = await paint([[0.5, 0.5]]);
  assert.equal(dab.shape, id);
  assert.equal(dab.max_angle_deg, undefined);
  await shot("painted");
});

test("a file that is dropped becomes a shape, too", async () => {
  const transfer = await page.evaluateHandle(
    (bytes) => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(bytes)], "leaf.png", { type: "image/png" }));
      return data;
    },
    [...leaf],
  );
  await picker.dispatchEvent("dragover", { dataTransfer: transfer });
  await picker.dispatchEvent("drop", { dataTransfer: transfer });
  await dialog.getByRole("button", { name: words.shapes.add }).click();
  await shape("leaf").waitFor();
});

test("what is no picture is refused in plain words", async () => {
  await picker
    .locator("input[type=file]")
    .setInputFiles({ name: "notes.png", mimeType: "image/png", buffer: Buffer.from("hello") });
  await dialog.getByText(words.shapes.unreadable("notes.png")).waitFor();
  assert.equal(await dialog.getByRole("button", { name: words.shapes.add }).isDisabled(), true);
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "detached" });
});

test("keys choose among the shapes", async () => {
  await shape("leaf").focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await shape("Star").getAttribute("aria-checked"), "true");
  await page.keyboard.press("ArrowRight");
  assert.equal(await shape("Round").getAttribute("aria-checked"), "true");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await shape("Star").getAttribute("aria-checked"), "true");
});

test("a surface at a slant is skipped where that is wanted", async () => {
  const limit = page.getByLabel(words.brush.slant);
  await limit.check();
  await page.getByLabel("Largest angle between").fill("35");
  await page.keyboard.press("Tab");
  const facing = await paint([
    [0.45, 0.5],
    [0.62, 0.5],
  ]);
  assert.equal(facing.max_angle_deg, 35);
  await shot("slant");
  await page.getByLabel(words.areas.through).check();
  assert.equal(await limit.isDisabled(), true);
  assert.equal((await paint([[0.5, 0.55]])).max_angle_deg, undefined);
  await page.getByLabel(words.areas.through).uncheck();
  assert.equal(await limit.isChecked(), true);
  await limit.uncheck();
});

test("a shape is renamed", async () => {
  await picker.getByRole("button", { name: "Options for Star" }).click();
  await picker.getByRole("menuitem", { name: words.shapes.rename }).click();
  await page.getByRole("textbox", { name: words.shapes.name }).fill("Five points");
  await page.keyboard.press("Enter");
  await shape("Five points").waitFor();
});

test("somebody else deletes it: the brush is round, and what was painted stays", async () => {
  const before = await newest();
  await server.request("DELETE", `/tools/${id}`);
  await page.getByText("The shape “Five points” was deleted").waitFor();
  assert.equal(await shape("Round").getAttribute("aria-checked"), "true");
  assert.equal(await shape("Five points").count(), 0);
  assert.equal((await paint([[0.5, 0.6]])).shape, "disc");
  await page.keyboard.press("Control+z");
  await browser.saved();
  await page.keyboard.press("Control+z");
  await browser.saved();
  assert.ok((await newest()).sequence > before.sequence);
});

test("one's own deletion asks first", async () => {
  await shape("leaf").click();
  await picker.getByRole("button", { name: "Options for leaf" }).click();
  await picker.getByRole("menuitem", { name: words.delete }).click();
  await page.getByRole("button", { name: words.delete, exact: true }).click();
  await shape("leaf").waitFor({ state: "detached" });
  assert.deepEqual(await server.json("GET", "/tools"), { tools: [], total: 0 });
});

test("the help sheet describes the brush", async () => {
  await page.mouse.click((await browser.stage_box()).x + 10, (await browser.stage_box()).y + 10);
  await page.keyboard.press("?");
  await page.getByRole("term").filter({ hasText: words.help.brush_rows[1][0] }).waitFor();
  await shot("help");
  await page.keyboard.press("Escape");
});

test("on a phone the shapes are chosen by touch", async () => {
  const phone = await Browser.open({
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  try {
    await phone.sign_in(server, server.token);
    await phone.page.goto(`${server.url}/models/1`);
    await phone.drawn();
    await phone.page
      .getByRole("button", { name: /^Brush/ })
      .first()
      .tap();
    await phone.page.getByRole("button", { name: words.model.show_panel }).tap();
    const shapes = phone.page.locator("strata-shape-picker");
    await shapes
      .locator("input[type=file]")
      .setInputFiles({ name: "leaf.png", mimeType: "image/png", buffer: leaf });
    await phone.page.getByRole("button", { name: words.shapes.add }).tap();
    await shapes.getByRole("radio", { name: words.brush.square, exact: true }).tap();
    assert.equal(
      await shapes
        .getByRole("radio", { name: words.brush.square, exact: true })
        .getAttribute("aria-checked"),
      "true",
    );
    await shapes.getByRole("radio", { name: "leaf", exact: true }).tap();
    assert.equal(
      await shapes.getByRole("radio", { name: "leaf", exact: true }).getAttribute("aria-checked"),
      "true",
    );
    await shapes.scrollIntoViewIfNeeded();
    await shot("phone", phone);
    phone.assert_no_complaints();
  } finally {
    await phone.close();
  }

  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
