// Real Chromium with the real page. Without Chromium or playwright-core, the tests fail in CI, and
// are visibly skipped in a run by hand.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { kRoot, load_module, missing } from "./modules.mjs";
import { decode_png } from "./png.mjs";
import { kLong_ms, wait_for } from "./strata-server.mjs";

const kChromium = process.env.CHROMIUM ?? "/usr/bin/chromium";
const kFlags = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--force-color-profile=srgb",
  "--font-render-hinting=none",
  "--disable-lcd-text",
];

function load_playwright() {
  if (!existsSync(kChromium)) missing(`there is no ${kChromium} (Debian's package chromium)`);
  if (!existsSync(join(kRoot, "web-client", "dist", "index.html")))
    missing("the page is not built: npm run build in web-client");
  return load_module("playwright-core");
}

/** Call this first, so a test that ends because of a missing program leaves no data. */
export const require_browser = () => void load_playwright();

/** Console messages after a test stops the server, for every state of the connections. */
export const kOfLostServer = [
  "WebSocket connection",
  "ERR_CONNECTION_REFUSED",
  "ERR_EMPTY_RESPONSE",
  "ERR_CONNECTION_RESET",
  "ERR_SOCKET_NOT_CONNECTED",
  "ERR_CONNECTION_CLOSED",
];

/** Redoc's message about two schemas of the contract at `/docs`. Redoc omits a part of them. */
export const kOfRedoc = ["oneOf and anyOf are not supported on the same level"];

/** Runs in the page before the page's own scripts. */
function seen_tour() {
  try {
    localStorage.setItem("strata.tour_over", "true");
  } catch {
    // a page without storage, such as about:blank
  }
}

export class Browser {
  /**
   * With `tour` the page offers the introduction to the model's page, as on a first visit.
   * Otherwise this user has seen it.
   */
  static async open({ tour = false, ...options } = {}) {
    const { chromium } = load_playwright();
    const browser = new Browser();
    browser.folder = mkdtempSync(join(tmpdir(), "strata-browser-"));
    browser.complaints = [];
    browser.context = await chromium.launchPersistentContext(browser.folder, {
      executablePath: kChromium,
      headless: true,
      args: kFlags,
      viewport: { width: 1280, height: 800 },
      locale: "en-GB",
      timezoneId: "UTC",
      colorScheme: "light",
      reducedMotion: "reduce",
      ...options,
    });
    if (!tour) await browser.context.addInitScript(seen_tour);
    browser.page = browser.context.pages()[0] ?? (await browser.context.newPage());
    browser.page.setDefaultTimeout(kLong_ms);
    browser.page.on(
      "console",
      (message) =>
        ["error", "warning"].includes(message.type()) &&
        browser.complaints.push(`${message.text()} (${message.location().url})`),
    );
    browser.page.on("pageerror", (error) => browser.complaints.push(String(error.stack ?? error)));
    browser.page.on("websocket", (socket) => browser.watch_cameras(socket));
    return browser;
  }

  /** Keeps the cameras that the page sends, by their number. */
  watch_cameras(socket) {
    this.cameras = new Map();
    socket.on("framesent", ({ payload }) => {
      if (typeof payload !== "string" || !payload.startsWith('{"op":"camera"')) return;
      const { seq, moving, view_id, ...camera } = JSON.parse(payload);
      if (!view_id) this.last_camera = { moving, camera: JSON.stringify(camera) };
      if (!view_id) this.cameras.set(seq, this.last_camera.camera);
    });
  }

  async close() {
    await this.context.close();
    rmSync(this.folder, { recursive: true, force: true });
  }

  /** `expected` are parts of console messages that the test's own faults cause. */
  assert_no_complaints(expected = []) {
    const bad = this.complaints.filter((text) => !expected.some((part) => text.includes(part)));
    if (bad.length > 0) throw new Error(`the page complained:\n${bad.join("\n")}`);
  }

