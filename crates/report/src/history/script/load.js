// Files beside the page. Texts of the history become text nodes and nothing else, but for labels that are addresses.
const index = JSON.parse($("index").textContent);
const need = beside("etalonHistory", name => "data/" + name + ".js");

// An element of a drawing.
const shape = (name, attributes, ...children) =>
  filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);

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

