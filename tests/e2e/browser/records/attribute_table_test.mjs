// The table of a layer's records with ten thousand rows: sorted, edited, refused, changed by two
// users at the same time, and undone. The tests also cover new and deleted records, columns, and
// CSV import and export. The test compares the page with the server's data.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const kMany = 10_000;

const base = "/models/demo-pot";
const T = "/tables/units";
const button = (name) => page.getByRole("button", { name, exact: true });
const record = async (key) => (await server.json("GET", `${T}/records/${key}`)).values;
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
/** The columns of the table, in their order. */
const columns = [
  "Key",
  "Code",
  "Depth",
  "Period",
  "Dug",
  "Soil",
  "Sealed",
  "Note",
  "Above",
  "Area",
];
const cell = (key, column) =>
  panel
    .locator(".line", { has: page.getByRole("rowheader", { name: String(key), exact: true }) })
    .locator(".cell")
    .nth(columns.indexOf(column));
async function write(key, column, text, end = "Enter") {
  await cell(key, column).click();
  await page.keyboard.press("F2");
  await panel.locator(".editor").waitFor();
  if (text !== null) await page.keyboard.type(text);
  await page.keyboard.press(end);
}
async function stored(key, slug, value) {
  await wait_for(
    async () => JSON.stringify((await record(key))[slug]) === JSON.stringify(value),
    `${slug} of ${key} to be ${JSON.stringify(value)}`,
  );
}
async function drop_csv(name, text) {
  await panel.evaluate(
    (element, [file, body]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([body], file, { type: "text/csv" }));
      element.dispatchEvent(
        new DragEvent("drop", { dataTransfer, bubbles: true, composed: true, cancelable: true }),
      );
    },
    [name, text],
  );
}
async function menu(label, item) {
  await button(label).click();
  await page.getByRole("menuitem", { name: item }).click();
}

let browser, page, server, panel, grid, bubble, dialog, let_names_go, are_names;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  panel = page.locator("strata-table-panel");
  grid = panel.getByRole("grid");
  bubble = panel.locator(".bubble");
  dialog = page.locator(
    "strata-record-dialog, strata-delete-record-dialog, strata-csv-dialog, strata-column-dialog",
  );
  await server.start();
  const { project } = await server.json("GET", base);
  await server.json("POST", `/projects/${project}/tables`, {
    name: "Units",
    columns: [
      { name: "Code", required: true, unique: true, comment: "As on the label of the bag" },
      { name: "Depth", kind: "numeric", unit: "m", minimum: 0 },
      { name: "Period", kind: "period" },
      { name: "Dug", kind: "date" },
      { name: "Soil", kind: "enumeration", choices: ["sand", "clay"], default: "clay" },
      { name: "Sealed", kind: "boolean" },
      { name: "Note" },
    ],
  });
  await server.json("POST", `${T}/columns`, { name: "Above", kind: "relation", target: "units" });
  const lines = Array.from(
    { length: kMany },
    (_, n) => `SU ${n + 1},${((n * 7) % kMany) / 100},${1500 + (n % 300)}`,
  );
  const bulk = await fetch(`${server.url}/api/v1${T}/records`, {
    method: "POST",
    headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "text/csv" },
    body: ["code,depth,period", ...lines].join("\n"),
  });
  assert.equal(bulk.status, 200);
  await server.json("POST", `${base}/layers`, {
    name: "Units",
    kind: "database",
    type: "u16",
    table: "units",
    resolution: 2048,
  });
  // the names of the possible records arrive only after the user has typed some characters

  const typed = new Promise((resolve) => (let_names_go = resolve));
  are_names = (url) =>
    url.pathname.endsWith("/records") && url.searchParams.get("limit") === "1000";
  await page.route(are_names, async (route) => {
    await typed;
    await route.continue();
  });
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await button(words.layers.select("Units")).click();
});

test("T opens the table; only the rows in sight are drawn, of ten thousand", async () => {
  await page.keyboard.press("t");
  await panel.getByText(words.tables.records(10_000)).waitFor();
  await cell(1, "Code").getByText("SU 1", { exact: true }).waitFor();
  assert.ok((await panel.locator(".line").count()) < 60);
  await cell(1, "Code").click();
  await page.keyboard.press("Control+End");
  await panel.getByText(`SU ${kMany}`, { exact: true }).waitFor();
  assert.ok((await panel.locator(".line").count()) < 60);
  await page.keyboard.press("Control+Home");
  await panel.getByText("SU 1", { exact: true }).waitFor();
  await shot("table");
});

