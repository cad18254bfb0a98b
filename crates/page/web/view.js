// What the page shows: progress, areas, bad verdicts, and one case.
"use strict";

const $ = (id) => document.getElementById(id);

/** Returns an element. Texts of records become text nodes. */
function make(name, attributes, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

const area = (id) => id.split("/")[0];
const counted = (n, noun) => `${n.toLocaleString("en")} ${noun}${n === 1 ? "" : "s"}`;

/** Keeps ids readable in URLs. */
const encoded = (text) => encodeURIComponent(text).replace(/%(2F|3A|3D|2C|2A)/g, decodeURIComponent);

/** The maximum number of verdicts in a list. */
const LISTED = 500;

/** The columns of the table of areas after the name and the number of records. */
const COLUMNS = ["pass", "imprecise", "bad", "known", "undrawn"];

/** Returns the column that counts an outcome; null for verdicts that have none. A selftest that must fail and does
 * counts as a pass. */
function column({ verdict, unexpected, bad, due }) {
  if (unexpected) return "bad";
  if (due && bad) return "pass";
  if (bad) return "known";
  if (verdict === "not-supported" || verdict === "skipped") return "undrawn";
  return COLUMNS.includes(verdict) ? verdict : null;
}

/** Shows a run. Cells change only if their numbers do. */
class View {
  #run;
  #rows = new Map();
  #listed = { bad: 0, known: 0 };
  #due = false;
  #spoken = "";

  constructor(run) {
    this.#run = run;
    $("areas").replaceChildren();
    $("bad").replaceChildren();
    $("known").replaceChildren();
    run.addEventListener("changed", ({ detail }) => {
      this.#add(detail);
      this.#soon();
    });
    for (const number of run.records.keys()) {
      this.#add(number);
    }
    this.#soon();
  }

  /** Returns the row of an area. */
  #row(name) {
    if (!this.#rows.has(name)) {
      const cells = Array.from({ length: COLUMNS.length + 1 }, () => make("td", {}));
      const counts = { all: 0, done: 0 };
      for (const key of COLUMNS) counts[key] = 0;
      this.#rows.set(name, { cells, counts });
      $("areas").append(make("tr", {}, make("th", { scope: "row" }, name), ...cells));
    }
    return this.#rows.get(name);
  }

  /** Makes the rows once the selection is known. */
  #prepare() {
    if (this.#rows.size === 0 && this.#run.opened !== null) {
      for (const id of this.#run.opened.cases) {
        this.#row(area(id)).counts.all += 1;
      }
    }
  }

  #add(number) {
    this.#prepare();
    const { opened, records } = this.#run;
    if (number === null || number >= opened.cases.length) {
      return;
    }
    const { outcome } = records.get(number);
    const { counts } = this.#row(area(opened.cases[number]));
    const key = column(outcome);
    counts.done += 1;
    if (key !== null) {
      counts[key] += 1;
    }
    if (key === "bad" || key === "known") {
      this.#list(key, opened.cases[number], outcome);
    }
  }

  #list(key, id, { symbol, word, headline, expected, class: colour }) {
    this.#listed[key] += 1;
    if (this.#listed[key] > LISTED) {
      return;
    }
    const chip = make("span", { class: `chip ${colour}` }, `${symbol} ${word}`);
    const link = make("a", { href: `#case=${encoded(id)}` }, make("code", {}, id));
    $(key).append(make("li", {}, chip, link, make("small", {}, expected ?? headline)));
  }

  #soon() {
    if (!this.#due) {
      this.#due = true;
      setTimeout(() => {
        this.#due = false;
        this.#show();
      }, 100);
    }
  }

  #show() {
    this.#prepare();
    const run = this.#run;
    const { opened } = run;
    $("start").hidden = run.running;
    $("stop").hidden = !run.running;
    $("resume").hidden = run.running || opened === null || run.complete;
    $("globs").disabled = $("profile").disabled = run.running;
    $("problem").hidden = run.problem === null;
    if (run.problem !== null) {
      showProblem(run.problem);
    }
    $("progress").hidden = opened === null && !run.running;
    $("result").hidden = opened === null;
    if (opened === null) {
      $("state").textContent = "Opening a device…";
      return;
    }
    $("device").textContent = `${opened.device}${opened.software ? " (software)" : ""}, ${opened.driver}`;
    $("bar").max = opened.cases.length;
    $("bar").value = run.done;
    $("state").textContent = this.#state();
    this.#speak();
    for (const { cells, counts } of this.#rows.values()) {
      const done = counts.done === counts.all ? String(counts.all) : `${counts.done} of ${counts.all}`;
      const texts = [done, ...COLUMNS.map((key) => String(counts[key] || ""))];
      texts.forEach((text, i) => {
        if (cells[i].textContent !== text) {
          cells[i].textContent = text;
          cells[i].className = i === 3 && text !== "" ? "f" : "";
        }
      });
    }
    const { bad, known } = this.#listed;
    $("bad-title").textContent = bad === 0 ? "Bad verdicts" : counted(bad, "bad verdict");
    $("none").hidden = bad > 0;
    const right = known === 0 ? "None: this device draws all these cases as the specification says." : "None except those of known bugs.";
    $("none").textContent = run.complete ? right : "None so far.";
    $("known-list").hidden = known === 0;
    $("known-title").textContent = `${counted(known, "bad verdict")} of known bugs`;
    document.body.dataset.state = run.running ? "running" : run.complete ? "complete" : "stopped";
  }

  /** Announces each tenth of a run, and its end, to screen readers. */
  #speak() {
    const run = this.#run;
    const tenth = Math.floor((10 * run.done) / run.opened.cases.length);
    const spoken = `${run.running} ${tenth}`;
    if (this.#spoken !== spoken) {
      this.#spoken = spoken;
      $("spoken").textContent = this.#state();
    }
  }

  #state() {
    const run = this.#run;
    const { cases, measured, timed, clock } = run.opened;
    const progress = `${run.done.toLocaleString("en")} of ${counted(cases.length, "case")}`;
    const others = measured > 0 ? ` ${counted(measured, "case")} that only measure time or quality are left out.` : clockText(timed, clock);
    if (run.complete) {
      return `Done: ${progress}.${others}`;
    }
    if (!run.running) {
      return `Stopped: ${progress}.${others}`;
    }
    const { left } = run;
    const time = left === null ? "" : left < 90 ? `, about ${Math.ceil(left)} s left` : `, about ${Math.ceil(left / 60)} min left`;
    return `${progress}${time}.`;
  }
}

