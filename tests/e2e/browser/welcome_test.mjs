// First visits: the introduction to the model's page, by keyboard and by touch, for annotators and
// viewers, and a choice of projects.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { active } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { square_ply } from "../support/js/meshes.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kTablet = { viewport: { width: 1180, height: 820 }, hasTouch: true, isMobile: true };
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });

async function shoot({ page }, name) {
  if (!output) return;
  await page.screenshot({ path: join(output, `welcome_${name}.png`) });
}

const card_of = ({ page }) => page.getByRole("dialog").and(page.locator("strata-tour section"));
const at_step = (who, name) => who.page.locator(`strata-tour section[data-step=${name}]`).waitFor();
const is_gone = (who) => card_of(who).waitFor({ state: "detached" });
const button = (who, name) => card_of(who).getByRole("button", { name, exact: true });
const progress = (who) => card_of(who).locator(".head .hint").innerText();

/** Checks that the card is inside the window, next to the marked element. */
async function lies_well(who, what) {
  const card = await card_of(who).boundingBox();
  const { width, height } = who.page.viewportSize();
  assert.ok(
    card.x >= 0 && card.y >= 0 && card.x + card.width <= width && card.y + card.height <= height,
    `${what}: the card leaves the window: ${JSON.stringify(card)}`,
  );
  const ring = who.page.locator("strata-tour .ring");
  if ((await ring.count()) === 0) return;
  const thing = await ring.boundingBox();
  assert.ok(
    thing.width > 10 && thing.height > 10,
    `${what}: nothing is marked: ${JSON.stringify(thing)}`,
  );
  const apart =
    card.x >= thing.x + thing.width ||
    card.x + card.width <= thing.x ||
    card.y >= thing.y + thing.height ||
    card.y + card.height <= thing.y;
  assert.ok(
    apart,
    `${what}: the card covers what it speaks of: ${JSON.stringify({ card, thing })}`,
  );
}

async function open_model(who) {
  await who.page.goto(`${server.url}/models/${model.id}`);
  await who.drawn();
}

/**
 * Checks that no introduction starts. The requests after the first frame have responses, so the
 * page would already show an introduction.
 */
async function offers_nothing(who) {
  await who.page.getByRole("button", { name: words.model.help, exact: true }).click();
  await who.page
    .locator("strata-help-sheet")
    .getByRole("heading", { name: words.help.title })
    .waitFor();
  await who.page.keyboard.press("Escape");
  await who.page.locator("strata-help-sheet").waitFor({ state: "detached" });
  assert.equal(await card_of(who).count(), 0, "the tour offers itself again");
}

const kSquare = square_ply(100); // mm

async function import_square(name, project) {
  const started = await fetch(
    `${server.url}/api/v1/models?filename=square.ply&name=${name}&unit=mm&project=${project}`,
    {
      method: "POST",
      headers: {
        Authorization: `Bearer ${server.token}`,
        "Content-Type": "application/octet-stream",
      },
      body: kSquare,
    },
  );
  assert.equal(started.status, 202, await started.clone().text());
  const { id } = await started.json();
  await wait_for(
    async () => (await server.json("GET", `/jobs/${id}`)).state === "done",
    `the import of ${name}`,
  );
}

let model;

let nora, vic, tablet, everybody, server;

test.beforeAll(async () => {
  nora = await Browser.open({ tour: true }); // an annotator at a desktop computer
  vic = await Browser.open({ tour: true, ...kPhone }); // a viewer with a phone
  tablet = await Browser.open({ tour: true, ...kTablet });
  everybody = { nora, vic, tablet };
  server = new StrataServer({ demo: true });
  await server.start();
  [model] = (await server.json("GET", "/models")).models;
  await nora.sign_in(server, await server.add_person("nora", "annotator"));
  await vic.sign_in(server, await server.add_person("vic", "viewer"));
  await tablet.sign_in(server, await server.add_person("tilda", "annotator"));
});

test("an annotator opens a model for the first time: the tour offers itself and takes nothing away", async () => {
  await open_model(nora);
  await at_step(nora, "turn");
  assert.equal(await progress(nora), "1 of 6");
  assert.equal(await active(nora.page), "", "the tour took the keyboard");
  await nora.page.keyboard.press("b");
  await nora.page
    .getByRole("button", { name: words.tools.brush, exact: true, pressed: true })
    .waitFor();
  await nora.page.keyboard.press("v");
  await lies_well(nora, "turn");
  await shoot(nora, "desk_1_turn");
});

test("by keyboard: Tab leads to the card, arrows go through it, and never past its ends", async () => {
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
});

