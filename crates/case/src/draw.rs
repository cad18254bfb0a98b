//! Draws: applies defaults, resolves names to indices, and refuses impossible states.

use crate::attachment::{MAX_SIZE, check_integer_value, find};
use crate::error::At;
use crate::fetch::fetch;
use crate::wire::{DrawWire, StencilFaceWire, StencilWire};
use etalon_frame::{Aspect, CounterKind, TextureFormat};
use etalon_scene::{
    Attachment, AttachmentContents, ColorTarget, Counter, Draw, EarlyTests, MAX_VERTICES, Mesh,
    Multisample, Params, Pass, PolygonMode, Pool, PrimitiveTopology, RESTART, Shader, StencilFace,
    StencilOperation, StencilState, Viewport,
};

/// The attachments that a draw draws to, and the names that it can use.
pub(crate) struct DrawTarget<'a> {
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    /// Indices of the colour attachments.
    pub(crate) color: &'a [usize],
    pub(crate) depth_stencil: Option<TextureFormat>,
    /// Index of the depth-stencil attachment.
    pub(crate) tested: Option<usize>,
    /// Indices of all attachments that the pass draws or resolves to.
    pub(crate) bound: &'a [usize],
    pub(crate) attachments: &'a [Attachment],
    pub(crate) counters: &'a [Counter],
    pub(crate) pool: Option<Pool>,
}

/// Returns the draw that a case file describes. It checks one key after the other, so the first wrong key is reported.
pub(crate) fn draw(wire: &DrawWire, target: &DrawTarget<'_>) -> Result<Draw, At> {
    let DrawTarget {
        size,
        depth_stencil,
        ..
    } = *target;
    let viewport = viewport(wire, size)?;
    let mut mesh = wire
        .mesh
        .expand(viewport_texels(&viewport))
        .map_err(|message| At::new(message).key("mesh"))?;
    if mesh.vertices.is_empty() || mesh.vertices.len() > MAX_VERTICES {
        return Err(At::new(format!("a mesh has 1 to {MAX_VERTICES} vertices")).key("mesh"));
    }
    if wire.w.is_empty() {
        return Err(At::new("`w` must not be empty").key("w"));
    }
    for (vertex, w) in mesh.vertices.iter_mut().zip(wire.w.iter().cycle()) {
        vertex.position = vertex.position.map(|v| v * w);
    }
    check_outlines(wire.polygon_mode, &mesh).map_err(|e| e.key("polygon_mode"))?;
    let (mesh, fetch) = fetch(mesh, wire.topology, wire.fetch, wire.instances.as_ref())?;
    check_vertices(&mesh, wire.shader).map_err(|e| e.key("mesh"))?;
    if wire.depth.is_some() && !depth_stencil.is_some_and(TextureFormat::has_depth) {
        return Err(At::new("a depth test needs a depth attachment").key("depth"));
    }
    if wire.stencil.is_some() && !depth_stencil.is_some_and(TextureFormat::has_stencil) {
        return Err(At::new("a stencil test needs a stencil attachment").key("stencil"));
    }
    let textures = textures(wire, target).map_err(|e| e.key("textures"))?;
    check_sampler(wire, target, &textures).map_err(|e| e.key("sampler"))?;
    check_tessellation(wire, &mesh).map_err(|e| e.key("tessellation"))?;
    check_clip_distances(wire)?;
    check_pool(wire, target)?;
    let counters = counters(wire, target.counters).map_err(|e| e.key("counters"))?;
    if wire.early_tests.is_conservative() && !wire.shader.writes_depth() {
        let message = "a conservative depth needs a shader that writes depth";
        return Err(At::new(message).key("early_tests"));
    }
    check_multisample(&wire.multisample).map_err(|e| e.key("multisample"))?;
    let color_targets = color_targets(wire, target.color.len())?;
    check_shader(wire, &color_targets)?;
    check_advanced(wire, target).map_err(|e| e.key("advanced_blend"))?;
    check_integers(wire, target, &color_targets)?;
    if let Some([low, high]) = wire.depth_bounds
        && !(0.0 <= low && low <= high && high <= 1.0)
    {
        return Err(At::new("bounds must be between 0 and 1, the lower first").key("depth_bounds"));
    }
    for (key, color) in [
        ("params", wire.params.color),
        ("params", wire.params.back_color),
        ("blend_constant", wire.blend_constant),
    ] {
        if color.0.iter().any(|v| !v.is_finite()) {
            return Err(At::new("a number does not fit into a 32-bit float").key(key));
        }
    }
    Ok(Draw {
        fetch,
        topology: wire.topology,
        tessellation: wire.tessellation,
        provoking: wire.provoking,
        params: Params {
            color: wire.params.color.0,
            back_color: wire.params.back_color.0,
        },
        early_tests: wire.early_tests,
        textures,
        sampler: wire.sampler,
        counters,
        cull: wire.cull,
        front_face: wire.front_face,
        polygon_mode: wire.polygon_mode,
        rasterizer_discard: wire.rasterizer_discard,
        scissor: wire.scissor,
        clip_distances: wire.clip_distances,
        depth_bias: wire.depth_bias,
        depth_clamp: wire.depth_clamp,
        depth_bounds: wire.depth_bounds,
        depth: wire.depth,
        stencil: wire.stencil.as_ref().map(stencil),
        targets: color_targets,
        logic: wire.logic,
        multisample: wire.multisample,
        blend_constant: wire.blend_constant.0,
        ..Draw::new(wire.shader, mesh, viewport)
    })
}

