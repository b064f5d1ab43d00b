//! Straight cuts, far sides and plates.

use std::f64::consts::PI;

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology, least_distance};
use bonemesh_roi::{ClearanceMm, Direction, RoiError, SolidRequest, select_solid};
use bonemesh_task::Task;

use crate::bodies::{body, length, request, selected, shell, solid, sound, volume_mm3};

/// Two walls of 3 mm with 6 mm between them, joined at their rims.
fn two_walls() -> TriangleMesh {
    body([25.0, 25.0, 7.0], |[x, y, z]| {
        let whole = (24.0 - x.abs()).min(24.0 - y.abs()).min(6.0 - z.abs());
        let hollow = (20.0 - x.abs()).min(20.0 - y.abs()).min(3.0 - z.abs());
        whole.min(-hollow)
    })
}

fn lowest(mesh: &TriangleMesh) -> f64 {
    let heights = mesh.vertices_mm().iter().map(|v| v[2]);
    heights.fold(f64::INFINITY, f64::min)
}

fn towards(direction: Direction, thickness_mm: f64) -> SolidRequest {
    SolidRequest {
        direction,
        ..request(thickness_mm)
    }
}

const DOWN: Direction = Direction::Along([0.0, 0.0, -1.0]);

#[test]
fn a_cut_ends_at_the_first_far_side_even_if_the_second_wall_hangs_together_with_it() {
    let walls = two_walls();
    // Up to the rim, where both walls are one.
    let patch = selected(&walls, |[x, y, z]| z > 5.5 && x.abs() < 12.0 && y > -12.0);
    for direction in [Direction::Normal, DOWN] {
        let one = sound(&walls, &patch, &towards(direction, 11.0));
        let vertices = one.mesh.vertices_mm().iter();
        let second = vertices.filter(|[_, y, z]| *y < 10.0 && *z < 2.0);
        assert_eq!(second.count(), 0, "{direction}");
    }
    let both = sound(&walls, &patch, &towards(Direction::Through, 12.5));
    assert!(lowest(&both.mesh) < -5.9);
}

#[test]
fn a_cut_straight_through_takes_both_walls() {
    let walls = two_walls();
    let patch = selected(&walls, |[x, y, z]| z > 5.5 && x.hypot(y) < 10.0);
    let both = sound(&walls, &patch, &towards(Direction::Through, 13.0));
    let part = volume_mm3(&both) / (PI * 100.0 * 6.0);
    assert!((part - 1.0).abs() < 0.01, "{part}");
    assert!((both.inward[2] + 1.0).abs() < 1e-3);
}

#[test]
fn the_sides_of_a_straight_cut_lie_along_its_direction() {
    let plate = body([25.0, 25.0, 5.0], |[x, y, z]| {
        (24.0 - x.abs()).min(24.0 - y.abs()).min(4.0 - z.abs())
    });
    let patch = selected(&plate, |[x, y, z]| z > 3.5 && x.hypot(y) < 8.0);
    let slant = Direction::along([0.5, 0.0, -1.0]).unwrap();
    let piece = sound(&plate, &patch, &towards(slant, 20.0));
    let part = volume_mm3(&piece) / (PI * 64.0 * 8.0);
    assert!((part - 1.0).abs() < 0.01, "{part}");
    for [x, y, z] in piece.mesh.vertices_mm() {
        let radius = (x - 0.5 * (4.0 - z)).hypot(*y);
        assert!(radius < 8.3, "{x} {y} {z}");
    }
}

#[test]
fn a_shell_is_cut_along_a_view_as_deep_as_the_thickness_behind_each_place() {
    let shell = shell();
    let patch = selected(&shell, |p| {
        length(p) > 17.0 && p[2] > 0.0 && p[0].hypot(p[1]) < 8.0
    });
    let piece = sound(&shell, &patch, &towards(DOWN, 3.0));
    let part = volume_mm3(&piece) / (PI * 64.0 * 3.0);
    // Along the lattice the outline is half an edge off, all around.
    assert!((part - 1.0).abs() < 0.03, "{part}");
}

