// Projects on the page: administrators create, rename and delete them, by keyboard, mouse and
// touch. The page lists the content that would be lost. Other users have no such controls.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { active } from "../support/js/accessible.mjs";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { square_ply } from "../support/js/meshes.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const output = process.env.STRATA_TEST_OUTPUT;
if (output) mkdirSync(output, { recursive: true });

const shoot = async ({ page }, name) => {
  if (output) await page.screenshot({ path: join(output, `projects_${name}.png`) });
};
const dialog = ({ page }) => page.locator("dialog[open]");
// slotted content is not part of the dialog element itself
const inside = ({ page }) => page.locator("strata-dialog");
const button = ({ page }, name) => page.getByRole("button", { name, exact: true });
const box = ({ page }, name) => page.getByRole("textbox", { name, exact: true });
const heading = ({ page }, name) => page.getByRole("heading", { name, exact: true }).waitFor();
const cards = ({ page }) => page.locator("strata-project-card b").allInnerTexts();
const from_menu = async (who, project, command) => {
  await button(who, `Options for ${project}`).click();
  await who.page.getByRole("menuitem", { name: command, exact: true }).click();
  await dialog(who).waitFor();
};
const is_closed = (who) =>
  wait_for(async () => (await dialog(who).count()) === 0, "the dialog to close");
const status = async ({ token }, method, path, body) =>
  (
    await fetch(`${server.url}/api/v1${path}`, {
      method,
      headers: {
        Authorization: `Bearer ${token}`,
        ...(body ? { "Content-Type": "application/json" } : {}),
      },
      ...(body ? { body: JSON.stringify(body) } : {}),
    })
  ).status;

const kSquare = square_ply(100); // mm

let ada, pia, nora, everybody, server, pot, curator, annotator;

test.beforeAll(async () => {
  ada = await Browser.open(); // an administrator at a desktop computer
  // another administrator, with a phone
  pia = await Browser.open({ ...kPhone, colorScheme: "dark" });
  nora = await Browser.open(); // a user without these rights
  everybody = { ada, pia, nora };
  server = new StrataServer({ demo: true });
  await server.start();
  [pot] = (await server.json("GET", "/models")).models;
  [curator, annotator] = [
    await server.add_person("carl", "curator"),
    await server.add_person("nora", "annotator"),
  ];
  await ada.sign_in(server, await server.add_person("ada", "administrator"));
  await pia.sign_in(server, await server.add_person("pia", "administrator"));
  await nora.sign_in(server, annotator);
});

test("from a model home is its project, also where the only other one is that of every site", async () => {
  await ada.page.goto(`${server.url}/models/${pot.id}`);
  await ada.drawn();
  await ada.page.getByRole("link", { name: words.model.back }).click();
  await heading(ada, "Demo");
  await ada.page.getByRole("link", { name: words.home.open("Demo pot") }).waitFor();
  assert.equal(new URL(ada.page.url()).pathname, `/projects/${pot.project}`);
  assert.equal(
    await ada.page.getByRole("link", { name: words.home.all_projects }).count(),
    0,
    "there is nothing to go up to",
  );
});

test("an administrator makes a project by keyboard, and is led to it", async () => {
  await ada.page.goto(server.url);
  await heading(ada, words.home.title);
  await button(ada, words.projects.new).focus();
  await ada.page.keyboard.press("Enter");
  await heading(ada, words.projects.new_title);
  await wait_for(
    async () =>
      await box(ada, "Name").evaluate((input) => input.getRootNode().activeElement === input),
    "the name to have the keyboard",
  );
  await ada.page.keyboard.type("   ");
  await ada.page.keyboard.press("Enter");
  await ada.page.getByText(words.projects.name_empty).waitFor();
  await ada.page.keyboard.type("Villa Giulia");
  await ada.page.keyboard.press("Tab");
  await ada.page.keyboard.type("Frescoes of the east wing, campaign of 2026.");
  await shoot(ada, "new_desk");
  await button(ada, words.projects.create).click();
  await heading(ada, "Villa Giulia");
  await is_closed(ada);
  assert.equal(new URL(ada.page.url()).pathname, "/projects/villa-giulia");
  await ada.page.getByText("Frescoes of the east wing").waitFor();
  await heading(ada, words.home.empty_title);
  await ada.page.getByText(words.projects.made_next).waitFor();
  await shoot(ada, "made_desk");
  assert.equal((await server.json("GET", "/projects/villa-giulia")).name, "Villa Giulia");
});

