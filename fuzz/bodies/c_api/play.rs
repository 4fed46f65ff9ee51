//! The sequence, in the precision of the module around this file (included once for each).

use std::ptr;

use hooke::SceneIn;

use super::calls::{advance, ask, choose_options, damaged, edit};
use super::*;
use crate::buffer::Header;
use crate::bytes::Bytes;
use crate::c_api::memory::{Answer, Kind, Memory};
use crate::options::Options;
use crate::status::hooke_status::{self, *};

/// The most calls.
const CALLS: usize = 96;
/// Plays calls on a buffer and on a scene of the kernel beside it.
pub fn play(mut bytes: Bytes<'_>) {
    let (n, s) = (bytes.below(6), bytes.below(9));
    let Some((memory, handle)) = begin(n, s, &mut bytes) else { return };
    let (reals, words) = SceneIn::<Real>::needs(n, s);
    let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    let Some(mut kernel) = SceneIn::<Real>::in_buffers(&mut reals, &mut words, n, s) else {
        panic!("the kernel has room for what the interface has room for")
    };
    let mut options: Option<Options<Real>> = None;
    for _ in 0..CALLS {
        if bytes.is_empty() {
            return;
        }
        let call = bytes.below(32);
        if call == 30 {
            any_sizes(&mut bytes);
            continue;
        }
        if call == 31 {
            damaged(&memory, &mut bytes);
            continue;
        }
        let before = memory.content();
        let steps = call >= 19;
        let (status, answer) = if steps {
            advance(handle, &mut kernel, options.as_ref(), &mut bytes)
        } else if call == 18 {
            let kind = Kind::read(&mut bytes);
            let wanted = choose_options(&mut bytes);
            let answer = kind.answer().and_then(|()| wanted.check());
            let mut place = Box::new(wanted);
            // SAFETY: a handle of `init`; the options are readable or the pointer is refused.
            let status = unsafe { set_options(handle, kind.of(&mut *place, handle)) };
            if answer.is_ok() {
                options = Some(wanted);
            }
            (status, answer)
        } else if call >= 14 {
            ask(call, handle, &mut kernel, options.as_ref(), &mut bytes)
        } else {
            edit(call, handle, &mut kernel, &mut bytes)
        };
        agrees(handle, status, answer, &before, &memory, !steps);
        same_state(handle, &kernel);
    }
}

/// Sizes up to all that a number can say: what has no size is refused, and nothing is made in a buffer of less than the size.
fn any_sizes(bytes: &mut Bytes<'_>) {
    let mut any = || usize::from_le_bytes(std::array::from_fn(|_| bytes.byte())) >> (bytes.byte() % 64);
    let (n, s) = (any(), any());
    let memory = Memory::new(256);
    let mut handle: Box<*mut Handle> = Box::new(ptr::null_mut());
    // SAFETY: a buffer of so many bytes, a place for the handle.
    let status = unsafe { init(memory.at().cast(), 256, n, s, &mut *handle) };
    let expected = match size(n, s) {
        0 => HOOKE_TOO_LARGE,
        257.. => HOOKE_TOO_SMALL,
        _ => HOOKE_OK,
    };
    assert_eq!(status as i32, expected as i32, "a scene of {n} particles and {s} springs");
}

/// A scene in a buffer that is large enough, after tries in some that are not.
fn begin(n: usize, s: usize, bytes: &mut Bytes<'_>) -> Option<(Memory, *mut Handle)> {
    let needs = size(n, s);
    assert!(needs > 0 && align_of::<u64>().is_multiple_of(alignment()));
    let (short, kind, place) = (bytes.below(4), Kind::read(bytes), Kind::read(bytes));
    let memory = Memory::new(needs - short);
    let mut handle: Box<*mut Handle> = Box::new(ptr::null_mut());
    let at = memory.at();
    let to = place.of(&mut *handle, at);
    // SAFETY: a buffer of so many bytes, or a pointer that is refused; a place for the handle, or one that is refused.
    let status = unsafe { init(kind.of(at, at).cast(), needs - short, n, s, to) };
    let expected = match (place, kind) {
        (Kind::Null, _) => HOOKE_NULL,
        (Kind::Off, _) => HOOKE_MISALIGNED,
        (_, Kind::Null) => HOOKE_NULL,
        (Kind::Inside, _) => HOOKE_OVERLAP,
        (Kind::Good, Kind::Off) => HOOKE_MISALIGNED,
        (Kind::Good, _) if short > 0 => HOOKE_TOO_SMALL,
        _ => HOOKE_OK,
    };
    assert_eq!(status as i32, expected as i32, "init");
    if status == HOOKE_OK {
        assert_eq!(handle.cast(), at, "the handle is the buffer");
        return Some((memory, *handle));
    }
    assert!(memory.content().iter().all(|b| *b == 0xa5) && handle.is_null(), "a refused init writes nothing");
    None
}

/// The status and the index are the kernel's, and a refused call has left the buffer as it was.
fn agrees(handle: *mut Handle, status: hooke_status, answer: Answer, before: &[u8], memory: &Memory, all: bool) {
    let expected = match &answer {
        Ok(()) => HOOKE_OK,
        Err(failure) => failure.status,
    };
    assert_eq!(status as i32, expected as i32, "the status");
    let Err(failure) = answer else { return };
    // SAFETY: a handle of `init`.
    assert_eq!(unsafe { last_index(handle) }, failure.index, "the index");
    if all {
        let index = core::mem::offset_of!(Header<Real>, last_index);
        let mut now = memory.content();
        let place = index..index + size_of::<usize>();
        now[place.clone()].copy_from_slice(&before[place]);
        assert!(now == before, "a refused call changes nothing but the index");
    }
}

/// Positions and velocities are the kernel's, bit for bit.
fn same_state(handle: *mut Handle, kernel: &SceneIn<'_, Real>) {
    let n = kernel.positions().len();
    let (mut count, mut of_springs) = (usize::MAX, usize::MAX);
    let mut vectors = vec![[0.0; 3]; n].into_boxed_slice();
    let bits = |list: &[[Real; 3]]| list.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    // SAFETY: a handle of `init`, places for the counts, an array with room for all particles.
    unsafe {
        assert!(particles(handle, &mut count) == HOOKE_OK && springs(handle, &mut of_springs) == HOOKE_OK);
        assert_eq!((count, of_springs), (n, kernel.state().springs()));
        assert!(positions(handle, vectors.as_mut_ptr().cast(), n) == HOOKE_OK);
        assert_eq!(bits(&vectors), bits(kernel.positions()));
        assert!(velocities(handle, vectors.as_mut_ptr().cast(), n) == HOOKE_OK);
        assert_eq!(bits(&vectors), bits(kernel.velocities()));
    }
}
