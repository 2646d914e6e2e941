use super::*;

#[test]
fn messages_say_where_and_about_what() {
    // The innermost label comes first.
    let labels = [c"step", c"sort"].map(|name| vk::DebugUtilsLabelEXT::default().label_name(name));
    let object = |kind, name| {
        let mut object = vk::DebugUtilsObjectNameInfoEXT::default().object_name(name);
        object.object_type = kind;
        object
    };
    let mut nameless = object(vk::ObjectType::DEVICE, c"");
    nameless.p_object_name = std::ptr::null();
    let objects = [
        object(vk::ObjectType::COMMAND_BUFFER, c"one-off"),
        object(vk::ObjectType::BUFFER, c"splats"),
        nameless,
    ];
    let data = vk::DebugUtilsMessengerCallbackDataEXT::default().message(c"a hazard");
    let message = |data: vk::DebugUtilsMessengerCallbackDataEXT<'_>| {
        // SAFETY: the struct was filled by its own setters.
        unsafe { describe(&data, &[]) }
    };
    assert_eq!(message(data), "a hazard");
    // SAFETY: as above.
    let recording = unsafe { describe(&data, &["tiles".into()]) };
    assert_eq!(recording, "in pass tiles: a hazard");
    assert_eq!(
        message(data.cmd_buf_labels(&labels)),
        "in pass sort > step: a hazard"
    );
    assert_eq!(
        message(data.cmd_buf_labels(&labels[1..]).objects(&objects)),
        "in pass sort: command buffer one-off, buffer splats: a hazard"
    );
    assert_eq!(
        message(vk::DebugUtilsMessengerCallbackDataEXT::default()),
        "(no text)"
    );
}
