//! What the research report's Figures 22 to 27 show of its cases, drawn from our runs.

use std::fs;
use std::path::Path;

use concio::Error;
use concio::case::JointKind;
use concio::run;
use concio::store::{StoredRun, hdf5};

use super::walls::Which;
use concio_cli::args::Figure;
use concio_cli::failure::Failure;
use concio_cli::figures::{self, Data, Options};
use concio_cli::files;

/// The last cycle of the drive [s]: the research report leaves the transient out of its portraits too.
const PORTRAIT: [Option<f64>; 2] = [Some(0.2), None];

/// Draws them into `out/figures`; the runs are those in `out`.
///
/// # Errors
/// Results that cannot be read, a folder that cannot be written.
pub fn draw(out: &Path) -> Result<(), Failure> {
    let folder = out.join("figures");
    fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, e))?;
    for which in Which::ALL.into_iter().filter(|w| *w != Which::Control) {
        let run = hdf5::read(&out.join(which.name()).join(run::RESULT))?;
        let mut shown = vec![Figure::Deformed, Figure::Phase, Figure::JointHistories];
        if matches!(which, Which::One | Which::Two) {
            shown.extend([Figure::Acceleration, Figure::PeakAcceleration]);
        }
        for figure in shown {
            let drawing = one(&run, figure)?;
            let svg = drawing.outlined().map_err(|why| Failure::Other(why.to_string(), None))?;
            files::write(&folder.join(format!("{}-{}.svg", which.name(), figure.name())), &svg)?;
        }
    }
    Ok(())
}

fn one(run: &StoredRun, figure: Figure) -> Result<concio_cli::draw::output::Drawing, Failure> {
    let window = if figure == Figure::Phase { PORTRAIT } else { [None; 2] };
    let data = Data::new(run, window)?;
    let sampled =
        run.outcome.layout.channels.iter().filter_map(|c| c.name.strip_prefix("joint/")?.strip_suffix("/slip"));
    let head = |name: &&str| run.joints.iter().any(|j| j.name == *name && j.joint.kind == JointKind::Head);
    let joints = sampled.filter(head).map(str::to_string).collect();
    Ok(figures::draw(figure, &data, &Options { joints, ..Options::default() })?)
}
