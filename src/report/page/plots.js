// Plots of all columns, one panel for what belongs together, with one cursor.
// Okabe and Ito's colours, told apart by colour-blind readers; dashes tell more.
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999"];
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3]];
const HEIGHT = 240;
/** Curves of a panel that are shown at first. */
const FIRST = 3;

const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Columns with their standard errors and bounds, by panel. */
function panelsOf(columns) {
  const groups = new Map();
  for (const column of columns) {
    if (!column.group || column === clock || belongsToAnother(column)) continue;
    const values = shown(column);
    if (values.every((value) => value === null)) continue;
    groups.set(column.group, [...(groups.get(column.group) ?? []), column]);
  }
  return [...groups].map(([title, members]) => ({ title, members }));
}

/** A column with a word before the unit of its name, like `slider_force_se_n`. */
function beside(column, word) {
  const unit = UNITS.find((ending) => column.name.endsWith(ending)) ?? "";
  return byName.get(`${column.name.slice(0, column.name.length - unit.length)}_${word}${unit}`);
}

const UNITS = ["_rad_per_s2", "_rad_per_s", "_m_per_s2", "_m_per_s", "_rad", "_nm", "_n", "_m"];

/** Whether a column is the error or a bound of another. */
const belongsToAnother = (column) => page.columns.some((other) => ["se", "min", "max"].some((word) => beside(other, word) === column));

/** Upper and lower edge of the band of a column, if it has one: its standard error, or what friction allows. */
function bandOf(column) {
  const [error, low, high] = ["se", "min", "max"].map((word) => beside(column, word));
  if (low && high) return [shown(high), shown(low)];
  if (!error || !page.band) return null;
  const half = shown(error).map((value) => (value === null ? null : page.band * value));
  return [1, -1].map((sign) => shown(column).map((value, k) => (value === null || half[k] === null ? null : value + sign * half[k])));
}

/** The range that shows the bulk of curves with poles; null where there is none to be cut off. */
function bulkOf(members) {
  if (!page.poles) return null;
  const values = members.flatMap((column) => shown(column).filter((value) => value !== null)).sort((a, b) => a - b);
  const at = (part) => values[Math.round(part * (values.length - 1))];
  const [low, high] = [at(0.05), at(0.95)];
  const room = high - low;
  if (at(1) - at(0) <= 4 * room) return null;
  return [Math.max(at(0), low - room), Math.min(at(1), high + room)];
}

/** What curves are drawn over: time, crank angle, or crank angle in its turn. */
const bases = [];
if (isMotion) {
  bases.push({ words: titled(clock), values: shown(clock) });
  if (angle && clock !== angle) {
    bases.push({ words: titled(angle), values: shown(angle) });
    const turn = shown(angle).map((value) => value - 360 * Math.floor(value / 360));
    bases.push({ words: "crank angle in its turn [°]", values: turn, wraps: true });
  }
}

const rising = (values) => values.every((value, i) => i === 0 || value > values[i - 1]);

const plots = [];

/** The ticks of an axis of angles are whole parts of a turn. */
const ANGLES = [1, 5, 10, 15, 30, 45, 90, 180, 360, 720, 1800, 3600, 18000, 36000, 180000];

/** Room for the labels of the ticks of an axis, pixels. */
function room(u, ticks, index) {
  if (index === 0) return 36;
  return 18 + 7 * Math.max(3, ...(ticks ?? []).map((tick) => tick.length));
}

function axis(label) {
  const numbers = (_, ticks) => ticks.map((tick) => (tick === null ? "" : six(tick)));
  const plain = { values: numbers, stroke: colourOf("--ink"), grid: { stroke: colourOf("--line"), width: 1 }, ticks: { stroke: colourOf("--line") } };
  return { ...plain, label, labelSize: 22, size: room, ...(label.includes("angle") && label.includes("[°]") ? { incrs: ANGLES } : {}) };
}

