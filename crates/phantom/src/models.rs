//! The thesis's models, drawn in pixels.
//!
//! Each is a binary image that is the same in every slice, drawn about the middle of the
//! matrix. Line and ring have the pixels that `OpenCV`'s `line` and `circle` give them, since the
//! thesis's counts of edge pixels depend on them.

mod ring;

use ndarray::{Array2, Array3};

use crate::PhantomError;

/// A binary image that is the same in every slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Model {
    Line,
    Ring,
    Cube,
    TwoCubes,
    CubeWithHole,
    Curved,
}

/// Half the line's width; its ends are discs of this radius.
const LINE_HALF: i32 = 10;
/// Side of a cube.
const CUBE: i32 = 100;
/// Side of the hole, and distance of the two cubes.
const HOLE: i32 = 50;
/// Side of the curved shape.
const CURVED: i32 = 256;
/// Its corner radii: top right, bottom right, bottom left; the fourth corner is sharp.
const CORNERS: [i32; 3] = [25, 50, 100];

impl Model {
    /// The image `[row, column]`, `true` in the model.
    pub(crate) fn draw(self, columns: usize, rows: usize) -> Result<Array2<bool>, PhantomError> {
        let needed = self.needed();
        if columns < needed || rows < needed {
            return Err(PhantomError::MatrixTooSmall {
                phantom: self.name(),
                needed,
                columns,
                rows,
            });
        }
        // Pixel coordinates relative to the middle of the matrix.
        let (x0, y0) = ((columns / 2) as i32, (rows / 2) as i32);
        let quarter = (rows / 4) as i32;
        Ok(Array2::from_shape_fn([rows, columns], |(row, column)| {
            let (x, y) = (column as i32 - x0, row as i32 - y0);
            match self {
                Self::Line => line(x, y, quarter),
                Self::Ring => ring::ring(x, y),
                Self::Cube => square(x, y, CUBE),
                Self::TwoCubes => {
                    let apart = i32::midpoint(CUBE, HOLE);
                    square(x - apart, y, CUBE) || square(x + apart, y, CUBE)
                }
                Self::CubeWithHole => square(x, y, CUBE) && !square(x, y, HOLE),
                Self::Curved => curved(x + CURVED / 2, y + CURVED / 2),
            }
        }))
    }

    /// Columns and rows that the model needs with a free pixel around it.
    fn needed(self) -> usize {
        match self {
            Self::Line => 48,
            Self::Ring => 314,
            Self::Cube | Self::CubeWithHole => 102,
            Self::TwoCubes => 252,
            Self::Curved => 264,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Ring => "cylinder",
            Self::Cube => "cube",
            Self::TwoCubes => "two-cubes",
            Self::CubeWithHole => "cube-with-hole",
            Self::Curved => "curved",
        }
    }
}

/// An upright line with round ends a quarter of the image's height above and below the middle.
fn line(x: i32, y: i32, quarter: i32) -> bool {
    let beyond = (y.abs() - quarter).max(0);
    x * x + beyond * beyond <= LINE_HALF * LINE_HALF
}

fn square(x: i32, y: i32, side: i32) -> bool {
    let inside = |v: i32| (-side / 2..side / 2).contains(&v);
    inside(x) && inside(y)
}

/// A square, counted from its top left corner, with three corners rounded.
fn curved(x: i32, y: i32) -> bool {
    let last = CURVED - 1;
    if !(0..=last).contains(&x) || !(0..=last).contains(&y) {
        return false;
    }
    let [top_right, bottom_right, bottom_left] = CORNERS;
    [
        (last - x, y, top_right),
        (last - x, last - y, bottom_right),
        (x, last - y, bottom_left),
    ]
    .into_iter()
    .all(|(across, down, radius)| {
        // Distances from the corner's two sides; the arc's centre lies `radius` from both.
        let (u, v) = (radius - across, radius - down);
        u <= 0 || v <= 0 || u * u + v * v <= radius * radius
    })
}

/// A stack `[slice, row, column]` of one of the thesis's models as a binary image.
///
/// # Errors
/// [`PhantomError::NoModel`] for a body that is not drawn in pixels,
/// [`PhantomError::MatrixTooSmall`].
pub fn model_images(
    phantom: crate::Phantom,
    [slices, rows, columns]: [usize; 3],
) -> Result<Array3<bool>, PhantomError> {
    let model = phantom.model().ok_or(PhantomError::NoModel(phantom))?;
    let image = model.draw(columns, rows)?;
    Ok(Array3::from_shape_fn(
        [slices, rows, columns],
        |(_, j, i)| image[[j, i]],
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FNV-1a of the image's pixels, 0 or 1, row by row.
    fn fingerprint(image: &Array2<bool>) -> u64 {
        image.iter().fold(0xcbf2_9ce4_8422_2325, |hash, pixel| {
            (hash ^ u64::from(*pixel)).wrapping_mul(0x0100_0000_01b3)
        })
    }

    fn count(image: &Array2<bool>) -> usize {
        image.iter().filter(|p| **p).count()
    }

    // The literals come from OpenCV 5.0: circle((256, 256), 150, thickness 10) and
    // line((256, 128), (256, 384), thickness 20) on 512 x 512 pixels. scikit-image 0.26 finds
    // 2,156 edge pixels in the former and 576 in the latter (as 0 and 255).
    #[test]
    fn ring_and_line_have_the_pixels_that_opencv_draws() {
        let ring = Model::Ring.draw(512, 512).unwrap();
        assert_eq!(
            (count(&ring), fingerprint(&ring)),
            (10_376, 0x92b5_f149_582b_2c91)
        );
        let line = Model::Line.draw(512, 512).unwrap();
        assert_eq!(
            (count(&line), fingerprint(&line)),
            (5_693, 0xa736_3552_6cbe_8e78)
        );
    }

    #[test]
    fn cubes_have_the_areas_of_their_names() {
        let area = |model: Model| count(&model.draw(512, 512).unwrap());
        assert_eq!(area(Model::Cube), 10_000);
        assert_eq!(area(Model::TwoCubes), 20_000);
        assert_eq!(area(Model::CubeWithHole), 7_500);
    }

    #[test]
    fn the_curved_shape_keeps_one_corner() {
        let image = Model::Curved.draw(512, 512).unwrap();
        let (first, last) = (256 - 128, 256 + 127);
        assert!(image[[first, first]]);
        assert!(!image[[first, last]] && !image[[last, last]] && !image[[last, first]]);
        assert!(image[[256, first]] && image[[256, last]] && image[[last, 256]]);
    }

    #[test]
    fn a_matrix_that_is_too_small_is_refused_with_the_size_needed() {
        let error = Model::Ring.draw(256, 512).unwrap_err();
        assert!(error.to_string().contains("needs 314"), "{error}");
    }
}
