// The page with one user: the cursor shows the area that a click paints. Keys have no effect while
// a question is open, and do not move the camera during a stroke. Navigation loses no edits, and
// changes by others are not overwritten.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, has_hue, kOfLostServer, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kMagenta = "#ff00ffff"; // no part of the pot has this hue
const kEdge_px = 3; // tolerance at the edge: half a texel, and JPEG's blocks of color

const base = "/models/demo-pot";
const edits = async (layer) =>
  (await server.json("GET", `${base}/layers/${layer}/edits?limit=1000`)).total;
const button = (name) => page.getByRole("button", { name, exact: true });
const radio = (name) => page.getByRole("radio", { name });
const show_only = async (slug) => {
  for (const { id, slug: other } of (await server.json("GET", `${base}/layers`)).layers) {
    await server.json("PATCH", `${base}/layers/${id}`, { visible: other === slug });
  }
};
const menu = async (layer, item) => {
  await button(`Options for ${layer}`).click();
  await page.getByRole("menuitem", { name: item }).click();
};

/**
 * Returns whether a pixel may be magenta, even in the shade, where JPEG keeps little of the hue.
 */
const may_be_magenta = (data, at) => {
  const least = Math.min(data[at], data[at + 2]);
  return least > 24 && data[at + 1] < 0.5 * least;
};

/** Returns the circle around the pointer, in CSS pixels of the stage. */
async function cursor() {
  const circle = page.locator("strata-stage svg.over circle").first();
  const [x, y, r] = await circle.evaluate((each) =>
    ["cx", "cy", "r"].map((name) => Number(each.getAttribute(name))),
  );
  return { x, y, r };
}

/** Clicks once at the pointer, and compares the painted area with the circle. */
async function compare_footprint(what) {
  await browser.point(0.5, 0.62);
  // waits for the depth under the pointer
  await page
    .locator("strata-value-readout")
    .getByText(/Position/)
    .waitFor();
  const circle = await cursor();
  const box = await browser.stage_box();
  await page.mouse.down();
  await page.mouse.up();
  await browser.saved();
  // the cursor would hide the painted area
  await page.mouse.move(box.x + box.width - 3, box.y + 3);
  await wait_for(
    async () => (await browser.count(rgb(kMagenta))) > circle.r * circle.r,
    `the dab of ${what}`,
    150,
  );
  const { data, width, height } = await browser.picture(box);
  let [holes, spills, painted] = [0, 0, 0];
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const distance = Math.hypot(x + 0.5 - circle.x, y + 0.5 - circle.y);
      const at = (y * width + x) * 4;
      if (may_be_magenta(data, at)) ++painted;
      else if (distance < circle.r - kEdge_px) ++holes;
      if (has_hue(data, at, rgb(kMagenta)) && distance > circle.r + kEdge_px) ++spills;
    }
  }
  const share = painted / (Math.PI * circle.r * circle.r);
  console.log(
    `  ${what}: radius ${circle.r.toFixed(1)} px, ${painted} pixels painted (${(share * 100).toFixed(1)} % of the circle), ` +
      `${holes} holes, ${spills} spills`,
  );
  assert.deepEqual(
    { holes, spills },
    { holes: 0, spills: 0 },
    `the cursor of ${what} is not what was painted`,
  );
  assert.ok(Math.abs(share - 1) < 0.08, `${what}: ${share} of the circle's area`);
  await page.keyboard.press("Control+z");
  await browser.saved();
  await wait_for(
    async () => (await browser.count(rgb(kMagenta))) === 0,
    "the dab to be taken back",
    150,
  );
  return circle.r;
}

/** Drops a scan of a box on the page, as a user does. */
async function drop_scan(name) {
  const corners = Array.from({ length: 8 }, (_, i) =>
    [i & 1, i & 2 ? 1 : 0, i & 4 ? 1 : 0].map((c) => c * 40).join(" "),
  );
  const sides = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  const faces = sides.flatMap(([a, b, c, d]) => [`3 ${a} ${b} ${c}`, `3 ${a} ${c} ${d}`]);
  const text = [
    "ply",
    "format ascii 1.0",
    "element vertex 8",
    "property float x",
    "property float y",
    "property float z",
    "element face 12",
    "property list uchar int vertex_indices",
    "end_header",
    ...corners,
    ...faces,
    "",
  ].join("\n");
  return page.evaluate(
    ([file, body]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([body], file));
      const event = new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true });
      document.body.dispatchEvent(event);
      return event.defaultPrevented; // otherwise the browser opens the file
    },
    [name, text],
  );
}

