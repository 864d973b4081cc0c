"use strict";
// The rows: columns in SI, exact; shown in the units that people read.
const page = JSON.parse(document.getElementById("data").textContent);

function decoded(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  return new Float64Array(bytes.buffer);
}

for (const column of page.columns) if (column.data !== undefined) column.si = decoded(column.data);
const byName = new Map(page.columns.map((column) => [column.name, column]));
const rows = page.columns.length ? (page.columns[0].si ?? page.columns[0].words).length : 0;
/** Whether rows follow each other in time or crank angle. */
const isMotion = rows > 1 && !page.scatter;

/** Values in the unit for people; null where there is none. */
function shown(column) {
  column.shown ??= Array.from(column.si, (value) => (Number.isFinite(value) ? value * column.factor : null));
  return column.shown;
}

/** Label and unit. */
const titled = (column) => (column.unit ? `${column.label} [${column.unit}]` : column.label);

/** Six digits. */
function six(value) {
  if (value == null || !Number.isFinite(value)) return "–";
  const text = value.toPrecision(6);
  return text.includes("e") ? Number(text).toExponential() : String(Number(text));
}

// Of a motion rows come one after the other in time, of a turn in crank angle.
const clock = byName.get("t_s") ?? byName.get("theta_rad") ?? page.columns[0];
const angle = byName.get("theta_rad");

/** The last row at or before a value of the clock. */
function rowAt(value) {
  let [low, high] = [0, rows - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (clock.si[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

// One cursor for all: a value of the clock, and the row before it.
const cursor = { at: isMotion ? clock.si[0] : 0, row: 0, listeners: [] };

function moveTo(at) {
  cursor.at = Math.min(Math.max(at, clock.si[0]), clock.si[rows - 1]);
  cursor.row = rowAt(cursor.at);
  for (const listener of cursor.listeners) listener();
}

const moveToRow = (row) => moveTo(clock.si[Math.min(Math.max(row, 0), rows - 1)]);

/** All digits; nothing where there is no value. */
const exact = (value) => (Number.isFinite(value) ? String(value) : "");

/** Least and largest value. */
function ends(values) {
  const known = values.filter((value) => value !== null);
  return [known.reduce((a, b) => Math.min(a, b), Infinity), known.reduce((a, b) => Math.max(a, b), -Infinity)];
}
