//! What the output files promise: that they hold the numbers they were given, open in other programs, and are whole
//! or absent.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use hooke_harness::output::picture::Strip;
use hooke_harness::output::vtk::Series;
use hooke_harness::output::{Energy, Frame, plot, safe, table};
use tiny_skia::Pixmap;
use vtkio::model::{Attribute, DataSet, IOBuffer, Piece, PolyDataPiece, VertexNumbers, Vtk};

/// A folder of its own for each test, removed with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("hooke-outputs-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir(&path).unwrap();
        Self(path)
    }

    fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Everything in it, hidden files too.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A triangle of springs and, out of its way, a particle without any.
const POSITIONS: [[f64; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.1, -0.0], [0.3, 1.0, 1e-300], [0.5, 0.5, 2.0 / 3.0]];
const VELOCITIES: [[f64; 3]; 4] = [[0.0; 3], [1.0, -2.0, 5e-324], [0.1, 0.2, 0.3], [1e300, 0.0, 0.0]];
const FIXED: [bool; 4] = [true, false, false, true];
const SPRINGS: [[usize; 2]; 3] = [[0, 1], [2, 1], [0, 2]];
const STRAIN: [f64; 3] = [0.1, -1.0 / 3.0, 0.0];
const TENSION: [f64; 3] = [12.5, -0.1, 0.0];

const FRAME: Frame<'_> = Frame {
    positions: &POSITIONS,
    velocities: &VELOCITIES,
    fixed: &FIXED,
    springs: &SPRINGS,
    strain: &STRAIN,
    tension: &TENSION,
};

fn poly_data(path: &Path) -> PolyDataPiece {
    let DataSet::PolyData { mut pieces, .. } = Vtk::import(path).unwrap().data else { panic!("no PolyData") };
    assert_eq!(pieces.len(), 1);
    match pieces.pop() {
        Some(Piece::Inline(piece)) => *piece,
        _ => panic!("no inline piece"),
    }
}

fn array<'a>(attributes: &'a [Attribute], name: &str) -> &'a IOBuffer {
    let found = attributes.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == name => Some(&array.data),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("no array {name}"))
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn buffer_bits(buffer: &IOBuffer) -> Vec<u64> {
    match buffer {
        IOBuffer::F64(values) => bits(values),
        _ => panic!("not f64"),
    }
}

#[test]
fn a_vtp_frame_holds_the_bits_it_was_given() {
    let dir = Scratch::new();
    let mut series = Series::create(&dir.0).unwrap().with_mass(&[1.0, 2.0, 3.0, 4.0]);
    series.frame(0.0, &FRAME).unwrap();
    let piece = poly_data(&dir.join("frame_00000.vtp"));
    assert_eq!(buffer_bits(&piece.points), bits(POSITIONS.as_flattened()));
    assert_eq!(buffer_bits(array(&piece.data.point, "velocity")), bits(VELOCITIES.as_flattened()));
    assert_eq!(array(&piece.data.point, "fixed"), &IOBuffer::U8(vec![1, 0, 0, 1]));
    assert_eq!(array(&piece.data.point, "mass"), &IOBuffer::F64(vec![1.0, 2.0, 3.0, 4.0]));
    let lines = VertexNumbers::XML { connectivity: vec![0, 1, 2, 1, 0, 2], offsets: vec![2, 4, 6] };
    assert_eq!(piece.lines, Some(lines));
    // The particle without a spring is a vertex cell, and its cell data comes first.
    assert_eq!(piece.verts, Some(VertexNumbers::XML { connectivity: vec![3], offsets: vec![1] }));
    assert_eq!(buffer_bits(array(&piece.data.cell, "strain")), bits(&[&[0.0], &STRAIN[..]].concat()));
    assert_eq!(buffer_bits(array(&piece.data.cell, "tension")), bits(&[&[0.0], &TENSION[..]].concat()));
}

#[test]
fn a_frame_whose_springs_all_broke_is_written_and_read() {
    let dir = Scratch::new();
    let mut series = Series::create(&dir.0).unwrap();
    series.frame(0.0, &Frame { springs: &[], strain: &[], tension: &[], ..FRAME }).unwrap();
    let piece = poly_data(&dir.join("frame_00000.vtp"));
    assert_eq!(piece.num_verts(), 4);
    assert_eq!(piece.num_lines(), 0);
}

