//! Does a collapse leave the surface near what its ends stand for?

use super::collapse::Surroundings;
use super::run::Run;
use crate::distance::is_within;
use crate::vector::Vector;

/// Part of a squared limit that the given vertices keep, since what lies between them may be further.
const SHARE: f64 = 0.7;

impl Run<'_> {
    /// Whether the given vertices that both ends stand for are near the triangles after the collapse,
    /// of which `surroundings` has the rim.
    ///
    /// This is cheap and spares most of the faults that would be found later, but proves nothing: the
    /// neighbours' given vertices, and what lies between them all, are not looked at.
    pub(super) fn stays_near(
        &self,
        surroundings: &Surroundings,
        [kept, gone]: [u32; 2],
        place: Vector,
    ) -> bool {
        let Some(points) = &self.points else {
            return true;
        };
        let at = |vertex: u32| self.vertices_mm[vertex as usize];
        let fan = surroundings.rim().map(|[q, r]| [place, at(q), at(r)]);
        let fan: Vec<[Vector; 3]> = fan.collect();
        let limit = SHARE * self.limit(kept, gone);
        let mut last = 0;
        let mut all = points.at(kept).chain(points.at(gone));
        all.all(|point| {
            let mut numbers = (last..fan.len()).chain(0..last);
            let found = numbers.find(|number| is_within(point, fan[*number], limit));
            // Points that come one after another are often near the same triangle.
            last = found.unwrap_or(last);
            found.is_some()
        })
    }
}
