//! `hooke work-precision` as its users see it: what it says and leaves.

use std::fs;

use serde_json::Value;

#[path = "data/scratch.rs"]
mod scratch;
use scratch::Scratch;

/// Compares, and reads the JSON.
fn compared(options: &str) -> Value {
    let folder = Scratch::new();
    folder.ok(&format!("work-precision {options} --repeats 1 --json f.json --quiet"));
    serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap()
}

/// The errors of a curve, from coarse to fine.
fn errors(found: &Value, curve: &str) -> Vec<f64> {
    let runs = found["runs"].as_array().unwrap().iter().filter(|run| run["curve"] == curve);
    runs.map(|run| run["error_m"].as_f64().unwrap_or_else(|| panic!("{run}"))).collect()
}

#[test]
fn table_plot_and_json_have_a_row_and_a_curve_for_what_was_asked() {
    let folder = Scratch::new();
    let line =
        "work-precision pair --method verlet,ros2 --dt 0.01,0.005 --accuracy 1e-5 --json f.json --out new";
    let said = folder.ok(line).stdout;
    assert_eq!(folder.names(), ["f.json", "new", "new/work-precision.csv", "new/work-precision.svg"]);
    let csv = fs::read_to_string(folder.path("new/work-precision.csv")).unwrap();
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|n| *n == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let curves: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(curves, ["ros2", "ros2", "verlet", "verlet", "\"ros2", "\"verlet"], "{csv}");
    let dts: Vec<f64> = rows[..4].iter().map(|row| row[column("dt_s")].parse().unwrap()).collect();
    assert_eq!(dts, [0.01, 0.005, 0.01, 0.005]);
    for row in &rows[..4] {
        let of = |name: &str| row[column(name)].parse::<f64>().unwrap();
        assert!(of("error_m") > 0.0 && of("error_m") < 1e-2 && of("ms") > 0.0, "{row:?}");
        assert!(of("momentum_drift") < 1e-12 && of("energy_drift") < 1e-2, "{row:?}");
        assert_eq!(of("solves"), if row[1] == "ros2" { 2.0 * of("steps") } else { 0.0 });
    }
    let svg = fs::read_to_string(folder.path("new/work-precision.svg")).unwrap();
    for curve in ["ros2", "verlet", "ros2, chosen steps"] {
        assert!(svg.contains(curve) && said.contains(curve), "{curve}");
    }
    for word in ["reference", "extrapolated", "tolerance 1e-8", "work-precision.csv", "f.json"] {
        assert!(said.contains(word), "{word} in {said}");
    }
}

#[test]
fn errors_fall_by_the_order_of_the_method() {
    let methods =
        [("euler", 2.0), ("symplectic-euler", 2.0), ("midpoint", 4.0), ("verlet", 4.0), ("ros3", 8.0)];
    let names = methods.map(|(name, _)| name).join(",");
    let found = compared(&format!("pair --method {names} --dt 0.01,0.005,0.0025 --smallest 1e-9"));
    assert_eq!(found["reference"]["met"], true, "{}", found["reference"]);
    for (name, factor) in methods {
        let errors = errors(&found, name);
        let falls: Vec<f64> = errors.windows(2).map(|pair| pair[0] / pair[1]).collect();
        // h²: the next order's share is still visible, a tenth of it at these steps.
        assert!(falls.iter().all(|fall| (fall / factor - 1.0).abs() < 0.1), "{name}: {errors:?}");
    }
}

#[test]
fn against_an_exact_solution_an_error_is_what_it_says() {
    // x = 1 + ½ cos t; Verlet's angle per step is 2 asin(h/2).
    let found = compared("spring --method verlet --dt 0.25 --seconds 1 --smallest 1e-8");
    let angle = 2.0 * (0.125_f64).asin();
    let exact = 0.5 * ((4.0 * angle).cos() - 1.0_f64.cos()).abs();
    let [error, ..] = errors(&found, "verlet")[..] else { panic!("{found}") };
    assert!((error - exact).abs() < 1e-9, "{error} {exact}");
}

#[test]
fn steps_of_ones_own_choice_begin_at_the_scenes_and_at_the_limit_and_are_halved() {
    let found = compared("spring --method midpoint,verlet --smallest 1e-4 --seconds 1");
    let runs = found["runs"].as_array().unwrap();
    let dts = |curve: &str| -> Vec<f64> {
        let own = runs.iter().filter(|run| run["curve"] == curve);
        own.map(|run| run["dt"].as_f64().unwrap()).collect()
    };
    assert_eq!(dts("midpoint")[0], 1.0 / 60.0);
    // The limit is 2 s, longer than the whole run.
    assert_eq!(dts("verlet")[..3], [1.0, 0.5, 0.25]);
    for curve in ["midpoint", "verlet"] {
        assert!(*errors(&found, curve).last().unwrap() <= 1e-4, "{found}");
    }
}

