//! "Did you mean …?": the nearest known name.

/// The nearest of `known`, if one is near: about a third of its letters may differ.
pub fn nearest<'a, S: AsRef<str>>(name: &str, known: &'a [S]) -> Option<&'a str> {
    known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(name, k.as_ref()), k.as_ref()))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, k)| *distance <= 1 + k.len().max(name.len()) / 3)
        .map(|(_, k)| k)
}

/// `; did you mean 'x'?` for the nearest of `known`, or nothing if none is near.
pub fn suggestion<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    nearest(name, known).map_or(String::new(), |k| format!("; did you mean '{k}'?"))
}
