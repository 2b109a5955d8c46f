// The user's own steps on the page, snapshots on the slider of the history, and changes since a
// state.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const { past, snapshots, steps } = words;

let ada, ben, server, model, layers;

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `steps_${name}.png`) });
}
const bar = ({ page }) => page.getByRole("region", { name: past.title });
const slider = ({ page }) => page.getByRole("slider", { name: past.slider });
const button = (who, name) => bar(who).getByRole("button", { name, exact: true });
const list = ({ page }) => page.getByRole("dialog", { name: steps.title });
const naming = ({ page }) => page.locator("strata-naming-dialog");
const rows = (who) => list(who).locator("[data-step]");
const notice = ({ page }, text) => page.locator("strata-notices").getByText(text);
const texels = async (layer = "finds") =>
  (await server.json("GET", `${layers}/${layer}/statistics`)).texels;
const newest = async () => (await server.json("GET", `/models/${model.id}`)).sequence;
async function stroke(who, from, to) {
  const before = await newest();
  await who.page.keyboard.press("b");
  await who.drag([from, to]);
  await who.saved();
  await wait_for(async () => (await newest()) > before, "the stroke in the journal");
}
const opens = ({ page }) => page.getByRole("button", { name: steps.title, exact: true }).click();
const select = ({ page }, name) =>
  page.getByRole("button", { name: words.layers.select(name) }).click();
/** Returns the number of undone rows. */
const undone = (who) => list(who).locator(".undone").count();

test.beforeAll(async () => {
  [ada, ben] = [await Browser.open(), await Browser.open()];
  server = new StrataServer({ demo: true });
  await server.start();
  model = (await server.json("GET", "/models")).models[0];
  layers = `/models/${model.id}/layers`;
  for (const other of (await server.json("GET", layers)).layers)
    await server.json("PATCH", `${layers}/${other.id}`, { visible: false });
  const palette = { mode: "categorical", points: [{ at: 1, color: "#0072b2", label: "Bone" }] };
  for (const name of ["Finds", "Salts"])
    await server.json("POST", layers, { name, type: "u8", palette });
  for (const [who, name] of [
    [ada, "ada"],
    [ben, "ben"],
  ]) {
    await who.sign_in(server, await server.add_person(name, "annotator"));
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
    await select(who, "Finds");
  }
});

test("the list has the own steps of all layers, the newest first", async () => {
  await opens(ada);
  await list(ada).getByText(steps.none).waitFor();
  await ada.page.keyboard.press("Escape");
  await list(ada).waitFor({ state: "detached" });
  await stroke(ada, [0.42, 0.5], [0.56, 0.52]);
  await stroke(ben, [0.42, 0.54], [0.56, 0.56]);
  await stroke(ada, [0.42, 0.58], [0.56, 0.6]);
  await select(ada, "Salts");
  await stroke(ada, [0.42, 0.64], [0.56, 0.66]);
  await opens(ada);
  await wait_for(async () => (await rows(ada).count()) === 4, "three steps and the begin");
  const told = await rows(ada).allInnerTexts();
  assert.match(told[0], /Painted: Bone[^]*Salts/);
  assert.match(told[1], /Painted: Bone[^]*Finds/);
  assert.match(told[3], new RegExp(steps.before_first));
  assert.equal(await rows(ada).first().getAttribute("aria-current"), "step");
  await shoot(ada, "list");
});

test("a click goes back two steps, and forward again", async () => {
  const [finds, salts] = [await texels(), await texels("salts")];
  await rows(ada).nth(2).click();
  await wait_for(async () => (await undone(ada)) === 2, "two undone steps");
  assert.equal(await texels("salts"), 0);
  assert.ok((await texels()) < finds, "the second stroke on Finds is undone");
  assert.equal(await rows(ada).nth(2).getAttribute("aria-current"), "step");
  await shoot(ada, "back");
  // the list is the same after a reload
  await ada.page.reload();
  await ada.drawn();
  await opens(ada);
  await wait_for(async () => (await undone(ada)) === 2, "two undone steps after a reload");
  await ada.page.keyboard.press("Home");
  await ada.page.keyboard.press("Enter");
  await wait_for(async () => (await undone(ada)) === 0, "no undone step");
  assert.deepEqual([await texels(), await texels("salts")], [finds, salts]);
});

