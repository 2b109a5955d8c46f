// Condition reports on the page: sections, texts, rows of the title block, a logo, and figures. The
// real server writes a DOCX and a PDF, which the test reads. Reports and their previews are also
// canceled, refused, and left running in the background. Viewers can also write reports.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { load_module } from "../support/js/modules.mjs";
import { open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const w = texts_of("en");
const words = w.report_dialog;

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kExpected = ["status of 404", "status of 422"]; // responses that the test causes
const kSections = [
  "object",
  "condition",
  "figures",
  "quantities",
  "findings",
  "measures",
  "methods",
  "provenance",
];

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `report_${name}.png`) });
};
const dialog = ({ page }) => page.locator("strata-report-dialog");
const button = (who, name) => dialog(who).getByRole("button", { name, exact: true });
const radio = (who, name) => dialog(who).getByRole("radio", { name });
const field = (who, name) => dialog(who).locator(`[name="${name}"]`);
const section = (who, part) => dialog(who).locator(`li[data-part="${part}"]`);
const open_section = (who, part) => section(who, part).locator("summary").click();
const order = (who) =>
  dialog(who)
    .locator("li[data-part]")
    .evaluateAll((rows) => rows.map((row) => row.dataset.part));
const bar = (who) => dialog(who).getByRole("progressbar");
const notice = ({ page }, text) => page.locator("strata-notices .notice", { hasText: text });
const closed = (who) => dialog(who).waitFor({ state: "detached" });
const make = (who) => button(who, words.make).click();
const preview = (who) => button(who, words.preview).click();
const preview_link = (who, name = words.preview_open) =>
  dialog(who).getByRole("link", { name, exact: true });
const is_file = (response) => /\/api\/v1\/jobs\/\d+\/file$/.test(response.url());
const has_focus = (locator) =>
  locator.evaluate((element) => element.getRootNode().activeElement === element);

/** The bodies of the page's requests for reports. */
const asked = [];
function listen(who) {
  who.page.on("request", (request) => {
    if (request.method() === "POST" && new URL(request.url()).pathname.endsWith("/report"))
      asked.push(request.postDataJSON());
  });
}

async function open_model(who) {
  await who.page.goto(`${server.url}/models/${id}`);
  await who.drawn();
}
async function open_dialog(who) {
  await open_tab(who.page, w, w.view.title);
  const open = who.page
    .locator("strata-view-panel")
    .getByRole("button", { name: w.condition_report.open });
  await open.click();
  await dialog(who).getByRole("dialog").waitFor();
}
/** Returns the name and place of the file that the action downloads. */
async function download(who, act) {
  const [file] = await Promise.all([who.page.waitForEvent("download"), act()]);
  return { name: file.suggestedFilename(), path: await file.path() };
}
const run = (program, ...options) =>
  execFileSync(program, options, { encoding: "utf8", maxBuffer: 2 ** 26 });
/** Returns the paragraphs of a DOCX, one in each line. */
const docx_text = (path) =>
  run("unzip", "-p", path, "word/document.xml")
    .replaceAll("</w:p>", "\n")
    .replaceAll(/<[^>]*>/g, "");
const pdf_text = (path) => run("pdftotext", "-layout", path, "-");

/** Checks that a text contains the parts in this order. */
function assert_order(text, parts) {
  let at = 0;
  for (const part of parts) {
    const found = text.indexOf(part, at);
    assert.ok(found >= 0, `“${part}” is missing after ${parts.slice(0, parts.indexOf(part))}`);
    at = found + part.length;
  }
}

function logo_file(bytes) {
  return { name: "museum.png", mimeType: "image/png", buffer: bytes };
}
function small_png() {
  const { PNG } = load_module("pngjs");
  const png = new PNG({ width: 60, height: 20 });
  for (let at = 0; at < png.data.length; at += 4) png.data.set([30, 60, 120, 255], at);
  return PNG.sync.write(png);
}

let ada, phone, server, model, id, layers, views;

test.beforeAll(async () => {
  [ada, phone] = [await Browser.open(), await Browser.open({ ...kPhone, colorScheme: "dark" })];
  server = new StrataServer({ demo: true });
  await server.start();
  model = await server.json("GET", kBase);
  id = model.id;
  ({ layers } = await server.json("GET", `${kBase}/layers`));
  // so many drawings take long enough to cancel the report
  views = [];
  for (let n = 1; n <= 8; ++n)
    views.push(
      await server.json("POST", `${kBase}/views`, {
        name: `Detail ${n}`,
        text: "",
        camera: {
          view: [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, -400, 1],
          projection: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -20.2, 0],
          width: 800,
          height: 800,
        },
        layers: layers.map((layer) => ({ layer: layer.id, visible: true, opacity: 1 })),
        light: { mode: "headlight" },
      }),
    );
  await ada.sign_in(server, await server.add_person("ada", "annotator"));
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  for (const who of [ada, phone]) listen(who);
});

