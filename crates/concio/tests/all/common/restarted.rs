//! Runs that are taken up again and again.

use concio::outcome::Outcome;
use concio::record::Recording;
use concio::run::Prepared;
use concio::simulate::{Progress, Simulation};

/// A run that is saved and restored into a new simulation after `first` steps, then after `next` of them, and so on.
pub fn restarted(p: &Prepared, first: u64, next: impl Fn(u64) -> u64) -> Outcome {
    let new = || Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    let (mut run, mut rows, mut stride) = (new(), Recording::default(), first);
    let reason = loop {
        let progress = run.advance(stride);
        rows.append(run.recording());
        run.clear_recording();
        if let Progress::Ended(reason) = progress {
            break reason;
        }
        let bytes = run.save();
        run = new();
        assert!(run.restore(&bytes));
        stride = next(stride);
    };
    run.outcome(rows, reason)
}
