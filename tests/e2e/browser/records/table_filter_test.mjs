// The table of records together with the other tools: the page's keys while the table has the
// keyboard focus, a filter for each column, and files. The tests also copy areas and cross-tables,
// and save them as files.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { findings } from "../../support/js/accessible.mjs";
import { Browser } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const base = "/models/demo-pot";
const button = (name) => page.getByRole("button", { name, exact: true });
const columns = ["Key", "Code", "Depth", "Soil", "Sealed", "Note", "Kind", "Above", "Dug"];
const cell = (key, column) =>
  panel
    .locator(".line", { has: page.getByRole("rowheader", { name: String(key), exact: true }) })
    .locator(".cell")
    .nth(columns.indexOf(column));
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const shown = async (keys) => {
  const seen = async () =>
    (await panel.locator(".line .cell.key").allTextContents()).map((text) => Number(text.trim()));
  await wait_for(
    async () => JSON.stringify(await seen()) === JSON.stringify(keys),
    `the records ${keys}`,
  );
};
const open_filter = async (column) => {
  await panel
    .getByRole("columnheader", { name: new RegExp(`^${column}`) })
    .getByRole("button", { name: new RegExp(`^Filter by ${column}`) })
    .click();
  await sheet.getByRole("dialog").waitFor();
};
const apply = async () => {
  await sheet.getByRole("button", { name: words.column_filter.apply, exact: true }).click();
  await sheet.waitFor({ state: "detached" });
};
const show_with = (what) => sheet.getByLabel(words.column_filter.show).selectOption(what);
const saved = async (click) => {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
};
/** Returns the page's current tool. */
const tool = () =>
  page.locator("strata-tool-rail button[aria-pressed=true]").getAttribute("aria-label");

let browser, page, server, panel, sheet, filter, line, areas;

test.beforeAll(async () => {
  browser = await Browser.open({
    viewport: { width: 1440, height: 900 },
    acceptDownloads: true,
  });
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  panel = page.locator("strata-table-panel");
  sheet = page.locator("strata-column-filter");
  filter = panel.getByRole("textbox", { name: words.tables.filter });
  await server.start();
  const { project, id: model } = await server.json("GET", base);
  const terms = await fetch(`${server.url}/api/v1/projects/${project}/terms?name=Kinds`, {
    method: "POST",
    headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "text/csv" },
    body: "code,label\npit,Pit\nwall,Wall\n",
  });
  assert.ok(terms.ok, await terms.text());
  const { tables } = await server.json("GET", `/projects/${project}/tables`);
  const kinds = tables.find(({ name }) => name === "Kinds");
  await server.json("POST", `/projects/${project}/tables`, {
    name: "Units",
    columns: [
      { name: "Code", required: true, unique: true },
      { name: "Depth", kind: "numeric", unit: "m" },
      { name: "Soil", kind: "enumeration", choices: ["sand", "clay"] },
      { name: "Sealed", kind: "boolean" },
      { name: "Note" },
      { name: "Kind", kind: "term", target: kinds.slug },
    ],
  });
  await server.json("POST", "/tables/units/columns", {
    name: "Above",
    kind: "relation",
    target: "units",
  });
  await server.json("POST", "/tables/units/columns", { name: "Dug", kind: "date" });
  const records = [
    { code: "SU 1", depth: 0.5, soil: "sand", sealed: true, note: "50 % burnt", kind: 1 },
    {
      code: "SU 2",
      depth: 1.5,
      soil: "clay",
      sealed: false,
      note: "Charcoal",
      kind: 2,
      above: [1],
      dug: "2024-05-02",
    },
    { code: "SU 3", depth: 2.5, soil: "clay", above: [1, 2], dug: "2025-01-01" },
    { code: "SU 4" },
  ];
  for (const values of records) await server.json("POST", "/tables/units/records", { values });
  await server.json("POST", `${base}/layers`, {
    name: "Units",
    kind: "database",
    type: "u16",
    table: "units",
    resolution: 2048,
  });
  await server.json("POST", `${base}/layers/units/edits`, {
    op: "fill",
    value: 2,
    mode: "where",
    where: "pieces = 1 or pieces = 2",
  });
  await browser.sign_in(server, server.token);
  await page.goto(`${server.url}/models/${model}`);
  await browser.drawn();
  await button(words.layers.select("Units")).click();
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("t");
  await shown([1, 2, 3, 4]);
});

