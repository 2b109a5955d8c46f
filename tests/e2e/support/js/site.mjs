// A small site with content of every kind: a nearly flat wall and another version of it, layers of
// each kind, tables, terms, files, a surface image, a brush shape. `spare` makes another object of
// a kind, for requests that delete an object.
import { encode_png } from "./png.mjs";
import { wait_for } from "./strata-server.mjs";

const kSide = 12; // number of cells per side of the wall, which is 100 mm wide
// Side of the wall in the texture, relative to the texture's side. The wall then has about 60 000
// texels, which the tests read quickly. A raster file still contains the whole layer.
const kTextureShare = 0.12;

/** Returns an ASCII PLY with texture coordinates, and a number at each vertex. */
function wall() {
  const vertices = [];
  const faces = [];
  for (let row = 0; row <= kSide; ++row) {
    for (let column = 0; column <= kSide; ++column) {
      const [u, v] = [column / kSide, row / kSide];
      vertices.push(
        [
          100 * u,
          100 * v,
          Math.sin(5 * u),
          0.02 + kTextureShare * u,
          0.02 + kTextureShare * v,
          u + v,
        ].join(" "),
      );
      const at = row * (kSide + 1) + column;
      if (row < kSide && column < kSide)
        faces.push(
          `3 ${at} ${at + 1} ${at + kSide + 2}`,
          `3 ${at} ${at + kSide + 2} ${at + kSide + 1}`,
        );
    }
  }
  const properties = ["x", "y", "z", "s", "t", "quality"]
    .map((name) => `property float ${name}`)
    .join("\n");
  return `ply\nformat ascii 1.0\nelement vertex ${vertices.length}\n${properties}\nelement face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n${vertices.join("\n")}\n${faces.join("\n")}\n`;
}

function picture(width, height) {
  const data = new Uint8Array(4 * width * height);
  for (let at = 0; at < width * height; ++at)
    data.set(at % width < width / 3 ? [200, 30, 30, 255] : [250, 250, 250, 255], 4 * at);
  return encode_png({ width, height, data });
}

const square = (x, y, size) => [
  [x, y],
  [x, y + size],
  [x + size, y + size],
  [x + size, y],
  [x, y],
];
const map = {
  type: "FeatureCollection",
  features: [1, 2].map((zone) => ({
    type: "Feature",
    properties: { zone },
    geometry: { type: "Polygon", coordinates: [square(20 * zone, 30, 15)] },
  })),
};

const kTermsCsv =
  "code,parent,label,label-es,color\nloss,,Loss,Pérdida,#c04020\nflaking,loss,Flaking,Descamación,\nsalts,,Salts,Sales,#2040c0\n";
const kTermsTurtle =
  '@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n<urn:d:loss> a skos:Concept ; skos:notation "loss" ; skos:prefLabel "Loss"@en .\n';
const kTermsRdf =
  '<?xml version="1.0"?><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="http://www.w3.org/2004/02/skos/core#"><skos:Concept rdf:about="urn:d:soot"><skos:notation>soot</skos:notation><skos:prefLabel xml:lang="en">Soot</skos:prefLabel></skos:Concept></rdf:RDF>';

/** The camera of a photograph of the wall, in a format of RealityCapture. */
const poses_of = (name) => `#name,x,y,alt,heading,pitch,roll,f\n${name},50,50,300,0,0,0,35\n`;

const kColumns = [
  { name: "Code", required: true, unique: true },
  { name: "Depth", kind: "numeric", unit: "m" },
  { name: "Layers", kind: "integer" },
  { name: "Period", kind: "period" },
  { name: "State", kind: "enumeration", choices: ["loose", "firm"] },
  { name: "Found", kind: "date" },
  { name: "Damage", kind: "term", target: "damage" },
  { name: "Above", kind: "relation", target: "units" },
  { name: "Wet", kind: "boolean" },
  { name: "Photos", kind: "picture" },
  { name: "Papers", kind: "document" },
];

export const kLayers = ["cracks", "moisture", "units", "risk"];
export const kColumnSlugs = kColumns.map(({ name }) => name.toLowerCase());

