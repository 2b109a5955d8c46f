// Two users at the same records: each sees the record that the other has open, takes it over after
// confirming, and loses no text.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../../support/js/browser.mjs";
import { attach_log, test } from "../../support/js/cases.mjs";
import { StrataServer, wait_for } from "../../support/js/strata-server.mjs";
import { texts_of } from "../../support/js/texts.mjs";

const words = texts_of("en");

const kExpected = ["status of 412"]; // the browser's message about a change that came too late

const base = "/models/demo-pot";
const T = "/tables/units";
const record = async (key) => (await server.json("GET", `${T}/records/${key}`)).values;
async function stored(key, slug, value) {
  await wait_for(
    async () => (await record(key))[slug] === value,
    `${slug} of ${key} to be ${value}`,
  );
}
async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({
      path: join(process.env.STRATA_TEST_OUTPUT, `record_lock_${name}.png`),
    });
}
const columns = ["Key", "Code", "Note", "Soil"];
const row = ({ page }, key) =>
  page.locator("strata-table-panel .line", {
    has: page.getByRole("rowheader", { name: new RegExp(`^${key}\\b`) }),
  });
const cell = (who, key, column) => row(who, key).locator(".cell").nth(columns.indexOf(column));
const mark = (who, key, user) =>
  row(who, key).getByRole("img", { name: `${user} is editing this.` });
const form = ({ page }) => page.locator("strata-record-dialog");
const note = (who) => form(who).getByRole("textbox", { name: "Note" });
const save = (who) => form(who).getByRole("button", { name: words.save, exact: true });
const button = ({ page }, name) => page.getByRole("button", { name, exact: true });
const bubble = ({ page }) => page.locator("strata-table-panel .bubble");
const editor = ({ page }) => page.locator("strata-table-panel .editor");
async function open_form(who, key) {
  await row(who, key).getByRole("rowheader").click();
  await button(who, words.tables.edit).click();
  await note(who).waitFor();
}
/** Clicks the button of the question, not the button that opened it. */
const agree = ({ page }, name) =>
  page.locator("strata-question").getByRole("button", { name, exact: true }).click();
async function type_into(who, key, column, text) {
  await cell(who, key, column).click();
  await who.page.keyboard.press("F2");
  await editor(who).waitFor();
  await who.page.keyboard.press("Control+a");
  await who.page.keyboard.type(text);
}

let ada, bea, phone, everybody, server;

