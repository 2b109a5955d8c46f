// Two pages paint behind nginx while the node of their model is killed, and one of them while it is
// stopped. The pages continue at another node, and nothing is lost.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { NodeSite } from "../support/js/nodes.mjs";
import { kLong_ms, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";
import { unsaved_ids } from "../support/js/unsaved.mjs";

const kModel = "demo-pot";
const words = texts_of("en");
// nginx sends these responses for a node that has ended
const kOfLostNode = [...kOfLostServer, "502", "503", "504"];

const history = async () =>
  (await site.json("GET", `/models/${kModel}/layers/marks/edits?limit=1000`)).edits;

const kept = (of = page) => unsaved_ids(of);

/** Waits until a page shows the newest edit. */
const shows_all = async (of) => {
  const newest = Math.max(...(await history()).map(({ sequence }) => sequence));
  const canvas = of.page.locator("strata-stage canvas").first();
  await wait_for(
    async () => Number(await canvas.evaluate(({ dataset }) => dataset.sceneSequence)) >= newest,
    "a picture with the newest edit",
  );
};

async function shot(name) {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
}

/** Draws a stroke slowly. Calls `midway` while the pointer is down. */
async function drag_slowly(y, midway) {
  const box = await browser.stage_box();
  const at = (x) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(0.4));
  await page.mouse.down();
  await page.mouse.move(...at(0.48), { steps: 6 });
  await midway();
  await page.mouse.move(...at(0.6), { steps: 6 });
  await page.mouse.up();
}

/** Checks that all these edits are in the journal once, and that there is no gap. */
async function check_journal(ids) {
  const rows = await history();
  const all = rows.map(({ id }) => id);
  assert.equal(new Set(all).size, all.length, "an edit is there twice");
  assert.deepEqual(
    ids.filter((id) => !all.includes(id)),
    [],
    "a part of a stroke is lost",
  );
}

let browser, other, site, page;
const sockets = [];
const painted = new Set();

test.beforeAll(async () => {
  test.setTimeout(5 * kLong_ms);
  browser = await Browser.open();
  site = new NodeSite({ demo: true });
  ({ page } = browser);
  page.on("websocket", (socket) => sockets.push(socket.url()));
  await site.start();
  await site.json("POST", `/models/${kModel}/layers`, { name: "Marks", type: "u8" });
  other = await Browser.open();
  for (const [each, secret] of [
    [browser, site.token],
    [other, await site.add_person("ben", "annotator")],
  ]) {
    await each.sign_in(site, secret);
    await each.page.goto(`${site.url}/models/${kModel}`);
    await each.drawn();
    await each.page.getByRole("button", { name: words.layers.select("Marks") }).click();
    await each.page.keyboard.press("b");
  }
});

test("the page paints at the node that nginx chooses", async () => {
  await browser.drag([
    [0.4, 0.4],
    [0.6, 0.4],
  ]);
  await browser.saved();
  for (const { id } of await history()) painted.add(id);
  assert.ok(painted.size > 0, "nothing was painted");
  const { nodes } = await site.json("GET", "/nodes");
  assert.deepEqual(
    nodes.map(({ url }) => url).sort(),
    ["a", "b", "c"].map((name) => `${site.url}/node/${name}`),
  );
});

test("the node is killed during a stroke: both pages continue at another node", async () => {
  const before = await site.command("owner", kModel);
  const edits_before = (await history()).length;
  let begun = 0;
  await drag_slowly(0.5, async () => {
    // Starts to wait for the banner before the node is killed, because the page can reconnect very
    // soon.
    const lost = [browser, other].map((each) => each.page.locator(".banner").waitFor());
    await site.command("kill_owner", kModel);
    begun = Date.now();
    await Promise.all(lost);
  });
  for (const id of await kept()) painted.add(id);
  await shot("nodes_killed");
  for (const each of [browser, other]) {
    await each.page.locator(".banner").waitFor({ state: "detached" });
    await each.saved();
  }
  console.log(`killed: all is saved after ${(Date.now() - begun) / 1000} s`);
  await wait_for(async () => (await kept()).length === 0, "all to be saved");
  const of_both = (await history()).length;
  await other.drag([
    [0.4, 0.45],
    [0.6, 0.45],
  ]);
  await wait_for(async () => (await history()).length > of_both, "the stroke of the other page");
  await other.saved();
  assert.deepEqual(await kept(other.page), []);
  for (const each of [browser, other]) await shows_all(each);
  assert.ok((await history()).length > edits_before, "the stroke is lost");
  await check_journal([...painted]);
  assert.notEqual((await site.command("owner", kModel)).url, before.url);
  await browser.drag([
    [0.45, 0.3],
    [0.55, 0.3],
  ]);
  await browser.saved();
  await browser.drawn();
  await shot("nodes_went_on");
  for (const { id } of await history()) painted.add(id);
  await site.command("start");
});

test("the node is stopped during a stroke: the page follows the model at once", async () => {
  const before = await site.command("owner", kModel);
  const opened = sockets.length;
  let stopped;
  await drag_slowly(0.6, async () => {
    const begun = Date.now();
    stopped = site.command("stop_owner", kModel);
    await wait_for(() => sockets.length > opened, "another connection");
    console.log(`stopped: the page connects again after ${(Date.now() - begun) / 1000} s`);
  });
  assert.equal((await stopped).status, 0);
  await page.locator(".banner").waitFor({ state: "detached" });
  await browser.saved();
  const node = sockets[opened].replace("ws:", "http:");
  assert.ok(node.startsWith(`${site.url}/node/`), `the page went to ${node}`);
  assert.ok(!node.startsWith(before.url), "the page went to the node that stops");
  await wait_for(async () => (await kept()).length === 0, "all to be saved");
  await check_journal([...painted]);
});

test("administrators see the nodes, and the page has nothing else to complain of", async () => {
  await site.command("start");
  await page.goto(site.url);
  await page.getByRole("button", { name: /^Account of / }).click();
  await page.getByRole("menuitem", { name: words.account.nodes, exact: true }).click();
  const dialog = page.locator("strata-nodes-dialog");
  await dialog.getByText("/node/a").first().waitFor();
  await dialog.getByText(words.nodes.states.ready).first().waitFor();
  await shot("nodes_dialog");
  for (const each of [browser, other]) each.assert_no_complaints(kOfLostNode);
  const { statuses } = await site.command("stop");
  assert.deepEqual([...new Set(statuses)], [0]);
});

test.afterEach(({}, info) => attach_log(info, site));
test.afterAll(async () => {
  for (const each of [browser, other]) await each?.close();
  await site?.remove();
});
