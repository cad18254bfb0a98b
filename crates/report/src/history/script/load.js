// Files next to the page. Texts of the history become text nodes; only labels that are URLs become links.
const index = JSON.parse($("index").textContent);
const need = beside("etalonHistory", name => "data/" + name + ".js");

// An element of a drawing.
const shape = (name, attributes, ...children) =>
  filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);

// Returns the place of the last ascending value up to `value`; -1 if all are larger.
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

