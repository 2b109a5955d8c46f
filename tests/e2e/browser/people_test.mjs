// Accounts on the page: a password for the owner, an invitation by link, the controls of each role,
// and the removal of users.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { square_ply } from "../support/js/meshes.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kOwnersPassword = "four words of mine";
const kAdasPassword = "engines weave algebra";
const kAdasNext = "as the loom weaves flowers";
const kAdasThird = "notes upon the memoir";
// Console messages about responses that the test causes, and about sockets that the server closes.
const kExpected = [
  "status of 401",
  "status of 403",
  "status of 404",
  "status of 409",
  "status of 422",
  ...kOfLostServer,
];

const at_home = ({ page }) =>
  page.getByRole("heading", { name: words.home.title, exact: true }).waitFor();
const at_sign_in = ({ page }) =>
  page.getByRole("heading", { name: words.sign_in.title, exact: true }).waitFor();
const alert_of = ({ page }, text) => page.getByRole("alert").getByText(text).waitFor();
const close_dialog = ({ page }) =>
  page.getByRole("button", { name: words.close, exact: true }).click();

async function sign_in({ page }, user, password) {
  await page.getByLabel(words.sign_in.user, { exact: true }).fill(user);
  await page.getByLabel(words.sign_in.password, { exact: true }).fill(password);
  await page.keyboard.press("Enter");
}
async function choose_in_menu({ page }, name) {
  await page.getByRole("button", { name: /^Account of/ }).click();
  await page.getByRole("menuitem", { name }).click();
}
async function choose_for({ page }, name, command) {
  await page.getByRole("button", { name: `Options for ${name}` }).click();
  await page.getByRole("menuitem", { name: command }).click();
}
const call = async (token, path, more = {}) =>
  (
    await fetch(`${server.url}/api/v1${path}`, {
      ...more,
      headers: { Authorization: `Bearer ${token}`, "Content-Type": "application/json" },
    })
  ).status;

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `people_${name}.png`) });
};

/** Imports a square of 100 mm. */
async function import_square(name, project) {
  const started = await fetch(
    `${server.url}/api/v1/models?filename=square.ply&name=${name}&unit=mm&project=${project}`,
    {
      method: "POST",
      headers: {
        Authorization: `Bearer ${server.token}`,
        "Content-Type": "application/octet-stream",
      },
      body: square_ply(100),
    },
  );
  assert.equal(started.status, 202, await started.clone().text());
  const { id } = await started.json();
  await wait_for(
    async () => (await server.json("GET", `/jobs/${id}`)).state === "done",
    `the import of ${name}`,
  );
}

let owner, ada, phone, server, link_field, link, path, edits;

