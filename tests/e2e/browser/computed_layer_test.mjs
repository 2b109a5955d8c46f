// A computed layer in the page: names are completed while one writes, what it holds for is told,
// mistakes at their character; stale when something that it reads changes, computed again by a
// button or by itself.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/browser.mjs";
import { StrataServer, wait_for } from "../support/strata-server.mjs";

const browser = await Browser.open();
const { page } = browser;
const server = new StrataServer({ demo: true });
const base = "/models/demo-pot";
const button = (name) => page.getByRole("button", { name });
const shot = async (name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `computed-${name}.png`) });
};
const risk = async () =>
  (await server.json("GET", `${base}/layers`)).layers.find((layer) => layer.slug === "risk");

try {
  await server.start();
  await page.goto(server.link);
  await page.getByRole("link", { name: /Demo pot/ }).click();
  await browser.drawn();

  await button("New layer").click();
  await page.getByRole("radio", { name: /From an expression/ }).click();
  const expression = page.getByLabel("Expression: a number");
  await expression.fill("if(valid(crcks), 2, 1)");
  await page.getByText(/no layer 'crcks'.*at character 10/).waitFor();
  await shot("mistake");
  await expression.fill("");
  await expression.pressSequentially("if(valid(cra");
  await page.getByRole("option", { name: /^cracks/ }).waitFor();
  await shot("completion");
  await expression.press("Enter");
  await expression.pressSequentially("), 2, 1)");
  await page.getByText(/Has a value on/).waitFor();
  await page.getByLabel("Name", { exact: true }).fill("Risk");
  await shot("dialog");
  await button("Compute layer").click();
  // it is computed first and gets its colours then
  await page.locator("strata-layer-dialog").waitFor({ state: "detached" });
  await wait_for(async () => (await risk())?.stale === false, "the layer");
  const made = await risk();
  assert.deepEqual(
    [made.expression, made.inputs, made.recompute],
    ["if(valid(cracks), 2, 1)", ["cracks"], "manual"],
  );
  assert.ok(made.palette.max <= 2 && made.palette.min >= 1, JSON.stringify(made.palette));
  await page.getByText("if(valid(cracks), 2, 1)").waitFor();

  await server.json("POST", `${base}/layers/cracks/edits`, {
    op: "fill",
    mode: "where",
    where: "z > 0",
    value: 1,
  });
  await page.getByText("Something that it is computed from has changed since.").waitFor();
  await shot("stale");
  await button("Compute again").click();
  await page
    .getByText("Something that it is computed from has changed since.")
    .waitFor({ state: "hidden" });
  assert.equal((await risk()).stale, false);

  await button("Options for Risk").click();
  await page.getByRole("menuitem", { name: /^Edit…?$/ }).click();
  await page.getByLabel("Expression: a number").fill("if(valid(cracks), 7, 5)");
  await page.getByLabel(/by itself/).check();
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await wait_for(
    async () => (await risk()).expression === "if(valid(cracks), 7, 5)" && !(await risk()).stale,
    "the new expression",
  );
  assert.equal((await risk()).recompute, "automatic");
  await server.json("POST", `${base}/layers/cracks/edits`, {
    op: "fill",
    mode: "where",
    where: "true",
    value: 1,
  });
  const least = async () => (await server.json("GET", `${base}/layers/risk/statistics`)).min;
  await wait_for(async () => (await least()) === 7, "the layer to follow by itself");

  browser.assert_no_complaints(["422"]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
} finally {
  await browser.close();
  await server.remove();
}
