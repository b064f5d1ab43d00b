//! How often each distance from a reference occurs, as a picture.

use std::path::Path;

use bonemesh_measure::Spread;

use super::canvas::{Canvas, Colour, TEXT_HEIGHT, text_width};
use super::{BARS, CHART, DASH, FAINT, GAP, HEIGHT, INK, PAPER, RECOMMENDED, WIDTH};
use super::{failed, save, tick_step};
use crate::Error;

/// Bars between the ends of the scale.
const BINS: usize = 106;
/// The ends of the scale, in the distance within which 95 % lie.
const END: f64 = 1.5;

/// Draws how often each of some signed distances (mm) occurs as a PNG file, which appears only when it is
/// complete. What lies beyond the scale is in the outermost bars.
///
/// # Errors
/// [`Error::Picture`].
pub fn write_distances(path: &Path, signed_mm: &[f64]) -> Result<(), Error> {
    save(path, &drawn(signed_mm)).map_err(|source| failed(path, source))
}

fn drawn(signed_mm: &[f64]) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEIGHT, PAPER);
    let spread = Spread::of(signed_mm);
    // Equal surfaces have no distance; the picture has a scale all the same.
    let end_mm = (END * spread.p95_mm).max(1e-3);
    let mut counts = [0_u64; BINS];
    for distance in signed_mm {
        let part = 0.5 * (1.0 + distance / end_mm);
        counts[((part * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let most = counts.iter().max().copied().unwrap_or(0).max(1);
    let ([left, right], [top, bottom]) = CHART;
    let across = |part: f64| left + (part.clamp(0.0, 1.0) * (right - left) as f64).round() as usize;
    let column = |mm: f64| across(0.5 * (1.0 + mm / end_mm));
    let total = signed_mm.len().max(1) as f64;
    let row = |percent: f64| {
        let part = percent / (100.0 * most as f64 / total);
        bottom - (part.min(1.0) * (bottom - top) as f64).round() as usize
    };
    percent_ticks(&mut canvas, 100.0 * most as f64 / total, row);
    mm_ticks(&mut canvas, end_mm, column);
    for (bin, count) in counts.into_iter().enumerate() {
        let [from, to] = [bin, bin + 1].map(|edge| across(edge as f64 / BINS as f64));
        canvas.fill(
            [from, to],
            [row(100.0 * count as f64 / total), bottom],
            BARS,
        );
    }
    canvas.fill([left, right], [bottom, bottom + 2], INK);
    let mut mark = |mm: f64, colour: Colour, dashes: Option<usize>| {
        canvas.rule(column(mm), [top - TEXT_HEIGHT, bottom], colour, dashes);
    };
    mark(spread.signed_mean_mm, RECOMMENDED, None);
    mark(-spread.p95_mm, INK, Some(DASH));
    mark(spread.p95_mm, INK, Some(DASH));
    let lines = [
        (
            format!(
                "Distance to the reference at {} places, negative inside",
                signed_mm.len()
            ),
            INK,
        ),
        (
            format!(
                "mean {:+.4} mm, without signs {:.4} mm",
                spread.signed_mean_mm, spread.mean_mm
            ),
            RECOMMENDED,
        ),
        (
            format!(
                "95 % within {:.4} mm, at most {:.4} mm",
                spread.p95_mm, spread.max_mm
            ),
            INK,
        ),
    ];
    for (number, (line, colour)) in lines.iter().enumerate() {
        canvas.write(line, left, 10 + number * (TEXT_HEIGHT + GAP), *colour);
    }
    canvas
}

fn percent_ticks(canvas: &mut Canvas, most: f64, row: impl Fn(f64) -> usize) {
    let ([left, right], [top, _]) = CHART;
    let step = tick_step(most);
    let digits = decimals(step);
    let count = (most / step) as usize;
    for tick in (0..=count).map(|i| i as f64 * step) {
        let at = row(tick);
        canvas.fill([left, right], [at, at + 1], FAINT);
        let label = format!("{tick:.digits$}");
        let column = left.saturating_sub(text_width(&label) + GAP);
        canvas.write(&label, column, at - TEXT_HEIGHT / 2, INK);
    }
    canvas.write("%", GAP, top - TEXT_HEIGHT - GAP, INK);
}

fn mm_ticks(canvas: &mut Canvas, end_mm: f64, column: impl Fn(f64) -> usize) {
    let ([left, right], [top, bottom]) = CHART;
    let step = tick_step(2.0 * end_mm);
    let digits = decimals(step);
    let count = (end_mm / step) as i64;
    for tick in (-count..=count).map(|i| i as f64 * step) {
        let at = column(tick);
        canvas.fill([at, at + 1], [top, bottom], FAINT);
        canvas.fill([at, at + 1], [bottom, bottom + GAP], INK);
        let label = format!("{tick:.digits$}");
        canvas.write(&label, at - text_width(&label) / 2, bottom + GAP + 4, INK);
    }
    let middle = usize::midpoint(left, right);
    canvas.write(
        "mm",
        middle - text_width("mm") / 2,
        HEIGHT - TEXT_HEIGHT - GAP,
        INK,
    );
}

/// Digits behind the point that a step of ticks needs.
fn decimals(step: f64) -> usize {
    (-step.log10().floor()).clamp(0.0, 9.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(canvas: &Canvas, colour: Colour) -> usize {
        canvas.pixels().chunks(3).filter(|p| **p == colour).count()
    }

    #[test]
    fn bars_and_marks_are_where_the_distances_are() {
        let narrow: Vec<f64> = (0..1000).map(|i| f64::from(i % 10) * 0.01).collect();
        let picture = drawn(&narrow);
        assert!(pixels(&picture, BARS) > 1000);
        assert!(pixels(&picture, RECOMMENDED) > 500);
    }

    #[test]
    fn odd_distances_are_drawn_too() {
        for distances in [
            &[][..],
            &[0.0; 5],
            &[1e9, -1e-9],
            &[f64::NAN, 1.0],
            &[f64::INFINITY],
        ] {
            let _ = drawn(distances);
        }
    }
}
