// Connects a device of this browser to the worker that served the page, and executes the lists that the
// worker sends.
"use strict";

/** True if the address requests a device in compatibility mode. */
const COMPATIBILITY = new URLSearchParams(location.search).has("compatibility");

/** The pause before another attempt to connect, in milliseconds. */
const RECONNECTION = 500;

/** Shows a line on the page. */
function show(text) {
  document.getElementById("state").textContent = text;
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
    const found = await openDevice(COMPATIBILITY);
    device = found.device;
    const scenes = new Scenes(device);
    let queue = Promise.resolve();
    socket.onmessage = ({ data }) => {
      queue = queue.then(async () => socket.send(await scenes.answer(data)));
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
