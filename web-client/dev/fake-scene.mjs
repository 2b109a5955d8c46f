// An egg with relief and painted layers, drawn by casting a ray per pixel: something to look at while the page is
// developed without the real server. Not fast, not the real edit.

import { deflateSync } from "node:zlib";

const kRadii = [49, 46, 52]; // mm
const kColumns = 1024;
const kRows = 512;

export const kBounds = { min: kRadii.map((r) => -r), max: kRadii.map((r) => r) };

function invert(m) {
  const a = Array.from({ length: 4 }, (_, r) => [0, 1, 2, 3].map((c) => m[c * 4 + r]).concat([0, 1, 2, 3].map((c) => (c === r ? 1 : 0))));
  for (let c = 0; c < 4; ++c) {
    let pivot = c;
    for (let r = c; r < 4; ++r) if (Math.abs(a[r][c]) > Math.abs(a[pivot][c])) pivot = r;
    [a[c], a[pivot]] = [a[pivot], a[c]];
    const scale = 1 / a[c][c];
    for (let k = 0; k < 8; ++k) a[c][k] *= scale;
    for (let r = 0; r < 4; ++r) {
      if (r === c) continue;
      const factor = a[r][c];
      for (let k = 0; k < 8; ++k) a[r][k] -= factor * a[c][k];
    }
  }
  return Array.from({ length: 16 }, (_, i) => a[i % 4][4 + Math.floor(i / 4)]);
}

const multiply = (a, b) =>
  Array.from({ length: 16 }, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[k * 4 + (i % 4)] * b[Math.floor(i / 4) * 4 + k], 0));

/** A function from a window pixel to the surface point there, or null. */
export function caster(camera) {
  const inverse = invert(multiply(camera.projection, camera.view));
  const unproject = (x, y, z) => {
    const p = [0, 1, 2, 3].map((r) => inverse[r] * x + inverse[4 + r] * y + inverse[8 + r] * z + inverse[12 + r]);
    return [p[0] / p[3], p[1] / p[3], p[2] / p[3]];
  };
  return (px, py) => {
    const [x, y] = [(px / camera.width) * 2 - 1, 1 - (py / camera.height) * 2];
    const near = unproject(x, y, -1);
    const far = unproject(x, y, 1);
    const o = near.map((v, i) => v / kRadii[i]);
    const d = far.map((v, i) => (v - near[i]) / kRadii[i]);
    const [a, b, c] = [d[0] ** 2 + d[1] ** 2 + d[2] ** 2, o[0] * d[0] + o[1] * d[1] + o[2] * d[2], o[0] ** 2 + o[1] ** 2 + o[2] ** 2 - 1];
    const root = b * b - a * c;
    if (root < 0) return null;
    const t = (-b - Math.sqrt(root)) / a;
    if (t < 0 || t > 1) return null;
    const unit = o.map((v, i) => v + t * d[i]);
    return { unit, position: unit.map((v, i) => v * kRadii[i]) };
  };
}

const cell_of = (unit) => {
  const column = Math.floor(((Math.atan2(unit[1], unit[0]) / (2 * Math.PI) + 1) % 1) * kColumns);
  const row = Math.min(kRows - 1, Math.floor(((unit[2] + 1) / 2) * kRows));
  return row * kColumns + column;
};

export function new_paint() {
  return { values: new Float32Array(kColumns * kRows), valid: new Uint8Array(kColumns * kRows) };
}

/** Each cell of the egg has about the same area. */
export const kAreaPerCell_m2 = (4 * Math.PI * 49e-3 * 49e-3) / (kColumns * kRows);

