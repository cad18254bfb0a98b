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

/** Returns an id that can break after each of its parts. */
const idOf = (id) => make("code", { class: "id" }, ...id.split(/(?<=[/=,:+])/).flatMap((part) => [part, make("wbr", {})]));

const area = (id) => id.split("/")[0];

/** Keeps ids readable in URLs. */
const encoded = (text) => encodeURIComponent(text).replace(/%(2F|3A|3D|2C|2A)/g, decodeURIComponent);

/** The maximum number of verdicts in a list. */
const LISTED = 500;

/** The maximum number of cases whose pictures stand above the mosaic. */
const CARDS = 3;

/** The columns of the table of areas after the name and the number of records. */
const COLUMNS = ["pass", "imprecise", "bad", "known", "undrawn"];

/** The colours of the frames in the mosaic. */
const MARKS = { bad: "f", known: "r" };

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
  #mosaic;
  #rows = new Map();
  #tally = new Tally();
  #listed = { bad: 0, known: 0 };
  #due = false;
  #spoken = "";

  constructor(run, mosaic) {
    this.#run = run;
    this.#mosaic = mosaic;
    $("areas").replaceChildren();
    $("bad").replaceChildren();
    $("known").replaceChildren();
    $("cards").hidden = true;
    $("copied").hidden = true;
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

  /** Makes the rows and the places of tiles once the selection is known. */
  #prepare() {
    const { opened } = this.#run;
    if (this.#rows.size === 0 && opened !== null) {
      for (const id of opened.cases) {
        this.#row(area(id)).counts.all += 1;
      }
      // Nothing is painted while frames are timed.
      this.#mosaic.begin(opened.timed ? 0 : opened.cases.length);
    }
  }

  #add(number) {
    this.#prepare();
    const { opened, records } = this.#run;
    if (number === null || number >= opened.cases.length) {
      return;
    }
    const { outcome, tile = null } = records.get(number);
    const { counts } = this.#row(area(opened.cases[number]));
    const key = column(outcome);
    counts.done += 1;
    if (key !== null) {
      counts[key] += 1;
    }
    this.#tally.add(outcome);
    this.#mosaic.add(number, tile, MARKS[key] ?? "");
    if (key === "bad" || key === "known") {
      this.#list(key, opened.cases[number], outcome, tile);
    }
  }

  #list(key, id, { symbol, word, headline, expected, class: colour }, tile) {
    this.#listed[key] += 1;
    if (this.#listed[key] > LISTED) {
      return;
    }
    const chip = make("span", { class: `chip ${colour}` }, `${symbol} ${word}`);
    const link = make("a", { href: `#case=${encoded(id)}` }, idOf(id));
    const picture = tile === null ? [] : [thumbnail(tile)];
    $(key).append(make("li", {}, ...picture, chip, link, make("small", {}, expected ?? headline)));
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
    const { opened, running } = run;
    const over = opened !== null && !running;
    $("start").hidden = running;
    $("start").disabled = false;
    $("start").textContent = over ? "Start again" : "Start";
    $("start").classList.toggle("first", !over);
    $("stop").hidden = !running;
    $("resume").hidden = !over || run.complete;
    $("save").hidden = $("copy").hidden = !over;
    $("selection").hidden = running;
    $("facts").hidden = true;
    $("problem").hidden = run.problem === null;
    if (run.problem !== null) {
      showProblem(run.problem);
    }
    $("progress").hidden = opened === null && !running;
    $("result").hidden = opened === null;
    if (opened === null) {
      $("sentence").textContent = running ? "Opening a device…" : "This run cannot begin";
      return;
    }
    this.#mosaic.pack(over, opened.cases.length);
    this.#mosaic.paint();
    $("sentence").textContent = sentence(run, this.#tally);
    $("answer").dataset.kind = over && !opened.timed ? this.#tally.kind : "";
    $("lead").textContent = lacks(this.#tally);
    $("remarks").textContent = remarks(run, this.#tally);
    $("device").textContent = `${opened.device}${opened.software ? " (software)" : ""}, ${opened.driver}`;
    $("bar").max = opened.cases.length;
    $("bar").value = run.done;
    $("bar").hidden = run.complete;
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
    $("known-title").textContent = `${counted(known, "bad verdict")} because of known bugs`;
    document.body.dataset.state = running ? "running" : run.complete ? "complete" : "stopped";
  }

  /** Announces each tenth of a run, and its end, to screen readers. */
  #speak() {
    const run = this.#run;
    const tenth = Math.floor((10 * run.done) / run.opened.cases.length);
    const spoken = `${run.running} ${tenth}`;
    if (this.#spoken !== spoken) {
      this.#spoken = spoken;
      $("spoken").textContent = run.running ? this.#state() : $("sentence").textContent;
    }
  }

  #state() {
    const { opened, running, complete, done, left } = this.#run;
    const clock = clockText(opened.timed, opened.clock);
    if (complete) {
      return clock;
    }
    const time = running && left !== null ? `, about ${duration(left)} left` : "";
    return `${done.toLocaleString("en")} of ${counted(opened.cases.length, "case")}${time}. ${clock}`;
  }
}

