// Plays the rows and steps through them.
function player() {
  const get = (id) => document.getElementById(id);
  const [play, place, pace, time, told] = ["play", "place", "pace", "time", "event"].map(get);
  const from = clock.si[0];
  const until = clock.si[rows - 1];
  const turns = angle ? Math.abs(angle.si[rows - 1] - angle.si[0]) / (2 * Math.PI) : 0;
  // At first a turn takes two seconds, but the whole no more than a minute.
  const usual = (until - from) / Math.min(Math.max(2 * turns, 4), 60);
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 5, 10]) {
    const option = new Option(clock.unit === "s" ? `${Number((usual * factor).toPrecision(2))} s a second` : `${factor} ×`, usual * factor);
    option.selected = factor === 1;
    pace.append(option);
  }
  place.max = rows - 1;
  let playing = null;
  const stop = () => {
    playing = null;
    play.textContent = "Play";
  };
  const frame = (now) => {
    if (playing === null) return;
    const passed = Math.max(now - playing, 0) / 1000;
    playing = now;
    moveTo(cursor.at + passed * Number(pace.value));
    if (cursor.at >= until) stop();
    else requestAnimationFrame(frame);
  };
  const toggle = () => {
    if (playing !== null) return stop();
    if (cursor.at >= until) moveTo(from);
    play.textContent = "Pause";
    playing = performance.now();
    requestAnimationFrame(frame);
  };
  const marks = page.events.map((event) => (clock.name === "t_s" ? event.t_s : event.theta_rad));
  const step = (sense) => {
    const gap = 1e-9 * (until - from);
    const beyond = marks.map((at, i) => [at, i]).filter(([at]) => sense * (at - cursor.at) > gap);
    if (!beyond.length) return;
    const [at, i] = sense > 0 ? beyond[0] : beyond[beyond.length - 1];
    stop();
    moveTo(at);
    told.textContent = page.events[i].kind;
  };
  for (const id of ["previous", "next"]) get(id).hidden = !marks.length;
  play.onclick = toggle;
  get("previous").onclick = () => step(-1);
  get("next").onclick = () => step(1);
  place.oninput = () => {
    stop();
    moveToRow(Number(place.value));
  };
  const keys = {
    " ": toggle,
    ArrowLeft: () => moveToRow(cursor.row - 1),
    ArrowRight: () => moveToRow(cursor.row + 1),
    Home: () => moveToRow(0),
    End: () => moveToRow(rows - 1),
    p: () => step(-1),
    n: () => step(1),
    "+": () => (pace.selectedIndex = Math.min(pace.selectedIndex + 1, pace.length - 1)),
    "-": () => (pace.selectedIndex = Math.max(pace.selectedIndex - 1, 0)),
  };
  addEventListener("keydown", (event) => {
    const used = event.target.closest?.("select, summary, button") && " ArrowLeftArrowRight".includes(event.key);
    if (used || event.ctrlKey || event.metaKey || event.altKey || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  });
  const list = get("row");
  const table = list.querySelector("table");
  const cells = page.columns.map((column) => {
    const line = table.insertRow();
    const name = document.createElement("th");
    name.textContent = column.name;
    line.append(name);
    return line.insertCell();
  });
  const tell = () => {
    place.value = cursor.row;
    place.setAttribute("aria-valuetext", `${six(cursor.at * clock.factor)} ${clock.unit}`);
    const turn = angle && clock !== angle ? `, θ = ${six((angle.si[cursor.row] * 180) / Math.PI)}°` : "";
    time.textContent = `${clock.name === "t_s" ? "t" : "θ"} = ${six(cursor.at * clock.factor)} ${clock.unit}${turn}`;
    if (playing !== null) told.textContent = "";
    if (list.open) cells.forEach((cell, i) => (cell.textContent = exact(page.columns[i].si[cursor.row])));
  };
  list.ontoggle = tell;
  cursor.listeners.push(tell);
  tell();
}

if (drawn && isMotion) player();
