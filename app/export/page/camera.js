// SPDX-License-Identifier: Apache-2.0
// Vectors, matrices (by columns, as OpenGL has them) and a camera that turns around a target.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const normalized = (a) => scaled(a, 1 / (norm(a) || 1));
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

function product(a, b) {
  const m = new Float32Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row)
      for (let k = 0; k < 4; ++k) m[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return m;
}

// Rows of a matrix whose last row is 0 0 0 1.
function matrixOfRows(rows) {
  const m = new Float32Array(16);
  rows.forEach((row, r) => row.forEach((value, c) => (m[4 * c + r] = value)));
  m[15] = 1;
  return m;
}

class Box {
  low = [Infinity, Infinity, Infinity];
  high = [-Infinity, -Infinity, -Infinity];
  get empty() { return !(this.low[0] <= this.high[0]); }
  get center() { return scaled(add(this.low, this.high), 0.5); }
  get size() { return subtract(this.high, this.low); }
  include(x, y, z) {
    const { low, high } = this;
    if (x < low[0]) low[0] = x;
    if (y < low[1]) low[1] = y;
    if (z < low[2]) low[2] = z;
    if (x > high[0]) high[0] = x;
    if (y > high[1]) high[1] = y;
    if (z > high[2]) high[2] = z;
  }
  includeBox(box) {
    if (box.empty) return;
    this.include(...box.low);
    this.include(...box.high);
  }
  get corners() {
    const list = [];
    for (let i = 0; i < 8; ++i) list.push([0, 1, 2].map((axis) => ((i >> axis) & 1 ? this.high : this.low)[axis]));
    return list;
  }
}

const steepest = 1.5533;  // [rad]

class Orbit {
  target = [0, 0, 0];  // [m]
  distance = 5;        // [m]
  zoom = 1;            // the user's, on top of what shows everything
  aspect = 1;
  covered = 0;         // by the controls, a share of the picture at its lower edge
  headed = 0;          // by the title, at its upper edge
  constructor(azimuth, elevation, fieldOfView) {
    Object.assign(this, { azimuth, elevation, fieldOfView });
  }
  get back() {
    const flat = Math.cos(this.elevation);
    return [flat * Math.cos(this.azimuth), flat * Math.sin(this.azimuth), Math.sin(this.elevation)];
  }
  get right() { return [-Math.sin(this.azimuth), Math.cos(this.azimuth), 0]; }
  get up() { return cross(this.back, this.right); }
  get range() { return this.distance * this.zoom; }  // from the eye to the target [m]
  // The target is in the middle of what nothing covers.
  get eye() {
    return add(this.target, add(scaled(this.back, this.range), scaled(this.up, (this.headed - this.covered) * this.halfHeight * this.range)));
  }
  get halfHeight() { return Math.tan(this.fieldOfView / 2); }  // of the picture at distance 1
  get near() { return 0.02 * this.range; }
  get far() { return 500 * this.range; }

  // The least distance from which all corners are in the picture.
  distanceFor(corners) {
    // On a phone held upright, the width decides.
    const y = this.halfHeight * 0.92 * (1 - this.covered - this.headed), x = this.halfHeight * this.aspect * 0.94;
    let distance = 0;
    for (const corner of corners) {
      const p = subtract(corner, this.target);
      const forward = dot(p, this.back);
      distance = Math.max(distance, forward + Math.abs(dot(p, this.right)) / x, forward + Math.abs(dot(p, this.up)) / y);
    }
    return distance;
  }
  view() {
    const eye = this.eye;
    return matrixOfRows([this.right, this.up, this.back].map((row) => [...row, -dot(row, eye)]));
  }
  projection() {
    const { near, far } = this, m = new Float32Array(16);
    m[0] = 1 / (this.halfHeight * this.aspect);
    m[5] = 1 / this.halfHeight;
    m[10] = (far + near) / (near - far);
    m[11] = -1;
    m[14] = (2 * far * near) / (near - far);
    return m;
  }
  // Shares of the picture's width and height from the upper left corner; depth is negative behind the eye.
  project(point) {
    const p = subtract(point, this.eye), depth = -dot(p, this.back);
    return {
      x: 0.5 + (0.5 * dot(p, this.right)) / (depth * this.halfHeight * this.aspect),
      y: 0.5 - (0.5 * dot(p, this.up)) / (depth * this.halfHeight),
      depth,
    };
  }
  turn(azimuth, elevation, lowest) {
    this.azimuth += azimuth;
    this.elevation = clamp(this.elevation + elevation, lowest, steepest);
  }
  pan(right, up) {
    const height = 2 * this.halfHeight * this.range;
    this.target = add(this.target, add(scaled(this.right, right * height), scaled(this.up, up * height)));
  }
}
