// The data of the page. The list of cases, and the facts and pictures of an area, are loaded when a view needs them.
const data = JSON.parse($("data").textContent);
const withCases = beside("etalonCases", () => "records/cases.js");
const factsOf = beside("etalonFacts", area => "records/" + area + ".js");
const picturesOf = beside("etalonPictures", area => "records/" + area + "-pictures.js");
const withFacts = area => factsOf(String(area));
const withPictures = area => picturesOf(String(area));
const cases = [];
const files = [];
const numberOf = new Map();
const signs = new Map();

// Loads the list of cases once. The promise is false if there is none.
let loading = null;
const ready = () => loading ??= withCases("cases").then(unpack);

function unpack(list) {
  if (!list) return false;
  for (const cell of list.cells) signs.set(cell.sign, cell);
  [data.cells, data.reasons] = [list.cells, list.reasons];
  const places = data.areas.map(() => 0);
  for (const file of list.files) {
    const group = { name: file.name, area: file.area, number: files.length, cases: [] };
    files.push(group);
    for (const [rest, row] of file.cases) {
      const id = file.name + rest;
      const [cells, consensus, reasons] = list.rows[row];
      const [text, votes, odd] = list.consensus[consensus];
      const one = {
        number: cases.length, place: places[file.area]++, file: group, id, low: id.toLowerCase(), cells, reasons,
        consensus: { text, votes, odd },
      };
      numberOf.set(id, one.number);
      group.cases.push(one);
      cases.push(one);
    }
  }
  shown = [...cases];
  return true;
}

const cellOf = (one, adapter) => signs.get(one.cells[adapter]);

// Returns the facts and times of a case on one adapter, from its area's facts; null without a record.
function recordOf(held, one, adapter) {
  const cell = cellOf(one, adapter);
  if (!cell) return null;
  let place = 0;
  for (let i = 0; i < adapter; i++) if (cellOf(one, i)) place++;
  const [times, lists] = held ? held.cases[one.place] : [[], []];
  const list = held ? held.facts[lists[place]] : [];
  const facts = [];
  for (let i = 0; i < list.length; i += 2) {
    const [label, form, inBody] = held.labels[list[i]];
    facts.push({ label, form, inBody, text: held.texts[list[i + 1]] });
  }
  const [draw, judge] = times.slice(2 * place, 2 * place + 2);
  return { cell, facts, draw, judge };
}

