// Vectors and 4×4 matrices in double precision. Matrices are column-major, as in the protocol.

export type Vec3 = readonly [number, number, number];
export type Vec4 = readonly [number, number, number, number];
export type Mat4 = readonly number[]; // 16 numbers

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const mix = (a: Vec3, b: Vec3, t: number): Vec3 => add(scale(a, 1 - t), scale(b, t));

export function transform(m: Mat4, v: Vec4): Vec4 {
  const row = (r: number): number =>
    m[r]! * v[0] + m[4 + r]! * v[1] + m[8 + r]! * v[2] + m[12 + r]! * v[3];
  return [row(0), row(1), row(2), row(3)];
}

export function multiply(a: Mat4, b: Mat4): Mat4 {
  const product: number[] = [];
  for (let column = 0; column < 4; ++column) {
    product.push(
      ...transform(a, [b[column * 4]!, b[column * 4 + 1]!, b[column * 4 + 2]!, b[column * 4 + 3]!]),
    );
  }
  return product;
}
