// Tours on the page: made from saved views, translated, reordered, and tested on the model. Another
// user's simultaneous change and the server's refusals are shown at the right position and lose no
// input. Links for kiosks are shown once, reloaded on request, and revoked. The tests also use a
// phone. Only curators have these controls.
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
// responses that the test causes
const kExpected = ["status of 412", "status of 422", "status of 404"];

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `tours_${name}.png`) });
};
const exact = (name) => ({ name, exact: true });
const list = ({ page }) => page.locator("strata-tour-list");
const row = (who, name) => list(who).locator("li", { hasText: name });
const editor = ({ page }) => page.locator("strata-tour-dialog");
const stops = (who) => editor(who).locator("strata-tour-stops");
const fields = (who) => editor(who).locator("strata-tour-stop-fields");
const trial = (who) => editor(who).locator("strata-tour-trial");
const kiosks = ({ page }) => page.locator("strata-kiosks-dialog");
const button = (where, name) => where.getByRole("button", exact(name));
const gone = (locator) => locator.waitFor({ state: "detached" });
const titles = async (who) =>
  (await stops(who).locator("li b").allTextContents()).map((text) => text.trim());
const tours = async () => (await server.json("GET", `${kBase}/tours`)).tours;
const tour = (slug) => server.json("GET", `${kBase}/tours/${slug}`);
const choose_stop = (who, title) => stops(who).locator("button.stop", { hasText: title }).click();
const of_stop = async (who, title, item) => {
  await stops(who)
    .getByRole("button", exact(`Options for ${title}`))
    .click();
  await stops(who).getByRole("menuitem", exact(item)).click();
};
const from_menu = async (who, name, item) => {
  await row(who, name)
    .getByRole("button", exact(`Options for ${name}`))
    .click();
  await row(who, name).getByRole("menuitem", exact(item)).click();
};
const save = (who) => button(editor(who), words.save).click();
const refused = (who, text) => editor(who).getByRole("alert").getByText(text).waitFor();
const question = ({ page }) => page.locator("strata-question");
const listed = ({ page }) => page.getByRole("link", { name: /Demo pot/ });
const path_of = ({ page }) => new URL(page.url()).pathname;
const home = ({ page }) => page.getByRole("link", exact(words.model.back)).click();
/** Goes back in the history, and waits until the page has received the event. */
const back = ({ page }) =>
  page.evaluate(() =>
    new Promise((resolve) => {
      addEventListener("popstate", resolve, { once: true });
      history.back();
    }).then(() => {}),
  );
const from_account = async (who, item) => {
  await button(who.page, words.account.menu("ada")).click();
  await who.page.getByRole("menuitem", exact(item)).click();
};

async function open_model(who) {
  await listed(who).click(); // the history then leads back to the list
  await who.drawn();
}
async function open_panel(who) {
  await who.page.goto(server.url);
  await open_model(who);
  await open_tab(who.page, words, words.view.title);
  await who.page.locator("strata-view-list").waitFor();
}
async function keep_view(who, name, keys) {
  await who.page.locator("strata-stage .surface").focus();
  for (const key of keys) await who.page.keyboard.press(key);
  await button(who.page.locator("strata-view-list"), words.kept_views.keep).click();
  const dialog = who.page.locator("strata-view-dialog");
  await dialog.getByLabel(words.kept_views.name).fill(name);
  await button(dialog, words.kept_views.keep_yes).click();
  await gone(dialog);
}
let id;

let ada, bea, phone, server, layers, again, link;

test.beforeAll(async () => {
  [ada, bea, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ ...kPhone, colorScheme: "dark" }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  // otherwise the page asks curators to confirm the scale
  id = (await server.json("PATCH", kBase, { scale_verified: true })).id;
  layers = (await server.json("GET", `${kBase}/layers`)).layers;
  const { project } = await server.json("GET", kBase);
  const columns = [
    { name: "Name", kind: "text", required: true },
    { name: "State", kind: "text" },
  ];
  const pieces = await server.json("POST", `/projects/${project}/tables`, {
    name: "Pieces",
    columns,
  });
  for (const name of ["Handle", "Rim"])
    await server.json("POST", `/tables/${pieces.id}/records`, { values: { name, state: "whole" } });
  await ada.sign_in(server, await server.add_person("ada", "curator"));
  await bea.sign_in(server, await server.add_person("bea", "annotator"));
  await phone.sign_in(server, await server.add_person("cleo", "curator"));
});

