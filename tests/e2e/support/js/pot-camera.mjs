// A camera for the demo pot, in the format of the protocol.

/**
 * Returns a camera that sees the pot (105 × 99 × 91 mm, up is z) from slightly above, rotated by an
 * angle.
 */
export function pot_camera(width, height, angle = 0, distance = 240) {
  const [elevation, center] = [0.25, [0, 0, 45]];
  const back = [
    -Math.sin(angle) * Math.cos(elevation),
    -Math.cos(angle) * Math.cos(elevation),
    Math.sin(elevation),
  ];
  const right = [Math.cos(angle), -Math.sin(angle), 0];
  const top = [
    back[1] * right[2] - back[2] * right[1],
    back[2] * right[0] - back[0] * right[2],
    back[0] * right[1] - back[1] * right[0],
  ];
  const eye = center.map((c, i) => c + distance * back[i]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const view = [0, 1, 2]
    .flatMap((i) => [right[i], top[i], back[i], 0])
    .concat([-dot(right, eye), -dot(top, eye), -dot(back, eye), 1]);
  const [near, far, focal] = [120, 380, 1 / Math.tan((30 * Math.PI) / 360)];
  const projection = [
    (focal * height) / width,
    0,
    0,
    0,
    0,
    focal,
    0,
    0,
    0,
    0,
    (far + near) / (near - far),
    -1,
    0,
    0,
    (2 * far * near) / (near - far),
    0,
  ];
  return { view, projection, width, height };
}
