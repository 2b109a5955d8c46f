// A kiosk in a real browser: opened by its link alone, operated with fingers, left alone and used
// again, without its server and with it again, reloaded remotely, and revoked. The test controls
// the page's clock. Environment variables:
// - STRATA_KIOSK_ROUNDS: number of visits during which memory is measured
// - STRATA_KIOSK_ALONE_MIN: minutes of the page's clock for which the tour plays alone after each
//   visit
// - STRATA_KIOSK_STEP_S: seconds that pass in one step of that time, with one stop of the tour each
// - STRATA_KIOSK_TOURS: number of complete tours before the visits, each with every camera movement
//   at normal speed
// The values 205, 50, 75 and 0 are a week of operation and take an hour. The values 24, 1, 5 and 10
// are 480 movements and take 40 minutes.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { findings } from "../support/js/accessible.mjs";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { kModel, kTour, make_kiosk_site } from "../support/js/kiosk-site.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";

const kRounds = Number(process.env.STRATA_KIOSK_ROUNDS ?? 4);
const kAlone_min = Number(process.env.STRATA_KIOSK_ALONE_MIN ?? 0.5);
const kStep_s = Number(process.env.STRATA_KIOSK_STEP_S ?? 5);
const kTours = Number(process.env.STRATA_KIOSK_TOURS ?? 1);
const kUpright = { width: 1080, height: 1920 };
// The layout is checked on each screen. The rest of the test uses the last one.
const kScreens = [{ width: 1920, height: 1080 }, { width: 768, height: 1024 }, kUpright];
const kTarget_px = 57; // 15 mm on the screen of a kiosk
// In MB, for the page and (next line) for the server. The memory that they use grows a little
// although the work stays the same. The limits allow this growth, but not a leak of one picture
// per round.
const kMostHeapGrowth = 1.5;
const kMostServerGrowth = 48; // in MB
const kMostNodeGrowth = 60;

const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `kiosk_${name}.png`) });
};
const button = (name) => page.getByRole("button", { name, exact: true });
const heading = (name) => page.getByRole("heading", { level: 1, name, exact: true });
const live = () =>
  wait_for(
    () => page.locator("strata-kiosk-stage canvas.live[data-still=true]").count(),
    "a live picture that is still",
  );
/** Advances the page's clock in steps. Between them the page handles messages from the server. */
const pass = async (seconds, step_s = 5) => {
  for (let left = seconds; left > 0; left -= step_s) {
    await page.clock.fastForward(Math.min(step_s, left) * 1000);
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 0)));
  }
};
const sent = { camera: null, layers: null };
let cameras = 0;
const eye = ({ view }) =>
  [0, 1, 2].map(
    (c) => -[0, 1, 2].reduce((sum, row) => sum + view[4 * c + row] * view[12 + row], 0),
  );
const apart = (a, b) => Math.hypot(...a.map((each, index) => each - b[index]));
/** Moves fingers along paths with the same number of points, as a touch screen reports them. */
async function touch(...paths) {
  const points = (at) => paths.map((path, id) => ({ id, x: path[at][0], y: path[at][1] }));
  await cdp.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
  for (let at = 1; at < paths[0].length; ++at)
    await cdp.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: points(at) });
  await cdp.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}
const line = ([x0, y0], [x1, y1], steps = 8) =>
  Array.from({ length: steps + 1 }, (_, n) => [
    x0 + ((x1 - x0) * n) / steps,
    y0 + ((y1 - y0) * n) / steps,
  ]);
const middle = async (locator) => {
  const { x, y, width, height } = await locator.boundingBox();
  return [x + width / 2, y + height / 2];
};

/**
 * Checks that all controls are large enough and in the lower half of each screen, and that no link
 * leads to another page.
 */
