// The View panel: surface images, light and section change only this user's view, by mouse and by
// keys. A brush paints the part that the section leaves visible.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_on_picture, open_tab } from "../support/js/panel.mjs";
import { encode_png } from "../support/js/png.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kOutput = process.env.STRATA_TEST_OUTPUT ?? "/tmp/strata-view";
mkdirSync(kOutput, { recursive: true });
const kCyan = [0, 200, 255]; // no part of the pot has this hue
const radio = (name) => bar.getByRole("radio", { name, exact: true });
const stage = async () => browser.picture(await browser.stage_box());
const shot = async (name) =>
  writeFileSync(join(kOutput, `view-${name}.png`), await browser.settled());
const brightness = ({ data, width, height }, from, to) => {
  let sum = 0;
  for (let y = Math.round(height * 0.62); y < height * 0.75; ++y)
    for (let x = Math.round(width * from); x < width * to; ++x) sum += data[(y * width + x) * 4];
  return sum / ((to - from) * width * 0.13 * height);
};

let browser, page, server, panel, bar, side, cyan, inside, uncut;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });

  panel = page.locator("strata-view-panel");
  bar = page.locator("strata-picture-bar");
  await server.start();
  side = 64;
  cyan = { width: side, height: side, data: new Uint8Array(side * side * 4) };
  for (let at = 0; at < cyan.data.length; at += 4) cyan.data.set([...kCyan, 255], at);

  for (const { id } of (await server.json("GET", "/models/demo-pot/layers")).layers)
    // the layers would hide the content below
    await server.json("PATCH", `/models/demo-pot/layers/${id}`, { visible: false });

  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
});

test("the panel begins with the layers; tabs change by mouse, arrows and keys, and are kept", async () => {
  const tab = (name) => page.getByRole("tab", { name });
  const chosen = () => page.getByRole("tab", { selected: true }).getAttribute("data-tab");
  assert.equal(await chosen(), "layers");
  await tab(words.view.title).click();
  await panel.getByRole("heading", { name: words.view.title, exact: true }).waitFor();
  await tab(words.view.title).focus();
  for (const [key, name] of [
    ["ArrowRight", "comments"],
    ["ArrowRight", "activity"],
    ["ArrowRight", "layers"],
    ["End", "activity"],
    ["Home", "layers"],
    ["ArrowLeft", "activity"],
    ["r", "records"],
    ["j", "comments"],
    ["y", "layers"],
    ["w", "view"],
  ]) {
    await page.keyboard.press(key);
    assert.equal(await chosen(), name, `after ${key}`);
  }
  await page.keyboard.press("q");
  await page.getByRole("tablist").waitFor({ state: "detached" });
  await page.keyboard.press("q");
  await page.reload();
  await browser.drawn();
  assert.equal(await chosen(), "view");
});

test("a picture that is added is shown, and blends by its slider", async () => {
  await panel.locator("input[type=file]").setInputFiles({
    name: "UV light.png",
    mimeType: "image/png",
    buffer: Buffer.from(encode_png(cyan)),
  });
  await panel.getByText("UV light").waitFor();
  await wait_for(async () => (await browser.count(kCyan)) > 20_000, "the look on the pot", 150);
  await shot("look");
  await panel.getByLabel(words.layers.opacity_of("UV light")).fill("0");
  await wait_for(async () => (await browser.count(kCyan)) === 0, "the look to be clear", 150);
  await panel.getByRole("button", { name: words.layers.hide("UV light") }).click();
});

test("raking light comes from where the pad is dragged to, and from where the keys move it", async () => {
  await open_on_picture(page, words, words.view.light);
  await radio(words.view.lights.raking).click();
  const pad = bar.getByRole("slider", { name: words.view.light_direction });
  const box = await pad.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 4, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  const lit_from = async (side) => {
    const picture = await stage();
    const more = brightness(picture, 0.34, 0.44) - brightness(picture, 0.58, 0.68);
    return side === "left" ? more > 15 : more < -15;
  };
  await wait_for(() => lit_from("left"), "light from the left", 150);
  await shot("raking");
  const said = await pad.getAttribute("aria-valuetext");
  await pad.focus();
  for (let i = 0; i < 22; ++i) await page.keyboard.press("ArrowRight");
  assert.notEqual(await pad.getAttribute("aria-valuetext"), said);
  await wait_for(() => lit_from("right"), "light from the right", 150);
  await radio(words.view.lights.museum).click();
});

