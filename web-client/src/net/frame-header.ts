/**
 * Reads the binary messages that contain one rectangle of a frame. protocol/frame.md defines the
 * layout and the numbered rules. The server's counterpart is
 * protocol/cpp/protocol/frame_header.cpp. Tests of both read the same golden vectors.
 */

export const kFrameHeaderBytes = 56;
const MAGIC = 0x46525453; // "STRF", little-endian
const VERSION = 1;
const kMaxSize = 8192;
const CODECS = { 1: "jpeg", 2: "png" } as const;
const KEYFRAME = 1;
const STILL = 2;
const LAST = 4;

export type FrameCodec = (typeof CODECS)[keyof typeof CODECS];

export interface FrameHeader {
  codec: FrameCodec;
  /** Whether the rectangle is the whole frame. */
  keyframe: boolean;
  /** Whether the frame has full quality. No better frame follows until the content changes. */
  still: boolean;
  /**
   * Whether this is the last rectangle of the frame. The page shows the frame and then acknowledges
   * it.
   */
  last: boolean;
  view_id: number;
  frame: number;
  camera_seq: number;
  scene_sequence: number;
  x: number;
  y: number;
  width: number;
  height: number;
  full_width: number;
  full_height: number;
  render_us: number;
  encode_us: number;
  payload_bytes: number;
}

export interface FrameMessage {
  header: FrameHeader;
  /** A JPEG or PNG file. It is a view of the message's buffer, not a copy. */
  payload: Uint8Array<ArrayBuffer>;
}

/** A frame that breaks a rule. `field` is the invalid member. */
export class FrameError extends Error {
  constructor(
    readonly field: string,
    detail: string,
  ) {
    super(`frame not usable: ${field}: ${detail}`);
    this.name = "FrameError";
  }
}

function demand(holds: boolean, field: string, detail: string): asserts holds {
  if (!holds) throw new FrameError(field, detail);
}

/**
 * Returns the header and payload of a message. Throws a FrameError if the message breaks a rule.
 */
export function decodeFrame(message: ArrayBuffer): FrameMessage {
  demand(message.byteLength >= kFrameHeaderBytes, "message", "it has at least 56 bytes");
  const view = new DataView(message);
  demand(view.getUint32(0, true) === MAGIC, "magic", "it starts with STRF");
  demand(view.getUint8(4) === VERSION, "version", "only version 1 is known");
  const codec = CODECS[view.getUint8(5) as keyof typeof CODECS] as FrameCodec | undefined;
  demand(codec !== undefined, "codec", "known are 1 (JPEG) and 2 (PNG)");
  const flags = view.getUint16(6, true);
  demand((flags & ~(KEYFRAME | STILL | LAST)) === 0, "flags", "bits above the third are zero");
  const header: FrameHeader = {
    codec,
    keyframe: (flags & KEYFRAME) !== 0,
    still: (flags & STILL) !== 0,
    last: (flags & LAST) !== 0,
    view_id: view.getUint32(8, true),
    frame: view.getUint32(12, true),
    camera_seq: safeInteger(view, 16, "camera_seq"),
    scene_sequence: safeInteger(view, 24, "scene_sequence"),
    x: view.getUint16(32, true),
    y: view.getUint16(34, true),
    width: view.getUint16(36, true),
    height: view.getUint16(38, true),
    full_width: view.getUint16(40, true),
    full_height: view.getUint16(42, true),
    render_us: view.getUint32(44, true),
    encode_us: view.getUint32(48, true),
    payload_bytes: view.getUint32(52, true),
  };
  check(header);
  demand(
    message.byteLength - kFrameHeaderBytes === header.payload_bytes,
    "payload_bytes",
    "the payload is exactly the rest of the message",
  );
  return { header, payload: new Uint8Array(message, kFrameHeaderBytes) };
}

function safeInteger(view: DataView, offset: number, field: string): number {
  const value = view.getBigUint64(offset, true);
  demand(value <= BigInt(Number.MAX_SAFE_INTEGER), field, "it is at most 2^53 - 1");
  return Number(value);
}

/** Checks rules 5 to 10, the conditions between the members. */
function check(h: FrameHeader): void {
  demand(h.view_id <= 15, "view_id", "a view is 0 to 15");
  demand(
    h.full_width >= 1 && h.full_width <= kMaxSize,
    "full_width",
    "a picture is 1 to 8192 pixels wide",
  );
  demand(
    h.full_height >= 1 && h.full_height <= kMaxSize,
    "full_height",
    "a picture is 1 to 8192 pixels high",
  );
  demand(
    h.width >= 1 && h.x + h.width <= h.full_width,
    "width",
    "the rectangle lies within the picture",
  );
  demand(
    h.height >= 1 && h.y + h.height <= h.full_height,
    "height",
    "the rectangle lies within the picture",
  );
  const whole = h.width === h.full_width && h.height === h.full_height;
  demand(!h.keyframe || whole, "keyframe", "a keyframe is the whole picture");
  demand(h.payload_bytes >= 1, "payload_bytes", "a rectangle has bytes");
}
