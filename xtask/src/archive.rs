//! What a user downloads: the program, its man pages, the completions of shells, the licences, in one file.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::{Outcome, read, run};
use crate::{concio, concio_dev, packages};

/// Documents of the root that go with the program.
const DOCUMENTS: [&str; 5] = ["README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE-APACHE", "LICENSE-MIT"];
/// Shells, and how the files are called where they look for completions.
const SHELLS: [(&str, &str); 5] = [
    ("bash", "concio.bash"),
    ("elvish", "concio.elv"),
    ("fish", "concio.fish"),
    ("powershell", "_concio.ps1"),
    ("zsh", "_concio"),
];

/// Writes `concio-VERSION-TARGET.tar.gz`, on Windows `.zip`, into target/archive.
pub fn make(root: &Path) -> Outcome {
    let said = read(Command::new("rustc").arg("-vV"))?;
    let target = said.lines().find_map(|l| l.strip_prefix("host: ")).ok_or("rustc -vV names no host")?;
    let name = format!("concio-{}-{target}", packages::version(root)?);
    let into = root.join("target/archive");
    let folder = into.join(&name);
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(failed)?;
    }
    fs::create_dir_all(folder.join("completions")).map_err(failed)?;
    let program = concio(root);
    let file = program.file_name().ok_or("the program has no name")?;
    fs::copy(&program, folder.join(file)).map_err(|e| format!("{}: {e}", program.display()))?;
    for document in DOCUMENTS {
        fs::copy(root.join(document), folder.join(document)).map_err(|e| format!("{document}: {e}"))?;
    }
    for (shell, file) in SHELLS {
        let script = read(Command::new(&program).args(["completions", shell]))?;
        fs::write(folder.join("completions").join(file), script).map_err(failed)?;
    }
    man(root, &folder.join("man"))?;
    let ending = if cfg!(windows) { "zip" } else { "tar.gz" };
    let archive = into.join(format!("{name}.{ending}"));
    // The `tar` of Windows is bsdtar, which writes what the ending says.
    let mut tar = Command::new("tar");
    tar.current_dir(&into).arg(if cfg!(windows) { "-acf" } else { "-czf" }).arg(&archive).arg(&name);
    run(&mut tar)?;
    println!("{}", archive.display());
    Ok(())
}

/// Writes the man pages into a folder.
pub fn man(root: &Path, into: &Path) -> Outcome {
    run(Command::new(concio_dev(root)).arg("man").arg(into))
}
