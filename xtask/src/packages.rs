//! The crates that are published: in the order of their dependencies, each with what a reader of crates.io needs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Deserialize;

use crate::command::{Outcome, cargo, read};

/// Files that each has to hold.
const FILES: [&str; 3] = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"];
/// Keywords that crates.io takes at most.
const MOST_KEYWORDS: usize = 5;

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    description: Option<String>,
    keywords: Vec<String>,
    categories: Vec<String>,
    /// Registries; empty where it is not to be published.
    publish: Option<Vec<String>>,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
    /// `dev`, `build` or nothing.
    kind: Option<String>,
    req: String,
    /// Where it lies if it is of this workspace.
    path: Option<String>,
}

/// Checks them all and names them in order; or prints the order alone (`--order`), or their version (`--version`).
pub fn make(root: &Path, rest: &[String]) -> Outcome {
    let packages = published(root)?;
    let order = order(&packages)?;
    match rest {
        [] => check(root, &packages, &order),
        [what] if what == "--order" => {
            order.iter().for_each(|name| println!("{name}"));
            Ok(())
        }
        [what] if what == "--version" => {
            println!("{}", version(root)?);
            Ok(())
        }
        _ => Err("cargo xtask packages takes --order, --version or nothing".into()),
    }
}

/// The version that all of them have.
pub fn version(root: &Path) -> Result<String, String> {
    let versions: BTreeSet<String> = published(root)?.into_iter().map(|p| p.version).collect();
    match Vec::from_iter(versions).as_slice() {
        [one] => Ok(one.clone()),
        several => Err(format!("the crates have several versions: {}", several.join(", "))),
    }
}

fn check(root: &Path, packages: &[Package], order: &[String]) -> Outcome {
    let mut wrong = Vec::new();
    for package in packages {
        let name = &package.name;
        let told = package.description.as_deref().unwrap_or_default();
        if told.is_empty() || package.keywords.is_empty() || package.categories.is_empty() {
            wrong.push(format!("{name} lacks its description, keywords or categories"));
        }
        if package.keywords.len() > MOST_KEYWORDS {
            wrong.push(format!("{name} has {} keywords, at most {MOST_KEYWORDS}", package.keywords.len()));
        }
        if packages.iter().any(|p| p.name != *name && p.description == package.description) {
            wrong.push(format!("{name} has the description of another crate"));
        }
        let list = read(cargo(root).args(["package", "--list", "--allow-dirty", "--package", name]))?;
        let missing = FILES.iter().filter(|file| !list.lines().any(|line| line == **file));
        wrong.extend(missing.map(|file| format!("{name} would be published without {file}")));
    }
    if !wrong.is_empty() {
        return Err(wrong.join("\n"));
    }
    println!("{} crates of version {} in order: {}", order.len(), version(root)?, order.join(", "));
    Ok(())
}

fn published(root: &Path) -> Result<Vec<Package>, String> {
    let text = read(cargo(root).args(["metadata", "--no-deps", "--format-version", "1", "--locked"]))?;
    let metadata: Metadata = serde_json::from_str(&text).map_err(|e| format!("cargo metadata: {e}"))?;
    Ok(metadata.packages.into_iter().filter(|p| p.publish.as_ref().is_none_or(|to| !to.is_empty())).collect())
}

/// The names, each after all that it depends on. A crate that depends on one which is not published has no place.
fn order(packages: &[Package]) -> Result<Vec<String>, String> {
    let mut left: BTreeMap<&str, BTreeSet<&str>> =
        packages.iter().map(|p| (p.name.as_str(), p.needed().collect())).collect();
    let mut order: Vec<String> = Vec::new();
    while !left.is_empty() {
        let ready: Vec<&str> = left
            .iter()
            .filter(|(_, needs)| needs.iter().all(|n| order.iter().any(|o| o == n)))
            .map(|(n, _)| *n)
            .collect();
        if ready.is_empty() {
            let stuck: Vec<String> = left.iter().map(|(name, needs)| format!("{name} needs {needs:?}")).collect();
            return Err(format!("of these crates one is not published or they need each other: {}", stuck.join("; ")));
        }
        for name in ready {
            left.remove(name);
            order.push(name.into());
        }
    }
    Ok(order)
}

impl Package {
    /// Crates of this workspace that it cannot be published without. For tests alone and without a version, they are left out.
    fn needed(&self) -> impl Iterator<Item = &str> {
        let needed = |d: &&Dependency| d.path.is_some() && !(d.kind.as_deref() == Some("dev") && d.req == "*");
        self.dependencies.iter().filter(needed).map(|d| d.name.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, needs: &[(&str, Option<&str>, &str)]) -> Package {
        let dependency = |&(name, kind, req): &(&str, Option<&str>, &str)| Dependency {
            name: name.into(),
            kind: kind.map(str::to_string),
            req: req.into(),
            path: Some("here".into()),
        };
        Package {
            name: name.into(),
            version: "1.0.0".into(),
            description: None,
            keywords: Vec::new(),
            categories: Vec::new(),
            publish: None,
            dependencies: needs.iter().map(dependency).collect(),
        }
    }

    #[test]
    fn what_a_crate_needs_stands_before_it() {
        let packages = [
            package("a", &[("c", None, "^1"), ("b", Some("build"), "^1")]),
            package("b", &[("c", None, "^1"), ("tests", Some("dev"), "*")]),
            package("c", &[]),
        ];
        assert_eq!(order(&packages), Ok(vec!["c".into(), "b".into(), "a".into()]));
    }

    #[test]
    fn a_crate_that_needs_an_unpublished_one_has_no_place() {
        let why = order(&[package("a", &[]), package("b", &[("own", None, "^1")])]).unwrap_err();
        assert!(why.contains("b needs {\"own\"}") && !why.contains("a needs"), "{why}");
        assert!(order(&[package("b", &[("own", Some("dev"), "^1")])]).is_err());
        assert!(order(&[package("a", &[("b", None, "^1")]), package("b", &[("a", None, "^1")])]).is_err());
    }
}