test("a refused step stops the walk with its reason", async () => {
  // a curator locks the layer while the list is open
  const turns = [];
  await ada.page.route("**/undo", async (route) => {
    if (route.request().method() === "POST") {
      turns.push(route.request().url());
      if (turns.length === 2) await server.json("PATCH", `${layers}/finds`, { locked: true });
    }
    await route.continue();
  });
  await list(ada).getByText(steps.before_first).click();
  await notice(ada, steps.refused(1, 3)).waitFor();
  await ada.page.unroute("**/undo");
  assert.equal(turns.length, 2);
  assert.equal(await texels("salts"), 0);
  await shoot(ada, "refused");
  await server.json("PATCH", `${layers}/finds`, { locked: false });
  await ada.page.keyboard.press("Escape");
  await ada.close_notices();
});

test("a state gets a name, and a mark on the slider", async () => {
  await ada.page.keyboard.press("v");
  await ada.page.keyboard.press("z");
  await slider(ada).waitFor();
  await button(ada, snapshots.title).click();
  await bar(ada).getByText(snapshots.none).waitFor();
  await button(ada, snapshots.name_now).click();
  const dialog = naming(ada);
  await dialog.getByRole("textbox", { name: snapshots.fields.name }).fill("Before cleaning");
  await dialog
    .getByRole("textbox", { name: snapshots.fields.text })
    .fill("With the poultice marks");
  await shoot(ada, "naming");
  await dialog.getByRole("button", { name: snapshots.save }).click();
  await bar(ada).locator("[data-snapshot]").waitFor();
  const [stored] = (await server.json("GET", `/models/${model.id}/snapshots`)).snapshots;
  assert.equal(stored.sequence, await newest());
  assert.equal(stored.user, "ada");
  await stroke(ben, [0.42, 0.7], [0.56, 0.72]);
  await button(ada, past.state_named("Before cleaning")).click();
  await ada.page
    .locator(`strata-stage canvas[data-scene-sequence="${stored.sequence}"][data-still=true]`)
    .waitFor();
  await shoot(ada, "snapshot");
});

test("others see the snapshot, but only its author changes it", async () => {
  await ben.page.keyboard.press("v");
  await ben.page.keyboard.press("z");
  await button(ben, snapshots.title).click();
  await bar(ben).locator("[data-snapshot]").waitFor();
  const menu = words.layers.options("Before cleaning");
  await button(ben, menu).click();
  assert.equal(await bar(ben).getByRole("menuitem").count(), 1);
  await ben.page.keyboard.press("Escape");
  await button(ada, menu).click();
  await bar(ada).getByRole("menuitem", { name: snapshots.rename }).click();
  const dialog = naming(ada);
  await dialog.getByRole("textbox", { name: snapshots.fields.name }).fill("Before all");
  await dialog.getByRole("button", { name: words.save, exact: true }).click();
  for (const who of [ada, ben])
    await bar(who).locator("[data-snapshot]").getByText("Before all").waitFor();
});

test("what changed since a state is lit on the surface", async () => {
  await button(ada, past.changes_show).click();
  await bar(ada)
    .getByText(/^Changed: /)
    .waitFor();
  await ada.page.locator("strata-stage .dim").waitFor();
  const [{ sequence }] = (await server.json("GET", `/models/${model.id}/snapshots`)).snapshots;
  const counted = await server.json("POST", `${layers}/finds/difference`, { from: sequence });
  assert.ok(counted.texels > 0);
  const select = await server.json("POST", `/models/${model.id}/select`, {
    changed: { from: sequence, layers: ["finds"] },
  });
  assert.equal(select.texels, counted.texels);
  await button(ada, past.back).click();
  await ada.page.locator("strata-stage .dim").waitFor();
  await shoot(ada, "changes");
  await button(ada, past.changes_show).click();
  await wait_for(
    async () => (await ada.page.locator("strata-stage .dim").count()) === 0,
    "nothing lit",
  );
});

test("a snapshot is deleted after a question", async () => {
  await button(ada, words.layers.options("Before all")).click();
  await bar(ada).getByRole("menuitem", { name: words.layers.delete }).click();
  await ada.page.getByRole("button", { name: words.delete, exact: true }).click();
  for (const who of [ada, ben]) await bar(who).getByText(snapshots.none).waitFor();
  assert.equal((await server.json("GET", `/models/${model.id}/snapshots`)).total, 0);
});

test("nobody complained", async () => {
  ada.assert_no_complaints(["/undo)"]); // the refused undo
  ben.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, ben]) await who?.close();
  await server?.remove();
});
