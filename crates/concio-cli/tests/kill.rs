//! A run that is killed again and again ends with the bytes of one that was left alone.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

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
    Command::new(env!("CARGO_BIN_EXE_concio"))
        .args(["run"])
        .arg(wall)
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Anything that differs from one run of the test to the next: the moments of the kills are meant to.
fn chance() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    u64::from(now.subsec_nanos()).wrapping_mul(6_364_136_223_846_793_005) >> 33
}

#[test]
fn ten_kills_at_random_moments_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let wall = folder.path().join("wall.toml");
    fs::write(&wall, WALL).unwrap();
    let (whole, broken) = (folder.path().join("whole"), folder.path().join("broken"));
    assert!(start(&wall, &whole).wait().unwrap().success());
    let (mut killed, mut resumable) = (0, 0);
    for _ in 0..KILLS {
        let mut child = start(&wall, &broken);
        std::thread::sleep(Duration::from_millis(50 + chance() % 2200));
        // SIGKILL: the process has no say.
        child.kill().unwrap();
        killed += u32::from(!child.wait().unwrap().success());
        resumable += u32::from(broken.join("checkpoint.bin").exists());
    }
    let last = Command::new(env!("CARGO_BIN_EXE_concio")).arg("run").arg(&wall).arg("--out").arg(&broken).output();
    let last = last.unwrap();
    assert!(last.status.success(), "{}", String::from_utf8_lossy(&last.stderr));
    println!("{killed} runs killed, {resumable} left a checkpoint");
    assert!(killed > 0 && resumable > 0, "no run was killed after a checkpoint: the wall is too quick for this test");
    let bytes = |out: &Path| fs::read(out.join("result.h5")).unwrap();
    assert!(bytes(&whole) == bytes(&broken), "the results differ");
    assert!(!broken.join("journal.bin").exists() && !broken.join("checkpoint.bin").exists());
}
