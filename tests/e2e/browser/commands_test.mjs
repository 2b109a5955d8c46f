// The command palette: it finds commands by words in any order, runs them by keys and by mouse, and
// lists recently used commands first. Impossible commands are gray and show the reason. The file
// also tests the palette on a phone, and the help, which lists the same keys.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

let ida, phone, server, model, field, option, focused;

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `commands_${name}.png`) });
}
async function look(who) {
  await who.page.goto(`${server.url}/models/${model.id}`);
  await who.drawn();
}

test.beforeAll(async () => {
  ida = await Browser.open();
  phone = await Browser.open({
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  server = new StrataServer({ demo: true });
  await server.start();
  model = (await server.json("GET", "/models")).models[0];
  await ida.page.goto(server.link);
  await look(ida);
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  await look(phone);
  field = ida.page.getByRole("combobox", { name: words.commands.find });
  option = (name) => ida.page.getByRole("option", { name });
  focused = () => ida.page.evaluate(() => document.activeElement?.localName ?? "");
});

test("Ctrl K opens it, and Escape closes it", async () => {
  await ida.page.keyboard.press("Control+k");
  await field.waitFor();
  await wait_for(() => field.evaluate((each) => each.matches(":focus")), "the field's focus");
  await ida.page.keyboard.press("Escape");
  await field.waitFor({ state: "detached" });
});

test("words in any order, in any case, find a layer, and Enter hides it", async () => {
  await ida.page.keyboard.press("Control+k");
  await field.fill("CRACKS hide");
  await shoot(ida, "layer");
  await ida.page.keyboard.press("Enter");
  await ida.page.getByRole("button", { name: words.layers.show("cracks"), exact: true }).waitFor();
  assert.equal(await field.count(), 0);
});

test("the recently used command is the first one", async () => {
  await ida.page.keyboard.press("Control+k");
  const first = ida.page.getByRole("listbox").getByRole("option").first();
  assert.match(await first.textContent(), /Show cracks/);
  assert.equal(await first.getAttribute("aria-selected"), "true");
  await ida.page.keyboard.press("ArrowDown");
  assert.equal(await first.getAttribute("aria-selected"), "false");
  await ida.page.keyboard.press("ArrowUp");
  await ida.page.keyboard.press("Enter");
  await ida.page.getByRole("button", { name: words.layers.hide("cracks"), exact: true }).waitFor();
});

test("a command shows its key and opens a dialog, and its key is in the help", async () => {
  await ida.page.keyboard.press("Control+k");
  await field.fill("help");
  assert.equal(await option(/^Help/).first().locator("kbd").textContent(), "?");
  await option(/^Help/).first().click();
  await ida.page.getByRole("dialog", { name: words.help.title }).waitFor();
  const help = ida.page.locator("strata-help-sheet");
  const row = help.getByRole("term").filter({ hasText: /^\s*B\s*$/ });
  assert.equal(await row.count(), 1);
  await help.getByText(words.help.tool_keys).waitFor();
  await help.getByRole("button", { name: words.commands.title }).click();
  await field.waitFor();
  await ida.page.keyboard.press("Escape");
});

test("a command that is not possible says why, and does nothing", async () => {
  await ida.page.keyboard.press("Control+k");
  await field.fill("table of records");
  const row = option(new RegExp(words.commands.no_table));
  assert.equal(await row.getAttribute("aria-disabled"), "true");
  await ida.page.keyboard.press("Enter");
  await field.waitFor();
  await field.fill("no such command");
  await ida.page.getByText(words.commands.none).first().waitFor();
  await ida.page.keyboard.press("Escape");
});

test("it opens from a field of the page, and gives the focus back", async () => {
  await ida.page.getByRole("slider", { name: words.layers.opacity_of("cracks") }).focus();
  await ida.page.keyboard.press("Control+k");
  await field.waitFor();
  await ida.page.keyboard.press("Escape");
  await field.waitFor({ state: "detached" });
  assert.notEqual(await focused(), "body");
});

test("a viewer on a phone opens it from the help", async () => {
  await phone.page.getByRole("button", { name: words.model.help }).click();
  await phone.page.getByRole("button", { name: words.commands.title }).click();
  const list = phone.page.getByRole("listbox");
  await list.waitFor();
  await shoot(phone, "phone");
  const brush = list.getByRole("option", { name: new RegExp(words.brush.viewer_only) }).first();
  assert.equal(await brush.getAttribute("aria-disabled"), "true");
  const { x, width } = await list.boundingBox();
  assert.ok(x >= 0 && x + width <= 390);
  await list.getByRole("option", { name: "Measure" }).click();
  await phone.page.getByRole("button", { name: "Measure", pressed: true }).waitFor();
});

test("neither browser nor server complains", async () => {
  for (const who of [ida, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const each of [ida, phone]) await each?.close();
  await server?.remove();
});
