// The data of the page, unpacked.
const parsed = JSON.parse($("data").textContent);
// Null if no case was run.
const data = parsed && parsed.files.length ? parsed : null;
const cases = [];
const files = [];
const numberOf = new Map();
const signs = new Map();
const bodies = new Map();
if (data) {
  for (const cell of data.cells) signs.set(cell.sign, cell);
  for (const [number, adapter, record] of data.bodies) bodies.set(number + " " + adapter, record);
  for (const file of data.files) {
    const group = { name: file.name, area: file.area, number: files.length, cases: [] };
    files.push(group);
    for (const [rest, cells, consensus, times, facts] of file.cases) {
      const id = file.name + rest;
      const found = data.consensus[consensus];
      const one = {
        number: cases.length, file: group, id, low: id.toLowerCase(), cells, times, facts,
        consensus: { text: found[0], votes: found[1], odd: found[2] },
      };
      numberOf.set(id, one.number);
      group.cases.push(one);
      cases.push(one);
    }
  }
}

// Returns the facts, times and sign of one case on one adapter; null without a record.
function recordOf(one, adapter) {
  const cell = signs.get(one.cells[adapter]);
  if (!cell) return null;
  let place = 0;
  for (let i = 0; i < adapter; i++) if (signs.has(one.cells[i])) place++;
  const list = data.facts[one.facts[place]];
  const facts = [];
  for (let i = 0; i < list.length; i += 2) {
    const [label, form, inBody] = data.labels[list[i]];
    facts.push({ label, form, inBody, text: data.texts[list[i + 1]] });
  }
  const [draw, judge] = one.times.slice(2 * place, 2 * place + 2);
  return { cell, facts, draw, judge, body: bodies.get(one.number + " " + adapter) };
}

