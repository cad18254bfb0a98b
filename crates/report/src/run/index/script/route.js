// The view of an address: an element of the page, a filter of its cases, or one case.
let routed = false;
let fromReport = false;
let afterRoute = null;

const route = router($("report"), $("case"), data ? { case: showCase, gallery: showGallery } : {}, () => {
  const found = data ? parameters() : new Map();
  const left = current;
  current = null;
  typed = false;
  // The section's own URL means the whole table.
  if (data && (found.size || !location.hash || location.hash === "#cases")) {
    const before = hashOf(state);
    state = stateOf(found);
    if (hashOf(state) !== before) {
      toggled.clear();
      showControls();
      refresh();
    }
  }
  const row = left === null ? -1 : placeOf(left);
  if (row >= 0) moveTo(row);
  else if (left !== null || found.size && !routed) $("cases").scrollIntoView();
  else reveal(location.hash.slice(1));
  routed = true;
  if (afterRoute) afterRoute();
  afterRoute = null;
});

// Returns the row of a case, or of the closed group around it; -1 if the filter leaves neither.
function placeOf(id) {
  const one = cases[numberOf.get(id)];
  return items.findIndex(item => one && (item.one ? item.one === one : item.group === one.file && !isOpen(item.group)));
}

// Back to the view before, or to all cases after following a link from outside.
function leaveCase() {
  if (fromReport) history.back();
  else location.hash = hashOf(state);
}

if (data) {
  for (const id of ["filter", "rows", "keys"]) $(id).hidden = false;
  listen();
  refresh();
}
document.querySelector(".skip").addEventListener("click", event => {
  event.preventDefault();
  (current === null ? $("main") : $("case-title")).focus();
});
addEventListener("keydown", onKey);
addEventListener("hashchange", route);
route();
// Elements after the script exist only now; views and links that need them are shown again.
addEventListener("DOMContentLoaded", () => {
  if (current === null) reveal(location.hash.slice(1));
  else if (data && cases[numberOf.get(current)] && data.bodies.some(([number]) => number === numberOf.get(current))) route();
});
// A mark for measurements: the table can be used from here on.
performance.mark("etalon-ready");