export class Site {
  /** The content of requests that is not JSON, by name. */
  files = {
    "wall.ply": Buffer.from(wall()),
    "picture.png": picture(24, 16),
    "map.geojson": Buffer.from(JSON.stringify(map)),
    "terms.csv": Buffer.from(kTermsCsv),
    "terms.ttl": Buffer.from(kTermsTurtle),
    "terms.rdf": Buffer.from(kTermsRdf),
    "records.csv": Buffer.from("key,depth,state\n1,2.5,firm\n2,,loose\n"),
    "readings.csv": Buffer.from("x,y,z,value\n20,20,0,1\n60,40,0,2\n"),
    "vertices.csv": Buffer.from("1\n".repeat((kSide + 1) ** 2)),
    "empty.zip": Buffer.concat([Buffer.from("PK\x05\x06"), Buffer.alloc(18)]),
    "poses.csv": Buffer.from(poses_of("picture.png")),
    "tender.x83": Buffer.from(
      '<GAEB xmlns="http://www.gaeb.de/GAEB_DA_XML/DA83/3.3"><Award><DP>83</DP><BoQ><BoQBody>' +
        '<Itemlist><Item RNoPart="0010"><Qty>2.5</Qty><QU>m2</QU></Item></Itemlist>' +
        "</BoQBody></BoQ></Award></GAEB>",
    ),
    "letter.txt": Buffer.from("A letter of 1903.\n"),
    "noise.bin": Buffer.from(Array.from({ length: 3000 }, (_, n) => (n * n * 31) % 256)),
  };
  #made = 0;

  constructor(server) {
    this.server = server;
  }

