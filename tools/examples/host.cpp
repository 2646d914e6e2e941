// A host in C++17 with plain vulkan.h: its own instance, device, depth buffer and mesh, and splats of rara among them.
//   host SCENE.ply PICTURE.ppm [both|mesh|splats]
// RARA_DEVICE: part of the device's name. RARA_VALIDATION: load the Khronos layer; any message is exit status 1.
#include "../../src/c/rara.h"
#include <vulkan/vulkan.h>
#include "mesh.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

constexpr uint32_t W = 480, H = 360;
constexpr VkFormat COLOUR = VK_FORMAT_R32G32B32A32_SFLOAT, DEPTH = VK_FORMAT_D32_SFLOAT;
constexpr RaraDepthMap REVERSED{0.05, INFINITY, VK_TRUE};  // 1 at 0.05, 0 at infinity
static VkPhysicalDevice physical;
static VkDevice device;
static int messages;

static void check(bool ok, const std::string &what) {
    if (!ok) { fprintf(stderr, "host: %s\n", what.c_str()); exit(1); }
}
#define VK(call) check((call) == VK_SUCCESS, #call " failed")
#define RARA(call) check((call) == RARA_OK, rara_last_error_message())

static VkBool32 VKAPI_PTR report(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *) {
    fprintf(stderr, "validation: %s\n", data->pMessage);
    messages++;
    return VK_FALSE;
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties offered;
    vkGetPhysicalDeviceMemoryProperties(physical, &offered);
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size};
    auto fits = [&](uint32_t i) { return needs.memoryTypeBits >> i & 1 && (offered.memoryTypes[i].propertyFlags & wanted) == wanted; };
    while (!fits(info.memoryTypeIndex)) check(++info.memoryTypeIndex < offered.memoryTypeCount, "no such memory");
    VkDeviceMemory memory;
    VK(vkAllocateMemory(device, &info, nullptr, &memory));
    return memory;
}

struct Image { VkImage image; VkDeviceMemory memory; VkImageView view; };
static Image make_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    Image made{};
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, nullptr, 0, VK_IMAGE_TYPE_2D, format, {W, H, 1}, 1, 1,
                           VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_TILING_OPTIMAL, usage};
    VK(vkCreateImage(device, &info, nullptr, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made.image, &needs);
    made.memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(device, made.image, made.memory, 0));
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, made.image, VK_IMAGE_VIEW_TYPE_2D, format, {}, {aspect, 0, 1, 0, 1}};
    VK(vkCreateImageView(device, &view, nullptr, &made.view));
    return made;
}
static void destroy(Image image) {
    vkDestroyImageView(device, image.view, nullptr);
    vkDestroyImage(device, image.image, nullptr);
    vkFreeMemory(device, image.memory, nullptr);
}
static void barrier(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, from, to,
                                 VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image, {aspect, 0, 1, 0, 1}};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 0, nullptr, 0, nullptr, 1, &change};
    vkCmdPipelineBarrier2(cmd, &info);
}

struct Push { float world_to_clip[16], centre_radius[4]; };  // of mesh.vert
static VkPipeline mesh_pipeline(VkPipelineLayout layout) {
    VkShaderModuleCreateInfo code[2]{{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, sizeof mesh_vert, mesh_vert},
                                     {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, sizeof mesh_frag, mesh_frag}};
    VkPipelineShaderStageCreateInfo stages[2]{};
    for (int i = 0; i < 2; i++) {
        VkShaderModule module;
        VK(vkCreateShaderModule(device, &code[i], nullptr, &module));
        stages[i] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, i ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT, module, "main"};
    }
    VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, nullptr, 0, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, nullptr, 0, 1, nullptr, 1};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, nullptr, 0, VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO, nullptr, 0, VK_TRUE, VK_TRUE, VK_COMPARE_OP_GREATER};
    VkPipelineColorBlendAttachmentState opaque{};
    opaque.colorWriteMask = 15;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, nullptr, 0, VK_FALSE, VK_LOGIC_OP_COPY, 1, &opaque};
    VkDynamicState dynamic[]{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo state{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0, 2, dynamic};
    VkPipelineRenderingCreateInfo target{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO, nullptr, 0, 1, &COLOUR, DEPTH};
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &target, 0, 2, stages, &vertices, &assembly,
                                      nullptr, &viewport, &raster, &samples, &depth, &blend, &state, layout};
    VkPipeline pipeline;
    VK(vkCreateGraphicsPipelines(device, nullptr, 1, &info, nullptr, &pipeline));
    for (auto &stage : stages) vkDestroyShaderModule(device, stage.module, nullptr);
    return pipeline;
}

