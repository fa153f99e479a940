// SPDX-License-Identifier: Apache-2.0
// Plays the robots of the page: controls, mouse, touch and keys.

const speeds = [0.1, 0.25, 0.5, 1, 2, 4];
const colorNames = { material: "Material", strain: "Strain", activation: "Activation" };
const element = (id) => document.getElementById(id);

function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// A round number that is not below a value.
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((digit) => digit * power >= value * (1 - 1e-6));
}

class Player {
  constructor(page, shaders) {
    this.page = page;
    this.canvas = element("canvas");
    this.view = new View(this.canvas, page, shaders);
    this.orbit = new Orbit(page.view.azimuth, page.view.elevation, page.view.field_of_view);
    this.decoded = new Map();  // robots by index
    this.shown = [];           // indices of robots
    this.selected = null;      // one of them
    this.time = 0;             // [s]
    this.playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.loop = this.follow = true;
    this.speed = 1;
    this.color = "material";
    this.theme = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
    this.resolution = Math.min(devicePixelRatio || 1, 2);
    this.slowFrames = 0;
    this.drawn = 0;  // frames
    this.changed = true;
    this.buildControls();
    new Gestures(this);
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("resize", () => this.resize());
    this.resize();
  }

  // Robots

  async robot(index) {
    if (!this.decoded.has(index)) {
      const description = this.page.robots[index], data = element("robot-" + index);
      this.decoded.set(index, inflated(data.textContent).then((bytes) => {
        data.remove();
        return new PageRobot(description, tablesOf(bytes, description.tables));
      }));
    }
    return this.decoded.get(index);
  }

  // Shows these robots side by side.
  async show(indices) {
    const request = (this.request = Symbol());
    const robots = await Promise.all(indices.map((index) => this.robot(index)));
    if (this.request !== request) return;  // another choice was faster
    this.shown = indices;
    this.selected = null;
    const group = new Group(robots, this.offsetsOf(robots));
    this.group = group;
    this.start = Math.min(...robots.map((robot) => robot.start));
    this.end = Math.max(...robots.map((robot) => robot.end));
    if (!(this.time >= this.start && this.time < this.end)) this.time = this.start;
    this.strainEnd = this.findStrainEnd();
    this.view.setGroup(group);
    this.view.floor = this.floorOf(robots, group.offsets);
    this.labels = indices.map((index, i) => this.makeLabel(this.page.robots[index], i));
    element("labels").replaceChildren(...this.labels);
    element("robots").textContent = this.subtitleOf(robots);
    this.resize();
    this.resetCamera();
    this.showLegend();
    this.showTime();
    if (this.panel === "information") this.showInformation();
  }

  subtitleOf(robots) {
    if (robots.length > 1) return this.page.subtitle || `${robots.length} robots`;
    return [robots[0].name === this.page.title ? "" : robots[0].name, ...robots[0].caption].filter(Boolean).join(" · ");
  }

  // On land a grid on the ground, in water one that faces the eye.
  offsetsOf(robots) {
    if (robots.length === 1) return [[0, 0, 0]];
    const side = 2.25 * Math.max(...robots.map((robot) => robot.radius));
    // Rows on the ground are foreshortened, and hide each other.
    const aspect = this.orbit.aspect * (this.page.ground ? 1.8 : 1), count = robots.length;
    const columns = count <= 2.2 * aspect ? count : clamp(Math.round(Math.sqrt(count * aspect)), 1, count), rows = Math.ceil(count / columns);
    const right = [-Math.sin(this.page.view.azimuth), Math.cos(this.page.view.azimuth), 0];
    const down = this.page.ground ? [-right[1], right[0], 0].map((x) => -x) : [0, 0, -1];
    return robots.map((robot, i) => {
      const inRow = Math.min(columns, count - columns * Math.floor(i / columns));
      const place = add(scaled(right, side * ((i % columns) - (inRow - 1) / 2)),
                        scaled(down, side * (Math.floor(i / columns) - (rows - 1) / 2)));
      const offset = subtract(place, robot.firstBox.center);
      if (this.page.ground) offset[2] = 0;
      return offset;
    });
  }

  floorOf(robots, offsets) {
    if (this.page.ground) return 0;
    let low = Infinity, high = -Infinity, tallest = 0;
    robots.forEach((robot, i) => {
      low = Math.min(low, robot.firstBox.low[2] + offsets[i][2]);
      high = Math.max(high, robot.firstBox.high[2] + offsets[i][2]);
      tallest = Math.max(tallest, robot.firstBox.size[2]);
    });
    return low - 0.5 * (high - low) - 2 * tallest;
  }

