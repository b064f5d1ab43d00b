//! Each command: call the library, say what came of it.

use std::path::Path;
use std::time::Instant;

use bonemesh_cloud::{read_cloud, write_cloud};
use bonemesh_mesh::{check_values_target, read_mesh, write_with_values};
use bonemesh_phantom::write_phantom;
use bonemesh_task::{Task, pool};
use serde_json::json;

use super::arguments::{Check, CloudArguments, Command, Info, MeshArguments, Render};
use super::mesh_file::FileArguments;
use super::output::Answer;
use super::phantom::PhantomArguments;
use super::{after_care, check_text, compare, histogram, region, text};
use crate::render::{Rendered, mesh_cloud, point_cloud, render};
use crate::source::{Reading, Source};
use crate::thresholds::choose_threshold;
use crate::{Error, Settings, check_walls};

/// The property of a file's vertices with the thickness of the wall.
const WALLS: &str = "wall_mm";

/// Runs `command`.
pub(super) fn run(command: &Command, task: &Task) -> Result<Answer, Error> {
    match command {
        Command::Info(arguments) => info(arguments, task),
        Command::Histogram(arguments) => histogram::run(arguments, task),
        Command::Render(arguments) => run_render(arguments, task),
        Command::Cloud(arguments) => run_cloud(arguments, task),
        Command::Mesh(arguments) => run_mesh(arguments, task),
        Command::Roi(arguments) => region::cut(arguments, task),
        Command::Mirror(arguments) => region::mirror(arguments, task),
        Command::Check(arguments) => run_check(arguments, task),
        Command::Compare(arguments) => compare::run(arguments, task),
        Command::Repair(arguments) => after_care::run(arguments, task),
        Command::Phantom(arguments) => run_phantom(arguments, task),
    }
}

fn info(arguments: &Info, task: &Task) -> Result<Answer, Error> {
    let contents = pool(None)?.install(|| {
        let source = Source::open(&arguments.directory, arguments.one_series, task)?;
        if arguments.pixels {
            source.decoded_contents(task)
        } else {
            Ok(source.contents().clone())
        }
    })?;
    Ok(Answer::new(&contents, text::contents(&contents)))
}

fn run_render(arguments: &Render, task: &Task) -> Result<Answer, Error> {
    arguments.file.check(&arguments.output)?;
    let rendered = render(&arguments.directory, &arguments.settings()?, task)?;
    save(rendered, &arguments.output, &arguments.file, task)
}

fn run_mesh(arguments: &MeshArguments, task: &Task) -> Result<Answer, Error> {
    arguments.file.check(&arguments.output)?;
    let cloud = read_cloud(&arguments.cloud)?;
    let settings = Settings {
        threads: arguments.threads,
        ..arguments.surface.settings(true)
    };
    let rendered = mesh_cloud(&cloud, &settings, task)?;
    save(rendered, &arguments.output, &arguments.file, task)
}

fn save(
    rendered: Rendered,
    output: &Path,
    file: &FileArguments,
    task: &Task,
) -> Result<Answer, Error> {
    let Rendered { mesh, mut report } = rendered;
    let clock = Instant::now();
    file.write(output, &mesh, &report, task)?;
    report.written(clock.elapsed().as_secs_f64());
    let answer = Answer::new(&report, text::rendered(&report, output));
    Ok(answer.with("output", output.to_string_lossy()))
}

fn run_cloud(arguments: &CloudArguments, task: &Task) -> Result<Answer, Error> {
    bonemesh_cloud::check_target(&arguments.output)?;
    let settings = arguments.edges.settings(None)?;
    let workers = pool(settings.threads)?;
    let Reading { volume, series } = workers.install(|| {
        let source = Source::open(&arguments.directory, settings.one_series, task)?;
        source.read(settings.series.as_ref(), task)
    })?;
    let chosen = choose_threshold(&volume, &settings, task)?;
    let settings = chosen.of(&settings);
    let cloud = point_cloud(&volume, &settings, arguments.frame.into(), task)?;
    write_cloud(&cloud, &arguments.output)?;
    let points = cloud.points_mm().len();
    let text = format!(
        "{}\n{}  {points} points\n",
        arguments.output.display(),
        text::threshold(
            chosen.threshold.hu(),
            settings.local_leeway_hu,
            chosen.reason.as_deref()
        )
    );
    let report = json!({
        "points": points,
        "threshold_hu": chosen.threshold.hu(),
        "threshold_reason": chosen.reason,
        "local_leeway_hu": settings.local_leeway_hu,
        "output": arguments.output.to_string_lossy(),
        "warnings": series.warnings,
    });
    Ok(Answer::new(&report, text))
}

fn run_check(arguments: &Check, task: &Task) -> Result<Answer, Error> {
    if let Some(path) = &arguments.walls {
        check_values_target(path)?;
    }
    let mesh = read_mesh(&arguments.mesh, task)?;
    let checked = check_walls(&mesh, arguments.threads, task)?;
    let answer = Answer::new(
        &checked.report,
        check_text::checked(&checked.report, &arguments.mesh),
    );
    let Some(path) = &arguments.walls else {
        return Ok(answer);
    };
    if checked.walls_mm.is_empty() {
        return Err(Error::NoWalls { path: path.clone() });
    }
    write_with_values(path, &checked.mesh, WALLS, &checked.walls_mm, task)?;
    Ok(answer.with("walls", path.to_string_lossy()))
}

fn run_phantom(arguments: &PhantomArguments, task: &Task) -> Result<Answer, Error> {
    let settings = arguments.settings();
    let written = pool(None)?
        .install(|| write_phantom(arguments.name, &arguments.directory, &settings, task))?;
    let text = format!(
        "{}\n  {} slices\n{}\n  what is known of the body\n",
        written.series.display(),
        written.files.len(),
        written.truth.display()
    );
    let report = json!({
        "series": written.series.to_string_lossy(),
        "slices": written.files.len(),
        "truth": written.truth.to_string_lossy(),
    });
    Ok(Answer::new(&report, text))
}