let browser, page, server, cameras, box, before;

test.beforeAll(async () => {
  browser = await Browser.open();
  ({ page } = browser);
  server = new StrataServer({ demo: true });
  await server.start();
  const palette = { mode: "categorical", points: [{ at: 1, color: kMagenta, label: "Test" }] };
  await server.json("POST", `${base}/layers`, {
    name: "Test",
    type: "u8",
    resolution: 8192,
    palette,
  });
  await show_only("test");
  cameras = []; // the cameras that the page sends
  page.on("websocket", (socket) =>
    socket.on("framesent", ({ payload }) => {
      const message = JSON.parse(payload);
      if (message.op === "camera") cameras.push(message);
    }),
  );
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  await button(words.layers.select("Test")).click();
});

test("the cursor shows the true footprint, in pixels and in millimetres, far and near", async () => {
  await page.keyboard.press("b");
  await compare_footprint("40 px");
  await radio(words.brush.on_object).click();
  await page.getByRole("textbox", { name: "Width, mm" }).fill("9");
  await page.keyboard.press("Enter");
  const far = await compare_footprint("9 mm");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("+");
  const near = await compare_footprint("9 mm, nearer");
  assert.ok(near > far * 1.4, `the circle of 9 mm grows from ${far} to ${near} px only`);
  await page.keyboard.press("Home");
  await radio(words.brush.on_screen).click();
});

test("Space turns the model, also after a tool was chosen with the mouse", async () => {
  await button(words.tools.eraser).click();
  await button(words.tools.brush).click();
  const painted = await edits("test");
  const canvas = page.locator("strata-stage canvas").first();
  const camera = () => canvas.evaluate((each) => Number(each.dataset.cameraSeq));
  [box, before] = [await browser.stage_box(), await camera()];
  await browser.point(0.5, 0.5);
  await page.keyboard.down(" ");
  await browser.drag([
    [0.5, 0.5],
    [0.55, 0.5],
  ]);
  await page.keyboard.up(" ");
  await wait_for(async () => (await camera()) > before, "the model to turn");
  await browser.saved();
  assert.equal(await edits("test"), painted, "Space and a drag painted");
  assert.equal(
    await button(words.tools.brush).getAttribute("aria-pressed"),
    "true",
    "Space pressed a button",
  );
});

test("keys do not act behind a question; a choice obeys the arrows", async () => {
  await button(words.brush.fill).click();
  await page.getByRole("heading", { name: words.brush.fill_title("Test") }).waitFor();
  await page.keyboard.press("e");
  await page.getByRole("button", { name: words.cancel }).click();
  assert.equal(
    await button(words.tools.brush).getAttribute("aria-pressed"),
    "true",
    "a key chose a tool behind the question",
  );
  await radio(words.brush.disc).focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await radio(words.brush.square).getAttribute("aria-checked"), "true");
  await page.keyboard.press("ArrowRight");
  assert.equal(await radio(words.brush.disc).getAttribute("aria-checked"), "true");
});

test("keys do not move the camera in mid-stroke", async () => {
  await page.mouse.move(box.x + box.width * 0.5, box.y + box.height * 0.6);
  await wait_for(async () => cameras.at(-1).moving === false, "the camera to come to rest");
  const held = cameras.length;
  await page.mouse.down();
  await page.keyboard.press("5");
  await page.keyboard.press("o");
  await page.mouse.move(box.x + box.width * 0.52, box.y + box.height * 0.6, { steps: 4 });
  await page.mouse.up();
  await browser.saved();
  assert.equal(cameras.length, held, "the camera moved in mid-stroke");
});

