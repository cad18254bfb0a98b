// A lane of a run: one device and one instance of the suite. It draws and judges the cases that the page names.
"use strict";

importScripts("device.js", "executor.js", "scenes.js", "suite.js");

/** The milliseconds in which a device must answer. */
const TIMEOUT = 60_000;

/** The number of steps of the clock from which its resolution is found. */
const TICKS = 10;

let clock = 0;
let suite = null;
let scenes = null;
let device = null;

/** Opens a fresh device. Returns its description. */
async function renew() {
  device?.destroy();
  scenes = null;
  const found = await openDevice(false);
  device = found.device;
  scenes = new Scenes(device);
  return found.hello;
}

/** Returns the parts of these lengths. */
function parts(bytes, lengths) {
  let start = 0;
  return lengths.map((length) => {
    const part = bytes.slice(start, start + length);
    start += length;
    return part;
  });
}

function joined(arrays) {
  const whole = new Uint8Array(arrays.reduce((sum, array) => sum + array.length, 0));
  let start = 0;
  for (const array of arrays) {
    whole.set(array, start);
    start += array.length;
  }
  return whole;
}

/** Returns the steps of the browser's clock in seconds: browsers make it coarse. */
function clockStep() {
  let least = Infinity;
  let last = performance.now();
  for (let ticks = 0; ticks < TICKS; ) {
    const next = performance.now();
    if (next > last) {
      least = Math.min(least, next - last);
      last = next;
      ticks += 1;
    }
  }
  return Number((least / 1000).toPrecision(2));
}

/** Returns the result of a promise, or null if it takes too long. */
function within(promise) {
  let timer;
  const late = new Promise((resolve) => {
    timer = setTimeout(() => resolve(null), TIMEOUT);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** Draws requests, up to the first failure. Returns what the suite needs to judge the answers. */
async function drawn(number, requests) {
  const begun = performance.now();
  const answers = [];
  let timeout = false;
  for (const request of requests) {
    const answer = await within(scenes.answer(request.buffer));
    if (answer === null) {
      timeout = true;
      break;
    }
    answers.push(answer);
    if (unpacked(answer.buffer)[0].error !== null) {
      break;
    }
  }
  const seconds = (performance.now() - begun) / 1000;
  const lengths = answers.map((answer) => answer.length);
  return [{ number, seconds, answers: lengths, timeout, clock }, joined(answers)];
}

/** Returns the outcome of a case and its bytes. */
async function outcome(number) {
  let [step, bytes] = suite.ask({ draw: { number } });
  let judging = 0;
  while (step.requests !== undefined) {
    const { lengths, renew: fresh } = step.requests;
    if (fresh || scenes === null) {
      await renew();
    }
    const [judge, answers] = await drawn(number, parts(bytes, lengths));
    const begun = performance.now();
    [step, bytes] = suite.ask({ judge }, answers);
    judging += performance.now() - begun;
  }
  if (step.judged !== undefined) {
    if (step.judged.renew) {
      scenes = null;
    }
    [step, bytes] = suite.ask({ record: { number, seconds: judging / 1000 } });
  }
  return [step.outcome, bytes];
}

/** What the page can ask for. Each answer is a message with the same key. */
const tasks = {
  /** Begins a run. */
  async open({ module, opening }) {
    suite = await Suite.of(module);
    const hello = await renew();
    const [opened] = suite.ask({ open: { ...opening, hello } });
    clock = opened.timed ? clockStep() : 0;
    return { opened, clock };
  },
  /** Reports the result of a round trip. */
  async trip({ number, line }) {
    suite.ask({ trip: { number } }, line);
    return {};
  },
  /** Draws and judges a case. */
  async draw({ number }) {
    const [found, bytes] = await outcome(number);
    const { length, short, tile: texels, pictures: named, ...rest } = found;
    const lengths = [length, short, texels, ...named.map(([, size]) => size)];
    const [line, brief, tile, ...files] = parts(bytes, lengths);
    const pictures = named.map(([path], i) => [path, files[i]]);
    const end = lengths.reduce((sum, size) => sum + size, 0);
    const file = found.frame === null ? null : bytes.slice(end);
    return { outcome: rest, line, short: short > 0 ? brief : null, tile: texels > 0 ? tile : null, pictures, file };
  },
};

let queue = Promise.resolve();
onmessage = ({ data: { task, ...rest } }) => {
  queue = queue.then(async () => {
    try {
      postMessage({ task, ...(await tasks[task](rest)) });
    } catch (error) {
      postMessage({ task, number: rest.number, error: error.message });
    }
  });
};
