//! Disjoint sets.

/// Members 0, 1, 2, ... in sets that can be joined.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    /// For each member, a lower one of its set, or itself if it is the lowest.
    parents: Vec<u32>,
}

impl Sets {
    /// Every member its own set.
    pub fn new(members: usize) -> Self {
        let mut sets = Self::default();
        sets.reset(members);
        sets
    }

    /// Back to every member its own set, without a new allocation if there is room.
    pub(crate) fn reset(&mut self, members: usize) {
        self.parents.clear();
        self.parents.extend(0..members as u32);
    }

    /// Makes two sets one; says whether they were two.
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// The lowest member of a set; paths are halved on the way.
    pub fn lowest(&mut self, mut member: u32) -> u32 {
        while self.parents[member as usize] != member {
            let parent = self.parents[member as usize];
            self.parents[member as usize] = self.parents[parent as usize];
            member = parent;
        }
        member
    }
}
