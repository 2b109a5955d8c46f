// A stand-in for the server while the page is developed: `node dev/fake-server.mjs [PORT]` serves dist/ and enough of
// the interface to look at every screen. Token: "museum". State lives in memory.

import { createHash, randomUUID } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { caster, kAreaPerCell_m2, kBounds, new_paint, paint_stroke, render, value_at } from "./fake-scene.mjs";

const port = Number(process.argv[2] ?? 8090);
const dist = fileURLToPath(new URL("../dist", import.meta.url));
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const policy =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

const models = new Map();
const jobs = new Map();
let next_id = 1;

function add_model(name, unit = "mm", verified = true) {
  const id = next_id++;
  const texts = Object.fromEntries(
    ["north", "crs", "inventory_number", "owner", "creator", "captured", "method", "accuracy", "processing", "rights_uri", "credit"].map((k) => [k, ""]),
  );
  models.set(id, {
    id, name, slug: `model-${id}`, project: "default", unit, unit_assumed: !verified, scale_verified: verified, up: "z",
    origin: [0, 0, 0], triangles: 199_988, vertices: 99_996, bounds: kBounds, area_m2: 0.0302,
    atlas: { source: "made", lowest_resolution: 2048, charts: 212, coverage: 0.61, overlap: 0, stretch_mean: 1.2, stretch_p99: 1.9, texel_area_max_m2: 4.1e-8 },
    repairs: [{ what: "dropped degenerate faces", count: 3 }],
    source_files: [{ name: "scan.ply", sha256: "0".repeat(64), bytes: 18_334_201 }],
    default_resolution: 4096, sequence: 0, ...texts, inventory_number: "1924.17", owner: "City museum",
    layers: new Map(), clients: new Set(), version: 1,
  });
  return models.get(id);
}

function add_layer(model, wanted) {
  const id = next_id++;
  const layer = {
    id, model: model.id, name: wanted.name, slug: `layer-${id}`, kind: "numeric", type: wanted.type ?? "u8",
    resolution: wanted.resolution ?? 4096, unit: wanted.unit ?? "", description: wanted.description ?? "",
    palette: wanted.palette, opacity: wanted.opacity ?? 1, visible: true, order: model.layers.size, sequence: 0,
  };
  model.layers.set(id, { layer, paint: new_paint(), version: 1, undo: [] });
  return layer;
}

const view_of = ({ layers: _l, clients: _c, version: _v, ...model }) => model;

