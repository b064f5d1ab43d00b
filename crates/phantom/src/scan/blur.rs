//! Point-spread function of the scanner: a Gaussian in the slice.

/// Standard deviations at which the Gaussian is cut off.
const REACH: f64 = 4.0;

/// Blurs an image of `columns` x `rows` pixels; beyond the border its pixels repeat.
pub(super) fn gaussian(image: &mut [f32], columns: usize, rows: usize, sigma_px: f64) {
    let weights = weights(sigma_px);
    if weights.len() == 1 {
        return;
    }
    let reach = weights.len() / 2;
    let mut padded = vec![0.0; columns + 2 * reach];
    for line in image.chunks_exact_mut(columns) {
        padded[..reach].fill(line[0]);
        padded[reach..reach + columns].copy_from_slice(line);
        padded[reach + columns..].fill(line[columns - 1]);
        for (value, window) in line.iter_mut().zip(padded.windows(weights.len())) {
            *value = window.iter().zip(&weights).map(|(v, w)| v * w).sum();
        }
    }
    let source = image.to_vec();
    for (row, line) in image.chunks_exact_mut(columns).enumerate() {
        line.fill(0.0);
        for (tap, weight) in weights.iter().enumerate() {
            let from = (row + tap).saturating_sub(reach).min(rows - 1) * columns;
            for (value, v) in line.iter_mut().zip(&source[from..from + columns]) {
                *value += weight * v;
            }
        }
    }
}

/// Sampled Gaussian of sum 1; a single 1 where it is too narrow to matter.
fn weights(sigma: f64) -> Vec<f32> {
    if sigma < 0.05 {
        return vec![1.0];
    }
    let reach = (REACH * sigma).ceil() as i32;
    let raw: Vec<f64> = (-reach..=reach)
        .map(|i| (-0.5 * (f64::from(i) / sigma).powi(2)).exp())
        .collect();
    let sum: f64 = raw.iter().sum();
    raw.into_iter().map(|w| (w / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_spreads_as_a_gaussian_and_keeps_its_sum() {
        let (columns, rows, sigma) = (41, 31, 2.0);
        let mut image = vec![0.0_f32; columns * rows];
        image[15 * columns + 20] = 1000.0;
        gaussian(&mut image, columns, rows, sigma);
        let (mut sum, mut spread) = (0.0, 0.0);
        for (i, v) in image.iter().enumerate() {
            let x = (i % columns) as f64 - 20.0;
            sum += f64::from(*v);
            spread += f64::from(*v) * x * x;
        }
        assert!((sum - 1000.0).abs() < 0.01);
        assert!((spread / sum - sigma * sigma).abs() < 0.02);
    }

    #[test]
    fn an_even_image_stays_even_up_to_its_border() {
        let mut image = vec![-1000.0_f32; 70];
        gaussian(&mut image, 10, 7, 1.3);
        assert!(image.iter().all(|v| (v + 1000.0).abs() < 0.01));
    }
}
