//! The ruler: nearest points of the bone surface, creases, walls, samples and volumes.

use bonemesh_phantom::{Body, BoneSurface, Phantom};
use bonemesh_task::Task;
use proptest::prelude::*;

const BODIES: [Phantom; 5] = [
    Phantom::SphereShell,
    Phantom::Tube,
    Phantom::BoxWithHole,
    Phantom::Femur,
    Phantom::Head,
];
const CREASE_MM: f64 = 1.2;

fn length(p: [f64; 3]) -> f64 {
    p.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn between(p: [f64; 3], q: [f64; 3]) -> f64 {
    length(std::array::from_fn(|i| p[i] - q[i]))
}

/// Points spread over the unit sphere.
fn sphere(count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let turn = 2.399_963_229_728_653 * f64::from(i);
        let flat = (1.0 - z * z).sqrt();
        [flat * turn.cos(), flat * turn.sin(), z]
    })
}

/// Whether the ball about `p` touches the surface: the point found lies on it, and the other
/// material begins nowhere inside the ball.
fn assert_nearest(phantom: Phantom, surface: &BoneSurface, body: &dyn Body, p: [f64; 3]) {
    let found = surface.nearest(p, CREASE_MM);
    let away = found.distance_mm.abs();
    let inside = body.signed_distance_mm(p) < 0.0;
    assert_eq!(found.distance_mm < 0.0, inside, "{phantom} {p:?}");
    assert!((between(p, found.point_mm) - away).abs() < 1e-9);
    let off = body.signed_distance_mm(found.point_mm).abs();
    assert!(off < 1e-3, "{phantom} {p:?}: {off} off the surface");
    let radius = away - 0.005 * away.max(1.0);
    for part in [1.0, 0.98, 0.9] {
        for way in sphere(1_500) {
            let q = std::array::from_fn(|i| p[i] + part * radius.max(0.0) * way[i]);
            let same = (body.signed_distance_mm(q) < 0.0) == inside;
            assert!(
                same || radius <= 0.0,
                "{phantom} {p:?}: {q:?} is nearer than {found:?}"
            );
        }
    }
}

#[test]
fn nothing_is_nearer_than_the_nearest_point() {
    for phantom in BODIES {
        let (surface, body) = (BoneSurface::of(phantom).unwrap(), phantom.body().unwrap());
        let samples = surface.samples(24, 1, &Task::default()).unwrap();
        for (sample, way) in samples.into_iter().zip(sphere(24)) {
            for off in [0.03, 0.3, 1.5] {
                let p = std::array::from_fn(|i| sample[i] + off * way[i]);
                assert_nearest(phantom, &surface, &*body, p);
            }
        }
    }
}

#[test]
fn in_blends_the_field_alone_would_measure_too_little() {
    let (surface, body) = (
        BoneSurface::of(Phantom::Head).unwrap(),
        Phantom::Head.body().unwrap(),
    );
    let samples = surface.samples(400, 2, &Task::default()).unwrap();
    let short = samples.iter().zip(sphere(400)).filter(|(sample, way)| {
        let p = std::array::from_fn(|i| sample[i] + 0.5 * way[i]);
        let d = surface.nearest(p, CREASE_MM).distance_mm;
        let claimed = body.signed_distance_mm(p);
        assert!(
            claimed.abs() <= d.abs() + 1e-6,
            "the field never claims more"
        );
        claimed.abs() < 0.95 * d.abs()
    });
    assert!(short.count() > 8);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn distances_to_spheres_are_those_of_the_formula(
        p in proptest::array::uniform3(-30.0..30.0f64),
    ) {
        let surface = BoneSurface::of(Phantom::SphereShell).unwrap();
        let r = length(p);
        let expected = (30.0 - r).max(r - 36.0);
        let found = surface.nearest(p, CREASE_MM);
        prop_assert!((found.distance_mm - expected).abs() < 0.005 * expected.abs().max(1.0));
        prop_assert!(!found.crease);
        if r > 15.0 {
            prop_assert!((found.wall_mm - 6.0).abs() < 0.01, "{}", found.wall_mm);
        }
    }

    #[test]
    fn distances_to_a_box_with_a_hole_are_those_of_its_faces(
        p in proptest::array::uniform3(-22.0..22.0f64),
    ) {
        // The walls one by one: six outer faces, four of the hole, each a rectangle.
        let clamp = |v: f64, half: f64| v.clamp(-half, half);
        let mut least = f64::INFINITY;
        for s in [-1.0, 1.0] {
            least = least.min(between(p, [20.0 * s, clamp(p[1], 15.0), clamp(p[2], 15.0)]));
            least = least.min(between(p, [clamp(p[0], 20.0), 15.0 * s, clamp(p[2], 15.0)]));
            least = least.min(between(p, [7.5 * s, clamp(p[1], 7.5), clamp(p[2], 15.0)]));
            least = least.min(between(p, [clamp(p[0], 7.5), 7.5 * s, clamp(p[2], 15.0)]));
            // An end is a frame: whatever is not in the hole.
            let end = if p[0].abs() < 7.5 && p[1].abs() < 7.5 {
                let out = (7.5 - p[0].abs()).min(7.5 - p[1].abs());
                out.hypot(p[2] - 15.0 * s)
            } else {
                between(p, [clamp(p[0], 20.0), clamp(p[1], 15.0), 15.0 * s])
            };
            least = least.min(end);
        }
        let found = BoneSurface::of(Phantom::BoxWithHole).unwrap().nearest(p, CREASE_MM);
        prop_assert!((found.distance_mm.abs() - least).abs() < 0.005 * least.max(1.0), "{found:?} {least}");
    }
}