/** Shows the pictures of the first wrong cases, from different case files if possible; new ones before known ones. */
function showCards(run, suite) {
  const wrong = [...run.records.entries()].filter(([number, { outcome, file }]) => {
    return number < run.opened.cases.length && file !== null && ["bad", "known"].includes(column(outcome));
  });
  wrong.sort(([a, { outcome: first }], [b, { outcome: second }]) => second.unexpected - first.unexpected || a - b);
  const files = new Map();
  for (const [number, record] of wrong) {
    const file = caseFile(run.opened.cases[number]);
    if (!files.has(file)) files.set(file, [number, record]);
  }
  const chosen = [...files.values()].slice(0, CARDS);
  const cards = chosen.map(([number, { outcome, line, file }]) => {
    const id = run.opened.cases[number];
    const body = recordBody(suite, line, file);
    const title = make("h2", {}, make("a", { href: `#case=${encoded(id)}` }, idOf(id)));
    const why = body.querySelector(".violation b")?.textContent ?? outcome.headline;
    const known = outcome.expected === null ? [] : [make("p", { class: "known" }, make("b", {}, "Known: "), outcome.expected)];
    const shots = body.querySelector(".strip .shots");
    return make("article", { class: "card" }, title, ...(shots === null ? [] : [shots]), make("p", {}, why), ...known);
  });
  const rest = wrong.length - cards.length;
  const more = rest > 0 ? [make("p", { class: "soft" }, `${counted(rest, "more case")} with wrong pictures ${rest === 1 ? "is" : "are"} listed below.`)] : [];
  $("cards").replaceChildren(...cards, ...more);
  $("cards").hidden = cards.length === 0;
  $("known-list").open = wrong.length > 0 && !wrong[0][1].outcome.unexpected;
}

/** Returns everything about a record as an element. */
function recordBody(suite, line, file) {
  const parts = [line, file ?? new Uint8Array()];
  const message = new Uint8Array(parts[0].length + parts[1].length);
  message.set(parts[0]);
  message.set(parts[1], parts[0].length);
  const [, html] = suite.ask({ view: { line: line.length } }, message);
  const body = make("div", { class: "record" });
  // The suite escapes all texts. The page's policy refuses attributes with styles, but not styles that a script sets.
  body.innerHTML = new TextDecoder().decode(html).replaceAll(' style="', ' data-style="');
  for (const element of body.querySelectorAll("[data-style]")) {
    element.style.cssText = element.dataset.style;
  }
  return body;
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

function showProblem(problem, what = "This page cannot continue") {
  const isWebGpu = /WebGPU|adapter|device/.test(problem);
  const [first, ...others] = isWebGpu ? remedies() : [];
  const remedy = first === undefined ? [] : [make("p", {}, first)];
  const more = others.length === 0 ? [] : [make("details", {}, make("summary", {}, "Other browsers"), make("ul", {}, ...others.map((text) => make("li", {}, text))))];
  const instead = isWebGpu ? [make("p", {}, "Nothing is drawn instead: the page does not use WebGL. The program ", make("code", {}, "etalon run"), " tests Vulkan and OpenGL without a browser.")] : [];
  $("problem").replaceChildren(make("p", {}, make("b", {}, `${what}: `), `${problem}.`), ...remedy, ...more, ...instead);
  $("problem").hidden = false;
}

/** Shows one case in place of the run. */
async function showCase(run, suite, id) {
  const view = $("view");
  const title = make("h1", { id: "view-title", tabindex: "-1" }, idOf(id));
  const back = make("nav", { "aria-label": "Cases" }, make("a", { href: "#" }, "All cases"));
  const number = run?.opened?.cases.indexOf(id) ?? -1;
  const record = run?.records.get(number);
  const content = make("div", {});
  if (record === undefined) {
    const again = make("a", { href: `#run=${encoded(id)}` }, "Draw it");
    content.append(make("p", { class: "state bad", role: "alert" }, "This run has no record of this case. ", again, "."));
  } else {
    const { outcome, line, file, tile = null } = record;
    const chip = make("span", { class: `chip ${outcome.class}` }, `${outcome.symbol} ${outcome.word}`);
    const body = recordBody(await suite(), line, file);
    if (file === null && tile !== null) {
      body.prepend(make("figure", { class: "drawn" }, thumbnail(tile), make("figcaption", {}, "As this device draws it")));
    }
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
