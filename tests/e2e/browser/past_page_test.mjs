// The history on the page: two users paint. One of them views earlier states, compares them with
// the newest one, and restores a part.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { with_one_layer } from "../support/js/one-layer.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const past = words.past;
const kEnough = 150; // minimum number of pixels of a visible stroke

let ada, ben, phone, server, model, finds, bone;

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `past_${name}.png`) });
}
const bar = ({ page }) => page.getByRole("region", { name: past.title });
const slider = ({ page }) => page.getByRole("slider", { name: past.slider });
const button = (who, name) => bar(who).getByRole("button", { name, exact: true });
const notice = ({ page }, text) => page.locator("strata-notices").getByText(text);
const texels = async () => (await server.json("GET", `${finds}/statistics`)).texels;
async function stroke(who, from, to) {
  await who.page.keyboard.press("b");
  await who.drag([from, to]);
  await who.saved();
}
/** Waits until the stage shows the state with that sequence. */
const shows = (who, sequence) =>
  who.page
    .locator(`strata-stage canvas[data-scene-sequence="${sequence}"][data-still=true]`)
    .waitFor();
const newest = async () => (await server.json("GET", `/models/${model.id}`)).sequence;

test.beforeAll(async () => {
  [ada, ben, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 }, hasTouch: true }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  ({ model, finds, bone } = await with_one_layer(server, "#0072b2"));
  const people = {
    ada: await server.add_person("ada", "annotator"),
    ben: await server.add_person("ben", "annotator"),
  };
  for (const [who, person] of [
    [ada, people.ada],
    [ben, people.ben],
    [phone, people.ada],
  ]) {
    await who.sign_in(server, person);
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
  }
  for (const who of [ada, ben])
    await who.page.getByRole("button", { name: words.layers.select("Finds") }).click();
});

const states = []; // the sequence and the number of texels after each stroke

test("each edit of both is a state of the history", async () => {
  const begin = await newest();
  states.push([begin, await texels()]);
  for (const [who, y] of [
    [ada, 0.5],
    [ben, 0.57],
    [ada, 0.64],
  ]) {
    await stroke(who, [0.42, y], [0.56, y + 0.02]);
    await wait_for(async () => (await newest()) > states.at(-1)[0], "the stroke in the journal");
    states.push([await newest(), await texels()]);
  }
  await wait_for(async () => (await ada.count(bone)) > 3 * kEnough, "three strokes", 150);
  await ada.page.keyboard.press("v");
  await ada.page.keyboard.press("z");
  await slider(ada).waitFor();
  assert.equal(await slider(ada).getAttribute("aria-valuetext"), past.now);
  await shoot(ada, "now");
});

test("the keyboard steps from edit to edit, with who and what", async () => {
  await slider(ada).focus();
  await ada.page.keyboard.press("ArrowLeft");
  await shows(ada, states[2][0]);
  await bar(ada).getByText("ben painted Finds").waitFor();
  await ada.page.keyboard.press("ArrowLeft");
  await shows(ada, states[1][0]);
  await bar(ada).getByText("ada painted Finds").waitFor();
  const two = await ada.count(bone);
  await shoot(ada, "then");
  await ada.page.keyboard.press("ArrowLeft");
  await shows(ada, states[0][0]);
  await wait_for(async () => (await ada.count(bone)) < two - kEnough, "a picture without strokes");
  await ada.page.keyboard.press("ArrowRight");
  await shows(ada, states[1][0]);
});

test("nobody paints into the past", async () => {
  await ada.page.keyboard.press("b");
  await notice(ada, past.paint_refused).waitFor();
  await ada.page.keyboard.press("Control+z");
  assert.equal(await texels(), states[3][1]);
  await ada.close_notices();
});