async function assert_within_reach(where) {
  for (const screen of kScreens) {
    await page.setViewportSize(screen);
    if (screen !== kUpright) await shot(`${where.replaceAll(" ", "_")}_${screen.width}`);
    await assert_within_reach_on(screen, `${where} at ${screen.width} × ${screen.height}`);
  }
}
async function assert_within_reach_on({ height }, where) {
  const found = await page.evaluate(() => {
    const all = (root) =>
      [...root.querySelectorAll("*")].flatMap((each) => [
        each,
        ...(each.shadowRoot ? all(each.shadowRoot) : []),
      ]);
    const seen = all(document).filter((each) => each.checkVisibility({ visibilityProperty: true }));
    return {
      links: seen.filter((each) => each.matches("a[href], form, iframe")).length,
      buttons: seen
        .filter((each) => each.matches("button"))
        .map((each) => ({
          name: each.textContent.trim(),
          ...each.getBoundingClientRect().toJSON(),
        })),
      overflow:
        document.scrollingElement.scrollHeight > innerHeight ||
        document.scrollingElement.scrollWidth > innerWidth,
    };
  });
  assert.equal(found.links, 0, `${where}: something leads away`);
  assert.equal(found.overflow, false, `${where}: the page scrolls`);
  assert.ok(found.buttons.length > 0, where);
  for (const { name, width, height: high, bottom, top } of found.buttons) {
    assert.ok(width >= kTarget_px && high >= kTarget_px, `${where}: ${name} is ${width} × ${high}`);
    assert.ok(
      high > height * 0.9 || (top + bottom) / 2 > height / 2,
      `${where}: ${name} is not in the lower half`,
    );
  }
}
const assert_accessible = async (where) => assert.deepEqual(await findings(page), [], where);

let browser,
  server,
  page,
  begin,
  cdp,
  path,
  kiosk,
  fits,
  stage,
  x,
  y,
  is_shown,
  card,
  stored,
  sign,
  picture,
  is_loaded,
  tour;

test.beforeAll(async () => {
  browser = await Browser.open({ viewport: kUpright, hasTouch: true });
  // on a busy machine more threads have separate memory, which would look like growth
  server = new StrataServer({ demo: true, env: { MALLOC_ARENA_MAX: "2" } });
  ({ page } = browser);
  // a kiosk does not need WebCodecs
  await page.addInitScript(() =>
    ["VideoDecoder", "ImageDecoder", "VideoFrame", "EncodedVideoChunk"].forEach(
      (name) => delete globalThis[name],
    ),
  );
  begin = page.getByRole("button", { name: /^Touch to begin/ });
  page.on("websocket", (socket) =>
    socket.on("framesent", ({ payload }) => {
      const message = JSON.parse(String(payload));
      sent[message.op] = message;
      if (message.op === "camera") ++cameras;
    }),
  );

  cdp = await page.context().newCDPSession(page);
  await server.start();
  ({ path, kiosk } = await make_kiosk_site(server, { idle_s: 30 }));
  await page.clock.install();
});

test("the link alone opens it, and nobody is signed in; it plays by itself", async () => {
  await page.goto(server.url + path);
  await begin.waitFor();
  await live();
  await heading("The pot from the well").waitFor();
  await assert_within_reach("attract");
  await assert_accessible("attract");
  await shot("attract");
  await pass(13);
  await heading("Fourteen sherds").waitFor();
  assert.equal(
    (await page.context().cookies()).filter(({ name }) => name !== "strata_kiosk").length,
    0,
  );
});

