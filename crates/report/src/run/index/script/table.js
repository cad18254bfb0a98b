// The table of all cases: a page of rows at a time, in groups that open and close.
const ROWS = 100;
// The filtered cases in the order of the table; the rows of all pages.
let shown = [];
let items = [];
let cursor = null;
const toggled = new Set();

const keyOf = item => (item.one ? "c" + item.one.number : "g" + item.group.number);
const pages = () => Math.max(1, Math.ceil(items.length / ROWS));
const openFirst = () => filtered(state) || cases.length <= ROWS;
const isOpen = group => openFirst() !== toggled.has(group.number);

// Cases that agree least go first.
const APART = { split: 0, odd: 1, alone: 3, agree: 4, nobody: 5 };
function byConsensus(a, b) {
  const wrong = one => [...one.cells].some(sign => signs.get(sign)?.unexpected) ? 0 : 1;
  return APART[a.consensus.votes] - APART[b.consensus.votes] || wrong(a) - wrong(b) || a.number - b.number;
}

// Rebuilds the rows after a change of the filter, the order or the open groups.
function refresh() {
  shown = matching(state);
  items = [];
  if (state.sort === "consensus") {
    shown.sort(byConsensus);
    items = shown.map(one => ({ one }));
  } else {
    const groups = new Map();
    for (const one of shown) {
      if (!groups.has(one.file)) groups.set(one.file, []);
      groups.get(one.file).push(one);
    }
    const sorted = [...groups];
    if (state.sort === "-case") sorted.reverse(), shown.reverse();
    for (const [group, members] of sorted) {
      items.push({ group, members });
      if (state.sort === "-case") members.reverse();
      if (isOpen(group)) for (const one of members) items.push({ one, group, members });
    }
  }
  state.page = Math.min(state.page, pages());
  draw();
}

function draw() {
  const table = $("case-table");
  for (const body of [...table.tBodies]) body.remove();
  const first = (state.page - 1) * ROWS;
  const page = items.slice(first, first + ROWS);
  if (!page.some(item => keyOf(item) === cursor)) cursor = page.length ? keyOf(page[0]) : null;
  let body = null;
  page.forEach((item, i) => {
    if (!body || !item.one) {
      body = make("tbody", {});
      table.append(body);
      // A group that began on the page before repeats its name.
      if (item.one && item.group) body.append(groupRow(item, true));
    }
    body.append(item.one ? caseRow(item.one, item.group) : groupRow(item, false));
  });
  for (const button of table.querySelectorAll("[data-sort]")) {
    const key = button.dataset.sort;
    const order = state.sort === key ? "ascending" : state.sort === "-" + key ? "descending" : "none";
    button.closest("th").setAttribute("aria-sort", order);
  }
  let text = whole(shown.length) + " of " + counted(cases.length, "case");
  if (!shown.length) text += ": no case fits the filters";
  if ($("count").textContent !== text) $("count").textContent = text;
  $("pages").hidden = pages() === 1;
  $("page-at").textContent = "Page " + state.page + " of " + pages();
  $("page-back").setAttribute("aria-disabled", String(state.page === 1));
  $("page-on").setAttribute("aria-disabled", String(state.page === pages()));
  $("f-clear").setAttribute("aria-disabled", String(!filtered(state)));
  const closed = items.some(item => !item.one && !isOpen(item.group));
  $("f-groups").textContent = closed ? "Open all groups" : "Close all groups";
  $("f-groups").setAttribute("aria-disabled", String(state.sort === "consensus"));
}

function groupRow({ group, members }, again) {
  const open = isOpen(group);
  const key = "g" + group.number;
  const counts = new Map();
  for (const one of members) {
    for (const sign of one.cells) counts.set(sign, (counts.get(sign) || 0) + 1);
  }
  const chips = data.cells.filter(cell => counts.has(cell.sign)).map(cell =>
    make("span", { class: "chip " + cell.class },
      whole(counts.get(cell.sign)) + " ", make("i", { "aria-hidden": "true" }, cell.symbol), " " + cell.word));
  const button = again ? make("span", {}, group.name + " (continued)") :
    make("button", { type: "button", "aria-expanded": String(open), "data-key": key, tabindex: key === cursor ? "0" : "-1" },
      make("i", { "aria-hidden": "true" }, open ? "▾ " : "▸ "), group.name);
  const words = make("div", {}, button, " ", make("small", {}, counted(members.length, "case")), ...chips);
  return make("tr", { class: "group" },
    make("th", { scope: "rowgroup", colspan: data.adapters.length + 2 }, words));
}

function caseRow(one, group) {
  const key = "c" + one.number;
  const text = group && one.id.length > group.name.length ? one.id.slice(group.name.length).replace(/^\//, "") : one.id;
  const link = make("a", { href: addressOf(one.id), "data-key": key, tabindex: key === cursor ? "0" : "-1" }, text || "(no name)");
  const row = make("tr", {}, make("th", { scope: "row" }, link), make("td", { class: "says " + one.consensus.votes }, one.consensus.text));
  for (let i = 0; i < data.adapters.length; i++) row.append(verdictCell(one, i));
  return row;
}

function verdictCell(one, adapter) {
  const cell = signs.get(one.cells[adapter]);
  if (!cell) return make("td", { class: "none" }, make("span", { class: "vh" }, "no record"));
  const odd = one.consensus.odd.includes(adapter);
  const symbol = cell.excused ? "(" + cell.symbol + ")" : cell.symbol;
  const seen = cell.bad && !cell.excused || cell.word.includes("(due");
  return make("td", { class: cell.class + (odd ? " odd" : ""), title: cell.word },
    make("i", { "aria-hidden": "true" }, symbol), seen ? " " : "",
    make("span", { class: seen ? "" : "vh" }, cell.word + (odd && !seen ? ", differs" : "")));
}

// Moves the one row that the Tab key can reach, across pages if necessary.
function moveTo(place) {
  if (!items.length) return;
  place = Math.min(Math.max(place, 0), items.length - 1);
  cursor = keyOf(items[place]);
  const page = Math.floor(place / ROWS) + 1;
  if (page !== state.page) {
    state.page = page;
    history.replaceState(null, "", hashOf(state));
    draw();
  }
  focusCursor();
}

function focusCursor() {
  for (const element of $("case-table").querySelectorAll("[data-key]")) {
    element.tabIndex = element.dataset.key === cursor ? 0 : -1;
    if (element.dataset.key !== cursor) continue;
    element.focus();
    element.closest("tr").scrollIntoView({ block: "nearest" });
  }
}

function toggle(number) {
  toggled.has(number) ? toggled.delete(number) : toggled.add(number);
  cursor = "g" + number;
  refresh();
  focusCursor();
}