export function paint_stroke(paint, begin, path) {
  const cast = caster(begin.camera);
  const per_mm = begin.camera.height / 2 / 110;
  const radius = begin.radius_px ?? begin.radius_mm * per_mm;
  for (let i = 0; i < path.length; ++i) {
    const [a, b] = [path[Math.max(0, i - 1)], path[i]];
    const [x0, x1] = [Math.min(a[0], b[0]) - radius, Math.max(a[0], b[0]) + radius];
    const [y0, y1] = [Math.min(a[1], b[1]) - radius, Math.max(a[1], b[1]) + radius];
    const length2 = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2;
    for (let y = Math.floor(y0); y <= y1; y += 1) {
      for (let x = Math.floor(x0); x <= x1; x += 1) {
        const t = length2 ? Math.max(0, Math.min(1, ((x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])) / length2)) : 0;
        const [dx, dy] = [x - a[0] - t * (b[0] - a[0]), y - a[1] - t * (b[1] - a[1])];
        if (begin.shape === "square" ? Math.max(Math.abs(dx), Math.abs(dy)) > radius : dx * dx + dy * dy > radius * radius) continue;
        const hit = cast(x + 0.5, y + 0.5);
        if (!hit) continue;
        const cell = cell_of(hit.unit);
        paint.valid[cell] = begin.erase ? 0 : 1;
        paint.values[cell] = begin.erase ? 0 : begin.value;
      }
    }
  }
}

export function value_at(paint, unit) {
  const cell = cell_of(unit);
  return paint.valid[cell] ? { valid: true, value: paint.values[cell] } : { valid: false };
}

const hex = (color) => [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));

function color_of(palette, value) {
  if (palette.mode === "categorical") return hex(palette.points.find((p) => p.at === value)?.color ?? "#999999");
  const points = palette.points;
  let k = 0;
  while (k < points.length - 2 && points[k + 1].at <= value) ++k;
  const [a, b] = [points[k], points[k + 1] ?? points[k]];
  const t = Math.max(0, Math.min(1, (value - a.at) / (b.at - a.at || 1)));
  const [ca, cb] = [hex(a.color), hex(b.color)];
  return ca.map((v, i) => v + (cb[i] - v) * t);
}

/** `layers`: [{paint, palette, opacity}] bottom to top. Returns a PNG. */
export function render(camera, layers, step = 1) {
  const [width, height] = [Math.ceil(camera.width / step), Math.ceil(camera.height / step)];
  const cast = caster(camera);
  const raw = Buffer.alloc((width * 3 + 1) * height);
  const light = [0.35, -0.6, 0.72];
  for (let y = 0; y < height; ++y) {
    let at = y * (width * 3 + 1) + 1;
    for (let x = 0; x < width; ++x) {
      const hit = cast((x + 0.5) * step, (y + 0.5) * step);
      let color = [228, 224, 215];
      if (hit) {
        const [u, v, w] = hit.unit;
        const relief = 0.06 * Math.sin(18 * w + 3 * Math.sin(7 * Math.atan2(v, u))) + 0.03 * Math.sin(53 * u) * Math.sin(47 * v);
        const shade = 0.5 + 0.5 * Math.max(0, u * light[0] + v * light[1] + w * light[2] + relief);
        color = [201, 158, 122];
        for (const layer of layers) {
          const cell = cell_of(hit.unit);
          if (!layer.paint.valid[cell]) continue;
          const over = color_of(layer.palette, layer.paint.values[cell]);
          color = color.map((c, i) => c + (over[i] - c) * layer.opacity);
        }
        color = color.map((c) => Math.min(255, c * shade * 1.12));
      }
      raw[at++] = color[0];
      raw[at++] = color[1];
      raw[at++] = color[2];
    }
  }
  return { width, height, bytes: png(width, height, raw) };
}

function png(width, height, raw) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(data.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(crc(body), body.length + 4);
    return out;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([
    Buffer.from("89504e470d0a1a0a", "hex"),
    chunk("IHDR", head),
    chunk("IDAT", deflateSync(raw, { level: 1 })),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

const kCrcTable = Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; ++k) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n >>> 0;
});

function crc(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) c = kCrcTable[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}
