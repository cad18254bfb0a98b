// Opens a device, and describes it like the adapter of a run (crates/webgpu/src/message.rs).
"use strict";

/** The version of the messages. */
const PROTOCOL = 1;

/** The feature of devices that have all of core WebGPU. Older browsers offer core WebGPU without this feature. */
const CORE = "core-features-and-limits";

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

/** Uncaptured errors, to be sent with the next answer. */
const messages = [];

/** Returns the name and version of the browser, or of what hosts the page, as it reports them. */
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
  const [, name, version] = /(Firefox|Chrome|Version|Dawn|Deno)\/([\d.]+)/.exec(navigator.userAgent) ?? [];
  return { name: name === "Version" ? "Safari" : (name ?? "browser"), version: version ?? "" };
}

/**
 * Finds an adapter, and returns it with the description of its best device. Throws the reason if there is no adapter.
 * @param {boolean} compatibility true to request an adapter in compatibility mode
 */
async function findAdapter(compatibility) {
  if (navigator.gpu === undefined) {
    throw new Error(
      isSecureContext
        ? "this browser has no WebGPU, or it is disabled"
        : "WebGPU needs a secure context: https, or an address of this machine (http://127.0.0.1)",
    );
  }
  const core = compatibility ? null : await navigator.gpu.requestAdapter();
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
  const hello = {
    protocol: PROTOCOL,
    browser: await browser(),
    compatibility: core === null && !adapter.features.has(CORE),
    adapter: {
      vendor: info.vendor,
      architecture: info.architecture,
      device: info.device,
      description: info.description,
      fallback: info.isFallbackAdapter ?? adapter.isFallbackAdapter ?? false,
    },
    features: FEATURES.filter((name) => adapter.features.has(name)),
    limits,
  };
  return { adapter, hello };
}

/**
 * Opens a device, and returns it with its description. Throws the reason if there is no device.
 * @param {boolean} compatibility true to request a device in compatibility mode
 */
async function openDevice(compatibility) {
  const { adapter, hello } = await findAdapter(compatibility);
  const requiredFeatures = hello.features.filter((name) => !compatibility || name !== CORE);
  const device = await adapter.requestDevice({ requiredFeatures, requiredLimits: hello.limits });
  device.onuncapturederror = ({ error }) => {
    messages.push(error.message);
  };
  const features = [...device.features];
  const isLimited = (compatibility || hello.compatibility) && !device.features.has(CORE);
  return { device, hello: { ...hello, compatibility: isLimited, features } };
}
