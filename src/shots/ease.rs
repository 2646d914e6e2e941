//! The pace of a movement.

rara_base::named! {
    /// How a movement begins and ends.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Ease {
        /// The speed is the same all the time.
        #[default]
        None = "none",
        /// The movement begins slowly.
        In = "in",
        /// The movement ends slowly.
        Out = "out",
        /// The movement begins and ends slowly.
        Both = "both",
    }
}

impl Ease {
    /// Returns the share of the way, from 0 to 1, at a share of the time.
    pub fn way(self, time: f64) -> f64 {
        let rest = 1.0 - time;
        match self {
            Self::None => time,
            Self::In => time * time,
            Self::Out => 1.0 - rest * rest,
            Self::Both => time * time * (3.0 - 2.0 * time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn movements_reach_both_ends_and_are_slow_where_they_are_to_be() {
        for ease in Ease::ALL {
            let pace = |time: f64| (ease.way(time + 1e-6) - ease.way(time - 1e-6)) / 2e-6;
            assert_eq!([0.0, 1.0].map(|time| ease.way(time)), [0.0, 1.0]);
            let is_slow = [1e-3, 0.999].map(|time| pace(time) < 0.1);
            let begins = matches!(ease, Ease::In | Ease::Both);
            let ends = matches!(ease, Ease::Out | Ease::Both);
            assert_eq!(is_slow, [begins, ends], "{ease}");
        }
    }
}
