//! A folder with a wall, and studies of that wall.

use std::path::PathBuf;

use concio::case::{Document, Syntax};
use concio_study::{Plan, StudyFile};

/// The folder, gone at the end of the test.
pub struct Desk(tempfile::TempDir);

impl Desk {
    /// With this wall in `wall.toml`.
    pub fn new(wall: &str) -> Self {
        let desk = Desk(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(desk.path("wall.toml"), wall).expect("a wall file");
        desk
    }

    /// The plan of a study, as if it stood in `study.toml`.
    pub fn plan(&self, study: &str) -> concio::Result<Plan> {
        Plan::of(StudyFile::of(Document::parse(study, Syntax::Toml, Some(&self.path("study.toml")))?)?)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}
