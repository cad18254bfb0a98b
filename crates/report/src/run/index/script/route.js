// The view of an address: an element of the page, a filter of its cases, or one case.
let routed = false;
let fromReport = false;
let afterRoute = null;

function route() {
  const found = data ? parameters(location.hash) : new Map();
  typed = false;
  if (found.has("case")) {
    fromReport = routed && $("case").hidden;
    showCase(found.get("case"));
  } else if (found.has("gallery")) {
    showGallery(found.get("gallery"));
  } else {
    const left = current;
    showReport();
    // The address of the section stands for the whole table.
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
  }
  routed = true;
  if (afterRoute) afterRoute();
  afterRoute = null;
}

function showReport() {
  current = null;
  $("case").hidden = true;
  $("report").hidden = false;
  document.title = REPORT_TITLE;
}

// The row of a case, or of the closed group that holds it; -1 where the filter leaves neither.
function placeOf(id) {
  const one = cases[numberOf.get(id)];
  return items.findIndex(item => one && (item.one ? item.one === one : item.group === one.file && !isOpen(item.group)));
}

// Back to the view before, or to all cases after following a link from outside.
function leaveCase() {
  if (fromReport) history.back();
  else location.hash = hashOf(state);
}

// A link to an entry opens the groups that hold it; browsers that do so by themselves lose nothing.
function reveal(id) {
  const target = id && $(id);
  for (let e = target; e; e = e.parentElement) if (e.tagName === "DETAILS") e.open = true;
  if (target) target.scrollIntoView();
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
// Elements behind the script exist later; then views and links use them.
addEventListener("DOMContentLoaded", () => {
  if (current === null) reveal(location.hash.slice(1));
  else if (data && cases[numberOf.get(current)] && data.bodies.some(([number]) => number === numberOf.get(current))) showCase(current);
});
// When the table can be used, for those who measure.
performance.mark("etalon-ready");
