//! The elements of one DICOM data set that we need, found without trusting any length.
//!
//! dicom-rs decodes the element headers; walking over them is done here, because every length
//! has to be held against the size of the file *before* memory is asked for, because values
//! that are not needed are skipped instead of read, and because the place of the pixels in the
//! file is wanted rather than the pixels. Names, dates and numbers of the patient are never read;
//! times of the scan are, to tell phases apart.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use dicom_core::{Tag, VR};
use dicom_dictionary_std::tags;
use dicom_encoding::decode::implicit_le::ImplicitVRLittleEndianDecoder;
use dicom_encoding::text::{SpecificCharacterSet, TextCodec};
use dicom_encoding::transfer_syntax::{DynDecoder, Endianness, TransferSyntax};

use crate::error::FileError;

/// Longest value that is read: the values needed are numbers, UIDs and one line of text, and the
/// longest of these, six numbers, has 101 characters.
const MAX_VALUE: u64 = 1024;

/// Most bytes of all values together: 65,535 frames with 500 bytes each, which is twice of what
/// positions, orientations and rescales take.
const MAX_KEPT: u64 = 32 << 20;

/// Most element headers that are looked at: 65,535 frames with 128 elements each. A file can be
/// made of empty elements only, eight bytes each.
const MAX_ELEMENTS: u64 = 1 << 23;

/// Deepest nesting of sequences; functional groups need 2, real files have been seen with 6.
const MAX_DEPTH: usize = 24;

/// Most items of one functional group sequence, the frames of a multi-frame image: a volume has
/// no more slices.
const MAX_FRAMES: usize = 65_535;

const ITEM: Tag = Tag(0xfffe, 0xe000);
const ITEM_END: Tag = Tag(0xfffe, 0xe00d);
const SEQUENCE_END: Tag = Tag(0xfffe, 0xe0dd);

/// Elements of the data set itself that are kept.
const WANTED: [Tag; 36] = [
    tags::MEDIA_STORAGE_SOP_CLASS_UID,
    tags::TRANSFER_SYNTAX_UID,
    tags::SPECIFIC_CHARACTER_SET,
    tags::IMAGE_TYPE,
    tags::SOP_CLASS_UID,
    tags::MODALITY,
    tags::SERIES_DESCRIPTION,
    tags::SERIES_INSTANCE_UID,
    tags::ACQUISITION_NUMBER,
    tags::INSTANCE_NUMBER,
    tags::IMAGE_POSITION_PATIENT,
    tags::IMAGE_ORIENTATION_PATIENT,
    tags::SLICE_LOCATION,
    tags::SAMPLES_PER_PIXEL,
    tags::PHOTOMETRIC_INTERPRETATION,
    tags::NUMBER_OF_FRAMES,
    tags::ROWS,
    tags::COLUMNS,
    tags::PIXEL_SPACING,
    tags::BITS_ALLOCATED,
    tags::BITS_STORED,
    tags::HIGH_BIT,
    tags::PIXEL_REPRESENTATION,
    tags::PIXEL_PADDING_VALUE,
    tags::PIXEL_PADDING_RANGE_LIMIT,
    tags::RESCALE_INTERCEPT,
    tags::RESCALE_SLOPE,
    tags::RESCALE_TYPE,
    tags::STUDY_INSTANCE_UID,
    tags::FRAME_OF_REFERENCE_UID,
    tags::TEMPORAL_POSITION_IDENTIFIER,
    tags::TRIGGER_TIME,
    tags::ACQUISITION_DATE_TIME,
    tags::ACQUISITION_TIME,
    tags::CONTENT_TIME,
    tags::TEMPORAL_POSITION_INDEX,
];

