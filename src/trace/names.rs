//! Names that were meant.

/// "did you mean `x`?", or some of what there is.
pub fn nearest(name: &str, known: &[&str]) -> String {
    /// Longer than this nothing is a slip of the hand, and comparing takes its time.
    const LONGEST: usize = 64;
    /// As many as one reads.
    const MOST: usize = 16;
    /// As many as are compared: a scene may have a hundred thousand names.
    const COMPARED: usize = 2_000;
    let length = name.chars().count();
    // A slip of the hand: up to a third of the letters, by edits or swaps.
    let close = |(distance, _): &(usize, &&str)| 3 * distance <= length.max(3);
    let distances = known
        .iter()
        .take(COMPARED)
        .filter(|c| length <= LONGEST && c.len() <= LONGEST)
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate));
    if let Some((_, best)) = distances
        .filter(close)
        .min_by_key(|(distance, _)| *distance)
    {
        return format!("did you mean `{best}`?");
    }
    let mut some = known[..known.len().min(MOST)].join(", ");
    if known.len() > MOST {
        some += ", …";
    }
    format!("known here: {some}")
}
