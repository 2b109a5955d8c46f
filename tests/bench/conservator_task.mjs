// Measures one task done in four ways in the page: a stain of known extent on a real scan is mapped
// with the brush alone, with strokes inside and outside, with the wand, and with its brush. This is
// not a test.
//
//   STRATA_BINARY=build/release/bin/strata node tests/bench/conservator_task.mjs SCAN[:unit[:up]] [OUTPUT.json]
//
// A simulated hand draws in the page, in Chromium. Its seconds are those of models of the human hand,
// so that they can be repeated; the time that the page needs is measured and added:
// - along a tunnel of width W, a hand needs 0.1 s for each W of its length, and 0.1 s per W/2 to
//   stay at a border (Accot and Zhai, "Beyond Fitts' law", CHI 1997);
// - to move to a place and press, 1.1 s (Card, Moran and Newell, "The keystroke-level model", 1980:
//   pointing), and to press a key, 0.28 s (the same).
// The hand is uneven by 1.5 pixels. The stain is a disc with a wavy border and noise, computed from
// the coordinates, so its true extent is known at each texel.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, extname, join } from "node:path";
import { Browser } from "../e2e/support/js/browser.mjs";
import { decode_png } from "../e2e/support/js/png.mjs";
import { StrataServer, wait_for } from "../e2e/support/js/strata-server.mjs";
import { texts_of } from "../e2e/support/js/texts.mjs";

const words = texts_of("en");
const kPress_s = 1.1,
  kKey_s = 0.28,
  kPerWidth_s = 0.1,
  kUneven_px = 1.5;
const kFillWidth_px = 30,
  kRimWidth_px = 10,
  kSmartWidth_px = 40,
  kBeside_px = 15; // the distance from the border of a stroke that has to stay on one side of it
const kModel = "/models/scan";

const [scan, output] = process.argv.slice(2);
if (!scan) {
  console.error("conservator_task.mjs SCAN[:unit[:up]] [OUTPUT.json]");
  process.exit(2);
}
const [file, unit = "mm", up = "z"] = scan.split(":");

// --- the hand

let seed = 7;
/** Returns numbers from -1 to 1, the same in each run. */
function random() {
  seed = (seed * 1103515245 + 12345) % 2147483648;
  return (2 * seed) / 2147483648 - 1;
}

class Hand {
  presses = 0;
  keys = 0;
  seconds = 0; // of the hand
  waited = 0; // for the page

  constructor(browser) {
    this.page = browser.page;
    this.browser = browser;
  }

  press_key() {
    ++this.keys;
    this.seconds += kKey_s;
  }
  async key(key) {
    this.press_key();
    await this.page.keyboard.press(key);
  }
  async click(locator) {
    ++this.presses;
    this.seconds += kPress_s;
    await locator.click();
  }
  /** Types into a field. */
  async fill(locator, text) {
    ++this.presses;
    this.keys += text.length;
    this.seconds += kPress_s + kKey_s * text.length;
    await locator.fill(text);
    await locator.press("Enter");
  }
  /** Chooses from a list. */
  async choose(list, label) {
    this.presses += 2;
    this.seconds += 2 * kPress_s;
    await list.selectOption({ label });
  }
  /** Clicks at a pixel of the stage. */
  async press([x, y]) {
    ++this.presses;
    this.seconds += kPress_s;
    const box = await this.browser.stage_box();
    await this.page.mouse.click(box.x + x, box.y + y);
  }
  /** Draws through pixels of the stage, in a tunnel of this width. */
  async draw(points, tunnel_px) {
    ++this.presses;
    this.seconds += kPress_s + (kPerWidth_s * length_of(points)) / tunnel_px;
    const box = await this.browser.stage_box();
    const [first, ...rest] = points.map(([x, y]) => [
      box.x + x + kUneven_px * random(),
      box.y + y + kUneven_px * random(),
    ]);
    await this.page.mouse.move(...first);
    await this.page.mouse.down();
    for (const point of rest) await this.page.mouse.move(...point, { steps: 2 });
    await this.page.mouse.up();
  }
  /** Waits for the page, and counts the time. */
  async wait(what) {
    const begin = performance.now();
    await what();
    this.waited += (performance.now() - begin) / 1000;
  }
}

const length_of = (points) =>
  points
    .slice(1)
    .reduce((sum, [x, y], i) => sum + Math.hypot(x - points[i][0], y - points[i][1]), 0);

// --- what the hand sees: the pixels of the stain