#[test]
fn the_index_is_whole_after_every_frame() {
    let dir = Scratch::new();
    fs::write(dir.join("frame_00007.vtp"), "of an earlier run").unwrap();
    fs::write(dir.join("frame_notes.vtp"), "not ours").unwrap();
    let mut series = Series::create(&dir.0).unwrap();
    let times = [0.0, 1.0 / 60.0, 0.1 + 0.2];
    for count in 0..=times.len() {
        let text = fs::read_to_string(dir.join("motion.pvd")).unwrap();
        well_formed(&text);
        let entries: Vec<_> = text.lines().filter(|line| line.contains("<DataSet ")).collect();
        assert_eq!(entries.len(), count);
        for (number, entry) in entries.iter().enumerate() {
            assert_eq!(attribute(entry, "timestep").parse(), Ok(times[number]));
            assert_eq!(attribute(entry, "file"), format!("frame_{number:05}.vtp"));
            assert!(dir.join(attribute(entry, "file")).is_file());
        }
        if let Some(&time) = times.get(count) {
            series.frame(time, &FRAME).unwrap();
        }
    }
    let names = ["frame_00000.vtp", "frame_00001.vtp", "frame_00002.vtp", "frame_notes.vtp", "motion.pvd"];
    assert_eq!(dir.names(), names);
}

#[test]
fn contradicting_lists_are_refused_and_leave_the_series_as_it_was() {
    let dir = Scratch::new();
    let mut series = Series::create(&dir.0).unwrap();
    let before = fs::read(dir.join("motion.pvd")).unwrap();
    for frame in [
        Frame { velocities: &VELOCITIES[..3], ..FRAME },
        Frame { fixed: &[], ..FRAME },
        Frame { strain: &STRAIN[..2], ..FRAME },
        Frame { tension: &[0.0; 4], ..FRAME },
        Frame { springs: &[[0, 1], [1, 2], [3, 4]], ..FRAME },
    ] {
        assert_eq!(series.frame(0.0, &frame).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        assert!(Strip::new(90, 60, 1).add(0.0, &frame).is_err());
    }
    assert!(series.frame(f64::NAN, &FRAME).is_err());
    assert_eq!(fs::read(dir.join("motion.pvd")).unwrap(), before);
    assert_eq!(dir.names(), ["motion.pvd"]);
}

fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let start = element.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    &element[start..start + element[start..].find('"').unwrap()]
}

/// Every tag that is opened is closed in order, and no `&` stands alone.
fn well_formed(text: &str) {
    let mut open = Vec::new();
    for (position, _) in text.match_indices('<') {
        let tag = &text[position + 1..position + text[position..].find('>').unwrap()];
        assert!(!tag.contains('<'), "{tag}");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.starts_with(['?', '!']) && !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().unwrap());
        }
    }
    assert!(open.is_empty(), "{open:?} left open");
    for (position, _) in text.match_indices('&') {
        let entity = &text[position..position + text[position..].find(';').unwrap()];
        assert!(["&lt", "&gt", "&amp", "&quot", "&apos"].contains(&entity), "{entity}");
    }
}

fn energy(time: f64, kinetic: f64, springs: f64, gravity: f64) -> Energy {
    Energy { time, kinetic, springs, gravity, total: kinetic + springs + gravity }
}

/// The points of each curve. The legend, the ticks and the grid are lines of two points.
fn curves(svg: &str) -> Vec<usize> {
    let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
    lines.map(|line| attribute(line, "points").split_whitespace().count()).filter(|&n| n > 2).collect()
}

#[test]
fn the_energy_plot_is_well_formed_and_has_four_curves_units_and_names() {
    let samples: Vec<_> = (0..50).map(|i| f64::from(i) * 0.1).map(|t| energy(t, t, 1.0 - t, t * t)).collect();
    let svg = plot::svg("a <b> & \"c\"", &samples).unwrap();
    well_formed(&svg);
    assert_eq!(curves(&svg), [50; 4]);
    for text in
        ["a &lt;b&gt; &amp;", "time (s)", "energy (J)", "kinetic T", "springs V", "gravity V", "total T + V"]
    {
        assert!(svg.contains(text), "{text}");
    }
    let dir = Scratch::new();
    plot::write(&dir.join("energy.svg"), "a <b> & \"c\"", &samples).unwrap();
    assert_eq!(fs::read_to_string(dir.join("energy.svg")).unwrap(), svg);
}

