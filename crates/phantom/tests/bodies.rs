//! Distances, volumes and sides of the bodies.

use bonemesh_phantom::{BONE_HU, Body, Phantom, SOFT_HU, scan};
use bonemesh_task::Task;
use bonemesh_volume::Voxels;
use proptest::prelude::*;

const EXACT: [Phantom; 3] = [Phantom::SphereShell, Phantom::Tube, Phantom::BoxWithHole];
const BODIES: [Phantom; 5] = [
    Phantom::SphereShell,
    Phantom::Tube,
    Phantom::BoxWithHole,
    Phantom::Femur,
    Phantom::Head,
];

fn steepness(body: &dyn Body, p: [f64; 3]) -> f64 {
    let h = 1e-5;
    (0..3)
        .map(|i| {
            let (mut a, mut b) = (p, p);
            a[i] += h;
            b[i] -= h;
            (body.signed_distance_mm(a) - body.signed_distance_mm(b)) / (2.0 * h)
        })
        .map(|g| g * g)
        .sum::<f64>()
        .sqrt()
}

fn between(p: [f64; 3], q: [f64; 3]) -> f64 {
    (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
}

proptest! {
    #[test]
    fn exact_distances_grow_as_fast_as_one_walks_near_the_surface(
        p in proptest::array::uniform3(-40.0..40.0f64),
    ) {
        for phantom in EXACT {
            let body = phantom.body().unwrap();
            let d = body.signed_distance_mm(p).abs();
            // Closer than any part of the medial surface, but for creases at inner edges.
            if d < 2.5 {
                let s = steepness(&*body, p);
                prop_assert!(s < 1.0 + 1e-6, "{phantom} {s}");
                prop_assert!(phantom != Phantom::SphereShell || s > 1.0 - 1e-6, "{phantom} {s}");
            }
        }
    }

    #[test]
    fn no_distance_exceeds_the_way_to_the_surface(
        p in proptest::array::uniform3(-90.0..90.0f64),
        q in proptest::array::uniform3(-90.0..90.0f64),
    ) {
        for phantom in BODIES {
            let body = phantom.body().unwrap();
            let change = (body.signed_distance_mm(p) - body.signed_distance_mm(q)).abs();
            prop_assert!(change <= between(p, q) + 1e-6, "{phantom}");
        }
    }
}

#[test]
fn bone_lies_where_the_distance_is_negative() {
    for phantom in BODIES {
        let body = phantom.body().unwrap();
        let mut inside = 0;
        for i in 0..20_000_u32 {
            let at = |n: u32, half: f64| f64::from(i * n % 997) / 997.0 * 2.0 * half - half;
            let p = [at(1, 70.0), at(31, 100.0), at(173, 110.0)];
            let bone = body.hu(p) >= BONE_HU;
            assert_eq!(bone, body.signed_distance_mm(p) < 0.0, "{phantom} {p:?}");
            inside += u32::from(bone);
        }
        assert!(inside > 20, "{phantom}: {inside} points in bone");
    }
}

#[test]
fn voxels_add_up_to_the_volume_that_the_formula_gives() {
    for phantom in EXACT {
        let settings = phantom.settings().ideal();
        let volume = scan(phantom, &settings, &Task::default()).unwrap();
        let Voxels::I16(hu) = volume.voxels() else {
            panic!("phantoms are whole Hounsfield units")
        };
        let voxel = volume.geometry().patient_from_voxel().determinant();
        let bone: f64 = hu
            .iter()
            .map(|v| (f64::from(*v) - SOFT_HU) / (BONE_HU - SOFT_HU))
            .sum();
        let truth = bonemesh_phantom::truth(phantom, &settings).unwrap();
        let expected = truth["volume_mm3"].as_f64().unwrap();
        let ratio = bone * voxel / expected;
        assert!((ratio - 1.0).abs() < 0.002, "{phantom}: {ratio}");
    }
}

#[test]
fn cubes_have_the_published_volumes() {
    for (phantom, cm3) in [
        (Phantom::Cube, 43.45),
        (Phantom::TwoCubes, 86.90),
        (Phantom::CubeWithHole, 32.59),
    ] {
        let truth = bonemesh_phantom::truth(phantom, &phantom.settings()).unwrap();
        let volume = truth["volume_mm3"].as_f64().unwrap() / 1000.0;
        assert!((volume - cm3).abs() < 0.005, "{phantom}: {volume}");
    }
}

#[test]
fn the_head_tells_left_from_right() {
    let head = Phantom::Head.body().unwrap();
    let truth = bonemesh_phantom::truth(Phantom::Head, &Phantom::Head.settings()).unwrap();
    let place = |name: &str| -> [f64; 3] {
        serde_json::from_value(truth["landmarks_mm"][name].clone()).unwrap()
    };
    let mirrored = |p: [f64; 3]| [-p[0], p[1], p[2]];

    let burr = place("burr_hole_on_the_patients_left");
    assert!(burr[0] > 0.0, "+x is the patient's left");
    // A line through the hole meets no bone; the same line on the right crosses the wall.
    let through = |side: f64| {
        (-160..160).any(|i| {
            let s = f64::from(i) / 10.0;
            let p = [burr[0] + 0.56 * s, burr[1] - 0.44 * s, burr[2] + 0.70 * s];
            head.signed_distance_mm([side * p[0], p[1], p[2]]) < 0.0
        })
    };
    assert!(!through(1.0));
    assert!(through(-1.0));

    let gap = place("missing_tooth_on_the_patients_right");
    assert!(gap[0] < 0.0);
    assert!(head.signed_distance_mm(gap) > 0.5);
    assert!(head.hu(mirrored(gap)) > BONE_HU, "the left tooth is there");
}

#[test]
fn the_jaw_is_a_body_of_its_own() {
    let settings = Phantom::Head.settings().ideal().coarser(1.5);
    let volume = scan(Phantom::Head, &settings, &Task::default()).unwrap();
    let Voxels::I16(hu) = volume.voxels() else {
        panic!("phantoms are whole Hounsfield units")
    };
    let mut sizes = component_sizes(&hu.mapv(|v| v > 350));
    sizes.sort_unstable();
    assert_eq!(sizes.len(), 2, "{sizes:?}");
}

/// Voxels of each 26-connected component.
fn component_sizes(mask: &ndarray::Array3<bool>) -> Vec<usize> {
    let mut left = mask.clone();
    let mut sizes = Vec::new();
    for (start, bone) in mask.indexed_iter() {
        if !bone || !left[start] {
            continue;
        }
        left[start] = false;
        let (mut open, mut size) = (vec![start], 0);
        while let Some((k, j, i)) = open.pop() {
            size += 1;
            for n in 0..27 {
                let at = (
                    (k + n / 9).wrapping_sub(1),
                    (j + n / 3 % 3).wrapping_sub(1),
                    (i + n % 3).wrapping_sub(1),
                );
                if left.get(at).copied().unwrap_or(false) {
                    left[at] = false;
                    open.push(at);
                }
            }
        }
        sizes.push(size);
    }
    sizes
}
