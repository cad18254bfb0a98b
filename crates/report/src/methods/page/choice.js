// The adapter, the size of frames and the budget by which methods are chosen. `choice/answer.rs` says the same for the
// budget with which the page begins, and a test compares both.
const TIMES = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 2e-2, 5e-2, 1e-1, 2e-1, 5e-1, Infinity];
const ERRORS = [0, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 1e-1, Infinity];
const ROUNDING = 1 / (255 * Math.sqrt(12)), EXACT = 2 / 255 + 1e-9;
// The numbers of texels of timed frames, and those of computed ones: from half the least to twice the largest.
const KNOWN = JSON.parse($("overview")?.dataset.sizes ?? "[]").slice(1).map(([width, height]) => width * height);
const TEXELS = Array.from({ length: 101 }, (_, i) => Math.min(...KNOWN) / 2 * (4 * Math.max(...KNOWN) / Math.min(...KNOWN)) ** (i / 100));
const bounded = (value, text) => value === Infinity ? "any" : text(value);
const worstAlike = error => Math.max(error * 1.05, ROUNDING);

// Numbers as text, as `numbers.rs` writes them.
function digits(value) {
  if (value === 0) return "0";
  const places = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
  const text = value.toFixed(places);
  return places ? text.replace(/\.?0+$/, "") : text;
}
function percent(value) {
  const shown = value * 100;
  if (shown === 0) return "0";
  return (shown < 9.5e-5 ? shown.toExponential(0).replace("e-0", "e-") : digits(shown)) + "\u00a0%";
}
function seconds(value) {
  const [factor, unit] = value === 0 ? [1, "s"] : value < 1e-6 ? [1e9, "ns"] : value < 1e-3 ? [1e6, "µs"] : value < 1 ? [1e3, "ms"] : [1, "s"];
  return digits(value * factor) + " " + unit;
}

const megapixels = texels => digits(texels / 1e6) + " megapixels";

function median(values) {
  const sorted = [...values].sort((a, b) => a - b), middle = (sorted.length - 1) / 2;
  return (sorted[Math.floor(middle)] + sorted[Math.ceil(middle)]) / 2;
}

// Returns the methods of a card on an adapter at a frame: `{ index }` of a measured size, or `{ texels }`.
function candidates(card, adapter, frame) {
  const points = JSON.parse(card.dataset.points).filter(point => point[1] === adapter);
  const here = ([, , , at, cost]) => {
    if (frame.texels === undefined) return at[frame.index];
    const nearest = at[frame.nearest];
    if (!cost || !nearest) return null;
    const [fixed, unit] = cost;
    const times = fixed.map((time, i) => Math.max(0, time + unit[i] * frame.texels / 1e6));
    const all = [Math.min(times[0], times[1]), times[1], Math.max(times[2], times[1])];
    return all.every(time => time > 0) ? [...all, ...nearest.slice(3)] : null;
  };
  const found = JSON.parse(card.dataset.methods).map(([name, order], key) => {
    const ofMethod = points.filter(point => point[0] === name).map(point => [point[2], here(point)]);
    return { name, order, key, places: new Map(ofMethod.filter(([, place]) => place)) };
  });
  const most = Math.max(0, ...found.map(one => one.places.size));
  const kept = found.filter(one => one.places.size && 2 * one.places.size >= most);
  // Errors of different scenes do not compare: the scenes that all methods draw count, if there are any.
  const common = [...kept[0]?.places.keys() ?? []].filter(scene => kept.every(one => one.places.has(scene)));
  return kept.map(({ places: all, ...one }) => {
    const scenes = common.length ? common : [...all.keys()], places = scenes.map(scene => all.get(scene));
    const errors = places.map(place => place[3]);
    return {
      ...one, scenes, time: [0, 1, 2].map(end => median(places.map(place => place[end]))),
      error: [Math.min(...errors), median(errors), Math.max(...errors)], exact: places.every(place => place[4] <= EXACT),
    };
  });
}

