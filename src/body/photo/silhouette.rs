//! Silhouette of a person in a picture, as a mask of pixels.

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mask {
    pub width: usize,
    pub height: usize,
    /// Pixels row by row from the top left.
    pub bits: Vec<bool>,
}

/// Run of the person's pixels in one row: first column, and column after the last.
pub(super) type Run = (usize, usize);

impl Mask {
    pub fn new(width: usize, height: usize, bits: Vec<bool>) -> Self {
        Self { width, height, bits }
    }

    /// Runs of the person's pixels in a row, from the left.
    pub fn runs(&self, row: usize) -> Vec<Run> {
        let bits = &self.bits[row * self.width..(row + 1) * self.width];
        let starts = (0..self.width).filter(|&x| bits[x] && (x == 0 || !bits[x - 1]));
        starts.map(|start| (start, (start..self.width).find(|&x| !bits[x]).unwrap_or(self.width))).collect()
    }

    /// First and last row with pixels of the person. `None` for an empty mask.
    pub fn rows(&self) -> Option<(usize, usize)> {
        let row = |i: usize| i / self.width;
        let first = self.bits.iter().position(|bit| *bit)?;
        let last = self.bits.iter().rposition(|bit| *bit)?;
        Some((row(first), row(last)))
    }

    pub fn mirrored(&self) -> Self {
        let bits = self.bits.chunks(self.width.max(1)).flat_map(|row| row.iter().rev().copied()).collect();
        Self { bits, ..*self }
    }

    pub fn area(&self) -> usize {
        self.bits.iter().filter(|bit| **bit).count()
    }

    /// Morphological opening: removes all that is narrower than three pixels.
    pub fn opened(&self) -> Self {
        self.combined(|a, b, c| a && b && c).combined(|a, b, c| a || b || c)
    }

    /// Keeps the largest piece, and fills holes smaller than a gap between limbs.
    pub fn cleaned(&self) -> Self {
        let mut largest = self.pieces().into_iter().next().unwrap_or_default();
        largest.sort_unstable();
        let mut bits = vec![false; self.bits.len()];
        largest.iter().for_each(|&i| bits[i] = true);
        let kept = Self { bits, ..*self };
        // Background that is not connected to the border is a hole, or if larger a gap between limbs.
        let outside = Self { bits: kept.bits.iter().map(|bit| !bit).collect(), ..*self };
        let smallest_gap = kept.area() / 80;
        let mut bits = kept.bits;
        for piece in outside.pieces() {
            let at_border = |&i: &usize| {
                let (x, y) = (i % self.width, i / self.width);
                x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height
            };
            if piece.len() < smallest_gap && !piece.iter().any(at_border) {
                piece.iter().for_each(|&i| bits[i] = true);
            }
        }
        Self { bits, ..*self }
    }

    /// Combines each pixel with its neighbours, along the rows and then along the columns.
    fn combined(&self, rule: impl Fn(bool, bool, bool) -> bool) -> Self {
        let pass = |bits: &[bool], step: usize, position: &dyn Fn(usize) -> usize, count: usize| -> Vec<bool> {
            let combined = |i: usize| {
                let place = position(i);
                let before = place > 0 && bits[i - step];
                let after = place + 1 < count && bits[i + step];
                rule(before, bits[i], after)
            };
            (0..bits.len()).map(combined).collect()
        };
        let along = pass(&self.bits, 1, &|i| i % self.width, self.width);
        Self { bits: pass(&along, self.width, &|i| i / self.width, self.height), ..*self }
    }

    /// Pieces of the person's pixels connected along pixel sides, the largest first.
    pub fn pieces(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.bits.len()];
        let mut pieces = Vec::new();
        for start in 0..self.bits.len() {
            if !self.bits[start] || seen[start] {
                continue;
            }
            seen[start] = true;
            let mut piece = vec![start];
            let mut next = 0;
            while next < piece.len() {
                let i = piece[next];
                next += 1;
                let x = i % self.width;
                let around = [
                    (x > 0).then(|| i - 1),
                    (x + 1 < self.width).then_some(i + 1),
                    i.checked_sub(self.width),
                    (i + self.width < self.bits.len()).then_some(i + self.width),
                ];
                for j in around.into_iter().flatten().filter(|&j| self.bits[j]) {
                    if !seen[j] {
                        seen[j] = true;
                        piece.push(j);
                    }
                }
            }
            pieces.push(piece);
        }
        pieces.sort_by_key(|piece| std::cmp::Reverse(piece.len()));
        pieces
    }

    /// Intersection over union of two masks of equal size.
    #[cfg(test)]
    pub fn overlap(&self, other: &Self) -> f64 {
        let count = |rule: &dyn Fn(bool, bool) -> bool| {
            self.bits.iter().zip(&other.bits).filter(|(a, b)| rule(**a, **b)).count() as f64
        };
        count(&|a, b| a && b) / count(&|a, b| a || b).max(1.0)
    }
}
