//! All that a wall file tells of a panel's continuum, with what it rests on and what is not to be believed.

use concio::case::{Beam, Case, ModelKind};
use concio::{G, InputError};

use crate::bending::{Bending, dry_bending};
use crate::card::{Card, Density};
use crate::cell::Cell;
use crate::membrane::membrane_stiffness;
use crate::moduli::{Constants, Moduli};
use crate::panel::{panel_stiffness, scale};
use crate::running::RunningBond;
use crate::strength::{Domain, Plane, cut, holds, planes};
use crate::texture::{Heads, Pattern, Strengths, Texture};
use crate::units::Units;
use crate::window::{WindowModuli, pitch_area, window, windows};
use crate::{ContinuumError, Strength};

/// Bricks of a panel up to which its own stiffness is held against that of the continuum.
const LARGEST: usize = 20_000;
/// Elements a side of the continuum's panel.
const ELEMENTS: usize = 32;
/// Programs that may be spent on the search for planes; fewer where a cell has many bricks.
const PROGRAMS: usize = 1000;
const FEW_PROGRAMS: usize = 300;
const SMALL_CELL: usize = 12;
/// E of what masonry is built of is less [Pa]: bricks have 5 to 30 GPa, granite and basalt up to some 70 GPa.
const STIFFEST: f64 = 70e9;
/// E of the softest adobe [Pa]; most have 0.1 to 1 GPa, bricks more.
const SOFTEST: f64 = 50e6;
/// Pressure that no wall is under [Pa]: the best masonry crushes at 50 MPa, and is loaded with some MPa.
const MOST_PRESSED: f64 = 50e6;
/// 2 (1 − ν)/(1 − 2ν) of a thin layer that bricks hold, ν = 0.2; and E/G, Concio's default.
const HELD_LAYER: f64 = 8.0 / 3.0;
const FREE_LAYER: f64 = 2.4;

/// What is asked of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// Whether head joints bear.
    pub heads: Heads,
    /// Take listed courses as a cell that repeats.
    pub repeated: bool,
    /// E_b in Pa and ν of bricks that deform; none: rigid ones.
    pub brick: Option<[f64; 2]>,
    /// Pressure −σ22 at which strength is told in Pa, from 0; none: that of load and weight at half of the height.
    pub pressure: Option<f64>,
}

/// The continuum of a panel.
#[derive(Debug, Clone)]
pub struct Found {
    /// Name of the panel.
    pub name: String,
    /// What its bond is.
    pub bond: String,
    /// Whether the moduli are those of a cell; else the mean of three windows, D and F not known and 0.
    pub is_periodic: bool,
    /// Number of courses.
    pub courses: usize,
    /// Bricks across the panel, in the mean.
    pub across: f64,
    /// Width and height [m].
    pub size: [f64; 2],
    /// Moduli, of bricks that deform where they were asked for.
    pub moduli: Moduli,
    /// Engineering constants of these.
    pub constants: Option<Constants>,
    /// E1 in Pa if head joints are open, of bricks that deform where they were asked for; of a cell.
    pub open_e1: Option<f64>,
    /// Mass.
    pub density: Density,
    /// Windows, where there is no cell.
    pub windows: Option<Windows>,
    /// Pressure at which strength is told in Pa, from 0.
    pub pressure: f64,
    /// Strength of intact joints, where they have a bond.
    pub bonded: Option<StrengthFound>,
    /// Strength of joints that only rub.
    pub dry: Option<StrengthFound>,
    /// Bending strength of dry joints, of running bond [N].
    pub bending: Option<Bending>,
    /// How far the continuum is off.
    pub scale: Option<Scale>,
    /// What the numbers rest on.
    pub assumed: Vec<String>,
    /// What is unsafe to believe.
    pub warnings: Vec<String>,
}

/// A strength domain and where it ends at the pressure of [`Found::pressure`].
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct StrengthFound {
    /// Whether the planes are (H5) to (H7); else the program found them.
    pub closed: bool,
    /// The planes.
    pub planes: Vec<Plane>,
    /// Largest σ11 in Pa at this pressure, without shear.
    pub tension: Option<f64>,
    /// Largest |σ12| in Pa at this pressure and σ11 = 0.
    pub shear: Option<f64>,
}

