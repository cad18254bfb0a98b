// A run: lanes draw and judge its cases, round trips first, and the page keeps the records.
"use strict";

/** The maximum number of lanes. Each occupies a worker, a device and a core. */
const LANES = 8;
/** The number of cases that are sent to a lane in advance. */
const AHEAD = 2;
/** The number of neighbouring cases that a lane takes at a time, since they share pipelines. */
const CHUNK = 16;
/** The number of attempts at a case whose lane fails. */
const ATTEMPTS = 2;
/** The number of lanes that fail in a row before the run stops. */
const FAILURES = 4;
/** The number of cases from whose time that of a case is known. */
const PACED = 100;
/** The milliseconds between writes to the store. */
const WRITING = 200;

/** Returns the current time as runs record it. */
const now = () => new Date().toISOString().replace(/\.\d+Z$/, "Z");

/** Returns what the browser reveals about the machine. */
async function machine() {
  const data = navigator.userAgentData;
  let cpu = "";
  try {
    const { architecture, bitness } = await data.getHighEntropyValues(["architecture", "bitness"]);
    cpu = [architecture, bitness && `${bitness}-bit`].filter(Boolean).join(" ");
  } catch {
    // Not every browser reveals this.
  }
  return { os: data?.platform || navigator.platform || "unknown", cpu, cores: navigator.hardwareConcurrency ?? 1 };
}

/** One worker with its device. */
class Lane {
  /** The numbers of the cases that it has, in order. */
  asked = [];
  /** The numbers of the cases that it takes next. */
  chunk = [];
  #worker = new Worker("lane.js");
  #answers = [];

  /** @param {(lane: Lane, answer: object) => void} drawn called with each answer to `draw` */
  constructor(drawn) {
    this.#worker.onmessage = ({ data }) => {
      if (data.task === "draw") {
        this.asked.shift();
        drawn(this, data);
      } else if (data.task === "open") {
        this.#answers.shift()(data);
      }
    };
    this.#worker.onerror = (event) => {
      event.preventDefault();
      const data = { task: "draw", number: this.asked[0], error: event.message || "the worker does not start" };
      if (this.#answers.length > 0) {
        this.#answers.shift()(data);
      } else {
        drawn(this, data);
      }
    };
  }

  /** Begins a run. Returns what the suite says about it, and the steps of the clock. */
  async open(module, opening) {
    const { opened, clock, error } = await new Promise((resolve) => {
      this.#answers.push(resolve);
      this.#worker.postMessage({ task: "open", module, opening });
    });
    if (error !== undefined) {
      throw new Error(error);
    }
    return { ...opened, clock };
  }

  trip(number, line) {
    this.#worker.postMessage({ task: "trip", number, line });
  }

  draw(number) {
    this.asked.push(number);
    this.#worker.postMessage({ task: "draw", number });
  }

  end() {
    this.#worker.terminate();
    this.#answers.splice(0).forEach((resolve) => resolve({ error: "the run is stopped" }));
  }
}

/** A run. Dispatches `changed` whenever something happens. */
class Run extends EventTarget {
  selection;
  opened = null;
  /** Records by number: outcome, line, the line without its frame, tile, pictures, the frame's file. */
  records = new Map();
  /** The reason why the run stopped by itself. */
  problem = null;
  running = false;
  #store;
  #module;
  #opening;
  #lanes = [];
  #queue = [];
  #trips = new Set();
  #attempts = new Map();
  #failures = 0;
  #unwritten = [];
  #begun = 0;
  #drawn = 0;

  /**
   * @param {Store} store
   * @param {WebAssembly.Module} module
   * @param {{globs: string[], profile: string, fault: string}} selection
   */
  constructor(store, module, selection) {
    super();
    this.#store = store;
    this.#module = module;
    this.selection = selection;
  }

  /** Returns the run of the store. `start` continues it. */
  static of(store, module, { run, records }) {
    const found = new Run(store, module, run.selection);
    found.opened = run.opened;
    found.#opening = run.opening;
    found.records = records;
    return found;
  }

  /** Returns the number of cases with a record. */
  get done() {
    let done = 0;
    for (const number of this.records.keys()) {
      done += number < this.opened.cases.length ? 1 : 0;
    }
    return done;
  }

  get complete() {
    return this.opened !== null && this.done === this.opened.cases.length;
  }

