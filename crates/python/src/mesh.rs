//! A triangle mesh.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use bonemesh::{Error, MeshError, PatientFrame, TriangleMesh};
use ndarray::Array2;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::arrays::{Input, numpy, rows};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::report::{dict, json, value};
use crate::views::read_only;

/// A triangle mesh in millimetres; it never changes.
///
/// Vertices are single precision, as in mesh files and in Blender, and every step that starts from
/// a `Mesh` uses exactly these: a mesh, the file it was saved to and what Blender shows are equal.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Mesh {
    parts: Arc<Parts>,
    /// What is said of the mesh, as one JSON object.
    report: String,
}

/// The arrays of a mesh.
pub(crate) struct Parts {
    vertices: Array2<f32>,
    triangles: Array2<u32>,
    /// The same for the library, once it was asked for by what is asked again and again.
    kept: OnceLock<TriangleMesh>,
}

#[pymethods]
impl Mesh {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let vertices = Input::new("vertices", vertices)?.vectors()?;
        let triangles = Input::new("triangles", triangles)?.index_triples()?;
        let mesh = TriangleMesh::new(vertices, triangles).map_err(Error::from);
        let mesh = mesh.and_then(|mesh| Self::of(mesh, &NoReport {}));
        mesh.map_err(|e| errors::raised(py, &e))
    }

    /// `(N, 3) float32`, mm: a read-only view.
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        numpy(slf.py())?;
        Ok(read_only(slf, |mesh| &mesh.parts.vertices))
    }

    /// `(M, 3) uint32`, counter-clockwise seen from outside: a read-only view.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        numpy(slf.py())?;
        Ok(read_only(slf, |mesh| &mesh.parts.triangles))
    }

    /// What the step that made the mesh says of it; a new dict each time.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, &self.report)
    }

    /// Write the mesh to a file; its extension (.stl, .ply, .obj, .3mf) names the format.
    ///
    /// - `frame`: "LPS", to the left, the back and the head, as the mesh has it; or "RAS", to the right, the
    ///   front and the head: turned, not mirrored. The file says which.
    /// - `sidecar`: writes the report beside it, as PATH.json, with the file's unit and frame, without times,
    ///   memory and warnings.
    #[pyo3(signature = (path, *, frame="LPS", sidecar=false, progress=None, cancel=None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        frame: &str,
        sidecar: bool,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<()> {
        let watch = Watch::new(py, progress, cancel)?;
        let parts = self.parts();
        let frame: PatientFrame = frame.parse().map_err(|e| errors::unusable(py, e))?;
        let report = sidecar.then(|| self.report.clone());
        detached(py, watch, move |task| {
            if report.is_some() {
                bonemesh::check_sidecar_target(&path)?;
            }
            bonemesh::write_mesh_in(&path, &parts.mesh()?, frame, task)?;
            report.map_or(Ok(()), |report| {
                bonemesh::write_sidecar(&path, frame, &value(&report))
            })
        })
    }

    fn __repr__(&self) -> String {
        let (vertices, triangles) = (self.parts.vertices.nrows(), self.parts.triangles.nrows());
        format!("<bonemesh.Mesh, {vertices} vertices, {triangles} triangles>")
    }
}

/// Read a mesh file (.stl, .ply, .obj, .3mf); equal vertices become one, in file order.
#[pyfunction]
#[pyo3(signature = (path, *, progress=None, cancel=None))]
pub(crate) fn read_mesh(
    py: Python<'_>,
    path: PathBuf,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    detached(py, watch, move |task| {
        Mesh::of(bonemesh::read_mesh(&path, task)?, &NoReport {})
    })
}

/// Nothing is said of a mesh that was not made here.
#[derive(Serialize)]
struct NoReport {}

impl Mesh {
    /// `mesh` in single precision, with its `report`.
    pub(crate) fn of(mesh: TriangleMesh, report: &impl Serialize) -> Result<Self, Error> {
        let (vertices_mm, triangles) = mesh.into_parts();
        let single: Vec<[f32; 3]> = vertices_mm.iter().map(|v| v.map(|c| c as f32)).collect();
        if let Some(vertex) = single.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
            let [x, y, z] = vertices_mm[vertex];
            let value = x.abs().max(y.abs()).max(z.abs());
            return Err(MeshError::NotFinite { vertex, value }.into());
        }
        Ok(Self {
            parts: Arc::new(Parts {
                vertices: rows(single),
                triangles: rows(triangles),
                kept: OnceLock::new(),
            }),
            report: json(report),
        })
    }

    /// The arrays, for work that goes on while Python may drop the mesh.
    pub(crate) fn parts(&self) -> Arc<Parts> {
        self.parts.clone()
    }
}

impl Parts {
    /// The mesh as the library works with it, the same coordinates in double precision.
    pub(crate) fn mesh(&self) -> Result<TriangleMesh, Error> {
        let vertices = self.vertices.as_slice().map(<[f32]>::as_chunks::<3>);
        let triangles = self.triangles.as_slice().map(<[u32]>::as_chunks::<3>);
        let (Some((vertices, _)), Some((triangles, _))) = (vertices, triangles) else {
            unreachable!("the arrays are in C order, so each is one slice: anything else is a bug");
        };
        let vertices_mm = vertices.iter().map(|v| v.map(f64::from)).collect();
        Ok(TriangleMesh::new(vertices_mm, triangles.to_vec())?)
    }

    /// The same, kept as long as the mesh is: for short work, which the copy would take longer than.
    pub(crate) fn kept_mesh(&self) -> Result<&TriangleMesh, Error> {
        if let Some(mesh) = self.kept.get() {
            return Ok(mesh);
        }
        let mesh = self.mesh()?;
        Ok(self.kept.get_or_init(|| mesh))
    }
}