test("a tour needs views, and says how they are had", async () => {
  await open_panel(ada);
  await list(ada).getByText(words.tours.none).waitFor();
  await button(list(ada), words.tours.new).click();
  await editor(ada).getByText(words.tours.no_views).waitFor();
  await shot(ada, "no_views");
  await button(editor(ada), words.cancel).click(); // without changes the page asks no question
  await gone(editor(ada));
  await keep_view(ada, "West wall", ["4"]);
  await keep_view(ada, "From above", ["7"]);
  await keep_view(ada, "The handle", ["1", "ArrowLeft"]);
});

test("it is made of views, and what it lacks is told at its field", async () => {
  await button(list(ada), words.tours.new).click();
  await button(stops(ada), words.tours.add).waitFor();
  await save(ada);
  await refused(ada, words.tours.wrong.name_missing);
  await editor(ada).getByLabel(words.tours.name, { exact: true }).fill("Around the pot");
  await save(ada);
  await refused(ada, words.tours.wrong.stops_missing);
  for (const [index, name] of ["West wall", "From above", "The handle"].entries()) {
    await button(stops(ada), words.tours.add).click();
    await stops(ada)
      .locator("li b")
      .nth(index)
      .getByText(`${index + 1}. ${name}`)
      .waitFor();
  }
  await fields(ada).getByLabel(words.tours.stop_title, { exact: true }).fill("");
  await save(ada);
  await refused(ada, words.tours.wrong.title_missing);
  await wait_for(
    () =>
      fields(ada)
        .getByLabel(words.tours.stop_title, { exact: true })
        .evaluate((input) => input.getRootNode().activeElement === input),
    "the title to have the focus",
  );
  await fields(ada).getByLabel(words.tours.stop_title, { exact: true }).fill("The handle");
  await fields(ada)
    .getByLabel(words.tours.stop_text, { exact: true })
    .fill("Made apart, and set on when the wall was dry.");
  await fields(ada).getByLabel(words.tours.attract).fill("0");
  await save(ada);
  await refused(ada, words.tours.wrong_seconds(1, 600));
  await shot(ada, "refused");
  await fields(ada).getByLabel(words.tours.attract).fill("12.5");
  await editor(ada).getByLabel(words.tours.idle).fill("90");
});

test("layers and records are chosen in an order, with columns that are called otherwise", async () => {
  await fields(ada)
    .getByRole("combobox", exact(words.tours.layer_add))
    .selectOption({ label: layers[0].name });
  await button(fields(ada), words.tours.layer_add).click();
  await button(fields(ada), words.tours.layer_add).click();
  await fields(ada)
    .getByRole("list", exact(words.tours.swipe))
    .getByRole("button", { name: /^Move .* up$/ })
    .last()
    .click();
  await button(fields(ada), words.tours.table_add).click();
  await fields(ada).getByRole("combobox", exact("Records of Pieces")).fill("Rim");
  await fields(ada).getByRole("option", { name: "Rim" }).click();
  await ada.page.keyboard.press("Tab");
  await fields(ada)
    .getByRole("combobox", exact(words.tours.column_add))
    .selectOption({ label: "State" });
  await button(fields(ada), words.tours.column_add).click();
  await fields(ada)
    .getByLabel(/^Label of State on the card/)
    .fill("Condition");
  await shot(ada, "things");
  await save(ada);
  await gone(editor(ada));
  await row(ada, "Around the pot").getByText(words.tours.about(3, "en")).waitFor();
  const made = await tour("around-the-pot");
  assert.deepEqual(
    [made.languages, made.idle_s, made.stops.map(({ view }) => view)],
    [["en"], 90, ["west-wall", "from-above", "the-handle"]],
  );
  const last = made.stops[2];
  assert.equal(last.attract_s, 12.5);
  assert.equal(last.layers.length, 2);
  assert.equal(last.layers[1], layers[0].slug);
  assert.deepEqual(last.records, [
    { table: "pieces", keys: [2], columns: [{ column: "state", labels: { en: "Condition" } }] },
  ]);
});

