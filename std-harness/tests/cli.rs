//! The command line as its users and the checks see it: the program is run, and what it says and leaves is read.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

#[path = "data/scratch.rs"]
mod scratch;
use scratch::Scratch;

/// Rows of a final CSV, in any precision, as they are written.
fn rows(folder: &Scratch, name: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.path(name)).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("id,x,y,z,vx,vy,vz"));
    assert!(text.ends_with('\n') && !text.contains('\r'));
    lines.map(|line| line.split(',').map(String::from).collect()).collect()
}

/// Runs a scene and reads the final state as numbers: [x, y, z, vx, vy, vz] by id.
fn state(options: &str) -> Vec<[f64; 6]> {
    let folder = Scratch::new();
    folder.ok(&format!("run {options} --final f.csv --quiet"));
    let numbers = |row: &Vec<String>| std::array::from_fn(|c| row[c + 1].parse().unwrap());
    rows(&folder, "f.csv").iter().map(numbers).collect()
}

/// Runs a scene and reads the figures.
fn figures(options: &str) -> Value {
    let folder = Scratch::new();
    folder.ok(&format!("run {options} --json f.json --quiet"));
    serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap()
}

#[test]
fn run_alone_writes_the_series_the_plot_the_table_and_the_picture_to_out() {
    for line in ["run --seconds 0.05", "--seconds 0.05"] {
        let folder = Scratch::new();
        let ran = folder.ok(line);
        let names = folder.names();
        for name in ["motion.pvd", "energy.svg", "energy.csv", "picture.png", "frame_00003.vtp"] {
            assert!(names.contains(&format!("out/{name}")), "{line}: {name} in {names:?}");
        }
        assert!(names.iter().all(|name| name.starts_with("out") && !name.contains(".part")), "{names:?}");
        assert!(ran.stdout.contains("curtain") && ran.stdout.contains("motion.pvd"), "{}", ran.stdout);
        let energies = fs::read_to_string(folder.path("out/energy.csv")).unwrap();
        assert_eq!(energies.lines().count(), 1 + 1 + 6, "a header, the start and each of 6 steps of 1/120 s");
        let svg = fs::read_to_string(folder.path("out/energy.svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert_eq!(&fs::read(folder.path("out/picture.png")).unwrap()[..8], b"\x89PNG\r\n\x1a\n");
    }
}

#[test]
fn final_and_json_alone_write_just_those() {
    let folder = Scratch::new();
    folder.ok("run cloth:4 --steps 2 --final a.csv");
    assert_eq!(folder.names(), ["a.csv"]);
    folder.ok("run cloth:4 --steps 2 --json b.json");
    assert_eq!(folder.names(), ["a.csv", "b.json"]);
    folder.ok("run cloth:4 --steps 2 --json b.json --final a.csv --out d/e");
    assert!(folder.path("d/e/motion.pvd").exists() && folder.path("d/e/picture.png").exists());
    assert!(!folder.path("out").exists());
    folder.ok("run cloth:4 --steps 2 --out new --final new/f.csv");
    assert!(folder.path("new/f.csv").exists());
}

#[test]
fn quiet_says_nothing_and_otherwise_there_is_a_summary() {
    let folder = Scratch::new();
    assert_eq!(folder.ok("run cloth:4 --steps 2 --json b.json --quiet").stdout, "");
    let summary = folder.ok("run cloth:4 --steps 2 --json b.json").stdout;
    for word in ["16 particles (14 free)", "42 springs", "2 steps", "iterations", "energy", "b.json"] {
        assert!(summary.contains(word), "{word} in {summary}");
    }
}

#[test]
fn the_json_has_every_key_of_the_contract_with_its_type() {
    let f = figures("cloth:8 --steps 5");
    for key in
        ["particles", "springs", "free", "islands", "steps", "iterations", "clamped", "workspace_bytes"]
    {
        assert!(f[key].is_u64(), "{key}: {}", f[key]);
    }
    for key in ["uncertified_steps", "at_floor"] {
        assert!(f[key].is_u64(), "{key}: {}", f[key]);
    }
    for key in ["dt", "wall_s", "step_ms", "energy_start", "energy_end", "error_bound_J", "error_lower_J"] {
        assert!(f[key].is_f64(), "{key}: {}", f[key]);
    }
    assert_eq!((&f["scene"], &f["renumbered"]), (&Value::from("cloth:8"), &Value::from(false)));
    assert_eq!(f.get("momentum_drift"), Some(&Value::Null));
    let size = [&f["particles"], &f["springs"], &f["free"], &f["islands"], &f["steps"]].map(|v| v.as_u64());
    assert_eq!(size, [64, 2 * 8 * 7 + 2 * 7 * 7, 62, 1, 5].map(Some));
    assert_eq!(f["dt"].as_f64(), Some(1.0 / 60.0));
    assert!(f["error_lower_J"].as_f64() <= f["error_bound_J"].as_f64());
    assert!(f["iterations"].as_u64() > Some(5) && f["workspace_bytes"].as_u64() > Some(64 * 6 * 8));
}

#[test]
fn momentum_is_reported_only_where_nothing_may_change_it() {
    let drift = |options: &str| figures(&format!("{options} --steps 20"))["momentum_drift"].as_f64();
    assert!(drift("lattice:3x3x3").unwrap() < 1e-14);
    assert!(drift("pair").unwrap() < 1e-14);
    assert_eq!(drift("cloth:4"), None);
    assert_eq!(drift("lattice:3x3x3 --gravity 0,0,-1"), None);
    assert_eq!(drift("lattice:3x3x3 --pin vertices:0"), None);
    assert!(drift("cloth:4 --pin none --gravity 0,0,0").is_some());
}

#[test]
fn the_reference_scenes_report_their_sizes() {
    for (scene, particles, free, springs) in [
        ("cloth:32", 1024, 1022, 3906),
        ("net:6", 36, 34, 110),
        ("syrup:6", 36, 34, 110),
        ("chain:50", 50, 49, 49),
        ("lattice:3x3x3", 27, 27, 158),
        ("lattice:2x2x2", 8, 8, 28),
        ("spring", 2, 1, 1),
        ("pair", 2, 2, 1),
        ("curtain", 1024, 1015, 5826),
    ] {
        let f = figures(&format!("{scene} --steps 1"));
        let size = [&f["particles"], &f["free"], &f["springs"]].map(|v| v.as_u64().unwrap());
        assert_eq!((f["scene"].as_str(), size), (Some(scene), [particles, free, springs]));
    }
}

#[test]
fn the_final_csv_has_a_row_per_particle_and_shortest_decimals_that_read_back() {
    let folder = Scratch::new();
    folder.ok("run cloth:5 --steps 7 --final wide.csv --quiet");
    let wide = rows(&folder, "wide.csv");
    assert_eq!(wide.len(), 25);
    for (id, row) in wide.iter().enumerate() {
        assert_eq!((row.len(), row[0].as_str()), (7, id.to_string().as_str()));
        for text in &row[1..] {
            assert_eq!(&text.parse::<f64>().unwrap().to_string(), text);
        }
    }
    // Corners are pinned: where they were, at rest.
    assert_eq!(wide[4][1..], ["1", "0", "0", "0", "0", "0"]);

    folder.ok("run cloth:5 --steps 7 --final narrow.csv --quiet --precision f32");
    for (narrow, wide) in rows(&folder, "narrow.csv").iter().zip(&wide) {
        for (narrow, wide) in narrow[1..].iter().zip(&wide[1..]) {
            let x = narrow.parse::<f32>().unwrap();
            assert_eq!(&x.to_string(), narrow, "an f32 has no more digits than it needs");
            assert!((f64::from(x) - wide.parse::<f64>().unwrap()).abs() < 1e-3, "{narrow} and {wide}");
        }
    }
}

#[test]
fn two_runs_leave_the_same_bytes() {
    let folder = Scratch::new();
    for precision in ["f64", "f32"] {
        for run in ["a", "b"] {
            folder.ok(&format!(
                "run curtain --steps 12 --quiet --precision {precision} --final {run}.csv --out {run}"
            ));
        }
        for name in [".csv", "/energy.csv", "/motion.pvd", "/frame_00003.vtp"] {
            let read = |run: &str| fs::read(folder.path(&format!("{run}{name}"))).unwrap();
            assert_eq!(read("a"), read("b"), "{precision} {name}");
        }
    }
}

#[test]
fn gravity_and_velocity_take_effect() {
    // Without springs' help a free particle falls as q̇ = v + t g, the linearly-implicit way or any other.
    let fall = state("pair --stiffness 0 --gravity -1,0,0.5 --velocity 0,-2,0 --dt 0.25 --steps 4");
    assert_eq!(fall[0][3..], [-1.0, -2.0, 0.5]);
    assert_eq!(fall[1][3..], [-1.0, -2.0, 0.5]);
    assert_eq!(fall[0][1], -2.0);
    let pinned = state("cloth:3 --velocity 1,2,3 --steps 0");
    assert_eq!((&pinned[0][3..], &pinned[1][3..]), ([0.0; 3].as_slice(), [1.0, 2.0, 3.0].as_slice()));
}

#[test]
fn mass_and_stiffness_take_effect() {
    // spring: x'' = −(k/m)(x − 1), so k × 4 and m × 4 is the same motion, and k × 4 alone is not.
    let spring = |options: &str| state(&format!("spring --steps 30 {options} --tolerance 1e-12"))[1][0];
    let plain = spring("");
    assert_eq!(spring("--stiffness 4 --mass 4"), plain);
    assert!((spring("--stiffness 4") - plain).abs() > 0.01 && (spring("--mass 4") - plain).abs() > 0.01);
    // ω² = k/m: twice the frequency at half the step is the same position.
    assert!((spring("--stiffness 4 --dt 0.008333333333333333") - plain).abs() < 1e-9);
}

#[test]
fn pins_take_effect() {
    let still = |options: &str| {
        let end = state(&format!("chain:4 --steps 3 {options}"));
        end.iter().filter(|row| row[3..] == [0.0; 3]).count()
    };
    assert_eq!(still(""), 1);
    assert_eq!(still("--pin vertices:0,3"), 2);
    assert_eq!(still("--pin none"), 0);
    let free = |rule: &str| figures(&format!("curtain --steps 0 --pin {rule}"))["free"].as_u64().unwrap();
    assert!(free("min-y:0") == 992 && free("min-y:0.1") < 992, "the lowest row of the curtain");
}

#[test]
fn time_and_method_options_take_effect() {
    let f = figures("cloth:4 --dt 0.01 --seconds 0.1");
    assert_eq!((f["steps"].as_u64(), f["dt"].as_f64()), (Some(10), Some(0.01)));
    assert_eq!(figures("cloth:4 --steps 0")["steps"].as_u64(), Some(0));
    assert_eq!(figures("cloth:4 --integrator euler --solver jacobi")["steps"].as_u64(), Some(60));
    let iterations = |options: &str| figures(&format!("cloth:8 --steps 5 {options}"))["iterations"].as_u64();
    assert!(iterations("--tolerance 1e-10") > iterations("--tolerance 1e-2"));
    assert!(iterations("--absolute 1e-3") < iterations(""));
    assert!(iterations("--max-iterations 3") <= Some(15));
    let bytes = |solver: &str| {
        let f = figures(&format!("cloth:8 --steps 5 --solver {solver}"));
        // One solve a step where a solver is direct.
        assert_eq!(
            (f["iterations"].as_u64() == Some(5), f["fallback_steps"].as_u64()),
            (solver != "jacobi", Some(0))
        );
        f["workspace_bytes"].as_u64()
    };
    assert!(bytes("jacobi") < bytes("ldl") && bytes("jacobi") < bytes("banded"));
    let folder = Scratch::new();
    folder.ok("run cloth:4 --seconds 1 --fps 5 --out o");
    assert_eq!(folder.names().iter().filter(|name| name.ends_with(".vtp")).count(), 6);
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";

#[test]
fn a_mesh_runs_with_the_defaults_of_the_contract() {
    let folder = Scratch::new();
    folder.write("t.obj", TRIANGLE);
    folder.ok("run t.obj --json f.json --final f.csv --quiet");
    let f: Value = serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap();
    assert_eq!(
        [&f["particles"], &f["springs"], &f["free"], &f["steps"]].map(|v| v.as_u64().unwrap()),
        [3, 3, 3, 60]
    );
    // It falls freely, springs at rest: v = g t.
    assert!((rows(&folder, "f.csv")[0][5].parse::<f64>().unwrap() + 9.81).abs() < 1e-9);
}

/// A strip of triangles whose points come in no order: that at place k has the id k⁷ mod 31.
fn strip() -> String {
    let id = |place: usize| (0..7).fold(1, |product, _| product * place % 31);
    let mut points = vec![String::new(); 31];
    for place in 0..31 {
        let (x, y) = (place / 2, place % 2);
        points[id(place)] = format!("v {x} {y} {}\n", 0.1 * (x % 3) as f64);
    }
    let face = |k: usize| format!("f {} {} {}\n", id(k) + 1, id(k + 1) + 1, id(k + 2) + 1);
    points.concat() + &(0..29).map(face).collect::<String>()
}

#[test]
fn renumbering_changes_no_id_in_any_output() {
    let folder = Scratch::new();
    folder.write("strip.obj", strip());
    let options = "--pin vertices:0,1 --dt 0.02 --steps 20 --tolerance 1e-12 --fps 25 --quiet";
    for (name, how) in [("as-is", "none"), ("new", "rcm")] {
        folder.ok(&format!(
            "run strip.obj {options} --renumber {how} --final {name}.csv --json {name}.json --out {name}"
        ));
        let f: Value =
            serde_json::from_str(&fs::read_to_string(folder.path(&format!("{name}.json"))).unwrap()).unwrap();
        assert_eq!(f["renumbered"].as_bool(), Some(how == "rcm"));
    }
    let (old, new) = (rows(&folder, "as-is.csv"), rows(&folder, "new.csv"));
    assert_ne!(old, new, "another order of sums has other last digits");
    for (old, new) in old.iter().zip(&new) {
        assert_eq!(old[0], new[0]);
        for (a, b) in old[1..].iter().zip(&new[1..]) {
            // The contract of tight trajectories, as in the tests' table of allowed errors.
            assert!((a.parse::<f64>().unwrap() - b.parse::<f64>().unwrap()).abs() <= 1e-9, "{old:?} {new:?}");
        }
    }
    // The start holds no rounding yet: the same points, pins and springs in the same places, byte for byte.
    let frame = |name: &str| fs::read(folder.path(&format!("{name}/frame_00000.vtp"))).unwrap();
    assert_eq!(frame("as-is"), frame("new"));
}

#[test]
fn errors_and_moving_pins_name_particles_as_the_user_does_in_a_renumbered_run() {
    let folder = Scratch::new();
    folder.write("strip.obj", strip());
    // The pins 0 and 1 are the first two of the strip; only 1 moves.
    folder.write("t.toml", "mesh = \"strip.obj\"\npins = [0, 1]\n[[moving]]\nparticles = [1]\nlinear = { velocity = [0.0, 0.0, 1.0] }\n");
    let ran = folder.ok("run t.toml --renumber rcm --dt 0.25 --steps 2 --final f.csv").stdout;
    assert!(ran.contains("renumbered: springs reach"), "{ran}");
    let end = rows(&folder, "f.csv");
    assert_eq!(
        (end[0][1..].join(","), end[1][1..].join(",")),
        ("0,0,0,0,0,0".into(), "0,1,0.5,0,0,1".into())
    );
    // All particles but 30 are pinned, and it flies out of the range of f64.
    let pins = (0..30).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
    let line = format!(
        "run strip.obj --renumber rcm --stiffness 0 --pin vertices:{pins} --velocity 5e307,0,0 --dt 1.5 --steps 9 --final g.csv --quiet"
    );
    let ran = folder.hooke(&line.split_whitespace().collect::<Vec<_>>());
    assert!(ran.code == 1 && ran.stderr.contains("particle 30"), "{ran:?}");
    assert_eq!(rows(&folder, "g.csv")[30][4].parse(), Ok(5e307));
}

#[test]
fn a_numbering_that_is_good_already_is_kept_and_said() {
    let folder = Scratch::new();
    for scene in ["cloth:6", "chain:9", "lattice:6x5x4", "curtain"] {
        let ran = folder.ok(&format!("run {scene} --steps 1 --renumber rcm --json f.json")).stdout;
        assert!(ran.contains("not renumbered: springs join particles at few distances already"), "{ran}");
    }
}

#[test]
fn auto_says_what_it_took_and_why_and_gives_that_solvers_bits() {
    let folder = Scratch::new();
    folder.write("strip.obj", strip());
    for line in
        ["chain:30 --steps 9", "cloth:9 --steps 9", "strip.obj --pin vertices:0 --steps 9 --precision f32"]
    {
        let run = |options: &str| {
            let ran = folder.ok(&format!("run {line} {options} --final f.csv --json f.json")).stdout;
            let json: Value =
                serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap();
            (ran, json, fs::read(folder.path("f.csv")).unwrap())
        };
        let (said, chosen, bits) = run("--solver auto");
        let (name, reason) = (chosen["solver"].as_str().unwrap(), chosen["solver_reason"].as_str().unwrap());
        assert!(said.contains(&format!("auto took {name}: {reason}")), "{said}");
        assert!(reason.contains(&format!(
            "least work foretold (µs a step, on the machine it was weighed on): {name} "
        )));
        assert_eq!(
            (run("--solver auto").1["solver_reason"].as_str(), run("--solver auto").2),
            (Some(reason), bits.clone())
        );
        let (_, named, expected) = run(&format!("--solver {name}"));
        assert_eq!((named["solver"].as_str(), &named["solver_reason"]), (Some(name), &Value::Null));
        assert_eq!(bits, expected, "{line}: {name}");
    }
    assert_eq!(figures("cloth:4 --steps 1")["solver"].as_str(), Some("jacobi"));
}

#[test]
fn a_name_wins_over_a_file_and_a_path_is_the_file() {
    let folder = Scratch::new();
    folder.write("pair", "not a mesh");
    folder.ok("run pair --steps 1 --json a.json --quiet");
    folder.refuses("run ./pair", &["./pair"]).unwrap();
}

#[test]
fn info_says_what_is_in_a_mesh() {
    let folder = Scratch::new();
    folder.write("t.obj", TRIANGLE);
    let text = folder.ok("info t.obj").stdout;
    assert!(text.contains('3') && text.to_lowercase().contains("triangle"), "{text}");
    let json: Value = serde_json::from_str(&folder.ok("info t.obj --json").stdout).unwrap();
    assert_eq!((json["points"].as_u64(), json["area"].as_f64()), (Some(3), Some(1.0)), "{json}");
    assert_eq!(folder.names(), ["t.obj"]);
    folder.refuses("info none.obj", &["none.obj"]).unwrap();
    folder.refuses("info", &["MESH"]).unwrap();
}

#[test]
fn help_names_every_command_option_and_scene() {
    let folder = Scratch::new();
    let help = folder.ok("--help").stdout;
    let run = folder.ok("run --help").stdout;
    for word in ["run", "info", "cloth:N"] {
        assert!(help.contains(word), "{word} in {help}");
    }
    let options = "--dt --steps --seconds --integrator --solver --tolerance --absolute --max-iterations --renumber --precision \
                   --stiffness --mass --gravity --velocity --pin --out --fps --final --json --quiet";
    let scenes = "curtain cloth:N net:N syrup:N chain:N lattice:AxBxC spring pair";
    for word in options.split_whitespace().chain(scenes.split_whitespace()) {
        assert!(run.contains(word), "{word} in {run}");
    }
    assert_eq!(folder.names(), [""; 0]);
}

/// Every bad input: exit code 2, one line that names the value, nothing written.
#[test]
fn bad_options_and_names_are_refused() {
    let folder = Scratch::new();
    folder.write("stands", "a file where a folder should be");
    fs::create_dir(folder.path("folder")).unwrap();
    let cases = BTreeMap::from([
        ("run cloth:4 --mass 0", vec!["--mass 0"]),
        ("run cloth:4 --mass -1", vec!["--mass -1"]),
        ("run cloth:4 --mass NaN", vec!["--mass NaN"]),
        ("run cloth:4 --mass heavy", vec!["heavy", "--mass"]),
        ("run cloth:4 --stiffness -1", vec!["--stiffness -1"]),
        ("run cloth:4 --stiffness inf", vec!["--stiffness inf"]),
        ("run cloth:4 --dt 0", vec!["--dt 0"]),
        ("run cloth:4 --dt -1", vec!["--dt -1"]),
        ("run cloth:4 --dt NaN", vec!["--dt NaN"]),
        ("run cloth:4 --dt inf", vec!["--dt inf"]),
        ("run cloth:4 --dt 1e-300 --steps 1", vec!["--dt", "range"]),
        ("run cloth:4 --precision f32 --steps 1 --dt 1e-30", vec!["--dt 1e-30", "range of f32"]),
        ("run cloth:4 --precision f32 --absolute 1e300", vec!["--absolute 1e300", "range of f32"]),
        ("run cloth:4 --precision f32 --gravity 0,1e50,0", vec!["--gravity 1e50", "range of f32"]),
        ("run cloth:4 --precision f32 --mass 1e-60", vec!["particle 0", "1e-60 kg"]),
        ("run cloth:4 --precision f32 --stiffness 1e50", vec!["spring 0", "1e50 N/m"]),
        ("run cloth:4 --final same --json same", vec!["same", "--final and --json"]),
        ("run cloth:4 --dt", vec!["--dt"]),
        ("run cloth:4 --seconds -1", vec!["--seconds -1"]),
        ("run cloth:4 --seconds NaN", vec!["--seconds NaN"]),
        ("run cloth:4 --steps 1.5", vec!["1.5", "--steps"]),
        ("run cloth:4 --steps -3", vec!["-3"]),
        ("run cloth:4 --steps 3 --seconds 1", vec!["--steps", "--seconds"]),
        ("run cloth:4 --steps 99999999999", vec!["9.9999999999e10 steps", "1e9"]),
        ("run cloth:4 --dt 1e-20", vec!["steps of 1e-20 s"]),
        ("run cloth:4 --seconds 1e300", vec!["6e301 steps"]),
        ("run cloth:4 --fps 0", vec!["--fps 0"]),
        ("run cloth:4 --tolerance -1", vec!["--tolerance -1"]),
        ("run cloth:4 --tolerance NaN", vec!["--tolerance NaN"]),
        ("run cloth:4 --absolute -1", vec!["--absolute -1"]),
        ("run cloth:4 --max-iterations -1", vec!["-1"]),
        ("run cloth:4 --gravity 1,2", vec!["'1,2'", "three numbers"]),
        ("run cloth:4 --gravity 1,2,inf", vec!["'inf' is not a finite number"]),
        ("run cloth:4 --velocity a,b,c", vec!["'a' is not a finite number"]),
        ("run cloth:4 --integrator eulr", vec!["'eulr'", "'euler'"]),
        ("run cloth:4 --solver jacob", vec!["'jacob'", "'jacobi'"]),
        ("run cloth:4 --solver bandet", vec!["'bandet'", "'banded'"]),
        ("run cloth:4 --solver aut", vec!["'aut'", "'auto'"]),
        ("run cloth:4 --renumber rmc", vec!["--renumber", "'rmc'", "'rcm'"]),
        ("run cloth:4 --renumber", vec!["--renumber"]),
        ("run cloth:4 --precision f16", vec!["f16", "f32"]),
        ("run cloth:4 --stepz 3", vec!["--stepz", "'--steps'"]),
        ("run cloth:4 --fsp 3", vec!["--fsp", "'--fps'"]),
        ("--stepz 3", vec!["--stepz", "'--steps'"]),
        ("run cloth:4 --pin min-z:3", vec!["'min-z:3'", "'min-y'"]),
        ("run cloth:4 --pin min-y:x", vec!["'x' is not a distance"]),
        ("run cloth:4 --pin vertices:99999", vec!["no vertex 99999", "0 to 15"]),
        ("run cloth:4 --pin vertices:", vec!["vertices:"]),
        ("run curtain --pin min-y:1e9", vec!["pins all 1024"]),
        ("run cloth:99999999999", vec!["'99999999999'", "most"]),
        ("run cloth:99999999999999999999999", vec!["'99999999999999999999999'", "most"]),
        ("run cloth:0", vec!["'0'"]),
        ("run cloth:1", vec!["'1'"]),
        ("run cloth:-2", vec!["'-2'"]),
        ("run cloth:", vec!["'cloth:'", "cloth:N"]),
        ("run cloth", vec!["'cloth'", "cloth:N"]),
        ("run cloth:abc", vec!["'abc'"]),
        ("run spring:3", vec!["'spring:3'"]),
        ("run lattice:3x3", vec!["'3x3'", "lattice:AxBxC"]),
        ("run lattice:0x3x3", vec!["'0'"]),
        ("run lattice:1x1x1", vec!["at least 2"]),
        ("run lattice:99999x99999x99999", vec!["99999x99999x99999", "most"]),
        ("run clot:32", vec!["'clot:32'", "'cloth:32'"]),
        ("run cloth:4 chain:4", vec!["'chain:4'"]),
        ("rnu", vec!["'rnu'", "'run'"]),
        ("cloth:4", vec!["'cloth:4'", "hooke run cloth:4"]),
        ("run cloth:4 --out stands", vec!["stands"]),
        ("run cloth:4 --out stands/below", vec!["stands"]),
        ("run cloth:4 --final none/f.csv", vec!["none/f.csv"]),
        ("run cloth:4 --json none/f.json", vec!["none/f.json"]),
        ("run cloth:4 --final folder", vec!["folder", "directory"]),
        ("run cloth:4 --json none/f.json --out made", vec!["none/f.json"]),
        ("run cloth:4 --mass 0 --out made --final f.csv --json f.json", vec!["--mass 0"]),
        ("run cloth:4 --precision f32 --velocity 1e300,0,0", vec!["particle 1", "1e300"]),
    ]);
    let wrong: String =
        cases.iter().filter_map(|(line, needles)| folder.refuses(line, needles).err()).collect();
    assert_eq!(wrong, "");
}

#[test]
fn an_empty_argument_is_refused_by_name() {
    let folder = Scratch::new();
    for args in [["run", "", "--quiet"], ["run", "--out", ""], ["run", "--final", ""]] {
        let ran = folder.hooke(&args);
        assert_eq!((ran.code, ran.stderr.lines().count()), (2, 1), "{args:?}: {ran:?}");
        assert_eq!(folder.names(), [""; 0], "{args:?}");
    }
}

#[test]
#[cfg(unix)]
fn an_argument_that_is_no_text_is_refused() {
    use std::os::unix::ffi::OsStrExt;
    let mut hooke = std::process::Command::new(env!("CARGO_BIN_EXE_hooke"));
    let output = hooke.args(["run".as_ref(), std::ffi::OsStr::from_bytes(b"\xff.obj")]).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), stderr.lines().count()), (Some(2), 1), "{stderr}");
}

