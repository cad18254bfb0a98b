//! Entry points with a planted fault, for tests of the suite.
//!
//! A backend that is opened with a fault finds these functions instead of the driver's. They have the
//! driver's signatures, and cannot carry a state of their own. The driver's functions and the observed calls
//! are therefore kept per thread: a context belongs to one thread.

use etalon_backend::{CallFault, DrawNumbers, Fault, FaultyCalls};
use std::cell::RefCell;
use std::collections::HashSet;
use std::ffi::{CStr, c_void};
use std::{ptr, slice};

thread_local! {
    static PLANTED: RefCell<Option<Planted>> = const { RefCell::new(None) };
}

type PlantedPointer = *const c_void;

/// The driver's functions, and the observed state of the calls.
#[derive(Default)]
struct Planted {
    driver: Driver,
    calls: FaultyCalls,
    /// The resolves since the last draw.
    blits: u32,
    /// The framebuffer that is drawn to.
    framebuffer: u32,
    /// The framebuffer that is read from.
    source: u32,
    /// The framebuffers that have several layers.
    layered: HashSet<u32>,
    /// The framebuffers that are multisampled.
    multisampled: HashSet<u32>,
    /// True after a clear of the framebuffer that is drawn to.
    cleared: bool,
    /// True if restart at a set index is enabled.
    restarts: bool,
    /// The buffer that is read.
    read: u32,
    /// True before the first clear after a call that leaves contents undefined.
    undefined: bool,
    /// The format of the texture that was last created with immutable storage, which views share.
    stored: u32,
}

/// Prepares the thread for a context that is opened, with or without a fault.
pub(crate) fn plant(fault: Option<Fault>) {
    let is_planted = matches!(fault, Some(Fault::Call(_)));
    PLANTED.set(is_planted.then(Planted::default));
}

/// Activates the fault.
pub(crate) fn arm(fault: Option<Fault>) {
    if let Some(Fault::Call(fault)) = fault {
        with(|planted| planted.calls.fault = Some(fault));
    }
}

/// Returns the address that the backend finds for an entry point.
pub(crate) fn address(name: &CStr, address: PlantedPointer) -> PlantedPointer {
    PLANTED.with_borrow_mut(|planted| match planted {
        Some(planted) if !address.is_null() => replaced(planted, &name.to_string_lossy(), address),
        _ => address,
    })
}

fn with(call: impl FnOnce(&mut Planted)) {
    PLANTED.with_borrow_mut(|planted| planted.as_mut().map(call));
}

/// Calls one of the driver's functions.
macro_rules! driver {
    ($driver:expr, $name:ident($($arg:expr),*)) => {
        if let Some(function) = $driver.$name {
            // SAFETY: the function has the type of the driver's function of its name. The caller passes the
            // arguments on unchanged, or made from valid ones.
            unsafe { function($($arg),*) }
        }
    };
}

/// Declares the functions that replace the driver's. Each runs code `before` it calls the driver's function
/// with the resulting arguments, or runs code `instead`.
macro_rules! functions {
    ($($how:ident $name:ident $(| $alias:ident)* ($($arg:ident: $kind:ty),*) |$planted:ident| { $($body:tt)* })+) => {
        /// The driver's functions.
        #[derive(Clone, Copy, Default)]
        #[expect(non_snake_case, reason = "the names are the API's")]
        struct Driver {
            $($name: Option<unsafe extern "system" fn($($kind),*)>,)+
        }

        /// Returns the address of the function that has the fault, or `address` if no function replaces this
        /// name.
        fn replaced(planted: &mut Planted, name: &str, address: PlantedPointer) -> PlantedPointer {
            match name {
                $(stringify!($name) $(| stringify!($alias))* => {
                    type Function = unsafe extern "system" fn($($kind),*);
                    // SAFETY: the specification gives this name this type, and the address is not null.
                    let function = unsafe { std::mem::transmute::<PlantedPointer, Function>(address) };
                    planted.driver.$name = Some(function);
                    faulty::$name as PlantedPointer
                })+
                _ => address,
            }
        }

        mod faulty {
            #![expect(non_snake_case, reason = "the names are the API's")]
            #![expect(unused_mut, reason = "not every function changes each of its arguments")]

            use super::*;

            $(
                pub(super) unsafe extern "system" fn $name($(mut $arg: $kind),*) {
                    with(|$planted| {
                        $($body)*
                        functions!(@$how $planted $name($($arg),*));
                    });
                }
            )+
        }
    };
    (@before $planted:ident $name:ident($($arg:ident),*)) => { driver!($planted.driver, $name($($arg),*)) };
    (@instead $($call:tt)*) => {};
}

