// The page's own fonts: the page and the guide use them under the content security policy, and load
// only the scripts that they need. The layout does not move when a font arrives late.
import assert from "node:assert/strict";
import { attach_log, ends_well, test } from "../support/js/cases.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const kMostShift = 0.01; // sum of the layout shifts; Chromium rates 0.1 as good

/** Returns the families and the number of font files that the page has loaded. */
const loaded = (page) =>
  page.evaluate(async () => {
    await document.fonts.ready;
    const faces = [...document.fonts].filter(({ status }) => status === "loaded");
    const files = performance
      .getEntriesByType("resource")
      .filter(({ name }) => name.endsWith(".woff2"));
    return {
      families: [...new Set(faces.map(({ family }) => family.replaceAll('"', "")))],
      files: files.length,
    };
  });

/** Returns the page's own font families that are loaded. */
const arrived = (page) =>
  page.evaluate(() =>
    [...document.fonts].flatMap(({ status, family }) =>
      status === "loaded" && family.includes("Variable") ? family : [],
    ),
  );

function assert_both({ families, files }) {
  for (const family of ["Inter Variable", "Source Serif 4 Variable"])
    assert.ok(families.includes(family), `${family} is none of ${families}`);
  assert.equal(files, 2, "more than the Latin files");
}

test.afterEach(({ server }, info) => attach_log(info, server));

test("the page shows its fonts, and loads only the script that it shows", async ({
  server,
  page,
}) => {
  await page.goto(server.url);
  await page.getByRole("heading", { name: w.sign_in.title }).waitFor();
  assert_both(await loaded(page));
});

test("figures have one width", async ({ page }) => {
  const widths = await page.evaluate(() => {
    const probe = document.createElement("span");
    document.body.append(probe);
    const found = ["1111", "0000", "8888"].map((text) => {
      probe.textContent = text;
      return probe.getBoundingClientRect().width;
    });
    probe.remove();
    return found;
  });
  assert.equal(new Set(widths).size, 1, `${widths}`);
});

test("nothing moves when the fonts arrive late", async ({ server, page }) => {
  let release;
  const released = new Promise((resolve) => (release = resolve));
  await page.route("**/*.woff2", async (route) => {
    await released;
    await route.continue();
  });
  await page.goto(server.url, { waitUntil: "commit" });
  const heading = page.getByRole("heading", { name: w.sign_in.title });
  await heading.waitFor();
  const boxes = () =>
    page.evaluate(() => {
      const all = (root) =>
        [...root.querySelectorAll("*")].flatMap((each) => [
          each,
          ...(each.shadowRoot ? all(each.shadowRoot) : []),
        ]);
      return all(document)
        .filter((each) => each.matches("h1, h2, button, input, select, p, label"))
        .map((each) => each.getBoundingClientRect().y);
    });
  assert.deepEqual((await arrived(page)).length, 0, "a font has arrived already");
  const before = await boxes();
  await page.evaluate(() => {
    globalThis.shift = 0;
    new PerformanceObserver((list) => {
      for (const { value } of list.getEntries()) globalThis.shift += value;
    }).observe({ type: "layout-shift" });
  });
  release();
  assert_both(await loaded(page));
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
  const after = await boxes();
  const moves = after.map((y, index) => Math.abs(y - before[index]));
  console.log(`largest move ${Math.max(...moves)} px, shift ${await page.evaluate("shift")}`);
  assert.ok(Math.max(...moves) <= 1, `moves of ${moves} px`);
  assert.ok((await page.evaluate("shift")) <= kMostShift);
  await page.unroute("**/*.woff2");
});

test("the guide shows the same fonts", async ({ server, page }) => {
  await page.goto(`${server.url}/guide/get-started`);
  await page.getByRole("heading", { level: 1 }).waitFor();
  const { families } = await loaded(page);
  assert.ok(families.includes("Inter Variable") && families.includes("Source Serif 4 Variable"));
});

test("the notices name the fonts and their license", async ({ server }) => {
  const text = await (await fetch(`${server.url}/third-party-notices.txt`)).text();
  for (const name of ["@fontsource-variable/inter", "@fontsource-variable/source-serif-4"])
    assert.ok(text.includes(name), name);
  assert.ok(text.includes("SIL OPEN FONT LICENSE"));
});

ends_well({ complaints: ["/api/v1/me"] }); // no user has signed in