/// Elements inside functional groups that are kept; each occurs in one macro only.
const WANTED_IN_GROUPS: [Tag; 10] = [
    tags::IMAGE_POSITION_PATIENT,
    tags::IMAGE_ORIENTATION_PATIENT,
    tags::PIXEL_SPACING,
    tags::RESCALE_INTERCEPT,
    tags::RESCALE_SLOPE,
    tags::RESCALE_TYPE,
    tags::TEMPORAL_POSITION_INDEX,
    tags::DIMENSION_INDEX_VALUES,
    tags::FRAME_ACQUISITION_DATE_TIME,
    tags::FRAME_REFERENCE_DATE_TIME,
];

/// Where the pixels lie in the data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelPlace {
    /// Byte offset of the value: pixels, or the first item of encapsulated pixels.
    pub(crate) offset: u64,
    /// Bytes of native pixels; `None` for encapsulated ones.
    pub(crate) length: Option<u64>,
}

/// Raw values by tag.
pub(crate) type Values = BTreeMap<Tag, Vec<u8>>;

/// The elements of one data set that are wanted.
pub(crate) struct Elements {
    pub(crate) values: Values,
    /// What all frames share, if the image has functional groups.
    pub(crate) shared: Values,
    /// What each frame has of its own, if the image has functional groups.
    pub(crate) frames: Vec<Values>,
    pub(crate) pixels: Option<PixelPlace>,
    pub(crate) is_directory: bool,
    endianness: Endianness,
}

impl Elements {
    /// Walks over `source` from its current place up to the pixels.
    ///
    /// `size` is where `source` ends; the walk starts at `position`. With `only_group` the walk
    /// ends, without error, at the first element of another group (file meta information).
    pub(crate) fn read<S: Read + Seek>(
        source: &mut S,
        syntax: &TransferSyntax,
        position: u64,
        size: u64,
        only_group: Option<u16>,
    ) -> Result<(Self, u64), FileError> {
        let unsupported = || FileError::UnknownSyntax(syntax.uid().to_owned());
        let mut walk = Walk {
            decoder: syntax.decoder_for::<S>().ok_or_else(unsupported)?,
            source,
            position,
            size,
            elements: 0,
            kept: 0,
            found: Self {
                values: Values::new(),
                shared: Values::new(),
                frames: Vec::new(),
                pixels: None,
                is_directory: false,
                endianness: syntax.endianness(),
            },
        };
        walk.root(only_group)?;
        Ok((walk.found, walk.position))
    }

    /// First unsigned 16-bit number of an element.
    pub(crate) fn u16(&self, tag: Tag) -> Option<u16> {
        let bytes: [u8; 2] = self.values.get(&tag)?.get(..2)?.try_into().ok()?;
        Some(match self.endianness {
            Endianness::Little => u16::from_le_bytes(bytes),
            Endianness::Big => u16::from_be_bytes(bytes),
        })
    }

    /// All unsigned 32-bit numbers of an element among `values` of this data set.
    pub(crate) fn u32s(&self, values: &Values, tag: Tag) -> Vec<u32> {
        let bytes = values.get(&tag).map_or(&[][..], Vec::as_slice);
        let number = |b: &[u8; 4]| match self.endianness {
            Endianness::Little => u32::from_le_bytes(*b),
            Endianness::Big => u32::from_be_bytes(*b),
        };
        bytes.as_chunks().0.iter().map(number).collect()
    }

    /// Text of an element without padding.
    pub(crate) fn text(&self, tag: Tag) -> Option<String> {
        text(&self.values, tag)
    }

    /// Text of an element in the data set's character set, control characters removed.
    pub(crate) fn described(&self, tag: Tag) -> String {
        let code = self.text(tags::SPECIFIC_CHARACTER_SET).unwrap_or_default();
        let code = code.rsplit('\\').find(|c| !c.is_empty()).unwrap_or("");
        let codec = SpecificCharacterSet::from_code(code).unwrap_or_default();
        let bytes = self.values.get(&tag).map_or(&[][..], Vec::as_slice);
        let text = codec
            .decode(bytes)
            .unwrap_or_else(|_| String::from_utf8_lossy(bytes).into_owned());
        let printable: String = text.chars().filter(|c| !c.is_control()).collect();
        printable.trim().to_owned()
    }

