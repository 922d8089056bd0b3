//! What can be typed. The text of `--help` is the reference: docs/cli.md is made from it.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use concio::case::RecordChannel;
use concio::quantity::{Acceleration, Length, Stress, Time};

/// What clap's own list has no groups for: every command that a user types.
pub const COMMANDS: &str = "\
Make and run a wall:
  new          write a commented wall file to start from
  check        say what a wall file describes, or what is wrong with it
  record       measure and draw an accelerogram
  run          simulate a wall: results and report

Look at results:
  plot         figures for print, or the report again
  export       CSV, NPZ or VTKHDF
  compare      two runs side by side

Without a simulation:
  limit        the horizontal load under which a dry wall becomes a mechanism
  mechanisms   what may fall out of the plane of a wall
  continuum    the material that finite element programs need
  scale        the dimensionless groups of a wall

Many runs:
  study        sensitivity, fragility, crack lines, interfaces
  first-crack  the scale of a motion at which a first joint cracks

For programs:
  schema       the JSON Schema of the wall file
  system       the assembled system as JSON, for other solvers
  completions  the completions of a shell

`concio COMMAND --help` says more of each.
";

/// Earthquake response of block masonry, in the plane of a wall and out of it.
///
/// A wall file says in about twenty lines what the wall is, how its joints behave and how it is shaken.
/// `concio new` writes one to start from.
#[derive(Debug, Parser)]
#[command(name = "concio", version, propagate_version = true, arg_required_else_help = true, max_term_width = 110)]
#[command(help_template = "{about-section}\n{usage-heading} {usage}\n\n{before-help}Options:\n{options}{after-help}", before_help = COMMANDS)]
#[command(after_help = "\
First steps:
  concio run                    the built-in wall, to see a result
  concio new wall.toml          a wall file to change
  concio check wall.toml        what it describes, or what is wrong with it
  concio run wall.toml          the run; its page is concio-run/wall/report.html

Exit status: 0 done, 1 the run stopped early or a file could not be written, 2 the input is wrong.")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands; what they do is said at their arguments.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(Run),
    Check(Check),
    New(New),
    Schema(Schema),
    Record(Record),
    System(System),
    Scale(Scale),
    Export(Export),
    Plot(Plot),
    Compare(Compare),
    FirstCrack(FirstCrack),
    Limit(Limit),
    Continuum(Continuum),
    Mechanisms(Mechanisms),
    Study(Study),
    Completions(Completions),
}

/// Simulate a wall and write its results and report.
///
/// Writes result.h5 (histories, frames, envelopes), summary.json (the numbers of the run) and report.html
/// (figures, energies, input). Each appears whole or not at all. A run that was stopped or killed resumes
/// where it left off when the same command is given again.
///
/// Ctrl-C stops the run and writes what was computed so far; a second Ctrl-C ends the program at once.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio run                              the built-in wall
  concio run wall.toml                    results in concio-run/wall
  concio run wall.toml --out night/a1     results in night/a1
  concio run wall.toml --fresh            from the start, whatever a killed run left")]
pub struct Run {
    /// Wall file, TOML or JSON; without it the built-in example.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Folder of the results; default concio-run/NAME for NAME.toml.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Start at t = 0 even if a killed run could be resumed.
    #[arg(long, alias = "no-resume")]
    pub fresh: bool,
}

/// Validate a wall file and say what it describes.
///
/// Lists what is wrong, with line and allowed range. If nothing is, prints what the wall consists of (panels, joints of each
/// kind, mass, normal forces) and what moves it (record, scale, peak acceleration, the part used). Walls of up to 2,000 blocks
/// tell their first period with joints intact, of planar walls with joints as they bear, and planar walls whether they stand
/// under their loads. No motion is simulated.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio check wall.toml
  concio check wall.toml --svg wall.svg    a drawing with the names of blocks and joints
  concio check wall.toml --joints          every joint by name")]
pub struct Check {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Draw the wall into this file.
    #[arg(long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// List every joint: name, kind, course, weight, normal force.
    #[arg(long)]
    pub joints: bool,
}

/// Write a commented wall file to start from.
///
/// A file that exists is not overwritten.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio new                 writes wall.toml
  concio new nave.toml
  concio new --model shear
  concio new -               prints it")]
pub struct New {
    /// File to write; `-` for standard output.
    #[arg(default_value = "wall.toml", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// How its blocks move.
    #[arg(long, value_enum, default_value_t = Model::Planar)]
    pub model: Model,
}

/// The models of a wall file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Model {
    /// To the side, up and down, and turning: walls open, rock, slide and fall.
    Planar,
    /// Out of the plane, as one body or a chain of two: façades that rock under floors, ties and side walls.
    Rocking,
    /// To the side alone, as in the research report: for walls whose joints slide or crack and do nothing else.
    Shear,
}

/// Print the JSON Schema of the wall file.
///
/// Editors that know JSON Schema complete and check wall files with it. It documents every key with its unit,
/// bound and default.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  concio schema > wall.schema.json
and as the first line of a wall file, for editors with a TOML language server:
  #:schema ./wall.schema.json")]
