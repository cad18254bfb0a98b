//! Entry points with a planted fault, for tests of the suite.
//!
//! A backend that is opened with one finds these functions where the driver's would be. They have the
//! driver's signatures and nothing else to tell contexts apart, so the driver's own functions and what was
//! seen of the calls are kept per thread: a context belongs to one thread. The rest of the backend is the
//! one that releases have.

use etalon_backend::CallFault;
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::{CStr, c_void};

thread_local! {
    static PLANTED: RefCell<Option<Planted>> = const { RefCell::new(None) };
}

type Pointer = *const c_void;

/// Declares the functions that stand before the driver's: the type of each, and the fields that keep the
/// driver's own.
macro_rules! functions {
    ($($field:ident $kind:ident $faulty:path: $($name:literal)|+ = ($($arg:ty),*);)+) => {
        $(type $kind = unsafe extern "system" fn($($arg),*);)+

        /// The driver's own functions.
        #[derive(Clone, Copy, Default)]
        struct Driver {
            $($field: Option<$kind>,)+
        }

        /// Returns the address of a function with the fault in it, or the driver's.
        fn replaced(planted: &mut Planted, name: &CStr, address: Pointer) -> Pointer {
            match name.to_bytes() {
                $($($name)|+ => {
                    // SAFETY: the specification gives this name this type, and the address is not null.
                    let own = unsafe { std::mem::transmute::<Pointer, $kind>(address) };
                    planted.driver.$field = Some(own);
                    let faulty: $kind = $faulty;
                    faulty as Pointer
                })+
                _ => address,
            }
        }
    };
}

functions! {
    enable Enable enable: b"glEnable" = (u32);
    disable Disable disable: b"glDisable" = (u32);
    scissor Scissor scissor: b"glScissor" = (i32, i32, i32, i32);
    viewport Viewport viewport: b"glViewport" = (i32, i32, i32, i32);
    viewport_indexed ViewportIndexed viewport_indexed:
        b"glViewportIndexedf" | b"glViewportIndexedfOES" = (u32, f32, f32, f32, f32);
    depth_func DepthFunc depth_func: b"glDepthFunc" = (u32);
    depth_mask DepthMask depth_mask: b"glDepthMask" = (u8);
    cull_face CullFace cull_face: b"glCullFace" = (u32);
    stencil_func StencilFunc stencil_func: b"glStencilFuncSeparate" = (u32, u32, i32, u32);
    blend_color BlendColor blend_color: b"glBlendColor" = (f32, f32, f32, f32);
    bind_framebuffer BindFramebuffer bind_framebuffer: b"glBindFramebuffer" = (u32, u32);
    clear_f32 ClearF32 clear_f32: b"glClearBufferfv" = (u32, i32, *const f32);
    clear_u32 ClearU32 clear_u32: b"glClearBufferuiv" = (u32, i32, *const u32);
    clear_i32 ClearI32 clear_i32: b"glClearBufferiv" = (u32, i32, *const i32);
    clear_both ClearBoth clear_both: b"glClearBufferfi" = (u32, i32, f32, i32);
    blit Blit blit: b"glBlitFramebuffer" =
        (i32, i32, i32, i32, i32, i32, i32, i32, u32, u32);
    attach_layer AttachLayer attach_layer: b"glFramebufferTextureLayer" = (u32, u32, u32, i32, i32);
    attach_image AttachImage attach_image: b"glFramebufferTexture2D" = (u32, u32, u32, u32, i32);
    viewport_array ViewportArray viewport_array:
        b"glViewportArrayv" | b"glViewportArrayvOES" = (u32, i32, *const f32);
    clip_control ClipControl clip_control:
        b"glClipControl" | b"glClipControlEXT" = (u32, u32);
    begin_query BeginQuery begin_query: b"glBeginQuery" = (u32, u32);
    end_query EndQuery end_query: b"glEndQuery" = (u32);
    query_u64 QueryU64 query_u64:
        b"glGetQueryObjectui64v" | b"glGetQueryObjectui64vEXT" = (u32, u32, *mut u64);
    query_u32 QueryU32 query_u32: b"glGetQueryObjectuiv" = (u32, u32, *mut u32);
    finish Finish finish: b"glFinish" = ();
    arrays Arrays arrays: b"glDrawArrays" = (u32, i32, i32);
    arrays_instanced ArraysInstanced arrays_instanced:
        b"glDrawArraysInstanced" = (u32, i32, i32, i32);
    arrays_base ArraysBase arrays_base:
        b"glDrawArraysInstancedBaseInstance" = (u32, i32, i32, i32, u32);
    elements Elements elements: b"glDrawElements" = (u32, i32, u32, Pointer);
    elements_moved ElementsMoved elements_moved:
        b"glDrawElementsBaseVertex" = (u32, i32, u32, Pointer, i32);
    elements_instanced ElementsInstanced elements_instanced:
        b"glDrawElementsInstanced" = (u32, i32, u32, Pointer, i32);
    elements_instanced_moved ElementsInstancedMoved elements_instanced_moved:
        b"glDrawElementsInstancedBaseVertex" = (u32, i32, u32, Pointer, i32, i32);
    elements_base ElementsBase elements_base:
        b"glDrawElementsInstancedBaseVertexBaseInstance" =
        (u32, i32, u32, Pointer, i32, i32, u32);
}

