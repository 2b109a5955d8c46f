// Measured figures on the page: options with a preview of the sheet, and files. The figures show
// the user's current view or a saved view, also perpendicular to a picked face. Figures are
// canceled, refused, and left running in the background. Viewers can also make figures.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { open_on_picture, open_tab } from "../support/js/panel.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kBase = "/models/demo-pot";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kExpected = ["status of 404", "status of 422"]; // responses that the test causes
let id;

const shot = async ({ page }, name) => {
  if (process.env.STRATA_TEST_OUTPUT)
    await page.screenshot({ path: join(process.env.STRATA_TEST_OUTPUT, `figures_${name}.png`) });
};
const dialog = ({ page }) => page.locator("strata-figure-dialog");
const button = (who, name) => dialog(who).getByRole("button", { name, exact: true });
const field = (who, name) => dialog(who).locator(`[name="${name}"]`);
const radio = (who, name) =>
  dialog(who).getByRole("radio", {
    name,
    exact: !["TIFF", "PDF", "PNG", "SVG", "DXF"].includes(name),
  });
const notice = ({ page }, text) => page.locator("strata-notices .notice", { hasText: text });
const closed = (who) => dialog(who).waitFor({ state: "detached" });
const bar = (who) => dialog(who).getByRole("progressbar");

/** The body of the page's latest request of each kind. */
const asked = new Map(); // user → { preview, file }
function listen(who) {
  asked.set(who, {});
  who.page.on("request", (request) => {
    if (request.method() === "POST" && new URL(request.url()).pathname.endsWith("/figures"))
      asked.get(who)[request.headers()["prefer"] === "respond-async" ? "file" : "preview"] =
        request.postDataJSON();
  });
}

const state = (who) => dialog(who).locator("figure").getAttribute("data-state");
/**
 * Returns the sheet for the current options: its colors, and a text that is equal for equal images.
 */
async function sheet(who) {
  await wait_for(async () => (await state(who)) === "drawn", "the sheet");
  return dialog(who)
    .locator("figure img")
    .evaluate(async (img) => {
      await img.decode();
      const [width, height] = [img.naturalWidth, img.naturalHeight];
      const canvas = new OffscreenCanvas(width, height).getContext("2d");
      canvas.drawImage(img, 0, 0);
      const { data } = canvas.getImageData(0, 0, width, height);
      let [drawn, text] = [0, 5381];
      for (let at = 0; at < data.length; at += 4) {
        if (Math.min(data[at], data[at + 1], data[at + 2]) < 235) ++drawn;
        text = (text * 33 + data[at] + 3 * data[at + 1] + 7 * data[at + 2]) % 4294967291;
      }
      const corner = (x, y) => [...data.slice(4 * (y * width + x), 4 * (y * width + x) + 3)];
      return {
        width,
        height,
        drawn: drawn / (width * height),
        text,
        corners: [
          corner(2, 2),
          corner(width - 3, 2),
          corner(2, height - 3),
          corner(width - 3, height - 3),
        ],
      };
    });
}
/** Returns the sheet after a choice. It must differ from the sheet before. */
async function sheet_after(who, before, choose) {
  await choose();
  return wait_for(async () => {
    const now = await sheet(who);
    return now.text !== before.text && (await state(who)) === "drawn" ? now : null;
  }, "another sheet");
}

