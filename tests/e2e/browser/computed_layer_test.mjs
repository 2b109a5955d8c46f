// A computed layer on the page: completion of names, the result of the current expression, and
// errors with their position. The layer is stale after a change to its inputs. A button computes it
// again, or the server does so automatically.
import assert from "node:assert/strict";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const base = "/models/demo-pot";
const button = (page, name) => page.getByRole("button", { name });
const expression_of = (page) => page.getByLabel(w.layer_dialog.expression);
const shot = async (page, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `computed-${name}.png`) });
};
const risk_of = async (server) =>
  (await server.json("GET", `${base}/layers`)).layers.find((layer) => layer.slug === "risk");
const fill_cracks = (server, where) =>
  server.json("POST", `${base}/layers/cracks/edits`, {
    op: "fill",
    mode: "where",
    where,
    value: 1,
  });

test.beforeAll(async ({ server, desk }) => {
  await desk.page.goto(server.link);
  await desk.page.getByRole("link", { name: w.home.open("Demo pot") }).click();
  await desk.drawn();
});

test("a mistake is told at its character", async ({ page }) => {
  await button(page, w.layers.new).click();
  await page.getByRole("radio", { name: w.layer_dialog.formula }).click();
  await expression_of(page).fill("if(valid(crcks), 2, 1)");
  await page.getByText(/no layer 'crcks'.*at character 10/).waitFor();
  await shot(page, "mistake");
});

test("names are completed, and what the expression holds for is told", async ({ page }) => {
  const expression = expression_of(page);
  await expression.fill("");
  await expression.pressSequentially("if(valid(cra");
  await page
    .getByRole("option", { name: /^cracks/ })
    .first()
    .waitFor();
  await shot(page, "completion");
  await expression.press("Enter");
  await expression.pressSequentially("), 2, 1)");
  await page.getByText(/Has a value on/).waitFor();
});

test("a preview shows the values on the object, and makes no layer", async ({ server, page }) => {
  const before = (await server.json("GET", `${base}/layers`)).layers.length;
  await expression_of(page).fill("distance(valid(cracks))");
  const preview = page.locator("strata-layer-preview");
  await button(page, w.layer_dialog.preview).click();
  await preview.getByText(/ to .* on \d/).waitFor();
  const picture = preview.getByRole("img", { name: w.layer_preview.picture });
  await wait_for(
    () => picture.evaluate((image) => image.complete && image.naturalWidth > 300),
    "the picture",
  );
  await picture.scrollIntoViewIfNeeded();
  await shot(page, "preview");
  // a change removes it, and shows the server's problems at the expression
  await expression_of(page).fill("distance(valid(cracks), -5)");
  await picture.waitFor({ state: "detached" });
  await button(page, w.layer_dialog.preview).click();
  await page.locator("strata-expression-field").getByRole("alert").getByText(/./).waitFor();
  await page.getByRole("radio", { name: w.layer_dialog.shape, exact: false }).click();
  await button(page, w.layer_dialog.preview).click();
  await preview.getByText(/ to .* on \d/).waitFor();
  await shot(page, "preview_shape");
  await page.getByLabel(w.layer_dialog.name, { exact: true }).fill("Height");
  assert.equal(await picture.count(), 1, "the name removed the preview");
  await page.getByLabel(w.layer_dialog.name, { exact: true }).fill("");
  await page.getByRole("radio", { name: w.layer_dialog.formula }).click();
  assert.equal(await picture.count(), 0, "the preview of another kind stayed");
  assert.equal((await server.json("GET", `${base}/layers`)).layers.length, before);
  await expression_of(page).fill("if(valid(cracks), 2, 1)");
});

test("the layer is computed first and gets its colours then", async ({ server, page }) => {
  await page.getByLabel(w.layer_dialog.name, { exact: true }).fill("Risk");
  await shot(page, "dialog");
  await button(page, w.layer_dialog.compute).click();
  await page.locator("strata-layer-dialog").waitFor({ state: "detached" });
  await wait_for(async () => (await risk_of(server))?.stale === false, "the layer");
  const made = await risk_of(server);
  assert.deepEqual(
    [made.expression, made.inputs, made.recompute],
    ["if(valid(cracks), 2, 1)", ["cracks"], "manual"],
  );
  assert.ok(made.palette.max <= 2 && made.palette.min >= 1, JSON.stringify(made.palette));
  await page.getByText("if(valid(cracks), 2, 1)").waitFor();
});

test("it is stale once what it reads changes, and computed again by a button", async ({
  server,
  page,
}) => {
  await fill_cracks(server, "z > 0");
  await page.getByText(w.layers.stale).waitFor();
  await shot(page, "stale");
  await button(page, w.layers.recompute).click();
  await page.getByText(w.layers.stale).waitFor({ state: "hidden" });
  assert.equal((await risk_of(server)).stale, false);
});

test("it may follow by itself", async ({ server, page }) => {
  await button(page, w.layers.options("Risk")).click();
  await page.getByRole("menuitem", { name: /^Edit…?$/ }).click();
  await expression_of(page).fill("if(valid(cracks), 7, 5)");
  await page.getByLabel(w.layer_dialog.follows).check();
  await page.getByRole("button", { name: w.save, exact: true }).click();
  await wait_for(async () => {
    const risk = await risk_of(server);
    return risk.expression === "if(valid(cracks), 7, 5)" && !risk.stale;
  }, "the new expression");
  assert.equal((await risk_of(server)).recompute, "automatic");
  await fill_cracks(server, "true");
  const least = async () => (await server.json("GET", `${base}/layers/risk/statistics`)).min;
  await wait_for(async () => (await least()) === 7, "the layer to follow by itself");
});

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well({ complaints: ["422"] });