/// The driver's functions, and what was seen of the calls.
struct Planted {
    fault: CallFault,
    armed: bool,
    driver: Driver,
    /// The framebuffers that were bound before a draw, of this submission.
    passes: u32,
    /// The draws since a framebuffer was bound.
    draws: u32,
    /// The draws of this submission.
    all_draws: u32,
    /// The resolves since the last draw.
    blits: u32,
    /// The queries of this submission.
    queries: Vec<u32>,
    framebuffer: u32,
    scissor: Option<[i32; 4]>,
    scissor_on: bool,
    viewport: [i32; 4],
    kept: Kept,
    /// The last clear value of each framebuffer, as bits.
    cleared: HashMap<u32, [u32; 4]>,
}

/// The state of the draw before.
#[derive(Default)]
struct Kept {
    compare: Option<u32>,
    write: Option<u8>,
    cull: Option<u32>,
    culls: Option<bool>,
    scissor: Option<[i32; 4]>,
    references: HashMap<u32, i32>,
    constants: Option<[f32; 4]>,
    viewport: Option<[f32; 4]>,
}

/// Prepares a fault for the context that is opened on this thread; `None` opens one without.
pub(crate) fn plant(fault: Option<CallFault>) {
    PLANTED.set(fault.map(|fault| Planted {
        fault,
        armed: false,
        driver: Driver::default(),
        passes: 0,
        draws: 0,
        all_draws: 0,
        blits: 0,
        queries: Vec::new(),
        framebuffer: 0,
        scissor: None,
        scissor_on: false,
        viewport: [0; 4],
        kept: Kept::default(),
        cleared: HashMap::new(),
    }));
}

/// Lets the fault act.
pub(crate) fn arm() {
    with(|p| p.armed = true);
}

/// Returns the address under which the backend finds an entry point.
pub(crate) fn address(name: &CStr, address: Pointer) -> Pointer {
    if address.is_null() {
        return address;
    }
    with(|p| replaced(p, name, address)).unwrap_or(address)
}

fn with<R>(call: impl FnOnce(&mut Planted) -> R) -> Option<R> {
    PLANTED.with_borrow_mut(|planted| planted.as_mut().map(call))
}

/// Returns the value of the call before, and keeps this one for the next.
fn lag<T: Copy>(kept: &mut Option<T>, value: T) -> T {
    kept.replace(value).unwrap_or(value)
}

