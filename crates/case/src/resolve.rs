//! Scenes and passes: applies defaults, resolves names to indices, and refuses impossible states.

use crate::attachment::{attachment, default_size, find};
use crate::draw::{DrawTarget, check_own_reads, draw, writes_depth_stencil};
use crate::error::At;
use crate::pass_operations::{PassTarget, clears, operations};
use crate::path::check_path;
use crate::queries::check_queries;
use crate::tiles::tiles;
use crate::values::typed;
use crate::wire::{DepthStencilResolveWire, PassWire, SceneWire};
use etalon_scene::{Attachment, Counter, DepthStencilResolve, Pass, Pool, ResolveMode, Scene};
use serde_json::Value;

/// The maximum number of counters of a scene.
const MAX_COUNTERS: usize = 64;

/// The maximum number of draws of a scene in a file, before `tiles` multiplies them.
const MAX_DRAWS: usize = 1 << 16;

/// Parses and checks a scene.
pub(crate) fn parse_scene(value: &Value) -> Result<Scene, At> {
    scene(&typed::<SceneWire>(value)?)
}

fn scene(wire: &SceneWire) -> Result<Scene, At> {
    let size = default_size(wire);
    let mut attachments = Vec::new();
    for (name, a) in &wire.attachments {
        let attachment = attachment(name, a, size).map_err(|e| e.key(name).key("attachments"))?;
        attachments.push(attachment);
    }
    if wire.counters.len() > MAX_COUNTERS {
        let message = format!("a scene can have at most {MAX_COUNTERS} counters");
        return Err(At::new(message).key("counters"));
    }
    let counters: Vec<Counter> = wire
        .counters
        .iter()
        .map(|(name, kind)| Counter {
            name: name.clone(),
            kind: *kind,
        })
        .collect();
    check_pool(wire).map_err(|e| e.key("pool"))?;
    let draws: usize = wire.passes.iter().map(|pass| pass.draws.len()).sum();
    if draws > MAX_DRAWS {
        let message = format!("a scene can have at most {MAX_DRAWS} draws, and this has {draws}");
        return Err(At::new(message).key("passes"));
    }
    let mut passes = Vec::new();
    for (i, p) in wire.passes.iter().enumerate() {
        passes.push(
            pass(p, &attachments, &counters, wire.pool).map_err(|e| e.index(i).key("passes"))?,
        );
    }
    let mut read = Vec::new();
    for (i, name) in wire.read.iter().enumerate() {
        let index = find(name, &attachments).map_err(|e| e.index(i).key("read"))?;
        if read.contains(&index) {
            return Err(At::new(format!("`{name}` occurs twice"))
                .index(i)
                .key("read"));
        }
        read.push(index);
    }
    if read.is_empty() {
        return Err(At::new("nothing is read back, so nothing could be judged").key("read"));
    }
    let scene = Scene {
        attachments,
        passes,
        read,
        counters,
        query_scope: wire.queries,
        pool: wire.pool,
        path: wire.path,
    };
    check_content(&scene)?;
    check_queries(&scene).map_err(|e| e.key("queries"))?;
    check_path(&scene).map_err(|e| e.key("path"))?;
    Ok(scene)
}

/// Checks that a worker can be given the scene.
pub(crate) fn check_content(scene: &Scene) -> Result<(), At> {
    match scene.content_bytes() {
        bytes if bytes > Scene::MOST_CONTENT => Err(At::new(format!(
            "its texels, vertices and indices take up to {bytes} bytes, and at most {} can be drawn: use fewer, or \
             smaller attachments",
            Scene::MOST_CONTENT
        ))),
        _ => Ok(()),
    }
}

/// Checks that a pool has room, is not too large, and is used.
fn check_pool(wire: &SceneWire) -> Result<(), At> {
    let draws = || wire.passes.iter().flat_map(|pass| &pass.draws);
    let used = draws().any(|draw| draw.shader.uses_pool());
    match wire.pool {
        None => Ok(()),
        Some(_) if !used => Err(At::new("no shader uses it")),
        Some(pool)
            if pool.layers > 0
                && u64::from(pool.nodes) != pool.texels() * u64::from(pool.layers) =>
        {
            Err(At::new(
                "a pool with layers has as many nodes for each texel",
            ))
        }
        Some(pool) if pool.nodes == 0 || pool.bytes() > Pool::MOST_BYTES => Err(At::new(format!(
            "a pool needs at least one node, and at most {} bytes",
            Pool::MOST_BYTES
        ))),
        Some(_) => Ok(()),
    }
}

