//! 3MF: the meshes of what is to be built, put to their places.
//!
//! 1. `Archive::open`: the zip's table of contents.
//! 2. `Archive::root`: the part that the package's relationship names as its model.
//! 3. `Archive::model`: that part and, as items and components name them, others; read once each.
//! 4. `Assembly::place`: every item's meshes, through all components, with their transforms.
//!
//! Colours, materials, slices, beam lattices and thumbnails are passed over.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::rc::Rc;

use bonemesh_task::Task;
use zip::ZipArchive;

use super::malformed;
use super::threemf_model::{self, Fault, IDENTITY, Model, Placed, Transform};
use super::xml::{Tags, XmlFault};
use crate::{MeshError, TriangleMesh};

/// Texts of models are written to a tenth of their size or so; a file that claims to unpack to more
/// than this many times its own is made to fill the memory.
const MOST_UNPACKED: u64 = 200;
/// Bytes that may be unpacked in any case.
const FREE_UNPACKED: u64 = 1 << 20;
/// Components within components; more are a circle, or made to look like one.
const DEEPEST: usize = 32;
/// Objects placed; more are made to take for ever.
const MOST_PLACED: usize = 1 << 16;
/// Triangles that copies of objects may add to those in the file.
const MOST_COPIED: usize = 1 << 22;

/// Reads the meshes of all items and merges equal vertices.
pub(super) fn read(path: &Path, task: &Task) -> Result<TriangleMesh, MeshError> {
    let mut archive = Archive::open(path, task)?;
    let root = archive.root()?;
    let model = archive.model(&root)?;
    let all = model.objects.keys().map(|&object| Placed {
        object,
        part: None,
        transform: IDENTITY,
    });
    // A file without a list of what to build shows what it has.
    let items = if model.items.is_empty() {
        all.collect()
    } else {
        model.items.clone()
    };
    let mut assembly = Assembly {
        archive,
        vertices_mm: Vec::new(),
        triangles: Vec::new(),
        placed: 0,
    };
    let mm = model.unit_mm;
    let to_mm = [mm, 0.0, 0.0, 0.0, mm, 0.0, 0.0, 0.0, mm, 0.0, 0.0, 0.0];
    for item in &items {
        assembly.place(item, &root, &to_mm, 0)?;
    }
    let mesh = TriangleMesh::new(assembly.vertices_mm, assembly.triangles)
        .map_err(|e| malformed(path, "3MF", e.to_string()))?;
    Ok(mesh.merged(task)?)
}

/// The zip archive and the models read from it so far.
struct Archive<'a> {
    path: &'a Path,
    task: &'a Task,
    zip: ZipArchive<BufReader<File>>,
    /// Bytes that may still be unpacked.
    room: u64,
    models: BTreeMap<String, Rc<Model>>,
    /// Triangles in all of them.
    triangles: usize,
}

impl<'a> Archive<'a> {
    fn open(path: &'a Path, task: &'a Task) -> Result<Self, MeshError> {
        let unreadable = |e: io::Error| MeshError::reading(path, &e);
        let file = File::open(path).map_err(unreadable)?;
        let metadata = file.metadata().map_err(unreadable)?;
        if metadata.is_dir() {
            return Err(MeshError::IsFolder {
                path: path.to_path_buf(),
            });
        }
        let zip = ZipArchive::new(BufReader::new(file))
            .map_err(|e| malformed(path, "3MF", format!("it is no zip archive ({e})")))?;
        Ok(Self {
            path,
            task,
            zip,
            room: metadata.len().saturating_mul(MOST_UNPACKED) + FREE_UNPACKED,
            models: BTreeMap::new(),
            triangles: 0,
        })
    }

    fn fault(&self, reason: impl Into<String>) -> MeshError {
        malformed(self.path, "3MF", reason)
    }

    /// The name of the part with the model.
    fn root(&mut self) -> Result<String, MeshError> {
        const CUSTOM: &str = "3D/3dmodel.model";
        let relationships = "_rels/.rels";
        if self.zip.index_for_name(relationships).is_none() {
            return Ok(CUSTOM.into());
        }
        let target = self.with_part(relationships, |text| {
            let mut tags = Tags::new(text);
            let mut target = None;
            while let Some(tag) = tags.next()? {
                let is_model = |kind: &str| kind.ends_with("/3dmodel");
                if tag.attribute("Type").is_some_and(is_model) && target.is_none() {
                    target = tag.attribute("Target").map(str::to_owned);
                }
            }
            Ok(target)
        })?;
        Ok(target.unwrap_or_else(|| CUSTOM.into()))
    }

    /// The model part `name`, read when first asked for.
    fn model(&mut self, name: &str) -> Result<Rc<Model>, MeshError> {
        if let Some(model) = self.models.get(name) {
            return Ok(model.clone());
        }
        let model = Rc::new(self.with_part(name, |text| threemf_model::read(text))?);
        let counts = model.objects.values().map(|object| object.triangles.len());
        self.triangles += counts.sum::<usize>();
        self.models.insert(name.into(), model.clone());
        Ok(model)
    }

