//! `roi` and `mirror`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use bonemesh_mesh::read_mesh;
use bonemesh_roi::read_selection;
use bonemesh_task::Task;
use serde_json::json;

use super::mesh_file::FileArguments;
use super::output::Answer;
use super::roi::{Mirror, Roi};
use super::text;
use crate::Error;
use crate::region::{RegionResult, select_roi, select_rois};
use crate::region_report::RegionReport;
use crate::sidecar::sidecar_path;

/// `roi`.
pub(super) fn cut(arguments: &Roi, task: &Task) -> Result<Answer, Error> {
    arguments.file.check(&arguments.output)?;
    let mesh = read_mesh(&arguments.mesh, task)?;
    let selected = match (&arguments.selection.file, &arguments.selection.within) {
        (_, Some(ball)) => ball.vertices(&mesh),
        (Some(file), None) => read_selection(file)?,
        (None, None) => Vec::new(),
    };
    if arguments.separate {
        let regions = select_rois(&mesh, &selected, &arguments.request(), task)?;
        return write_regions(&regions, &arguments.output, &arguments.file, task);
    }
    let region = select_roi(&mesh, &selected, &arguments.request(), task)?;
    let (output, file) = (&arguments.output, &arguments.file);
    file.write(output, &region.mesh, &region.report, task)?;
    Ok(region_answer(&region.report, output))
}

fn region_answer(report: &RegionReport, output: &Path) -> Answer {
    Answer::new(report, text::region(report, output)).with("output", output.to_string_lossy())
}

/// Writes each region to a file of its own: all of them or, where one fails, none.
fn write_regions(
    regions: &[RegionResult],
    output: &Path,
    file: &FileArguments,
    task: &Task,
) -> Result<Answer, Error> {
    let mut text = String::new();
    let mut reports = Vec::new();
    let mut written: Vec<PathBuf> = Vec::new();
    for (number, region) in (1..).zip(regions) {
        let path = numbered(output, number);
        if let Err(error) = file.write(&path, &region.mesh, &region.report, task) {
            for path in written
                .iter()
                .flat_map(|path| [path.clone(), sidecar_path(path)])
            {
                // What cannot be taken away again stays: the error is that of the file that failed.
                let _ = std::fs::remove_file(path);
            }
            return Err(error);
        }
        let answer = region_answer(&region.report, &path);
        text.push_str(&answer.text);
        reports.push(answer.json);
        written.push(path);
    }
    Ok(Answer::new(&json!({ "regions": reports }), text))
}

/// `region.stl` as `region-1.stl`.
fn numbered(path: &Path, number: usize) -> PathBuf {
    let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let [stem, ending] = [path.file_stem(), path.extension()].map(part);
    path.with_file_name(format!("{stem}-{number}.{ending}"))
}

/// `mirror`.
pub(super) fn mirror(arguments: &Mirror, task: &Task) -> Result<Answer, Error> {
    arguments.file.check(&arguments.output)?;
    let mesh = read_mesh(&arguments.mesh, task)?;
    let whole = match &arguments.of {
        Some(file) => &read_mesh(file, task)?,
        None => &mesh,
    };
    let chosen = arguments.plane.choose(whole, arguments.threads, task)?;
    let mirrored = mesh.mirrored(&chosen.plane);
    let (output, file) = (&arguments.output, &arguments.file);
    file.write(output, &mirrored, &chosen.report, task)?;
    let text = text::mirrored(&chosen.report, &arguments.output);
    Ok(Answer::new(&chosen.report, text).with("output", arguments.output.to_string_lossy()))
}
