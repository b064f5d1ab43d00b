//! The main line: folder to mesh, one step after the other, each timed.

use std::borrow::Cow;
use std::path::Path;
use std::time::Instant;

use bonemesh_cloud::{Frame, PointCloud, Sampling, extract_points, sample};
use bonemesh_mesh::TriangleMesh;
use bonemesh_segment::{Mask, SegmentError, detect_edges, threshold};
use bonemesh_surface::{IsosurfaceSettings, SurfaceError, isosurface, labelled_surface};
use bonemesh_task::{Task, pool};
use bonemesh_volume::{Volume, Voxels};

use crate::after_care::cared_for;
use crate::choices::{no_cloud, refuse_unused};
use crate::left_out::leave_out;
use crate::metal::{note, without_streaks};
use crate::of_cloud::cloud_to_mesh;
use crate::options::OptionsReport;
use crate::report::{RenderReport, Seconds, check};
use crate::source::{Reading, Source};
use crate::thresholds::{chosen, leveled};
use crate::{Error, Method, Settings};

/// Fewer points enclose no space.
const MIN_POINTS: usize = 4;

/// A mesh in patient millimetres (LPS) and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The surface of the bone, outward-oriented.
    pub mesh: TriangleMesh,
    /// Counts, topology, times, warnings.
    pub report: RenderReport,
}

/// Reads the series in the folder or file `path` and makes the surface of its bone.
///
/// # Errors
/// Any [`Error`]; nothing is written.
pub fn render(path: &Path, settings: &Settings, task: &Task) -> Result<Rendered, Error> {
    refuse_unused(settings)?;
    pool(settings.threads)?.install(|| {
        let clock = Instant::now();
        let source = Source::open(path, settings.one_series, task)?;
        let Reading { volume, series } = source.read(settings.series.as_ref(), task)?;
        let read_s = clock.elapsed().as_secs_f64();
        let mut rendered = volume_to_mesh(&volume, settings, task)?;
        let report = &mut rendered.report;
        report.series_uid = Some(series.uid);
        report.warnings.splice(..0, series.warnings);
        report.seconds.read = read_s;
        report.seconds.total += read_s;
        Ok(rendered)
    })
}

/// Makes the surface of the bone in `volume`.
///
/// # Errors
/// Any [`Error`] but those of reading.
pub fn render_volume(volume: &Volume, settings: &Settings, task: &Task) -> Result<Rendered, Error> {
    refuse_unused(settings)?;
    pool(settings.threads)?.install(|| volume_to_mesh(volume, settings, task))
}

/// The (sampled) point cloud of the bone's edges in `volume`.
///
/// In the patient frame edges are found, and points ordered, in the volume's patient order
/// ([`Volume::in_patient_order`]); in the image frame as the voxels are stored.
///
/// # Errors
/// Any [`Error`] but those of reading and meshing.
pub fn point_cloud(
    volume: &Volume,
    settings: &Settings,
    frame: Frame,
    task: &Task,
) -> Result<PointCloud, Error> {
    pool(settings.threads)?.install(|| {
        let damped = if settings.damp_metal {
            without_streaks(volume, settings, task)?.0
        } else {
            Cow::Borrowed(volume)
        };
        let volume = &*damped;
        let settings = &chosen(volume, settings, task)?.of(settings);
        let found = volume_to_cloud(volume, settings, frame, &mut Seconds::default(), task)?;
        Ok(found.0)
    })
}

/// Makes the surface of a point cloud.
///
/// # Errors
/// [`Error::Cloud`], [`Error::Surface`], [`Error::NotForMethod`] where voxels are needed.
pub fn mesh_cloud(cloud: &PointCloud, settings: &Settings, task: &Task) -> Result<Rendered, Error> {
    if settings.method.needs_voxels() {
        return Err(no_cloud(settings.method));
    }
    refuse_unused(settings)?;
    pool(settings.threads)?.install(|| {
        let rendered = cloud_to_mesh(cloud, None, settings, Seconds::default(), task)?;
        cared_for(rendered, &settings.after_care, task)
    })
}

fn volume_to_mesh(volume: &Volume, settings: &Settings, task: &Task) -> Result<Rendered, Error> {
    let mut seconds = Seconds::default();
    let mut clock = Instant::now();
    let (volume, metal) = without_streaks(volume, settings, task)?;
    let volume = &*volume;
    let chosen = chosen(volume, settings, task)?;
    let options = OptionsReport::of(settings);
    let settings = &chosen.of(settings);
    let threshold_s = lap(&mut clock);
    let mut rendered = if settings.method.needs_voxels() {
        seconds.edges += threshold_s;
        volume_to_closed_surface(volume, settings, seconds, task)?
    } else {
        let (cloud, bone_mm3) =
            volume_to_cloud(volume, settings, Frame::Patient, &mut seconds, task)?;
        seconds.edges += threshold_s;
        cloud_to_mesh(&cloud, Some(bone_mm3), settings, seconds, task)?
    };
    rendered = cared_for(rendered, &settings.after_care, task)?;
    rendered.report.options = options;
    rendered.report.spacing_mm = Some(volume.geometry().spacing_mm());
    rendered.report.threshold_hu = Some(settings.threshold.hu());
    rendered.report.threshold_reason = chosen.reason;
    rendered.report.warnings.extend(note(metal, settings));
    rendered.report.metal = metal;
    Ok(rendered)
}

