//! Long lists of short texts, made on all cores and written in order.

use std::io::{self, Write};

use bonemesh_task::Task;
use rayon::prelude::*;

use super::BLOCK;
use super::atomic::Fault;

/// Items made to text by one thread at a time.
const PIECE: usize = 1 << 12;

/// Writes the text that `encode` adds for each item; an item is one unit of progress.
pub(super) fn write<T: Sync>(
    file: &mut impl Write,
    items: &[T],
    task: &Task,
    encode: impl Fn(&T, &mut Vec<u8>) -> io::Result<()> + Sync,
) -> Result<(), Fault> {
    for block in items.chunks(BLOCK) {
        let pieces = block.par_chunks(PIECE).map(|piece| {
            let mut text = Vec::with_capacity(48 * piece.len());
            for item in piece {
                encode(item, &mut text)?;
            }
            Ok(text)
        });
        for piece in pieces.collect::<io::Result<Vec<_>>>()? {
            file.write_all(&piece)?;
            task.check()?;
        }
        task.advance(block.len())?;
    }
    Ok(())
}