/// The numbers of a draw call.
#[derive(Clone, Copy)]
struct Call {
    mode: u32,
    count: i32,
    /// The type of indices, and the place of the first.
    indices: Option<(u32, Pointer)>,
    instances: i32,
    base_vertex: i32,
    first_instance: u32,
}

impl Planted {
    fn has(&self, fault: CallFault) -> bool {
        self.armed && self.fault == fault
    }

    /// Returns the parts of the viewport that draws reach: left, top, right and bottom.
    fn parts(&self) -> Vec<[i32; 4]> {
        let [x, y, w, h] = self.viewport;
        let (right, bottom) = (x + w, y + h);
        match self.fault {
            _ if !self.armed => Vec::new(),
            CallFault::OnlyFirst64 => vec![[0, 0, 64, 64]],
            CallFault::LastRow => vec![[x, y, right, bottom - 1]],
            CallFault::LastColumn => vec![[x, y, right - 1, bottom]],
            CallFault::SecondTile => {
                vec![[0, 0, 32, 32], [64, 0, right, 32], [0, 32, right, bottom]]
            }
            _ => Vec::new(),
        }
    }

    /// Draws with changed numbers, in parts if the fault asks for it.
    fn draw(&mut self, mut call: Call, draw: impl Fn(&Driver, &Call)) {
        if self.draws == 0 {
            self.passes += 1;
        }
        self.draws += 1;
        self.all_draws += 1;
        self.blits = 0;
        let lost = (self.has(CallFault::Draw256) && self.draws == 256)
            || (self.has(CallFault::LaterPassDraw) && self.draws == 1 && self.passes > 1);
        if lost {
            return;
        }
        let line = [glow::POINTS, glow::LINES, glow::LINE_STRIP].contains(&call.mode);
        match self.fault {
            _ if !self.armed => {}
            CallFault::Indices65535 if call.indices.is_some() => {
                call.count = call.count.min(65_535)
            }
            CallFault::Vertices4096 if call.indices.is_none() => {
                call.count = call.count.min(4_096);
            }
            CallFault::Lines500 if line => call.count = call.count.min(500),
            CallFault::SecondInstance => call.instances = call.instances.min(1),
            CallFault::BaseVertex => call.base_vertex = 0,
            CallFault::FirstInstance => call.first_instance = 0,
            CallFault::IndexOffset => {
                if let Some((_, at)) = &mut call.indices {
                    *at = std::ptr::null();
                }
            }
            CallFault::FirstIndex => {
                if let Some((kind, at)) = &mut call.indices
                    && !at.is_null()
                    && call.count > 0
                {
                    let size = if *kind == glow::UNSIGNED_SHORT { 2 } else { 4 };
                    *at = at.wrapping_byte_add(size);
                    call.count -= 1;
                }
            }
            _ => {}
        }
        let parts = self.parts();
        let driver = self.driver;
        let (Some(scissor), Some(enable), Some(disable)) =
            (driver.scissor, driver.enable, driver.disable)
        else {
            return;
        };
        if parts.is_empty() {
            draw(&driver, &call);
            return;
        }
        for [left, top, right, bottom] in parts {
            let mut part = [left, top, right, bottom];
            if let Some([x, y, w, h]) = self.scissor.filter(|_| self.scissor_on) {
                part = [
                    left.max(x),
                    top.max(y),
                    right.min(x.saturating_add(w)),
                    bottom.min(y.saturating_add(h)),
                ];
            }
            let [x, y, right, bottom] = part;
            let (w, h) = ((right - x).max(0), (bottom - y).max(0));
            // SAFETY: the context is current: the backend has just called a function of it.
            unsafe {
                enable(glow::SCISSOR_TEST);
                scissor(x, y, w, h);
            }
            draw(&driver, &call);
        }
        // SAFETY: as above.
        unsafe {
            if !self.scissor_on {
                disable(glow::SCISSOR_TEST);
            }
            if let Some([x, y, w, h]) = self.scissor {
                scissor(x, y, w, h);
            }
        }
    }

