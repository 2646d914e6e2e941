/* A host in C99 with a Vulkan device of its own and no window. It draws a square and splats of rara, which hide each other, and
   saves the picture and its depths as portable float maps.

     host SCENE.ply PICTURE.pfm DEPTHS.pfm

   RARA_DEVICE is part of the device's name. RARA_VALIDATION loads the Khronos layer; any message of it is exit status 1. */
#include "rara.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 480, HEIGHT = 360 };
static const VkFormat COLOUR = VK_FORMAT_R32G32B32A32_SFLOAT, DEPTH = VK_FORMAT_D32_SFLOAT;
static const VkRect2D PICTURE = {{0, 0}, {WIDTH, HEIGHT}}, SQUARE = {{180, 120}, {120, 120}};
static const VkDeviceSize DEPTHS_AT = (VkDeviceSize)WIDTH * HEIGHT * 4 * sizeof(float); /* behind the colours */

static VkPhysicalDevice physical;
static VkDevice device;
static int messages;

static void fail(const char *what) {
    fprintf(stderr, "host: %s\n", what);
    exit(1);
}
#define VK(call) do { if ((call) != VK_SUCCESS) fail(#call " failed"); } while (0)
#define RARA(call) do { if ((call) != RARA_OK) fail(rara_last_error_message()); } while (0)

static VKAPI_ATTR VkBool32 VKAPI_CALL report(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT type,
                                             const VkDebugUtilsMessengerCallbackDataEXT *data, void *user) {
    (void)severity, (void)type, (void)user;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    messages++;
    return VK_FALSE;
}

static VkInstance make_instance(int validation, VkDebugUtilsMessengerEXT *messenger) {
    const char *layer = "VK_LAYER_KHRONOS_validation", *debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application,
        .enabledLayerCount = validation ? 1 : 0, .ppEnabledLayerNames = &layer,
        .enabledExtensionCount = validation ? 1 : 0, .ppEnabledExtensionNames = &debug_utils,
    };
    VkInstance instance;
    VK(vkCreateInstance(&info, NULL, &instance));
    if (!validation) return instance;
    const VkDebugUtilsMessengerCreateInfoEXT wanted = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = report,
    };
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT");
    VK(create(instance, &wanted, NULL, messenger));
    return instance;
}

/* Finds a device that will do, before it is opened. */
static RaraSupport choose_device(VkInstance instance) {
    const char *name = getenv("RARA_DEVICE"), *why = "no Vulkan device of this name";
    VkPhysicalDevice all[16];
    uint32_t count = 16;
    const VkResult listed = vkEnumeratePhysicalDevices(instance, &count, all);
    if (listed != VK_SUCCESS && listed != VK_INCOMPLETE) fail("vkEnumeratePhysicalDevices failed");
    RaraSupport support;
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(all[i], &properties);
        if (name && !strstr(properties.deviceName, name)) continue;
        physical = all[i];
        if (rara_check(vkGetInstanceProcAddr, instance, physical, VK_API_VERSION_1_3, &support, sizeof support) == RARA_OK) return support;
        why = rara_last_error_message();
    }
    fail(why);
    return support;
}

/* Opens the device with what rara needs; a host adds extensions and features of its own. */
static void make_device(const RaraSupport *support) {
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh_shader = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT};
    VkPhysicalDeviceVulkan13Features vulkan13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, .pNext = support->mesh_shader ? &mesh_shader : NULL};
    VkPhysicalDeviceVulkan12Features vulkan12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &vulkan13};
    RARA(rara_support_features(support, &vulkan12));
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueFamilyIndex = support->queue_family, .queueCount = 1,
        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = &vulkan12, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue,
        .enabledExtensionCount = support->extension_count, .ppEnabledExtensionNames = support->extensions};
    VK(vkCreateDevice(physical, &info, NULL, &device));
}