#[test]
fn what_an_x_ray_lasso_picked_up_behind_is_left_out_unless_asked_for() {
    let shell = shell();
    let patch = selected(&shell, |p| p[0].hypot(p[1]) < 6.0);
    let front = selected(&shell, |p| p[0].hypot(p[1]) < 6.0 && p[2] > 17.0);
    let expected = sound(&shell, &front, &towards(DOWN, 3.0));
    let seen = sound(&shell, &patch, &towards(DOWN, 3.0));
    let parts =
        [&seen, &expected].map(|s| (s.patch_mm2, volume_mm3(s), s.mesh.vertices_mm().len()));
    assert_eq!(parts[0], parts[1]);
    assert!(seen.mesh == expected.mesh);
    assert!(seen.dropped > 0);
    let all = SolidRequest {
        with_hidden: true,
        ..request(2.0)
    };
    let all = sound(&shell, &patch, &all);
    let pairs = all.mesh.vertices_mm().iter();
    assert!(pairs.clone().any(|v| v[2] > 19.0) && pairs.clone().any(|v| v[2] < -19.0));
    assert!(volume_mm3(&solid(&shell, &patch, 2.0)) < 0.5 * volume_mm3(&all));
}

#[test]
fn a_plate_lies_on_the_bone_with_its_clearance_and_its_thickness() {
    let shell = shell();
    let half_angle = 0.6_f64;
    let along = |[x, y, z]: [f64; 3]| (2.0 * x - y + 3.0 * z) / 14.0_f64.sqrt();
    let is_in = |p: [f64; 3]| length(p) > 17.0 && along(p) > length(p) * half_angle.cos();
    let patch = selected(&shell, is_in);
    for (clearance, thickness) in [(0.0, 2.0), (0.2, 1.5), (1.0, 3.0)] {
        let plate = SolidRequest {
            direction: Direction::Outward,
            clearance: ClearanceMm::new(clearance).unwrap(),
            ..request(thickness)
        };
        let plate = sound(&shell, &patch, &plate);
        let [low, high] = [20.0 + clearance, 20.0 + clearance + thickness];
        let cone = 2.0 * PI * (1.0 - half_angle.cos()) / 3.0;
        let part = volume_mm3(&plate) / (cone * (high.powi(3) - low.powi(3)));
        assert!((part - 1.0).abs() < 0.02, "{clearance} {thickness}: {part}");
        for place in plate.mesh.vertices_mm() {
            let radius = length(*place);
            assert!((low - 0.05..high + 0.1).contains(&radius), "{radius}");
        }
    }
}

#[test]
fn a_plate_keeps_off_bone_beside_the_patch() {
    // A wall stands up beside the patch, 1 mm from its outline.
    let step = body([20.0, 20.0, 12.0], |[x, y, z]| {
        let floor = (19.0 - x.abs()).min(19.0 - y.abs()).min(-z).min(z + 8.0);
        let wall = (x - 5.0)
            .min(12.0 - x)
            .min(19.0 - y.abs())
            .min(11.0 - z)
            .min(z + 8.0);
        floor.max(wall)
    });
    let patch = selected(&step, |[x, y, z]| {
        z.abs() < 0.3 && (-8.0..4.5).contains(&x) && y.abs() < 8.0
    });
    let plate = SolidRequest {
        direction: Direction::Outward,
        clearance: ClearanceMm::new(1.0).unwrap(),
        ..request(3.0)
    };
    let plate = sound(&step, &patch, &plate);
    let nearest = plate.mesh.vertices_mm().iter().map(|v| 5.0 - v[0]);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!((0.9..1.2).contains(&nearest), "{nearest}");
}

#[test]
fn a_plate_thicker_than_the_bone_stays_outside_of_it() {
    let shell = shell();
    let patch = selected(&shell, |p| length(p) > 17.0 && p[2] > 19.0);
    let plate = SolidRequest {
        direction: Direction::Outward,
        ..request(12.0)
    };
    let plate = sound(&shell, &patch, &plate);
    let nearest = plate.mesh.vertices_mm().iter().map(|p| length(*p));
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!(nearest > 20.1, "{nearest}");
}