// The factor between the times of two runs that the interval of one does not show; the page's first sentences use it too.
const ANOTHER_RUN = 1.06, quickest = one => one.time[0] / ANOTHER_RUN, slowest = one => one.time[2] * ANOTHER_RUN;

// Returns the best methods within a budget, or the fastest one if none is within it.
function choose(all, most, limit) {
  const fastest = of => of.reduce((best, one) => best && best.time[1] <= one.time[1] ? best : one, null);
  const every = all.filter(one => one.error[1] <= limit);
  const sure = every.filter(one => slowest(one) <= most), possible = every.filter(one => quickest(one) <= most);
  if (!possible.length) return { nothing: fastest(every) ?? fastest(all) };
  const base = sure.length ? sure : possible, byTime = limit !== Infinity;
  const least = Math.min(...base.map(one => one.error[1]));
  const alike = byTime ? base : base.filter(one => one.error[1] <= worstAlike(least));
  const best = fastest(alike), canBeFaster = one => quickest(one) <= slowest(best);
  const isBetter = one => byTime ? canBeFaster(one) : worstAlike(one.error[1]) < least;
  const unsure = possible.filter(one => !sure.includes(one) && isBetter(one) && !alike.includes(one));
  return { best: [best, ...alike.filter(one => one !== best && canBeFaster(one)), ...unsure] };
}

function answer(all, most, limit, place) {
  const limits = [most !== Infinity && seconds(most), limit !== Infinity && percent(limit)].filter(Boolean);
  const head = limits.length ? `Within ${limits.join(" and ")} at ${place}` : `At ${place}`;
  const words = name => name === "none" ? "none (plain drawing)" : name;
  const figures = one => {
    const [low, error, high] = one.error, several = one.scenes.length > 1;
    const range = several && low < high ? ` (${percent(low)} to ${percent(high)} over ${one.scenes.length} scenes)` : "";
    const kind = error === 0 ? "no error" : (several ? "median error " : "error ") + percent(error);
    return `${words(one.name)}, ${kind}${range}, ${seconds(one.time[1])}`;
  };
  const { nothing, best } = choose(all, most, limit);
  if (nothing === null) return `${head}: not timed.`;
  if (nothing) return `${head}: nothing. The fastest is ${figures(nothing)}.`;
  const either = some => some.length > 2
    ? `one of ${some.length} that cannot be told apart, such as ${figures(some[0])}`
    : (some.length === 2 ? "either " : "") + some.map(figures).join("; or ");
  const first = either(best);
  const hasOrder = all.some(one => one.order !== null), isFree = one => !one.order;
  const free = best.some(isFree) ? [] : choose(all.filter(isFree), most, limit).best ?? [];
  const anyOrder = free.length ? `; in any order: ${either(free)}` : "";
  const fits = one => one.exact && isFree(one);
  if ([...best, ...free].some(fits)) return `${head}: ${first}${anyOrder}.`;
  const exact = all.filter(fits).sort((a, b) => a.time[1] - b.time[1])[0];
  const name = hasOrder ? "exact and order-independent" : "exact";
  return `${head}: ${first}${anyOrder}${exact ? `; ${name}: ${words(exact.name)}, ${seconds(exact.time[1])}` : ""}.`;
}

// Returns an element of a chart; its namespace is that of the charts on the page.
const drawn = (name, attributes, ...children) =>
  filled(document.createElementNS(document.querySelector("svg").namespaceURI, name), attributes, children);