/* Lends the device to rara. */
static RaraDevice *lend_device(VkInstance instance, VkQueue queue, const RaraSupport *support, int validation) {
    RaraAdoptDesc desc;
    RARA(rara_adopt_desc_default(&desc, sizeof desc));
    desc.get_instance_proc_addr = vkGetInstanceProcAddr;
    desc.instance = instance;
    desc.physical_device = physical;
    desc.device = device;
    desc.queue = queue;
    desc.queue_family = support->queue_family;
    desc.mesh_shader = support->mesh_shader;
    desc.push_descriptor = support->push_descriptor;
    desc.full_subgroups = support->full_subgroups;
    desc.debug_utils = validation;
    RaraDevice *lent;
    RARA(rara_device_adopt(&desc, &lent));
    return lent;
}

/* Loads a scene and puts it on the device. The camera sees all of it, the clip cuts it through its middle, which is returned too. */
static RaraSceneBuffers *load_scene(RaraDevice *lent, const char *path, RaraCamera *camera, RaraClip **clip, double centre[3]) {
    RaraGaussians *gaussians;
    RARA(rara_gaussians_load(path, NULL, 0, &gaussians));
    RaraGaussiansInfo info;
    RARA(rara_gaussians_info(gaussians, &info, sizeof info));
    for (int i = 0; i < 3; i++) centre[i] = (info.bounds_min[i] + info.bounds_max[i]) / 2;
    const double up[3] = {0, -1, 0};
    RARA(rara_camera_frame(gaussians, up, 50, WIDTH, HEIGHT, camera, sizeof *camera));
    const RaraPlane plane = {{-0.28, 0, 0.96}, -(-0.28 * centre[0] + 0.96 * centre[2])};
    RARA(rara_clip_of_planes(&plane, 1, RARA_CLIP_OP_AND, clip));
    RaraLayer layer;
    RARA(rara_layer_default(&layer, sizeof layer, "scene", gaussians));
    RaraSceneBuffers *scene;
    RARA(rara_scene_buffers_upload(lent, &layer, 1, RARA_SH_FORMAT_PACKED, &scene));
    rara_gaussians_destroy(gaussians);
    return scene;
}

/* Makes a renderer for the host's attachments. It reads the host's depths before the splats are drawn, so that tiles draw them,
   and writes the splats' own where a pixel is half covered. */
static RaraRenderer *make_renderer(RaraDevice *lent, RaraDepthMap map, int validation) {
    RaraDepthDesc depth;
    RARA(rara_depth_desc_default(&depth, sizeof depth, DEPTH, map));
    depth.readable = VK_TRUE;
    depth.write_alpha = 0.5f;
    RaraRendererDesc desc;
    RARA(rara_renderer_desc_default(&desc, sizeof desc, COLOUR));
    desc.depth = &depth;
    if (validation) desc.bindings = RARA_BINDINGS_BOUND; /* the layer can watch bound buffers */
    else RARA(rara_bindings_suiting(lent, &desc.bindings));
    RaraRenderer *renderer;
    RARA(rara_renderer_create(lent, &desc, &renderer));
    return renderer;
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties offered;
    vkGetPhysicalDeviceMemoryProperties(physical, &offered);
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size};
    while (!(needs.memoryTypeBits >> info.memoryTypeIndex & 1) ||
           (offered.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted)
        if (++info.memoryTypeIndex == offered.memoryTypeCount) fail("no such memory");
    VkDeviceMemory memory;
    VK(vkAllocateMemory(device, &info, NULL, &memory));
    return memory;
}

typedef struct { VkImage image; VkDeviceMemory memory; VkImageView view; VkImageAspectFlags aspect; } Image;
static Image make_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    Image made = {.aspect = aspect};
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D, .format = format,
        .extent = {WIDTH, HEIGHT, 1}, .mipLevels = 1, .arrayLayers = 1, .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VK(vkCreateImage(device, &info, NULL, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made.image, &needs);
    made.memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(device, made.image, made.memory, 0));
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, .image = made.image, .viewType = VK_IMAGE_VIEW_TYPE_2D, .format = format,
        .subresourceRange = {aspect, 0, 1, 0, 1}};
    VK(vkCreateImageView(device, &view, NULL, &made.view));
    return made;
}
static void destroy_image(Image image) {
    vkDestroyImageView(device, image.view, NULL);
    vkDestroyImage(device, image.image, NULL);
    vkFreeMemory(device, image.memory, NULL);
}