test("escape leaves everything as it is, and gives the keyboard back", async () => {
  await ada.page.goto(server.url);
  await heading(ada, words.home.projects);
  await from_menu(ada, "Demo", words.projects.describe);
  await box(ada, "Name").fill("Something else");
  await ada.page.keyboard.press("Escape");
  await is_closed(ada);
  await wait_for(
    async () => /Options for Demo/.test(await active(ada.page)),
    "the keyboard to be back at the menu",
  );
  assert.equal((await server.json("GET", `/projects/${pot.project}`)).name, "Demo");
});

test("the project that every site has can be named, not deleted", async () => {
  await ada.page.goto(`${server.url}/projects/default`);
  await heading(ada, "Default");
  await button(ada, words.home.options("Default")).click();
  await ada.page.getByRole("menuitem", { name: words.projects.describe }).waitFor();
  assert.equal(await ada.page.getByRole("menuitem", { name: "Delete…" }).count(), 0);
  await ada.page.keyboard.press("Escape");
});

test("who changes a project that somebody else changed meanwhile is told, and then may; its address stays", async () => {
  await ada.page.getByRole("link", { name: words.home.all_projects }).click();
  await heading(ada, words.home.projects);
  assert.deepEqual(await cards(ada), ["Demo", "Villa Giulia"]);
  await from_menu(ada, "Villa Giulia", words.projects.describe);
  await ada.page.getByText(words.projects.describe_lead("/projects/villa-giulia")).waitFor();
  await server.json("PATCH", "/projects/villa-giulia", { name: "Villa Julia" });
  await box(ada, "Name").fill("Villa Giulia, Rome");
  await button(ada, words.save).click();
  await ada.page.getByText(words.projects.changed("Villa Julia")).waitFor();
  await shoot(ada, "changed_meanwhile");
  await button(ada, words.save).click();
  await is_closed(ada);
  await wait_for(
    async () => (await cards(ada)).includes("Villa Giulia, Rome"),
    "the card to have the new name",
  );
  const renamed = await server.json("GET", "/projects/villa-giulia");
  assert.deepEqual(
    [renamed.name, renamed.description],
    ["Villa Giulia, Rome", "Frescoes of the east wing, campaign of 2026."],
  );
  await shoot(ada, "gallery_desk");
});

test("a project may demand that programs name versions; the page does", async () => {
  const demand = () => inside(ada).getByRole("checkbox", { name: words.projects.require_version });
  for (const is_demanded of [true, false]) {
    await from_menu(ada, "Villa Giulia, Rome", words.projects.describe);
    await ada.page.getByText(words.projects.require_version_hint).waitFor();
    assert.equal(await demand().isChecked(), !is_demanded);
    await demand().setChecked(is_demanded);
    if (is_demanded) await shoot(ada, "demands_versions");
    await button(ada, words.save).click();
    await is_closed(ada);
    assert.equal(
      (await server.json("GET", "/projects/villa-giulia")).require_if_match,
      is_demanded,
    );
  }
});

test("with models it stays, and it is said what to do", async () => {
  const started = await fetch(
    `${server.url}/api/v1/models?filename=square.ply&name=Threshold&unit=mm&project=villa-giulia`,
    {
      method: "POST",
      headers: {
        Authorization: `Bearer ${server.token}`,
        "Content-Type": "application/octet-stream",
      },
      body: kSquare,
    },
  );
  assert.equal(started.status, 202);
  const { id: job } = await started.json();
  await wait_for(
    async () => (await server.json("GET", `/jobs/${job}`)).state === "done",
    "the import",
  );
  await pia.page.goto(`${server.url}/projects/villa-giulia`);
  await heading(pia, "Villa Giulia, Rome");
  await pia.page.getByRole("link", { name: words.home.open("Threshold") }).waitFor();
  await from_menu(pia, "Villa Giulia, Rome", "Delete…");
  await heading(pia, words.projects.kept_title("Villa Giulia, Rome"));
  await pia.page.getByText("First delete its model").waitFor();
  assert.equal(
    await inside(pia).getByRole("button", { name: words.delete, exact: true }).count(),
    0,
  );
  await shoot(pia, "with_models_phone_dark");
  await inside(pia).locator("footer").getByRole("button", { name: words.close }).tap();
  await is_closed(pia);
});

