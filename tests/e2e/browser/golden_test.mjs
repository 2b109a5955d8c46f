// Compares screenshots of the page and streamed frames with the images in tests/golden (generated
// models only). STRATA_UPDATE_GOLDEN=1 updates the images. Check the new images before you commit
// them. After a failure, the screenshot and an image of the differences (in red) are in the build
// folder.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Browser, has_hue, require_browser } from "../support/js/browser.mjs";
import { kRoot } from "../support/js/modules.mjs";
import { decode_png, encode_png } from "../support/js/png.mjs";
import { pot_camera } from "../support/js/pot-camera.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kGolden = join(kRoot, "tests", "golden");
const kOutput = process.env.STRATA_TEST_OUTPUT ?? "/tmp/strata-golden";
const is_update = process.env.STRATA_UPDATE_GOLDEN === "1";

// A pixel differs if a channel is off by more than `kStep`. Other versions of Mesa, libjpeg and
// FreeType cause smaller differences. `share` is the allowed share of such pixels. Another
// rasterizer moves the pot's edges by a pixel, and another FreeType moves the letters. `mean`
// limits the difference over the whole image. A wrong color on a small patch exceeds each of the
// two limits.
const kStep = 40;
const kPageLimits = { share: 0.012, mean: 1.6 };
const kPictureLimits = { share: 0.004, mean: 0.8 };
// A small missing element has little effect on a whole page, so details are compared separately.
// The limits allow for the edges of letters and lines. The test checks that it detects each missing
// detail.
const kDetailLimits = { share: 0.05, mean: 7 };

const failures = [];

/** Compares a box, in pixels, of two images with the same size. */
function difference(now, golden, { x, y, width, height }) {
  let [off, sum] = [0, 0];
  for (let row = y; row < y + height; ++row) {
    for (let column = x; column < x + width; ++column) {
      const at = (row * now.width + column) * 4;
      const steps = [0, 1, 2].map((c) => Math.abs(now.data[at + c] - golden.data[at + c]));
      if (Math.max(...steps) > kStep) ++off;
      sum += steps[0] + steps[1] + steps[2];
    }
  }
  return { share: off / (width * height), mean: sum / (width * height) / 3 };
}

const within = (found, limits) => found.share <= limits.share && found.mean <= limits.mean;
const whole = ({ width, height }) => ({ x: 0, y: 0, width, height });

/** Makes a gray image with the differing pixels in red. */
function difference_picture(now, golden) {
  const picture = { ...now, data: new Uint8Array(now.data.length) };
  for (let at = 0; at < now.data.length; at += 4) {
    const differs = [0, 1, 2].some((c) => Math.abs(now.data[at + c] - golden.data[at + c]) > kStep);
    const grey = 128 + (golden.data[at] + golden.data[at + 1] + golden.data[at + 2]) / 6;
    picture.data.set(differs ? [220, 0, 0, 255] : [grey, grey, grey, 255], at);
  }
  return encode_png(picture);
}

/** `details` are names and boxes of small parts, which are compared separately. */
function compare(name, shot, limits, details = {}) {
  mkdirSync(kOutput, { recursive: true });
  const file = join(kGolden, `${name}.png`);
  if (is_update || !existsSync(file)) {
    assert.ok(is_update, `there is no ${file}: make it with STRATA_UPDATE_GOLDEN=1`);
    writeFileSync(file, encode_png(decode_png(shot)));
    console.log(`${name}: written`);
    return;
  }
  const [now, golden] = [decode_png(shot), decode_png(readFileSync(file))];
  if (now.width !== golden.width || now.height !== golden.height) {
    failures.push(
      `${name}: ${now.width} × ${now.height} instead of ${golden.width} × ${golden.height}`,
    );
    return;
  }
  const parts = [
    [name, whole(now), limits],
    ...Object.entries(details).map(([part, box]) => [`${name}, ${part}`, box, kDetailLimits]),
  ];
  let is_good = true;
  for (const [part, box, most] of parts) {
    const found = difference(now, golden, box);
    const text = `${part}: ${(found.share * 100).toFixed(3)} % of pixels differ (at most ${most.share * 100} %), mean ${found.mean.toFixed(3)} (at most ${most.mean})`;
    console.log(text);
    if (within(found, most)) continue;
    failures.push(`${text}; see ${join(kOutput, name)}.diff.png`);
    is_good = false;
  }
  if (is_good) return;
  writeFileSync(join(kOutput, `${name}.png`), shot);
  writeFileSync(join(kOutput, `${name}.diff.png`), difference_picture(now, golden));
}

/** Checks that the page without a detail does not match the golden image. */
function assert_noticed(name, detail, box, without) {
  if (is_update) return;
  const found = difference(
    decode_png(without),
    decode_png(readFileSync(join(kGolden, `${name}.png`))),
    box,
  );
  console.log(
    `${name} without ${detail}: ${(found.share * 100).toFixed(1)} % of pixels differ, mean ${found.mean.toFixed(1)}`,
  );
  if (within(found, kDetailLimits))
    failures.push(`${name}: the limits do not notice that ${detail} is missing`);
}

