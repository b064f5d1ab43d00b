//! How the mesh that a command makes is written.

use std::path::Path;

use bonemesh_mesh::{PatientFrame, TriangleMesh, check_target, write_mesh_in};
use bonemesh_task::Task;
use clap::Args;
use serde::Serialize;

use crate::Error;
use crate::sidecar::{check_sidecar_target, write_sidecar};

#[derive(Debug, Args)]
pub(super) struct FileArguments {
    /// Frame of the file's coordinates: lps, to the left, the back and the head, as DICOM has it; or ras,
    /// to the right, the front and the head.
    #[arg(long, default_value = "lps")]
    frame: PatientFrame,
    /// Write beside the mesh, as OUTPUT.json, how it was made.
    #[arg(long)]
    sidecar: bool,
}

impl FileArguments {
    /// Tells before the work whether its result can be written.
    pub(super) fn check(&self, output: &Path) -> Result<(), Error> {
        check_target(output)?;
        if self.sidecar {
            check_sidecar_target(output)?;
        }
        Ok(())
    }

    /// Writes the mesh and, if asked for, its report beside it.
    pub(super) fn write(
        &self,
        output: &Path,
        mesh: &TriangleMesh,
        report: &impl Serialize,
        task: &Task,
    ) -> Result<(), Error> {
        write_mesh_in(output, mesh, self.frame, task)?;
        if self.sidecar {
            let report = serde_json::to_value(report)
                .expect("reports have text keys and plain values: anything else is a bug");
            write_sidecar(output, self.frame, &report)?;
        }
        Ok(())
    }
}