test("it stays beside its thing in windows of any size; what is put away it leads to otherwise", async () => {
  await nora.page.keyboard.press("ArrowLeft");
  for (const size of [
    { width: 700, height: 500 },
    { width: 390, height: 844 },
    { width: 1600, height: 1000 },
    { width: 1280, height: 800 },
  ]) {
    await nora.page.setViewportSize(size);
    const outside = () =>
      lies_well(nora, `${size.width}×${size.height}`).then(
        () => null,
        (error) => error,
      );
    await wait_for(
      async () => (await outside()) === null,
      `the card to lie beside undo at ${size.width}×${size.height}`,
    );
  }
  await nora.page.keyboard.press("ArrowLeft");
  await nora.page.keyboard.press("ArrowLeft");
  await at_step(nora, "layers");
  await nora.page.getByRole("button", { name: words.model.hide_panel, exact: true }).click();
  await card_of(nora).getByText(words.tour.steps.layers.way).waitFor();
  await lies_well(nora, "layers without the panel");
  await shoot(nora, "desk_layers_put_away");
  await nora.page.getByRole("button", { name: words.model.show_panel, exact: true }).click();
  await card_of(nora).getByText(words.tour.steps.layers.way).waitFor({ state: "detached" });
});

test("a tour that was not ended is offered again; Escape ends it from anywhere, for good", async () => {
  await nora.page.reload();
  await at_step(nora, "turn");
  await nora.page.keyboard.press("Escape");
  await is_gone(nora);
  await nora.page.reload();
  await nora.drawn();
  await offers_nothing(nora);
});

test("from the help it begins again, with the keyboard, and gives it back", async () => {
  const help = nora.page.getByRole("button", { name: words.model.help, exact: true });
  await help.focus();
  await nora.page.keyboard.press("Enter");
  await nora.page.getByRole("button", { name: words.tour.again, exact: true }).focus();
  await nora.page.keyboard.press("Enter");
  await at_step(nora, "turn");
  await wait_for(async () => /Next/.test(await active(nora.page)), "the card to have the keyboard");
  for (const name of ["layers", "brush", "undo", "values", "share"]) {
    await nora.page.keyboard.press("Enter");
    await at_step(nora, name);
  }
  await button(nora, words.tour.back).click();
  await at_step(nora, "values");
  await button(nora, words.tour.next).click();
  await button(nora, words.tour.done).focus();
  await nora.page.keyboard.press("Enter");
  await is_gone(nora);
  assert.match(await active(nora.page), /Help/, "the keyboard was not given back");
});

test("a viewer with a phone: by touch, without the steps that paint", async () => {
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
});

test("a tablet: the fingers turn the model meanwhile, and the tour is skipped by one tap", async () => {
  await open_model(tablet);
  await at_step(tablet, "turn");
  await lies_well(tablet, "tablet");
  await button(tablet, words.tour.next).tap();
  await at_step(tablet, "layers");
  await button(tablet, words.tour.next).tap();
  await at_step(tablet, "brush");
  await lies_well(tablet, "tablet: brush");
  await tablet.page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
  await shoot(tablet, "tablet_brush_dark");
  await button(tablet, words.tour.skip).tap();
  await is_gone(tablet);
  await tablet.page.reload();
  await tablet.drawn();
  await offers_nothing(tablet);
});

test("with one project home shows its models, as ever", async () => {
  await nora.page.goto(server.url);
  await nora.page.getByRole("heading", { name: words.home.title, exact: true }).waitFor();
  await nora.page.getByRole("link", { name: words.home.open("Demo pot") }).waitFor();
});

test("with several a project is chosen first; the empty ones are last, and say so", async () => {
  await server.json("POST", "/projects", {
    name: "Villa Giulia",
    description: "Frescoes of the east wing, campaign of 2026.",
  });
  await server.json("POST", "/projects", { name: "Archive" });
  await import_square("Threshold", "villa-giulia");
  await import_square("Lintel", "villa-giulia");
  for (const who of [nora, vic, tablet]) {
    await who.page.goto(server.url);
    await who.page.getByRole("heading", { name: words.home.projects, exact: true }).waitFor();
    // content below the window's edge is loaded when it becomes visible
    for (const each of await who.page.locator("strata-project-card").all()) {
      await each.scrollIntoViewIfNeeded();
      await each.getByText(/changed (today|yesterday)/).waitFor();
    }
    await wait_for(
      async () => (await who.page.locator("strata-thumbnail canvas.drawn").count()) === 2,
      "a picture of each project with models",
    );
    await who.page.locator("strata-project-card").first().scrollIntoViewIfNeeded();
  }
  const names = () => nora.page.locator("strata-project-card b").allInnerTexts();
  assert.deepEqual(await names(), ["Demo", "Villa Giulia", "Archive"]);
  await nora.page.getByRole("link", { name: /^Villa Giulia.*2 models · changed/s }).waitFor();
  await nora.page.getByRole("link", { name: /^Archive.*No models yet/s }).waitFor();
  await shoot(nora, "gallery_desk");
  await shoot(vic, "gallery_phone");
  await tablet.page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
  await shoot(tablet, "gallery_tablet_dark");
});