/// Three windows.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Windows {
    /// Left and right side of each [m], and what it told.
    pub each: Vec<([f64; 2], WindowModuli)>,
    /// Standard deviation over the mean of A1111, A2222, A1212.
    pub scatter: [f64; 3],
    /// Whether they overlap, which makes the scatter too small.
    pub overlap: bool,
}

/// How far the continuum is off from the bricks, all of them rigid.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Scale {
    /// Error of A1212 in a wall of so many courses without sides.
    pub without_sides: f64,
    /// Horizontal stiffness of the panel without openings under a beam that stays level: of its bricks, of its continuum [N/m].
    pub panel: Option<[f64; 2]>,
}

impl Scale {
    /// By how much the panel's continuum is too stiff, over its bricks.
    pub fn excess(&self) -> Option<f64> {
        self.panel.map(|[bricks, continuum]| continuum / bricks - 1.0)
    }
}

impl Found {
    /// A card in some units, with the dry planes, or those of the bond where it has none.
    pub fn card(&self, units: Units) -> Card {
        let planes = self.dry.as_ref().or(self.bonded.as_ref()).map_or(&[][..], |s| &s.planes);
        let mut card = Card::new(&self.name, units, &self.moduli, self.density, self.is_periodic);
        card.assumed = self.assumed.iter().chain(&self.warnings).cloned().collect();
        card.with_strength(units, planes)
    }
}