  /** Returns the seconds that are left; null while they are unknown. */
  get left() {
    const seconds = (performance.now() - this.#begun) / 1000;
    return this.#drawn < 20 ? null : (seconds / this.#drawn) * (this.opened.cases.length - this.done);
  }

  /** Draws the cases without a record. Returns when all are drawn or the run is stopped. */
  async start() {
    this.running = true;
    this.problem = null;
    this.#changed();
    try {
      await this.#open();
      this.#begun = performance.now();
      const missing = (numbers) => numbers.filter((number) => !this.records.has(number));
      await this.#draw(missing(this.opened.first));
      await this.#draw(missing([...this.opened.cases.keys()]));
    } catch (error) {
      if (this.running) {
        this.problem ??= error.message;
      }
    }
    await this.stop();
  }

  /** Stops drawing. Keeps the records. */
  async stop() {
    this.#lanes.splice(0).forEach((lane) => lane.end());
    if (this.running && this.#drawn >= PACED && !this.opened.timed) {
      this.#store.pace = (performance.now() - this.#begun) / 1000 / this.#drawn;
    }
    this.running = false;
    this.#finish?.();
    await this.#write();
    this.#changed();
  }

  /** Opens the lanes. A run whose header no longer fits begins anew. */
  async #open() {
    const { globs, profile, fault } = this.selection;
    const earlier = this.opened;
    const command = ["page", `#run=${globs.join(" ")}&profile=${profile}`];
    this.#opening ??= { globs, profile, fault, machine: await machine(), started: now(), command };
    const first = new Lane(this.#answered);
    this.#lanes.push(first);
    let opened = await first.open(this.#module, this.#opening);
    if (earlier !== null && earlier.header !== opened.header) {
      this.records = new Map();
      this.#opening = { ...this.#opening, started: now() };
      opened = await first.open(this.#module, this.#opening);
    }
    this.opened = opened;
    this.#opening = { ...this.#opening, trips: opened.trips };
    this.#trips = new Set(opened.first);
    if (this.records.size === 0) {
      const { selection } = this;
      await this.#store.begin({ selection, opened, opening: this.#opening });
    }
    this.#changed();
    const cores = navigator.hardwareConcurrency ?? 2;
    // Nothing else is drawn or judged while frames are timed.
    const most = opened.timed ? 1 : LANES;
    const more = Math.min(most, Math.max(2, cores), opened.cases.length) - 1;
    const others = Array.from({ length: more }, () => this.#lane().catch(() => null));
    // A device that refuses more lanes has at least one.
    this.#lanes.push(...(await Promise.all(others)).filter((lane) => lane !== null));
    this.#lanes.forEach((lane) => this.#tellTrips(lane));
  }

  async #lane() {
    const lane = new Lane(this.#answered);
    await lane.open(this.#module, this.#opening).catch((error) => {
      lane.end();
      throw error;
    });
    return lane;
  }

  /** Tells a lane the results of round trips that matter. */
  #tellTrips(lane) {
    for (const number of this.#trips) {
      const record = this.records.get(number);
      if (record !== undefined && matters(record)) {
        lane.trip(number, record.line);
      }
    }
  }

  #finish = null;

  /** Draws cases. Returns when all are drawn or the run is stopped. */
  async #draw(numbers) {
    if (numbers.length === 0 || !this.running) {
      return;
    }
    this.#queue = numbers;
    await new Promise((resolve) => {
      this.#finish = resolve;
      this.#lanes.forEach((lane) => this.#feed(lane));
    });
    this.#finish = null;
  }

  #feed(lane) {
    while (lane.asked.length < AHEAD) {
      if (lane.chunk.length === 0) {
        const share = Math.ceil(this.#queue.length / (4 * this.#lanes.length));
        lane.chunk = this.#queue.splice(0, Math.min(CHUNK, share));
      }
      if (lane.chunk.length === 0) {
        break;
      }
      lane.draw(lane.chunk.shift());
    }
    if (this.#queue.length === 0 && this.#lanes.every((lane) => lane.asked.length === 0)) {
      this.#finish?.();
    }
  }

  #answered = (lane, answer) => {
    if (!this.#lanes.includes(lane)) {
      return;
    }
    const { outcome, line, short, tile, pictures, file, number, error } = answer;
    if (error !== undefined) {
      this.#replace(lane, number, error);
      return;
    }
    this.#failures = 0;
    this.#keep(outcome.number, { outcome, line, short, tile, pictures, file });
    this.#feed(lane);
  };

  #keep(number, record) {
    this.records.set(number, record);
    this.#drawn += 1;
    if (this.#unwritten.length === 0) {
      setTimeout(() => this.#write(), WRITING);
    }
    this.#unwritten.push([number, record]);
    if (this.#trips.has(number) && matters(record)) {
      this.#lanes.forEach((lane) => lane.trip(number, record.line));
    }
    this.#changed(number);
  }

