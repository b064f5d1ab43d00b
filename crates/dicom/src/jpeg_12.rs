//! JPEG with 9 to 12 bits a sample (ITU-T T.81, process 4 and its kin) through libjpeg-turbo.
//!
//! dicom-rs's JPEG decoder knows 8 bits only, and no wrapper of libjpeg-turbo gives its 12-bit
//! functions a safe form. So this is the one place with `unsafe`: six functions of
//! `TurboJPEG`.

// Foreign functions; each call says why it is sound.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_int, c_void};
use std::ptr::NonNull;

use turbojpeg_sys as turbo;

/// Scans of a progressive image; more only cost time.
const MAX_SCANS: c_int = 100;

/// Working memory (MB): the coefficients of the largest progressive frame.
const MAX_MEMORY: c_int = 256;

/// Decodes a grey image of `rows` x `columns` samples of 9 to 12 bits.
///
/// Anything out of order, even what libjpeg-turbo only warns of, is an error: a guessed slice
/// would look like a measured one.
pub(crate) fn decode(jpeg: &[u8], rows: usize, columns: usize) -> Result<Vec<u16>, String> {
    let (Ok(height), Ok(width)) = (c_int::try_from(rows), c_int::try_from(columns)) else {
        return Err(format!("{rows} x {columns} pixels are too many"));
    };
    let decoder = Decoder::new()?;
    for (parameter, value) in [
        (turbo::TJPARAM_TJPARAM_STOPONWARNING, 1),
        (turbo::TJPARAM_TJPARAM_SCANLIMIT, MAX_SCANS),
        (turbo::TJPARAM_TJPARAM_MAXMEMORY, MAX_MEMORY),
    ] {
        decoder.set(parameter, value)?;
    }
    decoder.read_header(jpeg)?;
    let declared = [
        decoder.get(turbo::TJPARAM_TJPARAM_JPEGHEIGHT),
        decoder.get(turbo::TJPARAM_TJPARAM_JPEGWIDTH),
    ];
    let bits = decoder.get(turbo::TJPARAM_TJPARAM_PRECISION);
    if declared != [height, width] || !(9..=12).contains(&bits) {
        return Err(format!("{declared:?} pixels of {bits} bits"));
    }
    let mut samples = vec![0_i16; rows * columns];
    // SAFETY: the handle is live and not shared; `jpeg` is valid for its length, and TurboJPEG
    // only reads it; it writes `JPEGHEIGHT` rows of `width` grey samples, and `samples` has just
    // as many, since the height and width in this very header have been compared.
    let status = unsafe {
        turbo::tj3Decompress12(
            decoder.0.as_ptr(),
            jpeg.as_ptr(),
            jpeg.len() as _,
            samples.as_mut_ptr(),
            width,
            turbo::TJPF_TJPF_GRAY as c_int,
        )
    };
    decoder.check(status)?;
    Ok(samples.into_iter().map(i16::cast_unsigned).collect())
}

/// A `TurboJPEG` instance for decompression.
struct Decoder(NonNull<c_void>);

impl Decoder {
    fn new() -> Result<Self, String> {
        // SAFETY: takes a number only; gives null or an instance that is ours.
        let handle = unsafe { turbo::tj3Init(turbo::TJINIT_TJINIT_DECOMPRESS as c_int) };
        NonNull::new(handle)
            .map(Self)
            .ok_or_else(|| "no memory for the decoder".to_owned())
    }

    fn set(&self, parameter: turbo::TJPARAM, value: c_int) -> Result<(), String> {
        // SAFETY: the handle is live; numbers out of range are answered with a status.
        self.check(unsafe { turbo::tj3Set(self.0.as_ptr(), parameter as c_int, value) })
    }

    fn get(&self, parameter: turbo::TJPARAM) -> c_int {
        // SAFETY: the handle is live; an unknown parameter gives -1.
        unsafe { turbo::tj3Get(self.0.as_ptr(), parameter as c_int) }
    }

    fn read_header(&self, jpeg: &[u8]) -> Result<(), String> {
        // SAFETY: the handle is live, and `jpeg` is valid for its length and only read.
        self.check(unsafe {
            turbo::tj3DecompressHeader(self.0.as_ptr(), jpeg.as_ptr(), jpeg.len() as _)
        })
    }

    fn check(&self, status: c_int) -> Result<(), String> {
        if status == 0 {
            return Ok(());
        }
        // SAFETY: the handle is live; the text belongs to it, ends with a null byte and is
        // copied before anything else is called.
        let text = unsafe { CStr::from_ptr(turbo::tj3GetErrorStr(self.0.as_ptr())) };
        Err(text.to_string_lossy().into_owned())
    }
}

impl Drop for Decoder {
    fn drop(&mut self) {
        // SAFETY: the handle is live and not used again.
        unsafe { turbo::tj3Destroy(self.0.as_ptr()) }
    }
}