#[test]
fn the_energy_plot_survives_every_kind_of_numbers() {
    let steps = |values: &[f64]| -> Vec<Energy> {
        values.iter().enumerate().map(|(i, &v)| energy(i as f64, v, 0.0, v)).collect()
    };
    let cases: [&[f64]; 10] = [
        &[],
        &[1.0],
        &[0.0; 3],
        &[-7.25; 3],
        &[1e6, 1e6 + 1e-9, 1e6],
        &[1.0, f64::NAN, f64::INFINITY, -1.0],
        &[f64::NAN; 3],
        &[f64::MAX / 4.0, -f64::MAX / 4.0, 0.0],
        &[5e-324, 0.0, 1e-300],
        &[1e-5, 2e-5, -3e-9],
    ];
    for values in cases {
        let svg = plot::svg("case", &steps(values)).unwrap();
        well_formed(&svg);
        for wrong in ["NaN", "inf", "−0\n", "-2147483648", "2147483647"] {
            assert!(!svg.contains(wrong), "{values:?}: {wrong}");
        }
    }
    assert!(plot::svg("none", &[]).unwrap().contains("no samples"));
    assert!(plot::svg("micro", &steps(&[1e-6, 9e-5])).unwrap().contains("energy (µJ)"));
}

#[test]
fn a_long_run_is_thinned_but_keeps_its_peak() {
    let mut samples: Vec<_> = (0..200_000).map(|i| energy(f64::from(i) * 1e-4, 1.0, 0.0, 0.0)).collect();
    let flat = plot::svg("flat", &samples).unwrap();
    assert!(flat.len() < 300_000, "{} bytes", flat.len());
    samples[123_457].kinetic = 100.0;
    let peak = plot::svg("peak", &samples).unwrap();
    let height = |svg: &str| {
        let kinetic = |line: &&str| line.starts_with("<polyline") && line.contains("#226DC9");
        let line = svg.lines().filter(kinetic).max_by_key(|line| line.len()).unwrap();
        let points = attribute(line, "points").split_whitespace();
        let heights = points.map(|point| point.split(',').nth(1).unwrap().parse::<i32>().unwrap());
        let (min, max) = heights.fold((i32::MAX, i32::MIN), |(l, h), y| (l.min(y), h.max(y)));
        max - min
    };
    assert_eq!(height(&flat), 0);
    assert!(height(&peak) > 1000);
}

/// One spring under `strain`, at two moments, drawn.
fn drawn(strain: f64) -> Pixmap {
    let dir = Scratch::new();
    let mut strip = Strip::new(300, 200, 2);
    for time in [0.0, 1.0] {
        let frame = Frame {
            positions: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            velocities: &[[0.0; 3]; 3],
            fixed: &[true, false, false],
            springs: &[[0, 1]],
            strain: &[strain],
            tension: &[strain],
        };
        strip.add(time, &frame).unwrap();
    }
    let path = dir.join("strip.png");
    strip.save(&path).unwrap();
    Pixmap::load_png(&path).unwrap()
}

/// Pixels above the colour bar that are clearly red and clearly blue. The amber of a pin is neither: it is almost
/// as green as it is red.
fn reddish_and_bluish(pixmap: &Pixmap) -> (usize, usize) {
    let above = pixmap.width() as usize * (pixmap.height() as usize - 30);
    let count = |lead: fn([i32; 3]) -> i32| {
        let channels = |p: &tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()].map(i32::from);
        pixmap.pixels()[..above].iter().filter(|pixel| lead(channels(pixel)) > 60).count()
    };
    (count(|[r, g, b]| r - g.max(b)), count(|[r, _, b]| b - r))
}

#[test]
fn a_stretched_spring_is_red_a_compressed_one_blue_a_relaxed_one_neither() {
    let stretched = drawn(0.2);
    assert_eq!((stretched.width(), stretched.height()), (300, 200));
    let (red, blue) = reddish_and_bluish(&stretched);
    assert!(red > 50 && blue == 0, "{red} {blue}");
    let (red, blue) = reddish_and_bluish(&drawn(-0.2));
    assert!(red == 0 && blue > 50, "{red} {blue}");
    assert_eq!(reddish_and_bluish(&drawn(0.0)), (0, 0));
}

#[test]
fn a_picture_can_be_made_of_anything() {
    let dir = Scratch::new();
    let path = dir.join("strip.png");
    let far = [[1e9; 3], [1e9 + 1.0, 1e9, 1e9], [f64::NAN, 0.0, 0.0], [1e300, f64::NEG_INFINITY, 0.0]];
    for positions in [far, [[3.0, 4.0, 5.0]; 4], [[f64::NAN; 3]; 4], [[1e17; 3]; 4], POSITIONS] {
        for count in [1, 2, 100] {
            let mut strip = Strip::new(240, 160, 3);
            for step in 0..count {
                let frame = Frame { positions: &positions, strain: &[f64::NAN, 1e300, 0.0], ..FRAME };
                strip.add(f64::from(step), &frame).unwrap();
            }
            strip.save(&path).unwrap();
            assert_eq!(Pixmap::load_png(&path).unwrap().width(), 240);
        }
    }
    Strip::new(10, 10, 0).save(&path).unwrap();
    Strip::new(1, 1, 6).save(&path).unwrap();
    assert!(Strip::new(0, 100, 6).save(&dir.join("none.png")).is_err());
    assert_eq!(dir.names(), ["strip.png"]);
}

