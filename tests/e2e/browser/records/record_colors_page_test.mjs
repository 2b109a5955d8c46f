// Records on the model: colored by a column's values, with patterns, for this user or for all
// users. Selected rows and rows of a filter are highlighted, or shown alone, and the camera moves
// to them.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, rgb } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const kSherds = 14;
const kEnough = 1500; // minimum number of pixels of a visible sherd
const [kLoose, kFirm] = ["#ff00ff", "#00e0ff"];

const base = "/models/demo-pot";
const L = `${base}/layers/sherds`;
const button = (name) => page.getByRole("button", { name, exact: true });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const palette = async () => (await server.json("GET", L)).palette;
const shows = (color, least, what) =>
  wait_for(async () => (await browser.count(rgb(color))) > least, what, 150);
const hides = (color, what) =>
  wait_for(async () => (await browser.count(rgb(color))) < 30, what, 150);
async function open_colors() {
  await button(words.layers.options("Sherds")).click();
  await page.getByRole("menuitem", { name: words.colors.open }).click();
  await dialog.getByRole("heading", { name: words.colors.title("Sherds") }).waitFor();
}
const fill_filter = async (text) => {
  await panel.getByLabel(words.tables.filter, { exact: true }).fill(text);
  await page.keyboard.press("Enter");
};

let browser, page, server, dialog, panel, legend, loose_area;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  dialog = page.locator("strata-color-dialog");
  panel = page.locator("strata-table-panel");
  legend = page.locator("strata-layer-panel .legend-column");
  await server.start();
  await server.json("POST", `${base}/layers`, {
    name: "Sherds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [
      { name: "Name" },
      { name: "State", kind: "enumeration", choices: ["loose", "firm"] },
      { name: "Thickness", kind: "numeric", unit: "mm" },
    ],
  });
  for (let key = 1; key <= kSherds; ++key) {
    const state = key === kSherds ? {} : { state: key % 3 === 0 ? "loose" : "firm" };
    await server.json("POST", "/tables/sherds/records", {
      values: { name: `Sherd ${key}`, thickness: 2 + key / 2, ...state },
    });
    await server.json("POST", `${L}/edits`, {
      op: "fill",
      value: key,
      mode: "where",
      where: `pieces = ${key}`,
    });
  }
  for (const other of ["pieces", "cracks"])
    await server.json("PATCH", `${base}/layers/${other}`, { visible: false });
  ({ area_m2: loose_area } = await server.json("POST", `${L}/extent`, {
    filter: "state = 'loose'",
  }));

  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  const later = page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await button(words.layers.select("Sherds")).click();
});

test("the layer is coloured by a column, as it is chosen", async () => {
  await open_colors();
  await dialog.getByLabel(words.colors.column).selectOption({ label: "State" });
  await dialog.locator("li", { hasText: "firm" }).getByText("9", { exact: true }).waitFor();
  await dialog.getByText("1 record has no value.").waitFor();
  await dialog.getByLabel(words.colors.color_of("loose")).fill(kLoose);
  await dialog.getByLabel(words.colors.color_of("firm")).fill(kFirm);
  await shows(kLoose, kEnough, "loose sherds in their colour");
  await shows(kFirm, kEnough, "firm sherds in theirs");
  assert.equal((await palette()).column, undefined, "nobody else sees it yet");
  await shot("colors-by-column");
});

test("with patterns, half of the colour makes room for what lies below", async () => {
  const plain = await browser.count(rgb(kFirm));
  await dialog.getByLabel(words.colors.patterned).check();
  await wait_for(
    async () => (await browser.count(rgb(kFirm))) < 0.75 * plain,
    "hatches to be drawn",
    150,
  );
  await dialog.getByLabel(words.colors.pattern_of("loose")).selectOption("outline");
  await shot("colors-patterns");
  await dialog.getByLabel(words.colors.patterned).uncheck();
  await wait_for(
    async () => (await browser.count(rgb(kFirm))) > 0.95 * plain,
    "plain colours",
    150,
  );
});

