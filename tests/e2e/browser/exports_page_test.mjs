// The dialog for 3D models: a GLB file with the chosen layers in its texture and the classes of a
// layer as features, or an OBJ file of a part with fewer triangles, is made, saved and named.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const base = "/models/demo-pot";

const dialog = () => page.locator("strata-export-dialog");
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `exports_${name}.png`) });
};
const open = async () => {
  await open_tab(page, words, words.view.title);
  await page.getByRole("button", { name: words.model_export.open, exact: true }).click();
  await dialog().getByRole("dialog").waitFor();
};

/** Makes the file, and returns its name and its bytes. */
async function make_file() {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    dialog().getByRole("button", { name: words.export_dialog.make, exact: true }).click(),
  ]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

/** Makes the file, and returns its name and the JSON part of the GLB (glTF 2.0, section 4). */
async function make() {
  const { name, bytes } = await make_file();
  assert.equal(bytes.subarray(0, 4).toString("latin1"), "glTF");
  assert.equal(bytes.readUInt32LE(8), bytes.length);
  const length = bytes.readUInt32LE(12);
  return { name, json: JSON.parse(bytes.subarray(20, 20 + length).toString("utf8")) };
}

const triangles_of = ({ accessors, meshes }) =>
  accessors[meshes[0].primitives[0].indices].count / 3;
/** Waits until the dialog says that it has saved the file with this number of triangles. */
const saved = (name, triangles) =>
  dialog()
    .getByText(words.export_dialog.saved(name, words.home.triangles(triangles)))
    .waitFor();

let browser, page, server, classes, all;

test.beforeAll(async ({ server: started, desk }) => {
  [browser, page, server] = [desk, desk.page, started];
  await server.json("PATCH", base, { scale_verified: true });
  ({ triangles: all } = await server.json("GET", base));
  const { layers } = await server.json("GET", `${base}/layers`);
  classes = layers.find(({ palette }) => palette.mode === "categorical");
  await server.json("POST", `${base}/selections`, {
    name: "Damage",
    audience: "everyone",
    within: { where: "x > 0" },
  });
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
});

test("a file has the visible layers in its texture", async () => {
  await open();
  await shot("dialog");
  await dialog()
    .locator('select[name="size"]')
    .selectOption({ label: words.export_dialog.side(1024) });
  const { name, json } = await make();
  assert.match(name, /^demo-pot[\w.-]*\.glb$/);
  assert.equal(json.images[0].mimeType, "image/jpeg");
  assert.equal(json.extensions, undefined);
  assert.equal(triangles_of(json), all);
  await saved(name, all);
  await shot("saved");
});

test("a file has the classes of a layer as features", async () => {
  await dialog().locator('select[name="features"]').selectOption(String(classes.id));
  await dialog().getByRole("radio", { name: words.export_dialog.formats.png }).click();
  await dialog().locator('input[name="unlit"]').check();
  const { json } = await make();
  assert.equal(json.images[0].mimeType, "image/png");
  assert.ok(json.extensionsUsed.includes("KHR_materials_unlit"));
  const [ids] = json.meshes[0].primitives[0].extensions.EXT_mesh_features.featureIds;
  const [table] = json.extensions.EXT_structural_metadata.propertyTables;
  assert.equal(ids.featureCount, table.count);
  assert.ok(table.count > 0);
  await page.keyboard.press("Escape");
  await dialog().waitFor({ state: "detached" });
});

test("a file has fewer triangles", async () => {
  await open();
  const triangles = dialog().locator('select[name="triangles"]');
  const counts = await triangles.locator("option").evaluateAll((all) => all.map((o) => o.value));
  const most = Number(counts.at(-1));
  assert.ok(counts[0] === "" && most > 0 && most < all, `${counts} of ${all}`);
  await triangles.selectOption(String(most));
  const { name, json } = await make();
  const count = triangles_of(json);
  assert.ok(count <= most && count >= 0.9 * most, `${count} of ${most}`);
  await saved(name, count);
  await triangles.selectOption("");
});

test("an OBJ file has a saved selection, and no features", async () => {
  await dialog().getByRole("radio", { name: words.export_dialog.files.obj }).click();
  await dialog().locator('select[name="part"]').selectOption({ label: "Damage" });
  assert.ok(await dialog().locator('select[name="features"]').isDisabled());
  await shot("obj");
  const { name, bytes } = await make_file();
  assert.equal(name, "demo-pot.zip");
  const content = bytes.toString("latin1");
  for (const entry of ["demo-pot.obj", "demo-pot.mtl", "demo-pot.png"])
    assert.ok(content.startsWith("PK") && content.includes(entry), entry);
  const told = await dialog().getByText(name).textContent();
  const count = Number(/\((.*) triangles\)/.exec(told)[1].replaceAll(",", ""));
  assert.ok(count > 0 && count < all, `${told} of ${all}`);
  await page.keyboard.press("Escape");
  await dialog().waitFor({ state: "detached" });
});

test("the settings stay for the next file", async () => {
  await open();
  assert.notEqual(await dialog().locator('select[name="part"]').inputValue(), "");
  await dialog().getByRole("radio", { name: words.export_dialog.files.glb }).click();
  assert.equal(await dialog().locator('select[name="features"]').inputValue(), String(classes.id));
  await dialog().locator('select[name="features"]').selectOption("");
  await page.keyboard.press("Escape");
});

ends_well();

test.afterEach(({}, info) => attach_log(info, server));
