//! A folder to type commands in.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use snapbox::cmd::Command;

/// A wall that takes a moment: four courses of two bricks, the top driven until the joints slip.
pub const WALL: &str = r#"title = "Small wall"
model = "shear"

[[panel]]
bond = "running"
courses = 4
bricks = 2
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }

[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 1000 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }

[load]
top = "10 kN/m"
beam = "driven"

[motion]
duration = "0.05 s"
top = { sine = { amplitude = "2 mm", frequency = "2 Hz", ramp = "0.05 s" } }
"#;

/// An empty folder, gone at the end of the test.
pub struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    /// With [`WALL`] in `wall.toml`.
    pub fn new() -> Desk {
        let desk = Desk { folder: tempfile::tempdir().expect("a temporary folder") };
        desk.put("wall.toml", WALL);
        desk
    }
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
    pub fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder in the temporary folder");
        std::fs::write(path, text).expect("a file in the temporary folder");
    }
    pub fn get(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("a text file in the temporary folder")
    }
    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.get(name)).expect("JSON")
    }
    /// Everything that lies in the folder.
    pub fn list(&self) -> Vec<String> {
        let names = std::fs::read_dir(self.folder.path()).expect("the temporary folder");
        let mut names: Vec<String> =
            names.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
    /// `concio` with arguments as they are typed, parted by blanks.
    pub fn concio(&self, line: &str) -> Command {
        concio(self.folder.path()).args(line.split_whitespace())
    }
}

fn concio(folder: &Path) -> Command {
    Command::new(PROGRAM).current_dir(folder).env("NO_COLOR", "1").env_remove("RUST_BACKTRACE")
}

/// Anything that differs from one run of a test to the next: the moments of its kills are meant to.
pub fn chance() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("a clock after 1970");
    u64::from(now.subsec_nanos()).wrapping_mul(6_364_136_223_846_793_005) >> 33
}

/// The program under test.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_concio");
