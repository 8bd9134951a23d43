//! Arguments of calls: pointers, texts and buffers.

use std::ffi::{CStr, c_char};

use engine::Result;

use crate::status::wrong;

/// What a pointer of the caller points to.
///
/// # Errors
/// If it is null.
///
/// # Safety
/// The pointer is null, or from the function that makes it and not freed.
pub unsafe fn borrowed<'a, T>(pointer: *const T, name: &str) -> Result<&'a T> {
    // SAFETY: the caller's contract.
    unsafe { pointer.as_ref() }.ok_or_else(|| wrong(format!("`{name}` is null")))
}

/// [`borrowed`], to change it.
///
/// # Errors
/// If it is null.
///
/// # Safety
/// As for [`borrowed`], and no other thread uses it.
pub unsafe fn borrowed_mut<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T> {
    // SAFETY: the caller's contract.
    unsafe { pointer.as_mut() }.ok_or_else(|| wrong(format!("`{name}` is null")))
}

/// A text.
///
/// # Errors
/// If it is null, or not UTF-8.
///
/// # Safety
/// The pointer is null, or to bytes that end with 0.
pub unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str> {
    if pointer.is_null() {
        return Err(wrong(format!("`{name}` is null")));
    }
    // SAFETY: the caller's contract.
    unsafe { CStr::from_ptr(pointer) }.to_str().map_err(|_| wrong(format!("`{name}` is not UTF-8")))
}

/// Numbers that the caller passes.
///
/// # Errors
/// If it is null and there should be some.
///
/// # Safety
/// The pointer is null, or to this many numbers.
pub unsafe fn numbers<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T]> {
    check(pointer, count, name)?;
    // SAFETY: the caller's contract; a slice of nothing needs no memory.
    Ok(if count == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, count) } })
}

/// A buffer of the caller that is filled.
///
/// # Errors
/// If it is null and something should be in it.
///
/// # Safety
/// The pointer is null, or to this many numbers that nobody else uses.
pub unsafe fn buffer<'a, T>(pointer: *mut T, count: usize, name: &str) -> Result<&'a mut [T]> {
    check(pointer, count, name)?;
    // SAFETY: the caller's contract; a slice of nothing needs no memory.
    Ok(if count == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, count) } })
}

fn check<T>(pointer: *const T, count: usize, name: &str) -> Result<()> {
    if count > 0 && pointer.is_null() {
        return Err(wrong(format!("`{name}` is null")));
    }
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(wrong(format!("`{name}` cannot have {count} entries")));
    }
    match pointer.is_aligned() {
        true => Ok(()),
        false => Err(wrong(format!("`{name}` is not aligned"))),
    }
}

/// Frees what a pointer of the caller points to; nothing if it is null.
///
/// # Safety
/// The pointer is null, or from the function that makes it and not freed.
pub unsafe fn free<T>(pointer: *mut T) {
    if !pointer.is_null() {
        // SAFETY: the caller's contract.
        drop(unsafe { Box::from_raw(pointer) });
    }
}