  /** Replaces a lane that failed. Other lanes draw its cases; the case that failed is tried once more. */
  async #replace(lane, number, error) {
    lane.end();
    this.#lanes.splice(this.#lanes.indexOf(lane), 1);
    this.#failures += 1;
    const attempts = (this.#attempts.get(number) ?? 0) + 1;
    this.#attempts.set(number, attempts);
    const others = [...lane.asked, ...lane.chunk].filter((other) => other !== number);
    this.#queue.unshift(...others);
    if (number !== undefined && attempts < ATTEMPTS) {
      this.#queue.unshift(number);
    } else if (number !== undefined) {
      this.#keep(number, this.#broken(number, error));
    }
    try {
      if (this.#failures >= FAILURES) {
        throw new Error(error);
      }
      const fresh = await this.#lane();
      if (!this.running) {
        fresh.end();
        return;
      }
      this.#lanes.push(fresh);
      this.#tellTrips(fresh);
      this.#feed(fresh);
    } catch (failure) {
      if (this.#lanes.length === 0 || this.#failures >= FAILURES) {
        this.problem = failure.message;
        this.#finish?.();
        this.running = false;
      }
    }
  }

  /** Returns the record of a case at which the suite itself failed. */
  #broken(number, error) {
    const record = {
      case: this.opened.cases[number] ?? "",
      adapter: this.opened.adapter,
      verdict: "internal-error",
      message: error,
      texels: { total: 0, wrong: 0, imprecise: 0, open: 0 },
      assertions: [],
      seconds: { draw: 0, judge: 0 },
    };
    const outcome = {
      number,
      verdict: record.verdict,
      unexpected: true,
      bad: true,
      due: false,
      expected: null,
      symbol: "!",
      word: "internal error",
      class: "b",
      headline: error,
      frame: null,
    };
    const line = new TextEncoder().encode(`${JSON.stringify(record)}\n`);
    return { outcome, line, short: null, tile: null, pictures: [], file: null };
  }

  async #write() {
    await this.#store.add(this.#unwritten.splice(0));
  }

  #changed(number = null) {
    this.dispatchEvent(new CustomEvent("changed", { detail: number }));
  }

  /** Returns the run folder as one compressed file. */
  async file() {
    return archive(await this.#folder());
  }

  /** Returns the charts of methods as HTML, and their style sheet; null if nothing is measured. */
  async charts(suite) {
    const [[, lines], ...files] = await this.#folder();
    const pictures = files.filter(([path]) => path.startsWith("pictures/"));
    const sizes = pictures.map(([path, file]) => [path, file.length]);
    const bytes = await new Blob([lines, ...pictures.map(([, file]) => file)]).arrayBuffer();
    const methods = { lines: lines.length, pictures: sizes };
    const [{ style }, html] = suite.ask({ methods }, new Uint8Array(bytes));
    return html.length === 0 ? null : { style, html: new TextDecoder().decode(html) };
  }

  /** Returns the files of the run folder: pairs of a path and bytes, `run.jsonl` first. */
  async #folder() {
    const { cases, header } = this.opened;
    const lines = [new TextEncoder().encode(header)];
    const files = [];
    const imprecise = new Map();
    for (const [number, id] of cases.entries()) {
      const record = this.records.get(number);
      if (record === undefined) {
        continue;
      }
      let kept = record.file !== null;
      if (kept && record.short !== null) {
        const before = imprecise.get(caseFile(id)) ?? 0;
        imprecise.set(caseFile(id), before + 1);
        kept = before < IMPRECISE_FRAMES;
      }
      lines.push(kept || record.short === null ? record.line : record.short);
      if (kept) {
        files.push([record.outcome.frame, record.file]);
      }
      files.push(...(record.pictures ?? []));
    }
    const text = new Uint8Array(await new Blob(lines).arrayBuffer());
    const ids = new TextEncoder().encode(`${cases.join("\n")}\n`);
    return [["run.jsonl", text], ["cases.txt", ids], ...files];
  }
}

/** The number of frames of imprecise cases that are kept per case file; failures keep all. */
const IMPRECISE_FRAMES = 3;

/** Returns an id without its axis values. */
const caseFile = (id) => id.replace(/\/[^/]*=.*$/, "");

/** Returns true if the record of a round trip affects other cases. */
const matters = ({ outcome }) => outcome.bad || outcome.verdict === "skipped";
