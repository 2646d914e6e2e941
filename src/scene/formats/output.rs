//! What the reader of a format makes of a file.

use glam::DAffine3;

use crate::assemble::Assembler;
use crate::failure::Failure;
use crate::parts::{keep, without};
use crate::placement::Placement;
use crate::{Annotations, Gaussians, LoadReport, Property};
use rara_base::counted::counted;

/// What a reader makes of a file.
#[derive(Default)]
pub(super) struct FormatOutput {
    pub(super) gaussians: Gaussians,
    pub(super) report: LoadReport,
    /// The file's elements, those included that were dropped.
    pub(super) elements: u64,
    /// The numbers of those that were dropped or not asked for, which ascend.
    pub(super) dropped: Vec<u64>,
    pub(super) annotations: Option<Annotations>,
    /// The values of the properties that were asked for, which no part but this may have.
    pub(super) properties: Vec<Property>,
    /// What the file has beside that is neither read nor said, by its names.
    pub(super) others: Vec<String>,
}

impl From<Assembler> for FormatOutput {
    fn from(assembler: Assembler) -> Self {
        let (elements, dropped) = (assembler.rows(), assembler.dropped.clone());
        let (loaded, properties) = assembler.finish();
        Self {
            gaussians: loaded.gaussians,
            report: loaded.report,
            elements,
            dropped,
            properties,
            ..Self::default()
        }
    }
}

impl FormatOutput {
    /// Appends what another part of the file has become.
    pub(super) fn append(&mut self, other: Self) -> Result<(), Failure> {
        let before = self.elements;
        let differs = self.gaussians.training() != other.gaussians.training();
        if differs && !self.gaussians.is_empty() && !other.gaussians.is_empty() {
            self.report.note(format!(
                "some parts were trained in other ways; all are drawn {}, as the first is",
                self.gaussians.training()
            ));
        }
        let (own, more) = (self.gaussians.len(), other.gaussians.len());
        join(&mut self.properties, own, other.properties, more);
        for name in other.others {
            if !self.others.contains(&name) {
                self.others.push(name);
            }
        }
        if self.gaussians.is_empty() {
            self.gaussians = other.gaussians; // most files have one part
        } else {
            self.gaussians
                .try_append(&other.gaussians)
                .ok_or_else(|| Failure::Memory(counted(other.elements + before, "Gaussian")))?;
        }
        self.report.append(other.report, before);
        self.elements += other.elements;
        let dropped = other.dropped.iter().map(|element| before + element);
        self.dropped.extend(dropped);
        Ok(())
    }

    /// The element that each Gaussian was.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u64> {
        let mut dropped = self.dropped.iter().peekable();
        (0..self.elements).filter(move |element| dropped.next_if(|next| *next == element).is_none())
    }

    /// Places the Gaussians; what cannot be held there is dropped.
    pub(super) fn place(&mut self, placement: &Placement) {
        let lost = self.gaussians.place(placement);
        self.drop_lost(lost);
    }

    /// Applies a transform that is no placement; what cannot be held where it leads is dropped.
    pub(super) fn transform(&mut self, transform: &DAffine3) {
        let lost = self.gaussians.transform(transform);
        self.drop_lost(lost);
    }

    /// Drops the Gaussians of these numbers, which are gone.
    fn drop_lost(&mut self, lost: Vec<u32>) {
        if lost.is_empty() {
            return;
        }
        let numbers: Vec<u64> = self.numbers().collect();
        let kept = without(&lost, numbers.len());
        for property in &mut self.properties {
            keep(&mut property.values, &kept, 1);
        }
        for index in lost {
            let element = numbers[index as usize];
            self.dropped.push(element);
            self.report.drop_element(element, || {
                "it is beyond single precision where it is placed".into()
            });
        }
        self.dropped.sort_unstable();
    }
}

/// Appends the values of so many more Gaussians to those of properties; what one of both has not is no number.
fn join(properties: &mut Vec<Property>, own: usize, others: Vec<Property>, more: usize) {
    for mut other in others {
        match properties.iter_mut().find(|known| known.name == other.name) {
            Some(known) => known.values.append(&mut other.values),
            None => {
                other.values.splice(..0, std::iter::repeat_n(f64::NAN, own));
                properties.push(other);
            }
        }
    }
    for property in properties {
        property.values.resize(own + more, f64::NAN);
    }
}