/** Returns what the clock of this browser tells about times. */
function clockText(timed, clock) {
  if (!timed) {
    return "";
  }
  const step = `${Number((clock * 1000).toPrecision(2))} ms`;
  return ` The browser's clock has steps of ${step}; the intervals of frame times include them.`;
}

/** Shows the charts of methods, unless the run is going on: drawing them would disturb its times. */
async function showCharts(run, suite) {
  const timed = run.opened?.timed && !run.running;
  const charts = timed ? await run.charts(await suite()) : null;
  $("charts").hidden = charts === null;
  // The suite escapes all texts.
  $("charts").innerHTML = charts?.html ?? "";
  $("viewer")?.remove();
  if (charts !== null) {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(charts.style);
    document.adoptedStyleSheets = [sheet];
    showMethods();
  }
}

/** What to do without WebGPU. */
const REMEDIES = [
  "Chrome and Edge have it from version 113, on Android from 121. On Linux, switch on chrome://flags/#enable-unsafe-webgpu and chrome://flags/#enable-vulkan.",
  "Firefox has it from version 141 on Windows and 145 on macOS. Elsewhere, set dom.webgpu.enabled in about:config.",
  "Safari has it from version 26.",
];

function showProblem(problem) {
  const isWebGpu = /WebGPU|adapter|device/.test(problem);
  const remedies = isWebGpu ? [make("ul", {}, ...REMEDIES.map((text) => make("li", {}, text)))] : [];
  $("problem").replaceChildren(make("p", {}, make("b", {}, "This page cannot continue: "), `${problem}.`), ...remedies);
  $("problem").hidden = false;
}

/** Shows one case in place of the run. */
async function showCase(run, suite, id) {
  const view = $("view");
  const title = make("h1", { id: "view-title", tabindex: "-1" }, make("code", {}, id));
  const back = make("nav", { "aria-label": "Cases" }, make("a", { href: "#" }, "All cases"));
  const number = run?.opened?.cases.indexOf(id) ?? -1;
  const record = run?.records.get(number);
  const content = make("div", {});
  if (record === undefined) {
    const again = make("a", { href: `#run=${encoded(id)}` }, "Draw it");
    content.append(make("p", { class: "state bad", role: "alert" }, "This run has no record of this case. ", again, "."));
  } else {
    const { outcome, line, file } = record;
    const chip = make("span", { class: `chip ${outcome.class}` }, `${outcome.symbol} ${outcome.word}`);
    const message = new Uint8Array(await new Blob([line, file ?? new Uint8Array()]).arrayBuffer());
    const [, html] = (await suite()).ask({ view: { line: line.length } }, message);
    // The suite escapes all texts.
    const body = make("div", { class: "record" });
    body.innerHTML = new TextDecoder().decode(html);
    const link = make("a", { href: `#run=${encoded(id)}&profile=full` }, "Draw this case alone");
    content.append(make("p", {}, make("code", {}, run.opened.adapter), " ", chip), body, make("p", { class: "again" }, link, ". The link works on any device."));
  }
  view.replaceChildren(back, title, content);
  view.hidden = false;
  $("report").hidden = true;
  document.title = `${id} – etalon`;
  title.focus({ preventScroll: true });
  scrollTo(0, 0);
}

function showRun() {
  $("view").hidden = true;
  $("report").hidden = false;
  document.title = "etalon";
}
