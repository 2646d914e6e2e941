use super::*;

fn offer(format: vk::Format) -> vk::SurfaceFormatKHR {
    vk::SurfaceFormatKHR {
        format,
        color_space: vk::ColorSpaceKHR::SRGB_NONLINEAR,
    }
}

#[test]
fn a_format_that_is_blended_as_stored_goes_before_those_listed_first() {
    let offered = [
        offer(vk::Format::B8G8R8A8_SRGB),
        offer(vk::Format::A2B10G10R10_UNORM_PACK32),
        offer(vk::Format::R8G8B8A8_UNORM),
    ];
    let any = choose(&offered, |_| true).unwrap();
    assert_eq!(any.format, vk::Format::R8G8B8A8_UNORM);
    let ten = choose(&offered, |f| f == vk::Format::A2B10G10R10_UNORM_PACK32).unwrap();
    assert_eq!(ten.format, vk::Format::A2B10G10R10_UNORM_PACK32);
}

#[test]
fn srgb_formats_and_other_colour_spaces_are_refused_with_what_there_is() {
    let wide = vk::SurfaceFormatKHR {
        color_space: vk::ColorSpaceKHR::HDR10_ST2084_EXT,
        ..offer(vk::Format::A2B10G10R10_UNORM_PACK32)
    };
    let error = choose(&[offer(vk::Format::B8G8R8A8_SRGB), wide], |_| true).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("B8G8R8A8_SRGB") && text.contains("rara render"),
        "{text}"
    );
}

#[test]
fn a_lost_window_has_a_sentence() {
    let text = lost(vk::Result::ERROR_SURFACE_LOST_KHR).to_string();
    assert!(text.contains("the window was lost"), "{text}");
    assert!(
        lost(vk::Result::ERROR_DEVICE_LOST)
            .to_string()
            .contains("the device was lost")
    );
}
