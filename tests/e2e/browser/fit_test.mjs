// Elements do not overlap or touch: long names of layers, numbers with their units, the filter next
// to a selected record, the switch of the light. On a phone the active layer and undo stay visible.
// The visible text of a control is its name. All content of the page is inside ARIA landmarks.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { kHeadRules, violations } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_on_picture, open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kWindows = {
  desk: { width: 1440, height: 900 },
  tablet: { width: 820, height: 1180 },
  phone: { width: 390, height: 844 },
};
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });
const shoot = async (who, name) =>
  output && (await who.page.screenshot({ path: join(output, `fit_${name}.png`) }));
const button = (name, who = desk) => who.page.getByRole("button", { name, exact: true });
/** Returns the boxes of the elements. */
const boxes = (locator) =>
  locator.evaluateAll((all) => all.map((each) => each.getBoundingClientRect().toJSON()));
const apart = (a, b) =>
  a.right <= b.left + 0.5 ||
  b.right <= a.left + 0.5 ||
  a.bottom <= b.top + 0.5 ||
  b.bottom <= a.top + 0.5;
/** Returns the boxes of a field's text and of its unit. */
const number_box = (field) =>
  field.evaluate((all) => {
    const input = all.querySelector("input");
    const unit = [...all.children].find((each) => each !== input);
    const style = getComputedStyle(input);
    const right =
      input.getBoundingClientRect().right -
      parseFloat(style.paddingRight) -
      parseFloat(style.borderRightWidth);
    return {
      text_right: right,
      unit_left: unit.getBoundingClientRect().left,
      unit_right: unit.getBoundingClientRect().right,
      right: all.getBoundingClientRect().right,
    };
  });

let desk, phone, server, page, model, project, person, chip, chosen;