// Draws the marks of a card's methods on an adapter, and the limits of the budget.
function plotMarks(card, adapter, all, most, limit) {
  const plotted = card.querySelector(".plotted");
  if (!plotted) return;
  const [[x0, x1], left, right] = JSON.parse(plotted.dataset.x), [[y0, y1], top, bottom, zero] = JSON.parse(plotted.dataset.y);
  const part = (value, low, high) => Math.min(1, Math.max(0, (Math.log10(value) - low) / (high - low)));
  const x = time => left + part(time, x0, x1) * (right - left);
  const y = error => zero > 0 && error <= 0 ? bottom - zero / 2 : bottom - zero - part(error, y0, y1) * (bottom - zero - top);
  const scenes = JSON.parse(card.dataset.scenes), question = card.querySelector("h3 a").hash.slice(2);
  const target = one => one.scenes.length === 1 ? scenes[one.scenes[0]] : `m${question}-${adapter}-${one.key}`;
  const keys = card.querySelectorAll(".legend .key path"), taken = all.map(one => box(x(one.time[1]) - 5, y(one.error[1]) + 5, 10, 10));
  const marks = all.map(one => {
    const [at, up] = [x(one.time[1]), y(one.error[1])], name = one.name + (one.order ?? "");
    const mark = keys[one.key].cloneNode();
    mark.setAttribute("transform", `translate(${at} ${up})`);
    mark.append(drawn("title", {}, `${one.name}: ${percent(one.error[1])} (${percent(one.error[0])} to ${percent(one.error[2])}), ` +
      `${seconds(one.time[1])} (${seconds(one.time[0])} to ${seconds(one.time[2])})`));
    const group = drawn("a", { class: mark.getAttribute("class").replace("mark", "of"), href: "#" + target(one) },
      drawn("path", { class: "spread", d: `M${at} ${y(one.error[0])}V${y(one.error[2])}` }),
      drawn("path", { class: "spread wide", d: `M${x(one.time[0])} ${up}H${x(one.time[2])}` }), mark);
    group.classList.toggle("beyond", one.time[1] > most || one.error[1] > limit);
    const wide = name.length * 7.7;
    const places = [[at + 7, up + 5], [at + 6, up - 7], [at + 6, up + 17], [at - wide - 8, up + 5], [at - wide / 2, up - 9], [at - wide / 2, up + 20]];
    const free = places.find(([l, b]) => l > left && l + wide < right && b - 12 > top && b < bottom && !taken.some(other => meet(box(l, b, wide, 14), other)));
    if (free) {
      taken.push(box(...free, wide, 14));
      group.append(drawn("text", { class: "label", x: free[0], y: free[1] }, name));
    }
    return group;
  });
  plotted.querySelector(".marks").replaceChildren(...marks);
  const limits = [most !== Infinity && `M${x(most)} ${top}V${bottom}`, limit !== Infinity && `M${left} ${y(limit)}H${right}`];
  plotted.querySelector(".limits").replaceChildren(...limits.filter(Boolean).map(d => drawn("path", { class: "limit", d })));
}

// Rectangles by their left end, their bottom, width and height.
const box = (left, bottom, width, height) => [left, bottom - height, left + width, bottom];
const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

function weigh() {
  const on = Number($("on").value);
  const [most, limit] = [[TIMES, "most-time"], [ERRORS, "most-error"]].map(([stops, id]) => stops[Number($(id).value)]);
  const outputs = [["most-time", most, seconds], ["most-error", limit, percent]];
  for (const [id, value, text] of outputs) $(id).labels[0].querySelector("output").textContent = bounded(value, text);
  const computed = $("frame").value === "computed";
  $("texels").closest("label").hidden = !computed;
  let frame = { index: Number($("frame").value) }, size = $("frame").selectedOptions[0].textContent;
  if (computed) {
    const texels = TEXELS[Number($("texels").value)], away = i => Math.abs(Math.log(KNOWN[i] / texels));
    frame = { texels, nearest: 1 + KNOWN.map((_, i) => i).reduce((best, i) => away(i) < away(best) ? i : best, 0) };
    size = megapixels(texels);
    $("texels").labels[0].querySelector("output").textContent = size;
  }
  const place = `${size} on ${$("on").selectedOptions[0].textContent}`;
  for (const card of document.querySelectorAll(".card")) {
    const all = candidates(card, on, frame);
    card.querySelector(".answer").textContent = answer(all, most, limit, place);
    plotMarks(card, on, all, most, limit);
    const missing = JSON.parse(card.dataset.methods).map(([name]) => name).filter(name => !all.some(one => one.name === name));
    card.querySelector(".untimed").textContent = missing.length ? `Not timed here: ${missing.join(", ")}.` : "";
  }
  for (const part of document.querySelectorAll("[data-on]")) part.classList.toggle("off", Number(part.dataset.on) !== on);
}

