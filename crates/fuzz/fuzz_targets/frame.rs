//! Compressed pixels behind a header that is right: the decoders, the layouts, the fragments.

#![no_main]

use arbitrary::{Arbitrary, Unstructured};
use bonemesh_fuzz::{catch_decoder_panics, read_folder, with_files};
use libfuzzer_sys::fuzz_target;

/// Transfer syntaxes whose pixels are in pieces, and one whose are not.
const SYNTAXES: [&str; 12] = [
    "1.2.840.10008.1.2.5",
    "1.2.840.10008.1.2.4.50",
    "1.2.840.10008.1.2.4.51",
    "1.2.840.10008.1.2.4.57",
    "1.2.840.10008.1.2.4.70",
    "1.2.840.10008.1.2.4.80",
    "1.2.840.10008.1.2.4.81",
    "1.2.840.10008.1.2.4.90",
    "1.2.840.10008.1.2.4.91",
    "1.2.840.10008.1.2.4.201",
    "1.2.840.10008.1.2.4.203",
    "1.2.840.10008.1.2.1",
];

/// One image: what its header says, and the bytes of its pixels.
#[derive(Debug)]
struct Image<'a> {
    syntax: &'static str,
    rows: u16,
    columns: u16,
    bits_allocated: u16,
    bits_stored: u16,
    high_bit: u16,
    is_signed: bool,
    /// Where the pixels are cut into a second fragment.
    cut: Option<u16>,
    /// Offset table, mostly empty.
    offsets: Vec<u32>,
    pixels: &'a [u8],
}

impl<'a> Arbitrary<'a> for Image<'a> {
    fn arbitrary(u: &mut Unstructured<'a>) -> arbitrary::Result<Self> {
        let [syntax, bits, flags]: [u8; 3] = u.arbitrary()?;
        let bits_allocated = [8, 16, 32, 12][usize::from(bits >> 5 & 3)];
        let bits_stored = u16::from(bits & 31) + 1;
        let offsets = if flags & 4 == 0 {
            Vec::new()
        } else {
            vec![u.arbitrary::<u32>()?, u.arbitrary::<u32>()?]
        };
        Ok(Self {
            syntax: SYNTAXES[usize::from(syntax) % SYNTAXES.len()],
            rows: u.arbitrary()?,
            columns: u.arbitrary()?,
            bits_allocated,
            bits_stored,
            high_bit: if flags & 8 == 0 { bits_stored - 1 } else { 15 },
            is_signed: flags & 1 == 1,
            cut: if flags & 2 == 0 {
                None
            } else {
                Some(u.arbitrary::<u16>()?)
            },
            offsets,
            pixels: u.bytes(u.len())?,
        })
    }
}

fuzz_target!(init: catch_decoder_panics(), |image: Image| {
    with_files(&[("1", &image.file(1)), ("2", &image.file(2))], read_folder);
});

impl Image<'_> {
    /// The image as the file of slice `number`.
    fn file(&self, number: u16) -> Vec<u8> {
        let mut out = [&[0; 128][..], b"DICM"].concat();
        let mut meta = Vec::new();
        element(&mut meta, [2, 0x10], *b"UI", self.syntax.as_bytes());
        element(&mut out, [2, 0], *b"UL", &(meta.len() as u32).to_le_bytes());
        out.extend(meta);
        for (tag, text) in [
            ([0x20, 0x32], format!("0\\0\\{number}")),
            ([0x20, 0x37], "1\\0\\0\\0\\1\\0".to_owned()),
        ] {
            element(&mut out, tag, *b"DS", text.as_bytes());
        }
        for (tag, number) in [(2, 1), (0x10, self.rows), (0x11, self.columns)] {
            element(&mut out, [0x28, tag], *b"US", &number.to_le_bytes());
        }
        element(&mut out, [0x28, 0x30], *b"DS", b"1\\1");
        for (tag, number) in [
            (0x100, self.bits_allocated),
            (0x101, self.bits_stored),
            (0x102, self.high_bit),
            (0x103, u16::from(self.is_signed)),
        ] {
            element(&mut out, [0x28, tag], *b"US", &number.to_le_bytes());
        }
        self.pixels(&mut out);
        out
    }

    fn pixels(&self, out: &mut Vec<u8>) {
        out.extend([0xe0, 0x7f, 0x10, 0, b'O', b'W', 0, 0]);
        if self.syntax == SYNTAXES[11] {
            out.extend((self.pixels.len() as u32).to_le_bytes());
            out.extend(self.pixels);
            return;
        }
        out.extend([0xff; 4]);
        let table: Vec<u8> = self.offsets.iter().flat_map(|o| o.to_le_bytes()).collect();
        item(out, &table);
        let cut = usize::from(self.cut.unwrap_or(u16::MAX)).min(self.pixels.len());
        let (first, second) = self.pixels.split_at(cut);
        item(out, first);
        if !second.is_empty() {
            item(out, second);
        }
        out.extend([0xfe, 0xff, 0xdd, 0xe0, 0, 0, 0, 0]);
    }
}

/// An element of a short value, explicit VR little endian.
fn element(out: &mut Vec<u8>, tag: [u16; 2], vr: [u8; 2], value: &[u8]) {
    out.extend(tag.iter().flat_map(|t| t.to_le_bytes()));
    out.extend(vr);
    let padded = value.len().next_multiple_of(2);
    out.extend((padded as u16).to_le_bytes());
    out.extend(value);
    out.resize(
        out.len() + padded - value.len(),
        if vr == *b"UI" { 0 } else { b' ' },
    );
}

fn item(out: &mut Vec<u8>, content: &[u8]) {
    out.extend([0xfe, 0xff, 0, 0xe0]);
    out.extend((content.len() as u32).to_le_bytes());
    out.extend(content);
}
