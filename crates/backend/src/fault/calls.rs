//! The part of faulty calls that all APIs share.

use crate::CallFault;
use std::any::Any;
use std::collections::{HashMap, HashSet};

/// The numbers of a draw call.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawNumbers {
    /// True if the draw has indices.
    pub indexed: bool,
    /// True if the draw has points or lines.
    pub thin: bool,
    /// The number of vertices or indices.
    pub count: i32,
    /// The number of instances.
    pub instances: i32,
    /// The first index.
    pub first: i32,
    /// The number that is added to indices.
    pub base_vertex: i32,
    /// The first instance.
    pub first_instance: u32,
}

/// A query that has begun but not ended.
#[derive(Clone, Copy, Debug)]
pub struct OpenQuery {
    /// The pool or target of the query.
    pub owner: u64,
    /// The index in the pool, or the name.
    pub query: u32,
    /// True if the query can end between two draws: it began within a pass, or the API has no passes.
    pub ends_anywhere: bool,
    /// The number of draws since the query began.
    draws: u32,
    /// True if the fault has already ended the query.
    ended: bool,
}

/// The calls to a driver that a planted fault has observed.
///
/// A backend opened with a fault replaces the driver's functions with its own, which use this to decide how
/// to change a call. The rest of the backend does not know about the fault. Rectangles have the API's origin.
#[derive(Default)]
pub struct FaultyCalls {
    /// The fault; `None` until it is active.
    pub fault: Option<CallFault>,
    /// The number of passes of the submission so far.
    pub passes: u32,
    /// The number of draws of the pass so far.
    pub draws: u32,
    /// The rectangle that draws can reach: left, top, right and bottom.
    pub area: [i32; 4],
    /// The scissor rectangle: x, y, width and height.
    pub scissor: [i32; 4],
    /// True if the scissor test is enabled.
    pub scissor_on: bool,
    /// The queries of the submission, kept until another submission begins queries.
    pub queries: Vec<u32>,
    /// True if `queries` belong to an earlier submission.
    queries_are_old: bool,
    /// The queries that have begun but not ended.
    open: Vec<OpenQuery>,
    /// The queries that were open during a clear.
    cleared_queries: Vec<u32>,
    /// The results that were read since the submission, by owner and query.
    read: HashSet<(u64, u32)>,
    /// The values of the previous call, by the state's number.
    kept: HashMap<u32, Box<dyn Any>>,
    /// The last clear value of each image, as bits.
    cleared: HashMap<u64, [u32; 4]>,
}

impl FaultyCalls {
    /// Returns true if this is the fault, and it is active.
    pub fn has(&self, fault: CallFault) -> bool {
        self.fault == Some(fault)
    }

    /// Records that a submission ends, or that another begins.
    pub fn end_submission(&mut self) {
        (self.passes, self.draws) = (0, 0);
        self.queries_are_old = true;
        self.kept.clear();
        self.read.clear();
    }

    /// Records that a pass begins.
    pub fn begin_pass(&mut self) {
        self.passes += 1;
        self.draws = 0;
    }