/// Finds the continuum of a panel of a valid case.
///
/// # Errors
/// As [`Texture::of`] and [`Texture::pattern`]; a wall that falls apart, equations that were not solved.
pub fn analyse(case: &Case, panel: usize, options: Options) -> Result<Found, ContinuumError> {
    let texture = Texture::of(case, options.heads)?;
    let pattern = texture.pattern(panel, options.repeated)?;
    let given = &case.panels[panel];
    let mut assumed = assumed(&texture, panel, options);
    let mut warnings: Vec<String> = options.brick.and_then(|[modulus, _]| odd_brick(modulus)).into_iter().collect();
    warnings.extend(options.pressure.and_then(odd_pressure));
    let own: Vec<&concio::wall::Block> = texture.wall.blocks.iter().filter(|b| b.panel == panel).collect();
    let ends = |axis: fn(&concio::wall::Block) -> [f64; 2]| {
        own.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |e, b| [e[0].min(axis(b)[0]), e[1].max(axis(b)[1])])
    };
    let (x, y) = (ends(|b| b.x), ends(|b| b.y));
    let size = [x[1] - x[0], y[1]];
    let courses = texture.wall.panels[panel].courses;
    let mean_length = own.iter().map(|b| b.length()).sum::<f64>() / own.len() as f64;
    let across = given.bricks.map_or(size[0] / (mean_length + given.mortar.head.si()), |bricks| bricks as f64);
    let share = match &pattern {
        Pattern::Running(_, cell) | Pattern::Repeated(cell) => cell.brick_share(),
        Pattern::Irregular(_) => {
            let of_panel = (0..texture.wall.blocks.len()).filter(|i| texture.wall.blocks[*i].panel == panel);
            let area: f64 = of_panel.map(|i| pitch_area(&texture.wall, i)).sum();
            let weight: f64 = own.iter().map(|b| b.weight()).sum();
            weight / (given.brick.specific_weight.si() * given.brick.thickness.si() * area)
        }
    };
    let thickness = given.brick.thickness.si();
    let volume = given.brick.specific_weight.si() * share / G;
    let density = Density { volume, area: volume * thickness };
    let pressure = options.pressure.unwrap_or_else(|| {
        let loaded = texture.wall.loaded();
        let all: f64 = loaded.iter().sum();
        let on: f64 = (0..loaded.len()).filter(|i| texture.wall.blocks[*i].panel == panel).map(|i| loaded[i]).sum();
        (case.load.top.per_length(all) * on / size[0] + 0.5 * density.area * G * size[1]) / thickness
    });
    let (bond, rigid, three) = match &pattern {
        Pattern::Running(bond, _) => ("running bond, overlap 1/2".to_string(), bond.moduli(), None),
        Pattern::Repeated(cell) => (cell_name(cell), Moduli::of_cell(cell)?, None),
        Pattern::Irregular(why) => {
            let (moduli, three) = of_windows(&texture, panel, thickness)?;
            warnings.push(format!(
                "{why}: these are means of three windows of the wall, no closed form; the scatter over windows is {}, and other windows give others",
                three.scatter.map(|s| format!("{:.1} %", 100.0 * s)).join(", ")
            ));
            if three.overlap {
                warnings.push("the windows overlap, the panel being short: the scatter is too small".into());
            }
            (format!("irregular: {why}"), moduli, Some(three))
        }
    };
    if options.brick.is_some() && three.is_some() {
        let error = InputError::new("bricks that deform are taken into account in bonds that repeat alone");
        return Err(error.allowed("no --brick-modulus").into());
    }
    let moduli = deformed(&rigid, options)?;
    if !given.openings.is_empty() {
        assumed.push(
            "openings are left out: the continuum is that of the masonry between them, and the mesh has the holes"
                .into(),
        );
    }
    let strengths = Ask { pattern: &pattern, pressure };
    let mut dry = None;
    let mut bonded = None;
    // Nothing is in open head joints, whatever their law says.
    let as_asked = |law: Strengths| match options.heads {
        Heads::Closed => law,
        Heads::Open => Strengths { head: None, ..law },
    };
    if let Some(law) = texture.bonded(panel).map(as_asked) {
        bonded = strengths.of(law, &mut warnings, "with its bond")?;
        warnings.push("strength with bond counts on the cohesion of all joints at once; brittle mortar cracks one joint after another and bears less".into());
    }
    let friction = as_asked(texture.dry(panel));
    if friction.bed.is_some_and(|l| l.friction > 0.0) {
        dry = strengths.of(friction, &mut warnings, "dry")?;
        assumed.push("friction is associative: what slides dilates too, so that strength is one from above; real joints bear less where nothing presses them together".into());
    }
    if friction.bed.is_none_or(|l| l.friction == 0.0) && texture.bonded(panel).is_none() {
        assumed.push("the file has neither friction nor a bond, and so no strength".into());
    }
    let bending = match (&pattern, friction.bed) {
        (Pattern::Running(bond, _), Some(law)) => Some(dry_bending(bond, law.friction, pressure * thickness)),
        _ => None,
    };
    let scale = match &pattern {
        Pattern::Running(_, cell) => Some(scale_check(case, panel, options, cell, courses, size, &rigid)?),
        Pattern::Repeated(cell) if cell.bricks.len() == 1 => {
            Some(scale_check(case, panel, options, cell, courses, size, &rigid)?)
        }
        _ => None,
    };
    let open_e1 = match &pattern {
        Pattern::Running(bond, _) => {
            let open = RunningBond { head: crate::Stiffness::open(), ..*bond }.moduli();
            deformed(&open, options)?.constants().map(|c| c.e1)
        }
        _ => None,
    };
    warnings.extend(stiffer_than_bricks(case, &texture, panel, options, &moduli)?);
    if texture.heads_part(panel) && options.heads == Heads::Closed {
        let open = open_e1.map_or(String::new(), |e| format!(" (E1 is then {:.4} GPa)", 1e-9 * e));
        warnings.push(format!(
            "head joints part freely: these moduli are those of closed ones, under pressure along the courses. In tension they are open{open}: see --heads open"
        ));
    }
    if let Some(excess) = scale.and_then(|s| s.excess()).filter(|e| *e > 0.05) {
        warnings.push(format!(
            "the continuum of this panel is {:.0} % too stiff beside its own bricks, whatever the mesh of the finite elements",
            100.0 * excess
        ));
    }
    Ok(Found {
        name: texture.wall.panels[panel].name.clone(),
        bond,
        is_periodic: three.is_none(),
        courses,
        across,
        size,
        constants: moduli.constants(),
        moduli,
        open_e1,
        density,
        windows: three,
        pressure,
        bonded,
        dry,
        bending,
        scale,
        assumed,
        warnings,
    })
}

/// Says of a pressure that was asked for [Pa] that masonry does not bear it, mostly by its unit.
fn odd_pressure(pressure: f64) -> Option<String> {
    let [given, meant] = [1e-6, 1e-9].map(|unit| rounded(unit * pressure));
    let most = 1e-6 * MOST_PRESSED;
    (pressure > MOST_PRESSED).then(|| {
        format!("a pressure of {given} MPa is more than walls bear, up to {most:.0} MPa: were {meant} MPa meant?")
    })
}

