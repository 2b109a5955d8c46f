// Groups on the page: an administrator creates a group, adds users and gives it a role in a
// project. Its members see the project and the origin of their role, until the role ends while
// their pages are open.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

// Console messages about responses that the test causes, and about sockets that the server closes.
const kExpected = [
  "status of 401",
  "status of 403",
  "status of 404",
  "status of 409",
  "status of 422",
  ...kOfLostServer,
];
const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `groups_${name}.png`) });
};

async function choose_in_menu({ page }, name) {
  await page.getByRole("button", { name: /^Account of/ }).click();
  await page.getByRole("menuitem", { name }).click();
}
const show = (part) => owner.page.getByRole("radio", { name: part, exact: true }).click();
async function choose_for(options, command) {
  await owner.page.getByRole("button", { name: options }).click();
  await owner.page.getByRole("menuitem", { name: command }).click();
}
async function leave_inner_dialog() {
  await owner.page.keyboard.press("Escape");
  await wait_for(
    async () => (await owner.page.locator("dialog[open]").count()) === 1,
    "the inner dialog to close",
  );
}

let owner, gil, server, slug, project, in_demo;

test.beforeAll(async () => {
  [owner, gil] = [
    await Browser.open(),
    await Browser.open({ viewport: { width: 390, height: 844 } }),
  ];
  server = new StrataServer({ demo: true });
  await server.start();
  const { models } = await server.json("GET", "/models");
  ({ slug, project } = models[0]);
  await owner.sign_in(server, await server.add_person("anna", "administrator"));
  await gil.sign_in(server, await server.add_person("gil", "guest"));
  await server.add_person("max", "viewer");
  await server.json("PATCH", "/users/gil", { full_name: "Gil Guest" });
  await gil.page.getByText(words.home.empty_guest).waitFor();
});

test("a group is made with the keyboard; a name that is taken is told at its field", async () => {
  await choose_in_menu(owner, words.account.people);
  await owner.page.getByRole("row", { name: /Gil Guest/ }).waitFor();
  await show("Groups");
  await owner.page.getByText(words.groups.none).waitFor();
  await owner.page.getByLabel(words.groups.new_name).press("Enter");
  await owner.page.getByRole("alert").getByText(words.groups.name_empty).waitFor();
  await owner.page.getByLabel(words.groups.new_name).fill("Students");
  await owner.page.keyboard.press("Enter");
  await owner.page.getByRole("heading", { name: words.groups.members_of("Students") }).waitFor();
  await owner.page.getByText(words.groups.inside(0)).waitFor();
  await leave_inner_dialog();
  await owner.page.getByLabel(words.groups.new_name).fill("STUDENTS");
  await owner.page.keyboard.press("Enter");
  await owner.page
    .getByRole("alert")
    .getByText("There is already a group with the name `Students`.")
    .waitFor();
  assert.equal(
    await owner.page.getByLabel(words.groups.new_name).getAttribute("aria-invalid"),
    "true",
  );
});

test("people are put into it and taken out, found by their names", async () => {
  await choose_for(words.groups.options("Students"), words.groups.members);
  await owner.page.getByRole("checkbox", { name: "max" }).check();
  await owner.page.getByText(words.groups.inside(1)).waitFor();
  await owner.page.getByRole("checkbox", { name: "max" }).uncheck();
  await owner.page.getByText(words.groups.taken_out).waitFor();
  await owner.page.getByLabel(words.site_people.filter).last().fill("gil");
  await wait_for(
    async () => (await owner.page.getByRole("checkbox").count()) === 1,
    "gil alone to be listed",
  );
  await owner.page.getByRole("checkbox", { name: /Gil Guest/ }).focus();
  await owner.page.keyboard.press("Space");
  await owner.page.getByText(words.groups.put_in).waitFor();
  await shot(owner, "members");
  await leave_inner_dialog();
  await owner.page.getByText("1 person · no role in any project").waitFor();
});

test("it gets a role in the project of the demo: its people see it, and where that comes from", async () => {
  await choose_for(words.groups.options("Students"), words.site_people.projects);
  in_demo = owner.page
    .locator("strata-project-roles-dialog")
    .getByRole("combobox", { name: words.project_roles.role_in("Demo") });
  assert.equal(await in_demo.inputValue(), "");
  await in_demo.selectOption("annotator");
  await owner.page
    .locator("strata-project-roles-dialog")
    .getByText(words.site_people.role_changed("annotator"))
    .waitFor();
  await shot(owner, "roles");
  await leave_inner_dialog();
  await owner.page.getByText("1 person · a role in 1 project").waitFor();
  await shot(owner, "list");
  await gil.page.reload();
  await gil.page.getByRole("link", { name: /Demo pot/ }).waitFor();
  await choose_in_menu(gil, words.account.open);
  await gil.page.getByText(words.account.role_by_groups("Annotator", "Students")).waitFor();
  await shot(gil, "account");
  await gil.page.keyboard.press("Escape");
});

