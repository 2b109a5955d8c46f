// Pictures and documents of records on the page: added in the form, visible in the table and on the
// card of the surface, removed, and restored by undo. The tests also add a folder of photos whose
// names match records.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Browser } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { encode_png } from "../../support/js/png.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const base = "/models/demo-pot";
const T = "/tables/finds";
const button = (name) => page.getByRole("button", { name, exact: true });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
/** Makes an image of one color, so images differ. */
function photo(name, red) {
  const path = join(folder, name);
  const data = Buffer.alloc(64 * 48 * 4);
  for (let at = 0; at < data.length; at += 4) data.set([red, 120, 200 - red / 2, 255], at);
  writeFileSync(path, encode_png({ width: 64, height: 48, data }));
  return path;
}
const files = async (key) =>
  (await server.json("GET", `${T}/records/${key}/attachments`)).attachments.map(
    ({ name, column }) => [name, column],
  );
const shown = (images) =>
  wait_for(
    () =>
      images.evaluateAll(
        (all) => all.length > 0 && all.every((image) => image.complete && image.naturalWidth > 0),
      ),
    "thumbnails to be drawn",
  );
let mouse = [0, 0];
/**
 * Rests the mouse at a point in shares of the stage. The pointer passes over other content on its
 * way.
 */
async function rest_at(x, y) {
  const stage = await browser.stage_box();
  mouse = [stage.x + x * stage.width, stage.y + y * stage.height];
  await page.mouse.move(...mouse, { steps: 3 });
}
async function lies_beside() {
  const [stage, box] = [await browser.stage_box(), await glance.boundingBox()];
  const [x, y] = mouse;
  assert.ok(
    box.x >= stage.x &&
      box.y >= stage.y &&
      box.x + box.width <= stage.x + stage.width &&
      box.y + box.height <= stage.y + stage.height,
    "within the stage",
  );
  assert.ok(
    x < box.x || x > box.x + box.width || y < box.y || y > box.y + box.height,
    "not over the pointer",
  );
}

