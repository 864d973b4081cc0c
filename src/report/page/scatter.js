// Rows that are no motion: one column over another, by kind.
function scatter({ x, y, colour: depth, log, lines, kind, within }) {
  const get = (id) => document.getElementById(id);
  const numbers = page.columns.filter((column) => column.si && shown(column).some((value) => value !== null));
  const words = new Map(page.columns.filter((column) => column.words).map((column) => [column.name, column.words]));
  const selects = [get("x"), get("y")];
  selects.forEach((select, i) => {
    for (const column of numbers) select.append(new Option(titled(column), column.name));
    const wanted = numbers.findIndex((column) => column.name === [x, y][i]);
    select.selectedIndex = wanted >= 0 ? wanted : Math.min(i, numbers.length - 1);
  });
  const colour = get("colour");
  colour.append(new Option("by kind", ""));
  for (const column of numbers) colour.append(new Option(titled(column), column.name));
  colour.value = numbers.some((column) => column.name === depth) ? depth : "";
  get("log").checked = log;
  const places = within ? [...new Set(words.get(within))] : [];
  for (const place of places) get("within").append(new Option(place || "(no title)"));
  get("within").parentElement.hidden = places.length < 2;
  const kinds = kind && words.has(kind) ? [...new Set(words.get(kind))] : [""];
  let made = null;
  const draw = () => {
    const [across, up] = selects.map((select) => byName.get(select.value));
    const depth = byName.get(colour.value);
    const place = places[get("within").selectedIndex];
    const isLog = get("log").checked;
    const usable = (value) => value !== null && (!isLog || value > 0);
    const groups = kinds.map((name) => {
      const members = [];
      for (let row = 0; row < rows; row++) {
        if (places.length && words.get(within)[row] !== place) continue;
        if (name && words.get(kind)[row] !== name) continue;
        if (usable(shown(across)[row]) && usable(shown(up)[row])) members.push(row);
      }
      return members;
    });
    const all = groups.flat();
    const parent = get("scattered");
    made?.destroy();
    get("nothing").hidden = all.length > 0;
    if (!all.length) return (made = null);
    const range = (column) => {
      const [low, high] = ends(all.map((row) => shown(column)[row]));
      if (isLog) return [low / 1.5, high * 1.5];
      const room = Math.max(0.04 * (high - low || Math.abs(high) || 1), depth ? spacing(all.map((row) => shown(column)[row])) / 2 : 0);
      return [low - room, high + room];
    };
    const scale = (column) => ({ time: false, distr: isLog ? 3 : 1, range: (u, low, high) => (u.zoomed ? [low, high] : range(column)) });
    const series = kinds.map((name, i) => ({ label: name || titled(up), stroke: COLOURS[i % COLOURS.length], paths: () => null, points: { show: false }, value: () => "" }));
    made = new uPlot(
      {
        width: parent.clientWidth,
        height: 460,
        series: [{ label: titled(across), value: () => "" }, ...series],
        axes: [across, up].map((column) => ({ ...axis(titled(column)), ...(isLog ? decades : {}) })),
        scales: { x: scale(across), y: scale(up) },
        cursor: { drag: { x: true, y: true, uni: 20 }, points: { show: false } },
        hooks: {
          draw: [
            (u) =>
              groups.forEach((members, i) => {
                if (!u.series[i + 1].show) return;
                if (depth) paint(u, members, across, up, depth, isLog);
                else mark(u, members, across, up, i, lines);
              }),
          ],
          setSelect: [(u) => (u.zoomed = true)],
          ready: [(u) => u.over.addEventListener("mousemove", (event) => tell(u, event, all, across, up))],
        },
      },
      [ends(all.map((row) => shown(across)[row])), ...kinds.map(() => ends(all.map((row) => shown(up)[row])))],
      parent,
    );
    const key = get("colours");
    key.hidden = !depth;
    if (!depth) return;
    const [low, high] = ends(all.map((row) => shown(depth)[row]).filter((value) => value !== null));
    key.querySelector("i").style.background = `linear-gradient(to right, ${SHADES.join()})`;
    key.firstChild.textContent = `${Number(low.toPrecision(4))} `;
    key.lastChild.textContent = ` ${Number(high.toPrecision(4))}: ${titled(depth)}`;
  };
  for (const id of ["x", "y", "colour", "log", "within"]) get(id).onchange = draw;
  get("unzoom").onclick = draw;
  get("scatter").hidden = false;
  draw();
  addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
}

