//! STL, binary or ASCII, through `stl_io`, with the checks and leniencies it lacks.
//!
//! The first word is no guide: many binary files begin with `solid`. A file whose size fits the
//! count in its header exactly is binary; any other must be readable as ASCII. The claimed count is
//! compared with the size before anything is reserved, so a wrong one costs nothing.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use bonemesh_task::Task;
use stl_io::Triangle;

use super::malformed;
use crate::merge::VertexMerger;
use crate::{MeshError, TriangleMesh};

/// Bytes before the first triangle of a binary file: header and count.
const HEAD: u64 = 84;
/// Bytes of a triangle in a binary file.
const RECORD: u64 = 50;
/// Triangles read between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;
/// A longer line belongs to no ASCII STL; without a limit one line could fill the memory.
const LONGEST_LINE: u64 = 1 << 16;

/// Reads the file and merges equal corners.
pub(super) fn read(path: &Path, task: &Task) -> Result<TriangleMesh, MeshError> {
    let unreadable = |e: io::Error| MeshError::reading(path, &e);
    let mut file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(MeshError::IsFolder {
            path: path.to_path_buf(),
        });
    }
    let bytes = metadata.len();
    let mut head = Vec::new();
    file.by_ref()
        .take(1024)
        .read_to_end(&mut head)
        .map_err(unreadable)?;
    file.rewind().map_err(unreadable)?;
    let mut soup = Soup::new(path);
    match kind_of(&head, bytes) {
        Kind::Binary { triangles } => {
            task.begin("read mesh", triangles);
            soup.add_binary(file, task)?;
        }
        Kind::Ascii => {
            task.begin("read mesh", bytes as usize);
            soup.add_ascii(BufReader::new(file), task)?;
        }
        Kind::Other(reason) => return Err(malformed(path, "STL", reason)),
    }
    TriangleMesh::new(soup.merger.into_vertices(), soup.triangles).map_err(|e| match e {
        MeshError::NotFinite { .. } => malformed(path, "STL", e.to_string()),
        other => other,
    })
}

/// What the first bytes and the size say of a file.
enum Kind {
    Binary { triangles: usize },
    Ascii,
    Other(String),
}

/// Binary if the size fits the count, ASCII if it begins with `solid` and has no zero bytes.
fn kind_of(head: &[u8], bytes: u64) -> Kind {
    let claimed = head
        .get(80..84)
        .and_then(|count| count.try_into().ok())
        .map(u32::from_le_bytes);
    if let Some(triangles) = claimed
        && HEAD + RECORD * u64::from(triangles) == bytes
    {
        return Kind::Binary {
            triangles: triangles as usize,
        };
    }
    if head.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        // Text has no zero bytes; the header and attributes of a binary file do.
        && !head.contains(&0)
    {
        return Kind::Ascii;
    }
    Kind::Other(match claimed {
        None if bytes == 0 => "it is empty".into(),
        None => format!("{bytes} bytes are too few"),
        Some(triangles) => {
            let holds = bytes.saturating_sub(HEAD) / RECORD;
            let most = HEAD + RECORD * u64::from(triangles);
            let wrong = if holds == u64::from(triangles) {
                format!("has {} bytes too many", bytes - most)
            } else {
                format!("would hold {holds} triangles where its header says {triangles}")
            };
            format!(
                "it is no text beginning with solid, and as a binary file of {bytes} bytes it {wrong}"
            )
        }
    })
}

