// The view of one case: every adapter's verdict and all that is known about it.
const REPORT_TITLE = document.title;
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

function showCase(id) {
  const view = $("case");
  current = id;
  const number = numberOf.get(id);
  const one = number === undefined ? null : cases[number];
  view.className = "";
  view.replaceChildren(neighbours(one), make("h1", { id: "case-title", tabindex: "-1" }, make("code", {}, id)));
  if (one) {
    view.append(
      make("p", {}, make("b", {}, "Consensus: "), one.consensus.text + "."),
      overview(one),
      meant(id),
      ...byWeight(one).map(i => onAdapter(one, i)).filter(Boolean));
  } else {
    view.append(
      make("p", { class: "state bad", role: "alert" }, "This run has no case of this name."),
      make("p", {}, make("a", { href: "#q=" + encoded(id) }, "Search for it"), " among all cases."));
  }
  document.title = id + " – etalon";
  $("report").hidden = true;
  view.hidden = false;
  scrollTo(0, 0);
  $("case-title").focus({ preventScroll: true });
}

// The way back, and to the cases before and after in what the filter left.
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
  const body = make("tbody", {});
  data.adapters.forEach((name, i) => {
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
    body.append(row);
  });
  const heads = ["Adapter", "Verdict", "From the others", "Drawing", "Judging"];
  return make("div", { class: "wide" }, make("table", { class: "figures on" },
    make("caption", { class: "vh" }, "This case on each adapter"),
    make("thead", {}, make("tr", {}, ...heads.map(head => make("th", { scope: "col" }, head)))), body));
}

function onAdapter(one, i) {
  const record = recordOf(one, i);
  if (!record) return null;
  const section = make("section", { class: "record" },
    make("h2", {}, make("code", {}, data.adapters[i]), " ",
      make("span", { class: "chip " + record.cell.class }, ...symbolAndWord(record.cell))));
  // An entry under Findings with pictures is shown as it is there.
  const found = record.body === undefined ? null : $("r" + record.body);
  const facts = record.facts.filter(fact => !found || !fact.inBody);
  if (facts.length) section.append(listed(facts));
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

function listed(facts) {
  const list = make("dl", { class: "facts" });
  let last = "";
  for (const { label, form, text } of facts) {
    if (label !== last) list.append(make("dt", {}, label));
    last = label;
    const inner = form === "pre" ? make("pre", {}, text)
      : form === "code" ? make("code", {}, text)
      : form === "case" ? make("a", { href: addressOf(text) }, make("code", {}, text))
      : text;
    list.append(make("dd", {}, inner));
  }
  return list;
}

