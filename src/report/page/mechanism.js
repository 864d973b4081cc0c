// The mechanism, to scale, at the cursor.
const drawn = document.getElementById("mechanism");

function element(name, attributes, parent) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

/** Crank angle and slider position at the cursor: cubic (Hermite) between rows where the speed is known. */
function poseAtCursor() {
  const { row, at } = cursor;
  const next = Math.min(row + 1, rows - 1);
  const h = clock.si[next] - clock.si[row];
  const part = h > 0 ? (at - clock.si[row]) / h : 0;
  const between = (name, rate) => {
    const column = byName.get(name);
    if (!column) return undefined;
    const [a, b] = [column.si[row], column.si[next]];
    const slope = byName.get(rate);
    if (!slope || clock === angle || part === 0) return a + part * (b - a);
    const [p, q] = [slope.si[row] * h, slope.si[next] * h];
    const left = 1 - part;
    return a * (1 + 2 * part) * left ** 2 + p * part * left ** 2 + b * (1 + 2 * left) * part ** 2 - q * left * part ** 2;
  };
  return { theta: between("theta_rad", "omega_rad_per_s"), x: between("x_m", "v_m_per_s") };
}

function mechanism({ crank: r, rod: l, offset: e, branch, crank_cg: crankCg, rod_cg: rodCg, loose }) {
  const x = byName.get("x_m");
  const reach = [l + r, Math.abs(l - r)].map((length) => branch * Math.sqrt(Math.max(length ** 2 - e ** 2, 0)));
  const limits = x ? ends(Array.from(x.si, (value) => (Number.isFinite(value) ? value : null))) : reach;
  const size = Math.max(0.12 * r, 0.03 * (r + l));
  const left = Math.min(-r, ...limits) - 3 * size;
  const right = Math.max(r, ...limits) + 3 * size;
  const [low, high] = [Math.min(-r, -e) - 2.5 * size, Math.max(r, -e) + 2.5 * size];
  drawn.setAttribute("viewBox", `${left} ${-high} ${right - left} ${high - low}`);
  const thin = 0.004 * Math.max(right - left, 2 * (high - low));
  const stroke = (width, more = {}) => ({ stroke: "var(--steel)", "stroke-width": width * thin, fill: "none", ...more });
  const at = (x, y) => ({ cx: x, cy: -y });
  // Ground: guide, pivot, path of the crank pin, dead centres.
  element("line", { x1: left, x2: right, y1: e, y2: e, ...stroke(1, { "stroke-dasharray": `${6 * thin} ${4 * thin}` }) }, drawn);
  element("circle", { ...at(0, 0), r, ...stroke(0.7, { "stroke-dasharray": `${2 * thin} ${3 * thin}` }) }, drawn);
  element("path", { d: `M0 0 L${-size} ${1.6 * size} L${size} ${1.6 * size} Z`, ...stroke(1, { fill: "var(--line)" }) }, drawn);
  for (const length of [l + r, l - r]) {
    const centre = branch * Math.sqrt(length ** 2 - e ** 2);
    if (!Number.isFinite(centre) || length <= 0) continue;
    const mark = element("rect", { x: centre - size, y: e - size, width: 2 * size, height: 2 * size, ...stroke(0.6, { opacity: 0.6 }) }, drawn);
    element("title", {}, mark).textContent = "dead centre";
  }
  const rod = element("line", stroke(5, { "stroke-linecap": "round", stroke: "var(--accent)" }), drawn);
  const crank = element("line", stroke(7, { "stroke-linecap": "round" }), drawn);
  const slider = element("rect", { y: e - size, width: 2 * size, height: 2 * size, ...stroke(1.5, { fill: "var(--box)" }) }, drawn);
  const pins = [0, 1, 2].map(() => element("circle", { r: 0.35 * size, ...stroke(1.5, { fill: "var(--paper)" }) }, drawn));
  const centre = (words) => {
    const mark = element("g", {}, drawn);
    element("circle", { r: 0.3 * size, ...stroke(1, { fill: "var(--paper)" }) }, mark);
    element("path", { d: `M0 0 L${0.3 * size} 0 A${0.3 * size} ${0.3 * size} 0 0 1 0 ${0.3 * size} Z M0 0 L${-0.3 * size} 0 A${0.3 * size} ${0.3 * size} 0 0 1 0 ${-0.3 * size} Z`, fill: "var(--steel)" }, mark);
    element("title", {}, mark).textContent = words;
    return mark;
  };
  const crankMark = crankCg && centre("centre of gravity of the crank");
  const rodMark = rodCg && centre("centre of gravity of the rod");
  const inset = loose && byName.has("journal_x_m") && bearing(loose, right, high, 3 * size, thin);
  const place = (mark, x, y) => mark.setAttribute("transform", `translate(${x} ${-y})`);
  const line = (made, x1, y1, x2, y2) => {
    for (const [key, value] of Object.entries({ x1, y1: -y1, x2, y2: -y2 })) made.setAttribute(key, value);
  };
  return () => {
    const pose = poseAtCursor();
    const [sin, cos] = [Math.sin(pose.theta), Math.cos(pose.theta)];
    const [ax, ay] = [r * cos, r * sin];
    const lean = l ** 2 - (e + ay) ** 2;
    const px = pose.x ?? ax + branch * Math.sqrt(Math.max(lean, 0));
    if (!Number.isFinite(px) || !Number.isFinite(ax)) return;
    line(crank, 0, 0, ax, ay);
    line(rod, ax, ay, px, -e);
    slider.setAttribute("x", px - size);
    [[0, 0], [ax, ay], [px, -e]].forEach(([x, y], i) => place(pins[i], x, y));
    if (crankMark) place(crankMark, crankCg[0] * cos - crankCg[1] * sin, crankCg[0] * sin + crankCg[1] * cos);
    if (rodMark) {
      const [ux, uy] = [(px - ax) / l, (-e - ay) / l];
      place(rodMark, ax + rodCg[0] * ux - rodCg[1] * uy, ay + rodCg[0] * uy + rodCg[1] * ux);
    }
    inset?.();
  };
}

