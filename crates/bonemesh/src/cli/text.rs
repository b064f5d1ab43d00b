//! Reports in words.

use std::fmt::Write;
use std::path::Path;

use bonemesh_mesh::Topology;

use crate::AfterCareReport;
use crate::mirror::PlaneReport;
use crate::region_report::{RegionReport, SolidReport};
use crate::report::{RenderReport, Seconds};
use crate::source::Contents;

/// Files that `info` names one by one.
const MAX_LEFT_OUT: usize = 50;

/// Cubic millimetres in a cubic centimetre.
const MM3_PER_CM3: f64 = 1000.0;

/// `info`.
pub(super) fn contents(contents: &Contents) -> String {
    let mut text = String::new();
    let mut line = |l: String| {
        text.push_str(&l);
        text.push('\n');
    };
    for series in &contents.series {
        let is_rival = contents.alternatives.contains(&series.number);
        let choice = match series.number {
            n if n == contents.recommended => "  (recommended)",
            _ if is_rival => "  (could be meant as well)",
            _ => "",
        };
        line(format!("{}  {}{choice}", series.number, series.title()));
        for of_series in series.lines() {
            line(format!("   {of_series}"));
        }
    }
    if !contents.left_out.is_empty() {
        line(format!("left out: {}", contents.left_out.len()));
        for left_out in contents.left_out.iter().take(MAX_LEFT_OUT) {
            let path = left_out.path.to_string_lossy();
            line(format!("   {}: {}", printable(&path), left_out.reason));
        }
        if let more @ 1.. = contents.left_out.len().saturating_sub(MAX_LEFT_OUT) {
            line(format!("   and {more} more, which --json lists"));
        }
    }
    text
}

/// Text without line breaks and whatever else drives a terminal, which names of files may hold.
pub(super) fn printable(text: &str) -> String {
    let shown = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    text.chars().map(shown).collect()
}

/// `render` and `mesh`.
pub(super) fn rendered(report: &RenderReport, file: &Path) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{}", file.display());
    let _ = writeln!(
        text,
        "  {} triangles, {} vertices, {}{}",
        report.triangles,
        report.vertices,
        components(report.components, report.cavities),
        enclosed(report.watertight, report.volume_mm3)
    );
    if let (Some(points), Some(alpha_mm), Some(tetrahedra)) =
        (report.points, report.alpha_mm, report.tetrahedra)
    {
        let _ = writeln!(
            text,
            "  {points} points, alpha {alpha_mm:.3} mm, {tetrahedra} tetrahedra"
        );
    }
    if let (Some(coefficient), Some(bone_mm3)) = (report.alpha_coefficient, report.bone_volume_mm3)
    {
        let _ = writeln!(
            text,
            "  alpha is {coefficient:.3} times the mean distance, for the bone's {}",
            volume(bone_mm3)
        );
    }
    let _ = writeln!(text, "  {}", verdict(report.watertight, report.manifold));
    let left_out = [
        (
            "the scanner's table",
            report.left_out_table,
            "--keep-table keeps it",
        ),
        ("specks", report.left_out_specks, "--islands 0 keeps them"),
    ];
    for (name, left_out, remedy) in left_out {
        if let Some(left_out) = left_out {
            let _ = writeln!(
                text,
                "  left out what looks like {name}: {} in {} ({remedy})",
                volume(left_out.volume_mm3),
                counted(left_out.islands, "island", "islands")
            );
        }
    }
    if let Some(report) = &report.after_care {
        text.push_str(&after_care(report));
    }
    if let Some(hu) = report.threshold_hu {
        let reason = report.threshold_reason.as_deref();
        text.push_str(&threshold(hu, report.local_leeway_hu, reason));
    }
    let after_care_s = report.after_care.as_ref().map_or(0.0, |care| care.seconds);
    let _ = writeln!(text, "  {}", seconds(&report.seconds, after_care_s));
    for warning in &report.warnings {
        let _ = writeln!(text, "  note: {warning}");
    }
    text
}

/// Steps that take less than these seconds are not named.
const SHOWN_S: f64 = 0.005;

/// The time of all, and of the steps that took place.
fn seconds(seconds: &Seconds, after_care_s: f64) -> String {
    let steps = [
        ("read", seconds.read),
        ("edges", seconds.edges),
        ("cloud", seconds.cloud),
        ("neighbours", seconds.neighbours),
        ("tetrahedra", seconds.tetrahedra),
        ("surface", seconds.surface),
        ("after-care", after_care_s),
        ("write", seconds.write),
    ];
    let steps: Vec<String> = steps
        .into_iter()
        .filter(|(_, of_step)| *of_step >= SHOWN_S)
        .map(|(name, of_step)| format!("{name} {of_step:.2}"))
        .collect();
    format!("{:.2} s: {}", seconds.total, steps.join(", "))
}

