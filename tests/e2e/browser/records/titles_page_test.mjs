// A table selects its title column, which may contain terms. A record's form shows terms as the
// brush does, in a list that opens on request.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `titles_${name}.png`) });
};
const kTerms =
  "code,parent,label\nz-loss,,Loss\nq-worn,z-loss,Worn\na-broken,z-loss,Broken off\nb-deposit,,Deposit\na-salt,b-deposit,Salts\n";
const kTree = ["Loss", "Worn", "Broken off", "Deposit", "Salts"];

let browser, page, server;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
});

test("records are called by the column that their table chooses, and terms open when asked for", async () => {
  await server.start();
  const model = (await server.json("GET", "/models")).models[0];
  const send = (path, body, type) =>
    fetch(`${server.url}/api/v1${path}`, {
      method: "POST",
      headers: { Authorization: `Bearer ${server.token}`, "Content-Type": type },
      body,
    }).then((answer) => answer.json());
  await send("/projects/demo/terms?name=Damage", kTerms, "text/csv").then(
    async (report) =>
      report.table ?? (await send("/projects/default/terms?name=Damage", kTerms, "text/csv")),
  );
  const terms = (await server.json("GET", "/tables/damage/terms")).terms;
  const key_of = (label) => terms.find(({ name }) => name === label).key;
  const columns = [
    { name: "Note" },
    { name: "Damage", kind: "term", target: "damage" },
    { name: "Where" },
  ];
  const layer = await server.json("POST", `/models/${model.id}/layers`, {
    name: "Places",
    kind: "database",
    type: "u16",
    columns,
  });
  const table = layer.table;
  for (const [note, label] of [
    ["Zinc", "Salts"],
    ["äther", "Worn"],
    ["Apple", "Loss"],
  ])
    await server.json("POST", `/tables/${table}/records`, {
      values: { note, damage: key_of(label) },
    });
  await server.json("POST", `/models/${model.id}/layers/${layer.id}/edits`, {
    op: "fill",
    mode: "where",
    where: "z > 0",
    value: 1,
  });

  await page.goto(server.link);
  await page.goto(`${server.url}/models/${model.id}`);
  await browser.drawn();
  await page.getByRole("button", { name: words.layers.select("Places") }).click();
  await page.keyboard.press("t");
  const grid = page.locator("strata-table-panel");
  await grid.getByText("Zinc").first().waitFor();

  // the terms have the order of the tree, not of the codes or keys
  await grid
    .getByRole("columnheader", { name: /^Damage/ })
    .getByRole("button", { name: /^Damage/ })
    .click();
  const notes = async () =>
    (await grid.locator('[role="row"] [id$="-1"]').allTextContents())
      .map((text) => text.trim())
      .filter((text) => ["Zinc", "äther", "Apple"].includes(text));
  await wait_for(
    async () => JSON.stringify(await notes()) === JSON.stringify(["Apple", "äther", "Zinc"]),
    "the rows in the order of the tree",
  );

  // the column of terms becomes the title column
  await grid
    .getByRole("columnheader", { name: /^Damage/ })
    .getByRole("button", { name: /column/i })
    .click();
  await page.getByRole("menuitemcheckbox", { name: words.tables.title_column }).click();
  await wait_for(
    async () => (await server.json("GET", `/tables/${table}`)).title_column !== undefined,
    "the title",
  );
  const legend = page.locator("strata-layer-panel li.layer.selected");
  await grid.getByRole("rowheader", { name: "1", exact: true }).click();
  await grid
    .locator(".chosen")
    .getByText(/^Salts ·/)
    .waitFor();
  await shot("chosen");

  // in the form, no list opens automatically, and the list is the tree
  await grid
    .getByRole("button", { name: words.tables.edit })
    .or(grid.locator(".chosen").getByRole("button").nth(1))
    .first()
    .click();
  const dialog = page.locator("strata-record-dialog");
  await dialog.getByRole("heading", { name: "Salts" }).waitFor();
  assert.equal(await dialog.locator(".list:popover-open").count(), 0, "a list lies over the form");
  const field = dialog.getByRole("combobox", { name: "Damage" });
  await field.click();
  const options = dialog.getByRole("option");
  await options.first().waitFor();
  assert.deepEqual(
    (await options.locator(".ellipsis").allTextContents()).map((text) => text.trim()),
    kTree,
  );
  const left = async (index) => (await options.nth(index).locator(".ellipsis").boundingBox()).x;
  assert.ok((await left(1)) > (await left(0)), "a term stands below the one above it");
  await shot("tree");
  await field.fill("broken");
  await wait_for(
    async () => (await options.count()) === 2,
    "the term that is looked for, with the one above it",
  );
  await field.press("Enter");
  const chip = dialog.locator(".chip").first();
  await chip.getByText("Broken off").waitFor();
  const [word, cross] = [
    await chip.locator(".ellipsis").boundingBox(),
    await chip.getByRole("button").boundingBox(),
  ];
  assert.ok(word.x + word.width <= cross.x + 1, "the button covers letters");
  await chip.getByRole("button").click();
  assert.equal(await field.getAttribute("placeholder"), "Search terms");
  assert.equal(await dialog.locator(".list:popover-open").count(), 0);
  await shot("form");
  void legend;

  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