test("stops are put in another order, taken out and brought back", async () => {
  await row(ada, "Around the pot").locator("button.open").click();
  await stops(ada).locator("li").nth(2).waitFor();
  await of_stop(ada, "The handle", words.layers.up);
  assert.deepEqual(await titles(ada), ["1. West wall", "2. The handle", "3. From above"]);
  await stops(ada)
    .locator("li .grip")
    .nth(2)
    .dragTo(stops(ada).locator("li").nth(0), { targetPosition: { x: 60, y: 6 } });
  assert.deepEqual(await titles(ada), ["1. From above", "2. West wall", "3. The handle"]);
  await of_stop(ada, "West wall", words.tours.remove);
  assert.deepEqual(await titles(ada), ["1. From above", "2. The handle"]);
  await stops(ada).getByText(words.tours.removed("West wall")).waitFor();
  await shot(ada, "removed");
  await button(stops(ada), words.model.undo).click();
  assert.deepEqual(await titles(ada), ["1. From above", "2. West wall", "3. The handle"]);
});

test("it is translated, and what lacks is marked", async () => {
  await editor(ada)
    .getByRole("combobox", exact(words.tours.language_add))
    .selectOption({ label: "Spanish" });
  await button(editor(ada).locator("strata-tour-languages"), words.tours.language_add).click();
  await stops(ada)
    .locator("li", { hasText: "From above" })
    .getByText(words.tours.missing("Spanish"))
    .waitFor();
  await choose_stop(ada, "The handle");
  await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).fill("El asa");
  await fields(ada).getByText(words.tours.lacks).waitFor(); // the text is still missing
  await fields(ada).getByLabel(words.tours.stop_text_in("Spanish")).fill("Hecha aparte.");
  await gone(
    stops(ada).locator("li", { hasText: "The handle" }).getByText(words.tours.missing("Spanish")),
  );
  await fields(ada).getByLabel(words.tours.column_label("State", "Spanish")).fill("Estado");
  await editor(ada)
    .getByRole("combobox", exact(words.tours.language_add))
    .selectOption({ label: "German" });
  await button(editor(ada).locator("strata-tour-languages"), words.tours.language_add).click();
  await fields(ada).getByLabel(words.tours.stop_title_in("German")).fill("Der Henkel");
  await fields(ada).getByRole("radio", { name: "Spanish" }).click();
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
  await shot(ada, "translated");
  for (const [width, height, name] of [
    [820, 1180, "tablet"],
    [390, 844, "narrow"],
  ]) {
    await ada.page.setViewportSize({ width, height });
    await shot(ada, name);
  }
  await ada.page.setViewportSize({ width: 1280, height: 800 });
  await button(editor(ada), words.tours.language_remove("German")).click();
  await button(question(ada), words.cancel).click();
  assert.equal((await fields(ada).getByRole("radio").count()) > 0, true);
  await button(editor(ada), words.tours.language_remove("German")).click();
  await button(question(ada), words.tours.language_remove_yes).click();
  await gone(button(editor(ada), words.tours.language_remove("German")));
});

test("a stop is tried on the model, and the editor comes back as it was left", async () => {
  await button(fields(ada), words.tours.try_stop).click();
  await trial(ada).getByText("Made apart, and set on when the wall was dry.").waitFor();
  await wait_for(
    async () =>
      (
        await ada.page
          .locator('strata-view-list button.go[aria-current="true"]')
          .textContent()
          .catch(() => "")
      ).includes("The handle"),
    "the stop's view",
    400,
  );
  await shot(ada, "trial");
  await button(trial(ada), words.tours.stop_before).click();
  await trial(ada).getByText("2. West wall").waitFor();
  await ada.page.keyboard.press("Escape");
  await choose_stop(ada, "The handle");
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
});

