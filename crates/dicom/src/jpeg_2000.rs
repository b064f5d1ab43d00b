//! What a JPEG 2000 code stream asks of its decoder, looked up before it is given to one.
//!
//! A decoder makes structures for every tile, precinct and code block that the headers declare,
//! before it knows whether any data are there, so that a hundred bytes can ask for gigabytes.
//! Markers and their fields are those of ITU T.800, annex A.

/// Tiles: as many as 8192 x 8192 pixels in tiles of 128 x 128 have. Each costs 7 kilobytes.
const MAX_TILES: u64 = 1 << 12;

/// Precincts of all resolutions: twice as many as 8192 x 8192 pixels in precincts of 128 x 128
/// have. Each costs 1.5 kilobytes.
const MAX_PRECINCTS: u64 = 1 << 14;

/// Code blocks: as many as 8192 x 8192 pixels in blocks of 32 x 32 have.
const MAX_BLOCKS: u64 = 1 << 16;

/// Quality layers: encoders offer some fifty. Each costs time for every precinct.
const MAX_LAYERS: u64 = 256;

/// Packets, of which there is one for each layer of each precinct: all are looked at.
const MAX_PACKETS: u64 = 1 << 20;

/// Decomposition levels that the standard allows.
const MAX_LEVELS: u32 = 32;

const START: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];

const SIZE: u8 = 0x51;
const CODING_STYLE: u8 = 0x52;
const CODING_STYLE_OF_COMPONENT: u8 = 0x53;
const TILE_PART: u8 = 0x90;
const DATA: u8 = 0x93;
const END: u8 = 0xd9;

/// The code stream in `bytes`, out of the file format that it may be wrapped in, if it asks for
/// no more than real slices do.
pub(crate) fn checked(mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    let begin = bytes.windows(START.len()).position(|w| w == START);
    bytes.drain(..begin.ok_or("no code stream")?);
    let mut limits = Limits::default();
    let mut at = 2;
    while let Some(segment) = Segment::at(&bytes, at) {
        at = match segment.marker {
            END => break,
            TILE_PART => {
                let length = number(segment.content, 2, 4)?;
                limits.headers(&bytes, at + segment.length())?;
                if length == 0 {
                    break;
                }
                at + length.max(14) as usize
            }
            _ => {
                limits.take(&segment)?;
                at + segment.length()
            }
        };
    }
    Ok(bytes)
}

fn number(bytes: &[u8], at: usize, length: usize) -> Result<u64, String> {
    let field = bytes.get(at..at + length).ok_or("a header is cut off")?;
    Ok(field.iter().fold(0, |n, b| n << 8 | u64::from(*b)))
}

/// A marker and what follows it, up to the next.
struct Segment<'a> {
    marker: u8,
    content: &'a [u8],
}

impl<'a> Segment<'a> {
    fn at(bytes: &'a [u8], at: usize) -> Option<Self> {
        let [0xff, marker, rest @ ..] = bytes.get(at..)? else {
            return None;
        };
        if matches!(*marker, DATA | END) {
            let content = &[];
            let marker = *marker;
            return Some(Self { marker, content });
        }
        let length = usize::from(u16::from_be_bytes(*rest.first_chunk()?));
        Some(Self {
            marker: *marker,
            content: rest.get(2..length)?,
        })
    }

    fn length(&self) -> usize {
        if matches!(self.marker, DATA | END) {
            2
        } else {
            4 + self.content.len()
        }
    }
}

/// What the headers have declared so far.
#[derive(Default)]
struct Limits {
    columns: u64,
    rows: u64,
    tiles: u64,
    layers: u64,
}

impl Limits {
    /// The headers of a tile part, from `at` to its data.
    fn headers(&mut self, bytes: &[u8], mut at: usize) -> Result<(), String> {
        while let Some(segment) = Segment::at(bytes, at).filter(|s| s.marker != DATA) {
            self.take(&segment)?;
            at += segment.length();
        }
        Ok(())
    }