test("the dialog offers all sections, the visible layers and four directions", async () => {
  await open_model(ada);
  await open_dialog(ada);
  assert.deepEqual(await order(ada), kSections);
  for (const part of kSections) assert.ok(await field(ada, `on_${part}`).isChecked(), part);
  for (const layer of layers)
    assert.equal(await field(ada, `layer_${layer.id}`).isChecked(), layer.visible);
  await open_section(ada, "figures");
  assert.deepEqual(
    await section(ada, "figures")
      .locator("input[name^=scale_]")
      .evaluateAll((inputs) => inputs.map((input) => input.name)),
    ["scale_front", "scale_right", "scale_back", "scale_left"],
  );
  await shot(ada, "first");
});

test("a wrong input is shown at its field, and no report is requested", async () => {
  await button(ada, words.add_field).click();
  await field(ada, "field_0_value").fill("Museum of Strata");
  await field(ada, "scale_right").fill("big");
  await open_section(ada, "findings");
  await field(ada, "records").fill("1001");
  await open_section(ada, "findings"); // the section opens again because of the problem
  await field(ada, "text_condition").fill("x".repeat(20_001));
  for (const request of [preview, make]) {
    await field(ada, "field_0_value").fill("Museum of Strata");
    await request(ada);
    for (const name of ["field_0_label", "scale_right", "records", "text_condition"])
      assert.equal(await field(ada, name).getAttribute("aria-invalid"), "true", name);
    await dialog(ada).getByText(words.wrong_label).waitFor();
    await dialog(ada).getByText(words.wrong).waitFor();
    await wait_for(() => has_focus(field(ada, "field_0_label")), "the focus on the first field");
  }
  assert.ok(await field(ada, "records").isVisible());
  assert.equal(asked.length, 0);
  await shot(ada, "wrong");
  await field(ada, "field_0_label").fill("Client");
  await dialog(ada).getByText(words.wrong_label).waitFor({ state: "detached" });
  await field(ada, "scale_right").fill("");
  await field(ada, "records").fill("20");
});

test("sections move by keyboard, and the focus stays on the button", async () => {
  const up = section(ada, "condition").locator('[data-order="up:condition"]');
  const down = section(ada, "condition").locator('[data-order="down:condition"]');
  await up.focus();
  await ada.page.keyboard.press("Enter");
  assert.deepEqual((await order(ada)).slice(0, 2), ["condition", "object"]);
  await wait_for(() => has_focus(down), "the focus on the button that still moves the section");
  await section(ada, "methods").locator('[data-order="up:methods"]').focus();
  for (let step = 0; step < 2; ++step) await ada.page.keyboard.press("Enter");
  assert.deepEqual(await order(ada), [
    "condition",
    "object",
    "figures",
    "quantities",
    "methods",
    "findings",
    "measures",
    "provenance",
  ]);
  await field(ada, "on_provenance").uncheck();
  assert.equal(await field(ada, "text_provenance").count(), 0);
});

test("a file that cannot be a logo is refused, and a picture is shown", async () => {
  const input = dialog(ada).locator("strata-report-logo input[type=file]");
  await input.setInputFiles(logo_file(Buffer.from("GIF89a")));
  await dialog(ada).getByText(words.wrong_logo).waitFor();
  await input.setInputFiles(logo_file(Buffer.alloc(500_001)));
  await dialog(ada).getByText(words.large_logo).waitFor();
  await input.setInputFiles(logo_file(small_png()));
  const picture = dialog(ada).getByRole("img", { name: words.logo_alt("museum.png") });
  await picture.waitFor();
  assert.equal(await picture.evaluate((img) => img.decode().then(() => img.naturalWidth)), 60);
});