pub struct Schema {}

/// Measure and draw an accelerogram.
///
/// The format is found from the content: PEER AT2, ITACA/ESM/AFAD ASC, COSMOS V1 and V2, CSMIP V2, USGS SMC, K-NET and KiK-net
/// in ASCII and CSV, GeoNet V1A and V2A, text of Turkey's NSMN and of Taiwan's CWB, UNAM ASA, uncorrected Volume 1 (RENADIC, USC, CSMIP,
/// BHRC), or text: columns, after a time column or with --dt, or one component row by row. Prints peak acceleration, velocity and
/// displacement, Arias intensity, significant duration and Housner intensity of the record as it is, unfiltered. Only the offset
/// of K-NET and KiK-net is taken off, as the archive does before it states the peak.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio record quake.AT2
  concio record station.V2 --channel 3 --svg ch3.svg
  concio record shaking.txt --dt 5ms --units gal --layout rows
  concio record quake.AT2 --json                        also the 5 % response spectrum")]
pub struct Record {
    /// Record file.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Print JSON (SI units) instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Draw histories and spectrum into this file.
    #[arg(long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// Component of a file with several: its number from 1, or a word of its name; default the first horizontal one.
    #[arg(long, value_name = "N|NAME", value_parser = channel)]
    pub channel: Option<RecordChannel>,
    /// Unit of a text file that names none (g, m/s2, cm/s2, …).
    #[arg(long, value_name = "UNIT")]
    pub units: Option<String>,
    /// Sample interval of a text file without a time column that names none, in seconds or with a unit (5ms).
    #[arg(long, value_name = "TIME", value_parser = interval, allow_hyphen_values = true)]
    pub dt: Option<f64>,
    /// How the values of a text file stand.
    #[arg(long, value_enum)]
    pub layout: Option<Layout>,
    /// What the values of a text file are.
    #[arg(long, value_enum, default_value = "acceleration")]
    pub quantity: Quantity,
}

/// What the values of a text file are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Quantity {
    /// Acceleration.
    Acceleration,
    /// Displacement.
    Displacement,
}

/// How the values of a text file stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layout {
    /// A column for each component.
    Columns,
    /// One component, row by row.
    Rows,
}

/// Print the assembled system as JSON, for other solvers.
///
/// Masses, joints with their stiffness, damping, normal force and friction, and the motion of base and top: all that
/// a general-purpose solver needs to integrate the same equations. docs/system.md describes the keys.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  concio system wall.toml > system.json")]
pub struct System {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
}

/// Convert a result to CSV, NPZ or VTKHDF.
///
/// CSV is a folder of tables, NPZ a NumPy archive with the names of the HDF5 file, VTKHDF a file of moving blocks for
/// ParaView.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("format").required(true))]
#[command(after_help = "\
Examples:
  concio export concio-run/wall --csv                 tables in concio-run/wall/csv
  concio export concio-run/wall --npz --out a1.npz
  concio export concio-run/wall --vtkhdf              concio-run/wall/result.vtkhdf")]
pub struct Export {
    /// Folder of a run.
    #[arg(value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// A folder of CSV tables.
    #[arg(long, group = "format")]
    pub csv: bool,
    /// A NumPy archive.
    #[arg(long, group = "format")]
    pub npz: bool,
    /// A file for ParaView.
    #[arg(long, group = "format")]
    pub vtkhdf: bool,
    /// Where to; default csv, result.npz or result.vtkhdf in the folder of the run.
    #[arg(short, long, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    pub out: Option<PathBuf>,
}

/// Draw figures of a result for print, or its report again.
///
/// Without --figure, report.html is made anew from result.h5 and summary.json, for example after an update of Concio.
/// With --figure, figures are drawn into DIR/figures, sized for a column of a journal; docs/figures.md shows them all.
/// A figure that is asked for by name and cannot be made is an error; of `all`, those that can be made are.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio plot concio-run/wall                                      report.html
  concio plot concio-run/wall --figure all                         every figure, SVG in concio-run/wall/figures
  concio plot concio-run/wall --figure deformed --at \"1.25 s\" --scale 5000 --format pdf
  concio plot concio-run/wall --figure phase --blocks p1c6b1,p1c3b2 --width double
  concio plot concio-run/wall --figure joint-histories --joints \"p1c3b1|p1c3b2\" --from \"2 s\" --to \"3 s\"")]