    fn take(&mut self, segment: &Segment) -> Result<(), String> {
        let content = segment.content;
        match segment.marker {
            SIZE => self.size(content),
            CODING_STYLE => {
                self.layers = self.layers.max(number(content, 2, 2)?);
                let has_precincts = number(content, 0, 1)? & 1 == 1;
                self.coding(content.get(5..).unwrap_or_default(), has_precincts)
            }
            CODING_STYLE_OF_COMPONENT => {
                let has_precincts = number(content, 1, 1)? & 1 == 1;
                self.coding(content.get(2..).unwrap_or_default(), has_precincts)
            }
            // Other segments of headers (T.800 A.2, T.814 A.1): they make nothing large.
            0x50 | 0x55 | 0x57..=0x59 | 0x5c..=0x61 | 0x63 | 0x64 => Ok(()),
            marker => Err(format!("an unknown marker ff{marker:02x}")),
        }
    }

    fn size(&mut self, content: &[u8]) -> Result<(), String> {
        let field = |i: usize| number(content, 2 + 4 * i, 4);
        let extent = |to: u64, from: u64| to.checked_sub(from).ok_or("a size below zero");
        self.columns = extent(field(0)?, field(2)?)?;
        self.rows = extent(field(1)?, field(3)?)?;
        let (width, height) = (field(4)?, field(5)?);
        if width == 0 || height == 0 {
            return Err("tiles without a size".to_owned());
        }
        let across = extent(field(0)?, field(6)?)?.div_ceil(width);
        let down = extent(field(1)?, field(7)?)?.div_ceil(height);
        self.tiles = across.saturating_mul(down);
        at_most(self.tiles, MAX_TILES, "tiles")
    }

    /// Levels, size of the code blocks and, if there are any, of the precincts.
    fn coding(&self, content: &[u8], has_precincts: bool) -> Result<(), String> {
        let levels = number(content, 0, 1)? as u32;
        if levels > MAX_LEVELS {
            return Err(format!("{levels} decomposition levels"));
        }
        let exponent = |at| number(content, at, 1).map(|e| (e as u32 & 15) + 2);
        let (across, down) = (exponent(1)?, exponent(2)?);
        let in_blocks = |n: u64, exponent: u32| (n >> exponent) + 1;
        let mut blocks = in_blocks(self.columns, across).saturating_mul(in_blocks(self.rows, down));
        let mut precincts = 0_u64;
        for resolution in 0..=levels {
            let sizes = if has_precincts {
                number(content, 5 + resolution as usize, 1)? as u32
            } else {
                0xff
            };
            let reduced = |n: u64| n >> (levels - resolution).min(63);
            let (width, height) = (sizes & 15, sizes >> 4);
            let (columns, rows) = (reduced(self.columns), reduced(self.rows));
            let here = in_blocks(columns, width).saturating_mul(in_blocks(rows, height));
            precincts = precincts.saturating_add(here);
            // A precinct cuts the code blocks that are larger than its half.
            let smallest = |exponent: u32, block: u32| block.min(exponent.saturating_sub(1));
            blocks = blocks.max(
                in_blocks(columns, smallest(width, across))
                    .saturating_mul(in_blocks(rows, smallest(height, down))),
            );
        }
        // Every tile has at least one precinct for each resolution, and a code block.
        precincts = precincts.saturating_add(self.tiles.saturating_mul(u64::from(levels) + 1));
        at_most(precincts, 2 * MAX_PRECINCTS + MAX_TILES * 6, "precincts")?;
        at_most(self.layers, MAX_LAYERS, "layers")?;
        at_most(
            precincts.saturating_mul(self.layers),
            MAX_PACKETS,
            "packets",
        )?;
        at_most(blocks, MAX_BLOCKS + 1024, "code blocks")
    }
}