test("where a key cannot be meant as text it is one of the page; Home and End stay within the row", async () => {
  await cell(2, "Soil").click();
  await page.keyboard.press("m");
  await wait_for(
    async () => (await tool()) === words.tools.measure,
    "the measuring tool, by M in a cell of choices",
  );
  await page.keyboard.press("v");
  await wait_for(async () => (await tool()) === words.tools.orbit, "turning, by V");
  await page.keyboard.press("Home");
  await wait_for(
    () => panel.locator(".cell.key.active").count(),
    "the first cell of the row, by Home",
  );
  await page.keyboard.press("End");
  await wait_for(
    () => panel.locator(".cell.computed.active").count(),
    "the last cell of the row, by End",
  );
  await page.keyboard.press("b");
  await wait_for(
    async () => (await tool()) === words.tools.brush,
    "the brush, by B in a cell that is computed",
  );
  await cell(2, "Depth").click();
  await page.keyboard.press("h");
  await wait_for(
    async () => (await tool()) === words.tools.pan,
    "moving, by H in a cell of numbers",
  );
  await page.keyboard.press("7");
  await panel.locator(".editor").waitFor();
  await page.keyboard.press("Escape");
  await cell(2, "Note").click();
  await page.keyboard.press("t");
  await wait_for(
    async () => (await panel.locator(".editor textarea").inputValue()) === "t",
    "a letter in a cell of text",
  );
  await page.keyboard.press("Escape");
  await page.keyboard.press("Escape");
  await page.keyboard.press("t");
  await panel.waitFor({ state: "detached" });
  await page.keyboard.press("t");
  await shown([1, 2, 3, 4]);
  await cell(2, "Sealed").click();
  await page.keyboard.press("t");
  await panel.waitFor({ state: "detached" });
  await page.keyboard.press("t");
  await shown([1, 2, 3, 4]);
});

test("values of a column are chosen with how many records have them", async () => {
  await open_filter("Soil");
  line = (text) => sheet.getByRole("listitem").filter({ hasText: text });
  assert.match(await line("clay").innerText(), /clay\s*2/);
  assert.match(await line("sand").innerText(), /sand\s*1/);
  assert.match(await line("without a value").innerText(), /1$/);
  assert.deepEqual(await findings(page), []);
  await shot("column-filter-values");
  await sheet.getByRole("checkbox", { name: /^clay/ }).check();
  await shown([2, 3]); // immediately
  assert.ok(await sheet.getByRole("dialog").isVisible());
  await apply();
  await shown([2, 3]);
  assert.equal(await filter.inputValue(), "soil = 'clay'");
  await panel.getByRole("button", { name: words.column_filter.open_on("Soil") }).waitFor();
});

test("columns are filtered together; what was typed stays", async () => {
  await filter.fill("soil = 'clay' and code like 'SU%'");
  await page.keyboard.press("Enter");
  await open_filter("Depth");
  await sheet.getByLabel("From (m)").fill("2");
  await page.keyboard.press("Enter");
  await sheet.waitFor({ state: "detached" });
  await shown([3]);
  assert.equal(await filter.inputValue(), "soil = 'clay' and code like 'SU%' and depth >= 2");
  await open_filter("Soil");
  assert.ok(await sheet.getByRole("checkbox", { name: /^clay/ }).isChecked());
  await sheet.getByRole("button", { name: words.column_filter.remove }).click();
  await shown([3]);
  assert.equal(await filter.inputValue(), "code like 'SU%' and depth >= 2");
  await shot("column-filter-two");
  await button(words.tables.filter_clear).click();
  await shown([1, 2, 3, 4]);
});

test("each kind of column has its questions", async () => {
  await open_filter("Note");
  await show_with("contains");
  await sheet.getByLabel(words.column_filter.contains, { exact: true }).fill("50 %");
  await apply();
  await shown([1]);
  await open_filter("Note");
  await show_with("empty");
  await apply();
  await shown([3, 4]);
  await open_filter("Note");
  await show_with("filled");
  await apply();
  await shown([1, 2]);
  await open_filter("Note");
  await sheet.getByRole("button", { name: words.column_filter.remove }).click();
  await open_filter("Kind");
  await line("Wall").waitFor();
  await sheet.getByRole("checkbox", { name: /^Wall/ }).check();
  await apply();
  await shown([2]);
  await open_filter("Kind");
  await sheet.getByRole("checkbox", { name: /^without/ }).check();
  await apply();
  await shown([2, 3, 4]);
  await button(words.tables.filter_clear).click();
  await open_filter("Above");
  await sheet.getByRole("checkbox", { name: /^SU 2/ }).check();
  await shot("column-filter-relation");
  await apply();
  await shown([3]);
  await open_filter("Above");
  await sheet.getByRole("button", { name: words.column_filter.remove }).click();
  await open_filter("Sealed");
  await sheet.getByRole("checkbox", { name: /^no/ }).check();
  await apply();
  await shown([2]);
  await button(words.tables.filter_clear).click();
  await open_filter("Dug");
  await sheet.getByLabel(words.column_filter.from).fill("2024-12-31");
  await apply();
  await shown([3]);
  await button(words.tables.filter_clear).click();
});

