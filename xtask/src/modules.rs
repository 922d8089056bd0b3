//! Circles between the modules of a crate: modules side by side in one folder that need each other, directly or through others.
//!
//! A module and what lies in its folder count as one where others use them. What only tests use does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

use crate::command::Outcome;

/// Where a module is: names from the root of its crate on.
type Place = Vec<String>;

/// What one module says: what it uses, by path, and what it hands on under a name of its own.
#[derive(Default)]
struct Module {
    file: PathBuf,
    uses: BTreeSet<Vec<String>>,
    hands_on: BTreeMap<String, Vec<String>>,
}

type Crate = BTreeMap<Place, Module>;

/// Fails where modules of a crate go in circles, naming what ties each.
pub fn check(root: &Path) -> Outcome {
    let mut folders: Vec<PathBuf> = fs::read_dir(root.join("crates"))
        .map_err(|e| e.to_string())?
        .filter_map(|entry| Some(entry.ok()?.path().join("src")))
        .collect();
    folders.sort();
    let (mut circles, mut modules) = (Vec::new(), 0);
    for folder in folders {
        let top = ["lib.rs", "main.rs"].map(|name| folder.join(name)).into_iter().find(|file| file.exists());
        let Some(top) = top else { continue };
        let mut parts = Crate::new();
        read(&top, Vec::new(), &mut parts)?;
        modules += parts.len();
        circles.extend(circles_of(&parts).into_iter().map(|circle| {
            let folder = folder.strip_prefix(root).unwrap_or(&folder);
            format!("{}: {circle}", folder.display())
        }));
    }
    println!("{modules} modules, {} circles", circles.len());
    if circles.is_empty() { Ok(()) } else { Err(circles.join("\n")) }
}