/// Returns the pass that a case file describes. One key of a pass after the other.
fn pass(
    wire: &PassWire,
    attachments: &[Attachment],
    counters: &[Counter],
    pool: Option<Pool>,
) -> Result<Pass, At> {
    let mut color = Vec::new();
    for (i, name) in wire.color.iter().enumerate() {
        let check = || -> Result<usize, At> {
            let index = find(name, attachments)?;
            if !attachments[index].format.is_color() {
                return Err(At::new(format!("`{name}` is not a colour attachment")));
            }
            if color.contains(&index) {
                return Err(At::new(format!("`{name}` occurs twice")));
            }
            Ok(index)
        };
        let index = check().map_err(|e| e.index(i).key("color"))?;
        color.push(index);
    }
    let depth_stencil = match &wire.depth_stencil {
        None => None,
        Some(name) => {
            let index = find(name, attachments).map_err(|e| e.key("depth_stencil"))?;
            if attachments[index].format.is_color() {
                return Err(
                    At::new(format!("`{name}` is a colour attachment")).key("depth_stencil")
                );
            }
            Some(index)
        }
    };
    let resolve = resolve_targets(wire, &color, attachments)?;
    let depth_stencil_resolve = match &wire.depth_stencil_resolve {
        None => None,
        Some(resolve) => {
            let made = depth_stencil_target(resolve, depth_stencil, attachments);
            Some(made.map_err(|e| e.key("depth_stencil_resolve"))?)
        }
    };
    let targets: Vec<&Attachment> = color
        .iter()
        .chain(&depth_stencil)
        .map(|i| &attachments[*i])
        .collect();
    let Some(first) = targets.first() else {
        return Err(At::new("a pass needs an attachment"));
    };
    let shape = |a: &Attachment| (a.size, a.samples);
    if let Some(other) = targets.iter().find(|a| shape(a) != shape(first)) {
        return Err(At::new(format!(
            "`{}` and `{}` differ in size or samples",
            first.name, other.name
        )));
    }
    let format = depth_stencil.map(|i| attachments[i].format);
    let resolved = resolve.iter().flatten();
    let bound: Vec<usize> = color
        .iter()
        .chain(&depth_stencil)
        .chain(resolved)
        .chain(depth_stencil_resolve.as_ref().map(|r| &r.to))
        .copied()
        .collect();
    let mut draws = Vec::new();
    for (i, d) in wire.draws.iter().enumerate() {
        let target = DrawTarget {
            size: first.size,
            samples: first.samples,
            color: &color,
            depth_stencil: format,
            tested: depth_stencil,
            bound: &bound,
            attachments,
            counters,
            pool,
        };
        for tile in tiles(d, first.size).map_err(|e| e.index(i).key("draws"))? {
            let draw = draw(&tile, &target).map_err(|e| e.index(i).key("draws"))?;
            if wire.depth_stencil_read_only && writes_depth_stencil(&draw) {
                return Err(
                    At::new("the pass declares that it writes neither depth nor stencil")
                        .index(i)
                        .key("draws"),
                );
            }
            draws.push(draw);
        }
    }
    let target = PassTarget {
        size: first.size,
        color: color.iter().map(|i| attachments[*i].format).collect(),
        depth_stencil: format,
        draws: draws.len(),
    };
    let pass = Pass {
        depth_stencil_resolve,
        operations: operations(wire, &target).map_err(|e| e.key("operations"))?,
        clears: clears(wire, &target).map_err(|e| e.key("clears"))?,
        color,
        resolve,
        depth_stencil,
        depth_stencil_read_only: wire.depth_stencil_read_only,
        draws,
    };
    // A draw of a file can stand for several tiles, which read alike.
    for draw in &pass.draws {
        check_own_reads(draw, &pass, attachments).map_err(|e| e.key("textures").key("draws"))?;
    }
    Ok(pass)
}

/// Returns the resolve of depth and stencil, after checking that the format has its modes.
fn depth_stencil_target(
    wire: &DepthStencilResolveWire,
    depth_stencil: Option<usize>,
    attachments: &[Attachment],
) -> Result<DepthStencilResolve, At> {
    let Some(source) = depth_stencil.map(|i| &attachments[i]) else {
        return Err(At::new("the pass has neither depth nor stencil"));
    };
    let to = find(&wire.to, attachments).map_err(|e| e.key("to"))?;
    let target = &attachments[to];
    if source.samples < 2 || target.samples != 1 {
        return Err(At::new("a resolve goes from several samples to one").key("to"));
    }
    if (source.format, source.size) != (target.format, target.size) {
        return Err(At::new(format!(
            "`{}` differs in format or size from `{}`",
            wire.to, source.name
        ))
        .key("to"));
    }
    let modes = [
        ("depth", wire.depth, source.format.has_depth()),
        ("stencil", wire.stencil, source.format.has_stencil()),
    ];
    for (name, mode, has) in modes {
        if mode != ResolveMode::None && !has {
            return Err(At::new(format!("the pass has no {name}")).key(name));
        }
    }
    if wire.stencil == ResolveMode::Average {
        return Err(At::new("stencil cannot be averaged").key("stencil"));
    }
    if [wire.depth, wire.stencil] == [ResolveMode::None; 2] {
        return Err(At::new("a resolve needs a mode for `depth` or `stencil`"));
    }
    Ok(DepthStencilResolve {
        to,
        depth: wire.depth,
        stencil: wire.stencil,
    })
}

fn resolve_targets(
    wire: &PassWire,
    color: &[usize],
    attachments: &[Attachment],
) -> Result<Vec<Option<usize>>, At> {
    let mut resolve = vec![None; color.len()];
    for (i, name) in wire.resolve.iter().enumerate() {
        let Some(name) = name else { continue };
        let check = || -> Result<usize, At> {
            let target = find(name, attachments)?;
            let Some(source) = color.get(i).map(|c| &attachments[*c]) else {
                return Err(At::new("there is no colour attachment at this location"));
            };
            let target_is = &attachments[target];
            if source.samples < 2 || target_is.samples != 1 {
                return Err(At::new("a resolve goes from several samples to one"));
            }
            if resolve.contains(&Some(target)) {
                return Err(At::new(format!("`{name}` occurs twice")));
            }
            if (source.format, source.size) != (target_is.format, target_is.size) {
                return Err(At::new(format!(
                    "`{name}` differs in format or size from `{}`",
                    source.name
                )));
            }
            Ok(target)
        };
        let target = check().map_err(|e| e.index(i).key("resolve"))?;
        resolve[i] = Some(target);
    }
    Ok(resolve)
}
