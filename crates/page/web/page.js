// The page: its address, its buttons, and the run that this browser keeps.
//
//   #run=cull/lines depth/*    draws these cases; also #q=
//   #methods=transparency      measures the methods of a question, and shows their charts
//   &profile=full              of the full profile
//   &save                      and saves the run when it is done
//   #case=ID                   shows a case of the run
"use strict";

let store = null;
let module = null;
let run = null;

/** The instance of the suite on this thread; it only shows records. */
let shown = null;
const suite = () => (shown ??= Suite.of(module));

/** Returns the parameters after `#`. */
function parameters() {
  const parts = location.hash.slice(1).split("&").filter(Boolean);
  const decoded = (text) => {
    try {
      return decodeURIComponent(text);
    } catch {
      return text;
    }
  };
  return new Map(
    parts.map((part) => {
      const [name, ...value] = part.split("=");
      return [name, decoded(value.join("="))];
    }),
  );
}

const words = (text) => text.split(/\s+/).filter(Boolean);

/** Returns the selection that the address names, or null. */
function named() {
  const found = parameters();
  const question = found.get("methods");
  const methods = question === undefined ? undefined : `methods/${question}`;
  const globs = found.get("run") ?? found.get("q") ?? methods;
  const profile = found.get("profile") === "full" ? "full" : "quick";
  return globs === undefined ? null : { globs: words(globs), profile, fault: found.get("fault") ?? "" };
}

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** Shows a run, and its selection in the form. */
function take(next) {
  run = next;
  $("globs").value = run.selection.globs.join(" ");
  $("profile").value = run.selection.profile;
  new View(run);
  showCharts(run, suite);
}

async function begin(selection) {
  await run?.stop();
  take(new Run(store, module, selection));
  await goOn();
}

async function goOn() {
  const { running } = run;
  if (running) {
    return;
  }
  const mine = run;
  await store.note(false);
  await mine.start();
  if (mine !== run) {
    return;
  }
  await showCharts(run, suite);
  if (mine.complete && parameters().has("save")) {
    await save();
  }
}

async function save() {
  const address = URL.createObjectURL(await run.file());
  const name = `etalon-${run.opened.adapter.replaceAll(/[^a-z0-9]+/g, "-")}.tar.gz`;
  make("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

function route() {
  const id = parameters().get("case");
  if (id !== undefined) {
    return showCase(run, suite, id);
  }
  showRun();
  const selection = named();
  // Going back from a case to its run draws nothing.
  if (selection !== null && !(run !== null && same(run.selection, selection))) {
    return begin(selection);
  }
}

/** Returns the module, or throws the reason why there is none. */
async function load() {
  if (location.protocol === "file:") {
    throw new Error("browsers refuse WebAssembly and workers from file: addresses; serve the folder, for example with `python3 -m http.server`, and open http://localhost:8000");
  }
  const response = await fetch("etalon.wasm");
  if (!response.ok) {
    throw new Error(`etalon.wasm cannot be loaded (${response.status})`);
  }
  return WebAssembly.compile(await response.arrayBuffer());
}

async function main() {
  if (navigator.gpu === undefined) {
    const why = isSecureContext ? "this browser has no WebGPU, or it is disabled" : "WebGPU needs a secure context: https, or an address of this machine (http://localhost)";
    showProblem(why);
  }
  try {
    [store, module] = await Promise.all([Store.open(), load()]);
  } catch (error) {
    showProblem(error.message);
    return;
  }
  const [navigation] = performance.getEntriesByType("navigation");
  const reloaded = navigation?.type === "reload";
  const kept = await store.read();
  const selection = named();
  if (kept !== null && (selection === null || (reloaded && same(kept.run.selection, selection)))) {
    take(Run.of(store, module, kept));
  }
  const id = parameters().get("case");
  if (id !== undefined) {
    await showCase(run, suite, id);
  }
  addEventListener("hashchange", route);
  if (run === null && selection !== null) {
    await begin(selection);
  } else if (run !== null && !run.complete && !kept.run.stopped) {
    await goOn();
  }
}

$("choice").addEventListener("submit", (event) => {
  event.preventDefault();
  if (module === null) {
    return;
  }
  const selection = { globs: words($("globs").value), profile: $("profile").value, fault: "" };
  const profile = selection.profile === "full" ? "&profile=full" : "";
  history.replaceState(null, "", `#run=${encoded(selection.globs.join(" "))}${profile}`);
  begin(selection);
});
$("stop").addEventListener("click", async () => {
  // Noted at once: a click on "Continue" that comes before the records are kept is noted later.
  const noted = store.note(true);
  await run?.stop();
  await noted;
});
$("resume").addEventListener("click", () => goOn());
$("save").addEventListener("click", save);
main();
