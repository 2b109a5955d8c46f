#!/usr/bin/env node
// Measures how two pages survive faults of the example of a cluster (examples/cluster). Two people
// paint one model in Chromium, through nginx, while the node of the model is killed, and while the
// PostgreSQL primary is killed.
//
//     STRATA_BINARY=build/release/bin/strata tests/bench/page_faults.mjs [--rounds N] [--output FOLDER]
//
// Prints a Markdown table, and writes pictures of both pages to FOLDER: every half second, from the
// fault of the first round until both pages paint again. For each fault, there is a folder with all
// pictures, and a sheet (node_killed.jpg, primary_killed.jpg).
//
// seconds   from the kill until both pages have drawn a batch of a stroke that they first sent after
//           the kill, and that is saved
// lost      batches that a page knows to be saved, and that the history does not contain
// doubled   batches that the history contains twice, or that no page has sent
//
// Exits with 1 if a batch is lost or doubled. A round takes two to three minutes. `./test` unpacks
// the programs that this needs, and the page must be built.
import { mkdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { Browser } from "../e2e/support/js/browser.mjs";
import { NodeSite } from "../e2e/support/js/nodes.mjs";
import { wait_for } from "../e2e/support/js/strata-server.mjs";
import { texts_of } from "../e2e/support/js/texts.mjs";
import { unsaved_ids } from "../e2e/support/js/unsaved.mjs";

const kModel = "ball";
const kPicture_ms = 500; // between two pictures of a sheet
const kPicturesAfter = 3; // pictures after both pages paint again
const kColumns = 8;
const kWidth = 240; // of a small picture
const kFrameHeader = { view_id: 8, scene_sequence: 24, bytes: 56 }; // protocol/frame.md
const words = texts_of("en");

const { values } = parseArgs({
  options: {
    rounds: { type: "string", default: "1" },
    output: { type: "string", default: "page-faults" },
  },
});
const output = resolve(values.output);
process.env.STRATA_MERGE_AFTER = "0"; // a merge replaces the batches that this program compares

/** The batches of strokes that a page has sent, and what it knows about them. */
class Batches {
  constructor(page) {
    this.sent = new Map(); // id → {first_ms, place, sequence}
    this.places = new Map(); // stroke and number → the batch
    this.saved = new Set(); // ids
    this.refused = new Set(); // ids
    this.shown = []; // [time, newest edit] of frames, since `begin`
    page.on("websocket", (socket) => {
      socket.on("framesent", ({ payload }) => this.#sends(payload));
      socket.on("framereceived", ({ payload }) => this.#receives(payload));
    });
  }

  #sends(payload) {
    if (typeof payload !== "string" || !payload.startsWith('{"op":"stroke.extend"')) return;
    const { id, stroke, n } = JSON.parse(payload);
    if (this.sent.has(id)) return;
    const batch = { id, stroke, n, first_ms: Date.now() };
    this.sent.set(id, batch);
    this.places.set(`${stroke} ${n}`, batch);
  }

  #receives(payload) {
    if (typeof payload !== "string") return this.#sees(payload);
    const message = JSON.parse(payload);
    if (message.op === "saved" && message.stroke) {
      const batch = this.places.get(`${message.stroke} ${message.n}`);
      if (!batch) return;
      batch.sequence = message.sequence;
      this.saved.add(batch.id);
    } else if (message.op === "problem" && this.sent.has(message.ref)) {
      // The page sends a batch again if the server cannot save it now.
      if (![429, 503].includes(message.status)) this.refused.add(message.ref);
    } else if (message.op === "welcome") {
      for (const { stroke, n } of message.strokes)
        for (const batch of this.sent.values())
          if (batch.stroke === stroke && batch.n <= n) this.saved.add(batch.id);
    }
  }

  #sees(payload) {
    if (payload.length < kFrameHeader.bytes || payload.readUInt32LE(kFrameHeader.view_id) !== 0)
      return;
    this.shown.push([Date.now(), Number(payload.readBigUInt64LE(kFrameHeader.scene_sequence))]);
  }

  begin() {
    this.shown = [];
  }

  /** Returns when the page had drawn a saved batch that it first sent after a time, or undefined. */
  painted_since(begun_ms) {
    const times = [...this.sent.values()]
      .filter(({ id, first_ms, sequence }) => first_ms > begun_ms && sequence && this.saved.has(id))
      .map((batch) => {
        const shown = this.shown.find(
          ([at, sequence]) => at > batch.first_ms && sequence >= batch.sequence,
        );
        return shown?.[0];
      })
      .filter((at) => at !== undefined);
    return times.length > 0 ? Math.min(...times) : undefined;
  }
}

