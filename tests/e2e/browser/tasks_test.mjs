// The most frequent tasks on the page, walked step by step. A step is a click, a drag, a key or an
// entry in a field. Each task has a limit of steps, so that no change makes it longer by accident.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { kRoot } from "../support/js/modules.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const exact = (name) => ({ name, exact: true });
const kScan = join(kRoot, "..", "shared", "data", "vessel_lekythos_gigamesh_15k.ply");

let steps = 0,
  model,
  observations;

/** Runs one task. It fails if it takes more than `most` steps. */
function task(name, most, walk, needs = null) {
  test(name, async ({ server, desk }, info) => {
    test.skip(needs !== null && !existsSync(needs), `${needs} is absent`);
    const { page } = desk;
    await page.goto(`${server.url}/models/${model.id}`);
    await desk.drawn();
    steps = 0;
    const begin = Date.now();
    await walk(hand(desk));
    const seconds = ((Date.now() - begin) / 1000).toFixed(1);
    info.annotations.push({ type: "steps", description: `${steps} steps, ${seconds} s` });
    if (process.env.STRATA_TEST_OUTPUT) {
      console.log(`${name}: ${steps} steps (limit ${most}), ${seconds} s`);
      await page.screenshot({
        path: join(process.env.STRATA_TEST_OUTPUT, `task_${name.replaceAll(/\W+/g, "_")}.png`),
      });
    }
    assert.ok(steps <= most, `${steps} steps, the limit is ${most}`);
  });
}

/** The actions of a person. Each action is one step. */
function hand(desk) {
  const { page } = desk;
  const counted =
    (act) =>
    async (...what) => {
      ++steps;
      return act(...what);
    };
  return {
    desk,
    page,
    counted,
    click: counted((where) => where.click()),
    press: counted((key) => page.keyboard.press(key)),
    fill: counted((where, text) => where.fill(text)),
    choose: counted((where, value) => where.selectOption(value)),
    drag: counted((path) => desk.drag(path)),
    at: counted(async (x, y) => {
      const { x: left, y: top, width, height } = await desk.stage_box();
      await page.mouse.click(left + x * width, top + y * height);
    }),
    tab: counted((title) => open_tab(page, words, title)),
    button: (name, where = page) => where.getByRole("button", exact(name)),
    item: (name) => page.getByRole("menuitem", exact(name)),
    notice: (text) => page.locator("strata-notices").getByText(text).first().waitFor(),
    /** Selects a layer. Does nothing if the page already has the layer selected. */
    select: async (name) => {
      const row = page.getByRole("button", exact(words.layers.select(name)));
      if (!(await row.isVisible())) return;
      ++steps;
      await row.click();
    },
  };
}

test.beforeAll(async ({ server, desk }) => {
  model = await server.json("PATCH", "/models/demo-pot", { scale_verified: true });
  await server.json("POST", `/projects/${model.project}/templates/stone-condition`, {
    model: String(model.id),
  });
  const { tables } = await server.json("GET", `/projects/${model.project}/tables`);
  observations = tables.find(({ slug }) => slug === "stone-observations");
  const urgencies = ["none", "watch", "within a year", "now"];
  for (let i = 0; i < 8; ++i)
    await server.json("POST", `/tables/${observations.id}/records`, {
      values: { depth: i, urgency: urgencies[i % 4] },
    });
  await desk.sign_in(server, server.token);
});

task("draw a crack and read its length", 3, async ({ click, drag, button, select, notice }) => {
  await select("Stone observations");
  await click(button(words.tools.line));
  await drag([
    [0.42, 0.62],
    [0.5, 0.6],
    [0.58, 0.62],
  ]);
  await notice(/Line of [\d.]+\s[cm]?m/);
});

task("paint a crack and read its area", 4, async (me) => {
  await me.select("cracks");
  await me.press("b");
  await me.drag([
    [0.42, 0.6],
    [0.5, 0.58],
    [0.58, 0.6],
  ]);
  await me.desk.saved();
  await me.tab(words.activity.title);
  await me.page.locator("strata-activity-panel").getByText(/cm²/).first().waitFor();
});

task("find out who painted this", 1, async ({ tab, page }) => {
  await tab(words.activity.title);
  await page
    .locator("strata-activity-panel [data-activity]", { hasText: "owner" })
    .first()
    .waitFor();
});