test("at rest the server is asked for nothing; the picture comes nearer by itself, but not for who wants less motion", async () => {
  const comes_near = () =>
    page
      .locator("strata-kiosk-stage canvas")
      .evaluate((canvas) =>
        canvas.getAnimations().some(({ animationName }) => animationName === "come-near"),
      );
  /**
   * Returns how often the page sent the camera in 1.5 s, or null if the stop changed in that time.
   */
  const moves = async () => {
    const [title, seq] = [await page.locator("h1").textContent(), sent.camera.seq];
    await page.clock.runFor(1500);
    return title === (await page.locator("h1").textContent()) ? sent.camera.seq - seq : null;
  };
  await wait_for(async () => (await moves()) === 0, "a stop that stands still");
  assert.equal(await comes_near(), false);
  await page.emulateMedia({ reducedMotion: "no-preference" });
  await wait_for(comes_near, "the picture to come nearer");
  await wait_for(async () => (await moves()) > 10, "the way to a stop");
  await wait_for(async () => (await moves()) === 0, "a stop that stands still, for the server");
  await shot("nearer");
  await page.emulateMedia({ reducedMotion: "reduce" });
  await wait_for(async () => !(await comes_near()), "an end of it");
});

test("a touch begins at the first stop, and does nothing else", async () => {
  await page.touchscreen.tap(540, 400);
  await heading("The pot from the well").waitFor();
  assert.equal(await begin.count(), 0);
  await live();
  await assert_within_reach("first stop");
  await assert_accessible("first stop");
  await shot("first");
});

test("on an upright screen the object has most of the height, and its words no more than they need", async () => {
  fits = async (where) => {
    const stage = await page.locator("strata-kiosk-stage").boundingBox();
    assert.ok(
      stage.height >= 0.6 * kUpright.height,
      `${where}: the object has ${stage.height} of ${kUpright.height}`,
    );
    const words = page.locator(".panel > .words");
    const [room, needed] = await words.evaluate((each) => [
      each.clientHeight,
      [...each.children].at(-1).getBoundingClientRect().bottom - each.getBoundingClientRect().top,
    ]);
    assert.ok(room - needed < 12, `${where}: words of ${needed} in ${room}`);
  };
  await fits("first stop");
});

test("keys reach all of it: Tab goes to a button, Enter presses it, and the object has its own", async () => {
  const focused = () =>
    page.evaluate(() => {
      let at = document.activeElement;
      while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement;
      return at.textContent.trim() || at.ariaLabel || at.tagName;
    });
  const tab_to = async (name, key = "Tab") => {
    const passed = [];
    while (passed.at(-1) !== name) {
      assert.ok(passed.length < 30, `${key} does not reach ${name}: ${passed.join(", ")}`);
      await page.keyboard.press(key);
      passed.push(await focused());
    }
  };
  await tab_to(await page.locator("strata-kiosk-stage .surface").getAttribute("aria-label"));
  for (const key of ["+", "-", "ArrowRight", "ArrowLeft", "ArrowUp", "ArrowDown"]) {
    const before = sent.camera;
    await page.keyboard.press(key);
    await wait_for(() => apart(eye(sent.camera), eye(before)) > 1, `${key} on the object`);
  }
  await tab_to("Next");
  await page.keyboard.press("Enter");
  await heading("Fourteen sherds").waitFor();
  await tab_to("Sherd 3", "Shift+Tab");
  await page.keyboard.press("Enter");
  await page.locator(".card").getByRole("heading", { name: "Sherd 3" }).waitFor();
  await tab_to("Close");
  await page.keyboard.press("Enter");
  await page.locator(".card").waitFor({ state: "detached" });
  await tab_to("Previous");
  await page.keyboard.press("Enter");
  await heading("The pot from the well").waitFor();
  await live();
});

