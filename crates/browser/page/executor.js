// Executes lists of WebGPU calls, without knowing about scenes. A list refers to objects by their indices in
// its tables, and its commands are in recording order (crates/webgpu/src/calls.rs).
"use strict";

/** The errors that a scope can catch. Of several errors in a step, the first in this order is reported. */
const FILTERS = ["out-of-memory", "validation", "internal"];

/** The bytes of the timestamps at the beginning and the end of a frame. */
const CLOCK_BYTES = 16;

/** The milliseconds between checks of a device that is not done. */
const PAUSE = 2;

/** A failure of the device, in the form that the worker expects. */
class Failed extends Error {
  /**
   * @param {string} kind `lost`, `resource`, `shader` or `internal`
   * @param {string} what the operation that failed
   * @param {string} message the device's message
   */
  constructor(kind, what, message) {
    super(message);
    this.kind = kind;
    this.what = what;
  }
}

/** Returns the name of an enum's variant, and its content if it has any. */
const variant = (value) => (typeof value === "string" ? [value] : Object.entries(value)[0]);

const bitsOfFloat = new DataView(new ArrayBuffer(4));

/** Returns the 32-bit float of these bits. */
function floatOf(bits) {
  bitsOfFloat.setUint32(0, bits);
  return bitsOfFloat.getFloat32(0);
}

/** Objects that outlive a list, by their descriptions. */
class Cache {
  #known = new Map();

  /** Returns the object of a description. Calls `make` if it is new. */
  get(description, make) {
    const key = JSON.stringify(description);
    let known = this.#known.get(key);
    if (known === undefined) {
      known = make();
      this.#known.set(key, known);
    }
    return known;
  }

  clear() {
    this.#known.clear();
  }
}

/** A device, and the objects on it that outlive a list. */
class Executor {
  #device;
  #timed;
  #shaders = new Cache();
  #layouts = new Cache();
  #pipelines = new Cache();
  #samplers = new Cache();
  #clock = null;
  #lost = null;
  /** Steps whose errors are not known yet: nothing waits for the device until a frame is done. */
  #steps = [];

  /** @param {GPUDevice} device */
  constructor(device) {
    this.#device = device;
    this.#timed = device.features.has("timestamp-query");
    device.lost.then((info) => {
      this.#lost = info.message || "no message";
    });
  }

  /** Creates the objects of a list, and fills its buffers with `contents`: pairs of a buffer's index and bytes. */
  prepare(list, contents) {
    const made = { list, begun: false };
    this.#step("making attachments", () => this.#memory(made, contents));
    made.layouts = list.layouts.map((entries) => this.#layout(entries));
    made.samplers = list.samplers.map((sampler) => this.#sampler(sampler));
    made.pipelines = list.pipelines.map((pipeline) => this.#pipeline(list, pipeline));
    this.#step("making bindings", () => {
      made.groups = list.groups.map((group) => this.#group(made, group));
      made.bundles = list.bundles.map((bundle) => this.#bundle(made, bundle));
    });
    return made;
  }

  /**
   * Draws a frame and waits for the device. Returns its times in milliseconds, and, if `read` is true, the
   * bytes that the list reads back. One wait serves both.
   */
  async submit(made, read) {
    const { list } = made;
    const clock = this.#timed && list.frame.flat().some(isTimed) ? this.#clockOf() : null;
    const begin = performance.now();
    let submitted = begin;
    const done = this.#step("drawing a scene", () => {
      const buffers = list.frame.map((commands, index) => {
        const encoder = this.#device.createCommandEncoder();
        if (index === 0 && !made.begun) {
          this.#record(made, encoder, list.first, null);
        }
        this.#record(made, encoder, commands, clock);
        if (clock !== null && index + 1 === list.frame.length) {
          encoder.resolveQuerySet(clock.queries, 0, 2, clock.resolved, 0);
          encoder.copyBufferToBuffer(clock.resolved, 0, clock.mapped, 0, CLOCK_BYTES);
        }
        return encoder.finish();
      });
      this.#device.queue.submit(buffers);
      submitted = performance.now();
      return Promise.all([
        read ? this.#mapped(made) : this.#device.queue.onSubmittedWorkDone(),
        clock?.mapped.mapAsync(GPUMapMode.READ),
      ]);
    });
    made.begun = true;
    await this.#settled(done);
    const times = { cpu: submitted - begin, wall: performance.now() - begin, gpu: null };
    if (clock !== null) {
      const [start, end] = new BigUint64Array(clock.mapped.getMappedRange());
      times.gpu = end >= start ? Number(end - start) / 1e6 : null;
      clock.mapped.unmap();
    }
    return [times, read ? bytesOf(made) : null];
  }

  /** Returns the bytes that a list reads back from its last frame. */
  async read(made) {
    await this.#settled(this.#step("reading a frame back", () => this.#mapped(made)));
    return bytesOf(made);
  }

  /** Destroys the objects that belong only to this list. */
  drop(made) {
    for (const object of [...(made.textures ?? []), ...(made.buffers ?? []), ...(made.querySets ?? [])]) {
      object.destroy();
    }
  }

  /** Forgets everything whose state an error makes unknown. */
  forget() {
    for (const cache of [this.#shaders, this.#layouts, this.#pipelines, this.#samplers]) {
      cache.clear();
    }
    this.#clock = null;
    this.#steps = [];
  }

  /**
   * Returns the result of an action, whose errors are checked when the step is settled.
   * @param {string} what what the action does
   * @param {() => T} action
   * @param {{[filter: string]: {kind: string, what: string}}} told how to report errors of a filter, if not
   * as usual
   */
  #step(what, action, told = {}) {
    for (const filter of FILTERS) {
      this.#device.pushErrorScope(filter);
    }
    const step = { what, told, thrown: null };
    let result;
    try {
      result = action();
    } catch (error) {
      step.thrown = error;
    }
    // A lost device has no scopes.
    step.caught = FILTERS.toReversed().map((filter) =>
      this.#device.popErrorScope().then(
        (error) => error && { filter, message: error.message },
        () => null,
      ),
    );
    this.#steps.push(step);
    if (step.thrown !== null) {
      throw step.thrown;
    }
    return result;
  }

