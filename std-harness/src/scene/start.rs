//! `--from`: positions and velocities of an earlier run's `--final`, to go on from.

use std::path::Path;

use super::Model;
use crate::error::InputError;

/// The header of a final state.
const HEADER: &str = "id,x,y,z,vx,vy,vz";

/// Puts a model's particles where a file says. Rest lengths stay those of the scene.
pub fn from_file(model: &mut Model, file: &Path) -> Result<(), InputError> {
    let text = std::fs::read_to_string(file).map_err(|e| InputError::in_file(file, e.to_string()))?;
    let mut lines = text.lines().enumerate();
    let header = lines.next().map_or("", |(_, line)| line.trim());
    if header != HEADER {
        return Err(InputError::at(
            file,
            1,
            format!("'{header}' is not the header of a final state, {HEADER}"),
        ));
    }
    let mut rows = 0;
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let refuse = |message: String| Err(InputError::at(file, number + 1, message));
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let [id, numbers @ ..] = cells.as_slice() else { continue };
        if id.parse() != Ok(rows) {
            return refuse(format!("id '{id}', but {rows} is next"));
        }
        if rows >= model.position.len() {
            return refuse(format!("more particles than {} has, which are {rows}", model.name));
        }
        let mut values = [0.0; 6];
        if numbers.len() != values.len() {
            return refuse(format!("{} numbers after the id, not 6", numbers.len()));
        }
        for (value, cell) in values.iter_mut().zip(numbers) {
            match cell.parse::<f64>() {
                Ok(x) if x.is_finite() => *value = x,
                _ => return refuse(format!("'{cell}' is not a finite number")),
            }
        }
        let [x, y, z, vx, vy, vz] = values;
        (model.position[rows], model.velocity[rows]) = ([x, y, z], [vx, vy, vz]);
        rows += 1;
    }
    if rows < model.position.len() {
        let all = model.position.len();
        return Err(InputError::in_file(file, format!("{rows} particles, but {} has {all}", model.name)));
    }
    Ok(())
}
