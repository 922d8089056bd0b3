//! Cards: round trip, units, what each format holds and refuses.

use concio_continuum::{Card, Cell, Density, Format, Moduli, Strength, Units, planes};
use concio_verified::agrees;

use crate::references::{S1, S1M};

const DENSITY: Density = Density { volume: 1800.0, area: 216.0 };

fn card(units: Units) -> Card {
    let bond = S1.bond();
    let law = Strength::coulomb(0.1e6, 0.6);
    Card::new("north wall", units, &bond.moduli(), DENSITY, true).with_strength(units, &planes(&bond, law))
}

#[test]
fn json_reads_back_to_the_same_numbers() {
    for units in ["SI", "N-mm", "kN-m", "lbf-in", "kip-ft"].map(|u| Units::parse(u).expect("units")) {
        let card = card(units);
        let text = card.write(Format::Json).expect("a card");
        assert_eq!(Card::from_json(&text).expect("a card"), card, "{}", card.units);
    }
    let wrong = Card::from_json("{}").expect_err("no card").to_string();
    assert!(wrong.contains("concio continuum"), "{wrong}");
}

#[test]
fn units_are_those_of_the_user() {
    let of = |units: &str| card(Units::parse(units).expect("units"));
    let (mm, metres, inches) = (of("N-mm-t"), of("kN-m"), of("lbf-in"));
    let c = |card: &Card| card.constants.expect("constants");
    agrees!("Continuum: E1 on a card; N-mm", "31,824 MPa", "MPa", c(&mm).e1, 31_824.0, 1e-12);
    agrees!("Continuum: E1 on a card; kN-m", "31,824 MPa", "kPa", c(&metres).e1, 31_824e3, 1e-12);
    agrees!(
        "Continuum: E1 on a card; lbf-in",
        "31,824 MPa over 6894.757 Pa",
        "psi",
        c(&inches).e1,
        31_824e6 / 6_894.757_293_168,
        1e-9
    );
    agrees!("Continuum: density on a card; N-mm", "1800 kg/m³", "t/mm³", mm.density.volume, 1.8e-9, 1e-12);
    agrees!("Continuum: density on a card; kN-m", "1800 kg/m³", "t/m³", metres.density.volume, 1.8, 1e-12);
    agrees!("Continuum: D1111 on a card; N-mm", "6.164496 MN m", "N mm", mm.moduli.plate[0][0], 6.164496e9, 1e-9);
    assert_eq!((mm.unit_of_mass.as_str(), metres.unit_of_mass.as_str()), ("t", "t"));
    assert_eq!(mm.moduli.thickness, 120.0);
    agrees!("Continuum: strength on a card; N-mm", "0.1 MPa", "MPa", mm.strength[0].b, 0.1, 1e-12);
}

#[test]
fn units_that_are_none_are_refused() {
    for text in ["", "mm", "N", "N-mm-kg", "N-furlong", "N-mm-t-s", "n-mm"] {
        let error = Units::parse(text).expect_err(text).to_string();
        assert!(error.contains("allowed"), "{text}: {error}");
    }
    assert_eq!(Units::parse("N-mm-t").expect("units"), Units::parse("N-mm").expect("units"));
}

/// Numbers after a keyword line, up to the next.
fn numbers(text: &str, keyword: &str) -> Vec<f64> {
    let rows = text.lines().skip_while(|l| !l.starts_with(keyword)).skip(1).take_while(|l| !l.starts_with('*'));
    rows.flat_map(|l| l.split(',').filter(|w| !w.trim().is_empty()).map(|w| w.trim().parse().expect("a number")))
        .collect()
}

#[test]
fn keyword_cards_hold_the_constants() {
    let card = card(Units::parse("N-mm").expect("units"));
    let c = card.constants.expect("constants");
    let close = |found: &[f64], expected: &[f64]| {
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(f, e)| assert!((f - e).abs() <= 1e-9 * e.abs(), "{f} {e}"));
    };
    let lamina = card.write(Format::Lamina).expect("a card");
    close(&numbers(&lamina, "*ELASTIC, TYPE=LAMINA"), &[c.e1, c.e2, c.nu12, c.g12, c.g13, c.g23]);
    close(&numbers(&lamina, "*DENSITY"), &[1.8e-9]);
    assert!(lamina.contains("NAME=CONCIO_NORTH_WALL") && lamina.contains("units: N-mm, mass t"), "{lamina}");
    // What one E, G and t cannot hold stands beside the numbers.
    let flat = lamina.replace("\n**", "");
    assert!(flat.contains("1.345") && flat.contains("shell card"), "{lamina}");
    assert!(lamina.lines().all(|l| l.chars().count() <= 110), "{lamina}");
    let engineering = card.write(Format::Engineering).expect("a card");
    close(&numbers(&engineering, "*ELASTIC"), &[c.e1, c.e2, c.e2, 0.0, 0.0, 0.0, c.g12, c.g13, c.g23]);
    let shell = card.write(Format::Shell).expect("a card");
    let m = &card.moduli;
    let half = numbers(&shell, "*SHELL GENERAL SECTION");
    assert_eq!(half.len(), 21);
    let at = |i: usize, j: usize| half[j * (j + 1) / 2 + i];
    for i in 0..6 {
        for j in i..6 {
            let expected = match (i < 3, j < 3) {
                (true, true) => m.membrane[i][j],
                (false, false) => m.plate[i - 3][j - 3],
                _ => 0.0,
            };
            assert!((at(i, j) - expected).abs() <= 1e-9 * expected.abs(), "{i} {j}");
        }
    }
    close(&numbers(&shell, "*TRANSVERSE SHEAR"), &[m.shear[0][0], m.shear[1][1], 0.0]);
    // Keyword readers take no line of data of more than 16 numbers, no field of more than 20 characters, no line of more than 256 of comments.
    for line in [&lamina, &engineering, &shell].into_iter().flat_map(|t| t.lines()).filter(|l| !l.starts_with("**")) {
        assert!(line.split(',').count() <= 9 && line.split(',').all(|f| f.trim().len() <= 35), "{line}");
    }
    let tcl = card.write(Format::OpenSees).expect("a card");
    assert!(tcl.contains("nDMaterial ElasticOrthotropic $concioTag 3.182400000E4 5.616000000E3"), "{tcl}");
}

#[test]
fn a_bond_that_leans_has_no_lamina() {
    let cell = Cell::shifted(0.25, 0.055, 0.25, &S1M.laying()).expect("a cell");
    let m = Moduli::of_cell(&cell).expect("moduli");
    let card = Card::new("p1", Units::SI, &m, DENSITY, true);
    for format in [Format::Lamina, Format::Engineering, Format::OpenSees] {
        let error = card.write(format).expect_err("coupled").to_string();
        assert!(error.contains("coupled") && error.contains("shell"), "{error}");
    }
    assert!(card.write(Format::Shell).is_ok() && card.write(Format::Json).is_ok());
    let window = Card::new("p1", Units::SI, &S1.bond().moduli(), DENSITY, false);
    let error = window.write(Format::Shell).expect_err("not known").to_string();
    assert!(error.contains("not known") && window.write(Format::Json).is_ok(), "{error}");
}