test.beforeAll(async () => {
  [ada, bea, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  everybody = { ada, bea, phone };
  server = new StrataServer({ demo: true });
  await server.start();
  const { project } = await server.json("GET", base);
  await server.json("POST", `/projects/${project}/tables`, {
    name: "Units",
    columns: [
      { name: "Code", required: true },
      { name: "Note" },
      { name: "Soil", kind: "enumeration", choices: ["sand", "clay"] },
    ],
  });
  for (let n = 1; n <= 6; ++n)
    await server.json("POST", `${T}/records`, { values: { code: `SU ${n}`, note: `found ${n}` } });
  await server.json("POST", `${base}/layers`, {
    name: "Units",
    kind: "database",
    type: "u16",
    table: "units",
    resolution: 2048,
  });
  for (const [name, who] of Object.entries({ ada, bea }))
    await who.sign_in(server, await server.add_person(name, "annotator"));
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  const id = (await server.json("GET", base)).id;
  for (const who of Object.values(everybody)) {
    await who.page.goto(`${server.url}/models/${id}`);
    await who.drawn();
    if (who === phone) await button(who, words.model.show_panel).click();
    await button(who, words.layers.select("Units")).click();
    await who.page.keyboard.press("t");
    await cell(who, 1, "Code").getByText("SU 1", { exact: true }).waitFor();
  }
});

test("who has a record's form open is seen in its row, by viewers, too", async () => {
  await open_form(ada, 1);
  for (const who of [bea, phone]) await mark(who, 1, "ada").waitFor();
  assert.equal(await mark(ada, 1, "ada").count(), 0, "one's own row");
  await shoot(bea, "row");
  await shoot(phone, "phone_row");
});

test("a second form of it can be read, but not changed", async () => {
  await open_form(bea, 1);
  await form(bea).getByText(words.tables.edited_by("ada")).waitFor();
  assert.equal(await note(bea).getAttribute("readonly"), "");
  assert.ok(await form(bea).getByRole("combobox", { name: "Soil" }).isDisabled());
  assert.ok(await save(bea).isDisabled());
  await shoot(bea, "waiting");
});

test("taken over after a question, the other form keeps what was written, to be copied", async () => {
  await note(ada).fill("Mine, and not saved");
  await button(bea, words.tables.take_over).click();
  await bea.page.getByText("ada is editing this record.").waitFor();
  await shoot(bea, "question");
  await agree(bea, words.cancel);
  assert.equal(
    await note(ada).getAttribute("readonly"),
    null,
    "a question that was not answered took something",
  );
  await button(bea, words.tables.take_over).click();
  await agree(bea, words.tables.take_over);
  await form(ada).getByText("bea took over editing.").waitFor();
  assert.equal(await note(ada).getAttribute("readonly"), "");
  assert.equal(await note(ada).inputValue(), "Mine, and not saved");
  assert.equal(
    await form(ada).getByRole("textbox", { name: words.tables.written }).inputValue(),
    "Note: Mine, and not saved",
  );
  assert.ok(await save(ada).isDisabled());
  await note(ada).press("Control+Enter");
  await shoot(ada, "taken");
  assert.equal(await note(bea).getAttribute("readonly"), null);
  await note(bea).fill("Bea's");
  await save(bea).click();
  await stored(1, "note", "Bea's");
});

test("left by the other it is one's own again: the text is still there, and what was saved meanwhile is told", async () => {
  await form(ada).getByText("bea took over editing.").waitFor({ state: "detached" });
  assert.equal(await note(ada).inputValue(), "Mine, and not saved");
  await save(ada).click();
  await form(ada).getByText(words.tables.changed_meanwhile("bea")).waitFor();
  assert.equal((await record(1)).note, "Bea's");
  await save(ada).click();
  await stored(1, "note", "Mine, and not saved");
  await form(ada).waitFor({ state: "detached" });
});

test("whoever waits without taking over begins with what was saved", async () => {
  await open_form(ada, 2);
  await open_form(bea, 2);
  await form(bea).getByText(words.tables.edited_by("ada")).waitFor();
  await note(ada).fill("Saved by ada");
  await save(ada).click();
  await wait_for(async () => (await note(bea).inputValue()) === "Saved by ada", "what ada saved");
  assert.equal(await note(bea).getAttribute("readonly"), null);
  await note(bea).fill("And by bea");
  await save(bea).click();
  await stored(2, "note", "And by bea");
  await mark(phone, 2, "bea").waitFor({ state: "detached" });
});

test("a cell that is written into is seen, asked for and taken over; its text stays, too", async () => {
  await type_into(ada, 3, "Note", "Half a sen");
  await mark(bea, 3, "ada").waitFor();
  await cell(bea, 3, "Note").click();
  await bea.page.keyboard.press("F2");
  await bea.page.getByText(words.tables.take_over_title("SU 3")).waitFor();
  assert.equal(await editor(bea).count(), 0);
  await agree(bea, words.cancel);
  await cell(bea, 3, "Note").click();
  await bea.page.getByText(words.tables.take_over_title("SU 3")).waitFor();
  await agree(bea, words.tables.take_over);
  await editor(bea).waitFor();
  await bubble(ada).getByText("bea took over editing.").waitFor();
  assert.equal(await editor(ada).getByRole("textbox").inputValue(), "Half a sen");
  await ada.page.keyboard.press("Enter");
  await mark(ada, 3, "bea").waitFor();
  await shoot(ada, "cell_taken");
  assert.equal((await record(3)).note, "found 3");
  await bea.page.keyboard.press("Control+a");
  await bea.page.keyboard.type("A whole sentence");
  await bea.page.keyboard.press("Enter");
  await stored(3, "note", "A whole sentence");
  await bubble(ada).getByText("bea took over editing.").waitFor({ state: "detached" });
  await ada.page.keyboard.press("Escape");
  await editor(ada).waitFor({ state: "detached" });
  await mark(bea, 3, "ada").waitFor({ state: "detached" });
});

test("an end of the connection is the end of it", async () => {
  await open_form(ada, 4);
  await mark(bea, 4, "ada").waitFor();
  await ada.page.goto(server.url);
  await mark(bea, 4, "ada").waitFor({ state: "detached" });
  await open_form(bea, 4);
  assert.equal(await note(bea).getAttribute("readonly"), null);

  for (const who of Object.values(everybody)) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of Object.values(everybody)) await who?.close();
  await server?.remove();
});
