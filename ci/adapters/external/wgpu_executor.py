"""Draws the scenes of etalon's open protocol by wgpu (pip install wgpu numpy).

    { "name": "external:wgpu-py", "backend": "external", "command": ["python3", "wgpu_executor.py"] }

The argument `upside-down`, `srgb-twice` or `one-sample` makes a mistake, which `etalon conformance` must name.
"""

import base64
import json
import sys

import numpy as np
import wgpu

MISTAKES = set(sys.argv[1:])
COLORS = {  # bytes of a texel
    "r8unorm": 1, "rg8unorm": 2, "rgba8unorm": 4, "rgba8unorm-srgb": 4, "bgra8unorm": 4, "bgra8unorm-srgb": 4,
    "rgb10a2unorm": 4, "r16float": 2, "rg16float": 4, "rgba16float": 8,
    "r32float": 4, "rg32float": 8, "rgba32float": 16,
}
DEPTHS = ["depth16unorm", "depth24plus", "depth24plus-stencil8", "depth32float", "stencil8"]
FEATURES = ["centroid-interpolation", "depth-bias-clamp", "fractional-viewport", "independent-blend",
            "sample-interpolation", "sample-shading"]
USAGE = wgpu.TextureUsage

adapter = wgpu.gpu.request_adapter_sync(power_preference="high-performance")
device = adapter.request_device_sync()


class Unsupported(Exception):
    pass


def hello():
    is_float = lambda name: name.endswith("32float")
    # Samples are read by a shader, which would decode and encode sRGB.
    single = lambda name: is_float(name) or name.endswith("-srgb")
    formats = {name: {"samples": [1] if single(name) else [1, 4], "blendable": not is_float(name)} for name in COLORS}
    formats |= {name: {"samples": [1, 4]} for name in DEPTHS}
    return {
        "protocol": 1, "device": adapter.info["device"], "driver": "wgpu-py over " + adapter.info["backend_type"],
        "driver_version": wgpu.__version__, "software": adapter.info["adapter_type"] == "CPU", "rules": "webgpu",
        "max_size": 4096, "max_color_attachments": 2, "formats": formats, "features": FEATURES,
    }


def texture(format, size, samples):
    usage = USAGE.RENDER_ATTACHMENT | USAGE.TEXTURE_BINDING
    if samples == 1:
        usage |= USAGE.COPY_SRC | (USAGE.COPY_DST if format in COLORS else 0)
    return device.create_texture(size=(*size, 1), format=format, usage=usage, sample_count=samples)


def attached(attachment):
    """Makes a texture with the attachment's contents."""
    format, size = attachment["format"], attachment["size"]
    made = texture(format, size, attachment["samples"])
    if "texels" in attachment:
        rows = {"bytes_per_row": size[0] * COLORS[format], "rows_per_image": size[1]}
        device.queue.write_texture({"texture": made}, base64.b64decode(attachment["texels"]), rows, (*size, 1))
        return made
    encoder = device.create_command_encoder()
    aspects = {
        name: {"load": {"clear": attachment[name]}, "store": "store"} for name in ("depth", "stencil") if name in attachment
    }
    if format in COLORS:
        cleared = {"color_attachments": [color_attachment(made, {"load": {"clear": attachment["clear"]}, "store": "store"})]}
    else:
        cleared = {"color_attachments": [], "depth_stencil_attachment": depth_stencil_attachment(made, format, aspects)}
    encoder.begin_render_pass(**cleared).end()
    device.queue.submit([encoder.finish()])
    return made


def operation(operations):
    load = operations["load"]
    value = load["clear"] if isinstance(load, dict) else None
    return ("load" if value is None else "clear"), value, operations["store"]


def color_attachment(made, operations, target=None):
    load, value, store = operation(operations)
    attachment = {"view": made.create_view(), "load_op": load, "store_op": store, "clear_value": value or (0, 0, 0, 0)}
    return attachment | ({"resolve_target": target.create_view()} if target else {})


