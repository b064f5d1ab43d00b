//! What `check` says, for people.

use std::fmt::Write;
use std::path::Path;

use super::text::{counted, volume};
use crate::PrintCheck;

/// `check`.
pub(super) fn checked(check: &PrintCheck, file: &Path) -> String {
    let report = &check.topology;
    let yes = |b: bool| if b { "yes" } else { "no" };
    let mut rows = vec![
        ("vertices", report.vertices.to_string()),
        ("triangles", report.triangles.to_string()),
        (
            "components",
            match report.cavities {
                0 => report.components.to_string(),
                cavities => format!(
                    "{}, {cavities} of them walls of cavities",
                    report.components
                ),
            },
        ),
        (
            "watertight",
            format!(
                "{} ({} open edges)",
                yes(report.watertight),
                report.boundary_edges
            ),
        ),
        (
            "manifold",
            format!(
                "{} ({} edges, {} vertices are not)",
                yes(report.manifold),
                report.non_manifold_edges,
                report.non_manifold_vertices
            ),
        ),
        (
            "consistent winding",
            yes(report.consistent_winding).to_owned(),
        ),
        ("facing outward", yes(check.outward).to_owned()),
        ("self-intersections", intersections(check)),
        (
            "degenerate triangles",
            report.degenerate_triangles.to_string(),
        ),
        (
            "volume",
            if report.watertight {
                volume(report.volume_mm3)
            } else {
                "none, the surface is open".to_owned()
            },
        ),
        ("area", format!("{:.2} cm2", report.area_mm2 / 100.0)),
    ];
    rows.extend(walls(check));
    if let Some([low, high]) = report.bounds_mm {
        let axes = ["x (mm)", "y (mm)", "z (mm)"].into_iter().enumerate();
        rows.extend(axes.map(|(axis, name)| {
            let extent = format!("{:.2} to {:.2}", low[axis], high[axis]);
            (name, extent)
        }));
    }
    rows.push(("printable", verdict_on_print(check)));
    let mut text = format!("{}\n", file.display());
    for (name, value) in rows {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name:24}{value}");
    }
    for reason in &check.reasons {
        let _ = writeln!(text, "    {reason}");
    }
    text
}

/// Walls (mm) that a usual nozzle of 0.4 mm cannot lay down.
const THIN_MM: f64 = 0.4;

/// The verdict, and whether walls may be too thin for it.
fn verdict_on_print(check: &PrintCheck) -> String {
    let is_thin = check.thinnest_wall_mm.is_some_and(|mm| mm < THIN_MM);
    match (check.printable, is_thin) {
        (true, true) => format!(
            "yes, but walls below {THIN_MM} mm are thinner than most printers print (see where: --walls)"
        ),
        (true, false) => "yes".to_owned(),
        (false, _) => "no".to_owned(),
    }
}

/// How many there are and where the first is.
fn intersections(check: &PrintCheck) -> String {
    match check.intersections.first() {
        Some(first) => format!(
            "{}, {} triangles; the first at {}",
            counted(check.self_intersections, "pair", "pairs"),
            check.intersecting_triangles,
            place(first.place_mm)
        ),
        None => check.self_intersections.to_string(),
    }
}

/// The row of the walls, if there are any.
fn walls(check: &PrintCheck) -> Option<(&'static str, String)> {
    let thinnest = check.thinnest_wall_mm?;
    let at = place(check.thinnest_wall_place_mm?);
    let low = check.wall_5_percent_mm?;
    let text = format!("{thinnest:.2} mm at {at}; 5 % of the surface below {low:.2} mm");
    Some(("thinnest wall", text))
}

fn place([x, y, z]: [f64; 3]) -> String {
    format!("({x:.2}, {y:.2}, {z:.2})")
}
