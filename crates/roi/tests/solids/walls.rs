//! Solids cut out of bodies whose walls are known.

use std::collections::HashSet;
use std::f64::consts::PI;

use bonemesh_mesh::TriangleMesh;

use crate::bodies::{STEP_MM, body, body_of_edges, length, selected, shell, solid, volume_mm3};

#[test]
fn a_cap_of_a_shell_has_the_volume_of_the_cone_for_any_thickness() {
    let shell = shell();
    let half_angle = 0.5_f64;
    // Across the lattice: along it, a whole ring of vertices would lie just inside or outside.
    let along = |[x, y, z]: [f64; 3]| (2.0 * x - y + 3.0 * z) / 14.0_f64.sqrt();
    let is_in = |p: [f64; 3]| length(p) > 17.0 && along(p) > length(p) * half_angle.cos();
    let patch = selected(&shell, is_in);
    for thickness in [1.5, 3.0, 6.0, 9.0] {
        let solid = solid(&shell, &patch, thickness);
        let inner = 20.0_f64 - thickness.min(6.0);
        let cone = 2.0 * PI * (1.0 - half_angle.cos()) / 3.0;
        let expected = cone * (20.0_f64.powi(3) - inner.powi(3));
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
        for place in solid.mesh.vertices_mm() {
            let radius = length(*place);
            assert!(
                (inner - 0.1..20.1).contains(&radius),
                "{thickness} mm: {radius}"
            );
            let angle = (along(*place) / radius).acos();
            let beyond_mm = (angle - half_angle) * radius;
            // At the front about half an edge, which is as near as selected vertices say it.
            let most_mm = if radius > 19.95 { 0.6 } else { 0.8 } * STEP_MM;
            assert!(
                beyond_mm < most_mm,
                "{thickness} mm: {beyond_mm} at {radius}"
            );
        }
    }
}

#[test]
fn outline_sides_and_back_lie_within_a_tenth_of_a_millimetre() {
    let shell = body_of_edges(0.12, [8.5; 3], |p| (8.0 - length(p)).min(length(p) - 5.0));
    let half_angle = 0.5_f64;
    let along = |[x, y, z]: [f64; 3]| (2.0 * x - y + 3.0 * z) / 14.0_f64.sqrt();
    let is_in = |p: [f64; 3]| length(p) > 6.5 && along(p) > length(p) * half_angle.cos();
    let patch = selected(&shell, is_in);
    for thickness in [2.0_f64, 4.0] {
        let inner = 8.0_f64 - thickness.min(3.0);
        let solid = solid(&shell, &patch, thickness);
        let beside = |p: [f64; 3]| ((along(p) / length(p)).acos() - half_angle) * length(p);
        let places = solid.mesh.vertices_mm().iter();
        let at_sides: Vec<f64> = places
            .clone()
            .filter(|p| (inner + 0.3..7.9).contains(&length(**p)))
            .map(|p| beside(*p))
            .collect();
        assert!(at_sides.len() > 100);
        let farthest = at_sides.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
        assert!(farthest < 0.1, "{thickness} mm: sides {farthest} mm off");
        for place in places {
            let radius = length(*place);
            assert!((inner - 0.1..8.1).contains(&radius), "{radius}");
            assert!(beside(*place) < 0.1, "{} at {radius}", beside(*place));
            // Well inside of the outline there is only front and back.
            if beside(*place) < -0.2 {
                let off = (radius - 8.0).abs().min((radius - inner).abs());
                assert!(off < 0.1, "{off} at {radius}");
            }
        }
    }
}

