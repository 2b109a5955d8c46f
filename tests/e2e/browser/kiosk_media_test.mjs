// The design and the media of a tour: made in the editor, and shown on a kiosk in a dark room, with
// the QR code for phones, and without the server.
import assert from "node:assert/strict";
import { join } from "node:path";
import { findings } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { kTour, make_kiosk_site } from "../support/js/kiosk-site.mjs";
import { encode_png } from "../support/js/png.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";

let browser, server, page, path, kiosk;
const button = (name) => page.getByRole("button", { name, exact: true });
const heading = (name) => page.getByRole("heading", { level: 1, name, exact: true });
const live = () =>
  page.locator("strata-kiosk-stage canvas.live[data-still=true]").waitFor({ timeout: 120_000 });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `media_${name}.png`) });
};

function picture(width, height, color) {
  const data = new Uint8Array(4 * width * height);
  for (let at = 0; at < width * height; ++at) data.set(color, 4 * at);
  return encode_png({ width, height, data });
}
/** Returns a tone of 20 seconds, 8-bit mono. */
function sound() {
  const samples = 8000 * 20;
  const wav = Buffer.alloc(44 + samples);
  wav.write("RIFF", 0);
  wav.writeUInt32LE(36 + samples, 4);
  wav.write("WAVEfmt ", 8);
  wav.writeUInt32LE(16, 16);
  wav.writeUInt16LE(1, 20);
  wav.writeUInt16LE(1, 22);
  wav.writeUInt32LE(8000, 24);
  wav.writeUInt32LE(8000, 28);
  wav.writeUInt16LE(1, 32);
  wav.writeUInt16LE(8, 34);
  wav.write("data", 36);
  wav.writeUInt32LE(samples, 40);
  for (let at = 0; at < samples; ++at) wav[44 + at] = 128 + 20 * Math.sin(at / 6);
  return wav;
}
const file = async (name, body) => {
  const answer = await fetch(`${server.url}/api/v1${kTour}/files?name=${name}`, {
    method: "POST",
    headers: {
      Authorization: `Bearer ${server.token}`,
      "Content-Type": "application/octet-stream",
    },
    body,
  });
  assert.equal(answer.status, 201, await answer.clone().text());
  return (await answer.json()).id;
};

test.beforeAll(async () => {
  browser = await Browser.open({ viewport: { width: 1080, height: 1920 }, hasTouch: true });
  server = new StrataServer({ demo: true });
  ({ page } = browser);
  await server.start();
  ({ path, kiosk } = await make_kiosk_site(server, { idle_s: 3600 }));
  const [logo, photo, voice] = [
    await file("museum.png", picture(200, 80, [224, 164, 88, 255])),
    await file("well.png", picture(600, 400, [70, 110, 140, 255])),
    await file("voice.wav", sound()),
  ];
  const tour = await server.json("GET", kTour);
  tour.stops[0].media = [
    { file: photo, alt: { en: "The well" }, caption: { en: "In 1931", de: "Im Jahr 1931" } },
    { file: voice, caption: { en: "A conservator tells", de: "Eine Restauratorin erzählt" } },
  ];
  await server.json("PATCH", kTour, {
    stops: tour.stops,
    theme: { mode: "dark", accent: "#e0a458", logo, logo_alt: "Museum of the Well" },
    classes: [
      {
        layer: "pieces",
        classes: Array.from({ length: 14 }, (_, at) => ({
          value: at + 1,
          names: { de: `Scherbe ${at + 1}` },
        })),
      },
    ],
  });
  await server.json("PATCH", `/kiosks/${kiosk.id}`, { phones: true });
});

test("a kiosk has the museum's logo and colors, also behind the object", async () => {
  await page.goto(server.url + path);
  await page.locator(".begin").tap();
  await heading("The pot from the well").waitFor();
  await live();
  const logo = page.getByRole("img", { name: "Museum of the Well" });
  await wait_for(() => logo.evaluate(({ naturalWidth }) => naturalWidth > 0), "the logo");
  const next = await button("Next").evaluate((each) => getComputedStyle(each).backgroundColor);
  assert.equal(next, "rgb(224, 164, 88)");
  const corner = await page.locator("strata-kiosk-stage canvas").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(4, 4, 1, 1);
    return [...data].slice(0, 3);
  });
  assert.ok(Math.max(...corner) < 60, `the room is not dark: ${corner}`);
  assert.deepEqual(await findings(page), []);
  await shot("stop");
});

