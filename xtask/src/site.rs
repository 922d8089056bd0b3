//! The site of the documents: pages that exist anyway, laid out for Sphinx under target/site (docs/decisions/0015-site.md).

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use crate::command::{Outcome, read, run};
use crate::{links, report_ui};

/// Settings and pinned packages of Sphinx.
const SETTINGS: &str = "xtask/site";
/// Pages from outside of docs/ and their names on the site.
const PAGES: [(&str, &str); 5] = [
    ("README.md", "index.md"),
    ("CHANGELOG.md", "changelog.md"),
    ("ARCHITECTURE.md", "architecture.md"),
    ("CONTRIBUTING.md", "contributing.md"),
    ("SUPPORT.md", "support.md"),
];
/// Navigation: captions, and the pages below them in their order. Sphinx fails where a page of docs/ is in none.
const SECTIONS: [(&str, &[&str]); 9] = [
    ("Start", &["guide/01-install", "guide/02-first-run", "gallery"]),
    ("Guide", &["guide/README", "guide/0[3-9]*", "guide/1*"]),
    ("Reference", &["cli", "wall-file", "results", "figures", "symbols", "system"]),
    ("Python", &["python/walls", "python/records", "python/runs", "python/studies", "python/*"]),
    ("Theory", &["theory", "planar", "limit-analysis", "mechanisms", "continuum", "constrained", "negative-slope"]),
    ("Studies", &["studies", "studies/analyses", "studies/*", "report-cases"]),
    ("Numbers checked", &["verification", "performance"]),
    ("How to", &["howto/*", "contributing", "support"]),
    ("Decisions", &["architecture", "changelog", "decisions/*"]),
];
/// A word that a reader may search for, and a page that has to be among those found.
const SEARCH: [&str; 2] = ["friction", "theory.html"];

/// Builds the site, on which no link is broken, and opens it in a browser.
pub fn make(root: &Path) -> Outcome {
    let Some(python) = environment(root)? else {
        crate::command::skip("site of the documents (it needs Python 3.11 with venv, and a package index)");
        return Ok(());
    };
    let folder = root.join("target/site");
    let pages = folder.join("pages");
    if pages.exists() {
        fs::remove_dir_all(&pages).map_err(|e| format!("{}: {e}", pages.display()))?;
    }
    let count = lay_out(root, &pages)?;
    let html = folder.join("html");
    let mut sphinx = Command::new(python);
    sphinx.args([
        "-m",
        "sphinx",
        "--quiet",
        "--fail-on-warning",
        "--keep-going",
        "--jobs",
        "auto",
        "--builder",
        "html",
    ]);
    sphinx.arg("--conf-dir").arg(root.join(SETTINGS)).arg("--doctree-dir").arg(folder.join("doctrees"));
    sphinx.args(["--define", concat!("html_theme_options.repository_url=", env!("CARGO_PKG_REPOSITORY"))]);
    run(sphinx.arg(&pages).arg(&html))?;
    println!("{count} pages: {}", html.join("index.html").display());
    open(&html)
}

/// The interpreter of the site's own environment, which is made anew where its packages are others; `None` where it cannot be had.
fn environment(root: &Path) -> Result<Option<PathBuf>, String> {
    let folder = root.join("target/venv-site");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let wanted = root.join(SETTINGS).join("requirements.txt");
    let packages = fs::read(&wanted).map_err(|e| format!("{}: {e}", wanted.display()))?;
    let installed = folder.join("requirements.txt");
    if fs::read(&installed).is_ok_and(|found| found == packages) {
        return Ok(Some(python));
    }
    if read(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder)).is_err() {
        return Ok(None);
    }
    let mut install = Command::new(&python);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"]).arg(&wanted);
    if read(&mut install).is_err() {
        return Ok(None);
    }
    fs::write(&installed, packages).map_err(|e| format!("{}: {e}", installed.display()))?;
    Ok(Some(python))
}

/// Writes the pages and their pictures into a folder, links between them as they lie there; how many pages.
fn lay_out(root: &Path, into: &Path) -> Result<usize, String> {
    let mut files: Vec<String> = PAGES.iter().map(|(file, _)| (*file).into()).collect();
    collect(root, "docs", &mut files)?;
    collect(root, "xtask/site/python", &mut files)?;
    let mut count = 0;
    for file in &files {
        let Some(place) = place(file) else { continue };
        let (from, to) = (root.join(file), into.join(&place));
        let failed = |e: std::io::Error| format!("{file}: {e}");
        fs::create_dir_all(to.parent().unwrap_or(into)).map_err(failed)?;
        if !file.ends_with(".md") {
            fs::copy(&from, &to).map_err(failed)?;
            continue;
        }
        count += 1;
        let text = fs::read_to_string(&from).map_err(failed)?;
        let mut page = links::relinked(&text, |target| moved(root, file, &place, target))?;
        if place == "index.md" {
            page += &navigation();
        }
        fs::write(&to, page).map_err(failed)?;
    }
    Ok(count)
}

