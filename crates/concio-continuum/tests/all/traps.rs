//! What is easily got wrong.

use concio::case::{Case, Syntax, from_str};
use concio_continuum::{Cell, Heads, Moduli, Options, RunningBond, Stiffness, analyse};
use concio_verified::agrees;
use proptest::prelude::*;

use crate::references::{S1, S1M, S3};

/// Trap 1: D is not t²/12 of A, and no E, G and t hold both.
#[test]
fn plates_are_stiffer_than_their_membrane_says() {
    let share = |m: &Moduli, i: usize| m.plate[i][i] / (m.thickness.powi(2) / 12.0 * m.membrane[i][i]);
    let (s1, s3) = (S1.bond().moduli(), S3.bond().moduli());
    agrees!(
        "Continuum: D1111 over t²/12 A1111; S1",
        "6.164496/4.582656 of the reference table",
        "",
        share(&s1, 0),
        6.164496 / 4.582656,
        1e-6
    );
    agrees!(
        "Continuum: D1111 over t²/12 A1111; S3",
        "2.929680/1.347840 of the reference table",
        "",
        share(&s3, 0),
        2.929680 / 1.347840,
        1e-6
    );
    assert!((share(&s1, 1) - 1.0).abs() < 1e-12);
    assert!(share(&s1, 2) > 4.0, "{}", share(&s1, 2));
    // 4 D1212 has p + q where 4 A1212 has 4 p q/(p + q), before k_s comes in.
    let t = s1.thickness;
    let [p, q] = [s1.polar[0][0] / t, s1.polar[1][1] / t];
    assert!((4.0 * s1.membrane[2][2] - 4.0 * t * p * q / (p + q)).abs() < 1e-3);
    let soft = |k: Stiffness| Stiffness { transverse: 1e-6 * k.transverse, ..k };
    let flat = RunningBond { bed: soft(S1.bed), head: soft(S1.head), ..S1.bond() }.moduli();
    agrees!(
        "Continuum: 4 D1212 without k_s",
        "t³/12 (p + q)",
        "N m",
        4.0 * flat.plate[2][2],
        t.powi(3) / 12.0 * (p + q),
        1e-5
    );
}

/// Trap 2: rigid bricks of overlap ½ have no Poisson's ratio; deformable ones do.
#[test]
fn rigid_bricks_do_not_shorten_sideways() {
    let m = S1.bond().moduli();
    assert_eq!((m.membrane[0][1], m.plate[0][1]), (0.0, 0.0));
    let cell = Moduli::of_cell(&S1.cell()).expect("moduli");
    assert!(cell.membrane[0][1].abs() < 1e-9 * cell.membrane[0][0]);
    assert_eq!(cell.constants().expect("constants").nu12, 0.0);
}

/// Trap 3: moduli are over the pitch, contacts those of bricks.
#[test]
fn mortar_between_the_bricks_counts() {
    let (with, without) = (S1M.bond(), S1.bond());
    assert_eq!((with.pitch, with.rise), (0.26, 0.065));
    assert!((with.contact - 0.12).abs() < 1e-12 && (with.head_height - 0.055).abs() < 1e-12);
    let less = |i: usize| 1.0 - with.moduli().membrane[i][i] / without.moduli().membrane[i][i];
    for i in 0..3 {
        assert!((0.07..0.14).contains(&less(i)), "{i}: {}", less(i));
    }
    // The brick's own size in the place of the pitch is 8 % off.
    let wrong = RunningBond { pitch: 0.25, rise: 0.055, ..with }.moduli();
    assert!((wrong.membrane[1][1] / with.moduli().membrane[1][1] - 1.0).abs() > 0.07);
}

/// Trap 4: k_t of the head joint moves E1 not at all and G little; k_n′ moves E1 by threefold.
#[test]
fn open_head_joints_matter_along_the_courses() {
    let with = |normal: f64, tangential: f64| {
        let head = Stiffness { normal, tangential, transverse: tangential };
        RunningBond { head, ..S1.bond() }.moduli().constants().expect("constants")
    };
    let whole = with(86.4e9, 36e9);
    let no_shear = with(86.4e9, 0.0);
    assert_eq!(whole.e1, no_shear.e1);
    assert!((no_shear.g12 / whole.g12 - 1.0).abs() < 0.03);
    assert!((whole.e1 / with(0.0, 0.0).e1 - 3.4).abs() < 1e-6);
}

/// Bricks of 260 × 65 × 120 mm with 10 mm of mortar: b = 270, a = 75, c = 125, h_c = 65 mm.
fn with_mortar(bed: &str, head: &str) -> Case {
    let text = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 8\nbricks = 4\n\
         brick = {{ length = 0.26, height = 0.065, thickness = 0.12, specific_weight = 18e3 }}\nmortar = {{ bed = 0.01, head = 0.01 }}\n\
         [joint]\nbed = {{ {bed} }}\nhead = {{ {head} }}\n[motion]\nduration = 1.0\n"
    );
    from_str(&text, Syntax::Toml, None).expect("a wall").case
}