class Seen {
  constructor({ width, height, data }) {
    this.width = width;
    this.height = height;
    this.inside = new Uint8Array(width * height);
    for (let at = 0; at < width * height; ++at)
      this.inside[at] = data[4 * at] > 120 && data[4 * at + 1] < 90 && data[4 * at + 2] > 120;
  }
  has(x, y) {
    const [column, row] = [Math.round(x), Math.round(y)];
    if (column < 0 || row < 0 || column >= this.width || row >= this.height) return false;
    return this.inside[row * this.width + column] === 1;
  }
  get center() {
    let [x, y, count] = [0, 0, 0];
    for (let at = 0; at < this.inside.length; ++at)
      if (this.inside[at]) {
        x += at % this.width;
        y += Math.floor(at / this.width);
        ++count;
      }
    if (count < 1000) throw new Error(`only ${count} pixels of the stain are visible`);
    return [x / count, y / count];
  }
  /** Returns the places at this distance inside (or, below 0, outside) the border, all around. */
  ring(distance, count = 120) {
    const [cx, cy] = this.center;
    return Array.from({ length: count + 1 }, (_, i) => {
      const angle = (2 * Math.PI * i) / count;
      let border = 0;
      for (let r = 1; r < this.width; ++r)
        if (this.has(cx + r * Math.cos(angle), cy + r * Math.sin(angle))) border = r;
      const r = Math.max(border - distance, 0);
      return [cx + r * Math.cos(angle), cy + r * Math.sin(angle)];
    });
  }
  /** Returns the parts of a row that are at least `distance` inside the border. */
  spans(row, distance) {
    const spans = [];
    let begin = null;
    for (let x = 0; x <= this.width; ++x) {
      const in_it = [-distance, 0, distance].every(
        (d) => this.has(x + d, row) && this.has(x, row + d),
      );
      if (in_it && begin === null) begin = x;
      if (!in_it && begin !== null) {
        if (x - 1 - begin > 2) spans.push([begin, x - 1]);
        begin = null;
      }
    }
    return spans;
  }
}

// --- the four ways

const selection = (page) => page.getByRole("group", { name: words.selection.title, exact: true });

async function by_brush(hand, seen) {
  await hand.key("b");
  const width = hand.page.getByRole("textbox", { name: new RegExp(`^${words.brush.width}`) });
  await hand.fill(width, String(kRimWidth_px));
  await hand.draw(seen.ring(kRimWidth_px / 2), kRimWidth_px / 2);
  await hand.fill(width, String(kFillWidth_px));
  const step = 0.7 * kFillWidth_px;
  for (let row = step / 2; row < seen.height; row += step)
    for (const [from, to] of seen.spans(row, kFillWidth_px / 2 + 2)) {
      await hand.draw(
        [
          [from, row],
          [to, row],
        ],
        kFillWidth_px,
      );
    }
  // the rest between the rim and the rows
  await hand.fill(width, "20");
  await hand.draw(seen.ring(14), 10);
  await hand.draw(seen.ring(24), 10);
}

async function by_strokes(hand, seen) {
  await hand.key("Shift+L");
  await hand.wait(() => hand.browser.rested());
  await hand.draw(seen.ring(kBeside_px, 32), kBeside_px);
  hand.press_key();
  await hand.page.keyboard.down("Alt");
  await hand.draw(seen.ring(-kBeside_px, 32), kBeside_px);
  await hand.page.keyboard.up("Alt");
  await hand.wait(() => selected(hand.page));
  await hand.key("Enter"); // accepts the area
  await hand.key("Enter"); // paints it
}

async function by_wand(hand, seen) {
  await hand.key("Shift+G");
  await hand.click(hand.page.getByRole("radio", { name: words.wand.ways.value, exact: true }));
  await hand.choose(
    hand.page.getByRole("combobox", { name: words.wand.layer, exact: true }),
    "Moisture",
  );
  await hand.press(seen.center);
  await hand.wait(() => selected(hand.page));
  await hand.key("Enter");
}

async function by_smart_brush(hand, seen) {
  await hand.page.keyboard.press("v"); // not counted: the wand may still be active
  await hand.key("Shift+G");
  await hand.key("Shift+G");
  await hand.click(hand.page.getByRole("radio", { name: words.wand.ways.value, exact: true }));
  await hand.choose(
    hand.page.getByRole("combobox", { name: words.wand.layer, exact: true }),
    "Moisture",
  );
  const width = hand.page.getByRole("textbox", { name: new RegExp(`^${words.brush.width}`) });
  await hand.fill(width, String(kSmartWidth_px));
  // along the rim, with a quarter of the brush outside, then over the rest in one stroke
  await hand.draw(seen.ring(kSmartWidth_px / 4, 48), kSmartWidth_px / 2);
  const rows = [];
  const step = 0.8 * kSmartWidth_px;
  for (let row = step / 2; row < seen.height; row += step)
    for (const [from, to] of seen.spans(row, kSmartWidth_px / 2))
      rows.push(...(rows.length % 4 === 0 ? [from, to] : [to, from]).map((x) => [x, row]));
  await hand.draw(rows, kSmartWidth_px);
  await hand.wait(() => selected(hand.page));
  await hand.key("Enter");
}

const selected = (page) =>
  wait_for(
    async () => /\d\s*(mm²|cm²|m²)/.test(await selection(page).getByRole("status").innerText()),
    "the area of the selection",
  );

const kWays = {
  "brush alone": by_brush,
  strokes: by_strokes,
  wand: by_wand,
  "smart brush": by_smart_brush,
};

// --- the site

const server = new StrataServer();
const browser = await Browser.open();

