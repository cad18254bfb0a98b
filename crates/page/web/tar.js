// A run folder as one file: a tar archive, compressed with gzip.
"use strict";

const BLOCK = 512;

/** Returns the header of a member. */
function tarHeader(name, size, kind, seconds) {
  const header = new Uint8Array(BLOCK);
  const put = (text, start) => header.set(new TextEncoder().encode(text), start);
  const octal = (value, digits) => value.toString(8).padStart(digits, "0");
  put(name.slice(0, 100), 0);
  put("0000644\0" + "0000000\0" + "0000000\0", 100);
  put(octal(size, 11) + "\0" + octal(seconds, 11) + "\0", 124);
  put(" ".repeat(8), 148);
  put(kind, 156);
  put("ustar\0" + "00", 257);
  const sum = header.reduce((sum, byte) => sum + byte, 0);
  put(octal(sum, 6) + "\0 ", 148);
  return header;
}

/** Returns the parts of a member: header, bytes and padding. Long names have a header of their own. */
function member(name, bytes, seconds) {
  const padding = (size) => new Uint8Array((BLOCK - (size % BLOCK)) % BLOCK);
  const parts = [];
  if (name.length > 100) {
    const field = ` path=${name}\n`;
    let length = field.length;
    while (String(length).length + field.length !== length) {
      length = String(length).length + field.length;
    }
    const text = new TextEncoder().encode(length + field);
    parts.push(tarHeader("path", text.length, "x", seconds), text, padding(text.length));
  }
  parts.push(tarHeader(name, bytes.length, "0", seconds), bytes, padding(bytes.length));
  return parts;
}

/** Returns a compressed archive of files: pairs of an ASCII name and bytes. */
async function archive(files) {
  const seconds = Math.floor(Date.now() / 1000);
  const parts = files.flatMap(([name, bytes]) => member(name, bytes, seconds));
  const tar = new Blob([...parts, new Uint8Array(2 * BLOCK)]);
  const packed = tar.stream().pipeThrough(new CompressionStream("gzip"));
  return new Response(packed).blob();
}
