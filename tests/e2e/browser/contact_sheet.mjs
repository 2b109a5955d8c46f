// Shows screenshots of every screen and dialog of the page on one sheet, for a person to judge. The
// screenshots have the window sizes of a phone, a tablet and a desktop computer. This is not a test
// and detects no errors. `scripts/contact_sheet` runs it. The first argument is the folder for the
// output. `--language` and `--theme` set the page's language and theme. `--windows` selects the
// windows. The window of a wall display has 4K. `--only` takes pictures of some screens only, by
// name. The others are opened too, because a screen may need those before it.
import { mkdirSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { Browser } from "../support/js/browser.mjs";
import { kiosk_screens_of } from "../support/js/kiosk-screens.mjs";
import { make_kiosk_site } from "../support/js/kiosk-site.mjs";
import { make_site, screens_of } from "../support/js/screens.mjs";
import { StrataServer } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const kSizes = { phone: [390, 844], tablet: [820, 1180], desk: [1440, 900], wall: [3840, 2160] };
const kDesk = { width: 1280, height: 800 }; // the window in which the functions open the screens
const kScale = 0.3; // scale of the screenshots on the sheet
const kMostBytes = 2_000_000; // size of the sheet as one image
const kQualities = [70, 60, 50, 40, 30, 20];
const kLocales = { en: "en-GB", de: "de-DE", es: "es-ES" };
const kFrame_ms = 20_000; // after this time, the screenshot shows the current state

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    language: { type: "string", default: "en" },
    theme: { type: "string", default: "light" },
    windows: { type: "string", default: "phone,tablet,desk" },
    only: { type: "string" },
  },
});
const { language, theme } = values;
const windows = values.windows.split(",");
if (
  positionals.length !== 1 ||
  !(language in kLocales) ||
  !["light", "dark", "contrast"].includes(theme) ||
  !windows.every((each) => each in kSizes)
) {
  console.error(
    "contact_sheet FOLDER [--language en|de|es] [--theme light|dark|contrast] [--windows phone,tablet,desk,wall] [--only SCREEN,…]",
  );
  process.exit(2);
}
const kWindows = Object.fromEntries(windows.map((each) => [each, kSizes[each]]));
const folder = resolve(positionals[0]);
mkdirSync(join(folder, "shots"), { recursive: true });

const server = new StrataServer({ demo: true });
const viewer = await Browser.open({ locale: kLocales[language], viewport: kDesk });
const bea = await Browser.open();
const { page } = viewer;

const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const file_of = (screen, window) => `shots/${screen.name.replaceAll(/\W+/g, "_")}_${window}.jpg`;

/** Waits after a change of the window's size until the server has drawn the model again. */
async function settled() {
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
  const canvas = page.locator("strata-stage canvas, strata-kiosk-stage canvas.live").first();
  if ((await canvas.count()) === 0) return;
  const fits = () =>
    canvas.evaluate((canvas) => {
      const { width, height } = canvas.getBoundingClientRect();
      return Math.abs(canvas.width / canvas.height - width / height) < 0.02;
    });
  for (const end = Date.now() + kFrame_ms; Date.now() < end && !(await fits());)
    await page.waitForTimeout(100);
}

async function take(screen) {
  for (const [window, [width, height]] of Object.entries(kWindows)) {
    await page.setViewportSize({ width, height });
    await settled();
    await page.screenshot({
      path: join(folder, file_of(screen, window)),
      type: "jpeg",
      quality: 80,
    });
  }
  await page.setViewportSize(kDesk);
}

function sheet_of(screens) {
  const shot =
    (screen) =>
    ([window, [width, height]]) =>
      `<a href="${file_of(screen, window)}"><img src="${file_of(screen, window)}" alt="${window}" width="${Math.round(width * kScale)}" height="${Math.round(height * kScale)}"></a>`;
  const figure = (screen, n) =>
    `<figure><figcaption><b>${n + 1}</b> ${escaped(screen.name)}</figcaption><div>${Object.entries(kWindows).map(shot(screen)).join("")}</div></figure>`;
  const sizes = Object.entries(kWindows)
    .map(([window, size]) => `${window} ${size.join(" × ")}`)
    .join(", ");
  return `<!doctype html><meta charset="utf-8"><title>Screens</title><style>
    body { margin: 24px; font: 14px system-ui, sans-serif; background: #ddd; color: #111; }
    main { display: flex; flex-wrap: wrap; gap: 22px 26px; }
    figure { margin: 0; } figcaption { margin: 0 0 5px; } figure div { display: flex; gap: 6px; align-items: flex-start; }
    img { display: block; background: #fff; outline: 1px solid #999; }
  </style><h1>${screens.length} screens</h1><p>${sizes}; ${language}, ${theme}.</p><main>${screens.map(figure).join("\n")}</main>`;
}

/** Returns the whole sheet as one image, in the best quality below the size limit. */
async function picture_of(sheet) {
  await page.setViewportSize({ width: 2530, height: 1000 });
  await page.goto(pathToFileURL(sheet).href);
  await page.evaluate(() => Promise.all([...document.images].map((image) => image.decode())));
  const path = join(folder, "sheet.jpg");
  for (const quality of kQualities) {
    await page.screenshot({ path, type: "jpeg", quality, fullPage: true });
    if (statSync(path).size <= kMostBytes) break;
  }
  return path;
}

let step = "start";
try {
  await server.start();
  await page.addInitScript(
    (name) =>
      document.addEventListener(
        "DOMContentLoaded",
        () => (document.documentElement.dataset.theme = name),
      ),
    theme,
  );
  const site = await make_site(server, bea);
  const wanted = values.only?.split(",");
  const is_wanted = ({ name }) => !wanted || wanted.includes(name);
  const screens = screens_of(viewer, texts_of(language), site);
  const take_all = async (of) => {
    for (const screen of of) {
      console.log((step = screen.name));
      await screen.start();
      await page.evaluate((name) => (document.documentElement.dataset.theme = name), theme);
      if (is_wanted(screen)) await take(screen);
      await screen.end?.();
    }
  };
  await take_all(screens);
  step = "the site of a kiosk";
  const of_kiosk = kiosk_screens_of(viewer, server, await make_kiosk_site(server));
  await take_all(of_kiosk);
  screens.push(...of_kiosk);
  const sheet = join(folder, "index.html");
  writeFileSync(sheet, sheet_of(screens.filter(is_wanted)));
  console.log(`${sheet}\n${await picture_of(sheet)}`);
} catch (error) {
  console.error(`failed at: ${step}`);
  throw error;
} finally {
  for (const each of [viewer, bea]) await each.close();
  await server.remove();
}