/// The greatest magnitude of a clip-space coordinate: every API's floats can represent it (OpenGL 3.3,
/// 2.1.1).
const FARTHEST: f32 = 4_294_967_296.0;

/// The greatest magnitude of texture coordinates.
const FARTHEST_UV: f32 = 64.0;

/// Checks the state that decides which samples are drawn.
fn check_multisample(state: &Multisample) -> Result<(), At> {
    let share = |v: f32| (0.0..=1.0).contains(&v);
    if !state.min_sample_shading.is_none_or(share) {
        let message = "a share of the samples must be between 0 and 1";
        return Err(At::new(message).key("min_sample_shading"));
    }
    if !state.sample_coverage.is_none_or(|c| c.value.is_finite()) {
        let message = "a share of the samples must be a finite number";
        return Err(At::new(message).key("value").key("sample_coverage"));
    }
    Ok(())
}

/// Checks that patches are whole triangles, and that no attribute would have to pass through the tessellator.
fn check_tessellation(wire: &DrawWire, mesh: &Mesh) -> Result<(), At> {
    if wire.tessellation.is_none() {
        return Ok(());
    }
    if wire.topology != PrimitiveTopology::TriangleList {
        return Err(At::new("tessellation requires `triangle-list`"));
    }
    let count = mesh.indices.as_ref().map_or(mesh.vertices.len(), Vec::len);
    if !count.is_multiple_of(3) || mesh.indices.iter().flatten().any(|i| *i == RESTART) {
        return Err(At::new(
            "patches must have three vertices each, without restarts between them",
        ));
    }
    if !wire.shader.passes_position_alone() {
        return Err(At::new(format!(
            "the evaluation shader passes on only positions, but shader {} reads attributes",
            wire.shader.name()
        )));
    }
    Ok(())
}

/// Checks that enabled clip distances exist, and that no outline is clipped: no specification says which
/// edges of a clipped polygon are drawn.
fn check_clip_distances(wire: &DrawWire) -> Result<(), At> {
    let count = wire.shader.clip_distances();
    if wire.clip_distances != u8::MAX && u32::from(wire.clip_distances) >> count != 0 {
        let message = format!("shader {} has {count} clip distances", wire.shader.name());
        return Err(At::new(message).key("clip_distances"));
    }
    if count > 0 && wire.polygon_mode != PolygonMode::Fill {
        let message = "no specification defines the outline of a polygon clipped by distances";
        return Err(At::new(message).key("polygon_mode"));
    }
    if count > 0 && wire.instances.is_some() {
        let message = "clip distances come from the vertex colour, but instances have their own";
        return Err(At::new(message).key("instances"));
    }
    Ok(())
}

/// Checks that no outline reaches behind the eye: no specification says which edges of a clipped polygon are
/// drawn.
fn check_outlines(mode: PolygonMode, mesh: &Mesh) -> Result<(), At> {
    let behind = mesh.vertices.iter().any(|v| v.position[3] <= 0.0);
    if mode != PolygonMode::Fill && behind {
        return Err(At::new(
            "no specification defines the outline of a polygon that reaches behind the eye",
        ));
    }
    Ok(())
}

/// Returns the indices of the attachments that the shader reads.
fn textures(wire: &DrawWire, target: &DrawTarget<'_>) -> Result<Vec<usize>, At> {
    let each = wire.textures.iter().enumerate();
    let textures: Vec<usize> = each
        .map(|(i, name)| texture(name, wire.shader, target).map_err(|e| e.index(i)))
        .collect::<Result<_, _>>()?;
    let first = textures.first().map(|index| &target.attachments[*index]);
    if wire.shader.writes_mask() {
        check_masks(first)?;
    }
    if wire.shader.writes_reference() {
        check_references(first)?;
    }
    if textures.len() != wire.shader.textures() {
        return Err(At::new(format!(
            "shader {} reads {} textures, {} are given",
            wire.shader.name(),
            wire.shader.textures(),
            textures.len()
        )));
    }
    Ok(textures)
}

