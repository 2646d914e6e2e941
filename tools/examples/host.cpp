// A host in C++17 with a Vulkan device of its own: a depth-tested mesh, and splats of rara among it.
//   host SCENE.ply PICTURE.ppm [both|mesh|splats] [eyes]
// eyes: two of them side by side, in linear light, shifted by a part of a pixel as for temporal antialiasing; the splats write their
// depths, and the mesh, which comes last, meets them.
// RARA_DEVICE: part of the device's name. RARA_VALIDATION: load the Khronos layer; any message is exit status 1.
#include "rara.h"
#include "engine.h"
#include <cstring>

#define RARA(call) check((call) == RARA_OK, rara_last_error_message())
constexpr RaraDepthMap REVERSED{0, 0.05, RARA_PROJECTION_PERSPECTIVE};  // 0.05 / z: 1 at 0.05, 0 at infinity

int main(int count, char **arguments) {
    check(count >= 3, "usage: host SCENE.ply PICTURE.ppm [both|mesh|splats] [eyes]");
    const std::string what = count > 3 ? arguments[3] : "both";
    const uint32_t eye_count = count > 4 ? 2 : 1;
    const bool mesh_last = eye_count > 1;
    const bool validation = getenv("RARA_VALIDATION") != nullptr;
    check(rara_abi_version() == RARA_ABI_VERSION, "rara.h and the library are of different versions");
    RARA(rara_set_log([](RaraLogLevel level, const char *text, void *) {
        if (level <= RARA_LOG_LEVEL_WARN) fprintf(stderr, "rara: %s\n", text);
    }, nullptr));

    VkInstance instance = make_instance(validation);

    // Find a device that will do, before there is one, and add what rara needs of it to what the host enables.
    uint32_t devices = 16;
    VkPhysicalDevice all[16];
    VkResult listed = vkEnumeratePhysicalDevices(instance, &devices, all);
    check(listed == VK_SUCCESS || listed == VK_INCOMPLETE, "vkEnumeratePhysicalDevices failed");
    RaraSupport support{};
    std::string why = "no Vulkan device of this name";
    for (uint32_t i = 0; i < devices && !physical; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(all[i], &properties);
        const char *name = getenv("RARA_DEVICE");
        if (name && !strstr(properties.deviceName, name)) continue;
        if (rara_check(vkGetInstanceProcAddr, instance, all[i], VK_API_VERSION_1_3, &support, sizeof support) == RARA_OK) physical = all[i];
        else why = rara_last_error_message();
    }
    check(physical, why);
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh_shader{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT};
    VkPhysicalDeviceVulkan13Features vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, support.mesh_shader ? &mesh_shader : nullptr};
    VkPhysicalDeviceVulkan12Features vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &vulkan13};
    RARA(rara_support_features(&support, &vulkan12));
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, support.queue_family, 1, &priority};
    VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &vulkan12, 0, 1, &queue_info, 0, nullptr, support.extension_count, support.extensions};
    VK(vkCreateDevice(physical, &device_info, nullptr, &device));
    VkQueue queue;
    vkGetDeviceQueue(device, support.queue_family, 0, &queue);

    // The host's targets, mesh and command buffer.
    Image colour = make_image(COLOUR, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    Image depth = make_image(DEPTH, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    Readback readback = make_readback();
    VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)};
    VkPipelineLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 0, nullptr, 1, &range};
    VkPipelineLayout layout;
    VK(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout));
    VkPipeline pipeline = mesh_pipeline(layout);
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, support.queue_family};
    VkCommandPool pool;
    VK(vkCreateCommandPool(device, &pool_info, nullptr, &pool));
    VkCommandBufferAllocateInfo cmd_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer cmd;
    VK(vkAllocateCommandBuffers(device, &cmd_info, &cmd));

    // rara: the device is lent, a scene loaded and uploaded, a renderer made for the host's attachments.
    RaraAdoptDesc adopt;
    RARA(rara_adopt_desc_default(&adopt, sizeof adopt));
    adopt.get_instance_proc_addr = vkGetInstanceProcAddr;
    adopt.instance = instance, adopt.physical_device = physical, adopt.device = device;
    adopt.queue = queue, adopt.queue_family = support.queue_family;
    adopt.mesh_shader = support.mesh_shader, adopt.push_descriptor = support.push_descriptor, adopt.debug_utils = validation;
    adopt.full_subgroups = support.full_subgroups;
    RaraDevice *lent;
    RARA(rara_device_adopt(&adopt, &lent));
    RaraGaussians *gaussians;
    RARA(rara_gaussians_load(arguments[1], nullptr, 0, &gaussians));
    RaraGaussiansInfo scene_info;
    RARA(rara_gaussians_info(gaussians, &scene_info, sizeof scene_info));
    struct Eye {
        RaraRenderer *renderer;
        RaraFrame *frame;
        RaraCamera camera;
        Push push;
        VkRect2D area;
    } eyes[2]{};
    const double up[3]{0, -1, 0};
    for (uint32_t e = 0; e < eye_count; e++) {
        eyes[e].area = {{int32_t(W / eye_count * e), 0}, {W / eye_count, H}};
        RARA(rara_camera_frame(gaussians, up, 50, W / eye_count, H, &eyes[e].camera, sizeof eyes[e].camera));
    }
    RaraSceneBuffers *scene;
    RaraLayer layer;
    RARA(rara_layer_default(&layer, sizeof layer, "scene", gaussians));
    RARA(rara_scene_buffers_upload(lent, &layer, 1, RARA_SH_FORMAT_PACKED, &scene));
    rara_gaussians_destroy(gaussians);
    RaraDepthDesc tested;
    RARA(rara_depth_desc_default(&tested, sizeof tested, DEPTH, REVERSED));
    RaraRendererDesc desc;
    RARA(rara_renderer_desc_default(&desc, sizeof desc, COLOUR));
    tested.readable = VK_TRUE;  // rara_renderer_prepare is given the depths: without them splats are quads, several times as slow
    desc.depth = &tested, desc.timing = VK_TRUE;
    desc.bindings = validation ? RARA_BINDINGS_BOUND : RARA_BINDINGS_ADDRESS;  // the layer can watch bound buffers
    if (eye_count > 1) desc.color_space = RARA_COLOR_SPACE_LINEAR, tested.write_alpha = 0.5f;
    RARA(rara_renderer_create(lent, &desc, &eyes[0].renderer));
    if (eye_count > 1) RARA(rara_renderer_create_sharing(eyes[0].renderer, &desc, &eyes[1].renderer));

    // The scene cut through its middle, and a mesh there.
    double centre[3], size = 0;
    for (int i = 0; i < 3; i++) {
        centre[i] = (scene_info.bounds_min[i] + scene_info.bounds_max[i]) / 2;
        size = std::max(size, scene_info.bounds_max[i] - scene_info.bounds_min[i]);
    }
    RaraPlane plane{{-0.28, 0, 0.96}, -(-0.28 * centre[0] + 0.96 * centre[2])};
    RaraClip *clip;
    RARA(rara_clip_of_planes(&plane, 1, RARA_CLIP_OP_AND, &clip));
    for (uint32_t e = 0; e < eye_count; e++) {
        RaraCamera &camera = eyes[e].camera;
        Push &push = eyes[e].push;
        if (eye_count > 1) {
            for (int i = 0; i < 3; i++) camera.eye[i] += (e ? 0.02 : -0.02) * size * camera.rotation[i];  // along its first axis
            camera.cx += 0.25, camera.cy -= 0.375;
        }
        for (int i = 0; i < 3; i++) push.centre_radius[i] = float(centre[i]);
        push.centre_radius[3] = float(0.4 * size);
        for (int column = 0; column < 4; column++) {
            double p[3]{};
            for (int row = 0; row < 3; row++)
                for (int i = 0; i < 3; i++) p[row] += camera.rotation[3 * row + i] * (column < 3 ? i == column : -camera.eye[i]);
            push.world_to_clip[4 * column] = float(2 * camera.fx / camera.width * p[0] + (2 * camera.cx / camera.width - 1) * p[2]);
            push.world_to_clip[4 * column + 1] = -float(2 * camera.fy / camera.height * p[1] + (2 * camera.cy / camera.height - 1) * p[2]);  // y is up
            push.world_to_clip[4 * column + 2] = column < 3 ? 0 : float(REVERSED.scale);
            push.world_to_clip[4 * column + 3] = float(p[2]);
        }
    }

    // A frame: the mesh in a rendering scope, then rara's stages, which read its depths, then the splats in a second scope. Both
    // eyes show one cut.
    RaraCut *cut;
    RARA(rara_cut_create(eyes[0].renderer, &cut));
    RARA(rara_cut_configure(cut, scene, clip, nullptr));
    rara_clip_destroy(clip);
    for (uint32_t e = 0; e < eye_count; e++) RARA(rara_renderer_configure_cut(eyes[e].renderer, scene, &eyes[e].camera, cut, nullptr, &eyes[e].frame));
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VK(vkBeginCommandBuffer(cmd, &begin));
    barrier(cmd, colour.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo onto{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, nullptr, colour.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    onto.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, onto.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingAttachmentInfo behind = onto;
    behind.imageView = depth.view, behind.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    behind.clearValue.depthStencil = {0, 0};
    onto.clearValue.color = {{0, 0, 0, 1}};
    VkRenderingInfo scope{VK_STRUCTURE_TYPE_RENDERING_INFO, nullptr, 0, {{0, 0}, {W, H}}, 1, 0, 1, &onto, &behind};
    auto draw_mesh = [&] {
        for (uint32_t e = 0; e < eye_count && what != "splats"; e++) {
            const auto &[origin, extent] = eyes[e].area;
            VkViewport viewport{float(origin.x), H, float(extent.width), -float(H), 0, 1};  // the host's own: splats need none
            vkCmdSetViewport(cmd, 0, 1, &viewport);
            vkCmdSetScissor(cmd, 0, 1, &eyes[e].area);
            vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push), &eyes[e].push);
            vkCmdDraw(cmd, 24, 1, 0, 0);
        }
    };
    vkCmdBeginRendering(cmd, &scope);
    if (!mesh_last) draw_mesh();
    vkCmdEndRendering(cmd);
    barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    RaraDepthImage drawn;
    RARA(rara_depth_image_default(&drawn, sizeof drawn, depth.image, W, H));
    RARA(rara_cut_prepare(cut, cmd));
    for (uint32_t e = 0; e < eye_count; e++) {
        drawn.x = eyes[e].area.offset.x;
        RARA(rara_renderer_prepare(eyes[e].renderer, cmd, scene, &drawn, eyes[e].frame));  // copies the depths
    }
    barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    barrier(cmd, colour.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    onto.loadOp = behind.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    vkCmdBeginRendering(cmd, &scope);
    for (uint32_t e = 0; e < eye_count; e++) {
        vkCmdSetScissor(cmd, 0, 1, &eyes[e].area);
        if (what != "mesh") RARA(rara_renderer_draw(eyes[e].renderer, cmd, float(eyes[e].area.offset.x), 0, eyes[e].frame));
        rara_frame_destroy(eyes[e].frame);
    }
    if (mesh_last) draw_mesh();
    vkCmdEndRendering(cmd);
    barrier(cmd, colour.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    copy(cmd, colour.image, readback);
    VK(vkEndCommandBuffer(cmd));
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &cmd};
    VK(vkQueueSubmit(queue, 1, &submit, nullptr));
    VK(vkQueueWaitIdle(queue));

    // The picture, and the statistics of the frame.
    save(arguments[2], readback);
    RaraFrameStats stats;
    RARA(rara_renderer_stats(eyes[0].renderer, &stats, sizeof stats));
    printf("%u visible, %u cut, %u clipped away, %u culled; %.2f ms:", stats.visible, stats.cutoff, stats.invisible, stats.culled, stats.gpu_ms);
    for (uint32_t i = 0; i < stats.pass_count; i++) printf(" %s %.2f", stats.passes[i].name, stats.passes[i].ms);
    printf("\n");

    // Everything of rara's goes first; the host destroys its own.
    rara_cut_destroy(cut);
    for (Eye &eye : eyes) rara_renderer_destroy(eye.renderer);
    rara_scene_buffers_destroy(scene);
    check(rara_device_bytes(lent) == 0, "rara kept memory");
    rara_device_destroy(lent);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    destroy(readback);
    destroy(colour);
    destroy(depth);
    vkDestroyDevice(device, nullptr);
    destroy(instance);
    return messages ? 1 : 0;
}
