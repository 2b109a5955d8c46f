// The dialog with the stable addresses of a model, and the pages of linked data.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

let browser, page, server;
const dialog = () => page.locator("strata-linked-dialog");
const shot = async (of, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await of.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `linked_${name}.png`) });
};

test.beforeAll(async ({ server: started, desk }) => {
  [browser, page, server] = [desk, desk.page, started];
  await server.json("PATCH", "/models/demo-pot", { scale_verified: true });
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
});

test("the dialog shows the addresses of the model", async () => {
  await open_tab(page, words, words.view.title);
  await page.getByRole("button", { name: words.gis.linked, exact: true }).click();
  await dialog().getByRole("dialog").waitFor();
  const address = (label) => dialog().getByRole("textbox", { name: label, exact: true });
  const { id } = await server.json("GET", "/models/demo-pot");
  const model = `${server.url}/id/models/${id}`;
  assert.equal(await address(words.linked_dialog.model).inputValue(), model);
  assert.equal(await address(words.linked_dialog.manifest).inputValue(), `${model}/manifest`);
  await shot(page, "dialog");
});

test("the description is saved as Turtle", async () => {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    dialog().getByRole("button", { name: words.linked_dialog.save, exact: true }).click(),
  ]);
  assert.equal(file.suggestedFilename(), "demo-pot.ttl");
  const text = readFileSync(await file.path(), "utf8");
  assert.match(text, /@prefix crm: /);
  assert.match(text, /rdfs:label "Demo pot"/);
});

test("pages lead from a model to a layer and its annotations", async () => {
  const [shown] = await Promise.all([
    page.waitForEvent("popup"),
    dialog().getByRole("link", { name: words.linked_dialog.show }).click(),
  ]);
  await shown.getByRole("heading", { name: "Demo pot" }).waitFor();
  await shot(shown, "model");
  await shown.getByRole("link", { name: "pieces", exact: true }).click();
  await shown.getByRole("heading", { name: "pieces" }).waitFor();
  await shot(shown, "layer");
  await shown.getByRole("link", { name: "Annotations", exact: true }).click();
  await shown.getByText("WktSelector").first().waitFor();
  await shot(shown, "annotations");
  await shown.close();
});

ends_well();

test.afterEach(({}, info) => attach_log(info, server));
