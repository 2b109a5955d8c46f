// Measuring on a surface with a known shape, a ridge like a roof. Straight lengths, lengths along
// the surface, heights, areas and the profile equal the values of the roof. The tests use mouse,
// keyboard and touch, and also the page of a viewer.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const shot = async (name, of = page) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await of.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `measure_${name}.png`) });
};

// A roof of 200 mm × 120 mm, seen from above. It rises from y = 0 to a ridge of 45 mm along y = 60,
// and falls to y = 120.
const kRidge_mm = 45;
const kSlope = kRidge_mm / 60;
const kAlong = Math.hypot(1, kSlope); // length along the roof divided by its projection
const height_at = (y) => kRidge_mm - kSlope * Math.abs(y - 60);
const roof = [
  "ply",
  "format ascii 1.0",
  "element vertex 6",
  "property float x",
  "property float y",
  "property float z",
  "element face 4",
  "property list uchar int vertex_indices",
  "end_header",
  "0 0 0",
  "200 0 0",
  `200 60 ${kRidge_mm}`,
  `0 60 ${kRidge_mm}`,
  "200 120 0",
  "0 120 0",
  "3 0 1 2",
  "3 0 2 3",
  "3 3 2 4",
  "3 3 4 5",
  "",
].join("\n");

async function import_roof() {
  const started = await fetch(`${server.url}/api/v1/models?filename=roof.ply&name=Roof&unit=mm`, {
    method: "POST",
    headers: {
      Authorization: `Bearer ${server.token}`,
      "Content-Type": "application/octet-stream",
    },
    body: roof,
  });
  assert.equal(started.status, 202, await started.clone().text());
  const { id } = await started.json();
  return wait_for(async () => {
    const now = await server.json("GET", `/jobs/${id}`);
    assert.ok(!["failed", "cancelled"].includes(now.state), JSON.stringify(now));
    return now.state === "done" && now.model;
  }, "the import");
}

const of = (where) => {
  const panel = where.page.locator("strata-measure-panel");
  const button = (name) => panel.getByRole("button", { name, exact: true });
  const figure = (name) => panel.locator(`[data-figure="${name}"]`);
  /** Returns the value in millimeters or square millimeters. */
  const told = async (name) => {
    const text = await figure(name).innerText();
    const [, number, unit] =
      /^([+-]?[\d.,]+) (µm|mm|cm|m|km|mm²|cm²|m²)$/.exec(text) ?? assert.fail(`${name}: ${text}`);
    return (
      Number(number.replaceAll(",", "")) *
      { µm: 0.001, mm: 1, cm: 10, m: 1000, km: 1e6, "mm²": 1, "cm²": 100, "m²": 1e6 }[unit]
    );
  };
  const is_about = async (name, wanted, tolerance, why = "") => {
    await wait_for(async () => (await figure(name).count()) === 1, `the figure ${name}`);
    let last = NaN;
    await wait_for(
      async () => Math.abs((last = await told(name)) - wanted) <= tolerance,
      `${name} to be ${wanted}${why}`,
    ).catch((error) => {
      throw new Error(`${error.message}; it is ${last}`);
    });
  };
  const places = (count) =>
    panel
      .locator('[role="status"]')
      .getByText(new RegExp(`^${count} points?\\b`))
      .waitFor({ state: "attached" });
  const none = () =>
    wait_for(
      async () => (await panel.locator('[role="status"]').textContent()).trim() === "",
      "nothing to be measured",
    );
  return { panel, button, figure, told, is_about, places, none };
};

/**
 * Sets an orthographic view from above. Returns the mapping from the roof to the page, from the
 * server's positions of two pixels of the page.
 */