test("one finger turns, two move, enlarge and tilt", async () => {
  stage = await page.locator("strata-kiosk-stage").boundingBox();
  [x, y] = [stage.x + stage.width / 2, stage.y + stage.height / 2];
  const at_first = sent.camera;
  await touch(line([x, y], [x + 200, y + 40]));
  await wait_for(() => apart(eye(sent.camera), eye(at_first)) > 20, "one finger to turn it");
  await live();
  const after_turn = sent.camera;
  await touch(line([x - 60, y], [x - 200, y]), line([x + 60, y], [x + 200, y]));
  await wait_for(() => apart(eye(sent.camera), eye(after_turn)) > 60, "two fingers to come nearer");
  const near = sent.camera;
  await touch(line([x - 60, y], [x - 60, y + 150]), line([x + 60, y], [x + 60, y + 150]));
  await wait_for(
    () =>
      apart(eye(sent.camera), eye(near)) > 3 && Math.abs(sent.camera.view[0] - near.view[0]) < 1e-9,
    "two fingers to move it",
  );
  const moved = sent.camera;
  await touch(
    [
      [x - 100, y],
      [x - 70, y - 70],
      [x, y - 100],
    ],
    [
      [x + 100, y],
      [x + 70, y + 70],
      [x, y + 100],
    ],
  );
  await wait_for(
    () => Math.abs(sent.camera.view[0] - moved.view[0]) > 0.1,
    "two fingers to tilt it",
  );
  assert.equal(await page.evaluate(() => visualViewport.scale), 1, "the page was zoomed");
  for (const name of ["contextmenu", "selectstart", "dragstart"])
    assert.equal(
      await page.evaluate(
        (event) =>
          document
            .querySelector("strata-kiosk")
            .dispatchEvent(new Event(event, { bubbles: true, cancelable: true, composed: true })),
        name,
      ),
      false,
      name,
    );
});

test("the next stop is there where its view has it, whatever was turned before; buttons and swipes choose its layers", async () => {
  await button("Next").tap();
  await heading("Fourteen sherds").waitFor();
  is_shown = (name) =>
    wait_for(
      async () => (await button(name).getAttribute("aria-pressed")) === "true",
      `the layer ${name}`,
    );
  await is_shown("Sherds");
  await live();
  await assert_within_reach("second stop");
  await assert_accessible("second stop");
  await shot("second");
  await button("cracks").tap();
  await is_shown("cracks");
  const visible = () => sent.layers.layers.filter((layer) => layer.visible).length;
  await wait_for(() => visible() === 1, "one layer to be shown");
  const text = await page.locator(".panel .words").boundingBox();
  await touch(line([text.x + 700, text.y + 100], [text.x + 300, text.y + 110]));
  await is_shown("pieces");
  await touch(line([text.x + 700, text.y + 100], [text.x + 300, text.y + 110]));
  await is_shown("pieces"); // the last layer
  const row = await page.locator(".layers").boundingBox();
  await touch(line([row.x + 200, row.y + 30], [row.x + 500, row.y + 32]));
  await is_shown("cracks");
  await touch(line([row.x + 200, row.y + 30], [row.x + 500, row.y + 32]));
  await is_shown("Sherds");
});

test("a tap on a class says which it is, beside the place, until the object moves", async () => {
  await fits("second stop");
  const choose = (name) =>
    wait_for(async () => {
      await button(name).tap(); // a tap may miss the button while the row of buttons moves
      return (await button(name).getAttribute("aria-pressed")) === "true";
    }, `the layer ${name}`);
  await choose("pieces");
  await live();
  await page.touchscreen.tap(x, y);
  const place = page.locator(".place-of-tap");
  await place.getByText(/^Sherd \d+$/).waitFor();
  await place.getByText("pieces", { exact: true }).waitFor();
  const bubble = await place.locator("p").boundingBox();
  assert.ok(
    bubble.x >= 0 &&
      bubble.x + bubble.width <= kUpright.width &&
      Math.abs(bubble.x + bubble.width / 2 - x) < 250 &&
      bubble.y + bubble.height < y,
    JSON.stringify(bubble),
  );
  await assert_accessible("class");
  await shot("class");
  await touch(line([x, y], [x + 120, y + 20]));
  await place.waitFor({ state: "detached" });
  await choose("Sherds");
});

