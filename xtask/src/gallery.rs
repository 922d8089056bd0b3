//! docs/gallery.md: every wall file of examples/ with the drawing that the program makes of it.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::read;
use crate::{concio, examples};

const HEAD: &str = "\
# Gallery

<!-- Made by `cargo xtask docs`. -->

The walls of [examples/](../examples/README.md), drawn by `concio check FILE --svg OUT`. The comments in the files say what
they show. Lines are joints, coloured by kind; the block above is the top beam, what stands below the wall is its base.
";

/// The page and its pictures, as paths from the root with their content.
pub fn make(root: &Path) -> Result<Vec<(String, String)>, String> {
    let mut page = HEAD.to_string();
    let mut files = Vec::new();
    let scratch = root.join("target").join("gallery.svg");
    for wall in examples::wall_files(root)? {
        let name = wall.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = fs::read_to_string(&wall).map_err(|e| format!("{}: {e}", wall.display()))?;
        let mut check = Command::new(concio(root));
        read(check.arg("check").arg(&wall).arg("--svg").arg(&scratch).current_dir(root))?;
        let picture = fs::read_to_string(&scratch).map_err(|e| format!("{}: {e}", scratch.display()))?;
        let title = title(&text);
        page += &format!("\n## [{title}](../examples/{name}.toml)\n\n![drawing](img/{name}.svg)\n");
        files.push((format!("docs/img/{name}.svg"), picture));
    }
    files.push(("docs/gallery.md".into(), page));
    Ok(files)
}

fn title(text: &str) -> &str {
    let titles = text.lines().filter_map(|l| l.strip_prefix("title = \""));
    titles.filter_map(|t| t.strip_suffix('"')).next().unwrap_or("Untitled")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_is_that_of_the_key() {
        assert_eq!(title("# Not this\nmodel = \"planar\"\ntitle = \"Brick panel\"\n"), "Brick panel");
        assert_eq!(title("model = \"planar\"\n"), "Untitled");
    }
}
