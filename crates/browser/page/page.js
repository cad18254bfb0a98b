// Connects a device of this browser to the worker that served the page, and executes the lists that the
// worker sends.
"use strict";

const PROTOCOL = 1;

/** The feature of devices with everything that WebGPU guarantees, which older browsers have without naming it. */
const CORE = "core-features-and-limits";

/** True if the address requests a device in compatibility mode. */
const COMPATIBILITY = new URLSearchParams(location.search).has("compatibility");

/** The features that are requested if the adapter has them. */
const FEATURES = [
  CORE,
  "clip-distances",
  "depth-clip-control",
  "depth32float-stencil8",
  "dual-source-blending",
  "float32-blendable",
  "float32-filterable",
  "indirect-first-instance",
  "rg11b10ufloat-renderable",
  "texture-formats-tier1",
  "timestamp-query",
];

/** The pause before another attempt to connect, in milliseconds. */
const RECONNECTION = 500;

/** Uncaptured errors, to be sent with the next answer. */
const messages = [];

/** Shows a line on the page. */
function show(text) {
  document.getElementById("state").textContent = text;
}

/** Returns the browser's name and version, as it reports them. */
async function browser() {
  const data = navigator.userAgentData;
  try {
    const { fullVersionList = [] } = (await data?.getHighEntropyValues(["fullVersionList"])) ?? {};
    const known = /^(Chromium|Google Chrome|Microsoft Edge|Opera)$/;
    const brand = fullVersionList.findLast(({ brand }) => known.test(brand));
    if (brand !== undefined) {
      return { name: brand.brand, version: brand.version };
    }
  } catch {
    // The user agent has less detail.
  }
  const [, name, version] = /(Firefox|Chrome|Version)\/([\d.]+)/.exec(navigator.userAgent) ?? [];
  return { name: name === "Version" ? "Safari" : (name ?? "browser"), version: version ?? "" };
}

/** Opens a device, and returns it with its description. Throws the reason if there is no device. */
async function open() {
  if (navigator.gpu === undefined) {
    throw new Error(
      isSecureContext
        ? "this browser has no WebGPU, or it is disabled"
        : "WebGPU needs a secure context: https, or an address of this machine (http://127.0.0.1)",
    );
  }
  const core = COMPATIBILITY ? null : await navigator.gpu.requestAdapter();
  const adapter = core ?? (await navigator.gpu.requestAdapter({ featureLevel: "compatibility" }));
  if (adapter === null) {
    throw new Error("the browser has WebGPU but provides no adapter");
  }
  const { info } = adapter;
  const names = ["maxTextureDimension2D", "maxTextureDimension3D", "maxColorAttachments",
    "maxColorAttachmentBytesPerSample", "maxStorageBuffersPerShaderStage", "maxStorageBuffersInFragmentStage",
    "minUniformBufferOffsetAlignment", "minStorageBufferOffsetAlignment", "maxBufferSize",
    "maxStorageBufferBindingSize"];
  const limits = {};
  for (const name of names) {
    if (adapter.limits[name] !== undefined) {
      limits[name] = adapter.limits[name];
    }
  }
  const offered = FEATURES.filter((name) => adapter.features.has(name));
  const requiredFeatures = offered.filter((name) => !COMPATIBILITY || name !== CORE);
  const device = await adapter.requestDevice({ requiredFeatures, requiredLimits: limits });
  device.onuncapturederror = ({ error }) => {
    messages.push(error.message);
  };
  const hello = {
    protocol: PROTOCOL,
    browser: await browser(),
    compatibility: core === null && !device.features.has(CORE),
    adapter: {
      vendor: info.vendor,
      architecture: info.architecture,
      device: info.device,
      description: info.description,
      fallback: info.isFallbackAdapter ?? adapter.isFallbackAdapter ?? false,
    },
    features: [...device.features],
    limits,
  };
  return { device, hello };
}

/** Returns a message that consists of a header and bytes. */
function packed(header, bytes) {
  const text = new TextEncoder().encode(JSON.stringify(header));
  const message = new Uint8Array(4 + text.length + bytes.length);
  new DataView(message.buffer).setUint32(0, text.length, true);
  message.set(text, 4);
  message.set(bytes, 4 + text.length);
  return message;
}

/** Returns the header of a message, and the bytes after it. */
function unpacked(message) {
  const length = new DataView(message).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length)));
  return [header, new Uint8Array(message, 4 + length)];
}

/** Answers requests on a device, in order. */
class Page {
  #executor;
  #scenes = new Map();

  constructor(device) {
    this.#executor = new Executor(device);
  }

  /** Returns the answer to a request. */
  async answer(message) {
    const [request, bytes] = unpacked(message);
    const answer = { number: request.number, times: [], error: null };
    let output = new Uint8Array();
    try {
      for (const slot of request.dropped) {
        const made = this.#scenes.get(slot);
        if (made !== undefined) {
          this.#executor.drop(made);
          this.#scenes.delete(slot);
        }
      }
      if (request.list !== null) {
        this.#scenes.set(request.slot, this.#executor.prepare(request.list, contents(request.contents, bytes)));
      }
      const made = this.#scenes.get(request.slot);
      for (let frame = 1; frame <= request.frames; frame += 1) {
        const [times, bytes] = await this.#executor.submit(made, request.read && frame === request.frames);
        answer.times.push(times);
        output = bytes ?? output;
      }
      if (request.read && request.frames === 0) {
        output = await this.#executor.read(made);
      }
    } catch (thrown) {
      answer.error = await this.#failure(thrown);
      this.#executor.forget();
    }
    answer.messages = messages.splice(0);
    return packed(answer, output);
  }

  /** Returns the report of an error, or of an earlier error on the device. */
  async #failure(thrown) {
    try {
      await this.#executor.check(thrown);
      return null;
    } catch ({ kind = "internal", what = "executing a list", message }) {
      return { kind, what, message };
    }
  }
}

/** Returns the contents of buffers: pairs of an index and bytes. The bytes of all buffers are consecutive. */
function contents(lengths, bytes) {
  let start = 0;
  return lengths.map(([place, length]) => {
    const part = bytes.subarray(start, start + length);
    start += length;
    return [place, part];
  });
}

/** Serves one connection. Returns when it ends. */
async function serve() {
  const address = new URL("socket", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  const socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  const closed = new Promise((resolve) => {
    socket.onclose = resolve;
  });
  const opened = new Promise((resolve) => {
    socket.onopen = () => resolve(true);
    closed.then(() => resolve(false));
  });
  if (!(await opened)) {
    return false;
  }
  let device = null;
  try {
    const found = await open();
    device = found.device;
    const page = new Page(device);
    let queue = Promise.resolve();
    socket.onmessage = ({ data }) => {
      queue = queue.then(async () => socket.send(await page.answer(data)));
    };
    device.lost.then(({ message }) => show(`The device was lost: ${message}`));
    show("Connected. Scenes are drawn on this device until the run ends.");
    socket.send(JSON.stringify(found.hello));
  } catch (error) {
    show(`This browser cannot be tested: ${error.message}`);
    socket.send(JSON.stringify({ protocol: PROTOCOL, unavailable: error.message }));
  }
  await closed;
  device?.destroy();
  show("The run has ended, or its worker is restarting.");
  return true;
}

/** Connects again and again: after a lost worker, another one listens at the same address. */
async function main() {
  for (;;) {
    await serve();
    await new Promise((resolve) => {
      setTimeout(resolve, RECONNECTION);
    });
  }
}

main();
