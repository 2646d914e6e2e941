//! Vulkan's result codes as the crate's errors, with the sentence a person needs for the ones that are nobody's bug.

use ash::vk;

use rara_base::error::Error;

/// The error of a Vulkan call, to be used with `map_err`: a lost device and exhausted memory are errors of their own.
pub fn failed(call: &'static str) -> impl FnOnce(vk::Result) -> Error {
    move |result| match result {
        vk::Result::ERROR_DEVICE_LOST => Error::DeviceLost { call },
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            Error::Memory(format!("{call} ran out of device memory"))
        }
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
            Error::Memory(format!("{call} ran out of host memory"))
        }
        result => Error::Vulkan {
            call,
            code: result.as_raw(),
            text: result.to_string(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lost_devices_and_exhausted_memory_have_sentences() {
        let lost = failed("vkQueueSubmit2")(vk::Result::ERROR_DEVICE_LOST);
        assert_eq!(
            lost.to_string(),
            "the device was lost (vkQueueSubmit2): the driver crashed, was reset or stopped a submission that ran too \
             long; nothing on this device can be used any more"
        );
        assert!(matches!(lost, Error::DeviceLost { .. }));
        let full = failed("vkCreateBuffer")(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        assert!(matches!(full, Error::Memory(_)));
        let other = failed("vkCreateFence")(vk::Result::ERROR_UNKNOWN);
        assert!(matches!(
            other,
            Error::Vulkan {
                call: "vkCreateFence",
                ..
            }
        ));
    }
}