pub struct Plot {
    /// Folder of a run.
    #[arg(value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// Figure to draw; may be given several times or with commas between names.
    #[arg(long, value_name = "NAME", value_enum, value_delimiter = ',')]
    pub figure: Vec<Figures>,
    /// Format of the files.
    #[arg(long, value_enum, default_value = "svg", requires = "figure")]
    pub format: Format,
    /// Folder for the figures; default DIR/figures.
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath, requires = "figure")]
    pub out: Option<PathBuf>,
    /// Instant of deformed and acceleration, such as "1.25 s", or peak: that of the largest displacement, of
    /// acceleration that of the largest relative acceleration.
    #[arg(long, value_name = "TIME", value_parser = instant, default_value = "peak", requires = "figure", allow_hyphen_values = true)]
    pub at: Instant,
    /// How many times larger displacements are drawn; default a round number that shows them.
    #[arg(long, value_name = "FACTOR", value_parser = positive, requires = "figure", allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// Blocks of phase, by name, with commas between them; default those that moved most.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "figure")]
    pub blocks: Vec<String>,
    /// Joints of joint-phase, joint-histories and hysteresis, by name; default those that moved or dissipated most.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "figure")]
    pub joints: Vec<String>,
    /// Start of the time shown, such as "2 s".
    #[arg(long, value_name = "TIME", value_parser = time, requires = "figure", allow_hyphen_values = true)]
    pub from: Option<f64>,
    /// End of the time shown.
    #[arg(long, value_name = "TIME", value_parser = time, requires = "figure", allow_hyphen_values = true)]
    pub to: Option<f64>,
    /// Width in print: single (85 mm), double (180 mm), or a length of 40 mm to 400 mm such as "120 mm".
    #[arg(long, value_parser = width, default_value = "single", requires = "figure", allow_hyphen_values = true)]
    pub width: f64,
    /// Resolution of PNG [pixels per inch], 50 to 1200.
    #[arg(long, value_name = "DPI", value_parser = clap::value_parser!(u32).range(50..=1200), default_value = "300", requires = "figure", allow_negative_numbers = true)]
    pub dpi: u32,
}

/// What `--figure` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figures {
    /// One figure.
    One(Figure),
    /// Every figure that can be made.
    All,
}

impl ValueEnum for Figures {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Figures; 12] = [
            Figures::One(Figure::Deformed),
            Figures::One(Figure::Phase),
            Figures::One(Figure::JointPhase),
            Figures::One(Figure::JointHistories),
            Figures::One(Figure::PeakAcceleration),
            Figures::One(Figure::Acceleration),
            Figures::One(Figure::Cracks),
            Figures::One(Figure::Hysteresis),
            Figures::One(Figure::TopForce),
            Figures::One(Figure::Energies),
            Figures::One(Figure::Motion),
            Figures::All,
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        match self {
            Figures::One(figure) => figure.to_possible_value(),
            Figures::All => Some(clap::builder::PossibleValue::new("all").help("Every figure that can be made")),
        }
    }
}

/// The figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Figure {
    /// The wall at an instant, displacements enlarged, over its outline at rest.
    Deformed,
    /// Velocity over displacement of blocks, relative to the base.
    Phase,
    /// Relative velocity over relative displacement of joints.
    JointPhase,
    /// Relative displacement of neighbouring blocks over time.
    JointHistories,
    /// Joints coloured by their peak relative acceleration over the largest of all.
    PeakAcceleration,
    /// Joints coloured by their relative acceleration at an instant over the largest in the whole history.
    Acceleration,
    /// Joints coloured by the damage of their bonds.
    Cracks,
    /// Friction force over slip of joints.
    Hysteresis,
    /// Force of the top beam over its displacement.
    TopForce,
    /// Energies by mechanism over time.
    Energies,
    /// Motion of base and driven beam, and response spectrum with 5 % damping.
    Motion,
}

impl Figure {
    /// Its name on the command line and, with an ending, that of its file.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().into())
    }
}

/// Formats of figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Vectors for text processors and browsers; letters are outlines.
    Svg,
    /// Pixels.
    Png,
    /// Vectors for LaTeX and journals; text can be selected.
    Pdf,
}

fn time(text: &str) -> Result<f64, String> {
    with_unit(text, "s")?;
    Time::parse(text).map(Time::si)
}

/// On the command line, other than in a wall file, a number alone is no quantity: quotes make no difference there.
fn with_unit(text: &str, unit: &str) -> Result<(), String> {
    match text.trim().parse::<f64>() {
        Ok(_) => Err(format!("the unit is missing: write {}{unit}", text.trim())),
        Err(_) => Ok(()),
    }
}

/// A number alone is in seconds.
fn interval(text: &str) -> Result<f64, String> {
    text.trim().parse::<f64>().or_else(|_| Time::parse(text).map(Time::si))
}

/// A number beyond the components of the file may be a name: `360` of `360 deg`.
fn channel(text: &str) -> Result<RecordChannel, String> {
    match text.trim() {
        "" | "0" => Err("allowed: a number from 1, or a name".into()),
        name => Ok(RecordChannel::Name(name.into())),
    }
}

/// Width of one column of a journal [mm].
pub const SINGLE: f64 = 85.0;
/// Width of two columns [mm].
pub const DOUBLE: f64 = 180.0;

/// An instant of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instant {
    /// That of the frame with the largest displacement of a block relative to the base; for accelerations that with the
    /// largest relative acceleration of a joint.
    Peak,
    /// This one [s]; the nearest frame is drawn.
    At(f64),
}

