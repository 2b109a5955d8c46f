// Takes the screenshots for the guide (docs/pictures) from the real page. This is not a test.
// `scripts/guide_pictures` runs it. The argument is the folder for the output.
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { Browser } from "../support/js/browser.mjs";
import { kiosk_screens_of } from "../support/js/kiosk-screens.mjs";
import { make_kiosk_site } from "../support/js/kiosk-site.mjs";
import { make_site, screens_of } from "../support/js/screens.mjs";
import { StrataServer } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

// Screens of screens.mjs and kiosk-screens.mjs, and the files for them.
const kPictures = {
  home: "home",
  people: "people",
  "brush: a class": "paint",
  measure: "measure",
  "paint from a file": "maps",
  "fill where": "fill-where",
  templates: "templates",
  views: "saved-views",
  figure: "figure",
  "new tour": "tour",
  table: "table",
  following: "following",
  review: "review",
  comment: "comment",
  activity: "activity",
  "kiosk: a stop": "kiosk",
};
const kWindow = { width: 1280, height: 800 };

const folder = resolve(process.argv[2] ?? "");
if (process.argv.length !== 3) {
  console.error("guide_pictures FOLDER");
  process.exit(2);
}
mkdirSync(folder, { recursive: true });

const server = new StrataServer({ demo: true });
const viewer = await Browser.open({ locale: "en-GB", viewport: kWindow });
const bea = await Browser.open();
const missing = new Set(Object.keys(kPictures));

async function take_all(screens) {
  for (const screen of screens) {
    await screen.start();
    const name = kPictures[screen.name];
    if (name) {
      const path = join(folder, `${name}.jpg`);
      await viewer.settled();
      await viewer.page.screenshot({ path, type: "jpeg", quality: 82 });
      missing.delete(screen.name);
      console.log(path);
    }
    await screen.end?.();
  }
}

try {
  await server.start();
  const site = await make_site(server, bea);
  // only some of the pieces are measured, so the other layers stay visible
  await server.json("POST", "/models/demo-pot/layers/moisture/edits", {
    op: "fill",
    mode: "where",
    erase: true,
    where: "not valid(pieces) or pieces > 3",
  });
  await take_all(screens_of(viewer, texts_of("en"), site));
  await take_all(kiosk_screens_of(viewer, server, await make_kiosk_site(server)));
  if (missing.size > 0) throw new Error(`no such screen: ${[...missing].join(", ")}`);
} finally {
  for (const each of [viewer, bea]) await each.close();
  await server.remove();
}