task(
  "restore a layer as it was before",
  4,
  async ({ page, press, click, button, notice, counted }) => {
    await press("z");
    const slider = page.getByRole("slider", { name: words.past.slider });
    await counted(() => slider.click({ position: { x: 4, y: 8 } }))();
    const bar = page.getByRole("region", { name: words.past.title });
    await click(button(words.past.restore, bar));
    await click(button(words.past.restore_now, page.locator("strata-past-restore")));
    await notice(/restored/i);
  },
);

task("print a figure 1:10 as PDF", 3, async ({ page, press, choose, click, button }) => {
  await page.locator("strata-stage .surface").focus();
  await press("f");
  const dialog = page.locator("strata-figure-dialog");
  const scale = dialog.getByRole("combobox", exact(words.figures.scale));
  await choose(scale, { value: "10" });
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    click(button(words.figures.make, dialog)),
  ]);
  assert.match(file.suggestedFilename(), /1-10\.pdf$/);
});

task("make a tour of three stops", 17, async ({ page, tab, press, click, fill, button }) => {
  await tab(words.view.title);
  for (const [name, key] of [
    ["West", "4"],
    ["Above", "5"],
    ["Front", "1"],
  ]) {
    await page.locator("strata-stage .surface").focus();
    await press(key);
    await click(button(words.kept_views.keep, page.locator("strata-view-list")));
    const dialog = page.locator("strata-view-dialog");
    await fill(dialog.getByLabel(words.kept_views.name), name);
    await click(button(words.kept_views.keep_yes, dialog));
    await dialog.waitFor({ state: "detached" });
  }
  await click(button(words.tours.new, page.locator("strata-tour-list")));
  const editor = page.locator("strata-tour-dialog");
  await fill(editor.getByLabel(words.tours.name, { exact: true }), "Around");
  await click(button(words.tours.add_all(3), page.locator("strata-tour-stops")));
  await click(button(words.save, editor));
  await page.locator("strata-tour-list").getByRole("listitem").waitFor();
});

task("find all records with urgency “now”", 4, async ({ page, press, click, select }) => {
  await select("Stone observations");
  await press("t");
  const panel = page.locator("strata-table-panel");
  await click(
    panel
      .getByRole("columnheader", { name: /^Urgency/ })
      .getByRole("button", { name: /^Filter by Urgency/ }),
  );
  const sheet = page.locator("strata-column-filter");
  await click(sheet.getByRole("checkbox", { name: /^now/ }));
  await panel.getByText(/^2 of \d+ records/).waitFor();
});

task("measure a distance along the surface", 3, async ({ page, press, at }) => {
  await page.locator("strata-stage .surface").focus();
  await press("m");
  await at(0.4, 0.6);
  await at(0.6, 0.6);
  await page.locator("strata-measure-panel [data-figure]").first().waitFor();
});

task("invite an annotator", 5, async ({ page, click, fill, button, item }) => {
  await click(button(words.account.menu("owner")));
  await click(item(words.account.people));
  await click(button(words.site_people.invite));
  const dialog = page.locator("strata-people-dialog");
  await fill(dialog.getByRole("textbox", { name: words.site_people.invite_user }), "carla");
  await click(button(words.site_people.invite_button, dialog));
  await page.locator("strata-made-link").first().waitFor();
});

task("export the areas of a layer to a spreadsheet", 3, async ({ page, click, button, item }) => {
  await click(button(words.layers.options("cracks")));
  await click(item(words.layers.statistics));
  const dialog = page.locator("strata-statistics-dialog");
  await dialog.getByText(/cm²/).first().waitFor();
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    click(dialog.getByRole("button", { name: /xlsx|excel/i }).first()),
  ]);
  assert.match(file.suggestedFilename(), /cracks-quantities\.xlsx$/);
});

task("look in raking light at a section", 3, async ({ page, desk, press }) => {
  await page.locator("strata-stage .surface").focus();
  await press("k");
  await press("k");
  await press("x");
  await desk.drawn();
});

task(
  "import a scan and confirm its unit",
  3,
  async ({ page, desk, click, counted }) => {
    await page.getByRole("link", { name: words.model.home }).first().click();
    steps = 0; // the task begins on the page of models
    const chooser = page.waitForEvent("filechooser");
    await click(page.getByRole("button", { name: words.home.import }).first());
    await counted(async () => (await chooser).setFiles(kScan))();
    const dialog = page.locator("strata-scale-dialog");
    await dialog.getByRole("dialog").waitFor();
    await click(dialog.getByRole("button").last());
    await dialog.waitFor({ state: "detached" });
    await desk.drawn();
  },
  kScan,
);

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well();
