// SPDX-License-Identifier: Apache-2.0
// Draws a group of robots and their surroundings with WebGL 2, by the shaders of the program.

// The texture units of all samplers.
const units = ["masses", "face_normals", "mass_normals", "materials", "faces", "colormap", "caustics_tile", "sand_tile",
               "ground_light_map", "shadow_map", "shadow_depths", "roof"];
const shadowSide = 1024, roofSide = 512, groundSide = 256, causticsSide = 256, causticsCells = 96, sandSide = 512;
const colorModes = { material: 0, activation: 1, strain: 2 };
const surroundingsNumbers = { none: 0, water: 1, land: 2 };

class View {
  constructor(canvas, page, shaders) {
    const options = { antialias: true, alpha: false, powerPreference: "high-performance" };
    const gl = canvas.getContext("webgl2", options);
    if (!gl) throw new Error("This browser has no WebGL 2, which draws the robots. Try another browser, or switch hardware acceleration on.");
    Object.assign(this, { canvas, gl, page, shaders });
    this.around = surroundingsNumbers[page.surroundings];
    // Light of crossing rays adds up to more than 1.
    this.hasCaustics = this.around === 1 && Boolean(gl.getExtension("EXT_color_buffer_float") || gl.getExtension("EXT_color_buffer_half_float"));
    this.programs = new Map();
    this.frame = new Float32Array(132);
    this.frameBuffer = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.frameBuffer);
    gl.bufferData(gl.UNIFORM_BUFFER, this.frame.byteLength, gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.frameBuffer);
    this.textures = {};
    this.corners = gl.createVertexArray();
    this.cornerBuffer = gl.createBuffer();
    this.nothing = gl.createVertexArray();
    this.makeMaps();
  }

  // Shaders

  // The text of a shader of the program as WebGL takes it: without numbers of bindings and locations.
  text(name, stage, defines, included = new Set()) {
    const isTop = included.size === 0;
    included.add(name);
    const source = this.shaders[name];
    if (source === undefined) throw new Error("no shader is named " + name);
    let text = source.replace(/^#include "(.*)"$/gm, (_, file) =>
      included.has(file) ? "" : this.text(file, stage, "", included));
    if (!isTop) return text;
    text = text.replace(/, binding = \d+/g, "").replace(/layout\((binding|location) = \d+\) (?=uniform)/g, "")
      .replace(/out gl_PerVertex \{[^}]*\};/g, "")
      .replace(stage === "vert" ? /layout\(location = \d+\) (?=(flat )?out)/g : /layout\(location = \d+\) (?=(flat )?in)/g, "")
      .replace(/\) flat out /g, ") out ").replace(/^(out|in) (\w+) (\w+);/gm, "$1 $2 $3;");
    return `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DShadow;
precision highp usampler2D;
#define AROUND ${this.around}
#define OCTAVES 2
${defines}${text}`;
  }

  // `shown`: its color goes to the screen.
  program(vertex, fragment, { defines = "", shown = false } = {}) {
    const key = vertex + fragment + defines;
    if (this.programs.has(key)) return this.programs.get(key);
    const { gl } = this, program = gl.createProgram();
    const attach = (type, text) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    };
    let pixels = this.text(fragment, "frag", defines);
    if (shown) pixels = pixels.replace("void main()", "void light_of_pixel()") + this.shaders["screen.glsl"].replace(
      /^#include "(.*)"$/gm, (_, file) => this.shaders[file]);
    const stages = [attach(gl.VERTEX_SHADER, this.text(vertex, "vert", defines)), attach(gl.FRAGMENT_SHADER, pixels)];
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
      throw new Error(`${vertex}, ${fragment}: ` + stages.map((stage) => gl.getShaderInfoLog(stage)).join("") + gl.getProgramInfoLog(program));
    gl.useProgram(program);
    const block = gl.getUniformBlockIndex(program, "Frame");
    if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
    units.forEach((name, unit) => gl.uniform1i(gl.getUniformLocation(program, name), unit));
    const made = { program, at: (name) => gl.getUniformLocation(program, name) };
    this.programs.set(key, made);
    return made;
  }

  // Textures

  bind(name, texture) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + units.indexOf(name));
    gl.bindTexture(gl.TEXTURE_2D, texture);
  }

  // A texture of numbers, read by index.
  upload(name, format, kind, type, data, width = 1024) {
    const { gl } = this, height = data.length / 4 / width;
    let entry = this.textures[name];
    if (!entry || entry.height !== height) {
      if (entry) gl.deleteTexture(entry.texture);
      entry = this.textures[name] = { texture: gl.createTexture(), height };
      this.bind(name, entry.texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    }
    this.bind(name, entry.texture);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, kind, type, data);
  }

  makeMap(name, format, side, levels, filter, wrap) {
    const { gl } = this, texture = gl.createTexture(), framebuffer = gl.createFramebuffer();
    this.bind(name, texture);
    gl.texStorage2D(gl.TEXTURE_2D, levels, format, side, side);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.LINEAR_MIPMAP_LINEAR : filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
    const isDepth = format === gl.DEPTH_COMPONENT24;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, isDepth ? gl.DEPTH_ATTACHMENT : gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    if (isDepth) gl.drawBuffers([gl.NONE]);
    this.textures[name] = { texture, framebuffer, side };
  }

  makeMaps() {
    const { gl, page } = this;
    this.makeMap("shadow_depths", gl.DEPTH_COMPONENT24, shadowSide, 1, gl.NEAREST, gl.CLAMP_TO_EDGE);
    this.makeMap("roof", gl.DEPTH_COMPONENT24, roofSide, 1, gl.NEAREST, gl.CLAMP_TO_EDGE);
    this.makeMap("ground_light_map", gl.RGBA8, groundSide, 1, gl.LINEAR, gl.CLAMP_TO_EDGE);
    this.makeMap("sand_tile", gl.RGBA8, sandSide, 10, gl.LINEAR, gl.REPEAT);
    this.makeMap("caustics_tile", this.hasCaustics ? gl.R16F : gl.RGBA8, causticsSide, 9, gl.LINEAR, gl.REPEAT);
    // The same depths through a comparing sampler.
    this.bind("shadow_map", this.textures.shadow_depths.texture);
    const sampler = gl.createSampler();
    gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
    // What linear filtering of comparisons does, browsers leave open.
    gl.samplerParameteri(sampler, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.samplerParameteri(sampler, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.bindSampler(units.indexOf("shadow_map"), sampler);
    this.into("sand_tile");
    this.fullscreen(this.program("fullscreen.vert", "sand.frag"));
    this.bind("sand_tile", this.textures.sand_tile.texture);
    gl.generateMipmap(gl.TEXTURE_2D);
    const colors = new Uint8Array(page.colormap.flatMap((hex) => [...this.bytesOf(hex), 255]));
    const texture = gl.createTexture();
    this.bind("colormap", texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, colors.length / 4, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colors);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    if (!this.hasCaustics) {
      this.into("caustics_tile");
      gl.clearColor(1, 1, 1, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
      this.bind("caustics_tile", this.textures.caustics_tile.texture);
      gl.generateMipmap(gl.TEXTURE_2D);
      return;
    }
    const row = causticsCells + 1, indices = [];
    for (let y = 0; y < causticsCells; ++y)
      for (let x = 0; x < causticsCells; ++x) {
        const corner = y * row + x;
        indices.push(corner, corner + 1, corner + row, corner + row, corner + 1, corner + row + 1);
      }
    this.causticsGrid = gl.createVertexArray();
    gl.bindVertexArray(this.causticsGrid);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
  }

  bytesOf(hex) { return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)); }

  // What is drawn from now on goes into a map.
  into(name) {
    const { gl } = this, { framebuffer, side } = this.textures[name];
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, side, side);
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
  }

  fullscreen({ program }) {
    const { gl } = this;
    gl.useProgram(program);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // The scene

  setGroup(group) {
    const { gl } = this;
    this.group = group;
    const corners = new Uint32Array(3 * group.faceCount);
    for (let i = 0; i < corners.length; ++i) corners[i] = i;
    gl.bindVertexArray(this.corners);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.cornerBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 1, gl.UNSIGNED_INT, 0, 0);
    this.upload("faces", gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, group.faces);
  }

  uploadGroup() {
    const { gl, group } = this;
    this.upload("masses", gl.RGBA32F, gl.RGBA, gl.FLOAT, group.masses);
    this.upload("face_normals", gl.RGBA32F, gl.RGBA, gl.FLOAT, group.faceNormals);
    this.upload("mass_normals", gl.RGBA32F, gl.RGBA, gl.FLOAT, group.massNormals);
    this.upload("materials", gl.RGBA32F, gl.RGBA, gl.FLOAT, group.materials);
  }

  drawSkins({ program }) {
    const { gl, group } = this;
    gl.useProgram(program);
    gl.bindVertexArray(this.corners);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * group.faceCount);
  }

  // Rounds up to a multiple of an eighth of the power of two below it, so that the size rarely changes.
  stepped(size) {
    const unit = 2 ** Math.floor(Math.log2(Math.max(size, 1e-6))) / 8;
    return unit * Math.ceil(size / unit);
  }

  // As fit.comp: what the light's map of depths covers.
  fitShadow(box, back) {
    const right = normalized(cross([0, 1, 0], back)), up = cross(back, right);
    const middle = box.center, half = scaled(box.size, 0.5);
    const extent = (axis) => half.reduce((sum, h, i) => sum + h * Math.abs(axis[i]), 0);
    const width = this.stepped(2.1 * Math.max(extent(right), extent(up), 1e-3));
    const depth = this.stepped(2.1 * Math.max(extent(back), 1e-3));
    const texel = width / shadowSide, rounded = (x) => texel * Math.round(x / texel);
    return {
      matrix: matrixOfRows([[...scaled(right, 1 / width), 0.5 - rounded(dot(middle, right)) / width],
                            [...scaled(up, 1 / width), 0.5 - rounded(dot(middle, up)) / width],
                            [...scaled(back, -1 / depth), 0.5 + dot(middle, back) / depth]]),
      width, depth,
    };
  }

  // As fit.comp: corner and side of every place where shadows can fall.
  fitGround(box, toKey, keySize, floor) {
    const drop = Math.max(0, box.high[2] - floor) / Math.max(toKey[2], 0.2);
    const low = [0, 1].map((i) => Math.min(box.low[i], box.low[i] - drop * toKey[i]));
    const high = [0, 1].map((i) => Math.max(box.high[i], box.high[i] - drop * toKey[i]));
    const margin = 0.05 * Math.hypot(high[0] - low[0], high[1] - low[1], drop) + drop * keySize;
    const side = this.stepped(Math.max(high[0] - low[0], high[1] - low[1]) + 2 * margin);
    return [0.5 * (low[0] + high[0]) - 0.5 * side, 0.5 * (low[1] + high[1]) - 0.5 * side, side];
  }

  writeFrame(orbit, style, time, box) {
    const { gl, frame, canvas, page } = this;
    const view = orbit.view(), projection = product(orbit.projection(), view);
    const toKey = normalized(style.to_key), distance = orbit.range;
    const shadow = this.fitShadow(box, toKey);
    const floor = this.floor, ground = this.fitGround(box, toKey, style.key_size, floor);
    const power = Math.log2(distance), whole = Math.floor(power), t = clamp((power - whole - 0.35) / 0.3, 0, 1);
    const octave = t < 1 ? [2 ** whole, 2 ** (whole + 1), t * t * (3 - 2 * t)] : [2 ** (whole + 1), 2 ** (whole + 2), 0];
    frame.set(projection, 0);
    frame.set(view, 32);
    frame.set(shadow.matrix, 48);
    const vectors = [
      [...orbit.eye, time % 3600], [...toKey, style.key_size], [...style.key_light, style.glow], [...style.sky_light, 4.2],
      [...style.ground_light, 0], [...style.backdrop_high, 0], [...style.backdrop_low, 0], [...style.floor_color, 0],
      [...style.line_color, 1], [...scaled(style.fog, 1 / distance), 0.55 * distance],
      [canvas.width, canvas.height, 1 / canvas.width, 1 / canvas.height],
      [orbit.near, orbit.far, orbit.halfHeight * orbit.aspect, orbit.halfHeight], [shadow.width, shadow.depth, 0, 0],
      [...ground, floor], [this.around, this.hasCaustics ? style.caustics : 0, box.high[2], distance], [...octave, 0],
      [0, 0, 0, 0.2 * Math.max(...this.group.robots.map((robot) => robot.radius))]];
    vectors.forEach((vector, i) => frame.set(vector, 64 + 4 * i));
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.frameBuffer);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, frame);
    this.style = style;
    return shadow;
  }

  drawCaustics() {
    const { gl } = this, caustics = this.program("caustics.vert", "caustics.frag");
    this.into("caustics_tile");
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.useProgram(caustics.program);
    gl.uniform1i(caustics.at("cells"), causticsCells);
    gl.uniform1f(caustics.at("pixels"), causticsSide);
    gl.bindVertexArray(this.causticsGrid);
    gl.drawElements(gl.TRIANGLES, 6 * causticsCells * causticsCells, gl.UNSIGNED_SHORT, 0);
    gl.disable(gl.BLEND);
    this.bind("caustics_tile", this.textures.caustics_tile.texture);
    // The finest level is ragged where few rays cross, so sampling starts at the next one.
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_BASE_LEVEL, 0);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_BASE_LEVEL, 1);
  }

  drawDepths(name, matrix) {
    const { gl } = this, depths = this.program("page_shadow.vert", "page_shadow.frag");
    this.into(name);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    gl.useProgram(depths.program);
    gl.uniformMatrix4fv(depths.at("to_map"), false, matrix);
    this.drawSkins(depths);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  // Heights seen from above, for ambient light: box and range as occlusion.glsl has them.
  drawRoof(box, radius) {
    const margin = 2 * radius, side = Math.max(box.size[0], box.size[1]) + 2 * margin;
    const corner = [box.center[0] - side / 2, box.center[1] - side / 2];
    const top = box.high[2] + 1e-3, depth = Math.max(top - box.low[2], 1e-3) * 1.01;
    this.drawDepths("roof", matrixOfRows([[1 / side, 0, 0, -corner[0] / side], [0, 1 / side, 0, -corner[1] / side],
                                          [0, 0, -1 / depth, top / depth]]));
    return { box: [...corner, side, top], range: [depth, radius] };
  }

  // Draws the group as it is now. `color`: a key of colorModes.
  draw(orbit, style, time, color) {
    const { gl, canvas, group } = this;
    const box = new Box();
    group.boxes.forEach((robot) => box.includeBox(robot));
    const shadow = this.writeFrame(orbit, style, time, box);
    this.uploadGroup();
    if (this.hasCaustics) this.drawCaustics();
    this.drawDepths("shadow_depths", shadow.matrix);
    const radius = 0.45 * Math.max(...group.robots.map((robot) => robot.radius));
    const roof = this.drawRoof(box, radius);
    if (this.around !== 0) {
      this.into("ground_light_map");
      this.fullscreen(this.program("fullscreen.vert", "page_ground.frag"));
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.clear(gl.DEPTH_BUFFER_BIT | gl.COLOR_BUFFER_BIT);
    const set = (made) => {
      gl.useProgram(made.program);
      gl.uniform4fv(made.at("roof_box"), roof.box);
      gl.uniform2fv(made.at("roof_range"), roof.range);
      gl.uniform1f(made.at("vignette"), style.vignette);
      return made;
    };
    this.drawSkins(set(this.program("page_skin.vert", "page_skin.frag",
                                    { defines: `#define COLOR_BY ${colorModes[color]}\n`, shown: true })));
    gl.depthFunc(gl.LEQUAL);
    this.fullscreen(set(this.program("page_backdrop.vert", "backdrop.frag", { defines: "#define HORIZON\n", shown: true })));
    if (this.around === 1) this.drawParticles(orbit, time, set);
  }

  drawParticles(orbit, time, set) {
    const { gl, page } = this, particles = set(this.program("page_particle.vert", "particle.frag", { shown: true }));
    const half = 1.1 * 2 ** Math.floor(Math.log2(orbit.range) + 0.5), count = 1500, exposure = 1 / 24;
    const middle = add(orbit.target, scaled(orbit.back, 0.2 * half));
    gl.uniform4f(particles.at("box"), ...middle, half);
    gl.uniform4f(particles.at("flow"), ...page.flow, exposure);
    gl.uniform3f(particles.at("drift"), ...page.flow.map((speed) => (speed * time) % (2 * half)));
    gl.uniform1f(particles.at("share"), 1);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
    gl.depthMask(false);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * count);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}
