//! Sequences that resume where an earlier run stopped.

use airlight_image::{Control, ImageError};
use airlight_render::sequence::{
    FramePattern, FrameStep, SequencePlan, SequenceProgress, SequenceReport, run,
};
use std::{
    cell::Cell,
    fs,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
};

#[test]
fn plans_count_their_frames() {
    for (start, until, every, count) in [(0, 0, 5, 1), (0, 9, 5, 2), (0, 10, 5, 3), (-7, 7, 7, 3)] {
        let plan = SequencePlan::new(start, until, every).unwrap();
        let times: Vec<i64> = plan.frames().map(|f| f.time_s).collect();
        assert_eq!(plan.count(), count);
        assert_eq!(times.len() as u64, count);
        assert_eq!(times[0], start);
        assert!(times.iter().all(|&t| t <= until));
    }
    for (start, until, every, words) in [
        (0, 10, 0, "above 0"),
        (10, 0, 1, "after its start"),
        (0, 10_000_000, 1, "10000001"),
        (i64::MIN, i64::MAX, 1, "at most"),
    ] {
        let error = SequencePlan::new(start, until, every)
            .unwrap_err()
            .to_string();
        assert!(error.contains(words), "{error}");
    }
    let wide = SequencePlan::new(i64::MIN, i64::MAX, i64::MAX).unwrap();
    assert_eq!(wide.frames().last().unwrap().time_s, i64::MAX - 1);
}

#[test]
fn a_sequence_takes_up_where_it_stopped() {
    let folder = std::env::temp_dir().join(format!("airlight-sequence-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let pattern = FramePattern::new(&folder.join("sky.txt"));
    let plan = SequencePlan::new(0, 40, 10).unwrap();
    let cancel = AtomicBool::new(false);
    let made = Cell::new(0);
    let make = |_: FrameStep, path: &Path| {
        made.set(made.get() + 1);
        if made.get() == 2 {
            cancel.store(true, Ordering::Relaxed);
        }
        fs::write(path, "whole").map_err(|source| ImageError::File {
            action: "write",
            path: path.to_owned(),
            source,
        })
    };
    let control = Control::cancelled_by(&cancel);
    let stopped = run(&plan, &pattern, false, control, &mut (), make).unwrap_err();
    assert!(stopped.is_cancelled());
    assert_eq!(made.get(), 2);
    cancel.store(false, Ordering::Relaxed);
    // A file of no length is no picture.
    fs::write(pattern.path(4, 30), "").unwrap();

    struct Heard(Vec<String>);
    impl SequenceProgress for Heard {
        fn skipped(&mut self, frame: FrameStep, total: u64, _: &Path) {
            self.0.push(format!("skipped {}/{total}", frame.number));
        }
        fn finished(&mut self, frame: FrameStep, total: u64, _: &Path) {
            self.0.push(format!("finished {}/{total}", frame.number));
        }
    }
    let mut heard = Heard(Vec::new());
    let report = run(&plan, &pattern, false, control, &mut heard, make).unwrap();
    assert_eq!(
        report,
        SequenceReport {
            made: 3,
            skipped: 2
        }
    );
    assert_eq!(
        heard.0,
        [
            "skipped 1/5",
            "skipped 2/5",
            "finished 3/5",
            "finished 4/5",
            "finished 5/5"
        ]
    );
    let again = run(&plan, &pattern, true, Control::default(), &mut (), make).unwrap();
    assert_eq!(again.made, 5);
    fs::remove_dir_all(folder).unwrap();
}
