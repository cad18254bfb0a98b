//! The pool of fragments that shaders store for later passes, in one list per texel.

use crate::lanes::{LANES, Mask, Real};
use etalon_pipeline::shader::Node;
use etalon_scene::Pool;

/// A fragment, and the number of the next node in its list. Numbers start from 1.
#[derive(Clone, Copy, Debug)]
struct StoredFragment {
    color: [f32; 4],
    depth: f32,
    behind: usize,
}

/// The lists of all texels.
#[derive(Debug, Default)]
pub(crate) struct TexelLists {
    size: [usize; 2],
    /// The number of each texel's first node, or 0.
    heads: Vec<usize>,
    nodes: Vec<StoredFragment>,
    most: usize,
}

impl TexelLists {
    /// Returns empty lists.
    pub(crate) fn new(pool: Option<Pool>) -> Self {
        let Some(pool) = pool else {
            return Self::default();
        };
        Self {
            size: pool.size.map(|s| s as usize),
            heads: vec![0; pool.texels() as usize],
            nodes: Vec::new(),
            most: pool.nodes as usize,
        }
    }

    /// Returns the index of a texel's head.
    fn head(&self, x: usize, y: usize) -> Option<usize> {
        let [width, height] = self.size;
        (x < width && y < height).then(|| y * width + x)
    }

    /// Adds the fragments of a span, which starts at column `x` of row `y`, to the front of their texels'
    /// lists, until the pool is full.
    pub(crate) fn add(&mut self, [x, y]: [usize; 2], node: &Node<Real>, mask: Mask) {
        for lane in (0..LANES).filter(|lane| mask[*lane]) {
            let Some(head) = self.head(x + lane, y) else {
                continue;
            };
            if self.nodes.len() == self.most {
                return;
            }
            self.nodes.push(StoredFragment {
                color: node.color.map(|v| v[lane]),
                depth: node.depth[lane],
                behind: self.heads[head],
            });
            self.heads[head] = self.nodes.len();
        }
    }

    /// Returns the lists of a span's texels, one node per lane. Shorter lists are padded with empty nodes.
    pub(crate) fn of(&self, [x, y]: [usize; 2]) -> Vec<Node<Real>> {
        let nothing = Node {
            color: [[0.0; LANES]; 4],
            depth: [2.0; LANES],
        };
        let mut ranks = Vec::new();
        for lane in 0..LANES {
            let head = self.head(x + lane, y).map_or(0, |head| self.heads[head]);
            let mut number = head;
            let mut rank = 0;
            while let Some(stored) = number.checked_sub(1).and_then(|i| self.nodes.get(i)) {
                if rank == ranks.len() {
                    ranks.push(nothing);
                }
                ranks[rank].depth[lane] = stored.depth;
                for (channel, value) in ranks[rank].color.iter_mut().zip(stored.color) {
                    channel[lane] = value;
                }
                number = stored.behind;
                rank += 1;
            }
        }
        ranks
    }
}
