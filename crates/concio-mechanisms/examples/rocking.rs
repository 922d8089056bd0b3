//! A façade under a record, in both signs: does it lift off, how far does it turn, is the answer a matter of chance, and at which scale of the record does it
//! fall? Then the same wall with a tie.
//!
//!     cargo run --release -p concio-mechanisms --example rocking -- RECORD [THICKNESS HEIGHT]
//!
//! RECORD is a file of any format that Concio reads, of its first component; thickness and height in metres.

use std::path::Path;

use concio::ground::record::TextOptions;
use concio::ground::signal::from_record;
use concio::ground::{formats, measure};
use concio_mechanisms::rocking::{
    Back, Mechanism, Positive, Repeated, Restitution, Rocking, Setting, Shaking, Spot, Stop, Tie, Verdict,
};

/// Scales of the record that are tried.
const SCALES: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("usage: rocking RECORD [THICKNESS HEIGHT]")?;
    let mut number = |default: f64| arguments.next().map_or(Ok(default), |text| text.parse());
    let (thickness, height) = (number(0.5)?, number(5.0)?);

    let record = formats::read(Path::new(&path), &TextOptions::default())?.swap_remove(0);
    let motion = from_record(&record);
    println!("{} {}: peak {:.2} m/s²", record.event, record.station, measure(&record).pga.value.abs());

    let bare = Mechanism::wall(thickness, height, 1.0, 20e3, Back::SideWalls(Restitution::Block));
    let tie = Tie { yield_force: Some(8e3), ..Tie::elastic(Spot::lower([0.0, 0.95 * height]), 2e6) };
    let tied = Mechanism { ties: vec![tie], ..bare.clone() };
    for (name, mechanism) in [("bare", &bare), ("with a tie of 8 kN/m", &tied)] {
        let rocking = Rocking::new(mechanism)?;
        println!(
            "\n{thickness} m by {height} m, {name}: lifts off at {:.3} g, e = {:.3}",
            rocking.multiplier(),
            rocking.restitution()
        );
        for positive in [Positive::Inwards, Positive::Outwards] {
            let shaking = Shaking::across(&motion, positive);
            let setting = Setting::default();
            let lift_off = rocking.first_lift_off(&shaking, &setting)?;
            println!(
                "  positive {positive:?}: first lift-off at {:.3} of the record",
                lift_off.map_or(f64::INFINITY, |l| l.scale)
            );
            for scale in SCALES {
                let repeated = rocking.repeat(&shaking.times(scale), &setting)?;
                println!("    {scale:4} of the record: {}", said(&repeated));
            }
        }
    }
    Ok(())
}

fn said(repeated: &Repeated) -> String {
    let response = &repeated.response;
    let peak = response.peak.over_d0.unwrap_or(f64::NAN);
    match (repeated.verdict, response.stop) {
        (Verdict::Falls, Stop::Fallen { time, beyond }) => {
            format!("falls to the ground at {time:.1} s, beyond d0 for good from {beyond:.1} s")
        }
        (Verdict::Chance, _) => {
            let [fell, runs] = repeated.fell;
            format!("a matter of chance: {fell} of {runs} runs within a thousandth of the record fall")
        }
        _ if peak == 0.0 => "rests".into(),
        _ => format!(
            "turns up to {peak:.3} d0 ({:.0} mm at the top) at {:.1} s; {} impacts, residual {:.0e}",
            1e3 * response.peak.displacement,
            response.peak.time,
            response.counts.impacts,
            response.relative_residual()
        ),
    }
}