fn instant(text: &str) -> Result<Instant, String> {
    if text == "peak" { Ok(Instant::Peak) } else { time(text).map(Instant::At) }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err("allowed: a number above 0".into()),
    }
}

/// Two rising parts of 1.
fn plateau(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<f64> = text.split(',').filter_map(|p| p.trim().parse().ok()).collect();
    match (<[f64; 2]>::try_from(parts.as_slice()), text.split(',').count()) {
        (Ok([from, to]), 2) if 0.0 < from && from < to && to < 1.0 => Ok([from, to]),
        _ => Err("allowed: two rising numbers above 0 and below 1, such as 0.1,0.4".into()),
    }
}

/// A part of 1.
fn part(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (0.0..=1.0).contains(&v) => Ok(v),
        _ => Err("allowed: a number from 0 to 1".into()),
    }
}

/// An acceleration above 0 [m/s²].
fn peak_acceleration(text: &str) -> Result<f64, String> {
    with_unit(text, " g")?;
    match Acceleration::parse(text)?.si() {
        v if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err("allowed: above 0 g".into()),
    }
}

fn length(text: &str) -> Result<Length, String> {
    with_unit(text, " mm")?;
    match Length::parse(text)? {
        v if v.si() > 0.0 && v.si().is_finite() => Ok(v),
        _ => Err("allowed: above 0".into()),
    }
}

/// A length above 0 [m].
fn limit(text: &str) -> Result<f64, String> {
    with_unit(text, "mm")?;
    match Length::parse(text)?.si() {
        v if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err("allowed: above 0mm".into()),
    }
}

/// A length above 0 [m].
fn metres(text: &str) -> Result<f64, String> {
    with_unit(text, "m")?;
    match Length::parse(text)?.si() {
        v if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err("allowed: above 0m".into()),
    }
}

/// A modulus above 0 in Pa.
fn modulus(text: &str) -> Result<f64, String> {
    // Bricks have 0.05 to 70 GPa: the size of a bare number tells its unit.
    with_unit(
        text,
        match text.trim().parse::<f64>().unwrap_or(0.0).abs() {
            size if size < 100.0 => "GPa",
            size if size < 1e6 => "MPa",
            _ => "Pa",
        },
    )?;
    stress(text)?.filter(|v| *v > 0.0).ok_or_else(|| "allowed: above 0GPa".into())
}

/// A stress from 0 in Pa.
fn pressure(text: &str) -> Result<f64, String> {
    stress(text)?.filter(|v| *v >= 0.0).ok_or_else(|| "allowed: from 0MPa".into())
}

/// A stress in Pa, none that is not finite; GPa are for moduli.
fn stress(text: &str) -> Result<Option<f64>, String> {
    with_unit(text, "MPa")?;
    let trimmed = text.trim();
    let value = match trimmed.strip_suffix("GPa").map(|number| number.trim().parse::<f64>()) {
        Some(Ok(number)) => 1e9 * number,
        _ => Stress::parse(trimmed)?.si(),
    };
    Ok(Some(value).filter(|v| v.is_finite()))
}

fn shard(text: &str) -> Result<[usize; 2], String> {
    let wrong = || "allowed: I/N with I from 1 to N, such as 3/16".to_string();
    let (i, n) = text.split_once('/').ok_or_else(wrong)?;
    match (i.parse(), n.parse()) {
        (Ok(i), Ok(n)) if 1 <= i && i <= n => Ok([i, n]),
        _ => Err(wrong()),
    }
}

fn fraction(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (0.0..=1.0).contains(&v) => Ok(v),
        _ => Err("allowed: 0 to 1".into()),
    }
}

/// In millimetres.
fn width(text: &str) -> Result<f64, String> {
    let width = match text {
        "single" => SINGLE,
        "double" => DOUBLE,
        length => {
            with_unit(length, "mm")?;
            1e3 * Length::parse(length).map_err(|why| format!("{why}; also single, double"))?.si()
        }
    };
    if (40.0..=400.0).contains(&width) { Ok(width) } else { Err("allowed: 40 mm to 400 mm, single, double".into()) }
}

/// Set two runs side by side.
///
/// Prints which keys of their wall files differ, the numbers of both with difference and ratio, and what either warns of. Writes
/// report.html with these and histories over each other (base acceleration, top displacement, base shear, loop, energies), the
/// figures as SVG and PDF, and compare.json into the folder. Both runs have ended and are of one model. The difference is
/// B − A, the ratio B / A.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "\
Examples:
  concio compare concio-run/before concio-run/after
  concio compare night/a1 night/a2 --out a1-a2
  concio compare constrained wall.toml               one wall with free, no-tension and rigid head joints")]