/// Bricks that deform do so beside open head joints too.
#[test]
fn open_head_joints_have_the_bricks_of_closed_ones() {
    let case =
        with_mortar("law = \"elastic\", stiffness = \"36 N/mm3\"", "law = \"elastic\", stiffness = \"86.4 N/mm3\"");
    let open_e1 = |brick: Option<[f64; 2]>| {
        analyse(&case, 0, Options { brick, ..Options::default() }).expect("a continuum").open_e1.expect("running bond")
    };
    // (H1) without head joints: k_t c b/(2a) = 36e9 · 0.125 · 0.27/0.15.
    let beds = 8.1e9;
    agrees!("Continuum: E1 with open head joints; rigid bricks", "k_t c b/(2a)", "Pa", open_e1(None), beds, 1e-9);
    let series = 1.0 / (1.0 / beds + 1.0 / 10e9);
    agrees!(
        "Continuum: E1 with open head joints; bricks of 10 GPa",
        "1/(2a/(k_t c b) + 1/E_b)",
        "Pa",
        open_e1(Some([10e9, 0.2])),
        series,
        1e-9
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    /// Nothing in head joints is never stiffer than something, and is what open head joints are asked for.
    #[test]
    fn open_head_joints_are_never_stiffer(
        bed in 0.1f64..500.0, head in 0.01f64..500.0, modulus in proptest::option::of(0.5e9f64..80e9), nu in 0.0f64..0.45,
    ) {
        let of = |stiffness: f64| format!("law = \"elastic\", stiffness = \"{stiffness} N/mm3\"");
        let case = with_mortar(&of(bed), &of(head));
        let with = |heads: Heads| {
            let options = Options { heads, brick: modulus.map(|e| [e, nu]), ..Options::default() };
            analyse(&case, 0, options).expect("a continuum")
        };
        let (closed, open) = (with(Heads::Closed), with(Heads::Open));
        let (told, e1) = (closed.open_e1.expect("running bond"), closed.constants.expect("constants").e1);
        prop_assert!(told <= e1 * (1.0 + 1e-12), "open {told}, closed {e1}");
        let asked = open.constants.expect("constants").e1;
        prop_assert!((told / asked - 1.0).abs() < 1e-9, "told {told}, asked {asked}");
    }
}

/// `rigidity` of pressed joints enters as the law has it, and a continuum stiffer than stone is told with it.
#[test]
fn a_continuum_stiffer_than_stone_is_told() {
    let of = |bed: &str, head: &str| {
        let found = analyse(&with_mortar(bed, head), 0, Options::default()).expect("a continuum");
        let told = found.warnings.iter().filter(|w| w.contains("no brick or stone")).cloned().collect::<Vec<_>>();
        (found.constants.expect("constants").e1, told)
    };
    let bed = "law = \"elastic\", stiffness = \"36 N/mm3\"";
    let head = "law = \"no-tension\", stiffness = \"86.4 N/mm3\"";
    // (H1): 86.4e9 · 0.065 · 0.27/0.075 = 20.2176e9 for the head joints, 8.1e9 for the beds.
    let (e1, told) = of(bed, head);
    agrees!(
        "Continuum: E1 of pressed head joints",
        "κ k_n′ h_c b/a + k_t c b/(2a)",
        "Pa",
        e1,
        20_217.6e9 + 8.1e9,
        1e-9
    );
    // E2 = 2 k_n c a/b = 2 · 2.4 · 36e9 · 0.125 · 0.075/0.27 = 6 GPa.
    assert_eq!(
        told,
        [
            "E1 is 20225.7 GPa and E2 6 GPa, and no brick or stone has more than 70 GPa: joint.head.rigidity = 1000 makes pressed \
          `no-tension` joints so many times as stiff as `stiffness` says. With `rigidity = 1` E1 is 28.3176 GPa, E2 6 GPa"
        ]
    );
    let (e1, told) = of(bed, &format!("{head}, rigidity = 1"));
    agrees!("Continuum: E1 of head joints, rigidity 1", "k_n′ h_c b/a + k_t c b/(2a)", "Pa", e1, 28.3176e9, 1e-9);
    assert!(told.is_empty(), "{told:?}");
    let (_, told) = of(bed, "law = \"elastic\", stiffness = \"864 N/mm3\"");
    assert!(told.len() == 1 && told[0].ends_with("--brick-modulus adds the flexibility of the bricks"), "{told:?}");
}

/// Trap 8: the shear model holds the vertical motion and the rotation of blocks: p t is its shear stiffness.
#[test]
fn the_shear_model_has_another_shear_stiffness() {
    let m = S1.bond().moduli();
    // Bricks that only slide: bed springs alone work in shear, all in series upwards.
    let bed = S1.bed.tangential;
    let by_hand = S1.brick[2] * bed * S1.brick[1];
    agrees!("Continuum: shear stiffness of the shear model", "k_t a t", "N/m", m.polar[0][0], by_hand, 1e-12);
    assert!(m.polar[0][0] > m.membrane[2][2]);
}

/// Trap 10: bricks that do not turn are four times too stiff in shear.
#[test]
fn bricks_turn_under_shear() {
    let m = S1.bond().moduli();
    let held = 0.25 * (m.polar[0][0] + m.polar[1][1]);
    assert!((3.8..4.1).contains(&(held / m.membrane[2][2])), "{}", held / m.membrane[2][2]);
    // The cell finds the rotation by itself.
    let free = Moduli::of_cell(&Cell::shifted(0.26, 0.065, 0.5, &S1.laying()).expect("a cell")).expect("moduli");
    agrees!(
        "Continuum: shear of bricks that turn",
        "t p q/(p + q)",
        "N/m",
        free.membrane[2][2],
        m.membrane[2][2],
        1e-9
    );
}
