use super::*;
use exr::prelude::{ReadChannels, ReadLayers, read};

#[test]
fn channels_stand_beside_the_colours() {
    let folder = std::env::temp_dir().join(format!("rara-channels-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let pixel = |i: u16| [f32::from(i), 0.25, -1.0, 0.5];
    let picture = Picture {
        width: 3,
        height: 2,
        pixels: (0..6).map(pixel).collect(),
    };
    let channel = |name: &str, values: Vec<f32>| Channel {
        name: name.into(),
        values,
    };
    let depth = channel("Z", vec![0.0, 1.5, 2.5, 1e30, -1.0, 0.1]);
    let path = folder.join("a.exr");
    picture
        .save_with(&path, std::slice::from_ref(&depth))
        .expect("writes");
    assert_eq!(Picture::load(&path).expect("reads"), picture);
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels();
    let image = image.first_valid_layer().all_attributes().from_file(&path);
    let list = image.expect("an OpenEXR file").layer_data.channel_data.list;
    let names: Vec<String> = list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["A", "B", "G", "R", "Z"]);
    let values: Vec<f32> = list[4].sample_data.values_as_f32().collect();
    assert_eq!(values, depth.values);

    for (name, channels, says) in [
        ("a.jpg", vec![], ".exr"),
        (
            "b.png",
            vec![channel("other", vec![0.0; 6])],
            "no form of 16 bits",
        ),
        (
            "b.exr",
            vec![channel("Z", vec![0.0; 5])],
            "5 numbers for 6 pixels",
        ),
        ("b.exr", vec![channel("R", vec![0.0; 6])], "called 'R'"),
    ] {
        let error = picture.save_with(folder.join(name), &channels);
        let error = error.expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
    assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);

    let normal =
        ["N.X", "N.Y", "N.Z"].map(|name| channel(name, vec![-1.0, 0.0, 1.0, 0.5, 0.0, 0.0]));
    let [x, y, z] = normal;
    let layer = channel("layer", vec![-1.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
    let all = [depth, x, y, z, layer];
    for (name, files) in [("c.png", 4), ("d.npy", 4)] {
        let before = std::fs::read_dir(&folder).expect("a folder").count();
        picture.save_with(folder.join(name), &all).expect("writes");
        let after = std::fs::read_dir(&folder).expect("a folder").count();
        assert_eq!(after - before, files, "{name}");
    }
    let read = |name: &str| image::open(folder.join(name)).expect("a picture");
    assert_eq!(
        *read("c.depth.png").as_luma16().expect("16 bits").as_raw(),
        [0, 1500, 2500, 65535, 0, 100]
    );
    assert_eq!(
        *read("c.layer.png").as_luma16().expect("16 bits").as_raw(),
        [0, 1, 2, 3, 4, 5]
    );
    let bits = read("c.normal.png").to_rgb16().into_raw();
    assert_eq!(
        [bits[0], bits[3], bits[6], bits[9]],
        [0, 32768, 65535, 49151]
    );
    let bytes = std::fs::read(folder.join("d.normal.npy")).expect("an array");
    assert!(String::from_utf8_lossy(&bytes).contains("'shape': (2, 3, 3, )"));
    assert_eq!(bytes.len(), 128 + 4 * 18);
    let bytes = std::fs::read(folder.join("d.depth.npy")).expect("an array");
    assert_eq!(
        bytes[128..],
        *bytemuck::cast_slice::<f32, u8>(&all[0].values)
    );
    std::fs::remove_dir_all(&folder).expect("ours");
}
