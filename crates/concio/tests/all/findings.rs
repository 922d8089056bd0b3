//! Mistakes of a geometry are listed together, the first of them one by one.

use concio::case::{Case, Syntax, from_str};
use concio::pattern::{findings, lay};
use proptest::prelude::*;

const REST: &str = "[joint]\nbed = { law = \"elastic\", stiffness = 1e8 }\nhead = { law = \"no-tension\", stiffness = 1e8 }\n[motion]\nduration = 1\n";

/// Boxes: course, left, bottom, length, height.
fn case(blocks: &[(usize, f64, f64, f64, f64)]) -> Case {
    let list: String = blocks
        .iter()
        .map(|(course, x, y, length, height)| {
            format!("[[panel.block]]\ncourse = {course}\nx = {x}\ny = {y}\nlength = {length}\nheight = {height}\n")
        })
        .collect();
    let brick = "brick = { length = 0.25, height = 0.05, thickness = 0.1, specific_weight = 18e3 }";
    let text = format!("model = \"shear\"\n[[panel]]\nbond = \"explicit\"\n{brick}\n{list}{REST}");
    from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}")).case
}

/// Thirty blocks in one place overlap in 30 · 29 / 2 pairs.
#[test]
fn all_overlaps_are_counted_and_the_first_told() {
    let all = findings(&case(&[(1, 0.0, 0.0, 0.25, 0.05); 30]));
    assert_eq!(all.len(), 21);
    assert!(all[..20].iter().all(|e| e.what.contains("overlap") && e.key.is_some()), "{all:?}");
    assert_eq!(all[20].what, format!("and {} more mistakes like these", 30 * 29 / 2 - 20));
    let two = findings(&case(&[(1, 0.0, 0.0, 0.25, 0.05), (1, 0.2, 0.0, 0.25, 0.05), (1, 0.4, 0.0, 0.25, 0.05)]));
    let told: Vec<&str> = two.iter().map(|e| e.what.as_str()).collect();
    assert_eq!(told, ["blocks p1c1b1 and p1c1b2 overlap", "blocks p1c1b2 and p1c1b3 overlap"]);
}

/// Ten thousand blocks in one place are 5·10⁷ pairs: not all are compared, and that is said.
#[test]
fn a_heap_of_blocks_is_answered_without_comparing_all() {
    let all = findings(&case(&vec![(1, 0.0, 0.0, 0.25, 0.05); 10_000]));
    assert_eq!(all.len(), 21);
    let last = &all[20].what;
    let more: usize =
        last.strip_prefix("and at least ").and_then(|rest| rest.split(' ').next()?.parse().ok()).expect(last);
    assert!((10_000..50_000_000).contains(&more), "{last}");
}

/// Blocks in the air too, and those whose bottom is in the block below them.
#[test]
fn all_blocks_that_rest_on_nothing_are_told() {
    let course = |n: usize, y: f64, x: &[f64]| x.iter().map(|x| (n, *x, y, 0.25, 0.05)).collect::<Vec<_>>();
    let all = [course(1, 0.0, &[0.0]), course(2, 0.05, &[0.0, 0.3, 0.6])].concat();
    let told: Vec<String> = findings(&case(&all)).into_iter().filter_map(|e| e.key).collect();
    assert_eq!(told, ["panel[0].block[2]", "panel[0].block[3]"]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    /// Every pair that overlaps is found once, whatever the blocks: as many as comparing each with each finds.
    #[test]
    fn overlaps_are_those_of_all_pairs(places in prop::collection::vec((1usize..4, 0u8..12, 0u8..8, 1u8..5, 1u8..4), 2..7)) {
        // The courses are numbered without a gap.
        let blocks: Vec<(usize, f64, f64, f64, f64)> = [1, 2, 3]
            .iter()
            .map(|c| (*c, 100.0 * *c as f64, 0.0, 1.0, 1.0))
            .chain(places.iter().map(|(c, x, y, l, h)| (*c, f64::from(*x), f64::from(*y), f64::from(*l), f64::from(*h))))
            .collect();
        let over = |a: [f64; 2], b: [f64; 2]| (a[0] + a[1]).min(b[0] + b[1]) > a[0].max(b[0]);
        // Of one course neighbours may not even stand above each other, which is told instead.
        let mut expected = 0;
        for (i, a) in blocks.iter().enumerate() {
            expected += blocks[i + 1..].iter().filter(|b| over([a.1, a.3], [b.1, b.3]) && over([a.2, a.4], [b.2, b.4])).count();
        }
        let mut case = case(&blocks);
        case.panels[0].brick.length = 1.0.into();
        let all = findings(&case);
        let more = all.last().and_then(|e| e.what.strip_prefix("and ")?.split(' ').next()?.parse::<usize>().ok()).unwrap_or(0);
        let told = all.iter().filter(|e| e.what.contains("overlap")).count();
        prop_assert_eq!(more, 0);
        prop_assert_eq!(told, expected, "{:?}", all);
        prop_assert!(all.is_empty() == lay(&case).is_ok());
    }
}