/// Says of bricks [Pa] that they are softer than adobe, or stiffer than stone, mostly by their unit.
fn odd_brick(modulus: f64) -> Option<String> {
    let [mega, giga] = [1e-6, 1e-9].map(|unit| rounded(unit * modulus));
    if modulus > STIFFEST {
        let most = 1e-9 * STIFFEST;
        return Some(format!(
            "bricks of {giga} GPa are stiffer than any brick or stone, which have up to {most:.0} GPa"
        ));
    }
    (modulus < SOFTEST).then(|| {
        let meant = (SOFTEST..=STIFFEST).contains(&(1e3 * modulus));
        let meant = if meant { format!(": were {mega} GPa meant?") } else { String::new() };
        let least = 1e-6 * SOFTEST;
        format!("bricks of {mega} MPa are softer than adobe, which has {least:.0} MPa or more; burnt bricks have 1 to 30 GPa{meant}")
    })
}

/// Moduli with the flexibility of the bricks, where it was asked for.
fn deformed(rigid: &Moduli, options: Options) -> Result<Moduli, ContinuumError> {
    options.brick.map_or(Ok(*rigid), |[modulus, nu]| rigid.in_series(modulus, nu))
}

/// A warning of a continuum that is stiffer than stone, with what `rigidity` has to do with it.
fn stiffer_than_bricks(
    case: &Case,
    texture: &Texture,
    panel: usize,
    options: Options,
    moduli: &Moduli,
) -> Result<Option<String>, ContinuumError> {
    let giga = |e: f64| rounded(1e-9 * e);
    let Some([e1, e2, ..]) = moduli.apparent().filter(|e| e[0].max(e[1]) > STIFFEST) else { return Ok(None) };
    let told = format!(
        "E1 is {} GPa and E2 {} GPa, and no brick or stone has more than {:.0} GPa",
        giga(e1),
        giga(e2),
        1e-9 * STIFFEST
    );
    let Some((key, times)) = texture.rigidity(panel).filter(|(_, times)| *times > 1.0) else {
        return Ok(Some(format!("{told}: --brick-modulus adds the flexibility of the bricks")));
    };
    let mut soft = case.clone();
    soft.joint.bed.rigidity = 1.0;
    soft.joint.head.rigidity = 1.0;
    let springs = soft.joint.changes.iter_mut().filter_map(|change| change.spring.as_mut());
    springs.filter_map(|spring| spring.rigidity.as_mut()).for_each(|rigidity| *rigidity = 1.0);
    let with_one = match Texture::of(&soft, options.heads)?.pattern(panel, options.repeated)? {
        Pattern::Running(bond, _) => Some(bond.moduli()),
        Pattern::Repeated(cell) => Some(Moduli::of_cell(&cell)?),
        Pattern::Irregular(_) => None,
    };
    let with_one = with_one.map(|rigid| deformed(&rigid, options)).transpose()?.and_then(|m| m.apparent());
    let with_one =
        with_one.map_or(String::new(), |[e1, e2, ..]| format!(" E1 is {} GPa, E2 {} GPa", giga(e1), giga(e2)));
    Ok(Some(format!(
        "{told}: {key} = {times} makes pressed `no-tension` joints so many times as stiff as `stiffness` says. With `rigidity = 1`{with_one}"
    )))
}

fn cell_name(cell: &Cell) -> String {
    match cell.bricks.len() {
        1 => "stack bond".into(),
        n => format!("listed courses that repeat, {n} bricks in a cell"),
    }
}

fn assumed(texture: &Texture, panel: usize, options: Options) -> Vec<String> {
    let mut all = vec![match options.brick {
        Some([e, nu]) => {
            format!("bricks deform, E {} GPa and nu {nu}: flexibilities added up, an estimate", rounded(1e-9 * e))
        }
        None => "bricks are rigid: nu12 = 0 follows from it".to_string(),
    }];
    all.push(
        "joints are intact and closed, as under the wall's load: where they open or slide the wall is softer".into(),
    );
    all.push("out of the plane joints shear as along it: k_s = k_t".into());
    if let Some(ratio) = texture.bed_ratio(panel) {
        let which = match ratio {
            r if (r - FREE_LAYER).abs() < 1e-3 => {
                ", E/G of mortar with nu = 0.2; a thin layer that bricks hold has 2.667"
            }
            r if (r - HELD_LAYER).abs() < 1e-3 => ", a thin layer of mortar with nu = 0.2 that bricks hold; E/G is 2.4",
            _ => "",
        };
        all.push(format!("k_n/k_t of bed joints is {}{which}", rounded(ratio)));
    }
    if options.heads == Heads::Open {
        all.push("head joints are open".into());
    }
    all.push("mortar has no weight: the density is that of the bricks over the pitch".into());
    if texture.model() == ModelKind::Shear {
        all.push(
            "the shear model, which this file names, holds rise and turn of blocks: its own shear stiffness is p t, not A1212, and it has no A2222".into(),
        );
    }
    all
}

