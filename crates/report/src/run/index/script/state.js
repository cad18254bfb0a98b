// The filter: the state of its controls, and the same as a URL fragment.
const INITIAL = {
  q: "", messages: false, verdict: "", on: "", area: "", odd: "", unexpected: false, disagree: false, reason: "",
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
  const known = value => [...$("f-verdict").options].some(option => option.value === value);
  const odd = found.get("odd");
  return {
    q: found.get("q") ?? "",
    messages: found.get("messages") === "1",
    verdict: known(found.get("verdict")) ? found.get("verdict") : "",
    on: found.has("on") ? place(data.adapters, found.get("on")) : "",
    area: found.has("area") ? place(data.areas, found.get("area")) : "",
    odd: odd === undefined ? "" : odd === "" ? "any" : place(data.adapters, odd),
    unexpected: found.get("unexpected") === "1",
    disagree: found.get("disagree") === "1",
    reason: data.reasons[found.get("reason")] === undefined ? "" : found.get("reason"),
    sort: ["case", "-case", "consensus"].includes(found.get("sort")) ? found.get("sort") : "case",
    page: Math.max(1, Math.floor(Number(found.get("page"))) || 1),
  };
}

function hashOf({ q, messages, verdict, on, area, odd, unexpected, disagree, reason, sort, page }) {
  const parts = [
    ["q", q], ["messages", messages && "1"], ["verdict", verdict], ["on", on && data.adapters[on]],
    ["area", area && data.areas[area]], ["odd", odd && odd !== "any" && data.adapters[odd]],
    ["unexpected", unexpected && "1"], ["disagree", disagree && "1"], ["reason", reason], ["sort", sort !== "case" && sort], ["page", page > 1 && String(page)],
  ].filter(([key, value]) => value || key === "odd" && odd);
  return parts.length ? "#" + parts.map(([key, value]) => key + "=" + encoded(value || "")).join("&") : "#cases";
}

const filtered = state => [...TEXTS, "unexpected", "disagree", "reason"].some(key => state[key]);

// The facts of all areas, once they are searched.
let allFacts = null;

// Returns a test of a case's id, or its facts, for all words of a search but those that name adapters.
function searcher(words, messages) {
  const tests = words.map(occurs => {
    if (!messages || !allFacts) return one => occurs(one.low);
    const areas = allFacts.map(held => {
      const texts = (held?.texts ?? []).map(text => occurs(text.toLowerCase()));
      return (held?.facts ?? []).map(list => list.some((text, i) => i % 2 === 1 && texts[text]));
    });
    return one => occurs(one.low) || Boolean(allFacts[one.file.area]?.cases[one.place][1].some(list => areas[one.file.area][list]));
  });
  return one => tests.every(test => test(one));
}

// Returns the words of a search that ids can have, and the adapters that the others name.
function searched(state) {
  const names = data.adapters.map(name => name.toLowerCase());
  const [words, adapters] = [[], new Set()];
  for (const occurs of wordsOf(state.q)) {
    const named = names.flatMap((name, i) => occurs(name) ? [i] : []);
    if (named.length && !cases.some(one => occurs(one.low))) named.forEach(i => adapters.add(i));
    else words.push(occurs);
  }
  const all = data.adapters.map((_, i) => i);
  return { words, adapters: state.on ? [Number(state.on)] : adapters.size ? all.filter(i => adapters.has(i)) : all };
}

function matching(state, { words, adapters }) {
  const found = searcher(words, state.messages);
  const fits = sign => {
    const cell = signs.get(sign);
    if (state.verdict === "none") return !cell && !state.unexpected;
    if (!cell) return !state.verdict && !state.unexpected && adapters.length === data.adapters.length;
    if (state.unexpected && !cell.unexpected) return false;
    if (state.verdict === "bad") return cell.bad && !cell.due;
    return !state.verdict || cell.verdict === state.verdict;
  };
  const fitting = new Set([...signs.keys(), "."].filter(fits));
  const hasReason = (one, i) => one.reasons.some((reason, at) => at % 2 === 1 && String(reason) === state.reason && one.reasons[at - 1] === i);
  return cases.filter(one => {
    if (state.area && one.file.area !== Number(state.area)) return false;
    const { votes, odd } = one.consensus;
    if (state.odd && (votes !== "odd" || state.odd !== "any" && odd[0] !== Number(state.odd))) return false;
    if (state.disagree && votes !== "odd" && votes !== "split") return false;
    return adapters.some(i => fitting.has(one.cells[i]) && (!state.reason || hasReason(one, i))) && found(one);
  });
}

