// Two users at one model: each sees the participants, the other's pointer, and the other's strokes
// while they are painted. One user follows the other's view, invites the other to follow, and is
// notified when the other leaves.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Browser, rgb } from "../support/js/browser.mjs";
import { attach_log, test } from "../support/js/cases.mjs";
import { decode_png } from "../support/js/png.mjs";
import { StrataServer, wait_for } from "../support/js/strata-server.mjs";
import { texts_of } from "../support/js/texts.mjs";

const words = texts_of("en");

const kOutput = process.env.STRATA_TEST_OUTPUT ?? "/tmp/strata-together";
const kMagenta = "#ff00ff"; // no part of the pot has this hue
const kEnough = 150; // minimum number of pixels of a visible stroke
const kPhone = { width: 390, height: 844 };
const kDesk = { width: 1280, height: 800 };
const kCrowd = [
  "Carl Diaz",
  "Dora Maar",
  "Emil Nolde",
  "Fatma Aliye Topuz of the long and sonorous name",
  "Gia",
  "Hal Ito",
];
const kColors = ["#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7b5ea7", "#5c7a29"];

mkdirSync(kOutput, { recursive: true });
const shot = async (who, name) =>
  writeFileSync(join(kOutput, `together_${name}.png`), await who.settled());

const pose_of = ({ view, projection, width, height }) =>
  JSON.stringify([view, projection, width, height]);

/**
 * Records the messages between a page and the server: only the newest message of each op, in `sent`
 * and `heard`.
 */
function listen(who) {
  who.sent = {};
  who.heard = {};
  who.page.on("websocket", (socket) => {
    const keep =
      (where) =>
      ({ payload }) => {
        if (typeof payload !== "string") return;
        const message = JSON.parse(payload);
        // When the view stops, the page sends the last camera again. The server need not draw
        // this camera, so a frame may still have the earlier number.
        if (message.op === "camera")
          message.drawn_from =
            where.camera && pose_of(where.camera) === pose_of(message)
              ? where.camera.drawn_from
              : message.seq;
        where[message.op] = message;
      };
    socket.on("framesent", keep(who.sent));
    socket.on("framereceived", keep(who.heard));
  });
}
const bea_as_heard = () => anna.heard.presence?.users.find(({ name }) => name === "bea");

/** The matrices are column-major, as in the protocol. */
const times = (m, v) =>
  [0, 1, 2, 3].map((row) =>
    [0, 1, 2, 3].reduce((sum, column) => sum + m[4 * column + row] * v[column], 0),
  );
/** Returns a point's position in the window of a camera, from its matrices. */
function projected({ view, projection, width, height }, place) {
  const [x, y, , w] = times(projection, times(view, [...place, 1]));
  return { x: (x / w / 2 + 0.5) * width, y: (0.5 - y / w / 2) * height };
}
const same_view = (a, b) =>
  a && b && Math.max(...a.view.map((value, index) => Math.abs(value - b.view[index]))) < 1e-6;
const at_rest = (who) =>
  wait_for(
    async () => {
      const canvas = await who.page
        .locator("strata-stage canvas")
        .evaluate(({ dataset }) => ({ ...dataset }));
      return canvas.still === "true" && Number(canvas.cameraSeq) >= who.sent.camera?.drawn_from;
    },
    "a still picture of the newest camera",
    100,
  );
/** Returns the position of Bea's pointer on Anna's page, in CSS pixels of the stage. */
const cursor_at = () =>
  cursor.evaluate((element) => {
    const [box, stage] = [
      element.getBoundingClientRect(),
      element.getRootNode().host.getBoundingClientRect(),
    ];
    return { x: box.left - stage.left, y: box.top - stage.top, classes: element.className };
  });
async function cursor_comes_to(wanted, tolerance, what) {
  let last = null;
  await wait_for(async () => {
    if ((await cursor.count()) !== 1) return false;
    last = await cursor_at();
    return Math.hypot(last.x - wanted.x, last.y - wanted.y) <= tolerance;
  }, what).catch((late) => {
    throw new Error(
      `${late.message}: it is at ${JSON.stringify(last)} instead of ${JSON.stringify(wanted)}`,
    );
  });
}
const people = (who) => who.page.locator("strata-people-menu");
const entry = (who, name) => people(who).getByRole("menuitem", { name });
const open_people = (who) => people(who).locator(".faces").click();
async function choose(who, name) {
  await open_people(who);
  await entry(who, name).click();
}
const bar = (who) => who.page.locator("strata-together-bar button");

let anna, bea, server, cursor, person, box, at, point;