async function from_above({ page: on }) {
  await on.locator("strata-stage .surface").focus();
  await on.keyboard.press("o");
  await on.keyboard.press("5"); // view from above
  const box = await on.locator("strata-stage").boundingBox();
  const place_at = async (x, y) => {
    await on.mouse.move(box.x + x, box.y + y);
    const position = on.locator("strata-value-readout .position");
    await position.waitFor();
    let last = "";
    const text = await wait_for(
      async () => {
        const now = await position.innerText();
        const same = now === last;
        last = now;
        return same && now;
      },
      "the place under the pointer to be known",
      300,
    );
    return /([-\d.]+), ([-\d.]+), ([-\d.]+)/.exec(text).slice(1).map(Number);
  };
  const [x0, y0] = [box.width / 2, box.height / 2];
  const [a, b] = [await place_at(x0 - 100, y0 - 60), await place_at(x0 + 100, y0 + 60)];
  const mm_per_px = (b[0] - a[0]) / 200;
  assert.ok(
    Math.abs((a[1] - b[1]) / 120 - mm_per_px) < 0.02 * mm_per_px,
    `seen from above: ${a} ${b}`,
  );
  const page_of = (x, y) => [
    box.x + x0 - 100 + (x - a[0]) / mm_per_px,
    box.y + y0 - 60 - (y - a[1]) / mm_per_px,
  ];
  return {
    mm_per_px,
    page_of,
    click: async (x, y, count = 1) => on.mouse.click(...page_of(x, y), { clickCount: count }),
  };
}

let browser,
  phone,
  server,
  page,
  desk,
  model,
  viewer,
  roof_from_above,
  mm_per_px,
  click,
  near,
  plot,
  readout,
  x,
  y,
  z,
  moisture,
  moved_px;

test.beforeAll(async () => {
  browser = await Browser.open();
  phone = await Browser.open({
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
    deviceScaleFactor: 2,
  });
  server = new StrataServer();
  ({ page } = browser);
  desk = of(browser);
  await server.start();
  model = await import_roof();
  viewer = await server.add_person("vera", "viewer");
  await server.json("POST", `/models/${model}/layers`, {
    name: "Moisture",
    type: "f32",
    unit: "%",
    resolution: 2048,
    palette: {
      mode: "linear",
      min: 0,
      max: 10,
      points: [
        { at: 0, color: "#440154ff" },
        { at: 10, color: "#fde725ff" },
      ],
    },
  });
  await server.json("POST", `/models/${model}/layers`, {
    name: "Units",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name" }],
  });
  await server.json("POST", `/models/${model}/layers/moisture/edits`, {
    op: "fill",
    mode: "where",
    where: "x < 100",
    value: 4,
  });
  await server.json("POST", `/models/${model}/layers/moisture/edits`, {
    op: "fill",
    mode: "where",
    where: "x < 50",
    value: 7,
  });
});

test("who may only look has the tool, by its key, with no layer chosen", async () => {
  await browser.sign_in(server, viewer);
  await page.goto(`${server.url}/models/${model}`);
  await browser.drawn();
  roof_from_above = await from_above(browser);
  ({ mm_per_px, click } = roof_from_above);
  near = 2.5 * mm_per_px; // for two ends, each with an error of slightly more than a pixel
  await page.keyboard.press("m");
  assert.equal(
    await page
      .getByRole("button", { name: words.tools.measure, exact: true })
      .getAttribute("aria-pressed"),
    "true",
  );
  await desk.panel.getByText(/Click or tap points/).waitFor();
  const unconfirmed = desk.panel.getByText("Size not confirmed.");
  await unconfirmed.waitFor();
  await server.json("PATCH", `/models/${model}`, { scale_verified: true });
  await unconfirmed.waitFor({ state: "detached" });
});

test("up and down the roof: straight it is its shadow, along the surface it is longer by the slope", async () => {
  await click(40, 10);
  await desk.places(1);
  await click(40, 110);
  await desk.places(2);
  await desk.is_about("straight", 100, near);
  await desk.is_about("along", 100 * kAlong, near * kAlong);
  await desk.is_about("rise", 0, near * kSlope);
  assert.equal(await desk.figure("area").count(), 0);
  await shot("two_places");
});

