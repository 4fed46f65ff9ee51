//! Small scenes in motion, for unit tests.

use hooke::{Gravity, LinearlyImplicitEuler};
use hooke_harness::scene::catalog;

use crate::scenario::Scenario;

pub(crate) type Forces = ((), Gravity<f64>);

/// A scene of the catalogue in one state of the window.
pub(crate) fn moving(name: &str) -> Scenario<Forces> {
    let model = catalog::named(name).unwrap().unwrap();
    let euler = LinearlyImplicitEuler::new(model.dt).gravity(model.gravity);
    let mut scenario = Scenario::new(&model, euler).unwrap();
    scenario.record(&Scenario::<Forces>::steps(model.dt, 1).unwrap(), None, |_| {}).unwrap();
    scenario.put(0);
    scenario
}
