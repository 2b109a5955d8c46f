// The page in the browser's language or in the selected one: texts, numbers, names of data, and the
// files that it loads for a language.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Browser, kOfLostServer } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";

const language_of = ({ page }) => page.evaluate(() => document.documentElement.lang);
const heading = ({ page }, name) => page.getByRole("heading", { name, exact: true }).waitFor();

/** The languages whose texts a browser has loaded. */
const loaded = [];

let german, french, server, model, project, value;

test.beforeAll(async () => {
  [german, french] = [
    await Browser.open({ locale: "de-DE" }),
    await Browser.open({ locale: "fr-FR" }),
  ];
  server = new StrataServer({ demo: true });
  german.page.on("request", (request) => {
    const found = /\/assets\/(en|de|es)-[^/]*\.js$/.exec(new URL(request.url()).pathname);
    if (found) loaded.push(found[1]);
  });
  await server.start();
  const { models } = await server.json("GET", "/models");
  [{ id: model, project }] = models;
});

test("a browser in a language that the page is not written in gets English", async () => {
  await french.page.goto(server.url);
  await heading(french, "Sign in");
  assert.equal(await language_of(french), "en");
});

test("a German one gets German, and no other words are loaded", async () => {
  await german.page.goto(server.url);
  await heading(german, "Anmelden");
  assert.equal(await language_of(german), "de");
  assert.deepEqual(loaded, ["de"]);
});

test("before the sign-in another language can be chosen; it is kept", async () => {
  await german.page.getByRole("combobox", { name: "Sprache" }).selectOption("es");
  await heading(german, "Iniciar sesión");
  assert.equal(await language_of(german), "es");
  await german.page.reload();
  await heading(german, "Iniciar sesión");
  await german.page.getByRole("combobox", { name: "Idioma" }).selectOption({ index: 0 });
  await heading(german, "Anmelden");
});

test("numbers are written and read with a comma", async () => {
  await german.page.context().request.post(`${server.url}/api/v1/login`, {
    data: { token: server.token },
    headers: { Origin: server.url },
  });
  const wet = await server.json("POST", `/models/${model}/layers`, {
    name: "Feuchte",
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
  await german.page.goto(`${server.url}/models/${model}`);
  await german.drawn();
  await german.page.getByRole("button", { name: "Auf Feuchte malen" }).click();
  await german.page.keyboard.press("b");
  value = german.page.locator("strata-value-picker").getByRole("textbox", { name: "Wert" });
  assert.equal(await value.inputValue(), "2,5");
  await value.fill("");
  await value.pressSequentially("1,25");
  await value.press("Enter");
  await german.drag([
    [0.46, 0.5],
    [0.56, 0.52],
  ]);
  await german.saved();
  const highest = async () =>
    (await server.json("GET", `/models/${model}/layers/${wet.id}/statistics`)).max;
  assert.equal(await wait_for(highest, "something painted"), 1.25);
  await value.fill("1.250"); // this number is ambiguous
  await value.press("Enter");
  await german.page.getByText("ohne Tausenderpunkte").waitFor();
});

test("data are called by the chosen language first", async () => {
  const finds = await server.json("POST", `/projects/${project}/tables`, {
    name: "Finds",
    columns: [{ name: "Material", kind: "text", labels: { de: "Werkstoff", es: "Materia" } }],
  });
  await server.json("POST", `/models/${model}/layers`, {
    name: "Funde",
    kind: "database",
    type: "u16",
    resolution: 2048,
    table: finds.slug,
  });
  await german.page.reload();
  await german.drawn();
  await german.page.getByRole("button", { name: "Auf Funde malen" }).click();
  await german.page.getByRole("button", { name: "Tabelle der Datensätze" }).click();
  await german.page.getByRole("columnheader", { name: "Werkstoff" }).waitFor();
});

test("with unsaved changes another language is asked about, and No leaves all as it is", async () => {
  await german.page.getByRole("button", { name: "Auf Feuchte malen" }).click();
  await german.page.keyboard.press("b");
  await value.fill("3");
  await value.press("Enter");
  await server.signal("SIGSTOP");
  await german.drag([
    [0.4, 0.45],
    [0.5, 0.47],
  ]);
  await german.page.locator('.saving:not([data-state="saved"])').waitFor();
  await german.page.getByRole("button", { name: /^Konto von/ }).click();
  await german.page.getByRole("menuitem", { name: /^Sprache/ }).click();
  await german.page.getByRole("combobox", { name: "Sprache" }).selectOption("es");
  await german.page.getByText("noch nicht gespeichert").last().waitFor();
  await german.page.getByRole("button", { name: "Abbrechen" }).click();
  await wait_for(
    async () => (await german.page.getByRole("combobox", { name: "Sprache" }).inputValue()) === "",
    "the choice to be as it was",
  );
  assert.equal(await language_of(german), "de");
  await german.page.keyboard.press("Escape");
  await server.signal("SIGCONT");
  await german.saved();
});

test("saved, it is changed at once", async () => {
  await german.page.getByRole("button", { name: /^Konto von/ }).click();
  await german.page.getByRole("menuitem", { name: /^Sprache/ }).click();
  await german.page.getByRole("combobox", { name: "Sprache" }).selectOption("es");
  await german.page.getByRole("button", { name: "Pintar en Feuchte" }).click();
  assert.equal(await language_of(german), "es");
  await german.page.getByRole("button", { name: "Pintar en Funde" }).click();
  await german.page.getByRole("button", { name: "Tabla de registros" }).click();
  await german.page.getByRole("columnheader", { name: "Materia" }).waitFor();
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [german, french]) who.assert_no_complaints(["status of 401", ...kOfLostServer]);
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  for (const who of [german, french]) await who?.close();
  await server?.remove();
});
