//! Checks that methods' scenes keep the promises of the scene model.

use etalon_scene::{AttachmentContents, Pool, Scene};

/// Asserts what the model promises of every scene: indices are in range, sizes and samples agree, no pass
/// reads what it draws to, and the shader writes all targets.
pub(crate) fn assert_valid(scene: &Scene) {
    assert!(!scene.read.is_empty());
    assert!(scene.read.iter().all(|i| *i < scene.attachments.len()));
    for a in &scene.attachments {
        let named = scene.attachments.iter().filter(|b| b.name == a.name);
        assert_eq!(named.count(), 1, "{}", a.name);
        if let AttachmentContents::Texels(codes) = &a.contents {
            let channels = a.format.color_channels().len();
            assert_eq!(codes.len(), (a.size[0] * a.size[1]) as usize * channels);
            assert_eq!(a.samples, 1);
        }
    }
    for pass in &scene.passes {
        let shape = |i: &usize| {
            let a = &scene.attachments[*i];
            (a.size, a.samples)
        };
        let drawn: Vec<usize> = pass
            .color
            .iter()
            .chain(&pass.depth_stencil)
            .copied()
            .collect();
        assert!(!drawn.is_empty());
        assert!(drawn.iter().all(|i| shape(i) == shape(&drawn[0])));
        let is_color = |i: &usize| scene.attachments[*i].format.is_color();
        assert!(pass.color.iter().all(is_color));
        assert!(!pass.depth_stencil.iter().any(is_color));
        assert_eq!(pass.resolve.len(), pass.color.len());
        for (from, to) in pass.color.iter().zip(&pass.resolve) {
            let Some(to) = to else { continue };
            let [from, to] = [from, to].map(|i| &scene.attachments[*i]);
            assert_eq!((from.format, from.size), (to.format, to.size));
            assert!(from.samples > 1 && to.samples == 1);
        }
        for draw in &pass.draws {
            assert_eq!(draw.targets.len(), pass.color.len());
            assert!(draw.targets.len() <= draw.shader.outputs());
            assert_eq!(draw.textures.len(), draw.shader.textures());
            let pool = scene.pool.filter(|_| draw.shader.uses_pool());
            assert_eq!(pool.is_some(), draw.shader.uses_pool());
            if let Some(pool) = pool {
                let [width, height, ..] = draw.params.color;
                assert_eq!((pool.size, 1), shape(&drawn[0]));
                assert_eq!([width, height], pool.size.map(|side| side as f32));
                assert_eq!(draw.shader.uses_layers(), pool.layers > 0);
                if pool.layers > 0 {
                    assert_eq!(draw.params.color[2], pool.layers as f32);
                    assert_eq!(
                        u64::from(pool.nodes),
                        pool.texels() * u64::from(pool.layers)
                    );
                }
                assert!(pool.nodes > 0 && pool.bytes() <= Pool::MOST_BYTES);
            }
            assert_eq!(draw.sampler.is_some(), draw.shader.samples_texture());
            assert!(draw.depth.is_none() || pass.depth_stencil.is_some());
            assert!(!draw.multisample.alpha_to_coverage || shape(&drawn[0]).1 > 1);
            assert!(!draw.mesh.vertices.is_empty());
            let count = draw.mesh.vertices.len() as u32;
            let known = |i: &u32| *i < count;
            assert!(draw.mesh.indices.iter().flatten().all(known));
            for vertex in &draw.mesh.vertices {
                let [x, y, z, w] = vertex.position;
                assert!(x.abs() <= 64.0 && y.abs() <= 64.0, "{vertex:?}");
                assert!((0.0..=1.0).contains(&z) && w > 0.0, "{vertex:?}");
            }
            for texture in &draw.textures {
                let a = &scene.attachments[*texture];
                assert!(a.format.is_color() && a.samples == 1);
                assert!(!drawn.contains(texture) && !pass.resolve.contains(&Some(*texture)));
                assert!(draw.shader.samples_texture() || a.size == shape(&drawn[0]).0);
            }
        }
    }
}
