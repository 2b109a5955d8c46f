// Checks every screen and dialog of the page: axe-core's findings in English and German, the
// contrast in each theme, and overflow in the longest language, in four window sizes. The keyboard
// focus starts in dialogs at a sensible control, reaches every control visibly, stays in dialogs
// and returns from them. `accessibility_test.mjs [PART…]` runs only these parts of `kParts`, which
// CTest runs in parallel.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { active, findings, overflows, walk } from "../support/js/accessible.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";
import { bea_at, make_site, screens_of } from "../support/js/screens.mjs";

const words = texts_of("en");

const kSizes = [
  [390, 844],
  [820, 1180],
  [1280, 800],
  [3840, 2160],
];
const kThemes = ["light", "dark", "contrast"];

// each part uses the language of its walk through all screens
const kParts = { themes: "en", keyboard: "en", german: "de" };
const parts = process.argv.length > 2 ? process.argv.slice(2) : Object.keys(kParts);
for (const part of parts) assert.ok(part in kParts, `${part} is none of ${Object.keys(kParts)}`);
const does = (part) => parts.includes(part);

const kLocales = { en: "en-GB", de: "de-DE" };
const browsers = {};
for (const language of new Set(parts.map((part) => kParts[part])))
  browsers[language] = await Browser.open({ locale: kLocales[language] });
const bea = await Browser.open(); // another user at the model
const server = new StrataServer({ demo: true });
const checked = [];
const wrong = [];
let step = "start";

async function check(language, { page }, screen) {
  const found = async (what, lines) =>
    void (await lines).forEach((line) =>
      wrong.push(`${language}, ${screen.name}, ${what}: ${line}`),
    );
  const themes = language === "de" ? ["light"] : does("themes") ? kThemes : [];
  for (const theme of themes) {
    await page.evaluate((name) => (document.documentElement.dataset.theme = name), theme);
    await found(theme, findings(page, theme === "light" ? null : ["color-contrast"]));
  }
  await page.evaluate(() => (document.documentElement.dataset.theme = "light"));
  if (language === "de") {
    for (const [width, height] of kSizes) {
      await page.setViewportSize({ width, height });
      await page.evaluate(
        () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
      );
      await found(`${width}×${height}`, overflows(page));
    }
    await page.setViewportSize({ width: 1280, height: 800 });
  }
  if (language === "en" && does("keyboard") && (await page.locator("dialog[open]").count()) > 0) {
    if ((await active(page)) === "button.icon.quiet “Close”")
      wrong.push(`${language}, ${screen.name}: the keyboard begins at the cross`);
  }
  if (language === "en" && does("keyboard") && screen.keyboard) {
    const { unreached, unseen, stops } = await walk(page);
    await found("not reached by the Tab key", unreached);
    await found("has an invisible focus", unseen);
    assert.ok(stops > 0, `${screen.name} has no stop of the Tab key`);
  }
  checked.push(`${language} ${screen.name}`);
}

/** Selects a locked layer with the brush, as a user without the right to change it. */
async function locked_for_bea(language, site) {
  const w = texts_of(language);
  await bea.page.evaluate((chosen) => localStorage.setItem("strata.language", chosen), language);
  await bea_at(site);
  await bea.page.getByRole("button", { name: w.layers.select("Finds"), exact: true }).click();
  await bea.page.keyboard.press("b");
  await bea.page.locator("strata-brush-panel").getByText(w.layers.locked_detail("Finds")).waitFor();
  await bea.page.locator("strata-notices").getByText(w.layers.locked, { exact: true }).waitFor();
  await check(language, bea, { name: "brush on a locked layer", keyboard: true });
}

const account_of_owner = (page) => page.getByRole("button", { name: words.account.menu("owner") });

