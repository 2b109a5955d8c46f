// The layout at the window sizes of phones, tablets, desktop computers and wall displays. The
// selected element becomes visible, menus stay inside the window, and scrolling rows show that they
// scroll. Texts match the available pointers, and are readable on wall displays.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { active } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kTablet = { width: 820, height: 1180 };
const kDesk = { width: 1280, height: 800 };
const kLarge = { width: 2560, height: 1440 };
const kWall = { width: 3840, height: 2160 };
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });
const shoot = async (who, name) =>
  output && (await who.page.screenshot({ path: join(output, `layout_${name}.png`) }));
const button = (name) => page.getByRole("button", { name, exact: true });
const root_font_px = () =>
  page.evaluate(() => parseFloat(getComputedStyle(document.documentElement).fontSize));

let desk, phone, server, page, model;

test.beforeAll(async () => {
  desk = await Browser.open();
  phone = await Browser.open(kPhone);
  server = new StrataServer({ demo: true });
  ({ page } = desk);
  await server.start();
  [model] = (await server.json("GET", "/models")).models;
  await server.json("POST", "/projects", { name: "Empty" });
  const finds = await server.json("POST", `/projects/${model.project}/tables`, {
    name: "Finds",
    columns: [{ name: "Name" }],
  });
  await server.json("POST", `/tables/${finds.id}/records`, { values: { name: "Handle" } });
  await server.json("POST", `/models/${model.id}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    table: finds.slug,
  });
});

test("a project without models asks for one thing", async () => {
  await desk.sign_in(server, server.token);
  await page.goto(`${server.url}/projects/empty`);
  await button(words.home.choose_file).waitFor();
  assert.deepEqual(await page.locator("strata-home-page button.primary").allInnerTexts(), [
    "Choose a file",
  ]);
});

test("the options of a tool come into sight with it, and stay away when only the layer changes", async () => {
  await page.goto(`${server.url}/models/${model.id}`);
  await desk.drawn();
  await button(words.layers.select("cracks")).click();
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("b");
  const scroller = page.locator("strata-model-page aside .scroll");
  const scrolled = () => scroller.evaluate((each) => each.scrollTop);
  const is_seen = (what) =>
    wait_for(async () => (await scrolled()) === 0, `the options of ${what}`);
  const scroll_down = () => scroller.evaluate((each) => (each.scrollTop = each.scrollHeight));
  for (const view of [kDesk, kTablet]) {
    await page.setViewportSize(view);
    await scroll_down();
    assert.ok((await scrolled()) > 0, "the panel need not scroll");
    await page.keyboard.press("a");
    await page.getByRole("heading", { name: words.tools.polygon }).waitFor();
    await is_seen("the polygon");
    await scroll_down();
    await button(words.tools.eraser).click();
    await is_seen("the eraser");
    await scroll_down();
    await page
      .getByRole("button", { name: words.layers.select("pieces") })
      .evaluate((each) => each.click());
    await page.locator("strata-brush-panel").getByText("pieces").waitFor();
    assert.ok((await scrolled()) > 0, "a layer that is chosen scrolls the panel");
    await page
      .getByRole("button", { name: words.layers.select("cracks") })
      .evaluate((each) => each.click());
  }
  await page.setViewportSize(kDesk);
});

test("a question begins at the answer that harms nothing", async () => {
  await button(words.layers.options("cracks")).click();
  await page.getByRole("menuitem", { name: words.layers.delete }).click();
  await page.locator("strata-question dialog[open]").waitFor();
  await wait_for(
    async () => (await active(page)) === "button.way-out “Cancel”",
    "the keyboard at Cancel",
  );
  await page.keyboard.press("Enter");
  await page.locator("strata-question").waitFor({ state: "detached" });
  assert.equal(await button(words.layers.options("cracks")).count(), 1, "Enter deleted the layer");
});

test("a menu that is open stays inside the window when either changes its width", async () => {
  await button(words.layers.select("Finds")).click();
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("t");
  await page.getByRole("grid").getByText("Handle").first().waitFor();
  await button(words.tables.more).click();
  const list = page.locator("strata-table-panel .list:popover-open");
  const items = () => page.getByRole("menuitem").count();
  const before = await items();
  await page.setViewportSize(kTablet);
  await wait_for(
    async () => (await items()) > before,
    "the menu to take up what has no room beside it",
  );
  const is_inside = async () => {
    const box = await list.boundingBox();
    return box.x >= 0 && box.x + box.width <= kTablet.width;
  };
  await wait_for(is_inside, "the menu to lie inside the window");
  const { width: narrow } = await list.boundingBox();
  await page
    .getByRole("menuitem")
    .first()
    .evaluate((item) =>
      item.append(" and everything else that was written into the records meanwhile"),
    );
  assert.ok((await list.boundingBox()).width > narrow + 40, "the menu does not grow");
  await wait_for(is_inside, "the menu that has grown to lie inside the window");
  await page.keyboard.press("Escape");
  await page.keyboard.press("t");
  await page.setViewportSize(kDesk);
});

test("tools that a phone has no room for are hinted at, at the end where they are", async () => {
  await phone.sign_in(server, server.token);
  await phone.page.goto(`${server.url}/models/${model.id}`);
  await phone.drawn();
  const ends = (who) =>
    who.page
      .locator("strata-tool-rail")
      .evaluate((rail) =>
        ["more-before", "more-after"].filter((name) => rail.hasAttribute(name)).join(),
      );
  const has_ends = (who, wanted) =>
    wait_for(async () => (await ends(who)) === wanted, `the ends “${wanted}” of the tools`);
  await has_ends(phone, "more-after");
  await shoot(phone, "rail");
  await phone.page.locator("strata-tool-rail").evaluate((rail) => (rail.scrollLeft = 40));
  await has_ends(phone, "more-before,more-after");
  await phone.page
    .locator("strata-tool-rail")
    .evaluate((rail) => (rail.scrollLeft = rail.scrollWidth));
  await has_ends(phone, "more-before");
  await has_ends(desk, "");
  assert.equal(
    await page.locator("strata-tool-rail").evaluate((rail) => getComputedStyle(rail).maskImage),
    "none",
  );
});

test("the help speaks of the pointers that there are", async () => {
  const parts = (who) => who.page.locator("strata-help-sheet h3").allInnerTexts();
  for (const who of [desk, phone]) {
    await who.page.getByRole("button", { name: words.model.help, exact: true }).click();
    await who.page.locator("strata-help-sheet dialog[open]").waitFor();
    await who.page.locator("strata-help-sheet h3", { hasText: "Touch" }).waitFor();
  }
  assert.deepEqual((await parts(desk)).slice(0, 3), ["Mouse", "Touch", "Tools"]);
  assert.deepEqual((await parts(phone)).slice(0, 2), ["Touch", "Tools"]);
  await shoot(phone, "help");
});

test("in the window of a wall words are larger, and the help stands in two columns", async () => {
  assert.equal(await root_font_px(), 16);
  await page.setViewportSize(kWall);
  assert.equal(await root_font_px(), 24);
  const columns = await page
    .locator("strata-help-sheet h3")
    .evaluateAll((heads) => [
      ...new Set(heads.map((head) => Math.round(head.getBoundingClientRect().left))),
    ]);
  assert.equal(columns.length, 2);
  await shoot(desk, "wall_help");
  await page.keyboard.press("Escape");
});

test("what is pointed at is where the pointer is, also where words are larger", async () => {
  await page.setViewportSize(kLarge);
  assert.equal(await root_font_px(), 20);
  await page.keyboard.press("b");
  await wait_for(
    async () => {
      const box = await desk.stage_box();
      await desk.point(0.4, 0.5);
      await desk.point(0.5, 0.55);
      const circle = page.locator("strata-stage svg.over circle").first();
      if ((await circle.count()) === 0) return false;
      const [x, y] = await circle.evaluate((each) =>
        ["cx", "cy"].map((name) => Number(each.getAttribute(name))),
      );
      return Math.abs(x - 0.5 * box.width) < 2 && Math.abs(y - 0.55 * box.height) < 2;
    },
    "the circle of the brush around the pointer",
    150,
  );
});

test("the panel is as wide as it is drawn, and grows with the words in it", async () => {
  const panel = page.locator("strata-model-page aside");
  assert.ok(Math.abs((await panel.boundingBox()).width - 330 * 1.25) < 1);
  const splitter = await page
    .getByRole("separator", { name: words.model.resize_panel })
    .boundingBox();
  await page.mouse.move(splitter.x + 3, 400);
  await page.mouse.down();
  await page.mouse.move(kLarge.width - 600, 400, { steps: 4 });
  await page.mouse.up();
  await wait_for(
    async () => Math.abs((await panel.boundingBox()).width - 600) < 2,
    "the panel to follow the pointer",
  );
});

test("the gallery takes the width of a wall", async () => {
  await page.goto(server.url);
  await page.getByRole("heading", { name: words.home.projects }).waitFor();
  await page.setViewportSize(kWall);
  const { width } = await page.locator("ul.gallery").boundingBox();
  assert.ok(width > 0.9 * kWall.width, `the gallery has ${width} px of ${kWall.width}`);
  await shoot(desk, "wall_home");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const browser of [desk, phone]) browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const browser of [desk, phone]) await browser?.close();
  await server?.remove();
});
