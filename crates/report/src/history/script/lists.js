// The views of a run, of an adapter, of all news, and of a search.
const MOST_FOUND = 200;
const MOST_NEWS = 500;
let ids = null;

async function allCases() {
  if (ids) return ids;
  const packed = await need("cases");
  if (!packed) return null;
  ids = [];
  for (const [shared, rest] of packed) ids.push(ids.length ? ids[ids.length - 1].slice(0, shared) + rest : rest);
  return ids;
}

const caseLink = id => make("a", { href: addressOf(id) }, make("code", {}, id));

// Links a label that is a URL; any other text stays text.
function labelOf(text) {
  if (!/^https?:\/\//.test(text) || !URL.canParse(text)) return text;
  return make("a", { href: new URL(text).href, rel: "noreferrer" }, text);
}

async function showRun(text, into) {
  const [known, names] = await Promise.all([runs(), allCases()]);
  const run = known && known.runs.find(one => String(one.id) === text);
  if (!run || !names) return fail(into, known ? "This history has no run of this number." : LOST);
  const number = placeOf(index.runs, run.place);
  const file = number < 0 ? [] : await need("run-" + number);
  into.append(facts([
    ["Started", run.started], ["Released", run.released], ["Kind", run.kind], ["Suite", "etalon " + run.etalon + (run.commit ? ", commit " + run.commit : "")],
    ["Machine", run.machine], ["Profile", run.profile], ["Missing records", run.missing ? String(run.missing) : ""], ["Digest", run.digest],
    ...run.labels.map(([key, value]) => ["Label " + key, labelOf(value)]),
  ].filter(([, value]) => value)));
  const found = (file || []).find(([place]) => place === run.place);
  for (const line of known.lines) {
    const at = line.runs.findIndex(one => one.run === run);
    if (at < 0) continue;
    const [now, before] = [line.runs[at], line.runs[at - 1]];
    const of = found ? found[1].filter(([on]) => on === line.number) : [];
    const section = make("section", { class: "course" }, make("h2", {}, line.name),
      make("p", {}, [now.version, now.driver, now.device].filter(Boolean).join(", "), "; ", counted(now.records, "record"), now.whole ? "" : ", a part of the suite"));
    section.append(make("p", {}, ...(before ? ["Against ", ...told(before), ": ", range(before, now), "."] : ["The first run of this adapter."])));
    for (const [, kind, cases] of of) {
      const list = () => make("ul", {}, ...cases.slice(0, 1000).map(at => make("li", {}, caseLink(names[at]))));
      const details = folded(EVENTS[kind][0] + ": " + counted(cases.length, "case"), list);
      section.append(details);
      if (cases.length <= 20) details.open = true;
    }
    if (before && !of.length) section.append(make("p", {}, "No case changed."));
    into.append(section);
  }
}

async function showAdapter(name, into) {
  const known = await runs();
  const line = known && known.lines.find(one => one.name === name);
  const data = line && await need("adapter-" + line.number);
  if (!data) return fail(into, line || known ? "This history has no such adapter." : LOST);
  const shown = [...data.areas.keys()].filter(area => data.rows.some(([, cells]) => cells[area]));
  const percent = (good, of) => of ? (100 * good / of).toFixed(2).replace(/^100\.00$/, "100") + " %" : "–";
  const rows = data.rows.slice(0, MOST_ROWS).map(([at, row]) => cells(told(line.runs[at]), ...shown.map(area => {
    if (!row[area]) return "–";
    const [good, of, ownGood, own] = row[area];
    const parts = [make("b", {}, percent(good, of))];
    if (own !== of || ownGood !== good) parts.push(make("small", { class: "c" }, percent(ownGood, own) + " of " + whole(own)));
    return parts;
  })));
  into.append(make("p", { class: "cap" }, "Bold: the good share of the cases with a verdict in all whole runs of this adapter. Small: of all cases of that run. ",
    counted(line.runs.length - data.rows.length, "run") + " of parts of the suite are left out."));
  into.append(table("Whole runs, newest first" + (data.rows.length > rows.length ? ": the last " + rows.length + " of " + data.rows.length : ""),
    ["Run", ...shown.map(area => data.areas[area])], rows));
}

async function showNews(_, into) {
  const lines = await need("news");
  if (!lines) return fail(into, LOST);
  if (lines.length > MOST_NEWS) into.append(make("p", { class: "cap" }, "The worst " + MOST_NEWS + " of " + whole(lines.length) + "."));
  into.append(make("ul", { class: "news" }, ...lines.slice(0, MOST_NEWS).map(([colour, word, subject, isFamily, text, chip]) => {
    const link = isFamily ? make("a", { href: "#q=" + encoded(subject) }, make("code", {}, subject)) : caseLink(subject);
    return make("li", { class: colour }, make("b", {}, word), " ", link, chip ? make("span", { class: "chip" }, chip) : "", " ", make("span", { class: "h" }, text));
  })));
}

async function showFound(text, into) {
  const names = await allCases();
  if (!names) return fail(into, LOST);
  const words = wordsOf(text);
  const found = names.filter(id => words.every(occurs => occurs(id.toLowerCase())));
  $("view-state").textContent = counted(found.length, "case") + (found.length > MOST_FOUND ? ", the first " + MOST_FOUND : "");
  into.append(make("ul", { class: "found" }, ...found.slice(0, MOST_FOUND).map(id => make("li", {}, caseLink(id)))));
}