test("then is next to now, with a divider that moves", async () => {
  await button(ada, past.compare).click();
  await ada.page.locator(`strata-past-overlay canvas[data-then="${states[1][0]}"]`).waitFor();
  const divider = ada.page.getByRole("slider", { name: past.divider });
  await wait_for(async () => (await ada.count(bone)) > kEnough, "strokes at the right");
  await shoot(ada, "compare");
  await divider.focus();
  await ada.page.keyboard.press("Home");
  await wait_for(async () => (await divider.getAttribute("aria-valuenow")) === "2", "the divider");
  const now = await ada.count(bone);
  await ada.page.keyboard.press("End");
  await wait_for(async () => (await ada.count(bone)) < now - kEnough, "a picture of then alone");
  // the camera moves both sides
  await ada.page.keyboard.press("Home");
  const box = await ada.stage_box();
  const handle = await divider.boundingBox();
  await ada.page.mouse.move(handle.x + handle.width / 2, box.y + 60);
  await ada.page.mouse.down();
  await ada.page.mouse.move(box.x + box.width / 2, box.y + 60, { steps: 4 });
  await ada.page.mouse.up();
  await wait_for(async () => {
    const value = Number(await divider.getAttribute("aria-valuenow"));
    return value > 45 && value < 55;
  }, "the divider in the middle");
  await button(ada, past.compare).click();
  await shows(ada, states[1][0]);
});

test("a part of the layer is restored, after its size was shown", async () => {
  await button(ada, past.restore).click();
  await bar(ada)
    .getByText(/The restore changes/)
    .waitFor();
  await bar(ada).getByRole("button", { name: past.part, exact: true }).click();
  await bar(ada).getByText(past.draw_part).waitFor();
  // an outline around only the third stroke
  await ada.drag([
    [0.36, 0.62],
    [0.62, 0.62],
    [0.62, 0.72],
    [0.36, 0.72],
  ]);
  await bar(ada)
    .getByText(/The restore changes/)
    .waitFor();
  await shoot(ada, "restore");
  await button(ada, past.restore_now).click();
  await notice(ada, past.restored_hint).waitFor();
  const after = await texels();
  assert.ok(after < states[3][1] && after > states[1][1], `${after} texels`);
  assert.equal(await slider(ada).getAttribute("aria-valuetext"), past.now);
  await ada.page.keyboard.press("Control+z");
  await wait_for(async () => (await texels()) === states[3][1], "the restore undone");
});

test("playing ends at now", async () => {
  await slider(ada).focus();
  await ada.page.keyboard.press("Home");
  await bar(ada).getByText(past.before_first).waitFor();
  await bar(ada).getByRole("combobox", { name: past.speed }).selectOption("4");
  await button(ada, past.play).click();
  await button(ada, past.pause).waitFor();
  await button(ada, past.play).waitFor({ timeout: 120_000 });
  assert.equal(await slider(ada).getAttribute("aria-valuetext"), past.now);
  await ada.page.keyboard.press("z");
  assert.equal(await bar(ada).count(), 0);
});

test("a line of the activity shows the model as it was then", async () => {
  const panel = ada.page.locator("strata-activity-panel");
  await open_tab(ada.page, words, words.activity.title);
  await panel
    .getByRole("button", { name: /Show the model as it was/ })
    .first()
    .click();
  await slider(ada).waitFor();
});

test("the history fits a phone, and follows a finger", async () => {
  await phone.page.locator('[data-tour="panel"]').click();
  await phone.page.getByRole("button", { name: past.title, exact: true }).click();
  await slider(phone).waitFor();
  const box = await slider(phone).boundingBox();
  await phone.page.touchscreen.tap(box.x + 2, box.y + box.height / 2);
  await wait_for(
    async () => (await slider(phone).getAttribute("aria-valuetext")) !== past.now,
    "an earlier state",
  );
  await shoot(phone, "phone");
  await button(phone, past.back).click();
  await wait_for(
    async () => (await slider(phone).getAttribute("aria-valuetext")) === past.now,
    "the newest state",
  );
});

test("nobody complained", async () => {
  for (const who of [ada, ben, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, ben, phone]) await who?.close();
  await server?.remove();
});