test("the server writes a DOCX with the texts in their order", async () => {
  await field(ada, "title").fill("Pot of Agathe");
  await field(ada, "author").fill("Ada Roe");
  await field(ada, "heading_condition").fill("Damage survey");
  await field(ada, "text_condition").fill("The rim is stable.\n\nThe base has salts.");
  await field(ada, "text_measures").fill("Reduce the salts.");
  const figures = section(ada, "figures");
  for (const name of [w.figures.froms.right, w.figures.froms.left])
    await figures.getByRole("button", { name: w.ordered_choice.remove(name), exact: true }).click();
  await figures.locator("select").selectOption(`view:${views[0].id}`);
  await figures.getByRole("button", { name: words.add_figure }).click();
  await field(ada, "scale_front").fill("1:4");
  await shot(ada, "filled");
  const file = await download(ada, () => make(ada));
  await dialog(ada).getByText(words.saved(file.name)).waitFor();
  assert.match(file.name, /\.docx$/);
  const request = asked.at(-1);
  assert.deepEqual(
    [request.format, request.language, request.fields, request.max_records],
    ["docx", "en", [{ label: "Client", value: "Museum of Strata" }], 20],
  );
  assert.deepEqual(request.figures, [
    { direction: "front", scale: 4 },
    { direction: "back" },
    { view: String(views[0].id) },
  ]);
  assert.deepEqual(
    [...request.layers].sort(),
    layers
      .filter(({ visible }) => visible)
      .map((layer) => layer.id)
      .sort(),
  );
  assert_order(docx_text(file.path), [
    "Pot of Agathe",
    "Ada Roe",
    "Client",
    "Museum of Strata",
    "Damage survey",
    "The rim is stable.",
    "The base has salts.",
    words.parts.object,
    words.parts.figures,
    w.figures.froms.front,
    "Detail 1",
    words.parts.quantities,
    words.parts.methods,
    words.parts.measures,
    "Reduce the salts.",
  ]);
  assert.ok(!docx_text(file.path).includes(words.parts.provenance));
  assert.equal(await ada.page.locator("strata-job-list .job").count(), 0);
  await shot(ada, "saved");
});

test("the preview is a PDF in another tab, and the dialog says when it is out of date", async () => {
  assert.equal(await preview_link(ada).count(), 0);
  const [answer] = await Promise.all([ada.page.waitForResponse(is_file), preview(ada)]);
  await preview_link(ada).waitFor();
  assert.equal((await answer.body()).toString("latin1", 0, 5), "%PDF-");
  assert.deepEqual([asked.at(-1).format, asked.at(-1).title], ["pdf", "Pot of Agathe"]);
  await dialog(ada).getByText(words.preview_ready).waitFor();
  assert.ok(await radio(ada, words.formats.docx).isChecked());
  assert.equal(await ada.page.locator("strata-job-list .job").count(), 0);
  const [tab] = await Promise.all([ada.context.waitForEvent("page"), preview_link(ada).click()]);
  await wait_for(
    () => tab.evaluate(() => document.contentType === "application/pdf"),
    "the browser's viewer of PDF",
  );
  assert.equal(tab.url(), await preview_link(ada).getAttribute("href"));
  if (process.env.STRATA_TEST_OUTPUT) await shot({ page: tab }, "preview_tab");
  await tab.close();
  await field(ada, "title").fill("Pot of Berta");
  await dialog(ada).getByText(words.preview_stale).waitFor();
  await shot(ada, "preview_stale");
  await field(ada, "title").fill("Pot of Agathe");
  await dialog(ada).getByText(words.preview_ready).waitFor();
  await shot(ada, "preview");
});

test("the server writes a PDF in another language", async () => {
  await radio(ada, words.formats.pdf).click();
  await radio(ada, "German").click();
  const file = await download(ada, () => make(ada));
  assert.match(file.name, /\.pdf$/);
  const text = pdf_text(file.path);
  const german = texts_of("de").report_dialog.parts;
  assert_order(text, ["Pot of Agathe", "Zustandsbericht"]);
  assert_order(text, ["Damage survey", "The rim is stable.", german.quantities, german.methods]);
});

/** Starts a job with a button of the dialog, and returns the id of the job. */
async function start(who, press) {
  const [response] = await Promise.all([
    who.page.waitForResponse(
      (response) =>
        response.request().method() === "POST" &&
        new URL(response.url()).pathname.endsWith("/report") &&
        response.status() === 202,
    ),
    press(who),
  ]);
  await bar(who).waitFor();
  return (await response.json()).id;
}
const job_of = (who, id) =>
  who.page.evaluate(async (at) => (await fetch(`/api/v1/jobs/${at}`)).json(), id);

test("a report and a preview can be canceled", async () => {
  const downloads = [];
  ada.page.on("download", (file) => downloads.push(file.suggestedFilename()));
  const figures = section(ada, "figures");
  for (const view of views.slice(1)) {
    await figures.locator("select").selectOption(`view:${view.id}`);
    await figures.getByRole("button", { name: words.add_figure }).click();
  }
  for (const [press, cancel] of [
    [make, words.cancel],
    [preview, words.cancel_preview],
  ]) {
    const started = await start(ada, press);
    await shot(ada, "making");
    await button(ada, cancel).click();
    await bar(ada).waitFor({ state: "detached" });
    const job = await job_of(ada, started);
    assert.deepEqual([job.state, job.file, downloads], ["cancelled", undefined, []]);
  }
  await dialog(ada).getByText(words.preview_stale).waitFor(); // the earlier preview stays
});

