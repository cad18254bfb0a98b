// The view of an address: the report, a filter of its cases, or one case.
const LOST = "A file of this report cannot be loaded: is the folder “records” next to the page?";
let routed = false;
let fromReport = false;
let afterRoute = null;

const views = router($("report"), $("case"), { case: showCase, gallery: showGallery }, () => {
  const left = current;
  current = null;
  typed = false;
  const wasAway = $("cases").hidden;
  const listed = isList();
  $("cases").hidden = !listed;
  $("report").hidden = listed;
  if (listed) {
    const before = hashOf(state);
    state = stateOf(parameters());
    if (hashOf(state) !== before || !items.length) {
      toggled.clear();
      showControls();
      refresh();
    }
    const row = left === null ? -1 : placeOf(left);
    if (row >= 0) moveTo(row);
    else if (wasAway) scrollTo(0, 0);
  } else if (location.hash) {
    reveal(location.hash.slice(1));
  }
  routed = true;
  if (afterRoute) afterRoute();
  afterRoute = null;
});

// Without a filter, the section's own address means the whole table.
const isList = () => location.hash === "#cases" || parameters().size > 0;

async function route() {
  if (isList() && !(await ready())) return lost();
  await views();
}

function lost() {
  if (!$("lost")) $("report").prepend(make("p", { id: "lost", class: "state bad", role: "alert" }, LOST));
}

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

$("find").hidden = false;
listen();
listenToMatrix();
document.querySelector(".skip").addEventListener("click", event => {
  event.preventDefault();
  (current === null ? $("main") : $("case-title")).focus();
});
addEventListener("keydown", onKey);
addEventListener("hashchange", route);
route();
// The list is there before the first click.
addEventListener("load", () => setTimeout(ready, 50));
// A mark for measurements: the page can be used from here on.
performance.mark("etalon-ready");