/** A person who paints short strokes in one part of the stage until `stop`. */
class Person {
  #paints = null;
  #leaves = false;

  static async open(site, place) {
    const person = new Person();
    person.place = place;
    person.browser = await Browser.open();
    person.page = person.browser.page;
    person.batches = new Batches(person.page);
    await person.browser.sign_in(site, site.owner);
    await person.page.goto(`${site.url}/models/${kModel}`);
    await person.browser.drawn();
    await person.page.getByRole("button", { name: words.layers.select("Marks") }).click();
    await person.page.keyboard.press("b");
    return person;
  }

  paint() {
    this.#leaves = false;
    this.#paints = this.#strokes();
  }

  async #strokes() {
    for (let n = 0; !this.#leaves; ++n) {
      const y = 0.35 + 0.3 * ((n * 0.382) % 1);
      await this.browser.drag([
        [this.place, y],
        [this.place + 0.08, y + 0.03],
      ]);
      await this.page.waitForTimeout(100);
    }
  }

  async stop() {
    this.#leaves = true;
    await this.#paints;
  }

  picture() {
    return this.page.screenshot({ type: "jpeg", quality: 60 });
  }
}

/** Takes pictures of all pages from now until `finish`. */
class Film {
  constructor(people) {
    this.people = people;
    this.begun = Date.now();
    this.rows = []; // {seconds, pictures}
    this.done = this.#roll();
  }

  async #roll() {
    for (let left = kPicturesAfter; left > 0; left -= this.finished ? 1 : 0) {
      const at = Date.now();
      const pictures = await Promise.all(this.people.map((person) => person.picture()));
      this.rows.push({ seconds: (at - this.begun) / 1000, pictures });
      await new Promise((ready) => setTimeout(ready, Math.max(0, at + kPicture_ms - Date.now())));
    }
  }

  async finish() {
    this.finished = true;
    await this.done;
  }
}

/** Writes the pictures to a folder, and the sheet with all of them next to it. */
async function write_pictures(film, title, seconds) {
  const folder = join(output, title.replaceAll(" ", "_"));
  mkdirSync(folder, { recursive: true });
  for (const { seconds: at, pictures } of film.rows)
    for (const [page, picture] of pictures.entries())
      writeFileSync(join(folder, `${at.toFixed(1).padStart(5, "0")}_${page + 1}.jpg`), picture);
  const shot = (picture) =>
    `<img width="${kWidth}" src="data:image/jpeg;base64,${picture.toString("base64")}">`;
  const figures = film.rows.map(
    ({ seconds: at, pictures }) =>
      `<figure>${pictures.map(shot).join("")}<figcaption>${at.toFixed(1)} s</figcaption></figure>`,
  );
  const html = `<!doctype html><meta charset="utf-8"><style>
    body { margin: 16px; font: 13px system-ui, sans-serif; background: #ddd; color: #111; }
    main { display: grid; grid-template-columns: repeat(${kColumns}, ${kWidth}px); gap: 10px 6px; }
    figure { margin: 0; } img { display: block; margin-bottom: 3px; }
  </style><p>${title}; both pages paint again after ${seconds.toFixed(1)} s</p><main>${figures.join("\n")}</main>`;
  const browser = await Browser.open({
    viewport: { width: kColumns * (kWidth + 6) + 32, height: 900 },
  });
  try {
    await browser.page.setContent(html);
    await browser.page.evaluate(() =>
      Promise.all([...document.images].map((image) => image.decode())),
    );
    writeFileSync(
      `${folder}.jpg`,
      await browser.page.screenshot({ type: "jpeg", quality: 70, fullPage: true }),
    );
  } finally {
    await browser.close();
  }
}

