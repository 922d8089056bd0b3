use concio::case::Case;
use concio::many::*;
use concio::run::prepare;
use concio::simulate::Simulation;
fn cpu() -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat").unwrap().split(' ').next().unwrap().parse::<f64>().unwrap()
        * 1e-9
}
fn main() {
    let path = std::path::Path::new("examples/02-driven-top.toml");
    let tol: f64 = std::env::args().nth(1).map_or(1e-3, |t| t.parse().unwrap());
    let count: usize = std::env::args().nth(2).map_or(64, |t| t.parse().unwrap());
    let threads: usize = std::env::args().nth(3).map_or(1, |t| t.parse().unwrap());
    let singles: usize = std::env::args().nth(4).map_or(8, |t| t.parse().unwrap());
    let text = std::fs::read_to_string(path).unwrap();
    let prepared: Vec<_> = (0..count)
        .map(|k| {
            let mu = 0.4 + 0.4 * k as f64 / (count.max(2) - 1) as f64;
            let t = text.replace("static = 0.6, dynamic = 0.42", &format!("static = {mu}, dynamic = {}", 0.7 * mu));
            let mut case: Case = concio::case::from_str(&t, concio::case::Syntax::of(path, &t), None).unwrap().case;
            case.solver.tolerance = tol;
            prepare(case, std::path::Path::new("examples")).unwrap()
        })
        .collect();
    let (t0, c0) = (std::time::Instant::now(), cpu());
    let mut its = 0;
    let mut ones = vec![];
    for p in prepared.iter().step_by(count.div_ceil(singles.max(1))).take(singles) {
        let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
        let (rows, why) = run.run_to_end();
        let o = run.outcome(rows, why);
        its += o.counters.iterations;
        ones.push(o);
    }
    let single = (cpu() - c0) / ones.len() as f64;
    eprintln!("single {single:.4} s per run, {:.3} us per iteration", single * 1e6 * ones.len() as f64 / its as f64);
    let jobs: Vec<Job> = prepared.iter().map(Job::from).collect();
    let (t0, c0) = (std::time::Instant::now(), cpu());
    let outcomes = simulate_many(&jobs, threads);
    let batch = if threads == 1 { cpu() - c0 } else { t0.elapsed().as_secs_f64() } / count as f64;
    let its: u64 = outcomes.iter().map(|o| o.as_ref().unwrap().counters.iterations).sum();
    eprintln!(
        "batch {batch:.4} s per run, {:.3} us per iteration, ratio {:.2}",
        batch * count as f64 * 1e6 / its as f64,
        single / batch
    );
    let mut same = 0;
    for (k, one) in (0..count).step_by(count.div_ceil(singles.max(1))).zip(&ones) {
        let o = outcomes[k].as_ref().unwrap();
        if o == one {
            same += 1
        } else {
            eprintln!(
                "run {k}: counters {:?} {:?}\n energies {:?} {:?}",
                one.counters, o.counters, one.energies, o.energies
            );
            eprintln!(
                " rows {} env {} totals {} layout {}",
                one.recording == o.recording,
                one.envelopes == o.envelopes,
                one.totals == o.totals,
                one.layout == o.layout
            );
        }
    }
    eprintln!("{same} of {} equal", ones.len());
    let work: f64 = outcomes.iter().map(|o| o.as_ref().unwrap().energies.input_top).sum::<f64>() / count as f64;
    eprintln!("mean work {work}");
}