test.beforeAll(async () => {
  [owner, ada, phone] = [
    await Browser.open(),
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
});

test("the owner, who came by the printed link, is asked for a password, and told what is wrong with one", async () => {
  await owner.page.goto(server.link);
  await at_home(owner);
  await owner.page.getByRole("button", { name: words.account.no_password }).click();
  await owner.page.getByText(words.account.this_browser).waitFor();
  await owner.page.getByLabel(words.account.new, { exact: true }).fill("short");
  await owner.page.getByRole("button", { name: words.account.password_choose }).click();
  await alert_of(owner, "at least 10 characters");
  await owner.page.getByLabel(words.account.new, { exact: true }).fill(kOwnersPassword);
  await owner.page.getByLabel(words.account.repeat).fill("four words of his");
  await owner.page.keyboard.press("Enter");
  await alert_of(owner, words.password.differs);
  await owner.page.getByLabel(words.account.repeat).fill(kOwnersPassword);
  await owner.page.keyboard.press("Enter");
  await owner.page.getByText("Your password is set.").waitFor();
  await owner.page.getByLabel(words.account.current).waitFor();
  await close_dialog(owner);
  await server.sign_in_owner({ user: "owner", password: kOwnersPassword });
  assert.equal(
    await owner.page.getByRole("button", { name: words.account.no_password }).count(),
    0,
  );
});

test("they sign out, and in again by name and password", async () => {
  await choose_in_menu(owner, words.account.sign_out);
  await at_sign_in(owner);
  await sign_in(owner, "owner", "four words of hers");
  await alert_of(owner, words.sign_in.wrong);
  await sign_in(owner, "nobody", kOwnersPassword);
  await alert_of(owner, words.sign_in.wrong);
  await sign_in(owner, "Owner", kOwnersPassword); // the server ignores the case of letters
  await at_home(owner);
});

test("a token that is not known is told so, and the owner's is one for scripts since they have a password", async () => {
  await phone.page.goto(server.url);
  await phone.page.getByText(words.sign_in.otherwise).click();
  await phone.page.getByLabel(words.sign_in.token).fill("no such token");
  await phone.page.keyboard.press("Enter");
  await alert_of(phone, words.sign_in.token_wrong);
  await phone.page.getByLabel(words.sign_in.token).fill(server.token);
  await phone.page.keyboard.press("Enter");
  await alert_of(phone, "for scripts");
  await at_sign_in(phone);
});

test("Ada is invited; a name that cannot be is told at its field", async () => {
  await choose_in_menu(owner, words.account.people);
  await owner.page.getByRole("button", { name: words.site_people.invite }).click();
  await owner.page.getByLabel(words.site_people.invite_user).fill("owner");
  await owner.page.getByRole("button", { name: words.site_people.invite_button }).click();
  await owner.page.locator("strata-people-dialog form small[role=alert]:not([hidden])").waitFor();
  assert.equal(
    await owner.page.getByLabel(words.site_people.invite_user).getAttribute("aria-invalid"),
    "true",
  );
  await owner.page.getByLabel(words.site_people.invite_user).fill("ada");
  await owner.page.getByLabel(words.site_people.full_name).fill("Ada Lovelace");
  await owner.page
    .getByRole("combobox", { name: words.site_people.role, exact: true })
    .selectOption("annotator");
  await owner.page.getByRole("button", { name: words.site_people.invite_button }).click();
  link_field = owner.page.getByRole("textbox", {
    name: words.site_people.link("Ada Lovelace"),
    exact: true,
  });
  link = await link_field.inputValue();
  assert.ok(link.startsWith(`${server.url}/join#`), link);
  await owner.page
    .getByRole("row", { name: /Ada Lovelace/ })
    .getByText(words.site_people.states.invited)
    .waitFor();
  assert.equal(
    await owner.page.getByLabel(words.site_people.role_of("owner")).count(),
    0,
    "the owner's row can be changed",
  );
});

test("at a browser where somebody else is signed in the link says so", async () => {
  const beside = await owner.context.newPage();
  await beside.goto(link);
  await beside.getByText(/Somebody else is signed in to this browser: owner/).waitFor();
  assert.equal(await beside.getByLabel(words.join.password, { exact: true }).count(), 0);
  await beside.close();
});

test("Ada opens her link, chooses a password, and is in; the secret is gone from the address", async () => {
  await ada.page.goto(link);
  await ada.page.getByRole("heading", { name: words.join.greeting("Ada Lovelace") }).waitFor();
  await ada.page.getByLabel(words.join.password, { exact: true }).fill(kAdasPassword);
  await ada.page.getByLabel(words.join.repeat).fill(kAdasPassword);
  await ada.page.keyboard.press("Enter");
  await at_home(ada);
  assert.equal(ada.page.url(), `${server.url}/`);
  await ada.page.getByRole("button", { name: words.account.menu("Ada Lovelace") }).click();
  await ada.page.getByRole("menuitem", { name: words.account.open }).waitFor();
  assert.equal(
    await ada.page.getByRole("menuitem", { name: words.account.people }).count(),
    0,
    "an annotator is offered the people",
  );
  await ada.page.keyboard.press("Escape");
  assert.equal(
    await ada.page.getByRole("button", { name: words.home.import }).count(),
    0,
    "an annotator is offered to import",
  );
});

test("the link was good for one use", async () => {
  await phone.page.goto(link);
  await phone.page.getByText(words.join.useless_title).waitFor();
  await phone.page.goto(`${server.url}/join`);
  await phone.page.getByText(words.join.incomplete_title).waitFor();
});

test("she sees the model, and paints", async () => {
  await ada.page.getByRole("link", { name: /Demo pot/ }).click();
  await ada.drawn();
  path = new URL(ada.page.url()).pathname;
  await ada.page.getByRole("button", { name: words.layers.select("cracks") }).click();
  await ada.page.keyboard.press("b");
  edits = async () => (await server.json("GET", `${path}/layers/cracks/edits?limit=1`)).total;
  const before = await edits();
  await ada.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await ada.saved();
  await wait_for(async () => (await edits()) > before, "her stroke to be in the history");
});

test("the owner makes her a viewer: her page, which is open, offers no painting any more", async () => {
  await owner.page.getByLabel(words.site_people.role_of("Ada Lovelace")).selectOption("viewer");
  await owner.page.getByText(words.site_people.role_changed("viewer")).waitFor();
  await ada.page.getByText(words.people.role_now("viewer")).waitFor();
  await ada.page
    .getByRole("button", { name: words.tools.brush, exact: true })
    .waitFor({ state: "detached" });
  assert.equal(
    await ada.page.getByRole("button", { name: words.model.undo, exact: true }).count(),
    0,
  );
  const painted = await edits();
  await ada.page.keyboard.press("b");
  await ada.page.getByText(words.brush.viewer_only).waitFor();
  await ada.page.getByRole("button", { name: /^Account of/ }).click();
  await ada.page.getByText("ada · Viewer").waitFor();
  await ada.page.keyboard.press("Escape");
  assert.equal(await edits(), painted);
});

test("the owner disables her: she is out, and cannot come back", async () => {
  await choose_for(owner, "Ada Lovelace", words.site_people.disable);
  await owner.page.getByText(words.site_people.disable_lead).waitFor();
  await owner.page
    .getByRole("button", { name: words.site_people.disable_button, exact: true })
    .click();
  await owner.page
    .getByRole("row", { name: /Ada Lovelace/ })
    .getByText(words.site_people.states.disabled, { exact: true })
    .waitFor();
  await at_sign_in(ada);
  await sign_in(ada, "ada", kAdasPassword);
  // the next attempt must wait for the response to this one
  await alert_of(ada, words.sign_in.wrong);
  await at_sign_in(ada);
});

test("enabled again she comes back to where she was", async () => {
  await choose_for(owner, "Ada Lovelace", words.site_people.enable);
  await owner.page.getByText(words.site_people.enabled).waitFor();
  await sign_in(ada, "ada", kAdasPassword);
  await ada.drawn();
});

test("who forgot a password gets a new link; the old password is good for nothing then", async () => {
  await choose_for(owner, "Ada Lovelace", words.site_people.new_link);
  await owner.page.getByRole("button", { name: words.site_people.new_link_button }).click();
  const next_link = await wait_for(async () => {
    const shown = await link_field.inputValue();
    return shown !== link && shown;
  }, "the new link");
  await phone.page.goto(next_link);
  await phone.page.getByLabel(words.join.password, { exact: true }).fill(kAdasNext);
  await phone.page.getByLabel(words.join.repeat).fill(kAdasNext);
  await phone.page.keyboard.press("Enter");
  await at_home(phone);
  await at_sign_in(ada); // the new password has ended her other sessions
  await sign_in(ada, "ada", kAdasPassword);
  await alert_of(ada, words.sign_in.wrong);
  await sign_in(ada, "ada", kAdasNext);
  await ada.drawn();
});

test("she changes her password on the page, with the one until now; it ends her other sessions", async () => {
  await choose_in_menu(phone, words.account.open);
  const change = async (current, password, repeat = password) => {
    await phone.page.getByLabel(words.account.current).fill(current);
    await phone.page.getByLabel(words.account.new, { exact: true }).fill(password);
    await phone.page.getByLabel(words.account.repeat).fill(repeat);
    await phone.page.getByRole("button", { name: words.account.password_change }).click();
  };
  await change("", kAdasThird);
  await alert_of(phone, words.account.current_missing);
  await change(kAdasPassword, kAdasThird);
  await alert_of(phone, "The current password is wrong");
  await change(kAdasNext, "short");
  await alert_of(phone, "at least 10 characters");
  await change(kAdasNext, kAdasThird);
  await phone.page.getByText("Your password is set.").waitFor();
  await shot(phone, "password_changed");
  await at_sign_in(ada);
  await sign_in(ada, "ada", kAdasNext);
  await alert_of(ada, words.sign_in.wrong);
  await sign_in(ada, "ada", kAdasThird);
  await ada.drawn();
  await close_dialog(phone);
});

test("she signs out at one of her browsers, from another", async () => {
  await choose_in_menu(phone, words.account.open);
  await phone.page.getByText(words.account.this_browser).waitFor();
  await phone.page.getByRole("button", { name: /^Sign out of / }).click();
  await at_sign_in(ada);
  await phone.page.getByRole("button", { name: /^Sign out of / }).waitFor({ state: "detached" });
  await sign_in(ada, "ada", kAdasThird);
  await ada.drawn();
  await close_dialog(phone);
});

test("she sees where she is signed in, and signs out there", async () => {
  await choose_in_menu(phone, words.account.open);
  await phone.page.getByText(words.account.this_browser).waitFor();
  await phone.page.getByRole("button", { name: words.account.sign_out_others }).click();
  await phone.page.getByText(words.account.signed_out_others).waitFor();
  await at_sign_in(ada);
  await phone.page.getByLabel(words.account.full_name).fill("Countess of Lovelace");
  await phone.page.keyboard.press("Enter");
  await phone.page
    .getByRole("button", { name: words.account.menu("Countess of Lovelace"), includeHidden: true })
    .waitFor();
  await close_dialog(phone);
});

test("a token made on the page works for a script, as its role allows, until it is revoked", async () => {
  await close_dialog(owner);
  await choose_in_menu(owner, words.account.open);
  await owner.page.getByRole("button", { name: words.account.token_new }).click();
  await owner.page.getByRole("button", { name: words.account.token_make }).click();
  await alert_of(owner, words.account.token_name_missing);
  await owner.page.getByLabel(words.account.token_name).fill("Nightly report");
  const role_of_token = owner.page.getByRole("combobox", {
    name: words.account.token_role,
    exact: true,
  });
  await role_of_token.selectOption("owner");
  await owner.page.getByRole("combobox", { name: words.account.token_where }).selectOption("Demo");
  assert.equal(
    await role_of_token.inputValue(),
    "curator",
    "a token of one project is curator at most",
  );
  await role_of_token.selectOption("viewer");
  await shot(owner, "token_form");
  await owner.page.getByRole("button", { name: words.account.token_make }).click();
  await owner.page.getByText("Viewer · only in Demo").waitFor();
  const token = await owner.page.getByLabel(/Copy it now/).inputValue();
  await owner.page.getByText(`Authorization: Bearer ${token}`).waitFor();
  assert.equal(await call(token, "/models"), 200);
  assert.equal(
    await call(token, `${path}/layers`, { method: "POST", body: JSON.stringify({ name: "No" }) }),
    403,
  );
  await owner.page
    .getByRole("button", { name: words.account.token_revoke("Nightly report") })
    .click();
  await owner.page.getByRole("button", { name: words.account.revoke, exact: true }).last().click();
  await owner.page.getByText(words.account.no_tokens).waitFor();
  assert.equal(await call(token, "/models"), 401);
  await close_dialog(owner);
});

test("deleted she is out; what she did stays, under a name that nobody can tell", async () => {
  await choose_in_menu(owner, words.account.people);
  await owner.page.getByLabel(words.site_people.filter).fill("countess");
  await owner.page.getByText(words.site_people.count_of(1, 2)).waitFor();
  await choose_for(owner, "Countess of Lovelace", words.site_people.delete);
  await owner.page.getByText("stays in the history").waitFor();
  await owner.page.getByRole("button", { name: words.delete, exact: true }).click();
  await owner.page.getByText(words.site_people.none_found).waitFor();
  await phone.page.reload();
  await at_sign_in(phone);
  const { edits: history } = await server.json("GET", `${path}/layers/cracks/edits?limit=1000`);
  assert.ok(
    history.some(({ user }) => user.startsWith("former-")),
    "what she did is not in the history",
  );
  assert.ok(!history.some(({ user }) => user === "ada"), "her name is still in the history");
});

test("an administrator lets a guest annotate in one project: they see its models on their page, and no others", async () => {
  await server.json("POST", "/projects", { name: "Villa Giulia" });
  await import_square("Threshold", "villa-giulia");
  await ada.sign_in(server, await server.add_person("anna", "administrator"));
  await phone.sign_in(server, await server.add_person("gil", "guest"));
  await phone.page.getByText(words.home.empty_guest).waitFor();
  await choose_in_menu(ada, words.account.people);
  await choose_for(ada, "gil", words.site_people.projects);
  await ada.page.getByText(words.project_roles.lead("guest")).waitFor();
  const in_villa = ada.page.getByRole("combobox", {
    name: words.project_roles.role_in("Villa Giulia"),
  });
  assert.equal(await in_villa.inputValue(), "");
  await in_villa.selectOption("annotator");
  await ada.page
    .locator("strata-project-roles-dialog")
    .getByText(words.site_people.role_changed("annotator"))
    .waitFor();
  await shot(ada, "roles_in_projects");
  await phone.page.reload();
  await phone.page.getByRole("link", { name: /Threshold/ }).waitFor();
  assert.equal(
    await phone.page.getByRole("link", { name: /Demo pot/ }).count(),
    0,
    "the guest sees a model of another project",
  );
  assert.equal(
    await phone.page.getByRole("button", { name: words.home.import }).count(),
    0,
    "an annotator is offered to import",
  );
  await shot(phone, "guest");
  await phone.page.getByRole("link", { name: /Threshold/ }).click();
  await phone.drawn();
  await phone.page.getByRole("button", { name: words.tools.brush, exact: true }).waitFor();
  await shot(phone, "guest_model");
  await in_villa.selectOption("");
  await ada.page
    .locator("strata-project-roles-dialog")
    .getByText(words.project_roles.removed)
    .waitFor();
  await phone.page.goto(server.url);
  await phone.page.getByText(words.home.empty_guest).waitFor();
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [owner, ada, phone]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [owner, ada, phone]) await who?.close();
  await server?.remove();
});