    /// True if a clear is skipped; `value` is that of a colour clear.
    fn skips_clear(&mut self, value: Option<[u32; 4]>) -> bool {
        if self.has(CallFault::ClearSkipped) && self.all_draws > 0 {
            return true;
        }
        let Some(value) = value else { return false };
        let before = self.cleared.insert(self.framebuffer, value);
        self.has(CallFault::EqualClearSkipped) && before == Some(value)
    }

    /// Runs a clear, without its rectangle if the fault asks for it.
    fn clear(&self, clear: impl FnOnce(&Driver)) {
        let unbounded = self.has(CallFault::ClearRect) && self.scissor_on;
        let switch = |function: Option<Enable>| {
            if let Some(function) = function.filter(|_| unbounded) {
                // SAFETY: the context is current: the backend has just called a function of it.
                unsafe { function(glow::SCISSOR_TEST) };
            }
        };
        switch(self.driver.disable);
        clear(&self.driver);
        switch(self.driver.enable);
    }
}

/// Calls one of the driver's functions.
macro_rules! driver {
    ($driver:expr, $field:ident($($arg:expr),*)) => {
        if let Some(function) = $driver.$field {
            // SAFETY: the function has the type of the driver's of its name, whose arguments the caller
            // passes on as they are or made from valid ones.
            unsafe { function($($arg),*) }
        }
    };
}

unsafe extern "system" fn enable(capability: u32) {
    with(|p| {
        switch(p, capability, true);
    });
}

unsafe extern "system" fn disable(capability: u32) {
    with(|p| {
        switch(p, capability, false);
    });
}

fn switch(p: &mut Planted, capability: u32, mut on: bool) {
    if capability == glow::SCISSOR_TEST {
        p.scissor_on = on;
    }
    if capability == glow::CULL_FACE && p.has(CallFault::CullKept) {
        on = lag(&mut p.kept.culls, on);
    }
    let restart = [glow::PRIMITIVE_RESTART, glow::PRIMITIVE_RESTART_FIXED_INDEX];
    on &= !(restart.contains(&capability) && p.has(CallFault::RestartIgnored));
    if on {
        driver!(p.driver, enable(capability));
    } else {
        driver!(p.driver, disable(capability));
    }
}

unsafe extern "system" fn scissor(x: i32, y: i32, w: i32, h: i32) {
    with(|p| {
        let mut rect = [x, y, w, h];
        if p.has(CallFault::ScissorKept) {
            rect = lag(&mut p.kept.scissor, rect);
        }
        let right = rect[0].saturating_add(rect[2]);
        if p.has(CallFault::ScissorEdge) && right % 16 == 0 {
            rect[2] = (rect[2] - 1).max(0);
        }
        p.scissor = Some(rect);
        driver!(p.driver, scissor(rect[0], rect[1], rect[2], rect[3]));
    });
}

unsafe extern "system" fn viewport(x: i32, y: i32, w: i32, h: i32) {
    with(|p| {
        p.viewport = [x, y, w, h];
        let mut rect = p.viewport.map(|v| v as f32);
        if p.has(CallFault::ViewportKept) {
            rect = lag(&mut p.kept.viewport, rect);
        }
        let [x, y, w, h] = rect.map(|v| v as i32);
        driver!(p.driver, viewport(x, y, w, h));
    });
}

unsafe extern "system" fn viewport_indexed(index: u32, x: f32, y: f32, w: f32, h: f32) {
    with(|p| {
        p.viewport = [x, y, w, h].map(|v| v as i32);
        let mut rect = [x, y, w, h];
        if p.has(CallFault::ViewportKept) {
            rect = lag(&mut p.kept.viewport, rect);
        }
        let [x, y, w, h] = rect;
        driver!(p.driver, viewport_indexed(index, x, y, w, h));
    });
}