test("Backspace takes a place back, and another one is set: half way up the height is the roof's", async () => {
  await page.keyboard.press("Backspace");
  await desk.places(1);
  await click(40, 60);
  await desk.places(2);
  await desk.is_about("straight", 50 * kAlong, near * kAlong);
  await desk.is_about("along", 50 * kAlong, near * kAlong);
  await desk.is_about("rise", 50 * kSlope, near * kSlope);
});

test("the length to the pointer stands beside it", async () => {
  await page.mouse.move(...roof_from_above.page_of(120, 60));
  const so_far = page.locator("strata-stage .length");
  await wait_for(async () => {
    const text = (await so_far.count()) === 1 ? await so_far.innerText() : "";
    const cm = Number(/^([\d.]+) cm$/.exec(text)?.[1]);
    return Math.abs(cm * 10 - (50 * kAlong + 80)) < 3 * near;
  }, "the length so far");
  await shot("so_far");
});

test("a second click on the last place ends; a rectangle on one side of the roof has its area", async () => {
  await page.keyboard.press("Escape");
  await desk.none();
  for (const [x, y] of [
    [30, 10],
    [150, 10],
    [150, 50],
    [30, 50],
  ])
    await click(x, y);
  await desk.places(4);
  await click(30, 50);
  await desk.panel.getByRole("heading", { name: words.measure.profile }).waitFor();
  assert.equal(await desk.button(words.measure.end).count(), 0);
  const [wide, deep] = [120, 40 * kAlong];
  await desk.is_about("area", wide * deep, near * (wide + deep));
  await desk.is_about("perimeter", 2 * (wide + deep), 4 * near);
  await desk.is_about("straight", 2 * wide + deep, 3 * near);
  await desk.is_about("ends", deep, near * kAlong);
  assert.equal(
    await desk.panel.getByText(/from the plane/).count(),
    0,
    "one side of a roof is flat",
  );
  await shot("area");
});

test("the next click begins anew; what is measured stays when the camera moves", async () => {
  await click(20, 10);
  await desk.places(1);
  await click(20, 110);
  await desk.places(2);
  await page.keyboard.press("Enter");
  plot = desk.panel.getByRole("slider", { name: words.measure.plot });
  await plot.locator("path.curve").waitFor();
  const drawn = async () =>
    page
      .locator("strata-stage svg.measured path")
      .evaluateAll((all) => all.map((each) => each.getAttribute("d")).join(" "));
  const before = await drawn();
  for (let n = 0; n < 4; ++n) await page.keyboard.press("ArrowRight");
  await wait_for(async () => (await drawn()) !== before, "the line to move with the model");
  await desk.is_about("along", 100 * kAlong, near * kAlong, ", still");
  await shot("turned");
  await page.keyboard.press("5");
});

test("a figure contains the measured distance as a dimension, unless it is turned off", async () => {
  const figure = page.locator("strata-figure-dialog");
  const asked = () =>
    page.waitForRequest(
      (request) =>
        request.method() === "POST" && new URL(request.url()).pathname.endsWith("/figures"),
    );
  await page.locator("strata-stage .surface").focus();
  const [opened] = await Promise.all([asked(), page.keyboard.press("f")]);
  const { dimensions } = opened.postDataJSON();
  assert.equal(dimensions.length, 1);
  const [{ from, to }] = dimensions;
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  assert.ok(Math.abs(length - 100) < near, `${length} mm`);
  const box = figure.locator('[name="dimensions"]');
  assert.ok(await box.isChecked());
  await figure.locator('figure[data-state="drawn"]').waitFor();
  await shot("figure");
  const [without] = await Promise.all([asked(), box.uncheck()]);
  assert.equal(without.postDataJSON().dimensions, undefined);
  await box.check();
  await figure.getByRole("button", { name: words.close, exact: true }).first().click();
  await figure.waitFor({ state: "detached" });
});

