//! Small scenes in motion, for unit tests.

use hooke::{Gravity, LinearlyImplicitEuler};
use hooke_harness::scene::catalog;

use crate::scenario::{Scenario, WINDOW};

pub(crate) type Forces = ((), Gravity<f64>);

/// A scene of the catalogue as it is at the start, without states.
pub(crate) fn resting(name: &str) -> Scenario<Forces> {
    let model = catalog::named(name).unwrap().unwrap();
    let euler = LinearlyImplicitEuler::new(model.dt).gravity(model.gravity);
    Scenario::new(&model, euler).unwrap()
}

/// The same in so many states of the window.
pub(crate) fn in_states(name: &str, states: usize) -> Scenario<Forces> {
    let mut scenario = resting(name);
    let steps = Scenario::<Forces>::steps(scenario.model.dt, states, WINDOW).unwrap();
    scenario.record(&steps, None, |_| {}).unwrap();
    scenario.put(0);
    scenario
}

/// The same in one state.
pub(crate) fn moving(name: &str) -> Scenario<Forces> {
    in_states(name, 1)
}