    /// Numbers of an element in text form.
    pub(crate) fn numbers<const N: usize>(&self, tag: Tag) -> Option<[f64; N]> {
        numbers(&self.values, tag)
    }
}

/// Text of an element without padding, as ASCII.
pub(crate) fn text(values: &Values, tag: Tag) -> Option<String> {
    let text = String::from_utf8_lossy(values.get(&tag)?);
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    (!text.is_empty()).then(|| text.to_owned())
}

/// Exactly `N` finite numbers in text form, separated by backslashes.
pub(crate) fn numbers<const N: usize>(values: &Values, tag: Tag) -> Option<[f64; N]> {
    let text = text(values, tag)?;
    let parsed: Option<Vec<f64>> = text
        .split('\\')
        .map(|n| n.trim().parse().ok().filter(|v: &f64| v.is_finite()))
        .collect();
    parsed?.try_into().ok()
}

/// Where the values of the data set being walked over go.
#[derive(Clone, Copy, PartialEq)]
enum Into {
    Nowhere,
    Shared,
    Frame,
}

struct Walk<'s, S: Read + Seek> {
    decoder: DynDecoder<S>,
    source: &'s mut S,
    position: u64,
    size: u64,
    /// Element headers seen so far.
    elements: u64,
    /// Bytes of values kept so far.
    kept: u64,
    found: Elements,
}

struct Element {
    tag: Tag,
    is_sequence: bool,
    /// A sequence whose VR the writer did not know: its content is implicit VR little endian.
    is_unknown: bool,
    /// `None`: ends with a delimiter.
    length: Option<u64>,
}