test.beforeAll(async () => {
  [anna, bea] = [await Browser.open(), await Browser.open()];
  server = new StrataServer({ demo: true });

  cursor = anna.page.locator("strata-people-overlay .person");
  await server.start();
  for (const { id } of (await server.json("GET", "/models/demo-pot/layers")).layers)
    // other layers could have pixels of the same color
    await server.json("PATCH", `/models/demo-pot/layers/${id}`, { visible: false });
  const palette = { mode: "categorical", points: [{ at: 1, color: kMagenta, label: "Soot" }] };
  await server.json("POST", "/models/demo-pot/layers", {
    name: "Traces",
    type: "u8",
    resolution: 4096,
    palette,
  });
  person = await server.add_person("bea", "annotator");
  await server.json("PATCH", "/users/bea", { full_name: "Bea Ost" });
});

test("who is here: oneself first, the other by full name", async () => {
  for (const who of [anna, bea]) listen(who);
  await anna.sign_in(server, server.token);
  await bea.sign_in(server, person);
  for (const who of [anna, bea]) {
    await who.page.goto(`${server.url}/models/demo-pot`);
    await who.drawn();
  }
  await anna.page.getByLabel("2 people have this model open: owner (you), Bea Ost").waitFor();
  await bea.page.getByLabel("2 people have this model open: Bea Ost (you), owner").waitFor();
  const faces = await people(anna)
    .locator(".faces .face")
    .evaluateAll((all) => all.map(({ textContent, title }) => [textContent.trim(), title]));
  assert.deepEqual(faces, [
    ["O", "owner (you)"],
    ["BO", "Bea Ost"],
  ]);
});

test("a person with two windows is one", async () => {
  const second = await bea.context.newPage();
  await second.goto(`${server.url}/models/demo-pot`);
  await wait_for(() => anna.heard.presence?.users.length === 3, "the second window");
  assert.equal(
    new Set(
      anna.heard.presence.users.filter(({ name }) => name === "bea").map(({ color }) => color),
    ).size,
    1,
  );
  await anna.page.getByLabel(/2 people have this model open/).waitFor();
  await second.close();
});

test("from the sixth on they are counted, and the menu lists all of them", async () => {
  const crowd = await anna.context.newPage();
  await crowd.routeWebSocket(/\/live$/, (page) => {
    const server = page.connectToServer();
    server.onMessage((text) => {
      if (typeof text === "string" && JSON.parse(text).op === "presence") {
        const message = JSON.parse(text);
        kCrowd.forEach((full_name, index) =>
          message.users.push({
            session: `00000000-0000-4000-8000-00000000000${index}`,
            name: `user${index}`,
            full_name,
            color: kColors[index],
          }),
        );
        page.send(JSON.stringify(message));
      } else {
        page.send(text);
      }
    });
  });
  await crowd.goto(`${server.url}/models/demo-pot`);
  await crowd.getByLabel(/^8 people have this model open: owner \(you\), /).waitFor();
  const folded = crowd.locator("strata-people-menu .faces .face");
  assert.deepEqual([await folded.count(), (await folded.last().textContent()).trim()], [6, "+3"]);
  await crowd.locator("strata-people-menu .faces").click();
  // includes the user's own other window
  assert.equal(
    await crowd
      .locator("strata-people-menu")
      .getByRole("menuitem", { name: /^(..\s*)?Follow / })
      .count(),
    8,
  );
  await crowd.screenshot({ path: join(kOutput, "together_crowd_1280.png") });
  await crowd.setViewportSize(kPhone);
  await crowd.screenshot({ path: join(kOutput, "together_crowd_390.png") });
  await crowd.close();
  await wait_for(() => anna.heard.presence.users.length === 2, "the second window to go");
});

test("her pointer is where she points: in the same view at the same pixel", async () => {
  await Promise.all([at_rest(anna), at_rest(bea)]);
  assert.ok(same_view(anna.sent.camera, bea.sent.camera), "both see what everybody sees first");
  box = await bea.stage_box();
  at = { x: Math.round(box.width * 0.53), y: Math.round(box.height * 0.55) };
  point = (x, y) => bea.page.mouse.move(box.x + x, box.y + y);
  await point(at.x, at.y);
  await cursor_comes_to(at, 1.5, "her pointer on Anna's page");
  assert.ok(!(await cursor_at()).classes.includes("hidden"), "what she points at is in front");
  assert.equal(await cursor.locator("b").textContent(), "Bea Ost");
  assert.equal(
    await anna.page.evaluate(
      ([x, y]) =>
        document.elementsFromPoint(x, y).some((each) => each.localName === "strata-people-overlay"),
      [box.x + at.x, box.y + at.y],
    ),
    false,
  );
});

