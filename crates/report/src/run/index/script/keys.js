// The handlers of the controls, the table and the keyboard.
function onKey(event) {
  if (foreign(event)) return;
  const target = event.target instanceof Element ? event.target : document.body;
  const handled = current !== null ? keyInCase(event.key) : $("cases").hidden ? keyInReport(event.key, target) : keyInCases(event.key, target);
  if (handled) event.preventDefault();
}

function keyInCase(key) {
  if (key === "Escape") {
    leaveCase();
  } else if (key === "/") {
    location.hash = hashOf(state);
    afterRoute = () => $("f-q").focus();
  } else if (key === "j" && $("case-on")) {
    $("case-on").click();
  } else if (key === "k" && $("case-back")) {
    $("case-back").click();
  } else {
    return false;
  }
  return true;
}

function keyInReport(key, target) {
  if (key !== "/" || typing(target)) return false;
  $("find-q").focus();
  return true;
}

function keyInCases(key, target) {
  if (target === $("f-q")) {
    if (key === "Escape" && $("f-q").value) return change({ q: "" }, true), true;
    if (key === "Escape") return moveTo(0), true;
    if (key !== "ArrowDown" && key !== "Enter") return false;
    const first = items.findIndex(item => item.one);
    return moveTo(first < 0 ? 0 : first), true;
  }
  if (typing(target)) return false;
  if (key === "/") return $("f-q").focus(), $("f-q").select(), true;
  const element = target.closest("#case-table [data-key]");
  if (!element) return false;
  const at = items.findIndex(item => keyOf(item) === element.dataset.key);
  const item = items[at];
  const group = item && !item.one && item.group;
  if (key === "ArrowDown" || key === "j") moveTo(at + 1);
  else if (key === "ArrowUp" || key === "k") moveTo(at - 1);
  else if (key === "Home") moveTo(0);
  else if (key === "End") moveTo(items.length - 1);
  else if (key === "PageDown") moveTo(at + 20);
  else if (key === "PageUp") moveTo(at - 20);
  else if (group && (key === "ArrowRight" && !isOpen(group) || key === "ArrowLeft" && isOpen(group))) toggle(group.number);
  else if (!group && key === "ArrowLeft" && item.group) moveTo(items.findLastIndex((other, i) => i < at && !other.one));
  else if (key === "Escape") $("f-q").focus();
  else return false;
  return true;
}

// A change of the filter gets its own place in the browser's history, a word that is typed just one.
let typed = false;
function change(part, typing) {
  const page = "page" in part ? part.page : 1;
  state = { ...state, ...part, page };
  if (!("page" in part || "sort" in part)) toggled.clear();
  const address = hashOf(state);
  if (address !== location.hash) history[typing && typed ? "replaceState" : "pushState"](null, "", address);
  typed = typing;
  showControls();
  refresh();
}

function showControls() {
  for (const key of TEXTS) if ($("f-" + key).value !== state[key]) $("f-" + key).value = state[key];
  for (const key of CHECKS) $("f-" + key).checked = state[key];
}

function listen() {
  for (const key of [...TEXTS, ...CHECKS]) {
    const control = $("f-" + key);
    const isTyped = key === "q";
    control.addEventListener(isTyped ? "input" : "change", () => change({ [key]: CHECKS.includes(key) ? control.checked : control.value }, isTyped));
  }
  $("filter").addEventListener("submit", event => event.preventDefault());
  $("find").addEventListener("submit", event => {
    event.preventDefault();
    location.hash = hashOf({ ...INITIAL, q: $("find-q").value.trim() });
  });
  $("f-clear").addEventListener("click", () => change({ ...INITIAL, sort: state.sort }, false));
  $("f-groups").addEventListener("click", () => {
    const open = items.some(item => !item.one && !isOpen(item.group));
    toggled.clear();
    if (open !== openFirst()) for (const file of files) toggled.add(file.number);
    state.page = 1;
    refresh();
  });
  $("page-back").addEventListener("click", () => turn(-1));
  $("page-on").addEventListener("click", () => turn(1));
  $("case-table").addEventListener("click", event => {
    const sort = event.target.closest("[data-sort]");
    const group = event.target.closest("button[data-key]");
    if (sort?.dataset.sort === "case") change({ sort: state.sort === "case" ? "-case" : "case" }, false);
    else if (sort) change({ sort: state.sort === "consensus" ? "case" : "consensus" }, false);
    else if (group) toggle(Number(group.dataset.key.slice(1)));
  });
  $("case-table").addEventListener("focusin", event => {
    const element = event.target.closest("[data-key]");
    if (!element || element.dataset.key === cursor) return;
    for (const other of $("case-table").querySelectorAll("[data-key][tabindex='0']")) other.tabIndex = -1;
    element.tabIndex = 0;
    cursor = element.dataset.key;
  });
}

function turn(by) {
  const page = state.page + by;
  if (page < 1 || page > pages()) return;
  cursor = null;
  change({ page }, false);
  $("rows").scrollIntoView({ block: "nearest" });
}

