// The trash on the page: Undo after a deletion, the list of a project's deleted content, and the
// rights of each role. The tests use keyboard, mouse and touch.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });

const shoot = async ({ page }, name) => {
  if (output) await page.screenshot({ path: join(output, `bin_${name}.png`) });
};
const button = ({ page }, name) => page.getByRole("button", { name, exact: true });
const menu = async (who, label, command) => {
  await button(who, label).click();
  await who.page.getByRole("menuitem", { name: command, exact: true }).click();
};
const bin = ({ page }) => page.locator("strata-bin-dialog");
const entry = (who, name) => bin(who).locator("li", { hasText: name });
const notice = ({ page }, text) => page.locator("strata-notices").getByText(text);
const undo = (who) =>
  who.page.locator("strata-notices").getByRole("button", { name: words.model.undo, exact: true });
const layers_of = async () =>
  (await server.json("GET", `${kBase}/layers`)).layers.map(({ name }) => name);
// a model that is deleted before its thumbnail is drawn would cause a refused request
const pictured = ({ page }) => page.locator("strata-thumbnail canvas.drawn").waitFor();
const confirm = async ({ page }, name) => {
  const question = page.locator("strata-dialog").last();
  await question.getByRole("button", { name, exact: true }).click();
};

let carl, phone, bea, everybody, server, pot, before, layer, name;