functions! {
    instead glEnable(capability: u32) |planted| { planted.switch(capability, true); }
    instead glDisable(capability: u32) |planted| { planted.switch(capability, false); }
    before glScissor(x: i32, y: i32, w: i32, h: i32) |planted| {
        [x, y, w, h] = planted.calls.set_scissor([x, y, w, h], i32::MAX);
    }
    before glViewport(x: i32, y: i32, w: i32, h: i32) |planted| {
        planted.calls.area = [x, y, x + w, y + h];
        [x, y, w, h] = planted.calls.kept(CallFault::ViewportKept, 0, [x, y, w, h]);
    }
    before glViewportIndexedf | glViewportIndexedfOES(index: u32, x: f32, y: f32, w: f32, h: f32) |planted| {
        let [left, top, width, height] = [x, y, w, h].map(|length| length as i32);
        planted.calls.area = [left, top, left + width, top + height];
        [x, y, w, h] = planted.calls.kept(CallFault::ViewportKept, 1, [x, y, w, h]);
    }
    before glViewportArrayv | glViewportArrayvOES(first: u32, count: i32, viewports: *const f32) |planted| {
        let both: [[f32; 4]; 2];
        if planted.calls.has(CallFault::ViewportFirst) && count == 2 {
            // SAFETY: a viewport has four components.
            both = [unsafe { *viewports.cast::<[f32; 4]>() }; 2];
            viewports = both.as_ptr().cast();
        }
    }
    before glClipControl | glClipControlEXT(origin: u32, depth: u32) |planted| {
        if planted.calls.has(CallFault::ClipOriginKept) {
            origin = glow::UPPER_LEFT;
        }
    }
    before glDepthFunc(compare: u32) |planted| {
        compare = planted.calls.kept(CallFault::CompareKept, 0, compare);
    }
    before glDepthMask(write: u8) |planted| {
        write = planted.calls.kept(CallFault::DepthWriteKept, 0, write);
    }
    before glCullFace(face: u32) |planted| {
        face = planted.calls.kept(CallFault::CullKept, 0, face);
    }
    before glStencilFuncSeparate(face: u32, compare: u32, reference: i32, mask: u32) |planted| {
        reference = planted.calls.kept(CallFault::StencilReferenceKept, face, reference);
    }
    before glBlendColor(r: f32, g: f32, b: f32, a: f32) |planted| {
        [r, g, b, a] = planted.calls.kept(CallFault::BlendConstantKept, 0, [r, g, b, a]);
    }
    before glFramebufferTextureLayer(target: u32, point: u32, texture: u32, level: i32, layer: i32) |planted| {
        if planted.calls.has(CallFault::LayerDropped) {
            layer = 0;
        }
        if planted.calls.has(CallFault::LevelDropped) {
            level = 0;
        }
    }
    before glFramebufferTexture2D(target: u32, point: u32, image: u32, texture: u32, level: i32) |planted| {
        if image == glow::TEXTURE_2D_MULTISAMPLE {
            planted.multisampled.insert(planted.framebuffer);
        }
        let faces = glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z;
        if planted.calls.has(CallFault::FaceDropped) && faces.contains(&image) {
            image = glow::TEXTURE_CUBE_MAP_POSITIVE_X;
        }
        if planted.calls.has(CallFault::LevelDropped) {
            level = 0;
        }
    }
    before glFramebufferTexture(target: u32, point: u32, texture: u32, level: i32) |planted| {
        planted.layered.insert(planted.framebuffer);
    }
    before glTexStorage2D(target: u32, levels: i32, format: u32, width: i32, height: i32) |planted| {
        planted.stored = format;
    }
    before glTexStorage3D(target: u32, levels: i32, format: u32, width: i32, height: i32, depth: i32) |planted| {
        planted.stored = format;
    }
    before glTexStorage2DMultisample(
        target: u32, samples: i32, format: u32, width: i32, height: i32, fixed: u8
    ) |planted| {
        planted.stored = format;
    }
    before glTextureView | glTextureViewOES | glTextureViewEXT(
        texture: u32, target: u32, viewed: u32, format: u32, level: u32, levels: u32, layer: u32, layers: u32
    ) |planted| {
        if planted.calls.has(CallFault::ViewFormat) {
            format = planted.stored;
        }
    }
    before glShaderSource(shader: u32, count: i32, strings: *const PlantedPointer, lengths: *const i32) |planted| {
        let text: String;
        let (start, length): (PlantedPointer, i32);
        if planted.calls.has(CallFault::LayerUnwritten) && count == 1 && !lengths.is_null() {
            // SAFETY: the string has this length.
            let bytes = unsafe { slice::from_raw_parts((*strings).cast::<u8>(), *lengths as usize) };
            text = String::from_utf8_lossy(bytes).replace("gl_Layer = ", "gl_Layer = 0 * ");
            (start, length) = (text.as_ptr().cast(), text.len() as i32);
            (strings, lengths) = (&start, &length);
        }
    }
    before glReadBuffer(buffer: u32) |planted| {
        planted.read = buffer;
    }
    before glReadPixels(x: i32, y: i32, w: i32, h: i32, format: u32, kind: u32, pixels: PlantedPointer) |planted| {
        if planted.calls.has(CallFault::ReadBufferFirst) && planted.read > glow::COLOR_ATTACHMENT0 {
            driver!(planted.driver, glReadBuffer(glow::COLOR_ATTACHMENT0));
        }
    }
    before glScissorArrayv(first: u32, count: i32, rectangles: *const i32) |planted| {
        let both: [[i32; 4]; 2];
        if planted.calls.has(CallFault::ScissorFirst) && count == 2 && planted.cleared {
            // SAFETY: a rectangle has four components.
            both = [unsafe { *rectangles.cast::<[i32; 4]>() }; 2];
            rectangles = both.as_ptr().cast();
        }
    }
    before glColorMask(r: u8, g: u8, b: u8, a: u8) |planted| {}
    before glDrawBuffers(count: i32, buffers: *const u32) |planted| {
        // SAFETY: there are `count` buffers.
        let mut changed = unsafe { slice::from_raw_parts(buffers, count as usize) }.to_vec();
        if planted.calls.has(CallFault::ClearAllBuffers) && count > 1 {
            for (buffer, point) in changed.iter_mut().zip(glow::COLOR_ATTACHMENT0..) {
                *buffer = point;
            }
            buffers = changed.as_ptr();
        }
        if planted.calls.has(CallFault::GapEnds) {
            let behind = changed.iter_mut().skip_while(|buffer| **buffer != glow::NONE);
            behind.for_each(|buffer| *buffer = glow::NONE);
            buffers = changed.as_ptr();
        }
    }
    before glInvalidateFramebuffer(target: u32, count: i32, points: *const u32) |planted| {
        planted.undefined = true;
    }
    instead glInvalidateSubFramebuffer(
        target: u32, count: i32, points: *const u32, x: i32, y: i32, w: i32, h: i32
    ) |planted| {
        planted.undefined = true;
        driver!(planted.driver, glInvalidateSubFramebuffer(target, count, points, x, y, w, h));
        // SAFETY: there is at least one.
        let point = unsafe { *points };
        if planted.calls.has(CallFault::InvalidateAll) && point == glow::COLOR_ATTACHMENT0 {
            driver!(planted.driver, glDisable(glow::SCISSOR_TEST));
            driver!(planted.driver, glClearBufferfv(glow::COLOR, 0, [0.5_f32; 4].as_ptr()));
            driver!(planted.driver, glEnable(glow::SCISSOR_TEST));
        }
    }
    instead glClear(mask: u32) |planted| {
        let several = mask.count_ones() > 1 && planted.calls.has(CallFault::ClearFirstOfCall);
        let color = glow::COLOR_BUFFER_BIT;
        let mask = if several && mask & color != 0 {
            color
        } else if several {
            glow::DEPTH_BUFFER_BIT
        } else {
            mask
        };
        planted.clear(None, |driver| driver!(driver, glClear(mask)));
    }
    before glBindFramebuffer(target: u32, framebuffer: u32) |planted| {
        if planted.calls.has(CallFault::StateForgotten) && target == glow::FRAMEBUFFER {
            driver!(planted.driver, glColorMask(1, 1, 1, 1));
            driver!(planted.driver, glDisable(glow::CULL_FACE));
        }
        if target != glow::READ_FRAMEBUFFER {
            planted.framebuffer = framebuffer;
            planted.cleared = false;
        }
        if target != glow::DRAW_FRAMEBUFFER {
            planted.source = framebuffer;
        }
        if target == glow::FRAMEBUFFER {
            planted.calls.draws = 0;
            for open in planted.calls.queries_after_pass() {
                driver!(planted.driver, glEndQuery(open.owner as u32));
            }
        }
    }
    instead glClearBufferfv(buffer: u32, index: i32, value: *const f32) |planted| {
        // SAFETY: a colour has four components.
        let color = (buffer == glow::COLOR).then(|| unsafe { *value.cast::<[u32; 4]>() });
        let spoils = buffer == glow::DEPTH && planted.calls.has(CallFault::StencilWithDepth);
        if buffer == glow::COLOR && index > 0 && planted.calls.has(CallFault::ClearFirstTarget) {
            return;
        }
        planted.clear(color, |driver| {
            driver!(driver, glClearBufferfv(buffer, index, value));
            if spoils {
                driver!(driver, glClearBufferiv(glow::STENCIL, 0, &0));
            }
        });
    }
    instead glClearBufferuiv(buffer: u32, index: i32, value: *const u32) |planted| {
        // SAFETY: as above.
        let color = unsafe { *value.cast::<[u32; 4]>() };
        planted.clear(Some(color), |driver| driver!(driver, glClearBufferuiv(buffer, index, value)));
    }
    instead glClearBufferiv(buffer: u32, index: i32, value: *const i32) |planted| {
        planted.clear(None, |driver| driver!(driver, glClearBufferiv(buffer, index, value)));
    }
    instead glClearBufferfi(buffer: u32, index: i32, depth: f32, stencil: i32) |planted| {
        planted.clear(None, |driver| driver!(driver, glClearBufferfi(buffer, index, depth, stencil)));
    }
    before glBlitFramebuffer(
        x0: i32, y0: i32, x1: i32, y1: i32, to_x0: i32, to_y0: i32, to_x1: i32, to_y1: i32, mask: u32, filter: u32
    ) |planted| {
        planted.blits += 1;
        // Read-back also blits, after the end of a submission.
        if planted.calls.has(CallFault::ResolveFirst) && planted.blits > 1 && planted.calls.passes > 0 {
            return;
        }
        let is_empty = planted.calls.passes > 0 && planted.calls.draws == 0;
        if planted.calls.has(CallFault::EmptyResolve) && is_empty {
            return;
        }
        if planted.calls.has(CallFault::BlitColumn) {
            (x1, to_x1) = (x1 - 1, to_x1 - 1);
        }
        if planted.calls.has(CallFault::BlitReadsFirst) && planted.read > glow::COLOR_ATTACHMENT0 {
            driver!(planted.driver, glReadBuffer(glow::COLOR_ATTACHMENT0));
        }
        if planted.calls.has(CallFault::BlitMirror) {
            [x0, x1] = [x0.min(x1), x0.max(x1)];
            [y0, y1] = [y0.min(y1), y0.max(y1)];
            [to_x0, to_x1] = [to_x0.min(to_x1), to_x0.max(to_x1)];
            [to_y0, to_y1] = [to_y0.min(to_y1), to_y0.max(to_y1)];
        }
        if planted.calls.has(CallFault::BlitScale) {
            (to_x1, to_y1) = (to_x0 + x1 - x0, to_y0 + y1 - y0);
        }
        if planted.calls.has(CallFault::BlitFilter) {
            filter = glow::NEAREST;
        }
        if planted.calls.has(CallFault::BlitPlace) {
            (to_x1, to_y1) = (to_x1 - to_x0, to_y1 - to_y0);
            (to_x0, to_y0) = (0, 0);
        }
        let alone = [glow::DEPTH_BUFFER_BIT, glow::STENCIL_BUFFER_BIT].contains(&mask);
        let moves = [x0, y0] != [to_x0, to_y0];
        if planted.calls.has(CallFault::BlitAspectAlone) && alone && moves {
            return;
        }
        if planted.calls.has(CallFault::ResolvePlace) && planted.multisampled.contains(&planted.source) {
            [to_x0, to_y0, to_x1, to_y1] = [x0, y0, x1, y1];
        }
    }
    instead glBeginQuery(target: u32, query: u32) |planted| {
        driver!(planted.driver, glBeginQuery(target, query));
        if target != glow::TIME_ELAPSED {
            planted.calls.begin_query(query);
            planted.calls.open_query(target.into(), query, true);
            if planted.calls.ends_query_early() {
                driver!(planted.driver, glEndQuery(target));
            }
        }
    }
    before glEndQuery(target: u32) |planted| {
        let ended = planted.calls.close_query(target.into(), None);
        if target != glow::TIME_ELAPSED && (ended || planted.calls.ends_query_early()) {
            return;
        }
    }
    instead glGetQueryObjectui64v | glGetQueryObjectui64vEXT(query: u32, what: u32, result: *mut u64) |planted| {
        let answering = planted.answering(query);
        driver!(planted.driver, glGetQueryObjectui64v(answering, what, result));
        // SAFETY: upheld by the caller; the driver wrote the result.
        unsafe { *result = planted.calls.result(0, query, *result) };
    }
    instead glGetQueryObjectuiv(query: u32, what: u32, result: *mut u32) |planted| {
        let answering = planted.answering(query);
        driver!(planted.driver, glGetQueryObjectuiv(answering, what, result));
        // SAFETY: as above.
        unsafe { *result = planted.calls.result(0, query, (*result).into()) as u32 };
    }
    before glFinish() |planted| {
        planted.calls.end_submission();
        planted.blits = 0;
    }
    before glMultiDrawArraysIndirectCount | glMultiDrawArraysIndirectCountARB(
        mode: u32, place: PlantedPointer, count: isize, most: i32, stride: i32
    ) |planted| {
        if planted.calls.has(CallFault::IndirectFewer) {
            return;
        }
    }
    before glMultiDrawElementsIndirectCount | glMultiDrawElementsIndirectCountARB(
        mode: u32, kind: u32, place: PlantedPointer, count: isize, most: i32, stride: i32
    ) |planted| {
        if planted.calls.has(CallFault::IndirectFewer) {
            return;
        }
    }
    instead glDrawArrays(mode: u32, first: i32, count: i32) |planted| {
        planted.draw(arrays(mode, count), |driver, numbers| driver!(driver, glDrawArrays(mode, first, numbers.count)));
    }
    instead glDrawArraysInstanced(mode: u32, first: i32, count: i32, instances: i32) |planted| {
        planted.draw(DrawNumbers { instances, ..arrays(mode, count) }, |driver, numbers| {
            driver!(driver, glDrawArraysInstanced(mode, first, numbers.count, numbers.instances));
        });
    }
    instead glDrawArraysInstancedBaseInstance(
        mode: u32, first: i32, count: i32, instances: i32, first_instance: u32
    ) |planted| {
        planted.draw(DrawNumbers { instances, first_instance, ..arrays(mode, count) }, |driver, numbers| {
            let (instances, base) = (numbers.instances, numbers.first_instance);
            driver!(driver, glDrawArraysInstancedBaseInstance(mode, first, numbers.count, instances, base));
        });
    }
    instead glDrawElements(mode: u32, count: i32, kind: u32, start: PlantedPointer) |planted| {
        planted.draw(elements(mode, count, kind, start), |driver, numbers| {
            driver!(driver, glDrawElements(mode, numbers.count, kind, place(numbers, kind)));
        });
    }
    instead glDrawElementsBaseVertex(mode: u32, count: i32, kind: u32, at: PlantedPointer, base_vertex: i32) |planted| {
        planted.draw(DrawNumbers { base_vertex, ..elements(mode, count, kind, at) }, |driver, numbers| {
            driver!(driver, glDrawElementsBaseVertex(mode, numbers.count, kind, place(numbers, kind), numbers.base_vertex));
        });
    }
    instead glDrawElementsInstanced(mode: u32, count: i32, kind: u32, at: PlantedPointer, instances: i32) |planted| {
        planted.draw(DrawNumbers { instances, ..elements(mode, count, kind, at) }, |driver, numbers| {
            driver!(driver, glDrawElementsInstanced(mode, numbers.count, kind, place(numbers, kind), numbers.instances));
        });
    }
    instead glDrawElementsInstancedBaseVertex(
        mode: u32, count: i32, kind: u32, at: PlantedPointer, instances: i32, base_vertex: i32
    ) |planted| {
        planted.draw(DrawNumbers { instances, base_vertex, ..elements(mode, count, kind, at) }, |driver, numbers| {
            let (start, instances, base) = (place(numbers, kind), numbers.instances, numbers.base_vertex);
            driver!(driver, glDrawElementsInstancedBaseVertex(mode, numbers.count, kind, start, instances, base));
        });
    }
    instead glDrawElementsInstancedBaseVertexBaseInstance(
        mode: u32, count: i32, kind: u32, at: PlantedPointer, instances: i32, base_vertex: i32, first_instance: u32
    ) |planted| {
        let numbers = elements(mode, count, kind, at);
        planted.draw(DrawNumbers { instances, base_vertex, first_instance, ..numbers }, |driver, numbers| {
            let (start, instances, base) = (place(numbers, kind), numbers.instances, numbers.base_vertex);
            driver!(driver, glDrawElementsInstancedBaseVertexBaseInstance(
                mode, numbers.count, kind, start, instances, base, numbers.first_instance
            ));
        });
    }
}

