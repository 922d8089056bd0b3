//! `concio continuum`.

use std::path::Path;

use concio::case::CaseFile;
use concio::{Error, InputError};
use concio_continuum::{
    ContinuumError, Format, Found, Heads, Moduli, Options, Plane, StrengthFound, Units, analyse, scale_curve,
};
use serde_json::{Value, json};

use super::wall_file;
use crate::args::{CardFormat, Continuum, ContinuumHeads, SINGLE};
use crate::draw::chart::{Axis, Line, Panel, Sheet, draw};
use crate::draw::output::POINTS;
use crate::failure::Failure;
use crate::files;
use crate::format::{fixed, line, pairs, percent, si, significant};

/// Numbers of courses of the figure.
const COURSES: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
/// Height of its plot [pt].
const HEIGHT: f64 = 150.0;

/// Finds the continuum of the panels of a wall.
pub fn continuum(args: &Continuum) -> Result<(), Failure> {
    let units = units(args)?;
    if let Some(out) = &args.figure {
        files::guard(out, "svg", &[&args.file])?;
    }
    let file = wall_file::read_at_rest(&args.file)?;
    wall_file::doubt(&file);
    let (chosen, found) = found(args, &file)?;
    if let Some(format) = args.card {
        let one = alone(args, &found)?;
        one.warnings.iter().for_each(|w| files::note(&format!("warning: {w}")));
        let card = one.card(units).write(format_of(format)).map_err(|e| failure(e.into(), &file, &args.file))?;
        if format == CardFormat::Json { files::print_json(&card)? } else { files::print(&card)? }
    } else if args.json {
        files::print_json(&format!("{:#}\n", result(&found)))?;
    } else {
        let title = if file.case.title.is_empty() { String::new() } else { format!("{}\n\n", line(&file.case.title)) };
        let texts: Vec<String> = found.iter().map(text).collect();
        files::print(&format!("{title}{}", texts.join("\n")))?;
    }
    if let Some(out) = &args.figure {
        figure(&file, &chosen, options(args), args, out)?;
    }
    Ok(())
}

/// What `--json` prints; with `--card` the text of the card.
pub fn value(args: &Continuum, file: &CaseFile) -> Result<Value, Failure> {
    let (_, found) = found(args, file)?;
    let Some(format) = args.card else { return Ok(result(&found)) };
    let card = alone(args, &found)?.card(units(args)?).write(format_of(format));
    Ok(card.map_err(|e| failure(e.into(), file, &args.file))?.into())
}

/// Places of the panels that are asked for, and what is found of each.
fn found(args: &Continuum, file: &CaseFile) -> Result<(Vec<usize>, Vec<Found>), Failure> {
    let chosen = panels(args, file)?;
    let mut found = Vec::with_capacity(chosen.len());
    for &panel in &chosen {
        found.push(analyse(&file.case, panel, options(args)).map_err(|e| failure(e, file, &args.file))?);
    }
    Ok((chosen, found))
}

/// The one panel that a card is of.
fn alone<'f>(args: &Continuum, found: &'f [Found]) -> Result<&'f Found, Failure> {
    let [one] = found else {
        let names: Vec<&str> = found.iter().map(|f| f.name.as_str()).collect();
        let error = InputError::new(format!("a card is that of one panel, and the wall has {}", found.len()));
        return Err(error.in_file(&args.file).key("--panel").allowed(names.join(", ")).into());
    };
    Ok(one)
}

fn units(args: &Continuum) -> Result<Units, Failure> {
    Units::parse(&args.units).map_err(|e| match e {
        Error::Input(e) => Failure::from((*e).key("--units")),
        other => other.into(),
    })
}

fn result(found: &[Found]) -> Value {
    let all: Vec<Value> = found.iter().map(panel).collect();
    json!({ "version": env!("CARGO_PKG_VERSION"), "panels": all })
}

