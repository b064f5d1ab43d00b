//! What is done to a finished mesh, as arguments; and `repair`, which does it to a file.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use bonemesh_mesh::{Decimation, Islands, check_topology, read_mesh};
use bonemesh_task::{Task, pool};
use clap::Args;

use super::after_care_values as values;
use super::arguments::{count, length_mm, mesh_file};
use super::mesh_file::FileArguments;
use super::output::Answer;
use super::text;
use crate::{AfterCare, Cavities, Error, Holes, care_for};

#[derive(Debug, Args)]
pub(super) struct AfterCareArguments {
    /// Fill `all` holes of an open mesh, or those that are no longer than this.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = values::holes)]
    fill_holes: Option<Holes>,
    /// Keep only the `largest` island of the mesh, or all of at least this volume, or the bones at
    /// these places (mm, in the mesh's frame; several with a semicolon between them).
    #[arg(long, value_name = "MM3|X,Y,Z", allow_negative_numbers = true, value_parser = values::islands)]
    islands: Option<Islands>,
    /// Fill `all` cavities inside the bone, or those of at most this volume.
    #[arg(long, value_name = "MM3", allow_negative_numbers = true, value_parser = values::cavities)]
    fill_cavities: Option<Cavities>,
    /// Smooth, and move no vertex further than this.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = length_mm)]
    smooth: Option<f64>,
    /// Take triangles away until this many are left.
    #[arg(long, value_name = "COUNT", allow_negative_numbers = true, value_parser = count)]
    triangles: Option<NonZeroUsize>,
    /// Take triangles away as long as the surface moves no further than this.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = length_mm)]
    decimate: Option<f64>,
}

impl AfterCareArguments {
    pub(super) fn settings(&self) -> AfterCare {
        AfterCare {
            clean: false,
            face_outward: false,
            holes: self.fill_holes,
            islands: self.islands.clone(),
            cavities: self.fill_cavities,
            smooth_mm: self.smooth,
            decimation: Decimation {
                triangles: self.triangles.map(NonZeroUsize::get),
                error_mm: self.decimate,
            },
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct Repair {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    mesh: PathBuf,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    output: PathBuf,
    #[command(flatten)]
    file: FileArguments,
    #[command(flatten)]
    care: AfterCareArguments,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    threads: Option<NonZeroUsize>,
}

/// Takes out what is no surface, turns over what faces the wrong way, and does what the arguments ask for.
pub(super) fn run(arguments: &Repair, task: &Task) -> Result<Answer, Error> {
    arguments.file.check(&arguments.output)?;
    let mesh = read_mesh(&arguments.mesh, task)?;
    let care = AfterCare {
        clean: true,
        face_outward: true,
        ..arguments.care.settings()
    };
    let (mesh, report) = pool(arguments.threads)?.install(|| care_for(mesh, &care, task))?;
    arguments
        .file
        .write(&arguments.output, &mesh, &report, task)?;
    let topology = check_topology(&mesh, task)?;
    let text = text::repaired(&report, &topology, &arguments.output);
    Ok(Answer::new(&report, text)
        .with("vertices", topology.vertices)
        .with("triangles", topology.triangles)
        .with("watertight", topology.watertight)
        .with("manifold", topology.manifold)
        .with("components", topology.components)
        .with("volume_mm3", topology.volume_mm3)
        .with("output", arguments.output.to_string_lossy()))
}
