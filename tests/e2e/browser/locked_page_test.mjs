// A curator locks a layer while another user paints on it. That user sees the lock immediately, and
// her page sends no further edits. She can paint again after the layer is unlocked.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kEnough = 150; // minimum number of pixels of a visible stroke

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `locked_${name}.png`) });
}
async function choose_for({ page }, name, command) {
  await page.getByRole("button", { name: `Options for ${name}` }).click();
  await page.getByRole("menuitem", { name: command, exact: true }).click();
}
const cursor = ({ page }) =>
  page.locator("strata-stage .surface").evaluate((surface) => getComputedStyle(surface).cursor);
const notice = ({ page }) =>
  page.locator("strata-notices").getByText(words.layers.locked_detail("Finds"));
const told_in_panel = ({ page }) =>
  page.locator("strata-brush-panel").getByText(words.layers.locked_detail("Finds"));
const lock_of = ({ page }, says) =>
  page.locator("strata-layer-panel").getByRole("img", { name: says });
/** Collects the messages with changes that this page sends after this call. */
function changes_sent({ page }) {
  const sent = [];
  page.on("websocket", (socket) =>
    socket.on("framesent", ({ payload }) => {
      const { op } = JSON.parse(payload);
      if (/^(stroke|edit|undo|redo)/.test(op)) sent.push(op);
    }),
  );
  return sent;
}

let carl,
  ada,
  phone,
  server,
  model,
  layers,
  palette,
  finds,
  bone,
  edits,
  sent,
  texels,
  saved,
  known;