async function focus_of_a_dialog(page) {
  step = "a dialog keeps the focus and gives it back";
  const opener = account_of_owner(page);
  await opener.focus();
  const before = await active(page);
  // each key moves the focus, and the next key depends on the new focus
  const moves = async (key) => {
    const from = await active(page);
    await page.keyboard.press(key);
    await wait_for(
      async () => (await active(page)) !== from,
      `${key} to move the focus from ${from}`,
    );
  };
  await moves("Enter");
  await moves("ArrowDown");
  await page.keyboard.press("Enter");
  await page.getByRole("dialog").waitFor();
  for (let presses = 0; presses < 30; ++presses) {
    await page.keyboard.press("Tab");
    const inside = await page.evaluate(() => {
      let at = document.activeElement;
      const path = [];
      while (at) {
        path.push(at);
        at = at.shadowRoot?.activeElement;
      }
      return (
        path.length === 0 ||
        path[0] === document.body ||
        path.some((each) => /-dialog$/.test(each.localName))
      );
    });
    assert.ok(inside, `Tab leaves the dialog for ${await active(page)}`);
  }
  await page.keyboard.press("Escape");
  await wait_for(
    async () => (await active(page)) === before,
    `the focus to come back to ${before}`,
  );
}

async function chosen_theme(page) {
  step = "a theme is chosen and kept, and the system is followed where none is";
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  const becomes = (name) =>
    wait_for(async () => (await theme()) === name, `the theme to be ${name}`);
  const choose_theme = async (name) => {
    await account_of_owner(page).click();
    await page.getByRole("menuitem", { name: words.settings.open }).click();
    await page.getByRole("combobox", { name: words.settings.theme }).selectOption(name);
    await page.keyboard.press("Escape");
  };
  await choose_theme("Dark");
  await becomes("dark");
  await page.reload();
  await account_of_owner(page).waitFor();
  assert.equal(await theme(), "dark");
  await page.emulateMedia({ colorScheme: "light", contrast: "more" });
  assert.equal(await theme(), "dark", "a theme that was chosen gave way");
  await choose_theme(words.settings.themes.system);
  await becomes("contrast");
  await page.emulateMedia({ colorScheme: "dark", contrast: "no-preference" });
  await becomes("dark");
  await page.emulateMedia({ colorScheme: "light", forcedColors: "active" });
  await becomes("light");
  assert.deepEqual(await findings(page), []);
}

try {
  await server.start();
  step = "the site";
  const site = await make_site(server, bea);
  for (const [language, browser] of Object.entries(browsers)) {
    for (const screen of screens_of(browser, texts_of(language), site)) {
      step = `${language}: ${screen.name}`;
      await screen.start();
      await check(language, browser, screen);
      await screen.end?.();
    }
  }

  await server.json("PATCH", `/models/${site.model}/layers/finds`, { locked: true });
  for (const language of Object.keys(browsers)) {
    step = `${language}: brush on a locked layer`;
    await locked_for_bea(language, site);
  }

  step = "empty home";
  // the home page also requests a thumbnail of the deleted model
  for (const { page } of [...Object.values(browsers), bea]) await page.goto("about:blank");
  await server.request("DELETE", `/models/${site.model}`);
  for (const [language, browser] of Object.entries(browsers)) {
    await browser.page.goto(server.url);
    await browser.page
      .getByRole("heading", { name: texts_of(language).home.empty_title, exact: true })
      .waitFor();
    await check(language, browser, { name: "empty home", keyboard: true });
  }

  if (does("keyboard")) {
    await focus_of_a_dialog(browsers.en.page);
    await chosen_theme(browsers.en.page);
  }

  step = "the end";
  console.log(`${checked.length} screens checked:\n  ${checked.join("\n  ")}`);
  if (wrong.length > 0)
    throw new Error(`${wrong.length} findings:\n${[...new Set(wrong)].join("\n")}`);
  for (const browser of [...Object.values(browsers), bea])
    browser.assert_no_complaints(["status of 401", "status of 404"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
} catch (error) {
  console.log(
    `failed at: ${step}; findings so far:\n${[...new Set(wrong)].join("\n")}\n--- log of the server\n${server.log.slice(-30).join("\n")}`,
  );
  if (process.env.STRATA_TEST_OUTPUT) {
    for (const [name, { page }] of Object.entries({ ...browsers, bea }))
      await page
        .screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `accessibility_${name}.png`) })
        .catch(() => {});
  }
  throw error;
} finally {
  for (const browser of [...Object.values(browsers), bea]) await browser.close();
  await server.remove();
}
