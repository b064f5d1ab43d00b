//! What `roi` and `mirror` are told.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{ClearanceMm, Direction, Method as RoiMethod, ThicknessMm};
use clap::Args;

use super::arguments::{count, mesh_file, number};
use super::mesh_file::FileArguments;
use crate::mirror::PlaneChoice;
use crate::region::{Mirror as Mirrored, RegionRequest};

#[derive(Debug, Args)]
pub(super) struct Roi {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    pub(super) mesh: PathBuf,
    #[command(flatten)]
    pub(super) selection: Selection,
    /// How deep the region reaches below the selection, or how thick a plate is, in mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = thickness)]
    thickness: ThicknessMm,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) file: FileArguments,
    /// How the region is found: solid, cut out of the bone; or thesis, slice by slice along one normal.
    #[arg(long, default_value = "solid")]
    method: RoiMethod,
    /// Which way a solid is cut: normal, along the surface's own normals to the far side of the bone;
    /// through, straight through all that lies behind; outward, the plate that lies on the bone; or
    /// X,Y,Z, straight along this direction to the far side.
    #[arg(
        long,
        default_value = "normal",
        value_name = "normal|through|outward|X,Y,Z",
        allow_hyphen_values = true
    )]
    direction: Direction,
    /// The gap between bone and plate, in mm, from 0 to 20; 0.2 if none is given.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = clearance)]
    clearance: Option<ClearanceMm>,
    /// Take selected pieces, too, that lie hidden behind others.
    #[arg(long)]
    hidden: bool,
    /// One solid for each piece of the selection that does not touch the others, the largest first:
    /// OUTPUT-1.stl, OUTPUT-2.stl, ...
    #[arg(long)]
    pub(super) separate: bool,
    /// Take what lies on the other side of this plane in place of the selection: auto, the bone's own
    /// plane of symmetry; across the patient's x, y or z, through the middle of the mesh; the places p
    /// with N · p = D; or through three places X,Y,Z;X,Y,Z;X,Y,Z.
    #[arg(long, value_name = "auto|x|y|z|NX,NY,NZ,D", allow_hyphen_values = true)]
    mirror: Option<PlaneChoice>,
    /// Put what was taken from the other side where the selection is, as the template for an implant.
    #[arg(long, requires = "mirror")]
    mirror_back: bool,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    threads: Option<NonZeroUsize>,
}

impl Roi {
    pub(super) fn request(&self) -> RegionRequest {
        RegionRequest {
            thickness: self.thickness,
            method: self.method,
            direction: self.direction,
            clearance: self.clearance.unwrap_or_default(),
            with_hidden: self.hidden,
            mirror: self.mirror.map(|plane| Mirrored {
                plane,
                back: self.mirror_back,
            }),
            threads: self.threads,
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct Mirror {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    pub(super) mesh: PathBuf,
    /// The plane: auto, the mesh's own plane of symmetry; x, y or z, across the patient's axis through the
    /// middle of the mesh; the places p with N · p = D; or through three places X,Y,Z;X,Y,Z;X,Y,Z.
    #[arg(
        long,
        default_value = "auto",
        value_name = "auto|x|y|z|NX,NY,NZ,D",
        allow_hyphen_values = true
    )]
    pub(super) plane: PlaneChoice,
    /// Mesh file whose plane of symmetry is found, such as the whole skull that the mesh is a part of.
    #[arg(long, value_name = "MESH")]
    pub(super) of: Option<PathBuf>,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) file: FileArguments,
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
    #[arg(long, value_name = "X,Y,Z,RADIUS", allow_hyphen_values = true)]
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

fn clearance(text: &str) -> Result<ClearanceMm, String> {
    ClearanceMm::new(number(text)?).map_err(|e| e.to_string())
}

fn thickness(text: &str) -> Result<ThicknessMm, String> {
    ThicknessMm::new(number(text)?).map_err(|e| e.to_string())
}
