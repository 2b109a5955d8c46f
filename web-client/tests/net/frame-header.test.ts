// The server's tests read the same reference vectors (tests/unit/protocol/frame_header_test.cpp).
import { describe, expect, it } from "vitest";

import golden from "../../../protocol/golden/frame_headers.json";
import { decodeFrame, kFrameHeaderBytes, FrameError } from "../../src/net/frame-header";

function fromHex(hex: string): ArrayBuffer {
  return new Uint8Array((hex.match(/../g) ?? []).map((byte) => parseInt(byte, 16))).buffer;
}

describe("frame header", () => {
  for (const { name, hex, fields } of golden.valid) {
    it(`the golden header "${name}" is read`, () => {
      const { header, payload } = decodeFrame(fromHex(hex));
      expect(header).toEqual(fields);
      expect(payload).toEqual(new Uint8Array(fromHex(hex)).slice(kFrameHeaderBytes));
    });

    it(`"${name}" cut anywhere is refused`, () => {
      const whole = fromHex(hex);
      for (let length = 0; length < whole.byteLength; ++length)
        expect(() => decodeFrame(whole.slice(0, length))).toThrow(FrameError);
    });
  }

  for (const { name, hex, field } of golden.invalid) {
    it(`the broken header "${name}" is refused by its ${field}`, () => {
      expect(() => decodeFrame(fromHex(hex))).toThrow(
        expect.objectContaining({ name: "FrameError", field }),
      );
    });
  }
});
