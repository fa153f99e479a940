// SPDX-License-Identifier: Apache-2.0
// Robots of the page: their motion, and the numbers that the shaders of skins read.

// One robot, decoded. app/export/html_file.cpp writes its tables.
class PageRobot {
  constructor(description, tables) {
    Object.assign(this, description);
    this.positions = tables.positions;  // per frame and mass, in steps
    this.faceMasses = tables.faces;
    this.neighbors = tables.neighbors;
    this.faceBits = tables.face_bits;   // shape, and the material's index << 2
    this.springs = tables.springs;      // two masses, and the rest length in steps of rest_step
    this.faceCount = this.faceMasses.length / 3;
    this.springCounts = new Float32Array(this.masses);
    for (let i = 0; i < this.springs.length; i += 3) {
      ++this.springCounts[this.springs[i]];
      ++this.springCounts[this.springs[i + 1]];
    }
    this.end = this.start + (this.frames - 1) / this.rate;
    this.radius = this.radiusOfRoom();
  }

  // Of the ball around the middle of the masses that the first frame fills.
  radiusOfRoom() {
    const box = new Box(), p = this.positions, s = this.step;
    for (let i = 0; i < 3 * this.masses; i += 3) box.include(p[i] * s, p[i + 1] * s, p[i + 2] * s);
    this.firstBox = box;
    const middle = box.center;
    let radius = 0;
    for (let i = 0; i < 3 * this.masses; i += 3)
      radius = Math.max(radius, norm(subtract([p[i] * s, p[i + 1] * s, p[i + 2] * s], middle)));
    return radius || 0.1;
  }

  // Writes the positions at a time, moved by an offset, into every fourth element of `out`. Returns their box.
  place(time, offset, out, first) {
    const at = clamp((time - this.start) * this.rate, 0, this.frames - 1);
    const frame = Math.min(Math.floor(at), Math.max(this.frames - 2, 0)), share = at - frame;
    const row = 3 * this.masses, p = this.positions, box = new Box();
    const a = frame * row, b = Math.min(frame + 1, this.frames - 1) * row;
    for (let mass = 0; mass < this.masses; ++mass) {
      const i = 3 * mass, to = 4 * (first + mass);
      const x = offset[0] + this.step * (p[a + i] + share * (p[b + i] - p[a + i]));
      const y = offset[1] + this.step * (p[a + i + 1] + share * (p[b + i + 1] - p[a + i + 1]));
      const z = offset[2] + this.step * (p[a + i + 2] + share * (p[b + i + 2] - p[a + i + 2]));
      out[to] = x;
      out[to + 1] = y;
      out[to + 2] = z;
      box.include(x, y, z);
    }
    return box;
  }

  // Writes the mean strain of the springs at each mass [1] behind its position.
  strain(out, first) {
    const s = this.springs;
    for (let mass = 0; mass < this.masses; ++mass) out[4 * (first + mass) + 3] = 0;
    for (let i = 0; i < s.length; i += 3) {
      const a = 4 * (first + s[i]), b = 4 * (first + s[i + 1]), rest = s[i + 2] * this.rest_step;
      const length = Math.hypot(out[b] - out[a], out[b + 1] - out[a + 1], out[b + 2] - out[a + 2]);
      const strain = (length - rest) / rest;
      out[a + 3] += strain;
      out[b + 3] += strain;
    }
    for (let mass = 0; mass < this.masses; ++mass) out[4 * (first + mass) + 3] /= this.springCounts[mass] || 1;
  }

  // How far a muscle is contracted, (L0 - L) / L0 = -amplitude sin(frequency t + phase); half waves only where negative.
  static contraction(material, time) {
    let wave = Math.sin(material.frequency * time + material.phase);
    if (material.half_wave) wave = Math.min(wave, 0);
    return -material.amplitude * wave;
  }
}