  // The scale of strain rests: from the largest but 4 % of the masses, at moments all along the motion.
  findStrainEnd() {
    const values = [];
    for (let i = 0; i < 12; ++i) {
      this.group.update(this.start + ((i + 0.5) / 12) * (this.end - this.start), "strain");
      const step = Math.max(1, Math.floor(this.group.massCount / 1000));
      for (let mass = 0; mass < this.group.massCount; mass += step) values.push(Math.abs(this.group.masses[4 * mass + 3]));
    }
    values.sort((a, b) => a - b);
    return roundUp(Math.max(values[Math.floor(0.96 * (values.length - 1))] || 0, 0.01));
  }

  makeLabel(robot, i) {
    const label = make("button", { class: "label", onclick: () => this.select(this.selected === i ? null : i) },
                       make("b", {}, robot.name));
    for (const line of robot.caption) label.append(make("span", {}, line));
    return label;
  }

  select(i) {
    this.selected = i;
    this.drawnTime = undefined;  // the camera moves there
    this.labels.forEach((label, k) => label.classList.toggle("chosen", k === i));
    this.showInformation();
    this.changed = true;
  }

  // Camera

  resetCamera() {
    this.orbit.azimuth = this.page.view.azimuth;
    this.orbit.elevation = this.page.view.elevation;
    this.orbit.zoom = 1;
    this.group.update(this.time);
    this.frameCamera(Infinity);
    this.changed = true;
  }

  // Moves the camera towards where it shows the robots that it follows. `elapsed` [s]
  frameCamera(elapsed) {
    const boxes = this.selected === null ? this.group.boxes : [this.group.boxes[this.selected]];
    const box = new Box();
    boxes.forEach((robot) => box.includeBox(robot));
    if (box.empty) return;
    const share = 1 - Math.exp(-elapsed / 0.5), { orbit } = this;
    orbit.target = add(orbit.target, scaled(subtract(box.center, orbit.target), share));
    const wanted = 1.12 * orbit.distanceFor(boxes.flatMap((robot) => robot.corners));
    // Bodies that bend change the distance a little all the time; only more than that moves the camera.
    const held = this.wantedDistance;
    if (elapsed === Infinity || !(wanted < held && wanted > 0.75 * held)) this.wantedDistance = wanted;
    orbit.distance += share * (this.wantedDistance - orbit.distance);
  }

  get lowestElevation() {
    const height = this.orbit.target[2] - this.view.floor;
    return clamp(-Math.asin(clamp((0.9 * height) / this.orbit.range, 0, 1)), -steepest, 0.02);
  }

  // Time

  setTime(time) {
    this.time = clamp(time, this.start, this.end);
    this.changed = true;
    this.showTime();
  }
  stepFrames(count) {
    this.setPlaying(false);
    const rate = this.group.robots[0].rate;
    this.setTime(this.start + Math.round((this.time - this.start) * rate + count) / rate);
  }
  setPlaying(playing) {
    this.playing = playing;
    if (playing && this.time >= this.end) this.time = this.start;
    element("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    element("play").classList.toggle("playing", playing);
    this.lastTick = undefined;
    this.changed = true;
  }
  setSpeed(speed) {
    this.speed = speed;
    element("speed").value = String(speed);
  }
  changeSpeed(by) { this.setSpeed(speeds[clamp(speeds.indexOf(this.speed) + by, 0, speeds.length - 1)]); }
  setColor(color) {
    this.color = color;
    element("color").value = color;
    this.showLegend();
    this.changed = true;
  }
  toggle(name, value = !this[name]) {
    this[name] = value;
    element(name).setAttribute("aria-pressed", String(value));
    this.changed = true;
  }

  // One frame of the screen. `now` [ms]
  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const elapsed = this.lastTick === undefined ? 0 : (now - this.lastTick) / 1000;
    this.lastTick = now;
    if (!this.group) return;
    if (this.playing && this.end > this.start) {
      let time = this.time + this.speed * Math.min(elapsed, 0.25);
      if (time >= this.end) {
        if (this.loop) time = this.start + ((time - this.start) % (this.end - this.start));
        else this.setPlaying(false);
      }
      const again = time < this.time;
      this.setTime(time);
      this.draw(this.follow ? (again ? Infinity : elapsed) : 0);
      this.adaptResolution(elapsed);
    } else if (this.changed) {
      this.draw(this.follow && this.time !== this.drawnTime ? Infinity : 0);
    }
  }