/// Reads a module from its file, and those below it.
fn read(file: &Path, place: Place, parts: &mut Crate) -> Outcome {
    let text = fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let parsed = syn::parse_file(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    below(file, &place, parsed.items, parts)
}

fn below(file: &Path, place: &Place, items: Vec<Item>, parts: &mut Crate) -> Outcome {
    let mut reader = Reader { module: Module { file: file.to_path_buf(), ..Module::default() }, children: Vec::new() };
    reader.children = items
        .iter()
        .filter_map(|item| if let Item::Mod(m) = item { Some(m.ident.to_string()) } else { None })
        .collect();
    let mut inner = Vec::new();
    for item in items {
        match item {
            Item::Mod(own) => inner.push(own),
            other => reader.visit_item(&other),
        }
    }
    parts.insert(place.clone(), reader.module);
    let folder = file.parent().unwrap_or(file);
    let named = matches!(file.file_name().and_then(|n| n.to_str()), Some("lib.rs" | "main.rs" | "mod.rs"));
    let folder = if named { folder.to_path_buf() } else { file.with_extension("") };
    for ItemMod { attrs, ident, content, .. } in inner {
        if only_for_tests(&attrs) {
            continue;
        }
        let mut place = place.clone();
        place.push(ident.to_string());
        if let Some((_, items)) = content {
            below(file, &place, items, parts)?;
            continue;
        }
        let files = [folder.join(format!("{ident}.rs")), folder.join(ident.to_string()).join("mod.rs")];
        let file = files.into_iter().find(|file| file.exists());
        read(&file.ok_or_else(|| format!("no file of module {}", place.join("::")))?, place, parts)?;
    }
    Ok(())
}

fn only_for_tests(attrs: &[Attribute]) -> bool {
    attrs.iter().any(|a| a.path().is_ident("test") || a.path().is_ident("cfg") && quoted(a) == "test")
}

fn quoted(attr: &Attribute) -> String {
    attr.meta.require_list().map(|list| list.tokens.to_string()).unwrap_or_default()
}

/// Gathers the paths that a module names.
struct Reader {
    module: Module,
    children: Vec<String>,
}

impl Reader {
    /// Paths that begin at the crate, here, above or in a module below.
    fn see(&mut self, path: Vec<String>) {
        let known = ["crate", "self", "super"].contains(&path[0].as_str()) || self.children.contains(&path[0]);
        if path.len() > 1 && known {
            self.module.uses.insert(path);
        }
    }

    fn tree(&mut self, tree: &UseTree, mut path: Vec<String>, public: bool) {
        match tree {
            UseTree::Path(step) => {
                path.push(step.ident.to_string());
                self.tree(&step.tree, path, public);
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.tree(tree, path.clone(), public)),
            UseTree::Name(_) | UseTree::Rename(_) | UseTree::Glob(_) => {
                let (name, own) = match tree {
                    UseTree::Name(name) => (name.ident.to_string(), name.ident.to_string()),
                    UseTree::Rename(name) => (name.ident.to_string(), name.rename.to_string()),
                    _ => ("*".into(), "*".into()),
                };
                if name != "self" {
                    path.push(name);
                }
                if public {
                    self.module.hands_on.insert(own, path.clone());
                }
                if !path.is_empty() {
                    self.see(path);
                }
            }
        }
    }

    /// Within macros no paths are parsed: names that follow `crate` and `super`.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    let starts = ["crate", "super"].contains(&ident.to_string().as_str());
                    if starts && path.is_empty() || !path.is_empty() {
                        path.push(ident.to_string());
                    }
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => {}
                TokenTree::Group(group) => {
                    self.tokens(group.stream());
                    self.end(&mut path);
                }
                _ => self.end(&mut path),
            }
        }
        self.end(&mut path);
    }

    fn end(&mut self, path: &mut Vec<String>) {
        if !path.is_empty() {
            self.see(std::mem::take(path));
        }
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_item(&mut self, item: &'a Item) {
        let attrs = match item {
            Item::Fn(f) => &f.attrs,
            Item::Impl(i) => &i.attrs,
            Item::Use(u) => &u.attrs,
            Item::Const(c) => &c.attrs,
            Item::Struct(s) => &s.attrs,
            _ => &Vec::new(),
        };
        if !only_for_tests(attrs) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        self.tree(&item.tree, Vec::new(), !matches!(item.vis, Visibility::Inherited));
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        self.see(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, own: &'a Macro) {
        self.tokens(own.tokens.clone());
    }
}

/// The module that a path named in `place` ends in, through those that hand it on.
fn home(parts: &Crate, place: &Place, path: &[String], depth: usize) -> Option<Place> {
    let (mut at, mut rest) = (place.clone(), path);
    loop {
        match rest.first()?.as_str() {
            "crate" => at.clear(),
            "super" => {
                at.pop()?;
            }
            "self" => {}
            _ => break,
        }
        rest = &rest[1..];
    }
    while let Some(name) = rest.first() {
        let mut next = at.clone();
        next.push(name.clone());
        if !parts.contains_key(&next) {
            break;
        }
        (at, rest) = (next, &rest[1..]);
    }
    let handed = rest.first().filter(|_| depth < 8).and_then(|name| parts.get(&at)?.hands_on.get(name));
    match handed {
        Some(path) => home(parts, &at, path, depth + 1).or(Some(at)),
        None => Some(at),
    }
}

/// Circles among modules side by side, each told with what ties it.
fn circles_of(parts: &Crate) -> Vec<String> {
    // Above which folder, and from which of its modules to which: what is named by it.
    let mut arrows: BTreeMap<Place, BTreeMap<(String, String), BTreeSet<String>>> = BTreeMap::new();
    for (place, module) in parts {
        for path in &module.uses {
            let Some(to) = home(parts, place, path, 0) else { continue };
            let shared = place.iter().zip(&to).take_while(|(a, b)| a == b).count();
            if let (Some(from), Some(to)) = (place.get(shared), to.get(shared)) {
                let file = module.file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                let named = path.last().map_or("", |name| name.as_str());
                let ties = arrows.entry(place[..shared].to_vec()).or_default().entry((from.clone(), to.clone()));
                ties.or_default().insert(format!("{named} in {file}"));
            }
        }
    }
    let mut found = Vec::new();
    for (folder, arrows) in &arrows {
        let reaches = |from: &String| {
            let (mut seen, mut todo) = (BTreeSet::new(), vec![from]);
            while let Some(at) = todo.pop() {
                for (a, b) in arrows.keys().filter(|(a, _)| a == at) {
                    if a != b && seen.insert(b) {
                        todo.push(b);
                    }
                }
            }
            seen
        };
        let names: BTreeSet<&String> = arrows.keys().flat_map(|(a, b)| [a, b]).collect();
        let reached: BTreeMap<&String, BTreeSet<&String>> = names.iter().map(|name| (*name, reaches(name))).collect();
        let mut told = BTreeSet::new();
        for name in names.iter().filter(|name| reached[*name].contains(*name)) {
            let circle: BTreeSet<&String> = names
                .iter()
                .filter(|other| reached[*name].contains(*other) && reached[*other].contains(*name))
                .copied()
                .collect();
            if !told.insert(circle.clone()) {
                continue;
            }
            let ties = arrows.iter().filter(|((a, b), _)| circle.contains(a) && circle.contains(b));
            let ties: Vec<String> = ties
                .map(|((a, b), names)| {
                    format!("    {a} → {b}: {}", Vec::from_iter(names.iter().map(String::as_str)).join(", "))
                })
                .collect();
            let members: Vec<&str> = circle.iter().map(|name| name.as_str()).collect();
            let at = if folder.is_empty() { "modules".into() } else { folder.join("::") };
            found.push(format!("{at}: {} in a circle\n{}", members.join(", "), ties.join("\n")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(text: &str) -> Vec<String> {
        let mut parts = Crate::new();
        let items = syn::parse_file(text).expect("Rust").items;
        below(Path::new("lib.rs"), &Vec::new(), items, &mut parts).expect("modules");
        circles_of(&parts)
    }

    /// Two modules that need each other are a circle; one that needs both is none of it.
    #[test]
    fn circles_are_found() {
        let found = circles(
            "mod a { use crate::b::B; } mod b { use super::a; fn f() { a::g(); } } mod c { use crate::{a, b}; }",
        );
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("modules: a, b in a circle"), "{found:?}");
        // Through a third one, and in what a macro is given.
        let found =
            circles("mod a { use crate::b::B; } mod b { fn f() { m!(crate::c::C) } } mod c { use crate::a::A; }");
        assert!(found[0].starts_with("modules: a, b, c in a circle"), "{found:?}");
        // Below another module.
        let found = circles("mod a { mod x { use super::y::Y; } mod y { use crate::a::x::X; } }");
        assert!(found[0].starts_with("a: x, y in a circle"), "{found:?}");
    }

    /// What is handed on counts where it stands; what only tests use does not count.
    #[test]
    fn arrows_that_run_down_are_none() {
        assert!(
            circles("mod a { pub struct A; } mod b { pub use crate::a::A; } mod c { use crate::b::A; }").is_empty()
        );
        let handed = "mod a { use crate::b::C; } mod b { pub use crate::c::C; } mod c { use crate::a::A; }";
        assert!(circles(handed)[0].starts_with("modules: a, c in a circle"));
        let tested = "mod a { use crate::b::B; } mod b { #[cfg(test)] mod tests { use crate::a::A; } }";
        assert!(circles(tested).is_empty());
    }
}
