//! First cracking: the search, its tables, its figure, its words.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use concio::case::CaseFile;
use concio::run::Control;
use concio_study::Runner;
use concio_study::first_crack::{Answer, Question, Subject, Trial, keep, search};
use concio_study::limits::counts_deformation;
use concio_study::runner::Progress;
use concio_study::table::{self, Table};
use concio_study::warned::{self, Warned};
use serde_json::{Value, json};

use super::asked;
use super::bars::{Bar, Bars, bars};
use super::page::{Figure, Section, shown};
use crate::draw::output::Drawing;
use crate::failure::{Failure, STOPPED};
use crate::format::{columns, counted, si, significant};
use crate::progress::Runs;
use crate::warned::warn_of_runs;
use crate::{files, stop};

/// Which of the runs are done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Do {
    /// This share of the motions: the i-th of n, from 1.
    Share([usize; 2]),
    /// None: tables and report are written of what the folder has.
    Report,
    /// None: what the folder has is told.
    Tell,
}

/// What is asked of which walls, and where it is kept.
pub struct Request<'a> {
    /// Heading of the report.
    pub title: &'a str,
    /// Lines at its head.
    pub facts: Vec<(&'static str, String)>,
    /// What was run: the first section of the report.
    pub first: Section,
    /// The question.
    pub question: &'a Question,
    /// The walls under their motions.
    pub subjects: &'a [Subject],
    /// The folder.
    pub out: &'a Path,
    /// Threads; 0 for one per core.
    pub threads: usize,
    /// The wall file.
    pub wall: &'a CaseFile,
    /// What was warned of before.
    pub known: Warned,
}