#[test]
fn a_plate_keeps_its_clearance_from_ridges_narrower_than_its_steps() {
    // Ridges 0.5 mm wide and 1 mm high, 4 mm apart.
    let ridged = body([15.0, 15.0, 4.0], |[x, y, z]| {
        let ridge = 0.25 - ((x / 4.0).round() * 4.0 - x).abs();
        let plate = (14.0 - x.abs()).min(14.0 - y.abs()).min(2.0 - z.abs());
        let ridges = ridge
            .min(3.0 - z.abs())
            .min(14.0 - y.abs())
            .min(14.0 - x.abs());
        plate.max(ridges)
    });
    let patch = selected(&ridged, |[x, y, z]| z > 1.5 && x.hypot(y) < 9.0);
    let request = SolidRequest {
        clearance: ClearanceMm::new(0.5).unwrap(),
        ..towards(Direction::Outward, 5.0)
    };
    let plate = sound(&ridged, &patch, &request);
    let tree = TriangleTree::new(&plate.mesh, &Task::default()).unwrap();
    let gaps = ridged
        .vertices_mm()
        .iter()
        .filter_map(|v| tree.nearest(*v, 0.5));
    let least = gaps
        .map(|found| found.squared_mm2.sqrt())
        .fold(0.5, f64::min);
    assert!(least > 0.48, "{least} mm");
    assert_eq!(plate.gap_mm, None);
}

#[test]
fn a_plate_without_clearance_stays_outside_of_the_bone() {
    let rough = body([12.0, 12.0, 4.0], |[x, y, z]| {
        let height = 2.0 + 0.3 * (1.3 * x).sin() * (1.7 * y).cos();
        (11.0 - x.abs())
            .min(11.0 - y.abs())
            .min((height - z).min(z + 2.0))
    });
    let patch = selected(&rough, |[x, y, z]| z > 1.0 && x.hypot(y) < 8.0);
    for clearance_mm in [0.0, 0.05, 0.2] {
        let request = SolidRequest {
            clearance: ClearanceMm::new(clearance_mm).unwrap(),
            ..towards(Direction::Outward, 3.0)
        };
        let plate = sound(&rough, &patch, &request);
        assert_eq!(plate.gap_mm, None, "{clearance_mm}");
        let tree = TriangleTree::new(&rough, &Task::default()).unwrap();
        let gap = least_distance(&plate.mesh, &tree, 1.0, &Task::default()).unwrap();
        assert!(gap.unwrap() > 0.95 * clearance_mm, "{gap:?}");
        assert!(gap.unwrap() < clearance_mm + 0.3, "{gap:?}");
    }
}

#[test]
fn a_plate_on_thin_bone_is_one_body_on_its_own_side() {
    for thickness_mm in [0.3, 0.6] {
        let slab = body([12.0, 12.0, 3.0], |[x, y, z]| {
            let across = (11.0 - x.abs()).min(11.0 - y.abs());
            across.min((1.0 - z).min(z - 1.0 + thickness_mm))
        });
        let patch = selected(&slab, |[x, y, z]| z > 0.95 && x.hypot(y) < 8.0);
        let plate = sound(&slab, &patch, &towards(Direction::Outward, 3.0));
        assert!(lowest(&plate.mesh) > 1.1, "{}", lowest(&plate.mesh));
        let topology = check_topology(&plate.mesh, &Task::default()).unwrap();
        assert_eq!(topology.components, 1);
    }
}

#[test]
fn a_plate_is_refused_where_nothing_says_which_way_is_out() {
    let shell = shell();
    let patch = selected(&shell, |p| length(p) > 17.0 && p[0] > 15.0);
    let request = towards(Direction::Outward, 3.0);
    let turned = |is_turned: fn(usize) -> bool| {
        let numbered = shell.triangles().iter().enumerate();
        let triangles =
            numbered.map(|(n, &[a, b, c])| if is_turned(n) { [a, c, b] } else { [a, b, c] });
        let mesh = TriangleMesh::new(shell.vertices_mm().to_vec(), triangles.collect()).unwrap();
        select_solid(&mesh, &patch, &request, &Task::default()).unwrap_err()
    };
    assert!(matches!(turned(|_| true), RoiError::NothingCut));
    assert!(matches!(turned(|n| n % 5 == 0), RoiError::Open));
}
