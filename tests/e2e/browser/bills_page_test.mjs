// Bills of quantities on the page: the import of a tender, rules over the classes of a layer, hand
// measurements, the measured quantities, and the export. The expected sums come from the statistics
// of the layer.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { with_one_layer } from "../support/js/one-layer.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const words = w.bills;
const kBills = "/projects/demo/bills";
const kTender = `<GAEB xmlns="http://www.gaeb.de/GAEB_DA_XML/DA83/3.3"><PrjInfo><Cur>EUR</Cur></PrjInfo>
<Award><DP>83</DP><BoQ><BoQInfo><Name>Facade</Name></BoQInfo><BoQBody><BoQCtgy RNoPart="01">
<LblTx><p><span>Natural stone</span></p></LblTx><BoQBody><Itemlist>
${["Clean the surface", "Fill losses"]
  .map(
    (text, i) => `<Item RNoPart="00${i + 1}0"><Qty>1.5</Qty><QU>m2</QU><UP>20.5</UP><Description>
<CompleteText><OutlineText><OutlTxt><TextOutlTxt><p>${text}</p></TextOutlTxt></OutlTxt>
</OutlineText></CompleteText></Description></Item>`,
  )
  .join("")}
</Itemlist></BoQBody></BoQCtgy></BoQBody></BoQ></Award></GAEB>`;

let area_m2;

const exact = (name) => ({ name, exact: true });
const list = (page) => page.locator("strata-bills-dialog");
const bill = (page) => page.locator("strata-bill-dialog");
const button = (page, name) => bill(page).getByRole("button", exact(name));
const field = (page, name) => bill(page).locator(`[name="${name}"]`);
const item = (page, number) => bill(page).getByRole("treeitem").filter({ hasText: number });
const sum = (page) => bill(page).locator("strata-bill-proof .sum b");
const shoot = (page, name) =>
  process.env.STRATA_TEST_OUTPUT
    ? page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `bills_${name}.png`) })
    : null;
const choose_file = (page, name, content) =>
  list(page)
    .locator("strata-file-choice input")
    .setInputFiles({ name, mimeType: "application/xml", buffer: Buffer.from(content) });
const first_bill = async (server) => (await server.json("GET", kBills)).bills[0];
const measured = async (server) =>
  server.json("GET", `${kBills}/${(await first_bill(server)).id}/quantities`);
/** Measures the bill, and returns when the page shows the quantities. */
async function measure(page) {
  await button(page, words.measure_all).click();
  await button(page, words.measure_all).waitFor();
  await bill(page).locator(".state b").waitFor();
}

test.beforeAll(async ({ server, desk }) => {
  const { finds } = await with_one_layer(server, "#d55e00");
  await server.json("POST", `${finds}/edits`, {
    op: "fill",
    mode: "where",
    where: "true",
    value: 1,
  });
  ({ area_m2 } = await server.json("GET", `${finds}/statistics`));
  await desk.page.goto(server.link);
  await desk.page.getByRole("button", exact(w.home.options("Demo"))).click();
  await desk.page.getByRole("menuitem", exact(w.billing.open)).click();
  await list(desk.page).getByText(words.none).waitFor();
});

test("a file that is not GAEB is refused, and a tender becomes a bill", async ({ page }) => {
  await shoot(page, "none");
  await choose_file(page, "old.d83", "00        83L      1122PPPPI\r\n");
  await list(page).getByRole("alert").getByText("GAEB 90").waitFor();
  await choose_file(page, "tender.x83", kTender);
  await list(page).getByText(words.imported("Facade")).waitFor();
  await list(page).getByText(words.positions(2)).waitFor();
  await shoot(page, "list");
});

