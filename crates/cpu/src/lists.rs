//! The pool of fragments that shaders store for later passes, in one list per texel or in its nearest layers.

use crate::lanes::{LANES, Mask, Real};
use etalon_pipeline::shader::Node;
use etalon_scene::{Pool, PoolUse};

/// A fragment, and the number of the next node in its list. Numbers start from 1.
#[derive(Clone, Copy, Debug)]
struct StoredFragment {
    color: [f32; 4],
    depth: f32,
    behind: usize,
    /// True if a layer has its colour.
    filled: bool,
}

impl StoredFragment {
    /// A layer that has no fragment: behind all depths, transparent.
    const NOTHING: Self = Self {
        color: [0.0; 4],
        depth: 2.0,
        behind: 0,
        filled: false,
    };
}

/// The lists or layers of all texels.
#[derive(Debug, Default)]
pub(crate) struct TexelLists {
    size: [usize; 2],
    /// The number of each texel's first node, or 0.
    heads: Vec<usize>,
    /// The nodes of lists in the order in which they were added, or the layers of each texel, nearest first.
    nodes: Vec<StoredFragment>,
    most: usize,
    /// The number of layers of each texel; 0 if there are lists.
    layers: usize,
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
            nodes: vec![StoredFragment::NOTHING; pool.texels() as usize * pool.layers as usize],
            most: pool.nodes as usize,
            layers: pool.layers as usize,
        }
    }

    /// Returns the index of a texel's head.
    fn head(&self, x: usize, y: usize) -> Option<usize> {
        let [width, height] = self.size;
        (x < width && y < height).then(|| y * width + x)
    }

    /// Stores the fragments of a span, which starts at column `x` of row `y`, as a shader does.
    pub(crate) fn add(
        &mut self,
        [x, y]: [usize; 2],
        pool_use: PoolUse,
        node: &Node<Real>,
        mask: Mask,
    ) {
        for lane in (0..LANES).filter(|lane| mask[*lane]) {
            let Some(head) = self.head(x + lane, y) else {
                continue;
            };
            let fragment = StoredFragment {
                color: node.color.map(|v| v[lane]),
                depth: node.depth[lane],
                behind: self.heads[head],
                filled: true,
            };
            match pool_use {
                PoolUse::KeepNearest => self.keep_nearest(head, fragment.depth),
                PoolUse::FillNearest => self.fill(head, fragment),
                _ => self.append(head, fragment),
            }
        }
    }

    /// Adds a fragment to the front of a list, until the pool is full.
    fn append(&mut self, head: usize, fragment: StoredFragment) {
        if self.nodes.len() < self.most {
            self.nodes.push(fragment);
            self.heads[head] = self.nodes.len();
        }
    }

    /// Returns the layers of a texel.
    fn layers(&mut self, head: usize) -> &mut [StoredFragment] {
        let first = head * self.layers;
        &mut self.nodes[first..first + self.layers]
    }

    /// Stores a depth if it is among the nearest; the farthest is dropped.
    fn keep_nearest(&mut self, head: usize, mut depth: f32) {
        for layer in self.layers(head) {
            if depth < layer.depth {
                std::mem::swap(&mut depth, &mut layer.depth);
            }
        }
    }

    /// Stores a colour in the first layer of its depth that has none.
    fn fill(&mut self, head: usize, fragment: StoredFragment) {
        let mut layers = self.layers(head).iter_mut();
        if let Some(layer) = layers.find(|l| l.depth == fragment.depth && !l.filled) {
            *layer = fragment;
        }
    }

    /// Returns a node by its number.
    fn node(&self, number: usize) -> Option<&StoredFragment> {
        number
            .checked_sub(1)
            .and_then(|index| self.nodes.get(index))
    }

    /// Returns the nodes of a texel: its list, or its layers.
    fn stored(&self, head: usize) -> impl Iterator<Item = &StoredFragment> {
        let first = self.node(self.heads[head]);
        let list = std::iter::successors(first, |stored| self.node(stored.behind));
        let layers = &self.nodes[head * self.layers..(head + 1) * self.layers];
        list.chain(layers)
    }

    /// Returns the nodes of a span's texels that a shader reads, one node per lane. Shorter lists are padded
    /// with empty nodes.
    pub(crate) fn of(&self, [x, y]: [usize; 2], pool_use: PoolUse) -> Vec<Node<Real>> {
        let nothing = Node {
            color: StoredFragment::NOTHING.color.map(|v| [v; LANES]),
            depth: [StoredFragment::NOTHING.depth; LANES],
        };
        let mut ranks = Vec::new();
        for lane in 0..LANES {
            let Some(head) = self.head(x + lane, y) else {
                continue;
            };
            let is_read =
                |stored: &&StoredFragment| pool_use != PoolUse::FillNearest || !stored.filled;
            for (rank, stored) in self.stored(head).filter(is_read).enumerate() {
                if rank == ranks.len() {
                    ranks.push(nothing);
                }
                ranks[rank].depth[lane] = stored.depth;
                for (channel, value) in ranks[rank].color.iter_mut().zip(stored.color) {
                    channel[lane] = value;
                }
            }
        }
        ranks
    }
}
