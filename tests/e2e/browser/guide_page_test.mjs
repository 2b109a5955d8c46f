// The guide opens without an account, its search finds pages, and the page links to it. It does not
// violate the content security policy, and loads no files from another host.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { findings } from "../support/js/accessible.mjs";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { kRoot } from "../support/js/modules.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");
const kFolders = ["how-to", "reference", "explanation"];
const pages = kFolders.flatMap((folder) =>
  readdirSync(join(kRoot, "docs", folder))
    .filter((file) => file.endsWith(".md"))
    .map((file) => `${folder}/${file.slice(0, -".md".length)}`.replace(/index$/, "")),
);
const foreign = [];

test("it opens without an account, and all comes from this server", async ({ server, page }) => {
  page.on("request", (request) => {
    if (!request.url().startsWith(`${server.url}/`)) foreign.push(request.url());
  });
  await page.goto(`${server.url}/guide`);
  await page.getByRole("link", { name: "Get started" }).first().click();
  await page.getByRole("heading", { level: 1, name: "Get started" }).waitFor();
  assert.equal(new URL(page.url()).pathname, "/guide/get-started");
});

test("the search finds a page by a word of its text", async ({ page }) => {
  await page.getByRole("button", { name: "Search" }).click();
  await page.getByRole("searchbox").fill("lasso");
  await page
    .getByRole("option")
    .filter({ hasText: /Paint a layer/ })
    .first()
    .click();
  await page.getByRole("heading", { level: 1, name: "Paint a layer" }).waitFor();
});

test("every page has an address, a title and its pictures", async ({ server, page }) => {
  assert.ok(pages.length > 30);
  for (const each of pages) {
    const answer = await page.goto(`${server.url}/guide/${each}`);
    assert.equal(answer.status(), 200, each);
    await page.getByRole("heading", { level: 1 }).waitFor();
    const broken = await page.locator("main img").evaluateAll((all) =>
      Promise.all(
        all.map((image) =>
          image.decode().then(
            () => undefined,
            () => image.src,
          ),
        ),
      ),
    );
    assert.deepEqual(
      broken.filter((source) => source),
      [],
      each,
    );
  }
  assert.deepEqual(foreign, []);
});

test("the sample of a condition report can be read", async ({ server, page }) => {
  await page.goto(`${server.url}/guide/how-to/write-a-condition-report`);
  for (const [name, type, begin] of [
    ["as PDF/A", "application/pdf", "%PDF-"],
    ["as DOCX", "officedocument.wordprocessingml.document", "PK"],
  ]) {
    const address = await page.getByRole("link", { name }).evaluate((link) => link.href);
    const answer = await fetch(address);
    assert.ok(answer.headers.get("Content-Type").endsWith(type), address);
    assert.ok((await answer.text()).startsWith(begin), address);
  }
});

test("axe has no serious finding", async ({ server, page }) => {
  for (const each of ["", "how-to/paint-a-layer", "reference/conditions"]) {
    await page.goto(`${server.url}/guide/${each}`);
    await page.getByRole("heading", { level: 1 }).waitFor();
    assert.deepEqual(await findings(page), [], each);
  }
});

test("help leads to the guide", async ({ server, desk, page }) => {
  await desk.sign_in(server, server.token);
  await page.goto(`${server.url}/models/1`);
  await page.getByRole("button", { name: words.model.help, exact: true }).click();
  const link = page.getByRole("link", { name: words.help.guide, exact: true });
  const [opened] = await Promise.all([page.waitForEvent("popup"), link.click()]);
  await opened.getByRole("heading", { level: 1 }).waitFor();
  assert.equal(new URL(opened.url()).pathname, "/guide/");
});

test("a page that does not exist says so", async ({ server }) => {
  const answer = await fetch(`${server.url}/guide/how-to/nothing`);
  assert.equal(answer.status, 404);
  assert.match(answer.headers.get("Content-Type"), /^text\/html/);
});

test.afterEach(({ server }, info) => attach_log(info, server));
ends_well();
