// Who comes for the first time: the tour of the model's page, by keyboard and by touch, for who paints and who looks.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { active } from "../support/accessible.mjs";
import { Browser } from "../support/browser.mjs";
import { StrataServer, wait_for } from "../support/strata-server.mjs";

const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kTablet = { viewport: { width: 1180, height: 820 }, hasTouch: true, isMobile: true };
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });

const nora = await Browser.open({ tour: true }); // an annotator at a desk
const vic = await Browser.open({ tour: true, ...kPhone }); // who may look
const tablet = await Browser.open({ tour: true, ...kTablet });
const everybody = { nora, vic, tablet };
const server = new StrataServer({ demo: true });
let step = "start";
const say = (text) => console.log((step = text));

async function shoot({ page }, name) {
  if (!output) return;
  await page.screenshot({ path: join(output, `welcome_${name}.png`) });
}

const card_of = ({ page }) => page.getByRole("dialog").and(page.locator("strata-tour section"));
const at_step = (who, name) => who.page.locator(`strata-tour section[data-step=${name}]`).waitFor();
const is_gone = (who) => card_of(who).waitFor({ state: "detached" });
const button = (who, name) => card_of(who).getByRole("button", { name, exact: true });
const progress = (who) => card_of(who).locator(".head .hint").innerText();

/** The card lies in the window, and beside what it marks. */
async function lies_well(who, what) {
  const card = await card_of(who).boundingBox();
  const { width, height } = who.page.viewportSize();
  assert.ok(card.x >= 0 && card.y >= 0 && card.x + card.width <= width && card.y + card.height <= height, `${what}: the card leaves the window: ${JSON.stringify(card)}`);
  const ring = who.page.locator("strata-tour .ring");
  if ((await ring.count()) === 0) return;
  const thing = await ring.boundingBox();
  assert.ok(thing.width > 10 && thing.height > 10, `${what}: nothing is marked: ${JSON.stringify(thing)}`);
  const apart = card.x >= thing.x + thing.width || card.x + card.width <= thing.x || card.y >= thing.y + thing.height || card.y + card.height <= thing.y;
  assert.ok(apart, `${what}: the card covers what it speaks of: ${JSON.stringify({ card, thing })}`);
}

async function open_model(who) {
  await who.page.goto(`${server.url}/models/${model.id}`);
  await who.drawn();
}

/** It would have begun by then: what is asked of the server after the first picture has been answered. */
async function offers_nothing(who) {
  await who.page.getByRole("button", { name: "Help", exact: true }).click();
  await who.page.locator("strata-help-sheet").getByRole("heading", { name: "Help" }).waitFor();
  await who.page.keyboard.press("Escape");
  await who.page.locator("strata-help-sheet").waitFor({ state: "detached" });
  assert.equal(await card_of(who).count(), 0, "the tour offers itself again");
}