pub struct Compare {
    /// Other comparisons.
    #[command(subcommand)]
    pub what: Option<Comparison>,
    /// Folder of the first run.
    #[arg(required = true, value_name = "A", value_hint = ValueHint::DirPath)]
    pub a: Option<PathBuf>,
    /// Folder of the second run.
    #[arg(required = true, value_name = "B", value_hint = ValueHint::DirPath)]
    pub b: Option<PathBuf>,
    /// Folder of the comparison; default concio-compare/A-B, the names of both.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

/// What `compare` compares.
#[derive(Debug, Subcommand)]
pub enum Comparison {
    Constrained(Constrained),
}

/// Head joints that are free, no-tension springs, or rigid.
///
/// Runs the wall three times: with head joints that only damp, so that blocks may overlap; with no-tension springs of the
/// rigidity that the file gives; with rigid unilateral contact. All else is as in the file. Joints count as head joints
/// where their law is no-tension or rigid; bonded ones are refused, because only a spring can carry a bond.
///
/// Prints the deepest interpenetration of each, and draws displacements, velocities and gaps of pairs of neighbouring
/// blocks. Writes compare.json and the figures pair-1, pair-2, … into the folder.
///
/// With --rigidity the wall is also run with springs of these rigidities. Printed and drawn (convergence) are the largest
/// difference of the pairs' displacements from those of rigid contact, over their peak, and the power of the rigidity with
/// which it goes. Stiffer springs come to rigid contact with restitution 1. Where the motion is chaotic, differences stay as
/// large as the motion itself.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio compare constrained wall.toml
  concio compare constrained wall.toml --pairs 'p1c1b1|p1c1b2,p1c3b1|p1c3b2' --format pdf
  concio compare constrained wall.toml --rigidity 10,100,1e3,1e4,1e5,1e6")]
pub struct Constrained {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Folder of the results; default concio-run/NAME-constrained for NAME.toml.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Head joints or connections, by name, with commas between them; default the two that overlap most when free.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub pairs: Vec<String>,
    /// Restitution of the rigid joints to which the file gives none, 0 to 1.
    #[arg(long, value_name = "E", value_parser = fraction, default_value = "1", allow_negative_numbers = true)]
    pub restitution: f64,
    /// Rigidities of no-tension springs to run besides, above 0, with commas between them.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = positive, allow_hyphen_values = true)]
    pub rigidity: Vec<f64>,
    /// Format of the figures.
    #[arg(long, value_enum, default_value = "svg")]
    pub format: Format,
}

/// Print the dimensionless groups of a wall.
///
/// Reference mass M is that of the first panel's brick, reference stiffness K that of bed joints, Ω = √(K/M). Λ is the
/// length of the first panel's brick unless another is given: it scales displacements and changes nothing in how walls
/// compare. Beside each group stands its range over Table 1 and section 4.2 of the research report, and the key of the wall
/// file that a study changes when it varies the group (`path = "group.load"`).
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio scale wall.toml
  concio scale wall.toml --length 10mm     displacements over a centimetre
  concio scale wall.toml --json")]
pub struct Scale {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Λ, above 0, with its unit.
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_hyphen_values = true)]
    pub length: Option<Length>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Find the motion's scale at which a first joint cracks.
///
/// The wall is run under every record at growing scales until two runs enclose the crack: one without it, and one with it at
/// most --interval above. Besides, some lower scales are tried. Told are the scale, PGA, PGV and spectral accelerations there,
/// which joint cracks and when. A record takes the place of the wall's motion and is used whole.
///
/// Writes first-crack.csv, first-crack-runs.csv, first-crack.json, a report and its figure. Runs that the folder knows
/// already are not done again. A study file with [first-crack] asks the same of synthetic, trimmed or reversed motions and of
/// walls that vary.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio first-crack wall.toml                                       under the wall's own motion
  concio first-crack wall.toml --records a.at2,b.v2,c.smc
  concio first-crack wall.toml --records a.at2 --criterion opening --limit 0.3mm
  concio first-crack wall.toml --records a.at2 --interval 0.001 --out cracks")]
pub struct FirstCrack {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Accelerograms, with commas between them; without them the wall's own motion.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_hint = ValueHint::FilePath)]
    pub records: Vec<PathBuf>,
    /// What counts as a crack.
    #[arg(long, value_enum, default_value = "bond")]
    pub criterion: CrackCriterion,
    /// Limit of opening or slip, such as 0.3mm; default 0.1mm, from which cracks are seen.
    #[arg(long, value_name = "LENGTH", value_parser = limit, allow_hyphen_values = true)]
    pub limit: Option<f64>,
    /// Largest relative distance of the two scales around the crack, 1e-5 to 1.
    #[arg(long, value_name = "PART", default_value_t = 0.01, value_parser = positive, allow_negative_numbers = true)]
    pub interval: f64,
    /// Lower scales that are tried besides, 0 to 100.
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true)]
    pub checks: usize,
    /// Periods of the spectral accelerations, with commas between them; default 0.1s,0.2s,0.5s.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = time, allow_hyphen_values = true)]
    pub periods: Vec<f64>,
    /// Threads; default one per core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Folder of the results; default concio-first-crack/NAME for NAME.toml.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

/// What counts as a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CrackCriterion {
    /// A joint reaches the strength of [joint.bond]
    Bond,
    /// A head joint or connection opens by --limit
    Opening,
    /// The sides of a bed or support joint are displaced by --limit; elastic deformation counts
    Slip,
}

