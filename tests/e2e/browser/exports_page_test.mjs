// The dialog for 3D models: a GLB file with the chosen layers in its texture and the classes of a
// layer as features is made, saved and named.
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

/** Makes the file, and returns its name and the JSON part of the GLB (glTF 2.0, section 4). */
async function make() {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    dialog().getByRole("button", { name: words.export_dialog.make, exact: true }).click(),
  ]);
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.subarray(0, 4).toString("latin1"), "glTF");
  assert.equal(bytes.readUInt32LE(8), bytes.length);
  const length = bytes.readUInt32LE(12);
  return {
    name: file.suggestedFilename(),
    json: JSON.parse(bytes.subarray(20, 20 + length).toString("utf8")),
  };
}

let browser, page, server, classes;

test.beforeAll(async ({ server: started, desk }) => {
  [browser, page, server] = [desk, desk.page, started];
  await server.json("PATCH", base, { scale_verified: true });
  const { layers } = await server.json("GET", `${base}/layers`);
  classes = layers.find(({ palette }) => palette.mode === "categorical");
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
  await dialog().getByText(words.export_dialog.saved(name)).waitFor();
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

test("the settings stay for the next file", async () => {
  await open();
  assert.equal(await dialog().locator('select[name="features"]').inputValue(), String(classes.id));
  await dialog().locator('select[name="features"]').selectOption("");
  await page.keyboard.press("Escape");
});

ends_well();

test.afterEach(({}, info) => attach_log(info, server));