#[test]
fn edges_are_creases_and_faces_are_not() {
    let surface = BoneSurface::of(Phantom::BoxWithHole).unwrap();
    for (p, crease) in [
        ([20.1, 3.0, 2.0], false),
        ([19.9, 15.1, 2.0], true),
        ([20.2, 15.2, 2.0], true),
        ([20.1, 15.0 - 1.3, 2.0], false),
        ([20.1, 15.0 - 1.1, 2.0], true),
        ([7.4, 7.4, 0.0], true),
        ([7.4, 5.0, 0.0], false),
        ([12.0, 0.0, 14.9], false),
        ([20.3, 15.3, 15.3], true),
    ] {
        assert_eq!(surface.nearest(p, CREASE_MM).crease, crease, "{p:?}");
    }
    let walls = surface.nearest([20.1, 3.0, 2.0], CREASE_MM);
    assert!((walls.wall_mm - 12.5).abs() < 0.01, "{walls:?}");
    let hole = surface.nearest([7.4, 3.0, 2.0], CREASE_MM);
    assert!((hole.gap_mm - 15.0).abs() < 0.01, "{hole:?}");
}

#[test]
fn a_thin_wall_alone_is_no_crease() {
    // The septum, 1.8 mm thick, far from its rims.
    let surface = BoneSurface::of(Phantom::Head).unwrap();
    let found = surface.nearest([-2.4, -55.0, -48.0], CREASE_MM);
    assert!(!found.crease, "{found:?}");
    assert!(found.wall_mm < 2.0, "{found:?}");
    let name = surface.structures()[found.structure];
    assert!(name.contains("septum"), "{name}");
}

#[test]
fn skin_is_measured_to_the_air_behind_it() {
    let surface = BoneSurface::of(Phantom::Head).unwrap();
    let crown = surface.nearest([28.5, 34.0, 67.3], CREASE_MM);
    let body = Phantom::Head.body().unwrap();
    let at = |s: f64| {
        body.hu(std::array::from_fn(|i| {
            crown.point_mm[i] + s * crown.normal[i]
        }))
    };
    assert!(crown.air_mm > 1.0 && crown.air_mm < 5.0, "{crown:?}");
    assert!(at(crown.air_mm - 0.02) > 0.0);
    assert!(at(crown.air_mm + 0.02) < -900.0);
    let shell = BoneSurface::of(Phantom::SphereShell).unwrap();
    assert!(shell.nearest([37.0, 0.0, 0.0], CREASE_MM).air_mm >= 20.0);
}

#[test]
fn volumes_are_those_of_the_formulas() {
    for phantom in [Phantom::SphereShell, Phantom::Tube, Phantom::BoxWithHole] {
        let truth = bonemesh_phantom::truth(phantom, &phantom.settings()).unwrap();
        let expected = truth["volume_mm3"].as_f64().unwrap();
        let surface = BoneSurface::of(phantom).unwrap();
        let volume = surface.volume_mm3(0.5, &Task::default()).unwrap();
        let ratio = volume / expected - 1.0;
        assert!(ratio.abs() < 5e-4, "{phantom}: {ratio}");
    }
}

#[test]
fn samples_lie_on_the_surface_as_densely_everywhere() {
    let surface = BoneSurface::of(Phantom::SphereShell).unwrap();
    let samples = surface.samples(20_000, 3, &Task::default()).unwrap();
    assert_eq!(samples.len(), 20_000);
    let outer = samples.iter().filter(|p| length(**p) > 33.0).count() as f64;
    for p in &samples {
        let r = length(*p);
        assert!((r - 30.0).abs().min((r - 36.0).abs()) < 1e-5);
    }
    let share = 36.0_f64.powi(2) / (36.0_f64.powi(2) + 30.0_f64.powi(2));
    assert!((outer / 20_000.0 - share).abs() < 0.015, "{outer}");
    let upper = samples.iter().filter(|p| p[2] > 0.5 * length(**p)).count() as f64;
    assert!((upper / 20_000.0 - 0.25).abs() < 0.015, "{upper}");
}

#[test]
fn every_number_of_threads_gives_the_same() {
    let surface = BoneSurface::of(Phantom::Femur).unwrap();
    let once = |threads: usize| {
        let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
        pool.install(|| {
            let task = Task::default();
            let points = surface.samples(300, 5, &task).unwrap();
            let volume = surface.volume_mm3(3.0, &task).unwrap();
            (
                surface.nearest_of_all(&points, CREASE_MM, &task).unwrap(),
                volume,
            )
        })
    };
    assert_eq!(once(1), once(3));
}

#[test]
fn cancelled_work_ends() {
    let surface = BoneSurface::of(Phantom::Tube).unwrap();
    let task = Task::default();
    task.cancel().cancel();
    assert!(surface.samples(10, 0, &task).is_err());
    assert!(surface.volume_mm3(1.0, &task).is_err());
    assert!(surface.nearest_of_all(&[[0.0; 3]], 1.2, &task).is_err());
}

#[test]
fn points_at_the_end_of_the_world_have_an_answer() {
    let surface = BoneSurface::of(Phantom::Head).unwrap();
    for far in [1e4, 1e9, 1e154, 1e308] {
        let found = surface.nearest([far, -far, far], CREASE_MM);
        assert!(found.distance_mm > 1e4, "{found:?}");
    }
    let near = surface.nearest([1000.0, 0.0, 0.0], CREASE_MM);
    assert!(near.distance_mm > 920.0 && near.distance_mm < 940.0);
}

#[test]
fn models_drawn_in_pixels_have_no_ruler() {
    assert!(BoneSurface::of(Phantom::Cube).is_none());
}