/// Returns the numbers of a draw that has no indices, instances or offsets.
fn arrays(mode: u32, count: i32) -> DrawNumbers {
    DrawNumbers {
        indexed: false,
        thin: [glow::POINTS, glow::LINES, glow::LINE_STRIP].contains(&mode),
        count,
        instances: 1,
        first: 0,
        base_vertex: 0,
        first_instance: 0,
    }
}

/// Returns the numbers of a draw with indices of this type, which begin at this offset.
fn elements(mode: u32, count: i32, kind: u32, place: PlantedPointer) -> DrawNumbers {
    DrawNumbers {
        indexed: true,
        first: (place.addr() / index_bytes(kind)) as i32,
        ..arrays(mode, count)
    }
}

/// Returns the offset of the first index, as a pointer.
fn place(numbers: &DrawNumbers, kind: u32) -> PlantedPointer {
    ptr::without_provenance(numbers.first as usize * index_bytes(kind))
}

/// Returns the size of an index in bytes.
fn index_bytes(kind: u32) -> usize {
    if kind == glow::UNSIGNED_SHORT { 2 } else { 4 }
}

impl Planted {
    fn switch(&mut self, capability: u32, mut on: bool) {
        if capability == glow::SCISSOR_TEST {
            self.calls.scissor_on = on;
        }
        if capability == glow::CULL_FACE {
            on = self.calls.kept(CallFault::CullKept, 1, on);
        }
        let restart = [glow::PRIMITIVE_RESTART, glow::PRIMITIVE_RESTART_FIXED_INDEX];
        if capability == glow::PRIMITIVE_RESTART {
            self.restarts = on;
        }
        on &= !(restart.contains(&capability) && self.calls.has(CallFault::RestartIgnored));
        if on {
            driver!(self.driver, glEnable(capability));
        } else {
            driver!(self.driver, glDisable(capability));
        }
    }

