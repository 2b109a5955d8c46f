// The surveys of an object on the page: a curator puts two models into an object, opens one survey
// from the other, and compares them with the divider.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { square_ply } from "../support/js/meshes.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const { surveys } = words;

let carl, server, first, second;

async function shoot(name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await carl.page.screenshot({
      path: join(process.env.STRATA_TEST_OUTPUT, `surveys_${name}.png`),
    });
}
async function imported(name, unit, side) {
  const query = new URLSearchParams({ filename: "x.ply", name, unit });
  const response = await fetch(`${server.url}/api/v1/models?${query}`, {
    method: "POST",
    headers: { Authorization: `Bearer ${server.token}` },
    body: square_ply(side),
  });
  assert.equal(response.status, 202, await response.clone().text());
  const { id } = await response.json();
  const job = await wait_for(async () => {
    const now = await server.json("GET", `/jobs/${id}`);
    assert.ok(!["failed", "cancelled"].includes(now.state), now.message);
    return now.state === "done" ? now : null;
  }, `the import of ${name}`);
  await server.json("PATCH", `/models/${job.model}`, { scale_verified: true });
  for (const layer of ["Cracks", "Salts"])
    await server.json("POST", `/models/${job.model}/layers`, {
      name: layer,
      type: "u8",
      resolution: 2048,
    });
  return server.json("GET", `/models/${job.model}`);
}
const date = (name) => carl.page.getByRole("radio", { name, exact: true });
const is_at = ({ id }) => carl.page.waitForURL(`${server.url}/models/${id}`);
const view_of = ({ last_camera: { camera } }) => JSON.parse(camera).view;
const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-6 * Math.max(1, Math.abs(b)), `${a} ≠ ${b}`);
const divider = () => carl.page.getByRole("slider", { name: surveys.divider("2019", "Jun 2022") });

test.beforeAll(async () => {
  carl = await Browser.open();
  server = new StrataServer();
  await server.start();
  first = await imported("Panel 2019", "mm", 100);
  second = await imported("Panel 2022", "m", 0.1);
  await carl.sign_in(server, await server.add_person("carl", "curator"));
});

test("a curator puts the models into an object", async () => {
  for (const [model, when] of [
    [first, "2019"],
    [second, "2022-06"],
  ]) {
    await carl.page.goto(`${server.url}/models/${model.id}`);
    await carl.drawn();
    await carl.page.getByRole("button", { name: words.model.details, exact: true }).click();
    await carl.page.getByLabel(surveys.object, { exact: true }).fill("Panel");
    await carl.page.getByRole("textbox", { name: surveys.date, exact: true }).fill(when);
    await carl.page.getByRole("button", { name: surveys.save, exact: true }).click();
    await wait_for(
      async () => (await server.json("GET", `/models/${model.id}`)).survey_date === when,
      "the survey in the database",
    );
    await carl.page.keyboard.press("Escape");
  }
  const { objects } = await server.json("GET", "/projects/default/objects");
  assert.deepEqual(
    objects.map(({ name, surveys: own }) => [name, own.map(({ model }) => model)]),
    [["Panel", [first.id, second.id]]],
  );
});

test("a curator renames the object on its card", async () => {
  await carl.page.goto(server.url);
  await carl.page.getByRole("listitem").filter({ hasText: "Panel" }).hover();
  await carl.page.getByRole("button", { name: words.home.options("Panel"), exact: true }).click();
  await carl.page.getByRole("menuitem", { name: words.home.rename_object, exact: true }).click();
  await carl.page
    .getByRole("textbox", { name: words.home.object_name, exact: true })
    .fill("Wall panel");
  await carl.page.getByRole("button", { name: words.save, exact: true }).click();
  await carl.page.getByRole("link", { name: words.home.open("Wall panel"), exact: true }).waitFor();
  const { objects } = await server.json("GET", "/projects/default/objects");
  assert.deepEqual(
    objects.map(({ name }) => name),
    ["Wall panel"],
  );
});

test("the list of models has one card with the dates", async () => {
  await carl.page.goto(server.url);
  const card = carl.page.getByRole("listitem").filter({ hasText: "Wall panel" });
  await card.getByText(words.home.surveys(2)).waitFor();
  assert.equal(await card.count(), 1);
  await shoot("home");
  await card.getByRole("link", { name: "2019", exact: true }).click();
  await is_at(first);
  await carl.drawn();
});

