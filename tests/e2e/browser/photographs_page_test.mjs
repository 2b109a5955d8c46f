// Photographs with camera poses on the page: poses and an image are imported, the photographs of a
// place are listed after a click on the model, and a photograph is shown with the model over it and
// next to it. The user paints on it and draws a line and a point, which are where the photograph shows
// them.
import assert from "node:assert/strict";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { with_samples } from "../support/js/marks.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const base = "/models/demo-pot";
const kFocal = 1000; // of the photographs, in pixels
const [kWidth, kHeight] = [900, 600];

const list = () => page.locator("strata-photographs-dialog");
const dialog = () => page.locator("strata-photograph-dialog");
const button = (name) => page.getByRole("button", { name, exact: true });
const file_choice = (label) => list().locator(`strata-file-choice[label="${label}"] input`);
const statistics = () => server.json("GET", `${base}/layers/test/statistics`);
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({
      path: join(process.env.STRATA_TEST_OUTPUT, `photographs_${name}.png`),
    });
};

const minus = (a, b) => a.map((value, i) => value - b[i]);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = (a) => a.map((value) => value / Math.hypot(...a));
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/** Returns the rows of the rotation into a camera that looks from `eye` to `target`, z forward. */
function rotation(eye, target) {
  const forward = unit(minus(target, eye));
  const right = unit(cross(forward, [0, 0, 1]));
  return [right, cross(forward, right), forward];
}

/** Returns the quaternion (w, x, y, z) of a rotation whose trace is above -1. */
function quaternion([[a, b, c], [d, e, f], [g, h, i]]) {
  const angle = Math.acos((a + e + i - 1) / 2);
  const axis = unit([h - f, c - g, d - b]);
  return [Math.cos(angle / 2), ...axis.map((value) => value * Math.sin(angle / 2))];
}

/** Returns a camera of the contract for the same view. */
function camera_of(eye, target) {
  const [right, down, forward] = rotation(eye, target);
  const rows = [right, down.map((v) => -v), forward.map((v) => -v)];
  const view = [0, 1, 2].flatMap((column) => [...rows.map((row) => row[column]), 0]);
  const [near, far] = [0.01, 1000];
  return {
    view: [...view, ...rows.map((row) => -dot(row, eye)), 1],
    projection: [
      ...[(2 * kFocal) / kWidth, 0, 0, 0],
      ...[0, (2 * kFocal) / kHeight, 0, 0],
      ...[0, 0, -(far + near) / (far - near), -1],
      ...[0, 0, (-2 * far * near) / (far - near), 0],
    ],
    width: kWidth,
    height: kHeight,
  };
}

const colmap_line = (id, name, eye, target) => {
  const rows = rotation(eye, target);
  const moved = rows.map((row) => -dot(row, eye));
  return `${id} ${[...quaternion(rows), ...moved].join(" ")} 1 ${name}\n\n`;
};
const as_file = (name, text, mimeType = "text/plain") => ({
  name,
  mimeType,
  buffer: Buffer.from(text),
});

let browser, page, server, front, marks, middle;

test.beforeAll(async ({ server: started, desk }) => {
  [browser, page, server] = [desk, desk.page, started];
  marks = await with_samples(server, base);
  const palette = { mode: "categorical", points: [{ at: 1, color: "#ff00ffff", label: "Test" }] };
  await server.json("POST", `${base}/layers`, {
    name: "Test",
    type: "u8",
    resolution: 2048,
    palette,
  });
  await server.json("PATCH", base, { scale_verified: true });
  const { bounds } = await server.json("GET", base);
  middle = bounds.min.map((low, i) => (low + bounds.max[i]) / 2);
  const size = Math.max(...minus(bounds.max, bounds.min));
  front = [middle[0] + 0.2 * size, middle[1] - 1.8 * size, middle[2] + 0.1 * size];
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();
  await button(words.layers.select("Test")).click();
});

