// An area of the matrix opens into its case files.
function listenToMatrix() {
  for (const body of document.querySelectorAll("#matrix tbody[data-area]")) {
    const button = make("button", { type: "button", class: "open", "aria-expanded": "false", "aria-label": "Case files of " + data.areas[body.dataset.area] }, "▸");
    button.addEventListener("click", async () => {
      const open = button.getAttribute("aria-expanded") === "true";
      if (!open && !(await ready())) return lost();
      for (const row of [...body.rows].slice(1)) row.remove();
      if (!open) for (const file of files) if (file.area === Number(body.dataset.area)) body.append(fileRow(file, body.rows[0]));
      button.setAttribute("aria-expanded", String(!open));
      button.textContent = open ? "▸" : "▾";
    });
    body.querySelector("th").prepend(button);
  }
}

function fileRow(file, area) {
  const row = make("tr", { class: "file" }, make("th", { scope: "row" }, file.name.slice(data.areas[file.area].length + 1) || file.name));
  for (const { dataset, className } of [...area.cells].slice(1)) {
    const edge = /\bedge\b/.test(className) ? " edge" : "";
    row.append(fileCell(file, Number(dataset.column), edge));
  }
  return row;
}

function fileCell(file, column, edge) {
  const counts = data.cells.map(cell => [cell, file.cases.filter(one => one.cells[column] === cell.sign).length]).filter(([, n]) => n);
  const sum = test => counts.reduce((total, [cell, n]) => total + (test(cell) ? n : 0), 0);
  const parts = [sum(cell => cell.unexpected), sum(cell => cell.excused && !cell.due), sum(cell => cell.right)];
  const [unexpected, known, right] = parts;
  const total = sum(() => true);
  const kind = unexpected ? counts.find(([cell]) => cell.unexpected)[0].class + " new" : known ? "known" : "";
  const number = String(unexpected || known || (right ? 0 : "–"));
  const bar = make("i", { class: "bar" });
  parts.reduce((end, part, i) => (bar.style.setProperty("--" + "xyz"[i], 100 * (end + part) / (total || 1) + "%"), end + part), 0);
  const content = total ? [number, bar] : [number];
  const adapter = data.adapters[column];
  const address = "#q=" + encoded(file.name) + "&on=" + encoded(adapter) + (kind ? "&verdict=bad" : "");
  return make("td", {
    class: kind + edge, "data-head": adapter, title: counts.map(([cell, n]) => n + " " + cell.word).join(", ") || "no record",
  }, ...total ? [make("a", { href: address }, ...content)] : content);
}

