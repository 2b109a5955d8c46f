// Draws crops of the demo pot at 200 %, for a person to judge: silhouettes, borders of classes and a
// hairline crack, each with 1, 5 and 16 samples per pixel. This is not a test.
//
//   STRATA_BINARY=build/bench/bin/strata node tests/bench/draw_edges.mjs OUTPUT.png
import { writeFileSync } from "node:fs";
import { Browser } from "../e2e/support/js/browser.mjs";
import { pot_camera } from "../e2e/support/js/pot-camera.mjs";
import { StrataServer } from "../e2e/support/js/strata-server.mjs";

const kSamples = { 1: "1 sample", 5: "5 samples", 16: "16 samples" };
const kWidth = 1280,
  kHeight = 800,
  kCrop = [120, 90],
  kScale = 2;
// The upper left corner of each crop in the frame.
const kCrops = {
  silhouette: [312, 260],
  "borders of classes": [560, 470],
  "hairline crack": [400, 380],
};

const [output] = process.argv.slice(2);
if (!output) {
  console.error("draw_edges.mjs OUTPUT.png");
  process.exit(2);
}
const server = new StrataServer({ demo: true });
const browser = await Browser.open();
try {
  await server.start();
  const { page } = browser;
  await browser.sign_in(server, server.token);
  await page.setViewportSize({ width: kWidth, height: kHeight });
  const model = await server.json("GET", "/models/demo-pot");
  const camera = pot_camera(kWidth, kHeight);
  const frames = {};
  for (const samples of Object.keys(kSamples)) {
    const response = await fetch(`${server.url}/api/v1/models/${model.id}/frame`, {
      method: "POST",
      headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "application/json" },
      body: JSON.stringify({ camera, format: "png", samples: Number(samples) }),
    });
    if (!response.ok) throw new Error(await response.text());
    frames[samples] = Buffer.from(await response.arrayBuffer()).toString("base64");
    if (process.env.STRATA_TEST_OUTPUT)
      writeFileSync(
        `${process.env.STRATA_TEST_OUTPUT}/edges_${samples}.png`,
        Buffer.from(frames[samples], "base64"),
      );
  }
  const sheet = await page.evaluate(draw_sheet, { frames, kSamples, kCrops, kCrop, kScale });
  writeFileSync(output, Buffer.from(sheet.split(",")[1], "base64"));
} finally {
  await browser.close();
  await server.remove();
}

/** Runs in the page. */
async function draw_sheet({ frames, kSamples, kCrops, kCrop, kScale }) {
  const [width, height] = kCrop.map((side) => side * kScale);
  const kGap = 12,
    kHead = 28;
  const canvas = document.createElement("canvas");
  canvas.width = (width + kGap) * Object.keys(frames).length + kGap;
  canvas.height = (height + kHead + kGap) * Object.keys(kCrops).length + kGap;
  const draw = canvas.getContext("2d");
  draw.fillStyle = "white";
  draw.fillRect(0, 0, canvas.width, canvas.height);
  draw.imageSmoothingEnabled = false;
  draw.font = "15px sans-serif";
  let x = kGap;
  for (const [samples, data] of Object.entries(frames)) {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    let y = kGap;
    for (const [name, [left, top]] of Object.entries(kCrops)) {
      draw.fillStyle = "black";
      draw.fillText(`${name}: ${kSamples[samples]}`, x, y + 18);
      draw.drawImage(image, left, top, ...kCrop, x, y + kHead, width, height);
      y += height + kHead + kGap;
    }
    x += width + kGap;
  }
  return canvas.toDataURL("image/png");
}
