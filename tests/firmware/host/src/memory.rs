//! What a scene costs in RAM: the price per particle and per spring that the README names.

#[cfg(test)]
mod tests {
    use hooke::{Scene, SceneIn};

    /// Bytes that one more particle and one more spring add to a scene.
    macro_rules! added {
        ($t:ty) => {{
            let of = size_of::<Scene<$t, 40, 40>>();
            (size_of::<Scene<$t, 42, 40>>() - of, size_of::<Scene<$t, 40, 42>>() - of)
        }};
    }

    #[test]
    fn a_particle_takes_152_bytes_and_a_spring_40_in_f32() {
        assert_eq!(added!(f32), (2 * 152, 2 * 40));
        let (numbers, words) = SceneIn::<f32>::needs(1, 0);
        assert_eq!(4 * (numbers + words), 152);
    }

    #[test]
    fn a_particle_takes_272_bytes_and_a_spring_64_in_f64() {
        assert_eq!(added!(f64), (2 * 272, 2 * 64));
        let (numbers, words) = SceneIn::<f64>::needs(0, 1);
        assert_eq!(8 * numbers + 4 * words, 64);
    }
}