/// Holes left that the text names; the report has more of them.
const HOLES_SHOWN: usize = 5;

/// `repair`: what was done, and what the mesh is now.
pub(super) fn repaired(report: &AfterCareReport, topology: &Topology, file: &Path) -> String {
    format!(
        "{}\n  {}, {}, {}{}\n  {}\n{}  {:.2} s\n",
        file.display(),
        counted(topology.triangles, "triangle", "triangles"),
        counted(topology.vertices, "vertex", "vertices"),
        components(topology.components, topology.cavities),
        enclosed(topology.watertight, topology.volume_mm3),
        verdict(topology.watertight, topology.manifold),
        after_care(report),
        report.seconds
    )
}

/// What was done to a finished mesh, a line each.
pub(super) fn after_care(report: &AfterCareReport) -> String {
    let mut text = String::new();
    let taken_out = [
        (report.removed_degenerate, "without area taken out"),
        (report.removed_doubled, "given twice taken out"),
    ];
    for (count, what) in taken_out.into_iter().filter(|(count, _)| *count > 0) {
        let _ = writeln!(text, "  {} {what}", counted(count, "triangle", "triangles"));
    }
    if let Some(turned) = report.turned_triangles.filter(|turned| *turned > 0) {
        // Writing to a String cannot fail.
        let turned = counted(turned, "triangle", "triangles");
        let _ = writeln!(text, "  {turned} turned over to face outward");
    }
    if let (Some(filled), Some(left)) = (report.filled_holes, report.left_holes) {
        // Writing to a String cannot fail.
        let filled = counted(filled, "hole", "holes");
        let _ = writeln!(text, "  {filled} filled, {left} left");
        for hole in report.largest_left_holes.iter().take(HOLES_SHOWN) {
            let [x, y, z] = hole.place_mm;
            let _ = writeln!(
                text,
                "    left: {:.1} mm, {} edges, at {x:.1} {y:.1} {z:.1}: {}",
                hole.extent_mm, hole.edges, hole.reason
            );
        }
    }
    let parts = [
        (
            ["island", "islands"],
            report.removed_islands,
            report.removed_islands_mm3,
        ),
        (
            ["cavity", "cavities"],
            report.removed_cavities,
            report.removed_cavities_mm3,
        ),
    ];
    for ([one, many], count, mm3) in parts.into_iter().filter(|(_, count, _)| *count > 0) {
        // Writing to a String cannot fail.
        let count = counted(count, one, many);
        let _ = writeln!(text, "  {count} taken away, {}", volume(mm3));
    }
    if let (Some(mm), Some(back)) = (report.largest_move_mm, report.put_back_vertices) {
        let _ = writeln!(
            text,
            "  smoothed: moved up to {mm:.3} mm, {back} vertices left in place"
        );
    }
    if let (Some(count), Some(held)) = (report.removed_triangles, report.held_vertices) {
        let held = match held {
            0 => String::new(),
            _ => format!(
                ", {} left as they were (a smaller bound may take more away there)",
                counted(held, "vertex", "vertices")
            ),
        };
        let _ = writeln!(
            text,
            "  {} taken away{held}",
            counted(count, "triangle", "triangles")
        );
    }
    if let Some(mm) = report.largest_distance_mm {
        let _ = writeln!(
            text,
            "  the reduced surface passes the former vertices at {mm:.3} mm at most"
        );
    }
    if let Some(percent) = report.volume_change_percent {
        let _ = writeln!(text, "  volume changed by {percent:+.3} %");
    }
    if let Some(wanted) = report.missed_triangles {
        let _ = writeln!(
            text,
            "  {wanted} triangles were asked for; no more could go without bending the surface too much or taking it through itself or out of its bounds"
        );
    }
    text
}

/// A volume in cm3, or in mm3 where there are few of them.
pub(super) fn volume(mm3: f64) -> String {
    match mm3.abs() {
        few if few < 1.0 => format!("{mm3:.3} mm3"),
        few if few < MM3_PER_CM3 => format!("{mm3:.1} mm3"),
        _ => format!("{:.2} cm3", mm3 / MM3_PER_CM3),
    }
}

