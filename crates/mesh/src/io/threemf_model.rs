//! One model part of a 3MF archive: its objects and what it says of their places.

use std::collections::BTreeMap;
use std::io::BufRead;

use super::obj_read::coordinate;
use super::xml::{Tag, TagKind, Tags, XmlFault};

/// Rows and columns of `x' = x m[0..3] + y m[3..6] + z m[6..9] + m[9..12]`.
pub(super) type Transform = [f64; 12];

pub(super) const IDENTITY: Transform = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];

/// A model part.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// Length of its unit.
    pub(super) unit_mm: f64,
    pub(super) objects: BTreeMap<u32, Object>,
    /// What is to be built.
    pub(super) items: Vec<Placed>,
}

/// A mesh, or other objects put together.
#[derive(Debug, Default)]
pub(super) struct Object {
    /// In the part's unit.
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) components: Vec<Placed>,
}

/// An object at a place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    pub(super) object: u32,
    /// The part of the archive that the object is in, if it is another.
    pub(super) part: Option<String>,
    pub(super) transform: Transform,
}

/// Why a part cannot be used.
#[derive(Debug)]
pub(super) enum Fault {
    Xml(XmlFault),
    Content(String),
}

impl From<XmlFault> for Fault {
    fn from(fault: XmlFault) -> Self {
        Self::Xml(fault)
    }
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Content(reason)
    }
}

/// Reads a model part; elements of extensions, which have a prefix, are passed over.
pub(super) fn read(text: impl BufRead) -> Result<Model, Fault> {
    let mut tags = Tags::new(text);
    let mut reader = Reader::default();
    while let Some(tag) = tags.next()? {
        if reader.core.is_none() {
            reader.begin(&tag)?;
        } else if reader.core.as_deref() == Some(tag.prefix) {
            reader.add(&tag)?;
        }
    }
    if reader.core.is_none() {
        return Err("its model part is empty".to_owned().into());
    }
    if !reader.is_ended {
        return Err("its model part ends before </model>".to_owned().into());
    }
    Ok(reader.model)
}

/// What has been read of a part.
#[derive(Default)]
struct Reader {
    /// The prefix of the first element, which all of the core format then have: mostly none.
    core: Option<String>,
    model: Model,
    current: Option<(u32, Object)>,
    is_ended: bool,
}

impl Reader {
    /// Takes the outermost element.
    fn begin(&mut self, tag: &Tag<'_>) -> Result<(), String> {
        if tag.name != "model" || tag.kind != TagKind::Open {
            return Err(format!("its model part begins with <{}>", shown(tag.name)));
        }
        self.model.unit_mm = match tag.attribute("unit") {
            None | Some("millimeter") => 1.0,
            Some("micron") => 0.001,
            Some("centimeter") => 10.0,
            Some("meter") => 1000.0,
            Some("inch") => 25.4,
            Some("foot") => 304.8,
            Some(other) => return Err(format!("its unit \"{}\" is not known", shown(other))),
        };
        self.core = Some(tag.prefix.to_owned());
        Ok(())
    }

    fn add(&mut self, tag: &Tag<'_>) -> Result<(), String> {
        match (tag.name, tag.kind) {
            ("model", TagKind::Close) => self.is_ended = true,
            ("object", TagKind::Close) => {
                if let Some((id, object)) = self.current.take() {
                    self.finish(id, object)?;
                }
            }
            (_, TagKind::Close) => {}
            ("object", _) => {
                let id = number(tag, "id")?;
                self.current = Some((id, Object::default()));
                if tag.kind == TagKind::Empty {
                    self.current = None;
                }
            }
            ("item", _) => self.model.items.push(placed(tag)?),
            ("vertex" | "triangle" | "component", _) => {
                let Some((_, object)) = &mut self.current else {
                    return Err(format!("it has a {} outside of an object", tag.name));
                };
                match tag.name {
                    "vertex" => object.vertices.push(vertex(tag, object.vertices.len())?),
                    "triangle" => object
                        .triangles
                        .push(triangle(tag, object.triangles.len())?),
                    _ => object.components.push(placed(tag)?),
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Puts a whole object among the others.
    fn finish(&mut self, id: u32, object: Object) -> Result<(), String> {
        let vertices = object.vertices.len();
        let is_missing = |v: &&u32| **v as usize >= vertices;
        if let Some(vertex) = object.triangles.as_flattened().iter().find(is_missing) {
            return Err(format!(
                "object {id} names vertex {vertex} but has {vertices}"
            ));
        }
        match self.model.objects.insert(id, object) {
            None => Ok(()),
            Some(_) => Err(format!("it has two objects {id}")),
        }
    }
}

fn vertex(tag: &Tag<'_>, number: usize) -> Result<[f64; 3], String> {
    let mut vertex = [None; 3];
    for (name, value) in tag.attributes() {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => continue,
        };
        vertex[axis] = coordinate(value.trim_ascii());
    }
    let [Some(x), Some(y), Some(z)] = vertex else {
        return Err(format!("vertex {number} lacks a coordinate"));
    };
    Ok([x, y, z])
}

fn triangle(tag: &Tag<'_>, number: usize) -> Result<[u32; 3], String> {
    let mut triangle = [None; 3];
    for (name, value) in tag.attributes() {
        let corner = match name {
            "v1" => 0,
            "v2" => 1,
            "v3" => 2,
            _ => continue,
        };
        triangle[corner] = value.trim_ascii().parse().ok();
    }
    let [Some(a), Some(b), Some(c)] = triangle else {
        return Err(format!("triangle {number} lacks a vertex number"));
    };
    Ok([a, b, c])
}

/// The object and place that an item or component names.
fn placed(tag: &Tag<'_>) -> Result<Placed, String> {
    let transform = match tag.attribute("transform") {
        None => IDENTITY,
        Some(text) => {
            let numbers = text.split_ascii_whitespace().map(str::parse);
            let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().unwrap_or_default();
            numbers
                .try_into()
                .map_err(|_| format!("the transform \"{}\" is not 12 numbers", shown(text)))?
        }
    };
    Ok(Placed {
        object: number(tag, "objectid")?,
        part: tag.attribute("path").map(str::to_owned),
        transform,
    })
}

fn number(tag: &Tag<'_>, name: &str) -> Result<u32, String> {
    let text = tag
        .attribute(name)
        .ok_or_else(|| format!("an {} lacks its {name}", tag.name))?;
    text.trim_ascii()
        .parse()
        .map_err(|_| format!("the {name} \"{}\" is no number", shown(text)))
}

/// A text of the file, short enough and on one line.
fn shown(text: &str) -> String {
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    text.chars().take(40).map(shown).collect()
}
