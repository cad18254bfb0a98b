// The view of one case: every adapter's verdict and all that is known about it.
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
}

function showCase(id) {
  enter(id);
  const one = cases[numberOf.get(id)];
  const content = one ? [
    make("p", {}, make("b", {}, "Consensus: "), one.consensus.text + "."),
    overview(one),
    meant(id),
    ...byWeight(one).map(i => onAdapter(one, i)).filter(Boolean),
  ] : [
    make("p", { class: "state bad", role: "alert" }, "This run has no case of this name."),
    make("p", {}, make("a", { href: "#q=" + encoded(id) }, "Search for it"), " among all cases."),
  ];
  return { leads: () => [neighbours(one)], title: id, heading: make("code", {}, id), content };
}

// Links back, and to the previous and next case that the filter left.
function neighbours(one) {
  const back = make("a", { href: hashOf(state), id: "back" }, "All cases");
  const nav = make("nav", { "aria-label": "Cases" }, back);
  const at = shown.indexOf(one);
  if (at > 0) nav.append(" ", make("a", { href: addressOf(shown[at - 1].id), id: "case-back" }, "Previous case"));
  if (at >= 0 && at + 1 < shown.length) {
    nav.append(" ", make("a", { href: addressOf(shown[at + 1].id), id: "case-on" }, "Next case"));
  }
  return nav;
}

// The adapters, odd ones first, then those with a bad verdict.
function byWeight(one) {
  const weight = i => one.consensus.odd.includes(i) ? 0 : signs.get(one.cells[i])?.bad ? 1 : 2;
  return data.adapters.map((_, i) => i).sort((a, b) => weight(a) - weight(b) || a - b);
}

function overview(one) {
  const rows = data.adapters.map((name, i) => {
    const record = recordOf(one, i);
    const row = make("tr", {}, make("th", { scope: "row" }, make("code", {}, name)));
    if (record) {
      const odd = one.consensus.odd.includes(i);
      row.append(
        make("td", { class: "verdict " + record.cell.class }, ...symbolAndWord(record.cell)),
        make("td", {}, odd ? one.consensus.votes === "odd" ? "differs only here" : "differs" : ""),
        make("td", { class: "num" }, duration(record.draw)),
        make("td", { class: "num" }, duration(record.judge)));
    } else {
      row.append(make("td", { colspan: "4" }, "no record"));
    }
    return row;
  });
  return table("This case on each adapter", ["Adapter", "Verdict", "From the others", "Drawing", "Judging"], rows, { class: "figures on" });
}

function onAdapter(one, i) {
  const record = recordOf(one, i);
  if (!record) return null;
  const section = make("section", { class: "record" },
    make("h2", {}, make("code", {}, data.adapters[i]), " ",
      make("span", { class: "chip " + record.cell.class }, ...symbolAndWord(record.cell))));
  // An entry under Findings with pictures is shown in the same form.
  const found = record.body === undefined ? null : $("r" + record.body);
  const told = record.facts.filter(fact => !found || !fact.inBody);
  if (told.length) section.append(facts(told.map(fact => [fact.label, shownFact(fact)])));
  if (found) {
    const body = found.cloneNode(true);
    body.removeAttribute("id");
    for (const link of body.querySelectorAll(".all")) link.remove();
    section.append(body);
  } else {
    section.append(make("p", { class: "again" }, "Draw it again: ",
      make("code", {}, "etalon run " + quoted(one.id) + " --adapter " + quoted(data.adapters[i]))));
  }
  return section;
}

function shownFact({ form, text }) {
  return form === "pre" ? make("pre", {}, text)
    : form === "code" ? make("code", {}, text)
    : form === "case" ? make("a", { href: addressOf(text) }, make("code", {}, text))
    : text;
}

