//! Volume of a solid.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::PhantomError;
use crate::shape::build::Solid;
use crate::vector::{Vec3, add};

/// Parts along each side of the cube around the solid, one piece of work each.
const PARTS: usize = 16;

/// Volume of `solid` from cubes of at most `cell_mm`, in which its surface counts as flat.
pub(super) fn of(solid: &Solid, cell_mm: f64, task: &Task) -> Result<f64, PhantomError> {
    let (centre, radius) = solid.around();
    let half = radius / PARTS as f64;
    task.begin("volume", PARTS.pow(3));
    let parts: Result<Vec<f64>, PhantomError> = (0..PARTS.pow(3))
        .into_par_iter()
        .map(|part| {
            let at = |i: usize| (2 * i + 1) as f64 * half - radius;
            let [i, j, k] = [part % PARTS, part / PARTS % PARTS, part / PARTS.pow(2)];
            let volume = in_cube(solid, add(centre, [at(i), at(j), at(k)]), half, cell_mm);
            task.advance(1)?;
            Ok(volume)
        })
        .collect();
    // One after the other, so that threads do not decide the last digit.
    Ok(parts?.into_iter().sum())
}

/// The part of a cube of half side `half` that is inside.
fn in_cube(solid: &Solid, middle: Vec3, half: f64, cell_mm: f64) -> f64 {
    let reach = 3f64.sqrt() * half;
    let (local, d) = solid.near(middle, reach);
    let whole = (2.0 * half).powi(3);
    if d > reach {
        return 0.0;
    }
    if d < -reach {
        return whole;
    }
    if 2.0 * half <= cell_mm {
        return whole * (0.5 - d / (2.0 * half)).clamp(0.0, 1.0);
    }
    (0..8)
        .map(|corner| {
            let side = |axis: usize| {
                if corner >> axis & 1 == 0 {
                    -half / 2.0
                } else {
                    half / 2.0
                }
            };
            let middle = add(middle, [side(0), side(1), side(2)]);
            in_cube(&local, middle, half / 2.0, cell_mm)
        })
        .sum()
}