let browser, page, server, folder, panel, form, photos, card, glance, asked;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  folder = mkdtempSync(join(tmpdir(), "strata-photos-"));
  panel = page.locator("strata-table-panel");
  form = page.locator("strata-record-dialog");
  photos = page.locator("strata-photos-dialog");
  card = page.locator("strata-record-card");

  glance = page.locator("strata-hover-card section");
  await server.start();
  await server.json("POST", `${base}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [
      { name: "Code", required: true, unique: true },
      { name: "Photos", kind: "picture" },
      { name: "Reports", kind: "document" },
      { name: "Depth", kind: "numeric", unit: "m" },
      { name: "Note", labels: { en: "Remark" } },
    ],
  });
  await server.json("POST", `${T}/records`, {
    values: {
      code: "SU 1",
      depth: 1.2,
      note: "Charcoal and burnt clay, cut by the later pit in the north",
    },
  });
  for (const code of ["SU 2", "SU 3"])
    await server.json("POST", `${T}/records`, { values: { code } });
  await server.json("POST", `${base}/layers/finds/edits`, {
    op: "fill",
    value: 1,
    mode: "where",
    where: "true",
  });

  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await button(words.layers.select("Finds")).click();
  await page.keyboard.press("t");
  await panel.getByText(words.tables.records(3)).waitFor();
});

test("files are added in the record's form, and sent when it is saved", async () => {
  await panel.getByRole("rowheader", { name: "1", exact: true }).click();
  await button(words.tables.edit).click();
  await form
    .getByRole("group", { name: "Photos" })
    .locator("input")
    .setInputFiles([photo("north.png", 230), photo("south.png", 30)]);
  await form.getByText("south.png").waitFor();
  assert.deepEqual(await files(1), [], "not yet");
  writeFileSync(join(folder, "report.pdf"), "%PDF-1.4\n% a report\n");
  await form
    .getByRole("group", { name: "Reports" })
    .locator("input")
    .setInputFiles(join(folder, "report.pdf"));
  await shot("files-waiting");
  await button(words.save).click();
  await wait_for(async () => (await form.count()) === 0, "the form to close");
  assert.deepEqual((await files(1)).sort(), [
    ["north.png", "photos"],
    ["report.pdf", "reports"],
    ["south.png", "photos"],
  ]);
});

test("the table shows pictures small, and how many files there are", async () => {
  await wait_for(
    async () => (await panel.locator("img.thumbnail").count()) === 2,
    "two thumbnails",
  );
  await shown(panel.locator("img.thumbnail"));
  await panel.getByText("1 file", { exact: true }).waitFor();
  await shot("files-in-table");
});

test("a file that is no picture is refused by its column, and the form stays", async () => {
  await panel.getByRole("rowheader", { name: "2", exact: true }).click();
  await button(words.tables.edit).click();
  await form
    .getByRole("group", { name: "Photos" })
    .locator("input")
    .setInputFiles(join(folder, "report.pdf"));
  await button(words.save).click();
  await form.getByRole("alert").getByText(/./).first().waitFor();
  await form.getByRole("group", { name: "Photos" }).getByText("report.pdf").waitFor();
  await shot("files-refused");
  await button(words.cancel).click();
  assert.deepEqual(await files(2), []);
});

test("a file that is taken away comes back by undo", async () => {
  await panel.getByRole("rowheader", { name: "1", exact: true }).click();
  await button(words.tables.edit).click();
  await shown(form.locator("figure img"));
  await button(words.files.remove("south.png")).click();
  await button(words.save).click();
  await wait_for(async () => (await files(1)).length === 2, "one file less");
  await button(words.tables.undo).click();
  await wait_for(async () => (await files(1)).length === 3, "the file to be back");
});

test("the legend has the records that there are", async () => {
  assert.deepEqual(
    await page.locator("strata-layer-panel .legend-classes").first().locator("li").allInnerTexts(),
    ["SU 1", "SU 2", "SU 3"],
  );
});

test("a click on the surface, while turning, shows the record with its picture", async () => {
  const box = await browser.stage_box();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await card.getByText("SU 1").first().waitFor();
  await shown(card.locator("img"));
  await shot("card-with-picture");
});

test("a mouse that rests on a record sees it at a glance, beside the pointer", async () => {
  await button(words.tables.card_close).click();
  await server.json("POST", `${base}/layers/finds/edits`, {
    op: "fill",
    value: 2,
    mode: "where",
    where: "x > 0",
  });
  asked = [];
  page.on(
    "request",
    (request) =>
      /\/tables\/\d+\/records\/\d+$/.test(request.url()) &&
      asked.push(request.url().split("/").at(-1)),
  );
  await rest_at(0.37, 0.57);
  await glance.getByText("SU 1", { exact: true }).waitFor();
  await shown(glance.locator("img"));
  assert.deepEqual(await glance.locator("dt").allInnerTexts(), ["Reports", "Depth", "Remark"]);
  assert.deepEqual((await glance.locator("dd").allInnerTexts()).slice(0, 2), ["1 file", "1.2 m"]);
  await shot("glance");
  await rest_at(0.38, 0.6);
  await lies_beside();
  assert.equal(await glance.evaluate((element) => getComputedStyle(element).pointerEvents), "none");
  assert.equal(await page.locator("strata-hover-card").getAttribute("aria-hidden"), "true");
});

test("until the mouse rests on another, something is pressed or the view moves", async () => {
  await rest_at(0.62, 0.62);
  await glance.getByText("SU 2", { exact: true }).waitFor();
  await page.keyboard.press("Escape");
  assert.equal(await glance.count(), 0);
  await rest_at(0.61, 0.6);
  await glance.getByText("SU 2", { exact: true }).waitFor();
  await page.keyboard.press("b");
  assert.equal(await glance.count(), 0);
  await page.keyboard.press("v");
  await rest_at(0.6, 0.62);
  await glance.waitFor();
  await page.mouse.down();
  assert.equal(await glance.count(), 0);
  await page.mouse.up();
  await card.getByText("SU 2").first().waitFor(); // the tap opens the whole card
  await button(words.tables.card_close).click();
  await rest_at(0.37, 0.57);
  await glance.getByText("SU 1", { exact: true }).waitFor();
  await rest_at(0.52, 0.66);
  await glance.getByText("SU 2", { exact: true }).waitFor();
  const before = await glance.elementHandle();
  await page.mouse.wheel(0, -240);
  await wait_for(
    () => before.evaluate((element) => !element.isConnected),
    "the glance to go as the view comes nearer",
  );
  for (let steps = 0; steps < 5; ++steps) await page.mouse.wheel(0, -240);
  for (const at of [
    [0.03, 0.04],
    [0.88, 0.04], // left of the view cube
    [0.03, 0.96],
    [0.97, 0.96],
  ]) {
    await rest_at(...at);
    await glance.getByText(at[0] > 0.5 ? "SU 2" : "SU 1", { exact: true }).waitFor();
    await lies_beside();
    await shot(`glance-${at.join("-")}`);
  }
  assert.equal(asked.filter((key) => key === "1").length, 1, "a record is asked for once");
  await page.keyboard.press("Home");
});

test("a folder of photos finds its records by their names", async () => {
  await button(words.tables.more).click();
  const chooser = page.waitForEvent("filechooser");
  await page.getByRole("menuitem", { name: words.files.add_menu }).click();
  await (
    await chooser
  ).setFiles([
    photo("SU-2_north_1.png", 10),
    photo("su 3_north_1.png", 60),
    photo("SU 9_north_1.png", 90),
    photo("IMG1.png", 99),
  ]);
  await photos.getByText(words.files.matched(2)).waitFor();
  await photos.getByText(words.files.reasons.record).waitFor();
  await photos.getByText(words.files.reasons.pattern).waitFor();
  await shot("photos-matched");
  await button(words.files.send(2)).click();
  await wait_for(async () => (await photos.count()) === 0, "the dialog to close");
  assert.deepEqual(
    [await files(2), await files(3)],
    [[["SU-2_north_1.png", "photos"]], [["su 3_north_1.png", "photos"]]],
  );
  await wait_for(
    async () => (await panel.locator("img.thumbnail").count()) === 4,
    "their thumbnails in the table",
  );
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints(["415", "422"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  rmSync(folder, { recursive: true, force: true });
  await browser?.close();
  await server?.remove();
});