test("closing with changes asks, by Escape, too, and again", async () => {
  await ada.page.keyboard.press("Escape");
  await shot(ada, "leave");
  await button(question(ada), words.cancel).click();
  await gone(question(ada));
  await button(editor(ada), words.close).click();
  await ada.page.keyboard.press("Escape"); // Escape means no
  await gone(question(ada));
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
});

test("leaving the page asks as well while a stop is tried: by its links, back, signing out and loading it anew", async () => {
  await button(fields(ada), words.tours.try_stop).click();
  const ways = { home, back, sign_out: (who) => from_account(who, "Sign out") };
  for (const [name, leave] of Object.entries(ways)) {
    await leave(ada);
    await question(ada).getByText(words.tours.leave_lead).waitFor();
    await shot(ada, `leave_by_${name}`);
    await button(question(ada), words.cancel).click();
    await gone(question(ada));
    assert.equal(path_of(ada), `/models/${id}`, name);
    await trial(ada).getByText("3. The handle").waitFor();
  }
  const [asked] = await Promise.all([
    ada.page.waitForEvent("dialog"),
    ada.page.evaluate(() => void setTimeout(() => location.reload())),
  ]);
  assert.equal(asked.type(), "beforeunload");
  await asked.dismiss();
  await button(trial(ada), words.tours.trial_end).click();
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
  await back(ada); // also for navigation outside the editor
  await question(ada).getByText(words.tours.leave_lead).waitFor();
  await back(ada);
  assert.equal(await question(ada).count(), 1);
  await button(question(ada), words.cancel).click();
  await gone(question(ada));
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
});

test("what somebody else saved meanwhile is told, and nothing is lost", async () => {
  await server.json("PATCH", `${kBase}/tours/around-the-pot`, { name: "Twice around" });
  await save(ada);
  await refused(ada, words.tours.conflict);
  await shot(ada, "conflict");
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("Spanish")).inputValue(),
    "El asa",
  );
  await save(ada);
  await gone(editor(ada));
  again = await tour("around-the-pot");
  assert.deepEqual(
    [again.name, again.languages, again.stops.map(({ view }) => view)],
    ["Around the pot", ["en", "es"], ["from-above", "west-wall", "the-handle"]],
  );
  assert.deepEqual(again.stops[2].title, { en: "The handle", es: "El asa" });
  assert.deepEqual(again.stops[2].records[0].columns, [
    { column: "state", labels: { en: "Condition", es: "Estado" } },
  ]);
});

test("who says yes is where they wanted to be, and without changes nothing is asked", async () => {
  for (const leave of [home, back]) {
    await row(ada, "Around the pot").locator("button.open").click();
    await editor(ada).getByLabel(words.tours.name, { exact: true }).fill("Never saved");
    await button(fields(ada), words.tours.try_stop).click();
    await leave(ada);
    await button(question(ada), words.tours.leave_yes).click();
    await listed(ada).waitFor();
    await gone(question(ada));
    assert.match(path_of(ada), /^\/(projects\/[^/]+)?$/);
    await open_model(ada);
    await row(ada, "Around the pot").locator("button.open").click();
    await button(fields(ada), words.tours.try_stop).click();
    await leave(ada);
    await listed(ada).waitFor();
    assert.equal(await question(ada).count(), 0);
    await open_model(ada);
  }
  assert.equal((await tour("around-the-pot")).name, "Around the pot");
});

