// A pen on a tablet: it paints while the hand that holds it rests on the screen. Without the pen,
// two fingers move the model, and one finger rotates it.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

let tilda, server, model, edits, pen, touch, camera, before, painted;

test.beforeAll(async () => {
  tilda = await Browser.open({
    viewport: { width: 1180, height: 820 },
    hasTouch: true,
    isMobile: true,
  });
  server = new StrataServer({ demo: true });
  await server.start();
  [model] = (await server.json("GET", "/models")).models;
  edits = async () =>
    (await server.json("GET", `/models/${model.id}/layers/cracks/edits?limit=1`)).total;
  await tilda.sign_in(server, await server.add_person("tilda", "annotator"));
  await tilda.page.goto(`${server.url}/models/${model.id}`);
  await tilda.drawn();
  await tilda.page.getByRole("button", { name: words.layers.select("cracks") }).click();
  await tilda.page.getByRole("button", { name: words.tools.brush, exact: true }).click();
  const box = await tilda.stage_box();
  const at = ([x, y]) => ({ x: box.x + x * box.width, y: box.y + y * box.height });
  const device = await tilda.context.newCDPSession(tilda.page);
  pen = (type, place, more = {}) =>
    device.send("Input.dispatchMouseEvent", { type, ...at(place), pointerType: "pen", ...more });
  touch = (type, ...places) =>
    device.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: places.map((place, id) => ({ ...at(place), id })),
    });
  camera = () =>
    tilda.page
      .locator("strata-stage canvas")
      .first()
      .evaluate((canvas) => Number(canvas.dataset.cameraSeq));
  before = await edits();
});

test("the pen paints with the hand beside it, which neither paints nor turns", async () => {
  await tilda.idle(); // the tool's panel changes the size of the 3D view
  const stood = await camera();
  await pen("mouseMoved", [0.4, 0.5]);
  await touch("touchStart", [0.7, 0.7]);
  await pen("mousePressed", [0.4, 0.5], { button: "left", buttons: 1, clickCount: 1 });
  for (const x of [0.42, 0.44, 0.46]) {
    await pen("mouseMoved", [x, 0.5], { button: "left", buttons: 1 });
    await touch("touchMove", [x + 0.3, 0.75]);
  }
  await touch("touchMove", [0.75, 0.75], [0.8, 0.6]);
  await touch("touchMove", [0.75, 0.75], [0.85, 0.5]);
  await pen("mouseReleased", [0.46, 0.5], { button: "left", buttons: 0, clickCount: 1 });
  await touch("touchEnd");
  await tilda.saved();
  await tilda.idle();
  await wait_for(async () => (await edits()) > before, "the stroke to be saved");
  const { edits: done } = await server.json(
    "GET",
    `/models/${model.id}/layers/cracks/edits?limit=1000`,
  );
  const strokes = new Set(done.filter(({ user }) => user === "tilda").map(({ stroke }) => stroke));
  assert.equal(strokes.size, 1, "the hand painted, too");
  assert.equal(await camera(), stood, "the hand turned the model");
  if (process.env.STRATA_TEST_OUTPUT)
    await tilda.page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, "pen.png") });
});

test("pressed half as hard the pen paints a narrower line, and as wide as ever where its pressure is not to count", async () => {
  const area_of_line = async (y, force) => {
    const painted = async () =>
      (await server.json("GET", `/models/${model.id}/layers/cracks/edits?limit=1000`)).edits.filter(
        ({ user }) => user === "tilda",
      );
    const known = (await painted()).length;
    await pen("mousePressed", [0.42, y], { button: "left", buttons: 1, clickCount: 1, force });
    for (const x of [0.45, 0.48, 0.52])
      await pen("mouseMoved", [x, y], { button: "left", buttons: 1, force });
    await pen("mouseReleased", [0.52, y], { button: "left", buttons: 0, clickCount: 1 });
    await tilda.saved();
    await wait_for(async () => (await painted()).length > known, "the line to be saved");
    await tilda.saved();
    const edits_now = await painted();
    return edits_now
      .slice(0, edits_now.length - known)
      .reduce((sum, { area_m2 }) => sum + area_m2, 0);
  };
  const clear = () =>
    server.json("POST", `/models/${model.id}/layers/cracks/edits`, {
      op: "fill",
      mode: "where",
      where: "true",
      erase: true,
    });
  await clear();
  const hard = await area_of_line(0.56, 1);
  const soft = await area_of_line(0.62, 0.4);
  assert.ok(
    soft > 0 && soft < 0.6 * hard,
    `the soft line has ${soft / hard} of the hard one's area`,
  );
  await clear();
  if ((await tilda.page.getByLabel(words.brush.pressure).count()) === 0)
    await tilda.page.getByRole("button", { name: words.model.show_panel }).click();
  await tilda.page.getByLabel(words.brush.pressure).uncheck();
  const wide = await area_of_line(0.62, 0.4);
  assert.ok(wide > 1.5 * soft, `the line is ${wide / soft} of the soft one's area`);
});

test("away with the pen: two fingers move the model, one turns it, and neither paints", async () => {
  await pen("mouseMoved", [-0.02, 0.5]); // the pen is over the tools
  painted = await edits();
  // The page ignores fingers for some time after the last event of the pen, so the fingers repeat
  // the gesture until the page reacts.
  const moves = (gesture) => async () => {
    const from = await camera();
    await gesture();
    await tilda.idle();
    return (await camera()) !== from;
  };
  const pinch = async () => {
    await touch("touchStart", [0.4, 0.5], [0.5, 0.5]);
    await touch("touchMove", [0.38, 0.5], [0.55, 0.5]);
    await touch("touchMove", [0.36, 0.5], [0.6, 0.5]);
    await touch("touchEnd");
  };
  const drag = async () => {
    await touch("touchStart", [0.4, 0.5]);
    await touch("touchMove", [0.45, 0.5]);
    await touch("touchMove", [0.5, 0.5]);
    await touch("touchEnd");
  };
  await wait_for(moves(pinch), "two fingers to move the model");
  await wait_for(moves(drag), "one finger to turn the model");
  await tilda.saved();
  assert.equal(await edits(), painted, "a finger painted while there is a pen");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  tilda.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await tilda?.close();
  await server?.remove();
});