/// Find the horizontal load under which a dry wall becomes a mechanism.
///
/// Blocks are rigid, joints bear no tension and slide at the static friction of the wall file; mortar, stiffness and motion
/// play no part. The dead load, weights and load.top, stays; the live load is λ times it, horizontal. Friction is associative:
/// what slides also dilates, which makes λ an upper bound of that of real joints. An estimate without dilation stands beside
/// it.
///
/// Forces in balance prove a lower bound of λ, a mechanism an upper one, both printed. docs/limit-analysis.md says how.
///
/// With --out-of-plane the wall is pushed across its plane, block by block in space: extruded by its thickness, its base wide
/// and fixed. Floors, ties, side walls and gable of the table `out_of_plane` stand and pull behind it. Told beside λ is
/// whether the multipliers of `concio mechanisms` are high or low.
///
/// Exit status 1 if the bounds of λ are more than 1e-4 of it apart; those of smooth heads are told.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio limit wall.toml
  concio limit wall.toml --towards left --heads frictionless
  concio limit wall.toml --load top --out limits/top
  concio limit wall.toml --out-of-plane --out limits/across
  concio limit wall.toml --json")]
pub struct Limit {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// What is turned to the horizontal.
    #[arg(long, value_enum, default_value = "body")]
    pub load: LimitLoad,
    /// Where it pushes to; default both ways, and what is told is the weaker; with --out-of-plane outwards.
    #[arg(long, value_enum)]
    pub towards: Option<Side>,
    /// Friction of head joints and connections; with --out-of-plane both are told.
    #[arg(long, value_enum, default_value = "as-given")]
    pub heads: HeadFriction,
    /// Push the wall across its plane, as blocks in space.
    #[arg(long)]
    pub out_of_plane: bool,
    /// Hold what is below this height, such as 1.2m, and push the rest: for parts, and where all slides at λ = μ.
    #[arg(long, value_name = "LENGTH", value_parser = metres, requires = "out_of_plane", allow_hyphen_values = true)]
    pub above: Option<f64>,
    /// Draw contact points in so that bed joints twist no stronger than even pressure does; λ comes out too low.
    #[arg(long, requires = "out_of_plane")]
    pub even_twist: bool,
    /// Estimate λ without dilation for walls of more than 100 blocks too: some fifty times the work.
    #[arg(long, requires = "out_of_plane")]
    pub without_dilation: bool,
    /// Print JSON (SI units).
    #[arg(long)]
    pub json: bool,
    /// Write limit.json (bounds, forces, mechanism) and mechanism.svg into this folder.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

/// Assess what may fall out of the plane of a wall.
///
/// Finds every mechanism that the wall can have: overturning at each bed joint, with and without its side walls, an outer
/// leaf alone, vertical arches between floors that hold, a horizontal arch, corners, flaps with oblique hinges, a gable. Each
/// has its multiplier α0, least over the slopes of its cracks, and the checks of the Italian code where the wall file gives a
/// site. Floors, ties, side walls and site stand in the table `out_of_plane` of the wall file; what it lacks is told with what
/// is assumed. Blocks are rigid and multipliers are upper bounds in the class of their mechanism.
///
/// With a record, the least mechanism of each kind is followed through it, once with each sign: how far it turns, whether it
/// falls, and whether that is a matter of chance, for a thousandth more or less of the record may decide it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio mechanisms wall.toml                   the least of each kind
  concio mechanisms wall.toml --all             every hinge level
  concio mechanisms wall.toml --record quake.AT2 --pga \"0.3 g\"
  concio mechanisms wall.toml --record station.V2 --vertical station.V2 --scale 1.5
  concio mechanisms wall.toml --shaken          under the motion of the wall file
  concio mechanisms wall.toml --out assessed    mechanisms.json, mechanisms.csv, report.html with drawings
  concio mechanisms wall.toml --json")]
pub struct Mechanisms {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Print every hinge level instead of the least of each kind, and follow every one through a motion.
    #[arg(long)]
    pub all: bool,
    /// Which sum of the friction of side walls is taken.
    #[arg(long, value_enum, default_value = "summed")]
    pub overlaps: OverlapSum,
    /// Ends of the plateau of a trilinear curve as parts of d0, such as 0.1,0.4: joints that are not sharp bear no more than that.
    #[arg(long, value_name = "D1,D2", value_parser = plateau, allow_hyphen_values = true)]
    pub trilinear: Option<[f64; 2]>,
    /// Print JSON (SI units).
    #[arg(long)]
    pub json: bool,
    /// Write mechanisms.json, mechanisms.csv, report.html and its figures into this folder; with a motion time-history-KIND.csv.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// What shakes them.
    #[command(flatten)]
    pub motion: TimeHistory,
}

/// What shakes the mechanisms of a wall.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Time history")]
pub struct TimeHistory {
    /// Record that shakes the wall across its plane, in any format of `concio record`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, group = "shaken-by")]
    pub record: Option<PathBuf>,
    /// Shake it across its plane by the motion of the wall file, base and vertical.
    #[arg(long, group = "shaken-by")]
    pub shaken: bool,
    /// Factor on the motion, above 0; on the vertical one too.
    #[arg(long, value_name = "FACTOR", value_parser = positive, requires = "shaken-by", allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// Scale the record to this peak acceleration, such as "0.3 g"; the vertical one by the same factor.
    #[arg(long, value_name = "ACCELERATION", value_parser = peak_acceleration, requires = "record", conflicts_with = "scale", allow_hyphen_values = true)]
    pub pga: Option<f64>,
    /// File of the vertical record; it may be that of the record. Without it nothing moves up and down.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "record")]
    pub vertical: Option<PathBuf>,
    /// Component of the record: its number from 1, or a word of its name; default the first horizontal one.
    #[arg(long, value_name = "N|NAME", value_parser = channel, requires = "record")]
    pub channel: Option<RecordChannel>,
    /// Component of the vertical record; default the first vertical one.
    #[arg(long, value_name = "N|NAME", value_parser = channel, requires = "vertical")]
    pub vertical_channel: Option<RecordChannel>,
    /// Unit of text files that name none.
    #[arg(long, value_name = "UNIT", requires = "record")]
    pub units: Option<String>,
    /// Sample interval of text files that name none, in seconds or with a unit (5ms).
    #[arg(long, value_name = "TIME", value_parser = interval, requires = "record", allow_hyphen_values = true)]
    pub dt: Option<f64>,
    /// How the values of text files stand.
    #[arg(long, value_enum, requires = "record")]
    pub layout: Option<Layout>,
    /// Velocity after an impact over that before, 0 to 1; default by formula. It is chosen, not known: try others.
    #[arg(long, value_name = "E", value_parser = part, requires = "shaken-by", allow_negative_numbers = true)]
    pub restitution: Option<f64>,
}

/// Sums of the friction of the overlaps of a side wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OverlapSum {
    /// Over the courses: f = 1/2
    Summed,
    /// With f = 0.4 of the code
    Code,
}