/// `count` with its noun.
pub(super) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// How many parts there are, and how many of them are inside others.
fn components(components: usize, cavities: usize) -> String {
    match cavities {
        0 => counted(components, "component", "components"),
        1 => format!("{components} components (one the wall of a cavity)"),
        _ => format!("{components} components ({cavities} walls of cavities)"),
    }
}

/// What a surface encloses, where it does: of an open one the number would say nothing.
fn enclosed(watertight: bool, mm3: f64) -> String {
    if watertight {
        format!(", {}", volume(mm3))
    } else {
        String::new()
    }
}

/// The threshold, how far it may lie elsewhere around a voxel, and where it is from.
pub(super) fn threshold(hu: f64, leeway_hu: Option<f64>, reason: Option<&str>) -> String {
    let leeway = leeway_hu.map(|hu| format!(", by place up to {hu} HU more or less"));
    let reason = reason.map(|reason| format!(" ({reason})"));
    let [leeway, reason] = [leeway, reason].map(Option::unwrap_or_default);
    format!("  bone above {hu} HU{leeway}{reason}\n")
}

/// `roi`.
pub(super) fn region(report: &RegionReport, file: &Path) -> String {
    let thesis = report.thesis.iter();
    let found = thesis.map(|thesis| format!(", {} points behind them", thesis.kept_points));
    let solid = report.solid.iter();
    let cut = solid.map(|solid| format!(", {:.1} mm2, cut {}", solid.patch_mm2, solid.direction));
    let what: String = found.chain(cut).collect();
    let notes: String = report.solid.iter().map(solid_notes).collect();
    format!(
        "{}\n  {}{what}, thickness {} mm\n{notes}  {} triangles, {} vertices, {}{}\n  {}\n  {:.2} s\n",
        file.display(),
        counted(report.selected(), "selected vertex", "selected vertices"),
        report.thickness_mm,
        report.triangles,
        report.vertices,
        components(report.components, 0),
        enclosed(report.watertight, report.volume_mm3),
        verdict(report.watertight, report.manifold),
        report.seconds,
    )
}

/// How near a plate comes to the bone.
fn near(gap_mm: f64) -> String {
    if gap_mm > 0.0 {
        format!("  comes as near to the bone as {gap_mm:.2} mm\n")
    } else {
        "  touches or enters the bone somewhere; a larger clearance keeps it off\n".to_owned()
    }
}

/// What was done to the selection or the mesh before a solid was cut, a line each.
fn solid_notes(solid: &SolidReport) -> String {
    let counts = [
        (
            solid.dropped_pieces,
            ["piece", "pieces"],
            "of the selection left out: crumbs, or hidden behind others (--hidden takes these too)",
        ),
        (
            solid.closed_gaps,
            ["gap", "gaps"],
            "in the selection closed",
        ),
        (
            solid.removed_triangles,
            ["triangle", "triangles"],
            "without area, or given twice, of the mesh taken out first",
        ),
        (
            solid.turned_triangles,
            ["triangle", "triangles"],
            "of the mesh turned over first",
        ),
        (
            solid.filled_holes,
            ["hole", "holes"],
            "of the mesh filled first",
        ),
    ];
    let counts = counts.iter().filter(|(count, _, _)| *count > 0);
    let gap = solid.gap_mm.iter();
    let mirror = solid.mirror.iter();
    let lines: Vec<String> = counts
        .map(|&(count, [one, many], what)| format!("  {} {what}\n", counted(count, one, many)))
        .chain(gap.map(|gap| near(*gap)))
        .chain(mirror.map(|m| format!("  taken from the other side of {}\n", plane(m))))
        .collect();
    lines.concat()
}

fn plane(report: &PlaneReport) -> String {
    let [x, y, z] = report.normal;
    let found = report.error_mm.zip(report.mean_mm);
    let found = found.map_or_else(String::new, |(error, mean)| {
        format!(" (found; the best 70 % of the surface fits within {error:.2} mm rms, all of it within {mean:.2} mm in the mean)")
    });
    format!(
        "the plane {x:.4},{y:.4},{z:.4},{:.2}{found}",
        report.offset_mm
    )
}

/// `mirror`.
pub(super) fn mirrored(report: &PlaneReport, file: &Path) -> String {
    format!("{}\n  mirrored in {}\n", file.display(), plane(report))
}

fn verdict(watertight: bool, manifold: bool) -> &'static str {
    match (watertight, manifold) {
        (true, true) => "closed and manifold",
        (true, false) => {
            "closed; touches itself along edges or at vertices (bonemesh check counts them)"
        }
        (false, _) => "open",
    }
}