#[test]
fn the_verdict_names_a_method_for_every_decade_that_is_reached() {
    let found = compared("pair --method midpoint,verlet,euler --dt 0.02,0.002 --smallest 1e-7");
    let decades = found["verdict"].as_array().unwrap();
    let powers: Vec<f64> = decades.iter().map(|d| d["error_m"].as_f64().unwrap().log10().round()).collect();
    assert!(powers.len() >= 3 && powers.windows(2).all(|pair| pair[0] - pair[1] == 1.0), "{powers:?}");
    let smallest = ["midpoint", "verlet", "euler"].map(|curve| *errors(&found, curve).last().unwrap());
    let smallest = smallest.into_iter().fold(f64::INFINITY, f64::min);
    assert!(10_f64.powf(*powers.last().unwrap() - 1.0) < smallest, "{powers:?} {smallest}");
    for decade in decades {
        let best = &decade["best"];
        assert!(["midpoint", "verlet", "euler"].iter().any(|name| best["curve"] == *name), "{decade}");
        for other in
            ["second", "implicit", "explicit"].map(|key| &decade[key]).into_iter().filter(|o| !o.is_null())
        {
            assert!(other["ms"].as_f64() >= best["ms"].as_f64(), "{decade}");
        }
    }
}

#[test]
fn a_run_that_cannot_be_is_a_row_with_its_reason() {
    let found = compared("pair --method verlet,euler --dt 0.25,0.01");
    let runs = found["runs"].as_array().unwrap();
    let row = runs.iter().find(|run| run["curve"] == "verlet" && run["dt"] == 0.25).unwrap();
    assert!(row["note"].as_str().unwrap().contains("beyond the limit of verlet"), "{row}");
    assert!(row["error_m"].is_null() && row["ms"].is_null(), "{row}");
    let others = runs.iter().filter(|run| run["curve"] != "verlet" || run["dt"] != 0.25);
    assert!(others.clone().count() >= 3 && others.into_iter().all(|run| run["error_m"].is_f64()), "{found}");
}

#[test]
fn where_the_reference_is_not_certain_the_diagram_is_cut_and_says_so() {
    let folder = Scratch::new();
    let said = |options: &str| {
        let line = format!("work-precision pair --method verlet {options} --repeats 1 --json f.json");
        let text = folder.ok(&line).stdout;
        let found: Value = serde_json::from_str(&fs::read_to_string(folder.path("f.json")).unwrap()).unwrap();
        (text, found)
    };
    // Positions are rounded to some 1e-16 m: no reference knows digits below that.
    let (text, found) = said("--dt 0.01 --smallest 1e-17 --effort 0.2");
    assert_eq!(found["reference"]["met"], false);
    assert!(text.contains("the diagram is cut"), "{text}");
    // A reference for errors of 1 m tells nothing of one of 1e-6 m.
    let (text, found) = said("--dt 0.05,1e-3 --smallest 1");
    assert_eq!((&found["reference"]["met"], &found["dropped"]), (&true.into(), &1.into()));
    assert!(text.contains("1 of 2 runs are more accurate than the reference can tell"), "{text}");
    let certain = found["reference"]["certain_from_m"].as_f64().unwrap();
    let [coarse, fine] = &found["runs"].as_array().unwrap()[..] else { panic!("{found}") };
    assert!(coarse["error_m"].as_f64().unwrap() >= certain && coarse["dropped"] == false, "{coarse}");
    assert!(fine["error_m"].is_null() && fine["dropped"] == true, "{fine}");
}

#[test]
fn bad_options_are_refused_in_a_line_and_nothing_is_written() {
    let folder = Scratch::new();
    folder.write("scene.toml", "");
    let refusals = [
        ("pair --method verle", ["--method", "'verle'; did you mean 'verlet'?"]),
        ("pair --method auto", ["--method auto", "--accuracy"]),
        ("pair --method euler --accuracy 1e-3", ["--accuracy", "euler"]),
        ("pair --accuracy 0", ["--accuracy", "0"]),
        ("pair --dt 0.01,-1", ["--dt", "-1"]),
        ("pair --dt x", ["--dt", "'x'"]),
        ("pair --dt 1 --seconds 0.5", ["--dt 1.0", "--seconds 0.5"]),
        ("pair --dt 1e-12", ["--dt", "too many"]),
        ("pair --seconds 0", ["--seconds", "0"]),
        ("pair --repeats 0", ["--repeats", "0"]),
        ("pair --tolerance nan", ["--tolerance", "NaN"]),
        ("pair --solver jacoby", ["'jacoby'", "jacobi"]),
        ("pair --smallest -1", ["--smallest", "-1"]),
        ("pair --effort 0", ["--effort", "0"]),
        ("pair --mass 0", ["--mass", "0"]),
        ("no-scene", ["no-scene", ""]),
        ("pair --json out/work-precision.csv", ["work-precision.csv", "--out writes this file itself"]),
        ("pair --json no/such/folder.json", ["no/such/folder.json", "cannot write"]),
        ("pair --steps 3", ["--steps", ""]),
    ];
    let wrong: Vec<String> = refusals
        .iter()
        .filter_map(|(line, words)| folder.refuses(&format!("work-precision {line}"), words).err())
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

#[test]
fn instructions_are_the_same_again_and_more_for_more_steps() {
    if std::process::Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: needs valgrind");
        return;
    }
    let counts = || -> Vec<u64> {
        let found = compared("pair --method verlet,ros2 --dt 0.01,0.005 --instructions --smallest 1e-5");
        let runs = found["runs"].as_array().unwrap();
        runs.iter().map(|run| run["instructions"].as_u64().unwrap_or_else(|| panic!("{run}"))).collect()
    };
    let (first, second) = (counts(), counts());
    assert_eq!(first, second);
    // Twice the steps, within what the first of them has to find.
    for pair in first.chunks(2) {
        assert!(pair[1] > pair[0] * 3 / 2 && pair[1] < pair[0] * 5 / 2, "{first:?}");
    }
}
