//! A list of layers from its file to what an upload takes.

use std::ffi::CStr;
use std::fs;
use std::ptr::null_mut;

use super::*;
use crate::boundary::*;
use crate::handles::alive;
use crate::layer::given;
use crate::tests::assert_fails;
use rara::glam::DVec3;
use rara::scene::{Kind, generate, save};

#[test]
fn a_list_of_layers_is_uploaded_as_it_says() {
    let folder = std::env::temp_dir().join(format!("rara-c-layers-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("the system's folder is writable");
    let scene = generate(Kind::General, 40, 1);
    save(&folder.join("bone.ply"), &scene).expect("is written");
    let list = r#"{ "layers": [
        { "name": "bone", "path": "bone.ply", "opacity": 0.5, "clip_expr": "plane:0,0,1,0" },
        { "name": "skin", "path": "bone.ply", "position": [1, 2, 3], "visible": false } ] }"#;
    let file = folder.join("scene.json");
    fs::write(&file, list).expect("is written");
    let name = CString::new(file.to_str().expect("UTF-8")).expect("no NUL");

    let mut layers = null_mut();
    // SAFETY: a string that ends in NUL, handles that are alive, and structs that may be overwritten.
    unsafe {
        assert_eq!(
            rara_layers_load(name.as_ptr(), &mut layers),
            RARA_OK,
            "{}",
            crate::tests::message()
        );
        let mut info: RaraLayersInfo = std::mem::zeroed();
        assert_eq!(
            rara_layers_info(layers, &mut info, size_of_val(&info)),
            RARA_OK
        );
        assert_eq!((info.count, info.dropped, info.repaired), (2, 0, 0));
        let mut all: [RaraLayer; 2] = std::mem::zeroed();
        for (index, layer) in all.iter_mut().enumerate() {
            let got = rara_layers_get(layers, index, layer, size_of::<RaraLayer>());
            assert_eq!(got, RARA_OK);
        }
        assert_eq!(CStr::from_ptr(all[1].name), c"skin");
        let read = given(all.as_ptr(), all.len()).expect("are what an upload takes");
        assert_eq!(read[0].state.opacity, 0.5);
        let clip = read[0].clip.as_ref().expect("has its own");
        assert!(clip.keeps(DVec3::Z) && !clip.keeps(DVec3::NEG_Z));
        assert!(!read[1].state.visible && read[1].clip.is_none());
        assert_eq!(
            read[1].state.placement.position(),
            DVec3::new(1.0, 2.0, 3.0)
        );
        assert_eq!(read[1].gaussians.gaussians.len(), 40);
        drop(read);

        let beyond = rara_layers_get(layers, 2, &mut all[0], size_of::<RaraLayer>());
        assert_fails(
            beyond,
            RARA_ERROR_INVALID,
            "index is 2, and there are 2 layers",
        );
        rara_layers_destroy(layers);
        assert!(
            alive(all[0].gaussians, "gaussians").is_err(),
            "it ends with its layers"
        );
        assert!(alive(all[0].clip, "clip").is_err(), "and so does the clip");
    }
    fs::remove_dir_all(&folder).expect("is ours");
}