test("camera poses and an image are imported", async () => {
  await open_tab(page, words, words.view.title);
  await button(words.view.open_photographs).click();
  await list().getByText(words.photographs.none_yet).waitFor();
  const back = [2 * middle[0] - 3 * front[0], 2 * middle[1] - front[1], front[2]];
  const images =
    colmap_line(1, "west/FRONT.jpg", front, middle) + colmap_line(2, "BACK.jpg", back, middle);
  const calibration = `1 PINHOLE ${kWidth} ${kHeight} ${kFocal} ${kFocal} ${kWidth / 2} ${kHeight / 2}\n`;
  await file_choice(words.photographs.poses).setInputFiles([
    as_file("cameras.txt", calibration),
    as_file("images.txt", images),
  ]);
  await list().getByText(words.photographs.imported(2, 0)).waitFor();
  // the photograph is what the server draws from there, so it fits the model
  const answer = await fetch(`${server.url}/api/v1${base}/frame`, {
    method: "POST",
    headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "application/json" },
    body: JSON.stringify({ camera: camera_of(front, middle), samples: 4 }),
  });
  assert.equal(answer.status, 200);
  const picture = Buffer.from(await answer.arrayBuffer());
  await file_choice(words.photographs.pictures).setInputFiles([
    as_file("front.JPG", picture, "image/jpeg"),
    as_file("unknown.jpg", picture, "image/jpeg"),
  ]);
  await list().getByText(words.photographs.refused(1)).waitFor();
  await list().getByText(words.photographs.counts(2, 1)).waitFor();
  const { photographs } = await server.json("GET", `${base}/photographs`);
  assert.deepEqual(
    photographs.map(({ name, has_picture }) => [name, has_picture]),
    [
      ["BACK.jpg", false],
      ["west/FRONT.jpg", true],
    ],
  );
  await shot("imported");
});

test("all photographs can be listed and searched", async () => {
  const named = (name) => list().locator("ul.found").getByRole("button", { name });
  await list().getByRole("radio", { name: words.photographs.all, exact: true }).click();
  await named(/FRONT\.jpg/).waitFor();
  await named(/BACK\.jpg/).waitFor();
  await list().getByLabel(words.photographs.search).fill("WEST/");
  await list().getByText(words.photographs.listed(1), { exact: true }).waitFor();
  assert.equal(await named(/BACK\.jpg/).count(), 0);
  await list().getByLabel(words.photographs.only_missing).check();
  await list().getByText(words.photographs.listed(0), { exact: true }).waitFor();
  await list().getByLabel(words.photographs.search).fill("");
  await named(/BACK\.jpg/).waitFor();
  assert.equal(await named(/FRONT\.jpg/).count(), 0);
  await shot("all");
  await list().getByRole("radio", { name: words.photographs.of_place, exact: true }).click();
  await list().getByText(words.photographs.how).waitFor();
});

test("a click on the model lists the photographs of the place", async () => {
  const box = await browser.stage_box();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.6 * box.height);
  await list().getByText(words.photographs.seen_by(1)).waitFor();
  await list()
    .getByRole("button", { name: /FRONT\.jpg/ })
    .waitFor();
  assert.equal(
    await list()
      .getByRole("button", { name: /BACK\.jpg/ })
      .count(),
    0,
  );
  await page.locator("strata-stage svg.over circle").first().waitFor();
  const thumbnail = list().locator("ul.found img");
  await wait_for(
    () => thumbnail.evaluate((img) => img.complete && img.naturalWidth > 0),
    "the thumbnail",
  );
  await shot("list");
});

