//! Tests of the methods' scenes. Other tests draw and measure the pictures.

use super::*;
use crate::validity::assert_valid;

fn wire(method: MethodName, address: AddressMode) -> Wire {
    Wire {
        scene: SceneName::Grass,
        method,
        address,
        scale: None,
        cutoff: None,
    }
}

const METHODS: [MethodName; 5] = [
    MethodName::Discard,
    MethodName::BlendSorted,
    MethodName::Hashed,
    MethodName::AlphaToCoverage,
    MethodName::AlphaToCoverageSharpened,
];

#[test]
fn every_method_draws_and_the_truth_clamps_at_the_border() {
    for method in METHODS {
        for (address, scale) in [(AddressMode::ClampToEdge, 0.25), (AddressMode::Repeat, 4.0)] {
            let wire = Wire {
                scale: Some(scale),
                ..wire(method, address)
            };
            let made = make(&wire).expect("the parameters are in range");
            assert_valid(&made.scene);
            let draw = &made.scene.passes[0].draws[0];
            assert_eq!(draw.sampler.map(|s| s.address), Some([address; 2]));
            for surface in &made.truth.surfaces {
                let Paint::Texture { texture, uv } = &surface.paint else {
                    panic!("a card without a texture");
                };
                assert_eq!(texture.address, [AddressMode::ClampToEdge; 2]);
                assert_eq!(uv.len(), surface.corners.len());
            }
        }
    }
}

#[test]
fn the_texture_is_full_at_one_border_and_empty_at_the_other() {
    let texels = grass();
    let side = TEXTURE as usize;
    assert_eq!(texels.len(), side * side);
    assert!(texels[..side].iter().all(|t| t[3] == 0));
    assert!(texels[side * (side - 1)..].iter().all(|t| t[3] == 255));
    let some = texels.iter().filter(|t| (1..255).contains(&t[3])).count();
    assert!(some > side, "{some} texels are partly covered");
}

#[test]
fn cards_are_sorted_and_their_borders_coincide_with_those_of_texels() {
    for scale in [0.5, 0.75, 1.0, 1.5, 2.0, 4.0] {
        let cards = cards(scale);
        let depth = |card: &Polygon| card.corners.iter().map(|c| c[2]).sum::<f64>();
        let far = sorted(&cards);
        assert!(far.windows(2).all(|c| depth(&c[0]) >= depth(&c[1])));
        assert_eq!(far.len(), cards.len());
        for corner in cards.iter().flat_map(|c| &c.corners) {
            assert!(corner[0].fract() == 0.0 && corner[1].fract() == 0.0);
            assert!((0.0..1.0).contains(&corner[2]));
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let plain = wire(MethodName::Discard, AddressMode::Repeat);
    let bad = [
        (
            "scale",
            Wire {
                scale: Some(0.2),
                ..plain.clone()
            },
        ),
        (
            "scale",
            Wire {
                scale: Some(4.1),
                ..plain.clone()
            },
        ),
        (
            "cutoff",
            Wire {
                cutoff: Some(0.0),
                ..plain.clone()
            },
        ),
        (
            "cutoff",
            Wire {
                cutoff: Some(f64::NAN),
                ..plain
            },
        ),
    ];
    for (key, wire) in bad {
        let Err(error) = make(&wire) else {
            panic!("{wire:?} is drawn");
        };
        assert_eq!(error.key, key);
    }
}