/// Files below a folder, by their paths from the root.
fn collect(root: &Path, folder: &str, files: &mut Vec<String>) -> Outcome {
    let entries = fs::read_dir(root.join(folder)).map_err(|e| format!("{folder}: {e}"))?;
    for entry in entries.filter_map(Result::ok) {
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() { collect(root, &path, files)? } else { files.push(path) }
    }
    Ok(())
}

/// Where a file of the tree lies on the site, if it is part of it.
fn place(file: &str) -> Option<String> {
    let outside = PAGES.iter().find(|(name, _)| *name == file).map(|(_, place)| (*place).to_string());
    let shown = [".md", ".svg", ".png"].iter().any(|ending| file.ends_with(ending));
    // Pages that Sphinx fills with the docstrings of the package for Python.
    let filled = file.strip_prefix("xtask/site/").filter(|page| page.ends_with(".rst"));
    outside.or_else(|| file.strip_prefix("docs/").filter(|_| shown).or(filled).map(str::to_string))
}

/// A link of a document as it has to be on the site: to a page there, else to the file in the repository.
fn moved(root: &Path, file: &str, at: &str, target: &str) -> Result<String, String> {
    if target.contains("://") || target.starts_with("mailto:") || target.starts_with('#') {
        return Ok(target.into());
    }
    let (path, heading) = target.split_once('#').map_or((target, String::new()), |(p, h)| (p, format!("#{h}")));
    let goal = normal(&format!("{}/{path}", folder(file)));
    if let Some(place) = place(&goal) {
        let up = "../".repeat(at.matches('/').count());
        return Ok(format!("{up}{place}{heading}"));
    }
    let kind = match root.join(&goal) {
        path if path.is_dir() => "tree",
        path if path.is_file() => "blob",
        _ => return Err(format!("{file}: ({target}) is not there")),
    };
    Ok(format!("{}/{kind}/main/{goal}{heading}", env!("CARGO_PKG_REPOSITORY")))
}

fn folder(file: &str) -> &str {
    file.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// A path without `.` and `..`, with slashes.
fn normal(path: &str) -> String {
    let mut parts: Vec<String> = Vec::new();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    parts.join("/")
}

/// The navigation as Sphinx reads it, at the end of the first page.
fn navigation() -> String {
    let section = |(caption, pages): &(&str, &[&str])| {
        format!("\n```{{toctree}}\n:hidden:\n:glob:\n:caption: {caption}\n\n{}\n```\n", pages.join("\n"))
    };
    SECTIONS.iter().map(section).collect()
}

/// Opens the first page and a search in a browser.
fn open(html: &Path) -> Outcome {
    let Some(browser) = report_ui::browser() else {
        crate::command::skip("the site in a browser (no chromium; CHROMIUM names one elsewhere)");
        return Ok(());
    };
    let html = html.canonicalize().map_err(|e| format!("{}: {e}", html.display()))?;
    let shown = |page: &str| {
        let mut chromium = Command::new(&browser);
        chromium.args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
        ]);
        chromium.args(["--virtual-time-budget=20000", "--dump-dom"]);
        // A profile of its own: browsers that share one wait for each other.
        chromium.arg(format!("--user-data-dir={}", html.with_file_name("browser").display()));
        read(chromium.arg(format!("file://{}/{page}", html.display())))
    };
    let first = shown("index.html")?;
    if !first.contains("<h1>Concio") || !first.contains("guide/01-install.html") {
        return Err("the site's first page shows no heading or no navigation in a browser".into());
    }
    let [word, page] = SEARCH;
    let found = shown(&format!("search.html?q={word}"))?;
    let (_, results) = found.split_once("id=\"search-results\"").ok_or("the site has no page of results")?;
    let count = results.matches("<li").count();
    if !results.contains(page) {
        return Err(format!("the site's search for {word} does not find {page}: {count} results"));
    }
    println!("in a browser the site's search finds {word} on {count} pages");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_page_or_to_the_repository() {
        let root = crate::root();
        let link = |file: &str, target: &str| moved(&root, file, &place(file).unwrap(), target);
        assert_eq!(link("README.md", "docs/guide/README.md"), Ok("guide/README.md".into()));
        assert_eq!(link("docs/guide/02-first-run.md", "../cli.md#concio-run"), Ok("../cli.md#concio-run".into()));
        assert_eq!(link("docs/howto/add-a-texture.md", "../../CHANGELOG.md"), Ok("../changelog.md".into()));
        assert_eq!(link("docs/theory.md", "#1-wall"), Ok("#1-wall".into()));
        let at = |kind: &str, path: &str| Ok(format!("{}/{kind}/main/{path}", env!("CARGO_PKG_REPOSITORY")));
        assert_eq!(
            link("docs/guide/02-first-run.md", "../../examples/17-arch.toml"),
            at("blob", "examples/17-arch.toml")
        );
        assert_eq!(link("ARCHITECTURE.md", "docs/decisions/"), at("tree", "docs/decisions"));
        assert!(link("README.md", "docs/no-such.md.toml").is_err());
    }

    #[test]
    fn navigation_has_every_section() {
        let text = navigation();
        assert_eq!(text.matches("{toctree}").count(), SECTIONS.len());
        assert!(text.contains(":caption: Theory\n\ntheory\nplanar\n"), "{text}");
    }
}