test("a problem that the server reports is shown at its field", async () => {
  const other = async (press, change, problem) => {
    await ada.page.route("**/report", (route) =>
      route.continue({
        postData: JSON.stringify({ ...route.request().postDataJSON(), ...change }),
      }),
    );
    await press(ada);
    await problem.waitFor();
    await ada.page.unroute("**/report");
  };
  const wrong_view = [{ direction: "front" }, { view: "nowhere" }];
  await other(preview, { figures: wrong_view }, dialog(ada).locator("#scale_back_problem"));
  assert.equal(await field(ada, "scale_back").getAttribute("aria-invalid"), "true");
  await wait_for(() => has_focus(field(ada, "scale_back")), "the focus on the field");
  await shot(ada, "refused");
  const twice = [{ part: "condition" }, { part: "condition" }];
  await other(make, { sections: twice }, section(ada, "object").locator(".error"));
  assert.equal(await dialog(ada).locator("#scale_back_problem").count(), 0);
  assert.equal(await bar(ada).count(), 0);
});

test("after the dialog has closed, a notice offers the file", async () => {
  let release;
  const held = new Promise((done) => (release = done));
  await ada.page.route("**/api/v1/jobs/*", async (route) => {
    await held;
    await route.continue();
  });
  await make(ada);
  await bar(ada).waitFor();
  await ada.page.keyboard.press("Escape");
  await closed(ada);
  const row = ada.page.locator("strata-job-list .job");
  await row.getByText(words.job("Pot of Agathe")).waitFor();
  release();
  await notice(ada, words.ready).waitFor();
  await ada.page.unroute("**/api/v1/jobs/*");
  const file = await download(ada, () =>
    notice(ada, words.ready).getByRole("button", { name: w.figures.save }).click(),
  );
  assert.match(file.name, /\.pdf$/);
  await row.waitFor({ state: "detached" });
});

test("a preview is canceled when the dialog closes", async () => {
  await open_dialog(ada);
  assert.equal(await preview_link(ada).count(), 0);
  const started = await start(ada, preview);
  await ada.page.keyboard.press("Escape");
  await closed(ada);
  await ada.page.locator("strata-job-list .job").waitFor({ state: "detached" });
  const { state, file } = await job_of(ada, started);
  assert.deepEqual([state, file], ["cancelled", undefined]);
});

test("the draft stays while the model is open, and the choices also in another visit", async () => {
  await open_dialog(ada);
  assert.deepEqual(
    [
      await field(ada, "title").inputValue(),
      await field(ada, "field_0_value").inputValue(),
      await field(ada, "text_condition").inputValue(),
    ],
    ["Pot of Agathe", "Museum of Strata", "The rim is stable.\n\nThe base has salts."],
  );
  const sections = await order(ada);
  await ada.page.keyboard.press("Escape");
  await closed(ada);
  await open_model(ada);
  await open_dialog(ada);
  assert.deepEqual(await order(ada), sections);
  assert.deepEqual(
    [
      await field(ada, "title").inputValue(),
      await field(ada, "author").inputValue(),
      await field(ada, "field_0_label").inputValue(),
      await field(ada, "field_0_value").inputValue(),
      await field(ada, "heading_condition").inputValue(),
      await field(ada, "text_condition").inputValue(),
      await radio(ada, words.formats.pdf).getAttribute("aria-checked"),
    ],
    ["", "Ada Roe", "Client", "", "Damage survey", "", "true"],
  );
  await dialog(ada)
    .getByRole("img", { name: words.logo_alt("museum.png") })
    .waitFor();
  await button(ada, words.logo_remove).click();
  await dialog(ada).locator("strata-file-choice").waitFor();
  await ada.page.keyboard.press("Escape");
  await closed(ada);
});

test("viewers write reports on a phone, which saves the preview for its own viewer", async () => {
  await phone.page.addInitScript(() =>
    Object.defineProperty(navigator, "pdfViewerEnabled", { value: false }),
  );
  await open_model(phone);
  await open_dialog(phone);
  await shot(phone, "phone");
  for (const part of ["figures", "findings", "measures", "methods"])
    await field(phone, `on_${part}`).uncheck();
  await section(phone, "condition").locator('[data-order="up:condition"]').tap();
  await field(phone, "text_condition").fill("Seen on site.");
  await shot(phone, "phone_sections");
  await button(phone, words.preview).tap();
  await preview_link(phone, words.preview_save).waitFor();
  await shot(phone, "phone_preview");
  const shown = await download(phone, () => preview_link(phone, words.preview_save).tap());
  assert.match(shown.name, /\.pdf$/);
  assert_order(pdf_text(shown.path), [words.parts.condition, "Seen on site."]);
  const file = await download(phone, () => button(phone, words.make).tap());
  assert.match(file.name, /\.docx$/);
  assert_order(docx_text(file.path), [
    words.parts.condition,
    "Seen on site.",
    words.parts.object,
    words.parts.quantities,
    words.parts.provenance,
  ]);
});

test("the pages report no errors, and the server ends with a clean log", async () => {
  for (const who of [ada, phone]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, phone]) await who?.close();
  await server?.remove();
});
