// The adapter and the budget with which the charts of all questions are compared.
const TIMES = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 1e-1, Infinity];
const ERRORS = [0, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 1e-1, Infinity];

function weigh() {
  const on = $("on").value;
  const [time, error] = [[TIMES, "most-time"], [ERRORS, "most-error"]].map(([stops, id]) => stops[Number($(id).value)]);
  const text = (value, factor, unit) => value === Infinity ? "any" : `${Number((value * factor).toPrecision(3))}\u00a0${unit}`;
  $("most-time").labels[0].querySelector("output").textContent = text(time, 1e3, "ms");
  $("most-error").labels[0].querySelector("output").textContent = text(error, 1e2, "%");
  const free = time === Infinity && error === Infinity;
  for (const card of document.querySelectorAll(".card")) {
    for (const part of card.querySelectorAll(".on")) part.classList.toggle("off", part.dataset.on !== on);
    for (const mark of card.querySelectorAll(".of[data-time]")) {
      mark.classList.toggle("beyond", Number(mark.dataset.time) > time || Number(mark.dataset.error) > error);
    }
    // For each method: the number of scenes within the budget, and of all scenes in which it was timed.
    const scenes = new Map();
    for (const [method, , adapter, took, off] of JSON.parse(card.dataset.points)) {
      if (String(adapter) !== on) continue;
      const [within, all] = scenes.get(method) ?? [0, 0];
      scenes.set(method, [within + (took <= time && off <= error), all + 1]);
    }
    const left = [...scenes].filter(([, [within]]) => within > 0).sort(([, [a, b]], [, [c, d]]) => c / d - a / b);
    const named = left.map(([method, [within, all]]) => within === all ? method : `${method} (${within} of ${all} scenes)`);
    card.querySelector(".left").textContent = free || !scenes.size ? "" : "Left: " + (named.join(", ") || "none") + ".";
    card.classList.toggle("none", !free && scenes.size > 0 && !left.length);
  }
}

if ($("budget")) {
  $("budget").hidden = false;
  for (const [stops, id] of [[TIMES, "most-time"], [ERRORS, "most-error"]]) {
    $(id).max = stops.length - 1;
    $(id).value = stops.length - 1;
  }
  $("budget").addEventListener("input", weigh);
  $("budget").addEventListener("submit", event => event.preventDefault());
  weigh();
}