fn options(args: &Continuum) -> Options {
    Options {
        heads: match args.heads {
            ContinuumHeads::Closed => Heads::Closed,
            ContinuumHeads::Open => Heads::Open,
        },
        repeated: args.repeated,
        brick: args.brick_modulus.map(|e| [e, args.brick_poisson]),
        pressure: args.pressure,
    }
}

fn format_of(format: CardFormat) -> Format {
    match format {
        CardFormat::Json => Format::Json,
        CardFormat::Lamina => Format::Lamina,
        CardFormat::Engineering => Format::Engineering,
        CardFormat::Shell => Format::Shell,
        CardFormat::Opensees => Format::OpenSees,
    }
}

/// Places of the panels that are asked for.
fn panels(args: &Continuum, file: &CaseFile) -> Result<Vec<usize>, Failure> {
    let names: Vec<String> = (0..file.case.panels.len()).map(|k| file.case.panel_name(k)).collect();
    let Some(name) = &args.panel else { return Ok((0..names.len()).collect()) };
    match names.iter().position(|n| n == name) {
        Some(panel) => Ok(vec![panel]),
        None => {
            let error = InputError::new(format!("no panel is called `{name}`")).in_file(&args.file).key("--panel");
            Err(error.allowed(names.join(", ")).into())
        }
    }
}

fn failure(error: ContinuumError, file: &CaseFile, path: &Path) -> Failure {
    match error {
        ContinuumError::Input(e) => match wall_file::all(file, file.locate(e)) {
            Failure::Input(all) => Failure::Input(all.into_iter().map(|e| e.in_file(path)).collect()),
            other => other,
        },
        ContinuumError::FallsApart => {
            let error = InputError::new(error.to_string()).in_file(path);
            error.allowed("joints that hold in both directions; a running bond does with open head joints").into()
        }
        other => Failure::Other(other.to_string(), None),
    }
}

/// A panel for people.
fn text(f: &Found) -> String {
    let mm = |metres: f64| format!("{} mm", significant(1e3 * metres, 4));
    let [width, height] = f.size;
    let mut rows = vec![
        ("panel", format!("{}: {}", line(&f.name), f.bond)),
        (
            "size",
            format!(
                "{} × {}, {} thick; {} courses of {} bricks in the mean",
                si(width, "m"),
                si(height, "m"),
                mm(f.moduli.thickness),
                f.courses,
                significant(f.across, 3)
            ),
        ),
    ];
    moduli(f, &mut rows);
    rows.push((
        "density",
        format!("{} kg/m³, {} kg/m² of wall", significant(f.density.volume, 5), significant(f.density.area, 5)),
    ));
    strength(f, &mut rows);
    if let Some(scale) = &f.scale {
        let panel = match (scale.excess(), scale.panel) {
            (Some(excess), Some([bricks, continuum])) => format!(
                "; as a panel that stands alone under a level beam {} of bricks, {} of its continuum, {} too stiff",
                si(bricks, "N/m"),
                si(continuum, "N/m"),
                percent(excess)
            ),
            _ => "; this panel is too large to be held against its bricks".into(),
        };
        rows.push((
            "scale",
            format!(
                "G12 of {} courses without sides is {} below A1212/t{panel}",
                f.courses,
                percent(-scale.without_sides)
            ),
        ));
    }
    rows.extend(f.assumed.iter().map(|a| ("assumed", a.clone())));
    rows.extend(f.warnings.iter().map(|w| ("but", w.clone())));
    pairs(&rows)
}