// The robots that are shown together, one after another in all arrays.
class Group {
  constructor(robots, offsets) {
    this.robots = robots;
    this.offsets = offsets;
    const sum = (key) => robots.reduce((total, robot) => total + robot[key], 0);
    this.massCount = sum("masses");
    this.faceCount = sum("faceCount");
    const texels = (count) => 1024 * Math.max(1, Math.ceil(count / 1024));
    this.masses = new Float32Array(4 * texels(this.massCount));
    this.faceNormals = new Float32Array(4 * texels(this.faceCount));
    this.massNormals = new Float32Array(4 * texels(this.massCount));
    this.materialCount = robots.reduce((total, robot) => total + robot.materials.length, 0);
    this.materials = new Float32Array(4 * texels(this.materialCount));
    this.faces = new Uint32Array(8 * texels(this.faceCount));
    this.smooth = robots.some((robot) => robot.smooth);
    this.activationEnd = Math.max(...robots.map((robot) => robot.largest_amplitude), 0) || 1;
    this.boxes = [];
    this.fill();
  }

  // What does not change while robots move.
  fill() {
    const none = 0xffffffff;
    let mass = 0, face = 0, material = 0;
    for (const robot of this.robots) {
      for (let i = 0; i < robot.faceCount; ++i) {
        const to = 8 * (face + i), bits = robot.faceBits[i];
        for (let corner = 0; corner < 3; ++corner) this.faces[to + corner] = mass + robot.faceMasses[3 * i + corner];
        this.faces[to + 3] = (bits & 3) | (robot.smooth ? 4 : 0) | ((material + (bits >> 2)) << 3);
        for (let edge = 0; edge < 4; ++edge) {
          const neighbor = robot.neighbors[4 * i + edge];  // relative to the face; 0 = none
          this.faces[to + 4 + edge] = neighbor === 0 ? none : face + i + neighbor;
        }
      }
      for (const { color } of robot.materials) this.materials.set(color, 4 * material++);
      mass += robot.masses;
      face += robot.faceCount;
    }
  }

  // Puts all robots where they are at a time; `values`: "strain" or nothing.
  update(time, values) {
    let first = 0, material = 0;
    this.boxes = this.robots.map((robot, i) => {
      const box = robot.place(time, this.offsets[i], this.masses, first);
      if (values === "strain") robot.strain(this.masses, first);
      const largest = robot.largest_amplitude || 1;
      for (const description of robot.materials)
        this.materials[4 * material++ + 3] = PageRobot.contraction(description, time) / largest;
      first += robot.masses;
      return box;
    });
    this.updateNormals();
  }

  updateNormals() {
    const { masses, faces, faceNormals, massNormals } = this;
    if (this.smooth) massNormals.fill(0);
    for (let face = 0; face < this.faceCount; ++face) {
      const [a, b, c] = [4 * faces[8 * face], 4 * faces[8 * face + 1], 4 * faces[8 * face + 2]];
      const ux = masses[b] - masses[a], uy = masses[b + 1] - masses[a + 1], uz = masses[b + 2] - masses[a + 2];
      const vx = masses[c] - masses[a], vy = masses[c + 1] - masses[a + 1], vz = masses[c + 2] - masses[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      const inverse = 1 / Math.max(Math.sqrt(x * x + y * y + z * z), 1e-20);
      faceNormals[4 * face] = x * inverse;
      faceNormals[4 * face + 1] = y * inverse;
      faceNormals[4 * face + 2] = z * inverse;
      if (!this.smooth) continue;
      for (const corner of [a, b, c]) {  // weighted by area
        massNormals[corner] += x;
        massNormals[corner + 1] += y;
        massNormals[corner + 2] += z;
      }
    }
    if (!this.smooth) return;
    for (let i = 0; i < 4 * this.massCount; i += 4) {
      const inverse = 1 / Math.max(Math.hypot(massNormals[i], massNormals[i + 1], massNormals[i + 2]), 1e-20);
      for (let axis = 0; axis < 3; ++axis) massNormals[i + axis] *= inverse;
    }
  }

  // Strains fill the scale from the middle to both sides; `end` is the strain at its ends.
  scaleValues(end) {
    for (let mass = 0; mass < this.massCount; ++mass)
      this.masses[4 * mass + 3] = clamp(0.5 + (0.5 * this.masses[4 * mass + 3]) / end, 0, 1);
  }
}
