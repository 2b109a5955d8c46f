// A list of terms on the page: made by a template, chosen from the tree by typing and by keys, painted in its colour, as the legend has it; lists from
// SKOS, looked at before they are written, imported again, saved; and what is refused.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Browser, rgb } from "../support/browser.mjs";
import { StrataServer, wait_for } from "../support/strata-server.mjs";

const browser = await Browser.open();
const { page } = browser;
const server = new StrataServer({ demo: true });
const folder = mkdtempSync(join(tmpdir(), "strata-terms-"));
let step = "start";
const say = (text) => console.log((step = text));

const base = "/models/demo-pot";
const button = (name) => page.getByRole("button", { name, exact: true });
const brush = page.locator("strata-brush-panel");
const layers = page.locator("strata-layer-panel");
const templates = page.locator("strata-template-dialog");
const search = brush.getByRole("combobox");
const term = (name) => brush.getByRole("treeitem", { name, exact: true });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT) await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const statistics = (layer) => server.json("GET", `${base}/layers/${layer}/statistics`);

try {
  await server.start();
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: "Decide later" });
  if (await later.isVisible()) await later.click();

  say("a template makes its tables and layers, and the first layer is painted on next");
  await button("More about layers").click();
  await page.getByRole("menuitem", { name: "From a template…" }).click();
  await templates.getByRole("listitem", { name: "Stone condition" }).waitFor();
  assert.equal(await templates.getByRole("button", { name: /^Make / }).count(), 4);
  await shot("templates");
  await button("Make Stone condition").click();
  await wait_for(async () => (await templates.count()) === 0, "the dialog to close");
  await layers.locator("li.selected").getByText("Stone condition", { exact: true }).waitFor();
  const made = (await server.json("GET", `${base}/layers`)).layers.find(({ slug }) => slug === "stone-condition");
  const { terms } = await server.json("GET", `/tables/${made.table}/terms`);
  const by_code = (code) => terms.find((each) => each.code === code);

  say("the brush shows the list as a tree");
  await term("Flaking").waitFor();
  assert.equal(await term("Coming off").getAttribute("aria-expanded"), "true");
  assert.deepEqual(await term("Flaking").evaluate((row) => [row.ariaLevel, row.ariaPosInSet, row.ariaSetSize]), ["2", "1", "4"]);
  assert.equal(await term("Flaking").getAttribute("title"), by_code("flaking").definition);
  await shot("term-tree");

  say("a term is found by typing and taken by Enter");
  await search.fill("flak");
  await search.press("Enter");
  await brush.locator(".now").getByText("Flaking").waitFor();
  assert.deepEqual(await brush.getByRole("treeitem").allInnerTexts().then((all) => all.map((text) => text.trim())), ["Coming off", "Flaking"]);
  assert.equal(await term("Flaking").getAttribute("aria-selected"), "true");
  await shot("term-found");

  say("what is painted has the term's key and its colour, and the legend names it");
  await browser.drag([[0.45, 0.5], [0.6, 0.5]]);
  await browser.saved();
  await wait_for(async () => (await statistics("stone-condition")).keys?.some(({ key }) => key === by_code("flaking").key), "the stroke to be kept");
  const line = layers.locator(".legend-classes li", { hasText: "Flaking" });
  await line.scrollIntoViewIfNeeded();
  await wait_for(async () => (await browser.count(rgb(by_code("flaking").color))) > 200, "the term's colour on the pot");
  await shot("term-painted");

  say("the arrow keys go through the tree, fold and unfold it");
  await search.press("Escape");
  await term("Cracks").waitFor();
  const active = () => search.evaluate((input) => input.getRootNode().getElementById(input.getAttribute("aria-activedescendant") ?? "")?.innerText.trim() ?? "");
  await search.press("ArrowLeft"); // from the one that is chosen to the one above
  assert.equal(await active(), "Coming off");
  await search.press("ArrowLeft");
  await wait_for(async () => (await term("Flaking").count()) === 0, "those below to be folded away");
  await search.press("ArrowDown");
  assert.equal(await active(), "Loss");
  await search.press("ArrowUp");
  await search.press("ArrowRight");
  await term("Powdering").waitFor();
  await search.press("ArrowRight");
  await search.press("ArrowDown");
  assert.equal(await active(), "Powdering");
  await search.press("Enter");
  await brush.locator(".now").getByText("Powdering").waitFor();

  say("what nothing is called is told, and a click on a fold hides what is below");
  await search.fill("qwertz");
  await brush.getByText("No term is called that.").waitFor();
  await button("Show all terms").click();
  await term("Cracks").locator(".fold").click();
  await wait_for(async () => (await term("Hairline crack").count()) === 0, "the cracks to be folded");

  say("the same template again is refused in plain words, and nothing is made");
  await button("More about layers").click();
  await page.getByRole("menuitem", { name: "From a template…" }).click();
  await button("Make Stone condition").click();
  await templates.getByRole("alert").getByText(/already/).waitFor();
  await shot("template-refused");
  await templates.getByRole("button", { name: "Close" }).click();
  assert.equal((await server.json("GET", `${base}/layers`)).layers.filter(({ name }) => name.startsWith("Stone")).length, 2);

  say("the end");
  browser.assert_no_complaints(["409", "422"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
} catch (error) {
  console.log(`failed at: ${step}\n--- log of the server\n${server.log.slice(-60).join("\n")}\n${browser.complaints.join("\n")}`);
  await shot("terms-failed");
  throw error;
} finally {
  rmSync(folder, { recursive: true, force: true });
  await browser.close();
  await server.remove();
}
