//! The selected vertices.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use crate::RoiError;

/// Longest line of a selection file, comment included.
const LONGEST_LINE: u64 = 4096;
/// How much of a wrong line an error repeats.
const QUOTED: usize = 40;

/// Reads vertex indices, one a line, in the order of the file.
///
/// Blank lines and whatever follows a `#` are passed over. The indices are of the mesh as
/// [`bonemesh_mesh::read_mesh`] returns it, from 0.
///
/// # Errors
/// [`RoiError::SelectionFile`], [`RoiError::SelectionLine`] or [`RoiError::SelectionEmpty`].
pub fn read_selection(path: impl AsRef<Path>) -> Result<Vec<u32>, RoiError> {
    let path = path.as_ref();
    let unreadable = |e: std::io::Error| RoiError::SelectionFile {
        path: path.to_path_buf(),
        reason: e.to_string(),
    };
    let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
    let mut indices = Vec::new();
    let mut bytes = Vec::new();
    for line in 1.. {
        bytes.clear();
        let length = file
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut bytes)
            .map_err(unreadable)?;
        if length == 0 {
            break;
        }
        let text = String::from_utf8_lossy(&bytes);
        // Some editors begin a file with a byte-order mark.
        let text = text.trim_start_matches('\u{feff}');
        let entry = text.split('#').next().unwrap_or_default().trim();
        let is_too_long = length as u64 == LONGEST_LINE;
        match entry.parse() {
            Ok(index) if !is_too_long => indices.push(index),
            Err(_) if entry.is_empty() && !is_too_long => {}
            _ => {
                return Err(RoiError::SelectionLine {
                    path: path.to_path_buf(),
                    line,
                    text: entry.chars().take(QUOTED).collect(),
                });
            }
        }
    }
    if indices.is_empty() {
        return Err(RoiError::SelectionEmpty {
            path: path.to_path_buf(),
        });
    }
    Ok(indices)
}

/// At least two different vertices of a mesh, in ascending order.
#[derive(Debug)]
pub(crate) struct Selection {
    indices: Vec<u32>,
    is_selected: Vec<bool>,
}

impl Selection {
    /// The distinct ones of `selected`, all of which must be below `vertices`.
    pub(crate) fn new(selected: &[u32], vertices: usize) -> Result<Self, RoiError> {
        let mut is_selected = vec![false; vertices];
        for &vertex in selected {
            let Some(flag) = is_selected.get_mut(vertex as usize) else {
                return Err(RoiError::Index { vertex, vertices });
            };
            *flag = true;
        }
        let indices: Vec<u32> = (0..)
            .zip(&is_selected)
            .filter(|(_, s)| **s)
            .map(|(v, _)| v)
            .collect();
        match indices.len() {
            0 => Err(RoiError::NoSelection),
            1 => Err(RoiError::OneVertex),
            _ => Ok(Self {
                indices,
                is_selected,
            }),
        }
    }

    /// The vertices, ascending.
    pub(crate) fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Whether a vertex of the mesh is one of them.
    pub(crate) fn contains(&self, vertex: u32) -> bool {
        self.is_selected[vertex as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Vec<u32>, RoiError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        read_selection(file.path())
    }

    #[test]
    fn blank_lines_and_comments_are_passed_over() {
        let text = b"# lassoed\r\n7\r\n\r\n  3 # the apex\n7\n#\n4294967295";
        assert_eq!(read(text).unwrap(), [7, 3, 7, u32::MAX]);
    }

    #[test]
    fn a_wrong_line_is_named_with_its_number() {
        for wrong in ["-1", "1.5", "seven", "1 2", "4294967296", "\u{0}"] {
            let error = read(format!("1\n# fine\n{wrong}\n").as_bytes()).unwrap_err();
            assert!(
                matches!(error, RoiError::SelectionLine { line: 3, .. }),
                "{error}"
            );
            assert!(!error.to_string().contains('\n'));
        }
        let long = read(&[b'1'; 10_000]).unwrap_err().to_string();
        assert!(long.len() < 300, "{long}");
        assert!(read(b"\xff\xfe\x00\n").is_err());
    }

    #[test]
    fn a_file_without_indices_or_no_file_at_all_is_refused() {
        assert!(matches!(
            read(b"# none\n\n"),
            Err(RoiError::SelectionEmpty { .. })
        ));
        let missing = read_selection("no-such-selection.txt").unwrap_err();
        assert!(missing.to_string().contains("no-such-selection.txt"));
    }

    #[test]
    fn a_selection_needs_two_different_vertices_of_the_mesh() {
        assert!(matches!(Selection::new(&[], 9), Err(RoiError::NoSelection)));
        assert!(matches!(
            Selection::new(&[4, 4], 9),
            Err(RoiError::OneVertex)
        ));
        assert!(matches!(
            Selection::new(&[4, 9], 9),
            Err(RoiError::Index {
                vertex: 9,
                vertices: 9
            })
        ));
        let selection = Selection::new(&[8, 4, 8], 9).unwrap();
        assert_eq!(selection.indices(), [4, 8]);
        assert!(selection.contains(8) && !selection.contains(5));
    }
}
