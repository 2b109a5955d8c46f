// A list of terms on the page: created by a template, selected from the tree by typing and by keys,
// and painted in its color, which the legend shows. Lists from SKOS are previewed before the
// import, imported again, and saved. The file also tests refusals.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Browser, rgb } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const base = "/models/demo-pot";
const button = (name) => page.getByRole("button", { name, exact: true });
const term = (name) => brush.getByRole("treeitem", { name, exact: true });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const menu = async (name, item) => {
  await button(name).click();
  await page.getByRole("menuitem", { name: item, exact: true }).click();
};
const choose_file = async (name, text) => {
  const path = join(folder, name);
  writeFileSync(path, text);
  await importer.locator("input[type=file]").setInputFiles(path);
};
const drop = (on, name, text) =>
  on.evaluate(
    (element, [file, body]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([body], file));
      element.dispatchEvent(
        new DragEvent("drop", { dataTransfer, bubbles: true, composed: true, cancelable: true }),
      );
    },
    [name, text],
  );
const pixels = async (color) => {
  await page.mouse.move(5, 5); // the brush's circle would be counted
  return browser.count(rgb(color));
};
const statistics = (layer) => server.json("GET", `${base}/layers/${layer}/statistics`);

let browser,
  page,
  server,
  folder,
  brush,
  layers,
  templates,
  importer,
  maker,
  table,
  search,
  by_code,
  prefixes;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  folder = mkdtempSync(join(tmpdir(), "strata-terms-"));
  brush = page.locator("strata-brush-panel");
  layers = page.locator("strata-layer-panel");
  templates = page.locator("strata-template-dialog");
  importer = page.locator("strata-terms-dialog");
  maker = page.locator("strata-layer-dialog");
  table = page.locator("strata-table-panel");
  search = brush.getByRole("combobox");
  await server.start();
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
});

test("a template makes its tables and layers, and the first layer is painted on next", async () => {
  await menu(words.layers.more, words.templates.open);
  await templates.getByRole("listitem", { name: "Stone condition" }).waitFor();
  assert.equal(await templates.getByRole("button", { name: /^Create / }).count(), 4);
  await shot("templates");
  await button(words.templates.make_of("Stone condition")).click();
  await wait_for(async () => (await templates.count()) === 0, "the dialog to close");
  await layers.locator("li.selected").getByText("Stone condition", { exact: true }).waitFor();
  const made = (await server.json("GET", `${base}/layers`)).layers.find(
    ({ slug }) => slug === "stone-condition",
  );
  const { terms } = await server.json("GET", `/tables/${made.table}/terms`);
  by_code = (code) => terms.find((each) => each.code === code);
});

test("a crack is drawn and a point is set at once, and the term has them", async () => {
  const notice = (text) => page.locator("strata-notices").getByText(text).last().waitFor();
  await page.keyboard.press("d");
  await browser.drag([
    [0.42, 0.6],
    [0.5, 0.58],
    [0.58, 0.6],
  ]);
  await notice(/drawn for “Crack”/);
  await page.keyboard.press("s");
  const box = await browser.stage_box();
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.65 * box.height);
  await notice(words.marks.point_set("Crack"));
  const { values } = await server.json(
    "GET",
    `/tables/stone-condition-terms/records/${by_code("crack").key}`,
  );
  assert.deepEqual([values.lines.length, values.points.length], [1, 1]);
  await shot("term-lines");
  await page.keyboard.press("b");
});

test("the brush shows the list as a tree", async () => {
  // a long list is folded, except above the selected term
  assert.equal(await term("Crack").getAttribute("aria-selected"), "true");
  await term("Detachment").locator(".fold").click();
  await term("Scaling").locator(".fold").click();
  await term("Flaking").waitFor();
  assert.equal(await term("Scaling").getAttribute("aria-expanded"), "true");
  assert.deepEqual(
    await term("Flaking").evaluate((row) => [row.ariaLevel, row.ariaPosInSet, row.ariaSetSize]),
    ["3", "1", "2"],
  );
  assert.equal(await term("Flaking").getAttribute("title"), by_code("flaking").definition);
  await shot("term-tree");
});