test("arrow keys go along the curve: in its middle is the ridge, marked on the model", async () => {
  readout = desk.panel.locator("strata-profile-plot output");
  const in_mm = (number, unit) => Number(number) * { µm: 0.001, mm: 1, cm: 10 }[unit];
  const sample = async () => {
    const found = /At ([\d.]+) (µm|mm|cm) · Height \(z\) ([\d.]+) (µm|mm|cm)/.exec(
      await readout.innerText(),
    );
    return found
      ? { along_mm: in_mm(found[1], found[2]), height_mm: in_mm(found[3], found[4]) }
      : { along_mm: NaN, height_mm: NaN };
  };
  await plot.focus();
  await page.keyboard.press("Home");
  await wait_for(async () => (await sample()).along_mm === 0, "the beginning");
  for (let n = 0; n < 5; ++n) await page.keyboard.press("PageUp");
  await wait_for(async () => Math.abs((await sample()).along_mm - 50 * kAlong) < 3, "the middle");
  const { along_mm, height_mm } = await sample();
  assert.ok(
    Math.abs(height_mm - height_at(10 + along_mm / kAlong)) < 2 * near,
    `${height_mm} mm at ${along_mm} mm`,
  );
  assert.match(await plot.getAttribute("aria-valuetext"), /^At [\d.]+ cm · Height \(z\)/);
  assert.equal(
    await page.locator('strata-stage svg.measured circle[r="8"]').count(),
    2,
    "the mark on the model",
  );
  await shot("plot_by_keys");
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width - 20, box.y + box.height / 2);
  await wait_for(async () => (await sample()).along_mm > 90 * kAlong, "the pointer's place");
});

test("at one scale for both the roof is as steep as it is", async () => {
  const slope = async () => {
    const d = await plot.locator("path.curve").getAttribute("d");
    const points = d
      .slice(1)
      .split("L")
      .map((each) => each.split(" ").map(Number));
    const [[x0, y0], [x1, y1]] = [points[0], points[Math.floor(points.length * 0.4)]];
    return (y0 - y1) / (x1 - x0);
  };
  const shown = kSlope / kAlong; // relative to the length along the slope
  assert.ok(Math.abs((await slope()) / shown - 1) > 0.1, "blown up at first");
  await desk.panel.getByLabel(words.measure.equal).check();
  await wait_for(async () => Math.abs((await slope()) / shown - 1) < 0.03, "the true slope");
  await shot("equal_scale");
});

test("the curve of a layer has a gap where there is no value", async () => {
  await plot.focus(); // a focused checkbox handles keys itself
  await page.keyboard.press("Escape");
  await desk.none();
  await click(10, 30);
  await click(190, 30);
  await desk.places(2);
  await page.keyboard.press("Enter");
  await desk.panel.getByLabel(words.measure.shows).waitFor(); // waits for the server's profile
  assert.deepEqual(
    await desk.panel.getByLabel(words.measure.shows).locator("option").allInnerTexts(),
    ["Height (z)", "Moisture (%)"],
  );
  await desk.panel.getByLabel(words.measure.shows).selectOption("Moisture (%)");
  await wait_for(async () => {
    const d =
      (await plot.locator("path.curve").count()) === 1 &&
      (await plot.locator("path.curve").getAttribute("d"));
    const xs = d
      ? d
          .slice(1)
          .split("L")
          .map((each) => parseFloat(each))
      : [];
    const width = (await plot.boundingBox()).width;
    return xs.length > 2 && Math.max(...xs) < 0.65 * width;
  }, "the curve of the painted half");
  await plot.focus();
  await page.keyboard.press("Home");
  await readout.getByText("Moisture 7 %").waitFor();
  await page.keyboard.press("End");
  await readout.getByText("Moisture no value").waitFor();
  await shot("layer");
  await server.json("POST", `/models/${model}/layers/moisture/edits`, {
    op: "fill",
    mode: "where",
    where: "x > 150",
    value: 2,
  });
  await readout.getByText("Moisture 2 %").waitFor(); // another user has changed the value
});