int main(int count, char **arguments) {
    check(count >= 3, "usage: host SCENE.ply PICTURE.ppm [both|mesh|splats]");
    const std::string what = count > 3 ? arguments[3] : "both";
    const bool validation = getenv("RARA_VALIDATION") != nullptr;
    check(rara_abi_version() == RARA_ABI_VERSION, "rara.h and the library are of different versions");

    // The host's instance.
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "host", 0, nullptr, 0, VK_API_VERSION_1_3};
    const char *layer = "VK_LAYER_KHRONOS_validation", *debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkDebugUtilsMessengerCreateInfoEXT messenger_info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr, 0,
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT, report};
    VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &application, validation, &layer, validation, &debug_utils};
    VkInstance instance;
    VK(vkCreateInstance(&instance_info, nullptr, &instance));
    auto function = [&](const char *name) { return vkGetInstanceProcAddr(instance, name); };
    VkDebugUtilsMessengerEXT messenger{};
    if (validation) VK(((PFN_vkCreateDebugUtilsMessengerEXT)function("vkCreateDebugUtilsMessengerEXT"))(instance, &messenger_info, nullptr, &messenger));

    // Which device will do, asked before there is one, and what rara wants of it added to what the host enables.
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
        if (rara_check(vkGetInstanceProcAddr, instance, all[i], &support, sizeof support) == RARA_OK) physical = all[i];
        else why = rara_last_error_message();
    }
    check(physical, why);
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh_shader{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT};
    VkPhysicalDeviceVulkan13Features vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, support.mesh_shader ? &mesh_shader : nullptr};
    VkPhysicalDeviceVulkan12Features vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &vulkan13};
    RARA(rara_support_features(&support, &vulkan12, &vulkan13, &mesh_shader));
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, support.queue_family, 1, &priority};
    VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &vulkan12, 0, 1, &queue_info, 0, nullptr, support.extension_count, support.extensions};
    VK(vkCreateDevice(physical, &device_info, nullptr, &device));
    VkQueue queue;
    vkGetDeviceQueue(device, support.queue_family, 0, &queue);

    // The host's targets, mesh and command buffer.
    Image colour = make_image(COLOUR, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    Image depth = make_image(DEPTH, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    VkBufferCreateInfo buffer_info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, W * H * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer;
    VK(vkCreateBuffer(device, &buffer_info, nullptr, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    VkDeviceMemory memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, buffer, memory, 0));
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
    RaraDevice *lent;
    RARA(rara_device_adopt(&adopt, &lent));
    RaraGaussians *gaussians;
    RARA(rara_gaussians_load(arguments[1], &gaussians));
    RaraGaussiansInfo scene_info;
    RARA(rara_gaussians_info(gaussians, &scene_info, sizeof scene_info));
    RaraCamera camera;
    const double up[3]{0, -1, 0};
    RARA(rara_camera_frame(gaussians, up, 50, W, H, &camera));
    RaraSceneBuffers *scene;
    RARA(rara_scene_buffers_upload(lent, gaussians, RARA_SH_FORMAT_PACKED, &scene));
    rara_gaussians_destroy(gaussians);
    RaraDepthDesc tested;
    RARA(rara_depth_desc_default(&tested, sizeof tested, DEPTH, REVERSED));
    RaraRendererDesc desc;
    RARA(rara_renderer_desc_default(&desc, sizeof desc, COLOUR));
    desc.depth = &tested, desc.timing = VK_TRUE;
    desc.bindings = validation ? RARA_BINDINGS_BOUND : RARA_BINDINGS_ADDRESS;  // bound, the layer can watch
    RaraRenderer *renderer;
    RARA(rara_renderer_create(lent, &desc, &renderer));

    // The scene cut through its middle, and a mesh there.
    double centre[3], size = 0;
    Push push{};
    for (int i = 0; i < 3; i++) {
        centre[i] = (scene_info.bounds_min[i] + scene_info.bounds_max[i]) / 2;
        push.centre_radius[i] = float(centre[i]);
        size = std::max(size, scene_info.bounds_max[i] - scene_info.bounds_min[i]);
    }
    push.centre_radius[3] = float(0.4 * size);
    RaraPlane plane{{0.6, 0, 0.8}, -(0.6 * centre[0] + 0.8 * centre[2])};
    RaraClip clip{&plane, 1, RARA_CLIP_OP_AND};
    for (int column = 0; column < 4; column++) {
        double p[3]{};
        for (int row = 0; row < 3; row++)
            for (int i = 0; i < 3; i++) p[row] += camera.rotation[3 * row + i] * (column < 3 ? i == column : -camera.eye[i]);
        push.world_to_clip[4 * column] = float(2 * camera.fx / W * p[0] + (2 * camera.cx / W - 1) * p[2]);
        push.world_to_clip[4 * column + 1] = float(2 * camera.fy / H * p[1] + (2 * camera.cy / H - 1) * p[2]);
        push.world_to_clip[4 * column + 2] = column < 3 ? 0 : float(REVERSED.z_near);
        push.world_to_clip[4 * column + 3] = float(p[2]);
    }

    // A frame: stages before the host's rendering scope, then the mesh and the splats inside it.
    RARA(rara_renderer_configure(renderer, scene, &camera, &clip, nullptr));
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VK(vkBeginCommandBuffer(cmd, &begin));
    RARA(rara_renderer_prepare(renderer, cmd, scene));
    barrier(cmd, colour.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo onto{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, nullptr, colour.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    onto.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, onto.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingAttachmentInfo behind = onto;
    behind.imageView = depth.view, behind.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    behind.clearValue.depthStencil = {0, 0};
    onto.clearValue.color = {{0, 0, 0, 1}};
    VkRenderingInfo scope{VK_STRUCTURE_TYPE_RENDERING_INFO, nullptr, 0, {{0, 0}, {W, H}}, 1, 0, 1, &onto, &behind};
    vkCmdBeginRendering(cmd, &scope);
    VkViewport viewport{0, 0, W, H, 0, 1};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scope.renderArea);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
    if (what != "splats") vkCmdDraw(cmd, 24, 1, 0, 0);
    if (what != "mesh") RARA(rara_renderer_draw(renderer, cmd, 0, 0));
    vkCmdEndRendering(cmd);
    barrier(cmd, colour.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {W, H, 1}};
    vkCmdCopyImageToBuffer(cmd, colour.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    VkMemoryBarrier2 readable{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &readable};
    vkCmdPipelineBarrier2(cmd, &dependency);
    VK(vkEndCommandBuffer(cmd));
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &cmd};
    VK(vkQueueSubmit(queue, 1, &submit, nullptr));
    VK(vkQueueWaitIdle(queue));

    // The picture, and what the frame tells about itself.
    float *pixels;
    VK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, (void **)&pixels));
    std::vector<unsigned char> bytes;
    for (uint32_t i = 0; i < W * H * 4; i++)
        if (i % 4 < 3) bytes.push_back((unsigned char)std::lround(255 * std::clamp(pixels[i], 0.0f, 1.0f)));
    FILE *file = fopen(arguments[2], "wb");
    check(file && fprintf(file, "P6 %u %u 255\n", W, H) > 0 && fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && !fclose(file), "the picture cannot be written");
    RaraFrameStats stats;
    RARA(rara_renderer_stats(renderer, &stats, sizeof stats));
    printf("%u visible, %u cut, %u clipped away, %u culled, %.2f ms in %u stages\n", stats.visible, stats.cutoff, stats.invisible, stats.culled, stats.gpu_ms, stats.pass_count);

    // What is rara's goes first, what is the host's is the host's to destroy.
    rara_renderer_destroy(renderer);
    rara_scene_buffers_destroy(scene);
    check(rara_device_bytes(lent) == 0, "rara kept memory");
    rara_device_destroy(lent);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
    destroy(colour);
    destroy(depth);
    vkDestroyDevice(device, nullptr);
    if (messenger) ((PFN_vkDestroyDebugUtilsMessengerEXT)function("vkDestroyDebugUtilsMessengerEXT"))(instance, messenger, nullptr);
    vkDestroyInstance(instance, nullptr);
    return messages ? 1 : 0;
}