test("a tap shows the record at this place, with its picture", async () => {
  await live();
  await page.touchscreen.tap(x, y);
  card = page.locator(".card");
  await card.getByRole("heading", { name: /^Sherd \d+$/ }).waitFor();
  await card.getByText(/^\d+(\.5)? mm$/).waitFor();
  await assert_within_reach("card");
  await assert_accessible("card");
  await shot("card");
  await card.getByRole("button", { name: /^Enlarge: sherd-\d+\.png$/ }).tap();
  const large = page.locator(".enlarged img");
  await wait_for(
    () => large.evaluate(({ naturalWidth }) => naturalWidth > 0),
    "the enlarged picture",
  );
  await assert_accessible("enlarged");
  await page.getByRole("dialog").getByRole("button", { name: "Close" }).tap();
  await card.getByRole("button", { name: "Close", exact: true }).tap();
  await card.waitFor({ state: "detached" });
  await button("Sherd 3").tap();
  await card.getByRole("heading", { name: "Sherd 3" }).waitFor();
  await card.getByText("Inventory", { exact: true }).waitFor();
  const before_swipe = sent.layers;
  const on_card = await card.locator(".words").boundingBox();
  await touch(line([on_card.x + 700, on_card.y + 100], [on_card.x + 300, on_card.y + 110]));
  // A browser treats the first tap after a fling as the end of the fling.
  const close = card.getByRole("button", { name: "Close", exact: true });
  await wait_for(
    async () =>
      (await card.count()) === 0 || (await close.tap({ timeout: 2000 }).catch(() => {}), false),
    "the card to be closed",
  );
  await is_shown("Sherds");
  assert.equal(sent.layers, before_swipe, "a swipe over the card changed the layer behind it");
});

test("its words are in the visitor's language", async () => {
  await button("Deutsch").tap();
  await heading("Vierzehn Scherben").waitFor();
  // the last layer has no German name
  for (const name of ["Scherben", "Risse", "pieces"]) await button(name).waitFor();
  await button("Sherd 3").tap();
  await card.getByText("Wandstärke", { exact: true }).waitFor();
  await shot("german");
  await button("Schließen").tap();
  await button("Español").tap();
  await heading("Fourteen sherds").waitFor(); // this title has no translation
  await button("Siguiente").waitFor();
});

test("who touches nothing is asked, and stays by saying so", async () => {
  await pass(25);
  assert.equal(await button("Sigo aquí").count(), 0);
  await pass(10);
  await button("Sigo aquí").waitFor();
  await assert_within_reach("asked");
  await assert_accessible("asked");
  await shot("asked");
  await button("Sigo aquí").tap();
  await button("Siguiente").waitFor();
  await pass(25);
  assert.equal(await button("Sigo aquí").count(), 0, "the time begins anew");
});

test("otherwise it begins anew, in its own language", async () => {
  await pass(45);
  await begin.waitFor();
  await heading("The pot from the well").waitFor();
  assert.equal(await page.evaluate(() => document.documentElement.lang), "en");
});

test("it keeps what it shows", async () => {
  stored = () =>
    page.evaluate(async () =>
      (await (await caches.open("strata-kiosk")).keys()).map(({ url }) => new URL(url).pathname),
    );
  await wait_for(
    async () => {
      await pass(31); // time for a heartbeat
      const keys = await stored();
      return (
        keys.filter((key) => key.endsWith("/picture")).length === 3 &&
        keys.includes("/api/v1/tables/sherds") &&
        keys.filter((key) => key.startsWith("/api/v1/attachments/")).length >= 2 &&
        keys.some((key) => key.startsWith("/kiosk/told/"))
      );
    },
    "the store to be full",
    300,
  );
  assert.ok(
    (await stored()).every((key) => !key.includes(path.split("/").at(-1))),
    "the secret is stored",
  );
  await page.evaluate(() => navigator.serviceWorker.ready);
});

