// Saved views on the page: created, opened and left again, and opened by their link in another
// user's browser. They are renamed, changed and deleted, which others see immediately. The tests
// use mouse, keyboard and touch. Viewers have no controls to change views.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_on_picture, open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kExpected = ["status of 412"]; // responses that the test causes

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `views_${name}.png`) });
};
const panel = ({ page }) => page.locator("strata-view-panel");
const list = ({ page }) => page.locator("strata-view-list");
const row = (who, name) => list(who).locator("li", { hasText: name });
const go = (who, name) => row(who, name).locator("button.go");
const dialog = ({ page }) => page.locator("strata-view-dialog");
const notice = ({ page }, text) => page.locator("strata-notices .notice", { hasText: text });
const bar = ({ page }) => page.locator("strata-picture-bar");
const radio = (who, name) => bar(who).getByRole("radio", { name, exact: true });
const is_chosen = async (who, name) =>
  (await radio(who, name).getAttribute("aria-checked")) === "true";
const gone = (locator) => locator.waitFor({ state: "detached" });
const views = async () => (await server.json("GET", `${kBase}/views`)).views;
const from_menu = async (who, name, item) => {
  await row(who, name)
    .getByRole("button", { name: `Options for ${name}` })
    .click();
  await row(who, name).getByRole("menuitem", { name: item, exact: true }).click();
};
const is_current = (who, name) =>
  wait_for(
    async () => (await go(who, name).getAttribute("aria-current")) === "true",
    `${name} to be the view that is seen`,
  );
/**
 * Returns the frame of the model once it is stable, without overlays. Move the camera last: the
 * frame of that camera also shows the changes before.
 */
const picture = async (who) => {
  let last = null;
  await who.rested();
  return wait_for(
    async () => {
      const now = await who.page
        .locator("strata-stage canvas")
        .first()
        .evaluate((canvas) => canvas.toDataURL());
      const same = now === last;
      last = now;
      return same ? now : null;
    },
    "the picture to settle",
    400,
  );
};
const becomes = (who, wanted, what) => wait_for(async () => (await picture(who)) === wanted, what);
const surface = (who) => who.page.locator("strata-stage .surface").focus();

async function open_model(who, hash = "") {
  await who.page.goto(`${server.url}/models/${id}${hash}`);
  await who.drawn();
}
async function open_panel(who) {
  await open_tab(who.page, words, words.view.title);
  await list(who).waitFor();
  for (const part of ["light", "section"]) await open_on_picture(who.page, words, words.view[part]);
}
let id;

let ada, bea, phone, server, layers, kept, made, link;

test.beforeAll(async () => {
  [ada, bea, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ ...kPhone, colorScheme: "dark" }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  layers = (await server.json("GET", `${kBase}/layers`)).layers;
  // otherwise the page asks curators to confirm the scale
  id = (await server.json("PATCH", kBase, { scale_verified: true })).id;
  await ada.sign_in(server, await server.add_person("ada", "annotator"));
  await bea.sign_in(server, await server.add_person("bea", "annotator"));
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  await ada.page
    .context()
    .grantPermissions(["clipboard-read", "clipboard-write"], { origin: server.url });
});

test("what is seen is kept under a name, and others have it at once", async () => {
  await open_model(ada);
  await open_model(bea);
  await open_panel(ada);
  await open_panel(bea);
  await list(ada).getByText(words.kept_views.none).waitFor();
  await shot(ada, "empty");
  await radio(ada, words.view.lights.raking).click();
  await open_tab(ada.page, words, words.layers.title);
  await ada.page.getByRole("button", { name: `Hide ${layers[0].name}` }).click();
  await open_tab(ada.page, words, words.view.title);
  await surface(ada);
  for (const key of ["4", "ArrowUp", "ArrowRight", "+", "+", "o"])
    await ada.page.keyboard.press(key);
  await radio(ada, words.view.sections.x).click();
  await bar(ada).getByLabel(words.view.cut_position).fill("620");
  kept = await picture(ada);
  await list(ada).getByRole("button", { name: words.kept_views.keep }).click();
  await dialog(ada).getByRole("button", { name: words.kept_views.keep_yes, exact: true }).click();
  assert.equal(
    await dialog(ada)
      .getByLabel(words.kept_views.name)
      .evaluate((input) => input.validity.valueMissing),
    true,
  );
  await dialog(ada).getByLabel(words.kept_views.name).fill("West wall");
  await dialog(ada)
    .getByLabel(words.kept_views.text)
    .fill("The breaks of the rim, cut open.\nIn raking light from the left.");
  await shot(ada, "keep");
  await dialog(ada).getByRole("button", { name: words.kept_views.keep_yes, exact: true }).click();
  await gone(dialog(ada));
  await go(bea, "West wall").waitFor();
  await is_current(ada, "West wall");
  [made] = await views();
  assert.deepEqual(
    [made.name, made.slug, made.user, made.light.mode, made.camera.section.length],
    ["West wall", "west-wall", "ada", "raking", 1],
  );
  assert.deepEqual(
    made.layers.map(({ layer, visible }) => [layer, visible]).sort(),
    layers.map(({ id: layer, visible }, index) => [layer, index > 0 && visible]).sort(),
  );
});

