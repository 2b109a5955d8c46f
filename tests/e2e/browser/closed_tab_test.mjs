// A tab is closed or crashes with unsaved edits. Closing it shows a warning. The next page of the
// same user sends the edits, once.
import assert from "node:assert/strict";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { kLong_ms, StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";
import { unsaved_ids } from "../support/js/unsaved.mjs";

const words = texts_of("en");

const kept = (wanted) => unsaved_ids(page, wanted);
const history = async () =>
  (await server.json("GET", "/models/demo-pot/layers/marks/edits?limit=1000")).edits;
const ids = async () => (await history()).map(({ id }) => id);

async function open_model() {
  await page.goto(`${server.url}/models/demo-pot`);
  await browser.drawn();
  await page.getByRole("button", { name: words.layers.select("Marks") }).click();
  await page.keyboard.press("b");
}

/** Paints while the server is stopped. Returns the messages that the browser stores. */
async function paint_unheard(y) {
  await server.signal("SIGSTOP");
  await browser.drag([
    [0.4, y],
    [0.6, y],
  ]);
  await page.locator('.saving:not([data-state="saved"])').waitFor();
  await wait_for(
    async () => (await kept("stroke.end")).length > 0,
    "the browser to keep what is not saved",
  );
  return kept();
}

/** Crashes the tab and opens another one. */
async function tab_dies() {
  const crashed = page.waitForEvent("crash");
  (await browser.context.newCDPSession(page)).send("Page.crash").catch(() => {});
  await crashed;
  browser.page = page = await browser.context.newPage();
  page.setDefaultTimeout(kLong_ms);
}

let browser, server, page, ada, bea, before, left, hers;

test.beforeAll(async () => {
  browser = await Browser.open();
  server = new StrataServer({ demo: true });
  ({ page } = browser);
  await server.start();
  ada = await server.add_person("ada", "curator");
  bea = await server.add_person("bea", "annotator");
  await server.json("POST", "/models/demo-pot/layers", { name: "Marks", type: "u8" });
  await browser.sign_in(server, ada);
  await open_model();
});

test("closing warns while something is not saved, and only then", async () => {
  const asked = [];
  page.on("dialog", (dialog) => (asked.push(dialog.type()), dialog.dismiss()));
  await browser.drag([
    [0.4, 0.4],
    [0.6, 0.4],
  ]);
  await browser.saved();
  await wait_for(
    async () => (await kept()).length === 0,
    "the browser to keep nothing that is saved",
  );
  before = await ids();
  assert.ok(before.length > 0, "nothing was painted");
  left = await paint_unheard(0.5);
  await page.close({ runBeforeUnload: true });
  await wait_for(() => asked.length > 0, "the question whether to leave");
  assert.deepEqual([asked, page.isClosed()], [["beforeunload"], false]);
});

test("the tab dies, and the server with what it had not read", async () => {
  await tab_dies();
  await server.signal("SIGKILL");
  await server.start();
  assert.deepEqual(
    await ids(),
    before,
    "the server knew what it was not to know: this test shows nothing",
  );
});

test("somebody else at the same browser sends nothing of it", async () => {
  await browser.sign_in(server, bea);
  await open_model();
  await browser.drag([
    [0.45, 0.7],
    [0.55, 0.7],
  ]);
  await browser.saved();
  hers = await history();
  assert.deepEqual(
    [...new Set(hers.slice(0, hers.length - before.length).map(({ user }) => user))],
    ["bea"],
  );
  assert.deepEqual(await kept(), left);
});

test("who painted it comes back: it is sent, in their name, once", async () => {
  await browser.sign_in(server, ada);
  await open_model();
  await page.getByText(/earlier changes? (was|were) sent again/).waitFor();
  await browser.saved();
  await wait_for(async () => (await kept()).length === 0, "all to be saved");
  const now = await history();
  assert.deepEqual(
    now
      .slice(0, now.length - hers.length)
      .map(({ id, user }) => `${id} ${user}`)
      .reverse(),
    left.map((id) => `${id} ada`),
  );
});

test("a tab that is closed in mid-stroke, of which the server read all: nothing is painted twice, and the stroke ends", async () => {
  await page.mouse.move(0, 0);
  await server.signal("SIGSTOP");
  const box = await browser.stage_box();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.6 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.6 * box.height, { steps: 6 });
  left = await wait_for(
    async () => ((await kept()).length > 1 ? kept() : null),
    "the browser to keep the stroke",
  );
  await tab_dies();
  await server.signal("SIGCONT");
  await open_model();
  await wait_for(async () => (await kept()).length === 0, "all to be saved");
  await browser.drag([
    [0.45, 0.3],
    [0.55, 0.3],
  ]);
  await browser.saved();
  const all = await ids();
  assert.equal(new Set(all).size, all.length, "an edit is there twice");
  assert.deepEqual(
    left.filter((id) => !all.includes(id)),
    [],
    "a part of the stroke is lost",
  );

  browser.assert_no_complaints(kOfLostServer);
  assert.equal(await server.signal("SIGTERM"), 0);
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await browser?.close();
  await server?.remove();
});
