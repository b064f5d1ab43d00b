//! The scanner's table and headrest, which lie above many thresholds, too.
//!
//! They are islands of their own, bare (most of their surface has air or foam beside it, and some of
//! it that of the outside, while soft tissue covers a patient's bones), and what is long is
//! extruded: it has the same outline slice after slice. Of a patient, whose bones are covered, every
//! bare island goes; of dry bone only what is extruded all along the stack. What hangs together with
//! bone stays, and so does what has many times the volume of all else: that is the bone.

use bonemesh_mesh::Island;
use bonemesh_segment::{Mask, outside_air};
use bonemesh_task::Task;
use bonemesh_volume::{Affine, Volume, Voxels};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

use crate::Error;

/// Where air is looked for, beyond the surface: outside the scan's blur, nearer than most skin.
const BESIDE_MM: f64 = 2.5;
/// Bare is what has air beside more than this part of its surface, and that of the outside beside so
/// much.
const BARE: f64 = 0.5;
const EXPOSED: f64 = 0.15;
/// Covered is bone with air of the outside beside less than this part of its surface.
const COVERED: f64 = 0.3;
/// Air and foam are below this.
const AIR_HU: f64 = -400.0;
/// Triangles looked at, for air and for outlines.
const AIR_SAMPLES: usize = 4_000;
const OUTLINE_SAMPLES: usize = 100_000;
/// Outlines are compared in cells of this size, in slabs of that thickness so many slabs apart.
const CELL_MM: f64 = 3.0;
const SLAB_MM: f64 = 5.0;
const SLABS_APART: i32 = 4;
/// The bone has at least this part of a table's volume: a crumb beside a dry long bone, which is as
/// extruded as a table, is not the patient.
const BONE_BESIDE_TABLE: f64 = 0.1;
/// Part of an outline that an extruded body repeats, and of the stack that it runs along.
const SAME: f64 = 0.8;
const ALONG: f64 = 0.9;

/// What islands are, one after another.
pub(crate) struct Verdict {
    /// The scanner's table and headrest.
    pub(crate) are_table: Vec<bool>,
    /// Air of the outside is beside them.
    pub(crate) are_bare: Vec<bool>,
}

/// Which islands are the scanner's table and headrest.
///
/// `volume`: the whole scan, in patient order, since a crop box is no border of the patient;
/// `stack_mm`: how high the part of it is that the islands come from.
pub(crate) fn judge(
    islands: &[Island<'_>],
    volume: &Volume,
    stack_mm: f64,
    task: &Task,
) -> Result<Verdict, Error> {
    let voxel_from_patient = volume.geometry().patient_from_voxel().inverse();
    let (Some(voxel_from_patient), true) = (voxel_from_patient, islands.len() > 1) else {
        return Ok(Verdict {
            are_table: vec![false; islands.len()],
            are_bare: vec![false; islands.len()],
        });
    };
    let outside = outside_air(volume, task)?;
    let scan = Scan {
        volume,
        outside: &outside,
        voxel_from_patient,
        spacing_mm: volume.geometry().spacing_mm(),
        stack_mm,
    };
    let looks: Vec<Look> = islands.par_iter().map(|i| scan.look(i)).collect();
    Ok(Verdict {
        are_table: are_foreign(&looks),
        are_bare: looks.iter().map(Look::is_bare).collect(),
    })
}

/// What an island looks like.
#[derive(Clone, Copy)]
struct Look {
    volume_mm3: f64,
    /// Part of its surface with air beside it, and with air of the outside.
    air: f64,
    outside: f64,
    is_extruded: bool,
}

impl Look {
    fn is_bare(&self) -> bool {
        self.air > BARE && self.outside > EXPOSED
    }
}

fn are_foreign(looks: &[Look]) -> Vec<bool> {
    let is_table = |look: &Look| look.is_bare() && look.is_extruded;
    let bones = looks.iter().enumerate().filter(|(_, look)| !is_table(look));
    let main = bones.max_by(|(_, a), (_, b)| a.volume_mm3.total_cmp(&b.volume_mm3));
    let Some((main, bone)) = main else {
        return vec![false; looks.len()];
    };
    let is_patient = bone.outside < COVERED;
    let is_foreign = |(number, look): (usize, &Look)| {
        let is_beside_bone = bone.volume_mm3 >= BONE_BESIDE_TABLE * look.volume_mm3;
        number != main && is_beside_bone && look.is_bare() && (is_patient || look.is_extruded)
    };
    looks.iter().enumerate().map(is_foreign).collect()
}

/// The scan around the islands.
struct Scan<'a> {
    volume: &'a Volume,
    outside: &'a Mask,
    voxel_from_patient: Affine,
    spacing_mm: [f64; 3],
    stack_mm: f64,
}