async function history(site) {
  const rows = [];
  for (;;) {
    const page = await site.json(
      "GET",
      `/models/${kModel}/layers/marks/edits?limit=1000&offset=${rows.length}`,
    );
    rows.push(...page.edits);
    if (page.edits.length === 0 || rows.length >= page.total) return rows.map(({ id }) => id);
  }
}

/** Kills a part while everybody paints. Returns the figures of this round, and the pictures. */
async function measure(site, people, part) {
  const started = Date.now();
  for (const person of people) {
    person.batches.begin();
    person.paint();
  }
  await wait_for(
    () => people.every(({ batches }) => batches.painted_since(started) !== undefined),
    "the first strokes",
  );
  const killed = await site.command(part);
  const begun = Date.now();
  const film = new Film(people);
  await site.command("kill", killed);
  const ended = Date.now(); // before this time, the part may have saved a batch
  const painted = await wait_for(() => {
    const times = people.map(({ batches }) => batches.painted_since(ended));
    return times.includes(undefined) ? null : times;
  }, "both pages to paint again");
  await film.finish();
  for (const person of people) await person.stop();
  await site.command("up");
  await wait_for(
    async () =>
      (await Promise.all(people.map(({ page }) => unsaved_ids(page)))).flat().length === 0,
    "all to be saved",
  );
  return { seconds: (Math.max(...painted) - begun) / 1000, film };
}

/** Compares the history with what all pages have sent since the start. */
async function compare(site, people) {
  const there = await history(site);
  const ids = new Set(there);
  const all = (name) => people.flatMap(({ batches }) => [...batches[name].keys()]);
  const sent = new Set(all("sent"));
  const refused = new Set(all("refused"));
  // After all is saved, the history contains every batch that the server has not refused.
  const lost = [...sent].filter((id) => !ids.has(id) && !refused.has(id));
  lost.push(...all("saved").filter((id) => !ids.has(id) && refused.has(id)));
  const doubled = there.length - ids.size + [...ids].filter((id) => !sent.has(id)).length;
  return { saved: ids.size, lost: lost.length, doubled };
}

const percentile = (numbers, share) =>
  numbers.toSorted((a, b) => a - b)[Math.max(0, Math.ceil(share * numbers.length) - 1)];

function table(rounds) {
  const lines = [
    "| event | rounds | seconds, p50 | p95 | saved batches | lost | doubled |",
    "|---|---|---|---|---|---|---|",
  ];
  for (const [event, rows] of Object.entries(rounds)) {
    const seconds = [0.5, 0.95].map((share) =>
      percentile(
        rows.map((row) => row.seconds),
        share,
      ).toFixed(1),
    );
    const sums = ["saved", "lost", "doubled"].map((name) =>
      rows.reduce((sum, row) => sum + row[name], 0),
    );
    lines.push(`| ${[event, rows.length, ...seconds, ...sums].join(" | ")} |`);
  }
  return lines.join("\n");
}

const kEvents = { "node killed": "owner", "primary killed": "primary" };
const rounds = { "node killed": [], "primary killed": [] };
const site = new NodeSite({ program: "serve_cluster.py" });
const people = [];
try {
  mkdirSync(output, { recursive: true });
  await site.start();
  for (const place of [0.4, 0.52]) people.push(await Person.open(site, place));
  let before = { saved: 0, lost: 0, doubled: 0 };
  for (let round = 1; round <= Number(values.rounds); ++round)
    for (const [event, part] of Object.entries(kEvents)) {
      const { seconds, film } = await measure(site, people, part);
      const total = await compare(site, people);
      const found = { seconds };
      for (const name of Object.keys(before)) found[name] = total[name] - before[name];
      before = total;
      rounds[event].push(found);
      console.error(`round ${round}, ${event}: ${JSON.stringify(found)}`);
      if (round === 1) await write_pictures(film, event, seconds);
    }
  console.log(table(rounds));
  process.exitCode = before.lost + before.doubled > 0 ? 1 : 0;
} finally {
  for (const person of people) await person.browser.close();
  await site.remove();
}