test("the keyboard moves in the tree, and a rule links a class of a layer", async ({ page }) => {
  await list(page).getByRole("button", exact("Facade")).click();
  await item(page, "Natural stone").click();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await wait_for(
    () => field(page, "short_text").evaluate((input) => input.matches(":focus")),
    "the focus on the short text",
  );
  assert.equal(await field(page, "short_text").inputValue(), "Clean the surface");
  await button(page, words.add_rule).click();
  await field(page, "rules[0].table").selectOption("");
  await field(page, "rules[0].model").selectOption({ label: "Demo pot" });
  await field(page, "rules[0].layer").selectOption({ label: "Finds" });
  await bill(page).getByRole("checkbox", exact("Bone")).check();
  await shoot(page, "rule");
});

test("the quantities are those of the layer", async ({ page, server }) => {
  await measure(page);
  assert.ok(Math.abs(parseFloat(await sum(page).textContent()) - area_m2) <= 0.005 + 1e-9);
  const row = bill(page).locator("strata-bill-proof tbody tr");
  assert.match(await row.textContent(), /Bone[^]*Demo pot[^]*Finds/);
  assert.equal(await row.getByRole("link").getAttribute("href"), "/models/demo-pot");
  const { positions } = await measured(server);
  assert.equal(positions[0].lines.length, 1);
  await sum(page).scrollIntoViewIfNeeded();
  await shoot(page, "measured");
});

test("a hand measurement shows its value at once, and changes the sum", async ({
  page,
  server,
}) => {
  const before = parseFloat(await sum(page).textContent());
  await button(page, words.add_line).click();
  await field(page, "measurements[0].formula").fill("2 * 1,20 *");
  await bill(page).getByText(words.mistake(11)).waitFor();
  await field(page, "measurements[0].formula").fill("2 * 1,20 * 0,85");
  await bill(page).locator("output", { hasText: "2.04 m2" }).waitFor();
  await field(page, "measurements[0].text").fill("Plinth");
  await field(page, "measurements[0].remark").fill("behind the scaffold");
  await bill(page).locator("strata-bill-proof").getByText(words.stale).waitFor();
  await shoot(page, "by_hand");
  await measure(page);
  await bill(page).locator("strata-bill-proof").getByText("Plinth").waitFor();
  assert.equal(parseFloat(await sum(page).textContent()).toFixed(2), (before + 2.04).toFixed(2));
  const { positions, total } = await measured(server);
  assert.equal(positions[0].total, total);
  await bill(page).locator(".state").getByText(total).waitFor();
  await bill(page).getByText(words.entered("owner", "").slice(0, -2)).waitFor();
});

test("a wrong number is refused at its field, and undo restores the item", async ({ page }) => {
  await field(page, "unit_price").fill("20,5,5");
  await button(page, w.save).click();
  await bill(page).getByRole("alert").getByText(words.wrong_number).waitFor();
  assert.equal(await field(page, "unit_price").getAttribute("aria-invalid"), "true");
  await shoot(page, "wrong");
  await button(page, words.undo).click();
  assert.equal(await field(page, "unit_price").inputValue(), "20.5");
  await item(page, "01.0020").click();
  await page.keyboard.press("Delete");
  await wait_for(async () => (await item(page, "01.0020").count()) === 0, "the item to go");
  await page.keyboard.press("Control+z");
  await item(page, "01.0020").waitFor();
  await item(page, "01.0010").click();
  await page.keyboard.press("Insert");
  await item(page, "01.0015").waitFor();
  await field(page, "short_text").fill("Remove salts");
  await button(page, w.save).click();
  await wait_for(() => button(page, w.save).isDisabled(), "the bill to be saved");
});

test("a change of another user is not overwritten", async ({ page, server }) => {
  const path = `${kBills}/${(await first_bill(server)).id}`;
  const { name, currency, items } = await server.json("GET", path);
  assert.deepEqual(
    items.map(({ number }) => number),
    ["01", "01.0010", "01.0015", "01.0020"],
  );
  await server.json("PUT", path, { name: `${name} 2026`, currency, items });
  await field(page, "short_text").fill("Remove the salts");
  await button(page, w.save).click();
  await bill(page).getByText(words.outdated).waitFor();
  await shoot(page, "outdated");
  await button(page, words.reload).click();
  await bill(page).getByRole("heading", exact("Facade 2026")).waitFor();
  assert.equal(await field(page, "short_text").inputValue(), "Remove salts");
});