/// Live loads of limit analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LimitLoad {
    /// The weight of every block, and of a beam that has mass
    Body,
    /// The weight of the top course and the load on it
    Top,
}

/// Sides of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Side {
    /// To −x
    Left,
    /// To +x
    Right,
    /// Across the plane, to the face that the wall file shows
    Outwards,
    /// Across the plane, away from it
    Inwards,
}

/// Friction of head joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum HeadFriction {
    /// As joint.friction says
    AsGiven,
    /// None
    Frictionless,
}

/// Give the material that finite element programs need in place of a wall's bricks and joints.
///
/// Prints membrane, plate and transverse shear moduli of every panel, its strength domain, what all of it rests on, and how far
/// the continuum is off at the panel's number of courses. Bonds that repeat have closed forms or are solved as a cell. Of
/// irregular ones three windows are tested, which gives a mean and a scatter. docs/continuum.md has equations and limits.
///
/// With --card the card of one panel is printed and nothing else.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio continuum wall.toml
  concio continuum wall.toml --json
  concio continuum wall.toml --card engineering --units N-mm > wall.inp
  concio continuum wall.toml --card shell --units kN-m
  concio continuum wall.toml --heads open              head joints without mortar
  concio continuum wall.toml --brick-modulus 10GPa     bricks that deform, an estimate
  concio continuum wall.toml --figure error.svg        how the error falls with the courses")]
pub struct Continuum {
    /// Wall file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Name of a panel; default all.
    #[arg(long, value_name = "NAME")]
    pub panel: Option<String>,
    /// What head joints hold.
    #[arg(long, value_enum, default_value = "closed")]
    pub heads: ContinuumHeads,
    /// Take the courses that an irregular panel lists as a cell that repeats along the wall and upwards.
    #[arg(long)]
    pub repeated: bool,
    /// Young's modulus of bricks that deform, such as 10GPa; default rigid bricks.
    #[arg(long, value_name = "STRESS", value_parser = modulus, allow_hyphen_values = true)]
    pub brick_modulus: Option<f64>,
    /// Their Poisson's ratio, above -1 to 0.5.
    #[arg(long, value_name = "NU", default_value_t = 0.2, requires = "brick_modulus", allow_negative_numbers = true)]
    pub brick_poisson: f64,
    /// Pressure on bed joints at which strength is told, such as 0.3MPa; default that of load and weight at half of the height.
    #[arg(long, value_name = "STRESS", value_parser = pressure, allow_hyphen_values = true)]
    pub pressure: Option<f64>,
    /// Print the card of a panel.
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with = "json")]
    pub card: Option<CardFormat>,
    /// Force and length of the card, with the second; mass follows: SI, N-mm, kN-m, lbf-in.
    #[arg(long, value_name = "UNITS", default_value = "SI", requires = "card")]
    pub units: String,
    /// Draw the error of the continuum over the number of courses, as SVG.
    #[arg(long, value_name = "SVG", value_hint = ValueHint::FilePath)]
    pub figure: Option<PathBuf>,
    /// Print JSON (SI units).
    #[arg(long)]
    pub json: bool,
}