/// Four decimals at most.
fn rounded(value: f64) -> f64 {
    (1e4 * value).round() / 1e4
}

/// What strength is asked of.
struct Ask<'a> {
    pattern: &'a Pattern,
    pressure: f64,
}

impl Ask<'_> {
    /// The domain of a law; none where there is no cell, or where nothing can be borne without pressure.
    fn of(
        &self,
        law: Strengths,
        warnings: &mut Vec<String>,
        which: &str,
    ) -> Result<Option<StrengthFound>, ContinuumError> {
        let (cell, closed) = match self.pattern {
            Pattern::Irregular(_) => return Ok(None),
            Pattern::Repeated(cell) => (cell, None),
            Pattern::Running(bond, cell) => {
                let both = law.bed.zip(law.head).filter(|(bed, head)| holds(bond, *bed, *head));
                (cell, both.map(|(bed, _)| planes(bond, bed)))
            }
        };
        let strong = |l: Option<Strength>| l.is_some_and(|l| l.cohesion > 0.0 && l.reached_tension() > 0.0);
        if self.pressure == 0.0 && !strong(law.bed) {
            warnings
                .push(format!("no strength {which}: nothing presses on the joints; give a pressure with --pressure"));
            return Ok(None);
        }
        let from = [0.0, -self.pressure, 0.0];
        let is_closed = closed.is_some();
        let found = match closed {
            Some(planes) => planes,
            None => {
                let programs = if cell.bricks.len() > SMALL_CELL { FEW_PROGRAMS } else { PROGRAMS };
                match Domain::new(cell, law.bed, law.head).planes(from, programs) {
                    Err(ContinuumError::Outside) => {
                        warnings.push(format!(
                            "no strength {which}: the wall does not bear its pressure of {:.4} MPa",
                            1e-6 * self.pressure
                        ));
                        return Ok(None);
                    }
                    Err(other) => return Err(other),
                    Ok(found) => {
                        warnings.extend(incomplete(found.excess, which, programs));
                        found.planes
                    }
                }
            }
        };
        // What is left of a bound that goes through this stress is rounding.
        let settled = |way: f64| if way.abs() < 1e-7 * self.pressure { 0.0 } else { way };
        let to = |direction: [f64; 3]| Some(settled(cut(&found, from, direction))).filter(|v| v.is_finite());
        let shear = [to([0.0, 0.0, 1.0]), to([0.0, 0.0, -1.0])].into_iter().flatten().reduce(f64::min);
        Ok(Some(StrengthFound { closed: is_closed, tension: to([1.0, 0.0, 0.0]), shear, planes: found }))
    }
}

/// Says of planes that were not all verified how far they go astray.
fn incomplete(excess: f64, which: &str, programs: usize) -> Option<String> {
    let how = match excess {
        part if part < 1e-5 => return None,
        part if part.is_finite() => format!("up to {:.2} % too far", 100.0 * part),
        _ => "without an end in a direction where the wall may have one".into(),
    };
    Some(format!(
        "strength {which}: after {programs} programs the planes still reach {how}; the domain has more of them than can be listed"
    ))
}

fn of_windows(texture: &Texture, panel: usize, thickness: f64) -> Result<(Moduli, Windows), ContinuumError> {
    let (three, overlap) = windows(&texture.wall, panel);
    let mut each = Vec::with_capacity(3);
    for w in &three {
        let found = window(&texture.wall, &texture.joints, &texture.stiffness, w);
        let keyed = |e| match e {
            ContinuumError::Input(concio::Error::Input(e)) => (*e).key(format!("panel[{panel}]")).into(),
            other => other,
        };
        each.push((w.x, found.map_err(keyed)?));
    }
    let mean = |i: usize, j: usize| each.iter().map(|(_, w)| w.membrane[i][j]).sum::<f64>() / 3.0;
    let membrane: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| mean(i, j)));
    let scatter = std::array::from_fn(|i| {
        let of = |w: &WindowModuli| (w.membrane[i][i] - membrane[i][i]).powi(2);
        (each.iter().map(|(_, w)| of(w)).sum::<f64>() / 2.0).sqrt() / membrane[i][i]
    });
    let none = [[0.0; 2]; 2];
    let moduli = Moduli { membrane, plate: [[0.0; 3]; 3], shear: none, polar: none, couple: None, thickness };
    Ok((moduli, Windows { each, scatter, overlap }))
}

