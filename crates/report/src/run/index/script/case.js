// The view of one case: what it tests, what is wrong, its pictures, then everything else.
// The id of the case that is shown, whether the run has it or not.
let current = null;

// A word as a shell takes it.
function quoted(word) {
  return /^[A-Za-z0-9\/._=+\-:,@%]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
}

function duration(micros) {
  if (micros >= 1e6) return (micros / 1e6).toFixed(2) + " s";
  return (micros / 1e3).toFixed(micros < 1e4 ? 2 : 1) + " ms";
}

function symbolAndWord(cell) {
  return [make("i", { "aria-hidden": "true" }, cell.symbol), " " + cell.word];
}

// The start of a view of cases.
function enter(id) {
  fromReport = routed && $("case").hidden;
  routed = true;
  typed = false;
  current = id;
  $("cases").hidden = true;
}

async function showCase(id) {
  enter(id);
  const one = cases[numberOf.get(id)];
  return { leads: () => [neighbours(one)], title: id, heading: make("code", {}, id), content: one ? await contentOf(one) : [
    make("p", { class: "state bad", role: "alert" }, "This run has no case of this name."),
    make("p", {}, make("a", { href: "#q=" + encoded(id) }, "Search for it"), " among all cases."),
  ] };
}

async function contentOf(one) {
  const [held, bodies] = await Promise.all([withFacts(one.file.area), withPictures(one.file.area)]);
  const about = make("p", { class: "about", hidden: true });
  const sections = byWeight(one).map(i => onAdapter(one, i, held, bodies));
  const tell = text => { about.textContent ||= text ?? ""; about.hidden = !about.textContent; };
  for (const { section } of sections) {
    const said = section.querySelector(".about");
    tell(said?.textContent);
    said?.remove();
    compare(section);
  }
  const [first, others] = [sections.filter(s => s.weight < RIGHT), sections.filter(s => s.weight >= RIGHT)].map(list => list.map(s => s.section));
  return [
    about,
    ...first,
    make("h2", {}, "On each adapter"),
    make("p", {}, make("b", {}, "Consensus: "), one.consensus.text + "."),
    overview(one, held),
    meant(one.id, tell),
    ...others.length ? [make("details", {}, make("summary", {}, "Facts of " + counted(others.length, "other record")), ...others)] : [],
  ];
}

// Links back, and to the previous and next case that the filter left.
function neighbours(one) {
  const back = make("a", { href: hashOf(state), id: "back" }, "All cases");
  const nav = make("nav", { "aria-label": "Cases" }, make("a", { href: "#" }, "Report"), " ", back);
  const at = shown.indexOf(one);
  if (at > 0) nav.append(" ", make("a", { href: addressOf(shown[at - 1].id), id: "case-back" }, "Previous case"));
  if (at >= 0 && at + 1 < shown.length) {
    nav.append(" ", make("a", { href: addressOf(shown[at + 1].id), id: "case-on" }, "Next case"));
  }
  return nav;
}

// Failures that nothing expected, other failures, imprecise and then right records; odd adapters go first.
const RIGHT = 3;
const weightOf = cell => cell.unexpected ? 0 : cell.bad ? 1 : cell.verdict === "imprecise" ? 2 : RIGHT;

function byWeight(one) {
  const weight = i => weightOf(cellOf(one, i)) * 2 + (one.consensus.odd.includes(i) ? 0 : 1);
  const drawn = data.adapters.map((_, i) => i).filter(i => cellOf(one, i));
  return drawn.sort((a, b) => weight(a) - weight(b) || a - b);
}

function overview(one, held) {
  const rows = data.adapters.map((name, i) => {
    const record = recordOf(held, one, i);
    const row = make("tr", {}, make("th", { scope: "row" }, make("code", {}, name)));
    if (record) {
      const odd = one.consensus.odd.includes(i);
      row.append(
        make("td", { class: "verdict " + record.cell.class }, ...symbolAndWord(record.cell)),
        make("td", {}, odd ? one.consensus.votes === "odd" ? "differs only here" : "differs" : ""),
        make("td", { class: "num" }, held ? duration(record.draw) : "–"),
        make("td", { class: "num" }, held ? duration(record.judge) : "–"));
    } else {
      row.append(make("td", { colspan: "4" }, "no record"));
    }
    return row;
  });
  return table("This case on each adapter", ["Adapter", "Verdict", "From the others", "Drawing", "Judging"], rows, { class: "figures on" });
}

function onAdapter(one, i, held, bodies) {
  const { cell, facts: told } = recordOf(held, one, i);
  const body = bodies?.[one.place + " " + i];
  const section = make("section", { class: "record" },
    make("h2", {}, make("code", {}, data.adapters[i]), " ", make("span", { class: "chip " + cell.class }, ...symbolAndWord(cell))));
  if (!held) section.append(make("p", { class: "state bad", role: "alert" }, LOST));
  if (body) {
    section.append(escapedHtml(body));
    const others = told.filter(fact => !fact.inBody);
    if (others.length) section.append(facts(others.map(fact => [fact.label, shownFact(fact)])));
  } else {
    const [lead, known, example] = ["lead", "known", "example"].map(form => told.find(fact => fact.form === form));
    if (lead) section.append(make("p", { class: "violation" }, make("b", {}, lead.text)));
    if (known) section.append(make("p", { class: "known" }, make("b", {}, known.label + ": "), known.text));
    if (example) section.append(alike(example.text, i));
    const others = told.filter(fact => ![lead, known, example].includes(fact));
    if (others.length) section.append(facts(others.map(fact => [fact.label, shownFact(fact)])));
    section.append(make("details", { class: "again" }, make("summary", {}, "Commands"),
      make("p", {}, "Draw it again: ", make("code", {}, "etalon run " + quoted(one.id) + " --adapter " + quoted(data.adapters[i])))));
  }
  return { section, weight: weightOf(cell) };
}

// Returns the pictures and operations of the case that shows the same bug in full.
function alike(id, adapter) {
  const found = make("div", { class: "alike" },
    make("p", {}, "The same bug, shown in full by ", make("a", { href: addressOf(id) }, make("code", {}, id)), ":"));
  const one = cases[numberOf.get(id)];
  if (one) withPictures(one.file.area).then(bodies => {
    const body = bodies?.[one.place + " " + adapter];
    if (!body) return;
    const content = escapedHtml(body);
    for (const element of content.querySelectorAll(".about, .known, .again")) element.remove();
    found.append(content);
    compare(found);
  });
  return found;
}

// Returns HTML from a script of the report, in which all texts are escaped. The page's policy runs no script in it.
function escapedHtml(text) {
  const template = make("template", {});
  template.innerHTML = text;
  return template.content;
}

function shownFact({ form, text }) {
  return form === "pre" ? make("pre", {}, text)
    : form === "code" ? make("code", {}, text)
    : form === "case" ? make("a", { href: addressOf(text) }, make("code", {}, text))
    : text;
}

