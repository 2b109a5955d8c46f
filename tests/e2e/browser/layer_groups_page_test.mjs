// Long lists of layers: groups that a curator makes in the layer's dialog and by dragging, and that
// other pages receive immediately. The tests also fold, show and hide a whole group, and use the
// search and the filter.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

let ida, ada, server, layers, button, names, is_listed;

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `groups_${name}.png`) });
}

test.beforeAll(async () => {
  [ida, ada] = [await Browser.open(), await Browser.open()];
  server = new StrataServer({ demo: true });
  await server.start();
  const model = (await server.json("GET", "/models")).models[0];
  layers = `/models/${model.id}/layers`;
  for (const name of ["Salts", "Moss", "Soot"])
    await server.json("POST", layers, {
      name,
      type: "u8",
      ...(name === "Soot" ? { group: "Deposits" } : {}),
    });
  await ida.page.goto(server.link);
  await ada.sign_in(server, await server.add_person("ada", "annotator"));
  for (const who of [ida, ada]) {
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
  }
  const panel = ({ page }) => page.locator("strata-layer-panel");
  button = (who, name) => panel(who).getByRole("button", { name, exact: true });
  names = async (who) =>
    (await panel(who).locator("li .fold .ellipsis, li.layer .name").allTextContents()).map((text) =>
      text.trim(),
    );
  is_listed = (who, expected) =>
    wait_for(
      async () => JSON.stringify(await names(who)) === JSON.stringify(expected),
      `the list ${expected}`,
    );
});

test("a layer gets an existing group in its dialog, and other pages list it there", async () => {
  await is_listed(ida, ["Deposits", "Soot", "Moss", "Salts", "cracks", "pieces"]);
  await button(ida, words.layers.options("Salts")).click();
  await ida.page.getByRole("menuitem", { name: words.layers.edit }).click();
  await ida.page.getByRole("combobox", { name: words.layers.group }).fill("deposits ");
  await ida.page.getByRole("button", { name: words.save, exact: true }).click();
  for (const who of [ida, ada])
    await is_listed(who, ["Deposits", "Soot", "Salts", "Moss", "cracks", "pieces"]);
});

test("a layer is dragged into the group, and stays where it was dropped", async () => {
  const row = (name) => ida.page.locator("strata-layer-panel li.layer", { hasText: name });
  const salts = await row("Salts").boundingBox();
  await row("Moss")
    .locator(".grip")
    .dragTo(row("Salts"), { targetPosition: { x: 60, y: 6 } });
  assert.ok(salts.height > 12);
  for (const who of [ida])
    await is_listed(who, ["Deposits", "Soot", "Moss", "Salts", "cracks", "pieces"]);
  const all = (await server.json("GET", layers)).layers;
  assert.equal(all.find(({ slug }) => slug === "moss").group, "Deposits");
});

test("the eye of a group hides all of its layers, and the name folds it", async () => {
  await button(ida, words.layers.hide("Deposits")).click();
  for (const name of ["Soot", "Moss", "Salts"])
    await button(ida, words.layers.show(name)).waitFor();
  await button(ada, words.layers.hide("Soot")).waitFor(); // the change affected only the other user
  await ida.page.locator("strata-layer-panel .fold").click();
  await is_listed(ida, ["Deposits", "cracks", "pieces"]);
  await shoot(ida, "folded");
  await ida.page.reload();
  await is_listed(ida, ["Deposits", "cracks", "pieces"]);
  await ida.page.locator("strata-layer-panel .fold").click();
  await button(ida, words.layers.show("Deposits")).click();
  for (const name of ["Soot", "Moss", "Salts"])
    await button(ida, words.layers.hide(name)).waitFor();
});

test("a list of more than seven layers has a search and a filter", async () => {
  const field = ida.page.getByRole("textbox", { name: words.layers.find });
  assert.equal(await field.count(), 0);
  for (const name of ["Fill", "Retouching", "Sección"])
    await server.json("POST", layers, { name, type: "u8", locked: name === "Fill" });
  await field.waitFor();
  await shoot(ida, "search");
  await field.fill("SECCION");
  await is_listed(ida, ["Sección"]);
  await field.fill("deposits");
  await is_listed(ida, ["Deposits", "Soot", "Moss", "Salts"]);
  await field.fill("no such layer");
  await ida.page.getByText(words.layers.none_found).waitFor();
  await field.press("Escape");
  await ida.page.getByRole("radio", { name: words.layers.shown.locked }).click();
  await is_listed(ida, ["Fill"]);
  await ida.page.getByRole("radio", { name: words.layers.shown.all }).click();
});

test("a group is dissolved for everybody", async () => {
  await button(ida, words.layers.options("Deposits")).click();
  await ida.page.getByRole("menuitem", { name: words.layers.group_dissolve }).click();
  await wait_for(
    async () => !(await names(ada)).includes("Deposits"),
    "the list without the group",
  );
  assert.equal(await button(ada, words.layers.options("Deposits")).count(), 0);

  for (const who of [ida, ada]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ida, ada]) await who?.close();
  await server?.remove();
});