static VkBuffer make_buffer(VkDeviceMemory *memory) {
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = DEPTHS_AT + (VkDeviceSize)WIDTH * HEIGHT * sizeof(float),
        .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer;
    VK(vkCreateBuffer(device, &info, NULL, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    *memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, buffer, *memory, 0));
    return buffer;
}

/* Waits for all that was recorded before, and turns an image to another layout. An engine names the stages that it means. */
static void turn(VkCommandBuffer cmd, Image image, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier2 change = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, .oldLayout = from, .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED, .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image.image, .subresourceRange = {image.aspect, 0, 1, 0, 1}};
    const VkDependencyInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &change};
    vkCmdPipelineBarrier2(cmd, &info);
}

/* Begins a rendering scope on both images, which loads what they hold or clears it. */
static void begin_scope(VkCommandBuffer cmd, Image colour, Image depth, VkAttachmentLoadOp load) {
    const VkRenderingAttachmentInfo onto = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, .imageView = colour.view,
        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, .loadOp = load, .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .clearValue = {.color = {.float32 = {0.125f, 0.125f, 0.125f, 1}}}};
    const VkRenderingAttachmentInfo behind = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, .imageView = depth.view,
        .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, .loadOp = load, .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .clearValue = {.depthStencil = {0, 0}}}; /* infinitely far: depths are reversed */
    const VkRenderingInfo scope = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO, .renderArea = PICTURE, .layerCount = 1, .colorAttachmentCount = 1,
        .pColorAttachments = &onto, .pDepthAttachment = &behind};
    vkCmdBeginRendering(cmd, &scope);
}

/* Draws the host's own scene: a square that faces the camera. */
static void draw_square(VkCommandBuffer cmd, float depth) {
    const VkClearAttachment square[] = {
        {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {0.75f, 0.5f, 0.25f, 1}}}},
        {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {depth, 0}}}};
    const VkClearRect where = {SQUARE, 0, 1};
    vkCmdClearAttachments(cmd, 2, square, 1, &where);
}

/* Records a frame: the square in a scope of its own, rara's stages, which read its depths, and the splats in a second scope. */
static void record(VkCommandBuffer cmd, Image colour, Image depth, float square, RaraRenderer *renderer, const RaraSceneBuffers *scene,
                   RaraFrame *frame) {
    const VkImageLayout drawn = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, tested = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    const VkImageLayout copied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    turn(cmd, colour, VK_IMAGE_LAYOUT_UNDEFINED, drawn);
    turn(cmd, depth, VK_IMAGE_LAYOUT_UNDEFINED, tested);
    begin_scope(cmd, colour, depth, VK_ATTACHMENT_LOAD_OP_CLEAR);
    draw_square(cmd, square);
    vkCmdEndRendering(cmd);

    RaraDepthImage shown;
    RARA(rara_depth_image_default(&shown, sizeof shown, depth.image, WIDTH, HEIGHT));
    turn(cmd, depth, tested, copied);
    RARA(rara_renderer_prepare(renderer, cmd, scene, &shown, frame));
    turn(cmd, depth, copied, tested);
    turn(cmd, colour, drawn, drawn);
    begin_scope(cmd, colour, depth, VK_ATTACHMENT_LOAD_OP_LOAD);
    vkCmdSetScissor(cmd, 0, 1, &PICTURE);
    RARA(rara_renderer_draw(renderer, cmd, 0, 0, frame));
    vkCmdEndRendering(cmd);
    turn(cmd, colour, drawn, copied);
    turn(cmd, depth, tested, copied);
}

/* Copies an image to where the processor can read it. */
static void copy(VkCommandBuffer cmd, Image image, VkBuffer buffer, VkDeviceSize offset) {
    const VkBufferImageCopy region = {
        .bufferOffset = offset, .imageSubresource = {image.aspect, 0, 0, 1}, .imageExtent = {WIDTH, HEIGHT, 1}};
    vkCmdCopyImageToBuffer(cmd, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    const VkMemoryBarrier2 readable = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT, .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT, .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &readable};
    vkCmdPipelineBarrier2(cmd, &info);
}