fn scale_check(
    case: &Case,
    panel: usize,
    options: Options,
    cell: &Cell,
    courses: usize,
    size: [f64; 2],
    moduli: &Moduli,
) -> Result<Scale, ContinuumError> {
    let without_sides = scale(cell, courses)?;
    let mut alone = case.clone();
    alone.panels = vec![case.panels[panel].clone()];
    alone.panels[0].openings.clear();
    alone.panels[0].connection = None;
    alone.ties.clear();
    alone.forces.clear();
    alone.joint.changes.clear();
    (alone.joint.base, alone.joint.top) = (None, None);
    alone.load.beam = Beam::Tied;
    alone.output = concio::case::Output::default();
    // Changes that hold for the whole panel are in the cell's joints, not in this case.
    let texture = Texture::of(&alone, options.heads)?;
    let blocks = texture.wall.blocks.len();
    let stiffness: Vec<crate::Stiffness> = texture
        .joints
        .iter()
        .map(|j| {
            let like = |c: &&crate::Contact| (c.normal[0].abs() > 0.5) == j.kind.is_upright();
            cell.contacts.iter().find(like).map_or_else(crate::Stiffness::open, |c| c.stiffness)
        })
        .collect();
    let panel = if blocks > LARGEST {
        None
    } else {
        let bricks = panel_stiffness(&texture.wall, &texture.joints, &stiffness)?;
        Some([bricks, membrane_stiffness(&moduli.membrane, size, ELEMENTS)?])
    };
    Ok(Scale { without_sides, panel })
}

/// Errors of the continuum by numbers of courses, above 0.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleCurve {
    /// In a wall without sides: 1 − G_N/A1212.
    pub without_sides: Vec<(usize, f64)>,
    /// In a panel as wide as high, as nearly as whole bricks can be, under a level beam: 1 − K/K of the continuum. Only numbers of
    /// courses up to what is soon solved.
    pub panel: Vec<(usize, f64)>,
}

/// Errors of a panel's bond at other numbers of courses.
///
/// # Errors
/// Bonds with more than one brick in a cell; as [`analyse`].
pub fn scale_curve(
    case: &Case,
    panel: usize,
    options: Options,
    courses: &[usize],
) -> Result<ScaleCurve, ContinuumError> {
    let texture = Texture::of(case, options.heads)?;
    let cell = match texture.pattern(panel, false)? {
        Pattern::Running(_, cell) | Pattern::Repeated(cell) if cell.bricks.len() == 1 => cell,
        _ => {
            let error = InputError::new("an irregular bond has no other number of courses");
            return Err(error.key(format!("panel[{panel}].bond")).allowed("running, stack").into());
        }
    };
    let moduli = Moduli::of_cell(&cell)?;
    let mut curve = ScaleCurve { without_sides: Vec::new(), panel: Vec::new() };
    let given = &case.panels[panel];
    let [pitch, rise] =
        [given.brick.length.si() + given.mortar.head.si(), given.brick.height.si() + given.mortar.bed.si()];
    for &n in courses {
        curve.without_sides.push((n, -scale(&cell, n)?));
        let bricks = (n as f64 * rise / pitch).round() as usize;
        if bricks == 0 || bricks * n > LARGEST {
            continue;
        }
        let mut own = case.clone();
        own.panels[panel].openings.clear();
        (own.panels[panel].courses, own.panels[panel].bricks) = (Some(n), Some(bricks));
        let [width, height] = [bricks as f64 * pitch - given.mortar.head.si(), n as f64 * rise];
        let found = scale_check(&own, panel, options, &cell, n, [width, height], &moduli)?;
        if let Some([bricks, continuum]) = found.panel {
            curve.panel.push((n, 1.0 - bricks / continuum));
        }
    }
    Ok(curve)
}
