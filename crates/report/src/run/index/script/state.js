// The filter: the state of its controls, and the same as a URL fragment.
const INITIAL = {
  q: "", messages: false, verdict: "", on: "", area: "", odd: "", unexpected: false, disagree: false,
  sort: "case", page: 1,
};
// The filters with a text, and the filters that are on or off.
const TEXTS = ["q", "verdict", "on", "area", "odd"];
const CHECKS = ["messages", "unexpected", "disagree"];
let state = { ...INITIAL };

function stateOf(found) {
  const place = (list, name) => {
    const at = list.indexOf(name);
    return at < 0 ? "" : String(at);
  };
  const areas = [...$("f-area").options].slice(1).map(option => option.textContent);
  const known = value => [...$("f-verdict").options].some(option => option.value === value);
  const odd = found.get("odd");
  return {
    q: found.get("q") ?? "",
    messages: found.get("messages") === "1",
    verdict: known(found.get("verdict")) ? found.get("verdict") : "",
    on: found.has("on") ? place(data.adapters, found.get("on")) : "",
    area: found.has("area") ? place(areas, found.get("area")) : "",
    odd: odd === undefined ? "" : odd === "" ? "any" : place(data.adapters, odd),
    unexpected: found.get("unexpected") === "1",
    disagree: found.get("disagree") === "1",
    sort: ["case", "-case", "consensus"].includes(found.get("sort")) ? found.get("sort") : "case",
    page: Math.max(1, Math.floor(Number(found.get("page"))) || 1),
  };
}

function hashOf({ q, messages, verdict, on, area, odd, unexpected, disagree, sort, page }) {
  const parts = [
    ["q", q], ["messages", messages && "1"], ["verdict", verdict], ["on", on && data.adapters[on]],
    ["area", area && $("f-area").options[Number(area) + 1].textContent], ["odd", odd && odd !== "any" && data.adapters[odd]],
    ["unexpected", unexpected && "1"], ["disagree", disagree && "1"], ["sort", sort !== "case" && sort], ["page", page > 1 && String(page)],
  ].filter(([key, value]) => value || key === "odd" && odd);
  return parts.length ? "#" + parts.map(([key, value]) => key + "=" + encoded(value || "")).join("&") : "#cases";
}

const filtered = state => [...TEXTS, "unexpected", "disagree"].some(key => state[key]);

// True if a case's id, or its facts, contain all words of a search.
function searcher(q, messages) {
  const tests = wordsOf(q).map(occurs => {
    if (!messages) return one => occurs(one.low);
    const texts = data.texts.map(text => occurs(text.toLowerCase()));
    const facts = data.facts.map(list => list.some((text, i) => i % 2 === 1 && texts[text]));
    return one => occurs(one.low) || one.facts.some(list => facts[list]);
  });
  return one => tests.every(test => test(one));
}

function matching(state) {
  const found = searcher(state.q, state.messages);
  const adapters = state.on ? [Number(state.on)] : data.adapters.map((_, i) => i);
  const fits = sign => {
    const cell = signs.get(sign);
    if (state.verdict === "none") return !cell && !state.unexpected;
    if (!cell || state.unexpected && !cell.unexpected) return false;
    if (state.verdict === "bad") return cell.bad;
    return !state.verdict || cell.verdict === state.verdict;
  };
  const fitting = new Set([...signs.keys(), "."].filter(fits));
  return cases.filter(one => {
    if (state.area && one.file.area !== Number(state.area)) return false;
    const { votes, odd } = one.consensus;
    if (state.odd && (votes !== "odd" || state.odd !== "any" && odd[0] !== Number(state.odd))) return false;
    if (state.disagree && votes !== "odd" && votes !== "split") return false;
    return adapters.some(i => fitting.has(one.cells[i])) && found(one);
  });
}