test("without its server the tour goes on with stored pictures", async () => {
  await begin.tap();
  await button("Next").waitFor();
  await server.signal("SIGTERM");
  sign = page.getByText("Only still pictures at the moment");
  await wait_for(async () => (await pass(2), await sign.count()), "the sign", 200);
  picture = page.locator("strata-kiosk-stage img");
  is_loaded = () =>
    wait_for(
      () => picture.evaluate(({ complete, naturalWidth }) => complete && naturalWidth > 0),
      "the stored picture",
    );
  await is_loaded();
  await assert_accessible("away");
  await shot("away");
  // The server needed some time to end, so the tour may have restarted.
  if (await begin.isVisible()) await begin.tap();
  await button("Next").tap();
  await heading("Fourteen sherds").waitFor();
  await is_loaded();
  await button("Sherd 3").tap();
  await card.getByRole("heading", { name: "Sherd 3" }).waitFor();
  await wait_for(
    () => card.locator("img").evaluate(({ naturalWidth }) => naturalWidth > 0),
    "the stored picture of the record",
  );
  await shot("away_card");
  await card.getByRole("button", { name: "Close", exact: true }).tap();
});

test("even when its browser begins anew", async () => {
  await page.reload();
  await wait_for(async () => (await pass(2), await begin.count()), "the stored tour", 200);
  await is_loaded();
  await pass(13);
  await heading("Fourteen sherds").waitFor();
  await is_loaded();
});

test("and is live again by itself", async () => {
  await server.start();
  await wait_for(
    async () => (await pass(10), await page.locator("strata-kiosk-stage canvas.live").count()),
    "live pictures",
    300,
  );
  await wait_for(async () => (await sign.count()) === 0, "no sign");
  assert.equal(await picture.count(), 0);
});

test("a changed tour is shown without anybody's doing", async () => {
  tour = await server.json("GET", kTour);
  tour.stops[0].title.en = "The vessel from the well";
  await server.json("PATCH", kTour, { stops: tour.stops });
  await wait_for(
    async () => (await pass(10), await heading("The vessel from the well").count()),
    "the new title",
    100,
  );
});

test("an administrator has it loaded anew", async () => {
  await page.evaluate(() => (globalThis.before = true));
  await server.json("POST", `/kiosks/${kiosk.id}/reload`);
  const is_new = () => page.evaluate(() => globalThis.before === undefined).catch(() => false);
  await wait_for(
    async () => (await is_new()) || (await page.clock.fastForward(31_000).catch(() => {}), false),
    "the page to be loaded anew",
    300,
  );
  await begin.waitFor();
  await wait_for(
    async () => (await server.json("GET", "/kiosks")).kiosks[0].wants_reload === false,
    "the wish to be gone",
  );
});