/// Head joints of a continuum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ContinuumHeads {
    /// As the file says; those that part freely are closed
    Closed,
    /// Nothing is in them
    Open,
}

/// Cards of finite element programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CardFormat {
    /// Everything, for scripts; reads back to the same numbers
    Json,
    /// Abaqus: *ELASTIC, TYPE=LAMINA
    Lamina,
    /// Abaqus, CalculiX: *ELASTIC, TYPE=ENGINEERING CONSTANTS
    Engineering,
    /// Abaqus: *SHELL GENERAL SECTION, A and D apart
    Shell,
    /// Tcl: nDMaterial ElasticOrthotropic
    Opensees,
}

/// Do many runs, and answer what they answer together.
///
/// A study file names a wall file and says what varies, in which combinations, what is kept and what is asked. Every run
/// is known by a hash of all that its result depends on, and not done again if the folder of the study has it. So a study that
/// was stopped or killed goes on with the same command, and one that grows runs what is new.
#[derive(Debug, Args)]
pub struct Study {
    /// What is done.
    #[command(subcommand)]
    pub what: StudyCommand,
}

/// What `study` does.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    Check(StudyCheck),
    Run(StudyRun),
    Plan(StudyPlan),
    Work(StudyWork),
    /// Go on with a study that was begun; as `run`, but a folder without runs is an error.
    #[command(after_help = "Example:\n  concio study resume friction.toml")]
    Resume(StudyRun),
    /// Tell how many runs a study has and what became of them.
    Status(StudyPlace),
    /// Write tables and report of the runs that the folder has.
    Report(StudyPlace),
    /// The same as `report`.
    Export(StudyPlace),
    Schema(StudySchema),
}

/// Validate a study file and say what it describes.
///
/// Every run is looked at: values that the wall file refuses are told with the line of the study file. Prints what
/// varies, how many runs there are and how many of them the folder has. Nothing is simulated.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio study check friction.toml
  concio study check friction.toml --runs      every run with its values")]
pub struct StudyCheck {
    /// Where the study is.
    #[command(flatten)]
    pub place: StudyPlace,
    /// List every run.
    #[arg(long)]
    pub runs: bool,
}

/// Do the runs of a study that its folder does not have yet.
///
/// Runs go side by side on all cores. Each is written to disk as it ends: whatever stops the program, what was computed
/// is kept. With --shard several processes, on one machine or many with a common folder, do one study together. When all
/// runs are there, the tables are written.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio study run friction.toml
  concio study run friction.toml --threads 8 --out /scratch/friction
  concio study run friction.toml --shard 3/16
  parallel concio study run friction.toml --threads 1 --shard {}/16 ::: $(seq 16)
  srun concio study run friction.toml --shard $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT")]
pub struct StudyRun {
    /// Where the study is.
    #[command(flatten)]
    pub place: StudyPlace,
    /// Threads; default one per core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Do the I-th of N shares of the runs, I from 1 to N.
    #[arg(long, value_name = "I/N", value_parser = shard, allow_hyphen_values = true)]
    pub shard: Option<[usize; 2]>,
}

/// Print the runs that a study can do now as tasks, for other programs to distribute.
///
/// A task is a line of JSON that holds all that its runs need, their records included; `concio study work` does it, on any
/// machine. Curves and searches ask for more when they have seen the rows of these: plan again until nothing is printed.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio study plan friction.toml              how many runs and tasks
  concio study plan friction.toml --json | parallel --pipe -N1 concio study work --threads 1 --out concio-study/friction
  concio study plan friction.toml --json --runs 32 > tasks.jsonl")]
pub struct StudyPlan {
    /// Where the study is.
    #[command(flatten)]
    pub place: StudyPlace,
    /// Print the tasks, one per line.
    #[arg(long)]
    pub json: bool,
    /// Runs in a task at most.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=4096), allow_negative_numbers = true)]
    pub runs: u16,
}

/// Do tasks that `concio study plan --json` printed.
///
/// Reads tasks from standard input, one per line. Writes a row per run to standard output, or into the folder of the study:
/// the lines are those of its runs/*.jsonl, so a file of them may also be put there.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio study work < tasks.jsonl > rows.jsonl && cp rows.jsonl concio-study/friction/runs/
  concio study work --out /shared/friction < tasks.jsonl")]
pub struct StudyWork {
    /// Folder of the study, to keep the rows in instead of printing them.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Threads; default one per core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
}

/// Where a study is.
#[derive(Debug, Args)]
pub struct StudyPlace {
    /// Study file, TOML or JSON.
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Folder of the study; default concio-study/NAME for NAME.toml.
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

/// Print the JSON Schema of the study file.
#[derive(Debug, Args)]
pub struct StudySchema {}

/// Print the completions of a shell.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio completions bash > ~/.local/share/bash-completion/completions/concio
  concio completions fish > ~/.config/fish/completions/concio.fish
  concio completions zsh  > \"${fpath[1]}/_concio\"")]
pub struct Completions {
    /// The shell.
    pub shell: Shell,
}