  /** Waits for the device, and throws the first error of all steps so far. */
  async #settled(done) {
    let rejected = null;
    try {
      await this.#awaited(done);
    } catch (error) {
      rejected = error;
    }
    await this.check(rejected);
  }

  /** Throws the first error of all steps so far, or else `thrown` if it is not null. */
  async check(thrown) {
    const steps = this.#steps.splice(0);
    for (const step of steps) {
      const caught = (await Promise.all(step.caught)).filter((error) => error !== null);
      if (this.#lost !== null) {
        throw new Failed("lost", step.what, this.#lost);
      }
      if (caught.length > 0) {
        const { filter, message } = caught.at(-1);
        const rule = { kind: filter === "out-of-memory" ? "resource" : "internal", what: step.what };
        const { kind, what } = step.told[filter] ?? rule;
        throw new Failed(kind, what, message);
      }
      if (step.thrown !== null) {
        throw new Failed("internal", step.what, step.thrown.message);
      }
    }
    if (thrown !== null) {
      throw thrown;
    }
  }

  /** Copies what a list reads to its output buffer, and maps the buffer. */
  #mapped(made) {
    const { list } = made;
    const encoder = this.#device.createCommandEncoder();
    this.#record(made, encoder, list.read, null);
    this.#device.queue.submit([encoder.finish()]);
    return made.buffers[list.output].mapAsync(GPUMapMode.READ);
  }

  /**
   * Waits for the device. Firefox checks whether the device is done only every 100 ms and at each submission,
   * so empty submissions make it check.
   */
  async #awaited(promise) {
    let settled = false;
    const done = promise.finally(() => {
      settled = true;
    });
    await Promise.race([done, pause()]);
    while (!settled) {
      this.#device.queue.submit([]);
      await Promise.race([done, pause()]);
    }
    return done;
  }

  #memory(made, contents) {
    const { list } = made;
    made.textures = list.textures.map((texture) =>
      this.#device.createTexture({
        size: texture.size,
        mipLevelCount: texture.levels,
        sampleCount: texture.samples,
        dimension: texture.dimension,
        format: texture.format,
        usage: texture.usage,
        viewFormats: texture.view_format === null ? [] : [texture.view_format],
      }),
    );
    made.views = list.views.map((view) => {
      const descriptor = { aspect: view.aspect };
      if (view.format !== null) {
        descriptor.format = view.format;
      }
      if (view.part !== null) {
        const [level, layer] = view.part;
        Object.assign(descriptor, {
          dimension: "2d",
          baseMipLevel: level,
          mipLevelCount: 1,
          baseArrayLayer: layer,
          arrayLayerCount: 1,
        });
      }
      return made.textures[view.texture].createView(descriptor);
    });
    made.buffers = list.buffers.map(({ size, usage }) => this.#device.createBuffer({ size: (size + 3) & ~3, usage }));
    for (const [place, bytes] of contents) {
      this.#device.queue.writeBuffer(made.buffers[place], 0, bytes);
    }
    made.querySets = list.query_sets.map(({ count }) =>
      this.#device.createQuerySet({ type: "occlusion", count }),
    );
  }

  #shader({ label, code }) {
    const module = () => this.#device.createShaderModule({ label, code });
    const told = { kind: "shader", what: label };
    return this.#shaders.get([label, code], () =>
      this.#step(label, module, { validation: told, internal: told }),
    );
  }

  #layout(entries) {
    return this.#layouts.get(entries, () => {
      const bindings = this.#device.createBindGroupLayout({ entries: entries.map(layoutEntry) });
      const groups = entries.length === 0 ? [] : [bindings];
      return { bindings, pipeline: this.#device.createPipelineLayout({ bindGroupLayouts: groups }) };
    });
  }

  #sampler(sampler) {
    const [addressModeU, addressModeV] = sampler.address;
    const { filter } = sampler;
    return this.#samplers.get(sampler, () =>
      this.#device.createSampler({ addressModeU, addressModeV, magFilter: filter, minFilter: filter }),
    );
  }

  #pipeline(list, pipeline) {
    const entries = pipeline.layout === null ? [] : list.layouts[pipeline.layout];
    const shader = list.shaders[pipeline.shader];
    const { label } = pipeline.state;
    return this.#pipelines.get([shader, entries, pipeline.state], () => {
      const module = this.#shader(shader);
      const layout = this.#layout(entries).pipeline;
      const make = () => this.#device.createRenderPipeline(descriptorOf(pipeline.state, module, layout));
      // An internal error is the shader's, because the driver compiles it now.
      return this.#step(`a pipeline of ${label}`, make, { internal: { kind: "shader", what: label } });
    });
  }

  #group(made, group) {
    const resource = (binding) => {
      const [kind, of] = variant(binding);
      switch (kind) {
        case "Buffer":
          return { buffer: made.buffers[of.buffer], offset: of.offset, size: of.size };
        case "View":
          return made.views[of];
        default:
          return made.samplers[of];
      }
    };
    return this.#device.createBindGroup({
      layout: made.layouts[group.layout].bindings,
      entries: group.entries.map(([binding, bound]) => ({ binding, resource: resource(bound) })),
    });
  }

  #bundle(made, bundle) {
    const encoder = this.#device.createRenderBundleEncoder({
      colorFormats: bundle.color,
      depthStencilFormat: bundle.depth_stencil ?? undefined,
      sampleCount: bundle.samples,
      depthReadOnly: bundle.read_only,
      stencilReadOnly: bundle.read_only,
    });
    for (const command of bundle.commands) {
      draw(made, encoder, command);
    }
    return encoder.finish();
  }

  #clockOf() {
    const { COPY_DST, COPY_SRC, MAP_READ, QUERY_RESOLVE } = GPUBufferUsage;
    this.#clock ??= {
      queries: this.#device.createQuerySet({ type: "timestamp", count: 2 }),
      resolved: this.#device.createBuffer({ size: CLOCK_BYTES, usage: QUERY_RESOLVE | COPY_SRC }),
      mapped: this.#device.createBuffer({ size: CLOCK_BYTES, usage: MAP_READ | COPY_DST }),
    };
    return this.#clock;
  }

  #record(made, encoder, commands, clock) {
    const rows = ({ buffer, offset, pitch }) => ({ buffer: made.buffers[buffer], offset, bytesPerRow: pitch });
    const part = ({ texture, level, origin, aspect }) => ({
      texture: made.textures[texture],
      mipLevel: level,
      origin,
      aspect,
    });
    for (const command of commands) {
      const [kind, of] = variant(command);
      switch (kind) {
        case "ClearBuffer":
          encoder.clearBuffer(made.buffers[of.buffer], 0, of.size);
          break;
        case "CopyBuffer":
          encoder.copyBufferToBuffer(made.buffers[of.from], 0, made.buffers[of.to], of.offset, of.size);
          break;
        case "Upload":
          encoder.copyBufferToTexture(rows(of.from), part(of.to), of.size);
          break;
        case "Download":
          encoder.copyTextureToBuffer(part(of.from), rows(of.to), of.size);
          break;
        case "CopyTexture":
          encoder.copyTextureToTexture(part(of.from), part(of.to), of.size);
          break;
        case "Resolve": {
          const set = made.querySets[of.set];
          encoder.resolveQuerySet(set, 0, set.count, made.buffers[of.buffer], of.offset);
          break;
        }
        case "Pass":
          pass(made, encoder, of, clock);
          break;
        default:
          throw new Failed("internal", "recording", `no command ${kind}`);
      }
    }
  }
}