test("a term is found by typing and taken by Enter", async () => {
  await search.fill("flak");
  await search.press("Enter");
  await brush.locator(".now").getByText("Flaking").waitFor();
  assert.deepEqual(
    await brush
      .getByRole("treeitem")
      .allInnerTexts()
      .then((all) => all.map((text) => text.trim())),
    ["Detachment", "Scaling", "Flaking"],
  );
  assert.equal(await term("Flaking").getAttribute("aria-selected"), "true");
  await shot("term-found");
});

test("what is painted has the term's key and its colour, and the legend names it", async () => {
  const before = await pixels(by_code("flaking").color);
  await browser.drag([
    [0.45, 0.5],
    [0.6, 0.5],
  ]);
  await browser.saved();
  await wait_for(
    async () =>
      (await statistics("stone-condition")).keys?.some(({ key }) => key === by_code("flaking").key),
    "the stroke to be kept",
  );
  const line = layers.locator(".legend-classes li", { hasText: "Flaking" });
  await line.scrollIntoViewIfNeeded();
  await wait_for(
    async () => (await pixels(by_code("flaking").color)) > before + 500,
    "the term's colour on the pot",
  );
  await shot("term-painted");
});

test("the arrow keys go through the tree, fold and unfold it", async () => {
  await search.press("Escape");
  await term("Crack").waitFor();
  const active = () =>
    search.evaluate(
      (input) =>
        input
          .getRootNode()
          .getElementById(input.getAttribute("aria-activedescendant") ?? "")
          ?.innerText.trim() ?? "",
    );
  await search.press("ArrowLeft"); // moves from the selected term to its parent
  assert.equal(await active(), "Scaling");
  await search.press("ArrowLeft");
  await wait_for(
    async () => (await term("Flaking").count()) === 0,
    "those below to be folded away",
  );
  await search.press("ArrowDown");
  assert.equal(await active(), "Features induced by material loss");
  await search.press("ArrowUp");
  await search.press("ArrowRight");
  await term("Flaking").waitFor();
  await search.press("ArrowRight");
  await search.press("ArrowDown");
  assert.equal(await active(), "Contour scaling");
  await search.press("Enter");
  await brush.locator(".now").getByText("Contour scaling").waitFor();
});

test("what nothing is called is told, and a click on a fold hides what is below", async () => {
  await search.fill("qwertz");
  await brush.getByText(words.terms.none_found).waitFor();
  await button(words.terms.show_all).click();
  await term("Crack").waitFor();
  await term("Crack and deformation").locator(".fold").click();
  await wait_for(async () => (await term("Crack").count()) === 0, "the cracks to be folded");
});

test("the same template again is refused in plain words, and nothing is made", async () => {
  await menu(words.layers.more, words.templates.open);
  await button(words.templates.make_of("Stone condition")).click();
  await templates
    .getByRole("alert")
    .getByText(/The model has a layer "Stone condition"/)
    .waitFor();
  await shot("template-refused");
  await templates.getByRole("button", { name: words.close }).click();
  assert.equal(
    (await server.json("GET", `${base}/layers`)).layers.filter(({ name }) =>
      name.startsWith("Stone"),
    ).length,
    4,
  );
});