  draw(elapsed) {
    this.changed = false;
    this.drawnTime = this.time;
    const strain = this.color === "strain";
    this.group.update(this.time, strain ? "strain" : undefined);
    if (strain) this.group.scaleValues(this.strainEnd);
    if (elapsed > 0) this.frameCamera(elapsed);
    this.orbit.elevation = Math.max(this.orbit.elevation, this.lowestElevation);
    const style = this.page.styles[this.theme][this.color === "material" ? "plain" : "values"];
    this.view.draw(this.orbit, style, this.time, this.color);
    this.placeLabels();
    ++this.drawn;
  }

  // A slow GPU draws fewer pixels.
  adaptResolution(elapsed) {
    this.slowFrames = elapsed > 0.045 ? this.slowFrames + 1 : Math.max(0, this.slowFrames - 2);
    if (this.slowFrames < 12 || this.resolution <= 0.5) return;
    this.slowFrames = 0;
    this.resolution = Math.max(0.5, 0.75 * this.resolution);
    this.resize();
  }

  resize() {
    const width = Math.max(1, Math.round(this.canvas.clientWidth * this.resolution));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * this.resolution));
    this.canvas.width = width;
    this.canvas.height = height;
    this.orbit.aspect = width / height;
    this.orbit.covered = clamp(element("bar").offsetHeight / this.canvas.clientHeight, 0, 0.3);
    // Names stand above robots.
    const head = document.querySelector("header").getBoundingClientRect().bottom - this.canvas.getBoundingClientRect().top;
    this.orbit.headed = clamp((head + (this.shown.length > 1 ? 44 : 0)) / this.canvas.clientHeight, 0, 0.14);
    this.changed = true;
  }

  // Names stand above their robots, where there is room for them.
  placeLabels() {
    const { clientWidth: width, clientHeight: height } = this.canvas, taken = [];
    this.labels.forEach((label, i) => {
      const box = this.group.boxes[i], [x, y] = box.center;
      const at = this.orbit.project([x, y, box.high[2]]);
      const left = at.x * width, top = at.y * height - 8;
      const free = taken.every(([l, t, w, h]) => Math.abs(l - left) > (w + label.offsetWidth) / 2 || Math.abs(t - top) > (h + label.offsetHeight) / 2);
      const visible = at.depth > 0 && left > 0 && left < width && top > 0 && top < height && (free || i === this.selected);
      label.style.visibility = visible && this.shown.length > 1 ? "visible" : "hidden";
      if (!visible) return;
      label.style.transform = `translate(-50%, -100%) translate(${left}px, ${Math.max(top, label.offsetHeight + 60)}px)`;
      taken.push([left, top, label.offsetWidth, label.offsetHeight]);
    });
  }

  // The robot under a point of the canvas in pixels, by the balls around the robots; the nearest of several.
  robotAt(x, y) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    let best = null, nearest = Infinity;
    this.group.boxes.forEach((box, i) => {
      const at = this.orbit.project(box.center);
      if (at.depth <= 0) return;
      const radius = ((0.4 * norm(box.size)) / (at.depth * this.orbit.halfHeight)) * (height / 2);
      if (Math.hypot(at.x * width - x, at.y * height - y) < radius && at.depth < nearest) [best, nearest] = [i, at.depth];
    });
    return best;
  }

  // Controls

  buildControls() {
    const { page } = this;
    document.title = page.title;
    element("title").textContent = page.title;
    element("play").addEventListener("click", () => this.setPlaying(!this.playing));
    element("time").addEventListener("input", (event) => {
      this.setPlaying(false);
      this.setTime(this.start + (Number(event.target.value) / 1000) * (this.end - this.start));
    });
    for (const speed of speeds) element("speed").append(make("option", { value: speed }, `${speed}×`));
    // Keys are for the player again after a choice.
    for (const id of ["speed", "color"]) element(id).addEventListener("change", (event) => event.target.blur());
    element("speed").addEventListener("change", (event) => this.setSpeed(Number(event.target.value)));
    for (const color of Object.keys(colorNames)) element("color").append(make("option", { value: color }, colorNames[color]));
    element("color").addEventListener("change", (event) => this.setColor(event.target.value));
    for (const name of ["loop", "follow"]) {
      element(name).addEventListener("click", () => this.toggle(name));
      this.toggle(name, this[name]);
    }
    element("reset").addEventListener("click", () => this.resetCamera());
    for (const name of ["information", "help"])
      element(name + "-button").addEventListener("click", () => this.openPanel(name));
    element("close").addEventListener("click", () => this.openPanel(null));
    this.setSpeed(1);
    this.setPlaying(this.playing);
    document.documentElement.dataset.theme = this.theme;
  }

  setTheme(theme) {
    this.theme = document.documentElement.dataset.theme = theme;
    this.changed = true;
  }

  showTime() {
    element("clock").textContent = `${this.time.toFixed(2)} s`;
    element("time").value = String(Math.round((1000 * (this.time - this.start)) / (this.end - this.start || 1)));
    element("time").setAttribute("aria-valuetext", element("clock").textContent);
  }

  showLegend() {
    const legend = element("legend");
    legend.replaceChildren();
    if (!this.group) return;
    if (this.color === "material") {
      const names = new Map(), wheels = this.group.robots.map((robot) => robot.legend.wheel).filter((wheel) => wheel.length);
      for (const robot of this.group.robots) for (const [css, name] of robot.legend.swatches) names.set(name, css);
      // Phases rise counter-clockwise from the right, as in pictures; a conic gradient turns the other way.
      if (wheels.length) {
        const colors = [...wheels[0], wheels[0][0]].reverse();
        legend.append(make("div", { class: "wheel" },
          make("i", { style: `background:conic-gradient(from 90deg,${colors.join()})` }), make("b", {}, "phase"),
          ...[["0°", 100, 50], ["90°", 50, 0], ["180°", 0, 50], ["270°", 50, 100]].map(([text, left, top]) =>
            make("span", { style: `left:${left}%;top:${top}%` }, text))));
      }
      if (names.size > 22) return;
      for (const [name, css] of names)
        legend.append(make("div", { class: "swatch" }, make("i", { style: `background:${css}` }), name));
      return;
    }
    const end = this.color === "strain" ? this.strainEnd : this.group.activationEnd;
    const text = `${Number((100 * end).toPrecision(3))} %`;
    legend.append(make("div", {}, this.color === "strain" ? "Strain" : "Contraction of the muscles"),
                  make("div", { class: "scale", style: `background:linear-gradient(90deg,${this.page.colormap.join()})` }),
                  make("div", { class: "ends" }, make("span", {}, "−" + text), make("span", {}, "0"), make("span", {}, text)));
  }

  // "information", "help" or null. The same one again closes it.
  openPanel(name) {
    this.panel = this.panel === name ? null : name;
    element("panel").hidden = !this.panel;
    element("information").hidden = this.panel !== "information";
    element("help").hidden = this.panel !== "help";
    for (const key of ["information", "help"])
      element(key + "-button").setAttribute("aria-expanded", String(this.panel === key));
    if (this.panel === "information") this.showInformation();
  }

  showInformation() {
    const { page } = this, content = element("information"), list = (facts) =>
      make("dl", {}, ...facts.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
    content.replaceChildren(make("h2", {}, page.title));
    if (page.command) {
      const code = make("code", {}, page.command), copy = make("button", { class: "copy" }, "Copy");
      copy.addEventListener("click", () => {
        getSelection().selectAllChildren(code);
        if (document.execCommand("copy")) copy.textContent = "Copied";  // a page of a file has no other clipboard
      });
      content.append(make("p", {}, "Made by"), make("div", { class: "command" }, code, copy));
    }
    content.append(list(page.facts));
    const robots = this.selected === null ? this.shown : [this.shown[this.selected]];
    for (const index of robots) {
      const robot = page.robots[index];
      content.append(make("h3", {}, robot.name), ...robot.caption.map((line) => make("div", {}, line)), list(robot.facts));
    }
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.group) return;
    const inForm = event.target instanceof HTMLSelectElement;
    const turn = event.shiftKey ? 0.1 : 0;
    const actions = {
      " ": () => this.setPlaying(!this.playing), k: () => this.setPlaying(!this.playing),
      ArrowLeft: () => (turn ? this.turn(-turn, 0) : this.stepFrames(-1)),
      ArrowRight: () => (turn ? this.turn(turn, 0) : this.stepFrames(1)),
      ArrowUp: () => (turn ? this.turn(0, turn) : this.zoom(1 / 1.1)),
      ArrowDown: () => (turn ? this.turn(0, -turn) : this.zoom(1.1)),
      Home: () => this.setTime(this.start), End: () => this.setTime(this.end),
      "+": () => this.changeSpeed(1), "=": () => this.changeSpeed(1), "-": () => this.changeSpeed(-1),
      1: () => this.setColor("material"), 2: () => this.setColor("strain"), 3: () => this.setColor("activation"),
      l: () => this.toggle("loop"), f: () => this.toggle("follow"), r: () => this.resetCamera(),
      t: () => this.setTheme(this.theme === "dark" ? "light" : "dark"),
      i: () => this.openPanel("information"), "?": () => this.openPanel("help"), h: () => this.openPanel("help"),
      Escape: () => (this.panel ? this.openPanel(null) : this.select(null)),
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action || inForm || (event.key === " " && event.target instanceof HTMLButtonElement)) return;
    event.preventDefault();
    action();
  }

  turn(azimuth, elevation) {
    this.orbit.turn(azimuth, elevation, this.lowestElevation);
    this.changed = true;
  }
  zoom(factor) {
    this.orbit.zoom = clamp(this.orbit.zoom * factor, 0.05, 20);
    this.changed = true;
  }
  pan(right, up) {
    if (this.follow) this.toggle("follow", false);
    this.orbit.pan(right, up);
    this.changed = true;
  }
}