let model;
try {
  await server.start();
  [model] = (await server.json("GET", "/models")).models;
  await nora.sign_in(server, await server.add_person("nora", "annotator"));
  await vic.sign_in(server, await server.add_person("vic", "viewer"));
  await tablet.sign_in(server, await server.add_person("tilda", "annotator"));

  say("an annotator opens a model for the first time: the tour offers itself and takes nothing away");
  await open_model(nora);
  await at_step(nora, "turn");
  assert.equal(await progress(nora), "1 of 6");
  assert.equal(await active(nora.page), "", "the tour took the keyboard");
  await nora.page.keyboard.press("b");
  await nora.page.getByRole("button", { name: "Brush", exact: true, pressed: true }).waitFor();
  await nora.page.keyboard.press("v");
  await lies_well(nora, "turn");
  await shoot(nora, "desk_1_turn");

  say("by keyboard: Tab leads to the card, arrows go through it, and never past its ends");
  await nora.page.keyboard.press("Tab");
  assert.match(await active(nora.page), /Skip the tour/);
  await nora.page.keyboard.press("ArrowLeft");
  await at_step(nora, "turn");
  for (const [at, name] of ["layers", "brush", "undo", "values", "share"].entries()) {
    await nora.page.keyboard.press("ArrowRight");
    await at_step(nora, name);
    assert.equal(await progress(nora), `${at + 2} of 6`);
    await lies_well(nora, name);
    await shoot(nora, `desk_${at + 2}_${name}`);
  }
  assert.match(await active(nora.page), /Done/, "the keyboard was lost with the button that went");
  await nora.page.keyboard.press("ArrowRight");
  await at_step(nora, "share");
  await nora.page.keyboard.press("ArrowLeft");
  await at_step(nora, "values");

  say("it stays beside its thing in windows of any size; what is put away it leads to otherwise");
  await nora.page.keyboard.press("ArrowLeft");
  for (const size of [{ width: 700, height: 500 }, { width: 390, height: 844 }, { width: 1600, height: 1000 }, { width: 1280, height: 800 }]) {
    await nora.page.setViewportSize(size);
    const outside = () => lies_well(nora, `${size.width}×${size.height}`).then(() => null, (error) => error);
    await wait_for(async () => (await outside()) === null, `the card to lie beside undo at ${size.width}×${size.height}`);
  }
  await nora.page.keyboard.press("ArrowLeft");
  await nora.page.keyboard.press("ArrowLeft");
  await at_step(nora, "layers");
  await nora.page.getByRole("button", { name: "Hide the panel", exact: true }).click();
  await card_of(nora).getByText("This button brings them.").waitFor();
  await lies_well(nora, "layers without the panel");
  await shoot(nora, "desk_layers_put_away");
  await nora.page.getByRole("button", { name: "Show the panel", exact: true }).click();
  await card_of(nora).getByText("This button brings them.").waitFor({ state: "detached" });

  say("a tour that was not ended is offered again; Escape ends it from anywhere, for good");
  await nora.page.reload();
  await at_step(nora, "turn");
  await nora.page.keyboard.press("Escape");
  await is_gone(nora);
  await nora.page.reload();
  await nora.drawn();
  await offers_nothing(nora);

  say("from the help it begins again, with the keyboard, and gives it back");
  const help = nora.page.getByRole("button", { name: "Help", exact: true });
  await help.focus();
  await nora.page.keyboard.press("Enter");
  await nora.page.getByRole("button", { name: "Show the tour", exact: true }).focus();
  await nora.page.keyboard.press("Enter");
  await at_step(nora, "turn");
  await wait_for(async () => /Next/.test(await active(nora.page)), "the card to have the keyboard");
  for (const name of ["layers", "brush", "undo", "values", "share"]) {
    await nora.page.keyboard.press("Enter");
    await at_step(nora, name);
  }
  await button(nora, "Back").click();
  await at_step(nora, "values");
  await button(nora, "Next").click();
  await button(nora, "Done").focus();
  await nora.page.keyboard.press("Enter");
  await is_gone(nora);
  assert.match(await active(nora.page), /Help/, "the keyboard was not given back");

  say("a viewer with a phone: by touch, without the steps that paint");
  await open_model(vic);
  for (const [at, name] of ["turn", "layers", "values", "share"].entries()) {
    await at_step(vic, name);
    assert.equal(await progress(vic), `${at + 1} of 4`);
    await lies_well(vic, name);
    await shoot(vic, `phone_${at + 1}_${name}`);
    await button(vic, name === "share" ? "Done" : "Next").tap();
  }
  await is_gone(vic);
  await vic.page.reload();
  await vic.drawn();
  await offers_nothing(vic);

  say("a tablet: the fingers turn the model meanwhile, and the tour is skipped by one tap");
  await open_model(tablet);
  await at_step(tablet, "turn");
  await lies_well(tablet, "tablet");
  await button(tablet, "Next").tap();
  await at_step(tablet, "layers");
  await button(tablet, "Next").tap();
  await at_step(tablet, "brush");
  await lies_well(tablet, "tablet: brush");
  await tablet.page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
  await shoot(tablet, "tablet_brush_dark");
  await button(tablet, "Skip the tour").tap();
  await is_gone(tablet);
  await tablet.page.reload();
  await tablet.drawn();
  await offers_nothing(tablet);

  say("the end");
  for (const who of Object.values(everybody)) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
} catch (error) {
  console.log(`failed at: ${step}\n--- log of the server\n${server.log.slice(-100).join("\n")}`);
  for (const [name, who] of Object.entries(everybody)) await shoot(who, `failed_${name}`).catch(() => {});
  throw error;
} finally {
  for (const who of Object.values(everybody)) await who.close();
  await server.remove();
}