/// Returns the index of an attachment that the shader can read.
fn texture(name: &str, shader: Shader, target: &DrawTarget<'_>) -> Result<usize, At> {
    let index = find(name, target.attachments)?;
    let attachment = &target.attachments[index];
    let refuse = |message: &str| Err(At::new(format!("`{name}` {message}")));
    if target.color.contains(&index) || target.tested == Some(index) {
        return own_texture(name, shader, attachment).map(|()| index);
    }
    if shader.reads_sample() || shader.reads_stencil() {
        return refuse(
            "is not part of the pass, and the shader reads samples or stencil of its own pass",
        );
    }
    if !attachment.format.is_color() || attachment.samples != 1 {
        return refuse("is not a single-sample colour attachment, so it cannot be read");
    }
    if target.bound.contains(&index) {
        return refuse("is a resolve target of the pass, so it cannot be read");
    }
    if attachment.format.is_integer() {
        return refuse("has integers, but the shader reads floats");
    }
    if !shader.samples_texture() && attachment.size != target.size {
        return refuse("differs in size from the pass's attachments");
    }
    Ok(index)
}

/// Checks that the shader can read an attachment of its own pass.
fn own_texture(name: &str, shader: Shader, attachment: &Attachment) -> Result<(), At> {
    let refuse = |message: &str| Err(At::new(format!("`{name}` {message}")));
    if shader.samples_texture() {
        return refuse("belongs to the pass itself, where a shader can read only its own texel");
    }
    if shader.writes_mask() || shader.writes_reference() {
        return refuse("belongs to the pass itself, but masks and references must be uploaded");
    }
    if shader.reads_sample() != (attachment.samples > 1) {
        return refuse("has another number of samples than the shader reads");
    }
    if shader.reads_stencil() {
        return match attachment.format.has_stencil() {
            true => Ok(()),
            false => refuse("has no stencil, which the shader reads"),
        };
    }
    if attachment.format.is_integer() || attachment.format == TextureFormat::Stencil8 {
        return refuse("has integers, but the shader reads floats");
    }
    Ok(())
}

/// Checks that a draw with attachments of its own pass as textures changes only what it does not read, or
/// colours, which it changes after it has read them.
pub(crate) fn check_own_reads(
    draw: &Draw,
    pass: &Pass,
    attachments: &[Attachment],
) -> Result<(), At> {
    if !draw.reads_own(pass) {
        return Ok(());
    }
    if !draw.textures.iter().all(|index| pass.attaches(*index)) {
        return Err(At::new(
            "attachments of the pass and other attachments cannot be read by one draw",
        ));
    }
    let changes = |aspect: Aspect| match aspect {
        Aspect::Color => false,
        Aspect::Depth => draw.depth.is_some_and(|d| d.write),
        Aspect::Stencil => changes_stencil(draw),
    };
    let aspect = |index: &usize| draw.aspect_read(attachments[*index].format);
    if draw.textures.iter().map(aspect).any(changes) {
        return Err(At::new(
            "a draw cannot read the depth or stencil that it changes: the tests can precede the shader",
        ));
    }
    Ok(())
}

/// Checks how a texture is sampled.
fn check_sampler(wire: &DrawWire, target: &DrawTarget<'_>, textures: &[usize]) -> Result<(), At> {
    match (wire.sampler, wire.shader.samples_texture()) {
        (None, false) => return Ok(()),
        (Some(_), false) => {
            return Err(At::new(format!(
                "shader {} fetches single texels",
                wire.shader.name()
            )));
        }
        (None, true) => {
            return Err(At::new(format!(
                "shader {} samples its texture: it needs a filter and address modes",
                wire.shader.name()
            )));
        }
        (Some(_), true) => {}
    }
    let triangles = [
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
    ];
    if !triangles.contains(&wire.topology) || wire.polygon_mode != PolygonMode::Fill {
        return Err(At::new("only filled triangles can sample textures"));
    }
    if target.samples > 1 {
        return Err(At::new(
            "with several samples, attributes may be those of any point of the texel; use a single sample",
        ));
    }
    let format = |t: &usize| target.attachments[*t].format;
    if !textures
        .iter()
        .map(format)
        .all(TextureFormat::is_filterable)
    {
        return Err(At::new(
            "not every driver can filter 32-bit floats, and none filters integers",
        ));
    }
    Ok(())
}

/// Checks that a shader that uses the pool has a pool of its pass's size, and parameters that say so.
fn check_pool(wire: &DrawWire, target: &DrawTarget<'_>) -> Result<(), At> {
    if !wire.shader.uses_pool() {
        return Ok(());
    }
    let name = wire.shader.name();
    if target.pool.is_none_or(|pool| pool.size != target.size) || target.samples > 1 {
        let message = format!("{name} needs a pool of the pass's size, and a single sample");
        return Err(At::new(message).key("shader"));
    }
    let [width, height, layers, _] = wire.params.color.0;
    if [width, height] != target.size.map(|side| side as f32) {
        let message = format!("for {name}, red and green must be the size of the picture");
        return Err(At::new(message).key("color").key("params"));
    }
    let expected = target.pool.map_or(0, |pool| pool.layers);
    if wire.shader.uses_layers() != (expected > 0) {
        let needs = if expected > 0 { "lists" } else { "layers" };
        let message = format!("{name} does not fit the pool: it needs one with {needs}");
        return Err(At::new(message).key("shader"));
    }
    if wire.shader.uses_layers() && layers != expected as f32 {
        let message = format!("for {name}, blue must be the number of layers");
        return Err(At::new(message).key("color").key("params"));
    }
    Ok(())
}

