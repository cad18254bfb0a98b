// The suite's WebAssembly: messages in and out (crates/page/src/abi.rs).
"use strict";

/** An instance of the suite. */
class Suite {
  #exports;

  /** @param {WebAssembly.Module} module */
  static async of(module) {
    const suite = new Suite();
    suite.#exports = (await WebAssembly.instantiate(module, {})).exports;
    return suite;
  }

  /** Returns the header and the bytes of the answer to a message. Throws if it cannot be answered. */
  ask(header, bytes = new Uint8Array()) {
    const { memory, etalon_room, etalon_ask, etalon_answer, etalon_length } = this.#exports;
    const message = packed(header, bytes);
    const room = etalon_room(message.length);
    // The memory can have grown, which replaces its buffer.
    new Uint8Array(memory.buffer, room, message.length).set(message);
    etalon_ask();
    const start = etalon_answer();
    const [answer, rest] = unpacked(memory.buffer.slice(start, start + etalon_length()));
    if (answer.error !== undefined) {
      throw new Error(answer.error);
    }
    return [answer, rest];
  }
}
