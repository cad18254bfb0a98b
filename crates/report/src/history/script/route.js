// The view that the URL names, and the keyboard.
const [start, view, find, q, status] = ["start", "view", "find", "q", "view-state"].map($);
let scrolled = 0;

// Returns a view with a title and a function that fills it.
const filling = (titled, fill) => async text => {
  if (!start.hidden) scrolled = scrollY;
  // A search keeps the focus in its field, which is above the view while it is used.
  const searching = fill === showFound && document.activeElement === q;
  const into = make("div", { id: "view-body" });
  status.textContent = "";
  await fill(text, into);
  const leads = () => {
    if (!searching) comeHome();
    return [...(searching ? [find] : []), make("p", {}, make("a", { id: "back", href: "#" }, "← Start"))];
  };
  return { leads, title: titled(text), content: [into], focus: searching ? q : null };
};

const comeHome = () => start.querySelector(".lead").after(find);

const route = router(start, view, {
  case: filling(id => id, showCase),
  run: filling(id => "Run " + id, showRun),
  adapter: filling(name => name, showAdapter),
  "all-news": filling(() => "All changes", showNews),
  q: filling(text => "Cases with “" + text + "”", showFound),
}, wasAway => {
  status.textContent = "";
  comeHome();
  if (wasAway && !location.hash) scrollTo(0, scrolled);
});

addEventListener("keydown", event => {
  if (foreign(event)) return;
  const target = event.target instanceof Element ? event.target : document.body;
  const away = !view.hidden;
  if (event.key === "Escape" && away) {
    location.hash = "";
    if (typing(target)) q.value = "";
  } else if (typing(target)) {
    if (event.key !== "Enter" && event.key !== "ArrowDown") return;
    go(1);
  } else if (event.key === "/") {
    if (away) location.hash = "";
    [start.hidden, view.hidden] = [false, true];
    comeHome();
    q.focus();
    q.select();
  } else if (event.key === "j" || event.key === "k") {
    go(event.key === "j" ? 1 : -1);
  } else {
    return;
  }
  event.preventDefault();
});

// Focuses the next or the previous visible link.
function go(by) {
  const links = [...(view.hidden ? start : $("view-body")).querySelectorAll("a, summary")].filter(link => link.checkVisibility());
  const at = links.indexOf(document.activeElement);
  const next = links[at < 0 ? (by > 0 ? 0 : links.length - 1) : at + by];
  if (next) next.focus();
}

let waits = 0;
q.addEventListener("input", () => {
  clearTimeout(waits);
  waits = setTimeout(() => {
    const address = q.value.trim() ? "#q=" + encoded(q.value) : "#";
    if (location.hash.startsWith("#q=")) history.replaceState(null, "", address);
    else history.pushState(null, "", address);
    const focused = document.activeElement === q;
    route().then(() => { if (focused) q.focus(); });
  }, 80);
});
find.addEventListener("submit", event => event.preventDefault());
find.hidden = false;
addEventListener("hashchange", route);
route();
performance.mark("etalon-ready");