fn moduli(f: &Found, rows: &mut Vec<(&'static str, String)>) {
    let Moduli { membrane: a, plate: d, shear, polar, couple, .. } = &f.moduli;
    let zero = |v: f64, most: f64| if v.abs() < 1e-9 * most { 0.0 } else { v };
    let coupled = |m: &[[f64; 3]; 3], unit: &str| {
        let most = m[0][0].max(m[1][1]);
        let [p, q] = [zero(m[0][2], most), zero(m[1][2], most)];
        if p == 0.0 && q == 0.0 { String::new() } else { format!(", 1112 {}, 2212 {}", si(p, unit), si(q, unit)) }
    };
    let four = |m: &[[f64; 3]; 3], unit: &str| {
        format!(
            "1111 {}, 2222 {}, 1212 {}, 1122 {}{}",
            si(m[0][0], unit),
            si(m[1][1], unit),
            si(m[2][2], unit),
            si(zero(m[0][1], m[0][0]), unit),
            coupled(m, unit)
        )
    };
    rows.push(("membrane A", four(a, "N/m")));
    match &f.constants {
        Some(c) => rows.push((
            "constants",
            format!(
                "E1 {}, E2 {}, ν12 {}, G12 {}, G13 {}, G23 {}",
                si(c.e1, "Pa"),
                si(c.e2, "Pa"),
                significant(c.nu12, 4),
                si(c.g12, "Pa"),
                si(c.g13, "Pa"),
                si(c.g23, "Pa")
            ),
        )),
        None => {
            if let Some([e1, e2, nu, g]) = f.moduli.apparent() {
                rows.push((
                    "apparent",
                    format!(
                        "E1 {}, E2 {}, ν12 {}, G12 {}; stretching and shear are coupled, and a lamina leaves that out",
                        si(e1, "Pa"),
                        si(e2, "Pa"),
                        significant(nu, 4),
                        si(g, "Pa")
                    ),
                ));
            }
        }
    }
    if let Some(open) = f.open_e1 {
        rows.push(("head joints open", format!("E1 {}", si(open, "Pa"))));
    }
    if let Some(w) = &f.windows {
        for (x, found) in &w.each {
            rows.push((
                "window",
                format!(
                    "{} … {}: A1111 {}, A2222 {}, A1212 {}; {} bricks inside",
                    si(x[0], "m"),
                    si(x[1], "m"),
                    si(found.membrane[0][0], "N/m"),
                    si(found.membrane[1][1], "N/m"),
                    si(found.membrane[2][2], "N/m"),
                    found.inside
                ),
            ));
        }
        rows.push((
            "scatter",
            format!("{}, {}, {} of the mean", percent(w.scatter[0]), percent(w.scatter[1]), percent(w.scatter[2])),
        ));
    }
    if f.is_periodic {
        let t = f.moduli.thickness;
        let over = |i: usize| significant(d[i][i] / (t * t / 12.0 * a[i][i]), 4);
        rows.push(("plate D", four(d, "N m")));
        rows.push((
            "",
            format!("{}, {}, {} times t²/12 A: one E, G and t cannot hold both", over(0), over(1), over(2)),
        ));
        rows.push(("shear F", format!("11 {}, 22 {}", si(shear[0][0], "N/m"), si(shear[1][1], "N/m"))));
        rows.push(("Cosserat", {
            let c = couple.map_or(String::new(), |c| format!("; C1 {}, C2 {}", si(c.c1, "N"), si(c.c2, "N")));
            format!("p t {}, q t {}{c}", si(polar[0][0], "N/m"), si(polar[1][1], "N/m"))
        }));
    }
}

fn strength(f: &Found, rows: &mut Vec<(&'static str, String)>) {
    let at = |s: &StrengthFound| {
        let of = |v: Option<f64>| v.map_or("without end".into(), |v| si(v, "Pa"));
        let by = if s.closed { "(H5) to (H7)" } else { "linear programs of the cell" };
        format!("σ11 up to {}, |σ12| up to {}; by {by}", of(s.tension), of(s.shear))
    };
    let plane = |p: &Plane| {
        let mut sum = String::new();
        for (a, name) in p.a.iter().zip(["σ11", "σ22", "σ12"]).filter(|(a, _)| a.abs() > 5e-7) {
            let sign = match (sum.is_empty(), *a < 0.0) {
                (true, false) => "",
                (true, true) => "−",
                (false, false) => " + ",
                (false, true) => " − ",
            };
            sum += &format!("{sign}{} {name}", fixed(a.abs(), 4));
        }
        format!("{sum} ≤ {}", si(if p.b.abs() < 1.0 { 0.0 } else { p.b }, "Pa"))
    };
    for (name, found) in [("strength, bonded", &f.bonded), ("strength, dry", &f.dry)] {
        let Some(found) = found else { continue };
        rows.push((name, format!("under {} on the beds {}", si(f.pressure, "Pa"), at(found))));
        rows.extend(found.planes.iter().map(|p| ("", plane(p))));
    }
    if let Some(b) = f.bending {
        rows.push((
            "bending, dry",
            format!("M11 {}, M22 {} per length, bricks that do not crush", si(b.m11, "N"), si(b.m22, "N")),
        ));
    }
}

/// A panel as JSON.
fn panel(f: &Found) -> Value {
    json!({
        "name": f.name,
        "bond": f.bond,
        "periodic": f.is_periodic,
        "courses": f.courses,
        "bricks_across": f.across,
        "size": f.size,
        "membrane": f.moduli.membrane,
        "plate": f.is_periodic.then_some(f.moduli.plate),
        "transverse_shear": f.is_periodic.then_some(f.moduli.shear),
        "cosserat_shear": f.is_periodic.then_some(f.moduli.polar),
        "couple": f.moduli.couple,
        "thickness": f.moduli.thickness,
        "constants": f.constants,
        "apparent": f.moduli.apparent(),
        "e1_head_joints_open": f.open_e1,
        "density": f.density,
        "windows": f.windows,
        "pressure": f.pressure,
        "strength_bonded": f.bonded,
        "strength_dry": f.dry,
        "bending_dry": f.bending,
        "scale": f.scale,
        "assumed": f.assumed,
        "warnings": f.warnings,
    })
}

/// Draws how the error of the continuum falls with the number of courses, in a wall without sides and in a panel that stands
/// alone and is as wide as high.
fn figure(file: &CaseFile, chosen: &[usize], options: Options, args: &Continuum, out: &Path) -> Result<(), Failure> {
    let [panel] = chosen else {
        let error = InputError::new("a figure is that of one panel").in_file(&args.file).key("--panel");
        return Err(error.allowed("the name of a panel").into());
    };
    let curve = scale_curve(&file.case, *panel, options, &COURSES).map_err(|e| failure(e, file, &args.file))?;
    let heading = "error of the continuum";
    let line = |points: &[(usize, f64)], style: usize| {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(n, e)| (*n as f64, *e)).unzip();
        Line { x: x.into(), y: y.into(), style }
    };
    // Through the last point, so that curves of order 1 come to it.
    let last = curve.without_sides.last().map_or(1.0, |p| p.1 * p.0 as f64);
    let slope: Vec<(usize, f64)> = COURSES.iter().map(|n| (*n, last / *n as f64)).collect();
    let all = || curve.without_sides.iter().chain(&curve.panel).chain(&slope).map(|p| p.1);
    let decade = |value: f64, up: f64| 10f64.powf((value.log10() + up).floor());
    let ends = [decade(all().fold(f64::INFINITY, f64::min), 0.0), decade(all().fold(0.0, f64::max), 1.0)];
    let axis = |quantity: &str, range: [f64; 2]| Axis {
        quantity: quantity.into(),
        unit: "",
        range: Some(range),
        logarithmic: true,
    };
    let sheet = Sheet {
        title: format!(
            "Error of the continuum over the number of courses, panel {}",
            line_of(&file.case.panel_name(*panel))
        ),
        legend: vec!["wall without sides".into(), "panel as wide as high".into(), "order 1".into()],
        panels: vec![Panel {
            heading: heading.into(),
            x: axis("courses", [COURSES[0] as f64, COURSES[COURSES.len() - 1] as f64]),
            y: axis("relative error", ends),
            lines: vec![line(&curve.without_sides, 0), line(&curve.panel, 1), line(&slope, 2)],
            rising: true,
            bare: false,
            marked: true,
        }],
        columns: 1,
        width: SINGLE * POINTS,
        height: Some(HEIGHT),
    };
    files::write(out, &draw(&sheet).outlined().map_err(|e| Failure::Other(e, None))?)
}

fn line_of(name: &str) -> String {
    line(name).into_owned()
}