test("a stroke that is not saved yet when its page is left: the server dies, too", async () => {
  const known = await edits("test");
  await server.signal("SIGSTOP");
  await browser.drag([
    [0.45, 0.62],
    [0.55, 0.62],
  ]);
  await server.signal("SIGKILL");
  await page.locator('.saving[data-state="not-saved"]').waitFor();
  await page.goBack();
  await page.getByRole("heading", { name: words.home.title, exact: true }).waitFor();
  await page.getByText(/of “Demo pot” not saved yet/).waitFor();
  await server.start();
  await page.getByText(words.saving.left_saved("Demo pot")).waitFor();
  assert.ok((await edits("test")) > known, "what was painted is not in the history");
  await page.goForward();
  await browser.drawn();
  await page.keyboard.press("b");
});

test("somebody else changes the layer that is being edited", async () => {
  await menu("Test", words.layers.edit);
  await page.getByLabel(words.layer_dialog.class_label(1)).waitFor();
  await server.json("PATCH", `${base}/layers/test`, { description: "by the other" });
  await page.getByLabel(words.layer_dialog.name, { exact: true }).fill("Mine");
  await button(words.save).click();
  await page.getByText(words.layer_dialog.changed).waitFor();
  await button(words.layer_dialog.reload).click();
  await wait_for(
    async () =>
      (await page.getByLabel(words.layer_dialog.description).inputValue()) === "by the other",
    "the newest version",
  );
  assert.equal(
    await page.getByLabel(words.layer_dialog.name, { exact: true }).inputValue(),
    "Test",
  );
  // adds a second class to a layer with one class
  await button(words.layer_dialog.class_add).click();
  await page.getByLabel(words.layer_dialog.class_label(2)).fill("Second");
  await button(words.save).click();
  await radio("Second").waitFor();
  const changed = await server.json("GET", `${base}/layers/test`);
  assert.deepEqual(
    [changed.name, changed.description, changed.palette.points.length],
    ["Test", "by the other", 2],
  );
});

test("a layer of things with records", async () => {
  await button(words.layers.new).click();
  await radio(/^Objects with records/).click();
  await page.getByLabel(words.layer_dialog.name, { exact: true }).fill("Finds");
  await button(words.layer_dialog.create).click();
  await page.getByLabel(words.brush.record).fill("70012");
  await page.keyboard.press("Enter");
  await button(words.brush.make_record(70_012)).click(); // a key without a record cannot be painted
  await button(words.brush.make_record(70_012)).waitFor({ state: "detached" });
  const { table } = await server.json("GET", `${base}/layers/finds`);
  assert.deepEqual(
    (await server.json("GET", `/tables/${table}/records`)).records.map(({ key }) => key),
    [1, 70012],
  );
  await browser.drag([
    [0.46, 0.45],
    [0.54, 0.45],
  ]);
  await browser.saved();
  await browser.point(0.5, 0.45);
  await page.locator("strata-value-readout").getByText(words.tables.record(70_012)).waitFor();
  await menu("Finds", words.layers.statistics);
  await page.getByText(words.tables.record(70_012)).last().waitFor();
  await page.keyboard.press("Escape");
  assert.deepEqual(
    await server
      .json("GET", `${base}/layers/finds/statistics`)
      .then(({ keys }) => keys.map(({ key }) => key)),
    [70012],
  );
});

test("a unit that was confirmed by mistake is corrected", async () => {
  await button(words.model.details).click();
  await button(words.model.correct_size).click();
  await radio(words.scale.cm).click();
  await button(words.scale.yes).click();
  await wait_for(
    async () => (await server.json("GET", base)).unit === "cm",
    "the unit to be corrected",
  );
});

test("a scan that is dropped on a model's page is imported, and the person stays until they open it", async () => {
  const here = page.url();
  assert.ok(await drop_scan("dropped_box.ply"), "the browser would have left for the file");
  await page.getByText(words.import.ready("dropped box")).waitFor();
  assert.equal(page.url(), here);
  await page.getByRole("link", { name: words.import.open, exact: true }).click();
  await page.getByRole("heading", { name: "dropped box", exact: true }).waitFor();
  await browser.drawn(); // the page goes directly from one model to another
  await page.getByText(/Is this object .*\?/).waitFor();
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints([...kOfLostServer, "412", "404 (Not Found)"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
