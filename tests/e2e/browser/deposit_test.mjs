// The citation of a project on the page of a model, and the form that describes the project for a
// repository and makes the deposit.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const field = (page, name) => page.locator(`strata-deposit-dialog [name="${name}"]`);
const shoot = (page, name) =>
  process.env.STRATA_TEST_OUTPUT
    ? page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `deposit-${name}.png`) })
    : null;
const metadata = (server) => server.json("GET", "/projects/demo/metadata");

test.beforeAll(async ({ server, desk }) => {
  const { page } = desk;
  await page.goto(server.link);
  await page.getByRole("link", { name: w.home.open("Demo pot") }).click();
  await desk.drawn();
});

test("the details of the model have a citation", async ({ page }) => {
  await page.getByRole("button", { name: w.model.details }).click();
  const citation = page.locator("strata-citation");
  await citation.locator("p").waitFor();
  assert.match(await citation.locator("p").textContent(), /Demo \[Dataset\]\.$/);
  const file = page.waitForEvent("download");
  await citation.getByRole("link", { name: "BibTeX" }).click();
  const bibtex = await readFile(await (await file).path(), "utf8");
  assert.match(bibtex, /^@dataset\{demo,/);
  await shoot(page, "citation");
});

test("a wrong ORCID iD and missing fields are refused at their fields", async ({ page }) => {
  await page.getByRole("button", { name: w.deposit.open }).click();
  await field(page, "title").fill("Survey of a pot");
  await field(page, "creator_name_0").fill("Muster, Ada");
  await field(page, "creator_orcid_0").fill("0000-0002-1825-0098");
  await page.getByRole("button", { name: w.deposit.make }).click();
  await page.getByRole("alert").getByText("0000-0002-1825-0098").waitFor();
  assert.equal(await field(page, "creator_orcid_0").getAttribute("aria-invalid"), "true");
  await shoot(page, "wrong");
  await field(page, "creator_orcid_0").fill("0000-0002-1825-0097");
  await page.getByRole("button", { name: w.deposit.make }).click();
  await page.getByRole("alert").getByText(w.deposit.incomplete).waitFor();
  await wait_for(
    () => field(page, "publisher").evaluate((input) => input.matches(":focus")),
    "the focus on the first field that is missing",
  );
});

test("the deposit is saved as a zip, and the metadata are stored", async ({ server, page }) => {
  await field(page, "publisher").fill("Zenodo");
  await field(page, "license").fill("CC-BY-4.0");
  await page.getByRole("button", { name: w.deposit.add_creator }).click();
  await field(page, "creator_name_1").fill("Roe, Jane");
  await page.getByRole("button", { name: w.save, exact: true }).click();
  await page.getByText(w.deposit.saved, { exact: true }).waitFor();
  const { record, missing } = await metadata(server);
  assert.deepEqual(missing, []);
  assert.deepEqual(
    record.creators.map(({ name }) => name),
    ["Muster, Ada", "Roe, Jane"],
  );
  const file = page.waitForEvent("download");
  await page.getByRole("button", { name: w.deposit.make }).click();
  const zip = await file;
  assert.equal(zip.suggestedFilename(), "demo.zip");
  assert.equal((await readFile(await zip.path())).subarray(0, 2).toString(), "PK");
  await page.getByText(w.deposit.made("demo.zip")).waitFor();
  await shoot(page, "made");
});

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well({ complaints: ["422"] }); // the refused ORCID iD