#[test]
fn a_picture_far_from_the_origin_is_the_picture_at_the_origin() {
    let dir = Scratch::new();
    let picture = |shift: f64| {
        let positions = POSITIONS.map(|[x, y, z]| [x + shift, y, z]);
        let mut strip = Strip::new(300, 200, 1);
        strip.add(0.0, &Frame { positions: &positions, ..FRAME }).unwrap();
        let path = dir.join("strip.png");
        strip.save(&path).unwrap();
        Pixmap::load_png(&path).unwrap()
    };
    let (here, far) = (picture(0.0), picture(f64::from(1 << 30)));
    let apart = here.data().iter().zip(far.data()).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    assert!(apart < here.data().len() / 500, "{apart} of {} bytes differ", here.data().len());
}

const AWKWARD: [f64; 9] =
    [-0.0, 5e-324, f64::MIN_POSITIVE / 3.0, 1e300, -1.0 / 3.0, f64::MAX, 0.1, 1e-7, 123_456_789.125];

fn rows(path: &Path) -> (String, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.ends_with('\n') && !text.contains('\r'));
    let mut lines = text.lines();
    let header = lines.next().unwrap().to_string();
    (header, lines.map(|line| line.split(',').map(str::to_string).collect()).collect())
}

#[test]
fn the_final_state_reads_back_bit_for_bit_in_both_precisions() {
    let dir = Scratch::new();
    let path = dir.join("final.csv");
    let doubles: Vec<[f64; 3]> = AWKWARD.map(|value| [value, -value, 1.0 / value]).to_vec();
    table::write_final(&path, &doubles, &doubles).unwrap();
    let (header, read) = rows(&path);
    assert_eq!(header, "id,x,y,z,vx,vy,vz");
    assert_eq!(read.len(), doubles.len());
    for (id, row) in read.iter().enumerate() {
        let numbers: Vec<f64> = row[1..].iter().map(|text| text.parse().unwrap()).collect();
        assert_eq!(row[0], id.to_string());
        assert_eq!(bits(&numbers), bits(&[doubles[id], doubles[id]].concat()));
    }

    let singles = [[0.1_f32, -0.0, 1e-45], [16_777_217.0, f32::MAX, 1.0 / 3.0]];
    table::write_final(&path, &singles, &singles).unwrap();
    let (_, read) = rows(&path);
    // Its own shortest decimals, not those of the f64 next to it.
    assert_eq!(read[0][1..4], ["0.1".to_string(), "-0".to_string(), format!("0.{}1", "0".repeat(44))]);
    for (row, expected) in read.iter().zip(singles) {
        let numbers: Vec<u32> = row[1..4].iter().map(|text| text.parse::<f32>().unwrap().to_bits()).collect();
        assert_eq!(numbers, expected.map(f32::to_bits));
    }
    assert!(table::write_final(&dir.join("odd.csv"), &singles, &singles[..1]).is_err());
    assert_eq!(dir.names(), ["final.csv"]);
}

#[test]
fn energies_read_back_bit_for_bit() {
    let dir = Scratch::new();
    let path = dir.join("energy.csv");
    let samples: Vec<_> = AWKWARD.iter().map(|&value| energy(value, 2.0, value, -0.0)).collect();
    table::write_energy(&path, &samples).unwrap();
    let (header, read) = rows(&path);
    assert_eq!(header, "time,kinetic,springs,gravity,total");
    assert_eq!(read.len(), samples.len());
    for (row, sample) in read.iter().zip(&samples) {
        let numbers: Vec<f64> = row.iter().map(|text| text.parse().unwrap()).collect();
        let Energy { time, kinetic, springs, gravity, total } = *sample;
        assert_eq!(bits(&numbers), bits(&[time, kinetic, springs, gravity, total]));
    }
}

