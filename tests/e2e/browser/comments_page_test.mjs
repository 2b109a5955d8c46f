// Comments on the surface: written at a point, kept while unsent, immediately visible to others,
// answered, resolved, edited, deleted, and found in the panel and by their address. The tests use
// mouse, keyboard and touch. The model hides the pins behind it.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kExpected = ["status of 412", "status of 422"]; // responses that the test causes

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `${name}.png`) });
};
const button = ({ page }, name) => page.getByRole("button", { name, exact: true });
const card = ({ page }) => page.locator("strata-comment-card section");
const panel = ({ page }) => page.locator("strata-comment-panel");
const pins = ({ page }) => page.locator("strata-comment-pins button[data-comment]");
const pin = ({ page }, id) => page.locator(`strata-comment-pins button[data-comment="${id}"]`);
const article = (who, text) => card(who).locator("article", { hasText: text });
const gone = (locator) => locator.waitFor({ state: "detached" });
const comments = async () => (await server.json("GET", `${kBase}/comments?limit=1000`)).comments;
const comment_with = (text) =>
  wait_for(
    async () => (await comments()).find((comment) => comment.text.includes(text)),
    `a comment with ${text}`,
  );
const focused = ({ page }) =>
  page.evaluate(() => {
    let active = document.activeElement;
    while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
    return active?.getAttribute("data-comment") ?? active?.tagName.toLowerCase() ?? "";
  });

async function open_model(who) {
  await who.page.goto(`${server.url}/models/${id}`);
  await who.drawn();
}
async function click_at(who, x, y) {
  const box = await who.stage_box();
  await who.page.mouse.click(box.x + x * box.width, box.y + y * box.height);
}
let id;

let ada, bea, phone, server, model, first, fingerprint;