test("from another side it is where the camera's matrices say, and hidden from behind", async () => {
  await anna.page.keyboard.press("ArrowLeft");
  await anna.page.keyboard.press("ArrowUp");
  await at_rest(anna);
  await cursor_comes_to(
    projected(anna.sent.camera, bea_as_heard().pointer.position),
    1,
    "her pointer after Anna turned",
  );
  assert.ok(!(await cursor_at()).classes.includes("hidden"), "what she points at is in front");
  await anna.page.keyboard.press("2");
  await at_rest(anna);
  await wait_for(
    async () => (await cursor_at()).classes.includes("hidden"),
    "her pointer to be hidden behind the pot",
  );
  await cursor_comes_to(
    projected(anna.sent.camera, bea_as_heard().pointer.position),
    1,
    "it to be behind",
  );
  await anna.page.keyboard.press("1");
  await at_rest(anna);
  await wait_for(
    async () => !(await cursor_at()).classes.includes("hidden"),
    "her pointer to be seen again",
  );
});

test("the brush in her hand is as large as where she paints, and her paint is there before she lets go", async () => {
  await bea.page.getByRole("button", { name: words.layers.select("Traces") }).click();
  await bea.page.keyboard.press("b");
  for (let i = 0; i < 6; ++i) await bea.page.keyboard.press("]");
  await bea.page.keyboard.press("1");
  await at_rest(bea);
  await point(at.x - 20, at.y);
  const own_radius = await bea.page
    .locator("strata-stage svg.over circle")
    .first()
    .getAttribute("r");
  await wait_for(async () => {
    const circles = await cursor
      .locator("circle")
      .evaluateAll((all) => all.map((circle) => Number(circle.getAttribute("r"))));
    return circles.length > 0 && Math.abs(circles[0] / Number(own_radius) - 1) < 0.05;
  }, `her brush of ${own_radius} px on Anna's page`);
  assert.equal(await anna.count(rgb(kMagenta)), 0);
  await bea.page.mouse.down();
  await bea.page.mouse.move(box.x + at.x + 60, box.y + at.y + 10, { steps: 8 });
  await wait_for(
    async () => (await anna.count(rgb(kMagenta))) > kEnough,
    "her paint on Anna's page while she draws",
    150,
  );
  assert.equal(await bea.page.locator("strata-stage .surface.paint").count(), 1);
  await shot(anna, "brush_1280");
  await bea.page.mouse.up();
  await bea.saved();
  await bea.page.keyboard.press("v");
});

test("following: the other's view, in their colour, wherever they turn", async () => {
  await point(at.x, at.y);
  await open_people(anna);
  await shot(anna, "menu_1280");
  await entry(anna, "Follow Bea Ost").click();
  await bar(anna).getByText(words.together.following("Bea Ost")).waitFor();
  for (const key of ["ArrowLeft", "ArrowLeft", "ArrowLeft", "ArrowDown", "+"])
    await bea.page.keyboard.press(key);
  await wait_for(() => same_view(anna.sent.camera, bea.sent.camera), "Anna's camera to be Bea's");
  await Promise.all([at_rest(anna), at_rest(bea)]);
  await bea.page.mouse.move(5, 5); // the pointer would make the frames differ
  await cursor.waitFor({ state: "detached" });
  const [mine, hers] = await Promise.all(
    [anna, bea].map(async (who) => {
      const url = await who.page
        .locator("strata-stage canvas")
        .evaluate((canvas) => canvas.toDataURL("image/png"));
      return decode_png(Buffer.from(url.split(",")[1], "base64")).data;
    }),
  );
  assert.equal(mine.length, hers.length);
  let difference = 0;
  for (let i = 0; i < mine.length; ++i) difference += Math.abs(mine[i] - hers[i]);
  assert.ok(
    difference / mine.length < 0.5,
    `the pictures differ by ${difference / mine.length} of 255`,
  );
  await wait_for(
    () => bea.heard.presence?.users.some(({ following }) => following !== undefined),
    "Bea to hear of it",
  );
  await open_people(bea);
  assert.ok(
    await entry(bea, /owner.*follows you/).isDisabled(),
    "in a circle nobody gets anywhere",
  );
  await bea.page.keyboard.press("Escape");
  await shot(anna, "following_1280");
});