test("a section opens the pot, and the brush paints what is seen then", async () => {
  await open_on_picture(page, words, words.view.section);
  await radio(words.view.sections.y).click();
  await bar.getByLabel(words.view.cut_position).fill("0");
  await bar.getByRole("button", { name: words.view.flip }).click();
  inside = ({ data }) => {
    let count = 0;
    for (let at = 0; at < data.length; at += 4)
      if ([219, 209, 194].every((wanted, c) => Math.abs(data[at + c] - wanted) < 4)) ++count;
    return count;
  };
  uncut = inside(await stage()); // some parts of the clay also have that color
  await bar.getByLabel(words.view.cut_position).fill("500");
  await wait_for(
    async () => inside(await stage()) > 3 * uncut + 3000,
    "the wall to be shown cut",
    150,
  );
  await page.keyboard.press("b");
  await shot("section");
  const layer = (await server.json("GET", "/models/demo-pot/layers")).layers.at(-1);
  const edits = async () =>
    (await server.json("GET", `/models/demo-pot/layers/${layer.id}/edits?limit=1000`)).total;
  const known = await edits();
  await browser.drag([
    [0.46, 0.55],
    [0.54, 0.6],
  ]);
  await browser.saved();
  assert.ok((await edits()) > known);
  await page.keyboard.press("v");
});

test("a box keeps what is inside, and sides do not pass each other", async () => {
  await radio(words.view.sections.box).click();
  await bar.getByLabel(words.view.box_to("Z")).fill("300");
  await bar.getByLabel(words.view.box_from("Z")).fill("900");
  assert.ok(Number(await bar.getByLabel(words.view.box_from("Z")).inputValue()) < 300);
  await bar.getByLabel(words.view.box_from("Z")).fill("0");
  await shot("box");
});

test("the cube shows the side that is seen; a face, an arrow key or a drag turns the model", async () => {
  const cube = page.getByRole("radiogroup", { name: words.picture_bar.cube });
  const face = (name) => cube.getByRole("radio", { name, exact: true });
  // waits until the camera has arrived
  const chosen = (name, what = name) =>
    wait_for(
      async () => (await face(name).getAttribute("aria-checked")) === "true",
      `${what} to be chosen`,
    );
  const none_chosen = () =>
    wait_for(
      async () => (await cube.getByRole("radio", { checked: true }).count()) === 0,
      "no side to be chosen",
    );
  await page.getByRole("button", { name: words.views.first, exact: true }).click();
  await none_chosen();
  await face(words.views.top).click();
  await chosen(words.views.top);
  await face(words.views.top).focus();
  for (const [key, name] of [
    ["ArrowDown", words.views.front],
    ["ArrowRight", words.views.right],
    ["ArrowRight", words.views.back],
    ["ArrowRight", words.views.left],
    ["ArrowDown", words.views.bottom],
    ["ArrowUp", words.views.front],
  ]) {
    await page.keyboard.press(key);
    await chosen(name, `${name}, after ${key},`);
  }
  await page.keyboard.press("6");
  await chosen(words.views.bottom);
  await page.keyboard.press("1");
  await chosen(words.views.front);
  const box = await cube.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 20, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  await none_chosen();
  await page.keyboard.press("Shift+Home");
});

test("keys step through lights and cuts", async () => {
  await page.mouse.click((await browser.stage_box()).x + 10, (await browser.stage_box()).y + 10);
  await page.keyboard.press("k");
  assert.equal(await radio(words.view.lights.headlight).getAttribute("aria-checked"), "true");
});

test("reset shows the model as others see it", async () => {
  await page.keyboard.press("Control+z");
  await browser.saved();
  await open_tab(page, words, words.view.title);
  await panel.getByRole("button", { name: words.view.reset }).click();
  assert.equal(await radio(words.view.lights.museum).getAttribute("aria-checked"), "true");
  assert.equal(await radio(words.view.sections.off).getAttribute("aria-checked"), "true");
  await wait_for(async () => inside(await stage()) < 2 * uncut + 1000, "the whole pot", 150);
});

test("on a phone the bar is on the picture, above the sheet", async () => {
  const phone = await Browser.open({
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  try {
    await phone.sign_in(server, server.token);
    await phone.page.goto(`${server.url}/models/1`);
    await phone.drawn();
    const view = phone.page.locator("strata-picture-bar");
    await open_tab(phone.page, words, words.view.title);
    await open_on_picture(phone.page, words, words.view.light);
    await view.getByRole("radio", { name: words.view.lights.raking, exact: true }).click();
    await view.getByRole("slider", { name: words.view.light_direction }).scrollIntoViewIfNeeded();
    writeFileSync(join(kOutput, "view-phone.png"), await phone.settled());
    phone.assert_no_complaints();
  } finally {
    await phone.close();
  }

  browser.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
