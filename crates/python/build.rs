//! Collects the licences that travel in the wheel: ours, and the notices of every crate compiled
//! into the extension module.
//!
//! They go to `OUT_DIR/licenses`, from where the wheel takes them. The texts come from the crates'
//! own sources as cargo unpacked them, so nothing is fetched, nothing is out of date and the same
//! lock file gives the same bytes.
//!
//! A crate without a licence file in its package is listed with what its manifest says.

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Beginnings of the names of files that hold a licence or a notice, in lower case.
const NOTICE_FILES: [&str; 7] = [
    "license",
    "licence",
    "copying",
    "copyright",
    "notice",
    "unlicense",
    // The licence of the Independent JPEG Group's code is a part of its read-me.
    "readme.ijg",
];

fn main() -> Result<()> {
    bind_own_symbols();
    // Asked when it runs: a cached build of this script may come from a checkout elsewhere.
    let workspace = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../..");
    println!("cargo::rerun-if-changed=build.rs");
    println!(
        "cargo::rerun-if-changed={}",
        workspace.join("Cargo.lock").display()
    );
    let folder = PathBuf::from(env::var("OUT_DIR")?).join("licenses");
    fs::create_dir_all(&folder)?;
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let file = workspace.join(name);
        println!("cargo::rerun-if-changed={}", file.display());
        fs::copy(&file, folder.join(name))?;
    }
    let metadata = metadata(&workspace)?;
    let notices = notices(&shipped_packages(&metadata)?)?;
    fs::write(folder.join("THIRD_PARTY_LICENSES.txt"), notices)?;
    Ok(())
}

/// Makes calls inside of the module stay inside of it, where the loader would let others in.
///
/// The JPEG 2000 decoder has the C names of `OpenJPEG`'s own library. In a program that is linked with that
/// library, as distributions build Blender, the loader would give ours the other's functions, whose
/// structures are laid out differently: nothing is decoded, or the program dies.
fn bind_own_symbols() {
    let is_elf = env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux");
    if is_elf {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-Bsymbolic");
    }
}

/// What cargo knows of the packages and of who needs whom, for the platform that is built for.
fn metadata(workspace: &Path) -> Result<Value> {
    let ask = |more: &[&str]| -> Result<std::process::Output> {
        Ok(Command::new(env::var("CARGO")?)
            .args(["metadata", "--format-version", "1", "--filter-platform"])
            .arg(env::var("TARGET")?)
            .args(more)
            .current_dir(workspace)
            .output()?)
    };
    // Offline is enough after any whole build; a first build may not have unpacked the crates
    // that only tests need, which cargo wants to see nevertheless.
    let mut answer = ask(&["--offline"])?;
    if !answer.status.success() {
        answer = ask(&[])?;
    }
    if !answer.status.success() {
        let reason = String::from_utf8_lossy(&answer.stderr).into_owned();
        return Err(format!("cargo metadata failed: {reason}").into());
    }
    Ok(serde_json::from_slice(&answer.stdout)?)
}

/// The packages of others that become part of the extension module, in the order of their names.
fn shipped_packages(metadata: &Value) -> Result<Vec<&Value>> {
    let nodes: BTreeMap<&str, &Value> = list(&metadata["resolve"]["nodes"])?
        .iter()
        .filter_map(|node| Some((node["id"].as_str()?, node)))
        .collect();
    let packages = list(&metadata["packages"])?;
    let own = packages
        .iter()
        .find(|p| p["name"] == env!("CARGO_PKG_NAME"))
        .and_then(|p| p["id"].as_str())
        .ok_or("cargo metadata does not list this package")?;
    let mut shipped = BTreeSet::new();
    let mut open = vec![own];
    while let Some(id) = open.pop() {
        if !shipped.insert(id) {
            continue;
        }
        for dependency in list(&nodes[id]["deps"])? {
            // Build scripts and tests stay behind; a `null` kind is what is linked.
            let linked = list(&dependency["dep_kinds"])?
                .iter()
                .any(|kind| kind["kind"].is_null());
            if let (true, Some(id)) = (linked, dependency["pkg"].as_str()) {
                open.push(id);
            }
        }
    }
    let mut found: Vec<&Value> = packages
        .iter()
        .filter(|p| !p["source"].is_null())
        .filter(|p| p["id"].as_str().is_some_and(|id| shipped.contains(id)))
        .collect();
    found.sort_by_key(|p| (p["name"].to_string(), p["version"].to_string()));
    Ok(found)
}

/// One list of all packages, then every text once, under the packages that it belongs to.
fn notices(packages: &[&Value]) -> Result<String> {
    let mut text = String::from(
        "Bonemesh's extension module contains the following packages, each under its own licence,\n\
         and the Rust standard library (MIT OR Apache-2.0, The Rust Project Contributors). Where a\n\
         package offers a choice and brings no text, its authors' terms are the Apache License 2.0,\n\
         which stands below.\n\n",
    );
    let mut holders: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages {
        let name = format!("{} {}", plain(&package["name"]), plain(&package["version"]));
        let files = notice_files(package)?;
        let place = plain(&package["repository"]);
        writeln!(text, "{name}: {} {place}", plain(&package["license"]))?;
        if files.is_empty() {
            let authors: Vec<&str> = list(&package["authors"])?
                .iter()
                .filter_map(Value::as_str)
                .collect();
            writeln!(
                text,
                "    (no licence file in the package; authors: {})",
                authors.join(", ")
            )?;
        }
        for file in files {
            let notice = String::from_utf8_lossy(&fs::read(file)?).replace("\r\n", "\n");
            let names = holders.entry(notice.trim().to_owned()).or_default();
            if names.last() != Some(&name) {
                names.push(name.clone());
            }
        }
    }
    let mut notices: Vec<_> = holders
        .into_iter()
        .map(|(text, names)| (names, text))
        .collect();
    notices.sort();
    for (names, notice) in notices {
        writeln!(
            text,
            "\n{}\n{}\n\n{notice}",
            "=".repeat(80),
            names.join(", ")
        )?;
    }
    Ok(text)
}

/// Licence and notice files at the top of a package, and at the top of the folders in it, where
/// the sources of C and C++ libraries lie; in the order of their names.
fn notice_files(package: &Value) -> Result<Vec<PathBuf>> {
    let manifest = plain(&package["manifest_path"]);
    let folder = Path::new(&manifest)
        .parent()
        .ok_or("a manifest lies in a folder")?;
    let mut files = notices_in(folder)?;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(notices_in(&path)?);
        }
    }
    files.sort();
    Ok(files)
}

fn notices_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path
            .file_name()
            .map(|n| n.to_string_lossy().to_lowercase())
            .unwrap_or_default();
        let source = Path::new(&name).extension().is_some_and(|e| e == "rs");
        if path.is_file() && !source && NOTICE_FILES.iter().any(|n| name.starts_with(n)) {
            files.push(path);
        }
    }
    Ok(files)
}

fn list(value: &Value) -> Result<&Vec<Value>> {
    value
        .as_array()
        .ok_or_else(|| "cargo metadata has another shape than expected".into())
}

fn plain(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}