test.beforeAll(async () => {
  [carl, ada, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  model = (await server.json("GET", "/models")).models[0];
  layers = `/models/${model.id}/layers`;
  for (const other of (await server.json("GET", layers)).layers)
    await server.json("PATCH", `${layers}/${other.id}`, { visible: false });
  palette = { mode: "categorical", points: [{ at: 1, color: "#d55e00", label: "Bone" }] };
  await server.json("POST", layers, { name: "Finds", type: "u8", palette });
  finds = `${layers}/finds`;
  bone = rgb(palette.points[0].color);
  edits = async () => (await server.json("GET", `${finds}/edits`)).total;
});

test("a curator and two annotators look at the model; one of them paints", async () => {
  await carl.sign_in(server, await server.add_person("carl", "curator"));
  sent = changes_sent(ada);
  const adas = await server.add_person("ada", "annotator");
  for (const who of [ada, phone]) await who.sign_in(server, adas);
  for (const who of [carl, ada, phone]) {
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
  }
  await ada.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await ada.page.keyboard.press("b");
  await ada.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await ada.saved();
  await wait_for(async () => (await ada.count(bone)) > kEnough, "the stroke", 150);
  assert.equal(await cursor(ada), "none");
  assert.equal(
    await ada.page.getByRole("button", { name: words.layers.options("Finds") }).count(),
    1,
  );
  await ada.page.getByRole("button", { name: words.layers.options("Finds") }).click();
  assert.equal(
    await ada.page.getByRole("menuitem", { name: words.layers.lock, exact: true }).count(),
    0,
    "an annotator is offered to lock",
  );
  assert.ok(
    (await ada.page
      .getByRole("menuitem", { name: /^(Paint from a file|Replace from a raster)/ })
      .count()) > 0,
  );
  await ada.page.keyboard.press("Escape");
});

test("the lock falls while her button is down: what she painted stays, and nothing more is sent", async () => {
  const box = await ada.stage_box();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  const before = await edits();
  await ada.page.mouse.move(...at(0.44, 0.4));
  await ada.page.mouse.down();
  await ada.page.mouse.move(...at(0.48, 0.4), { steps: 5 });
  await wait_for(async () => (await edits()) > before, "the beginning of the stroke to be saved");
  await ada.saved();
  await choose_for(carl, "Finds", words.layers.lock);
  await notice(ada).waitFor();
  await told_in_panel(ada).waitFor();
  await lock_of(ada, words.layers.locked_to_you).waitFor();
  texels = (await server.json("GET", `${finds}/statistics`)).texels;
  [saved, known] = [await edits(), sent.length];
  await ada.page.mouse.move(...at(0.56, 0.44), { steps: 5 });
  await ada.page.mouse.up();
  assert.equal(await cursor(ada), "not-allowed");
  await shoot(ada, "while_painting");
});

test("no tool sends anything, and each says why", async () => {
  for (const key of ["b", "e", "a", "l", "g"]) {
    await ada.page.keyboard.press(key);
    assert.equal(await cursor(ada), "not-allowed", key);
    await told_in_panel(ada).waitFor();
    await ada.drag([
      [0.5, 0.6],
      [0.55, 0.6],
      [0.55, 0.65],
    ]);
  }
  await ada.page.keyboard.press("Control+z");
  await ada.page.keyboard.press("Control+Shift+z");
  await notice(ada).waitFor();
  assert.equal(
    await ada.page.locator("strata-notices").getByText(words.layers.locked).count(),
    1,
    "one notice is enough",
  );
  assert.equal(await ada.page.getByRole("button", { name: words.brush.fill }).count(), 0);
  await ada.page.getByRole("button", { name: words.layers.options("Finds") }).click();
  assert.equal(
    await ada.page
      .getByRole("menuitem", { name: /^(Paint from a file|Replace from a raster)/ })
      .count(),
    0,
  );
  await shoot(ada, "menu");
  await ada.page.keyboard.press("Escape");
  assert.deepEqual(sent.slice(known), [], "changes were sent");
  assert.deepEqual(
    [await edits(), (await server.json("GET", `${finds}/statistics`)).texels],
    [saved, texels],
  );
});

test("another layer is painted as before, and coming back to the locked one says so again", async () => {
  await server.json("POST", layers, { name: "Open", type: "u8", palette });
  await ada.page.getByRole("button", { name: words.layers.select("Open") }).click();
  await ada.page.keyboard.press("b");
  assert.equal(await cursor(ada), "none");
  await ada.drag([
    [0.46, 0.6],
    [0.56, 0.62],
  ]);
  await ada.saved();
  assert.ok(sent.length > known);
  const close = ada.page.locator("strata-notices").getByRole("button", { name: words.close });
  while ((await close.count()) > 0) await close.first().click();
  await ada.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await notice(ada).waitFor();
});

test("on a phone", async () => {
  await phone.page.getByRole("button", { name: words.model.show_panel }).click();
  await lock_of(phone, words.layers.locked_to_you).waitFor();
  await phone.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await phone.page.getByRole("button", { name: words.tools.brush, exact: true }).click();
  await notice(phone).waitFor();
  await told_in_panel(phone).waitFor();
  await shoot(phone, "phone");
});

test("the curator sees the lock, paints all the same, and unlocks", async () => {
  await lock_of(carl, words.layers.locked_to_others).waitFor();
  await carl.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await carl.page.keyboard.press("b");
  assert.equal(await cursor(carl), "none");
  await carl.drag([
    [0.46, 0.7],
    [0.56, 0.72],
  ]);
  await carl.saved();
  await wait_for(async () => (await edits()) > saved, "the curator's stroke");
  await carl.page.locator("strata-layer-panel").getByText("Locked for annotators.").waitFor();
  await shoot(carl, "curator");
  await carl.page.getByRole("button", { name: words.layers.unlock, exact: true }).click();
  await lock_of(ada, words.layers.locked_to_you).waitFor({ state: "detached" });
  await wait_for(async () => (await cursor(ada)) === "none", "her brush to come back");
  const now = await edits();
  await ada.drag([
    [0.44, 0.35],
    [0.52, 0.36],
  ]);
  await wait_for(async () => (await edits()) > now, "her stroke on the unlocked layer");
  await shoot(ada, "unlocked");

  for (const who of [carl, ada, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [carl, ada, phone]) await who?.close();
  await server?.remove();
});
