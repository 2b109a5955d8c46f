// The dialog for GIS programs: the address, and a layer as GeoTIFF.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

let browser, page, server;
const dialog = () => page.locator("strata-gis-dialog");
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `gis_${name}.png`) });
};

test.beforeAll(async ({ server: started, desk }) => {
  [browser, page, server] = [desk, desk.page, started];
  await server.json("PATCH", "/models/demo-pot", { scale_verified: true });
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
});

test("the dialog shows the address of the site", async () => {
  await open_tab(page, words, words.view.title);
  await page.getByRole("button", { name: words.gis.open, exact: true }).click();
  await dialog().getByRole("dialog").waitFor();
  const address = dialog().getByRole("textbox", { name: words.gis_dialog.address });
  assert.equal(await address.inputValue(), `${server.url}/ogc`);
  await shot("dialog");
});

test("a layer is saved as GeoTIFF in the chosen direction", async () => {
  await dialog().locator('select[name="along"]').selectOption("+y");
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    dialog().getByRole("button", { name: words.gis_dialog.save, exact: true }).click(),
  ]);
  assert.match(file.suggestedFilename(), /^demo-pot-[\w-]+\.tif$/);
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.subarray(0, 2).toString("latin1"), "II");
  assert.ok(bytes.includes("x and z"), "the name of the local system");
});

test("the collections are shown as a page", async () => {
  const [shown] = await Promise.all([
    page.waitForEvent("popup"),
    dialog().getByRole("link", { name: words.gis_dialog.collections }).click(),
  ]);
  await shown.getByRole("heading", { name: /Demo pot/ }).waitFor();
  await shown.getByText("/ogc/collections/demo-pot/position").waitFor();
  await shown
    .getByRole("link", { name: /^The layer / })
    .first()
    .click();
  await shown.getByRole("link", { name: "The values as GeoTIFF" }).waitFor();
  await shown.goto(`${server.url}/ogc/collections?f=html`);
  await shown.getByRole("link", { name: "demo-pot", exact: true }).waitFor();
  if (process.env.STRATA_TEST_OUTPUT)
    await shown.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, "gis_collections.png") });
  await shown.close();
});

ends_well();

test.afterEach(({}, info) => attach_log(info, server));