test("what the server refuses is said at its field of the right stop", async () => {
  await row(ada, "Around the pot").locator("button.open").click();
  await choose_stop(ada, "From above");
  await fields(ada).getByLabel(words.tours.stop_title_in("English")).fill("Above");
  await ada.page.route(`**/tours/${again.id}`, async (route) => {
    if (route.request().method() !== "PATCH") return route.continue();
    const body = JSON.parse(route.request().postData());
    body.stops[2].layers.push("ghost"); // a layer that another user has just deleted
    return route.continue({ postData: JSON.stringify(body) });
  });
  await save(ada);
  await wait_for(
    async () =>
      (await fields(ada).getByLabel(words.tours.stop_title_in("English")).inputValue()) ===
      "The handle",
    "the stop that was refused",
  );
  await fields(ada).getByRole("alert").waitFor();
  await shot(ada, "server_refusal");
  await ada.page.unroute(`**/tours/${again.id}`);
  await ada.page.route(`**/tours/${again.id}`, async (route) => {
    if (route.request().method() !== "PATCH") return route.continue();
    const body = JSON.parse(route.request().postData());
    body.stops[1].title.es = "x".repeat(201);
    return route.continue({ postData: JSON.stringify(body) });
  });
  await save(ada);
  await wait_for(
    async () =>
      (await fields(ada)
        .getByLabel(words.tours.stop_title_in("Spanish"))
        .getAttribute("aria-invalid")) === "true",
    "the title in Spanish to be refused",
  );
  assert.equal(
    await fields(ada).getByLabel(words.tours.stop_title_in("English")).inputValue(),
    "West wall",
  );
  await ada.page.unroute(`**/tours/${again.id}`);
});

test("a stop whose view is gone is marked, and says what to do", async () => {
  const views = (await server.json("GET", `${kBase}/views`)).views;
  await server.request(
    "DELETE",
    `${kBase}/views/${views.find(({ slug }) => slug === "west-wall").id}`,
  );
  await stops(ada)
    .locator("li", { hasText: "West wall" })
    .getByText(words.tours.view_gone_short)
    .waitFor();
  await fields(ada)
    .getByText(/^The view of this stop was deleted/)
    .waitFor();
  await shot(ada, "view_gone");
  await fields(ada)
    .getByRole("combobox", exact(words.tours.view))
    .selectOption({ label: "From above" });
  await save(ada);
  await gone(editor(ada));
  assert.deepEqual(
    (await tour("around-the-pot")).stops.map(({ view }) => view),
    ["from-above", "from-above", "the-handle"],
  );
});

test("a link for a kiosk is made, and shown once", async () => {
  await from_menu(ada, "Around the pot", words.kiosks.of_tour);
  await kiosks(ada).getByText(words.kiosks.none_of).waitFor();
  await button(kiosks(ada), words.kiosks.new).click();
  await button(kiosks(ada), words.kiosks.make).click();
  await kiosks(ada).getByText(words.kiosks.name_missing).waitFor();
  await kiosks(ada).getByLabel(words.kiosks.name).fill("Entrance hall");
  await kiosks(ada).getByLabel(words.kiosks.days).fill("4000");
  await button(kiosks(ada), words.kiosks.make).click();
  await kiosks(ada)
    .getByText(/^Enter a whole number of days/)
    .waitFor();
  await kiosks(ada).getByLabel(words.kiosks.days).fill("30");
  await button(kiosks(ada), words.kiosks.make).click();
  const link_field = kiosks(ada).getByLabel(words.kiosks.link("Entrance hall"));
  link = await link_field.inputValue();
  assert.ok(
    await link_field.evaluate((field) => field === field.getRootNode().activeElement),
    "the keyboard is where the form was, and the link chosen",
  );
  assert.match(link, /^http:\/\/[^/]+\/kiosk\/.+$/);
  await kiosks(ada).getByRole("listitem").getByText(words.kiosks.states.unopened).waitFor();
  await shot(ada, "kiosk_made");
  await button(kiosks(ada), words.kiosks.link_done).click();
  assert.equal(await kiosks(ada).locator("strata-copy-field").count(), 0);
  await ada.page.keyboard.press("Escape");
  await gone(kiosks(ada));
});

