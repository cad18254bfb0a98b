//! Blits that move or filter the texels of an attachment before the host reads them.
//!
//! The source is the framebuffer that was drawn to; its read buffer is the attachment. A colour attachment is
//! copied to two draw buffers, and the second is read.

use crate::pool::PassFramebuffer;
use crate::read::{ReadObjects, ReadSource, bits, spoil};
use crate::state;
use crate::surface::{Surface, SurfaceKind};
use etalon_backend::{BackendError, Blit, Blits};
use etalon_frame::{Aspect, Image, PathEnd, PathValue, Requirement};
use glow::HasContext;

/// The destination of blits: a framebuffer and its surfaces. The last surface is read.
struct BlitDestination {
    target: PassFramebuffer,
    surfaces: Vec<Surface>,
}

impl ReadObjects<'_> {
    /// Returns the images of an attachment after blits that move its texels.
    pub(crate) fn moved(&mut self, source: &ReadSource<'_>) -> Result<Vec<Image>, BackendError> {
        let Some(blits) = Blits::new(source.end, source.size) else {
            return self.images_of(source);
        };
        let count = if source.format.is_color() { 2 } else { 1 };
        let destination = self.destination(source, blits.size(), count)?;
        for surface in &destination.surfaces {
            spoil(self.context, source.format, surface);
        }
        for blit in blits.blits(source.format.aspects()) {
            self.blit(
                source.drawn,
                destination.target.framebuffer,
                &blit,
                glow::NEAREST,
            );
        }
        self.read(source, destination, Some(blits))
    }

    /// Returns the images of a colour attachment after a blit with a linear filter. The filter averages each
    /// texel with a texel of zeros, and the result is doubled.
    pub(crate) fn filtered(&mut self, source: &ReadSource<'_>) -> Result<Vec<Image>, BackendError> {
        let [width, height] = source.size;
        let wide = self.destination(source, [2 * width, height], 1)?;
        let narrow = self.destination(source, source.size, 1)?;
        let gl = &self.context.gl;
        // SAFETY: the context is current and owns the framebuffer, and masks and scissor are open.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(wide.target.framebuffer));
            gl.clear_buffer_f32_slice(glow::COLOR, 0, &[0.0; 4]);
        }
        let aspects = vec![Aspect::Color];
        for x in 0..width {
            let column = |x: u32| [[x, 0], [x + 1, height]];
            let (from, to) = (column(x), column(2 * x));
            let blit = Blit {
                aspects: aspects.clone(),
                from,
                to,
            };
            self.blit(source.drawn, wide.target.framebuffer, &blit, glow::NEAREST);
        }
        let blit = Blit {
            aspects,
            from: [[0, 0], [2 * width, height]],
            to: [[0, 0], source.size],
        };
        let from = (wide.target.framebuffer, glow::COLOR_ATTACHMENT0);
        self.blit(from, narrow.target.framebuffer, &blit, glow::LINEAR);
        self.put_back(wide);
        let mut images = self.read(source, narrow, None)?;
        for image in &mut images {
            let channels = image.channels.clone();
            for (code, encoding) in image.codes.iter_mut().zip(channels.iter().cycle()) {
                *code = etalon_backend::doubled(*encoding, *code);
            }
        }
        Ok(images)
    }

    /// Returns a destination with `count` surfaces of the source's format.
    fn destination(
        &mut self,
        source: &ReadSource<'_>,
        size: [u32; 2],
        count: usize,
    ) -> Result<BlitDestination, BackendError> {
        let context = self.context;
        let kind = SurfaceKind::plain(source.format, 1);
        let mut surfaces = Vec::with_capacity(count);
        for _ in 0..count {
            surfaces.push(self.pool.surface(context, kind, size)?);
        }
        let (color, depth_stencil) = match &surfaces[..] {
            [surface] if !source.format.is_color() => (Vec::new(), Some(surface)),
            colors => (colors.iter().map(Some).collect(), None),
        };
        let target = self.pool.target(context, &color, depth_stencil, false)?;
        state::reset(context);
        let value = PathValue::End(source.end);
        let missing = BackendError::NotSupported(Requirement::Path(value));
        Ok(BlitDestination {
            target: target.ok_or(missing)?,
            surfaces,
        })
    }

    /// Blits from a framebuffer, whose read buffer is set to an attachment point, to another.
    fn blit(
        &self,
        from: (glow::Framebuffer, u32),
        to: glow::Framebuffer,
        blit: &Blit,
        filter: u32,
    ) {
        let gl = &self.context.gl;
        let (framebuffer, point) = from;
        let number = |place: u32| place as i32;
        let [[left, top], [right, bottom]] = blit.from.map(|corner| corner.map(number));
        let [[to_left, to_top], [to_right, to_bottom]] = blit.to.map(|corner| corner.map(number));
        let mask = bits(&blit.aspects);
        // SAFETY: the context is current and owns the framebuffers, and the source has the attachment point.
        unsafe {
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(framebuffer));
            if blit.aspects.contains(&Aspect::Color) {
                gl.read_buffer(point);
            }
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to));
            gl.blit_framebuffer(
                left, top, right, bottom, to_left, to_top, to_right, to_bottom, mask, filter,
            );
        }
    }

    /// Reads the last surface of a destination, and returns it to the pool.
    fn read(
        &mut self,
        source: &ReadSource<'_>,
        destination: BlitDestination,
        blits: Option<Blits>,
    ) -> Result<Vec<Image>, BackendError> {
        let images = match destination.surfaces.last() {
            Some(surface) => self.images_of(&ReadSource {
                surface,
                end: PathEnd::Store,
                blits,
                ..*source
            }),
            None => Err(BackendError::internal("a blit has no destination")),
        };
        self.put_back(destination);
        images
    }

    fn put_back(&mut self, destination: BlitDestination) {
        self.pool.put_target(self.context, destination.target);
        for surface in destination.surfaces {
            self.pool.put_surface(self.context, surface);
        }
    }
}