test.beforeAll(async () => {
  [ada, bea, phone] = [await Browser.open(), await Browser.open(), await Browser.open(kPhone)];
  server = new StrataServer({ demo: true });
  await server.start();
  for (const layer of (await server.json("GET", `${kBase}/layers`)).layers)
    await server.json("PATCH", `${kBase}/layers/${layer.id}`, { visible: false });
  await server.json("POST", `${kBase}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [{ name: "Name", required: true, unique: true }],
    palette: { mode: "categorical", points: [{ at: 1, color: "#2c6a63" }] },
  });
  await server.json("POST", "/tables/finds/records", { values: { name: "Handle" } });
  await server.json("POST", `${kBase}/layers/finds/edits`, {
    op: "fill",
    mode: "where",
    where: "true",
    value: 1,
  });
  // otherwise the page asks curators to confirm the scale
  model = await server.json("PATCH", kBase, { scale_verified: true });
  id = model.id;
  await ada.sign_in(server, await server.add_person("ada", "annotator"));
  await bea.sign_in(server, await server.add_person("bea", "annotator"));
  await phone.sign_in(server, await server.add_person("carl", "curator"));
});

test("a click with the tool begins a comment there, and one beside the model none", async () => {
  await open_model(ada);
  await open_model(bea);
  await ada.page.keyboard.press("c");
  assert.equal(await button(ada, words.tools.comment).getAttribute("aria-pressed"), "true");
  await click_at(ada, 0.04, 0.5);
  await ada.page.getByText(words.comments.missed).waitFor();
  await click_at(ada, 0.47, 0.62);
  await card(ada).getByRole("textbox", { name: words.comments.text }).waitFor();
  assert.equal(await focused(ada), "textarea");
  assert.equal(await button(ada, words.tools.comment).first().isDisabled(), false);
  assert.equal(
    await card(ada).getByRole("button", { name: words.comments.send, exact: true }).isDisabled(),
    true,
    "nothing is written yet",
  );
  await ada.page.keyboard.type(
    "Is this the crack of 2019?\nSee https://example.org/report (page 3).",
  );
  await card(ada).getByLabel(words.comments.about).selectOption({ label: "Handle (Finds)" });
  await shot(ada, "composer");
});

test("what is not sent outlives the card and the page, and is nobody else's", async () => {
  await ada.page.keyboard.press("Escape");
  await gone(card(ada));
  await ada.page.reload();
  await ada.drawn();
  await button(ada, words.comments.pin_draft).click();
  assert.match(
    await card(ada).getByRole("textbox", { name: words.comments.text }).inputValue(),
    /^Is this the crack of 2019\?\nSee/,
  );
  assert.equal((await comments()).length, 0);
  assert.equal(await pins(bea).count(), 0);
});

test("it is sent by the keyboard, and seen by others without asking", async () => {
  await card(ada).getByRole("textbox", { name: words.comments.text }).focus();
  await ada.page.keyboard.press("Control+Enter");
  await article(ada, "Is this the crack").waitFor();
  first = await comment_with("Is this the crack");
  assert.equal(first.record, 1);
  await pin(bea, first.id).waitFor();
  assert.match(
    await pin(bea, first.id).getAttribute("aria-label"),
    /^Comment by ada: unread: Is this the crack of 2019\? See/,
  );
  assert.equal(await button(ada, words.comments.pin_draft).count(), 0);
  assert.match(ada.page.url(), new RegExp(`#comment=${first.id}$`));
  const link = card(ada).getByRole("link", { name: "https://example.org/report", exact: true });
  assert.equal(await link.getAttribute("rel"), "noopener noreferrer nofollow");
  await card(ada).getByText(words.comments.about_is("Handle (Finds)")).waitFor();
  await shot(ada, "thread");
});

test("a reply with somebody's name reaches them", async () => {
  await pin(bea, first.id).click();
  await article(bea, "Is this the crack").waitFor();
  await wait_for(
    async () => !/unread/.test(await pin(bea, first.id).getAttribute("aria-label")),
    "the thread to be read",
  );
  await ada.page.keyboard.press("Escape");
  await gone(card(ada));
  await card(bea)
    .getByRole("textbox", { name: words.comments.reply_text })
    .fill("@ada yes, <b>it</b> has grown.\nMore in May.");
  await card(bea).getByRole("button", { name: words.comments.send_reply, exact: true }).click();
  await article(bea, "it has grown").or(article(bea, "has grown.")).first().waitFor();
  assert.equal(await card(bea).locator(".mention").innerText(), "@ada");
  await ada.page.getByText(words.comments.mentioned("bea")).waitFor();
  assert.match(await pin(ada, first.id).getAttribute("aria-label"), /unread/);
  await ada.page.getByRole("button", { name: words.comments.show, exact: true }).click();
  await article(ada, "<b>it</b> has grown.").waitFor();
  await shot(bea, "reply");
});

test("names are completed behind an @, by keys and by the mouse", async () => {
  const writing = card(bea).locator("textarea");
  const names = card(bea).getByRole("listbox", { name: words.comments.names });
  await writing.focus();
  await bea.page.keyboard.type("Ask @ca");
  await names.getByRole("option", { name: "carl" }).waitFor();
  await card(bea).getByRole("combobox", { name: words.comments.reply_text }).waitFor();
  assert.equal(await names.getByRole("option").count(), 1, "bea herself is not among them");
  await shot(bea, "names");
  await bea.page.keyboard.press("Escape");
  await gone(names);
  assert.equal(await writing.inputValue(), "Ask @ca", "the card stays open");
  await bea.page.keyboard.press("Backspace");
  await bea.page.keyboard.press("Backspace");
  await names.getByRole("option", { name: "owner" }).waitFor();
  assert.deepEqual(
    (await names.getByRole("option").allInnerTexts()).map((text) => text.trim().split("\n").at(-1)),
    ["ada", "carl", "owner"],
  );
  assert.equal(
    await names
      .getByRole("option", { selected: true })
      .innerText()
      .then((text) => text.split("\n").at(-1)),
    "ada",
  );
  await bea.page.keyboard.press("ArrowDown");
  assert.equal(
    await writing.getAttribute("aria-activedescendant"),
    await names.getByRole("option", { selected: true }).getAttribute("id"),
  );
  await bea.page.keyboard.press("Enter");
  await gone(names);
  assert.equal(await writing.inputValue(), "Ask @carl ");
  await bea.page.keyboard.type("and @o");
  await names.getByRole("option", { name: "owner" }).click();
  await gone(names);
  assert.equal(await writing.inputValue(), "Ask @carl and @owner ");
  assert.equal(await card(bea).getByRole("combobox").count(), 0, "it is a plain field again");
  await writing.fill("");
});

test("pins are hidden behind the surface: on the far side, and inside where the wall stands before them", async () => {
  await bea.page.keyboard.press("Escape");
  await bea.page.keyboard.press("c");
  await click_at(bea, 0.44, 0.42); // through the gap, on the inside of the far wall
  await card(bea).getByRole("textbox", { name: words.comments.text }).fill("Inside");
  await bea.page.keyboard.press("Control+Enter");
  const inside = await comment_with("Inside");
  await bea.page.keyboard.press("Escape");
  await pin(bea, inside.id).waitFor();
  await bea.page.keyboard.press("2");
  await gone(pin(bea, first.id));
  await gone(pin(bea, inside.id));
  await bea.page.keyboard.press("1"); // from the front, where the pin is visible
  await pin(bea, first.id).waitFor();
  await gone(pin(bea, inside.id));
  await server.request("DELETE", `/comments/${inside.id}`);
});

test("one who has the keyboard comes from the pin to the thread and back", async () => {
  await pin(bea, first.id).focus();
  await bea.page.keyboard.press("Enter");
  await article(bea, "Is this the crack").waitFor();
  await wait_for(async () => (await focused(bea)) === "section", "the card to have the keyboard");
  await bea.page.keyboard.press("Escape");
  await gone(card(bea));
  assert.equal(await focused(bea), String(first.id));
});

test("texts are edited by who wrote them, and others see it", async () => {
  await article(ada, "Is this the crack")
    .getByRole("button", { name: words.comments.edit })
    .click();
  assert.equal(
    await article(ada, "has grown").getByRole("button", { name: words.comments.edit }).count(),
    0,
  );
  await card(ada).locator(`textarea[name="edit ${first.id}"]`).fill("Is this the crack of 2020?");
  await card(ada).getByRole("button", { name: words.save }).click();
  await article(ada, "Is this the crack of 2020?")
    .getByText(/^edited/)
    .waitFor();
  await pin(bea, first.id).click();
  await article(bea, "Is this the crack of 2020?").waitFor();
});

test("of two who change one text at once the later is told", async () => {
  await article(ada, "of 2020?").getByRole("button", { name: words.comments.edit }).click();
  await card(ada).locator(`textarea[name="edit ${first.id}"]`).fill("Is this the crack of 2021?");
  await ada.page.route(`**/comments/${first.id}`, async (route) => {
    if (route.request().method() === "PATCH")
      await server.json("PATCH", `/comments/${first.id}`, { state: "open" });
    await route.continue();
  });
  await card(ada).getByRole("button", { name: words.save }).click();
  await card(ada)
    .getByRole("alert")
    .getByText(/changed this after you read it/i)
    .waitFor();
  await ada.page.unroute(`**/comments/${first.id}`);
  assert.equal(
    await card(ada).locator(`textarea[name="edit ${first.id}"]`).inputValue(),
    "Is this the crack of 2021?",
  );
  await card(ada).getByRole("button", { name: words.save }).click();
  await article(bea, "Is this the crack of 2021?").waitFor();
});

test("a thread is resolved by anybody who writes; its pin is shown only when asked for", async () => {
  await card(bea).getByRole("button", { name: words.comments.resolve }).click();
  await card(bea)
    .getByText(/^Resolved by bea/)
    .waitFor();
  await card(ada)
    .getByText(/^Resolved by bea/)
    .waitFor();
  await ada.page.keyboard.press("Escape");
  await gone(pin(ada, first.id));
  await open_tab(ada.page, words, words.comments.title);
  await panel(ada).getByText(words.comments.none_found).waitFor();
  await panel(ada).getByRole("radio", { name: words.comments.states.resolved }).click();
  await pin(ada, first.id).waitFor();
  await panel(ada).getByText("Is this the crack of 2021?").waitFor();
  await bea.page.keyboard.press("Escape");
});

test("the list finds threads by words, state and person, and goes to them", async () => {
  const height = model.bounds.max[2] - model.bounds.min[2];
  for (const [n, text] of ["Soot on the rim", "Old repair, see @bea", "Fingerprint"].entries()) {
    const [x, y, z] = first.position;
    // far enough apart for a finger
    const coords = encodeURIComponent(`POINT Z(${x} ${y} ${z + [-0.2, 0.18, -0.38][n] * height})`);
    const { position } = await server.json("GET", `${kBase}/position?coords=${coords}`);
    await server.json("POST", `${kBase}/comments`, { text, position });
  }
  await open_tab(bea.page, words, words.comments.title);
  const rows = panel(bea).locator("li button");
  await wait_for(async () => (await rows.count()) === 3, "three open threads");
  await bea.page.getByRole("tab", { name: words.comments.unread(3) }).waitFor();
  await panel(bea).getByRole("textbox", { name: words.comments.find }).fill("RIM owner");
  await wait_for(async () => (await rows.count()) === 1, "the one with these words");
  await panel(bea).getByRole("textbox", { name: words.comments.find }).fill("");
  await panel(bea).getByRole("button", { name: words.comments.mine }).click();
  await wait_for(async () => (await rows.count()) === 1, "the one that names bea");
  await panel(bea).getByRole("radio", { name: words.comments.states.all }).click();
  await wait_for(async () => (await rows.count()) === 2, "those with bea");
  await panel(bea).getByRole("button", { name: words.comments.mine }).click();
  await shot(bea, "panel");
  await bea.page.keyboard.press("2");
  await rows.filter({ hasText: "Fingerprint" }).click();
  await article(bea, "Fingerprint").waitFor();
  fingerprint = await comment_with("Fingerprint");
  await pin(bea, fingerprint.id).waitFor();
  await shot(bea, "flown");
  await panel(bea).getByRole("button", { name: words.comments.mark_all_read }).click();
  await gone(bea.page.getByRole("tab", { name: /unread/ }));
});

test("an address leads to its comment, also to a reply", async () => {
  const reply = await comment_with("has grown");
  await bea.page.goto(`${server.url}/`);
  await bea.page.goto(`${server.url}/models/${id}#comment=${reply.id}`);
  await article(bea, "has grown").waitFor();
  await pin(bea, first.id).waitFor();
  await Promise.all([
    bea.page.getByText(words.comments.missing).waitFor(),
    bea.page.goto(`${server.url}/models/${id}#comment=999999`),
  ]);
});

test("a first comment that is deleted leaves its place while there are replies", async () => {
  await pin(ada, first.id).click();
  await article(ada, "of 2021?").getByRole("button", { name: words.delete }).click();
  await ada.page.getByRole("button", { name: words.cancel }).click();
  await article(ada, "of 2021?").getByRole("button", { name: words.delete }).click();
  await ada.page.locator("strata-dialog").getByRole("button", { name: words.delete }).click();
  await card(ada).getByText(words.comments.deleted).waitFor();
  assert.equal(
    await article(ada, "has grown").getByRole("button", { name: words.delete }).count(),
    0,
    "it is bea's",
  );
  await card(ada).getByRole("button", { name: words.comments.reopen }).click();
  await gone(card(ada).getByText(/^Resolved by/));
  await panel(ada).getByRole("radio", { name: words.comments.states.open }).click();
  await shot(ada, "deleted");
});

test("on a phone the thread is a sheet, and a finger writes", async () => {
  await open_model(phone);
  const box = await phone.stage_box();
  await button(phone, words.tools.comment).click();
  await phone.page.touchscreen.tap(box.x + 0.35 * box.width, box.y + 0.62 * box.height);
  await card(phone).getByRole("textbox", { name: words.comments.text }).fill("Glaze?");
  await shot(phone, "phone_composer");
  await card(phone).getByRole("button", { name: words.comments.send, exact: true }).click();
  await article(phone, "Glaze?").waitFor();
  await shot(phone, "phone_thread");
});

test("what somebody says meanwhile is shown above the sheet", async () => {
  const { id: aside } = await server.json("POST", `${kBase}/comments`, {
    text: "@carl, see here",
    position: first.position,
  });
  const told = phone.page.locator("strata-notices .notice", {
    hasText: words.comments.mentioned("owner"),
  });
  await told.waitFor();
  await shot(phone, "phone_told");
  await wait_for(async () => {
    const [notice, sheet] = [await told.boundingBox(), await card(phone).boundingBox()];
    return notice.y + notice.height <= sheet.y;
  }, "the notice to be above the sheet");
  await told.getByRole("button", { name: words.close }).click();
  await server.request("DELETE", `/comments/${aside}`);
  await gone(pin(phone, aside));
  await button(phone, words.comments.close).click();
  await pin(phone, first.id).tap();
  await card(phone).getByText(words.comments.deleted).waitFor();
  await article(phone, "has grown").getByRole("button", { name: words.delete }).click();
  await phone.page.locator("strata-dialog").getByRole("button", { name: words.delete }).click();
  await gone(card(phone));
  await gone(pin(ada, first.id));
  await pin(ada, (await comment_with("Glaze?")).id).waitFor();
});

test("without a pointer a comment goes to the middle of the view", async () => {
  await ada.page.keyboard.press("Escape");
  await ada.page.locator("strata-stage .surface").focus();
  await ada.page.keyboard.press("c");
  await ada.page.keyboard.press("Enter");
  await card(ada).getByRole("textbox", { name: words.comments.text }).waitFor();
  await wait_for(
    async () => (await focused(ada)) === "textarea",
    "the composer to have the keyboard",
  );
  await ada.page.keyboard.type("In the middle");
  await card(ada).getByRole("button", { name: words.comments.give_up }).click();
  await gone(card(ada));
  assert.equal(await button(ada, words.comments.pin_draft).count(), 0);
});

test("pins let paint through, and can be hidden", async () => {
  await ada.page.keyboard.press("b");
  const pin_of_paint = pins(ada).first();
  assert.equal(await pin_of_paint.evaluate((each) => getComputedStyle(each).pointerEvents), "none");
  await ada.page.keyboard.press("v");
  await open_tab(ada.page, words, words.comments.title);
  await panel(ada).getByRole("button", { name: words.comments.hide_pins }).click();
  await wait_for(async () => (await pins(ada).count()) === 0, "the pins to go");
});

test("who only looks reads, and is not offered to write", async () => {
  await phone.page.context().clearCookies();
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  await open_model(phone);
  assert.equal(await button(phone, words.tools.comment).count(), 0);
  await pin(phone, fingerprint.id).tap();
  await article(phone, "Fingerprint").waitFor();
  assert.equal(await card(phone).getByRole("textbox").count(), 0);
  assert.equal(
    await card(phone)
      .getByRole("button", { name: /Resolve|Edit|Delete/ })
      .count(),
    0,
  );
  await shot(phone, "phone_viewer");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [ada, bea, phone]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, bea, phone]) await who?.close();
  await server?.remove();
});