#[test]
#[cfg(unix)]
fn a_reader_that_leaves_early_is_no_failure() {
    use std::process::{Command, Stdio};
    let mut hooke = Command::new(env!("CARGO_BIN_EXE_hooke"));
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let child = hooke.arg("--help").stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr), (Some(0), vec![]));
}

#[test]
fn bad_meshes_are_refused_with_their_line() {
    let folder = Scratch::new();
    let medit = "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles 1\n1 2 3 0\nEnd\n";
    folder.write("good.mesh", medit);
    folder.ok("run good.mesh --steps 1 --json fine.json --quiet");
    let cases = [
        ("cut.mesh", medit.split("1 2 3").next().unwrap().into(), vec!["cut.mesh:"]),
        ("counts.mesh", medit.replace("Vertices 3", "Vertices 4"), vec!["counts.mesh:"]),
        ("range.mesh", medit.replace("1 2 3 0", "1 2 4 0"), vec!["range.mesh:8:", "4"]),
        ("zero.mesh", medit.replace("1 2 3 0", "0 2 3 0"), vec!["zero.mesh:8:", "0"]),
        ("nan.mesh", medit.replace("0 1 0 0", "0 nan 0 0"), vec!["nan.mesh:6:", "nan"]),
        ("inf.obj", TRIANGLE.replace("v 0 2 0", "v 0 inf 0"), vec!["inf.obj:3:", "inf"]),
        ("twice.obj", TRIANGLE.replace("f 1 2 3", "f 1 2 2"), vec!["twice.obj:4:", "2"]),
        ("far.obj", TRIANGLE.replace("f 1 2 3", "f 1 2 7"), vec!["far.obj:4:", "7"]),
        ("word.obj", TRIANGLE.replace("v 1 0 0", "v 1 zero 0"), vec!["word.obj:2:", "zero"]),
        ("empty.obj", String::new(), vec!["empty.obj:", "empty"]),
        ("what.xyz", "1 2 3".into(), vec!["what.xyz", "xyz"]),
    ];
    let mut wrong = String::new();
    for (name, text, needles) in cases {
        folder.write(name, text);
        for command in ["run", "info"] {
            wrong.extend(folder.refuses(&format!("{command} {name}"), &needles).err());
        }
    }
    wrong.extend(folder.refuses("run none.obj", &["none.obj: cannot read"]).err());
    wrong.extend(folder.refuses("run ./none", &["none"]).err());
    assert_eq!(wrong, "");
}

