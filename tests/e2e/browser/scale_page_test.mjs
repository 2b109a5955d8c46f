// The question about size and up direction, as after dropping files. It first shows the server's
// proposal and its reason. The model shows the choice, is not dimmed and can be used. "Decide
// later" keeps the values of the card. The tests use a desktop computer and a phone.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { kRoot } from "../support/js/modules.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kScan = join(kRoot, "..", "shared", "data", "vessel_lekythos_gigamesh_15k.ply");
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kUps = ["+X", "+Y", "+Z", "−X", "−Y", "−Z"];

/**
 * A bowl with a foot, upright along `axis`, 80 units wide. Its wall has a dent on one side, because
 * a round bowl looks the same with +X and −X up.
 */
function bowl(axis, comment = "") {
  const rings = [
    [20, 0],
    [35, 20],
    [40, 40],
    [37, 40],
    [32, 22],
    [17, 4],
    [0.1, 4],
  ];
  const kAround = 40;
  const vertices = [[0, 0, 0]];
  for (const [radius, height] of rings) {
    for (let i = 0; i < kAround; ++i) {
      const angle = (2 * Math.PI * i) / kAround;
      const dented = height > 4 && i > 30 && i < 40 ? 0.75 * radius : radius;
      const [a, b] = [dented * Math.cos(angle), dented * Math.sin(angle)];
      vertices.push(axis === "y" ? [a, height, -b] : [a, b, height]);
    }
  }
  const at = (ring, i) => 1 + ring * kAround + (i % kAround);
  const faces = [];
  for (let i = 0; i < kAround; ++i) {
    faces.push([0, at(0, i + 1), at(0, i)]);
    for (let ring = 0; ring + 1 < rings.length; ++ring)
      faces.push(
        [at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)],
        [at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)],
      );
  }
  return [
    "ply",
    "format ascii 1.0",
    ...(comment ? [`comment ${comment}`] : []),
    `element vertex ${vertices.length}`,
    "property float x",
    "property float y",
    "property float z",
    `element face ${faces.length}`,
    "property list uchar int vertex_indices",
    "end_header",
    ...vertices.map((v) => v.join(" ")),
    ...faces.map((f) => `3 ${f.join(" ")}`),
    "",
  ].join("\n");
}
const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `scale_${name}.png`) });
};

const card = ({ page }) => page.locator("strata-scale-dialog dialog[open]");
const asks = ({ page }) => page.locator("strata-scale-dialog");
const title = async (who) =>
  (await asks(who).getByRole("heading").innerText()).replace(/\s+/g, " ");
const reason = (who, of) => who.page.locator(`strata-scale-dialog [data-reason=${of}]`).innerText();
const contents_of = async (locator) => (await locator.allInnerTexts()).map((text) => text.trim());
const chosen = (who) =>
  contents_of(who.page.locator("strata-scale-dialog [role=radio][aria-checked=true]"));
const choose = (who, name) => asks(who).getByRole("radio", { name, exact: true }).click();
const bar = (who) => who.page.locator("strata-stage .scale").innerText();
const model_of = async (name) =>
  (await server.json("GET", "/models?limit=100")).models.find((each) => each.name === name);
const file_of = (name, text) => ({
  name,
  mimeType: "application/octet-stream",
  buffer: Buffer.from(text),
});

async function drop(who, ...files) {
  await who.page.goto(server.url);
  await who.page.locator("strata-home-page input[type=file]").first().setInputFiles(files);
}
async function asked(who) {
  await card(who).waitFor();
  await who.drawn();
}
/** Returns the brightness of the stage outside the model. A dimmed stage is darker. */
async function ground(who) {
  const box = await who.stage_box();
  const { data } = await who.picture({
    x: box.x + box.width * 0.3,
    y: box.y + 60,
    width: 4,
    height: 4,
  });
  return data[0] + data[1] + data[2];
}
const bar_says = (who, unit) =>
  wait_for(
    async () => (await bar(who)).replace(/\s+/g, " ").match(new RegExp(`^[\\d.]+ ${unit}( |$)`)),
    `a scale bar in ${unit}`,
  );

let desk, phone, server, model, with_card, after;

test.beforeAll(async () => {
  [desk, phone] = [
    await Browser.open({ viewport: { width: 1440, height: 900 } }),
    await Browser.open({ ...kPhone }),
  ];
  server = new StrataServer();
  await server.start();
  await desk.sign_in(server, server.token);
  await phone.sign_in(server, server.token);
});

test("a PLY whose header has the unit: the card says so, and the scale bar agrees", async () => {
  await drop(desk, file_of("bowl_with_unit.ply", bowl("y", "unit: mm")));
  await asked(desk);
  assert.match(await reason(desk, "unit"), /From a comment in the file: “unit: mm”/);
  assert.match(await title(desk), /80 × 40 × 80 mm/);
  assert.deepEqual(await chosen(desk), ["millimeters", "+Y"]);
  await bar_says(desk, "(mm|cm)");
  model = await model_of("bowl with unit");
  assert.deepEqual(
    [
      model.unit,
      model.unit_assumed,
      model.up,
      model.proposal.unit_reason,
      model.proposal.up_reason,
    ],
    ["mm", false, "y", "comment", "shape"],
  );
});