test("the profile is saved as the server's CSV and as a picture", async () => {
  const save = async (name) => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      desk.button(name).click(),
    ]);
    return {
      name: download.suggestedFilename(),
      text: readFileSync(await download.path(), "utf8"),
    };
  };
  const csv = await save(words.measure.save_csv);
  assert.equal(csv.name, "roof-profile.csv");
  const [head, ...lines] = csv.text
    .trim()
    .split(/\r?\n/)
    .map((line) => line.split(","));
  assert.equal(head[0], "along_mm");
  assert.ok(head.includes("moisture") && head.includes("units"), `${head}`);
  [x, y, z, moisture] = ["x", "y", "z", "moisture"].map((name) => head.indexOf(name));
  assert.ok(Math.abs(Number(lines.at(-1)[0]) - 180) < near, lines.at(-1).join());
  for (const line of lines)
    assert.ok(Math.abs(Number(line[z]) - height_at(Number(line[y]))) < 0.01, line.join());
  assert.deepEqual([Number(lines[0][moisture]), Number(lines.at(-1)[moisture])], [7, 2]);
  assert.ok(Math.abs(Number(lines[0][x]) - 10) < near);
  const picture = await save(words.measure.save_svg);
  assert.equal(picture.name, "roof-profile.svg");
  const drawing = await page.evaluate((text) => {
    const { documentElement: root } = new DOMParser().parseFromString(text, "image/svg+xml");
    return {
      name: root.localName,
      texts: [...root.querySelectorAll("text")].map((each) => each.textContent),
      curves: root.querySelectorAll("path.curve").length,
    };
  }, picture.text);
  assert.equal(drawing.name, "svg");
  assert.ok(
    drawing.texts.includes("Moisture, %") && drawing.texts.includes("Along the surface, cm"),
    `${drawing.texts}`,
  );
  assert.equal(drawing.curves, 2);
  assert.ok(!picture.text.includes("var(") && !picture.text.includes("lit$"), "it stands alone");
});

test("where there is no surface there is no place", async () => {
  await page.keyboard.press("Escape");
  await click(100, 140);
  await page.locator("strata-notices").getByText(words.marks.missed).waitFor();
  await desk.none();
});

test("keys alone: a place in the middle, the model is moved, another one", async () => {
  await page.mouse.move(2, 2);
  await page.locator("strata-stage .surface").focus();
  await page.keyboard.press("m");
  await desk.places(1);
  for (let n = 0; n < 3; ++n) await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("m");
  await desk.places(2);
  await page.keyboard.press("Enter");
  moved_px =
    3 *
    0.04 *
    Math.min(
      ...(await page
        .locator("strata-stage")
        .boundingBox()
        .then(({ width, height }) => [width, height])),
    );
  await desk.is_about("straight", moved_px * mm_per_px, near);
  await shot("keys");
});

test("buttons do the same, and the keyboard stays in the panel when the one that was pressed goes", async () => {
  await desk.button(words.measure.clear).focus();
  await page.keyboard.press("Enter");
  await desk.none();
  const focused = () =>
    page.evaluate(() => {
      let at = document.activeElement;
      while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement;
      return at.textContent.trim();
    });
  await wait_for(
    async () => (await focused()) === "Point in the middle",
    "the keyboard at the first button",
  );
  await page.keyboard.press("Enter");
  await desk.places(1);
  for (let n = 0; n < 3; ++n) await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("Enter");
  await desk.places(2);
  await desk.button(words.measure.end).focus();
  await page.keyboard.press("Enter");
  await desk.panel.getByRole("heading", { name: words.measure.profile }).waitFor();
  await wait_for(
    async () => (await focused()) === words.measure.take_back,
    "the keyboard at the first button that is left",
  );
  await desk.is_about("straight", moved_px * mm_per_px, near);
});

