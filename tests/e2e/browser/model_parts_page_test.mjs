// Several scans as one model: the question after several files are chosen, an archive with several
// scans, and the tree of parts, in which the user shows and hides them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { findings } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** A wall with waves, from (x0, y0) to (x1, y1), as OBJ in meters with one color. */
function wall(x0, y0, x1, y1, color, height = 6, cells = 40) {
  const lines = ["# unit: m"];
  for (let row = 0; row <= cells; ++row)
    for (let column = 0; column <= cells; ++column) {
      const t = column / cells;
      const wave = 0.08 * Math.sin(9 * t) * Math.sin((7 * row) / cells);
      const place = [x0 + t * (x1 - x0) + wave, y0 + t * (y1 - y0) + wave, (row / cells) * height];
      lines.push(`v ${[...place, ...color].join(" ")}`);
    }
  for (let row = 0; row < cells; ++row)
    for (let column = 0; column < cells; ++column) {
      const a = row * (cells + 1) + column + 1;
      lines.push(`f ${a} ${a + 1} ${a + cells + 2} ${a + cells + 1}`);
    }
  return lines.join("\n") + "\n";
}

const kFiles = {
  "Church/Nave/North wall.obj": wall(10, 8, 0, 8, [0.8, 0.7, 0.55]),
  "Church/Nave/South wall.obj": wall(0, 0, 10, 0, [0.75, 0.62, 0.5]),
  "Church/Tower/Outside/East.obj": wall(14, 0, 14, 8, [0.6, 0.6, 0.65], 12),
  "Church/Tower/Outside/West.obj": wall(10, 8, 10, 0, [0.55, 0.5, 0.45], 12),
  "Church/Apse.obj": wall(0, 8, 0, 0, [0.5, 0.45, 0.4]),
};

function zip_of(files) {
  const folder = mkdtempSync(join(tmpdir(), "strata-parts-"));
  try {
    for (const [name, text] of Object.entries(files)) {
      mkdirSync(join(folder, dirname(name)), { recursive: true });
      writeFileSync(join(folder, name), text);
    }
    execFileSync("python3", ["-m", "zipfile", "-c", "all.zip", "Church"], { cwd: folder });
    return readFileSync(join(folder, "all.zip"));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `parts_${name}.png`) });
};
const file = (name, content) => ({
  name,
  mimeType: "application/octet-stream",
  buffer: Buffer.from(content),
});
const choose = async ({ page }, files) =>
  page.locator("strata-home-page input[type=file]").first().setInputFiles(files);
const models_of = async () => (await server.json("GET", "/models?limit=100")).models;
const tree_of = ({ page }) => page.locator("strata-part-tree");
const shown = (some) => words.parts.shown(some, 5);

let desk, phone, server, church;

test.beforeAll(async () => {
  desk = await Browser.open({ viewport: { width: 1440, height: 900 } });
  phone = await Browser.open({ ...kPhone });
  server = new StrataServer();
  await server.start();
  await desk.sign_in(server, server.token);
  await phone.sign_in(server, server.token);
});

test("several files become several models, or one with parts", async () => {
  await desk.page.goto(server.url);
  await choose(
    desk,
    Object.entries(kFiles).map(([name, text]) => file(name.split("/").at(-1), text)),
  );
  const dialog = desk.page.locator("strata-scans-dialog");
  await dialog.getByText(words.scans.heading(5)).waitFor();
  await dialog.getByLabel(words.scans.as_parts(5)).check();
  assert.equal(await dialog.getByLabel(words.scans.name).inputValue(), "North wall");
  await dialog.getByLabel(words.scans.name).fill("Walls");
  assert.deepEqual(await findings(desk.page), []);
  await shot(desk, "question");
  await dialog.getByRole("button", { name: words.scans.start }).click();
  await desk.page.waitForURL(/\/models\//);
  await desk.drawn();
  const [model] = await models_of();
  assert.equal(model.name, "Walls");
  assert.deepEqual(
    model.parts.map(({ name }) => name),
    ["Apse", "East", "North wall", "South wall", "West"],
  );
});

test("an archive with several scans is offered as one model", async () => {
  await desk.page.goto(server.url);
  await choose(desk, [file("church.zip", zip_of(kFiles))]);
  await desk.page.getByRole("button", { name: words.import.as_parts_named("church") }).waitFor();
  await shot(desk, "archive");
  await desk.page.getByRole("button", { name: words.import.as_parts_named("church") }).click();
  await desk.page.waitForURL(/\/models\//);
  await desk.drawn();
  church = await wait_for(
    async () => (await models_of()).find(({ parts }) => parts?.some(({ folder }) => folder)),
    "the model with folders",
  );
  assert.equal(church.name, "church");
  // So the question about the size, which may open at any time, covers nothing.
  await server.json("PATCH", `/models/${church.id}`, { scale_verified: true });
});

test("the tree shows and hides parts and folders", async () => {
  await desk.page.goto(`${server.url}/models/${church.id}`);
  await desk.drawn();
  await desk.page.getByRole("button", { name: words.view.model_parts, exact: true }).click();
  await tree_of(desk).getByText(shown(5)).waitFor();
  assert.deepEqual(await findings(desk.page), []);
  await shot(desk, "tree");
  await tree_of(desk).getByLabel("Tower", { exact: true }).uncheck();
  await tree_of(desk).getByText(shown(3)).waitFor();
  assert.equal(await tree_of(desk).getByLabel("East", { exact: true }).isChecked(), false);
  await tree_of(desk).getByLabel("West", { exact: true }).check();
  await tree_of(desk).getByText(shown(4)).waitFor();
  const tower = tree_of(desk).getByLabel("Tower", { exact: true });
  assert.equal(await tower.evaluate((box) => box.indeterminate), true);
  await tree_of(desk)
    .getByRole("button", { name: words.parts.only("Nave"), exact: true })
    .click();
  await tree_of(desk).getByText(shown(2)).waitFor();
  await tree_of(desk)
    .getByRole("button", { name: words.parts.fly("Nave/South wall"), exact: true })
    .click();
  await desk.drawn();
  await shot(desk, "nave");
  await tree_of(desk).getByRole("button", { name: words.parts.show_all }).click();
  await tree_of(desk).getByText(shown(5)).waitFor();
});

test("the phone shows the same tree", async () => {
  await phone.page.goto(`${server.url}/models/${church.id}`);
  await phone.drawn();
  await phone.page.getByRole("button", { name: words.view.model_parts, exact: true }).click();
  await tree_of(phone).getByText(shown(5)).waitFor();
  assert.deepEqual(await findings(phone.page), []);
  await shot(phone, "phone");
  for (const who of [desk, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [desk, phone]) await who?.close();
  await server?.remove();
});
