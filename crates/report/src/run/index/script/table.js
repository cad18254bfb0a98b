// The table of all cases: a page of rows at a time, in groups that open and close.
const ROWS = 60;
// The filtered cases in the order of the table; the rows of all pages.
let shown = [];
let items = [];
// The adapters with a column.
let columns = [];
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

// Cases that fail as nothing expected go before known failures, and these before selftests.
const gravity = one => Math.min(...columns.map(i => cellOf(one, i)).map(cell => !cell ? 3 : cell.unexpected ? 0 : cell.bad && !cell.due ? 1 : 2));

// Rebuilds the rows after a change of the filter, the order or the open groups.
function refresh() {
  if (state.messages && !allFacts) {
    Promise.all(data.areas.map((_, area) => withFacts(area))).then(all => { allFacts = all; refresh(); });
  }
  const search = searched(state);
  columns = search.adapters;
  shown = matching(state, search);
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
    if (state.sort === "-case") sorted.reverse();
    else if (state.verdict) sorted.sort(([, a], [, b]) => Math.min(...a.map(gravity)) - Math.min(...b.map(gravity)));
    for (const [group, members] of sorted) {
      items.push({ group, members });
      if (state.sort === "-case") members.reverse();
      if (isOpen(group)) for (const one of members) items.push({ one, group, members });
    }
    shown = sorted.flatMap(([, members]) => members);
  }
  state.page = Math.min(state.page, pages());
  draw();
}

function drawHead() {
  const row = $("case-table").tHead.rows[0];
  for (const head of [...row.cells].slice(2)) head.remove();
  const names = columns.map(i => data.adapters[i]);
  $("case-table").classList.toggle("upright", columns.length > 4);
  for (const name of columns.length === 1 ? [...names, "What is wrong"] : names) {
    row.append(make("th", { scope: "col" }, make("span", {}, ...breakable(name))));
  }
  $("only").hidden = !state.reason;
  $("only").replaceChildren(make("b", {}, "With the reason: "), data.reasons[state.reason] ?? "", " ",
    make("a", { href: hashOf({ ...state, reason: "", page: 1 }) }, "All reasons"));
}

function draw() {
  drawHead();
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
  $("rows").hidden = !shown.length;
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
    for (const i of columns) counts.set(one.cells[i], (counts.get(one.cells[i]) || 0) + 1);
  }
  const chips = data.cells.filter(cell => counts.has(cell.sign)).map(cell =>
    make("span", { class: "chip " + cell.class },
      whole(counts.get(cell.sign)) + " ", make("i", { "aria-hidden": "true" }, cell.symbol), " " + cell.word));
  const button = again ? make("span", {}, group.name + " (continued)") :
    make("button", { type: "button", "aria-expanded": String(open), "data-key": key, tabindex: key === cursor ? "0" : "-1" },
      make("i", { "aria-hidden": "true" }, open ? "▾ " : "▸ "), group.name);
  const words = make("div", {}, button, " ", make("small", {}, counted(members.length, "case")), ...chips);
  return make("tr", { class: "group" },
    make("th", { scope: "rowgroup", colspan: columns.length + (columns.length === 1 ? 3 : 2) }, words));
}

function caseRow(one, group) {
  const key = "c" + one.number;
  const text = group && one.id.length > group.name.length ? one.id.slice(group.name.length).replace(/^\//, "") : one.id;
  const link = make("a", { href: addressOf(one.id), "data-key": key, tabindex: key === cursor ? "0" : "-1" }, text || "(no name)");
  const row = make("tr", {}, make("th", { scope: "row" }, link), make("td", { class: "says " + one.consensus.votes }, one.consensus.text));
  for (const i of columns) row.append(verdictCell(one, i));
  if (columns.length === 1) row.append(reasonCell(one, columns[0]));
  return row;
}

function verdictCell(one, adapter) {
  const cell = cellOf(one, adapter);
  const head = data.adapters[adapter];
  if (!cell) return make("td", { class: "none" }, make("span", { class: "vh" }, "no record"));
  const odd = one.consensus.odd.includes(adapter);
  const symbol = cell.excused ? "(" + cell.symbol + ")" : cell.symbol;
  const seen = cell.bad && !cell.excused || cell.word.includes("(due");
  return make("td", { class: cell.class + (odd ? " odd" : ""), title: cell.word, "data-head": head },
    make("i", { "aria-hidden": "true" }, symbol), seen ? " " : "",
    make("span", { class: seen ? "" : "vh" }, cell.word + (odd && !seen ? ", differs" : "")));
}

// Returns a cell that tells what is wrong when the area's facts have loaded.
function reasonCell(one, adapter) {
  const cell = make("td", { class: "says why" });
  withFacts(one.file.area).then(held => {
    const told = recordOf(held, one, adapter).facts;
    const [lead, known] = ["lead", "known"].map(form => told.find(fact => fact.form === form));
    cell.textContent = (lead ?? known)?.text ?? "";
  });
  return cell;
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