test("an arrow key opens the next survey, with the same camera and layers", async () => {
  await carl.page.getByRole("button", { name: words.layers.hide("Salts"), exact: true }).click();
  await carl.page.keyboard.press("4"); // a standard view
  await carl.rested();
  const before = view_of(carl);
  await date("2019").focus();
  await carl.page.keyboard.press("ArrowRight");
  await is_at(second);
  await carl.drawn();
  await carl.rested();
  const after = view_of(carl);
  for (let at = 0; at < 12; ++at) near(after[at], before[at]);
  for (let at = 12; at < 15; ++at) near(1000 * after[at], before[at]); // in m and in mm
  const shown = (name) => carl.page.getByRole("button", { name, exact: true });
  await shown(words.layers.show("Salts")).waitFor();
  await shown(words.layers.hide("Cracks")).waitFor();
});

test("the focus stays on the dates", async () => {
  const chosen = date("Jun 2022");
  await wait_for(
    () => chosen.evaluate((radio) => radio.getRootNode().activeElement === radio),
    "the focus on the date",
  );
  assert.equal(await chosen.getAttribute("aria-checked"), "true");
  await date("2019").click();
  await is_at(first);
  await carl.drawn();
});

test("two surveys are next to each other, with a divider that moves", async () => {
  await carl.page
    .getByRole("combobox", { name: surveys.compare, exact: true })
    .selectOption(String(second.id));
  await carl.page.locator("strata-survey-overlay canvas:not([hidden])").waitFor();
  await shoot("swipe");
  await divider().focus();
  await carl.page.keyboard.press("Home");
  await wait_for(
    async () => (await divider().getAttribute("aria-valuenow")) === "2",
    "the divider at the left edge",
  );
  await carl.page.getByRole("combobox", { name: surveys.compare, exact: true }).selectOption("");
  await wait_for(async () => (await divider().count()) === 0, "the open survey alone");
});

async function painted(model, layer, value, [x, y], radius_mm) {
  const response = await fetch(
    `${server.url}/api/v1/models/${model.id}/layers/${layer}/readings?radius_mm=${radius_mm}`,
    {
      method: "POST",
      headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "text/csv" },
      body: `x,y,z,value\n${x},${y},0,${value}\n`,
    },
  );
  assert.equal(response.status, 200, await response.clone().text());
}

test("the dialog of the changes shows which class became which", async () => {
  const changes = surveys.changes;
  await painted(first, "cracks", 1, [50, 50], 20);
  await painted(second, "cracks", 2, [0.05, 0.05], 20);
  await painted(second, "cracks", 2, [0.08, 0.02], 5); // a new piece
  await carl.page.getByRole("button", { name: changes.open, exact: true }).click();
  await carl.page
    .locator("strata-changes-dialog select[name=layer]")
    .selectOption({ label: "Cracks" });
  await carl.page.getByRole("button", { name: changes.compare, exact: true }).click();
  const table = carl.page.getByRole("region", { name: changes.table("2019", "Jun 2022") });
  await table.getByRole("rowheader", { name: "1", exact: true }).waitFor();
  const became = table.getByRole("row").filter({ hasText: /^\s*1/ }).getByRole("cell").first();
  near(Math.round(Number(await became.textContent()) / 0.5) * 0.5, 12.5); // π · 20² mm²
  await shoot("changes");
  // The piece is on the surface of the other survey, which has another unit.
  const before = view_of(carl);
  await carl.page.getByTitle(changes.fly, { exact: true }).first().click();
  await carl.rested();
  assert.notDeepEqual(view_of(carl), before);
  await carl.page.getByRole("radio", { name: changes.views.statistics, exact: true }).click();
  const statistics = carl.page.getByRole("region", { name: changes.statistics });
  await statistics.getByRole("rowheader", { name: "Jun 2022", exact: true }).waitFor();
  await shoot("statistics");
  const [csv] = await Promise.all([
    carl.page.waitForEvent("download"),
    carl.page.getByRole("button", { name: `CSV: ${changes.statistics}`, exact: true }).click(),
  ]);
  assert.equal(csv.suggestedFilename(), "cracks-surveys.csv");
  await carl.page.keyboard.press("Escape");
});

test("a curator deletes the object, and its models remain", async () => {
  await carl.page.goto(server.url);
  await carl.page.getByRole("listitem").filter({ hasText: "Wall panel" }).hover();
  await carl.page
    .getByRole("button", { name: words.home.options("Wall panel"), exact: true })
    .click();
  await carl.page.getByRole("menuitem", { name: words.home.delete_object, exact: true }).click();
  await carl.page.getByRole("button", { name: words.delete, exact: true }).click();
  for (const { name } of [first, second])
    await carl.page.getByRole("link", { name: words.home.open(name), exact: true }).waitFor();
  assert.deepEqual((await server.json("GET", "/projects/default/objects")).objects, []);
});

test("nobody complained", async () => {
  carl.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await carl?.close();
  await server?.remove();
});