  async #post(path, file, type = "application/octet-stream") {
    const body = Buffer.isBuffer(file) ? file : this.files[file];
    const answer = await fetch(`${this.server.url}/api/v1${path}`, {
      method: "POST",
      headers: { Authorization: `Bearer ${this.server.token}`, "Content-Type": type },
      body,
    });
    if (!answer.ok) throw new Error(`POST ${path}: ${answer.status} ${await answer.text()}`);
    return answer.json();
  }

  async #import(name, project) {
    const job = await this.#post(
      `/models?filename=wall.ply&unit=mm&project=${project}&name=${encodeURIComponent(name)}`,
      "wall.ply",
    );
    this.job ??= String(job.id);
    return wait_for(
      async () => {
        const now = await this.server.json("GET", `/jobs/${job.id}`);
        if (["failed", "cancelled"].includes(now.state))
          throw new Error(`the import ended: ${JSON.stringify(now)}`);
        return now.state === "done" && now.model;
      },
      "the import",
      20,
    );
  }

  async make() {
    const { server } = this;
    await server.json("POST", "/projects", { name: "Site" });
    await server.json("POST", "/users", { user: "guest" });
    await server.json("POST", "/groups", { name: "Students", members: ["guest"] });
    // No request changes the users of these invitations. Otherwise a request could, for example,
    // disable a user, and the invitation would no longer be valid.
    this.invitations = [];
    for (const user of ["newcomer", "other-newcomer"])
      this.invitations.push((await server.json("POST", "/users", { user })).path.split("#")[1]);
    for (const name of ["Wall", "Wall 2"]) await this.#import(name, "site");
    await this.#post("/projects/site/terms?name=Damage", "terms.csv", "text/csv");
    await server.json("POST", "/projects/site/tables", {
      name: "Units",
      columns: kColumns.filter(({ target }) => target !== "units"),
    });
    for (const column of kColumns.filter(({ target }) => target === "units"))
      await server.json("POST", "/tables/units/columns", column);
    await server.json("POST", "/projects/site/tables", {
      name: "Scratch",
      columns: [{ name: "Note" }, { name: "Size", kind: "integer" }],
    });
    for (const key of [1, 2, 3, 4]) {
      const values = {
        code: `SU ${key}`,
        depth: key / 2,
        layers: key,
        period: "1560~",
        state: key % 2 ? "loose" : "firm",
        found: "2024-05-02",
        damage: 1,
        wet: true,
        above: key > 1 ? [key - 1] : [],
      };
      await server.json("POST", "/tables/units/records", { values });
      await server.json("POST", "/tables/scratch/records", {
        values: { note: `Note ${key}`, size: key },
      });
    }
    await this.#post("/tables/units/records/1/attachments?name=north.png", "picture.png");
    await this.#post("/tables/units/records/1/attachments?name=letter.txt", "letter.txt");
    await this.#post("/models/wall/looks?name=Infrared", "picture.png", "image/png");
    await this.#post("/models/wall/photograph-poses?filename=poses.csv", "poses.csv");
    await this.#post("/models/wall/photographs?filename=picture.png", "picture.png", "image/png");
    await this.#post("/tools?name=Leaf&part=dark", "picture.png", "image/png");
    for (const [name, type] of [
      ["Cracks", "u8"],
      ["Moisture", "f32"],
    ])
      await server.json("POST", "/models/wall/layers", { name, type, resolution: 2048 });
    await server.json("POST", "/models/wall-2/layers", {
      name: "Cracks",
      type: "u8",
      resolution: 2048,
    });
    await server.json("POST", "/models/wall/layers", {
      name: "Units",
      kind: "database",
      type: "u16",
      table: "units",
      resolution: 2048,
    });
    const { id } = await server.json("POST", "/models/wall/comments", {
      text: "Since when?",
      position: [10, 10, 0],
      layer: "units",
      record: 1,
    });
    await server.json("POST", `/comments/${id}/replies`, { text: "Since 2019." });
    await this.#view("West");
    await this.#tour("Round", [{ table: "units", keys: [1], columns: [{ column: "code" }] }]);
    await this.#snapshot("First");
    await this.#selection("Sunny");
    await this.#post("/models/wall/tours/round/files?name=north.png", "picture.png");
    const { path } = await this.#kiosk("Hall");
    this.kiosk_link = path.split("/").pop();
    for (const [layer, value, where] of [
      ["cracks", 3, "x < 30"],
      ["moisture", 0.5, "y < 50"],
      ["units", 1, "x < 20 and y < 20"],
      ["units", 2, "x > 80"],
    ])
      await server.json("POST", `/models/wall/layers/${layer}/edits`, {
        op: "fill",
        mode: "where",
        where,
        value,
      });
    await this.#undo();
    await server.json("POST", "/projects/site/objects", { name: "Wall" });
    await server.json("POST", "/projects/site/bills", { name: "Facade" });
    await server.json("PUT", "/projects/site/metadata", {
      titles: [{ title: "Survey of a wall" }],
      creators: [{ name: "Muster, Ada" }],
      publisher: { name: "Museum" },
      year: 2026,
      rights: [{ license: "CC-BY-4.0" }],
    });
    await server.json("PATCH", "/models/wall", { object: 1, survey_date: "2019-05-01" });
    await server.json("POST", "/models/wall/layers", {
      name: "Risk",
      expression: "if(cracks > 1, 2, 1) * moisture",
      type: "f32",
      resolution: 2048,
    });
    const figure = await server.request(
      "POST",
      "/models/wall/figures",
      { dpi: 50 },
      { Prefer: "respond-async" },
    );
    this.figure_job = String((await figure.json()).id);
    await wait_for(
      async () => (await server.json("GET", `/jobs/${this.figure_job}`)).state === "done",
      "a figure",
      100,
    );
    for (const format of ["png", "npy"])
      this.files[`cracks.${format}`] = Buffer.from(
        await (
          await server.request("GET", `/models/wall/layers/cracks/texels.${format}`)
        ).arrayBuffer(),
      );
  }

  #view(name) {
    const camera = {
      view: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -300, 1],
      projection: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.1, -1, 0, 0, -21, 0],
      width: 400,
      height: 400,
    };
    return this.server.json("POST", "/models/wall/views", {
      name,
      text: "The west.",
      camera,
      layers: [{ layer: "cracks", opacity: 0.5 }],
    });
  }

  #snapshot(name) {
    return this.server.json("POST", "/models/wall/snapshots", { name });
  }

  #selection(name) {
    const definition = { audience: "everyone", within: { where: "true" } };
    return this.server.json("POST", "/models/wall/selections", { name, ...definition });
  }

  #tour(name, records = []) {
    const stops = [{ view: "west", title: { en: "The west" }, layers: ["cracks"], records }];
    return this.server.json("POST", "/models/wall/tours", { name, languages: ["en", "es"], stops });
  }

  #kiosk(name) {
    return this.server.json("POST", "/models/wall/tours/round/kiosks", { name });
  }

  async #undo() {
    const { server } = this;
    await server.json("POST", "/models/wall-2/layers", {
      name: "Undone",
      type: "u8",
      resolution: 2048,
    });
    await server.json("POST", "/projects/site/tables", { name: "Undone" });
    for (const value of [1, 2, 3, 4]) {
      await server.json("POST", "/models/wall-2/layers/undone/edits", {
        op: "fill",
        mode: "where",
        where: "x < 30",
        value,
      });
      await server.json("POST", "/tables/undone/columns", { name: `Column ${value}` });
    }
    for (let n = 0; n < 4; ++n) {
      await server.json("POST", "/models/wall-2/layers/undone/undo");
      await server.json("POST", "/tables/undone/undo");
    }
    await server.json("POST", "/models/wall-2/layers", {
      name: "Reviewed",
      type: "u8",
      resolution: 2048,
      review: true,
    });
    const annotator = await server.add_person("rita", "annotator");
    for (const value of [1, 2, 3, 4]) {
      const waits = await fetch(`${server.url}/api/v1/models/wall-2/layers/reviewed/edits`, {
        method: "POST",
        headers: { "Content-Type": "application/json", Authorization: `Bearer ${annotator.token}` },
        body: JSON.stringify({ op: "fill", mode: "where", where: `x < ${20 * value}`, value }),
      });
      if (!waits.ok)
        throw new Error(`an edit that waits for review: ${waits.status} ${await waits.text()}`);
    }
  }

  /**
   * Makes another object of a kind, and returns its name in paths. It must not need anything that a
   * request may have deleted, for example record 1.
   */
  async spare(kind) {
    const { server } = this;
    const name = `Spare ${++this.#made}`;
    switch (kind) {
      case "project":
        return (await server.json("POST", "/projects", { name })).slug;
      case "model":
        return String(await this.#import(name, "default"));
      case "layer":
        return (
          await server.json("POST", "/models/wall/layers", {
            name,
            type: "u8",
            resolution: 2048,
            visible: false,
          })
        ).slug;
      case "entry": {
        const { id } = await server.json("POST", "/models/wall/layers", {
          name,
          type: "u8",
          resolution: 2048,
          visible: false,
        });
        await server.request("DELETE", `/models/wall/layers/${id}`);
        return `layer-${id}`;
      }
      case "look":
        return (
          await this.#post(
            `/models/wall-2/looks?name=${encodeURIComponent(name)}`,
            "picture.png",
            "image/png",
          )
        ).slug;
      case "photograph": {
        await this.#post("/models/wall/photograph-poses", Buffer.from(poses_of(name)));
        const { photographs } = await server.json("GET", "/models/wall/photographs");
        return String(photographs.find((photograph) => photograph.name === name).id);
      }
      case "tool":
        return (
          await this.#post(`/tools?name=${encodeURIComponent(name)}`, "picture.png", "image/png")
        ).slug;
      case "bill":
        return String((await server.json("POST", "/projects/site/bills", { name })).id);
      case "object":
        return String((await server.json("POST", "/projects/site/objects", { name })).id);
      case "table":
        return (await server.json("POST", "/projects/site/tables", { name })).slug;
      case "column":
        return (await server.json("POST", "/tables/scratch/columns", { name })).column.slug;
      case "key":
        return String(
          (await server.json("POST", "/tables/units/records", { values: { code: name } })).key,
        );
      case "attachment":
        return String(
          (
            await this.#post(
              `/tables/units/records/2/attachments?name=${encodeURIComponent(`${name}.txt`)}`,
              "letter.txt",
            )
          ).attachments[0].id,
        );
      case "view":
        return (await this.#view(name)).slug;
      case "snapshot":
        return (await this.#snapshot(name)).slug;
      case "selection":
        return (await this.#selection(name)).slug;
      case "tour":
        return (await this.#tour(name)).slug;
      case "kiosk":
        return String((await this.#kiosk(name)).kiosk.id);
      case "comment":
        return String(
          (
            await server.json("POST", "/models/wall/comments", {
              text: name,
              position: [50, 50, 0],
            })
          ).id,
        );
      case "user":
        return (await server.json("POST", "/users", { user: `spare-${this.#made}` })).user.user;
      case "group": {
        const { id } = await server.json("POST", "/groups", { name });
        await server.json("PUT", `/projects/site/groups/${id}`, { role: "viewer" });
        return String(id);
      }
      case "token":
        return String((await server.json("POST", "/me/tokens", { name })).token.id);
      case "session":
        await fetch(`${server.url}/api/v1/login`, {
          method: "POST",
          headers: {
            "Content-Type": "application/json",
            "X-Forwarded-For": `10.0.0.${this.#made % 250}`,
          },
          body: JSON.stringify({ token: server.token }),
        });
        return String((await server.json("GET", "/me/sessions")).sessions[0]?.id ?? 1);
      case "job":
        return String(
          (
            await this.#post(
              `/models?filename=wall.ply&name=${encodeURIComponent(name)}`,
              "wall.ply",
            )
          ).id,
        );
      default:
        throw new Error(`there are no spare ones of ${kind}`);
    }
  }
}
