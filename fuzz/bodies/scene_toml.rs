//! Any bytes as a scene file: an error of one line that names the file, or a scene that the kernel takes.

use std::path::Path;

use hooke_harness::scene::toml;

/// The most of a generated scene's size that is tried: its digits, so that `lattice:999x999x999` costs no memory here.
const DIGITS: usize = 2;

/// A scene file of these bytes, in a folder that does not exist: no mesh is found there.
pub fn scene_toml(data: &[u8]) {
    if names_a_large_scene(data) {
        return;
    }
    let file = Path::new("/nonexistent/fuzz.toml");
    match toml::parse("fuzz", file, data) {
        Ok(loaded) => {
            let model = &loaded.model;
            let n = model.position.len();
            for (what, length) in [
                ("velocities", model.velocity.len()),
                ("masses", model.mass.len()),
                ("pins", model.pinned.len()),
            ] {
                assert_eq!(length, n, "as many {what} as particles");
            }
            assert!(model.springs.iter().all(|s| s.ends.iter().all(|i| *i < n)), "springs join particles");
            assert!(model.springs.iter().all(|s| s.ends[0] != s.ends[1]), "a spring has two ends");
            assert!(model.dt > 0.0 && model.dt.is_finite(), "a step takes time: {}", model.dt);
            assert!(model.seconds >= 0.0 && model.seconds.is_finite(), "so does a run: {}", model.seconds);
            for moving in &model.moving {
                let held = |i: &usize| model.pinned.get(*i) == Some(&true);
                assert!(moving.particles.iter().all(held), "what is moved is pinned");
            }
            let springs = model.springs.len();
            // Numbers that a precision cannot hold (the length of a spring between 1e308 and −1e308) are refused by name.
            match model.build::<f64>() {
                Ok(scene) => assert_eq!((scene.positions().len(), scene.state().springs()), (n, springs)),
                Err(error) => one_line(&error.to_string()),
            }
            if let Err(error) = model.build::<f32>() {
                one_line(&error.to_string());
            }
        }
        Err(error) => {
            one_line(&error.to_string());
            assert!(
                error.file.is_none() || error.file.as_deref() == Some(file),
                "it names the file: {error}"
            );
            let lines = 1 + data.iter().filter(|b| **b == b'\n').count();
            assert!(error.line.is_none_or(|line| (1..=lines).contains(&line)), "it names a line: {error}");
        }
    }
}

fn one_line(text: &str) {
    assert!(!text.is_empty() && !text.contains('\n'), "one line: {text}");
}

/// Is there a number of more digits in a line that speaks of a generator?
fn names_a_large_scene(data: &[u8]) -> bool {
    let long = |line: &[u8]| {
        line.windows(b"generator".len()).any(|word| word == b"generator")
            && line.split(|b| !b.is_ascii_digit()).any(|digits| digits.len() > DIGITS)
    };
    data.split(|b| *b == b'\n').any(long)
}
