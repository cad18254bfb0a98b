// One case over all runs of every adapter.
const STRIP = 900;
const MOST_ROWS = 100;
const LOST = "A file of this page cannot be loaded: is the folder “data” next to the page?";

async function showCase(id, into) {
  const [known, names] = await Promise.all([runs(), allCases()]);
  if (!known || !names) return fail(into, LOST);
  const place = placeOf(names, id);
  if (names[place] !== id) return fail(into, "This history has no case of this name.");
  const number = placeOf(index.cases, place);
  const file = await need("case-" + number);
  if (!file) return fail(into, LOST);
  const at = place - index.cases[number];
  const courses = file[0][file[1][at]];
  const [, times, said] = file[2].find(([which]) => which === at) || [at, -1, []];
  const body = [];
  for (const course of courses) body.push(courseOf(known, course, said));
  if (!courses.length) body.push(make("p", {}, "No run of this case gave a verdict."));
  into.replaceChildren(...body);
  if (times >= 0) {
    const held = await need("times-" + times);
    const found = held && held.find(one => one[0] === id);
    if (found) into.append(...charts(known, found[1]));
    else fail(into, LOST);
  }
}

function fail(into, text) {
  into.append(make("p", { role: "alert", class: "state bad" }, text));
}

function courseOf(known, [number, first, last, flat, gapList = [], eventList = []], said) {
  const line = known.lines[number];
  const spans = [];
  for (let i = 0; i < flat.length; i += 2) {
    const end = i + 2 < flat.length ? flat[i + 2] : last + 1;
    spans.push({ from: flat[i], end, look: known.looks[flat[i + 1]] });
  }
  const missing = [];
  for (let i = 0; i < gapList.length; i += 2) missing.push([gapList[i], gapList[i] + gapList[i + 1]]);
  const events = [];
  for (let i = 0; i < eventList.length; i += 3) events.push({ kind: eventList[i], after: eventList[i + 1], at: eventList[i + 2] });
  const now = spans[spans.length - 1];
  // A release that was not drawn differs only in the list of spans.
  let since = spans.length - 1;
  while (since > 0 && spans[since - 1].look.text === now.look.text) since--;
  const gone = events.length > 0 && events[events.length - 1].kind === GONE;
  const section = make("section", { class: "course" },
    make("h2", {}, line.name),
    make("p", {},
      make("span", { class: "chip " + now.look.colour }, now.look.text), gone ? " until " : " since ",
      ...told(line.runs[gone ? last : spans[since].from]), ". ", counted(last - first + 1, "run"), " from ", runLink(line.runs[first]), " to ", runLink(line.runs[last]), "."));
  if (now.look.reason) section.append(make("p", { class: "note" }, "Expected: " + now.look.reason));
  section.append(strip(line, spans, missing, first, last));
  for (const [timeline, state, at, author, reason] of said.filter(one => one[0] === line.name)) {
    section.append(make("p", {}, make("span", { class: "chip" }, state), " " + at.slice(0, 10) + (author ? ", " + author : "") + (reason ? ": " + reason : "")));
  }
  if (events.length) section.append(eventTable(line, spans, events));
  section.append(folded(counted(spans.length, "span") + " of equal verdicts", () => spanTable(line, spans)));
  return section;
}

const lookAt = (spans, run) => spans[Math.max(0, placeOf(spans.map(span => span.from), run))].look;

function eventTable(line, spans, events) {
  const rows = events.slice(-MOST_ROWS).reverse().map(({ kind, after, at }) => {
    const [before, now] = [line.runs[after], line.runs[at]];
    const [word, colour] = EVENTS[kind];
    const texts = kind > 2 ? "" : lookAt(spans, after).text + " → " + lookAt(spans, at).text;
    return cells([make("span", { class: "chip " + colour }, word)], told(now), told(before), texts, range(before, now));
  });
  const more = events.length - rows.length;
  return table("What happened" + (more > 0 ? ", the last " + rows.length + " of " + events.length : ""),
    ["Event", "In run", "Run before, for a diff", "Verdicts", "Between the two"], rows);
}

function spanTable(line, spans) {
  const rows = spans.slice(-MOST_ROWS).reverse().map(({ from, end, look }) => cells(
    [make("span", { class: "chip " + look.colour }, look.text)], told(line.runs[from]), told(line.runs[end - 1]),
    String(end - from), look.inferred ? "not drawn: between two releases that agree" : look.reason));
  const more = spans.length - rows.length;
  return table("Spans of equal verdicts" + (more > 0 ? ", the last " + rows.length + " of " + spans.length : ""),
    ["Verdict", "From", "To", "Runs", "Reason"], rows);
}

// The spans as a strip over the runs of the timeline; the table after it shows the same.
function strip(line, spans, missing, first, last) {
  const runs = line.runs.length;
  const x = run => (run / runs * STRIP).toFixed(1);
  const box = (from, end, colour) => shape("rect", { x: x(from), y: 0, width: Math.max(1, (end - from) / runs * STRIP).toFixed(1), height: 22, class: colour });
  const texts = spans.slice(-5).map(({ from, look }) => look.text + " from " + line.runs[from].run.day);
  const svg = shape("svg", { class: "strip", viewBox: "0 0 " + STRIP + " 40", role: "img", preserveAspectRatio: "none" },
    shape("title", {}, (spans.length > 5 ? "The last of " + spans.length + " spans: " : "") + texts.join(", then ")),
    shape("rect", { x: 0, y: 0, width: STRIP, height: 22, class: "empty" }));
  for (const { from, end, look } of spans) svg.append(box(from, end, look.colour.split(" ")[0]));
  for (const [from, end] of missing) {
    for (let run = from; run < end; run++) if (line.runs[run].whole) svg.append(box(run, run + 1, "empty"));
  }
  svg.append(shape("text", { x: 0, y: 37 }, line.runs[0].run.day), shape("text", { x: STRIP, y: 37, "text-anchor": "end" }, line.runs[runs - 1].run.day));
  // The driver's versions, if there is room for them.
  let free = 90;
  for (let run = 1; run < runs; run++) {
    if (line.runs[run].version === line.runs[run - 1].version) continue;
    svg.append(shape("path", { d: "M" + x(run) + " 0V26", class: "edge" }));
    const at = run / runs * STRIP;
    const width = 7 * line.runs[run].version.length;
    if (at < free || at + width > STRIP - 90) continue;
    svg.append(shape("text", { x: x(run), y: 37 }, line.runs[run].version));
    free = at + width + 12;
  }
  return svg;
}