test("six small pictures, each another one", async () => {
  assert.deepEqual(
    await contents_of(asks(desk).locator("[role=radiogroup]").last().getByRole("radio")),
    kUps,
  );
  const pictures = asks(desk).locator("strata-thumbnail canvas.drawn");
  await wait_for(async () => (await pictures.count()) === 6, "six pictures");
  assert.equal(
    new Set(await pictures.evaluateAll((all) => all.map((canvas) => canvas.toDataURL()))).size,
    6,
  );
  await shot(desk, "desk");
});

test("the picture is not dimmed, and the model can be turned while the question stands", async () => {
  with_card = await ground(desk);
  const before = await desk.settled(() =>
    desk.page.locator("strata-stage canvas").first().screenshot(),
  );
  await desk.drag([
    [0.3, 0.5],
    [0.5, 0.55],
  ]);
  await card(desk).waitFor();
  after = await desk.settled(() => desk.page.locator("strata-stage canvas").first().screenshot());
  assert.ok(!before.equals(after), "the model did not turn");
});

test("another choice turns the model and changes the scale bar at once, and nothing is kept", async () => {
  await choose(desk, "meters");
  await bar_says(desk, "m");
  assert.match(await title(desk), /80 × 40 × 80 m\?/);
  await choose(desk, "−Y");
  const upside_down = await desk.settled(() =>
    desk.page.locator("strata-stage canvas").first().screenshot(),
  );
  assert.ok(!upside_down.equals(after), "the model did not turn upside down");
  await shot(desk, "desk_upside_down");
  assert.deepEqual(
    [(await model_of("bowl with unit")).unit, (await model_of("bowl with unit")).up],
    ["mm", "y"],
  );
});

test("decide later: what the card named is kept, marked, and asked again", async () => {
  await asks(desk)
    .getByText(/“Decide later” keeps millimeters and \+Y up/)
    .waitFor();
  await asks(desk).getByRole("button", { name: words.scale.later }).click();
  await card(desk).waitFor({ state: "detached" });
  await bar_says(desk, "(mm|cm)");
  assert.match(await bar(desk), /Size not confirmed/);
  const without_card = await ground(desk);
  // dimming subtracts 80 from this sum of channels, and JPEG changes the sum by less than 12
  assert.ok(
    Math.abs(without_card - with_card) < 12,
    `the picture was dimmed while the card was open: ${with_card} of ${without_card}`,
  );
  await desk.page.reload();
  await asked(desk);
});

test("yes: it is confirmed, upside down as chosen, with the direction of north", async () => {
  await choose(desk, "−Y");
  const north = asks(desk).getByLabel(words.scale.north);
  await north.fill("361");
  await asks(desk).getByRole("button", { name: words.scale.yes }).click();
  await asks(desk).getByText(words.shape.sun.north.wrong).waitFor();
  await north.fill("-12.5");
  await shot(desk, "north");
  await asks(desk).getByRole("button", { name: words.scale.yes }).click();
  await wait_for(
    async () => (await model_of("bowl with unit")).scale_verified,
    "the size to be confirmed",
  );
  model = await model_of("bowl with unit");
  assert.deepEqual([model.unit, model.up, model.north], ["mm", "-y", "-12.5"]);
  await wait_for(async () => !/not confirmed/.test(await bar(desk)), "the scale bar to be sure");
});

test("without a unit in the file the size decides, and says that it is guessed; on a phone the model is seen above the card", async () => {
  await drop(phone, file_of("plain_bowl.ply", bowl("z")));
  await asked(phone);
  assert.match(await reason(phone, "unit"), /Guessed from the size/);
  assert.deepEqual(await chosen(phone), ["millimeters", "+Z"]);
  await bar_says(phone, "(mm|cm)");
  model = await model_of("plain bowl");
  assert.deepEqual(
    [model.unit, model.unit_assumed, model.scale_verified, model.up],
    ["mm", true, false, "z"],
  );
  const dialog = await card(phone).boundingBox();
  assert.ok(dialog.y > 0.33 * kPhone.viewport.height, `the card begins at ${dialog.y}`);
  assert.equal(
    await phone.page.evaluate(() => document.documentElement.scrollWidth),
    kPhone.viewport.width,
  );
  await wait_for(
    async () => (await asks(phone).locator("strata-thumbnail canvas.drawn").count()) === 6,
    "six pictures",
  );
  await shot(phone, "phone");
  await phone.page.keyboard.press("Escape");
  await card(phone).waitFor({ state: "detached" });

  if (existsSync(kScan)) {
    console.log("a real scan");
    await drop(desk, {
      name: "vessel_lekythos_gigamesh_15k.ply",
      mimeType: "application/octet-stream",
      buffer: readFileSync(kScan),
    });
    await asked(desk);
    assert.match(await reason(desk, "unit"), /From a comment in the file: “unit: mm”/);
    assert.match(await title(desk), /49.6 × 80.3 × 49.8 mm/);
    await bar_says(desk, "(mm|cm)");
    assert.deepEqual(await chosen(desk), ["millimeters", "+Y"]);
    await wait_for(
      async () => (await asks(desk).locator("strata-thumbnail canvas.drawn").count()) === 6,
      "six pictures",
    );
    await shot(desk, "lekythos");
  } else {
    console.log(`NOT CHECKED: there is no ${kScan}`);
  }

  for (const who of [desk, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [desk, phone]) await who?.close();
  await server?.remove();
});