/** Returns an element's box in whole pixels. */
async function box_of(locator) {
  const { x, y, width, height } = await locator.boundingBox();
  return {
    x: Math.round(x),
    y: Math.round(y),
    width: Math.round(width),
    height: Math.round(height),
  };
}

/** Compares the page's own screens, in the window of a laptop and of a phone. */
async function compare_page(server) {
  // tall enough to show the legend below the brush
  const laptop = await Browser.open({ viewport: { width: 1280, height: 900 } });
  try {
    const { page } = laptop;
    await page.goto(server.link);
    await page.getByRole("heading", { name: words.home.title, exact: true }).waitFor();
    await page.locator("strata-thumbnail canvas.drawn").waitFor();
    compare("gallery", await laptop.settled(), kPageLimits);
    await page.getByRole("link", { name: /Demo pot/ }).click();
    await laptop.drawn();
    await page.keyboard.press("b");
    await page.getByRole("radio", { name: "Open crack" }).click();
    await laptop.point(0.5, 0.6);
    await page
      .locator("strata-value-readout")
      .getByText(/Position/)
      .waitFor();
    const ring = await box_of(page.locator("strata-stage svg.over circle").first());
    const elements = {
      title: page.locator("strata-model-page h1"),
      saving: page.locator("strata-model-page .saving"),
      people: page.locator("strata-people-menu .faces .face"),
      legend: page.locator("strata-layer-panel .legend-classes"),
      "the scale bar": page.locator("strata-stage .scale"),
      "the value under the pointer": page.locator("strata-value-readout .card"),
    };
    const details = {
      "the cursor": {
        x: ring.x - 3,
        y: ring.y - 3,
        width: ring.width + 6,
        height: ring.height + 6,
      },
    };
    for (const [name, locator] of Object.entries(elements)) details[name] = await box_of(locator);
    compare("model", await laptop.settled(), kPageLimits, details);
    for (const [name, element] of Object.entries({
      "the cursor": page.locator("strata-stage svg.over"),
      ...elements,
    })) {
      await element.evaluate((each) => (each.style.visibility = "hidden"));
      assert_noticed("model", name, details[name], await laptop.settled());
      await element.evaluate((each) => (each.style.visibility = ""));
    }
    await page.getByRole("button", { name: words.layers.new }).click();
    await page.getByRole("radio", { name: /^Class/ }).click();
    compare("new_layer", await laptop.settled(), kPageLimits);
    if (is_update) await write_readme_picture(laptop);
    laptop.assert_no_complaints();
  } finally {
    await laptop.close();
  }
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
    compare("phone", await phone.settled(), kPageLimits);
    phone.assert_no_complaints();
  } finally {
    await phone.close();
  }
}

const frame = async (server, request) =>
  Buffer.from(
    await (await server.request("POST", "/models/demo-pot/frame", request)).arrayBuffer(),
  );

/** Finds a point on an open crack, along a line across the pot. */
async function point_at_open_crack(browser) {
  const card = browser.page.locator("strata-value-readout .card");
  let before = "";
  for (let x = 0.25; x < 0.75; x += 0.004) {
    await browser.point(x, 0.6);
    await card.getByText(/Position/).waitFor();
    for (let text = before; text === before;) text = await card.innerText();
    before = await card.innerText();
    if (before.includes("Open crack")) return;
  }
  throw new Error("there is no open crack across the pot");
}

/** Writes docs/public/demo.png: the page in use, with the model slightly closer. */
async function write_readme_picture(browser) {
  const { page } = browser;
  await page.keyboard.press("Escape");
  await page.keyboard.press("v");
  await page.setViewportSize({ width: 1280, height: 800 });
  await browser.settled();
  const box = await browser.stage_box();
  await page.mouse.click(box.x + 20, box.y + 20); // outside the button that opened the dialog
  await page.keyboard.press("+");
  await point_at_open_crack(browser);
  mkdirSync(join(kRoot, "docs", "public"), { recursive: true });
  const picture = decode_png(await browser.settled());
  // with fewer colors the file is a quarter smaller and looks the same
  picture.data.forEach(
    (value, at) => (picture.data[at] = Math.min(254, Math.round(value / 2) * 2)),
  );
  writeFileSync(join(kRoot, "docs", "public", "demo.png"), encode_png(picture));
}

/** Returns the distance of a point to a path of line segments. */
function distance_to(path, x, y) {
  let least = Infinity;
  for (let i = 0; i + 1 < path.length; ++i) {
    const [[ax, ay], [bx, by]] = [path[i], path[i + 1]];
    const [dx, dy] = [bx - ax, by - ay];
    const along = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)));
    least = Math.min(least, Math.hypot(x - ax - along * dx, y - ay - along * dy));
  }
  return least;
}