test("who sees to kiosks finds all of them in their menu: seen, asked to reload, revoked", async () => {
  const secret = link.split("/").pop();
  const as_kiosk = (path, how = {}) =>
    fetch(`${server.url}/api/v1${path}`, {
      ...how,
      headers: { Authorization: `Bearer ${secret}`, ...how.headers },
    });
  assert.equal((await as_kiosk("/kiosk")).status, 200);
  await button(ada.page, words.account.menu("ada")).click();
  await ada.page.getByRole("menuitem", exact(words.kiosks.open)).click();
  const entry = kiosks(ada).getByRole("listitem", exact("Entrance hall"));
  await entry.getByText(words.kiosks.states.running, { exact: true }).waitFor();
  await entry.getByText("Around the pot").waitFor();
  await button(entry, words.kiosks.reload_of("Entrance hall")).click();
  await entry.getByText(words.kiosks.asked).waitFor();
  assert.equal((await (await as_kiosk("/kiosk")).json()).wants_reload, true);
  await shot(ada, "kiosks");
  await button(entry, words.kiosks.revoke_of("Entrance hall")).click();
  await button(question(ada), words.cancel).click();
  assert.equal((await as_kiosk("/kiosk")).status, 200);
  await button(entry, words.kiosks.revoke_of("Entrance hall")).click();
  await button(question(ada), words.kiosks.revoke_yes).click();
  await entry.getByText(words.kiosks.states.revoked, { exact: true }).waitFor();
  assert.equal((await as_kiosk("/kiosk")).status, 401);
  assert.equal(await entry.getByRole("button").count(), 0);
  await shot(ada, "kiosk_revoked");
  await ada.page.keyboard.press("Escape");
});

test("on a phone a stop has the window to itself", async () => {
  await open_panel(phone);
  await row(phone, "Around the pot").scrollIntoViewIfNeeded();
  await shot(phone, "phone_list");
  await row(phone, "Around the pot").locator("button.open").tap();
  await stops(phone).locator("li").nth(2).waitFor();
  await shot(phone, "phone_editor");
  await stops(phone).locator("button.stop", { hasText: "The handle" }).tap();
  await fields(phone).getByLabel(words.tours.stop_title_in("Spanish")).fill("El asa de la vasija");
  assert.equal(await stops(phone).isVisible(), false);
  await shot(phone, "phone_stop");
  await button(fields(phone), words.tours.try_stop).tap();
  await shot(phone, "phone_trial");
  await button(trial(phone), words.tours.trial_end).tap();
  await button(editor(phone), words.tours.all_stops).tap();
  await stops(phone).locator("button.stop", { hasText: "Above" }).waitFor();
  await save(phone);
  await gone(editor(phone));
  assert.equal((await tour("around-the-pot")).stops[2].title.es, "El asa de la vasija");
  // the panel was hidden to show the model
  await phone.page.getByRole("button", { name: words.model.show_panel }).tap();
  await row(phone, "Around the pot").scrollIntoViewIfNeeded();
  await from_menu(phone, "Around the pot", words.kiosks.of_tour);
  await kiosks(phone).getByText(words.kiosks.states.revoked, { exact: true }).waitFor();
  await shot(phone, "phone_kiosks");
  await phone.page.keyboard.press("Escape");
});

test("annotators are offered none of it", async () => {
  await open_panel(bea);
  await bea.page.locator("strata-view-list button.go").first().waitFor();
  assert.equal(await list(bea).count(), 0);
  await button(bea.page, words.account.menu("bea")).click();
  await bea.page.getByRole("menuitem", exact(words.account.open)).waitFor();
  assert.equal(await bea.page.getByRole("menuitem", exact(words.kiosks.open)).count(), 0);
  await bea.page.keyboard.press("Escape");
});

test("a tour that was deleted meanwhile is made anew", async () => {
  await row(ada, "Around the pot").locator("button.open").click();
  await editor(ada).getByLabel(words.tours.name, { exact: true }).fill("Once more");
  await server.request("DELETE", `${kBase}/tours/around-the-pot`);
  await save(ada);
  await refused(ada, words.tours.gone);
  await save(ada);
  await gone(editor(ada));
  assert.deepEqual(
    (await tours()).map(({ name }) => name),
    ["Once more"],
  );
  await from_menu(ada, "Once more", words.layers.delete);
  await button(question(ada), words.delete).click();
  await list(ada).getByText(words.tours.none).waitFor();
  assert.deepEqual(await tours(), []);
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