test("administrators see it of the person, too", async () => {
  await show("People");
  await owner.page
    .getByRole("row", { name: /Gil Guest/ })
    .getByText("Students")
    .waitFor();
  await owner.page.getByLabel(words.site_people.filter).fill("students");
  await owner.page.getByText(/^1 of \d people$/).waitFor();
  await shot(owner, "people");
  await choose_for(words.site_people.options("Gil Guest"), words.site_people.projects);
  await owner.page.getByText(words.project_roles.by_groups("annotator", "Students")).waitFor();
  await in_demo.selectOption("curator");
  await owner.page.getByText(words.project_roles.by_groups_also("annotator", "Students")).waitFor();
  await in_demo.selectOption("");
  await owner.page.getByText(words.project_roles.by_groups("annotator", "Students")).waitFor();
  await shot(owner, "of_person");
  await leave_inner_dialog();
  await owner.page.getByLabel(words.site_people.filter).fill("");
});

test("somebody invited comes with the group, and is told so", async () => {
  await owner.page.getByRole("button", { name: words.site_people.invite }).click();
  await owner.page.getByLabel(words.site_people.invite_user).fill("ida");
  await owner.page
    .getByRole("combobox", { name: words.site_people.role, exact: true })
    .selectOption("guest");
  await owner.page.getByRole("checkbox", { name: "Students" }).check();
  await shot(owner, "invite");
  await owner.page.getByRole("button", { name: words.site_people.invite_button }).click();
  const link = await owner.page
    .getByRole("textbox", { name: words.site_people.link("ida"), exact: true })
    .inputValue();
  await owner.page.getByRole("row", { name: /ida/ }).getByText("Students").waitFor();
  const guest = await Browser.open();
  await guest.page.goto(link);
  await guest.page.getByText(words.join.groups("Students")).waitFor();
  await shot(guest, "join");
  await guest.close();
});

test("a page that is open follows the group's role, and ends with the group", async () => {
  await gil.page.goto(`${server.url}/models/${slug}`);
  await gil.drawn();
  await gil.page.getByRole("button", { name: words.tools.brush, exact: true }).waitFor();
  await show("Groups");
  await choose_for(words.groups.options("Students"), words.site_people.projects);
  await in_demo.selectOption("viewer");
  await gil.page.getByText(words.people.role_now("viewer")).waitFor();
  await gil.page
    .getByRole("button", { name: words.tools.brush, exact: true })
    .waitFor({ state: "detached" });
  await leave_inner_dialog();
  await choose_for(words.groups.options("Students"), words.groups.rename);
  await owner.page.getByLabel(words.groups.name, { exact: true }).fill("Pupils");
  await owner.page.keyboard.press("Enter");
  await owner.page.getByText("Pupils").waitFor();
  await choose_for(words.groups.options("Pupils"), words.layers.delete);
  await owner.page.getByText(words.groups.delete_lead(2, 2)).waitFor();
  await shot(owner, "delete");
  await owner.page.keyboard.press("Escape");
  await owner.page.getByText("2 people · a role in 1 project").waitFor();
  await choose_for(words.groups.options("Pupils"), words.layers.delete);
  await owner.page.getByRole("button", { name: words.delete, exact: true }).click();
  await owner.page.getByText(words.groups.none).waitFor();
  await gil.page.goto(server.url);
  await gil.page.getByText(words.home.empty_guest).waitFor();
});

test("the project's activity tells it", async () => {
  await owner.page.keyboard.press("Escape");
  await owner.page.goto(`${server.url}/models/${slug}`);
  await owner.drawn();
  const activity = owner.page.locator("strata-activity-panel");
  await open_tab(owner.page, words, words.activity.title);
  await activity.getByRole("radio", { name: words.activity.of_project }).click();
  await activity.getByText(words.activity.done["group removed"]).waitFor();
  await activity.getByText(words.activity.done["in_group added"]).first().waitFor();
  await activity.evaluate((panel) => panel.scrollIntoView());
  await shot(owner, "activity");
  assert.ok(project);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [owner, gil]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [owner, gil]) await who?.close();
  await server?.remove();
});