/** The clearance enlarged: where the journal is in its bearing, and where it was before. */
function bearing({ joint, radial }, right, high, size, thin) {
  const [x, y] = ["journal_x_m", "journal_y_m"].map((name) => byName.get(name).si);
  const scale = (0.7 * size) / radial;
  const inset = element("g", { transform: `translate(${right - 1.2 * size} ${-high + 1.2 * size})` }, drawn);
  element("circle", { r: size, fill: "var(--paper)", stroke: "var(--steel)", "stroke-width": thin }, inset);
  element("circle", { r: 0.7 * size, fill: "none", stroke: "var(--steel)", "stroke-width": thin, "stroke-dasharray": `${2 * thin}` }, inset);
  const trail = element("polyline", { fill: "none", stroke: "var(--accent)", "stroke-width": thin, opacity: 0.6 }, inset);
  const journal = element("circle", { r: 0.1 * size, fill: "var(--accent)" }, inset);
  const words = `journal in the ${joint}, ${six(1e3 * radial)} mm radial clearance, enlarged ${Math.round(scale)} times`;
  element("title", {}, inset).textContent = words;
  const TRAIL = 60;
  return () => {
    const at = (row) => [scale * x[row], -scale * y[row]];
    const past = Array.from({ length: Math.min(TRAIL, cursor.row) + 1 }, (_, i) => at(cursor.row - i));
    trail.setAttribute("points", past.map((point) => point.join(" ")).join(" "));
    const [cx, cy] = at(cursor.row);
    journal.setAttribute("cx", cx);
    journal.setAttribute("cy", cy);
  };
}

if (drawn && page.drawing && angle && isMotion) {
  document.getElementById("motion").hidden = false;
  const redraw = mechanism(page.drawing);
  cursor.listeners.push(redraw);
  redraw();
}