/** Waits for `PAUSE` milliseconds. */
const pause = () =>
  new Promise((resolve) => {
    setTimeout(resolve, PAUSE);
  });

/** Returns the bytes of a list's output, which is mapped. */
function bytesOf(made) {
  const output = made.buffers[made.list.output];
  const bytes = new Uint8Array(output.getMappedRange()).slice(0, made.list.reading.bytes);
  output.unmap();
  return bytes;
}

/** Returns true if a command is a pass that is timed. */
const isTimed = (command) => (command.Pass?.timed ?? []).some(Boolean);

/** Returns a layout's entry for a binding. */
function layoutEntry({ binding, resource }) {
  const [kind, of] = variant(resource);
  const entry = { binding, visibility: GPUShaderStage.FRAGMENT };
  switch (kind) {
    case "Uniform":
      return { ...entry, buffer: { type: "uniform", hasDynamicOffset: true, minBindingSize: of } };
    case "Storage":
      return { ...entry, buffer: { type: "storage", minBindingSize: of } };
    case "Texture":
      return { ...entry, texture: { sampleType: of.sample_type, multisampled: of.multisampled } };
    default:
      return { ...entry, sampler: { type: "filtering" } };
  }
}

/** Returns the description of a pipeline. */
function descriptorOf(state, module, layout) {
  const { primitive, depth_stencil: depthStencil } = state;
  const descriptor = {
    label: state.label,
    layout,
    vertex: {
      module,
      entryPoint: state.vertex,
      buffers: state.buffers.map((buffer) => ({
        arrayStride: buffer.stride,
        stepMode: buffer.per_instance ? "instance" : "vertex",
        attributes: buffer.attributes.map(({ location, offset, floats }) => ({
          shaderLocation: location,
          offset,
          format: `float32x${floats}`,
        })),
      })),
    },
    primitive: {
      topology: primitive.topology,
      frontFace: primitive.front_face,
      cullMode: primitive.cull,
    },
    multisample: {
      count: state.samples,
      mask: state.mask,
      alphaToCoverageEnabled: state.alpha_to_coverage,
    },
  };
  if (primitive.strip_index !== null) {
    descriptor.primitive.stripIndexFormat = primitive.strip_index;
  }
  if (primitive.unclipped_depth) {
    // Only devices with `depth-clip-control` know this member.
    descriptor.primitive.unclippedDepth = true;
  }
  if (depthStencil !== null) {
    descriptor.depthStencil = depthStencilOf(depthStencil);
  }
  if (state.fragment !== null) {
    descriptor.fragment = { module, entryPoint: state.fragment, targets: state.targets.map(target) };
  }
  return descriptor;
}

