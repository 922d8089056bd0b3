//! The interactive report: its bundle is what its sources build to, and it shows the numbers of the result.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{Outcome, read, run};
use crate::concio;

/// Sources of the page's program, and where its bundle lies.
const SOURCES: &str = "report-ui";
const BUNDLE: &str = "crates/concio-cli/src/report/app";
/// Oldest Node.js that the tools run on.
const OLDEST_NODE: [u32; 2] = [20, 19];

/// Builds the bundle into the tree.
pub fn build(root: &Path) -> Outcome {
    match install(root)? {
        Ok(()) => bundle(root, &root.join(BUNDLE)),
        Err(why) => Err(format!("the report cannot be built here: {why}")),
    }
}

/// Types, unit tests, the committed bundle against a fresh one, and the report in a browser.
pub fn check(root: &Path) -> Outcome {
    if let Err(why) = install(root)? {
        crate::command::skip(&format!("interactive report ({why})"));
        return Ok(());
    }
    let fresh = root.join("target").join("report-ui");
    bundle(root, &fresh)?;
    for name in ["app.js", "app.css"] {
        let bytes = |folder: &Path| fs::read(folder.join(name)).map_err(|e| format!("{name}: {e}"));
        if bytes(&fresh)? != bytes(&root.join(BUNDLE))? {
            return Err(format!(
                "{BUNDLE}/{name} is not what {SOURCES}/ builds to: run `cargo xtask report-ui`, commit it"
            ));
        }
    }
    println!("{BUNDLE} is current");
    run(npm(root).args(["run", "--silent", "unit"]))?;
    let Some(browser) = browser() else {
        crate::command::skip("the report in a browser (no chromium; CHROMIUM names one elsewhere)");
        return Ok(());
    };
    run(npm(root).args(["run", "--silent", "browser"]).env("CHROMIUM", browser).env("CONCIO", concio(root)))
}

fn bundle(root: &Path, into: &Path) -> Outcome {
    run(npm(root).args(["run", "--silent", "build"]).env("CONCIO_REPORT_OUT", into))
}

/// Installs what the sources need, exactly as it is locked; or why that is not possible on this machine.
fn install(root: &Path) -> Result<Result<(), String>, String> {
    let Ok(version) = read(Command::new("node").arg("--version")) else {
        return Ok(Err("no node".into()));
    };
    if !is_new_enough(&version) {
        let [major, minor] = OLDEST_NODE;
        return Ok(Err(format!("node {} is older than {major}.{minor}", version.trim())));
    }
    let ci = npm(root).args(["ci", "--no-audit", "--no-fund", "--loglevel=error"]).output();
    match ci {
        Ok(output) if output.status.success() => Ok(Ok(())),
        // A lock file that contradicts package.json is a mistake in the tree; a registry out of reach is not.
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            if said.contains("EUSAGE") { Err(said) } else { Ok(Err("npm ci does not work here".into())) }
        }
        Err(_) => Ok(Err("no npm".into())),
    }
}

fn is_new_enough(version: &str) -> bool {
    let mut parts = version.trim().trim_start_matches('v').split('.').map_while(|p| p.parse::<u32>().ok());
    let found = [parts.next().unwrap_or(0), parts.next().unwrap_or(0)];
    found >= OLDEST_NODE
}

fn npm(root: &Path) -> Command {
    let mut command = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    command.current_dir(root.join(SOURCES));
    command
}

/// `CHROMIUM`, else where the system keeps it.
pub fn browser() -> Option<PathBuf> {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    named.or_else(|| Some("/usr/bin/chromium".into())).filter(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_node() {
        assert!(is_new_enough("v20.20.2\n") && is_new_enough("v22.0.0"));
        assert!(!is_new_enough("v20.18.9") && !is_new_enough("v18.20.0") && !is_new_enough(""));
    }
}
