// Break points at other limits than the one that the page was written with. As `breaks.rs`.
const LEAST = 1e-6;
const breakSection = $("breaks");
const allCurves = JSON.parse(breakSection.dataset.curves);

function twoDigits(value) {
  return value === 0 ? "0" : String(Number(value.toPrecision(2)));
}

function crossings(curve, log, limit) {
  const found = [];
  for (let i = 1; i < curve.length; i++) {
    const [[x0, e0], [x1, e1]] = [curve[i - 1], curve[i]];
    if ((e0 > limit) === (e1 > limit)) continue;
    const [l0, l1] = [e0, e1].map(e => Math.log(Math.max(e, LEAST)));
    const t = (Math.log(limit) - l0) / (l1 - l0);
    const value = log && x0 > 0 ? Math.exp(Math.log(x0) + t * (Math.log(x1) - Math.log(x0))) : x0 + t * (x1 - x0);
    found.push({ value, leaves: e1 > limit, sides: [curve[i - 1], curve[i]] });
  }
  return found;
}

function showBreaks(percent) {
  const limit = percent / 100, text = `${Number(percent)}\u00a0%`;
  const rows = [], known = new Map();
  let steady = 0;
  for (const one of allCurves) {
    const found = crossings(one.curve, one.log, limit);
    const parts = found.map((c, i) =>
      `${c.leaves ? "leaves" : "comes within"}${i ? " it" : ` ${text} RMSE`} at ${one.parameter} ${twoDigits(c.value)}`);
    const sentence = `${one.name} ${parts.join(", ")}`, key = `${one.anchor} ${sentence}`;
    if (!found.length) { if (!known.has(`${one.anchor} ${one.name}`)) steady++; known.set(`${one.anchor} ${one.name}`, null); continue; }
    if (known.has(key)) { known.get(key).push(one.adapter); continue; }
    known.set(key, [one.adapter]);
    rows.push({ one, found, sentence, adapters: known.get(key) });
  }
  const adapters = new Set(allCurves.map(c => c.adapter)).size;
  const body = document.querySelector("#break-rows tbody");
  $("limit-text").textContent = text;
  body?.replaceChildren(...rows.map(({ one, found, sentence, adapters: on }) => {
    const sides = found.flatMap((c, i) => [
      ...(i ? ["; "] : []),
      ...c.sides.flatMap((side, j) => [...(j ? [" → "] : []),
        make("a", { href: "#" + one.anchor, ...(side[2] === null ? {} : { "data-go": side[2] }) }, side[3])]),
    ]);
    const shape = document.querySelector(`#${one.anchor} .key.m${one.style % 14} .keymark`)?.cloneNode(true) ?? "";
    return make("tr", {},
      make("td", {}, make("a", { href: "#" + one.anchor }, one.scene)), make("td", {}, shape, " " + one.name),
      make("td", {}, sentence), make("td", {}, ...sides),
      make("td", {}, on.length === adapters ? "all adapters" : on.join(", ")));
  }));
  const note = $("steady");
  if (note) note.textContent = `${steady} ${steady === 1 ? "curve" : "curves"} along a parameter never cross it.`;
}

if ($("limit") && $("break-rows")) {
  $("limit-field").hidden = false;
  $("limit").addEventListener("input", event => {
    const percent = event.target.valueAsNumber;
    if (percent > 0) {
      showBreaks(percent);
      // The rings and sentences of the charts are those of 1 %.
      document.body.classList.toggle("other-limit", percent !== 1);
    }
  });
}