/// Returns the counters that a draw adds to.
fn counters(wire: &DrawWire, available: &[Counter]) -> Result<Vec<usize>, At> {
    let mut result: Vec<usize> = Vec::new();
    for (i, name) in wire.counters.iter().enumerate() {
        let check = || -> Result<usize, At> {
            let found = available.iter().position(|c| &c.name == name);
            let index = found.ok_or_else(|| At::new(format!("there is no counter `{name}`")))?;
            let kind = available[index].kind;
            let clash = |other: &usize| {
                let other = available[*other].kind;
                other == kind || (other.is_occlusion() && kind.is_occlusion())
            };
            if result.iter().any(clash) {
                return Err(At::new(
                    "a draw can have one counter of each kind, and one occlusion query",
                ));
            }
            Ok(index)
        };
        result.push(check().map_err(|e| e.index(i))?);
    }
    let runs = |i: &usize| available[*i].kind == CounterKind::ShaderRuns;
    if result.iter().any(runs) != wire.shader.counts_runs() {
        return Err(At::new(format!(
            "a counter of shader runs needs a shader that counts its runs, and such a shader needs one; \
             {} is asked for",
            wire.shader.name()
        )));
    }
    Ok(result)
}

/// Checks that only shaders that write integers write to integer formats, without blending.
fn check_integers(
    wire: &DrawWire,
    target: &DrawTarget<'_>,
    targets: &[ColorTarget],
) -> Result<(), At> {
    for (index, color) in target.color.iter().zip(targets) {
        let format = target.attachments[*index].format;
        if format.is_integer() != wire.shader.writes_integers() {
            return Err(At::new(format!(
                "shader {} does not write the type of {format}",
                wire.shader.name()
            ))
            .key("shader"));
        }
        if format.is_integer() && color.blend.is_some() {
            return Err(At::new("integers cannot be blended").key("blend"));
        }
        check_integer_value(format, wire.params.color.0)
            .map_err(|at| at.key("color").key("params"))?;
    }
    Ok(())
}

/// Refuses inputs whose effect no specification defines: vertices too far away, and written depths outside 0 to
/// 1.
fn check_vertices(mesh: &Mesh, shader: Shader) -> Result<(), At> {
    for vertex in &mesh.vertices {
        if vertex
            .position
            .iter()
            .any(|v| v.is_nan() || v.abs() > FARTHEST)
        {
            return Err(At::new(format!(
                "coordinates in clip space must be between -{FARTHEST} and {FARTHEST}"
            )));
        }
        let [x, y, _, w] = vertex.position;
        if [x, y, w] == [0.0; 3] {
            return Err(At::new(
                "a vertex at the eye has no position in the picture",
            ));
        }
        if vertex.uv.iter().any(|v| v.abs() > FARTHEST_UV) {
            return Err(At::new(format!(
                "texture coordinates must be between -{FARTHEST_UV} and {FARTHEST_UV}"
            ))
            .key("uv"));
        }
        if shader == Shader::Centroid && vertex.uv[0] < 0.0 {
            let message = "the shader `centroid` requires a non-negative first texture coordinate";
            return Err(At::new(message).key("uv"));
        }
        let written = shader.depth_from_vertex_color();
        if written && !(0.0..=1.0).contains(&vertex.color[0]) {
            return Err(At::new("a written depth must be between 0 and 1"));
        }
    }
    Ok(())
}

/// Checks the texture that gives a shader its sample mask, and perhaps its depth.
fn check_masks(texture: Option<&Attachment>) -> Result<(), At> {
    let Some(texture) = texture else {
        return Ok(());
    };
    let texels = match &texture.contents {
        AttachmentContents::Texels(texels) if texture.format == TextureFormat::Rgba32Float => {
            texels
        }
        _ => {
            let message = "a sample mask must come from uploaded texels of rgba32float";
            return Err(At::new(message));
        }
    };
    let fits = |texel: &[u32]| {
        let (mask, depth) = (f32::from_bits(texel[0]), f32::from_bits(texel[1]));
        mask.fract() == 0.0 && (0.0..=65535.0).contains(&mask) && (0.0..=1.0).contains(&depth)
    };
    if texels.chunks_exact(4).all(fits) {
        return Ok(());
    }
    Err(At::new(
        "a sample mask must be an integer from 0 to 65535, and a written depth between 0 and 1",
    ))
}