    /// Lets `read` have the text of a part.
    fn with_part<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut dyn io::BufRead) -> Result<T, Fault>,
    ) -> Result<T, MeshError> {
        let plain = name.trim_start_matches('/');
        // Names are compared as the packaging standard wants it.
        let found = {
            let mut names = self.zip.file_names().filter_map(Result::ok);
            let found = names.find(|other| other.eq_ignore_ascii_case(plain));
            found.map(Cow::into_owned)
        };
        let Some(found) = found else {
            return Err(self.fault(format!("it has no part {}", shown(name))));
        };
        let broken = |e: &dyn std::fmt::Display| {
            let reason = format!("its part {} cannot be unpacked ({e})", shown(name));
            malformed(self.path, "3MF", reason)
        };
        let part = self.zip.by_name(&found).map_err(|e| broken(&e))?;
        self.task.begin("read mesh", part.size() as usize);
        let meter = Meter {
            part,
            room: &mut self.room,
            task: self.task,
        };
        read(&mut BufReader::with_capacity(1 << 16, meter)).map_err(|fault| {
            if let Err(cancelled) = self.task.check() {
                return cancelled.into();
            }
            match fault {
                Fault::Xml(XmlFault::Io(e)) => broken(&e),
                Fault::Xml(XmlFault::Text(reason)) => malformed(self.path, "3MF", reason),
                Fault::Content(reason) => malformed(self.path, "3MF", reason),
            }
        })
    }
}

/// A part that is unpacked, watched for its size and for the cancel switch.
struct Meter<'a, R> {
    part: R,
    room: &'a mut u64,
    task: &'a Task,
}

impl<R: Read> Read for Meter<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.part.read(buffer)?;
        self.task.advance(length).map_err(io::Error::other)?;
        *self.room = self.room.checked_sub(length as u64).ok_or_else(|| {
            io::Error::other(format!(
                "it grows to more than {MOST_UNPACKED} times the file's size"
            ))
        })?;
        Ok(length)
    }
}

/// Everything placed so far.
struct Assembly<'a> {
    archive: Archive<'a>,
    vertices_mm: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    placed: usize,
}

impl Assembly<'_> {
    /// Adds an object that a model in `part` places, `outer` being where that part's coordinates go.
    fn place(
        &mut self,
        placed: &Placed,
        part: &str,
        outer: &Transform,
        depth: usize,
    ) -> Result<(), MeshError> {
        self.archive.task.check()?;
        self.placed += 1;
        if depth > DEEPEST || self.placed > MOST_PLACED {
            return Err(self
                .archive
                .fault("its objects are placed in one another without end"));
        }
        let part = placed.part.as_deref().unwrap_or(part).to_owned();
        let model = self.archive.model(&part)?;
        let Some(object) = model.objects.get(&placed.object) else {
            let reason = format!("it has no object {} in {}", placed.object, shown(&part));
            return Err(self.archive.fault(reason));
        };
        let transform = composed(&placed.transform, outer);
        let triangles = self.triangles.len() + object.triangles.len();
        let most = self.archive.triangles + MOST_COPIED;
        let first = self.vertices_mm.len();
        if triangles > most || u32::try_from(first + object.vertices.len()).is_err() {
            let reason = format!("copies of its objects add more than {MOST_COPIED} triangles");
            return Err(self.archive.fault(reason));
        }
        let vertices = object.vertices.iter().map(|v| applied(&transform, *v));
        self.vertices_mm.extend(vertices);
        let is_mirrored = determinant(&transform) < 0.0;
        self.triangles.extend(object.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| v + first as u32);
            if is_mirrored { [a, c, b] } else { [a, b, c] }
        }));
        for component in &object.components {
            self.place(component, &part, &transform, depth + 1)?;
        }
        Ok(())
    }
}

/// First `inner`, then `outer`.
fn composed(inner: &Transform, outer: &Transform) -> Transform {
    let mut both = [0.0; 12];
    for row in 0..4 {
        for column in 0..3 {
            let along = |k: usize| inner[3 * row + k] * outer[3 * k + column];
            let shift = if row == 3 { outer[9 + column] } else { 0.0 };
            both[3 * row + column] = along(0) + along(1) + along(2) + shift;
        }
    }
    both
}

fn applied(m: &Transform, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| x * m[c] + y * m[3 + c] + z * m[6 + c] + m[9 + c])
}

fn determinant(m: &Transform) -> f64 {
    m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6])
        + m[2] * (m[3] * m[7] - m[4] * m[6])
}

/// A name of the file, short enough and on one line.
fn shown(name: &str) -> String {
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    name.chars().take(80).map(shown).collect()
}
