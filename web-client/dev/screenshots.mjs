// Pictures of every screen against dev/fake-server.mjs: `node dev/screenshots.mjs FOLDER [PORT]`, to look at.

import { mkdtempSync, writeFileSync, mkdirSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const folder = process.argv[2];
const base = `http://127.0.0.1:${process.argv[3] ?? 8090}`;
if (!folder) throw new Error("usage: node dev/screenshots.mjs FOLDER [PORT]");
mkdirSync(folder, { recursive: true });
const args = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

async function open(options = {}) {
  const context = await chromium.launchPersistentContext(mkdtempSync(join(tmpdir(), "strata-")), {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true, args, viewport: { width: 1440, height: 900 }, ...options,
  });
  const page = context.pages()[0] ?? (await context.newPage());
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && console.log("console:", message.text()));
  page.on("pageerror", (error) => console.log("page error:", error.message));
  return { context, page };
}

const shot = async (page, name) => {
  await page.waitForTimeout(350);
  await page.screenshot({ path: join(folder, `${name}.png`) });
  console.log(name);
};

async function sign_in(page) {
  await page.goto(base);
  await page.getByLabel("Token").fill("museum");
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByRole("heading", { name: "Models" }).waitFor();
}

const drawn = (page) => page.waitForFunction(() => Number(
  document.querySelector("strata-app").shadowRoot.querySelector("strata-model-page")?.shadowRoot
    .querySelector("strata-stage")?.shadowRoot.querySelector("canvas")?.dataset.frames) > 0);

async function drag(page, points) {
  await page.mouse.move(...points[0]);
  await page.mouse.down();
  for (const point of points.slice(1)) await page.mouse.move(...point, { steps: 8 });
  await page.mouse.up();
}

async function tour(scheme) {
  const { context, page } = await open({ colorScheme: scheme });
  const name = (text) => `${scheme}-${text}`;
  await page.goto(base);
  await shot(page, name("sign-in"));
  await sign_in(page);
  await page.waitForTimeout(2500);
  await shot(page, name("home"));
  const ply = join(folder, "nefertiti_bust.ply");
  const bad = join(folder, "bad_scan.ply");
  for (const file of [ply, bad]) writeFileSync(file, "ply\n");
  await page.locator("input[type=file]").setInputFiles([ply, bad]);
  await page.waitForTimeout(1600);
  await shot(page, name("importing"));
  await page.waitForTimeout(2000);
  await page.getByRole("link", { name: /Amphora/ }).click();
  await drawn(page);
  await page.mouse.move(560, 470);
  await shot(page, name("model"));
  await page.keyboard.press("b");
  await drag(page, [[430, 380], [520, 450], [640, 430], [700, 520]]);
  await page.waitForTimeout(600);
  await shot(page, name("brush"));
  await page.getByRole("button", { name: "Paint on Pieces" }).click();
  await page.getByRole("radio", { name: "on the object" }).click();
  await page.mouse.move(560, 470);
  await shot(page, name("classes"));
  await page.getByRole("button", { name: "Paint on Moisture" }).click();
  await page.mouse.move(760, 470);
  await shot(page, name("measurement"));
  await page.getByRole("button", { name: "New layer" }).click();
  await shot(page, name("create-presence"));
  await page.getByRole("radio", { name: /^Class/ }).click();
  await shot(page, name("create-classes"));
  await page.getByRole("radio", { name: /^Measurement/ }).click();
  await shot(page, name("create-measurement"));
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Options for Pieces" }).click();
  await shot(page, name("layer-menu"));
  await page.getByRole("menuitem", { name: "Areas…" }).click();
  await shot(page, name("statistics"));
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Options for Moisture" }).click();
  await page.getByRole("menuitem", { name: "Areas…" }).click();
  await shot(page, name("statistics-measurement"));
  await page.keyboard.press("Escape");
  await page.waitForTimeout(100);
  await page.keyboard.press("?");
  await shot(page, name("help"));
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "About this model" }).click();
  await shot(page, name("about"));
  await page.keyboard.press("Escape");
  const other = await context.newPage();
  await other.goto(`${base}/models/1`);
  await drawn(other);
  await other.mouse.move(500, 500);
  await other.waitForTimeout(500);
  await shot(page, name("two-people"));
  await other.goto(`${base}/`);
  await other.getByRole("link", { name: /nefertiti/ }).first().click();
  await drawn(other);
  await other.getByText("This object is").waitFor();
  await shot(other, name("scale"));
  await other.goto(`${base}/models/999`);
  await shot(other, name("missing"));
  await context.close();
}

async function sizes() {
  const phone = await open({ viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, hasTouch: true, isMobile: true });
  await sign_in(phone.page);
  await phone.page.waitForTimeout(1500);
  await shot(phone.page, "phone-home");
  await phone.page.goto(`${base}/models/1`);
  await drawn(phone.page);
  await shot(phone.page, "phone-model");
  await phone.page.getByRole("button", { name: "Brush" }).click();
  await phone.page.getByRole("button", { name: "Show the panel" }).click();
  await shot(phone.page, "phone-panel");
  await phone.context.close();
  const wall = await open({ viewport: { width: 3840, height: 2160 } });
  await sign_in(wall.page);
  await wall.page.goto(`${base}/models/1`);
  await drawn(wall.page);
  await wall.page.waitForTimeout(800);
  await shot(wall.page, "wall-model");
  await wall.context.close();
}

await tour("light");
await tour("dark");
await sizes();