test("a photograph is shown with the model, and paint goes where it shows it", async () => {
  await list()
    .getByRole("button", { name: /FRONT\.jpg/ })
    .click();
  const canvas = dialog().locator("strata-picture-canvas");
  const photograph = canvas.locator("img").first();
  const model = canvas.locator("img.over");
  const loaded = (image) => image.evaluate((img) => img.complete && img.naturalWidth > 300);
  await wait_for(() => loaded(photograph), "the photograph");
  await model.waitFor();
  await wait_for(() => loaded(model), "the model");
  await shot("over");
  await dialog().getByRole("radio", { name: words.photograph.beside, exact: true }).click();
  await dialog().getByRole("img", { name: words.photograph.model_alt }).waitFor();
  await shot("beside");
  await dialog().getByRole("radio", { name: words.tools.brush, exact: true }).click();
  const { x, y, width, height } = await photograph.boundingBox();
  const at = ([across, down]) => [x + across * width, y + down * height];
  await page.mouse.move(...at([0.45, 0.55]));
  await page.mouse.down();
  await page.mouse.move(...at([0.55, 0.55]), { steps: 8 });
  await page.mouse.up();
  await wait_for(async () => (await statistics()).texels > 0, "the paint");
  const camera = camera_of(front, middle);
  const painted = async (across, down) => {
    const { values } = await server.json("POST", `${base}/pick`, {
      camera,
      x: across * kWidth,
      y: down * kHeight,
    });
    return values.test.valid;
  };
  for (const [across, down, is] of [
    [0.45, 0.55, true],
    [0.5, 0.55, true],
    [0.55, 0.55, true],
    [0.5, 0.4, false],
    [0.65, 0.55, false],
  ])
    assert.equal(await painted(across, down), is, `${across} ${down}`);
  await dialog().getByRole("button", { name: words.model.undo, exact: true }).click();
  await wait_for(async () => (await statistics()).texels === 0, "the undone paint");
});

test("a line and a point belong to the record, where the photograph shows them", async () => {
  await dialog().locator('select[name="layer"]').selectOption("Samples");
  const photograph = dialog().locator("strata-picture-canvas img").first();
  const click = async ([across, down]) => {
    const { x, y, width, height } = await photograph.boundingBox();
    await page.mouse.click(x + across * width, y + down * height);
  };
  const tool = (name) => dialog().getByRole("radio", { name, exact: true }).click();
  const seen_at = (place) => {
    const { view, projection } = camera_of(front, middle);
    const times = (matrix, vector) =>
      [0, 1, 2, 3].map((row) =>
        dot(
          [0, 1, 2, 3].map((k) => matrix[4 * k + row]),
          vector,
        ),
      );
    const [cx, cy, , w] = times(projection, times(view, [...place, 1]));
    return [(cx / w + 1) / 2, (1 - cy / w) / 2];
  };
  const is_near = (place, wanted) => {
    const seen = seen_at(place);
    assert.ok(Math.hypot(...minus(seen, wanted)) < 0.01, `${seen}, not ${wanted}`);
  };
  await tool(words.tools.line);
  for (const place of [
    [0.45, 0.5],
    [0.55, 0.6],
    [0.55, 0.6],
  ])
    await click(place);
  await wait_for(async () => (await marks("cracks")).length === 1, "the line");
  const [{ coordinates: line }] = await marks("cracks");
  is_near(line[0], [0.45, 0.5]);
  is_near(line.at(-1), [0.55, 0.6]);
  await shot("line");
  await tool(words.tools.point);
  await click([0.5, 0.45]);
  await wait_for(async () => (await marks("places")).length === 1, "the point");
  is_near((await marks("places"))[0].coordinates[0], [0.5, 0.45]);
  await dialog().getByRole("button", { name: words.model.undo, exact: true }).click();
  await wait_for(async () => (await marks("places")).length === 0, "the undone point");
  assert.equal((await marks("cracks")).length, 1);
});

test("closing it leads back to the list of the same place, and all can be deleted", async () => {
  await page.keyboard.press("Escape");
  await dialog().waitFor({ state: "detached" });
  await list().getByText(words.photographs.seen_by(1)).waitFor();
  await list().locator("summary").click();
  await list().getByRole("button", { name: words.photographs.delete_all, exact: true }).click();
  await page
    .locator("strata-question")
    .getByRole("button", { name: words.delete, exact: true })
    .click();
  await list().getByText(words.photographs.none_yet).waitFor();
  assert.equal((await server.json("GET", `${base}/photographs`)).total, 0);
});

ends_well({ complaints: ["422"] }); // the image without a photograph

test.afterEach(({}, info) => attach_log(info, server));
