// The page of the contract: it contains every operation, and its menu leads to each. It neither
// violates the content security policy nor loads files from another host.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { findings, kHeadRules, violations } from "../support/js/accessible.mjs";
import { kOfRedoc } from "../support/js/browser.mjs";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { Contract } from "../support/js/contract.mjs";
import { kRoot } from "../support/js/modules.mjs";

const contract = JSON.parse(
  readFileSync(join(kRoot, "protocol", "generated", "openapi.json"), "utf8"),
);
const operations = Object.values(contract.paths)
  .flatMap((item) => Object.values(item))
  .filter((operation) => operation.operationId);
// A heading begins with a link to itself, which also has a name.
const heading = (page, name) => page.getByRole("heading", { level: 2, name });
const summary_of = (id) => operations.find(({ operationId }) => operationId === id).summary;
const foreign = [];

test.use({ demo: false });

test("it opens without an account, and all comes from this server", async ({ server, page }) => {
  page.on("request", (request) => {
    if (!request.url().startsWith(`${server.url}/`)) foreign.push(request.url());
  });
  await page.goto(`${server.url}/docs`);
  await page.getByRole("main").getByRole("heading", { level: 1 }).waitFor();
  assert.match(
    await page.getByRole("main").getByRole("heading", { level: 1 }).innerText(),
    /^Strata/,
  );
});

test("every operation of the contract has a heading", async ({ page }) => {
  assert.ok(operations.length > 150);
  for (const id of ["is_alive", "import_model", "create_tool"])
    await heading(page, summary_of(id)).first().waitFor();
  const shown = await page
    .locator('main [id^="operation/"]')
    .evaluateAll((all) =>
      all.map((each) => [
        each.id.split("operation/")[1],
        each.querySelector("h2")?.textContent.trim(),
      ]),
    );
  const ids_and_names = operations.map(({ operationId, summary }) => [operationId, summary]);
  assert.deepEqual(shown.sort(), ids_and_names.sort());
});

test("the page has a main part, and heads of its tables", async ({ page }) => {
  assert.deepEqual(await violations(page, kHeadRules), []);
  assert.equal(await page.locator("th:empty").count(), 0);
});

test("the menu leads to an operation", async ({ page }) => {
  const menu = page.getByRole("navigation", { name: "Operations" });
  await menu.getByText("tools", { exact: true }).click();
  const link = menu.getByRole("link", { name: summary_of("create_tool") });
  await link.click();
  await page.waitForFunction((name) => {
    const found = [...document.querySelectorAll("main h2")].find(
      (each) => each.textContent.trim() === name,
    );
    const { top } = found.getBoundingClientRect();
    return top > -100 && top < innerHeight / 2;
  }, summary_of("create_tool"));
  await menu.locator('a[aria-current="location"]').first().waitFor();
});

/** What Redoc shows differently: the method, the places of parameters, and the kinds of bodies. */
const parts_of = ({ method, parameters, body, responses }) => {
  const answers = [...responses.values()].map(({ content = {} }) => ["answer", content]);
  const contents = [["request", body?.content ?? {}], ...answers];
  return [
    method,
    ...parameters.map((each) => `in ${each.in}`),
    ...contents.flatMap(([where, content]) => [
      ...Object.keys(content).map((type) => `${where} ${/json$/.test(type) ? "JSON" : "file"}`),
      ...(Object.keys(content).length > 1 ? [`${where} with a choice`] : []),
    ]),
  ];
};

// Redoc makes all operations from the same parts, and axe takes minutes for all of them. So axe
// checks the first operation with each part.
test("axe has no serious finding", async ({ page }) => {
  const parts = new Set();
  const others = new Contract().operations.filter((operation) => {
    const known = parts.size;
    parts_of(operation).forEach((part) => parts.add(part));
    return parts.size === known;
  });
  assert.ok(operations.length - others.length >= 8);
  const left_out = others.map(({ id }) => `main [id$="operation/${id}"]`);
  const all = page.locator('main [id^="operation/"]');
  assert.equal(await all.count(), operations.length);
  assert.deepEqual(await findings(page, null, left_out), []);
});

test("it opens for who is signed in, at both of its addresses", async ({ server, desk, page }) => {
  await desk.sign_in(server, server.token);
  await page.goto(`${server.url}/api/v1/docs`);
  await heading(page, summary_of("is_alive")).first().waitFor();
  assert.deepEqual(foreign, []);
});

test("the policy allows the styles of Redoc by their hashes alone", async ({ server }) => {
  const policy = (path) =>
    fetch(`${server.url}${path}`).then(({ headers }) => headers.get("Content-Security-Policy"));
  const wider = await policy("/docs");
  assert.match(wider, /style-src 'self'( 'sha256-[\w+/=]+'){2}$/);
  assert.doesNotMatch(wider, /unsafe/);
  assert.doesNotMatch(await policy("/"), /style-src/);
});

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well({ complaints: kOfRedoc });
