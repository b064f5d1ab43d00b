//! Metal in a volume: told of every rendering, its streaks damped on request.

use std::borrow::Cow;

use bonemesh_metal::{Metal, Streaks, damp_metal, find_metal};
use bonemesh_task::Task;
use bonemesh_volume::Volume;
use serde::Serialize;

use crate::{Error, Settings};

/// Cubic millimetres in a cubic centimetre.
const MM3_PER_CM3: f64 = 1000.0;

/// What is said of the metal in a volume.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MetalReport {
    /// Pieces that do not touch.
    pub pieces: usize,
    /// Their volume as the scan shows it; metal blooms, so it has less.
    pub volume_mm3: f64,
    /// First and last slice with metal, counted from 0 as the volume is stored.
    pub slices: [usize; 2],
    /// Where it is in the patient: lowest and highest z.
    pub z_mm: [f64; 2],
    /// Spread of soft tissue in slices with metal, streaks and noise; `None` where there is nothing
    /// to compare it with.
    pub spread_hu: Option<f64>,
    /// The same in slices near by without metal.
    pub spread_without_hu: Option<f64>,
    /// The spread in slices with metal after damping; `None` if nothing was damped.
    pub spread_damped_hu: Option<f64>,
    /// Whether the streaks were damped.
    pub damped: bool,
}

impl MetalReport {
    fn of(metal: &Metal) -> Self {
        Self {
            pieces: metal.pieces,
            volume_mm3: metal.volume_mm3,
            slices: metal.slices,
            z_mm: metal.z_mm,
            spread_hu: metal.streaks.map(|s| s.with_metal_hu),
            spread_without_hu: metal.streaks.map(|s| s.without_hu),
            spread_damped_hu: None,
            damped: false,
        }
    }

    fn damped(self, after: Option<Streaks>) -> Self {
        Self {
            spread_damped_hu: after.map(|s| s.with_metal_hu),
            damped: true,
            ..self
        }
    }

    /// In words, in one line.
    fn note(&self) -> String {
        let volume_cm3 = self.volume_mm3 / MM3_PER_CM3;
        let [first, last] = self.slices;
        let [low, high] = self.z_mm;
        let place = format!(
            "metal: {volume_cm3:.2} cm3 in slices {first} to {last} (z {low:.1} to {high:.1} mm)"
        );
        let streaks = match (self.spread_hu, self.spread_without_hu) {
            (Some(with), Some(without)) => format!(
                "; streaks and noise spread soft tissue by {with:.0} HU there, by {without:.0} HU without"
            ),
            _ => String::new(),
        };
        let damped = match self.spread_damped_hu {
            Some(after) => format!(", by {after:.0} HU after damping"),
            None if self.damped => "; its streaks were damped".to_owned(),
            None => String::new(),
        };
        let is_worse = matches!((self.spread_hu, self.spread_damped_hu), (Some(before), Some(after)) if after > before);
        let remedy = if is_worse {
            "; damping did no good here: render without it"
        } else if self.damped {
            "; the surface beside it is still less true than elsewhere"
        } else {
            "; the surface in these slices, most of all beside the metal, is less true than elsewhere (--damp-metal damps streaks)"
        };
        format!("{place}{streaks}{damped}{remedy}")
    }
}

/// What is to be said of metal, if anything is.
pub(crate) fn note(metal: Option<MetalReport>, settings: &Settings) -> Option<String> {
    match metal {
        Some(metal) => Some(metal.note()),
        None if settings.damp_metal => {
            Some("no metal was found, so there were no streaks to damp".to_owned())
        }
        None => None,
    }
}

/// The volume to work on and what is to be said of its metal: damped if the `settings` say so.
pub(crate) fn without_streaks<'a>(
    volume: &'a Volume,
    settings: &Settings,
    task: &Task,
) -> Result<(Cow<'a, Volume>, Option<MetalReport>), Error> {
    let Some(metal) = find_metal(volume, task)? else {
        return Ok((Cow::Borrowed(volume), None));
    };
    let [first, last] = metal.slices;
    let is_used = |slices: &std::ops::Range<usize>| first < slices.end && last >= slices.start;
    if !settings
        .crop
        .as_ref()
        .is_none_or(|crop| is_used(&crop.slices))
    {
        return Ok((Cow::Borrowed(volume), None));
    }
    let report = MetalReport::of(&metal);
    if !settings.damp_metal {
        return Ok((Cow::Borrowed(volume), Some(report)));
    }
    let damped = damp_metal(volume, &metal, task)?;
    let after = find_metal(&damped, task)?.and_then(|metal| metal.streaks);
    Ok((Cow::Owned(damped), Some(report.damped(after))))
}
