// Reads the pixels of the frame that the 3D view shows.

import type { FrameHeader } from "../../net/frame-header";

/** A frame in full quality that shows the current camera. */
export interface SharpFrame {
  number: number;
  /** A number that only frames of the same camera have. */
  camera: number;
  width: number;
  height: number;
  /** Returns the pixels of a rectangle: red, green, blue and alpha. */
  read(x: number, y: number, width: number, height: number): Uint8ClampedArray;
}

/** The canvas of the 3D view, and the header of the last complete frame on it. */
export interface ShownFrame {
  canvas: HTMLCanvasElement;
  header: FrameHeader;
}

/**
 * Returns a function for `EdgeSnapperHost.frame`. `cameraInFrame` returns a number of the current
 * camera, or null if a frame with this camera number shows an older one.
 */
export function sharpFrames(
  shown: () => ShownFrame | null,
  cameraInFrame: (seq: number) => number | null,
): () => SharpFrame | null {
  // Reading the canvas of the 3D view itself would make the browser draw it without the GPU.
  let copy: CanvasRenderingContext2D | null = null;
  return () => {
    const found = shown();
    if (!found?.header.still) return null;
    const { canvas, header } = found;
    const camera = cameraInFrame(header.camera_seq);
    copy ??= document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    const pixels = copy;
    if (camera === null || !pixels) return null;
    return {
      number: header.frame,
      camera,
      width: header.full_width,
      height: header.full_height,
      read: (x, y, width, height) => {
        pixels.canvas.width = width; // this also clears it
        pixels.canvas.height = height;
        pixels.drawImage(canvas, x, y, width, height, 0, 0, width, height);
        return pixels.getImageData(0, 0, width, height).data;
      },
    };
  };
}