/// Checks the texture that gives a shader its stencil references, and perhaps its depth.
fn check_references(texture: Option<&Attachment>) -> Result<(), At> {
    const MAX_REFERENCE: f32 = 65535.0;
    let Some(texture) = texture else {
        return Ok(());
    };
    let texels = match &texture.contents {
        AttachmentContents::Texels(texels) if texture.format == TextureFormat::Rgba32Float => {
            texels
        }
        _ => {
            let message = "a stencil reference must come from uploaded texels of rgba32float";
            return Err(At::new(message));
        }
    };
    let fits = |texel: &[u32]| {
        let [front, depth, _, back] = [0, 1, 2, 3].map(|c| f32::from_bits(texel[c]));
        let is_integer = |v: f32| v.fract() == 0.0 && v.abs() <= MAX_REFERENCE;
        is_integer(front) && is_integer(back) && (0.0..=1.0).contains(&depth)
    };
    if texels.chunks_exact(4).all(fits) {
        return Ok(());
    }
    Err(At::new(
        "a stencil reference must be an integer from -65535 to 65535, and a written depth between 0 and 1",
    ))
}

/// Returns true if a draw can change depth or stencil.
pub(crate) fn writes_depth_stencil(draw: &Draw) -> bool {
    draw.depth.is_some_and(|d| d.write) || changes_stencil(draw)
}

/// Returns true if a draw can change stencil.
fn changes_stencil(draw: &Draw) -> bool {
    let changes = |face: &StencilFace| {
        let operations = [face.fail_op, face.depth_fail_op, face.pass_op];
        face.write_mask != 0 && operations.iter().any(|o| *o != StencilOperation::Keep)
    };
    draw.stencil
        .is_some_and(|s| changes(&s.front) || changes(&s.back))
}

/// Returns the bits of a write mask's letters: bit 0 is red, bit 3 alpha.
pub(crate) fn write_mask(letters: &str) -> Result<u8, At> {
    let mut mask = 0;
    for letter in letters.chars() {
        match "rgba".find(letter) {
            Some(bit) if mask & (1 << bit) == 0 => mask |= 1 << bit,
            _ => {
                return Err(At::new(
                    "a write mask consists of the letters r, g, b, a, each at most once",
                ));
            }
        }
    }
    Ok(mask)
}

fn color_targets(wire: &DrawWire, count: usize) -> Result<Vec<ColorTarget>, At> {
    let target = |blend, letters: &str| -> Result<ColorTarget, At> {
        Ok(ColorTarget {
            blend,
            advanced: wire.advanced_blend,
            write_mask: write_mask(letters).map_err(|e| e.key("write_mask"))?,
        })
    };
    let Some(list) = &wire.targets else {
        return Ok(vec![target(wire.blend, &wire.write_mask)?; count]);
    };
    if wire.blend.is_some() || wire.write_mask != "rgba" {
        return Err(At::new("`targets` excludes `blend` and `write_mask`").key("targets"));
    }
    if list.len() != count {
        return Err(At::new(format!(
            "{} targets are given, the pass has {count} colour attachments",
            list.len()
        ))
        .key("targets"));
    }
    let each = list.iter().enumerate();
    each.map(|(i, t)| target(t.blend, &t.write_mask).map_err(|e| e.index(i).key("targets")))
        .collect()
}

/// Checks the target of advanced blending, and the state that it excludes.
fn check_advanced(wire: &DrawWire, target: &DrawTarget<'_>) -> Result<(), At> {
    if wire.advanced_blend.is_none() {
        return Ok(());
    }
    if wire.blend.is_some() || wire.targets.is_some() || wire.logic.is_some() {
        let message = "advanced blending excludes `blend`, `targets` and `logic`";
        return Err(At::new(message));
    }
    let [index] = target.color else {
        return Err(At::new(
            "advanced blending needs exactly one colour attachment",
        ));
    };
    if wire.shader.has_second_source() {
        return Err(At::new("advanced blending needs a single source"));
    }
    let format = target.attachments[*index].format;
    if format.is_integer() || format.is_snorm() {
        return Err(At::new(format!(
            "the modes are defined for values from 0 to 1, not for {format}"
        )));
    }
    Ok(())
}

fn check_shader(wire: &DrawWire, targets: &[ColorTarget]) -> Result<(), At> {
    if !wire.shader.has_fragment() {
        return check_shaderless(wire, targets);
    }
    if targets.len() > wire.shader.outputs() {
        return Err(At::new(format!(
            "shader {} writes {} colours, the pass has {} colour attachments",
            wire.shader.name(),
            wire.shader.outputs(),
            targets.len()
        ))
        .key("shader"));
    }
    let second = targets.iter().filter_map(|t| t.blend).any(|b| {
        [b.color, b.alpha]
            .iter()
            .any(|c| c.src_factor.is_second_source() || c.dst_factor.is_second_source())
    });
    if second && !wire.shader.has_second_source() {
        let message = "a factor of the second source needs a shader that writes one";
        return Err(At::new(message).key("shader"));
    }
    Ok(())
}

