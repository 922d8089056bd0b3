//! A small file of each format with numbers that are known, for the tests that go over all of them.

use concio::ground::{Format, Record};

use super::writers::*;

pub const DT: f64 = 0.01;
/// The g of the archives [m/s²].
pub const G: f64 = 9.80665;

/// A file, and what is in it.
pub struct Fixture {
    pub name: &'static str,
    pub format: Format,
    pub text: String,
    pub channels: Vec<Channel>,
}

/// A component as it is read.
pub struct Channel {
    pub label: &'static str,
    pub dt: f64,
    /// Acceleration [m/s²].
    pub values: Vec<f64>,
    /// A unit of the last digit that the layout writes, of one [1] and of all numbers [m/s²].
    pub digit: [f64; 2],
}

impl Channel {
    /// Each sample within half of the last digit that the layout writes: relative where it writes exponents.
    pub fn assert_read(&self, name: &str, record: &Record) {
        assert!((record.dt - self.dt).abs() < 1e-15, "{name}: {}", record.dt);
        assert_eq!((record.npts(), record.channel.as_str()), (self.values.len(), self.label), "{name}");
        let [relative, absolute] = self.digit;
        for (k, (found, expected)) in record.acceleration.iter().zip(&self.values).enumerate() {
            // An exponent's last digit is worth up to ten times more for 9.99 than for 1.00.
            let half_digit = 0.5 * (relative * expected.abs() * 10.0 + absolute) * (1.0 + 1e-6);
            assert!((found - expected).abs() <= half_digit, "{name}, sample {k}: {found}, {expected}");
        }
    }
}

fn channel(label: &'static str, values: Vec<f64>, digit: [f64; 2]) -> Channel {
    Channel { label, dt: DT, values, digit }
}