    /// Draws with the numbers that the fault leaves, in parts if the fault asks for it.
    fn draw(&mut self, mut numbers: DrawNumbers, draw: impl Fn(&Driver, &DrawNumbers)) {
        if self.calls.draws == 0 {
            self.calls.begin_pass();
        }
        self.blits = 0;
        if self.calls.has(CallFault::RestartUnindexed) && self.restarts && !numbers.indexed {
            numbers.count -= 1;
        }
        let driver = self.driver;
        for open in self.calls.queries_before_draw() {
            driver!(driver, glEndQuery(open.owner as u32));
            driver!(driver, glBeginQuery(open.owner as u32, open.query));
        }
        let set_scissor = |[x, y, w, h]: [i32; 4]| {
            driver!(driver, glEnable(glow::SCISSOR_TEST));
            driver!(driver, glScissor(x, y, w, h));
        };
        let draw = |numbers: &DrawNumbers| draw(&driver, numbers);
        self.calls.draw(numbers, set_scissor, draw);
        for open in self.calls.queries_after_draw() {
            driver!(driver, glEndQuery(open.owner as u32));
        }
        if self.calls.scissor_on {
            set_scissor(self.calls.scissor);
        } else {
            driver!(driver, glDisable(glow::SCISSOR_TEST));
        }
    }

