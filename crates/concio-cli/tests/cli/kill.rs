//! A run that is killed again and again ends with the bytes of one that was left alone.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::support::{PROGRAM, chance};

/// Slips for long enough that several checkpoints fall into it on any machine.
const WALL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 8
bricks = 6
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "1.2 s"
top = { sine = { amplitude = "5 mm", frequency = "3 Hz", ramp = "0.3 s" } }
"#;
const KILLS: u32 = 10;

fn start(wall: &Path, out: &Path) -> Child {
    Command::new(PROGRAM)
        .args(["run"])
        .arg(wall)
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

#[test]
fn ten_kills_at_random_moments_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let wall = folder.path().join("wall.toml");
    fs::write(&wall, WALL).unwrap();
    let (whole, broken) = (folder.path().join("whole"), folder.path().join("broken"));
    assert!(start(&wall, &whole).wait().unwrap().success());
    let checkpoint = broken.join("checkpoint.bin");
    let written = || fs::metadata(&checkpoint).and_then(|m| m.modified()).ok();
    let (mut killed, mut taken_up) = (0, 0);
    for kill in 0..KILLS {
        let before = written();
        let mut child = start(&wall, &broken);
        // A run writes a checkpoint a second: some are killed before their first, which costs nothing, some after it.
        if kill % 3 == 2 {
            while written() == before && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_millis(5));
            }
        }
        std::thread::sleep(Duration::from_millis(20 + chance() % 150));
        // SIGKILL: the process has no say.
        child.kill().unwrap();
        killed += u32::from(!child.wait().unwrap().success());
        taken_up += u32::from(written() != before && written().is_some());
    }
    let last = Command::new(PROGRAM).arg("run").arg(&wall).arg("--out").arg(&broken).output();
    let last = last.unwrap();
    assert!(last.status.success(), "{}", String::from_utf8_lossy(&last.stderr));
    println!("{killed} runs killed, {taken_up} after a checkpoint of their own");
    assert!(killed >= KILLS - 2, "{killed} of {KILLS} kills met a run: the wall is too quick for this test");
    assert!(taken_up >= 2, "{taken_up} runs were killed after a checkpoint");
    let bytes = |out: &Path| fs::read(out.join("result.h5")).unwrap();
    assert!(bytes(&whole) == bytes(&broken), "the results differ");
    assert!(!broken.join("journal.bin").exists() && !broken.join("checkpoint.bin").exists());
}