/// The triangles read so far.
struct Soup<'a> {
    path: &'a Path,
    merger: VertexMerger,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Soup<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            merger: VertexMerger::default(),
            triangles: Vec::new(),
        }
    }

    fn push(&mut self, triangle: &Triangle) {
        let corners = triangle
            .vertices
            .map(|v| self.merger.index_of(v.0.map(f64::from)));
        self.triangles.push(corners);
    }

    fn add_binary(&mut self, file: File, task: &Task) -> Result<(), MeshError> {
        let mut masked = MaskedHeader { file, position: 0 };
        let path = self.path;
        let broken = |e: io::Error| MeshError::reading(path, &e);
        let reader = stl_io::create_stl_reader(&mut masked).map_err(broken)?;
        for triangle in reader {
            self.push(&triangle.map_err(broken)?);
            if self.triangles.len().is_multiple_of(STRIDE) {
                task.advance(STRIDE)?;
            }
        }
        Ok(())
    }

    /// Reads one solid after the other; `stl_io` stops after the first.
    fn add_ascii(&mut self, mut lines: impl BufRead, task: &Task) -> Result<(), MeshError> {
        let path = self.path;
        let mut section = Section::default();
        let mut line = Vec::new();
        for number in 1_usize.. {
            line.clear();
            let length = lines
                .by_ref()
                .take(LONGEST_LINE)
                .read_until(b'\n', &mut line)
                .map_err(|e| MeshError::reading(path, &e))?;
            let fault = |what: &str| malformed(path, "STL", format!("line {number} {what}"));
            if length == 0 {
                break;
            }
            if length as u64 == LONGEST_LINE {
                return Err(fault("is too long for text"));
            }
            section.add(&line).map_err(fault)?;
            if section.is_due() {
                for triangle in section.take() {
                    let triangle =
                        triangle.map_err(|e| fault(&format!("or one shortly before it: {e}")))?;
                    self.push(&triangle);
                }
            }
            if number.is_multiple_of(STRIDE) {
                task.check()?;
            }
            task.advance(length)?;
        }
        if section.is_open {
            return Err(malformed(
                path,
                "STL",
                "it ends before endsolid, so part of it is missing",
            ));
        }
        Ok(())
    }
}

/// Lines of an ASCII solid on their way to `stl_io`, in its own strict spelling.
///
/// It wants lower-case keywords, a name after `solid` and finite normals, none of which every
/// program writes; normals are not used here, so they are replaced.
#[derive(Default)]
struct Section {
    text: String,
    facets: usize,
    is_open: bool,
}

impl Section {
    /// Takes a line, or says what is wrong with it.
    fn add(&mut self, line: &[u8]) -> Result<(), &'static str> {
        let line = String::from_utf8_lossy(line).trim().to_ascii_lowercase();
        if line.is_empty() {
            return Ok(());
        }
        if !self.is_open {
            if !line.starts_with("solid") {
                return Err("should begin a solid");
            }
            self.is_open = true;
            return Ok(());
        }
        if line.starts_with("endsolid") {
            self.is_open = false;
            return Ok(());
        }
        if line.starts_with("facet") {
            self.facets += 1;
            self.text.push_str("facet normal 0 0 0");
        } else {
            self.text.push_str(&line);
        }
        self.text.push('\n');
        Ok(())
    }

    /// Whether the lines so far are to be read: at the end of a solid, or after many whole facets.
    fn is_due(&self) -> bool {
        let is_long = self.facets >= STRIDE && self.text.ends_with("endfacet\n");
        is_long || !(self.is_open || self.text.is_empty())
    }

    /// The triangles of the lines so far, which are then forgotten.
    fn take(&mut self) -> Vec<io::Result<Triangle>> {
        let text = format!("solid piece\n{}endsolid\n", std::mem::take(&mut self.text));
        self.facets = 0;
        match stl_io::create_stl_reader(&mut Cursor::new(text)) {
            Ok(reader) => {
                let mut triangles = Vec::new();
                for triangle in reader {
                    let is_last = triangle.is_err();
                    triangles.push(triangle);
                    if is_last {
                        break;
                    }
                }
                triangles
            }
            Err(error) => vec![Err(error)],
        }
    }
}

/// A binary STL whose header reads as zeros, because `stl_io` takes one beginning with `solid ` for
/// ASCII.
struct MaskedHeader {
    file: File,
    position: u64,
}

impl Read for MaskedHeader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        const MASKED: u64 = 80;
        let count = if self.position < MASKED {
            let count = buffer.len().min((MASKED - self.position) as usize);
            buffer[..count].fill(0);
            self.file
                .seek(SeekFrom::Start(self.position + count as u64))?;
            count
        } else {
            self.file.read(buffer)?
        };
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for MaskedHeader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.file.seek(to)?;
        Ok(self.position)
    }
}
