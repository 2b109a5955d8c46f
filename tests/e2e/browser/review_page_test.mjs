// A curator turns on the review of a layer's edits. An annotator's edits are hatched and listed.
// They are accepted, rejected with a visible reason, and reopened.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { with_one_layer } from "../support/js/one-layer.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kEnough = 150; // minimum number of pixels of a visible stroke

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `review_${name}.png`) });
}
const notice = ({ page }, text) => page.locator("strata-notices").getByText(text);
const panel = ({ page }) => page.locator("strata-review-panel");
/** Counts the dark pixels of the stage, such as the lines of a hatch. */
async function dark(who) {
  const { data } = await who.picture(await who.stage_box());
  let count = 0;
  for (let at = 0; at < data.length; at += 4)
    if (Math.max(data[at], data[at + 1], data[at + 2]) < 62) ++count;
  return count;
}
const listed = (who) => panel(who).locator("[data-waiting]");
async function stroke_by_ada(from, to) {
  await ada.page.keyboard.press("b");
  await ada.drag([from, to]);
  await ada.saved();
}

let cleo, ada, phone, server, model, finds, bone, texels, bare, painted;

test.beforeAll(async () => {
  [cleo, ada, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  ({ model, finds, bone } = await with_one_layer(server, "#d55e00"));
  texels = async () => (await server.json("GET", `${finds}/statistics`)).texels;
});

test("the curator asks for review by the layer's menu; an annotator is told so", async () => {
  await cleo.sign_in(server, await server.add_person("cleo", "curator"));
  const adas = await server.add_person("ada", "annotator");
  for (const who of [ada, phone]) await who.sign_in(server, adas);
  for (const who of [cleo, ada, phone]) {
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
  }
  assert.equal(await panel(cleo).count(), 0, "no layer asks for review yet");
  for (const who of [ada, cleo])
    await who.page.getByRole("button", { name: words.layers.select("Finds") }).click();
  await ada.page.getByRole("button", { name: words.layers.options("Finds") }).click();
  assert.equal(
    await ada.page.getByRole("menuitem", { name: words.review.begin }).count(),
    0,
    "an annotator is offered to ask for review",
  );
  await ada.page.keyboard.press("Escape");
  await cleo.page.getByRole("button", { name: words.layers.options("Finds") }).click();
  await cleo.page.getByRole("menuitem", { name: words.review.begin }).click();
  await ada.page.locator("strata-layer-panel").getByText(words.review.asked_of_you).waitFor();
  await open_tab(cleo.page, words, words.activity.title);
  await panel(cleo).getByText(words.review.none).waitFor();
});

test("what she paints is hatched for both, and the curator's list has it", async () => {
  bare = await dark(ada);
  await stroke_by_ada([0.46, 0.5], [0.56, 0.52]);
  await stroke_by_ada([0.46, 0.6], [0.56, 0.62]);
  for (const who of [ada, cleo]) {
    await wait_for(async () => (await who.count(bone)) > kEnough, "the strokes", 150);
    await wait_for(async () => (await dark(who)) > bare + kEnough, "their hatch", 150);
  }
  await wait_for(
    async () => (await listed(cleo).count()) === 2,
    "both strokes in the curator's list",
  );
  await open_tab(cleo.page, words, words.layers.title);
  await cleo.page.locator("strata-layer-panel").getByText(words.review.waiting(2)).waitFor();
  await open_tab(cleo.page, words, words.activity.title);
  await open_tab(ada.page, words, words.activity.title);
  await wait_for(async () => (await listed(ada).count()) === 2, "both strokes in her own list");
  assert.equal(
    await panel(ada)
      .getByRole("button", { name: /Accept/ })
      .count(),
    0,
    "an annotator is offered to decide",
  );
  await shoot(ada, "annotator");
  await shoot(cleo, "curator");
});

test("the curator looks at a stroke as its author saw it", async () => {
  await cleo.page.keyboard.press("6"); // selects another view
  await cleo.drawn();
  await listed(cleo).first().click();
  await wait_for(
    async () => (await cleo.count(bone)) > kEnough,
    "the strokes, from where they were painted",
    150,
  );
});

test("she accepts one: its hatch is gone, and its author hears so", async () => {
  painted = await texels();
  await panel(cleo).getByRole("button", { name: "Accept: stroke, ada" }).first().click();
  await notice(cleo, "1 edit accepted").waitFor();
  await notice(ada, words.review.told.accept("cleo", "Finds")).waitFor();
  await wait_for(async () => (await listed(cleo).count()) === 1, "one stroke left");
  assert.equal(await texels(), painted);
});

test("and rejects the other with a reason", async () => {
  await panel(cleo).getByRole("button", { name: "Reject: stroke, ada" }).click();
  await shoot(cleo, "reason");
  await cleo.page.keyboard.type("This is the old restoration");
  await panel(cleo).getByRole("button", { name: words.review.reject, exact: true }).click();
  await notice(ada, words.review.told.reject("cleo", "Finds")).waitFor();
  await notice(ada, "This is the old restoration").waitFor();
  await shoot(ada, "told");
  await wait_for(async () => (await texels()) < painted, "the stroke to go");
  for (const who of [ada, cleo])
    await wait_for(async () => (await dark(who)) < bare + kEnough / 3, "no hatch any more", 150);
});

test("the decision is taken back; once more by the notice, as long as it is there", async () => {
  const { edits } = await server.json("GET", `${finds}/edits?limit=1000`);
  const rejected = edits.find(({ review }) => review === "rejected").sequence;
  await server.json("POST", `${finds}/review`, { decision: "reopen", edits: [rejected] });
  await wait_for(async () => (await listed(cleo).count()) === 1, "it waits again");
  await notice(ada, "reopened the review of your paint").waitFor();
  await cleo.close_notices();
  await panel(cleo).getByRole("button", { name: "Reject: stroke, ada" }).click();
  await panel(cleo).getByRole("button", { name: words.review.reject, exact: true }).click();
  await cleo.page
    .locator("strata-notices")
    .getByRole("button", { name: words.review.take_back })
    .click();
  await wait_for(
    async () => (await texels()) === painted && (await listed(cleo).count()) === 1,
    "the stroke to be back, and to wait again",
  );
  await panel(cleo).getByRole("button", { name: words.review.accept_all }).click();
  await panel(cleo).getByText(words.review.none).waitFor();
  assert.equal(await texels(), painted);
});

test("what was accepted the annotator cannot take back", async () => {
  await ada.page.keyboard.press("Control+z");
  await notice(ada, "Only a curator can undo accepted strokes").waitFor();
  assert.equal(await texels(), painted);
});

test("on a phone", async () => {
  await stroke_by_ada([0.48, 0.4], [0.54, 0.42]);
  await open_tab(phone.page, words, words.activity.title);
  await wait_for(async () => (await listed(phone).count()) === 1, "her stroke on her phone");
  await panel(phone).scrollIntoViewIfNeeded();
  await shoot(phone, "phone");

  for (const who of [cleo, ada, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [cleo, ada, phone]) await who?.close();
  await server?.remove();
});