#[test]
fn a_failed_write_leaves_the_earlier_file_or_none() {
    let dir = Scratch::new();
    let fail = |out: &mut dyn io::Write| {
        out.write_all("x".repeat(200_000).as_bytes())?;
        Err(io::Error::other("lost interest"))
    };
    let error = safe::write_file(&dir.join("new"), fail).unwrap_err().to_string();
    assert!(error.contains("new") && error.contains("lost interest"), "{error}");
    fs::write(dir.join("old"), "kept").unwrap();
    assert!(safe::write_file(&dir.join("old"), fail).is_err());
    assert_eq!(dir.names(), ["old"]);
    assert_eq!(fs::read_to_string(dir.join("old")).unwrap(), "kept");
    safe::write_file(&dir.join("old"), |out| out.write_all(b"replaced")).unwrap();
    assert_eq!(fs::read_to_string(dir.join("old")).unwrap(), "replaced");
    assert_eq!(dir.names(), ["old"]);
}

#[cfg(unix)]
#[test]
fn a_link_is_written_through_not_replaced() {
    let dir = Scratch::new();
    fs::write(dir.join("target"), "").unwrap();
    std::os::unix::fs::symlink(dir.join("target"), dir.join("link")).unwrap();
    safe::write_file(&dir.join("link"), |out| out.write_all(b"through")).unwrap();
    assert_eq!(fs::read_to_string(dir.join("target")).unwrap(), "through");
    assert!(fs::symlink_metadata(dir.join("link")).unwrap().is_symlink());
}

/// A pipe stands for /dev/stdout and its like: a test that tried a device would, on the day it fails, replace it.
#[cfg(target_os = "linux")]
#[test]
fn a_pipe_is_written_to_not_replaced() {
    use std::io::Read;
    use std::os::unix::fs::FileTypeExt;
    let dir = Scratch::new();
    let path = dir.join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    // Open for both, which on Linux waits for nobody.
    let mut pipe = fs::OpenOptions::new().read(true).write(true).open(&path).unwrap();
    safe::prepare_file(&path).unwrap();
    safe::write_file(&path, |out| out.write_all(b"through")).unwrap();
    assert!(fs::metadata(&path).unwrap().file_type().is_fifo());
    let mut read = [0; 7];
    pipe.read_exact(&mut read).unwrap();
    assert_eq!(&read, b"through");
}

#[test]
fn a_place_that_cannot_be_written_is_refused_by_name_and_nothing_is_left() {
    let dir = Scratch::new();
    // A file where a folder should be stops every user, root included.
    fs::write(dir.join("file"), "in the way").unwrap();
    for bad in ["file", "file/sub", "file/sub/deeper"] {
        let error = safe::prepare_dir(&dir.join(bad)).unwrap_err();
        assert_eq!(error.file.as_deref(), Some(dir.join(bad).as_path()));
        assert_eq!(error.to_string().lines().count(), 1);
    }
    // The second part cannot be made, so the first must go again.
    assert!(safe::prepare_dir(&dir.join("fresh").join("x".repeat(300))).is_err());
    fs::create_dir(dir.join("folder")).unwrap();
    for bad in ["folder", "nowhere/final.csv", "file/final.csv", "folder/", ""] {
        let path = if bad.is_empty() { PathBuf::new() } else { dir.join(bad) };
        let error = safe::prepare_file(&path).unwrap_err();
        assert_eq!(error.file, Some(path), "{error}");
    }
    assert_eq!(dir.names(), ["file", "folder"]);
    assert_eq!(fs::read_to_string(dir.join("file")).unwrap(), "in the way");
    assert!(Series::create(&dir.join("file")).unwrap_err().to_string().contains("file"));
    let error = table::write_energy(&dir.join("nowhere/energy.csv"), &[]).unwrap_err().to_string();
    assert!(error.contains("energy.csv"), "{error}");
}

#[test]
fn a_place_that_can_be_written_is_ready_and_untouched() {
    let dir = Scratch::new();
    for _ in 0..2 {
        safe::prepare_dir(&dir.join("a/b/c")).unwrap();
        assert_eq!(fs::read_dir(dir.join("a/b/c")).unwrap().count(), 0);
    }
    safe::prepare_file(&dir.join("a/final.csv")).unwrap();
    fs::write(dir.join("a/old.csv"), "old").unwrap();
    safe::prepare_file(&dir.join("a/old.csv")).unwrap();
    assert_eq!(fs::read_to_string(dir.join("a/old.csv")).unwrap(), "old");
    assert_eq!(fs::read_dir(dir.join("a")).unwrap().count(), 2);
}

#[test]
fn a_write_protected_file_is_refused() {
    let dir = Scratch::new();
    let path = dir.join("protected");
    fs::write(&path, "precious").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    assert!(safe::prepare_file(&path).unwrap_err().to_string().contains("write-protected"));
}
