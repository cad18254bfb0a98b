// Functions that the scripts of all pages share. Texts of records become text nodes; nothing here turns them
// into HTML.
const $ = id => document.getElementById(id);

// Returns an element. All callers pass literals as the names of elements and attributes.
const make = (name, attributes, ...children) => filled(document.createElement(name), attributes, children);

function filled(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== false && value !== null) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

// Returns a name as nodes with a possible line break after each of its parts.
const breakable = name => name.split(/(?<=[:\/,+])/).flatMap((part, i) => i ? [make("wbr", {}), part] : [part]);

const whole = n => n.toLocaleString("en");
const counted = (n, noun) => whole(n) + " " + noun + (n === 1 ? "" : "s");

function table(caption, heads, rows, look = {}) {
  const head = make("tr", {}, ...heads.map(text => make("th", { scope: "col" }, text)));
  return make("div", { class: "wide" }, make("table", look,
    make("caption", look.class ? { class: "vh" } : {}, caption), make("thead", {}, head), make("tbody", {}, ...rows)));
}

function cells(first, ...others) {
  return make("tr", {}, make("th", { scope: "row" }, ...[first].flat()), ...others.map(one => make("td", {}, ...[one].flat())));
}

// Returns facts as pairs of name and content. A name that repeats the one before is left out.
function facts(pairs) {
  const names = pairs.map(([name], i) => i && pairs[i - 1][0] === name ? [] : [make("dt", {}, name)]);
  return make("dl", { class: "facts" }, ...pairs.flatMap(([, content], i) => [...names[i], make("dd", {}, content)]));
}

// Returns a list that is filled when it is opened.
function folded(summary, fill) {
  const details = make("details", {}, make("summary", {}, summary));
  details.addEventListener("toggle", () => {
    if (details.open && details.children.length === 1) details.append(...[fill()].flat());
  });
  return details;
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

// Keeps ids readable in URLs.
function encoded(text) {
  return encodeURIComponent(text.toWellFormed()).replace(/%(2F|3A|3D|2C)/g, decodeURIComponent);
}

const addressOf = id => "#case=" + encoded(id);

// Returns the parameters after `#`. An element's id has no `=` and gives none.
function parameters() {
  const found = new Map();
  for (const part of location.hash.slice(1).split("&")) {
    const at = part.indexOf("=");
    if (at > 0) found.set(part.slice(0, at), decoded(part.slice(at + 1)));
  }
  return found;
}

// Shows the view that the URL names in place of the start page. If the URL names no view, calls `back`, with
// true if a view was shown before. A view is a function from the text after its name to the links back, the
// title, the heading if it differs from the title, and the content.
function router(home, view, views, back) {
  const title = document.title;
  let turn = 0;
  return async () => {
    const mine = ++turn;
    const [[name, text]] = [...parameters(), [location.hash.slice(1), ""]];
    const made = Object.hasOwn(views, name) ? await views[name](text) : null;
    if (mine !== turn) return;
    const wasAway = home.hidden;
    document.title = made ? made.title + " – etalon" : title;
    [home.hidden, view.hidden] = [Boolean(made), !made];
    if (!made) return back(wasAway);
    const heading = make("h1", { id: view.id + "-title", tabindex: "-1" }, made.heading ?? made.title);
    // An element in use, such as the search field, keeps its place.
    const leads = made.leads();
    for (const child of [...view.children]) if (!leads.includes(child)) child.remove();
    view.append(...leads.filter(lead => lead.parentElement !== view), heading, ...made.content);
    (made.focus ?? heading).focus({ preventScroll: true });
    if (!made.focus) scrollTo(0, 0);
    // A mark for measurements.
    performance.mark("etalon-shown");
  };
}
// Returns a function for each word of a search: whether a lower-case text contains the word. `*` matches
// anything.
function wordsOf(search) {
  return search.toLowerCase().split(/\s+/).filter(Boolean).map(word => text => {
    let at = 0;
    for (const piece of word.split("*")) {
      const found = text.indexOf(piece, at);
      if (found < 0) return false;
      at = found + piece.length;
    }
    return true;
  });
}

// Opens the groups around the target of a link. Browsers that do this themselves lose nothing.
function reveal(id) {
  const target = id && $(id);
  for (let e = target; e; e = e.parentElement) if (e.tagName === "DETAILS") e.open = true;
  if (target) target.scrollIntoView();
}

// Returns true for a key that belongs to the browser.
const foreign = event => event.ctrlKey || event.metaKey || event.altKey || event.isComposing;
const typing = target => target.closest("input:not([type=checkbox]), textarea, select");

// Loads neighbouring scripts on demand. Each script calls the function `global` with its name and its value.
// Returns a function from a name to a promise of the script's value, or of null if it cannot be loaded.
function beside(global, address) {
  const [held, waiting] = [new Map(), new Map()];
  Object.defineProperty(window, global, { value: (name, value) => { held.set(name, value); } });
  const load = name => new Promise(done => {
    const element = make("script", {});
    const tell = () => {
      waiting.delete(name);
      element.remove();
      done(held.get(name) ?? null);
    };
    element.addEventListener("load", tell);
    element.addEventListener("error", tell);
    element.src = address(name);
    document.head.append(element);
  });
  return name => {
    if (held.has(name) || !address(name)) return Promise.resolve(held.get(name) ?? null);
    if (!waiting.has(name)) waiting.set(name, load(name));
    return waiting.get(name);
  };
}

