//! Compressed pixels lie in items (PS3.5 A.4): first a table of the frames' offsets, which may be
//! empty, then the frames, each in one fragment or more.
//!
//! Which fragments are a frame's is known, in this order, when there is one frame, when there are
//! as many fragments as frames (with an extended offset table there always are), from an offset
//! table whose every offset is that of a fragment, or from the marks that begin a code stream.

use std::io::{Read, Seek, SeekFrom};

use crate::codestream::begins;
use crate::error::FileError;

/// Most fragments that the frames of one file may be cut into.
const MAX_FRAGMENTS: usize = 1 << 20;

const ITEM: [u8; 4] = [0xfe, 0xff, 0x00, 0xe0];

/// Bytes of an item's header: its tag and its length.
const HEADER: u64 = 8;

/// Where the content of an item lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fragment {
    at: u64,
    length: u64,
    /// Begins with the first mark of a code stream.
    begins: bool,
}

/// Which fragments of a file are whose frame's.
#[derive(Clone, Debug)]
pub(crate) struct Index {
    fragments: Vec<Fragment>,
    /// The first fragment of each frame.
    firsts: Vec<usize>,
}

impl Index {
    /// Looks through the items of `frames` frames; `begin` is where the first item lies.
    pub(crate) fn read<S: Read + Seek>(
        source: &mut S,
        begin: u64,
        frames: usize,
    ) -> Result<Self, FileError> {
        let size = source.seek(SeekFrom::End(0))?;
        source.seek(SeekFrom::Start(begin))?;
        let table = *items(source, size, 1)?
            .first()
            .ok_or(FileError::Header("no offset table before the pixels"))?;
        let offsets = content(source, size, &[table], 4 * MAX_FRAGMENTS as u64)?;
        let (offsets, _) = offsets.as_chunks::<4>();
        let offsets: Vec<u32> = offsets.iter().map(|o| u32::from_le_bytes(*o)).collect();
        source.seek(SeekFrom::Start(table.at + table.length))?;
        let fragments = items(source, size, MAX_FRAGMENTS)?;
        let firsts = firsts(&fragments, &offsets, frames)?;
        Ok(Self { fragments, firsts })
    }

    /// The compressed bytes of frame `index`: its fragments put together.
    ///
    /// A frame of more than `most` bytes is refused.
    pub(crate) fn frame<S: Read + Seek>(
        &self,
        source: &mut S,
        index: usize,
        most: u64,
    ) -> Result<Vec<u8>, FileError> {
        let size = source.seek(SeekFrom::End(0))?;
        let end = self.firsts.get(index + 1).copied();
        let end = end.unwrap_or(self.fragments.len());
        content(source, size, &self.fragments[self.firsts[index]..end], most)
    }
}

/// The next items, `limit` at most; the last may reach beyond the end of the file.
fn items<S: Read + Seek>(
    source: &mut S,
    size: u64,
    limit: usize,
) -> Result<Vec<Fragment>, FileError> {
    let mut found = Vec::new();
    let mut at = source.stream_position()? + HEADER;
    // Where the closing delimiter is missing, what is there may still be whole.
    while found.len() < limit && at <= size {
        let mut header = [0; HEADER as usize];
        source.read_exact(&mut header)?;
        let [tag @ .., a, b, c, d] = header;
        if tag != ITEM {
            break;
        }
        let length = u64::from(u32::from_le_bytes([a, b, c, d]));
        let mut first = [0; 4];
        let looked_at = length.min(size - at).min(4) as usize;
        source.read_exact(&mut first[..looked_at])?;
        let begins = begins(&first);
        found.push(Fragment { at, length, begins });
        source.seek_relative(length as i64 - looked_at as i64)?;
        at += length + HEADER;
    }
    Ok(found)
}