test("a touch opens a picture, with its caption; nothing plays before a touch", async () => {
  assert.equal(await page.locator("audio, video").count(), 0);
  await button("Enlarge: The well").tap();
  const player = page.getByRole("dialog", { name: "The well" });
  await player.getByText("In 1931").waitFor();
  assert.deepEqual(await findings(page), []);
  await shot("picture");
  await player.getByRole("button", { name: "Close" }).tap();
  await player.waitFor({ state: "detached" });
});

test("sound plays after a touch, pauses, and ends with its dialog", async () => {
  await button("Play: A conservator tells").tap();
  const player = page.getByRole("dialog", { name: "A conservator tells" });
  const audio = player.locator("audio");
  await wait_for(() => audio.evaluate(({ currentTime }) => currentTime > 0.2), "the sound");
  assert.equal(await audio.evaluate(({ muted }) => muted), false);
  await shot("sound");
  await player.getByRole("button", { name: "Pause" }).tap();
  await wait_for(() => audio.evaluate(({ paused }) => paused), "the pause");
  assert.deepEqual(await findings(page), []);
  const high = await player.getByRole("button", { name: "Play" }).boundingBox();
  assert.ok(high.height >= 57 && high.y > 960, "the button is too small or too high");
  await player.getByRole("button", { name: "Play" }).tap();
  await wait_for(() => audio.evaluate(({ paused }) => !paused), "the sound again");
  const element = await audio.elementHandle();
  await player.getByRole("button", { name: "Close" }).tap();
  await wait_for(() => element.evaluate(({ paused }) => paused), "silence");
});

test("a class has its name in the visitor's language", async () => {
  await button("Deutsch").tap();
  await button("Abspielen: Eine Restauratorin erzählt").waitFor();
  await button("Weiter").tap();
  await heading("Vierzehn Scherben").waitFor();
  await wait_for(async () => {
    await button("pieces").tap(); // a tap may miss the button while the row of buttons moves
    return (await button("pieces").getAttribute("aria-pressed")) === "true";
  }, "the layer pieces");
  await live();
  const { x, y, width, height } = await page.locator("strata-kiosk-stage").boundingBox();
  await page.touchscreen.tap(x + width / 2, y + height / 2);
  await page
    .locator(".place-of-tap")
    .getByText(/^Scherbe \d+$/)
    .waitFor();
  await shot("class");
});

test("a phone opens the stop of the screen, and sees no code", async () => {
  const own = await page.evaluate(async () => (await fetch("/api/v1/kiosk?as=kiosk")).json());
  await page.locator("figure.phone svg").waitFor();
  const phone = await browser.context.browser()?.newContext?.();
  const other = phone ? await phone.newPage() : await browser.context.newPage();
  await other.setViewportSize({ width: 390, height: 844 });
  await other.goto(`${server.url}${own.phone_path}#stop=2&language=de`);
  await other.getByRole("heading", { level: 1, name: "Vierzehn Scherben" }).waitFor();
  assert.equal(await other.locator("figure.phone, .begin").count(), 0);
  await (phone ?? other).close();
});

test("pictures and sounds are stored, and players get parts of them", async () => {
  await page.clock.install();
  await page.goto(server.url + path);
  await live();
  const kept = () =>
    page.evaluate(
      async () =>
        (await (await caches.open("strata-kiosk")).keys()).filter(({ url }) =>
          /\/files\/\d+\?as=kiosk$/.test(url),
        ).length,
    );
  // the page stores them at a heartbeat, which is every 30 s of the page's clock
  await wait_for(
    async () =>
      (await kept()) === 3 || (await page.clock.fastForward(31_000).catch(() => {}), false),
    "the files to be kept",
    500,
  );
  await page.evaluate(() => navigator.serviceWorker.ready);
  const statuses = await page.evaluate(async () => {
    const found = (await (await caches.open("strata-kiosk")).keys()).filter(({ url }) =>
      url.includes("/files/"),
    );
    const answers = await Promise.all(
      found.map(({ url }) => fetch(url, { headers: { Range: "bytes=4-7" } })),
    );
    return answers.map(({ status }) => status);
  });
  assert.ok(statuses.includes(206), JSON.stringify(statuses));
  browser.assert_no_complaints();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