def depth_stencil_attachment(made, format, state):
    attachment = {"view": made.create_view()}
    for aspect, has in (("depth", format.startswith("depth")), ("stencil", "stencil" in format)):
        if has and state.get("read_only"):
            attachment[aspect + "_read_only"] = True
        elif has:
            load, value, store = operation(state[aspect])
            attachment |= {aspect + "_load_op": load, aspect + "_store_op": store, aspect + "_clear_value": value or 0}
    return attachment


def blended(component):
    names = {"constant-alpha": "constant", "one-minus-constant-alpha": "one-minus-constant"}
    factor = lambda name: names.get(component[name], component[name])
    return {"operation": component["operation"], "src_factor": factor("src_factor"), "dst_factor": factor("dst_factor")}


def pipeline(scene, scene_pass, draw, layout):
    format = lambda attachment: scene["attachments"][attachment]["format"]
    attachments = scene_pass["color"] + ([scene_pass["depth_stencil"]] if scene_pass["depth_stencil"] else [])
    module = device.create_shader_module(code=scene["shaders"][draw["shader"]]["wgsl"])
    attributes = [("float32x4", 0), ("float32x4", 16), ("float32x2", 32)]
    buffer = {"array_stride": 40, "attributes": [
        {"format": kind, "offset": offset, "shader_location": location} for location, (kind, offset) in enumerate(attributes)]}
    targets = []
    for color, target in zip(scene_pass["color"], draw["targets"]):
        blend = target["blend"] and {name: blended(target["blend"][name]) for name in ("color", "alpha")}
        targets.append({"format": format(color["attachment"]), "write_mask": target["write_mask"]} | ({"blend": blend} if blend else {}))
    primitive = {"topology": draw["topology"], "front_face": draw["front_face"], "cull_mode": draw["cull"]}
    if draw["indices"] is not None and draw["topology"].endswith("strip"):
        primitive["strip_index_format"] = "uint32"
    described = {"layout": layout, "primitive": primitive, "vertex": {"module": module, "entry_point": "vs", "buffers": [buffer]},
                 "fragment": {"module": module, "entry_point": "fs", "targets": targets}}
    multisample = draw["multisample"]
    described["multisample"] = {
        "count": scene["attachments"][attachments[0]["attachment"]]["samples"], "mask": multisample["mask"],
        "alpha_to_coverage_enabled": multisample["alpha_to_coverage"]}
    if scene_pass["depth_stencil"]:
        name, depth, stencil = format(scene_pass["depth_stencil"]["attachment"]), draw["depth"], draw["stencil"]
        state = {"format": name}
        if name.startswith("depth"):
            state["depth_write_enabled"] = bool(depth and depth["write"])
            state["depth_compare"] = depth["compare"] if depth else "always"
            if draw["topology"].startswith("triangle"):
                bias = draw["depth_bias"]
                state |= {"depth_bias": bias["constant"], "depth_bias_slope_scale": bias["slope"], "depth_bias_clamp": bias["clamp"]}
        if "stencil" in name and stencil:
            for face in ("front", "back"):
                state["stencil_" + face] = {key: stencil[face][key] for key in ("compare", "fail_op", "depth_fail_op", "pass_op")}
            state["stencil_read_mask"] = stencil["front"]["read_mask"]
            state["stencil_write_mask"] = stencil["front"]["write_mask"]
        described["depth_stencil"] = state
    return device.create_render_pipeline(**described)


