// A lane of a run: one device and one instance of the suite. It draws and judges the cases that the page names.
"use strict";

importScripts("device.js", "executor.js", "scenes.js", "suite.js");

/** The milliseconds in which a device must answer. */
const TIMEOUT = 60_000;

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

/** Returns the result of a promise, or null if it takes too long. */
function within(promise) {
  let timer;
  const late = new Promise((resolve) => {
    timer = setTimeout(() => resolve(null), TIMEOUT);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** Draws the requests of a case, up to the first failure. */
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
  const judge = { number, seconds, answers: answers.map((answer) => answer.length), timeout };
  return suite.ask({ judge }, joined(answers));
}

/** Returns the outcome of a case and its bytes. */
async function outcome(number) {
  const [drawing, bytes] = suite.ask({ draw: { number } });
  if (drawing.outcome !== undefined) {
    return [drawing.outcome, bytes];
  }
  const requests = parts(bytes, drawing.requests);
  for (;;) {
    if (scenes === null) {
      await renew();
    }
    const [judging, bytes] = await drawn(number, requests);
    if (judging.renew) {
      scenes = null;
    }
    if (judging.outcome !== null) {
      return [judging.outcome, bytes];
    }
  }
}

/** What the page can ask for. Each answer is a message with the same key. */
const tasks = {
  /** Begins a run. */
  async open({ module, opening }) {
    suite = await Suite.of(module);
    const hello = await renew();
    const [opened] = suite.ask({ open: { ...opening, hello } });
    return { opened };
  },
  /** Reports the result of a round trip. */
  async trip({ number, line }) {
    suite.ask({ trip: { number } }, line);
    return {};
  },
  /** Draws and judges a case. */
  async draw({ number }) {
    const [found, bytes] = await outcome(number);
    const { length, short, ...rest } = found;
    const [line, brief] = parts(bytes, [length, short]);
    const file = found.frame === null ? null : bytes.slice(length + short);
    return { outcome: rest, line, short: short > 0 ? brief : null, file };
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