fn at_most(count: u64, most: u64, name: &str) -> Result<(), String> {
    if count <= most {
        Ok(())
    } else {
        Err(format!("{count} {name} are too many"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Asked {
        side: u32,
        tile: u32,
        levels: u8,
        block: u8,
        precinct: u8,
        layers: u16,
    }

    const USUAL: Asked = Asked {
        side: 512,
        tile: 512,
        levels: 5,
        block: 4,
        precinct: 15,
        layers: 1,
    };

    fn segment(marker: u8, content: &[u8]) -> Vec<u8> {
        let length = (content.len() as u16 + 2).to_be_bytes();
        [&[0xff, marker], &length[..], content].concat()
    }

    fn coding(asked: &Asked) -> Vec<u8> {
        let mut content = vec![1, 0];
        content.extend(asked.layers.to_be_bytes());
        content.extend([0, asked.levels, asked.block, asked.block, 0, 1]);
        let sizes = asked.precinct << 4 | asked.precinct;
        content.extend(vec![sizes; usize::from(asked.levels) + 1]);
        segment(CODING_STYLE, &content)
    }

    fn tile_part(length: u32, headers: &[u8]) -> Vec<u8> {
        let mut content = vec![0, 0];
        content.extend(length.to_be_bytes());
        content.extend([0, 1]);
        let mut bytes = segment(TILE_PART, &content);
        bytes.extend(headers);
        bytes.extend([0xff, DATA, 1, 2, 3]);
        bytes
    }

    fn stream(asked: &Asked) -> Vec<u8> {
        let Asked { side, tile, .. } = *asked;
        let mut size = vec![0, 0];
        for n in [side, side, 0, 0, tile, tile, 0, 0] {
            size.extend(n.to_be_bytes());
        }
        size.extend([0, 1, 15, 1, 1]);
        let mut bytes = vec![0xff, 0x4f];
        bytes.extend(segment(SIZE, &size));
        bytes.extend(coding(asked));
        bytes
    }

    fn is_accepted(asked: &Asked) -> bool {
        let mut bytes = stream(asked);
        bytes.extend(tile_part(0, &[]));
        checked(bytes).is_ok()
    }

    #[test]
    fn what_encoders_write_is_accepted() {
        assert!(is_accepted(&USUAL));
        for (side, tile) in [(1, 1), (8192, 8192), (8192, 128), (4096, 1024)] {
            assert!(
                is_accepted(&Asked {
                    side,
                    tile,
                    ..USUAL
                }),
                "{side} {tile}"
            );
        }
        let side = 8192;
        let tile = side;
        assert!(is_accepted(&Asked {
            side,
            tile,
            precinct: 7,
            layers: 20,
            ..USUAL
        }));
        assert!(is_accepted(&Asked {
            side,
            tile,
            block: 3,
            ..USUAL
        }));
        assert!(is_accepted(&Asked { block: 0, ..USUAL }));
        assert!(is_accepted(&Asked {
            precinct: 5,
            layers: 100,
            ..USUAL
        }));
    }

    #[test]
    fn more_than_a_slice_needs_is_refused() {
        assert!(!is_accepted(&Asked { tile: 2, ..USUAL }));
        assert!(!is_accepted(&Asked { tile: 0, ..USUAL }));
        assert!(!is_accepted(&Asked {
            precinct: 1,
            ..USUAL
        }));
        assert!(!is_accepted(&Asked {
            precinct: 5,
            layers: u16::MAX,
            ..USUAL
        }));
        // 47,865 of them kept a decoder busy for seconds.
        assert!(!is_accepted(&Asked {
            layers: 257,
            ..USUAL
        }));
        assert!(!is_accepted(&Asked {
            side: 4096,
            tile: 4096,
            block: 0,
            ..USUAL
        }));
        assert!(!is_accepted(&Asked {
            levels: 33,
            ..USUAL
        }));
    }

    #[test]
    fn headers_of_later_tile_parts_are_looked_at() {
        let part = tile_part(17, &[]);
        let honest = [stream(&USUAL), part.clone(), part.clone()].concat();
        assert!(checked(honest).is_ok());
        let hostile = tile_part(
            0,
            &coding(&Asked {
                precinct: 1,
                ..USUAL
            }),
        );
        assert!(checked([stream(&USUAL), part, hostile].concat()).is_err());
    }

    #[test]
    fn the_file_format_around_it_is_taken_off() {
        let stream = [stream(&USUAL), tile_part(0, &[])].concat();
        let wrapped = [b"\0\0\0\x0cjP  any boxes".as_slice(), &stream].concat();
        assert_eq!(checked(wrapped).unwrap(), stream);
        assert!(checked(b"no code stream at all".to_vec()).is_err());
    }
}
