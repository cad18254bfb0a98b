// Frame times over runs, with the ruler below and change points.
const [CHART, HIGH, LOW, MARGIN] = [900, 190, 60, 64];

function micros(value) {
  const digits = n => Number(n.toPrecision(4)).toString();
  if (value >= 1e6) return digits(value / 1e6) + " s";
  return value >= 1000 ? digits(value / 1000) + " ms" : digits(value) + " µs";
}

function ratioText(ratio) {
  const percent = (ratio - 1) * 100;
  return (percent < 0 ? "−" : "+") + Math.abs(percent).toFixed(Math.abs(percent) < 10 ? 1 : 0) + " %";
}

const sized = ([size, low, high]) => ratioText(size) + " (" + ratioText(low) + " to " + ratioText(high) + ")";

function charts(known, series) {
  return series.map(([number, machine, ruler, times]) => {
    const line = known.lines[number];
    const section = make("section", { class: "course" },
      make("h2", {}, "Frame times on " + line.name),
      make("p", { class: "cap" }, (machine || "unknown machine") + (ruler ? "; ruler: " + ruler : "; no ruler was timed")));
    times.forEach((one, place) => {
      const time = timeOf(known, line, one);
      if (place === 0) section.append(...chart(line, time));
      else section.append(folded(time.name, () => chart(line, time)));
    });
    return section;
  });
}

function timeOf(known, line, [name, ranges, medians, rulers, changes, drifts, noise, visible]) {
  const places = [];
  for (let i = 0; i < ranges.length; i += 2) for (let k = 0; k < ranges[i + 1]; k++) places.push(ranges[i] + k);
  const at = new Map(line.runs.map(one => [one.run.place, one]));
  return { name, medians, rulers, changes, drifts, noise, visible, runs: places.map(place => at.get(place)) };
}

function chart(line, time) {
  const runs = time.runs.length;
  const height = HIGH + (time.rulers.length ? LOW + 12 : 0) + 22;
  const x = i => MARGIN + (runs > 1 ? i / (runs - 1) : 0.5) * (CHART - MARGIN - 8);
  const title = time.name + ": " + (time.changes.length ? time.changes.map(change =>
    sized(change[5]) + " at " + time.runs[change[0]].run.day).join(", then ") : "no change") + "; " + counted(runs, "run");
  const svg = shape("svg", { class: "times", viewBox: "0 0 " + CHART + " " + height, role: "img" }, shape("title", {}, title));
  const y = curve(svg, time.medians, x, 6, HIGH - 6, "curve", [0, ...time.changes.map(change => change[0])]);
  if (time.rulers.length) {
    svg.append(shape("text", { x: 0, y: HIGH + 16, class: "name" }, "ruler"));
    curve(svg, time.rulers, x, HIGH + 12, HIGH + LOW, "curve ruler", []);
  }
  svg.append(shape("text", { x: 0, y: 12, class: "name" }, time.name));
  const bottom = height - 22;
  time.changes.forEach((change, number) => {
    const [from, to] = [x(change[1]), x(change[2])];
    svg.append(
      shape("rect", { x: from.toFixed(1), y: 4, width: Math.max(2, to - from).toFixed(1), height: bottom - 4, class: "between" }),
      shape("path", { d: "M" + x(change[0]).toFixed(1) + " 4V" + bottom, class: "change" }),
      shape("text", { x: (x(change[0]) + 4).toFixed(1), y: 14, class: "number" }, String(number + 1)));
  });
  svg.append(shape("text", { x: MARGIN, y: height - 6 }, time.runs[0].run.day),
    shape("text", { x: CHART - 8, y: height - 6, "text-anchor": "end" }, time.runs[runs - 1].run.day));
  const parts = [make("figure", { class: "series" }, svg)];
  const visible = time.visible ? "A step of " + ratioText(time.visible) + " would be found with probability 0.9 when ten runs have followed it; " : "Too few runs for a step to be found; ";
  parts.push(make("p", { class: "cap" }, visible + "a run differs from its level by " + (time.noise * 100).toPrecision(2) + " %."));
  if (time.changes.length) parts.push(changeTable(time));
  for (const [from, to, ratio, machine] of time.drifts) {
    parts.push(make("p", {}, "Drifts by " + sized(ratio) + " from " + time.runs[from].run.day + " to " + time.runs[to - 1].run.day + (machine ? "; caused by the machine, because the ruler drifts too." : ".")));
  }
  parts.push(folded("Numbers of " + time.name, () => numberTable(time)));
  return parts;
}

// One curve in its box; `levels` are the runs at which another level begins.
function curve(svg, values, x, top, bottom, look, levels) {
  const there = values.filter(value => value > 0);
  let [low, high] = [Math.min(...there), Math.max(...there)];
  if (high < low * 1.02) [low, high] = [low * 0.99, high * 1.01];
  const y = value => bottom - (value - low) / (high - low) * (bottom - top - 8);
  for (const value of [low, high]) {
    svg.append(shape("path", { d: "M" + MARGIN + " " + y(value).toFixed(1) + "H" + (CHART - 8), class: "grid" }),
      shape("text", { x: MARGIN - 5, y: (y(value) + (value === low ? 0 : 9)).toFixed(1), "text-anchor": "end" }, micros(value)));
  }
  let path = "";
  let pen = false;
  values.forEach((value, i) => {
    if (value > 0) path += (pen ? "L" : "M") + x(i).toFixed(1) + " " + y(value).toFixed(1);
    pen = value > 0;
  });
  svg.append(shape("path", { d: path, class: look }));
  levels.forEach((from, i) => {
    const to = i + 1 < levels.length ? levels[i + 1] : values.length;
    const part = values.slice(from, to).filter(value => value > 0).sort((a, b) => a - b);
    const middle = part[part.length >> 1];
    if (middle) svg.append(shape("path", { d: "M" + x(from).toFixed(1) + " " + y(middle).toFixed(1) + "H" + x(to - 1).toFixed(1), class: "level" }));
  });
  return y;
}

function changeTable(time) {
  const rows = time.changes.map((change, number) => {
    const [at, from, to, before, after, ratio, p, visible, cause, returns, ruled, ruler, fresh, state] = change;
    const [first, behind] = [time.runs[from], time.runs[to]];
    const chips = [make("span", { class: "chip" }, state ? state[1] : "new")];
    if (state) chips.push(" " + [state[2].slice(0, 10), state[3], state[4]].filter(Boolean).join(", "));
    if (fresh) chips.push(make("span", { class: "chip o" }, "found with the last run"));
    return cells(String(number + 1), sized(ratio), micros(before) + " → " + micros(after), p,
      "±" + ratioText(visible).slice(1), [...told(first), " to ", ...told(behind), make("br", {}), make("small", {}, range(first, behind))],
      [cause + (ruler ? " (" + ratioText(ruler[0]) + ")" : "") + (returns ? "; it goes back and forth" : "")], chips);
  });
  return table("Change points of " + time.name,
    ["Change", "Size (99 % interval)", "Level", "p", "Smallest visible", "After run … up to run", "Cause", "State"], rows);
}

function numberTable(time) {
  const rows = time.runs.map((one, i) => cells(told(one), micros(time.medians[i]), time.rulers[i] ? micros(time.rulers[i]) : "–"));
  const shown = rows.slice(-MOST_ROWS).reverse();
  return table(time.name + (shown.length < rows.length ? ", the last " + shown.length + " of " + rows.length + " runs" : ""), ["Run", "Median", "Ruler"], shown);
}