test("by keys alone", async () => {
  const funnel = panel.getByRole("button", { name: words.column_filter.open("Code") });
  await funnel.focus();
  await page.keyboard.press("Enter");
  await sheet.getByRole("dialog").waitFor();
  const value = sheet.getByRole("checkbox", { name: /^SU 1/ });
  await value.waitFor(); // waits until the values are counted
  await value.focus();
  await page.keyboard.press("Space");
  await page.keyboard.press("Enter");
  await shown([1]);
  assert.equal(await filter.inputValue(), "code = 'SU 1'");
  await panel.getByRole("button", { name: words.column_filter.open_on("Code") }).press("Enter");
  await page.keyboard.press("Escape");
  await sheet.waitFor({ state: "detached" });
  await wait_for(
    () =>
      panel
        .getByRole("button", { name: words.column_filter.open_on("Code") })
        .evaluate((each) => each.matches(":focus")),
    "the keyboard back at the funnel",
  );
});

test("the rows are saved as they are shown", async () => {
  const csv = await saved(() =>
    panel.locator(".bar").getByRole("button", { name: words.tables.save_csv }).click(),
  );
  assert.equal(csv.name, "units.csv");
  assert.match(csv.bytes.toString(), /SU 1/);
  assert.doesNotMatch(csv.bytes.toString(), /SU 2/);
  const xlsx = await saved(() =>
    panel.locator(".bar").getByRole("button", { name: words.tables.save_xlsx }).click(),
  );
  assert.equal(xlsx.name, "units.xlsx");
  assert.equal(xlsx.bytes.subarray(0, 2).toString(), "PK");
  await button(words.tables.close).click();
});

test("areas are copied and saved", async () => {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await button(words.layers.options("pieces")).click();
  await page.getByRole("menuitem", { name: /^Areas/ }).click();
  areas = page.locator("strata-statistics-dialog");
  await areas.getByRole("button", { name: "Copy: Areas of “pieces”" }).click();
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(copied, /^Class\tArea\tShare of the surface\n.*\t.*cm²\t.* %/);
  assert.match(copied, /\nTotal\t[^\t]+\t[\d.]+ %$/);
  const of_areas = await saved(() =>
    areas.getByRole("button", { name: "XLSX: Areas of “pieces”" }).click(),
  );
  assert.equal(of_areas.name, "pieces-quantities.xlsx");
  assert.match(
    (
      await saved(() => areas.getByRole("button", { name: "CSV: Areas of “pieces”" }).click())
    ).bytes.toString(),
    /percent_of_surface/,
  );
});

test("two layers are set against each other, with names and sums", async () => {
  await areas.getByLabel(words.cross_table.other).selectOption({ label: "Units" });
  const table = areas.getByRole("table");
  await table.waitFor();
  assert.deepEqual(await table.getByRole("columnheader").allInnerTexts(), [
    "pieces / Units",
    "SU 2",
    "not in Units",
    words.cross_table.sum,
  ]);
  const expected = await server.json("POST", `${base}/cross-table`, {
    rows: "pieces",
    columns: "units",
  });
  assert.equal(await table.getByRole("rowheader").count(), expected.rows.length + 1);
  await areas.getByText(words.cross_table.agreement.none).waitFor();
  assert.deepEqual(await findings(page), []);
  await shot("cross-table");
  const crossed = await saved(() =>
    areas.getByRole("button", { name: /^CSV: Overlap of/ }).click(),
  );
  assert.equal(crossed.name, "pieces-units.csv");
  const [head, first] = crossed.bytes.toString().replace("\ufeff", "").split("\r\n");
  assert.equal(head, '"pieces / Units, cm²",SU 2,–,total');
  assert.match(first, /^Sherd 1,/);
  assert.equal(
    (await saved(() => areas.getByRole("button", { name: /^XLSX: Overlap of/ }).click())).bytes
      .subarray(0, 2)
      .toString(),
    "PK",
  );
});

test("two observers who used the same classes see how well they agree", async () => {
  const { palette } = await server.json("GET", `${base}/layers/pieces`);
  await server.json("POST", `${base}/layers`, {
    name: "Second observer",
    type: "u16",
    palette,
    resolution: 2048,
  });
  await server.json("POST", `${base}/layers/second-observer/edits`, {
    op: "fill",
    value: 1,
    mode: "where",
    where: "pieces = 1",
  });
  const { agreement: expected } = await server.json("POST", `${base}/cross-table`, {
    rows: "pieces",
    columns: "second-observer",
  });
  assert.ok(expected.kappa > 0 && expected.kappa < 1, JSON.stringify(expected));
  await areas.getByLabel(words.cross_table.other).selectOption({ label: "Second observer" });
  const agreement = areas.getByRole("region", { name: words.cross_table.agreement.title });
  await agreement.waitFor();
  await areas.getByText(`Cohen’s κ is ${expected.kappa.toFixed(2)}: `).waitFor();
  await agreement.getByRole("rowheader", { name: "Sherd 1", exact: true }).waitFor();
  const names = await agreement.getByRole("rowheader").allInnerTexts();
  assert.equal(names.length, expected.classes.length);
  assert.equal(names.at(-1), words.cross_table.agreement.unpainted);
  await areas.getByRole("button", { name: "Copy: Agreement of the two layers" }).click();
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(copied, /^Class\tIoU\tF1\t/);
  assert.deepEqual(await findings(page), []);
  await shot("agreement");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