#[test]
fn a_step_that_fails_says_so_and_keeps_what_was_computed() {
    let folder = Scratch::new();
    // Two steps of 5e307 m/s each over 1.5 s stay within the range of f64, the third does not.
    let line = "run pair --stiffness 0 --velocity 5e307,0,0 --dt 1.5 --steps 9 --out o --final f.csv --json f.json --quiet";
    let ran = folder.hooke(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.lines().count()), (1, "", 1), "{ran:?}");
    for part in ["step 3", "t = 3 s", "particle 0", "range"] {
        assert!(ran.stderr.contains(part), "{part} in {}", ran.stderr);
    }
    assert_eq!(rows(&folder, "f.csv")[0][4].parse(), Ok(5e307));
    let f: Value = serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap();
    assert_eq!(f["steps"].as_u64(), Some(2));
    for name in ["motion.pvd", "frame_00002.vtp", "energy.csv", "energy.svg", "picture.png"] {
        assert!(folder.path("o").join(name).exists(), "{name} in {:?}", folder.names());
    }
}

#[test]
fn no_output_takes_the_place_of_an_input_or_of_another_output() {
    let folder = Scratch::new();
    folder.write("t.obj", TRIANGLE);
    folder.write("t.toml", "mesh = \"t.obj\"\n");
    for line in [
        "run t.obj --final t.obj",
        "run t.obj --json ./t.obj",
        "run t.toml --final t.toml",
        "run t.toml --final t.obj",
        "run t.obj --out o --final o/energy.csv",
        "run t.obj --final f --json ./f",
    ] {
        let named = line.rsplit(' ').next().unwrap();
        folder.refuses(line, &[named]).unwrap();
    }
    folder.ok("run t.obj --final f.csv --json f.json --quiet");
}

#[test]
fn a_duration_that_is_no_whole_number_of_steps_is_rounded_up_and_said() {
    let folder = Scratch::new();
    let summary = folder.ok("run pair --dt 0.4 --seconds 1 --json f.json").stdout;
    assert!(summary.contains("the last one ends at 1.2"), "{summary}");
    let whole = folder.ok("run pair --dt 0.1 --seconds 0.3 --json f.json").stdout;
    assert!(!whole.contains("whole number"), "{whole}");
}