test("going elsewhere and back to it shows the same pixels, and leads back to what was seen before", async () => {
  await panel(ada).getByRole("button", { name: words.view.reset }).click();
  await open_tab(ada.page, words, words.layers.title);
  await ada.page.getByRole("button", { name: `Show ${layers[0].name}` }).click();
  await open_tab(ada.page, words, words.view.title);
  await surface(ada);
  for (const key of ["p", "Home", "ArrowLeft", "ArrowLeft"]) await ada.page.keyboard.press(key);
  assert.equal(await go(ada, "West wall").getAttribute("aria-current"), "false");
  const own = await picture(ada);
  assert.notEqual(own, kept);
  await go(ada, "West wall").focus();
  await ada.page.keyboard.press("Enter");
  await is_current(ada, "West wall");
  await becomes(ada, kept, "the pixels that were kept");
  assert.match(ada.page.url(), /#view=west-wall$/);
  await shot(ada, "there");
  await list(ada).getByRole("button", { name: words.kept_views.back }).click();
  await becomes(ada, own, "the pixels that were seen before");
  assert.deepEqual(
    [await is_chosen(ada, words.view.lights.museum), await is_chosen(ada, words.view.sections.off)],
    [true, true],
  );
  assert.equal(await list(ada).getByRole("button", { name: words.kept_views.back }).count(), 0);
});

test("its link leads there in somebody else's browser", async () => {
  await from_menu(ada, "West wall", words.kept_views.copy_link);
  await notice(ada, words.kept_views.copied).waitFor();
  link = await ada.page.evaluate(() => navigator.clipboard.readText());
  assert.equal(link, `${server.url}/models/${id}#view=west-wall`);
  await bea.page.goto(`${server.url}/`);
  // the notice closes after some seconds, so the test waits for it from the beginning
  const told = notice(bea, words.kept_views.shown("West wall")).getByText("The breaks of the rim");
  await Promise.all([told.waitFor(), bea.page.goto(link)]);
  await bea.drawn();
  await is_current(bea, "West wall");
  await becomes(bea, kept, "the same pixels there");
  await shot(bea, "link");
  assert.deepEqual(
    [await is_chosen(bea, words.view.lights.raking), await is_chosen(bea, words.view.sections.x)],
    [true, true],
  );
  await open_tab(bea.page, words, words.layers.title);
  await bea.page.getByRole("button", { name: `Show ${layers[0].name}` }).waitFor();
  await open_tab(bea.page, words, words.view.title);
  await surface(bea);
  await bea.page.keyboard.press("ArrowLeft");
  await wait_for(
    async () => !bea.page.url().includes("#"),
    "the address to name no view that is not seen",
  );
});

test("it gets another name, and its link goes on", async () => {
  await from_menu(ada, "West wall", words.projects.describe);
  assert.equal(await dialog(ada).getByLabel(words.kept_views.name).inputValue(), "West wall");
  await dialog(ada).getByLabel(words.kept_views.name).fill("North wall");
  await ada.page.route("**/views/*", async (route) => {
    if (route.request().method() === "PATCH")
      await server.json("PATCH", `${kBase}/views/${made.id}`, { name: "East wall" });
    await route.continue();
  });
  await dialog(ada).getByRole("button", { name: words.save }).click();
  await dialog(ada).getByRole("alert").getByText(words.kept_views.changed("East wall")).waitFor();
  await shot(ada, "stale");
  await ada.page.unroute("**/views/*");
  assert.equal(await dialog(ada).getByLabel(words.kept_views.name).inputValue(), "North wall");
  await dialog(ada).getByRole("button", { name: words.save }).click();
  await gone(dialog(ada));
  await go(bea, "North wall").waitFor();
  assert.equal((await views())[0].slug, "west-wall");
});

test("who did not make it is offered its link alone", async () => {
  await row(bea, "North wall").getByRole("button", { name: "Options for North wall" }).click();
  assert.deepEqual(await row(bea, "North wall").getByRole("menuitem").allTextContents(), [
    words.kept_views.copy_link,
    words.figures.of_view,
  ]);
  await shot(bea, "menu");
  await bea.page.keyboard.press("Escape");
});

test("it shows something else instead, and that is taken back", async () => {
  await from_menu(ada, "North wall", words.kept_views.replace);
  await notice(ada, words.kept_views.replaced("North wall")).waitFor();
  assert.equal((await views())[0].light.mode, "museum");
  await is_current(ada, "North wall");
  await notice(ada, words.kept_views.replaced("North wall"))
    .getByRole("button", { name: words.kept_views.undo })
    .click();
  await wait_for(async () => (await views())[0].light.mode === "raking", "what it showed before");
});

test("a section that is none of the page's own is kept as it is, and can be turned off", async () => {
  const [view] = await views();
  const { id: _i, slug: _s, user: _u, time: _t, version: _v, ...content } = view;
  const oblique = {
    ...content.camera,
    section: [
      [0.6, 0.6, 0.5, -30],
      [-0.6, 0.6, -0.5, 1000],
    ],
  };
  await server.json("POST", `${kBase}/views`, {
    ...content,
    name: "Oblique",
    text: "",
    camera: oblique,
  });
  await go(ada, "Oblique").click();
  await bar(ada).getByText(words.view.section_of_view(2)).waitFor();
  const cut = await picture(ada);
  await shot(ada, "oblique");
  await bar(ada).getByRole("button", { name: words.view.section_remove }).click();
  await wait_for(async () => (await picture(ada)) !== cut, "the whole pot");
  assert.equal(await is_chosen(ada, words.view.sections.off), true);
});

test("keys step through them", async () => {
  await surface(ada);
  await ada.page.keyboard.press("n");
  await is_current(ada, "North wall");
  await ada.page.keyboard.press("Shift+N");
  await is_current(ada, "Oblique");
  await notice(ada, words.kept_views.shown("Oblique"))
    .getByRole("button", { name: words.kept_views.back })
    .click();
  await gone(notice(ada, words.kept_views.shown("Oblique")));
  await wait_for(
    async () => (await go(ada, "Oblique").getAttribute("aria-current")) === "false",
    "the way back",
  );
});

test("on a phone, in another window, a finger goes there; who only looks is not offered to keep or change", async () => {
  await open_model(phone);
  await phone.page.getByRole("button", { name: words.model.show_panel }).click();
  await open_panel(phone);
  assert.equal(await list(phone).getByRole("button", { name: words.kept_views.keep }).count(), 0);
  await go(phone, "North wall").tap();
  await is_current(phone, "North wall");
  await go(phone, "North wall").scrollIntoViewIfNeeded();
  await shot(phone, "phone");
  await row(phone, "North wall").getByRole("button", { name: "Options for North wall" }).click();
  assert.equal(await row(phone, "North wall").getByRole("menuitem").count(), 2);
  await phone.page.keyboard.press("Escape");
});

test("deleted it is gone for everybody, and its link says so", async () => {
  await from_menu(ada, "North wall", words.layers.delete);
  await shot(ada, "delete");
  await ada.page.getByRole("button", { name: words.cancel }).click();
  await from_menu(ada, "North wall", words.layers.delete);
  await ada.page.locator("strata-dialog").getByRole("button", { name: words.delete }).click();
  for (const who of [ada, bea, phone]) await gone(go(who, "North wall"));
  await bea.page.goto(`${server.url}/`);
  await Promise.all([notice(bea, words.kept_views.missing).waitFor(), bea.page.goto(link)]);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [ada, bea, phone]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, bea, phone]) await who?.close();
  await server?.remove();
});
