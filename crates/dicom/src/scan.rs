//! What a folder holds: its series, and what was left out and why.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::error::{DicomError, FileError};
use crate::group::{Stack, stacks};
use crate::header::Header;
use crate::series::Series;

/// Kinds of reasons that an error message lists.
const MAX_REASONS: usize = 4;

/// The series of a folder, largest first, and the files that belong to none.
#[derive(Clone, Debug, Serialize)]
pub struct Scan {
    /// Most slices first, then most voxels.
    pub series: Vec<Series>,
    /// Files and folders that are in no series.
    pub left_out: Vec<LeftOut>,
}

/// A file or folder that is in no series.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct LeftOut {
    /// The file or folder.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// Why it was left out.
    pub reason: String,
}

/// A path as text, its unreadable bytes replaced: serde refuses paths that are no Unicode.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// Paths as texts, see [`as_text`].
pub(crate) fn as_texts<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|p| p.to_string_lossy()))
}

impl LeftOut {
    fn new(path: &Path, reason: &impl ToString) -> Self {
        Self {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Finds the CT series in a folder and its sub-folders, by content and not by name.
///
/// Only headers are read, except where two slices are at the same place and their pixels decide
/// whether one is a copy. Links to folders are not followed.
///
/// # Errors
/// [`DicomError::NotFound`], [`DicomError::NotAFolder`], [`DicomError::Folder`];
/// [`DicomError::NoSeries`] when no two slices make a volume; [`DicomError::Cancelled`].
pub fn find_series(path: &Path, task: &Task) -> Result<Scan, DicomError> {
    let metadata = fs::metadata(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => DicomError::NotFound(path.to_owned()),
        _ => folder_error(path, &e),
    })?;
    if !metadata.is_dir() {
        return Err(DicomError::NotAFolder(path.to_owned()));
    }
    let mut left_out = Vec::new();
    let files = list(path, &mut left_out, task)?;
    task.begin("scan", files.len());
    let headers = files.par_iter().map(|file| {
        let header = Header::read(file);
        task.advance(1)?;
        Ok((file, header))
    });
    let headers: Result<Vec<_>, DicomError> = headers.collect();
    let mut usable = Vec::new();
    let mut cut_off: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, header) in headers? {
        match header {
            Ok(header) if header.is_cut_off => {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let names = cut_off.entry(header.series_uid).or_default();
                names.push(name.into_owned());
                let reason = "cut off: its pixels are not complete";
                left_out.push(LeftOut::new(file, &reason));
            }
            Ok(header) => usable.push(header),
            Err(error) => left_out.push(LeftOut::new(file, &error)),
        }
    }
    let mut series = Vec::new();
    for stack in stacks(usable, task)? {
        add(stack, &cut_off, &mut series, &mut left_out);
    }
    left_out.sort();
    if series.is_empty() {
        return Err(DicomError::NoSeries {
            path: path.to_owned(),
            summary: summary(&left_out),
        });
    }
    series.sort_by(|a, b| {
        let voxels = |s: &Series| s.slices * s.rows * s.columns;
        (b.slices_found, voxels(b))
            .cmp(&(a.slices_found, voxels(a)))
            .then_with(|| a.uid.cmp(&b.uid))
            .then_with(|| a.files.cmp(&b.files))
    });
    for (index, series) in series.iter_mut().enumerate() {
        series.number = index + 1;
    }
    Ok(Scan { series, left_out })
}

fn folder_error(path: &Path, error: &std::io::Error) -> DicomError {
    DicomError::Folder {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

/// All files below `root`, sorted; sub-folders that cannot be listed are left out.
fn list(root: &Path, left_out: &mut Vec<LeftOut>, task: &Task) -> Result<Vec<PathBuf>, DicomError> {
    let mut folders = vec![root.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        task.check()?;
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if folder == root => return Err(folder_error(root, &error)),
            Err(error) => {
                left_out.push(LeftOut::new(&folder, &FileError::Io(error)));
                continue;
            }
        };
        for entry in entries {
            match entry.and_then(|e| Ok((e.path(), e.file_type()?))) {
                Ok((path, kind)) if kind.is_dir() => folders.push(path),
                // A link to a folder could lead round in circles; a link to a file is a file.
                Ok((path, kind)) if kind.is_symlink() && path.is_dir() => {
                    left_out.push(LeftOut::new(&path, &"a link to a folder"));
                }
                Ok((path, _)) => files.push(path),
                Err(error) => left_out.push(LeftOut::new(&folder, &FileError::Io(error))),
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Makes a series of a stack, or leaves its files out.
fn add(
    stack: Stack,
    cut_off: &BTreeMap<String, Vec<String>>,
    series: &mut Vec<Series>,
    left_out: &mut Vec<LeftOut>,
) {
    for copy in &stack.copies {
        let reason = "the same slice is there already";
        left_out.push(LeftOut::new(&copy.header.path, &reason));
    }
    let files: Vec<PathBuf> = stack.slices.iter().map(|s| s.header.path.clone()).collect();
    if files.len() < 2 {
        let reason = "a single slice; a volume needs at least 2 of one orientation and size";
        left_out.extend(files.iter().map(|f| LeftOut::new(f, &reason)));
        return;
    }
    match Series::new(stack) {
        Ok(mut found) => {
            if let Some(names) = cut_off.get(&found.uid) {
                let (count, first) = (names.len(), &names[0]);
                found.warnings.push(format!(
                    "{count} {} cut off and left out, first {first}; copy the series again",
                    if count == 1 { "file is" } else { "files are" }
                ));
            }
            series.push(found);
        }
        Err(error) => left_out.extend(files.iter().map(|f| LeftOut::new(f, &error))),
    }
}

/// The most frequent reasons with their counts.
fn summary(left_out: &[LeftOut]) -> String {
    if left_out.is_empty() {
        return "it is empty".to_owned();
    }
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for file in left_out {
        *counts.entry(&file.reason).or_default() += 1;
    }
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let more = if counts.len() > MAX_REASONS {
        "; and others"
    } else {
        ""
    };
    let parts: Vec<String> = counts
        .into_iter()
        .take(MAX_REASONS)
        .map(|(reason, count)| format!("{count} left out: {reason}"))
        .collect();
    parts.join("; ") + more
}