unsafe extern "system" fn viewport_array(first: u32, count: i32, viewports: *const f32) {
    with(|p| {
        if p.has(CallFault::ViewportFirst) && count == 2 {
            // SAFETY: a viewport has four components.
            let same = [[0, 1, 2, 3].map(|c| unsafe { *viewports.add(c) }); 2];
            driver!(p.driver, viewport_array(first, count, same.as_ptr().cast()));
        } else {
            driver!(p.driver, viewport_array(first, count, viewports));
        }
    });
}

unsafe extern "system" fn clip_control(origin: u32, depth: u32) {
    with(|p| {
        let kept = p.has(CallFault::ClipOriginKept);
        let origin = if kept { glow::UPPER_LEFT } else { origin };
        driver!(p.driver, clip_control(origin, depth));
    });
}

unsafe extern "system" fn attach_layer(
    target: u32,
    point: u32,
    texture: u32,
    level: i32,
    layer: i32,
) {
    with(|p| {
        let (mut level, mut layer) = (level, layer);
        if p.has(CallFault::LayerDropped) {
            layer = 0;
        }
        if p.has(CallFault::LevelDropped) {
            level = 0;
        }
        driver!(p.driver, attach_layer(target, point, texture, level, layer));
    });
}

unsafe extern "system" fn attach_image(
    target: u32,
    point: u32,
    image: u32,
    texture: u32,
    level: i32,
) {
    with(|p| {
        let (mut image, mut level) = (image, level);
        let faces = glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z;
        if p.has(CallFault::FaceDropped) && faces.contains(&image) {
            image = glow::TEXTURE_CUBE_MAP_POSITIVE_X;
        }
        if p.has(CallFault::LevelDropped) {
            level = 0;
        }
        driver!(p.driver, attach_image(target, point, image, texture, level));
    });
}

unsafe extern "system" fn depth_func(compare: u32) {
    with(|p| {
        let mut used = compare;
        if p.has(CallFault::CompareKept) {
            used = lag(&mut p.kept.compare, compare);
        }
        driver!(p.driver, depth_func(used));
    });
}

unsafe extern "system" fn depth_mask(write: u8) {
    with(|p| {
        let mut used = write;
        if p.has(CallFault::DepthWriteKept) {
            used = lag(&mut p.kept.write, write);
        }
        driver!(p.driver, depth_mask(used));
    });
}

unsafe extern "system" fn cull_face(face: u32) {
    with(|p| {
        let mut used = face;
        if p.has(CallFault::CullKept) {
            used = lag(&mut p.kept.cull, face);
        }
        driver!(p.driver, cull_face(used));
    });
}

unsafe extern "system" fn stencil_func(face: u32, compare: u32, reference: i32, mask: u32) {
    with(|p| {
        let mut used = reference;
        if p.has(CallFault::StencilReferenceKept) {
            used = p
                .kept
                .references
                .insert(face, reference)
                .unwrap_or(reference);
        }
        driver!(p.driver, stencil_func(face, compare, used, mask));
    });
}

unsafe extern "system" fn blend_color(r: f32, g: f32, b: f32, a: f32) {
    with(|p| {
        let mut color = [r, g, b, a];
        if p.has(CallFault::BlendConstantKept) {
            color = lag(&mut p.kept.constants, color);
        }
        let [r, g, b, a] = color;
        driver!(p.driver, blend_color(r, g, b, a));
    });
}

unsafe extern "system" fn bind_framebuffer(target: u32, framebuffer: u32) {
    with(|p| {
        if target != glow::READ_FRAMEBUFFER {
            p.framebuffer = framebuffer;
        }
        if target == glow::FRAMEBUFFER {
            p.draws = 0;
        }
        driver!(p.driver, bind_framebuffer(target, framebuffer));
    });
}