impl<S: Read + Seek> Walk<'_, S> {
    fn root(&mut self, only_group: Option<u16>) -> Result<(), FileError> {
        while self.position < self.size {
            if let Some(group) = only_group
                && self.next_group()? != group
            {
                return Ok(());
            }
            let element = self.next()?;
            if element.tag == tags::PIXEL_DATA {
                self.found.pixels = Some(PixelPlace {
                    offset: self.position,
                    length: element.length,
                });
                return Ok(());
            }
            if element.tag > tags::PIXEL_DATA {
                return Ok(());
            }
            self.root_element(&element)?;
        }
        Ok(())
    }

    /// Group of the next element, in little endian (file meta information always is), which
    /// stays unread: what follows may be in another form.
    fn next_group(&mut self) -> Result<u16, FileError> {
        let mut group = [0; 2];
        self.source.read_exact(&mut group)?;
        self.source.seek_relative(-2)?;
        Ok(u16::from_le_bytes(group))
    }

    fn root_element(&mut self, element: &Element) -> Result<(), FileError> {
        match element.tag {
            tags::DIRECTORY_RECORD_SEQUENCE => {
                self.found.is_directory = true;
                self.value(element, Into::Nowhere, 0)
            }
            tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE => self.sequence(element, Into::Shared, 1),
            tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE => self.sequence(element, Into::Frame, 1),
            tag if WANTED.contains(&tag) && !element.is_sequence => {
                let bytes = self.bytes(element)?;
                self.found.values.insert(tag, bytes);
                Ok(())
            }
            _ => self.value(element, Into::Nowhere, 0),
        }
    }

    /// The header of the next element, its length checked against the end of the file.
    fn next(&mut self) -> Result<Element, FileError> {
        let (header, bytes) = self
            .decoder
            .decode_header(self.source)
            .map_err(|_| FileError::Header("ends within an element"))?;
        self.position += bytes as u64;
        self.elements += 1;
        if self.elements > MAX_ELEMENTS {
            return Err(FileError::Header("far too many elements"));
        }
        if header.tag.group() == 0 {
            return Err(FileError::Header("an element that no file has"));
        }
        let length = header.len.get().map(u64::from);
        let element = Element {
            tag: header.tag,
            is_sequence: header.vr == VR::SQ || length.is_none(),
            is_unknown: header.vr == VR::UN && length.is_none(),
            length,
        };
        let needed = self.position + length.unwrap_or(0);
        if needed > self.size && element.tag != tags::PIXEL_DATA {
            let found = self.size;
            return Err(FileError::CutOff { needed, found });
        }
        Ok(element)
    }

    /// Passes a value that is not wanted, or looks for wanted ones inside a sequence.
    fn value(&mut self, element: &Element, into: Into, depth: usize) -> Result<(), FileError> {
        match element.length {
            Some(length) if into == Into::Nowhere || !element.is_sequence => self.skip(length),
            _ => self.sequence(element, into, depth + 1),
        }
    }

    fn skip(&mut self, length: u64) -> Result<(), FileError> {
        self.source
            .seek_relative(i64::try_from(length).unwrap_or(i64::MAX))?;
        self.position += length;
        Ok(())
    }

    /// The value of an element; of a long description the beginning.
    fn bytes(&mut self, element: &Element) -> Result<Vec<u8>, FileError> {
        let length = element.length.unwrap_or(0);
        let read = length.min(MAX_VALUE);
        self.kept += read;
        if read < length && element.tag != tags::SERIES_DESCRIPTION {
            return Err(FileError::Header("a value is far too long"));
        }
        if self.kept > MAX_KEPT {
            return Err(FileError::Header("far too many values"));
        }
        let mut bytes = vec![0; read as usize];
        self.source.read_exact(&mut bytes)?;
        self.position += read;
        self.skip(length - read)?;
        Ok(bytes)
    }

    fn sequence(&mut self, element: &Element, into: Into, depth: usize) -> Result<(), FileError> {
        if depth > MAX_DEPTH {
            return Err(FileError::Header("sequences nested too deeply"));
        }
        if element.is_unknown {
            let implicit: DynDecoder<S> = Box::<ImplicitVRLittleEndianDecoder<_>>::default();
            let outer = std::mem::replace(&mut self.decoder, implicit);
            let result = self.items(element, into, depth);
            self.decoder = outer;
            return result;
        }
        self.items(element, into, depth)
    }

    fn items(&mut self, element: &Element, into: Into, depth: usize) -> Result<(), FileError> {
        let end = element.length.map(|l| self.position + l);
        while end.is_none_or(|end| self.position < end) {
            let item = self.next()?;
            match item.tag {
                SEQUENCE_END => return Ok(()),
                ITEM => {}
                _ => return Err(FileError::Header("a sequence without items")),
            }
            if depth == 1 && into == Into::Frame {
                if self.found.frames.len() >= MAX_FRAMES {
                    return Err(FileError::Header("too many frames"));
                }
                self.found.frames.push(Values::new());
            }
            self.item(&item, into, depth)?;
        }
        Ok(())
    }

    fn item(&mut self, item: &Element, into: Into, depth: usize) -> Result<(), FileError> {
        if let (Some(length), Into::Nowhere) = (item.length, into) {
            return self.skip(length);
        }
        let end = item.length.map(|l| self.position + l);
        while end.is_none_or(|end| self.position < end) {
            let element = self.next()?;
            if element.tag == ITEM_END {
                return Ok(());
            }
            let is_wanted = into != Into::Nowhere
                && WANTED_IN_GROUPS.contains(&element.tag)
                && !element.is_sequence;
            if is_wanted {
                let bytes = self.bytes(&element)?;
                let values = match into {
                    Into::Frame => self.found.frames.last_mut(),
                    _ => Some(&mut self.found.shared),
                };
                if let Some(values) = values {
                    values.insert(element.tag, bytes);
                }
            } else {
                self.value(&element, into, depth)?;
            }
        }
        Ok(())
    }
}
