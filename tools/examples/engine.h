// A small engine that knows nothing of splats, for host.cpp alone: images, a depth-tested mesh, pictures to files.
#pragma once
#include <vulkan/vulkan.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

constexpr uint32_t W = 480, H = 360;
constexpr VkFormat COLOUR = VK_FORMAT_R32G32B32A32_SFLOAT, DEPTH = VK_FORMAT_D32_SFLOAT;
static VkPhysicalDevice physical;
static VkDevice device;
static VkDebugUtilsMessengerEXT messenger;
static int messages;

static void check(bool ok, const std::string &what) {
    if (!ok) { fprintf(stderr, "host: %s\n", what.c_str()); exit(1); }
}
#define VK(call) check((call) == VK_SUCCESS, #call " failed")

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
    VkPipelineShaderStageCreateInfo stages[2]{};
    for (int i = 0; i < 2; i++) {
        auto file = std::filesystem::path(__FILE__).replace_filename(i ? "mesh.frag.spv" : "mesh.vert.spv");
        std::vector<uint32_t> code(std::filesystem::file_size(file) / 4);
        std::ifstream(file, std::ios::binary).read((char *)code.data(), code.size() * 4);
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, code.size() * 4, code.data()};
        VkShaderModule module;
        VK(vkCreateShaderModule(device, &info, nullptr, &module));
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

static VkInstance make_instance(bool validation) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "host", 0, nullptr, 0, VK_API_VERSION_1_3};
    const char *layer = "VK_LAYER_KHRONOS_validation", *debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &application, validation, &layer, validation, &debug_utils};
    VkInstance instance;
    VK(vkCreateInstance(&info, nullptr, &instance));
    if (!validation) return instance;
    VkDebugUtilsMessengerCreateInfoEXT wanted{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr, 0,
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT, report};
    auto create = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT");
    VK(create(instance, &wanted, nullptr, &messenger));
    return instance;
}
static void destroy(VkInstance instance) {
    auto destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT");
    if (messenger) destroy(instance, messenger, nullptr);
    vkDestroyInstance(instance, nullptr);
}

struct Readback { VkBuffer buffer; VkDeviceMemory memory; };
static Readback make_readback() {
    Readback made{};
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, W * H * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VK(vkCreateBuffer(device, &info, nullptr, &made.buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, made.buffer, &needs);
    made.memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, made.buffer, made.memory, 0));
    return made;
}
static void copy(VkCommandBuffer cmd, VkImage image, const Readback &to) {
    VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {W, H, 1}};
    vkCmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.buffer, 1, &region);
    VkMemoryBarrier2 readable{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &readable};
    vkCmdPipelineBarrier2(cmd, &info);
}
static void save(const char *path, const Readback &from) {
    float *pixels;
    VK(vkMapMemory(device, from.memory, 0, VK_WHOLE_SIZE, 0, (void **)&pixels));
    std::vector<unsigned char> bytes;
    for (uint32_t i = 0; i < W * H * 4; i++)
        if (i % 4 < 3) bytes.push_back((unsigned char)std::lround(255 * std::clamp(pixels[i], 0.0f, 1.0f)));
    FILE *file = fopen(path, "wb");
    check(file && fprintf(file, "P6 %u %u 255\n", W, H) > 0, "the picture cannot be written");
    check(fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && !fclose(file), "the picture cannot be written");
}
static void destroy(const Readback &readback) {
    vkDestroyBuffer(device, readback.buffer, nullptr);
    vkFreeMemory(device, readback.memory, nullptr);
}
