// Two users at one model: each sees the strokes of the other, undo affects only a user's own edits,
// and no stroke is lost when the server is killed.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { Browser, kOfLostServer, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kScan = join(process.env.STRATA_TEST_DATA ?? "", "statue_nefertiti_70k.ply");
const has_scan = existsSync(kScan);
const kEnough = 150; // minimum number of pixels of a visible stroke
const kFew = 12; // maximum number of pixels that match by chance

if (!has_scan) console.log(`the demo pot stands in for the scan: there is no ${kScan}`);

const appears = (who, color, what) =>
  wait_for(async () => (await who.count(color)) > kEnough, what, 150);
const goes = (who, color, what) => wait_for(async () => (await who.count(color)) < kFew, what, 150);
const choose_class = (who, name) => who.page.getByRole("radio", { name, exact: true }).click();

let anna, bea, server, id, bone, glass, path;

test.beforeAll(async () => {
  [anna, bea] = [await Browser.open(), await Browser.open()];
  server = new StrataServer({ demo: !has_scan });
  await server.start();
});

test("a scan is imported by the page's file input, which opens it", async () => {
  await anna.page.goto(server.link);
  await anna.page.getByRole("heading", { name: words.home.title, exact: true }).waitFor();
  if (has_scan) await anna.page.locator("input[type=file]").setInputFiles(kScan);
  else await anna.page.getByRole("link", { name: /Demo pot/ }).click();
  await anna.page.waitForURL(/\/models\/\d+/);
  await anna.drawn();
  id = Number(/\/models\/(\d+)/.exec(anna.page.url())[1]);
  if (has_scan) {
    await anna.page.getByText(/Is this object .*\?/).waitFor();
    await anna.page.getByRole("button", { name: words.scale.later }).click();
  }
});

test("a layer of classes is created in the dialog", async () => {
  await anna.page.getByRole("button", { name: words.layers.new }).click();
  await anna.page.getByRole("radio", { name: /^Class/ }).click();
  await anna.page.getByRole("button", { name: words.layer_dialog.create }).click();
  await anna.page.getByText(words.layer_dialog.name_missing).waitFor();
  await anna.page.getByLabel(words.layer_dialog.name, { exact: true }).fill("Finds");
  await anna.page.getByLabel(words.layer_dialog.class_label(1)).fill("Bone");
  await anna.page.getByRole("button", { name: words.layer_dialog.class_add }).click();
  await anna.page.getByLabel(words.layer_dialog.class_label(2)).fill("Glass");
  await anna.page.getByRole("button", { name: words.layer_dialog.create }).click();
  await choose_class(anna, "Bone");
  const layers = await server.json("GET", `/models/${id}/layers`);
  const layer = layers.layers.find((each) => each.slug === "finds");
  assert.deepEqual(
    layer.palette.points.slice(0, 2).map((point) => point.label),
    ["Bone", "Glass"],
  );
  [bone, glass] = layer.palette.points.map((point) => rgb(point.color));
  path = `/models/${id}/layers/${layer.id}`;
  // other layers could have pixels of the same color
  for (const other of layers.layers)
    if (other.id !== layer.id)
      await server.json("PATCH", `/models/${id}/layers/${other.id}`, { visible: false });
});

test("somebody else opens the same model and looks from another side", async () => {
  await bea.sign_in(server, await server.add_person("bea", "annotator"));
  await bea.page.goto(`${server.url}/models/${id}`);
  await bea.drawn();
  // Bea may paint, but may not create layers or set the model's size.
  assert.equal(await bea.page.getByRole("button", { name: words.layers.new }).count(), 0);
  assert.equal(await bea.page.getByRole("button", { name: words.model.check_size }).count(), 0);
  await bea.page.keyboard.press("v");
  for (let i = 0; i < 4; ++i) await bea.page.keyboard.press("ArrowLeft");
  await anna.page.getByLabel(/2 people have this model open/).waitFor();
  await bea.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await bea.page.keyboard.press("b");
  await choose_class(bea, "Glass");
  for (const who of [anna, bea]) {
    assert.ok((await who.count(bone)) < kFew, "the empty model has the colour of bone");
    assert.ok((await who.count(glass)) < kFew, "the empty model has the colour of glass");
  }
});

