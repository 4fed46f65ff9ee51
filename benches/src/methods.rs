//! Hooke's own solvers, as `hooke run --solver` names them, with the memory that each needs. A solver that the harness
//! knows is here as soon as it has a line in [`name`].

use hooke::{BandedLdl, Force, SceneIn};
use hooke_harness::error::InputError;
use hooke_harness::nearest;
use hooke_harness::run::solver::{AnySolver, METHODS, Method};

use crate::peers::affordable;
use crate::scenario::{HostScene, Scenario};

/// What a line of the tables calls it.
pub(crate) fn name(method: Method) -> &'static str {
    match method {
        Method::Jacobi => "hooke block-Jacobi PCG",
        Method::Wide => "hooke wide PCG",
        Method::Wide32 => "hooke wide PCG f32",
        Method::Multigrid => "hooke multigrid PCG",
        Method::Ssor => "hooke SSOR PCG",
        Method::Ilu => "hooke D-ILU PCG",
        Method::Banded => "hooke banded LDL",
        Method::Ldl => "hooke sparse LDL",
        Method::Ldl32 => "hooke sparse LDL f32",
    }
}

/// Does it iterate more than a few times, so that an iteration can be told from the rest of a step?
pub(crate) fn iterates(method: Method) -> bool {
    !matches!(method, Method::Banded | Method::Ldl | Method::Ldl32)
}

/// The methods of these names; `usual` if there are none.
pub(crate) fn named(names: &[String], usual: &[Method]) -> Result<Vec<Method>, InputError> {
    if names.is_empty() {
        return Ok(usual.into());
    }
    let known = METHODS.map(|(name, _)| name);
    let find = |name: &String| {
        METHODS.iter().find(|(known, _)| known == name).map(|(_, method)| *method).ok_or_else(|| {
            let near = nearest::suggestion(name, &known);
            InputError::new(format!("--method '{name}' is none of {}{near}", known.join(" ")))
        })
    };
    names.iter().map(find).collect()
}

/// All of them, in the order of the tables.
pub(crate) fn all() -> Vec<Method> {
    METHODS.iter().map(|(_, method)| *method).collect()
}

/// The solver with the memory that this scene needs; or why it is skipped.
pub(crate) fn solver<F: Force<f64> + Clone>(
    method: Method,
    scenario: &mut Scenario<F>,
) -> Result<AnySolver<f64>, String> {
    if method == Method::Banded {
        // 9 numbers per row and row of bandwidth. The same rule as for a peer.
        let rows = scenario.particle.len().max(1);
        let width = BandedLdl::needs_of(&mut scenario.scene) / (9 * rows);
        affordable(std::iter::repeat_n(3 * width, 3 * rows))?;
    }
    let solver = AnySolver::new(method, &mut scenario.scene, &scenario.model);
    if matches!(method, Method::Wide | Method::Wide32) && solver.bytes() == 0 {
        return Err("no island has a layout in lanes, so it is block-Jacobi PCG".into());
    }
    Ok(solver)
}

/// Bytes of a scene with this solver: its state, islands, matrix and vectors, and the solver's own scratch.
pub(crate) fn bytes(scene: &HostScene, solver: &AnySolver<f64>) -> usize {
    let (reals, words) = SceneIn::<f64>::needs(scene.positions().len(), scene.state().springs());
    reals * size_of::<f64>() + words * size_of::<u32>() + solver.bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_name_is_that_of_hooke_run_and_a_wrong_one_is_named() {
        let names = |words: &[&str]| named(&words.iter().map(|w| w.to_string()).collect::<Vec<_>>(), &[]);
        assert_eq!(names(&["wide", "ldl"]).unwrap(), [Method::Wide, Method::Ldl]);
        assert!(names(&["mutigrid"]).unwrap_err().message.contains("did you mean 'multigrid'?"));
    }

    #[test]
    fn what_a_solver_needs_beside_the_scene_is_counted() {
        let mut scenario = testing::moving("cloth:8");
        let mut bytes = |method| {
            let solver = solver(method, &mut scenario).unwrap();
            bytes(&scenario.scene, &solver)
        };
        let plain = bytes(Method::Jacobi);
        // A row is tied to the one below and its neighbour: 9 numbers for each of 9 rows of bandwidth.
        let rows = 8 * 8 - 2;
        assert_eq!(bytes(Method::Banded) - plain, 8 * 9 * 9 * rows);
        for method in [Method::Wide, Method::Wide32, Method::Multigrid, Method::Ldl] {
            assert!(bytes(method) > plain, "{method}");
        }
    }

    #[test]
    fn lanes_that_are_not_used_are_no_method_of_their_own() {
        // Farther apart in the numbering than there are runs for.
        let mut model =
            hooke_harness::scene::Model::at_rest("star", (0..40).map(|i| [f64::from(i); 3]).collect(), 0.1);
        let stiffness = 10.0;
        let spring = |end: usize| hooke_harness::scene::ModelSpring {
            ends: [0, end],
            stiffness,
            rest_length: 1.0,
            damping: 0.0,
            cable: false,
        };
        model.springs = (1..40).map(spring).collect();
        let euler = hooke::LinearlyImplicitEuler::<f64>::new(0.01).gravity([0.0; 3]);
        let mut scenario = Scenario::new(&model, euler).unwrap();
        for method in [Method::Wide, Method::Wide32] {
            assert!(solver(method, &mut scenario).err().unwrap().contains("lanes"));
        }
        assert!(solver(Method::Jacobi, &mut scenario).is_ok());
    }

    #[test]
    fn a_band_that_would_take_minutes_is_refused_before_its_memory_is_asked_for() {
        let mut scenario = testing::resting("cloth:256");
        let why = solver(Method::Banded, &mut scenario).err().unwrap();
        assert!(why.contains("multiplications"), "{why}");
    }
}
