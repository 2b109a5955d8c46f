// A curator sets the users who can see a layer, a column and a photo, and who can download the
// scan. A viewer loses and regains access immediately.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { encode_png } from "../support/js/png.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

async function shoot({ page }, name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `visibility_${name}.png`) });
}
async function choose_for({ page }, menu, command) {
  await page.getByRole("button", { name: menu, exact: true }).click();
  await page.getByRole("menuitem", { name: command, exact: true }).click();
}
const row_of = ({ page }) => page.getByRole("button", { name: words.layers.select("Finds") });
const badge = (where, says) => where.getByRole("img", { name: says });
const kCurators = words.visibility.says.private;
const kTeam = words.visibility.says.team;
const photo = encode_png({ width: 64, height: 48, data: Buffer.alloc(64 * 48 * 4, 200) });

let carl, vera, phone, server, model, dialog;

test.beforeAll(async () => {
  [carl, vera, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  model = (await server.json("GET", "/models")).models[0];
  const layers = `/models/${model.id}/layers`;
  await server.json("POST", layers, {
    name: "Finds",
    kind: "database",
    type: "u16",
    columns: [{ name: "Name" }, { name: "Place" }, { name: "Photos", kind: "picture" }],
  });
  await server.json("POST", "/tables/finds/records", {
    values: { name: "Ring", place: "Under the slab" },
  });
  await server.json("POST", `${layers}/finds/edits`, {
    op: "fill",
    value: 1,
    mode: "where",
    where: "true",
  });
  const attached = await fetch(
    `${server.url}/api/v1/tables/finds/records/1/attachments?name=ring.png&column=photos`,
    {
      method: "POST",
      headers: {
        Authorization: `Bearer ${server.token}`,
        "Content-Type": "application/octet-stream",
      },
      body: photo,
    },
  );
  assert.equal(attached.status, 201);
});

test("a curator and two viewers look at the model", async () => {
  await carl.sign_in(server, await server.add_person("carl", "curator"));
  const veras = await server.add_person("vera", "viewer");
  for (const who of [vera, phone]) await who.sign_in(server, veras);
  for (const who of [carl, vera, phone]) {
    await who.page.goto(`${server.url}/models/${model.id}`);
    await who.drawn();
  }
  const later = carl.page.getByRole("button", { name: words.scale.later });
  if (await later.isVisible()) await later.click();
  await row_of(vera).click();
});

test("the layer becomes the curators' own: it is gone for the others while they look", async () => {
  await choose_for(carl, words.layers.options("Finds"), words.layers.edit);
  dialog = carl.page.locator("strata-layer-dialog");
  await dialog.getByText(words.visibility.says.public).waitFor();
  await dialog.getByRole("radio", { name: words.visibility.names.private }).click();
  await dialog.getByText(kCurators).waitFor();
  await shoot(carl, "layer_dialog");
  await dialog.getByRole("button", { name: words.save, exact: true }).click();
  await badge(carl.page.locator("strata-layer-panel"), kCurators).waitFor();
  await wait_for(async () => (await row_of(vera).count()) === 0, "the layer to be gone for her");
  await shoot(carl, "layer_badge");
  await shoot(vera, "layer_gone");
});

test("it is everybody's again", async () => {
  await choose_for(carl, words.layers.options("Finds"), words.layers.edit);
  await dialog.getByRole("radio", { name: words.visibility.names.public }).click();
  await dialog.getByRole("button", { name: words.save, exact: true }).click();
  await row_of(vera).waitFor();
  await wait_for(
    async () => (await badge(carl.page.locator("strata-layer-panel"), kCurators).count()) === 0,
    "the badge to go",
  );
});

test("a column of the team", async () => {
  for (const who of [carl, vera]) {
    await row_of(who).click();
    await who.page.keyboard.press("t");
    await who.page.locator("strata-table-panel").getByText("Under the slab").waitFor();
  }
  await choose_for(carl, words.tables.column_menu("Place"), words.tables.change_column);
  const column = carl.page.locator("strata-column-dialog");
  await column.getByRole("radio", { name: words.visibility.names.team }).click();
  await shoot(carl, "column_dialog");
  await column.getByRole("button", { name: words.save, exact: true }).click();
  await badge(carl.page.locator("strata-table-panel"), kTeam).waitFor();
  await wait_for(
    async () =>
      (await vera.page.locator("strata-table-panel").getByText("Under the slab").count()) === 0,
    "the column to be gone for her",
  );
  await vera.page.locator("strata-table-panel").getByText("Ring").waitFor();
  await shoot(carl, "column_badge");
  await shoot(vera, "column_gone");
});

test("a photo of the curators", async () => {
  await carl.page
    .locator("strata-table-panel")
    .getByRole("rowheader", { name: "1", exact: true })
    .click();
  await carl.page.getByRole("button", { name: words.tables.edit, exact: true }).click();
  const choice = carl.page
    .locator("strata-record-dialog")
    .getByLabel(words.visibility.of("ring.png"));
  await choice.selectOption({ label: words.visibility.names.private });
  await wait_for(
    async () =>
      (await server.json("GET", "/tables/finds/records/1/attachments")).attachments[0]
        .visibility === "private",
    "the photo to be private",
  );
  await shoot(carl, "photo");
  await carl.page.keyboard.press("Escape");
});

test("who downloads the scan", async () => {
  await carl.page.getByRole("button", { name: words.model.details }).click();
  const about = carl.page.locator("strata-about-sheet");
  await about.getByText(words.model.details_list.open_edges).waitFor();
  await about
    .getByLabel(words.visibility.download)
    .selectOption({ label: words.visibility.download_roles.viewer });
  await shoot(carl, "about");
  await wait_for(
    async () => (await server.json("GET", `/models/${model.id}`)).source_download === "viewer",
    "the right to be given",
  );
  await about
    .getByLabel(words.visibility.download)
    .selectOption({ label: words.visibility.download_roles.curator });
  await wait_for(
    async () => (await server.json("GET", `/models/${model.id}`)).source_download === "curator",
    "the right to be taken",
  );
  await carl.page.keyboard.press("Escape");
  await shoot(phone, "phone");

  // invisible photos have no thumbnail either
  for (const who of [carl, vera, phone]) who.assert_no_complaints(["/attachments/"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [carl, vera, phone]) await who?.close();
  await server?.remove();
});
