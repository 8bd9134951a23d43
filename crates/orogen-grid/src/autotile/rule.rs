//! Rule tiles: tiles chosen by the first of several patterns that matches their surroundings.

use super::flip::Flips;
use super::mask::OFFSETS;

/// A pattern of the eight cells around a cell, as masks of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pattern {
    /// Directions in which the layer must continue.
    pub must: u8,
    /// Directions in which the layer must end.
    pub must_not: u8,
}

impl Pattern {
    /// Reads three rows of three characters, from the north: `#` where the layer must continue, `.` where it must end,
    /// and `?` for any. The middle is `#`. Spaces are ignored.
    ///
    /// # Errors
    /// A description of the fault in the rows, as the end of a sentence.
    pub fn read(rows: &[impl AsRef<str>]) -> Result<Pattern, String> {
        let rows: Vec<Vec<char>> =
            rows.iter().map(|row| row.as_ref().chars().filter(|at| *at != ' ').collect()).collect();
        if rows.len() != 3 || rows.iter().any(|row| row.len() != 3) {
            return Err("needs three rows of three characters: # (the layer continues), . (it ends) or ? (any)".into());
        }
        if rows[1][1] != '#' {
            return Err(format!("has `{}` in its middle, which is the cell itself: write #", rows[1][1]));
        }
        let mut pattern = Pattern::default();
        for (bit, [dx, dy]) in OFFSETS.into_iter().enumerate() {
            match rows[(dy + 1) as usize][(dx + 1) as usize] {
                '#' => pattern.must |= 1 << bit,
                '.' => pattern.must_not |= 1 << bit,
                '?' => {}
                other => return Err(format!("has `{other}`; its characters are # (goes on), . (ends) and ? (any)")),
            }
        }
        Ok(pattern)
    }

    /// Whether the surroundings `mask` match the pattern.
    #[must_use]
    pub fn matches(self, mask: u8) -> bool {
        mask & self.must == self.must && mask & self.must_not == 0
    }
}

/// For each of the 256 surroundings, the first rule that matches and the transformation of its tiles. A rule matches
/// with any of its transformations; the unchanged tile is tried first.
#[must_use]
pub fn first_matches(rules: &[(Pattern, Flips)]) -> Vec<Option<(usize, super::flip::Flip)>> {
    let matching = |mask: u8| {
        rules.iter().enumerate().find_map(|(nth, (pattern, flips))| {
            let turned = |flip: &super::flip::Flip| {
                let turned = Pattern { must: flip.mask(pattern.must), must_not: flip.mask(pattern.must_not) };
                turned.matches(mask)
            };
            flips.all().into_iter().find(turned).map(|flip| (nth, flip))
        })
    };
    (0..=255).map(matching).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autotile::flip::Flip;
    use crate::autotile::mask::{E, N, NW, S, W};

    #[test]
    fn patterns_are_read() {
        let pattern = Pattern::read(&["? # ?", ".##", "???"]).unwrap();
        assert_eq!(pattern, Pattern { must: N | E, must_not: W });
        assert!(pattern.matches(N | E | S) && !pattern.matches(N | E | W) && !pattern.matches(N));
        assert!(Pattern::read(&["###", "###"]).unwrap_err().contains("three rows"));
        assert!(Pattern::read(&["###", "#.#", "###"]).unwrap_err().contains("middle"));
        assert!(Pattern::read(&["###", "###", "##x"]).unwrap_err().contains("`x`"));
    }

    #[test]
    fn the_first_rule_counts_and_rules_turn() {
        let turns = Flips { turns: true, ..Flips::default() };
        let rules = [
            (Pattern::read(&["?.?", "?##", "???"]).unwrap(), turns),
            (Pattern { must: NW, must_not: 0 }, Flips::default()),
            (Pattern::default(), Flips::default()),
        ];
        let found = first_matches(&rules);
        assert_eq!(found[usize::from(E)], Some((0, Flip::NONE)));
        // The layer ends in the east and continues in the south: a quarter turn clockwise.
        let turned = found[usize::from(S | W | N)].unwrap();
        assert_eq!(turned, (0, Flip { diagonal: true, x: true, y: false }));
        assert_eq!(found[255], Some((1, Flip::NONE)));
        assert_eq!(found[usize::from(N | E | S | W)], Some((2, Flip::NONE)));
    }
}