test("where not all places are seen at once, the nearest surface counts, and the panel says so", async () => {
  await desk.panel.getByRole("radio", { name: words.measure.ways.nearest }).click();
  await desk.panel.getByText(words.measure.way_hints.nearest).waitFor();
  await desk.is_about("along", moved_px * mm_per_px, near);
  await desk.panel.getByRole("radio", { name: words.measure.ways.seen }).click();
  await desk.panel.getByText(words.measure.way_hints.seen).waitFor();
});

test("what lies on two sides is measured straight; a line through the object is no way over its surface, and none is told", async () => {
  await page.keyboard.press("Escape");
  await desk.none();
  await page.keyboard.press("1"); // view from the front
  await page.keyboard.press("m");
  await desk.places(1);
  await page.keyboard.press("2"); // view from the back
  await page.keyboard.press("m");
  await desk.places(2);
  await desk.is_about("straight", 60, near);
  await desk.panel.getByText(/The straight lines pass through the object/).waitFor();
  assert.equal(await desk.figure("along").count(), 0);
  await page.keyboard.press("Enter");
  await shot("through");
  await page.keyboard.press("5"); // both points are visible from above
  await desk.panel.getByRole("radio", { name: words.measure.ways.seen }).click();
  await desk.is_about("along", 60 * kAlong, near * kAlong);
  assert.equal(await desk.panel.getByText(/The straight lines pass/).count(), 0);
});

test("another tool takes all of it away", async () => {
  await page.keyboard.press("v");
  await wait_for(
    async () => (await page.locator("strata-stage svg.measured").count()) === 0,
    "the line to be gone",
  );
  await page.keyboard.press("m");
  await desk.none();
});

test("by fingers, on a phone: taps set places, a drag turns, buttons end and clear", async () => {
  const hand = of(phone);
  await phone.sign_in(server, viewer);
  await phone.page.goto(`${server.url}/models/${model}`);
  await phone.drawn();
  await phone.page.getByRole("button", { name: words.tools.measure, exact: true }).tap();
  await hand.panel.getByText(/Click or tap points/).waitFor();
  const stage = await phone.stage_box();
  const tap = (share_x, share_y) =>
    phone.page.touchscreen.tap(stage.x + share_x * stage.width, stage.y + share_y * stage.height);
  await tap(0.42, 0.5);
  await hand.places(1);
  await tap(0.58, 0.5);
  await hand.places(2);
  await shot("phone_places", phone.page);
  await hand.button(words.measure.end).tap();
  await hand.panel.getByRole("heading", { name: words.measure.profile }).waitFor();
  assert.ok((await hand.told("along")) >= (await hand.told("straight")) - 0.01);
  await shot("phone", phone.page);
  await hand.button(words.measure.clear).tap();
  await hand.none();
  await tap(0.5, 0.5);
  await hand.places(1);
  const fingers = await phone.page.context().newCDPSession(phone.page);
  const touch = (type, ...points) =>
    fingers.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: points.map(([x, y]) => ({
        x: stage.x + x * stage.width,
        y: stage.y + y * stage.height,
      })),
    });
  const marks = () =>
    phone.page
      .locator("strata-stage svg.measured circle")
      .evaluateAll((all) =>
        all.map((each) => `${each.getAttribute("cx")} ${each.getAttribute("cy")}`).join(),
      );
  const unturned = await marks();
  await touch("touchStart", [0.3, 0.8]);
  for (let n = 1; n <= 8; ++n) await touch("touchMove", [0.3 + 0.03 * n, 0.8]);
  await touch("touchEnd");
  await wait_for(async () => (await marks()) !== unturned, "the model to be turned");
  await hand.places(1);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  browser.assert_no_complaints();
  phone.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await phone?.close();
  await server?.remove();
});
