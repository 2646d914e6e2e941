use super::*;

fn texture(at: (u32, u32), size: (u32, u32)) -> PanelTexture {
    let panel = Panel {
        at,
        picture: Picture::filled(size.0, size.1, [0.0, 0.5, 1.0, 0.0]),
    };
    let mut panels = Panels::default();
    panels.set(&[panel], vk::Format::B8G8R8A8_UNORM);
    panels.stored.remove(0)
}

#[test]
fn pixels_are_stored_as_each_format_of_a_window_has_them() {
    let orange = [1.0, 0.5, 0.0, 0.0];
    let bytes = |format| packed(orange, format);
    assert_eq!(bytes(vk::Format::B8G8R8A8_UNORM), Some([0, 128, 255, 255]));
    assert_eq!(bytes(vk::Format::R8G8B8A8_UNORM), Some([255, 128, 0, 255]));
    let word = |format| bytes(format).map(u32::from_ne_bytes);
    assert_eq!(
        word(vk::Format::A2B10G10R10_UNORM_PACK32),
        Some(3 << 30 | 512 << 10 | 1023)
    );
    assert_eq!(
        word(vk::Format::A2R10G10B10_UNORM_PACK32),
        Some(3 << 30 | 1023 << 20 | 512 << 10)
    );
    assert!(!are_possible(vk::Format::R16G16B16A16_SFLOAT));
}

#[test]
fn a_picture_without_its_pixels_is_left_out() {
    let mut picture = Picture::filled(4, 4, [0.0; 4]);
    picture.pixels.pop();
    let mut panels = Panels::default();
    panels.set(
        &[Panel {
            at: (0, 0),
            picture,
        }],
        vk::Format::B8G8R8A8_UNORM,
    );
    assert!(panels.stored.is_empty());
}

#[test]
fn what_lies_beyond_the_window_is_left_out() {
    let window = (100, 50);
    assert_eq!(within(&texture((8, 8), (20, 10)), window), Some((20, 10)));
    assert_eq!(within(&texture((90, 45), (20, 10)), window), Some((10, 5)));
    assert_eq!(within(&texture((100, 0), (20, 10)), window), None);
    assert_eq!(within(&texture((0, u32::MAX), (20, 10)), window), None);
    assert_eq!(within(&texture((0, 0), (0, 10)), window), None);
    let region = copy(16, &texture((90, 45), (20, 10)), (10, 5));
    assert_eq!(
        (region.buffer_row_length, region.image_extent.width),
        (20, 10)
    );
}

#[test]
fn panels_that_share_an_edge_do_not_overlap() {
    let first = texture((10, 10), (20, 10));
    for (at, meets) in [
        ((30, 10), false),
        ((29, 19), true),
        ((10, 20), false),
        ((0, 0), false),
        ((0, 1), true),
    ] {
        let other = texture(at, (11, 10));
        assert_eq!(overlap(&first, &other), meets, "{at:?}");
        assert_eq!(overlap(&other, &first), meets, "{at:?}");
    }
}

#[test]
fn a_cover_is_stored_without_its_alpha() {
    let mut panels = Panels::default();
    let picture = Picture::filled(3, 2, [0.0, 0.5, 1.0, 0.25]);
    panels.set_cover(Some(&picture), vk::Format::R8G8B8A8_UNORM);
    let cover = panels.cover.as_ref().expect("a cover");
    assert_eq!((cover.at, cover.size), ((0, 0), (3, 2)));
    assert_eq!(cover.bytes, [0, 128, 255, 255].repeat(6));
    panels.set_cover(Some(&picture), vk::Format::R16G16B16A16_SFLOAT);
    assert!(panels.cover.is_none());
}
