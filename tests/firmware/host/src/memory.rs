//! What a scene costs in RAM: in arrays the same as in borrowed buffers. How much that is, `measure` prints.

#[cfg(test)]
mod tests {
    use hooke::{Scene, SceneIn};

    /// Bytes that one more particle and one more spring add to a scene, in arrays and in buffers.
    macro_rules! added {
        ($t:ty) => {{
            let of = size_of::<Scene<$t, 40, 40>>();
            let buffers = |(numbers, words)| numbers * size_of::<$t>() + words * size_of::<u32>();
            let arrays = [size_of::<Scene<$t, 42, 40>>() - of, size_of::<Scene<$t, 40, 42>>() - of];
            let borrowed = [SceneIn::<$t>::needs(2, 0), SceneIn::<$t>::needs(0, 2)];
            (arrays, borrowed.map(buffers))
        }};
    }

    #[test]
    fn a_particle_and_a_spring_take_as_much_in_arrays_as_in_buffers() {
        let (single, double) = (added!(f32), added!(f64));
        assert_eq!(single.0, single.1);
        assert_eq!(double.0, double.1);
    }
}