/// Searches, writes tables and report, prints the answers.
pub fn answer(request: &Request, what: Do) -> Result<ExitCode, Failure> {
    let Request { question, subjects, .. } = request;
    let complete = match what {
        Do::Share([share, of]) => {
            let mine: Vec<Subject> = subjects.iter().skip(share - 1).step_by(of).cloned().collect();
            let Some(answers) = found(request, &mine, false, true)? else {
                files::note("stopped early; the same command goes on from here");
                return Ok(ExitCode::from(STOPPED));
            };
            if mine.len() == subjects.len() { Some(answers) } else { found(request, subjects, true, false)? }
        }
        Do::Report | Do::Tell => found(request, subjects, true, what == Do::Tell)?,
    };
    if let Some(answers) = &complete {
        warn_of_runs(request.wall, &warned(answers).sentences(&request.known));
    }
    let Some(answers) = complete else {
        let shared = matches!(what, Do::Share(_));
        files::note(if shared {
            "the other motions are left to other shards"
        } else {
            "not all runs are done yet: `concio study run` goes on"
        });
        return Ok(if what == Do::Report { ExitCode::from(STOPPED) } else { ExitCode::SUCCESS });
    };
    if what == Do::Tell {
        return files::print(&lines(question, &answers)).map(|()| ExitCode::SUCCESS);
    }
    let elastic = deforms(question, subjects)?;
    let path = write(request, &answers, elastic)?;
    files::print(&format!("{}\nopen {}\n", lines(question, &answers), path.display()))?;
    if elastic {
        files::note(&format!("note: {DEFORMATION}"));
    }
    let whole = answers.iter().all(|a| a.crack().is_some() && a.cause.is_none());
    Ok(if whole { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// What the runs of all motions warn of.
fn warned(answers: &[Answer]) -> Warned {
    let mut warned = Warned::default();
    for answer in answers {
        for trial in &answer.trials {
            warned.add(|| format!("{} at scale {}", answer.name, shown(trial.scale)), &trial.warnings);
        }
    }
    warned
}

/// The answers; none when the user, or `known_only` where runs are missing, stopped the search. What the folder holds that does
/// not count is told with `tell`.
fn found(
    request: &Request,
    subjects: &[Subject],
    known_only: bool,
    tell: bool,
) -> Result<Option<Vec<Answer>>, Failure> {
    let bar = Runs::default();
    let watch = |progress: &Progress| {
        if stop::asked() {
            return Control::Stop;
        }
        bar.show(progress);
        Control::Continue
    };
    let mut runner = Runner::open(request.out, &keep(), request.threads, &watch)?;
    runner.reading = known_only;
    if tell {
        super::tell_passed_over(runner.store(), 0);
    }
    let answers = search(request.question, subjects, &mut runner.until(request.question.rule));
    bar.clear();
    Ok(answers?)
}

/// Said of criterion `slip` where joints have springs.
const DEFORMATION: &str = "criterion slip compares the whole displacement of a joint's sides along each other with the limit: \
                           what its spring gives way elastically counts as well as what slides";

/// Whether elastic deformation counts for what is asked of these walls.
fn deforms(question: &Question, subjects: &[Subject]) -> concio::Result<bool> {
    let Some(subject) = subjects.first() else { return Ok(false) };
    let model = concio::run::prepare_case(subject.case.clone(), Path::new(""))?.model;
    Ok(counts_deformation(&model, &question.rule))
}

fn write(request: &Request, answers: &[Answer], elastic: bool) -> Result<PathBuf, Failure> {
    let (question, out) = (request.question, request.out);
    let (summary, runs) = (summary(question, answers), all_runs(answers));
    // A closed form has made no run, and no folder for one.
    std::fs::create_dir_all(out).map_err(|e| concio::Error::io(out, e))?;
    table::write_csv(&summary, &out.join("first-crack.csv"))?;
    table::write_csv(&runs, &out.join("first-crack-runs.csv"))?;
    let text =
        serde_json::to_string_pretty(&json(request, answers)).map_err(|e| Failure::Other(e.to_string(), None))?;
    files::write(&out.join("first-crack.json"), &(text + "\n"))?;
    let mut facts = request.facts.clone();
    facts.push(("criterion", criterion(question)));
    facts.push(("interval", format!("{} %", shown(100.0 * question.interval))));
    let mut text = words(question, answers);
    if elastic {
        text.push(format!("Note: {DEFORMATION}."));
    }
    let (doubts, doubted) = asked::warning_table(&warned(answers)).unzip();
    text.splice(0..0, doubts);
    facts.push(("runs with warnings", warned(answers).runs.to_string()));
    let tables = vec![("First cracks".into(), summary), (ALL_RUNS.into(), runs)];
    let section = Section {
        title: "First cracking".into(),
        text,
        figures: figure(answers).into_iter().map(|drawing| Figure {
            name: "first-crack".into(),
            caption: "First crack by motion: factor on the motion, its peak acceleration, and the spectral acceleration of the \
                      wall's first mode. The dark end of a bar is the interval between two runs.".into(),
            drawing,
        }).collect(),
        tables: doubted.into_iter().chain(tables).collect(),
        ..Section::default()
    };
    super::tell_others(out, super::Kind::FirstCrack);
    super::write(out, request.title, &facts, &[&request.first, &section])
}

fn criterion(question: &Question) -> String {
    let name = question.rule.criterion.name();
    question.rule.limit.map_or(name.into(), |limit| format!("{name}, {}", si(limit, "m")))
}

/// What stands above the table of all runs.
const ALL_RUNS: &str = "All runs; utilisation is the largest demand over limit of a joint. In planar walls it leaves out how joints \
                        turn, and is below 1 at a crack; of rigid joints it is not known";

/// One line per motion.
fn summary(question: &Question, answers: &[Answer]) -> Table {
    let mut table = Table::default();
    let text = |pick: &dyn Fn(&Answer) -> Option<String>| answers.iter().map(pick).collect::<Vec<_>>();
    let number = |pick: &dyn Fn(&Answer) -> Option<f64>| answers.iter().map(pick).collect::<Vec<_>>();
    let at_crack = |pick: fn(&Answer) -> Option<f64>| {
        answers.iter().map(move |a| Some(a.crack()?.scale * pick(a)?)).collect::<Vec<_>>()
    };
    table.texts("motion", text(&|a| Some(a.name.clone())));
    table.texts("joint", text(&|a| a.crack().map(|t| t.joint.clone())));
    table.texts("kind", text(&|a| a.crack().map(|t| t.kind.to_string())));
    table.numbers("time", "s", number(&|a| a.crack()?.time));
    table.numbers("scale_below", "", number(&|a| Some(a.below()?.scale)));
    table.numbers("scale", "", number(&|a| Some(a.crack()?.scale)));
    table.numbers("pga_below", "m/s²", number(&|a| Some(a.below()?.scale * a.shaking.pga)));
    table.numbers("pga", "m/s²", at_crack(|a| Some(a.shaking.pga)));
    table.numbers("pgv", "m/s", at_crack(|a| Some(a.shaking.pgv)));
    table.numbers("period", "s", number(&|a| Some(a.mode?.period)));
    table.numbers("damping", "", number(&|a| Some(a.mode?.damping)));
    table.numbers("sa_period", "m/s²", at_crack(|a| a.shaking.at_first));
    table.numbers("sa_period_damped", "m/s²", at_crack(|a| a.shaking.at_first_damped));
    for (k, period) in question.periods.iter().enumerate() {
        let at = number(&|a| Some(a.crack()?.scale * a.shaking.sa.get(k)?));
        table.numbers(format!("sa_{period}s"), "m/s²", at);
    }
    table.numbers("utilisation_below", "", number(&|a| Some(a.below()?.utilisation)));
    table.texts("lower_scales", text(&|a| Some(a.checked.iter().map(|s| shown(*s)).collect::<Vec<_>>().join(" "))));
    table.numbers("uncracked_above", "", number(&|a| Some(a.uncracked_above().len() as f64)));
    table.numbers("runs", "", number(&|a| Some(a.trials.len() as f64)));
    table.texts("cause", text(&|a| a.cause.clone()));
    table
}

/// One line per run.
fn all_runs(answers: &[Answer]) -> Table {
    let all: Vec<(&Answer, &Trial)> = answers.iter().flat_map(|a| a.trials.iter().map(move |t| (a, t))).collect();
    let text = |pick: &dyn Fn(&Answer, &Trial) -> String| all.iter().map(|(a, t)| Some(pick(a, t))).collect::<Vec<_>>();
    let mut table = Table::default();
    table.texts("motion", text(&|a, _| a.name.clone()));
    table.numbers("scale", "", all.iter().map(|(_, t)| Some(t.scale)).collect());
    table.numbers("pga", "m/s²", all.iter().map(|(a, t)| Some(t.scale * a.shaking.pga)).collect());
    table.texts("cracked", text(&|_, t| if t.cracked { "yes" } else { "no" }.into()));
    table.numbers("utilisation", "", all.iter().map(|(_, t)| Some(t.utilisation)).collect());
    table.texts("joint", text(&|_, t| t.joint.clone()));
    table.texts("kind", text(&|_, t| t.kind.to_string()));
    table.numbers("time", "s", all.iter().map(|(_, t)| t.time).collect());
    table.numbers("warnings", "", all.iter().map(|(_, t)| Some(t.warnings.len() as f64)).collect());
    table.texts("warning_kinds", all.iter().map(|(_, t)| warned::kinds(&t.warnings)).collect());
    table
}

fn json(request: &Request, answers: &[Answer]) -> Value {
    let question = request.question;
    let one = |a: &Answer| {
        let times = |value: f64| a.crack().map(|t| t.scale * value);
        let between = |value: f64| [a.below(), a.crack()].map(|t| t.map(|t| t.scale * value));
        json!({
            "motion": a.name,
            "scale": between(1.0),
            "pga": between(a.shaking.pga),
            "pgv": between(a.shaking.pgv),
            "sa": a.shaking.sa.iter().map(|s| times(*s)).collect::<Vec<_>>(),
            "period": a.mode.map(|m| m.period),
            "damping": a.mode.map(|m| m.damping),
            "sa_period": a.shaking.at_first.and_then(times),
            "sa_period_damped": a.shaking.at_first_damped.and_then(times),
            "joint": a.crack().map(|t| &t.joint),
            "kind": a.crack().map(|t| t.kind),
            "time": a.crack().and_then(|t| t.time),
            "lower_scales": a.checked,
            "uncracked_above": a.uncracked_above(),
            "trials": a.trials,
            "cause": a.cause,
        })
    };
    json!({
        "criterion": question.rule.criterion.name(),
        "limit": question.rule.limit,
        "interval": question.interval,
        "checks": question.checks,
        "periods": question.periods,
        "damping": concio_study::intensity::DAMPING,
        "units": "SI; scale, PGA, PGV: [run without a crack, run with the first crack]; Sa at the latter, of 5 % damping, damped: of the first mode's",
        "version": env!("CARGO_PKG_VERSION"),
        "motions": answers.iter().map(one).collect::<Vec<_>>(),
    })
}

/// The table on the terminal.
fn lines(question: &Question, answers: &[Answer]) -> String {
    let heading =
        ["motion", "scale", "PGA", "PGV", "Sa(T1)", "Sa(T1, ζ1)", "joint", "at", "runs"].map(str::to_string).to_vec();
    let g = |a: f64| format!("{} g", significant(a / concio::G, 3));
    let line = |a: &Answer| {
        let name = a.name.clone();
        match (a.below(), a.crack()) {
            (Some(below), Some(crack)) => vec![
                name,
                // As many digits as tell both ends apart.
                format!("{} … {}", digits(below.scale, question), digits(crack.scale, question)),
                g(crack.scale * a.shaking.pga),
                si(crack.scale * a.shaking.pgv, "m/s"),
                a.shaking.at_first.map_or("–".into(), |sa| g(crack.scale * sa)),
                a.shaking.at_first_damped.map_or("–".into(), |sa| g(crack.scale * sa)),
                format!("{} ({})", crack.joint, crack.kind),
                crack.time.map_or("–".into(), |t| format!("{t:.3} s")),
                a.trials.len().to_string(),
            ],
            _ => vec![name, a.cause.clone().unwrap_or_else(|| "no crack up to 20 g".into())],
        }
    };
    let mut text = columns(&[heading].into_iter().chain(answers.iter().map(line)).collect::<Vec<_>>());
    if let Some(told) = asked::counted_warnings(&warned(answers)) {
        text.push_str(&format!("  warnings {told}\n"));
    }
    if let Some(mode) = answers.iter().find_map(|a| a.mode) {
        let damping = significant(100.0 * mode.damping, 2);
        let period = si(mode.period, "s");
        text.push_str(&format!("  T1 = {period}, ζ1 = {damping} %: first mode of the wall; Sa(T1) is that of 5 %\n"));
    }
    text
}

fn digits(scale: f64, question: &Question) -> String {
    significant(scale, (2.0 - question.interval.log10()).ceil().max(3.0) as i32)
}

/// The answer in sentences.
fn words(question: &Question, answers: &[Answer]) -> Vec<String> {
    let mut text = Vec::new();
    let done: Vec<(&Answer, &Trial)> = answers.iter().filter_map(|a| Some((a, a.crack()?))).collect();
    let asked = match question.rule.limit {
        None => "a joint cracks when its mortar reaches its strength".to_string(),
        Some(limit) => format!(
            "a joint counts as cracked when it {} by {}",
            match question.rule.criterion {
                concio_study::limits::Criterion::Opening => "has opened",
                _ => "was displaced along itself",
            },
            si(limit, "m")
        ),
    };
    let runs: usize = answers.iter().map(|a| a.trials.len()).sum();
    text.push(format!(
        "Each motion was scaled until a first joint cracked ({asked}). The crack lies between two runs that were made, one without \
         and one with it, at most {} % apart; {} in all.",
        shown(100.0 * question.interval),
        counted(runs, "run")
    ));
    let peaks: Vec<f64> = done.iter().map(|(a, t)| t.scale * a.shaking.pga).collect();
    let order = |values: &[f64]| {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        order
    };
    if let (Some(&least), Some(&most)) = (order(&peaks).first(), order(&peaks).last()) {
        let g = |k: usize| format!("{} g ({})", significant(peaks[k] / concio::G, 3), done[k].0.name);
        let mut said = format!(
            "The runs with the first crack, up to {} % above those without, have a PGA from {} to {}",
            shown(100.0 * question.interval),
            g(least),
            g(most)
        );
        if done.len() > 2 {
            said.push_str(&format!(
                ", median {} g, dispersion β {}",
                significant(median(&peaks) / concio::G, 3),
                significant(dispersion(&peaks), 2)
            ));
            let spectral: Option<Vec<[f64; 2]>> = done
                .iter()
                .map(|(a, t)| Some([a.shaking.at_first?, a.shaking.at_first_damped?].map(|s| s * t.scale)))
                .collect();
            if let (Some(sa), Some(mode)) = (spectral, done[0].0.mode) {
                let [of_five, own] = [0, 1].map(|k| sa.iter().map(|s| s[k]).collect::<Vec<f64>>());
                said.push_str(&format!(
                    "; in terms of Sa at the wall's first period of {} the median is {} g and β {} with 5 % of damping, {} g and {} \
                     with the {} % of the wall's first mode",
                    si(mode.period, "s"),
                    significant(median(&of_five) / concio::G, 3),
                    significant(dispersion(&of_five), 2),
                    significant(median(&own) / concio::G, 3),
                    significant(dispersion(&own), 2),
                    significant(100.0 * mode.damping, 2)
                ));
            }
        }
        text.push(said + ".");
        let kinds = |kind: &str| done.iter().filter(|(_, t)| t.kind == kind).count();
        let named = ["bed", "head", "base", "top", "connection"].into_iter().filter(|k| kinds(k) > 0);
        let named: Vec<String> = named.map(|k| format!("{} {k}", kinds(k))).collect();
        text.push(format!("Kind of joint that cracks first: {}.", named.join(", ")));
    }
    let tried: usize = answers.iter().map(|a| a.checked.len()).sum();
    let above: Vec<&str> =
        answers.iter().filter(|a| !a.uncracked_above().is_empty()).map(|a| a.name.as_str()).collect();
    text.push(format!(
        "{} below the interval of the crack were made in all, at least {} of each motion spread evenly between 0 and the crack; no joint \
         cracked in them. \
         Cracks between them cannot be excluded where a response does not grow with its motion{}.",
        counted(tried, "run"),
        question.checks,
        match above.len() {
            0 => ", of which no run gave a sign".to_string(),
            _ => format!(": runs without a crack above the first one were met under {}", above.join(", ")),
        }
    ));
    for answer in answers {
        if let Some(cause) = &answer.cause {
            text.push(format!("{}: no answer, {cause}.", answer.name));
        } else if answer.crack().is_none() {
            text.push(format!("{}: no joint cracks up to a PGA of 20 g.", answer.name));
        }
    }
    text
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    if n % 2 == 1 { sorted[n / 2] } else { (sorted[n / 2 - 1] * sorted[n / 2]).sqrt() }
}

/// Standard deviation of the logarithms.
fn dispersion(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().map(|v| v.ln()).sum::<f64>() / n;
    (values.iter().map(|v| (v.ln() - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
}

fn figure(answers: &[Answer]) -> Option<Drawing> {
    let done: Vec<(&Answer, &Trial, &Trial)> =
        answers.iter().filter_map(|a| Some((a, a.below()?, a.crack()?))).collect();
    if done.is_empty() {
        return None;
    }
    let column = |quantity: &str, unit: &'static str, value: &dyn Fn(&Answer) -> Option<f64>| {
        let bar = |(a, below, crack): &(&Answer, &Trial, &Trial)| {
            value(a).map(|v| Bar {
                ends: [below.scale * v, crack.scale * v],
                upright: matches!(crack.kind, "head" | "connection"),
            })
        };
        Bars { quantity: quantity.into(), unit, bars: done.iter().map(bar).collect() }
    };
    let mut all = vec![column("scale", "", &|_| Some(1.0)), column("PGA", "g", &|a| Some(a.shaking.pga / concio::G))];
    if let Some(mode) = done.iter().find_map(|(a, ..)| a.mode) {
        let name = format!("Sa({}, {} %)", si(mode.period, "s"), significant(100.0 * mode.damping, 2));
        all.push(column(&name, "g", &|a| Some(a.shaking.at_first_damped? / concio::G)));
    }
    let names: Vec<&str> = done.iter().map(|(a, ..)| a.name.as_str()).collect();
    Some(bars("Scale, PGA and spectral acceleration at which a first joint cracks, by motion", &names, &all))
}