/// Refuses states that need a fragment shader's colours in a draw without one.
fn check_shaderless(wire: &DrawWire, targets: &[ColorTarget]) -> Result<(), At> {
    let refuse = |message: &str, key| Err(At::new(message.to_owned()).key(key));
    if targets.iter().any(|t| t.write_mask != 0) {
        let message = "without a fragment shader, colours are undefined: mask all channels";
        return refuse(message, "write_mask");
    }
    if targets.iter().any(|t| t.blend.is_some()) || wire.logic.is_some() {
        return refuse("without a fragment shader, nothing is blended", "shader");
    }
    if wire.multisample.alpha_to_coverage || wire.multisample.alpha_to_one {
        let message = "without a fragment shader, alpha is undefined";
        return refuse(message, "multisample");
    }
    if wire.early_tests != EarlyTests::Implicit {
        let message = "without a fragment shader, no test is early";
        return refuse(message, "early_tests");
    }
    Ok(())
}

/// Returns the viewport's width and height, in which meshes in texels are measured.
fn viewport_texels(viewport: &Viewport) -> [u32; 2] {
    let [_, _, width, height] = viewport.area();
    [width, height].map(|v| v.round().max(1.0) as u32)
}

/// Returns the viewport, by default the whole attachments.
fn viewport(wire: &DrawWire, size: [u32; 2]) -> Result<Viewport, At> {
    let viewport = wire.viewport.unwrap_or(Viewport::whole(size));
    let [x, y, w, h] = viewport.rect;
    let far = MAX_SIZE as f32;
    let fits = |v: f32| v.abs() <= far;
    if !(w > 0.0 && h != 0.0 && [x, y, w, h].into_iter().all(fits)) {
        let message = format!("a viewport needs a width and a height, neither above {MAX_SIZE}");
        return Err(At::new(message).key("rect").key("viewport"));
    }
    if viewport.depth.iter().any(|d| !(0.0..=1.0).contains(d)) {
        return Err(At::new("window depths must be between 0 and 1")
            .key("depth")
            .key("viewport"));
    }
    Ok(viewport)
}