    /// Returns the value of the previous call if this is the active fault, or else `value`. Keeps `value` for
    /// the next call. `state` distinguishes several states of one fault.
    pub fn kept<T: Copy + 'static>(&mut self, fault: CallFault, state: u32, value: T) -> T {
        if !self.has(fault) {
            return value;
        }
        let before = self.kept.insert(state, Box::new(value));
        before
            .and_then(|before| before.downcast_ref().copied())
            .unwrap_or(value)
    }

    /// Returns the scissor rectangle to set instead of this one: x, y, width and height. A right edge at or
    /// past `limit` is not changed.
    pub fn set_scissor(&mut self, rectangle: [i32; 4], limit: i32) -> [i32; 4] {
        let mut rectangle = self.kept(CallFault::ScissorKept, 0, rectangle);
        let right = rectangle[0].saturating_add(rectangle[2]);
        if self.has(CallFault::ScissorEdge) && right % 16 == 0 && right < limit {
            rectangle[2] = (rectangle[2] - 1).max(0);
        }
        self.scissor = rectangle;
        rectangle
    }

    /// Draws with the numbers that the fault leaves, once for each part of the area that draws still reach.
    /// `set_scissor` limits a draw to a part.
    pub fn draw(
        &mut self,
        mut numbers: DrawNumbers,
        set_scissor: impl Fn([i32; 4]),
        draw: impl Fn(&DrawNumbers),
    ) {
        self.draws += 1;
        match self.fault {
            Some(CallFault::Draw256) if self.draws == 256 => return,
            Some(CallFault::LaterPassDraw) if self.draws == 1 && self.passes > 1 => return,
            Some(CallFault::Indices65535) if numbers.indexed => {
                numbers.count = numbers.count.min(65_535)
            }
            Some(CallFault::Vertices4096) if !numbers.indexed => {
                numbers.count = numbers.count.min(4_096)
            }
            Some(CallFault::Lines500) if numbers.thin => numbers.count = numbers.count.min(500),
            Some(CallFault::FirstIndex) if numbers.first > 0 && numbers.count > 0 => {
                numbers.first += 1;
                numbers.count -= 1;
            }
            Some(CallFault::IndexOffset) => numbers.first = 0,
            Some(CallFault::BaseVertex) => numbers.base_vertex = 0,
            Some(CallFault::FirstInstance) => numbers.first_instance = 0,
            Some(CallFault::EmptyAsOne) => numbers.instances = numbers.instances.max(1),
            Some(CallFault::SecondInstance) => numbers.instances = numbers.instances.min(1),
            _ => {}
        }
        let [left, top, right, bottom] = self.area;
        let parts = match self.fault {
            Some(CallFault::OnlyFirst64) => vec![[0, 0, 64, 64]],
            Some(CallFault::LastRow) => vec![[left, top, right, bottom - 1]],
            Some(CallFault::LastColumn) => vec![[left, top, right - 1, bottom]],
            Some(CallFault::SecondTile) => {
                vec![[0, 0, 32, 32], [64, 0, right, 32], [0, 32, right, bottom]]
            }
            _ => return draw(&numbers),
        };
        for part in parts {
            set_scissor(self.within_scissor(part));
            draw(&numbers);
        }
    }

    /// Returns the intersection of a part and the scissor rectangle: x, y, width and height.
    fn within_scissor(&self, [mut left, mut top, mut right, mut bottom]: [i32; 4]) -> [i32; 4] {
        if self.scissor_on {
            let [x, y, width, height] = self.scissor;
            (left, right) = (left.max(x), right.min(x.saturating_add(width)));
            (top, bottom) = (top.max(y), bottom.min(y.saturating_add(height)));
        }
        [left, top, (right - left).max(0), (bottom - top).max(0)]
    }

    /// Returns true if the fault skips the clear of an image to the value that it was last cleared to.
    pub fn skips_equal_clear(&mut self, image: u64, value: [u32; 4]) -> bool {
        let before = self.cleared.insert(image, value);
        self.has(CallFault::EqualClearSkipped) && before == Some(value)
    }

    /// Records that a query begins.
    pub fn begin_query(&mut self, query: u32) {
        if std::mem::take(&mut self.queries_are_old) {
            self.queries.clear();
        }
        self.queries.push(query);
        self.cleared_queries.retain(|cleared| *cleared != query);
    }

    /// Records that a query of a pool or target is open, and whether it can end between two draws.
    pub fn open_query(&mut self, owner: u64, query: u32, ends_anywhere: bool) {
        self.open.push(OpenQuery {
            owner,
            query,
            ends_anywhere,
            draws: 0,
            ended: false,
        });
    }

    /// Records that a query of a pool or target ends. Returns true if the fault already ended it.
    pub fn close_query(&mut self, owner: u64, query: Option<u32>) -> bool {
        let is_it =
            |open: &OpenQuery| open.owner == owner && query.is_none_or(|query| query == open.query);
        let Some(index) = self.open.iter().position(is_it) else {
            return false;
        };
        self.open.swap_remove(index).ended
    }

    /// Returns the queries that the fault restarts before a draw.
    pub fn queries_before_draw(&self) -> Vec<OpenQuery> {
        let again = |open: &&OpenQuery| self.has(CallFault::QueryLastDraw) && open.draws > 0;
        self.open.iter().filter(again).copied().collect()
    }

    /// Records a draw, and returns the queries that the fault ends after it.
    pub fn queries_after_draw(&mut self) -> Vec<OpenQuery> {
        self.open.iter_mut().for_each(|open| open.draws += 1);
        self.end_queries(CallFault::QueryOneDraw, |open| open.ends_anywhere)
    }

    /// Returns the queries that the fault ends after a pass.
    pub fn queries_after_pass(&mut self) -> Vec<OpenQuery> {
        self.end_queries(CallFault::QueryOnePass, |open| open.draws > 0)
    }

    /// Returns the open queries for which `kind` is true, if this is the fault. It ends each query only once.
    fn end_queries(
        &mut self,
        fault: CallFault,
        kind: impl Fn(&OpenQuery) -> bool,
    ) -> Vec<OpenQuery> {
        if !self.has(fault) {
            return Vec::new();
        }
        let matching = self
            .open
            .iter_mut()
            .filter(|open| !open.ended && kind(open));
        matching
            .map(|open| {
                open.ended = true;
                *open
            })
            .collect()
    }

    /// Records a clear.
    pub fn note_clear(&mut self) {
        let open = self.open.iter().map(|open| open.query);
        self.cleared_queries.extend(open);
    }

    /// Returns the result of a query that replaces the driver's.
    pub fn result(&mut self, owner: u64, query: u32, result: u64) -> u64 {
        let is_again = !self.read.insert((owner, query));
        if self.has(CallFault::ResultOnce) && is_again {
            0
        } else if self.has(CallFault::QueryClear) && self.cleared_queries.contains(&query) {
            result + 1
        } else {
            result
        }
    }

    /// Returns true if the fault ends the query where it begins.
    pub fn ends_query_early(&self) -> bool {
        self.has(CallFault::QueryEarly) && self.queries.len() > 1
    }
}