unsafe extern "system" fn clear_f32(buffer: u32, index: i32, value: *const f32) {
    with(|p| {
        let color = (buffer == glow::COLOR).then(|| {
            // SAFETY: a colour has four components.
            [0, 1, 2, 3].map(|c| unsafe { *value.add(c) }.to_bits())
        });
        if p.skips_clear(color) {
            return;
        }
        let spoils = buffer == glow::DEPTH && p.has(CallFault::StencilWithDepth);
        p.clear(|driver| {
            driver!(driver, clear_f32(buffer, index, value));
            if spoils {
                let zero = 0;
                driver!(driver, clear_i32(glow::STENCIL, 0, &raw const zero));
            }
        });
    });
}

unsafe extern "system" fn clear_u32(buffer: u32, index: i32, value: *const u32) {
    with(|p| {
        // SAFETY: a colour has four components.
        let color = [0, 1, 2, 3].map(|c| unsafe { *value.add(c) });
        if !p.skips_clear(Some(color)) {
            p.clear(|driver| driver!(driver, clear_u32(buffer, index, value)));
        }
    });
}

unsafe extern "system" fn clear_i32(buffer: u32, index: i32, value: *const i32) {
    with(|p| {
        if !p.skips_clear(None) {
            p.clear(|driver| driver!(driver, clear_i32(buffer, index, value)));
        }
    });
}

unsafe extern "system" fn clear_both(buffer: u32, index: i32, depth: f32, stencil: i32) {
    with(|p| {
        if !p.skips_clear(None) {
            p.clear(|driver| driver!(driver, clear_both(buffer, index, depth, stencil)));
        }
    });
}

unsafe extern "system" fn blit(
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
    to_x0: i32,
    to_y0: i32,
    to_x1: i32,
    to_y1: i32,
    mask: u32,
    filter: u32,
) {
    with(|p| {
        p.blits += 1;
        // Reading back comes after the end of a submission and blits too.
        if p.has(CallFault::ResolveFirst) && p.blits > 1 && p.all_draws > 0 {
            return;
        }
        let column = i32::from(p.has(CallFault::BlitColumn));
        let (x1, to_x1) = (x1 - column, to_x1 - column);
        driver!(
            p.driver,
            blit(x0, y0, x1, y1, to_x0, to_y0, to_x1, to_y1, mask, filter)
        );
    });
}

/// True for the queries of counters.
fn counts(target: u32) -> bool {
    target != glow::TIME_ELAPSED
}

unsafe extern "system" fn begin_query(target: u32, query: u32) {
    with(|p| {
        driver!(p.driver, begin_query(target, query));
        if counts(target) {
            if p.all_draws == 0 {
                p.queries.clear();
            }
            p.queries.push(query);
            if p.has(CallFault::QueryEarly) && p.queries.len() > 1 {
                driver!(p.driver, end_query(target));
            }
        }
    });
}

unsafe extern "system" fn end_query(target: u32) {
    with(|p| {
        if !(counts(target) && p.has(CallFault::QueryEarly) && p.queries.len() > 1) {
            driver!(p.driver, end_query(target));
        }
    });
}

/// Returns the query whose result is that of another.
fn answering(p: &Planted, query: u32) -> u32 {
    match p.queries.first() {
        Some(first) if p.has(CallFault::QueryFirst) && p.queries.contains(&query) => *first,
        _ => query,
    }
}

unsafe extern "system" fn query_u64(query: u32, what: u32, result: *mut u64) {
    with(|p| driver!(p.driver, query_u64(answering(p, query), what, result)));
}

unsafe extern "system" fn query_u32(query: u32, what: u32, result: *mut u32) {
    with(|p| driver!(p.driver, query_u32(answering(p, query), what, result)));
}

/// The end of a submission.
unsafe extern "system" fn finish() {
    with(|p| {
        (p.passes, p.draws, p.all_draws, p.blits) = (0, 0, 0, 0);
        p.kept = Kept::default();
        driver!(p.driver, finish());
    });
}

