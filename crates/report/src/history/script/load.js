// Files beside the page, loaded when something in them is to be seen. Texts of the history become text nodes and
// nothing else, but for labels that are addresses.
const $ = id => document.getElementById(id);

// An element; the names of elements and attributes are literals wherever this is called.
function make(name, attributes, ...children) {
  const element = document.createElement(name);
  set(element, attributes);
  element.append(...children);
  return element;
}

// The same of a drawing.
function draw(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  set(element, attributes);
  element.append(...children);
  return element;
}

function set(element, attributes) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== false && value !== null) element.setAttribute(key, value === true ? "" : value);
  }
}

const index = JSON.parse($("index").textContent);
const held = new Map();
const waiting = new Map();

// The files call this with their name and what they hold.
Object.defineProperty(window, "etalonHistory", { value: (name, value) => { held.set(name, value); } });

// What a file holds; null where it cannot be loaded.
function need(name) {
  if (held.has(name)) return Promise.resolve(held.get(name));
  if (!waiting.has(name)) {
    waiting.set(name, new Promise(done => {
      const element = document.createElement("script");
      const tell = () => {
        waiting.delete(name);
        element.remove();
        done(held.has(name) ? held.get(name) : null);
      };
      element.addEventListener("load", tell);
      element.addEventListener("error", tell);
      element.src = "data/" + name + ".js";
      document.head.append(element);
    }));
  }
  return waiting.get(name);
}

// The last of ascending values that is not above one; -1 where all are.
function placeOf(values, value) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

const whole = n => n.toLocaleString("en");
const counted = (n, noun) => whole(n) + " " + noun + (n === 1 ? "" : "s");

function table(caption, heads, rows) {
  const head = make("tr", {}, ...heads.map(text => make("th", { scope: "col" }, text)));
  return make("div", { class: "wide" }, make("table", {},
    make("caption", {}, caption), make("thead", {}, head), make("tbody", {}, ...rows)));
}

function cells(first, ...others) {
  return make("tr", {}, make("th", { scope: "row" }, ...[first].flat()), ...others.map(one => make("td", {}, ...[one].flat())));
}

// A list that is made when it is opened.
function folded(summary, fill) {
  const details = make("details", {}, make("summary", {}, summary));
  details.addEventListener("toggle", () => {
    if (details.open && details.children.length === 1) details.append(...[fill()].flat());
  });
  return details;
}