test("each sees the other's stroke", async () => {
  await anna.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await anna.saved();
  await appears(anna, bone, "anna's stroke on her own page");
  await appears(bea, bone, "anna's stroke on bea's page");
  await bea.drag([
    [0.46, 0.62],
    [0.56, 0.64],
  ]);
  await bea.saved();
  await appears(bea, glass, "bea's stroke on her own page");
  await appears(anna, glass, "bea's stroke on anna's page");
});

test("the value under the pointer", async () => {
  await anna.point(0.5, 0.507);
  await anna.page.locator("strata-value-readout").getByText("Bone").waitFor();
});

test("undo takes back one's own stroke only", async () => {
  await anna.page.keyboard.press("Control+z");
  await anna.saved();
  await goes(anna, bone, "anna's stroke to go");
  await goes(bea, bone, "anna's stroke to go from bea's page");
  assert.ok((await anna.count(glass)) > kEnough, "bea's stroke went, too");
  await anna.page.keyboard.press("Control+Shift+z");
  await anna.saved();
  await appears(bea, bone, "anna's stroke to come back");

  if (has_scan) {
    console.log("the size question: another unit keeps the paint");
    const before = await server.json("GET", `${path}/statistics`);
    const model = await server.json("GET", `/models/${id}`);
    await anna.page.getByRole("button", { name: words.model.check_size }).click();
    await anna.page.getByRole("radio", { name: words.scale.cm }).click();
    await anna.page.getByRole("radio", { name: words.scale.mm }).click();
    await anna.page.getByText(/Is this object .*[mc]m\?/).waitFor();
    await anna.page.getByRole("button", { name: words.scale.yes }).click();
    await wait_for(
      async () => (await server.json("GET", `/models/${id}`)).scale_verified,
      "the size to be confirmed",
    );
    const [after, now] = [
      await server.json("GET", `${path}/statistics`),
      await server.json("GET", `/models/${id}`),
    ];
    assert.equal(now.unit, "mm");
    assert.equal(after.texels, before.texels);
    const scale = { mm: 1e-3, cm: 1e-2, m: 1 }[model.unit] / 1e-3;
    assert.ok(
      Math.abs((after.area_m2 * scale * scale) / before.area_m2 - 1) < 1e-6,
      `${before.area_m2} became ${after.area_m2}`,
    );
    await appears(anna, bone, "the paint after the change");
  }
});

test("the server is killed in mid-stroke: the page says so, reconnects by itself and sends again", async () => {
  const history = async () => (await server.json("GET", `${path}/edits?limit=1000`)).edits;
  const edits_before = (await history()).length;
  await server.signal("SIGSTOP");
  await anna.drag([
    [0.44, 0.4],
    [0.5, 0.36],
    [0.56, 0.4],
  ]);
  await anna.page.locator('.saving:not([data-state="saved"])').waitFor();
  await server.signal("SIGKILL");
  await anna.page.locator('.saving[data-state="not-saved"]').waitFor();
  await bea.page.getByText("Connection lost").waitFor();
  await server.start();
  await anna.saved();
  const edits = await history();
  assert.ok(edits.length > edits_before, "what was painted is not in the history");
  assert.equal(
    new Set(edits.map((edit) => edit.id)).size,
    edits.length,
    "an edit is in the history twice",
  );
  await bea.page.getByText("Connection lost").waitFor({ state: "hidden" });
  await appears(bea, bone, "bea's page to show the model again");
  await anna.point(0.5, 0.36);
  await anna.page.locator("strata-value-readout").getByText("Bone").waitFor();
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [anna, bea]) who.assert_no_complaints(kOfLostServer);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await anna?.close();
  await bea?.close();
  await server?.remove();
});