fn volume_to_closed_surface(
    volume: &Volume,
    settings: &Settings,
    mut seconds: Seconds,
    task: &Task,
) -> Result<Rendered, Error> {
    let mut clock = Instant::now();
    let whole = volume;
    let cropped = settings
        .crop
        .as_ref()
        .map(|crop| volume.cropped(crop))
        .transpose()?;
    let volume = cropped.as_ref().unwrap_or(volume);
    // Cubes are filled in one way of several, and slices are not columns: how the voxels were
    // stored must not show.
    let volume = volume.in_patient_order(task)?;
    let leveled = leveled(&volume, settings, task)?;
    let placing = IsosurfaceSettings {
        threshold_hu: settings.threshold.hu(),
        leveled: leveled.as_ref(),
        true_edges: settings.true_edges,
    };
    refuse_all_bone(leveled.as_ref().unwrap_or(&volume), placing.threshold_hu)?;
    let in_words = |error| in_words(error, &volume);
    let (mesh, labelled) = if settings.method == Method::Labelled {
        let surface = labelled_surface(&volume, placing, task).map_err(in_words)?;
        let of_labels = (surface.tetrahedra, surface.filled_mm3);
        (surface.mesh, Some(of_labels))
    } else {
        let mesh = isosurface(&volume, placing, task).map_err(in_words)?;
        (mesh, None)
    };
    drop(leveled);
    let (mesh, left_out) = if settings.crop.is_some() {
        let whole = whole.in_patient_order(task)?;
        leave_out(&mesh, &volume, &whole, settings, task)?
    } else {
        leave_out(&mesh, &volume, &volume, settings, task)?
    };
    let topology = check(&mesh, task)?;
    seconds.surface = lap(&mut clock);
    seconds.total = seconds.edges + seconds.surface;
    let mut report = RenderReport::new(settings, &topology, seconds);
    report.left_out_table = left_out.table;
    report.left_out_specks = left_out.specks;
    report.tetrahedra = labelled.map(|(tetrahedra, _)| tetrahedra);
    report.filled_mm3 = labelled.map(|(_, filled_mm3)| filled_mm3);
    Ok(Rendered { mesh, report })
}

/// A threshold that leaves nothing is refused with the range of the scan.
fn in_words(error: SurfaceError, volume: &Volume) -> Error {
    let SurfaceError::NothingAbove { threshold_hu } = error else {
        return error.into();
    };
    let (lowest_hu, highest_hu) = volume.hu_range();
    Error::Segment(SegmentError::NothingAbove {
        threshold_hu,
        lowest_hu,
        highest_hu,
    })
}

/// Refuses a threshold below all voxels: the surface would be the box around them.
fn refuse_all_bone(volume: &Volume, threshold_hu: f64) -> Result<(), Error> {
    // The first voxel of most scans is air. What is no number is no bone.
    let is_left = match volume.voxels() {
        Voxels::I16(hu) => hu.iter().any(|&hu| f64::from(hu) <= threshold_hu),
        Voxels::F32(hu) => hu
            .iter()
            .any(|&hu| hu.is_nan() || f64::from(hu) <= threshold_hu),
    };
    if is_left {
        return Ok(());
    }
    let (lowest_hu, highest_hu) = volume.hu_range();
    Err(Error::Segment(SegmentError::NothingBelow {
        threshold_hu,
        lowest_hu,
        highest_hu,
    }))
}

/// The cloud, and the volume (mm3) of all voxels of the bone.
fn volume_to_cloud(
    volume: &Volume,
    settings: &Settings,
    frame: Frame,
    seconds: &mut Seconds,
    task: &Task,
) -> Result<(PointCloud, f64), Error> {
    let mut clock = Instant::now();
    let cropped = settings
        .crop
        .as_ref()
        .map(|crop| volume.cropped(crop))
        .transpose()?;
    let volume = cropped.as_ref().unwrap_or(volume);
    // Edges are found slice by slice: how the voxels were stored must not show in the patient.
    let volume = match frame {
        Frame::Patient => volume.in_patient_order(task)?,
        Frame::Image => Cow::Borrowed(volume),
    };
    let leveled = leveled(&volume, settings, task)?;
    let compared = leveled.as_ref().unwrap_or(&volume);
    let mask = threshold(compared, settings.threshold, task)?;
    drop(leveled);
    drop(volume);
    drop(cropped);
    let bone_mm3 = bone_mm3(&mask);
    let edges = detect_edges(&mask, settings.canny, task)?;
    drop(mask);
    seconds.edges = lap(&mut clock);
    let cloud = extract_points(&edges, frame, task)?;
    drop(edges);
    if cloud.len() < MIN_POINTS {
        return Err(Error::FewEdges {
            points: cloud.len(),
            sigma: settings.canny.sigma(),
        });
    }
    let cloud = match &settings.sampling {
        Some(sampling) => sampled(&cloud, sampling, task)?,
        None => cloud,
    };
    seconds.cloud = lap(&mut clock);
    Ok((cloud, bone_mm3))
}

/// The volume of all voxels of the bone.
fn bone_mm3(mask: &Mask) -> f64 {
    let voxels = mask.voxels.iter().filter(|is_bone| **is_bone).count();
    let voxel_mm3 = mask.geometry.patient_from_voxel().determinant().abs();
    voxels as f64 * voxel_mm3
}

fn sampled(cloud: &PointCloud, sampling: &Sampling, task: &Task) -> Result<PointCloud, Error> {
    let kept = sample(cloud, sampling, task)?;
    if kept.len() < MIN_POINTS {
        return Err(Error::FewSamples {
            points: kept.len(),
            of: cloud.len(),
            sampler: sampling.sampler().name(),
        });
    }
    Ok(cloud.subset(&kept))
}

/// Seconds since `clock`, which starts anew.
pub(crate) fn lap(clock: &mut Instant) -> f64 {
    let seconds = clock.elapsed().as_secs_f64();
    *clock = Instant::now();
    seconds
}