unsafe extern "system" fn arrays(mode: u32, first: i32, count: i32) {
    with(|p| {
        p.draw(plain(mode, count, None), |driver, call| {
            driver!(driver, arrays(mode, first, call.count));
        });
    });
}

unsafe extern "system" fn arrays_instanced(mode: u32, first: i32, count: i32, instances: i32) {
    let call = Call {
        instances,
        ..plain(mode, count, None)
    };
    with(|p| {
        p.draw(call, |driver, call| {
            let instances = call.instances;
            driver!(driver, arrays_instanced(mode, first, call.count, instances));
        });
    });
}

unsafe extern "system" fn arrays_base(
    mode: u32,
    first: i32,
    count: i32,
    instances: i32,
    first_instance: u32,
) {
    let call = Call {
        instances,
        first_instance,
        ..plain(mode, count, None)
    };
    with(|p| {
        p.draw(call, |driver, call| {
            let (instances, base) = (call.instances, call.first_instance);
            driver!(
                driver,
                arrays_base(mode, first, call.count, instances, base)
            );
        });
    });
}

fn plain(mode: u32, count: i32, indices: Option<(u32, Pointer)>) -> Call {
    Call {
        mode,
        count,
        indices,
        instances: 1,
        base_vertex: 0,
        first_instance: 0,
    }
}

unsafe extern "system" fn elements(mode: u32, count: i32, kind: u32, at: Pointer) {
    draw_elements(plain(mode, count, Some((kind, at))), |driver, call, at| {
        driver!(driver, elements(call.mode, call.count, kind, at));
    });
}

/// Draws with indices.
fn draw_elements(call: Call, draw: impl Fn(&Driver, &Call, Pointer)) {
    with(|p| {
        p.draw(call, |driver, call| {
            if let Some((_, at)) = call.indices {
                draw(driver, call, at);
            }
        });
    });
}

unsafe extern "system" fn elements_moved(
    mode: u32,
    count: i32,
    kind: u32,
    at: Pointer,
    base_vertex: i32,
) {
    let call = Call {
        base_vertex,
        ..plain(mode, count, Some((kind, at)))
    };
    draw_elements(call, |driver, call, at| {
        let base = call.base_vertex;
        driver!(
            driver,
            elements_moved(call.mode, call.count, kind, at, base)
        );
    });
}

unsafe extern "system" fn elements_instanced(
    mode: u32,
    count: i32,
    kind: u32,
    at: Pointer,
    instances: i32,
) {
    let call = Call {
        instances,
        ..plain(mode, count, Some((kind, at)))
    };
    draw_elements(call, |driver, call, at| {
        let n = call.instances;
        driver!(
            driver,
            elements_instanced(call.mode, call.count, kind, at, n)
        );
    });
}

unsafe extern "system" fn elements_instanced_moved(
    mode: u32,
    count: i32,
    kind: u32,
    at: Pointer,
    instances: i32,
    base_vertex: i32,
) {
    let call = Call {
        instances,
        base_vertex,
        ..plain(mode, count, Some((kind, at)))
    };
    draw_elements(call, |driver, call, at| {
        let (n, base) = (call.instances, call.base_vertex);
        driver!(
            driver,
            elements_instanced_moved(call.mode, call.count, kind, at, n, base)
        );
    });
}

unsafe extern "system" fn elements_base(
    mode: u32,
    count: i32,
    kind: u32,
    at: Pointer,
    instances: i32,
    base_vertex: i32,
    first_instance: u32,
) {
    let call = Call {
        instances,
        base_vertex,
        first_instance,
        ..plain(mode, count, Some((kind, at)))
    };
    draw_elements(call, |driver, call, at| {
        let (n, base) = (call.instances, call.base_vertex);
        let first = call.first_instance;
        driver!(
            driver,
            elements_base(call.mode, call.count, kind, at, n, base, first)
        );
    });
}
