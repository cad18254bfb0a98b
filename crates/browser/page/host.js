// Runs the page in a program without documents: Node with the package `webgpu`, which is Dawn, or Deno, whose WebGPU is
// wgpu. The arguments are the page's address and Dawn's flags, such as `backend=vulkan`. What starts it is in
// crates/adapters/adapters.json; a text that `eval` runs cannot import, so Dawn comes as the promise `dawn`.
"use strict";

(async () => {
  const inDeno = globalThis.Deno !== undefined;
  const [address, ...flags] = inDeno ? Deno.args : process.argv.slice(2);
  const define = (name, value) => Object.defineProperty(globalThis, name, { value, configurable: true });
  define("location", new URL(address));
  define("isSecureContext", true);
  define("document", { getElementById: () => ({ set textContent(text) { console.error(text); } }) });
  if (!inDeno) {
    const { create, globals } = await dawn;
    Object.assign(globalThis, globals);
    const require = process.getBuiltinModule("module").createRequire(process.argv[1]);
    define("navigator", { gpu: create(flags), userAgent: `Dawn/${require("webgpu/package.json").version}` });
  }
  const text = async (name) => (await fetch(new URL(name, address))).text();
  const scripts = (await text("")).matchAll(/<script src="(.+?)">/g);
  const texts = await Promise.all(Array.from(scripts, ([, name]) => text(name)));
  // Scripts of a page share their names.
  new Function(texts.join("\n"))();
})();