test("a SKOS file is looked at first, and is not written while one of its terms is wrong", async () => {
  await menu(words.layers.more, words.terms_dialog.open);
  await choose_file("glaze.pdf", "no terms");
  await importer
    .getByRole("alert")
    .getByText(/is not supported/)
    .waitFor();
  prefixes =
    "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n@prefix g: <https://glaze.example/> .\n";
  await choose_file(
    "glaze_terms.ttl",
    `${prefixes}g:a a skos:Concept ; skos:broader g:b .\ng:b a skos:Concept ; skos:broader g:a .\n`,
  );
  await importer.getByRole("columnheader", { name: words.reports.what }).waitFor();
  assert.ok(await button(words.terms_dialog.import).isDisabled());
  await shot("terms-wrong");
  await choose_file(
    "glaze_terms.ttl",
    `${prefixes}
    g:glaze a skos:Concept ; skos:notation "glaze" ; skos:prefLabel "Glaze"@en, "Vidriado"@es ; skos:definition "Glass that was melted onto the clay."@en .
    g:crazing a skos:Concept ; skos:notation "crazing" ; skos:broader g:glaze ; skos:prefLabel "Crazing"@en, "Craquelado"@es .
    g:pinhole a skos:Concept ; skos:notation "pinhole" ; skos:broader g:glaze ; skos:prefLabel "Pinhole"@en .\n`,
  );
  await importer.getByText(words.reports.good).waitFor();
  assert.equal(await importer.getByLabel(words.terms_dialog.name).inputValue(), "glaze terms");
  await shot("terms-report");
  const { project } = await server.json("GET", base);
  const lists = async () =>
    (await server.json("GET", `/projects/${project}/tables`)).tables
      .filter(({ kind }) => kind === "terms")
      .map(({ name }) => name);
  const of_template = ["Stone condition terms", "Stone materials", "Stone measures"];
  assert.deepEqual((await lists()).sort(), of_template);
  await button(words.terms_dialog.import).click();
  await wait_for(async () => (await importer.count()) === 0, "the list to be made");
  await layers.locator("li.selected").getByText("glaze terms").first().waitFor();
  await term("Crazing").waitFor();
  assert.equal(await term("Crazing").getAttribute("aria-level"), "2");
  assert.deepEqual((await lists()).sort(), [...of_template, "glaze terms"]);
});

test("more terms go into the list from its table, and the tree follows", async () => {
  await page.getByRole("button", { name: words.tables.open }).click();
  await table.getByText(words.tables.records(3)).waitFor();
  await menu(words.tables.more, words.terms_dialog.open_more);
  await choose_file(
    "more.csv",
    "code,label-en,parent,color\ncrazing,Net of cracks,glaze,#aa3377\nrunning,Running,glaze,#4477aa\n",
  );
  await importer.getByText(words.reports.good).waitFor();
  await shot("terms-more");
  await button(words.terms_dialog.import).click();
  await term("Net of cracks").waitFor();
  await term("Running").waitFor();
  await shot("terms-imported");
});

test("a file that is dropped on the list's table is terms for it, and one in the dialog takes its place; one that says nothing new is not imported", async () => {
  await drop(table, "none.csv", "code,parent\nlone,nowhere\n");
  await importer.getByText("nowhere").waitFor();
  await drop(
    importer.getByRole("group", { name: words.terms_dialog.file }),
    "same.ttl",
    `${prefixes}g:pinhole a skos:Concept ; skos:notation "pinhole" ; skos:broader g:glaze ; skos:prefLabel "Pinhole"@en .\n`,
  );
  await importer.getByText("same.ttl").waitFor();
  await importer.getByText(words.reports.same).waitFor();
  assert.ok(await button(words.terms_dialog.import).isDisabled());
  await button(words.cancel).click();
});

test("the list is saved as SKOS, as it may be imported elsewhere", async () => {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    menu(words.tables.more, words.terms_dialog.save_turtle),
  ]);
  assert.equal(download.suggestedFilename(), "glaze-terms.ttl");
  await download.saveAs(join(folder, "saved.ttl"));
  assert.match(readFileSync(join(folder, "saved.ttl"), "utf8"), /Net of cracks/);
});

test("a new layer may hold the terms of a list that is there", async () => {
  await button(words.layers.new).click();
  await page.getByRole("radio", { name: /Objects with records/ }).click();
  await maker
    .getByLabel(words.layer_dialog.table)
    .selectOption({ label: words.layer_dialog.table_of_terms("glaze terms", 4) });
  await maker.getByLabel(words.layer_dialog.name, { exact: true }).fill("Glaze, second look");
  await shot("layer-of-terms");
  await button(words.layer_dialog.create).click();
  await layers.locator("li.selected").getByText("Glaze, second look").waitFor();
  await term("Running").waitFor();
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints(["409", "422"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  rmSync(folder, { recursive: true, force: true });
  await browser?.close();
  await server?.remove();
});
