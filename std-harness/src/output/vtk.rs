//! The motion for ParaView: `frame_00000.vtp`, `frame_00001.vtp`, … and `motion.pvd`, which gives each its time.
//!
//! PolyData (`.vtp`) holds points and lines and nothing else, which is what a network of springs is; ParaView
//! shows it without a filter. Arrays are binary and uncompressed (base64 inside the XML): all bits of every
//! number, and no compression library to wait for.
//!
//! The index is valid after every frame, so an interrupted run opens as far as it came. To keep that cheap, a new
//! entry is written over the closing tags, together with new closing tags, in one write: the file only grows.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use vtkio::model::{Attribute, Attributes, ByteOrder, DataSet, PolyDataPiece, Version, VertexNumbers, Vtk};

use super::{Frame, safe};

const HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
                    byte_order=\"LittleEndian\">\n  <Collection>\n";
const TAIL: &str = "  </Collection>\n</VTKFile>\n";

/// A time series being written.
#[derive(Debug)]
pub struct Series {
    dir: PathBuf,
    index: File,
    /// Where the closing tags of the index begin.
    end: u64,
    frames: usize,
    mass: Option<Vec<f64>>,
}

impl Series {
    /// Starts a series in `dir`, which is created if missing. Frames of an earlier run in the same folder are
    /// removed: behind a shorter new run they would look like its end.
    ///
    /// # Errors
    /// The file system's, with the path in front.
    pub fn create(dir: &Path) -> io::Result<Self> {
        fs::create_dir_all(dir).map_err(|error| named(dir, &error))?;
        for entry in fs::read_dir(dir).map_err(|error| named(dir, &error))? {
            let path = entry?.path();
            if path.file_name().and_then(|name| name.to_str()).is_some_and(is_frame_name) {
                fs::remove_file(&path).map_err(|error| named(&path, &error))?;
            }
        }
        let path = dir.join("motion.pvd");
        let mut index = File::create(&path).map_err(|error| named(&path, &error))?;
        index.write_all([HEAD, TAIL].concat().as_bytes())?;
        Ok(Self { dir: dir.to_path_buf(), index, end: HEAD.len() as u64, frames: 0, mass: None })
    }

    /// Adds the particles' masses (kg) to every frame from here on.
    #[must_use]
    pub fn with_mass(mut self, mass: &[f64]) -> Self {
        self.mass = Some(mass.to_vec());
        self
    }

    /// Writes the next frame, then lists it in the index. Times are expected to increase.
    ///
    /// # Errors
    /// Lists that contradict each other, a time that is not finite, or the file system's error; then the index
    /// still ends with the last complete frame.
    pub fn frame(&mut self, time: f64, frame: &Frame<'_>) -> io::Result<()> {
        frame.check()?;
        let refuse = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        if !time.is_finite() {
            return refuse(format!("frame: time {time} is not finite"));
        }
        if let Some(mass) = self.mass.as_ref().filter(|mass| mass.len() != frame.positions.len()) {
            return refuse(format!("frame: {} masses, {} particles", mass.len(), frame.positions.len()));
        }
        let name = format!("frame_{:05}.vtp", self.frames);
        let data = poly_data(frame, self.mass.as_deref());
        safe::write_file(&self.dir.join(&name), |out| {
            data.write_xml(out).map_err(|error| io::Error::other(error.to_string()))
        })?;
        let entry = format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{name}\"/>\n");
        self.index.seek(SeekFrom::Start(self.end))?;
        self.index.write_all([&entry, TAIL].concat().as_bytes())?;
        self.end += entry.len() as u64;
        self.frames += 1;
        Ok(())
    }
}

fn poly_data(frame: &Frame<'_>, mass: Option<&[f64]>) -> Vtk {
    // ParaView draws cells, not points: a particle without a spring (all broken, or a lone one) would vanish,
    // so it becomes a vertex cell. Cell data lists vertex cells first, then lines.
    let mut loose = vec![true; frame.positions.len()];
    for &[a, b] in frame.springs {
        loose[a] = false;
        loose[b] = false;
    }
    let loose: Vec<u64> = (0..).zip(&loose).filter(|&(_, &loose)| loose).map(|(id, _)| id).collect();
    let cells = |values: &[f64]| [&vec![0.0; loose.len()], values].concat();

    let mut point = vec![
        Attribute::vectors("velocity").with_data(frame.velocities.as_flattened().to_vec()),
        Attribute::generic("fixed", 1)
            .with_data(frame.fixed.iter().map(|&f| u8::from(f)).collect::<Vec<_>>()),
    ];
    if let Some(mass) = mass {
        point.push(Attribute::generic("mass", 1).with_data(mass.to_vec()));
    }
    let cell = vec![
        Attribute::scalars("strain", 1).with_data(cells(frame.strain)),
        Attribute::generic("tension", 1).with_data(cells(frame.tension)),
    ];
    let lines = VertexNumbers::XML {
        connectivity: frame.springs.as_flattened().iter().map(|&end| end as u64).collect(),
        offsets: (1..=frame.springs.len() as u64).map(|j| 2 * j).collect(),
    };
    let verts = (!loose.is_empty()).then(|| VertexNumbers::XML {
        offsets: (1..=loose.len() as u64).collect(),
        connectivity: loose.clone(),
    });
    Vtk {
        // 1.0 is the first version with 64-bit sizes, and what every ParaView since 2013 reads.
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(PolyDataPiece {
            points: frame.positions.as_flattened().to_vec().into(),
            verts,
            lines: Some(lines),
            data: Attributes { point, cell },
            ..PolyDataPiece::default()
        }),
    }
}

fn is_frame_name(name: &str) -> bool {
    let number = name.strip_prefix("frame_").and_then(|rest| rest.strip_suffix(".vtp"));
    number.is_some_and(|digits| digits.len() >= 5 && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}