test(`memory stays flat over ${kRounds} visitors`, async () => {
  // Most of the time goes into the pictures, so a short run draws smaller ones. In a short run, a
  // small leak of the server stays below the limit. A long run finds it.
  if (kRounds < 20) await page.setViewportSize({ width: 768, height: 1024 });
  await live();
  const server_mb = () =>
    Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.process.pid}/status`, "utf8"))[1]) /
    1024;
  const used = async () => {
    await cdp.send("HeapProfiler.collectGarbage");
    const { metrics } = await cdp.send("Performance.getMetrics");
    const of = (name) => metrics.find((metric) => metric.name === name).value;
    return {
      heap_mb: of("JSHeapUsedSize") / 2 ** 20,
      nodes: of("Nodes"),
      listeners: of("JSEventListeners"),
      server_mb: server_mb(),
    };
  };
  const told = ({ heap_mb, nodes, listeners, server_mb: rss }) =>
    `page ${heap_mb.toFixed(2)} MB, ${nodes} nodes, ${listeners} listeners; server ${rss.toFixed(0)} MB`;
  /** The slope of the line of least squares through the samples, in MB a day. */
  const growth = (samples, name) => {
    const mean = (of) => samples.reduce((sum, each) => sum + of(each), 0) / samples.length;
    const [day, mb] = [mean((each) => each.days), mean((each) => each[name])];
    const spread = mean((each) => (each.days - day) ** 2);
    return mean((each) => (each.days - day) * (each[name] - mb)) / spread;
  };
  await cdp.send("Performance.enable");
  // each stop, with the smallest number of cameras that the page sends on the way to it
  const kStops = [
    ["The vessel from the well", 2],
    ["Fourteen sherds", 2],
    ["The rim", 1],
  ];
  const visit = async (tours) => {
    await begin.tap();
    await button("Deutsch").tap();
    await button("Weiter").tap();
    await button("Sherd 3").tap();
    await card.getByRole("heading", { name: "Sherd 3" }).waitFor();
    await wait_for(async () => (await pass(15), await begin.count()), "the visitor to be gone", 20);
    for (const title of ["Fourteen sherds", "The rim"])
      await wait_for(async () => (await pass(3), await heading(title).count()), title, 20);
    await page.emulateMedia({ reducedMotion: tours > 0 ? "no-preference" : "reduce" });
    for (let tour = 0; tour < tours; ++tour)
      for (const [title, fewest] of kStops) {
        const before = cameras;
        await pass(9, 3);
        await wait_for(async () => (await pass(1), await heading(title).count()), title, 20);
        await wait_for(
          () => cameras >= before + fewest && !sent.camera.moving,
          `the end of the way to ${title}`,
        );
        await live();
      }
    await page.emulateMedia({ reducedMotion: "reduce" });
    await pass(kAlone_min * 60, kStep_s);
  };
  // runs until everything is loaded and compiled
  for (let round = 0; round < 8; ++round) await visit(round === 0 ? kTours : 0);
  const first = await used();
  // the state after half of the visits; allocators grow for a limited time, and leaks grow without
  // limit
  let settled = first;
  const clock = () => page.evaluate(() => performance.now());
  const from_ms = await clock();
  const cameras_before = cameras;
  const samples = []; // of the second half
  for (let round = 1; round <= kRounds; ++round) {
    await visit(kTours);
    const now = await used();
    if (kRounds > 20 && round === Math.floor(kRounds / 2)) settled = now;
    if (round >= kRounds / 2)
      samples.push({ ...now, days: ((await clock()) - from_ms) / 86_400_000 });
    if (round % 10 === 0) console.log(`  after ${round} visitors: ${told(now)}`);
  }
  const after = await used();
  const hours = ((await clock()) - from_ms) / 3600_000;
  console.log(
    `  before: ${told(first)}\n  after ${kRounds} visitors in ${hours.toFixed(1)} h of the page's clock, with ${kRounds * kTours * 2} ways of ${cameras - cameras_before} cameras: ${told(after)}`,
  );
  if (kRounds > 20)
    console.log(
      `  growth for a day of the page's clock: page ${growth(samples, "heap_mb").toFixed(2)} MB, server ${growth(samples, "server_mb").toFixed(2)} MB`,
    );
  assert.ok(after.heap_mb - settled.heap_mb < kMostHeapGrowth, "the page's memory grows");
  assert.ok(
    after.nodes - settled.nodes < kMostNodeGrowth &&
      after.listeners - settled.listeners < kMostNodeGrowth,
    "the page holds on to what is gone",
  );
  assert.ok(after.server_mb - settled.server_mb < kMostServerGrowth, "the server's memory grows");
});

test("revoked, it says so in plain words, and keeps nothing", async () => {
  await server.request("DELETE", `/kiosks/${kiosk.id}`);
  await page.getByRole("heading", { name: "This screen no longer has a tour" }).waitFor();
  await assert_accessible("revoked");
  await shot("revoked");
  await wait_for(async () => (await stored()).length === 0, "the store to be empty");
  await page.goto(`${server.url}/kiosk/nothing`);
  await page.getByRole("heading", { name: "This screen no longer has a tour" }).waitFor();
  assert.equal(new URL(page.url()).pathname, "/kiosk/nothing");

  // a stopping server responds with this status
  browser.assert_no_complaints([...kOfLostServer, "status of 401", "status of 503"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
  assert.ok(
    server.log.every((entry) => !entry.includes(path)),
    "the secret is in the log",
  );
  console.log("ok");
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