async function bytes(method, path, body, type) {
  const answer = await fetch(`${server.url}/api/v1${path}`, {
    method,
    headers: { Authorization: `Bearer ${server.token}`, "Content-Type": type },
    body,
  });
  if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${await answer.text()}`);
  return answer;
}
const done = (job) =>
  wait_for(
    async () => {
      const now = await server.json("GET", `/jobs/${job.id}`);
      if (["failed", "cancelled"].includes(now.state)) throw new Error(JSON.stringify(now));
      return now.state === "done" && now;
    },
    "a job",
    900,
  );

async function import_scan() {
  const name = `scan${extname(file)}`;
  const query = `filename=${name}&unit=${unit}&up=${up}&name=Scan`;
  const answer = await bytes(
    "POST",
    `/models?${query}`,
    readFileSync(file),
    "application/octet-stream",
  );
  await done(await answer.json());
  await server.json("PATCH", kModel, { scale_verified: true });
}

/** Plants the stain around a place, and returns the condition for its true extent. */
async function plant(center, size) {
  const [x, y, z] = center.map((c, i) => `(${"xyz"[i]} - ${c})`);
  const k = 9 / size;
  const wave = ["x", "y", "z"].map((axis, i) => `sin(${k * (1 + 0.37 * i)} * ${axis})`).join(" + ");
  const inside = `sqrt(${x} ^ 2 + ${y} ^ 2 + ${z} ^ 2) + ${0.06 * size} * (${wave}) < ${size}`;
  const fine = ["x", "y", "z"].map((axis, i) => `sin(${k * (31 + 13 * i)} * ${axis})`).join(" * ");
  await server.json("POST", `${kModel}/layers`, {
    name: "Moisture",
    resolution: 2048,
    visible: true,
    expression: `if(${inside}, 0.6, 0.35) + 0.05 * ${fine}`,
    palette: {
      mode: "linear",
      min: 0,
      max: 1,
      points: [
        { at: 0, color: "#f4efe6" },
        { at: 1, color: "#3b2f2a" },
      ],
    },
  });
  await server.json("POST", `${kModel}/layers`, {
    name: "Truth",
    resolution: 2048,
    expression: inside,
    palette: { mode: "categorical", points: [{ at: 1, color: "#ff00ff" }] },
  });
}

async function area_m2(where) {
  return (await server.json("POST", `${kModel}/select`, { within: { where }, layers: [] })).area_m2;
}

async function run(name, work, seen) {
  const slug = name.replace(" ", "-");
  await server.json("POST", `${kModel}/layers`, {
    name,
    type: "u8",
    resolution: 2048,
    palette: { mode: "categorical", points: [{ at: 1, color: "#c02020", label: "Stain" }] },
  });
  const hand = new Hand(browser);
  await browser.page.getByRole("button", { name: words.layers.select(name) }).click();
  await browser.rested();
  seed = 7;
  await work(hand, seen);
  await hand.wait(() =>
    wait_for(async () => (await area_m2(`valid("${slug}")`)) > 0, "the painted stain"),
  );
  await browser.saved();
  await browser.rested();
  if (process.env.STRATA_TEST_OUTPUT)
    await browser.page.screenshot({
      path: join(
        process.env.STRATA_TEST_OUTPUT,
        `task_${basename(file, extname(file))}_${slug}.png`,
      ),
    });
  const both = await area_m2(`truth = 1 and valid("${slug}")`),
    any = await area_m2(`truth = 1 or valid("${slug}")`);
  await server.json("PATCH", `${kModel}/layers/${slug}`, { visible: false });
  return {
    way: name,
    iou: both / any,
    presses: hand.presses,
    keys: hand.keys,
    hand_s: hand.seconds,
    waited_s: hand.waited,
  };
}

try {
  await server.start();
  await import_scan();
  await browser.page.goto(server.link);
  await browser.page.getByRole("link", { name: /Scan/ }).click();
  await browser.drawn();
  await browser.rested();
  const { view, projection, width, height } = JSON.parse(browser.last_camera.camera);
  const camera = { view, projection, width, height };
  const at = { x: width / 2, y: height / 2 };
  const picked = await server.json("POST", `${kModel}/pick`, { camera, ...at });
  const { bounds } = await server.json("GET", kModel);
  const extent = Math.max(...bounds.max.map((high, i) => high - bounds.min[i]));
  await plant(picked.position, 0.09 * extent);
  const frame = await bytes(
    "POST",
    `${kModel}/frame`,
    JSON.stringify({
      camera,
      format: "png",
      light: { mode: "unlit" },
      layers: ["truth"],
    }),
    "application/json",
  );
  const seen = new Seen(decode_png(Buffer.from(await frame.arrayBuffer())));
  const results = [];
  for (const [name, work] of Object.entries(kWays)) results.push(await run(name, work, seen));
  console.table(
    results.map(({ iou, hand_s, waited_s, ...rest }) => ({
      ...rest,
      iou: iou.toFixed(3),
      seconds: (hand_s + waited_s).toFixed(1),
      "of it waiting": waited_s.toFixed(1),
    })),
  );
  if (output)
    writeFileSync(output, JSON.stringify({ scan: basename(file), results }, null, 2) + "\n");
} finally {
  await browser.close();
  await server.remove();
}
