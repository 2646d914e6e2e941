//! Sets the device's clock against the processor's.

use std::time::{Duration, Instant};

use ash::{ext, khr, vk};

use super::device::Device;

/// Reads the device's clock without a submission; for devices that are opened here.
enum Clock {
    Khr(khr::calibrated_timestamps::Device),
    Ext(ext::calibrated_timestamps::Device),
}

/// The device's clock at a moment.
#[derive(Debug, Clone, Copy)]
pub struct Calibration {
    /// Ticks, as timestamps count them.
    pub tick: u64,
    /// The moment.
    pub at: Instant,
    /// How far off the moment may be.
    pub within: Duration,
}

impl Clock {
    fn new(device: &Device, instance: &ash::Instance) -> Option<Self> {
        let name = device.support().calibrated_timestamps?;
        Some(if name == khr::calibrated_timestamps::NAME {
            Self::Khr(khr::calibrated_timestamps::Device::new(
                instance,
                device.raw(),
            ))
        } else {
            Self::Ext(ext::calibrated_timestamps::Device::new(
                instance,
                device.raw(),
            ))
        })
    }

    /// Returns the one of a few readings that took least. The processor's clock is read around the device's and not by the
    /// same call: `Instant` cannot be made from what that would give, and the error is known all the same.
    fn read(&self) -> Option<Calibration> {
        let info =
            [vk::CalibratedTimestampInfoKHR::default().time_domain(vk::TimeDomainKHR::DEVICE)];
        let reading = || {
            let before = Instant::now();
            // SAFETY: the device is alive as long as `Device`, and every device has the domain of its own clock.
            let ticks = unsafe {
                match self {
                    Self::Khr(clock) => clock.get_calibrated_timestamps(&info),
                    Self::Ext(clock) => clock.get_calibrated_timestamps(&info),
                }
            };
            let within = before.elapsed() / 2;
            let at = before + within;
            let tick = ticks.ok()?.0[0];
            Some(Calibration { tick, at, within })
        };
        let readings = (0..5).filter_map(|_| reading());
        readings.min_by_key(|reading| reading.within)
    }
}

impl Device {
    /// The device's clock now; `None` where it cannot be read.
    #[doc(hidden)]
    pub fn calibrate(&self) -> Option<Calibration> {
        Clock::new(self, self.instance())?.read()
    }
}