fn content<S: Read + Seek>(
    source: &mut S,
    size: u64,
    fragments: &[Fragment],
    most: u64,
) -> Result<Vec<u8>, FileError> {
    if fragments.iter().map(|f| f.length).sum::<u64>() > most {
        return Err(FileError::Header("a frame or its table is far too long"));
    }
    let mut bytes = Vec::new();
    for Fragment { at, length, .. } in fragments {
        let needed = at + length;
        if needed > size {
            let found = size;
            return Err(FileError::CutOff { needed, found });
        }
        source.seek(SeekFrom::Start(*at))?;
        source.by_ref().take(*length).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The first fragment of each of `frames` frames.
fn firsts(fragments: &[Fragment], offsets: &[u32], frames: usize) -> Result<Vec<usize>, FileError> {
    if frames == 1 {
        return Ok(vec![0]);
    }
    if fragments.len() == frames {
        return Ok((0..frames).collect());
    }
    let firsts = by_table(fragments, offsets)
        .filter(|firsts| firsts.len() == frames)
        .unwrap_or_else(|| by_marks(fragments));
    if firsts.len() != frames || firsts[0] != 0 {
        return Err(FileError::Codec(format!(
            "{frames} frames in {} fragments cannot be told apart",
            fragments.len()
        )));
    }
    Ok(firsts)
}

/// Which fragments are the first of a frame, if every offset is that of a fragment.
fn by_table(fragments: &[Fragment], offsets: &[u32]) -> Option<Vec<usize>> {
    let begin = fragments.first()?.at;
    let firsts: Option<Vec<usize>> = offsets
        .iter()
        .map(|o| {
            fragments
                .binary_search_by_key(&(begin + u64::from(*o)), |f| f.at)
                .ok()
        })
        .collect();
    firsts.filter(|firsts| firsts.is_sorted_by(|a, b| a < b))
}

fn by_marks(fragments: &[Fragment]) -> Vec<usize> {
    (0..fragments.len())
        .filter(|i| fragments[*i].begins)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    const SOI: [u8; 2] = [0xff, 0xd8];

    fn item(content: &[u8]) -> Vec<u8> {
        let length = (content.len() as u32).to_le_bytes();
        [&ITEM, &length[..], content].concat()
    }

    fn table(offsets: &[u32]) -> Vec<u8> {
        item(
            &offsets
                .iter()
                .flat_map(|o| o.to_le_bytes())
                .collect::<Vec<u8>>(),
        )
    }

    fn stream(table: Vec<u8>, fragments: &[&[u8]]) -> Vec<u8> {
        let mut bytes = table;
        bytes.extend(fragments.iter().flat_map(|f| item(f)));
        bytes
    }

    /// All frames, or what is wrong with the first that cannot be read.
    fn frames(bytes: &[u8], count: usize) -> Result<Vec<Vec<u8>>, String> {
        let mut source = Cursor::new(bytes);
        let index = Index::read(&mut source, 0, count).map_err(|e| e.to_string())?;
        (0..count)
            .map(|i| index.frame(&mut source, i, 1000).map_err(|e| e.to_string()))
            .collect()
    }

    const END: [u8; 8] = [0xfe, 0xff, 0xdd, 0xe0, 0, 0, 0, 0];

    #[test]
    fn one_frame_is_all_its_fragments_with_or_without_an_end() {
        let mut bytes = stream(table(&[]), &[&[1, 2], &[3, 4], &[5, 6]]);
        let whole = vec![vec![1, 2, 3, 4, 5, 6]];
        assert_eq!(frames(&bytes, 1).unwrap(), whole);
        bytes.extend(END);
        bytes.extend([1; 30]);
        assert_eq!(frames(&bytes, 1).unwrap(), whole);
    }

    #[test]
    fn as_many_fragments_as_frames_need_no_table() {
        for table in [table(&[]), table(&[0, 10]), table(&[0, 4711])] {
            let bytes = stream(table, &[&[1, 2], &[3, 4, 5]]);
            assert_eq!(frames(&bytes, 2).unwrap(), [vec![1, 2], vec![3, 4, 5]]);
        }
    }

    #[test]
    fn a_table_tells_frames_of_several_fragments_apart() {
        let bytes = stream(table(&[0, 10]), &[&[1, 2], &[3, 4], &[5, 6]]);
        assert_eq!(frames(&bytes, 2).unwrap(), [vec![1, 2], vec![3, 4, 5, 6]]);
    }

    #[test]
    fn without_a_sound_table_the_marks_tell_them_apart() {
        let [soi, soc] = [[SOI[0], SOI[1], 1, 2], [0xff, 0x4f, 0xff, 0x51]];
        for table in [table(&[]), table(&[0, 13]), table(&[0]), table(&[12, 0])] {
            for mark in [soi, soc] {
                let bytes = stream(table.clone(), &[&mark, &[3, 4], &mark]);
                let expected = [[&mark[..], &[3, 4]].concat(), mark.to_vec()];
                assert_eq!(frames(&bytes, 2).unwrap(), expected);
            }
        }
    }

    #[test]
    fn frames_that_nothing_tells_apart_are_counted_in_the_message() {
        let bytes = stream(table(&[]), &[&[1, 2], &[3, 4], &[5, 6]]);
        let error = frames(&bytes, 2).unwrap_err();
        assert!(error.contains("2 frames in 3 fragments"), "{error}");
        assert!(frames(&stream(table(&[]), &[]), 2).is_err());
    }

    #[test]
    fn a_fragment_that_is_cut_off_costs_only_its_frame() {
        let mut bytes = stream(table(&[]), &[&[1, 2], &[3, 4]]);
        bytes.pop();
        assert!(frames(&bytes, 2).unwrap_err().contains("cut off"));
        let storage_of_first = stream(table(&[]), &[&[1, 2]]);
        assert_eq!(frames(&storage_of_first, 1).unwrap(), [vec![1, 2]]);
    }
}
