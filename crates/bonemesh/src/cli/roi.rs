//! What `roi` is told.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{Method as RoiMethod, ThicknessMm};
use clap::Args;

use super::arguments::{count, mesh_file, number};

#[derive(Debug, Args)]
pub(super) struct Roi {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    pub(super) mesh: PathBuf,
    #[command(flatten)]
    pub(super) selection: Selection,
    /// How deep the region reaches below the selection, in mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = thickness)]
    pub(super) thickness: ThicknessMm,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    /// How the region is found: thesis.
    #[arg(long, default_value = "thesis")]
    pub(super) method: RoiMethod,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    pub(super) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(super) struct Selection {
    /// Text file with one vertex index a line, of the mesh as read and vertex-merged in file order.
    #[arg(long = "selection", value_name = "FILE")]
    pub(super) file: Option<PathBuf>,
    /// Select every vertex within RADIUS mm of the point X,Y,Z instead.
    #[arg(long, value_name = "X,Y,Z,RADIUS", allow_negative_numbers = true)]
    pub(super) within: Option<Ball>,
}

/// A ball in the mesh's frame, in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre_mm: [f64; 3],
    radius_mm: f64,
}

impl Ball {
    /// The vertices of `mesh` inside the ball.
    pub(super) fn vertices(&self, mesh: &TriangleMesh) -> Vec<u32> {
        let squared = self.radius_mm * self.radius_mm;
        let inside = |v: &[f64; 3]| {
            (0..3)
                .map(|i| (v[i] - self.centre_mm[i]).powi(2))
                .sum::<f64>()
                <= squared
        };
        (0_u32..)
            .zip(mesh.vertices_mm())
            .filter_map(|(i, v)| inside(v).then_some(i))
            .collect()
    }
}

impl FromStr for Ball {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, String> = text.split(',').map(|n| number(n.trim())).collect();
        match numbers?[..] {
            [x, y, z, radius_mm]
                if radius_mm > 0.0 && [x, y, z, radius_mm].iter().all(|v| v.is_finite()) =>
            {
                Ok(Self {
                    centre_mm: [x, y, z],
                    radius_mm,
                })
            }
            _ => Err(format!(
                "`{text}` is no ball; write x,y,z,radius in mm with a radius above 0, for example 0,-90,40,20"
            )),
        }
    }
}

fn thickness(text: &str) -> Result<ThicknessMm, String> {
    ThicknessMm::new(number(text)?).map_err(|e| e.to_string())
}