// The choice as the address has it, `#device=cpu&size=1280x720&time=2ms&error=any`: each name with its controls, and
// the text of each of their settings.
function settings() {
  const options = id => [...$(id).options];
  const plain = text => text.replace(/[\u00a0 ]/g, "").replace("×", "x").replace("µ", "u").replace("%", "pct").replace("megapixels", "MP");
  const stops = (values, text) => values.map((value, i) => [plain(bounded(value, text)), i]);
  const sizes = ({ value, textContent }) => value === "computed"
    ? stops(TEXELS, megapixels).map(([text, i]) => [text, value, i])
    : [[value === "0" ? "pictures" : plain(textContent), value]];
  return [
    ["device", ["on"], options("on").map(one => [one.textContent, one.value])],
    ["size", ["frame", "texels"], options("frame").flatMap(sizes)],
    ["time", ["most-time"], stops(TIMES, seconds)],
    ["error", ["most-error"], stops(ERRORS, percent)],
  ];
}

// Puts the choice into the address, and the id of the element to which a link led. Other parameters stay.
let isKept = false;
function keep(id) {
  const parts = parameters();
  parts.delete("at");
  for (const [name, ids, all] of settings()) {
    parts.set(name, all.find(([, ...values]) => values.every((value, i) => $(ids[i]).value === String(value)))[0]);
  }
  if (id) parts.set("at", id);
  history.replaceState(null, "", "#" + [...parts].map(([name, text]) => `${encoded(name)}=${encoded(text)}`).join("&"));
  isKept = true;
}

// Takes from the address what it names of the choice. A link within the page leaves the choice in the address.
function follow() {
  if (!$("budget")) return;
  const named = parameters(), id = location.hash.slice(1);
  for (const [name, ids, all] of settings()) {
    const [, ...values] = all.find(([text]) => text === named.get(name)) ?? [];
    values.forEach((value, i) => { $(ids[i]).value = value; });
    isKept ||= values.length > 0;
  }
  weigh();
  if (named.has("at")) $(named.get("at"))?.scrollIntoView();
  else if (isKept && $(id)) keep(id);
}

if ($("budget")) {
  $("budget").hidden = false;
  const begin = Number($("budget").dataset.time);
  for (const [stops, id, start] of [[TIMES, "most-time", TIMES.indexOf(begin)], [ERRORS, "most-error", ERRORS.length - 1]]) {
    $(id).max = stops.length - 1;
    $(id).value = start;
  }
  $("budget").addEventListener("input", weigh);
  $("budget").addEventListener("change", () => keep());
  $("budget").addEventListener("submit", event => event.preventDefault());
  // A page that shows its charts anew replaces the listener.
  window.onhashchange = follow;
  follow();
}

// A click on the head of a column sorts the rows by it, a second one the other way round.
for (const head of document.querySelectorAll("table.sortable thead th")) {
  head.addEventListener("click", event => {
    if (event.target.closest("a")) return;
    const body = head.closest("table").tBodies[0], at = head.cellIndex, sorted = head.getAttribute("aria-sort") !== "ascending";
    const value = row => Number(row.cells[at].dataset.value ?? NaN), name = row => row.cells[at].textContent;
    const rows = [...body.rows].sort((a, b) => {
      const [x, y] = [value(a), value(b)];
      const order = at === 0 ? name(a).localeCompare(name(b)) : Number.isNaN(x) - Number.isNaN(y) || x - y;
      return sorted || Number.isNaN(x) !== Number.isNaN(y) ? order : -order;
    });
    for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", sorted ? "ascending" : "descending");
    body.append(...rows);
  });
}