test("on a phone all that she sees is seen, from where she stands", async () => {
  await anna.page.getByRole("button", { name: words.model.hide_panel }).click();
  await anna.page.setViewportSize(kPhone);
  await wait_for(() => anna.sent.camera.height > anna.sent.camera.width, "the window of the phone");
  await at_rest(anna);
  const eye = ({ view }) =>
    [0, 1, 2].map(
      (c) => -[0, 1, 2].reduce((sum, row) => sum + view[4 * c + row] * view[12 + row], 0),
    );
  eye(anna.sent.camera).forEach((value, index) =>
    assert.ok(Math.abs(value - eye(bea.sent.camera)[index]) < 1e-6, "another eye"),
  );
  // Half of the horizontal and vertical field of view, as tangents, for each camera.
  const [own, other] = [anna.sent.camera, bea.sent.camera].map(({ projection }) => [
    1 / projection[0],
    1 / projection[5],
  ]);
  assert.ok(
    Math.abs(own[0] / other[0] - 1) < 1e-6 && own[1] > other[1],
    `${own} does not hold ${other}`,
  );
  await bea.page.keyboard.press("b");
  await point(at.x, at.y);
  await cursor.waitFor({ state: "attached" });
  await shot(anna, "following_390");
  await bea.page.keyboard.press("v");
  await open_people(anna);
  await shot(anna, "menu_390");
  await anna.page.keyboard.press("Escape");
  await anna.page.setViewportSize(kDesk);
  await anna.page.getByRole("button", { name: words.model.show_panel }).click();
  await wait_for(() => anna.sent.camera.width > anna.sent.camera.height, "the window of the desk");
  await wait_for(
    () => same_view(anna.sent.camera, bea.sent.camera),
    "Anna's camera to be Bea's again",
  );
});

test("a move of one's own stops it, and so does Escape", async () => {
  await at_rest(anna);
  await anna.drag([
    [0.3, 0.3],
    [0.36, 0.32],
  ]);
  await bar(anna).waitFor({ state: "detached" });
  await wait_for(
    () => bea.heard.presence.users.every(({ following }) => following === undefined),
    "Bea to hear of it",
  );
  assert.ok(!same_view(anna.sent.camera, bea.sent.camera));
  await choose(anna, "Follow Bea Ost");
  await wait_for(() => same_view(anna.sent.camera, bea.sent.camera), "to follow again");
  await anna.page.keyboard.press("Escape");
  await bar(anna).waitFor({ state: "detached" });
});

test("somebody asks to look along: the others get a notice, and she sees who follows", async () => {
  await choose(bea, /Invite to follow me/);
  await bar(bea).getByText(words.together.leading(0)).waitFor();
  await anna.page.getByText(words.together.invites("Bea Ost")).waitFor();
  await anna.page
    .locator("strata-notices")
    .getByRole("button", { name: words.together.accept, exact: true })
    .click();
  await bar(bea).getByText(words.together.leading(1)).waitFor();
  await shot(bea, "leading_1280");
  await bea.page.keyboard.press("ArrowRight");
  await wait_for(() => same_view(anna.sent.camera, bea.sent.camera), "Anna to look along");
});

test("she takes it back and asks again: who went their own way is asked again", async () => {
  await anna.page.keyboard.press("Escape");
  await bar(bea).getByText(words.together.leading(0)).waitFor();
  await bar(bea).click();
  await bar(bea).waitFor({ state: "detached" });
  await wait_for(() => bea_as_heard().leading === false, "Anna to hear that it is over");
  await choose(bea, /Invite to follow me/);
  await anna.page.getByText(words.together.invites("Bea Ost")).waitFor();
  await shot(anna, "asked_1280");
  await anna.page.setViewportSize(kPhone);
  await shot(anna, "asked_390");
  await anna.page.setViewportSize(kDesk);
  await choose(anna, /Follow Bea Ost/);
  await bar(bea).getByText(words.together.leading(1)).waitFor();
});

test("she leaves: who followed her is told", async () => {
  await bea.page.locator("a.home").click();
  await anna.page.getByText(words.together.left("Bea Ost")).waitFor();
  await bar(anna).waitFor({ state: "detached" });
  await anna.page.getByLabel("Only you have this model open: owner (you)").waitFor();
  await shot(anna, "left_1280");
});

test("the pages have nothing to complain of, and the server ends with a clean log", async () => {
  for (const who of [anna, bea]) who.assert_no_complaints();
  assert.equal(await server.signal("SIGTERM"), 0);
  server.assert_clean_log();
});

test.afterEach(({}, info) => attach_log(info, server));
test.afterAll(async () => {
  await anna?.close();
  await bea?.close();
  await server?.remove();
});