test("with tables only, these are named, and its name is typed", async () => {
  const [{ id: model }] = (await server.json("GET", "/models")).models.filter(
    ({ name }) => name === "Threshold",
  );
  const finds = await server.json("POST", "/projects/villa-giulia/tables", {
    name: "Finds",
    columns: [{ name: "Name" }],
  });
  await server.json("POST", `/tables/${finds.id}/records`, { values: { name: "Sherd" } });
  await server.json("POST", "/projects/villa-giulia/tables", {
    name: "Units",
    columns: [{ name: "Find", kind: "relation", target: "finds" }],
  });
  await server.request("DELETE", `/models/${model}`);
  await pia.page.reload();
  await heading(pia, words.home.empty_title);
  await from_menu(pia, "Villa Giulia, Rome", "Delete…");
  await heading(pia, words.projects.kept_by_bin_title("Villa Giulia, Rome"));
  await inside(pia).locator("footer").getByRole("button", { name: words.close }).tap();
  await is_closed(pia);
  await server.request("DELETE", `/projects/villa-giulia/bin/model-${model}`);
  await pia.page.reload();
  await heading(pia, words.home.empty_title);
  await from_menu(pia, "Villa Giulia, Rome", "Delete…");
  await pia.page.getByText(words.projects.delete_tables_lead(2)).waitFor();
  await inside(pia).getByText("1 record").waitFor();
  const remove = inside(pia).getByRole("button", { name: words.delete, exact: true });
  const typed = box(pia, "Type “Villa Giulia, Rome” to confirm");
  for (const wrong of ["", "villa giulia, rome", "Villa Giulia"]) {
    await typed.fill(wrong);
    await typed.press("Enter");
    assert.ok(await remove.isDisabled(), `deleted by “${wrong}”`);
  }
  assert.equal((await server.json("GET", "/projects/villa-giulia/tables")).total, 2);
  await shoot(pia, "with_tables_phone_dark");
  await typed.fill("Villa Giulia, Rome");
  await remove.tap();
  await heading(pia, words.home.title); // the title of the only remaining project
  assert.equal(new URL(pia.page.url()).pathname, "/");
  await pia.page.getByText("“Villa Giulia, Rome” was deleted.").waitFor();
  assert.equal(await status({ token: server.token }, "GET", "/projects/villa-giulia"), 404);
  assert.equal(await status({ token: server.token }, "GET", `/tables/${finds.id}`), 404);
  await shoot(pia, "deleted_phone_dark");
});

test("by touch: a project is made on a phone, and deleted while it is empty by one more tap", async () => {
  await button(pia, words.projects.new).tap();
  await box(pia, "Name").fill("遺跡");
  await button(pia, words.projects.create).tap();
  await heading(pia, "遺跡");
  await shoot(pia, "empty_phone_dark");
  await pia.page.getByRole("link", { name: words.home.all_projects }).tap();
  await heading(pia, words.home.projects);
  await shoot(pia, "gallery_phone_dark");
  await from_menu(pia, "遺跡", "Delete…");
  await pia.page.getByText(words.projects.delete_lead).waitFor();
  await shoot(pia, "delete_phone_dark");
  await inside(pia).getByRole("button", { name: words.delete, exact: true }).tap();
  await heading(pia, words.home.title);
  await is_closed(pia);
});

test("who may not is offered none of it, and the server refuses them", async () => {
  await server.json("POST", "/projects", { name: "Archive" });
  for (const person of [annotator, curator]) {
    await nora.sign_in(server, person);
    await heading(nora, words.home.projects);
    await wait_for(async () => (await cards(nora)).length === 2, "both projects");
    assert.equal(await button(nora, words.projects.new).count(), 0);
    assert.equal(
      await nora.page.getByRole("button", { name: /^Options for/ }).count(),
      person === curator ? 2 : 0,
      "curators look into the Bin",
    );
    await nora.page.goto(`${server.url}/projects/archive`);
    await heading(nora, "Archive");
    await heading(nora, words.home.empty_title);
    assert.equal(
      await nora.page.getByRole("button", { name: /^Options for/ }).count(),
      person === curator ? 1 : 0,
    );
    assert.equal(await nora.page.getByRole("menuitem", { name: /Delete|Rename/ }).count(), 0);
    assert.equal(await status(person, "POST", "/projects", { name: "Mine" }), 403);
    assert.equal(await status(person, "PATCH", "/projects/archive", { name: "Mine" }), 403);
    assert.equal(await status(person, "DELETE", "/projects/archive"), 403);
  }
  await shoot(nora, "curator_empty");
});

test("whose role changes while the dialog is open is told so there", async () => {
  await ada.page.goto(server.url);
  await heading(ada, words.home.projects);
  await button(ada, words.projects.new).click();
  await box(ada, "Name").fill("Too late");
  await server.json("PATCH", "/users/ada", { role: "viewer" });
  await button(ada, words.projects.create).click();
  await inside(ada).getByRole("alert").filter({ hasText: /./ }).waitFor();
  await shoot(ada, "refused_desk");
  assert.deepEqual(
    (await server.json("GET", "/projects")).projects.map(({ name }) => name).sort(),
    ["Archive", "Default", "Demo"],
  );
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  ada.assert_no_complaints(["412", "403", "401"]);
  pia.assert_no_complaints(["409"]); // the page first tries to delete a table that others refer to
  nora.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of Object.values(everybody)) await who?.close();
  await server?.remove();
});