function depthStencilOf(state) {
  const { stencil } = state;
  const descriptor = { format: state.format };
  if (state.depth_write !== null) {
    descriptor.depthWriteEnabled = state.depth_write;
    descriptor.depthCompare = state.depth_compare;
  }
  const { constant, slope, clamp } = state.bias;
  if (constant !== 0 || slope !== 0 || clamp !== 0) {
    Object.assign(descriptor, {
      depthBias: constant,
      depthBiasSlopeScale: floatOf(slope),
      depthBiasClamp: floatOf(clamp),
    });
  }
  if (stencil !== null) {
    const face = ({ compare, fail_op: failOp, depth_fail_op: depthFailOp, pass_op: passOp }) => ({
      compare,
      failOp,
      depthFailOp,
      passOp,
    });
    Object.assign(descriptor, {
      stencilFront: face(stencil.front),
      stencilBack: face(stencil.back),
      stencilReadMask: stencil.front.read_mask,
      stencilWriteMask: stencil.front.write_mask,
    });
  }
  return descriptor;
}

/** Returns a target, or `null` for a location without an attachment. */
function target(state) {
  if (state === null) {
    return null;
  }
  const { format, blend, write_mask: writeMask } = state;
  const component = ({ operation, src_factor: srcFactor, dst_factor: dstFactor }) => ({
    operation,
    srcFactor,
    dstFactor,
  });
  const described = { format, writeMask };
  if (blend !== null) {
    described.blend = { color: component(blend.color), alpha: component(blend.alpha) };
  }
  return described;
}

