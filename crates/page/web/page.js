// The page: its address, its buttons, and the run that this browser keeps.
//
//   #run=cull/lines depth/*    draws these cases; also #q=
//   #cases=cull/lines depth/*  chooses these cases, and draws nothing before Start
//   #methods=transparency      measures the methods of a question, and shows their charts
//   &profile=full              of the full profile
//   &save                      and saves the run when it is done
//   #case=ID                   shows a case of the run
//   &device=NAME               the device of the run that a link repeats, with #cases=
"use strict";

let store = null;
let module = null;
let run = null;
let mosaic = null;
/** The description of the device before a run; null without a device. */
let hello = null;

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
  const globs = found.get("cases") ?? found.get("run") ?? found.get("q") ?? methods;
  const profile = found.get("profile") === "full" ? "full" : "quick";
  return globs === undefined ? null : { globs: words(globs), profile, fault: found.get("fault") ?? "" };
}

/** Returns true if the address names a selection that waits for Start. */
const waits = () => parameters().has("cases");

/** Returns the part of an address after `#`. Parameters without a value are left out, except the first. */
function fragment(...pairs) {
  const texts = pairs.filter(([, value], i) => i === 0 || value !== "").map(([name, value]) => `${name}=${encoded(value)}`);
  return `#${texts.join("&")}`;
}

/** Returns the fragment that names a selection. */
const selected = (name, { globs, profile, fault }, ...more) =>
  fragment([name, globs.join(" ")], ["profile", profile === "full" ? profile : ""], ["fault", fault], ...more);

const deviceText = ({ device, driver }) => `${device}, ${driver}`;

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

function fill({ globs, profile }) {
  $("globs").value = globs.join(" ");
  $("profile").value = profile;
}

/** Returns the selection of the form, with the fault that the address plants. */
const chosen = () => ({ globs: words($("globs").value), profile: $("profile").value, fault: named()?.fault ?? "" });

/** Shows a run, and its selection in the form. */
function take(next) {
  run = next;
  fill(run.selection);
  $("selection").open = false;
  new View(run, mosaic);
  showEnd(run);
}

/** Shows what only a run that is over has: charts or pictures. They would disturb one that goes on. */
async function showEnd(run) {
  await showCharts(run, suite);
  if (run.opened !== null && !run.opened.timed && !run.running) {
    showCards(run, await suite());
  }
}

/** Shows what Start would do: on which device, how many cases, and how long. */
async function showChoice() {
  const { globs, profile } = chosen();
  const facts = hello === null ? { device: "none", webgpu: "missing", time: "–" } : { time: "–" };
  let count = 0;
  try {
    const [choice] = (await suite()).ask({ choose: { globs, profile, hello } });
    count = choice.cases;
    const own = globs.length === 0 ? "" : ` that match ${globs.join(" ")}`;
    facts.cases = `${counted(count, "case")} of the ${profile} profile${own}`;
    const { device } = choice;
    if (device !== null) {
      const software = device.software ? ": software, so this tests the browser's drawing on the CPU and no GPU" : "";
      facts.device = `${device.device}${software}${madeOn(device)}`;
      facts.webgpu = `in ${device.driver}${hello.compatibility ? ", in compatibility mode only" : ""}`;
      facts.time = expectation(count, store.pace);
    }
  } catch (error) {
    facts.cases = error.message;
  }
  for (const [name, text] of Object.entries(facts)) {
    $(`fact-${name}`).textContent = text;
  }
  $("facts").hidden = false;
  $("start").disabled = hello === null || count === 0;
  $("selection").open ||= globs.length > 0 && hello !== null;
  mosaic.begin(hello === null || globs.some((glob) => glob.startsWith("methods")) ? 0 : count);
}

/** Returns a remark on the device of the run that the address repeats. */
function madeOn(device) {
  const made = parameters().get("device");
  if (made === undefined) {
    return "";
  }
  return made === deviceText(device) ? ". The link was made on a device of this name" : `. The link was made on another one: ${made}`;
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
  await showEnd(run);
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

/** Copies a link that chooses the cases of the run, and shows it. */
async function copy() {
  const hash = selected("cases", run.selection, ["device", deviceText(run.opened)]);
  const link = make("a", { href: new URL(hash, location.href).href }, "a link that repeats this run");
  const copied = await navigator.clipboard.writeText(link.href).then(() => true).catch(() => false);
  $("copied").replaceChildren(copied ? "Copied: " : "Copy it from here: ", link, ". It draws nothing before Start.");
  $("copied").hidden = false;
}

function route() {
  if (waits()) {
    location.reload();
    return;
  }
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
  try {
    [store, module] = await Promise.all([Store.open(), load()]);
  } catch (error) {
    showProblem(error.message);
    return;
  }
  mosaic = new Mosaic();
  const [navigation] = performance.getEntriesByType("navigation");
  const reloaded = navigation?.type === "reload";
  const kept = waits() ? null : await store.read();
  const selection = named();
  if (kept !== null && (selection === null || (reloaded && same(kept.run.selection, selection)))) {
    take(Run.of(store, module, kept));
  }
  const id = parameters().get("case");
  if (id !== undefined) {
    await showCase(run, suite, id);
  }
  addEventListener("hashchange", route);
  try {
    ({ hello } = await findAdapter(false));
  } catch (error) {
    showProblem(error.message, "This browser cannot be tested");
    $("sentence").textContent = "This browser cannot be tested yet";
  }
  if (run !== null) {
    if (!run.complete && !kept.run.stopped && hello !== null) {
      await goOn();
    }
  } else if (selection !== null && !waits() && hello !== null) {
    await begin(selection);
  } else {
    fill(selection ?? chosen());
    await showChoice();
  }
}

$("choice").addEventListener("submit", (event) => {
  event.preventDefault();
  if (module === null) {
    return;
  }
  const selection = chosen();
  history.replaceState(null, "", selected("run", selection));
  begin(selection);
});
let typed;
$("choice").addEventListener("input", () => {
  clearTimeout(typed);
  typed = setTimeout(() => module !== null && run === null && showChoice(), 200);
});
$("stop").addEventListener("click", async () => {
  // Noted at once: a click on "Continue" that comes before the records are kept is noted later.
  const noted = store.note(true);
  await run?.stop();
  await noted;
});
$("resume").addEventListener("click", () => goOn());
$("save").addEventListener("click", save);
$("copy").addEventListener("click", copy);
/** Returns the number of the case under the pointer if it is done. */
const pointed = ({ clientX, clientY }) => {
  const number = mosaic.at(clientX, clientY);
  return run?.records.has(number) ? number : null;
};
$("tiles").addEventListener("pointermove", (event) => {
  const number = pointed(event);
  $("tile-name").textContent = number === null ? TILES : run.opened.cases[number];
});
$("tiles").addEventListener("click", (event) => {
  const number = pointed(event);
  if (number !== null) location.hash = `case=${encoded(run.opened.cases[number])}`;
});
main();
