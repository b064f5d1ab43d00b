//! Choices that a method has no use for are refused, before any work is done.

use crate::{AlphaRule, Error, Method, Settings};

/// Methods that start from edge points.
const OF_POINTS: [Method; 5] = [
    Method::Alpha,
    Method::BallPivoting,
    Method::Poisson,
    Method::Tetrahedra,
    Method::Planar,
];
/// Methods that start from voxels.
const OF_VOXELS: [Method; 2] = [Method::Isosurface, Method::Labelled];

/// Refuses what was chosen but says nothing to the method.
///
/// # Errors
/// [`Error::NotForMethod`] with the first such choice and the methods that have it.
pub(crate) fn refuse_unused(settings: &Settings) -> Result<(), Error> {
    settings.after_care.check()?;
    let usual = Settings::default();
    let has_alpha = settings.alpha_mm.is_some() || settings.alpha_rule != AlphaRule::default();
    let choices: [(bool, &str, &[Method]); 8] = [
        (settings.sampling.is_some(), "`sample`", &OF_POINTS),
        (settings.canny != usual.canny, "`sigma`", &OF_POINTS),
        (has_alpha, "`alpha`", &[Method::Alpha]),
        (
            settings.radii_mm.is_some(),
            "`radii`",
            &[Method::BallPivoting],
        ),
        (settings.depth != usual.depth, "`depth`", &[Method::Poisson]),
        (
            settings.scale.to_bits() != usual.scale.to_bits(),
            "`scale`",
            &[Method::Poisson],
        ),
        (
            settings.true_edges != usual.true_edges,
            "`at-threshold` (true_edges=False)",
            &OF_VOXELS,
        ),
        (
            settings.leave_out_table != usual.leave_out_table,
            "`keep-table`",
            &OF_VOXELS,
        ),
    ];
    let method = settings.method;
    let unused = choices
        .into_iter()
        .find(|(is_chosen, _, of)| *is_chosen && !of.contains(&method));
    match unused {
        None => Ok(()),
        Some((_, choice, of)) => Err(Error::NotForMethod {
            choice,
            method: method.name(),
            instead: named(of),
        }),
    }
}

/// Methods in a sentence.
pub(crate) fn named(methods: &[Method]) -> String {
    let names: Vec<String> = methods.iter().map(|m| format!("`{}`", m.name())).collect();
    names.join(" or ")
}

/// What is said of a choice that only solids have.
pub(crate) fn not_for_region(choice: &'static str, method: bonemesh_roi::Method) -> Error {
    Error::NotForMethod {
        choice,
        method: method.name(),
        instead: "`solid`".into(),
    }
}

/// What is said where only voxels would do and there is a cloud.
///
/// # Errors
/// Always [`Error::NotForMethod`].
pub(crate) fn no_cloud(method: Method) -> Error {
    Error::NotForMethod {
        choice: "a cloud",
        method: method.name(),
        instead: named(&OF_POINTS),
    }
}

#[cfg(test)]
mod tests {
    use bonemesh_segment::CannySettings;

    use super::*;

    #[test]
    fn the_defaults_suit_every_method() {
        for method in Method::ALL {
            let settings = Settings {
                method,
                ..Settings::default()
            };
            assert!(refuse_unused(&settings).is_ok());
        }
    }

    #[test]
    fn a_choice_is_refused_with_the_methods_that_have_it() {
        let usual = Settings::default();
        let sigma = CannySettings::new(2.0, usual.canny.low(), usual.canny.high());
        let chosen = [
            Settings {
                alpha_mm: Some(2.0),
                ..usual.clone()
            },
            Settings {
                alpha_rule: AlphaRule::BoneVolume,
                ..usual.clone()
            },
            Settings {
                radii_mm: Some(vec![1.0]),
                ..usual.clone()
            },
            Settings {
                depth: 5,
                ..usual.clone()
            },
            Settings {
                scale: 2.0,
                ..usual.clone()
            },
            Settings {
                canny: sigma.expect("2 is a sigma"),
                ..usual.clone()
            },
            Settings {
                true_edges: false,
                ..usual.clone()
            },
            Settings {
                leave_out_table: false,
                ..usual
            },
        ];
        for settings in chosen {
            let takes = |method: &Method| {
                let of_method = Settings {
                    method: *method,
                    ..settings.clone()
                };
                refuse_unused(&of_method).is_ok()
            };
            let able: Vec<Method> = Method::ALL.into_iter().filter(takes).collect();
            assert!(
                !able.is_empty() && able.len() < Method::ALL.len(),
                "{able:?}"
            );
            for method in Method::ALL.into_iter().filter(|m| !able.contains(m)) {
                let of_method = Settings {
                    method,
                    ..settings.clone()
                };
                let message = refuse_unused(&of_method)
                    .expect_err("it is unused")
                    .to_string();
                let is_named = |able: &Method| message.contains(&format!("`{}`", able.name()));
                assert!(able.iter().all(is_named), "{message}");
            }
        }
    }
}
