//! The lines of a header.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::str::FromStr;

use crate::error::VolumeFileError;

/// Longest header that is read (bytes); the longest of real files have a few kilobytes.
const MAX_HEADER: u64 = 1 << 20;

/// Most bytes that are looked through for lines to be skipped.
const MAX_SKIPPED: u64 = 1 << 20;

/// Fields by their lower-case names.
#[derive(Clone, Debug, Default)]
pub(super) struct Fields {
    values: BTreeMap<String, String>,
    /// Bytes of the header, the empty line at its end included.
    pub(super) length: u64,
}

impl Fields {
    /// Reads the lines up to the first empty one or, in a detached header, to the end.
    pub(super) fn read(path: &Path) -> Result<Self, VolumeFileError> {
        let io = |e: io::Error| VolumeFileError::io(path, &e);
        let mut file = BufReader::new(File::open(path).map_err(io)?.take(MAX_HEADER));
        let mut fields = Self::default();
        let mut line = Vec::new();
        loop {
            line.clear();
            let count = file.read_until(b'\n', &mut line).map_err(io)?;
            let is_first = fields.length == 0;
            fields.length += count as u64;
            let is_whole = line.ends_with(b"\n");
            let text = String::from_utf8_lossy(&line);
            let text = text.trim_end_matches(['\n', '\r']);
            if is_first {
                check_version(path, text)?;
            } else if count == 0 && fields.get("data file").is_none() {
                let reason = "the empty line after its fields is missing";
                return Err(VolumeFileError::header(path, reason));
            } else if count == 0 || (is_whole && text.is_empty()) {
                return Ok(fields);
            } else {
                fields.add(text);
            }
        }
    }

    /// Takes a line; comments and `key:=value` pairs say nothing about the voxels.
    fn add(&mut self, line: &str) {
        let Some((name, value)) = line.split_once(':') else {
            return;
        };
        if line.starts_with('#') || value.starts_with('=') {
            return;
        }
        let name = match name.trim().to_lowercase() {
            name if name == "datafile" => "data file".to_owned(),
            name if name == "lineskip" => "line skip".to_owned(),
            name if name == "byteskip" => "byte skip".to_owned(),
            name if name == "blocksize" => "block size".to_owned(),
            name => name,
        };
        self.values
            .entry(name)
            .or_insert_with(|| value.trim().to_owned());
    }

    /// The text of a field.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.values.get(name).map(String::as_str)
    }

    /// The text of a field that must be there.
    pub(super) fn required(&self, path: &Path, name: &str) -> Result<&str, VolumeFileError> {
        self.get(name)
            .ok_or_else(|| VolumeFileError::header(path, format!("the field `{name}` is missing")))
    }

    /// The number in a field, if it is there.
    pub(super) fn number<T: FromStr>(
        &self,
        path: &Path,
        name: &str,
    ) -> Result<Option<T>, VolumeFileError> {
        let number = |text: &str| {
            text.parse().map_err(|_| {
                let reason = format!("`{}` is no {name}", text.escape_debug());
                VolumeFileError::header(path, reason)
            })
        };
        self.get(name).map(number).transpose()
    }

    /// The words of a per-axis field; as many as there are dimensions.
    pub(super) fn words(
        &self,
        path: &Path,
        name: &str,
        dimensions: usize,
    ) -> Result<Option<Vec<&str>>, VolumeFileError> {
        let Some(text) = self.get(name) else {
            return Ok(None);
        };
        let words = words(text);
        if words.len() == dimensions {
            return Ok(Some(words));
        }
        let reason = format!("{} {name} for {dimensions} dimensions", words.len());
        Err(VolumeFileError::header(path, reason))
    }
}

/// Words between white space; `(0, 1, 2)` and `"mm per s"` are one word each.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let end = match first {
            '(' => rest.find(')').map(|n| n + 1),
            '"' => rest[1..].find('"').map(|n| n + 2),
            _ => rest.find(char::is_whitespace),
        };
        let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
        words.push(word);
        rest = after.trim_start();
    }
    words
}

fn check_version(path: &Path, line: &str) -> Result<(), VolumeFileError> {
    match line.strip_prefix("NRRD000").map(str::trim_end) {
        Some("1" | "2" | "3" | "4" | "5") => Ok(()),
        _ => Err(VolumeFileError::unsupported(
            path,
            format!(
                "a file of the version `{}`",
                line.chars().take(12).collect::<String>().escape_debug()
            ),
            "save it as NRRD0004 or NRRD0005",
        )),
    }
}

/// The place in a file after `lines` lines, counted from `start` on.
pub(super) fn after_lines(path: &Path, start: u64, lines: u64) -> Result<u64, VolumeFileError> {
    if lines == 0 {
        return Ok(start);
    }
    let io = |e: io::Error| VolumeFileError::io(path, &e);
    let mut file = File::open(path).map_err(io)?;
    file.seek(SeekFrom::Start(start)).map_err(io)?;
    let mut file = BufReader::new(file.take(MAX_SKIPPED));
    let mut end = start;
    for _ in 0..lines {
        let count = file.skip_until(b'\n').map_err(io)?;
        if count == 0 {
            let reason = format!("{lines} lines to be skipped are not there");
            return Err(VolumeFileError::header(path, reason));
        }
        end += count as u64;
    }
    Ok(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_quoted_words_are_one_word_each() {
        assert_eq!(
            words("(1, 0,0)  none(0,1,0) \"milli metre\" x"),
            ["(1, 0,0)", "none(0,1,0)", "\"milli metre\"", "x"]
        );
        assert_eq!(words(" (1,2"), ["(1,2"]);
    }
}
