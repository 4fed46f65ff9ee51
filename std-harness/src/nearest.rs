//! "Did you mean …?": the nearest known name.

/// `; did you mean 'x'?` for the nearest of `known`, or nothing if none is near.
pub fn suggestion<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    let nearest = known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(name, k.as_ref()), k.as_ref()))
        .min_by_key(|(distance, _)| *distance);
    match nearest {
        Some((distance, k)) if distance <= 1 + k.len().max(name.len()) / 3 => {
            format!("; did you mean '{k}'?")
        }
        _ => String::new(),
    }
}