static void submit_and_wait(VkQueue queue, VkCommandBuffer cmd) {
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &cmd};
    VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    VK(vkQueueWaitIdle(queue));
}

/* Saves `kept` of each pixel's `channels` numbers, 3 as colours or 1 as grey: a portable float map has its lowest row first. */
static void save(const char *path, const float *pixels, size_t channels, size_t kept) {
    FILE *file = fopen(path, "wb");
    if (!file) fail("a picture cannot be written");
    fprintf(file, "%s\n%d %d\n-1.0\n", kept == 3 ? "PF" : "Pf", WIDTH, HEIGHT);
    for (size_t y = HEIGHT; y-- > 0;)
        for (size_t x = 0; x < WIDTH; x++) fwrite(pixels + channels * (y * WIDTH + x), sizeof(float), kept, file);
    if (ferror(file) | fclose(file)) fail("a picture cannot be written");
}

int main(int count, char **arguments) {
    if (count != 4) fail("usage: host SCENE.ply PICTURE.pfm DEPTHS.pfm");
    if (rara_abi_version() != RARA_ABI_VERSION) fail("rara.h and the library are of different versions");
    const int validation = getenv("RARA_VALIDATION") != NULL;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkInstance instance = make_instance(validation, &messenger);
    const RaraSupport support = choose_device(instance);
    make_device(&support);
    VkQueue queue;
    vkGetDeviceQueue(device, support.queue_family, 0, &queue);

    RaraDevice *lent = lend_device(instance, queue, &support, validation);
    RaraCamera camera;
    RaraClip *clip;
    double centre[3];
    RaraSceneBuffers *scene = load_scene(lent, arguments[1], &camera, &clip, centre);
    RaraDepthMap map;
    RARA(rara_depth_map_perspective(0.05, INFINITY, VK_TRUE, &map));
    RaraRenderer *renderer = make_renderer(lent, map, validation);
    double z = 0; /* of the scene's middle, along the view axis */
    for (int i = 0; i < 3; i++) z += camera.rotation[6 + i] * (centre[i] - camera.eye[i]);

    Image colour = make_image(COLOUR, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    Image depth = make_image(DEPTH, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    VkDeviceMemory memory;
    VkBuffer buffer = make_buffer(&memory);
    const VkCommandPoolCreateInfo pool_info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, .queueFamilyIndex = support.queue_family};
    VkCommandPool pool;
    VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    const VkCommandBufferAllocateInfo cmd_info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = pool, .commandBufferCount = 1};
    VkCommandBuffer cmd;
    VK(vkAllocateCommandBuffers(device, &cmd_info, &cmd));

    RaraFrame *frame;
    RARA(rara_renderer_configure(renderer, scene, &camera, clip, NULL, &frame));
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(cmd, &begin));
    record(cmd, colour, depth, (float)(map.offset + map.scale / z), renderer, scene, frame);
    copy(cmd, colour, buffer, 0);
    copy(cmd, depth, buffer, DEPTHS_AT);
    VK(vkEndCommandBuffer(cmd));
    submit_and_wait(queue, cmd);
    void *mapped;
    VK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    save(arguments[2], mapped, 4, 3);
    save(arguments[3], (const float *)mapped + DEPTHS_AT / sizeof(float), 1, 1);

    /* Everything of rara's goes before the host's device. */
    rara_frame_destroy(frame);
    rara_clip_destroy(clip);
    rara_renderer_destroy(renderer);
    rara_scene_buffers_destroy(scene);
    rara_device_destroy(lent);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyBuffer(device, buffer, NULL);
    vkFreeMemory(device, memory, NULL);
    destroy_image(colour);
    destroy_image(depth);
    vkDestroyDevice(device, NULL);
    PFN_vkDestroyDebugUtilsMessengerEXT destroy =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT");
    if (messenger) destroy(instance, messenger, NULL);
    vkDestroyInstance(instance, NULL);
    return messages ? 1 : 0;
}