test.beforeAll(async () => {
  desk = await Browser.open({ viewport: kWindows.desk });
  phone = await Browser.open({ viewport: kWindows.phone, hasTouch: true, isMobile: true });
  server = new StrataServer({ demo: true });
  ({ page } = desk);
  await server.start();
  [{ id: model, project }] = (await server.json("GET", "/models")).models;
  await server.json("POST", `/projects/${project}/templates/stone-condition`, {
    model: String(model),
  });
  await server.json("POST", `/models/${model}/layers`, {
    name: "Curvature",
    kind: "numeric",
    type: "f32",
    unit: "1/mm",
    resolution: 2048,
    palette: {
      mode: "linear",
      min: -1,
      max: 1,
      points: [
        { at: -1, color: "#0000ffff" },
        { at: 1, color: "#ff0000ff" },
      ],
    },
  });
  await server.json("POST", "/tables/stone-observations/records", {
    values: { urgency: "now", depth: 2.4 },
  });
  person = await server.add_person("ida", "curator");
  // her initials (IR) are not part of her names
  await server.json("PATCH", "/users/ida", { full_name: "Ida Roe" });
  await desk.sign_in(server, person);
  await page.goto(`${server.url}/models/${model}`);
  await desk.drawn();

  for (const [language, labels] of Object.entries({
    en: "Stone observations",
    de: "Beobachtungen am Stein",
  })) {
    const w = texts_of(language);
    await page.evaluate((chosen) => localStorage.setItem("strata.language", chosen), language);
    await page.reload();
    await desk.drawn();

    console.log(`${language}: the chosen layer's name is read whole, and no card leaves the panel`);
    await open_tab(page, w, w.layers.title);
    await button(w.layers.select(labels)).click();
    const panel = (await boxes(page.locator("strata-model-page aside")))[0];
    for (const card of await boxes(page.locator("strata-layer-panel li.layer")))
      assert.ok(
        card.right <= panel.right - 12, // 12 pixels are the padding of the panel
        `a card ends at ${card.right} in a panel that ends at ${panel.right}`,
      );
    const name = page.locator("strata-layer-panel li.selected .name .ellipsis");
    assert.ok(
      await name.evaluate((each) => each.scrollWidth <= each.clientWidth + 1),
      "the chosen layer's name is cut off",
    );
    await shoot(desk, `${language}_layers`);

    console.log(`${language}: a number does not touch its unit, however long that is`);
    await button(w.layers.select("Curvature")).click();
    await page.keyboard.press("b");
    const value = await number_box(page.locator("strata-value-picker .number"));
    assert.ok(
      value.text_right < value.unit_left && value.unit_right <= value.right,
      JSON.stringify(value),
    );
    await shoot(desk, `${language}_value`);

    console.log(`${language}: the words of the light switch keep apart`);
    const view = page.locator("strata-light-controls");
    await open_on_picture(page, w, w.view.light);
    const lights = view.getByRole("radiogroup", { name: w.view.light }).getByRole("radio");
    await lights.first().scrollIntoViewIfNeeded();
    const gaps = await lights.evaluateAll((all) =>
      all.map((each) => {
        const range = document.createRange();
        range.selectNodeContents(each);
        const text = range.getBoundingClientRect();
        const box = each.getBoundingClientRect();
        return Math.min(text.left - box.left, box.right - text.right);
      }),
    );
    assert.ok(
      gaps.every((gap) => gap >= 4),
      `words ${gaps} px from the edges of their buttons`,
    );
    await shoot(desk, `${language}_light`);

    console.log(
      `${language}: a chosen record leaves the filter its room, and the rows their places`,
    );
    await open_tab(page, w, w.layers.title);
    await button(w.layers.select(labels)).click();
    await page.keyboard.press("Escape");
    await page.locator("strata-stage .surface").focus();
    await page.keyboard.press("t");
    const key = page.getByRole("rowheader", { name: "1", exact: true });
    await key.waitFor();
    await page.locator("strata-table-panel .filter input").fill("urgency = 'now'");
    await page.keyboard.press("Enter");
    const before = (await boxes(key))[0];
    await key.click();
    await page.locator("strata-table-panel .chosen").waitFor();
    assert.deepEqual((await boxes(key))[0].top, before.top, "the rows moved");
    const filter = (await boxes(page.locator("strata-table-panel .filter input")))[0];
    assert.ok(filter.width >= 190, `the filter field has ${filter.width} px`);
    await shoot(desk, `${language}_filter`);
    for (const [window, size] of Object.entries(kWindows)) {
      await page.setViewportSize(size);
      await wait_for(
        async () => (await boxes(page.locator("strata-table-panel")))[0].width <= size.width,
        "the window's width",
      );
      const parts = await boxes(page.locator("strata-table-panel .bar > *:not(.grow)"));
      const [table] = await boxes(page.locator("strata-table-panel"));
      for (const part of parts)
        assert.ok(
          part.right <= table.right,
          `in the ${window}: ${JSON.stringify(part)} leaves the table`,
        );
      for (const [index, part] of parts.entries())
        for (const other of parts.slice(index + 1))
          assert.ok(
            part.width === 0 || other.width === 0 || apart(part, other),
            `in the ${window}: ${JSON.stringify([part, other])}`,
          );
      assert.ok(
        (await boxes(page.locator("strata-table-panel .filter input")))[0].width >= 190,
        `the filter in the ${window}`,
      );
      await shoot(desk, `${language}_filter_${window}`);
    }
    await page.setViewportSize(kWindows.desk);

    console.log(`${language}: in a record's form a number and its unit keep apart`);
    await page
      .locator("strata-table-panel .chosen")
      .getByRole("button", { name: w.tables.edit, exact: true })
      .click();
    const depth = await number_box(
      page.locator("strata-record-dialog strata-cell-input .number").first(),
    );
    assert.ok(depth.text_right < depth.unit_left, JSON.stringify(depth));
    await shoot(desk, `${language}_form`);
    await page.keyboard.press("Escape");
    await page.locator("strata-record-dialog").waitFor({ state: "detached" });
    await button(w.tables.close).click();

    console.log(
      `${language}: help has no frame as it opens, and one where the Tab key comes back to it`,
    );
    await page.locator("strata-stage .surface").focus();
    await page.keyboard.press("?");
    const help = page.locator("strata-help-sheet");
    const framed = () =>
      help
        .locator(".content")
        .evaluate(
          (each) => getComputedStyle(each).outlineStyle !== "none" && each.matches(":focus"),
        );
    await help.locator("dialog[open]").waitFor();
    await wait_for(
      () => help.locator(".content").evaluate((each) => each.matches(":focus")),
      "the keyboard in the help",
    );
    assert.equal(await framed(), false);
    await shoot(desk, `${language}_help`);
    await page.keyboard.press("Tab");
    await page.keyboard.press("Shift+Tab");
    assert.equal(await framed(), true);
    await page.keyboard.press("Escape");
    await help.waitFor({ state: "detached" });
  }
  await page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
  await shoot(desk, "dark");
  await page.evaluate(() => (document.documentElement.dataset.theme = "light"));
});