const pot = add_model("Amphora fragment 1924.17");
add_layer(pot, {
  name: "Pieces", description: "Sherds as numbered in the 1931 reconstruction.",
  palette: { mode: "categorical", min: 1, max: 4, points: [
    { at: 1, color: "#e69f00ff", label: "Rim" }, { at: 2, color: "#56b4e9ff", label: "Shoulder" },
    { at: 3, color: "#009e73ff", label: "Belly" }, { at: 4, color: "#cc79a7ff", label: "Modern filling" }] }, opacity: 0.6,
});
add_layer(pot, {
  name: "Moisture", type: "f32", unit: "%",
  palette: { mode: "linear", min: 0, max: 40, points: ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"].map((c, i) => ({ at: i * 10, color: `${c}ff` })) },
});
add_layer(pot, { name: "Cracks", palette: { mode: "categorical", min: 1, max: 1, points: [{ at: 1, color: "#d55e00ff", label: "Cracks" }] } });
const [pieces, moisture] = [...pot.layers.values()];
for (let i = 0; i < pieces.paint.valid.length; ++i) {
  const [row, column] = [Math.floor(i / 1024), i % 1024];
  const wave = row + 30 * Math.sin(column / 60) + 12 * Math.sin(column / 17);
  if (wave > 60 && column < 620) {
    pieces.paint.valid[i] = 1;
    pieces.paint.values[i] = wave > 420 ? 1 : wave > 300 ? 2 : wave > 120 ? 3 : 4;
  }
  if (Math.hypot(column - 850, (row - 250) * 1.2) < 130) {
    moisture.paint.valid[i] = 1;
    moisture.paint.values[i] = 40 - Math.hypot(column - 850, (row - 250) * 1.2) / 3.5;
  }
}
add_model("Head of a king");
add_model("Trench 4, east face", "m");

const json = (response, status, body, headers = {}) => {
  response.writeHead(status, { "Content-Type": status >= 400 ? "application/problem+json" : "application/json", ...headers });
  response.end(body === undefined ? "" : JSON.stringify(body));
};
const problem = (response, status, title, detail, field) => json(response, status, { status, title, detail, ...(field ? { field } : {}) });
const etag = (version) => ({ ETag: `"${version}"` });

async function body_of(request) {
  const parts = [];
  for await (const part of request) parts.push(part);
  return Buffer.concat(parts);
}

async function api(request, response, path, query) {
  const signed_in = /strata=museum/.test(request.headers.cookie ?? "");
  const body = await body_of(request);
  const content = () => JSON.parse(body.toString() || "{}");
  if (path === "/login") {
    if (content().token !== "museum") return problem(response, 401, "Not signed in", "The token is not known.");
    return json(response, 204, undefined, { "Set-Cookie": "strata=museum; HttpOnly; SameSite=Strict; Path=/" });
  }
  if (!signed_in) return problem(response, 401, "Not signed in", "Sign in first.");
  if (path === "/logout") return json(response, 204, undefined, { "Set-Cookie": "strata=; Max-Age=0; Path=/" });
  if (path === "/me") return json(response, 200, { user: "owner", role: "owner" });
  if (path === "/models" && request.method === "GET") {
    return json(response, 200, { models: [...models.values()].map(view_of), total: models.size });
  }
  if (path === "/models" && request.method === "POST") return start_job(response, query, body);
  const job = /^\/jobs\/(.+)$/.exec(path);
  if (job) {
    const found = jobs.get(job[1]);
    if (!found) return problem(response, 404, "Not found", "No such job.");
    if (request.method === "DELETE") found.state = "cancelled";
    return json(response, 200, found);
  }
  const parts = path.split("/").slice(1);
  const model = models.get(Number(parts[1]));
  if (parts[0] !== "models" || !model) return problem(response, 404, "Not found", "There is no such model.");
  if (parts.length === 2) return model_request(request, response, model, content);
  if (parts[2] === "frame") {
    const layers = [...model.layers.values()].filter((l) => l.layer.visible).map((l) => ({ paint: l.paint, palette: l.layer.palette, opacity: l.layer.opacity }));
    response.writeHead(200, { "Content-Type": "image/png" });
    return response.end(render(content().camera, layers, 1).bytes);
  }
  if (parts[2] === "layers") return layer_request(request, response, model, parts, content);
  problem(response, 404, "Not found", "No such path.");
}

function start_job(response, query, body) {
  const job = { id: randomUUID(), state: "running", progress: 0, message: "Reading the file" };
  jobs.set(job.id, job);
  const steps = ["Reading the file", "Mending the surface", "Unfolding the surface", "Measuring", "Saving"];
  const timer = setInterval(() => {
    if (job.state === "cancelled") return clearInterval(timer);
    job.progress = Math.min(1, job.progress + 0.07);
    job.message = steps[Math.min(4, Math.floor(job.progress * 5))];
    if (/bad/.test(query.get("filename") ?? "") && job.progress > 0.3) {
      Object.assign(job, { state: "failed", problem: { status: 422, title: "The file is not whole", detail: "The header promises 70 000 vertices, but the file ends after 31 204. Export or copy the scan again." } });
    } else if (job.progress >= 1) {
      Object.assign(job, { state: "done", model: add_model(query.get("name") ?? "Scan", "m", false).id });
    }
    if (job.state !== "running") clearInterval(timer);
  }, 150);
  json(response, 202, job, { Location: `/api/v1/jobs/${job.id}` });
  return body.length;
}

function model_request(request, response, model, content) {
  if (request.method === "DELETE") {
    models.delete(model.id);
    return json(response, 204);
  }
  if (request.method === "PATCH") {
    if (request.headers["if-match"] !== `"${model.version}"`) return problem(response, 412, "Changed by someone else", "Read it again.");
    Object.assign(model, content());
    model.version += 1;
  }
  json(response, 200, view_of(model), etag(model.version));
}

function layer_request(request, response, model, parts, content) {
  const tell = (event, layer) => model.clients.forEach((c) => c.send({ op: "layer", event, layer_id: layer.id, ...(event === "deleted" ? {} : { layer }) }));
  if (parts.length === 3) {
    if (request.method === "GET") return json(response, 200, { layers: [...model.layers.values()].map((l) => l.layer), total: model.layers.size });
    const layer = add_layer(model, content());
    tell("created", layer);
    return json(response, 201, layer, etag(1));
  }
  const entry = model.layers.get(Number(parts[3]));
  if (!entry) return problem(response, 404, "Not found", "There is no such layer.");
  if (parts[4] === "statistics") return json(response, 200, statistics(entry));
  if (request.method === "DELETE") {
    model.layers.delete(entry.layer.id);
    tell("deleted", entry.layer);
    model.clients.forEach((c) => c.draw());
    return json(response, 204);
  }
  if (request.method === "PATCH") {
    Object.assign(entry.layer, content());
    entry.version += 1;
    tell("changed", entry.layer);
    model.clients.forEach((c) => c.draw());
  }
  json(response, 200, entry.layer, etag(entry.version));
}

function statistics({ layer, paint }) {
  const values = [...paint.values].filter((_, i) => paint.valid[i]);
  const counts = new Map();
  for (const value of values) counts.set(value, (counts.get(value) ?? 0) + 1);
  const [min, max] = [Math.min(...counts.keys()), Math.max(...counts.keys())];
  const mean = values.reduce((a, b) => a + b, 0) / values.length;
  const bins = Array.from({ length: 64 }, (_, i) => ({ from: min + ((max - min) * i) / 64, to: min + ((max - min) * (i + 1)) / 64, texels: 0, area_m2: 0 }));
  for (const value of values) bins[Math.min(63, Math.floor(((value - min) / (max - min || 1)) * 64))].area_m2 += kAreaPerCell_m2;
  const none = values.length === 0;
  return {
    texels: values.length, area_m2: values.length * kAreaPerCell_m2, min: none ? null : min, max: none ? null : max,
    mean: none ? null : mean, std: none ? null : Math.sqrt(values.reduce((a, b) => a + (b - mean) ** 2, 0) / values.length),
    histogram: none ? [] : bins,
    keys: layer.type.startsWith("f") ? [] : [...counts].map(([key, texels]) => ({ key, texels, area_m2: texels * kAreaPerCell_m2, centroid: [0, 0, 0], bounds: kBounds })),
  };
}

// ── WebSocket ───────────────────────────────────────────────────────────────────────────────────────────────────────

class Client {
  constructor(socket, model) {
    Object.assign(this, { socket, model, session: randomUUID(), camera: null, seq: 0, frame: 0, unacked: 0, dirty: false, strokes: new Map(), overrides: new Map(), pending: Buffer.alloc(0) });
    this.color = ["#2c6a63", "#9a4a26", "#5b4b8a", "#1f5f99"][model.clients.size % 4];
    model.clients.add(this);
    socket.on("data", (data) => this.on_data(data));
    socket.on("error", () => {});
    socket.on("close", () => {
      model.clients.delete(this);
      tell_presence(model);
    });
  }

  on_data(data) {
    this.pending = Buffer.concat([this.pending, data]);
    for (;;) {
      const b = this.pending;
      if (b.length < 6) return;
      let [length, at] = [b[1] & 127, 2];
      if (length === 126) [length, at] = [b.readUInt16BE(2), 4];
      else if (length === 127) [length, at] = [Number(b.readBigUInt64BE(2)), 10];
      if (b.length < at + 4 + length) return;
      const mask = b.subarray(at, at + 4);
      const body = Buffer.from(b.subarray(at + 4, at + 4 + length).map((byte, i) => byte ^ mask[i % 4]));
      this.pending = b.subarray(at + 4 + length);
      const opcode = b[0] & 15;
      if (opcode === 8) return this.socket.end();
      if (opcode === 1) this.on_message(JSON.parse(body.toString()));
    }
  }

  write(opcode, body) {
    const head = body.length < 126 ? Buffer.from([128 | opcode, body.length]) : Buffer.alloc(body.length < 65536 ? 4 : 10);
    if (head.length === 4) (head[0] = 128 | opcode), (head[1] = 126), head.writeUInt16BE(body.length, 2);
    if (head.length === 10) (head[0] = 128 | opcode), (head[1] = 127), head.writeBigUInt64BE(BigInt(body.length), 2);
    this.socket.write(Buffer.concat([head, body]));
  }
  send(message) {
    this.write(1, Buffer.from(JSON.stringify(message)));
  }

  on_message(m) {
    const handlers = {
      hello: () => {
        this.send({ op: "welcome", session: this.session, user: "owner", role: "owner", model: view_of(this.model), layers: [...this.model.layers.values()].map((l) => l.layer), strokes: [],
          limits: { message_bytes: 262144, path_points: 4096, view_size: 8192, views: 4, frames_in_flight: 2, messages_per_second: 400 } });
        tell_presence(this.model);
      },
      camera: () => {
        this.camera = m;
        this.draw();
      },
      layers: () => {
        this.overrides = new Map(m.layers.map((o) => [o.layer, o]));
        this.draw();
      },
      "stroke.begin": () => {
        const entry = this.model.layers.get(m.layer);
        if (!entry) return this.send({ op: "problem", ref: m.id, status: 404, title: "Layer not found", detail: "Somebody deleted it. Choose another layer." });
        entry.undo.push({ values: entry.paint.values.slice(), valid: entry.paint.valid.slice() });
        this.strokes.set(m.stroke, m);
      },
      "stroke.extend": () => {
        const begin = this.strokes.get(m.stroke);
        if (!begin) return;
        paint_stroke(this.model.layers.get(begin.layer).paint, begin, m.path);
        this.edited(begin.layer, { stroke: m.stroke, n: m.n });
      },
      "stroke.end": () => {},
      edit: () => {
        const { paint, undo } = this.model.layers.get(m.layer);
        undo.push({ values: paint.values.slice(), valid: paint.valid.slice() });
        paint.valid.fill(1);
        paint.values.fill(m.edit.value);
        this.edited(m.layer, { id: m.id });
      },
      undo: () => {
        const entry = this.model.layers.get(m.layer);
        const before = entry.undo.pop();
        if (!before) return this.send({ op: "problem", ref: m.id, status: 409, title: "Nothing to undo", detail: "You have no stroke in this layer that is still in force." });
        Object.assign(entry.paint, before);
        this.edited(m.layer, { id: m.id });
      },
      redo: () => this.send({ op: "problem", ref: m.id, status: 409, title: "Nothing to redo", detail: "You took nothing back in this layer." }),
      ack: () => {
        this.unacked = 0;
        if (this.dirty) this.draw();
      },
      presence: () => {
        const hit = m.pointer && this.camera ? caster(this.camera)(...m.pointer) : null;
        this.pointer = hit ? { position: hit.position } : null;
        tell_presence(this.model);
      },
      pick: () => {
        const hit = caster(this.camera)(m.x, m.y);
        if (!hit) return this.send({ op: "picked", id: m.id, hit: false });
        const values = Object.fromEntries([...this.model.layers.values()].map((l) => [l.layer.slug, value_at(l.paint, hit.unit)]));
        this.send({ op: "picked", id: m.id, hit: true, position: hit.position, values });
      },
    };
    handlers[m.op]?.();
  }

  edited(layer, name) {
    const sequence = ++this.model.sequence;
    this.send({ op: "applied", ...name, sequence });
    setTimeout(() => this.send({ op: "saved", ...name, sequence }), 60);
    for (const client of this.model.clients) {
      client.draw();
      if (client !== this) client.send({ op: "layer", event: "edited", layer_id: layer, sequence });
    }
  }

  draw() {
    this.dirty = true;
    if (!this.camera || this.unacked > 0) return;
    this.dirty = false;
    this.unacked = 1;
    const layers = [...this.model.layers.values()]
      .sort((a, b) => a.layer.order - b.layer.order)
      .map(({ layer, paint }) => ({ paint, palette: layer.palette, opacity: this.overrides.get(layer.id)?.opacity ?? layer.opacity, visible: this.overrides.get(layer.id)?.visible ?? layer.visible }))
      .filter((l) => l.visible);
    const picture = render(this.camera, layers, this.camera.moving ? 3 : 1);
    const head = Buffer.alloc(56);
    head.write("STRF");
    head.set([1, 2, 7, 0], 4);
    head.writeUInt32LE(++this.frame, 12);
    head.writeBigUInt64LE(BigInt(this.camera.seq), 16);
    for (const [at, value] of [[36, picture.width], [38, picture.height], [40, picture.width], [42, picture.height]]) head.writeUInt16LE(value, at);
    head.writeUInt32LE(picture.bytes.length, 52);
    this.write(2, Buffer.concat([head, picture.bytes]));
  }
}

function tell_presence(model) {
  const users = [...model.clients].map((c, i) => ({ session: c.session, name: ["Ana", "Bruno", "Chiara", "Dimitris"][i % 4], color: c.color, ...(c.pointer ? { pointer: c.pointer } : {}) }));
  for (const client of model.clients) client.send({ op: "presence", users });
}

const server = createServer(async (request, response) => {
  const url = new URL(request.url, "http://localhost");
  try {
    if (url.pathname.startsWith("/api/v1")) return await api(request, response, url.pathname.slice(7), url.searchParams);
    const file = extname(url.pathname) ? normalize(url.pathname) : "/index.html";
    const data = await readFile(join(dist, file));
    response.writeHead(200, { "Content-Type": types[extname(file)] ?? "application/octet-stream", "Content-Security-Policy": policy });
    response.end(data);
  } catch (error) {
    problem(response, error.code === "ENOENT" ? 404 : 500, "Not served", String(error));
  }
});

server.on("upgrade", (request, socket) => {
  const model = models.get(Number(/models\/(\d+)\/live/.exec(request.url)?.[1]));
  if (!model) return socket.end("HTTP/1.1 404 Not Found\r\n\r\n");
  const accept = createHash("sha1").update(`${request.headers["sec-websocket-key"]}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest("base64");
  socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\nSec-WebSocket-Protocol: strata.v1\r\n\r\n`);
  new Client(socket, model);
});
server.listen(port, "127.0.0.1", () => console.log(`listening on http://127.0.0.1:${port}`));
