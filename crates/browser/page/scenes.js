// Answers requests to draw lists: messages of a header and bytes (crates/webgpu/src/message.rs).
"use strict";

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
class Scenes {
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
        const earlier = this.#scenes.get(request.slot);
        if (earlier !== undefined) {
          this.#executor.drop(earlier);
        }
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
