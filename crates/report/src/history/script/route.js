// The view of an address, and the keyboard.
const VIEWS = {
  case: [id => id, showCase],
  run: [id => "Run " + id, showRun],
  adapter: [name => name, showAdapter],
  "all-news": [() => "All changes", showNews],
  q: [text => "Cases with “" + text + "”", showFound],
};
const TITLE = document.title;
let shown = 0;
let scrolled = 0;

async function route() {
  const found = viewOf(VIEWS);
  const turn = ++shown;
  if (!found) {
    const wasAway = $("start").hidden;
    comeBack($("start"), $("view"), TITLE);
    place(false);
    if (wasAway && !location.hash) scrollTo(0, scrolled);
    return;
  }
  const [[titled, fill], text] = found;
  if (!$("start").hidden) scrolled = scrollY;
  const into = make("div", { id: "view-body" });
  // A search keeps the focus in its field.
  const searching = fill === showFound && document.activeElement === $("q");
  $("view-state").textContent = "";
  await fill(text, into);
  if (turn !== shown) return;
  $("view-title").textContent = titled(text);
  $("view-body").replaceWith(into);
  place(searching);
  leave($("start"), $("view"), titled(text));
  if (!searching) {
    $("view-title").focus();
    scrollTo(0, 0);
  }
  // For those who measure.
  performance.mark("etalon-shown");
}

// The search is above the view while it is used.
function place(searching) {
  if (searching) $("view").prepend($("find"));
  else $("start").querySelector(".lead").after($("find"));
  if (searching) $("q").focus();
}

addEventListener("keydown", event => {
  if (foreign(event)) return;
  const target = event.target instanceof Element ? event.target : document.body;
  const away = !$("view").hidden;
  if (event.key === "Escape" && away) {
    location.hash = "";
    if (typing(target)) $("q").value = "";
  } else if (typing(target)) {
    if (event.key !== "Enter" && event.key !== "ArrowDown") return;
    go(1);
  } else if (event.key === "/") {
    if (away) location.hash = "";
    comeBack($("start"), $("view"), TITLE);
    place(false);
    $("q").focus();
    $("q").select();
  } else if (event.key === "j" || event.key === "k") {
    go(event.key === "j" ? 1 : -1);
  } else {
    return;
  }
  event.preventDefault();
});

// To the next link, or the one before, of what is seen.
function go(by) {
  const links = [...($("view").hidden ? $("start") : $("view-body")).querySelectorAll("a, summary")].filter(link => link.checkVisibility());
  const at = links.indexOf(document.activeElement);
  const next = links[at < 0 ? (by > 0 ? 0 : links.length - 1) : at + by];
  if (next) next.focus();
}

let waits = 0;
$("q").addEventListener("input", () => {
  clearTimeout(waits);
  waits = setTimeout(() => {
    const address = $("q").value.trim() ? "#q=" + encoded($("q").value) : "#";
    if (location.hash.startsWith("#q=")) history.replaceState(null, "", address);
    else history.pushState(null, "", address);
    const focused = document.activeElement === $("q");
    route().then(() => { if (focused) $("q").focus(); });
  }, 80);
});
$("find").addEventListener("submit", event => event.preventDefault());
$("find").hidden = false;
addEventListener("hashchange", route);
route();
performance.mark("etalon-ready");
