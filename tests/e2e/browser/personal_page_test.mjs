// A user's hidden layers and order are kept after a reload and in another browser, and other users
// do not see them. A computed layer is hidden for others at first, is locked, and is marked after
// edits by hand. A user has the same color and name everywhere.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `personal_${name}.png`) });
}
const panel = ({ page }) => page.locator("strata-layer-panel");
const button = (who, name) => panel(who).getByRole("button", { name, exact: true });
const names = async (who) =>
  (await panel(who).locator("li.layer .name").allTextContents()).map((text) => text.trim());
const background = (locator) => locator.evaluate((each) => getComputedStyle(each).backgroundColor);
async function choose_for(who, name, command) {
  await button(who, `Options for ${name}`).click();
  await who.page.getByRole("menuitem", { name: command, exact: true }).click();
}
async function look(who, model) {
  await who.page.goto(`${server.url}/models/${model.id}`);
  await who.drawn();
}

let cleo, elsewhere, ada, server, model, layers, layer, before, order, edits, computed;

test.beforeAll(async () => {
  [cleo, elsewhere, ada] = [await Browser.open(), await Browser.open(), await Browser.open()];
  server = new StrataServer({ demo: true });
  await server.start();
  model = (await server.json("GET", "/models")).models[0];
  layers = `/models/${model.id}/layers`;
  layer = async (slug) =>
    (await server.json("GET", layers)).layers.find((each) => each.slug === slug);
  const cleos = await server.add_person("cleo", "curator");
  const adas = await server.add_person("ada", "annotator");
  await server.json("PATCH", "/users/cleo", { full_name: "Cleo Roe" });
  for (const who of [cleo, elsewhere]) await who.sign_in(server, cleos);
  await ada.sign_in(server, adas);
  for (const who of [cleo, ada]) await look(who, model);
  before = (await server.json("GET", layers)).layers.map(({ id, visible, opacity, order }) => ({
    id,
    visible,
    opacity,
    order,
  }));
});

test("an annotator hides a layer and moves another", async () => {
  order = await names(ada);
  await button(ada, words.layers.hide("cracks")).click();
  await choose_for(ada, order[0], words.layers.down);
  const moved = [order[1], order[0], ...order.slice(2)];
  assert.deepEqual(await names(ada), moved);
  await ada.page.getByText(words.layers.reset_default).waitFor();
  await wait_for(async () => {
    await ada.page.reload();
    await ada.drawn();
    return (
      (await button(ada, words.layers.show("cracks")).count()) === 1 &&
      JSON.stringify(await names(ada)) === JSON.stringify(moved)
    );
  }, "both to be there after a reload");
  await shoot(ada, "kept");
  assert.deepEqual(
    (await server.json("GET", layers)).layers.map(({ id, visible, opacity, order: at }) => ({
      id,
      visible,
      opacity,
      order: at,
    })),
    before,
    "for others nothing has changed",
  );
  assert.deepEqual(await names(cleo), order);
});

test("a curator computes a condition: painted where it holds, hidden for others, locked for everybody", async () => {
  await cleo.page.getByRole("button", { name: words.layers.new }).click();
  await cleo.page.getByRole("radio", { name: /From an expression/ }).click();
  await cleo.page.getByLabel("Expression: a number").fill("z > 0 and not valid(cracks)");
  await cleo.page.getByLabel(words.layer_dialog.name, { exact: true }).fill("Risk");
  await cleo.page.getByRole("button", { name: words.layer_dialog.compute }).click();
  await button(cleo, words.layers.hide("Risk")).waitFor();
  const risk = await layer("risk");
  assert.deepEqual(
    [risk.computed, risk.edited_by_hand, risk.locked, risk.visible, risk.type],
    ["expression", false, true, false, "u8"],
  );
  assert.equal(
    Math.min(...(await server.json("GET", layers)).layers.map((each) => each.order)),
    risk.order,
    "it lies below all others",
  );
  await button(ada, words.layers.show("Risk")).waitFor();
  const { min, max } = await server.json("GET", `${layers}/risk/statistics`);
  assert.deepEqual([min, max], [1, 1]);
  await button(cleo, words.layers.select("Risk")).click();
  await panel(cleo).getByText(words.layers.locked_computed).waitFor();
  edits = async () => (await server.json("GET", `${layers}/risk/edits`)).total;
  computed = await edits();
  await cleo.page.keyboard.press("b");
  await cleo.page
    .locator("strata-brush-panel")
    .getByText("The values of Risk were computed.")
    .waitFor();
  await cleo.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await shoot(cleo, "computed");
  await look(elsewhere, model);
  await button(elsewhere, words.layers.hide("Risk")).waitFor();
});