// Mouse and fingers on the canvas: one turns, two fingers or the right button pan, a pinch or the wheel zooms.
class Gestures {
  pointers = new Map();
  constructor(player) {
    this.player = player;
    const { canvas } = player;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.up(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      player.zoom(Math.exp(0.0015 * clamp(event.deltaY * (event.deltaMode === 1 ? 16 : 1), -200, 200)));
    }, { passive: false });
    canvas.addEventListener("dblclick", () => player.resetCamera());
  }
  down(event) {
    try {
      this.player.canvas.setPointerCapture(event.pointerId);
    } catch {}  // the pointer is already gone
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.moved = this.pointers.size > 1 ? Infinity : 0;
    this.drift = [0, 0];  // of the middle of two fingers [pixels]
  }
  move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (!pointer) return;
    const before = this.spread(), dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    Object.assign(pointer, { x: event.clientX, y: event.clientY });
    this.moved += Math.hypot(dx, dy);
    const { player } = this, height = player.canvas.clientHeight;
    if (this.pointers.size === 2) {
      const after = this.spread();
      if (before > 0 && after > 0) player.zoom(before / after);
      // A pinch moves its middle a little, which is not meant: the camera would no longer follow.
      if (Math.hypot(...this.drift) > 24) player.pan(-dx / (2 * height), dy / (2 * height));
      else this.drift = [this.drift[0] + dx / 2, this.drift[1] + dy / 2];
    } else if (event.buttons & 2 || event.shiftKey) {
      player.pan(-dx / height, dy / height);
    } else if (this.pointers.size === 1) {
      player.turn((-4 * dx) / height, (3 * dy) / height);
    }
  }
  up(event) {
    if (!this.pointers.delete(event.pointerId) || event.type === "pointercancel") return;
    const { player } = this, bounds = player.canvas.getBoundingClientRect();
    if (this.moved < 6 && player.group && player.shown.length > 1)
      player.select(player.robotAt(event.clientX - bounds.left, event.clientY - bounds.top));
  }
  // Distance of two fingers [pixels].
  spread() {
    if (this.pointers.size !== 2) return 0;
    const [a, b] = [...this.pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  }
}

function fail(error) {
  console.error(error);
  element("message").textContent = error.message || String(error);
  element("message").hidden = false;
  document.documentElement.dataset.state = "failed";
}

async function start() {
  if (typeof DecompressionStream === "undefined")
    throw new Error("This browser is too old to unpack the motion. Firefox 113, Chrome 80 or Safari 16.4 can.");
  const page = JSON.parse(element("page").textContent), shaders = JSON.parse(element("shaders").textContent);
  const player = (globalThis.player = new Player(page, shaders));
  await new Chooser(player).begin();
  element("loading").remove();
  document.documentElement.dataset.state = "ready";
  player.tick(performance.now());
}
start().catch(fail);