def bindings(scene, textures, draw):
    """Returns the layout and the bind group of a draw."""
    layout, entries, visible = [], [], wgpu.ShaderStage.FRAGMENT
    if "@binding(0)" in scene["shaders"][draw["shader"]]["wgsl"]:
        params = np.float32(draw["params"]["color"] + draw["params"]["back_color"])
        block = device.create_buffer_with_data(data=params, usage=wgpu.BufferUsage.UNIFORM)
        layout.append({"binding": 0, "visibility": visible, "buffer": {"type": "uniform"}})
        entries.append({"binding": 0, "resource": {"buffer": block, "offset": 0, "size": 32}})
    for binding, index in enumerate(draw["textures"], 1):
        kind = "float" if draw["sampler"] else "unfilterable-float"
        layout.append({"binding": binding, "visibility": visible, "texture": {"sample_type": kind}})
        entries.append({"binding": binding, "resource": textures[index].create_view()})
    if draw["sampler"]:
        filter, (u, v) = draw["sampler"]["filter"], draw["sampler"]["address"]
        sampler = device.create_sampler(mag_filter=filter, min_filter=filter, address_mode_u=u, address_mode_v=v)
        layout.append({"binding": 4, "visibility": visible, "sampler": {}})
        entries.append({"binding": 4, "resource": sampler})
    group_layout = device.create_bind_group_layout(entries=layout)
    group = device.create_bind_group(layout=group_layout, entries=entries)
    return device.create_pipeline_layout(bind_group_layouts=[group_layout]), group