fn times(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

fn without_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Three components: the known signal, half of it the other way, a quarter of it.
fn components() -> [Vec<f64>; 3] {
    let a = decaying_sine(DT, 200);
    [a.clone(), times(&a, -0.5), times(&a, 0.25)]
}

fn slices(components: &[Vec<f64>; 3]) -> [&[f64]; 3] {
    [&components[0], &components[1], &components[2]]
}

/// Formats that hold three components under these names, in numbers of that last digit [m/s²].
fn three(labels: [&'static str; 3], digit: f64) -> Vec<Channel> {
    labels.into_iter().zip(components()).map(|(label, values)| channel(label, values, [0.0, digit])).collect()
}

/// Film: steps of 0.004 s and 0.005 s, one of 0.012 s; values in g/10 with three decimals.
pub fn film() -> Vec<[f64; 2]> {
    let (mut ticks, mut pairs) = (0, Vec::new());
    for k in 0..300 {
        let t = f64::from(ticks) / 1000.0;
        let value = 1.4 * (-0.8 * t).exp() * (2.0 * std::f64::consts::PI * 2.5 * t + 0.3).sin();
        pairs.push([t, (1e3 * value).round() / 1e3]);
        ticks += if k == 150 { 12 } else { 4 + k % 2 };
    }
    pairs
}

/// [`film`] along straight lines at every thousandth of a second [m/s²].
fn film_in_thousandths() -> Vec<f64> {
    let pairs = film();
    let at = |tick: u32| {
        let t = f64::from(tick) / 1000.0;
        let k = pairs.iter().position(|pair| pair[0] >= t - 1e-9).unwrap();
        if (pairs[k][0] - t).abs() < 1e-9 {
            return pairs[k][1];
        }
        let ([t0, a0], [t1, a1]) = (pairs[k - 1], pairs[k]);
        a0 + (t - t0) / (t1 - t0) * (a1 - a0)
    };
    let last = (1e3 * pairs[pairs.len() - 1][0]).round() as u32;
    (0..=last).map(|tick| 0.1 * G * at(tick)).collect()
}

pub fn fixtures() -> Vec<Fixture> {
    let a = decaying_sine(DT, 201);
    let (g, cm) = (times(&a, 1.0 / G), times(&a, 100.0));
    let one = |name, format, text, label, digit| Fixture {
        name,
        format,
        text,
        channels: vec![channel(label, a.clone(), digit)],
    };
    // Full fields of ten characters: 1234.567 would leave a blank, -12345.678 does not.
    let channels = [times(&cm, 90.0), cm.clone(), times(&cm[..150], -1.0)];
    let of_csmip = |digit: f64| {
        let si = channels.iter().map(|values| times(values, 0.01));
        let labels = ["CHAN 1: 90 DEG", "CHAN 2: UP", "CHAN 3: 360 DEG"];
        labels.into_iter().zip(si).map(|(label, values)| channel(label, values, [0.0, digit])).collect::<Vec<_>>()
    };
    let fine = [times(&cm, 0.05), times(&cm, -0.02)];
    let of_fine = ["CHAN 1: 90 DEG", "CHAN 2: UP"].into_iter().zip(&fine);
    let of_fine = of_fine.map(|(label, values)| channel(label, times(values, 0.01), [0.0, 1e-8])).collect();
    let si = components();
    let [gal, mm] = [100.0, 1000.0].map(|factor| si.clone().map(|values| times(&values, factor)));
    let pairs = |factor: f64| {
        let values = si.iter().map(|values| {
            let pairs = values.iter().enumerate().map(|(k, a)| [k as f64 * DT, factor * a]);
            pairs.collect::<Vec<_>>()
        });
        ["EW", "V", "NS"].into_iter().zip(values).collect::<Vec<_>>()
    };
    let tenths = pairs(10.0 / G);
    let lettered: Vec<_> = ["L", "V", "T"].into_iter().zip(tenths.iter().map(|(_, pairs)| pairs.clone())).collect();
    let geonet_names = ["S90E Test Axis", "N00E Test Axis", "Up Test Axis"];
    let relative = |labels: [&'static str; 3], digit: f64| {
        labels
            .into_iter()
            .zip(si.clone())
            .map(|(label, values)| channel(label, values, [digit, 0.0]))
            .collect::<Vec<_>>()
    };
    let knet_digit = 3920.0 / 6_182_761.0 * 0.01;
    vec![
        one("peer.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::Plain, "\n"), "", [1e-7, 0.0]),
        one("peer_lower_case.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::LowerCase, "\n"), "", [1e-7, 0.0]),
        one("peer_comma.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::Comma, "\r\n"), "", [1e-7, 0.0]),
        one("peer_numbers_first.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::NumbersFirst, "\n"), "", [1e-7, 0.0]),
        one("peer_own_lines.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::OwnLines, "\n"), "", [1e-7, 0.0]),
        one("peer_cr_cr_lf.at2", Format::PeerAt2, peer_at2(&g, DT, Dialect::Plain, "\r\r\n"), "", [1e-7, 0.0]),
        one("itaca.asc", Format::ItacaAsc, itaca_asc(&cm, DT, 201), "HNE", [0.0, 1e-8]),
        one(
            "cosmos.v2c",
            Format::Cosmos,
            cosmos_v2(&cm, DT, 0.02),
            "1: 360 deg (Rcrdr Chan 1) Location: ground",
            [1e-7, 0.0],
        ),
        one(
            "cosmos.v1",
            Format::Cosmos,
            cosmos(&g, DT, 0.02, "g.     (02)"),
            "1: 360 deg (Rcrdr Chan 1) Location: ground",
            [1e-7, 0.0],
        ),
        Fixture {
            name: "csmip.v2",
            format: Format::CsmipV2,
            text: csmip_v2(&channels, DT, Announced::InBrackets),
            channels: of_csmip(1e-5),
        },
        Fixture {
            name: "csmip_2012.v2",
            format: Format::CsmipV2,
            text: csmip_v2(&fine, DT, Announced::WithFormat),
            channels: of_fine,
        },
        Fixture {
            name: "csmip_usc.v2",
            format: Format::CsmipV2,
            text: csmip_v2(&channels, DT, Announced::InUnits),
            channels: of_csmip(1e-5),
        },
        one("usgs.smc", Format::UsgsSmc, usgs_smc(&cm, DT), "360", [1e-5, 0.0]),
        Fixture {
            name: "knet.ew",
            format: Format::Knet,
            text: knet(&gal[0], DT, "E-W", -7.7),
            channels: vec![channel("E-W", without_mean(&si[0]), [0.0, 1.1 * knet_digit])],
        },
        Fixture {
            name: "kiknet.ud2",
            format: Format::Knet,
            text: knet(&gal[1], DT, "6", 34.0),
            channels: vec![channel("UD2 (surface)", without_mean(&si[1]), [0.0, 1.1 * knet_digit])],
        },
        Fixture {
            name: "knet.csv",
            format: Format::KnetCsv,
            text: knet_csv(slices(&gal), DT),
            channels: ["N-S", "E-W", "U-D"]
                .into_iter()
                .zip(&si)
                .map(|(label, values)| channel(label, without_mean(values), [0.0, 1.1e-4]))
                .collect(),
        },
        Fixture {
            name: "geonet.v1a",
            format: Format::Geonet,
            text: geonet(slices(&mm), DT, false),
            channels: three(geonet_names, 0.5e-4),
        },
        Fixture {
            name: "geonet.v2a",
            format: Format::Geonet,
            text: geonet(slices(&mm), DT, true),
            channels: three(geonet_names, 1e-4),
        },
        Fixture {
            name: "nsmn.txt",
            format: Format::Nsmn,
            text: nsmn(slices(&gal), DT),
            channels: three(["N-S", "E-W", "U-D"], 1e-8),
        },
        Fixture {
            name: "unam.asa",
            format: Format::UnamAsa,
            text: unam(slices(&gal), DT),
            channels: three(["C1 V", "C2 N00E", "C3 N90E"], 1e-6),
        },
        Fixture {
            name: "cwb.dat",
            format: Format::Cwb,
            text: cwb(slices(&gal), DT),
            channels: three(["U", "N", "E"], 1e-5),
        },
        Fixture {
            name: "renadic.v1",
            format: Format::Volume1,
            text: volume_1(&tenths, Volume::Pairs),
            channels: three(["CHAN 1: EW", "CHAN 2: V", "CHAN 3: NS"], 1e-4 * G),
        },
        Fixture {
            name: "csmip_2012.v1",
            format: Format::Volume1,
            text: volume_1(&tenths, Volume::Announced),
            channels: three(["CHAN 1: EW", "CHAN 2: V", "CHAN 3: NS"], 1e-6 * G),
        },
        Fixture {
            name: "bhrc.v1",
            format: Format::Volume1,
            text: volume_1(&lettered, Volume::Bhrc),
            channels: relative(["L 352 deg", "V", "T 82 deg"], 1e-6),
        },
        Fixture {
            name: "usc.v1",
            format: Format::Volume1,
            text: volume_1(&[("N00W", film())], Volume::Usc),
            channels: vec![Channel { label: "N00W", dt: 0.001, values: film_in_thousandths(), digit: [0.0, 1e-12] }],
        },
        one("time_value.csv", Format::Text, csv(&a, DT), "acceleration", [0.0, 1e-9]),
    ]
}
