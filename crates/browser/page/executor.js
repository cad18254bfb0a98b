// Executes lists of WebGPU calls. It knows nothing of scenes: a list names objects by their places in its tables, and
// commands in the order in which they are recorded (crates/webgpu/src/calls.rs).
"use strict";

/** The errors that a scope can catch, the most telling last: the first of these that caught one is reported. */
const FILTERS = ["out-of-memory", "internal", "validation"];

/** The most bytes of timestamps: the begin and the end of a frame. */
const CLOCK_BYTES = 16;

/** A failure of the device, as the relay reports it. */
class Failed extends Error {
  /**
   * @param {string} kind `lost`, `resource`, `shader` or `internal`
   * @param {string} what what was done
   * @param {string} message the device's words
   */
  constructor(kind, what, message) {
    super(message);
    this.kind = kind;
    this.what = what;
  }
}

/** Returns the name and the content of an enum's value that has a content. */
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

  /** Returns the object of a description, which `make` makes if it is new. */
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

/** A device, and what outlives a list on it. */
class Executor {
  #device;
  #timed;
  #shaders = new Cache();
  #layouts = new Cache();
  #pipelines = new Cache();
  #samplers = new Cache();
  #clock = null;
  #lost = null;

  /** @param {GPUDevice} device */
  constructor(device) {
    this.#device = device;
    this.#timed = device.features.has("timestamp-query");
    device.lost.then((info) => {
      this.#lost = info.message || "no message";
    });
  }

  /** Makes the objects of a list and fills its buffers with `contents`, a pair of a buffer's place and bytes each. */
  async prepare(list, contents) {
    const made = { list, begun: false };
    try {
      await this.#watched("making attachments", "resource", () => this.#memory(made, contents));
      for (const shader of list.shaders) {
        await this.#shader(shader);
      }
      made.layouts = list.layouts.map((entries) => this.#layout(entries));
      made.samplers = list.samplers.map((sampler) => this.#sampler(sampler));
      made.pipelines = [];
      for (const pipeline of list.pipelines) {
        made.pipelines.push(await this.#pipeline(list, pipeline));
      }
      await this.#watched("making bindings", "internal", () => {
        made.groups = list.groups.map((group) => this.#group(made, group));
        made.bundles = list.bundles.map((bundle) => this.#bundle(made, bundle));
      });
    } catch (error) {
      this.drop(made);
      throw error;
    }
    return made;
  }

  /** Draws a frame, and waits for the device. Returns its times in milliseconds. */
  async submit(made) {
    const { list } = made;
    const clock = this.#timed && list.frame.flat().some(isTimed) ? this.#clockOf() : null;
    const begin = performance.now();
    let submitted = begin;
    await this.#watched("drawing a scene", "internal", async () => {
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
      await this.#device.queue.onSubmittedWorkDone();
    });
    made.begun = true;
    const done = performance.now();
    const times = { cpu: submitted - begin, wall: done - begin, gpu: null };
    if (clock !== null) {
      await clock.mapped.mapAsync(GPUMapMode.READ);
      const [start, end] = new BigUint64Array(clock.mapped.getMappedRange());
      times.gpu = end >= start ? Number(end - start) / 1e6 : null;
      clock.mapped.unmap();
    }
    return times;
  }

  /** Returns the bytes of what a list reads back. */
  async read(made) {
    const { list } = made;
    const output = made.buffers[list.output];
    let bytes;
    await this.#watched("reading a frame back", "internal", async () => {
      const encoder = this.#device.createCommandEncoder();
      this.#record(made, encoder, list.read, null);
      this.#device.queue.submit([encoder.finish()]);
      await output.mapAsync(GPUMapMode.READ);
      bytes = new Uint8Array(output.getMappedRange()).slice(0, list.reading.bytes);
      output.unmap();
    });
    return bytes;
  }

  /** Destroys what belongs to a list alone. */
  drop(made) {
    for (const object of [...(made.textures ?? []), ...(made.buffers ?? []), ...(made.querySets ?? [])]) {
      object.destroy();
    }
  }

  /** Forgets everything that an error may have spoilt. */
  forget() {
    for (const cache of [this.#shaders, this.#layouts, this.#pipelines, this.#samplers]) {
      cache.clear();
    }
    this.#clock = null;
  }

  /** Runs an action and throws its first error. `kind` is the kind of the errors that no scope tells apart. */
  async #watched(what, kind, action) {
    if (this.#lost !== null) {
      throw new Failed("lost", what, this.#lost);
    }
    for (const filter of FILTERS) {
      this.#device.pushErrorScope(filter);
    }
    let thrown = null;
    try {
      await action();
    } catch (error) {
      thrown = error;
    }
    const caught = {};
    for (const filter of FILTERS.toReversed()) {
      try {
        caught[filter] = await this.#device.popErrorScope();
      } catch {
        // A lost device has no scopes.
      }
    }
    if (this.#lost !== null) {
      throw new Failed("lost", what, this.#lost);
    }
    if (caught["out-of-memory"]) {
      throw new Failed("resource", what, caught["out-of-memory"].message);
    }
    const found = caught.validation ?? caught.internal ?? thrown;
    if (found) {
      throw found instanceof Failed ? found : new Failed(kind, what, found.message);
    }
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

  async #shader(shader) {
    return this.#shaders.get(shader, async () => {
      let module;
      await this.#watched(shader.label, "shader", () => {
        module = this.#device.createShaderModule({ label: shader.label, code: shader.code });
      });
      return module;
    });
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

  async #pipeline(list, pipeline) {
    const entries = pipeline.layout === null ? [] : list.layouts[pipeline.layout];
    const shader = list.shaders[pipeline.shader];
    return this.#pipelines.get([shader, entries, pipeline.state], async () => {
      const module = await this.#shader(shader);
      const layout = this.#layout(entries).pipeline;
      try {
        return await this.#device.createRenderPipelineAsync(descriptorOf(pipeline.state, module, layout));
      } catch (error) {
        if (this.#lost !== null) {
          throw new Failed("lost", "making a pipeline", this.#lost);
        }
        // An internal error is of the shader, which the driver compiles now.
        const kind = error.reason === "internal" ? "shader" : "internal";
        const what = kind === "shader" ? pipeline.state.label : `a pipeline of ${pipeline.state.label}`;
        throw new Failed(kind, what, error.message);
      }
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

/** True if a command is a pass that is timed. */
const isTimed = (command) => (command.Pass?.timed ?? []).some(Boolean);

/** Returns a binding of a layout. */
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

function target({ format, blend, write_mask: writeMask }) {
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

function colorAttachment(made, color) {
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
