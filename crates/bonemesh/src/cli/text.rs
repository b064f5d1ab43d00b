//! Reports in words.

use std::fmt::Write;
use std::path::Path;

use crate::report::{CheckReport, RegionReport, RenderReport};
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
    let mut line = |l: String| {
        text.push_str(&l);
        text.push('\n');
    };
    line(format!("{}", file.display()));
    line(format!(
        "  {} triangles, {} vertices, {} components, {:.1} cm3",
        report.triangles,
        report.vertices,
        report.components,
        report.volume_mm3 / MM3_PER_CM3
    ));
    if let (Some(points), Some(alpha_mm), Some(tetrahedra)) =
        (report.points, report.alpha_mm, report.tetrahedra)
    {
        line(format!(
            "  {points} points, alpha {alpha_mm:.3} mm, {tetrahedra} tetrahedra"
        ));
    }
    line(format!("  {}", verdict(report.watertight, report.manifold)));
    if let Some(hu) = report.threshold_hu {
        text.push_str(&threshold(hu, report.threshold_reason.as_deref()));
    }
    let mut line = |l: String| {
        text.push_str(&l);
        text.push('\n');
    };
    let s = &report.seconds;
    line(format!(
        "  {:.2} s: read {:.2}, edges {:.2}, cloud {:.2}, neighbours {:.2}, tetrahedra {:.2}, surface {:.2}, write {:.2}",
        s.total, s.read, s.edges, s.cloud, s.neighbours, s.tetrahedra, s.surface, s.write
    ));
    for warning in &report.warnings {
        line(format!("  note: {warning}"));
    }
    text
}

/// The threshold, and where it is from.
pub(super) fn threshold(hu: f64, reason: Option<&str>) -> String {
    match reason {
        Some(reason) => format!("  bone above {hu} HU ({reason})\n"),
        None => format!("  bone above {hu} HU\n"),
    }
}

/// `roi`.
pub(super) fn region(report: &RegionReport, file: &Path) -> String {
    format!(
        "{}\n  {} selected vertices, {} points behind them, thickness {} mm\n  {} triangles, {} vertices, {} components, {:.2} cm3\n  {}\n  {:.2} s\n",
        file.display(),
        report.selected,
        report.kept_points,
        report.thickness_mm,
        report.triangles,
        report.vertices,
        report.components,
        report.volume_mm3 / MM3_PER_CM3,
        verdict(report.watertight, report.manifold),
        report.seconds,
    )
}

/// `check`.
pub(super) fn checked(report: &CheckReport, file: &Path) -> String {
    let mut text = format!("{}\n", file.display());
    let yes = |b: bool| if b { "yes" } else { "no" };
    let mut row = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name:24}{value}");
    };
    row("vertices", report.vertices.to_string());
    row("triangles", report.triangles.to_string());
    row("components", report.components.to_string());
    row(
        "watertight",
        format!(
            "{} ({} open edges)",
            yes(report.watertight),
            report.boundary_edges
        ),
    );
    row(
        "manifold",
        format!(
            "{} ({} edges, {} vertices are not)",
            yes(report.manifold),
            report.non_manifold_edges,
            report.non_manifold_vertices
        ),
    );
    row(
        "consistent winding",
        yes(report.consistent_winding).to_owned(),
    );
    row(
        "degenerate triangles",
        report.degenerate_triangles.to_string(),
    );
    row(
        "volume",
        format!("{:.2} cm3", report.volume_mm3 / MM3_PER_CM3),
    );
    row("area", format!("{:.2} cm2", report.area_mm2 / 100.0));
    if let Some([low, high]) = report.bounds_mm {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            row(
                &format!("{name} (mm)"),
                format!("{:.2} to {:.2}", low[axis], high[axis]),
            );
        }
    }
    text
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