/** Records a render pass. */
function pass(made, encoder, described, clock) {
  const descriptor = {
    colorAttachments: described.color.map((color) => colorAttachment(made, color)),
  };
  if (described.depth_stencil !== null) {
    descriptor.depthStencilAttachment = depthStencilAttachment(made, described.depth_stencil);
  }
  if (described.occlusion !== null) {
    descriptor.occlusionQuerySet = made.querySets[described.occlusion];
  }
  const [begins, ends] = described.timed;
  if (clock !== null && (begins || ends)) {
    descriptor.timestampWrites = { querySet: clock.queries };
    if (begins) {
      descriptor.timestampWrites.beginningOfPassWriteIndex = 0;
    }
    if (ends) {
      descriptor.timestampWrites.endOfPassWriteIndex = 1;
    }
  }
  const rendering = encoder.beginRenderPass(descriptor);
  for (const command of described.commands) {
    inPass(made, rendering, command);
  }
  rendering.end();
}

/** Returns a colour attachment, or `null` for a location without an attachment. */
function colorAttachment(made, color) {
  if (color === null) {
    return null;
  }
  const { clear, store } = color.operations;
  const attachment = {
    view: made.views[color.view],
    loadOp: clear === null ? "load" : "clear",
    storeOp: store ? "store" : "discard",
  };
  if (clear !== null) {
    attachment.clearValue = clear;
  }
  if (color.depth_slice !== null) {
    attachment.depthSlice = color.depth_slice;
  }
  if (color.resolve !== null) {
    attachment.resolveTarget = made.views[color.resolve];
  }
  return attachment;
}

function depthStencilAttachment(made, attachment) {
  const described = { view: made.views[attachment.view] };
  for (const aspect of ["depth", "stencil"]) {
    const [access, operations] = variant(attachment[aspect]);
    if (access === "ReadOnly") {
      described[`${aspect}ReadOnly`] = true;
    } else if (access === "Written") {
      const { clear, store } = operations;
      described[`${aspect}LoadOp`] = clear === null ? "load" : "clear";
      described[`${aspect}StoreOp`] = store ? "store" : "discard";
      if (clear !== null) {
        described[`${aspect}ClearValue`] = clear;
      }
    }
  }
  return described;
}

/** Records a command in a pass. */
function inPass(made, encoder, command) {
  const [kind, of] = variant(command);
  switch (kind) {
    case "SetViewport":
      encoder.setViewport(...of.rect, ...of.depth);
      break;
    case "SetScissorRect":
      encoder.setScissorRect(...of);
      break;
    case "SetBlendConstant":
      encoder.setBlendConstant(of);
      break;
    case "SetStencilReference":
      encoder.setStencilReference(of);
      break;
    case "Begin":
      encoder.beginOcclusionQuery(of.index);
      break;
    case "End":
      encoder.endOcclusionQuery();
      break;
    case "Execute":
      encoder.executeBundles([made.bundles[of]]);
      break;
    case "Draw":
      draw(made, encoder, of);
      break;
    default:
      throw new Failed("internal", "recording", `no command ${kind}`);
  }
}

/** Records a command in a pass or a bundle. */
function draw(made, encoder, command) {
  const [kind, of] = variant(command);
  const count = ({ start, end }) => end - start;
  switch (kind) {
    case "SetPipeline":
      encoder.setPipeline(made.pipelines[of]);
      break;
    case "SetBindGroup":
      encoder.setBindGroup(0, made.groups[of.group], of.offset === null ? [] : [of.offset]);
      break;
    case "SetVertexBuffer":
      encoder.setVertexBuffer(of.slot, made.buffers[of.buffer], of.place.start, count(of.place));
      break;
    case "SetIndexBuffer":
      encoder.setIndexBuffer(made.buffers[of.buffer], of.format, of.place.start, count(of.place));
      break;
    case "Draw":
      encoder.draw(count(of.vertices), count(of.instances), of.vertices.start, of.instances.start);
      break;
    case "DrawIndexed":
      encoder.drawIndexed(
        count(of.indices),
        count(of.instances),
        of.indices.start,
        of.base_vertex,
        of.instances.start,
      );
      break;
    case "DrawIndirect":
      encoder.drawIndirect(made.buffers[of.buffer], of.offset);
      break;
    case "DrawIndexedIndirect":
      encoder.drawIndexedIndirect(made.buffers[of.buffer], of.offset);
      break;
    default:
      throw new Failed("internal", "recording", `no command ${kind}`);
  }
}