test("a project is gone to by keyboard; its address leads there, and Back to the others", async () => {
  await nora.page.getByRole("link", { name: /^Villa Giulia/ }).focus();
  await nora.page.keyboard.press("Enter");
  await nora.page.getByRole("heading", { name: "Villa Giulia", exact: true }).waitFor();
  assert.equal(nora.page.url(), `${server.url}/projects/villa-giulia`);
  assert.equal(await nora.page.title(), "Villa Giulia – Strata");
  await wait_for(
    async () => /Villa Giulia/.test(await active(nora.page)),
    "the keyboard to be at the head of the project",
  );
  await nora.page.getByText(words.home.count(2)).waitFor();
  const models_of = ({ page }) =>
    page
      .getByRole("link", { name: /^Open / })
      .evaluateAll((links) => links.map((link) => link.getAttribute("aria-label")).sort());
  assert.deepEqual(await models_of(nora), ["Open Lintel", "Open Threshold"]);
  await wait_for(
    async () => (await nora.page.locator("strata-thumbnail canvas.drawn").count()) === 2,
    "the pictures",
  );
  await shoot(nora, "project_desk");
  await nora.page.goBack();
  await nora.page.getByRole("heading", { name: words.home.projects, exact: true }).waitFor();
  assert.equal(await nora.page.title(), "Strata");
  await nora.page.goForward();
  await nora.page.getByRole("heading", { name: "Villa Giulia", exact: true }).waitFor();
  await nora.page.getByRole("link", { name: words.home.open("Lintel") }).click();
  await nora.drawn();
  await nora.page.getByRole("link", { name: words.model.back }).click();
  await nora.page.getByRole("heading", { name: "Villa Giulia", exact: true }).waitFor();
  await nora.page.getByRole("link", { name: words.home.all_projects }).click();
  await nora.page.getByRole("heading", { name: words.home.projects, exact: true }).waitFor();
  await vic.page.goto(`${server.url}/projects/villa-giulia`);
  await vic.page.getByRole("link", { name: words.home.open("Lintel") }).waitFor();
  await shoot(vic, "project_phone");
});

test("where nothing is, it says what to do: wait for a curator, import, ask for a role", async () => {
  await vic.page.goto(`${server.url}/projects/archive`);
  await vic.page.getByText(words.home.empty_viewer).waitFor();
  assert.equal(await vic.page.getByRole("button", { name: words.home.choose_file }).count(), 0);
  await shoot(vic, "empty_phone");
  await vic.page.goto(`${server.url}/projects/nowhere`);
  await vic.page.getByRole("heading", { name: words.home.missing_title }).waitFor();
  await vic.page.getByRole("link", { name: words.home.all_projects }).tap();
  await vic.page.getByRole("heading", { name: words.home.projects, exact: true }).waitFor();
  await tablet.sign_in(server, await server.add_person("gil", "guest"));
  await tablet.page.getByRole("heading", { name: words.home.no_projects }).waitFor();
  await tablet.page.getByText(words.home.empty_guest).waitFor();
  await shoot(tablet, "no_project_tablet");
});

test("what a curator imports on the page of a project lies in it", async () => {
  await nora.sign_in(server, await server.add_person("carl", "curator"));
  await nora.page.goto(`${server.url}/projects/archive`);
  await nora.page.getByRole("button", { name: words.home.choose_file }).waitFor();
  assert.equal(
    await nora.page.getByRole("combobox", { name: words.home.into }).count(),
    0,
    "another project can be chosen on the page of one",
  );
  await shoot(nora, "empty_curator");
  await nora.page.locator("input[type=file]").setInputFiles({
    name: "sill.ply",
    mimeType: "application/octet-stream",
    buffer: Buffer.from(kSquare),
  });
  await nora.page.waitForURL(/\/models\/\d+$/);
  const made = (await server.json("GET", "/models")).models.find(({ name }) => name === "sill");
  assert.equal(made?.project, "archive");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of Object.values(everybody)) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of Object.values(everybody)) await who?.close();
  await server?.remove();
});