#[test]
fn the_front_is_the_patch_to_the_last_bit() {
    let shell = shell();
    let is_in = |p: [f64; 3]| length(p) > 17.0 && p[0] > 15.0;
    let patch = selected(&shell, is_in);
    let solid = solid(&shell, &patch, 4.0);
    let corners = |mesh: &TriangleMesh, t: &[u32; 3]| {
        let mut corners = mesh.corners_mm(*t).map(|c| c.map(f64::to_bits));
        corners.sort_unstable();
        corners
    };
    let triangles = solid.mesh.triangles().iter();
    let cut: HashSet<_> = triangles.map(|t| corners(&solid.mesh, t)).collect();
    let well_inside = |t: &&[u32; 3]| {
        let places = shell.corners_mm(**t);
        places.iter().all(|p| length(*p) > 17.0 && p[0] > 15.6)
    };
    let front: Vec<_> = shell.triangles().iter().filter(well_inside).collect();
    assert!(front.len() > 500);
    let kept = front.iter().filter(|t| cut.contains(&corners(&shell, t)));
    assert_eq!(kept.count(), front.len());
}

#[test]
fn walls_of_a_tube_are_cut_upright_around_its_curl() {
    let tube = body([16.0, 16.0, 20.0], |[x, y, z]| {
        let radius = x.hypot(y);
        (15.0 - radius).min(radius - 9.0).min(18.0 - z.abs())
    });
    // Almost half around, 20 mm high, from between two layers of the lattice to between two others.
    let is_in = |[x, y, z]: [f64; 3]| {
        x.hypot(y) > 12.0 && y.atan2(x).abs() < 1.4 && (z + 0.0575).abs() < 10.0
    };
    let patch = selected(&tube, is_in);
    for thickness in [2.0, 6.0, 8.0] {
        let solid = solid(&tube, &patch, thickness);
        let inner = 15.0_f64 - thickness.min(6.0);
        let expected = 1.4 * (15.0_f64.powi(2) - inner.powi(2)) * 20.0;
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
    }
}

#[test]
fn a_plate_is_cut_straight_through_or_part_of_the_way() {
    let plate = body([25.0, 25.0, 3.0], |[x, y, z]| {
        (24.0 - x.abs()).min(24.0 - y.abs()).min(2.0 - z.abs())
    });
    let is_in = |[x, y, z]: [f64; 3]| z > 1.5 && x.hypot(y) < 10.0;
    let patch = selected(&plate, is_in);
    for thickness in [1.0, 4.0, 5.0] {
        let solid = solid(&plate, &patch, thickness);
        let expected = PI * 100.0 * thickness.min(4.0);
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
    }
}

#[test]
fn hollows_in_what_is_cut_stay_hollow() {
    let shell = shell();
    let is_outer = |p: [f64; 3]| length(p) > 17.0;
    let whole = selected(&shell, is_outer);
    let inner = selected(&shell, |p| !is_outer(p));
    let between = |low: f64, high: f64| 4.0 / 3.0 * PI * (high.powi(3) - low.powi(3));
    for (patch, thickness, expected) in [
        (&whole, 3.0, between(17.0, 20.0)),
        (&whole, 6.0, between(14.0, 20.0)),
        (&inner, 3.0, between(14.0, 17.0)),
    ] {
        let part = volume_mm3(&solid(&shell, patch, thickness)) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
    }
}

#[test]
fn a_void_in_the_bone_stays_a_void() {
    let void = |[x, y, z]: [f64; 3]| length([x - 12.0, y, z]) - 1.4;
    let ball = body([21.0; 3], |p| (20.0 - length(p)).min(void(p)));
    let full = body([21.0; 3], |p| 20.0 - length(p));
    let is_in = |[x, y, z]: [f64; 3]| x > 0.0 && y.hypot(z) < 9.0;
    // Narrower than what ends a cut, it counts as a pore.
    let cut = |ball: &TriangleMesh| {
        let patch = selected(ball, |p| is_in(p) && length(p) > 19.0);
        volume_mm3(&solid(ball, &patch, 14.0))
    };
    let missing = cut(&full) - cut(&ball);
    let expected = 4.0 / 3.0 * PI * 1.4_f64.powi(3);
    assert!((missing / expected - 1.0).abs() < 0.1, "{missing}");
}