test.beforeAll(async () => {
  carl = await Browser.open(); // a curator at a desktop computer
  phone = await Browser.open({ ...kPhone, colorScheme: "dark" }); // the phone of an administrator
  // an annotator with a tablet
  bea = await Browser.open({ viewport: { width: 1180, height: 820 } });
  everybody = { carl, phone, bea };
  server = new StrataServer({ demo: true });
  await server.start();
  [pot] = (await server.json("GET", "/models")).models;
  await server.json("POST", `${kBase}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name" }],
    palette: { mode: "categorical", points: [{ at: 1, color: "#2c6a63" }] },
  });
  await server.json("POST", "/tables/finds/records", { values: { name: "Handle" } });
  await carl.sign_in(server, await server.add_person("carl", "curator"));
  await phone.sign_in(server, await server.add_person("pia", "administrator"));
  await bea.sign_in(server, await server.add_person("bea", "annotator"));
});

test("a layer that was deleted comes back by Undo", async () => {
  before = await layers_of();
  [layer] = (await server.json("GET", `${kBase}/layers`)).layers;
  ({ name } = layer);
  await carl.page.goto(`${server.url}/models/${pot.id}`);
  await carl.drawn();
  await menu(carl, `Options for ${name}`, words.layers.delete);
  await carl.page.getByText(words.bin.kept(30)).waitFor();
  await shoot(carl, "question");
  await confirm(carl, words.delete);
  await notice(carl, `The layer “${name}” was deleted.`).waitFor();
  await shoot(carl, "undo");
  assert.deepEqual((await layers_of()).includes(name), false);
  await undo(carl).click();
  await notice(carl, words.bin.restored(name)).waitFor();
  await button(carl, `Options for ${name}`).waitFor();
  assert.deepEqual(await layers_of(), before);
});

test("the Bin lists it, and gives it back by keys", async () => {
  await menu(carl, `Options for ${name}`, words.layers.delete);
  await confirm(carl, words.delete);
  await notice(carl, `The layer “${name}” was deleted.`).waitFor();
  await menu(carl, words.layers.more, words.bin.open);
  await entry(carl, name).waitFor();
  await shoot(carl, "list");
  assert.match(await entry(carl, name).textContent(), /Layer of Demo pot[\s\S]*deleted by carl/);
  await entry(carl, name)
    .getByRole("button", { name: `Restore ${name}` })
    .focus();
  await carl.page.keyboard.press("Enter");
  await bin(carl).getByText(words.bin.restored(name)).waitFor();
  await bin(carl).getByText(words.bin.none).waitFor();
  assert.deepEqual(await layers_of(), before);
  await carl.page.keyboard.press("Escape");
  await wait_for(async () => (await bin(carl).count()) === 0, "the Bin to close");
});

test("annotators find records in it, and nothing else", async () => {
  await server.request("DELETE", `${kBase}/layers/${layer.id}`);
  await bea.page.goto(`${server.url}/models/${pot.id}`);
  await bea.drawn();
  await menu(bea, words.layers.options("Finds"), words.tables.open);
  await bea.page.getByRole("rowheader", { name: /^1\b/ }).click();
  await button(bea, words.tables.delete).click();
  await confirm(bea, words.delete);
  await notice(bea, words.bin.deleted.record("Handle")).waitFor();
  await undo(bea).click();
  await notice(bea, words.bin.restored("Handle")).waitFor();
  await bea.page.getByRole("rowheader", { name: /^1\b/ }).click();
  await button(bea, words.tables.delete).click();
  await confirm(bea, words.delete);
  await notice(bea, words.bin.deleted.record("Handle")).waitFor();
  await menu(bea, words.tables.more, words.bin.open);
  await entry(bea, "Handle").waitFor();
  assert.equal(await bin(bea).locator("li").count(), 1, "layers are for curators");
  assert.equal(
    await bin(bea)
      .getByRole("button", { name: /permanently/ })
      .count(),
    0,
  );
  await shoot(bea, "records");
  await button(bea, words.bin.restore_of("Handle")).click();
  await bin(bea).getByText(words.bin.restored("Handle")).waitFor();
});

test("a model comes back, too, and its project waits for it", async () => {
  await phone.page.goto(`${server.url}/projects/${pot.project}`);
  await phone.page.getByRole("link", { name: words.home.open("Demo pot") }).waitFor();
  await pictured(phone);
  await menu(phone, words.home.options("Demo pot"), words.layers.delete);
  await confirm(phone, words.delete);
  await notice(phone, words.home.deleted("Demo pot")).waitFor();
  await phone.page.getByText(words.home.empty_title).waitFor();
  await undo(phone).tap();
  await phone.page.getByRole("link", { name: words.home.open("Demo pot") }).waitFor();
  await pictured(phone);
  await menu(phone, words.home.options("Demo pot"), words.layers.delete);
  await confirm(phone, words.delete);
  await phone.page.getByText(words.home.empty_title).waitFor();
  await menu(phone, words.home.options("Demo"), words.layers.delete);
  await phone.page
    .getByRole("heading", { name: words.projects.kept_by_bin_title("Demo") })
    .waitFor();
  await shoot(phone, "project_kept");
  await phone.page
    .locator("strata-delete-project-dialog")
    .getByRole("button", { name: words.bin.open })
    .tap();
  await entry(phone, "Demo pot").waitFor();
  await shoot(phone, "phone");
  await button(phone, words.bin.restore_of("Demo pot")).tap();
  await bin(phone).getByText(words.bin.restored("Demo pot")).waitFor();
  await bin(phone).getByRole("button", { name: words.close }).last().tap();
});

test("for ever is asked before, and is for ever", async () => {
  await phone.page.goto(`${server.url}/projects/${pot.project}`);
  await menu(phone, words.home.options("Demo"), words.bin.open);
  await entry(phone, name).waitFor();
  await button(phone, words.bin.erase_of(name)).tap();
  await phone.page.getByRole("heading", { name: words.bin.erase_title(name) }).waitFor();
  await shoot(phone, "for_ever");
  await confirm(phone, words.bin.erase_yes);
  await bin(phone).getByText(words.bin.erased(name)).waitFor();
  assert.deepEqual((await server.json("GET", `/projects/${pot.project}/bin`)).entries, []);
  assert.equal((await layers_of()).includes(name), false);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  // the thumbnail of a card, while the model is moved to the trash
  for (const who of Object.values(everybody)) who.assert_no_complaints(["/frame)"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const browser of Object.values(everybody)) await browser?.close();
  await server?.remove();
});