/** Checks that a stroke across seams of the atlas has no visible seam. */
async function compare_seam(server) {
  const camera = pot_camera(960, 720);
  const path = [
    [300, 400],
    [420, 470],
    [540, 470],
    [660, 400],
  ];
  const radius = 30;
  const palette = { mode: "categorical", points: [{ at: 1, color: "#ff00ff" }] };
  // The texels are smaller than a pixel. On a surface in edge view, a larger texel may show a
  // corner while its center is hidden and unpainted.
  await server.json("POST", "/models/demo-pot/layers", {
    name: "Seam",
    type: "u8",
    resolution: 8192,
    palette,
  });
  const edit = await server.json("POST", "/models/demo-pot/layers/seam/edits", {
    op: "stroke",
    value: 1,
    camera,
    radius_px: radius,
    path,
  });
  assert.ok(edit.texels_changed > 10_000, JSON.stringify(edit));

  // The stroke must cross seams: neighbors on the surface are far apart in the atlas.
  let seams = 0;
  let last = null;
  for (let x = path[0][0]; x <= path.at(-1)[0]; x += 4) {
    const i = path.findIndex(([right]) => right >= x);
    const [[ax, ay], [bx, by]] = i > 0 ? [path[i - 1], path[i]] : [path[0], path[1]];
    const hit = await server.json("POST", "/models/demo-pot/pick", {
      camera,
      x: x + 0.5,
      y: ay + ((by - ay) * (x - ax)) / (bx - ax) + 0.5,
    });
    assert.ok(
      hit.hit && hit.values.seam.valid,
      `the middle of the stroke at x = ${x} is not painted: ${JSON.stringify(hit)}`,
    );
    if (last && Math.hypot(hit.uv[0] - last.uv[0], hit.uv[1] - last.uv[1]) > 0.05) ++seams;
    last = hit;
  }
  assert.ok(seams >= 2, `the stroke crosses ${seams} seams only: choose another path`);

  const shot = await frame(server, { camera, layers: ["seam"], format: "png" });
  const { width, height, data } = decode_png(shot);
  const [holes, spills] = [[], []];
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const distance = distance_to(path, x + 0.5, y + 0.5);
      const painted = has_hue(data, (y * width + x) * 4, [255, 0, 255]);
      if (distance < radius - 1.5 && !painted) holes.push([x, y]);
      if (distance > radius + 1.5 && painted) spills.push([x, y]);
    }
  }
  console.log(
    `seam: ${seams} seams crossed, ${holes.length} pixels unpainted inside, ${spills.length} painted outside`,
  );
  if (holes.length + spills.length > 0) {
    writeFileSync(join(kOutput, "seam.png"), shot);
    failures.push(
      `seam: unpainted inside ${JSON.stringify(holes.slice(0, 10))}, painted outside ${JSON.stringify(spills.slice(0, 10))}`,
    );
  }
  compare("seam", shot, kPictureLimits);
  compare(
    "seam_aside",
    await frame(server, { camera: pot_camera(960, 720, 0.9), layers: ["seam"], format: "png" }),
    kPictureLimits,
  );
}

/** Compares the pot with a section and a painted inside, and its relief in raking light. */
async function compare_cut(server) {
  // the section removes the half that is nearer to the camera
  const camera = { ...pot_camera(960, 720, 0.3), section: [[0, 1, 0, 0]] };
  const palette = { mode: "categorical", points: [{ at: 1, color: "#00c8ff" }] };
  await server.json("POST", "/models/demo-pot/layers", {
    name: "Inside",
    type: "u8",
    resolution: 4096,
    palette,
  });
  const stroke = {
    op: "stroke",
    value: 1,
    camera,
    radius_px: 40,
    path: [
      [330, 420],
      [480, 500],
      [640, 420],
    ],
  };
  const edit = await server.json("POST", "/models/demo-pot/layers/inside/edits", stroke);
  assert.ok(edit.texels_changed > 10_000, JSON.stringify(edit));
  compare(
    "cut",
    await frame(server, { camera, layers: ["inside"], format: "png" }),
    kPictureLimits,
  );
  const whole = { ...camera, section: [] };
  const outside = decode_png(
    await frame(server, { camera: whole, layers: ["inside"], format: "png" }),
  );
  let spilled = 0;
  for (let at = 0; at < outside.data.length; at += 4)
    if (has_hue(outside.data, at, [0, 200, 255])) ++spilled;
  if (spilled > 0)
    failures.push(`cut: ${spilled} pixels are painted on the side that was cut away`);
  const light = { mode: "raking", direction: [-0.9, 0.3, 0.3] };
  compare(
    "raking",
    await frame(server, { camera: whole, layers: [], light, format: "png" }),
    kPictureLimits,
  );
}

require_browser();
const server = new StrataServer({ demo: true });
try {
  await server.start();
  await compare_page(server);
  await compare_seam(server);
  await compare_cut(server);
  await wait_for(async () => (await fetch(`${server.url}/readyz`)).ok, "the server to be well");
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
  assert.deepEqual(failures, []);
} catch (error) {
  console.log(`--- log of the server\n${server.log.slice(-50).join("\n")}`);
  throw error;
} finally {
  await server.remove();
}