    /// Runs a clear unless the fault skips it. `color` is the value of a colour clear. If the fault asks for
    /// it, the scissor test is disabled during the clear.
    fn clear(&mut self, color: Option<[u32; 4]>, clear: impl FnOnce(&Driver)) {
        if self.calls.has(CallFault::ClearSkipped) && self.calls.passes > 0 {
            return;
        }
        self.calls.note_clear();
        let undefined = std::mem::take(&mut self.undefined);
        if undefined && self.calls.has(CallFault::ClearUndefinedSkipped) {
            return;
        }
        let image = u64::from(self.framebuffer);
        if color.is_some_and(|color| self.calls.skips_equal_clear(image, color)) {
            return;
        }
        // The fault clears only the first layer, which is never read, so the whole clear is skipped.
        if self.calls.has(CallFault::ClearFirstLayer) && self.layered.contains(&self.framebuffer) {
            return;
        }
        self.cleared = true;
        let unbounded = self.calls.has(CallFault::ClearRect) && self.calls.scissor_on;
        if unbounded {
            driver!(self.driver, glDisable(glow::SCISSOR_TEST));
        }
        clear(&self.driver);
        if unbounded {
            driver!(self.driver, glEnable(glow::SCISSOR_TEST));
        }
    }

    /// Returns the query whose result the driver returns for this query.
    fn answering(&self, query: u32) -> u32 {
        match self.calls.queries.first() {
            Some(first)
                if self.calls.has(CallFault::QueryFirst) && self.calls.queries.contains(&query) =>
            {
                *first
            }
            _ => query,
        }
    }
}