async function open_model(who) {
  await who.page.goto(`${server.url}/models/${id}`);
  await who.drawn();
}
async function open_dialog(who) {
  await who.page.locator("strata-stage .surface").focus();
  await who.page.keyboard.press("f");
  await dialog(who).getByRole("dialog").waitFor();
}
/** Returns the name and bytes of the file that the action downloads. */
async function download(who, act) {
  const [file] = await Promise.all([who.page.waitForEvent("download"), act()]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}
const make = (who) => download(who, () => button(who, words.figures.make).click());

let ada, phone, server, model, hidden, hidden_name, finds, ada_person, preview, half, downloads;

test.beforeAll(async () => {
  [ada, phone] = [await Browser.open(), await Browser.open({ ...kPhone, colorScheme: "dark" })];
  server = new StrataServer({ demo: true });
  await server.start();
  model = await server.json("PATCH", kBase, { scale_verified: false });
  id = model.id;
  [{ id: hidden, name: hidden_name }] = (await server.json("GET", `${kBase}/layers`)).layers;
  finds = await server.json("POST", `/projects/${model.project}/tables`, {
    name: "Finds",
    columns: [
      { name: "Name", kind: "text", required: true },
      { name: "Depth", kind: "numeric", unit: "m" },
      { name: "Photos", kind: "picture" },
    ],
  });
  await server.json("POST", `/tables/${finds.id}/records`, {
    values: { name: "Handle of Agathe", depth: 1.25 },
  });
  await server.json("POST", `${kBase}/layers`, {
    name: "Finds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    table: finds.slug,
  });
  await server.json("POST", `${kBase}/layers/finds/edits`, {
    op: "fill",
    value: 1,
    mode: "where",
    where: "true",
  });
  ada_person = await server.add_person("ada", "annotator");
  await ada.sign_in(server, ada_person);
  await phone.sign_in(server, await server.add_person("vera", "viewer"));
  for (const who of [ada, phone]) listen(who);
});

test("the dialog shows the sheet: white paper with the model on it, of all that the person sees", async () => {
  await open_model(ada);
  const panel = ada.page.locator("strata-view-panel");
  for (const part of ["light", "section"]) await open_on_picture(ada.page, words, words.view[part]);
  await ada.page.getByRole("radio", { name: words.view.lights.raking, exact: true }).click();
  await ada.page.getByRole("radio", { name: words.view.sections.x, exact: true }).click();
  await open_tab(ada.page, words, words.layers.title);
  await ada.page.getByRole("button", { name: `Hide ${hidden_name}` }).click();
  await open_tab(ada.page, words, words.view.title);
  await panel.getByRole("button", { name: words.figures.open }).click();
  await dialog(ada).getByRole("dialog").waitFor();
  const first = await sheet(ada);
  assert.deepEqual(first.corners, Array(4).fill([255, 255, 255]));
  assert.ok(
    first.drawn > 0.03 && first.drawn < 0.7,
    `the model covers ${first.drawn} of the sheet`,
  );
  ({ preview } = asked.get(ada));
  assert.deepEqual(
    [
      preview.format,
      preview.paper,
      preview.light.mode,
      preview.camera.section.length,
      "scale" in preview,
      preview.provisional,
    ],
    ["png", "a4", "raking", 1, false, "Provisional"],
  );
  assert.equal(preview.layers.find(({ layer }) => layer === hidden).visible, false);
  assert.match(
    await dialog(ada).locator("figure img").getAttribute("alt"),
    /A4, seen from: Current view, scale: Fit to page/,
  );
  await shot(ada, "first");
});

test("where nobody has confirmed the size, that is told, until somebody has", async () => {
  const unsure = dialog(ada).getByText(words.figures.unsure);
  await unsure.waitFor();
  await server.json("PATCH", kBase, { scale_verified: true, unit: model.unit });
  await unsure.waitFor({ state: "detached" });
});

test("another scale is another sheet: twice as small is a quarter of the area", async () => {
  await field(ada, "legend").uncheck();
  await wait_for(async () => asked.get(ada).preview.legend === false, "a sheet without a legend");
  const one = await sheet_after(
    ada,
    await sheet_after(ada, await sheet(ada), () => field(ada, "scale").selectOption("5")),
    () => field(ada, "scale").selectOption("1"),
  );
  const two = await sheet_after(ada, one, () => field(ada, "scale").selectOption("2"));
  assert.ok(
    one.drawn > 2.5 * two.drawn && two.drawn > 0.004,
    `${one.drawn} at 1 : 1, ${two.drawn} at 1 : 2`,
  );
  await field(ada, "scale").selectOption("own");
  await field(ada, "own_scale").fill("2 to 1");
  await dialog(ada).getByText(words.figures.wrong_scale).waitFor();
  assert.equal(await field(ada, "own_scale").getAttribute("aria-invalid"), "true");
  await button(ada, words.figures.make).click();
  assert.equal(asked.get(ada).file, undefined);
  half = await sheet_after(ada, two, () => field(ada, "own_scale").fill("2:3"));
  assert.equal(asked.get(ada).preview.scale, 1.5);
  assert.ok(half.drawn < one.drawn && half.drawn > two.drawn);
});

test("so are another direction, paper and orientation", async () => {
  const top = await sheet_after(ada, half, () => field(ada, "from").selectOption("top"));
  assert.deepEqual(
    [asked.get(ada).preview.direction, asked.get(ada).preview.camera.section.length],
    ["top", 1],
  );
  const turned = await sheet_after(ada, top, () =>
    radio(ada, top.width > top.height ? "Portrait" : "Landscape").click(),
  );
  assert.notEqual(turned.width > turned.height, top.width > top.height);
  await sheet_after(ada, turned, () => radio(ada, "A5").click());
});

test("an unrolled vessel has fields for its surface, and neither camera nor labels", async () => {
  const before = await sheet(ada);
  const unrolled = await sheet_after(ada, before, async () => {
    await field(ada, "from").selectOption("rollout");
    await field(ada, "axis").selectOption("vertical");
  });
  const { rollout, camera, light, direction } = asked.get(ada).preview;
  assert.deepEqual([camera, light, direction], [undefined, undefined, undefined]);
  assert.equal(Math.hypot(...rollout.axis.direction), 1);
  assert.equal(await field(ada, "labels").count(), 0);
  await shot(ada, "unrolled");
  const cut = await sheet_after(ada, unrolled, () => field(ada, "cut").fill("90"));
  assert.equal(asked.get(ada).preview.rollout.cut, 90);
  // a wrong number stays at its field, and the preview remains
  await field(ada, "cut").fill("900");
  assert.equal(await field(ada, "cut").getAttribute("aria-invalid"), "true");
  await button(ada, words.figures.make).click();
  assert.equal(asked.get(ada).file, undefined);
  assert.equal(asked.get(ada).preview.rollout.cut, 90);
  await field(ada, "cut").fill("");
  await sheet_after(ada, cut, () => field(ada, "from").selectOption("top"));
  assert.equal(asked.get(ada).preview.rollout, undefined);
});

test("square to a face: the dialog steps aside, Escape leads back as it was, a click takes the face", async () => {
  const hint = ada.page.locator("strata-face-hint section");
  await field(ada, "from").selectOption("face");
  await hint.waitFor();
  await shot(ada, "pick");
  await ada.page.keyboard.press("Escape");
  await hint.waitFor({ state: "detached" });
  assert.equal(await field(ada, "from").inputValue(), "top");
  const before_face = await sheet(ada);
  await field(ada, "from").selectOption("face");
  await hint.waitFor();
  const seen =
    (await ada.page.locator("strata-stage canvas").first().getAttribute("data-camera-seq")) ?? "";
  await ada.drag([
    [0.5, 0.5],
    [0.62, 0.5],
  ]);
  await wait_for(
    async () =>
      (await ada.page.locator("strata-stage canvas").first().getAttribute("data-camera-seq")) !==
      seen,
    "the model to turn",
  );
  const square = await sheet_after(ada, before_face, async () => {
    const box = await ada.stage_box();
    await ada.page.mouse.click(box.x + box.width * 0.4, box.y + box.height * 0.55);
    await hint.waitFor({ state: "detached" });
    await wait_for(() => asked.get(ada).preview.normal, "the face to be asked for");
  });
  const { normal, center, direction } = asked.get(ada).preview;
  assert.ok(
    Math.abs(Math.hypot(...normal) - 1) < 1e-3 && center.length === 3 && direction === undefined,
  );
  assert.equal(await field(ada, "from").inputValue(), "face");
  await button(ada, words.figures.pick_again).click();
  await hint.waitFor();
  await sheet_after(ada, square, async () => {
    await ada.page.keyboard.press("Enter"); // on the button for the center, which has the focus
    await hint.waitFor({ state: "detached" });
  });
  assert.notDeepEqual(asked.get(ada).preview.center, center);
});

test("labels are what records have in a column; in SVG they are words", async () => {
  const unlabelled = await sheet(ada);
  await field(ada, "caption").fill("The handle,\nfrom the side");
  await sheet_after(ada, unlabelled, () => field(ada, "labels").selectOption({ label: "Finds" }));
  assert.deepEqual(await field(ada, "column").locator("option").allTextContents(), [
    "Name",
    "Depth",
  ]);
  await field(ada, "credit").fill("Museum of Strata, CC BY 4.0");
  await radio(ada, "SVG").click();
  await radio(ada, "150 dpi").click();
  await shot(ada, "labels");
  const svg = await make(ada);
  assert.match(svg.name, /\.svg$/);
  for (const word of ["Handle of Agathe", "Museum of Strata"])
    assert.ok(svg.bytes.toString("utf8").includes(word), `${word} is not in the drawing`);
  assert.deepEqual(
    [asked.get(ada).file.labels.column, asked.get(ada).file.dpi, asked.get(ada).file.caption],
    ["name", 150, "The handle,\nfrom the side"],
  );
  await dialog(ada).getByText(`Saved as ${svg.name}.`).waitFor();
});

test("a PDF is made, saved under its name, and listed no more", async () => {
  await radio(ada, "PDF").click();
  await field(ada, "title").fill("Pot of Agathe");
  const pdf = await make(ada);
  assert.match(pdf.name, /^[\w.-]+\.pdf$/);
  assert.equal(pdf.bytes.subarray(0, 5).toString("latin1"), "%PDF-");
  await dialog(ada).getByText(`Saved as ${pdf.name}.`).waitFor();
  assert.equal(await ada.page.locator("strata-job-list .job").count(), 0);
  await shot(ada, "saved");
});

test("a title block has the written texts, and the author stays on this computer", async () => {
  const before = await sheet(ada);
  const { title, fields } = words.figures.block;
  await dialog(ada).locator("summary", { hasText: title }).click();
  const framed = await sheet_after(ada, before, () => field(ada, "title_block").check());
  await sheet_after(ada, framed, async () => {
    await field(ada, "block_author").fill("Ada Lovelace");
    await field(ada, "block_sheet").fill("2/5");
  });
  const { labels, ...block } = asked.get(ada).preview.title_block;
  assert.deepEqual(block, { author: "Ada Lovelace", sheet: "2/5" });
  assert.deepEqual(labels, fields);
  await shot(ada, "title_block");
  const { title_block: is_on, block_texts } = await ada.page.evaluate(() =>
    JSON.parse(localStorage.getItem("strata.figure")),
  );
  assert.deepEqual([is_on, block_texts], [true, { organization: "", author: "Ada Lovelace" }]);
  await radio(ada, "SVG").click();
  const svg = (await make(ada)).bytes.toString("utf8");
  for (const word of ["Ada Lovelace", "2/5", fields.checked_by, "Pot of Agathe"])
    assert.ok(svg.includes(`>${word}</text>`), `${word} is not in the title block`);
  await field(ada, "title_block").uncheck();
});

test("several views are on one sheet: directions or saved views", async () => {
  const { camera } = asked.get(ada).preview;
  for (const name of ["Handle", "Rim"])
    await server.json("POST", `${kBase}/views`, { name, camera });
  const before = await sheet(ada);
  const four = await sheet_after(ada, before, () => field(ada, "views").selectOption("sides"));
  const { directions } = words.figures.views;
  assert.deepEqual(
    asked.get(ada).preview.views.map(({ direction, title }) => [direction, title]),
    ["front", "back", "left", "right"].map((each) => [each, directions[each]]),
  );
  assert.equal(await field(ada, "from").count(), 0);
  await shot(ada, "views");
  const svg = await make(ada);
  assert.match(svg.name, /-views-1-[\d.]+\.svg$/);
  for (const each of ["front", "back", "left", "right"])
    assert.ok(svg.bytes.toString("utf8").includes(`>${directions[each]}</text>`), each);
  // a drawing for CAD programs is a single one
  await radio(ada, "DXF").click();
  assert.deepEqual([await field(ada, "views").count(), await field(ada, "from").count()], [0, 1]);
  await radio(ada, "PDF").click();
  await field(ada, "views").selectOption("saved");
  await dialog(ada).getByText(words.figures.views.few(2)).waitFor();
  await button(ada, words.figures.make).click(); // refused on the page
  await dialog(ada).getByRole("alert").getByText(words.figures.views.few(2)).waitFor();
  await sheet_after(ada, four, async () => {
    for (const name of ["Rim", "Handle"])
      await dialog(ada).getByRole("checkbox", { name, exact: true }).check();
  });
  assert.equal(asked.get(ada).preview.views.length, 2);
  await shot(ada, "saved_views");
  await field(ada, "views").selectOption("one");
  assert.equal((await sheet(ada)).text, before.text);
});

test("one that takes long is given up", async () => {
  downloads = [];
  ada.page.on("download", (file) => downloads.push(file.suggestedFilename()));
  await radio(ada, "A3").click();
  await radio(ada, "600 dpi").click();
  await radio(ada, "TIFF").click();
  const [started] = await Promise.all([
    ada.page.waitForResponse(
      (answer) =>
        answer.request().method() === "POST" &&
        new URL(answer.url()).pathname.endsWith("/figures") &&
        answer.status() === 202,
    ),
    button(ada, words.figures.make).click(),
  ]);
  await bar(ada).waitFor();
  await shot(ada, "making");
  await button(ada, words.figures.cancel).click();
  await bar(ada).waitFor({ state: "detached" });
  const job = await ada.page.evaluate(
    async (at) => (await fetch(`/api/v1/jobs/${at}`)).json(),
    (await started.json()).id,
  );
  assert.deepEqual([job.state, job.file, downloads], ["cancelled", undefined, []]);
});

test("one whose dialog is closed goes on, and is offered", async () => {
  await radio(ada, "150 dpi").click();
  await radio(ada, "A5").click();
  await radio(ada, "PNG").click();
  let release;
  const held = new Promise((done) => (release = done));
  await ada.page.route("**/api/v1/jobs/*", async (route) => {
    await held;
    await route.continue();
  });
  await button(ada, words.figures.make).click();
  await bar(ada).waitFor();
  await ada.page.keyboard.press("Escape");
  await closed(ada);
  const row = ada.page.locator("strata-job-list .job");
  await row.getByText(words.figures.job("Pot of Agathe")).waitFor();
  release();
  await notice(ada, words.figures.ready).waitFor();
  await shot(ada, "ready");
  assert.deepEqual(downloads, []);
  await ada.page.unroute("**/api/v1/jobs/*");
  const png = await download(ada, () =>
    notice(ada, words.figures.ready).getByRole("button", { name: words.figures.save }).click(),
  );
  assert.match(png.name, /\.png$/);
  assert.equal(png.bytes.subarray(1, 4).toString("latin1"), "PNG");
  await row.waitFor({ state: "detached" });
});

test("what was written is there again, also what was chosen, in another visit as well", async () => {
  await open_dialog(ada);
  assert.deepEqual(
    [await field(ada, "title").inputValue(), await field(ada, "from").inputValue()],
    ["Pot of Agathe", "face"],
  );
  await field(ada, "from").selectOption("front");
  await ada.page.keyboard.press("Escape");
  await closed(ada);
  await open_model(ada);
  await open_dialog(ada);
  assert.deepEqual(
    [
      await field(ada, "title").inputValue(),
      await field(ada, "from").inputValue(),
      await field(ada, "own_scale").inputValue(),
    ],
    ["", "front", "1 : 1.5"],
  );
  assert.equal(await radio(ada, "A5").getAttribute("aria-checked"), "true");
});

test("what the server refuses stands at its field", async () => {
  await field(ada, "labels").selectOption({ label: "Finds" });
  await field(ada, "column").selectOption("depth");
  await sheet(ada);
  const columns = (await server.json("GET", `/tables/${finds.id}`)).columns;
  await server.request(
    "DELETE",
    `/tables/${finds.id}/columns/${columns.find(({ slug }) => slug === "depth").id}`,
  );
  await button(ada, words.figures.make).click();
  await dialog(ada).locator("#labels_problem").waitFor();
  assert.equal(await field(ada, "labels").getAttribute("aria-invalid"), "true");
  await wait_for(
    () => field(ada, "labels").evaluate((select) => select.getRootNode().activeElement === select),
    "the keyboard to be in the field",
  );
  assert.equal(await bar(ada).count(), 0);
  await shot(ada, "refused");
  await field(ada, "labels").selectOption("");
  await dialog(ada).locator("#labels_problem").waitFor({ state: "detached" });
  await ada.page.keyboard.press("Escape");
  await closed(ada);
});

test("of a kept view, by its menu: what it shows, not what is seen", async () => {
  const list = ada.page.locator("strata-view-list");
  const as_ada = {
    Authorization: `Bearer ${ada_person.token}`,
    "Content-Type": "application/json",
    "Idempotency-Key": "west",
  };
  const {
    scale: _s,
    dpi: _d,
    format: _f,
    paper: _p,
    legend: _l,
    provisional: _v,
    continued: _c,
    direction: _r,
    ...kept
  } = preview;
  const made = await fetch(`${server.url}/api/v1${kBase}/views`, {
    method: "POST",
    headers: as_ada,
    body: JSON.stringify({ name: "West wall", text: "", ...kept }),
  });
  assert.equal(made.status, 201, await made.clone().text());
  await list.getByRole("button", { name: words.layers.options("West wall") }).click();
  await list.getByRole("menuitem", { name: words.figures.of_view }).click();
  await dialog(ada)
    .getByRole("heading", { name: words.figures.title_of_view("West wall") })
    .waitFor();
  await sheet(ada);
  assert.deepEqual(
    [asked.get(ada).preview.view, asked.get(ada).preview.camera, asked.get(ada).preview.direction],
    [String((await made.json()).id), undefined, undefined],
  );
  await shot(ada, "of_view");
  await ada.page.keyboard.press("Escape");
  await closed(ada);
});

test("what a browser kept and is no choice does no harm", async () => {
  await ada.page.evaluate(() =>
    localStorage.setItem("strata.figure", '{"from":"north","dpi":1e9,"paper":["a4"],"scale":"x"}'),
  );
  await open_model(ada);
  await open_dialog(ada);
  await sheet(ada);
  assert.deepEqual(
    [await field(ada, "from").inputValue(), await field(ada, "scale").inputValue()],
    ["camera", ""],
  );
});

test("an unrolled picture can be opened again after its dialog was closed", async () => {
  const unrolled = ada.page.locator("strata-rollout-dialog");
  await open_model(ada);
  await open_tab(ada.page, words, words.view.title);
  for (let time = 0; time < 2; ++time) {
    await ada.page
      .locator("strata-view-panel")
      .getByRole("button", { name: words.figures.unroll })
      .click();
    await unrolled.locator('figure[aria-busy="false"]').waitFor();
    await ada.page.keyboard.press("Escape");
    await unrolled.waitFor({ state: "detached" });
  }
});

test("on a phone, by who may only look", async () => {
  await open_model(phone);
  await open_tab(phone.page, words, words.view.title);
  await phone.page
    .locator("strata-view-panel")
    .getByRole("button", { name: words.figures.open })
    .tap();
  const small = await sheet(phone);
  assert.ok(small.drawn > 0.03);
  await shot(phone, "phone");
  await field(phone, "from").selectOption("face");
  const phone_hint = phone.page.locator("strata-face-hint section");
  await phone_hint.waitFor();
  await shot(phone, "phone_pick");
  // The hidden dialog changed the shape of the stage. This waits until the frame has the new shape,
  // so a tap hits the visible content.
  const fits = (canvas) =>
    Math.abs(canvas.width / canvas.height - canvas.clientWidth / canvas.clientHeight) < 0.02;
  await wait_for(
    () => phone.page.locator("strata-stage canvas").first().evaluate(fits),
    "the picture in the stage's new shape",
  );
  const stage = await phone.stage_box();
  await phone.page.touchscreen.tap(stage.x + stage.width / 2, stage.y + 0.58 * stage.height);
  await phone_hint.waitFor({ state: "detached" });
  await wait_for(() => asked.get(phone).preview.normal, "the face to be asked for");
  await sheet(phone);
  await radio(phone, "PNG").tap();
  await radio(phone, "150 dpi").tap();
  const [of_viewer] = await Promise.all([
    phone.page.waitForEvent("download"),
    button(phone, words.figures.make).tap(),
  ]);
  assert.match(of_viewer.suggestedFilename(), /\.png$/);
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [ada, phone]) who.assert_no_complaints(kExpected);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [ada, phone]) await who?.close();
  await server?.remove();
});