def draw_into(encoder, scene, scene_pass, textures, draw):
    layout, group = bindings(scene, textures, draw)
    encoder.set_pipeline(pipeline(scene, scene_pass, draw, layout))
    encoder.set_bind_group(0, group)
    encoder.set_viewport(*draw["viewport"]["rect"], *draw["viewport"]["depth"])
    attachments = scene_pass["color"] + ([scene_pass["depth_stencil"]] if scene_pass["depth_stencil"] else [])
    size = scene["attachments"][attachments[0]["attachment"]]["size"]
    encoder.set_scissor_rect(*(draw["scissor"] or [0, 0, *size]))
    encoder.set_blend_constant(draw["blend_constant"])
    if draw["stencil"]:
        encoder.set_stencil_reference(draw["stencil"]["front"]["reference"])
    vertices = base64.b64decode(draw["vertices"])
    if not vertices or draw["indices"] == []:
        return
    encoder.set_vertex_buffer(0, device.create_buffer_with_data(data=vertices, usage=wgpu.BufferUsage.VERTEX))
    if draw["indices"] is None:
        encoder.draw(len(vertices) // 40)
    else:
        data = np.uint32(draw["indices"])
        encoder.set_index_buffer(device.create_buffer_with_data(data=data, usage=wgpu.BufferUsage.INDEX), "uint32")
        encoder.draw_indexed(len(data))


def copied(made, size, texel):
    rows = {"bytes_per_row": size[0] * texel, "rows_per_image": size[1]}
    return np.frombuffer(device.queue.read_texture({"texture": made}, rows, (*size, 1)), np.uint8)


def fetched(made, size, aspect, samples, sample):
    """Returns the bytes of one sample, through a shader: depth as a float, stencil as a 32-bit integer."""
    several, coordinate = "_multisampled" if samples > 1 else "", sample if samples > 1 else 0
    format, kind, value = {
        "color": (made.format, f"texture{several}_2d<f32>", "t"),
        "depth": ("r32float", f"texture_depth{several}_2d", "vec4f(t)"),
        "stencil": ("r32uint", f"texture{several}_2d<u32>", "t"),
    }[aspect]
    output = "vec4u" if aspect == "stencil" else "vec4f"
    code = f"""@group(0) @binding(0) var image: {kind};
        @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
            return vec4f(f32(i & 1) * 4 - 1, f32(i >> 1) * 4 - 1, 0, 1);
        }}
        @fragment fn fs(@builtin(position) p: vec4f) -> @location(0) {output} {{
            let t = textureLoad(image, vec2i(p.xy), {coordinate});
            return {value};
        }}"""
    module, target = device.create_shader_module(code=code), texture(format, size, 1)
    types = {"color": "unfilterable-float", "depth": "depth", "stencil": "uint"}
    entry = {"binding": 0, "visibility": wgpu.ShaderStage.FRAGMENT, "texture": {"sample_type": types[aspect], "multisampled": samples > 1}}
    layout = device.create_bind_group_layout(entries=[entry])
    views = {"color": made.format, "depth": made.format.removesuffix("-stencil8"), "stencil": "stencil8"}
    view = {"format": views[aspect], "aspect": "all" if aspect == "color" else aspect + "-only"}
    group = device.create_bind_group(layout=layout, entries=[{"binding": 0, "resource": made.create_view(**view)}])
    made_pipeline = device.create_render_pipeline(
        layout=device.create_pipeline_layout(bind_group_layouts=[layout]), vertex={"module": module, "entry_point": "vs"},
        primitive={"topology": "triangle-list"}, fragment={"module": module, "entry_point": "fs", "targets": [{"format": format}]})
    encoder = device.create_command_encoder()
    cleared = color_attachment(target, {"load": {"clear": (0, 0, 0, 0)}, "store": "store"})
    fetch = encoder.begin_render_pass(color_attachments=[cleared])
    fetch.set_pipeline(made_pipeline)
    fetch.set_bind_group(0, group)
    fetch.draw(3)
    fetch.end()
    device.queue.submit([encoder.finish()])
    return copied(target, size, COLORS.get(format, 4))


def read(attachment, made, aspect):
    """Returns the texels of an aspect: rows, columns, samples, bytes."""
    size, samples = attachment["size"], attachment["samples"]
    if samples == 1 and aspect == "color":
        planes = [copied(made, size, COLORS[made.format])]
    else:
        chosen = [0] * samples if "one-sample" in MISTAKES else range(samples)
        planes = [fetched(made, size, aspect, samples, sample) for sample in chosen]
    texels = np.stack([plane.reshape(size[1], size[0], -1) for plane in planes], axis=2)
    if aspect == "stencil":
        texels = texels[..., :1]
    if "upside-down" in MISTAKES:
        texels = texels[::-1]
    if "srgb-twice" in MISTAKES and made.format.endswith("-srgb"):
        linear = texels / 255
        encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
        texels = np.concatenate([np.rint(encoded[..., :3] * 255), texels[..., 3:]], axis=-1).astype(np.uint8)
    return base64.b64encode(texels.tobytes()).decode()


def frame(scene):
    if scene["counters"]:
        raise Unsupported("counters")
    textures = [attached(attachment) for attachment in scene["attachments"]]
    for scene_pass in scene["passes"]:
        encoder = device.create_command_encoder()
        described = {"color_attachments": [
            color_attachment(textures[c["attachment"]], c, None if c["resolve"] is None else textures[c["resolve"]])
            for c in scene_pass["color"]]}
        if scene_pass["depth_stencil"]:
            made = textures[scene_pass["depth_stencil"]["attachment"]]
            described["depth_stencil_attachment"] = depth_stencil_attachment(made, made.format, scene_pass["depth_stencil"])
        commands = encoder.begin_render_pass(**described)
        for draw in scene_pass["draws"]:
            draw_into(commands, scene, scene_pass, textures, draw)
        commands.end()
        device.queue.submit([encoder.finish()])
    images = []
    for index in scene["read"]:
        attachment, made = scene["attachments"][index], textures[index]
        aspects = ["color"] if made.format in COLORS else [a for a in ("depth", "stencil") if a in made.format]
        images += [{"attachment": attachment["name"], "aspect": a, "texels": read(attachment, made, a)} for a in aspects]
    return {"images": images}


print(json.dumps(hello()), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    try:
        answer = {"frame": frame(request["scene"])}
    except Unsupported as what:
        answer = {"unsupported": str(what)}
    except (wgpu.GPUError, RuntimeError) as error:
        answer = {"error": {"kind": "internal", "message": str(error)}}
    print(json.dumps({"number": request["number"]} | answer), flush=True)