test("for everyone: the layer keeps it, and the legend says what is what", async () => {
  await dialog.getByRole("button", { name: words.colors.everyone }).click();
  await wait_for(async () => (await palette()).column === "state", "the layer to keep its colours");
  assert.deepEqual(
    (await palette()).points.map((point) => [point.value, point.color]),
    [
      ["firm", `${kFirm}ff`],
      ["loose", `${kLoose}ff`],
    ],
  );
  await legend.getByText("By State").waitFor();
  await legend.getByText(words.colors.others).waitFor();
});

test("numbers make classes, and what is for me alone is nobody else's", async () => {
  await open_colors();
  await dialog.getByLabel(words.colors.column).selectOption({ label: "Thickness" });
  await dialog.getByLabel(words.colors.count).fill("4");
  await dialog.getByLabel(words.colors.count).blur();
  await wait_for(async () => (await dialog.locator("li").count()) === 4, "four classes");
  await dialog.getByRole("button", { name: words.colors.ramps.reds }).click();
  await dialog.getByText("2.5 – 4 mm").waitFor();
  await shot("colors-classes");
  await dialog.getByLabel(words.colors.method).selectOption({ label: words.colors.methods.smooth });
  await wait_for(
    async () => (await dialog.locator("li").count()) === 0,
    "a gradient has no classes",
  );
  await dialog.getByRole("button", { name: words.colors.only_me }).click();
  await legend.getByText("By Thickness").waitFor();
  assert.equal((await palette()).column, "state");
  await hides(kLoose, "the gradient in place of the states");
  await button(words.layers.reset_default).click();
  await shows(kLoose, kEnough, "the colours that everyone sees");
});

test("a dialog that is closed without a choice changes nothing", async () => {
  await open_colors();
  await dialog.getByLabel(words.colors.column).selectOption({ label: words.colors.each_record });
  await hides(kLoose, "a colour for each");
  await page.keyboard.press("Escape");
  await shows(kLoose, kEnough, "the colours of before");
});

test("rows that are chosen stand out", async () => {
  await page.keyboard.press("t");
  await panel.getByText(words.tables.records(14)).waitFor();
  await shows(kFirm, kEnough, "the model beside the table");
  await panel.getByRole("rowheader", { name: "3", exact: true }).click();
  await hides(kFirm, "the others to turn grey");
  await shot("rows-lit");
  await button(words.tables.isolate).click();
  await button(words.tables.fly).click();
  await shows(kLoose, 4 * kEnough, "the camera before the sherd");
  await shot("row-alone");
  await button(words.tables.isolate).click();
  await button(words.tables.choose_none).click();
  await shows(kFirm, kEnough, "all of them again");
});

test("and rows that a filter finds, as long as it finds them", async () => {
  await fill_filter("state = 'loose'");
  await panel.getByText(words.tables.records_of(4, 14)).waitFor();
  await hides(kFirm, "only what the filter finds");
  const told = await panel.locator(".on-model .hint").textContent();
  assert.match(told, loose_area < 0.1 ? /cm²/ : /m²/, told);
  await server.json("PATCH", "/tables/sherds/records/1", { values: { state: "loose" } });
  await server.json("PATCH", "/tables/sherds/records/2", { values: { state: "loose" } });
  await wait_for(
    async () => (await panel.locator(".on-model .hint").textContent()) !== told,
    "the area with two more",
  );
  await shot("filter-lit");
  await button(words.tables.outdated).click();
  await panel.getByText(words.tables.records_of(6, 14)).waitFor();
  await wait_for(
    async () => !(await button(words.tables.outdated).isVisible()),
    "the rows to be those that stand out",
  );
  await button(words.tables.light_up).click();
  await shows(kFirm, kEnough, "the filter to stay in the table");
  await button(words.tables.light_up).click();
  await hides(kFirm, "and back");
  await button(words.tables.close).click();
  await shows(kFirm, kEnough, "what stood out to go with the table");
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
