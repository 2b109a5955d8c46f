// The activity of a model in the side panel: its days, new lines of others, earlier lines on
// request, and the target of a line.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const panel = ({ page }) => page.locator("strata-activity-panel");
const line = (who, text) => panel(who).locator("[data-activity]", { hasText: text });
/** Sends a request as a user other than the owner. */
const post = async ({ token }, path, body) => {
  const headers = { Authorization: `Bearer ${token}`, "Content-Type": "application/json" };
  const answer = await fetch(`${server.url}/api/v1${path}`, {
    method: "POST",
    headers,
    body: JSON.stringify(body),
  });
  assert.ok(answer.ok, `POST ${path}: ${answer.status}`);
  return answer.json();
};

let ada, phone, server, bea, id, bounds, place, thread;

test.beforeAll(async () => {
  [ada, phone] = [await Browser.open(), await Browser.open(kPhone)];
  server = new StrataServer({ demo: true });
  await server.start();
  bea = await server.add_person("bea", "annotator");
  await server.json("POST", `${kBase}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name", required: true, unique: true }],
    palette: { mode: "categorical", points: [{ at: 1, color: "#2c6a63" }] },
  });
  await server.json("POST", "/tables/finds/records", { values: { name: "Handle" } });
  ({ id, bounds } = await server.json("PATCH", kBase, {
    scale_verified: true,
    credit: "A museum",
  }));
  place = [bounds.max[0], (bounds.min[1] + bounds.max[1]) / 2, (bounds.min[2] + bounds.max[2]) / 2];
  await ada.sign_in(server, await server.add_person("ada", "curator"));
  await phone.sign_in(server, await server.add_person("carl", "viewer"));
});

test("the panel tells what was done, the newest first", async () => {
  await ada.page.goto(`${server.url}/models/${id}`);
  await ada.drawn();
  await open_tab(ada.page, words, words.activity.title);
  await panel(ada).getByRole("heading", { name: "today" }).waitFor();
  await line(ada, "changed the model").waitFor();
  await line(ada, "Handle").waitFor();
  const first = await panel(ada).locator("[data-activity]").first().textContent();
  assert.match(first, /changed the model/);
});

test("what others do comes by itself, a line for what is done in one go", async () => {
  for (let i = 0; i < 3; ++i)
    await post(bea, `${kBase}/layers/finds/edits`, {
      op: "fill",
      mode: "where",
      where: "true",
      value: 1,
    });
  await line(ada, "3 times").waitFor();
  assert.match(await line(ada, "3 times").textContent(), /bea\s*filled in Finds/);
  thread = await post(bea, `${kBase}/comments`, {
    text: "Is this the rim?",
    position: place,
  });
  await line(ada, "Is this the rim?").waitFor();
  await shot(ada, "activity");
});

test("a line leads to its comment, record or layer", async () => {
  await line(ada, "Is this the rim?").click();
  await ada.page.locator("strata-comment-card section", { hasText: "Is this the rim?" }).waitFor();
  assert.match(ada.page.url(), new RegExp(`#comment=${thread.id}$`));
  await ada.page.keyboard.press("Escape");
  await line(ada, "Handle").click();
  await ada.page.locator("strata-table-panel").getByText("Handle").first().waitFor();
  await shot(ada, "activity_record");
});

test("earlier lines are shown when asked for, and those of the whole project", async () => {
  for (let i = 0; i < 60; ++i)
    await post(bea, `${kBase}/comments`, { text: `Note ${i}`, position: place });
  await line(ada, "Note 59").waitFor();
  await ada.page.reload();
  await ada.drawn();
  await line(ada, "Note 59").waitFor();
  assert.equal(await line(ada, "filled in Finds").count(), 0);
  await panel(ada).getByRole("button", { name: words.activity.more }).click();
  await line(ada, "filled in").first().waitFor();
  await panel(ada).getByRole("radio", { name: words.activity.of_project }).click();
  await line(ada, "Note 59").waitFor();
});

test("it can be read and used on a phone", async () => {
  await phone.page.goto(`${server.url}/models/${id}`);
  await phone.drawn();
  await open_tab(phone.page, words, words.activity.title);
  await line(phone, "Note 59").scrollIntoViewIfNeeded();
  await shot(phone, "activity_phone");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [ada, phone]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, phone]) await who?.close();
  await server?.remove();
});
