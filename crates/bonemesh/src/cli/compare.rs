//! `compare`: its arguments, its work, its words.

use std::fmt::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use bonemesh_measure::{Spread, heat_colours};
use bonemesh_mesh::{TriangleMesh, check_values_target, read_mesh, write_with_colours};
use bonemesh_task::Task;
use clap::Args;

use super::arguments::count;
use super::output::Answer;
use crate::Error;
use crate::compare::{CompareReport, CompareSettings, SpreadReport, compare, distances_to};
use crate::picture::{check_picture_target, write_distances};

/// The property of a file's vertices with the distance to the reference.
const DISTANCE: &str = "distance_mm";

/// Cubic millimetres in a cubic centimetre.
const MM3_PER_CM3: f64 = 1000.0;

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    mesh: PathBuf,
    /// Mesh file that it is compared with, in the same space.
    reference: PathBuf,
    /// File (.ply) for the mesh with its signed distance to the reference (mm, positive outside) at every
    /// vertex, as the property `distance_mm` and as colours: blue inside, red outside.
    #[arg(long, value_name = "PLY")]
    heat_map: Option<PathBuf>,
    /// Picture (.png) of how often each distance occurs.
    #[arg(long, value_name = "PNG")]
    histogram: Option<PathBuf>,
    /// Places of each surface from which distances are measured.
    #[arg(long, value_name = "COUNT", default_value = "100000", allow_negative_numbers = true, value_parser = count)]
    samples: NonZeroUsize,
    /// Leave the residual volume out, which takes longest.
    #[arg(long)]
    no_residual: bool,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    threads: Option<NonZeroUsize>,
}

/// Runs `compare`.
pub(super) fn run(arguments: &CompareArguments, task: &Task) -> Result<Answer, Error> {
    if let Some(path) = &arguments.heat_map {
        check_values_target(path)?;
    }
    if let Some(path) = &arguments.histogram {
        check_picture_target(path)?;
    }
    let mesh = read_mesh(&arguments.mesh, task)?;
    let reference = read_mesh(&arguments.reference, task)?;
    let settings = CompareSettings {
        samples: arguments.samples.get(),
        residual: !arguments.no_residual,
        threads: arguments.threads,
    };
    let compared = compare(&mesh, &reference, settings, task)?;
    let mut answer = Answer::new(&compared.report, in_words(&compared.report));
    if let Some(path) = &arguments.heat_map {
        let end_mm = write_heat_map(path, &mesh, &reference, arguments.threads, task)?;
        let line = format!(
            "{}\n  from {end_mm:.3} mm inside (blue) to {end_mm:.3} mm outside (red)\n",
            path.display()
        );
        answer.text.push_str(&line);
        answer = answer
            .with("heat_map", path.to_string_lossy())
            .with("heat_map_end_mm", end_mm);
    }
    if let Some(path) = &arguments.histogram {
        write_distances(path, &compared.signed_mm)?;
        let line = format!("{}\n", path.display());
        answer.text.push_str(&line);
        answer = answer.with("histogram", path.to_string_lossy());
    }
    Ok(answer)
}

/// Writes the mesh with distances and colours; gives the distance (mm) at which colours are full.
fn write_heat_map(
    path: &Path,
    mesh: &TriangleMesh,
    reference: &TriangleMesh,
    threads: Option<NonZeroUsize>,
    task: &Task,
) -> Result<f64, Error> {
    let distances = distances_to(mesh.vertices_mm(), reference, threads, task)?;
    let end_mm = Spread::of(&distances).p95_mm;
    let colours = heat_colours(&distances, end_mm);
    write_with_colours(path, mesh, DISTANCE, &distances, &colours, task)?;
    Ok(end_mm)
}

fn in_words(report: &CompareReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |l: String| {
        let _ = writeln!(text, "{l}");
    };
    line(format!(
        "distance of the surfaces: mean {:.4} mm, rms {:.4} mm, 95 % within {:.4} mm, at most {:.4} mm (Hausdorff)",
        report.mean_mm, report.rms_mm, report.p95_mm, report.hausdorff_mm
    ));
    let one_way = |s: &SpreadReport| {
        format!(
            "mean {:.4} mm, 95 % within {:.4} mm, at most {:.4} mm, with signs {:+.4} mm",
            s.mean_mm, s.p95_mm, s.max_mm, s.signed_mean_mm
        )
    };
    line(format!(
        "  mesh to reference: {}",
        one_way(&report.to_reference)
    ));
    line(format!(
        "  reference to mesh: {}",
        one_way(&report.from_reference)
    ));
    if let Some(found) = &report.edge_midpoints {
        line(format!(
            "edge midpoints (slices in common): overall {:.4} mm, by edge {:.4} mm, {} edges",
            found.overall_mm, found.midpoint_mm, found.edges
        ));
    }
    if let (Some(volume), Some(reference), Some(residual)) = (
        report.volume_mm3,
        report.reference_volume_mm3,
        report.residual_volume_mm3,
    ) {
        line(format!(
            "volumes: mesh {:.3} cm3, reference {:.3} cm3, residual (union less intersection) {:.4} cm3, {:.2} % of the reference",
            volume / MM3_PER_CM3,
            reference / MM3_PER_CM3,
            residual / MM3_PER_CM3,
            100.0 * residual / reference
        ));
    }
    for warning in &report.warnings {
        line(format!("note: {warning}"));
    }
    text
}