test("unlocked, it is edited by hand, and says so to everybody", async () => {
  await panel(cleo).getByRole("button", { name: words.layers.unlock_computed }).click();
  await panel(cleo)
    .getByText(/^Edited by hand: .* It does not update automatically\.$/)
    .waitFor();
  assert.equal(await edits(), computed, "nothing was painted while it was locked");
  await cleo.page.keyboard.press("Escape");
  await cleo.page.keyboard.press("b");
  await cleo.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await cleo.saved();
  await wait_for(async () => (await edits()) > computed, "the stroke");
  await button(ada, words.layers.select("Risk")).click();
  await panel(ada)
    .getByText(/^Edited by hand/)
    .waitFor();
  await shoot(cleo, "by_hand");
  await panel(cleo).getByRole("button", { name: words.layers.recompute }).click();
  await cleo.page.getByText(words.layers.overwrite_lead).waitFor();
  await cleo.page
    .locator("strata-question")
    .getByRole("button", { name: words.layers.recompute })
    .click();
  await wait_for(
    async () => (await layer("risk")).edited_by_hand === false,
    "the layer to be as it was computed",
  );
  await panel(cleo).getByText(words.layers.locked_computed).waitFor();
});

test("what everybody sees at first is changed only by asking for it", async () => {
  await button(cleo, words.layers.save_default).click();
  await wait_for(async () => (await layer("risk")).visible, "the default");
  await button(ada, words.layers.reset_default).click();
  await button(ada, words.layers.hide("cracks")).waitFor();
  assert.deepEqual(await names(ada), await names(cleo));
});

test("one colour and one name", async () => {
  const { color } = await server
    .json("GET", "/users")
    .then(({ users }) => users.find(({ user }) => user === "cleo"));
  const wished = `rgb(${rgb(color).join(", ")})`;
  await cleo.close_notices();
  await cleo.page.keyboard.press("c");
  await cleo.page.mouse.click(
    ...(await cleo.stage_box().then((box) => [box.x + box.width / 2, box.y + box.height * 0.6])),
  );
  await cleo.page.locator("strata-comment-card textarea").fill("Is this a fresh break?");
  await cleo.page
    .locator("strata-comment-card")
    .getByRole("button", { name: words.comments.send, exact: true })
    .click();
  await cleo.page.locator("strata-comment-card article").getByText("Cleo Roe").waitFor();
  await open_tab(cleo.page, words, words.activity.title);
  await cleo.page.locator("strata-activity-panel").getByText("Cleo Roe").first().waitFor();
  const marks = {
    account: cleo.page.locator("strata-account-menu .face"),
    presence: cleo.page.locator("strata-people-menu .face").first(),
    "presence of others": ada.page.locator('strata-people-menu .face[title^="Cleo Roe"]').first(),
    comment: cleo.page.locator("strata-comment-card .person-mark").first(),
    pin: cleo.page.locator("strata-comment-pins button").first(),
    activity: cleo.page.locator("strata-activity-panel .person-mark").first(),
  };
  for (const [name, mark] of Object.entries(marks)) {
    await mark.waitFor();
    assert.equal(await background(mark), wished, name);
    if (name !== "pin") assert.equal((await mark.textContent()).trim(), "CR", name);
  }
  await shoot(cleo, "one_colour");

  for (const who of [cleo, elsewhere, ada]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [cleo, elsewhere, ada]) await who?.close();
  await server?.remove();
});
