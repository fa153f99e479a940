// SPDX-License-Identifier: Apache-2.0
// Which robots of the page are shown: all of them side by side, or those that are clicked in a family tree or a map.

function draw(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const shortNumber = (value) => String(Number(value.toPrecision(3)));

class Chooser {
  constructor(player) {
    this.player = player;
    this.page = player.page;
    this.nodes = new Map();  // by robot
  }

  // Shows the first choice.
  async begin() {
    const { board, family } = this.page, all = this.page.robots.map((_, index) => index);
    if (board || family.length > 1) {
      element("chooser").hidden = false;
      document.body.classList.add("with-chooser");
      this.player.resize();
      element("chooser").append(board ? this.map(board) : this.tree(family));
      addEventListener("keydown", (event) => this.key(event));
    }
    await this.choose(board ? [this.bestOf(board)] : all);
  }

  async choose(robots) {
    this.chosen = robots;
    for (const [robot, node] of this.nodes) node.classList.toggle("chosen", robots.includes(robot));
    await this.player.show(robots);
  }

  // [ and ]: the robot before or after the one that is shown.
  key(event) {
    const by = { "[": -1, "]": 1 }[event.key], count = this.page.robots.length;
    if (!by) return;
    const from = this.chosen.length === 1 ? this.chosen[0] : by > 0 ? -1 : 0;
    this.choose([(from + by + count) % count]);
  }

  // Makes an element choose a robot; with Shift together with those that are shown.
  choosesRobot(node, robot) {
    const { name, caption } = this.page.robots[robot];
    node.setAttribute("tabindex", "0");
    node.setAttribute("role", "button");
    node.setAttribute("aria-label", [name, ...caption].join(", "));
    node.append(draw("title", {}, [name, ...caption].join("\n")));
    const choose = (more) => {
      const others = more && !this.chosen.includes(robot) ? this.chosen : [];
      this.choose([...others, robot].sort((a, b) => a - b));
    };
    node.addEventListener("click", (event) => choose(event.shiftKey));
    node.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      choose(event.shiftKey);
    });
    this.nodes.set(robot, node);
    return node;
  }

  // Generations from left to right, scores upwards. Dots are individuals; those with a ring play.
  tree(family) {
    const width = 320, height = 300, right = 12, top = 12, bottom = 30;
    const members = new Map(family.map(([id, generation, score, robot, parents]) => [id, { id, generation, score, robot, parents }]));
    const scored = [...members.values()].filter(({ score }) => score !== null);
    const range = (values) => [Math.min(...values), Math.max(...values)];
    const [firstGeneration, lastGeneration] = range(scored.map(({ generation }) => generation));
    // A few failures far below would press all others together at the top.
    const sorted = scored.map(({ score }) => score).sort((a, b) => a - b);
    const low = Math.min(sorted[Math.floor(0.03 * sorted.length)], ...scored.filter(({ robot }) => robot !== null).map(({ score }) => score));
    const high = sorted[sorted.length - 1];
    // Room for the longest number, of letters 6.5 wide.
    const left = 8 + 6.5 * Math.max(5, shortNumber(low).length, shortNumber(high).length);
    const x = ({ generation }) => left + ((width - left - right) * (generation - firstGeneration)) / (lastGeneration - firstGeneration || 1);
    const y = ({ score }) => height - bottom - (height - top - bottom) * clamp(((score ?? low) - low) / (high - low || 1), -0.03, 1);
    const svg = draw("svg", { viewBox: `0 0 ${width} ${height}`, "aria-label": "Family tree" });
    svg.append(draw("path", { class: "axis", d: `M${left} ${top}V${height - bottom}H${width - right}` }));
    const text = (content, attributes) => svg.append(draw("text", attributes, content));
    text("generation", { x: (left + width - right) / 2, y: height - 4, "text-anchor": "middle" });
    text(String(firstGeneration), { x: left, y: height - 14, "text-anchor": "middle" });
    text(String(lastGeneration), { x: width - right, y: height - 14, "text-anchor": "middle" });
    text(shortNumber(high), { x: left - 5, y: top + 4, "text-anchor": "end" });
    text(shortNumber(low), { x: left - 5, y: height - bottom, "text-anchor": "end" });
    text("score", { x: left - 5, y: (top + height - bottom) / 2, "text-anchor": "end" });
    for (const member of scored)
      if (member.robot === null) svg.append(draw("circle", { class: "kin", cx: x(member), cy: y(member), r: 1.4 }));
    const playing = scored.filter(({ robot }) => robot !== null);
    const seen = new Set();
    for (const member of playing)
      for (let child = member; child && !seen.has(child.id); ) {
        seen.add(child.id);
        const parents = child.parents.map((id) => members.get(id)).filter(Boolean);
        parents.forEach((parent, i) => svg.append(draw("path", {
          class: i === 0 ? "descent" : "descent second", d: `M${x(parent)} ${y(parent)}L${x(child)} ${y(child)}` })));
        child = parents[0];
      }
    for (const member of playing)
      svg.append(this.choosesRobot(draw("circle", { class: "plays", cx: x(member), cy: y(member), r: 6 }), member.robot));
    return make("div", {}, svg, this.hint("Click a ring to play that robot, with Shift to add it."), this.allButton());
  }

  // The cells of a map of elites in the colors of their scores.
  map(board) {
    const { columns, rows, cells, across, upward, score } = board;
    const left = upward.ticks.length > 0 ? 44 : 10, bottom = 34, top = 8, right = 12, width = 330;
    const side = clamp((width - left - right) / columns, 1, 60), height = Math.min(side * rows, 330) + top + bottom;
    const cellHeight = (height - top - bottom) / rows;
    const svg = draw("svg", { viewBox: `0 0 ${width} ${height + 14}`, "aria-label": "Map of elites" });
    cells.forEach((cell, i) => {
      const box = { x: left + side * (i % columns) + 0.5, y: top + cellHeight * Math.floor(i / columns) + 0.5,
                    width: side - 1, height: cellHeight - 1, rx: Math.min(3, side / 6) };
      const rect = draw("rect", { ...box, class: cell ? "elite" : "empty", ...(cell ? { fill: cell.color } : {}) });
      svg.append(cell && cell.robot !== undefined ? this.choosesRobot(rect, cell.robot) : rect);
    });
    const text = (content, attributes) => content && svg.append(draw("text", attributes, content));
    across.ticks.forEach((tick, i) => text(tick, { x: left + side * i, y: height - bottom + 14, "text-anchor": "middle" }));
    upward.ticks.forEach((tick, i) => text(tick, { x: left - 4, y: height - bottom - cellHeight * i + 3, "text-anchor": "end" }));
    text(across.title, { x: left + (side * columns) / 2, y: height - bottom + 30, "text-anchor": "middle" });
    text(upward.title, { x: 10, y: top + (cellHeight * rows) / 2, "text-anchor": "middle",
                         transform: `rotate(-90 10 ${top + (cellHeight * rows) / 2})` });
    const legend = make("div", {}, make("div", { class: "scale", style: `background:linear-gradient(90deg,${score.colors.join()})` }),
                        make("div", { class: "ends" }, make("span", {}, shortNumber(score.low)),
                             make("span", {}, `${score.title} ${score.unit}`), make("span", {}, shortNumber(score.high))));
    legend.className = "of-map";
    return make("div", {}, svg, legend, this.hint("Click a cell to play its robot, with Shift to add it."));
  }

  bestOf(board) {
    const filled = board.cells.filter((cell) => cell && cell.robot !== undefined);
    return filled.reduce((best, cell) => (cell.value > best.value ? cell : best)).robot;
  }

  hint(text) { return make("p", {}, text); }
  allButton() {
    return make("button", { onclick: () => this.choose(this.page.robots.map((_, index) => index)) }, "All side by side");
  }
}
