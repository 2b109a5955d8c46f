// PNG, 8 bits a channel, as browsers and the server write it: {width, height, data} with 4 bytes a pixel.
import { deflateSync, inflateSync, crc32 as zlib_crc32 } from "node:zlib";

const kSignature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]);
const kChannels = { 2: 3, 6: 4 };

const kCrcTable = Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; ++bit) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n >>> 0;
});
const crc32 = zlib_crc32 ?? ((bytes) => { // Node 18 has none
  let crc = 0xffffffff;
  for (const byte of bytes) crc = (crc >>> 8) ^ kCrcTable[(crc ^ byte) & 255];
  return (crc ^ 0xffffffff) >>> 0;
});

const paeth = (a, b, c) => {
  const p = a + b - c;
  const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
};

export function decode_png(file) {
  if (!file.subarray(0, 8).equals(kSignature)) throw new Error("not a PNG");
  let header = null;
  const parts = [];
  for (let at = 8; at < file.length; ) {
    const length = file.readUInt32BE(at);
    const type = file.toString("latin1", at + 4, at + 8);
    const body = file.subarray(at + 8, at + 8 + length);
    if (type === "IHDR") header = { width: body.readUInt32BE(0), height: body.readUInt32BE(4), depth: body[8], color: body[9], interlace: body[12] };
    if (type === "IDAT") parts.push(body);
    at += 12 + length;
  }
  const channels = kChannels[header.color];
  if (header.depth !== 8 || !channels || header.interlace) throw new Error(`a PNG of another kind: ${JSON.stringify(header)}`);
  const { width, height } = header;
  const raw = inflateSync(Buffer.concat(parts));
  const row = width * channels;
  const data = new Uint8Array(width * height * 4);
  let above = new Uint8Array(row);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (row + 1)];
    const line = raw.subarray(y * (row + 1) + 1, (y + 1) * (row + 1));
    for (let i = 0; i < row; ++i) {
      const left = i >= channels ? line[i - channels] : 0;
      const corner = i >= channels ? above[i - channels] : 0;
      const add = [0, left, above[i], (left + above[i]) >> 1, filter === 4 ? paeth(left, above[i], corner) : 0][filter];
      line[i] += add;
    }
    for (let x = 0; x < width; ++x) {
      for (let c = 0; c < 3; ++c) data[(y * width + x) * 4 + c] = line[x * channels + c];
      data[(y * width + x) * 4 + 3] = channels === 4 ? line[x * channels + 3] : 255;
    }
    above = line;
  }
  return { width, height, data };
}

export function encode_png({ width, height, data }) {
  const row = width * 3;
  const raw = Buffer.alloc(height * (row + 1));
  let above = new Uint8Array(row);
  for (let y = 0; y < height; ++y) {
    const line = new Uint8Array(row);
    for (let x = 0; x < width; ++x) for (let c = 0; c < 3; ++c) line[x * 3 + c] = data[(y * width + x) * 4 + c];
    // The filter of the smallest sum, as the specification advises.
    let least = Infinity;
    for (const filter of [0, 1, 2, 4]) {
      const filtered = Buffer.alloc(row + 1);
      filtered[0] = filter;
      let sum = 0;
      for (let i = 0; i < row; ++i) {
        const [left, corner] = i >= 3 ? [line[i - 3], above[i - 3]] : [0, 0];
        const guess = filter === 0 ? 0 : filter === 1 ? left : filter === 2 ? above[i] : paeth(left, above[i], corner);
        filtered[i + 1] = line[i] - guess;
        sum += Math.min(filtered[i + 1], 256 - filtered[i + 1]);
      }
      if (sum >= least) continue;
      least = sum;
      filtered.copy(raw, y * (row + 1));
    }
    above = line;
  }
  const chunk = (type, body) => {
    const named = Buffer.concat([Buffer.from(type, "latin1"), body]);
    const whole = Buffer.alloc(named.length + 8);
    whole.writeUInt32BE(body.length, 0);
    named.copy(whole, 4);
    whole.writeUInt32BE(crc32(named), named.length + 4);
    return whole;
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([kSignature, chunk("IHDR", header), chunk("IDAT", deflateSync(raw, { level: 9 })), chunk("IEND", Buffer.alloc(0))]);
}
