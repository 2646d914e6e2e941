//! Disjoint sets of numbers, each member the same way round as its set or the other way.

/// Sets that are joined one by one.
pub(super) struct Sets {
    /// What each member hangs from, and whether it is the other way round than that.
    above: Vec<(u32, bool)>,
}

impl Sets {
    /// So many sets of one member each.
    pub(super) fn new(count: usize) -> Self {
        Self {
            above: (0..count as u32).map(|member| (member, false)).collect(),
        }
    }

    /// The set of a member, and whether the member is the other way round than it.
    pub(super) fn find(&mut self, member: u32) -> (u32, bool) {
        let (mut set, mut is_turned) = (member, false);
        while self.above[set as usize].0 != set {
            let (above, turned) = self.above[set as usize];
            let (beyond, turned_beyond) = self.above[above as usize];
            if beyond != above {
                // Half of the way hangs nearer to the end from now on.
                self.above[set as usize] = (beyond, turned ^ turned_beyond);
            }
            is_turned ^= self.above[set as usize].1;
            set = self.above[set as usize].0;
        }
        (set, is_turned)
    }

    /// Joins the sets of two members, of which one is the other way round than the other or not. It is false where they are
    /// joined already, and not so.
    pub(super) fn join(&mut self, a: u32, b: u32, is_other_way: bool) -> bool {
        let ((a, a_turned), (b, b_turned)) = (self.find(a), self.find(b));
        let turned = a_turned ^ b_turned ^ is_other_way;
        if a == b {
            return !turned;
        }
        // The smaller number stays, so that sets are the same whatever they were joined in.
        let (above, below) = (a.min(b), a.max(b));
        self.above[below as usize] = (above, turned);
        true
    }
}