impl Scan<'_> {
    fn look(&self, island: &Island<'_>) -> Look {
        let [air, outside] = self.air_beside(island);
        let look = Look {
            volume_mm3: island.volume_mm3.abs(),
            air,
            outside,
            is_extruded: false,
        };
        Look {
            is_extruded: look.is_bare() && self.is_extruded(island),
            ..look
        }
    }

    /// The parts of an island's surface beside which there is air, and air of the outside; 0 if the
    /// volume ends all around it.
    fn air_beside(&self, island: &Island<'_>) -> [f64; 2] {
        let (mut seen, mut air, mut outside) = (0, 0, 0);
        for corners in island.triangles_mm(island.len().div_ceil(AIR_SAMPLES)) {
            if let Some(at) = self.voxel(beside(corners)) {
                seen += 1;
                air += u32::from(self.hu(at) < AIR_HU);
                outside += u32::from(self.outside.voxels[at]);
            }
        }
        [air, outside].map(|count| f64::from(count) / f64::from(seen.max(1)))
    }

    /// Slice, row and column of a place; `None` beyond the volume.
    fn voxel(&self, place_mm: [f64; 3]) -> Option<[usize; 3]> {
        let [i, j, k] = self.voxel_from_patient.apply(place_mm).map(f64::round);
        // NaN and what lies below the first voxel are none.
        let at = (i >= 0.0 && j >= 0.0 && k >= 0.0).then(|| [k, j, i].map(|v| v as usize))?;
        let shape = self.outside.geometry.shape();
        (0..3).all(|axis| at[axis] < shape[axis]).then_some(at)
    }

    fn hu(&self, at: [usize; 3]) -> f64 {
        match self.volume.voxels() {
            Voxels::I16(hu) => f64::from(hu[at]),
            Voxels::F32(hu) => f64::from(hu[at]),
        }
    }

    /// Whether an island has the same outline in slab after slab, all along the stack.
    fn is_extruded(&self, island: &Island<'_>) -> bool {
        let mut cells: FxHashSet<[i32; 3]> = FxHashSet::default();
        for [a, ..] in island.triangles_mm(island.len().div_ceil(OUTLINE_SAMPLES)) {
            let voxel = self.voxel_from_patient.apply(a);
            let cell =
                |axis: usize, mm: f64| (voxel[axis] * self.spacing_mm[axis] / mm).floor() as i32;
            cells.insert([cell(0, CELL_MM), cell(1, CELL_MM), cell(2, SLAB_MM)]);
        }
        let slabs = || cells.iter().map(|cell| cell[2]);
        let (Some(first), Some(last)) = (slabs().min(), slabs().max()) else {
            return false;
        };
        let long_mm = f64::from(last - first + 1) * SLAB_MM;
        if last - first < SLABS_APART || long_mm < ALONG * self.stack_mm {
            return false;
        }
        let comes_again = |[x, y, slab]: [i32; 3]| {
            let around = |by: i32| (-1..=1).map(move |beside| by + beside);
            around(x).any(|x| around(y).any(|y| cells.contains(&[x, y, slab + SLABS_APART])))
        };
        let compared = || cells.iter().filter(|cell| cell[2] + SLABS_APART <= last);
        let same = compared().filter(|cell| comes_again(**cell)).count();
        same as f64 > SAME * compared().count() as f64
    }
}

/// Just outside of a triangle's middle.
fn beside([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (minus(b, a), minus(c, a));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0 + BESIDE_MM * normal[k] / length)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(volume_mm3: f64, outside: f64, is_extruded: bool) -> Look {
        Look {
            volume_mm3,
            air: outside,
            outside,
            is_extruded,
        }
    }

    #[test]
    fn of_a_patient_all_that_is_bare_goes() {
        let looks = [
            look(9e5, 0.6, true),
            look(6e5, 0.02, false),
            look(3e3, 0.1, false),
            look(4e3, 0.9, false),
        ];
        assert_eq!(are_foreign(&looks), [true, false, false, true]);
    }

    #[test]
    fn of_dry_bone_only_what_is_extruded_goes() {
        let looks = [
            look(4e5, 0.9, false),
            look(2e5, 0.8, true),
            look(5e4, 0.95, false),
        ];
        assert_eq!(are_foreign(&looks), [false, true, false]);
    }

    #[test]
    fn a_crumb_beside_a_long_bone_does_not_make_that_a_table() {
        for covered in [0.05, 0.9] {
            let looks = [look(2e4, 0.9, true), look(1e3, covered, false)];
            assert_eq!(are_foreign(&looks), [false, false]);
        }
    }

    #[test]
    fn where_all_is_extruded_all_stays() {
        assert_eq!(are_foreign(&[look(4e5, 0.9, true)]), [false]);
    }
}