test("a click on a column's name sorts by it, again turns the order round", async () => {
  const depth = panel.getByRole("columnheader", { name: /^Depth/ });
  await depth.getByRole("button", { name: /Depth/ }).first().click();
  await depth.getByRole("button", { name: /Depth/ }).first().click();
  assert.equal(await depth.getAttribute("aria-sort"), "descending");
  const deepest = (await server.json("GET", `${T}/records?sortby=-depth&limit=1`)).records[0];
  await wait_for(
    async () =>
      (await panel.locator(".line .cell.key").first().textContent()).trim() === String(deepest.key),
    "the deepest first",
  );
  await depth.getByRole("button", { name: /Depth/ }).first().click();
  await cell(1, "Code").getByText("SU 1", { exact: true }).waitFor();
});

test("cells are written into by kind", async () => {
  await write(1, "Depth", "2.5");
  await stored(1, "depth", 2.5);
  await write(1, "Note", "Charcoal", "Tab"); // moves to the next cell, which is a relation
  await page.keyboard.type("SU 9999");
  let_names_go();
  await panel.getByRole("option", { name: /SU 9999/ }).waitFor();
  await shot("table-relation");
  await page.keyboard.press("Enter");
  await page.keyboard.type("SU 3");
  await panel.getByRole("option", { name: /^SU 3 3$/ }).waitFor();
  await page.keyboard.press("Enter");
  await page.keyboard.press("Enter");
  await stored(1, "note", "Charcoal");
  await stored(1, "above", [3, 9999]);
  await page.unroute(are_names);
  await cell(1, "Above").getByText("SU 3, SU 9999").waitFor();
  await write(1, "Dug", "02292024");
  await stored(1, "dug", "2024-02-29");
  await write(1, "Soil", "s");
  await stored(1, "soil", "sand");
  await write(1, "Sealed", "y");
  await stored(1, "sealed", true);
  await cell(2, "Note").click();
  await page.keyboard.type("b"); // the key starts to edit the cell and does not select the brush
  await page.keyboard.type("one");
  await page.keyboard.press("Enter");
  await stored(2, "note", "bone");
  await cell(2, "Note").getByText("bone").waitFor();
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Delete");
  await stored(2, "note", null);
});

test("what is emptied while it is still being saved is empty in the end", async () => {
  const version = async () => (await server.json("GET", `${T}/records/2`)).version;
  const before = await version();
  await wait_for(
    async () => !(await cell(2, "Note").getAttribute("class")).includes("saving"),
    "the page to know that it is stored",
  );
  let let_go;
  let on_its_way = false;
  const held = new Promise((done) => (let_go = done));
  await page.route("**/records/2", async (route) => {
    if (route.request().method() === "PATCH" && !on_its_way) {
      on_its_way = true;
      await held;
    }
    await route.continue();
  });
  await page.keyboard.type("horn");
  await page.keyboard.press("Enter");
  await wait_for(() => on_its_way, "the note on its way");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Delete");
  let_go();
  await wait_for(
    async () => (await version()) === before + 2,
    "both changes of the note to be stored",
  );
  await page.unroute("**/records/2");
  await stored(2, "note", null);
});

test("what is no value is said at the cell, by the page or by the server", async () => {
  await write(2, "Depth", "deep");
  await bubble.getByText(words.tables.bad_number).waitFor();
  await page.keyboard.press("Escape");
  await write(2, "Period", "circa 1560");
  await bubble.getByText(/EDTF/).waitFor();
  await shot("table-refused");
  assert.equal((await record(2)).period, "1501");
  await button(words.tables.correct).click();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("1560~");
  await page.keyboard.press("Enter");
  await stored(2, "period", "1560~");
  assert.equal(await bubble.count(), 0);
});

test("Ctrl+Z takes back what this person wrote into the table, and brings it back", async () => {
  await page.keyboard.press("Control+z");
  await stored(2, "period", "1501");
  await cell(2, "Period").getByText("1501", { exact: true }).waitFor();
  await page.keyboard.press("Control+Shift+z");
  await stored(2, "period", "1560~");
  await cell(2, "Period").getByText("1560~").waitFor();
});