/** A plot in its panel. Curves over what does not rise are drawn point by point, broken where they wrap. */
function plot(parent, { title, members }, base, visible) {
  const sorted = rising(base.values);
  const width = parent.clientWidth || 480;
  const unit = members[0].unit;
  const bulk = bulkOf(members);
  const labels = { title: bulk ? `${title}, peaks cut off` : title, width, height: HEIGHT };
  const series = [{ label: base.words, value: () => six(base.values[cursor.row]) }];
  const data = [sorted ? base.values : ends(base.values)];
  const bands = [];
  members.forEach((column, i) => {
    const isSample = column.label.endsWith("measured") || column.name.startsWith("residual");
    const style = isSample && sorted ? { stroke: "transparent", width: 0, show: visible[i] } : { stroke: COLOURS[i % COLOURS.length], dash: DASHES[Math.floor(i / COLOURS.length) % DASHES.length], width: 1.6, show: visible[i] };
    series.push({ label: column.label, ...style, spanGaps: false, value: () => six(shown(column)[cursor.row]), points: isSample ? { show: true, size: 3, fill: COLOURS[i % COLOURS.length], stroke: COLOURS[i % COLOURS.length] } : { show: false } });
    data.push(sorted ? shown(column) : ends(shown(column)));
  });
  members.forEach((column, i) => {
    const edges = sorted && bandOf(column);
    if (!edges) return;
    data.push(...edges);
    const edge = { stroke: "transparent", show: visible[i], points: { show: false } };
    const told = (k) => () => six(edges[k][cursor.row]);
    series.push({ ...edge, label: "to", value: told(0) }, { ...edge, label: "from", value: told(1) });
    bands.push({ series: [data.length - 2, data.length - 1], fill: `${COLOURS[i % COLOURS.length]}33` });
  });
  const made = new uPlot(
    {
      ...labels,
      series,
      bands,
      axes: [axis(base.words), axis(unit ? `${title.includes("angle") ? "angle " : ""}[${unit}]` : "")],
      scales: { x: { time: false }, y: bulk ? { range: (u, low, high) => (low >= bulk[0] && high <= bulk[1] ? [low, high] : bulk) } : {} },
      cursor: { drag: { x: true, y: true, uni: 20 }, points: { show: false }, y: false },
      legend: { live: true },
      hooks: { draw: sorted ? [] : [(u) => points(u, base, members)], ready: [(u) => listen(u, base, sorted)] },
    },
    data,
    parent,
  );
  if (!sorted) made.series.forEach((one, i) => i && (one.paths = () => null));
  const here = document.createElement("div");
  here.className = "here";
  made.over.append(here);
  made.show = () => {
    const [x, y] = [base.values[cursor.row], shown(members[made.leading()])[cursor.row]];
    const [left, top] = [made.valToPos(x, "x"), y === null ? -99 : made.valToPos(y, "y")];
    const inside = left >= 0 && left <= made.over.clientWidth && top >= 0 && top <= made.over.clientHeight;
    here.style.display = inside ? "" : "none";
    here.style.transform = `translate(${left}px, ${top}px)`;
    here.style.background = COLOURS[made.leading() % COLOURS.length];
    made.setLegend({ idx: sorted ? cursor.row : 0 }, false);
  };
  made.leading = () => Math.max(made.series.slice(1, members.length + 1).findIndex((one) => one.show), 0);
  return made;
}

/** Curves through points in the order of the rows. */
function points(u, base, members) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  members.forEach((column, i) => {
    if (!u.series[i + 1].show) return;
    ctx.strokeStyle = COLOURS[i % COLOURS.length];
    ctx.lineWidth = 1.6 * devicePixelRatio;
    ctx.setLineDash(DASHES[Math.floor(i / COLOURS.length) % DASHES.length].map((dash) => dash * devicePixelRatio));
    ctx.beginPath();
    let joined = false;
    const values = shown(column);
    for (let row = 0; row < rows; row++) {
      const [x, y] = [base.values[row], values[row]];
      if (y === null || x === null || (base.wraps && row && Math.abs(x - base.values[row - 1]) > 180)) joined = false;
      if (y === null || x === null) continue;
      const [left, top] = [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
      if (joined) ctx.lineTo(left, top);
      else ctx.moveTo(left, top);
      joined = true;
    }
    ctx.stroke();
  });
  ctx.restore();
}

/** The pointer moves the cursor to the nearest row; of several turns, the one nearest in time. */
function listen(u, base, sorted) {
  u.over.addEventListener("mousemove", (event) => {
    if (event.buttons) return;
    const left = event.clientX - u.over.getBoundingClientRect().left;
    if (sorted) return moveToRow(u.posToIdx(left));
    const value = u.posToVal(left, "x");
    let best = cursor.row;
    let least = Infinity;
    for (let row = 0; row < rows; row++) {
      const off = Math.abs(base.values[row] - value) * 1e6 + Math.abs(row - cursor.row);
      if (off < least) [best, least] = [row, off];
    }
    moveToRow(best);
  });
}

/** Speed over angle, and the path of a loose journal. */
function portraits() {
  const of = (title, x, y) => {
    const [first, second] = [byName.get(x), byName.get(y)];
    if (!first || !second) return [];
    return [{ title, members: [second], base: { words: titled(first), values: shown(first) } }];
  };
  return [
    ...(clock === angle ? [] : of("phase portrait", "theta_rad", "omega_rad_per_s")),
    ...of("path of the journal in the bearing", "journal_x_m", "journal_y_m"),
  ];
}

function drawAll() {
  const chosen = bases[document.getElementById("over").selectedIndex] ?? bases[0];
  const all = panelsOf(page.columns).map((panel) => ({ ...panel, base: chosen }));
  const panels = [...all, ...portraits()];
  panels.forEach((panel, i) => {
    const old = plots[i];
    const visible = panel.members.map((_, k) => (old ? old.series[k + 1].show : k < FIRST));
    const parent = old ? old.root.parentElement : document.getElementById("panels").appendChild(document.createElement("div"));
    parent.className = "panel";
    old?.destroy();
    plots[i] = plot(parent, panel, panel.base, visible);
    plots[i].show();
  });
}

if (isMotion) {
  document.getElementById("plots").hidden = false;
  const over = document.getElementById("over");
  for (const { words } of bases) over.append(new Option(words));
  over.parentElement.hidden = bases.length < 2;
  over.onchange = drawAll;
  document.getElementById("whole").onclick = drawAll;
  drawAll();
  let asked = false;
  cursor.listeners.push(() => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      for (const made of plots) made.show();
    });
  });
  let size = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth !== size) drawAll();
    size = innerWidth;
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);
}