test("the bill is exported as a workbook", async ({ page }) => {
  await button(page, words.export).click();
  const file = page.waitForEvent("download");
  await page.getByRole("menuitem", exact(words.formats.xlsx)).click();
  const workbook = await file;
  assert.equal(workbook.suggestedFilename(), "Facade 2026.xlsx");
  assert.equal((await readFile(await workbook.path())).subarray(0, 2).toString(), "PK");
});

test("unsaved changes are not lost, and a bill is renamed and deleted", async ({
  page,
  server,
}) => {
  await field(page, "short_text").fill("Something else");
  await page.keyboard.press("Escape");
  const question = page.locator("strata-question");
  await question.getByRole("button", exact(words.leave_yes)).click();
  await list(page).getByRole("button", exact("Facade 2026")).waitFor();
  const from_menu = async (command) => {
    await list(page)
      .getByRole("button", exact(words.options("Facade 2026")))
      .click();
    await page.getByRole("menuitem", exact(command)).click();
  };
  await from_menu(words.formats.x84);
  await list(page).getByRole("alert").getByText("01.0015").waitFor();
  await shoot(page, "refused_export");
  await from_menu(words.rename);
  await page.locator("strata-text-question input").fill("North facade");
  await page.locator("strata-text-question").getByRole("button", exact(w.save)).click();
  await list(page).getByRole("button", exact("North facade")).waitFor();
  assert.equal((await first_bill(server)).name, "North facade");
  await field_of_new(page).fill("Scaffold");
  await list(page).getByRole("button", exact(words.create)).click();
  await bill(page).getByText(words.empty, { exact: true }).waitFor();
  await button(page, words.new_group).click();
  await button(page, words.new_position).click();
  await item(page, "01.0010").waitFor();
  await button(page, w.save).click();
  await wait_for(() => button(page, w.save).isDisabled(), "the bill to be saved");
  await page.keyboard.press("Escape");
  await list(page)
    .getByRole("button", exact(words.options("Scaffold")))
    .click();
  await page.getByRole("menuitem", exact(w.layers.delete)).click();
  await question.getByRole("button", exact(w.delete)).click();
  await wait_for(
    async () => (await server.json("GET", kBills)).total === 1,
    "the bill to be deleted",
  );
});
const field_of_new = (page) => list(page).getByRole("textbox", exact(words.new_name));

test("on a phone, the fields of a position cover the tree", async ({ server }) => {
  const phone = await Browser.open({
    viewport: { width: 375, height: 740 },
    hasTouch: true,
    isMobile: true,
  });
  try {
    const { page } = phone;
    await page.goto(server.link);
    await page.goto(`${server.url}/models/demo-pot`);
    await phone.drawn();
    await open_tab(page, w, w.view.title);
    await page.getByRole("button", exact(w.billing.open)).click();
    await list(page).getByRole("button", exact("North facade")).click();
    await measure(page);
    await shoot(page, "phone_tree");
    await item(page, "01.0010").click();
    await field(page, "short_text").waitFor();
    await shoot(page, "phone_fields");
    await sum(page).scrollIntoViewIfNeeded();
    await shoot(page, "phone_proof");
    const wide = await bill(page)
      .locator("dialog")
      .evaluate((dialog) => dialog.scrollWidth - dialog.clientWidth);
    assert.ok(wide <= 0, `the dialog is ${wide} pixels too wide`);
    await button(page, words.all_items).click();
    await item(page, "01.0020").waitFor();
    phone.assert_no_complaints();
  } finally {
    await phone.close();
  }
});

test.afterEach(({ server }, info) => attach_log(info, server));
// the refused file and export, and the version of another user
ends_well({ complaints: ["status of 415", "status of 422", "status of 412"] });