  /** `secret` is the owner's token, or a user of `server.add_person`. */
  async sign_in(server, secret) {
    const data =
      typeof secret === "string"
        ? { token: secret }
        : { user: secret.user, password: secret.password };
    const answer = await this.page
      .context()
      .request.post(`${server.url}/api/v1/login`, { data, headers: { Origin: server.url } });
    if (!answer.ok()) throw new Error(`sign-in: ${answer.status()} ${await answer.text()}`);
    await this.page.goto(server.url);
    await this.page.getByRole("heading", { name: /^(Models|Projects)$/ }).waitFor();
  }

  /** Opens the model page and waits for its first frame. */
  async drawn() {
    await wait_for(() => this.frames().then((count) => count > 0), "the first picture");
  }
  frames() {
    return this.page
      .locator("strata-stage canvas")
      .first()
      .evaluate((canvas) => Number(canvas.dataset.frames ?? 0));
  }

  saved() {
    return this.page.locator('.saving[data-state="saved"]').waitFor();
  }

  async stage_box() {
    return this.page.locator("strata-stage").boundingBox();
  }

  async picture(clip) {
    return decode_png(await this.page.screenshot(clip ? { clip } : {}));
  }

  /**
   * Waits until the page has no open request, the results are drawn, and the stage does not change.
   */
  async idle() {
    await this.page.waitForFunction(async () => {
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      return (document.documentElement.dataset.requests ?? "0") === "0";
    });
    const stages = this.page.locator("strata-stage canvas:not([data-still=true])[data-frames]");
    await wait_for(
      async () => (await stages.count()) === 0,
      "a picture of the stage that is still",
    );
  }

  /**
   * Waits until the stage shows the last camera that the page sent, in full quality. The frame then
   * also shows everything that was changed before this camera was moved.
   */
  async rested() {
    await this.idle();
    await wait_for(async () => {
      const { still, cameraSeq } = await this.page
        .locator("strata-stage canvas")
        .first()
        .evaluate(({ dataset }) => ({ ...dataset }));
      const { moving, camera } = this.last_camera;
      return still === "true" && !moving && this.cameras.get(Number(cameraSeq)) === camera;
    }, "the frame of the last camera");
  }

  /** Returns a screenshot of the stable page, when two consecutive screenshots are the same. */
  async settled(take = () => this.page.screenshot()) {
    await this.idle();
    let last = null;
    return wait_for(
      async () => {
        const now = await take();
        const same = last !== null && now.equals(last);
        last = now;
        return same ? now : null;
      },
      "the picture to settle",
      300,
    );
  }

  /** Drags from point to point, in shares of the stage. */
  async drag(points) {
    const box = await this.stage_box();
    const [first, ...rest] = points.map(([x, y]) => [
      box.x + x * box.width,
      box.y + y * box.height,
    ]);
    await this.page.mouse.move(...first);
    await this.page.mouse.down();
    for (const point of rest) await this.page.mouse.move(...point, { steps: 6 });
    await this.page.mouse.up();
  }

  /** Closes the notices, which cover the stage. Some of them close automatically. */
  async close_notices() {
    const close = this.page.locator("strata-notices").getByRole("button", { name: "Close" });
    await wait_for(async () => {
      await close
        .first()
        .click({ timeout: 1000 })
        .catch(() => {});
      return (await close.count()) === 0;
    }, "notices to be gone");
  }

  async point(x, y) {
    const box = await this.stage_box();
    await this.page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  }

  /** Counts the pixels of the stage with the hue of a color, in any light. */
  async count(color) {
    return count_hue(await this.picture(await this.stage_box()), color);
  }
}

export function has_hue(data, at, color) {
  const brightest = Math.max(data[at], data[at + 1], data[at + 2], 1);
  if (brightest < 24) return false;
  const wanted = Math.max(...color);
  return [0, 1, 2].every((c) => Math.abs(data[at + c] / brightest - color[c] / wanted) < 0.13);
}

export function count_hue({ data }, color) {
  let count = 0;
  for (let at = 0; at < data.length; at += 4) if (has_hue(data, at, color)) ++count;
  return count;
}

export const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
