// A file of points: the model opens with the facts about its surface, and "Create again" makes
// another surface from the stored file. A model without layers moves to the Trash, another one stays.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** A vase of points, 20 cm wide and 40 cm high, without a bottom, in millimeters. */
function vase(points) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  const lines = [];
  for (let i = 0; i < points; ++i) {
    const height = (400 * (i + 0.5)) / points;
    const radius = 70 + 30 * Math.sin(height / 90);
    const angle = golden * i;
    const color = [180, 120 + Math.round(60 * Math.sin(height / 20)), 80];
    lines.push([radius * Math.cos(angle), radius * Math.sin(angle), height, ...color].join(" "));
  }
  const channels = ["red", "green", "blue"].map((name) => `property uchar ${name}`);
  return [
    "ply",
    "format ascii 1.0",
    "comment unit: mm",
    `element vertex ${points}`,
    ...["x", "y", "z"].map((name) => `property float ${name}`),
    ...channels,
    "end_header",
    ...lines,
    "",
  ].join("\n");
}

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `points_${name}.png`) });
};
const surface_of = ({ page }) => page.locator("strata-scale-dialog strata-points-surface");
const models_of = async () => (await server.json("GET", "/models?limit=100")).models;
const summary = words.points.again;

let desk, phone, server, first;

test.beforeAll(async () => {
  desk = await Browser.open({ viewport: { width: 1440, height: 900 } });
  phone = await Browser.open({ ...kPhone });
  server = new StrataServer();
  await server.start();
  await desk.sign_in(server, server.token);
  await phone.sign_in(server, server.token);
});

test("the model opens with the facts about its surface", async () => {
  await desk.page.goto(server.url);
  await desk.page
    .locator("strata-home-page input[type=file]")
    .first()
    .setInputFiles([
      { name: "vase.ply", mimeType: "application/octet-stream", buffer: Buffer.from(vase(9000)) },
    ]);
  await surface_of(desk)
    .getByText(/Made from 9[ ,.  ]?000 points, which are about/)
    .waitFor();
  await desk.drawn();
  [first] = await models_of();
  assert.equal(first.from_points.points, 9000);
  assert.ok(first.open_edges.loops >= 1, "the ends of the vase are open");
  await shot(desk, "facts");
});

test("a wrong length is named at its field", async () => {
  await surface_of(desk).getByText(summary).click();
  await surface_of(desk).getByLabel(words.points.lengths.cell.label).fill("0");
  await surface_of(desk).getByRole("button", { name: words.points.start }).click();
  await surface_of(desk).getByRole("alert").getByText(words.points.wrong).waitFor();
  assert.equal(
    await surface_of(desk).getByLabel(words.points.lengths.cell.label).getAttribute("aria-invalid"),
    "true",
  );
  await shot(desk, "wrong");
});

test("another surface replaces the model without layers, which moves to the Trash", async () => {
  await surface_of(desk).getByLabel(words.points.lengths.cell.label).fill("25");
  await surface_of(desk).getByRole("button", { name: words.points.start }).click();
  const second = await wait_for(
    async () => (await models_of()).find(({ id }) => id !== first.id),
    "the new model",
  );
  await wait_for(async () => (await models_of()).length === 1, "the old one to be in the Trash");
  await desk.page.waitForURL(new RegExp(`/models/${second.id}\\b`));
  await surface_of(desk).waitFor();
  await desk.drawn();
  assert.ok(second.triangles * 3 < first.triangles, `${second.triangles} of ${first.triangles}`);
  await desk.page
    .locator("strata-notices")
    .getByRole("button", { name: words.model.undo })
    .waitFor();
  await shot(desk, "again");
});

test("a model with layers stays; the phone shows the same", async () => {
  const [model] = await models_of();
  await server.json("POST", `/models/${model.id}/layers`, { name: "dust", type: "u8" });
  await phone.page.goto(`${server.url}/models/${model.id}`);
  await surface_of(phone).waitFor();
  await phone.drawn();
  await surface_of(phone).getByText(summary).click();
  await shot(phone, "phone");
  await surface_of(phone).getByLabel(words.points.lengths.gap.label).fill("500");
  await surface_of(phone).getByRole("button", { name: words.points.start }).click();
  await wait_for(async () => (await models_of()).length === 2, "the new model beside the old one");
  await phone.page.getByText(words.points.old_stays(model.name)).first().waitFor();
  for (const who of [desk, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [desk, phone]) await who?.close();
  await server?.remove();
});
