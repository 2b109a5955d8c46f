// A tour of the demo pot in three languages, with records and pictures, and the link of a kiosk
// that shows it.
import { encode_png } from "./png.mjs";
import { pot_camera } from "./pot-camera.mjs";

export const kModel = "/models/demo-pot";
export const kTour = `${kModel}/tours/round-the-pot`;
const kSherds = 14;

/** Returns a picture with stripes, like those of a painted sherd. */
function picture(width, height) {
  const data = new Uint8Array(4 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const band = Math.floor(y / (height / 7)) % 2;
      const wave = Math.sin(x / 14) * 9 > (y % (height / 7)) - height / 14;
      data.set(
        band && wave ? [52, 40, 34, 255] : [196, 132 + (y % 20), 92, 255],
        4 * (y * width + x),
      );
    }
  return encode_png({ width, height, data });
}

const kStops = [
  {
    view: "the-pot",
    attract_s: 10,
    transition_s: 2,
    layers: [],
    records: [],
    title: {
      en: "The pot from the well",
      de: "Der Topf aus dem Brunnen",
      es: "La vasija del pozo",
    },
    text: {
      en: "It lay at the bottom of a well for nineteen hundred years. Those who drew water let it fall, and nobody went down to fetch it.\n\nTurn it: the side that is dark lay in the mud.",
      de: "Neunzehnhundert Jahre lag er auf dem Grund eines Brunnens. Wer Wasser schöpfte, ließ ihn fallen, und niemand stieg hinab, um ihn zu holen.\n\nDrehen Sie ihn: Die dunkle Seite lag im Schlamm.",
      es: "Pasó mil novecientos años en el fondo de un pozo. Quien sacaba agua la dejó caer y nadie bajó a buscarla.\n\nGírela: el lado oscuro estaba en el barro.",
    },
  },
  {
    view: "sherds",
    attract_s: 10,
    transition_s: 3,
    layers: ["sherds", "cracks", "pieces"],
    records: [
      {
        table: "sherds",
        keys: [3, 1],
        columns: [
          { column: "name", labels: { en: "Inventory", de: "Inventar" } },
          { column: "thickness", labels: { de: "Wandstärke" } },
          { column: "state" },
          { column: "photo" },
        ],
      },
    ],
    title: { en: "Fourteen sherds", de: "Vierzehn Scherben" },
    text: {
      en: "Each sherd has a number. Choose below what is shown, or tap a sherd to read what the conservators found.",
    },
  },
  {
    view: "rim",
    attract_s: 10,
    transition: "cut",
    transition_s: 0,
    layers: [],
    records: [],
    title: { en: "The rim", de: "Der Rand", es: "El borde" },
    text: { en: "Fingers pressed these marks into the wet clay." },
  },
];

/** Returns the link's path, the kiosk and the model. */
export async function make_kiosk_site(server, { idle_s = 30 } = {}) {
  const model = await server.json("PATCH", kModel, { scale_verified: true });
  await server.json("POST", `${kModel}/layers`, {
    name: "Sherds",
    kind: "database",
    type: "u16",
    resolution: 2048,
    columns: [
      { name: "Name" },
      { name: "State", kind: "enumeration", choices: ["loose", "firm"] },
      { name: "Thickness", kind: "numeric", unit: "mm" },
      { name: "Photo", kind: "picture" },
    ],
  });
  for (let key = 1; key <= kSherds; ++key) {
    await server.json("POST", "/tables/sherds/records", {
      values: {
        name: `Sherd ${key}`,
        thickness: 2 + key / 2,
        state: key % 3 === 0 ? "loose" : "firm",
      },
    });
    await server.json("POST", `${kModel}/layers/sherds/edits`, {
      op: "fill",
      value: key,
      mode: "where",
      where: `pieces = ${key}`,
    });
    const answer = await fetch(
      `${server.url}/api/v1/tables/sherds/records/${key}/attachments?name=sherd-${key}.png&column=photo`,
      {
        method: "POST",
        headers: {
          Authorization: `Bearer ${server.token}`,
          "Content-Type": "application/octet-stream",
        },
        body: picture(300 + key, 200),
      },
    );
    if (!answer.ok) throw new Error(`a picture: ${answer.status} ${await answer.text()}`);
  }
  const view = (name, camera, shown) =>
    server.json("POST", `${kModel}/views`, {
      name,
      camera,
      light: { mode: name === "Rim" ? "raking" : "museum" },
      layers: ["sherds", "cracks", "pieces"].map((layer) => ({
        layer,
        visible: shown.includes(layer),
        opacity: 0.6,
      })),
    });
  await view("The pot", pot_camera(1600, 1000), []);
  await view("Sherds", pot_camera(1600, 1000, 0.9), ["sherds"]);
  await view("Rim", pot_camera(1600, 1000, 2.2, 170), []);
  for (const [layer, name] of [
    ["sherds", "Scherben"],
    ["cracks", "Risse"],
  ])
    await server.json("PATCH", `${kModel}/layers/${layer}`, { labels: { de: name } });
  await server.json("POST", `${kModel}/tours`, {
    name: "Round the pot",
    languages: ["en", "de", "es"],
    idle_s,
    stops: kStops,
  });
  const { path, kiosk } = await server.json("POST", `${kTour}/kiosks`, { name: "Foyer" });
  return { path, kiosk, model };
}
