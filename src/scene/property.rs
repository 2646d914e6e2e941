//! Properties that a file has of each Gaussian beside those that a Gaussian is made of.

/// A property's values, one for each Gaussian.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Property {
    /// The name of the property in the file.
    pub name: String,
    /// The values; what was dropped of the Gaussians was dropped here.
    pub values: Vec<f64>,
    /// True when the file stores them in single precision.
    pub single: bool,
}

impl Property {
    /// A property whose values are double-precision numbers or integers.
    pub fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            values,
            single: false,
        }
    }

    /// The values of the Gaussians of these numbers, in their order.
    pub fn of(&self, numbers: &[u32]) -> Self {
        let values = numbers.iter().map(|&number| self.values[number as usize]);
        Self {
            name: self.name.clone(),
            values: values.collect(),
            single: self.single,
        }
    }
}