/** Ticks of logarithmic axes: powers of ten, with 2 and 5 where there are few. The ticks of uPlot never end on some ranges. */
const decades = {
  filter: (_, ticks) => ticks,
  splits: (u, index, low, high) => {
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
      for (const step of high < 100 * low ? [1, 2, 5] : [1]) ticks.push(Number(`${step}e${power}`));
    return ticks.filter((tick) => tick >= low && tick <= high);
  },
};

/** Points of a kind, each kind with a shape of its own, and lines between them. */
function mark(u, members, across, up, kind, lines) {
  const { ctx, bbox } = u;
  const size = 4 * devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = ctx.fillStyle = COLOURS[kind % COLOURS.length];
  ctx.lineWidth = 1.4 * devicePixelRatio;
  const at = members.map((row) => [u.valToPos(shown(across)[row], "x", true), u.valToPos(shown(up)[row], "y", true)]);
  if (lines) {
    ctx.beginPath();
    at.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.stroke();
  }
  const corners = [0, 4, 3][kind % 3];
  ctx.beginPath();
  for (const [x, y] of at) {
    ctx.moveTo(x + size, y);
    if (!corners) ctx.arc(x, y, size, 0, 2 * Math.PI);
    for (let k = 1; k <= corners; k++) ctx.lineTo(x + size * Math.cos((2 * Math.PI * k) / corners), y + size * Math.sin((2 * Math.PI * k) / corners));
  }
  ctx.fill();
  ctx.restore();
}

/** Dark to light, told apart by all eyes and in print: viridis. */
const SHADES = ["#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725"];

/** The shade at a part from 0 to 1. */
function shade(part) {
  const at = Math.min(Math.max(part, 0), 1) * (SHADES.length - 1);
  const [below, above] = [Math.floor(at), Math.ceil(at)].map((i) => [1, 3, 5].map((k) => parseInt(SHADES[i].slice(k, k + 2), 16)));
  return `rgb(${below.map((value, i) => Math.round(value + (at - Math.floor(at)) * (above[i] - value))).join()})`;
}

/** Least distance of values that differ. */
function spacing(values) {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  return sorted.length < 2 ? 0 : Math.min(...sorted.slice(1).map((value, i) => value - sorted[i]));
}

/** Rows in the shade of a third column: tiles where they fill a grid, else points. */
function paint(u, members, across, up, depth, isLog) {
  const { ctx, bbox } = u;
  const values = (column) => members.map((row) => shown(column)[row]);
  const [xs, ys, zs] = [across, up, depth].map(values);
  const [low, high] = ends(zs.filter((value) => value !== null));
  const isGrid = !isLog && new Set(xs).size * new Set(ys).size === members.length && members.length > 3;
  const width = (column, axis, all) => (isGrid ? Math.abs(u.valToPos(spacing(all), axis, true) - u.valToPos(0, axis, true)) + 1 : 8 * devicePixelRatio);
  const [dx, dy] = [width(across, "x", xs), width(up, "y", ys)];
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  members.forEach((_, i) => {
    if (zs[i] === null) return;
    ctx.fillStyle = shade(high > low ? (zs[i] - low) / (high - low) : 0.5);
    ctx.fillRect(u.valToPos(xs[i], "x", true) - dx / 2, u.valToPos(ys[i], "y", true) - dy / 2, dx, dy);
  });
  ctx.restore();
}

/** The row nearest to the pointer, with all of its cells. */
function tell(u, event, members, across, up) {
  const box = u.over.getBoundingClientRect();
  const [left, top] = [event.clientX - box.left, event.clientY - box.top];
  let [best, least] = [-1, Infinity];
  for (const row of members) {
    const off = Math.hypot(u.valToPos(shown(across)[row], "x") - left, u.valToPos(shown(up)[row], "y") - top);
    if (off < least) [best, least] = [row, off];
  }
  const table = document.getElementById("cells");
  table.replaceChildren();
  for (const column of page.columns) {
    const text = column.words ? column.words[best] : exact(column.si[best]);
    if (!text) continue;
    const line = table.insertRow();
    const name = document.createElement("th");
    name.textContent = column.name;
    line.append(name);
    line.insertCell().textContent = text;
  }
}

if (page.scatter && rows) scatter(page.scatter);