test("controls are named by what is seen on them, and everything lies in a landmark", async () => {
  await page.evaluate(() => localStorage.setItem("strata.language", "en"));
  await page.reload();
  await desk.drawn();
  assert.deepEqual(await violations(page, kHeadRules), []);
  // the layer that is selected after a reload has no table
  await button(words.layers.select("Stone observations")).click();
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("t");
  await page.getByRole("grid").waitFor();
  assert.deepEqual(await violations(page, kHeadRules), []);
});

test("on a phone what is painted and undo are always in sight", async () => {
  await page.goto("about:blank"); // only the phone is at the model
  await phone.sign_in(server, person);
  await phone.page.goto(`${server.url}/models/${model}`);
  await phone.drawn();
  const rail = phone.page.locator("strata-tool-rail");
  const in_sight = async (locator, what) => {
    const [box] = await boxes(locator);
    assert.ok(
      box &&
        box.left >= -0.5 &&
        box.right <= kWindows.phone.width + 0.5 &&
        box.bottom <= kWindows.phone.height + 0.5,
      `${what} at ${JSON.stringify(box)}`,
    );
    const hit = await locator.evaluate((each) => {
      const { left, top, width, height } = each.getBoundingClientRect();
      let at = document.elementFromPoint(left + width / 2, top + height / 2);
      while (at?.shadowRoot) {
        const inner = at.shadowRoot.elementFromPoint(left + width / 2, top + height / 2);
        if (!inner || inner === at) break;
        at = inner;
      }
      return at === each || each.contains(at);
    });
    assert.ok(hit, `something lies over ${what}`);
  };
  await button(words.tools.brush, phone).click();
  chip = phone.page.locator("strata-paint-chip button");
  await chip.waitFor();
  for (const place of [0, 60, 100_000]) {
    await rail.evaluate((each, left) => (each.scrollLeft = left), place);
    for (const name of ["Undo", "Redo"])
      await in_sight(rail.getByRole("button", { name, exact: true }), name);
    await in_sight(chip, "what is painted");
  }
  await rail.evaluate((each) => (each.scrollLeft = 0));
  [chosen] = (await server.json("GET", `/models/${model}/layers`)).layers.slice(-1);
  assert.match(await chip.innerText(), new RegExp(`${chosen.name}\\s.*px`, "s"));
  await shoot(phone, "phone_brush");
});

test("the line that says so leads to what can be chosen", async () => {
  if ((await phone.page.locator("strata-model-page aside").count()) > 0)
    await button(words.model.hide_panel, phone).click();
  await chip.click();
  await phone.page
    .locator("strata-brush-panel")
    .getByRole("heading", { name: words.brush.title })
    .waitFor();
  await shoot(phone, "phone_options");
  await phone.page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
  await shoot(phone, "phone_dark");
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