fn stencil(wire: &StencilWire) -> StencilState {
    let face = |face: &StencilFaceWire| StencilFace {
        compare: face.compare,
        fail_op: face.fail_op,
        depth_fail_op: face.depth_fail_op,
        pass_op: face.pass_op,
        read_mask: face.read_mask.unwrap_or(wire.read_mask),
        write_mask: face.write_mask.unwrap_or(wire.write_mask),
        reference: face.reference.unwrap_or(wire.reference),
    };
    StencilState {
        front: face(&wire.front),
        back: face(wire.back.as_ref().unwrap_or(&wire.front)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolve::parse_scene;
    use crate::{CaseError, CaseFile, Profile};
    use etalon_scene::{AdvancedBlend, SampleCoverage};
    use serde_json::{Value, json};

    /// Returns the error of a draw with a texture of this format, all of whose texels have this value.
    fn fault(draw: Value, format: &str, texel: [f64; 4]) -> Option<At> {
        let values = [texel; 4];
        let scene = json!({
            "attachments": {
                "c": { "format": "rgba8unorm", "size": [4, 4] },
                "t": { "format": format, "size": [4, 4], "texels": { "kind": "rows", "values": values } }
            },
            "passes": [{ "color": ["c"], "draws": [draw] }], "read": ["c"]
        });
        parse_scene(&scene).err()
    }

    #[test]
    fn sample_masks_are_whole_numbers_of_uploaded_floats() {
        let draw =
            json!({ "mesh": { "kind": "full" }, "shader": "masked_depth", "textures": ["t"] });
        let faulty = |format, texel| fault(draw.clone(), format, texel).is_some();
        assert!(!faulty("rgba32float", [65535.0, 1.0, 0.0, 0.0]));
        assert!(faulty("rgba32float", [0.5, 1.0, 0.0, 0.0]));
        assert!(faulty("rgba32float", [-1.0, 1.0, 0.0, 0.0]));
        assert!(faulty("rgba32float", [1.0, 1.5, 0.0, 0.0]));
        assert!(faulty("rgba8unorm", [1.0, 1.0, 0.0, 0.0]));
    }

    #[test]
    fn a_draw_reads_its_own_pass_where_it_changes_nothing_it_reads() {
        let scene = |samples: u32, draw: Value| {
            let mut drawn = json!({ "mesh": { "kind": "full" } });
            let keys = draw.as_object().cloned().unwrap_or_default();
            keys.into_iter().for_each(|(key, value)| drawn[key] = value);
            parse_scene(&json!({
                "attachments": {
                    "c": { "format": "rgba8unorm", "size": [4, 4], "samples": samples },
                    "d": { "format": "depth24plus-stencil8", "samples": samples },
                    "t": { "format": "rgba8unorm" }
                },
                "passes": [{ "color": ["c"], "depth_stencil": "d", "draws": [drawn] }], "read": ["c"]
            }))
        };
        let depth = |write: bool| json!({ "compare": "less", "write": write });
        for (samples, draw) in [
            (1, json!({ "shader": "texel_color", "textures": ["c"] })),
            (
                1,
                json!({ "shader": "texel_color", "textures": ["d"], "depth": depth(false) }),
            ),
            (
                1,
                json!({ "shader": "texel_stencil", "textures": ["d"], "depth": depth(true) }),
            ),
            (
                4,
                json!({ "shader": "texel_sample", "textures": ["c"], "depth": depth(true) }),
            ),
        ] {
            assert!(scene(samples, draw.clone()).is_ok(), "{draw}");
        }
        for (samples, draw) in [
            (
                1,
                json!({ "shader": "texel_color", "textures": ["d"], "depth": depth(true) }),
            ),
            (1, json!({ "shader": "texel_stencil", "textures": ["c"] })),
            (1, json!({ "shader": "texel_stencil", "textures": ["t"] })),
            (1, json!({ "shader": "texel_sample", "textures": ["c"] })),
            (4, json!({ "shader": "texel_color", "textures": ["c"] })),
            (
                1,
                json!({ "shader": "texel_dual_source", "textures": ["c", "t"] }),
            ),
            (1, json!({ "shader": "masked_color", "textures": ["c"] })),
        ] {
            assert!(scene(samples, draw.clone()).is_err(), "{draw}");
        }
    }

    #[test]
    fn stencil_references_are_whole_numbers_of_uploaded_floats() {
        let draw =
            json!({ "mesh": { "kind": "full" }, "shader": "exported_depth", "textures": ["t"] });
        let faulty = |format, texel| fault(draw.clone(), format, texel).is_some();
        assert!(!faulty("rgba32float", [-65535.0, 1.0, 0.5, 65535.0]));
        assert!(faulty("rgba32float", [0.5, 1.0, 0.0, 0.0]));
        assert!(faulty("rgba32float", [65536.0, 1.0, 0.0, 0.0]));
        assert!(faulty("rgba32float", [1.0, 1.5, 0.0, 0.0]));
        assert!(faulty("rgba32float", [1.0, 1.0, 0.0, 0.5]));
        assert!(faulty("rgba8unorm", [1.0, 1.0, 0.0, 0.0]));
    }

    #[test]
    fn without_a_fragment_shader_nothing_asks_for_its_colours() {
        let draw = json!({ "mesh": { "kind": "full" }, "shader": "vertex_only", "write_mask": "" });
        let with = |key: &str, value: Value| {
            let mut draw = draw.clone();
            draw[key] = value;
            fault(draw, "rgba8unorm", [0.0; 4])
        };
        assert_eq!(with("cull", json!("none")), None);
        for (key, value) in [
            ("write_mask", json!("a")),
            ("logic", json!("xor")),
            ("early_tests", json!("forced")),
        ] {
            assert!(with(key, value).is_some(), "{key}");
        }
    }

    /// Returns the error of a scene with one draw.
    fn wrong(draw: Value) -> Option<At> {
        let scene = json!({
            "attachments": { "color": { "format": "rgba8unorm" } },
            "passes": [{ "color": ["color"], "draws": [draw] }],
            "read": ["color"]
        });
        parse_scene(&scene).err()
    }

    /// Returns the error at a key of the draw.
    fn at_draw(key: &str, message: &str) -> At {
        let draw = At::new(message).key(key).index(0).key("draws");
        draw.index(0).key("passes")
    }

    #[test]
    fn patches_are_triangles_without_attributes() {
        let draw = |shader: &str, topology: &str, indices: Value| {
            wrong(json!({
                "mesh": { "kind": "vertices", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], "indices": indices },
                "tessellation": { "order": "cw", "origin": "lower-left" },
                "topology": topology, "shader": shader
            }))
        };
        let two = json!([0, 1, 2, 2, 1, 3]);
        assert_eq!(draw("uniform_color", "triangle-list", two.clone()), None);
        let incomplete = "patches must have three vertices each, without restarts between them";
        for (shader, topology, indices, message) in [
            (
                "flat_color",
                "triangle-list",
                two.clone(),
                "the evaluation shader passes on only positions, but shader flat_color reads attributes",
            ),
            (
                "uniform_color",
                "triangle-strip",
                two,
                "tessellation requires `triangle-list`",
            ),
            (
                "uniform_color",
                "triangle-list",
                json!([0, 1, 2, 3]),
                incomplete,
            ),
            (
                "uniform_color",
                "triangle-list",
                json!([0, 1, 2, null, 1, 2]),
                incomplete,
            ),
        ] {
            let expected = at_draw("tessellation", message);
            assert_eq!(draw(shader, topology, indices), Some(expected));
        }
    }

    #[test]
    fn clip_distances_are_those_of_the_shader() {
        let draw = |keys: Value| {
            let mut draw = json!({ "mesh": { "kind": "full" }, "shader": "clip_flat" });
            for (key, value) in keys.as_object().into_iter().flatten() {
                draw[key] = value.clone();
            }
            wrong(draw)
        };
        for keys in [
            json!({}),
            json!({ "clip_distances": 0 }),
            json!({ "clip_distances": 3 }),
        ] {
            assert_eq!(draw(keys), None);
        }
        for (keys, key, message) in [
            (
                json!({ "clip_distances": 4 }),
                "clip_distances",
                "shader clip_flat has 2 clip distances",
            ),
            (
                json!({ "shader": "flat_color", "clip_distances": 1 }),
                "clip_distances",
                "shader flat_color has 0 clip distances",
            ),
            (
                json!({ "polygon_mode": "line" }),
                "polygon_mode",
                "no specification defines the outline of a polygon clipped by distances",
            ),
            (
                json!({ "instances": { "colors": [1] } }),
                "instances",
                "clip distances come from the vertex colour, but instances have their own",
            ),
        ] {
            assert_eq!(draw(keys), Some(at_draw(key, message)));
        }
    }

    #[test]
    fn invalid_shares_are_refused() {
        let shading = |share| Multisample {
            min_sample_shading: Some(share),
            ..Multisample::default()
        };
        let coverage = |value| Multisample {
            sample_coverage: Some(SampleCoverage {
                value,
                invert: true,
            }),
            ..Multisample::default()
        };
        assert!(check_multisample(&shading(1.0)).is_ok());
        assert!(check_multisample(&shading(1.5)).is_err());
        assert!(check_multisample(&shading(f32::NAN)).is_err());
        // OpenGL clamps the value.
        assert!(check_multisample(&coverage(-1.0)).is_ok());
        assert!(check_multisample(&coverage(f32::INFINITY)).is_err());
    }

    /// Builds a scene whose draw has these keys and draws to these attachments.
    fn build(color: &str, keys: &str) -> Result<etalon_scene::Scene, CaseError> {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"color":{{"format":"rgba8unorm","size":[4,4]}},
                "other":{{"format":"rgba8unorm"}},"signed":{{"format":"rgba8snorm"}},
                "integer":{{"format":"rgba8uint"}}}},
            "passes":[{{"color":{color},"draws":[{{"mesh":{{"kind":"full"}},{keys}}}]}}],
            "read":["color"]}}}}"#
        );
        let file = CaseFile::parse("t.json", &text)?;
        let case = file.cases(Profile::Full).next().expect("there is one");
        Ok(case.build()?.scene)
    }

    #[test]
    fn advanced_blending_takes_one_source_onto_one_attachment() {
        let flat = r#""shader":"flat_color","advanced_blend":"color-burn""#;
        let scene = build(r#"["color"]"#, flat).expect("it builds");
        let target = scene.passes[0].draws[0].targets[0];
        assert_eq!(target.advanced, Some(AdvancedBlend::ColorBurn));
        let two = r#""shader":"weighted_accumulate","advanced_blend":"screen""#;
        let uint = r#""shader":"uint_color","advanced_blend":"screen""#;
        let with = |keys: &str| format!("{flat},{keys}");
        let component = r#"{"operation":"add","src_factor":"one","dst_factor":"one"}"#;
        let blend = format!(r#""blend":{{"color":{component},"alpha":{component}}}"#);
        let excludes = "advanced blending excludes `blend`, `targets` and `logic`";
        for (color, keys, message) in [
            (r#"["color"]"#, with(r#""logic":"xor""#), excludes),
            (r#"["color"]"#, with(&blend), excludes),
            (r#"["color"]"#, with(r#""targets":[{}]"#), excludes),
            (
                r#"["color","other"]"#,
                two.to_owned(),
                "advanced blending needs exactly one colour attachment",
            ),
            (
                r#"["signed"]"#,
                flat.to_owned(),
                "the modes are defined for values from 0 to 1, not for rgba8snorm",
            ),
            (
                r#"["integer"]"#,
                uint.to_owned(),
                "the modes are defined for values from 0 to 1, not for rgba8uint",
            ),
        ] {
            let error = build(color, &keys).expect_err("it is refused");
            let key = "scene.passes[0].draws[0].advanced_blend";
            assert_eq!((&*error.key, &*error.message), (key, message));
        }
        let unknown = flat.replace("color-burn", "hue");
        assert!(build(r#"["color"]"#, &unknown).is_err());
    }
}
