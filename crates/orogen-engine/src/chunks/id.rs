//! Identifiers of chunks.

/// A chunk: a square of terrain at a level of detail.
///
/// Level 0 is the finest. A chunk of level l + 1 covers exactly four chunks of level l, with cells twice as large. Ids
/// do not depend on the viewer: chunk (l, x, y) is always the same terrain, so ids are good keys for caches and files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChunkId {
    /// Level of detail.
    pub level: u8,
    /// Row among the chunks of its level; row 0 starts at the origin, and rows increase southward.
    pub y: i64,
    /// Column among the chunks of its level; column 0 starts at the origin, and columns increase eastward.
    pub x: i64,
}

impl ChunkId {
    /// The chunk of the next coarser level that covers this one.
    #[must_use]
    pub fn parent(self) -> ChunkId {
        ChunkId { level: self.level.saturating_add(1), y: self.y.div_euclid(2), x: self.x.div_euclid(2) }
    }

    /// The four chunks of the next finer level that cover this one, row by row from the north-west; none for level 0.
    pub fn children(self) -> impl Iterator<Item = ChunkId> {
        let four = self.level.checked_sub(1).map(|level| {
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| ChunkId { level, y: self.y * 2 + y, x: self.x * 2 + x })
        });
        four.into_iter().flatten()
    }

    /// The chunk of the same level at an offset of columns eastward and rows southward.
    #[must_use]
    pub fn beside(self, columns: i64, rows: i64) -> ChunkId {
        ChunkId { level: self.level, y: self.y + rows, x: self.x + columns }
    }

    /// Whether this chunk contains `other`.
    #[must_use]
    pub fn covers(self, other: ChunkId) -> bool {
        let Some(levels) = self.level.checked_sub(other.level) else { return false };
        let up = |n: i64| n >> levels.min(63);
        up(other.x) == self.x && up(other.y) == self.y
    }

    /// Whether the two overlap; one then contains the other.
    #[must_use]
    pub fn overlaps(self, other: ChunkId) -> bool {
        self.covers(other) || other.covers(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families() {
        let chunk = ChunkId { level: 2, y: -3, x: 5 };
        let children: Vec<ChunkId> = chunk.children().collect();
        assert_eq!(children.len(), 4);
        assert_eq!((children[0].x, children[0].y, children[3].x, children[3].y), (10, -6, 11, -5));
        for child in children {
            assert_eq!(child.parent(), chunk);
            assert!(chunk.covers(child) && !child.covers(chunk) && chunk.overlaps(child) && child.overlaps(chunk));
            assert!(child.children().all(|grandchild| chunk.covers(grandchild)));
            assert!(!chunk.beside(1, 0).overlaps(child) && !chunk.beside(0, -1).overlaps(child));
        }
        assert!(chunk.covers(chunk) && !chunk.covers(chunk.parent()));
        assert_eq!(ChunkId { level: 0, y: 0, x: 0 }.children().count(), 0);
    }
}
