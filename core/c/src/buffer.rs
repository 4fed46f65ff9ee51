//! The caller's buffer: a header, then the scene's numbers, then its words.
//!
//! All of it is plain numbers, so that every content is a valid value; the magic word and the checksum are there to
//! notice a buffer that is no scene, and the counts that [`SceneIn::attach`] takes are validated again by itself.

use hooke::{Real, SceneIn};

use crate::options::Options;
use crate::status::hooke_status::{self, *};
use crate::status::{Failure, NO_INDEX};

/// What stands at the front of a buffer.
#[repr(C)]
pub(crate) struct Header<T> {
    magic: u32,
    /// Of the magic word, the capacity and the counts
    checksum: u32,
    /// Particles and springs there is room for
    capacity: [u32; 2],
    counts: [u32; 6],
    pub(crate) last_index: usize,
    options: Options<T>,
}

/// A buffer that a call has attached to.
pub(crate) struct Open<'a, T: Real> {
    pub(crate) header: &'a mut Header<T>,
    pub(crate) scene: SceneIn<'a, T>,
}

/// How long the parts of a buffer are.
pub(crate) struct Layout {
    reals: usize,
    words: usize,
    pub(crate) bytes: usize,
}

impl Layout {
    /// `None` for more than can be counted: the kernel's indices have 31 bits, and the bytes must fit into an `isize`.
    pub(crate) fn new<T: Real>(particles: usize, springs: usize) -> Option<Self> {
        // Less than 512 bytes per particle and spring together, in either precision: below this nothing overflows.
        let limit = (usize::MAX / 1024).min((1 << 31) - 1);
        if particles > limit || springs > limit {
            return None;
        }
        let (reals, words) = SceneIn::<T>::needs(particles, springs);
        let bytes = size_of::<Header<T>>() + reals * size_of::<T>() + words * size_of::<u32>();
        Some(Self { reals, words, bytes })
    }
}

impl<T: Real> Header<T> {
    /// "Hke" and the precision.
    const MAGIC: u32 = 0x486b_6500 + size_of::<T>() as u32;

    fn sum(&self) -> u32 {
        // FNV-1a by words.
        let step = |sum: u32, word: &u32| (sum ^ *word).wrapping_mul(0x0100_0193);
        [self.magic].iter().chain(&self.capacity).chain(&self.counts).fold(0x811c_9dc5, step)
    }

    fn layout(&self) -> Option<Layout> {
        let [particles, springs] = self.capacity;
        Layout::new::<T>(particles as usize, springs as usize)
    }

    /// Where the buffer ends, in bytes from its beginning.
    pub(crate) fn bytes(&self) -> usize {
        self.layout().map_or(0, |layout| layout.bytes)
    }
}

impl<'a, T: Real> Open<'a, T> {
    /// The scene's options: read, or set.
    pub(crate) fn options(&mut self) -> &mut Options<T> {
        &mut self.header.options
    }

    /// Ends a call: notes how far the scene is filled.
    pub(crate) fn close(self) {
        let Self { header, scene } = self;
        header.counts = scene.counts();
        header.checksum = header.sum();
    }

    /// Attaches to a buffer. Out of line: every exported function begins with it.
    ///
    /// # Safety
    /// `at` is null, or misaligned, or readable for a header; if it holds what [`init`] wrote there, what follows is
    /// the rest of that buffer, and nobody else uses the buffer during `'a`.
    #[inline(never)]
    pub(crate) unsafe fn new(at: *mut Header<T>) -> Result<Self, hooke_status> {
        if at.is_null() {
            return Err(HOOKE_NULL);
        }
        if !at.is_aligned() {
            return Err(HOOKE_MISALIGNED);
        }
        // SAFETY: not null, aligned, readable as promised; any bytes are a header.
        let header = unsafe { &mut *at };
        if header.magic != Header::<T>::MAGIC || header.checksum != header.sum() {
            return Err(HOOKE_NOT_A_SCENE);
        }
        let Layout { reals, words, .. } = header.layout().ok_or(HOOKE_NOT_A_SCENE)?;
        // SAFETY: the magic word and the checksum say that `init` laid this buffer out for these sizes (or that a
        // buffer was copied as a whole), with all bytes written, so both parts lie behind the header, within the buffer
        // and apart from each other; a header's size is a multiple of T's alignment and T's size of that of a word; any
        // bytes are a T or a word.
        let (reals, words) = unsafe {
            let first = at.add(1).cast::<T>();
            let second = first.add(reals).cast::<u32>();
            (core::slice::from_raw_parts_mut(first, reals), core::slice::from_raw_parts_mut(second, words))
        };
        let [particles, springs] = header.capacity;
        let scene = SceneIn::attach(reals, words, particles as usize, springs as usize, header.counts);
        Ok(Self { header, scene: scene.ok_or(HOOKE_NOT_A_SCENE)? })
    }
}

/// Lays out an empty scene in a buffer, which it fills with zeros first.
///
/// # Safety
/// `buffer` is null, or misaligned, or writable for `bytes`, and nobody else uses it during the call.
pub(crate) unsafe fn init<T: Real>(
    buffer: *mut u8,
    bytes: usize,
    particles: usize,
    springs: usize,
) -> Result<(), Failure> {
    let at = buffer.cast::<Header<T>>();
    if at.is_null() {
        return Err(HOOKE_NULL.into());
    }
    if !at.is_aligned() {
        return Err(HOOKE_MISALIGNED.into());
    }
    let layout = Layout::new::<T>(particles, springs).ok_or(HOOKE_TOO_LARGE)?;
    if bytes < layout.bytes {
        return Err(HOOKE_TOO_SMALL.into());
    }
    let mut header = Header {
        magic: Header::<T>::MAGIC,
        checksum: 0,
        capacity: [particles as u32, springs as u32],
        counts: [0; 6],
        last_index: NO_INDEX,
        options: Options::defaults(),
    };
    header.checksum = header.sum();
    // SAFETY: `buffer` is writable for `bytes`, no fewer than are written here, and aligned for a header. The zeros make
    // every later read one of written memory.
    unsafe {
        buffer.write_bytes(0, layout.bytes);
        at.write(header);
    }
    Ok(())
}
