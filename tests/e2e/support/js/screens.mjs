// Every screen of the page, with a way to open it, for checks of all screens
// (accessibility_test.mjs) and for their screenshots (contact_sheet.mjs).
import assert from "node:assert/strict";
import { open_on_picture, open_tab } from "./panel.mjs";
import { encode_png } from "./png.mjs";
import { wait_for } from "./strata-server.mjs";
import { texts_of } from "./texts.mjs";

const english = texts_of("en"); // Bea's language, for any language of the other page

const kGroup = "Students of the summer school in Northern Archaeology 2026";
const kGoneLayer = "Condition before the cleaning";
const kOtherProject = "Excavation at the East Gate, Northern Profile";

const kSide = 64;
const kPhoto = encode_png({
  width: kSide,
  height: kSide,
  data: Uint8Array.from({ length: kSide * kSide * 4 }, (_, at) =>
    at % 4 === 3 || (at / 4) % kSide < kSide / 2 ? 255 : 20,
  ),
});
const file_of = (name, mimeType, content) => ({ name, mimeType, buffer: Buffer.from(content) });

/**
 * Makes a site with content of every kind on a server that has the demo. `bea` becomes the browser
 * of another user at its model.
 */
export async function make_site(server, bea) {
  const { models } = await server.json("GET", "/models");
  const [{ id: model, project }] = models;
  const { path } = await server.json("POST", "/users", {
    user: "ada",
    full_name: "Ada Lovelace",
    role: "annotator",
  });
  await server.json("POST", `/models/${model}/layers`, {
    name: "Moisture",
    kind: "numeric",
    type: "f32",
    resolution: 2048,
    unit: "%",
    palette: {
      mode: "linear",
      min: 0,
      max: 5,
      points: [
        { at: 0, color: "#ffffffff" },
        { at: 5, color: "#0000ffff" },
      ],
    },
  });
  await server.json("POST", `/models/${model}/layers/moisture/edits`, {
    op: "fill",
    value: 2.5,
    mode: "where",
    where: "true",
  });
  const columns = [
    { name: "Name", kind: "text", required: true },
    { name: "Depth", kind: "numeric", unit: "m" },
    { name: "Found", kind: "date" },
    { name: "State", kind: "enumeration", choices: ["whole", "broken"] },
    { name: "Photos", kind: "picture" },
    { name: "Edges", kind: "line" },
  ];
  const finds = await server.json("POST", `/projects/${project}/tables`, {
    name: "Finds",
    columns,
  });
  for (const [name, depth, state] of [
    ["Handle", 1.25, "broken"],
    ["Rim", 0.5, "whole"],
    ["Base", 2, "whole"],
  ])
    await server.json("POST", `/tables/${finds.id}/records`, { values: { name, depth, state } });
  await server.json("POST", `/models/${model}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    table: finds.slug,
  });
  const gone = await server.json("POST", `/models/${model}/layers`, {
    name: kGoneLayer,
    type: "u8",
    resolution: 2048,
  });
  await server.json("POST", `/models/${model}/layers/${gone.slug}/edits`, {
    op: "fill",
    value: 1,
    mode: "where",
    where: "true",
  });
  await server.request("DELETE", `/models/${model}/layers/${gone.slug}`);
  const made = await server.json("POST", `/projects/${project}/templates/stone-condition`, {
    model: String(model),
  });
  const { slug: other } = await server.json("POST", "/projects", { name: kOtherProject });
  const { id: group } = await server.json("POST", "/groups", { name: kGroup, members: ["ada"] });
  await server.json("PUT", `/projects/${other}/groups/${group}`, { role: "annotator" });
  const person = await server.add_person("bea", "annotator");
  await server.json("PATCH", "/users/bea", { full_name: "Bea Ost" });
  await bea.sign_in(server, person);
  const as_bea = async (path, body) => {
    const headers = { Authorization: `Bearer ${person.token}`, "Content-Type": "application/json" };
    const answer = await fetch(`${server.url}/api/v1${path}`, {
      method: "POST",
      headers,
      body: JSON.stringify(body),
    });
    assert.ok(answer.ok, `${path}: ${answer.status}`);
  };
  const reply = (thread, text) => as_bea(`/comments/${thread}/replies`, { text });
  const fill_as_bea = (layer) =>
    as_bea(`/models/${model}/layers/${layer}/edits`, {
      op: "fill",
      mode: "where",
      where: "true",
      value: 1,
    });
  return { server, bea, model, invitation: path, terms: made.layers[0], reply, fill_as_bea };
}

export async function bea_at({ server, bea, model }) {
  await bea.page.goto(`${server.url}/models/${model}`);
  await bea.drawn();
}

/**
 * Returns all screens and dialogs, with the texts of a language, in this order and in the window of
 * a desktop computer. `start` of each screen continues where `end` of the previous one left the
 * page. `keyboard` means that the test visits the screen with the Tab key.
 */
export function screens_of({ page }, w, { server, bea, ...site }) {
  const exact = (name) => ({ name, exact: true });
  const button = (name) => page.getByRole("button", exact(name));
  const item = (name) => page.getByRole("menuitem", exact(name));
  const dialog = page.locator("dialog[open]");
  const open = async (by) => {
    await by.click();
    await dialog.first().waitFor();
  };
  const close_dialog = async () => {
    // A docked dialog closes by Escape only while it has the focus.
    const docked = page.locator("dialog[open]:not(:modal)");
    if ((await docked.count()) > 0) await docked.first().focus();
    await page.keyboard.press("Escape");
    await wait_for(async () => (await dialog.count()) === 0, "the dialog to close");
  };
  const close_both = async () => {
    await page.keyboard.press("Escape");
    await wait_for(async () => (await dialog.count()) === 1, "the inner dialog to close");
    await close_dialog();
  };
  const from_menu = (menu, name) => async () => {
    await button(menu).click();
    await open(item(name));
  };
  const with_files = (name, files) => async () => {
    await button(w.tables.more).click();
    const chooser = page.waitForEvent("filechooser");
    await item(name).click();
    await (await chooser).setFiles(files);
    await dialog.first().waitFor();
  };
  const escape = () => page.keyboard.press("Escape");
  const of_layer = (layer, name) => async () => {
    await open_tab(page, w, w.layers.title);
    await from_menu(w.layers.options(layer), name)();
  };
  const account = (name) => from_menu(w.account.menu("owner"), name);
  const choose_layer = async (name) => {
    await open_tab(page, w, w.layers.title);
    await button(w.layers.select(name)).click();
  };
  /** Selects a layer that has names in several languages. */
  const choose_named = ({ name, labels }) => {
    const names = [...new Set([name, ...Object.values(labels)])].map((each) =>
      w.layers.select(each),
    );
    return page
      .locator(names.map((each) => `strata-layer-panel button[aria-label="${each}"]`).join(", "))
      .first()
      .click();
  };
  const tool = async (key) => {
    await page.locator("strata-stage .surface").focus();
    await page.keyboard.press(key);
  };
  const purpose = (name) => async () => {
    await open(button(w.layers.new));
    await page
      .getByRole("radio", { name: new RegExp(`^${name.replaceAll(/[()]/g, "\\$&")}`) })
      .click();
  };
  /**
   * Waits until the stage and its frame have the window's shape, so a tap hits the visible content.
   */
  const at_stage = async (x, y) => {
    // waits until the page has the change
    await page.evaluate(
      () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
    );
    const fits = (canvas) =>
      Math.abs(canvas.width / canvas.height - canvas.clientWidth / canvas.clientHeight) < 0.02;
    await wait_for(
      () => page.locator("strata-stage canvas").first().evaluate(fits),
      "the picture in the stage's shape",
    );
    const box = await page.locator("strata-stage").boundingBox();
    return [box.x + x * box.width, box.y + y * box.height];
  };
  const stage_centre = () => at_stage(0.5, 0.5);
  const row = (key) =>
    page.getByRole("grid").getByRole("rowheader", { name: new RegExp(`^${key}\\b`) });
  const people = page.locator("strata-people-menu");
  const choose_of_people = async (name) => {
    await people.locator(".faces").click();
    await people.getByRole("menuitem", { name }).click();
  };
  const figure_drawn = () =>
    page.locator('strata-figure-preview figure[data-state="drawn"]').waitFor();
  const bar = page.locator("strata-together-bar button");
  const card = page.locator("strata-comment-card section");
  const to_sign_in = async () => {
    await page.goto(server.url);
    await page.getByRole("heading", exact(w.sign_in.title)).waitFor();
  };

  return [
    { name: "sign-in", start: to_sign_in },
    { name: "sign-in with a token", start: () => page.getByText(w.sign_in.otherwise).click() },
    {
      name: "sign-in that fails",
      start: async () => {
        await page.getByRole("textbox", exact(w.sign_in.user)).fill("nobody");
        await page.getByLabel(w.sign_in.password, { exact: true }).fill("no such password");
        await page.keyboard.press("Enter");
        await page.getByText(w.sign_in.wrong).waitFor();
      },
    },
    {
      name: "join",
      start: async () => {
        await page.goto(`${server.url}${site.invitation}`);
        await page.getByRole("heading", exact(w.join.greeting("Ada Lovelace"))).waitFor();
      },
    },
    {
      name: "join without a link",
      start: async () => {
        await page.goto(`${server.url}/join`);
        await page.getByText(w.join.incomplete_title).waitFor();
      },
    },
    {
      name: "home",
      start: async () => {
        await page.context().request.post(`${server.url}/api/v1/login`, {
          data: { token: server.token },
          headers: { Origin: server.url },
        });
        await page.goto(server.url);
        await page.getByRole("heading", exact(w.home.projects)).waitFor();
        await page.locator("strata-thumbnail canvas.drawn").first().waitFor();
        await page.getByRole("combobox", exact(w.home.into)).waitFor();
      },
      keyboard: true,
    },
    {
      name: "new project",
      start: () => open(button(w.projects.new)),
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "menu of a project",
      start: async () => {
        await page.getByRole("listitem").filter({ hasText: kOtherProject }).hover();
        await button(w.home.options(kOtherProject)).click();
      },
      end: escape,
    },
    {
      name: "project",
      start: from_menu(w.home.options(kOtherProject), w.projects.describe),
      end: close_dialog,
    },
    {
      name: "Bin, empty",
      start: async () => {
        await from_menu(w.home.options(kOtherProject), w.bin.open)();
        await page.getByText(w.bin.none).waitFor();
      },
      end: close_dialog,
    },
    {
      name: "Bin",
      start: async () => {
        await from_menu(w.home.options("Demo"), w.bin.open)();
        await page.getByText(kGoneLayer).waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "delete a project",
      start: async () => {
        await from_menu(w.home.options(kOtherProject), w.layers.delete)();
        await page.getByText(w.projects.delete_lead).waitFor();
      },
      end: close_dialog,
    },
    {
      name: "delete a project with models",
      start: from_menu(w.home.options("Demo"), w.layers.delete),
      end: close_dialog,
    },
    {
      name: "reset the demo",
      start: from_menu(w.home.options("Demo"), w.demo.open),
      end: close_dialog,
    },
    {
      name: "empty project",
      start: async () => {
        await page.getByRole("link", { name: kOtherProject }).click();
        await page.getByRole("heading", exact(kOtherProject)).waitFor();
        await page.getByText(w.home.empty_title).waitFor();
      },
    },
    {
      name: "no such project",
      start: async () => {
        await page.goto(`${server.url}/projects/nowhere`);
        await page.getByRole("heading", exact(w.home.missing_title)).waitFor();
      },
    },
    {
      name: "models of a project",
      start: async () => {
        await page.getByRole("link", exact(w.home.all_projects)).click();
        await page.getByRole("heading", exact(w.home.projects)).waitFor();
        await page.getByRole("link", { name: "Demo" }).click();
        await page.getByRole("link", exact(w.home.open("Demo pot"))).waitFor();
        await page.locator("strata-thumbnail canvas.drawn").first().waitFor();
      },
      keyboard: true,
    },
    {
      name: "menu of the account",
      start: () => button(w.account.menu("owner")).click(),
      end: escape,
    },
    {
      name: "menu of a model",
      start: async () => {
        await page.locator("li").first().hover();
        await button(w.home.options("Demo pot")).click();
      },
      end: escape,
    },
    {
      name: "question",
      start: from_menu(w.home.options("Demo pot"), w.layers.delete),
      end: close_dialog,
      keyboard: true,
    },
    { name: "account", start: account(w.account.open), end: close_dialog, keyboard: true },
    {
      name: "account: new token",
      start: async () => {
        await account(w.account.open)();
        await button(w.account.token_new).click();
      },
      end: close_dialog,
    },
    {
      name: "people",
      start: async () => {
        await account(w.account.people)();
        await page.getByRole("row", { name: /Ada Lovelace/ }).waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "nodes",
      start: async () => {
        await account(w.account.nodes)();
        await page.getByText(w.nodes.alone).waitFor();
      },
      end: close_dialog,
    },
    {
      name: "people: invite",
      start: async () => {
        await account(w.account.people)();
        await button(w.site_people.invite).click();
      },
      end: close_dialog,
    },
    {
      name: "people: roles in projects",
      start: async () => {
        await account(w.account.people)();
        await button(w.site_people.options("Ada Lovelace")).click();
        await item(w.site_people.projects).click();
        await page
          .getByRole("combobox", exact(w.project_roles.role_in(kOtherProject)))
          .selectOption("curator");
        await page.locator("strata-project-roles-dialog").getByRole("status").waitFor();
      },
      end: close_both,
      keyboard: true,
    },
    {
      name: "people: groups",
      start: async () => {
        await account(w.account.people)();
        await page.getByRole("radio", exact(w.groups.title)).click();
        await page.getByText(kGroup).waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "people: audit",
      start: async () => {
        await account(w.account.people)();
        await page.getByRole("radio", exact(w.audit.title)).click();
        await page.locator("strata-audit-log tbody tr").first().waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "people: who is in a group",
      start: async () => {
        await account(w.account.people)();
        await page.getByRole("radio", exact(w.groups.title)).click();
        await button(w.groups.options(kGroup)).click();
        await item(w.groups.members).click();
        await page.getByRole("checkbox", { name: "Ada Lovelace" }).waitFor();
      },
      end: close_both,
      keyboard: true,
    },
    {
      name: "people: roles of a group",
      start: async () => {
        await account(w.account.people)();
        await page.getByRole("radio", exact(w.groups.title)).click();
        await button(w.groups.options(kGroup)).click();
        await item(w.site_people.projects).click();
        await page.getByRole("combobox", exact(w.project_roles.role_in(kOtherProject))).waitFor();
      },
      end: close_both,
    },
    { name: "preferences", start: account(w.settings.open), end: close_dialog, keyboard: true },
    {
      name: "no such model",
      start: async () => {
        await page.goto(`${server.url}/models/999`);
        await page.getByText(w.model.not_found_title).waitFor();
      },
    },
    {
      name: "model",
      start: async () => {
        await page.goto(`${server.url}/models/${site.model}`);
        await wait_for(
          async () =>
            Number(
              await page
                .locator("strata-stage canvas")
                .first()
                .evaluate((canvas) => canvas.dataset.frames ?? 0),
            ) > 0,
          "the first picture",
        );
      },
      keyboard: true,
    },
    {
      name: "brush: a class",
      start: async () => {
        await choose_layer("cracks");
        await tool("b");
      },
      keyboard: true,
    },
    { name: "brush: a number", start: () => choose_layer("Moisture") },
    { name: "brush: a record", start: () => choose_layer("Finds") },
    { name: "brush: a term", start: () => choose_named(site.terms) },
    { name: "eraser", start: () => tool("e") },
    { name: "polygon", start: () => tool("a") },
    { name: "fill connected", start: () => tool("g") },
    {
      name: "wand",
      start: async () => {
        await tool("Shift+G");
        await page.mouse.click(...(await at_stage(0.5, 0.5)));
        await page.locator("strata-selection-bar").getByRole("slider").waitFor();
      },
    },
    {
      name: "border of the selection",
      start: async () => {
        await page
          .locator("strata-selection-bar")
          .getByRole("button", exact(w.selection.border.open))
          .click();
        await page.getByRole("dialog", exact(w.selection.border.title)).waitFor();
      },
      end: escape,
    },
    {
      name: "save the selection",
      start: from_menu(w.selection.more, w.selection.save),
      end: close_dialog,
    },
    {
      name: "saved selections",
      start: from_menu(w.selection.more, w.selection.saved),
      end: close_dialog,
    },
    { name: "line", start: () => tool("d") },
    {
      name: "measure",
      start: async () => {
        const panel = page.locator("strata-measure-panel");
        await tool("m");
        for (const place of [
          [0.4, 0.5],
          [0.6, 0.5],
          [0.5, 0.6],
        ])
          await page.mouse.click(...(await at_stage(...place)));
        await panel.locator('[data-figure="area"]').waitFor();
        await panel.getByRole("button", exact(w.measure.end)).click();
        await panel.locator("strata-profile-plot path.curve").first().waitFor();
      },
      keyboard: true,
    },
    {
      name: "value under the pointer",
      start: async () => {
        await tool("v");
        await choose_layer("Finds");
        await page.mouse.move(...(await stage_centre()));
        await page.locator("strata-value-readout .card").waitFor();
      },
      end: () => page.mouse.move(2, 2),
    },
    {
      name: "menu of a layer",
      start: () => button(w.layers.options("Finds")).click(),
      end: escape,
    },
    { name: "menu of the layers", start: () => button(w.layers.more).click(), end: escape },
    { name: "menu of the view", start: () => button(w.model.view).first().click(), end: escape },
    ...["presence", "classes", "measurement", "records", "formula", "shape"].map((kind) => ({
      name: `new layer: ${kind}`,
      start: purpose(w.layer_dialog[kind]),
      end: close_dialog,
      keyboard: kind === "classes",
    })),
    { name: "layer", start: of_layer("Moisture", w.layers.edit), end: close_dialog },
    { name: "colours", start: of_layer("Finds", w.colors.open), end: close_dialog },
    { name: "areas of classes", start: of_layer("cracks", w.layers.statistics), end: close_dialog },
    {
      name: "areas of measurements",
      start: async () => {
        await of_layer("Moisture", w.layers.statistics)();
        await page
          .locator("strata-statistics-dialog")
          .getByText(w.statistics.mean, { exact: true })
          .waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    { name: "clean up", start: of_layer("cracks", w.cleanup.open), end: close_dialog },
    {
      name: "records of pieces",
      start: of_layer("cracks", w.cleanup.open_pieces),
      end: close_dialog,
    },
    {
      name: "paint from a file",
      start: of_layer("Moisture", w.layers.paint_file),
      end: close_dialog,
    },
    {
      name: "fill where",
      start: async () => {
        await choose_layer("Moisture");
        await tool("b");
        await open(button(w.areas.where));
      },
      end: close_dialog,
    },
    {
      name: "templates",
      start: async () => {
        await from_menu(w.layers.more, w.templates.open)();
        await page.locator("strata-template-dialog").getByRole("listitem").first().waitFor();
      },
      end: close_dialog,
    },
    {
      name: "terms from a file",
      start: from_menu(w.layers.more, w.terms_dialog.open),
      end: close_dialog,
    },
    {
      name: "layers of another scan",
      start: from_menu(w.layers.more, w.transfer.open),
      end: close_dialog,
    },
    {
      name: "view",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open_on_picture(page, w, w.view.light);
        await open_on_picture(page, w, w.view.section);
        await page.getByRole("radio", exact(w.view.lights.raking)).click();
        await page.getByRole("radio", exact(w.view.sections.box)).click();
      },
    },
    {
      name: "keep a view",
      start: async () => {
        await page.locator("strata-view-list").getByText(w.kept_views.none).waitFor();
        await open(button(w.kept_views.keep));
        await page
          .getByRole("textbox", exact(w.kept_views.name))
          .fill("Inscription beside the handle, upper register");
        await page
          .getByRole("textbox", exact(w.kept_views.text))
          .fill(
            "Read in raking light.\nCompare https://example.org/a-very-long-address/that-does-not-break/anywhere/in-it",
          );
      },
      keyboard: true,
    },
    {
      name: "views",
      start: async () => {
        await page
          .locator("strata-view-dialog")
          .getByRole("button", exact(w.kept_views.keep_yes))
          .click();
        await page.locator("strata-view-list").getByRole("listitem").waitFor();
        await page
          .locator("strata-view-list")
          .getByRole("listitem")
          .getByRole("button")
          .first()
          .click();
        await page.locator("strata-view-list").evaluate((list) => list.scrollIntoView());
      },
      keyboard: true,
    },
    {
      name: "menu of a view",
      start: () =>
        button(w.layers.options("Inscription beside the handle, upper register")).click(),
      end: escape,
    },
    {
      name: "figure of a view",
      start: async () => {
        await from_menu(
          w.layers.options("Inscription beside the handle, upper register"),
          w.figures.of_view,
        )();
        await figure_drawn();
      },
      end: close_dialog,
    },
    {
      name: "figure",
      start: async () => {
        await open(button(w.figures.open));
        await page.getByRole("combobox", exact(w.figures.scale)).selectOption("own");
        await page.getByRole("textbox", exact(w.figures.own_scale_label)).fill("1 / 3");
        await page.getByText(w.figures.wrong_scale).waitFor();
        await page.getByRole("radio", exact(w.figures.own_dpi)).click();
        await page.getByRole("combobox", exact(w.figures.labels)).selectOption({ label: "Finds" });
        await figure_drawn();
      },
      keyboard: true,
    },
    {
      name: "figure: a face is picked",
      start: async () => {
        await page.getByRole("textbox", exact(w.figures.own_scale_label)).fill("1 : 3");
        await page.getByRole("combobox", exact(w.figures.from)).selectOption("face");
        await page.locator("strata-face-hint section").waitFor();
      },
      end: async () => {
        await escape();
        await dialog.first().waitFor();
        await close_dialog();
      },
    },
    {
      name: "unrolled picture",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open(button(w.figures.unroll));
        await page.locator('strata-rollout-dialog figure[aria-busy="false"] img').waitFor();
      },
      end: close_dialog,
    },
    {
      name: "photographs of a place",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open(button(w.view.open_photographs));
        await page.locator("strata-photographs-dialog strata-file-choice").first().waitFor();
      },
      end: close_dialog,
    },
    {
      name: "bills of quantities",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open(button(w.billing.open));
        await page.locator("strata-bills-dialog").getByText(w.bills.none).waitFor();
        await page.getByRole("textbox", exact(w.bills.new_name)).fill("Facade to the north");
      },
      keyboard: true,
    },
    {
      name: "bill of quantities",
      start: async () => {
        const bill = page.locator("strata-bill-dialog");
        await page
          .locator("strata-bills-dialog")
          .getByRole("button", exact(w.bills.create))
          .click();
        await bill.getByText(w.bills.empty, { exact: true }).waitFor();
        await bill.getByRole("button", exact(w.bills.new_group)).click();
        await bill.locator("[name=short_text]").fill("Natural stone of the walls and the vaults");
        await bill.getByRole("button", exact(w.bills.new_position)).click();
        await bill.locator("[name=short_text]").fill("Clean the surface with steam, no acids");
        await bill.getByRole("button", exact(w.bills.add_rule)).click();
        await bill.getByRole("button", exact(w.bills.add_line)).click();
        await bill.locator('[name="measurements[0].formula"]').fill("2 * 1,20 * 0,85");
        await bill.getByRole("button", exact(w.bills.measure_all)).click();
        await bill.locator("strata-bill-proof tbody tr").first().waitFor();
      },
      end: async () => {
        await page.keyboard.press("Escape");
        await page.locator("strata-bills-dialog").getByRole("listitem").waitFor();
        await close_dialog();
        const path = "/projects/demo/bills";
        for (const { id } of (await server.json("GET", path)).bills)
          await server.request("DELETE", `${path}/${id}`);
      },
      keyboard: true,
    },
    {
      name: "condition report",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open(button(w.condition_report.open));
        await button(w.report_dialog.add_field).click();
        const label = `${w.report_dialog.value} (${w.report_dialog.field(1)})`;
        await page.getByRole("textbox", exact(label)).fill("Museum");
        for (const part of ["figures", "findings"])
          await page.locator(`strata-report-sections li[data-part=${part}] summary`).click();
        await button(w.report_dialog.make).click();
        await page.getByText(w.report_dialog.wrong_label).waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "new tour",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await open(button(w.tours.new));
        const languages = page.locator("strata-tour-languages");
        await page
          .getByRole("textbox", exact(w.tours.name))
          .fill("Once around the pot, and into it");
        await page.locator("strata-tour-stops").getByRole("button", exact(w.tours.add)).click();
        for (const tag of ["fr", "zh-Hant"]) {
          await languages.getByRole("combobox").selectOption(tag);
          await languages.getByRole("button", exact(w.tours.language_add)).click();
        }
        const fields = page.locator("strata-tour-stop-fields");
        await fields.getByRole("button", exact(w.tours.layer_add)).click();
        await fields.getByRole("button", exact(w.tours.table_add)).click();
        await fields.getByRole("button", exact(w.tours.column_add)).click();
      },
      keyboard: true,
    },
    {
      name: "tour: a stop that is refused",
      start: async () => {
        await page
          .locator("strata-tour-stop-fields")
          .getByRole("textbox", { name: w.tours.transition_takes })
          .fill("99");
        await button(w.save).click();
        await page.getByText(w.tours.wrong_seconds(0, 30)).waitFor();
      },
    },
    {
      name: "tour: closing without saving",
      start: async () => {
        await escape();
        await page.locator("strata-question dialog[open]").waitFor();
      },
      end: async () => {
        await page.locator("strata-question").getByRole("button", exact(w.cancel)).click();
        await page
          .locator("strata-tour-stop-fields")
          .getByRole("textbox", { name: w.tours.transition_takes })
          .fill("2");
      },
    },
    {
      name: "tour: a stop is tried",
      start: async () => {
        await page
          .locator("strata-tour-stop-fields")
          .getByRole("button", exact(w.tours.try_stop))
          .click();
        await page.locator("strata-tour-trial section").waitFor();
      },
      end: async () => {
        await button(w.tours.trial_end).click();
        await page.locator("strata-tour-dialog").getByRole("button", exact(w.save)).click();
        await wait_for(async () => (await dialog.count()) === 0, "the editor to close");
      },
    },
    {
      name: "tours",
      start: async () => {
        await open_tab(page, w, w.view.title);
        await page.locator("strata-tour-list").getByRole("listitem").waitFor();
        await page.locator("strata-tour-list").evaluate((list) => list.scrollIntoView());
      },
    },
    {
      name: "kiosk links of a tour",
      start: async () => {
        await from_menu(w.layers.options("Once around the pot, and into it"), w.kiosks.of_tour)();
        await button(w.kiosks.new).click();
        await page
          .getByRole("textbox", exact(w.kiosks.name))
          .fill("Entrance hall, beside the ticket desk on the left");
        await button(w.kiosks.make).click();
        await page.locator("strata-kiosks-dialog strata-copy-field").waitFor();
        await page.locator("strata-kiosks-dialog").getByRole("listitem").waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "kiosks",
      start: async () => {
        await account(w.kiosks.open)();
        await page.locator("strata-kiosks-dialog").getByRole("listitem").first().waitFor();
      },
      end: async () => {
        await close_dialog();
        for (const { id } of (await server.json("GET", "/kiosks")).kiosks)
          await server.request("DELETE", `/kiosks/${id}`);
        for (const { id } of (await server.json("GET", `/models/${site.model}/tours`)).tours)
          await server.request("DELETE", `/models/${site.model}/tours/${id}`);
      },
    },
    {
      name: "view with a section of its own",
      start: async () => {
        const [view] = (await server.json("GET", `/models/${site.model}/views`)).views;
        await server.json("PATCH", `/models/${site.model}/views/${view.id}`, {
          camera: { ...view.camera, section: [[0.6, 0.6, 0.5, 0]] },
        });
        // Until the page has the change, the button still opens the view's previous state.
        const section = page.locator("strata-picture-bar").getByText(w.view.section_of_view(1));
        await wait_for(
          async () => {
            await page
              .locator("strata-view-list")
              .getByRole("listitem")
              .getByRole("button")
              .first()
              .click();
            return section.isVisible();
          },
          "the section of the view",
          500,
        );
      },
      end: async () => {
        for (const { id } of (await server.json("GET", `/models/${site.model}/views`)).views)
          await server.request("DELETE", `/models/${site.model}/views/${id}`);
        await page.locator("strata-view-list").getByText(w.kept_views.none).waitFor();
        await page
          .locator("strata-view-list")
          .getByRole("button", exact(w.kept_views.back))
          .click();
      },
    },
    {
      name: "orthophoto",
      start: async () => {
        await from_menu(w.view.look_more, w.orthophoto.open)();
      },
      end: close_dialog,
    },
    { name: "help", start: () => open(button(w.model.help)), end: close_dialog, keyboard: true },
    {
      name: "tour",
      start: async () => {
        await open(button(w.model.help));
        await button(w.tour.again).click();
        await page.locator("strata-tour section").waitFor();
      },
      keyboard: true,
    },
    { name: "tour: the layers", start: () => button(w.tour.next).click() },
    {
      name: "tour: the brush",
      start: () => button(w.tour.next).click(),
      end: async () => {
        await escape();
        await page.locator("strata-tour section").waitFor({ state: "detached" });
      },
    },
    {
      name: "shape of the brush",
      start: async () => {
        await tool("b");
        await open_tab(page, w, w.layers.title);
        await page
          .locator("strata-shape-picker input[type=file]")
          .setInputFiles(file_of("leaf.png", "image/png", kPhoto));
        // waits until the picture is loaded
        await page.locator("strata-shape-dialog").getByRole("radio", { checked: true }).waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    { name: "about", start: () => open(button(w.model.details)), end: close_dialog },
    {
      name: "deposit",
      start: async () => {
        await open(button(w.model.details));
        await button(w.deposit.open).click();
        await page.locator("strata-deposit-dialog [name=doi]").waitFor();
      },
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "size",
      start: async () => {
        await open(button(w.model.details));
        await button(w.model.correct_size).click();
        await page.locator("strata-scale-dialog dialog[open]").waitFor();
      },
      end: close_dialog,
    },
    {
      name: "table",
      start: async () => {
        await choose_layer("Finds");
        await button(w.tables.open).first().click();
        await page.getByRole("grid").getByText("Handle").first().waitFor();
      },
      keyboard: true,
    },
    { name: "menu of a table", start: () => button(w.tables.more).click(), end: escape },
    {
      name: "new column",
      start: from_menu(w.tables.more, w.tables.new_column),
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "records from a file",
      start: with_files(w.tables.import_csv, [
        file_of("finds.csv", "text/csv", "key,name,depth\n1,Handle of a jug,1.5\n,Spout,deep\n"),
      ]),
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "photos by their names",
      start: with_files(
        w.files.add_menu,
        ["Handle_1.png", "Lid_1.png"].map((name) => file_of(name, "image/png", kPhoto)),
      ),
      end: close_dialog,
      keyboard: true,
    },
    {
      name: "record",
      start: () =>
        open(page.locator("strata-table-panel").getByRole("button", exact(w.tables.new_record))),
      end: close_dialog,
    },
    {
      name: "delete a record",
      start: async () => {
        await page.getByRole("grid").getByRole("rowheader", exact("1")).click();
        await open(
          page.locator("strata-table-panel").getByRole("button", exact(w.tables.delete)).first(),
        );
      },
      end: close_dialog,
    },
    {
      name: "record that somebody else edits",
      start: async () => {
        await bea_at({ server, bea, model: site.model });
        await bea.page.getByRole("button", { name: english.layers.select("Finds") }).click();
        await bea.page.keyboard.press("t");
        await bea.page.getByRole("grid").getByRole("rowheader", exact("2")).click();
        await bea.page.getByRole("button", exact(english.tables.edit)).click();
        await row(2)
          .getByRole("img", exact(w.tables.edited_by("Bea Ost")))
          .waitFor();
        await row(2).click();
        await open(page.locator("strata-table-panel").getByRole("button", exact(w.tables.edit)));
        await page
          .locator("strata-record-dialog")
          .getByText(w.tables.edited_by("Bea Ost"))
          .waitFor();
      },
      end: async () => {
        await close_dialog();
        await bea.page.keyboard.press("Escape");
        await page.locator("strata-table-panel").getByRole("button", exact(w.tables.close)).click();
      },
      keyboard: true,
    },
    {
      name: "menu of the people",
      start: async () => {
        await bea_at({ server, bea, model: site.model }); // the page of the model without the table
        await people.locator(".faces").click();
        await people.getByRole("menuitem", { name: w.together.follow("Bea Ost") }).waitFor();
      },
      end: escape,
    },
    {
      name: "following",
      start: async () => {
        await choose_of_people(w.together.follow("Bea Ost"));
        await bar.getByText(w.together.following("Bea Ost")).waitFor();
        const [x, y] = await stage_centre();
        await bea.page.mouse.move(x + 20, y + 30); // Bea's pointer becomes visible
        await page.locator("strata-people-overlay .person").waitFor({ state: "attached" });
      },
      end: async () => {
        await bea.page.mouse.move(2, 2);
        await bar.click();
        await bar.waitFor({ state: "detached" });
      },
      keyboard: true,
    },
    {
      name: "asked to look along",
      start: async () => {
        await bea.page.locator("strata-people-menu .faces").click();
        await bea.page.getByRole("menuitem", { name: english.together.lead }).click();
        await page.getByText(w.together.invites("Bea Ost")).waitFor();
      },
      end: () => bea.page.locator("strata-together-bar button").click(),
    },
    {
      name: "others look along",
      start: async () => {
        await choose_of_people(w.together.lead);
        await bea.page.locator("strata-notices").getByRole("button", exact("Follow")).click();
        await bar.getByText(w.together.leading(1)).waitFor();
      },
      end: async () => {
        await bar.click();
        await bar.waitFor({ state: "detached" });
        await bea.page.keyboard.press("Escape");
      },
    },
    {
      name: "locked layer",
      start: async () => {
        await server.json("PATCH", `/models/${site.model}/layers/finds`, { locked: true });
        await choose_layer("Finds");
        await page
          .locator("strata-layer-panel .more")
          .getByText(w.layers.locked_to_others)
          .waitFor();
      },
      end: () => server.json("PATCH", `/models/${site.model}/layers/finds`, { locked: false }),
    },
    {
      name: "review",
      start: async () => {
        await server.json("PATCH", `/models/${site.model}/layers/finds`, { review: true });
        await site.fill_as_bea("finds");
        // the page receives this change after the edit is durable
        await server.json("PATCH", `/models/${site.model}/layers/finds`, { review: true });
        await open_tab(page, w, w.activity.title);
        await page
          .locator("strata-review-panel")
          .getByRole("button", exact(w.review.reject_all))
          .click();
        await page.locator("strata-review-panel textarea").waitFor();
      },
      end: async () => {
        await page.keyboard.press("Escape");
        await server.json("POST", `/models/${site.model}/layers/finds/review`, {
          decision: "reject",
          all: true,
        });
        await server.json("PATCH", `/models/${site.model}/layers/finds`, { review: false });
        // Otherwise the walk through the next screen would find a control of the panel that the
        // keyboard does not reach.
        await page.locator("strata-review-panel").waitFor({ state: "detached" });
      },
      keyboard: true,
    },
    {
      name: "new comment",
      start: async () => {
        await tool("c");
        await page.mouse.click(...(await stage_centre()));
        await card
          .getByRole("textbox", exact(w.comments.text))
          .fill("Is this the crack of 2019?\nSee https://example.org/report");
      },
      keyboard: true,
    },
    {
      name: "comment",
      start: async () => {
        await card.getByRole("textbox", exact(w.comments.text)).press("Control+Enter");
        await card.getByRole("article").first().waitFor();
        const { comments } = await server.json("GET", `/models/${site.model}/comments`);
        await site.reply(
          comments.at(-1).id,
          "@owner yes, it has grown. Look at the rim, too: https://example.org/a-very-long-address/that-does-not-break/anywhere/in-it",
        );
        await wait_for(async () => (await card.getByRole("article").count()) === 2, "the reply");
      },
      keyboard: true,
    },
    {
      name: "comments",
      start: async () => {
        await card.getByRole("button", exact(w.comments.resolve)).click();
        await card.getByRole("button", exact(w.comments.reopen)).waitFor();
        await card.getByRole("button", exact(w.comments.close)).click();
        await open_tab(page, w, w.comments.title);
        await page
          .locator("strata-comment-panel")
          .getByRole("radio", exact(w.comments.states.all))
          .click();
        await page.locator("strata-comment-panel").getByRole("listitem").first().waitFor();
        await page.locator("strata-comment-panel").evaluate((panel) => panel.scrollIntoView());
      },
      end: async () => {
        for (const { id } of (await server.json("GET", `/models/${site.model}/comments`)).comments)
          await server.request("DELETE", `/comments/${id}`);
      },
      keyboard: true,
    },
    {
      name: "activity",
      start: async () => {
        const panel = page.locator("strata-activity-panel");
        await open_tab(page, w, w.activity.title);
        await panel.getByRole("radio", exact(w.activity.of_project)).click();
        await panel.getByRole("listitem").first().waitFor();
        await panel.evaluate((all) => all.scrollIntoView());
      },
      keyboard: true,
    },
  ];
}