test("what others do is seen at once; of two who write into one cell the second is asked", async () => {
  const anna = (await server.add_person("anna", "annotator")).token;
  const as_anna = async (method, path, body) => {
    const answer = await fetch(`${server.url}/api/v1${path}`, {
      method,
      headers: { Authorization: `Bearer ${anna}`, "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    assert.ok(answer.ok, `${path}: ${answer.status}`);
  };
  await as_anna("PATCH", `${T}/records/4`, { values: { note: "from anna" } });
  await cell(4, "Note").getByText("from anna").waitFor();
  await cell(3, "Note").click();
  await page.keyboard.press("Enter");
  await page.keyboard.type("mine");
  await as_anna("PATCH", `${T}/records/3`, { values: { note: "anna's" } });
  await cell(3, "Note").getByText("anna's").waitFor();
  await page.keyboard.press("Enter");
  await bubble.getByText(/anna changed this at .*: anna's/).waitFor();
  await shot("table-conflict");
  await button(words.tables.take_mine).click();
  await stored(3, "note", "mine");
  await cell(3, "Note").click();
  await page.keyboard.press("Enter");
  await page.keyboard.type("mine again");
  await as_anna("PATCH", `${T}/records/3`, { values: { note: "anna's again" } });
  await cell(3, "Note").getByText("anna's again").waitFor();
  await page.keyboard.press("Enter");
  await button(words.tables.keep_theirs).click();
  await wait_for(async () => (await bubble.count()) === 0, "the question to go");
  await stored(3, "note", "anna's again");
});

test("a new record by its form, with what is wrong at the field", async () => {
  await button(words.tables.new_record).click();
  await dialog.getByLabel("Depth").fill("-1");
  await dialog.getByLabel("Code").fill("SU 1");
  await button(words.save).click();
  await dialog.getByRole("alert").first().waitFor();
  await shot("record-form");
  await dialog.getByLabel("Depth").fill("3");
  await button(words.save).click();
  await dialog.getByText(/Record 1 already has this value/).waitFor();
  await dialog.getByLabel("Code").fill("Pit");
  await button(words.save).click();
  await panel.getByText(words.tables.records(10_001)).waitFor();
  await cell(kMany + 1, "Code")
    .getByText("Pit")
    .waitFor(); // the new row is visible and selected
});

test("the chosen record is painted with, and its area is seen in the table", async () => {
  await button(words.tables.paint_with).click();
  await browser.drag([
    [0.45, 0.6],
    [0.5, 0.62],
  ]);
  await browser.saved();
  await shot("table-painted");
  await cell(kMany + 1, "Area")
    .getByText(/mm²|cm²/)
    .waitFor();
});

test("a click with the pick tool shows the record's card, with its form and its row; the brush finds records by name", async () => {
  await page.getByRole("combobox", { name: words.brush.find_record }).fill("SU 55");
  await page.getByRole("option", { name: /^SU 55 55$/ }).click();
  await browser.drag([
    [0.6, 0.6],
    [0.62, 0.62],
  ]);
  await browser.saved();
  await page.keyboard.press("i");
  const stage = await browser.stage_box();
  await page.mouse.click(stage.x + 0.47 * stage.width, stage.y + 0.607 * stage.height);
  const card = page.locator("strata-record-card");
  await card.getByText("Pit", { exact: true }).waitFor();
  await card.getByText("3 m", { exact: true }).waitFor();
  await shot("record-card");
  await button(words.tables.edit).last().click();
  await dialog.getByLabel("Note").fill("seen from above");
  await button(words.save).click();
  await card.getByText("seen from above").waitFor();
  await page.mouse.click(stage.x + 0.61 * stage.width, stage.y + 0.61 * stage.height);
  await card.getByText("SU 55", { exact: true }).waitFor();
  await page.locator("strata-value-readout").getByText("SU 55").waitFor();
  await button(words.tables.show_row).click();
  await cell(55, "Code").getByText("SU 55").waitFor();
  await button(words.tables.card_close).click();
  assert.equal(await card.count(), 0);
  await server.json("POST", `${base}/layers/units/edits`, {
    op: "fill",
    mode: "where",
    where: "units = 55",
    erase: true,
  });
  await cell(55, "Code").click();
  await page.keyboard.press("Control+End");
  await cell(kMany + 1, "Key").click();
});

test("a painted record that is to be deleted asks what becomes of that", async () => {
  await button(words.tables.delete).click();
  await button(words.delete).click();
  await dialog.getByText(/on Units of Demo pot/).waitFor();
  await shot("delete-painted");
  await page.getByRole("radio", { name: words.tables.texels_reassign }).click();
  await dialog.getByRole("combobox").fill("SU 7777");
  await dialog.getByRole("option", { name: /SU 7777/ }).click();
  await button(words.delete).click();
  await panel.getByText(words.tables.records(10_000)).waitFor();
  assert.ok((await server.json("GET", `${base}/layers/units/records/7777`)).area_m2 > 0);
  await panel.getByRole("columnheader", { name: /Area/ }).getByRole("button").first().click();
  await panel.getByRole("columnheader", { name: /Area/ }).getByRole("button").first().click();
  await wait_for(
    async () => (await panel.locator(".line .cell.key").first().textContent()).trim() === "7777",
    "the largest area first",
  );
  await panel.getByRole("columnheader", { name: /Area/ }).getByRole("button").first().click();
});

test("a CSV is looked at first: nothing is written while a row is wrong", async () => {
  await drop_csv("finds.csv", "code,depth,note\nSU 1,9,changed\nNew 1,deep,\nNew 1,2,\n");
  await dialog.getByText('"Depth" can contain only finite numbers.').waitFor();
  await shot("csv-report");
  assert.ok(await button(words.tables.csv_import).isDisabled());
  await button(words.cancel).click();
  await dialog.getByText('"Depth" can contain only finite numbers.').waitFor({ state: "hidden" });
  await drop_csv("finds.csv", "key,code,depth,note\n1,SU 1,9,changed\n,New 1,2,\n");
  await dialog.getByText(words.reports.good).waitFor();
  assert.equal((await record(1)).note, "Charcoal");
  await button(words.tables.csv_import).click();
  await panel.getByText(words.tables.records(10_001)).waitFor();
  await stored(1, "note", "changed");
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    menu(words.tables.more, /^Save as CSV$/),
  ]);
  assert.equal(download.suggestedFilename(), "units.csv");
});

test("columns come, get names in other languages, change their kind and tell what that loses, and go", async () => {
  await menu(words.tables.more, words.tables.new_column);
  await dialog.getByLabel(words.column_dialog.name).fill("Bags");
  await dialog.getByLabel(words.column_dialog.kind).selectOption("integer");
  await dialog.getByLabel(words.column_dialog.minimum).fill("0");
  await button(words.column_dialog.create).click();
  await panel.getByRole("columnheader", { name: /^Bags/ }).waitFor();
  await menu(words.tables.column_menu("Bags"), words.tables.change_column);
  await button(words.labels.add).click();
  await dialog.getByLabel(words.labels.language(1), { exact: true }).fill("es_MX");
  await dialog.getByRole("textbox", { name: words.labels.label("es_MX") }).fill("Bolsas");
  await button(words.save).click();
  await dialog.getByText(/"es_MX" is not a language tag/).waitFor();
  assert.equal(
    await dialog.getByLabel(words.labels.language(1), { exact: true }).getAttribute("aria-invalid"),
    "true",
  );
  await shot("column-language-refused");
  await dialog.getByLabel(words.labels.language(1), { exact: true }).fill("es");
  await button(words.labels.add).click();
  await dialog.getByLabel(words.labels.language(2), { exact: true }).fill("EN");
  await dialog.getByRole("textbox", { name: words.labels.label("English") }).fill("Finds bags");
  await shot("column-languages");
  await dialog.getByRole("textbox", { name: words.labels.label("English") }).press("Enter");
  // the browser's language is English
  await panel.getByRole("columnheader", { name: /^Finds bags/ }).waitFor();
  const bags = (await server.json("GET", T)).columns.find(({ slug }) => slug === "bags");
  assert.deepEqual([bags.name, bags.labels], ["Bags", { en: "Finds bags", es: "Bolsas" }]);
  await button(words.tables.new_record).click();
  await dialog.getByLabel("Finds bags").waitFor();
  await button(words.cancel).click();
  await menu(words.tables.column_menu("Note"), words.tables.change_column);
  await dialog.getByLabel(words.column_dialog.kind).selectOption("numeric");
  await button(words.save).click();
  await dialog.getByText(/did not fit the new type/).waitFor();
  await shot("column-lost");
  await dialog.getByRole("button", { name: words.column_dialog.take_back, exact: true }).click();
  await cell(1, "Note").getByText("changed").waitFor();
  await menu(words.tables.column_menu("Finds bags"), words.tables.drop_column);
  await button(words.tables.drop).click();
  await wait_for(
    async () => (await panel.getByRole("columnheader", { name: /^Finds bags/ }).count()) === 0,
    "the column to go",
  );
});

test("on a phone, too", async () => {
  await page.setViewportSize({ width: 400, height: 800 });
  await shot("table-phone");
  await page.setViewportSize({ width: 1280, height: 800 });
  await grid.focus();
  await page.keyboard.press("Escape");
  await page.keyboard.press("t");
  assert.equal(await panel.count(), 0);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints(["422", "409", "412"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
