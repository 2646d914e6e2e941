/* rara for C and C++: splats in a Vulkan host's own frames.
 *
 * Made by cbindgen from src/c, whose test the_header_is_current writes it anew with RARA_WRITE_HEADER=1; not to be edited.
 *
 * Every function that can fail returns a RaraResult; rara_last_error_message says what is wrong. Nothing is thrown and
 * nothing panics across this boundary. Structs that begin with struct_size may grow in later versions: those that go in
 * are filled by their rara_..._default first, those that come out are asked for with their size. The others are parts of
 * structs, elements of arrays or given by value, and never grow. Handles come from a function that makes them and end with
 * their rara_..._destroy; "alive" is the time between. A handle that is not alive is refused with RARA_ERROR_INVALID, as is
 * one of another kind, and one that another thread's call changes at the same time.
 *
 * Pointers that go in are null where that is allowed, or point to what their types say, as many values as the count beside
 * them says. Strings end in NUL. What a call fills may be overwritten, and ..._size is its room in bytes. A function that
 * asks for more says so.
 */

#ifndef RARA_H
#define RARA_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

// The version of this header. It changes when a host must be compiled anew; structs that grow at their end and functions
// that are added do not change it.
#define RARA_ABI_VERSION 4

// Room for a camera's name, the NUL included.
#define RARA_MAX_CAMERA_NAME 256

// Room for the names of extensions in RaraSupport.
#define RARA_MAX_EXTENSIONS 8

// Room for a stage's name, the NUL at its end included.
#define RARA_NAME_SIZE 16

// Room for a reason, the NUL at its end included.
#define RARA_REASON_SIZE 96

// Room for the stages of a frame.
#define RARA_MAX_PASSES 32

// The region that stays visible, made of planes, slabs, boxes, spheres, ellipsoids, cylinders, capsules and cones. Where a
// function takes one, null means everything. It does not change; several threads, renderers and layers may use it at once.
typedef struct RaraClip RaraClip;

// A host's device as rara uses it. Several threads may use it at once.
typedef struct RaraDevice RaraDevice;

// A frame that rara_renderer_configure has made, rara_renderer_prepare records and rara_renderer_draw draws, whatever is
// configured after it. It keeps the memory that it is recorded with: destroy it after its last draw. One thread at a time
// uses it.
typedef struct RaraFrame RaraFrame;

// A scene in the host's memory. It may be destroyed once it is on the device. Several threads may read it at once.
typedef struct RaraGaussians RaraGaussians;

// Finds the Gaussians that pixels show most of. One thread at a time uses it.
typedef struct RaraPicker RaraPicker;

// Draws scenes into the host's rendering scopes. One thread at a time uses it.
//
// A frame is three calls: rara_renderer_configure allocates and compiles what is new, and makes the frame;
// rara_renderer_prepare records its compute stages, outside any rendering scope; rara_renderer_draw records its splats
// inside one. The host submits both in this order, to the queue that it lent.
//
// Frames in flight: before the host configures frame n it has waited for frame n - frames_in_flight, and before it
// destroys the renderer it has waited for all of its frames. Frames are prepared in the order in which they are configured,
// and each is drawn before the next is prepared; one that is configured while another waits to be prepared takes nothing
// over from it. Where the next frame is configured before this one's slot is free, frames_in_flight is one more than the
// host's slots.
//
// Synchronisation: none is needed between the two recorded calls, nor for the buffers of renderer and scene. The
// attachments are the host's to synchronise, as for any draw of its own.
//
// The calls bind pipelines, push constants and, with RARA_BINDINGS_BOUND, push descriptor set 0: the host binds its own
// again. rara_renderer_draw sets the viewport, so that the host's own may be any, of negative height too, and binding
// rara's pipelines undoes all other dynamic state but the scissor: the host sets all that its pipelines need again. The
// scissor is the host's, and is not touched. No image and no layout is.
typedef struct RaraRenderer RaraRenderer;

// A scene in device memory: one layer or several. Several threads and renderers may use it at once, but nobody else
// while rara_scene_buffers_set_layer_state runs.
typedef struct RaraSceneBuffers RaraSceneBuffers;

// The result of every function that can fail. After anything but RARA_OK rara_last_error_message says more.
typedef int32_t RaraResult;

// How much a line of the log matters.
typedef uint32_t RaraLogLevel;

// Takes a line of the log of rara and of the crates that it is built on: `text` is UTF-8, ends in NUL and is gone after
// the call.
//
// Any thread that is inside a function of rara's may call it, several at once. Locks may be held meanwhile, so it must
// call nothing of rara's and throw nothing.
typedef void (*RaraLog)(RaraLogLevel level, const char *text, void *user);

// How a camera sees.
typedef uint32_t RaraProjection;

// A camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers.
typedef struct RaraCamera {
    // Set by the functions that make a camera: the size that they were given, or less where this library knows less.
    size_t struct_size;
    // Picture width, pixels.
    uint32_t width;
    // Picture height, pixels.
    uint32_t height;
    // How it sees.
    RaraProjection projection;
    // Focal length along x, pixels; without perspective the pixels of a world unit.
    double fx;
    // Focal length along y, pixels; without perspective the pixels of a world unit.
    double fy;
    // Principal point, pixels from the picture's left edge; width / 2 is the middle.
    double cx;
    // Principal point, pixels from the picture's top edge; height / 2 is the middle.
    double cy;
    // The eye's position, world units.
    double eye[3];
    // World to camera rotation, row-major: the rows are the camera's right, down and forward axes in the world. A determinant
    // of -1 mirrors the picture's world, as rara_camera_of_projection does for a left-handed host.
    double rotation[9];
    // The depth along the view axis, world units, from which on the scene is kept: a plane across the axis that moves with
    // the camera and cuts every layer, whatever else cuts it, those with a clip of their own too. Splats are cut exactly, as
    // by any other plane; RARA_MODE_NONE does not ask. -INFINITY, which the functions that make a camera set, for no such
    // plane.
    double clip_near;
    // The depth up to which the scene is kept, likewise. INFINITY, which these functions set, for no such plane.
    double clip_far;
    // The depth along the view axis, world units, from which on splats are drawn: those whose centres are nearer are left out
    // whole. 0, which these functions set, stands for 0.2 units of the scene, as in 3DGS.
    double near_cut;
} RaraCamera;

// The name of a camera in its file. It never grows.
typedef struct RaraCameraName {
    // The picture's name in the file, or the camera's number there: UTF-8, cut off where it does not fit.
    char text[RARA_MAX_CAMERA_NAME];
} RaraCameraName;

// A half-space: the points x with normal . x + offset >= 0 are visible. The normal need not have length one, but must
// not be zero. It never grows.
typedef struct RaraPlane {
    // Points to the visible side.
    double normal[3];
    // World units times the normal's length.
    double offset;
} RaraPlane;

// How several planes combine.
typedef uint32_t RaraClipOp;

// The values in a depth buffer: at a depth z along the view axis, world units, it holds offset + scale / z in perspective,
// offset - scale z without. It never grows.
typedef struct RaraDepthMap {
    // See RaraDepthMap.
    double offset;
    // See RaraDepthMap. Nearer is more where it is above zero.
    double scale;
    // The projection of the cameras that it is for.
    RaraProjection projection;
} RaraDepthMap;

// The host's depth attachment. Splats behind what it holds are hidden, and splats write nothing into it. In all of its
// pixels a splat has one depth, that of its centre. The host draws opaque things first, then splats.
typedef struct RaraDepthDesc {
    // Set by rara_depth_desc_default.
    size_t struct_size;
    // Its format, with or without stencil.
    VkFormat format;
    // True when a dynamic rendering scope has the same image as stencil attachment too. Default: false.
    VkBool32 stencil;
    // True when the host gives each frame's depth to rara_renderer_prepare. Tiles need that; without it quads
    // replace them. Default: false.
    VkBool32 readable;
    // The buffer's value for a depth; rara_renderer_set_depth_map changes it from frame to frame.
    struct RaraDepthMap map;
} RaraDepthDesc;

// A host's depth image, of one sample and created with VK_IMAGE_USAGE_TRANSFER_SRC_BIT.
typedef struct RaraDepthImage {
    // Set by rara_depth_image_default.
    size_t struct_size;
    // The image, whose level 0 is read.
    VkImage image;
    // Its layout when the copy runs: TRANSFER_SRC_OPTIMAL, the default, or GENERAL.
    VkImageLayout layout;
    // Its width, pixels.
    uint32_t width;
    // Its height, pixels.
    uint32_t height;
    // The array layer that is read. Default: 0.
    uint32_t layer;
    // The viewport's left edge in the image, pixels. Default: 0.
    int32_t x;
    // The viewport's top edge in the image, pixels. Default: 0.
    int32_t y;
} RaraDepthImage;

// The features of a suitable physical device beyond the requirements. Required are Vulkan 1.3, or 1.2 with
// VK_KHR_synchronization2 and VK_KHR_dynamic_rendering, the features bufferDeviceAddress, synchronization2 and
// dynamicRendering, and a queue family with graphics and compute.
typedef struct RaraSupport {
    // Set by rara_check.
    size_t struct_size;
    // The first queue family with graphics and compute. Any other with both will do too.
    uint32_t queue_family;
    // VK_EXT_mesh_shader with meshShader and taskShader. Optional: splats can be drawn without them.
    VkBool32 mesh_shader;
    // VK_KHR_push_descriptor. Optional: RARA_BINDINGS_BOUND needs it.
    VkBool32 push_descriptor;
    // VK_KHR_portability_subset. A host must enable it where the device has it.
    VkBool32 portability_subset;
    // Nanoseconds of one tick of a timestamp; 0 where the queue family has no timestamps, and frames then have no times.
    float timestamp_period;
    // Number of extensions.
    uint32_t extension_count;
    // The extensions named above that the device has, and those that Vulkan 1.2 needs, to be added to
    // ppEnabledExtensionNames. The strings live as long as the library.
    const char *extensions[RARA_MAX_EXTENSIONS];
    // Bytes of the largest buffer, which limits a scene's spherical harmonics.
    uint64_t max_buffer_size;
    // Most pixels along a side of an image.
    uint32_t max_image_size;
    // The Vulkan version that rara uses: VK_API_VERSION_1_2 or VK_API_VERSION_1_3.
    uint32_t api_version;
    // subgroupSizeControl and computeFullSubgroups, of Vulkan 1.3 or VK_EXT_subgroup_size_control. Optional: on GPUs the
    // sort is faster with them.
    VkBool32 full_subgroups;
} RaraSupport;

// For what kind of machine kernels are chosen.
typedef uint32_t RaraShape;

// Takes the news that rara uses nothing of the host's any more.
typedef void (*RaraRelease)(void *user);

// Who reaches device memory.
typedef uint32_t RaraMemoryUse;

// What RaraAllocate is asked for.
typedef struct RaraMemoryRequest {
    // Its size in the library, which may be larger than in the host's header.
    size_t struct_size;
    // What it is for, for debuggers: UTF-8, ends in NUL, and is gone after the call.
    const char *name;
    // Bytes.
    uint64_t size;
    // The offset is a multiple of this.
    uint64_t alignment;
    // A bit for each memory type that will do, as in VkMemoryRequirements.
    uint32_t memory_type_bits;
    // Who reaches it.
    RaraMemoryUse memory_use;
} RaraMemoryRequest;

// A part of device memory that a host lends.
typedef struct RaraMemory {
    // Its size in the library, which may be larger than in the host's header; the host leaves it as it is.
    size_t struct_size;
    // The memory, allocated with VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT.
    VkDeviceMemory memory;
    // Where the part begins in it, bytes.
    uint64_t offset;
    // The part as the processor sees it; null for RARA_MEMORY_USE_DEVICE.
    void *mapped;
    // Whatever the host knows it by, such as a VmaAllocation.
    void *user;
} RaraMemory;

// Lends memory, with `allocator_user` of RaraAdoptDesc: fills `*memory`, which is all zero before but for its size, and
// returns VK_SUCCESS, or returns why there is none; the call that needs it then fails with RARA_ERROR_MEMORY. It must throw
// nothing.
typedef VkResult (*RaraAllocate)(void *user, const struct RaraMemoryRequest *request, struct RaraMemory *memory);

// Takes back what RaraAllocate has lent, as it was lent. The device is done with it. It must throw nothing.
typedef void (*RaraFree)(void *user, const struct RaraMemory *memory);

// A host's own Vulkan, for rara_device_adopt. All of it stays the host's.
typedef struct RaraAdoptDesc {
    // Set by rara_adopt_desc_default.
    size_t struct_size;
    // The loader's vkGetInstanceProcAddr.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    // Created for `api_version` below.
    VkInstance instance;
    // The physical device that the device below was made from.
    VkPhysicalDevice physical_device;
    // Created with what rara_support_features sets.
    VkDevice device;
    // A queue with graphics and compute; everything that rara records goes to it.
    VkQueue queue;
    // The queue's family.
    uint32_t queue_family;
    // True when VK_EXT_mesh_shader, meshShader and taskShader were enabled. Default: false.
    VkBool32 mesh_shader;
    // True when VK_KHR_push_descriptor was enabled. Default: false.
    VkBool32 push_descriptor;
    // True when VK_EXT_debug_utils was enabled on the instance: rara then names its objects and labels its stages.
    // Default: false.
    VkBool32 debug_utils;
    // The cache in which compiled pipelines are looked up and kept. Default: null, and none are kept.
    VkPipelineCache pipeline_cache;
    // VkApplicationInfo::apiVersion of the instance, 1.2 or later. Default: VK_API_VERSION_1_3.
    uint32_t api_version;
    // True when subgroupSizeControl and computeFullSubgroups were enabled, for which the host's chain needs
    // VkPhysicalDeviceVulkan13Features or VkPhysicalDeviceSubgroupSizeControlFeatures. Default: false.
    VkBool32 full_subgroups;
    // For what kind of machine kernels are chosen. Pictures depend on it only by the rounding of sums. Default:
    // RARA_SHAPE_AUTO.
    RaraShape shape;
    // With RARA_SHAPE_GPU the invocations of a subgroup that kernels ask for, a power of two that the device can be asked
    // for; 0, the default, for kernels without subgroup operations. Otherwise ignored.
    uint32_t subgroup;
    // Called once, when rara uses nothing of the host's any more, with `release_user`: by the call that ends the last of the
    // RaraDevice and of what was made from it. Until then the host keeps its device. It may be on any thread, must throw
    // nothing, and may destroy the device. It is not called after rara_device_adopt has failed. Null, the default, for none.
    RaraRelease release;
    // What `release` is given. Default: null.
    void *release_user;
    // Lends all device memory that rara uses, such as vmaAllocateMemory does. Any thread calls it that makes or destroys
    // something of rara's, several at once; rara_renderer_prepare and rara_renderer_draw never do. Null, the default, for
    // an allocator of rara's own.
    RaraAllocate allocate;
    // Takes back what `allocate` has lent; null where that is.
    RaraFree free;
    // What `allocate` and `free` are given. Default: null.
    void *allocator_user;
} RaraAdoptDesc;

// The placement of a scene in a world: its points are scaled, then turned, then moved. {{0, 0, 0}, {0, 0, 0, 1}, 1}
// leaves it where it was made. It never grows.
typedef struct RaraPlacement {
    // The position of the scene's origin, world units.
    double position[3];
    // How it is turned: a quaternion x, y, z, w, of any length but zero.
    double rotation[4];
    // How many world units one unit of the scene is, above zero.
    double scale;
} RaraPlacement;

// How shaders reach buffers.
typedef uint32_t RaraBindings;

// What the numbers of the colour attachment stand for.
typedef uint32_t RaraColorSpace;

// The description of a renderer to be created.
typedef struct RaraRendererDesc {
    // Set by rara_renderer_desc_default.
    size_t struct_size;
    // Format of the colour attachment. Splats are blended as stored, premultiplied, so sRGB formats give another picture.
    VkFormat color_format;
    // Samples a pixel of the attachments. Default: 1.
    VkSampleCountFlagBits samples;
    // The depth attachment that splats are tested against; null, the default, if the scope has none. Only the call
    // itself reads it.
    const struct RaraDepthDesc *depth;
    // A classic render pass, or one compatible with it, that lives until the last rara_renderer_configure; null, the
    // default, stands for dynamic rendering.
    VkRenderPass render_pass;
    // The subpass of render_pass to draw in.
    uint32_t subpass;
    // How shaders reach buffers.
    RaraBindings bindings;
    // True to take timestamps, for the times in RaraFrameStats. Default: false.
    VkBool32 timing;
    // True to let a frame take over what the one before has computed and it would compute again. The host must then
    // submit every frame that it prepares, in order, or call rara_renderer_forget. Default: false.
    VkBool32 reuse;
    // How many recorded frames may be unfinished at once, 1 or more. Default: 1.
    uint32_t frames_in_flight;
    // Format of the target of rara_renderer_draw_depth, two channels or more; VK_FORMAT_UNDEFINED, the default, if that
    // function is not called.
    VkFormat expected_depth_format;
    // Like render_pass, for that target.
    VkRenderPass expected_depth_render_pass;
    // The subpass of expected_depth_render_pass to draw in.
    uint32_t expected_depth_subpass;
    // What the numbers of the colour attachment stand for.
    RaraColorSpace color_space;
} RaraRendererDesc;

// How the 16 numbers of a matrix lie in memory.
typedef uint32_t RaraMatrixOrder;

// What a host's matrices do not say of themselves and of its clip space, after the division by w: its normalised device
// coordinates.
typedef struct RaraNdc {
    // Set by rara_ndc_default.
    size_t struct_size;
    // How both matrices lie in memory.
    RaraMatrixOrder order;
    // True when a y of 1 is the picture's upper edge, as in Direct3D, Metal, WebGPU and OpenGL, and in Vulkan with a viewport
    // of negative height. Default: false.
    VkBool32 y_up;
    // True when depths go from -1 to 1, as in OpenGL and by VK_EXT_depth_clip_control; the buffer then holds (z + 1) / 2.
    // Default: false, from 0 to 1.
    VkBool32 negative_one_to_one;
    // True when nearer is more in the depth buffer. It is asked of orthographic projections alone, whose matrix is the same
    // for one that looks the other way; that of a perspective one says it. Default: false.
    VkBool32 reversed;
} RaraNdc;

// How spherical harmonics lie in device memory; the sizes are of one Gaussian of degree 3.
typedef uint32_t RaraShFormat;

// How a clip treats the Gaussians that it cuts.
typedef uint32_t RaraMode;

// The quantity that the weight w of a cut splat scales.
typedef uint32_t RaraDecay;

// RARA_MODE_RARA only: what a cut splat keeps in a pixel whose ray misses the traced ellipsoid.
typedef uint32_t RaraMiss;

// RARA_MODE_EXACT only: the form of the weight.
typedef uint32_t RaraExactForm;

// How splats become pixels. All give the same picture.
typedef uint32_t RaraRaster;

// The quantity that a frame shows of its splats.
typedef uint32_t RaraShow;

// RARA_MODE_EXACT only: how the normal distribution's Phi is approximated, and the largest error.
typedef uint32_t RaraPhiForm;

// The options of a frame, apart from scene, camera and clip.
typedef struct RaraSettings {
    // Set by rara_settings_default.
    size_t struct_size;
    // How cut Gaussians are treated.
    RaraMode mode;
    // The quantity that the weight scales.
    RaraDecay decay;
    // RARA_MODE_RARA: the traced ellipsoid, in standard deviations. Default: 3.
    float sigma;
    // RARA_MODE_RARA: what a missed pixel keeps.
    RaraMiss miss;
    // Ablation: treat every Gaussian as cut. Default: false.
    VkBool32 trace_all;
    // RARA_MODE_EXACT: the form of the weight.
    RaraExactForm form;
    // Highest spherical-harmonics degree to evaluate; -1 is the scene's own, and the default.
    int32_t sh_degree;
    // How splats become pixels.
    RaraRaster raster;
    // Colours, or a debug view.
    RaraShow show;
    // RARA_MODE_EXACT: how Phi is approximated. The preset sets this and all fields below.
    RaraPhiForm phi;
    // How many bits of the depths the sort compares at most, 8 to 32.
    uint32_t key_bits;
    // RARA_MODE_EXACT: a cut splat is perspective-exact where its largest deviation over its depth exceeds this. Zero
    // makes all of them exact.
    float beam_switch;
    // Tiles only: a pixel with less transmittance than this is saturated. Zero blends everything.
    float transmittance_min;
} RaraSettings;

// The most that frames will ask for, for rara_renderer_reserve.
typedef struct RaraFrameLimits {
    // Set by rara_frame_limits_default.
    size_t struct_size;
    // Width of the pictures, pixels.
    uint32_t width;
    // Height of the pictures, pixels, which may be another picture's than the width.
    uint32_t height;
    // Gaussians of a scene, all of its layers together.
    uint32_t gaussians;
    // Layers of a scene. Default: 1.
    uint32_t layers;
    // How the scenes' spherical harmonics are stored. Default: RARA_SH_FORMAT_PACKED.
    RaraShFormat sh_format;
    // Planes of a RaraClip that is a list of planes; RaraCamera::clip_near and clip_far add one each. Default: 6.
    uint32_t planes;
    // Surfaces of a RaraClip that bends or combines. Default: 0, for none.
    uint32_t surfaces;
    // Pairs of tile and splat, for which there is then exactly this room: a frame with more is drawn as quads, the same
    // picture but slower, and RaraFrameStats::fell_back says so. rara_scene_buffers_estimated_pairs tells a camera's.
    // Default: 0, for the usual room, 2 a Gaussian and 64 a tile of 8x8 pixels, which grows and allocates where a frame needs
    // more.
    uint32_t pairs;
    // The settings that frames have, each with every kind of clip: modes, rasters, what is shown and with which laws. Only
    // the call itself reads them. Default: null, for the default ones in all four modes.
    const struct RaraSettings *settings;
    // How many settings there are.
    size_t settings_count;
} RaraFrameLimits;

// Device memory and pipelines of a device.
typedef struct RaraDeviceMemory {
    // Set by rara_device_memory.
    size_t struct_size;
    // Bytes that scenes and renderers take.
    uint64_t bytes;
    // The most that `bytes` has ever been.
    uint64_t peak_bytes;
    // The most that `bytes` may become, as rara_device_set_memory_budget has set it; 0 for no limit.
    uint64_t budget;
    // Allocations so far, freed or not.
    uint64_t allocation_count;
    // Pipelines compiled so far, destroyed or not.
    uint64_t pipeline_count;
} RaraDeviceMemory;

// A request that a picker has recorded. It never grows.
typedef struct RaraPickTicket {
    // The picker's number.
    uint64_t picker;
    // The request's.
    uint64_t request;
} RaraPickTicket;

// The splat that adds most to a pixel's alpha. It never grows.
typedef struct RaraPick {
    // Its Gaussian's number in the scene: that in its layer, behind all Gaussians of the layers before it. Layers that
    // rara_gaussians_select has divided number as the set did where all of them are in the scene, else without those that are
    // missing.
    uint32_t number;
    // The number of its layer.
    uint32_t layer;
    // What it adds to the alpha of the pixel, from 1/255 to 1; 0 where no splat adds as much, and then all is 0.
    float alpha;
} RaraPick;

// Describes a scene, and what of its file could not be used.
typedef struct RaraGaussiansInfo {
    // Set by rara_gaussians_info.
    size_t struct_size;
    // Gaussians in the scene.
    uint64_t count;
    // Elements of the file that were left out: numbers that are not finite.
    uint64_t dropped;
    // Elements that were kept with a value put right.
    uint64_t repaired;
    // Degree of its spherical harmonics, 0 to 3.
    uint32_t sh_degree;
    // The corner of the scene's box with the smallest coordinates. The box holds all but the outermost percent of the
    // centres at each end of each axis.
    double bounds_min[3];
    // The corner with the largest coordinates.
    double bounds_max[3];
    // Whether they are drawn antialiased: see rara_gaussians_set_antialiased.
    VkBool32 antialiased;
} RaraGaussiansInfo;

// A part of the host's memory that the device can copy from.
typedef struct RaraStaging {
    // Set by rara_staging_default.
    size_t struct_size;
    // A buffer created with VK_BUFFER_USAGE_TRANSFER_SRC_BIT.
    VkBuffer buffer;
    // The offset of the part in the buffer, bytes. Default: 0.
    uint64_t offset;
    // The part, mapped for writing: it is never read.
    void *mapped;
    // Its length in bytes; it may be longer than what is needed.
    size_t size;
} RaraStaging;

// A host's Gaussians, as it has them in memory: each attribute an array, or a field of its own structs. A stride is the
// bytes from one Gaussian's numbers to the next one's; 0, the default, stands for numbers without a gap. Nothing has to be
// aligned, and only the call itself reads it.
typedef struct RaraGaussianArrays {
    // Set by rara_gaussian_arrays_default.
    size_t struct_size;
    // How many Gaussians there are. Where there are none the pointers may be null.
    size_t count;
    // Centres, world units: 3 floats a Gaussian.
    const float *positions;
    // Bytes from one centre to the next; 0 stands for 12.
    size_t position_stride;
    // Standard deviations along the Gaussian's own axes, world units, not logarithms: 3 floats a Gaussian, zero or above.
    const float *scales;
    // Bytes from one Gaussian's to the next one's; 0 stands for 12.
    size_t scale_stride;
    // Unit quaternions x, y, z, w that turn the Gaussian's own axes to the world's: 4 floats a Gaussian. Files of 3DGS have w
    // first.
    const float *rotations;
    // Bytes from one quaternion to the next; 0 stands for 16.
    size_t rotation_stride;
    // Opacities at the centre, 0 to 1, not logits: a float a Gaussian.
    const float *opacities;
    // Bytes from one opacity to the next; 0 stands for 4.
    size_t opacity_stride;
    // Degree of the spherical harmonics, 0 to 3. Default: 0.
    uint32_t sh_degree;
    // Spherical harmonics: (sh_degree + 1)^2 coefficients a Gaussian, each red, green and blue, the constant one first.
    const float *sh;
    // Bytes from one Gaussian's to the next one's; 0 stands for 12 (sh_degree + 1)^2.
    size_t sh_stride;
    // Whether they were trained antialiased: see rara_gaussians_set_antialiased. Default: false.
    VkBool32 antialiased;
} RaraGaussianArrays;

// The state of a layer, which may change from frame to frame.
typedef struct RaraLayerState {
    // Set by rara_layer_state_default and rara_scene_buffers_layer_state.
    size_t struct_size;
    // The layer's placement in its scene, which rara_renderer_set_placement places as a whole. Default: where it was
    // made.
    struct RaraPlacement placement;
    // The factor of its Gaussians' opacities, 0 to 1. Default: 1.
    float opacity;
    // True when it is drawn. A hidden layer costs next to nothing. Default: true.
    VkBool32 visible;
} RaraLayerState;

// A layer of a scene that is to be uploaded. Only the call itself reads it: the name is copied, and the Gaussians may be
// destroyed when the call returns.
typedef struct RaraLayer {
    // Set by rara_layer_default.
    size_t struct_size;
    // Its name: UTF-8, ends in NUL. Several layers may have the same.
    const char *name;
    // Its Gaussians. Several layers may have the same.
    const struct RaraGaussians *gaussians;
    // The state in which it is uploaded; null, the default, stands for that of rara_layer_state_default.
    const struct RaraLayerState *state;
    // Its own clip, as rara_scene_buffers_set_layer_clip sets it; null, the default, for the frame's clip.
    const struct RaraClip *clip;
} RaraLayer;

// A layer of a scene in device memory.
typedef struct RaraLayerInfo {
    // Set by rara_scene_buffers_layer_info.
    size_t struct_size;
    // Its name: UTF-8, ends in NUL, lives as long as the RaraSceneBuffers. A scene of rara_scene_buffers_upload or
    // rara_scene_buffers_upload_with has one layer, named "scene".
    const char *name;
    // Gaussians in the layer.
    uint64_t count;
} RaraLayerInfo;

// A choice of all settings that give up exactness for time: phi, key_bits, beam_switch and transmittance_min.
typedef uint32_t RaraPreset;

// How a clip is baked.
typedef struct RaraBakeSettings {
    // Set by rara_bake_settings_default.
    size_t struct_size;
    // Which Gaussians are cut: those that a frame of this mode cuts. RARA_MODE_HARD cuts none, so that Gaussians stay or go by
    // their centres, and RARA_MODE_NONE keeps all. Default: RARA_MODE_EXACT.
    RaraMode mode;
    // RARA_MODE_RARA: the traced ellipsoid, in standard deviations. Default: 3.
    float sigma;
    // How many Gaussians stand for a cut one, 1 to 3. Default: 1.
    uint32_t children;
    // A cut Gaussian stays whole where the clip keeps all within this many standard deviations of its centre. Default: 1, at
    // which baking twice is baking once.
    float leave;
} RaraBakeSettings;

// What baking has done. The first three are the classes that a frame counts, whatever a camera sees.
typedef struct RaraBakeCounts {
    // Set by rara_gaussians_bake.
    size_t struct_size;
    // Gaussians that the clip leaves whole; they are kept.
    uint64_t visible;
    // Gaussians that it cuts; they are replaced, except the next two.
    uint64_t cutoff;
    // Gaussians that lie outside; they are dropped.
    uint64_t invisible;
    // Of those that are cut: kept as they are, since the cut passes far enough outside (RaraBakeSettings::leave).
    uint64_t left;
    // Of those that are cut: dropped, since nothing is left that could be seen.
    uint64_t faint;
    // Gaussians that stand for cut ones.
    uint64_t children;
} RaraBakeCounts;

// Quantities that a pixel can have beside its colour (arbitrary output variables), one bit each. Means are over the pixel's
// splats, by what each adds to alpha.
typedef uint32_t RaraAovs;

// Room for channels of numbers, which rara_renderer_channels fills.
typedef struct RaraChannels {
    // Set by rara_channels_default.
    size_t struct_size;
    // Which quantities: one bit or more.
    RaraAovs aovs;
    // The camera's picture width, pixels.
    uint32_t width;
    // The camera's picture height, pixels.
    uint32_t height;
    // Where the numbers go: one channel after the other, in the order of the bits, and each row by row from the top left.
    float *values;
    // How many numbers there is room for, which is how many there are: width times height for each channel, of which
    // RARA_AOV_NORMAL has three and the others one. Set by rara_channels_default.
    size_t value_count;
} RaraChannels;

// GPU time of one stage. It never grows.
typedef struct RaraPassTime {
    // The stage: the same name as its shader and its debug label.
    char name[RARA_NAME_SIZE];
    // Milliseconds between its timestamps.
    double ms;
} RaraPassTime;

// The statistics of a frame. Counts and times are of the oldest frame in flight, which is the last one where there is
// only one.
typedef struct RaraFrameStats {
    // Set by rara_renderer_stats.
    size_t struct_size;
    // Gaussians in view and untouched by the clip.
    uint32_t visible;
    // Gaussians in view and cut by the clip.
    uint32_t cutoff;
    // Gaussians in view but wholly clipped away.
    uint32_t invisible;
    // Gaussians outside the view or too faint, whatever the clip says.
    uint32_t culled;
    // Splats handed to the rasteriser.
    uint32_t drawn;
    // How splats became pixels; RARA_RASTER_AUTO before the first frame.
    RaraRaster raster;
    // Why splats became pixels in that way.
    char raster_reason[RARA_REASON_SIZE];
    // True when tiles had no room for their lists, so that the frame was drawn as quads, which is slower and gives the
    // same picture; of RARA_SHOW_COUNT and RARA_SHOW_MEAN nothing was drawn. The next rara_renderer_configure makes the room.
    VkBool32 fell_back;
    // Number of passes; 0 without RaraRendererDesc's timing.
    uint32_t pass_count;
    // GPU time of each stage, in order.
    struct RaraPassTime passes[RARA_MAX_PASSES];
    // GPU time of the frame, milliseconds; NAN where pass_count is 0.
    double gpu_ms;
    // Number of skipped stages.
    uint32_t skipped_count;
    // The stages that the frame did not need.
    char skipped[RARA_MAX_PASSES][RARA_NAME_SIZE];
} RaraFrameStats;

// Done.
#define RARA_OK 0

// An argument is not possible: a null pointer, a plane without a normal, a picture of no size. The message names it.
#define RARA_ERROR_INVALID 1

// A file could not be opened or read.
#define RARA_ERROR_IO 2

// A file was read, and what stands in it is not usable.
#define RARA_ERROR_FORMAT 3

// The device lacks something.
#define RARA_ERROR_DEVICE 4

// There is not enough memory, on the device, on the host, or in the budget of rara_device_set_memory_budget.
#define RARA_ERROR_MEMORY 5

// A Vulkan call failed for another reason.
#define RARA_ERROR_VULKAN 6

// A panic was stopped: rara has a bug, and the message says which. With the handles that the call was given, only the
// destroy functions are sure to work.
#define RARA_ERROR_PANIC 7

// VK_ERROR_DEVICE_LOST. Nothing on the device can be used any more: the host destroys what was made from the RaraDevice,
// then the RaraDevice, then its own device, and goes on with another one.
#define RARA_ERROR_DEVICE_LOST 8

// Something is wrong that no function could return.
#define RARA_LOG_LEVEL_ERROR 1

// Something may be wrong.
#define RARA_LOG_LEVEL_WARN 2

// Messages that a user may want to read.
#define RARA_LOG_LEVEL_INFO 3

// Messages that a developer may want to read.
#define RARA_LOG_LEVEL_DEBUG 4

// Every step.
#define RARA_LOG_LEVEL_TRACE 5

// In perspective.
#define RARA_PROJECTION_PERSPECTIVE 0

// Lines of sight run along the view axis.
#define RARA_PROJECTION_ORTHOGRAPHIC 1

// Visible where every plane keeps it.
#define RARA_CLIP_OP_AND 0

// Visible where any plane keeps it.
#define RARA_CLIP_OP_OR 1

// The one that the device says it is. The default.
#define RARA_SHAPE_AUTO 0

// A driver that runs shaders on the processor's cores.
#define RARA_SHAPE_CPU 1

// A graphics processor.
#define RARA_SHAPE_GPU 2

// The device alone.
#define RARA_MEMORY_USE_DEVICE 0

// Mapped and host-coherent, for the processor to write.
#define RARA_MEMORY_USE_UPLOAD 1

// Mapped and host-coherent, for the processor to read.
#define RARA_MEMORY_USE_READBACK 2

// By address, which is fast. The default.
#define RARA_BINDINGS_ADDRESS 0

// Bound, so that the validation layer can watch them. Needs VK_KHR_push_descriptor; without it buffers are reached by
// address.
#define RARA_BINDINGS_BOUND 1

// The constants of the frame bound and all else by address, for CPU drivers: they compile it in a fraction of the time that bound
// buffers take, and run it faster than addresses alone. Needs what RARA_BINDINGS_BOUND needs.
#define RARA_BINDINGS_MIXED 2

// Colours as a display stores them, as splats are trained and blended: they meet the host's pixels as they are. The default.
#define RARA_COLOR_SPACE_STORED 0

// Linear light, as of a host that lights in HDR: splats are blended as stored, and the picture that they make is turned into
// linear light once before it is blended over the host's pixels. Only tiles do so: another raster is refused, and so is a
// depth that is not readable. A frame whose tiles have no room draws nothing, as RaraFrameStats::fell_back says.
#define RARA_COLOR_SPACE_LINEAR 1

// A view's translation is in numbers 12, 13 and 14: columns one after the other, of matrices that stand before column
// vectors (glm, Eigen), or rows, of matrices that stand behind row vectors (DirectXMath). The default.
#define RARA_MATRIX_ORDER_TRANSLATION_LAST 0

// A view's translation is in numbers 3, 7 and 11: rows one after the other, of matrices that stand before column vectors.
#define RARA_MATRIX_ORDER_TRANSLATION_BESIDE 1

// 8 bits a coefficient: 56 bytes.
#define RARA_SH_FORMAT_BYTE 0

// 10 to 11 bits a coefficient: 68 bytes. The preset balanced uses it.
#define RARA_SH_FORMAT_PACKED 1

// 16-bit floats: 96 bytes.
#define RARA_SH_FORMAT_HALF 2

// 32-bit floats: 192 bytes.
#define RARA_SH_FORMAT_FLOAT 3

// No clipping.
#define RARA_MODE_NONE 0

// Keep or drop by the centre.
#define RARA_MODE_HARD 1

// The paper's length ratio along each pixel's ray.
#define RARA_MODE_RARA 2

// The exact visible share of the splat, the low-pass of 3DGS included. The default.
#define RARA_MODE_EXACT 3

// The mode's own: linear for RARA_MODE_RARA, depth for RARA_MODE_EXACT. The default.
#define RARA_DECAY_AUTO 0

// Alpha: alpha' = alpha w (the paper).
#define RARA_DECAY_LINEAR 1

// Optical depth: alpha' = 1 - (1 - alpha)^w. Complementary halves rebuild the whole.
#define RARA_DECAY_DEPTH 2

// Everything (the paper's text).
#define RARA_MISS_KEEP 0

// Nothing (the paper's released code).
#define RARA_MISS_DROP 1

// All or nothing, by the side on which the ray's densest point lies. The default.
#define RARA_MISS_PEAK 2

// Affine in the pixel for small splats, perspective-exact for large ones (beam_switch). The default.
#define RARA_EXACT_FORM_AUTO 0

// Perspective-exact for every cut splat.
#define RARA_EXACT_FORM_BEAM 1

// Affine for every cut splat.
#define RARA_EXACT_FORM_AFFINE 2

// The faster way on the device at hand. The default.
#define RARA_RASTER_AUTO 0

// VK_EXT_mesh_shader.
#define RARA_RASTER_MESH 1

// Instanced quads.
#define RARA_RASTER_QUAD 2

// Tiles of pixels in a compute shader.
#define RARA_RASTER_TILES 3

// Their colours. The default.
#define RARA_SHOW_COLOUR 0

// The effect of the clip on them: a splat that it leaves whole is blue; one that it cuts goes from red, where the
// pixel keeps nothing, to yellow, where it keeps all.
#define RARA_SHOW_WEIGHT 1

// The number of splats that make the pixel: red, green and blue each. Only tiles count.
#define RARA_SHOW_COUNT 2

// The mean of the splats' colours, each weighted by its alpha, in no order. Only tiles make it.
#define RARA_SHOW_MEAN 3

// 1.9e-5.
#define RARA_PHI_FORM_QUINTIC 0

// 1.4e-4.
#define RARA_PHI_FORM_CUBIC 1

// 9.5e-3, two levels of 255.
#define RARA_PHI_FORM_LOGISTIC 2

// Nothing is approximated. It goes with scenes in RARA_SH_FORMAT_FLOAT.
#define RARA_PRESET_EXACT 0

// Only approximations that no picture shows: the usual choice. It goes with scenes in RARA_SH_FORMAT_PACKED.
#define RARA_PRESET_BALANCED 1

// Only approximations that pictures hardly show. It goes with scenes in RARA_SH_FORMAT_PACKED.
#define RARA_PRESET_FAST 2

// The mean depth of what is left, along the view axis, world units; 0 where nothing is.
#define RARA_AOV_DEPTH 1

// Three channels, x, y and z: the mean direction of the splats' thinnest axes, turned to the eye, in the world, of length one;
// 0 where nothing is. On a cut it is still the splats' own, not the surface's.
#define RARA_AOV_NORMAL 2

// The number of the layer, from 0, whose splats add most to alpha; -1 where nothing is.
#define RARA_AOV_LAYER 4

// The mean share that the clip leaves of the splats, 1 where it cuts none; 0 where nothing is.
#define RARA_AOV_WEIGHT 8

// How many splats make the pixel, until it is saturated.
#define RARA_AOV_COUNT 16

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library that is linked: the RARA_ABI_VERSION of its header.
uint32_t rara_abi_version(void);

// The message of this thread's last call that failed: one or two sentences in UTF-8, "" if none has failed. It is valid
// until this thread's next call that fails.
const char *rara_last_error_message(void);

// Sends the log of the whole process, up to the level of rara_set_log_level, to a function of the host's; with null, as in
// the beginning, nobody gets it. `user` is what the function is given.
//
// RARA_LOG_LEVEL_INFO tells of devices that were adopted and for which kernels, of scenes, and of how splats become pixels
// and why, where that changes. RARA_LOG_LEVEL_DEBUG tells of each pipeline that is compiled and how long that took, and of
// each buffer: a frame that is like one before has neither. RARA_LOG_LEVEL_TRACE tells of each frame.
//
// May be called at any time and by any thread, as long as it holds no lock that the function waits for. The previous
// function is then not called any more, and no thread is inside it when this returns: what its `user` points to may be
// freed. RARA_ERROR_INVALID if the function itself calls this, and where rara is linked into a Rust program that already
// has a logger, which then gets these records.
//
// # Safety
// `log` is null, or is as RaraLog says and may be called with `user` by any thread until it is replaced.
RaraResult rara_set_log(RaraLog log,
                        void *user);

// Sets up to which level rara_set_log's function gets lines, now and after another rara_set_log: RARA_LOG_LEVEL_WARN for
// errors and warnings, say; in the beginning RARA_LOG_LEVEL_TRACE, for all. What nobody gets is not put together either, so
// that a host without use for RARA_LOG_LEVEL_TRACE does not pay for it in each frame. 0 stands for none.
//
// May be called as rara_set_log may. RARA_ERROR_INVALID for what is no level, and if the log's function itself calls this.
RaraResult rara_set_log_level(RaraLogLevel most);

// A camera in perspective at `eye` that looks at `target`; each is three numbers in world units. `up` points up in the
// picture; in the usual world, where y is down, it is 0, -1, 0. `fov_y` is the full vertical field of view in degrees.
// `camera_size` is sizeof *camera.
RaraResult rara_camera_look_at(const double *eye,
                               const double *target,
                               const double *up,
                               double fov_y,
                               uint32_t width,
                               uint32_t height,
                               struct RaraCamera *camera,
                               size_t camera_size);

// A camera without perspective at `eye` that looks at `target`, whose picture of `width` x `height` pixels is `view_height`
// world units high. `eye`, `target` and `up` are as for rara_camera_look_at.
RaraResult rara_camera_orthographic(const double *eye,
                                    const double *target,
                                    const double *up,
                                    double view_height,
                                    uint32_t width,
                                    uint32_t height,
                                    struct RaraCamera *camera,
                                    size_t camera_size);

// A camera from a rigid world-to-camera matrix: 16 numbers, row-major, so that the translation is in numbers 3, 7
// and 11. Focal lengths and principal point are in pixels.
RaraResult rara_camera_from_world_to_camera(const double *matrix,
                                            double fx,
                                            double fy,
                                            double cx,
                                            double cy,
                                            uint32_t width,
                                            uint32_t height,
                                            struct RaraCamera *camera,
                                            size_t camera_size);

// A camera that shows a scene from the front, the right and above, near enough to fill the picture. `up` and `fov_y` are
// as for rara_camera_look_at.
RaraResult rara_camera_frame(const struct RaraGaussians *gaussians,
                             const double *up,
                             double fov_y,
                             uint32_t width,
                             uint32_t height,
                             struct RaraCamera *camera,
                             size_t camera_size);

// Loads the cameras of a 3DGS cameras.json, a nerfstudio transforms.json, a COLMAP sparse folder, or a single one from
// JSON with width, height, fx, fy, cx, cy and world_to_camera. JSON files keep their order, COLMAP's cameras are
// sorted by name. Cameras with lens distortion are RARA_ERROR_FORMAT.
//
// On entry `*count` is how many cameras there is room for at `cameras` and `names`; it becomes how many the file has. No more
// are written than there is room for, and none where `cameras` or `names` is null. `camera_size` is sizeof *cameras. `path` is
// as for rara_gaussians_load.
RaraResult rara_cameras_load(const char *path,
                             struct RaraCamera *cameras,
                             size_t camera_size,
                             struct RaraCameraName *names,
                             size_t *count);

// Makes a clip of half-spaces, at most 32; none keep everything.
RaraResult rara_clip_of_planes(const struct RaraPlane *planes, size_t count, RaraClipOp op, struct RaraClip **clip);

// Makes a clip of the text of an expression: a shape, as "sphere:0,0,0,1" or "!box:0,0,0,1,1,2", whose "!" keeps the
// outside, or all(...), any(...) and not(...) of expressions, as in "all(box:0,0,0,1,1,2, not(sphere:1,0,0,0.5))".
// `rara help render` has the numbers of each shape. RARA_ERROR_INVALID says what is wrong and in which column.
RaraResult rara_clip_parse(const char *expression, struct RaraClip **clip);

// Makes a clip of JSON, of which `rara --save-clip` writes files: a list whose elements have a "name" or not, and
// either "clip", an expression as a tree, or "normal" and "d", a plane. `name` is the name of the element to take, or its
// number where none is called so; null takes the only one.
RaraResult rara_clip_from_json(const uint8_t *json,
                               size_t size,
                               const char *name,
                               struct RaraClip **clip);

// Makes a clip of a JSON file, as rara_clip_from_json does. `path` is as for rara_gaussians_load.
RaraResult rara_clip_load(const char *path, const char *name, struct RaraClip **clip);

// Frees a clip; null is ignored. Renderers and layers that were given it have copies of their own.
void rara_clip_destroy(struct RaraClip *clip);

// Says in `kept` whether a clip keeps a point, three numbers; a surface's own points are kept.
RaraResult rara_clip_keeps(const struct RaraClip *clip, const double *point, VkBool32 *kept);

// The map of a perspective projection into depths from 0 to 1: `z_near`, world units above 0, becomes 0, or 1 if `reversed`,
// and `z_far`, beyond it and INFINITY too, the other.
RaraResult rara_depth_map_perspective(double z_near,
                                      double z_far,
                                      VkBool32 reversed,
                                      struct RaraDepthMap *map);

// The map of an orthographic projection: 0 at `z_zero` along the view axis, 1 at `z_one`, world units, and linear between
// them. Nearer is more where `z_one` is the nearer one.
RaraResult rara_depth_map_orthographic(double z_zero,
                                       double z_one,
                                       struct RaraDepthMap *map);

// A depth attachment without stencil, not readable. `desc_size` is sizeof *desc.
RaraResult rara_depth_desc_default(struct RaraDepthDesc *desc,
                                   size_t desc_size,
                                   VkFormat format,
                                   struct RaraDepthMap map);

// An image of `width` x `height` pixels, whose upper left corner is the viewport's. `depth_size` is sizeof *depth.
RaraResult rara_depth_image_default(struct RaraDepthImage *depth,
                                    size_t depth_size,
                                    VkImage image,
                                    uint32_t width,
                                    uint32_t height);

// Checks whether a physical device will do, before there is a device. If it will not, the result is RARA_ERROR_DEVICE
// and the message names what is missing.
//
// `api_version` is the VkApplicationInfo::apiVersion that the instance was created with, 1.2 or later; `support_size` is
// sizeof *support.
//
// # Safety
// `instance` is alive and was created for `api_version`, `physical_device` is one of its own, and
// `get_instance_proc_addr` is the loader's. `support` has room for `support_size` bytes.
RaraResult rara_check(PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                      VkInstance instance,
                      VkPhysicalDevice physical_device,
                      uint32_t api_version,
                      struct RaraSupport *support,
                      size_t support_size);

// Sets the features that rara needs in the host's own structs: those in the pNext chain of its VkDeviceCreateInfo,
// whichever of Vulkan's structs they are in. No other field is touched. RARA_ERROR_INVALID names a feature for which the
// chain has no struct; those that are optional may be missing, since a host can do without: meshShader and taskShader,
// subgroupSizeControl and computeFullSubgroups.
//
// # Safety
// `support` was filled by rara_check; `p_next` is null, or a chain of structs that may be changed.
RaraResult rara_support_features(const struct RaraSupport *support,
                                 void *p_next);

// Enables nothing optional and sets all handles to null; the host replaces them. `desc_size` is sizeof *desc.
RaraResult rara_adopt_desc_default(struct RaraAdoptDesc *desc, size_t desc_size);

// Works with the host's device. Nothing in `desc` is ever destroyed, and only rara_scene_buffers_upload,
// rara_scene_buffers_upload_layers and rara_renderer_channels submit to the queue. RARA_ERROR_INVALID names an extension that
// the description claims and whose functions the device does not have. Features that are claimed cannot be checked.
//
// # Safety
// The handles belong together, are as the description says, and outlive all that is made from the RaraDevice, of which
// `release` tells the end. It may be called with `release_user` by any thread, and so may `allocate` and `free` with
// `allocator_user`; they keep what their types say.
RaraResult rara_device_adopt(const struct RaraAdoptDesc *desc,
                             struct RaraDevice **device);

// Bytes of device memory that rara has allocated on the device, 0 for null.
uint64_t rara_device_bytes(const struct RaraDevice *device);

// Gives the device back; the VkDevice lives on. What was made from the RaraDevice may be destroyed later, but before the
// VkDevice. Null is ignored.
void rara_device_destroy(struct RaraDevice *device);

// Sets where the scene stands, from the next rara_renderer_configure on; camera, clip, depth map and expected depths are
// the world's. Until this is called the scene stands where it was made. RARA_ERROR_INVALID for numbers that are not
// finite, a scale that is not above zero and a rotation of zero; the placement then stays as it was.
//
// The picture is that of the placed Gaussians, spherical harmonics turn with the scene, and no Gaussian is touched: a
// scene can be moved in every frame, and one RaraSceneBuffers can be drawn in several places, by a renderer each. All
// lengths are then in the scene's units, also the depth of 0.2 below which centres are culled where RaraCamera::near_cut
// says no other, in world units.
RaraResult rara_renderer_set_placement(struct RaraRenderer *renderer,
                                       const struct RaraPlacement *placement);

// Creates a renderer. The first frame that needs a pipeline or buffer creates it. RARA_ERROR_DEVICE where the device
// cannot draw into such attachments.
RaraResult rara_renderer_create(const struct RaraDevice *device,
                                const struct RaraRendererDesc *desc,
                                struct RaraRenderer **renderer);

// Creates another renderer on the same device that shares the compiled pipelines of `other`: one for each view that is
// drawn in the same scope. Its working memory is its own.
RaraResult rara_renderer_create_sharing(const struct RaraRenderer *other,
                                        const struct RaraRendererDesc *desc,
                                        struct RaraRenderer **renderer);

// Changes what the host's depth buffer holds for a depth, from the next rara_renderer_configure on.
RaraResult rara_renderer_set_depth_map(struct RaraRenderer *renderer, const struct RaraDepthMap *map);

// Changes the format of the colour attachment, from the next rara_renderer_configure on, which compiles what the format needs
// and keeps what was compiled for others: for a host whose swapchain changes, or that draws into several targets.
RaraResult rara_renderer_set_color_format(struct RaraRenderer *renderer,
                                          VkFormat color_format);

// Forgets what earlier frames have computed, as is needed after a frame that was prepared and not submitted.
// rara_renderer_configure comes after it.
RaraResult rara_renderer_forget(struct RaraRenderer *renderer);

// Frees a renderer's memory and pipelines; null is ignored. The host has waited for all of its frames.
//
// # Safety
// `renderer` is null, or alive and not used any more, not even by the device.
void rara_renderer_destroy(struct RaraRenderer *renderer);

// One colour attachment of one sample in dynamic rendering, no timestamps, no reuse, one frame in flight. `desc_size` is
// sizeof *desc.
RaraResult rara_renderer_desc_default(struct RaraRendererDesc *desc,
                                      size_t desc_size,
                                      VkFormat color_format);

// Vulkan's own: y down, depths from 0 to 1, nearer is less, a view's translation in numbers 12 to 14. `ndc_size` is sizeof
// *ndc.
RaraResult rara_ndc_default(struct RaraNdc *ndc,
                            size_t ndc_size);

// The camera of a host's matrices of 16 numbers each, whose rotation has a mirror in it where the world is left-handed, and
// what its depth buffer holds, for rara_renderer_set_depth_map; `map` may be null. `width` and `height` are the viewport's,
// pixels; `camera_size` is sizeof *camera. A null `ndc` is rara_ndc_default's.
//
// The axes of the view may be any, with y up or down and z forward or back, left-handed ones too. The view may scale,
// evenly along its axes, and lead from a scene instead of the world (the view times a model's matrix), mirrors included.
// The projection may be reversed, infinite, off-centre, jittered, turned by quarters (as for a display's pre-rotation) or
// orthographic. RARA_ERROR_INVALID names the matrix and what in it is not possible: an entry that is not finite, a matrix
// that is singular or looks transposed, a view that shears or scales unevenly, a projection that shears, or whose depth is
// not a function of the distance alone (as with an oblique near plane).
//
// RaraCamera::near_cut says from which depth on splats are drawn, whatever the projection's near plane. An orthographic
// camera's eye is moved back where that would leave out what lies behind the near plane; depths count from there.
RaraResult rara_camera_of_projection(const double *view,
                                     const double *projection,
                                     const struct RaraNdc *ndc,
                                     uint32_t width,
                                     uint32_t height,
                                     struct RaraCamera *camera,
                                     size_t camera_size,
                                     struct RaraDepthMap *map);

// As rara_camera_of_projection, of matrices in single precision.
RaraResult rara_camera_of_projection_floats(const float *view,
                                            const float *projection,
                                            const struct RaraNdc *ndc,
                                            uint32_t width,
                                            uint32_t height,
                                            struct RaraCamera *camera,
                                            size_t camera_size,
                                            struct RaraDepthMap *map);

// Limits of frames of one layer that is cut by up to six planes in any mode. `limits_size` is sizeof *limits.
RaraResult rara_frame_limits_default(struct RaraFrameLimits *limits,
                                     size_t limits_size,
                                     uint32_t width,
                                     uint32_t height,
                                     uint32_t gaussians);

// Compiles the pipelines and allocates the working memory of all frames within limits: rara_renderer_configure then
// compiles and allocates nothing for them, whatever their cameras, clips, modes and scenes. Frames beyond the limits are
// configured as without them, and what was reserved stays.
//
// It takes a fraction of a second to some seconds, submits nothing, and may be called on any thread, as while a scene loads;
// the renderer is used by no other call meanwhile. A renderer of rara_renderer_create_sharing compiles for both.
// rara_renderer_configure comes after it. RARA_ERROR_MEMORY where there is no room; of a budget's it is said before
// anything is allocated or compiled.
RaraResult rara_renderer_reserve(struct RaraRenderer *renderer,
                                 const struct RaraFrameLimits *limits);

// Gives back the working memory, also what was reserved, but for what a frame like `keep` needs, which is prepared or null:
// for that rara_renderer_configure then allocates nothing. The host has waited for all of the renderer's frames.
//
// # Safety
// `renderer` is alive, no other thread uses it, and the device has finished its frames; `keep` is null or alive.
RaraResult rara_renderer_trim(struct RaraRenderer *renderer,
                              const struct RaraFrame *keep);

// Bytes of device memory that the renderer's working memory takes, 0 for null.
uint64_t rara_renderer_bytes(const struct RaraRenderer *renderer);

// An estimate of the pairs of tile and splat in a camera's picture, for RaraFrameLimits::pairs: without what a clip leaves
// out, with the scene where it was made, and with the usual near cut. Splats that are nearer have the most pairs of all.
RaraResult rara_scene_buffers_estimated_pairs(const struct RaraSceneBuffers *scene,
                                              const struct RaraCamera *camera,
                                              uint32_t *pairs);

// The device memory that rara has allocated, and the pipelines that it has compiled. `memory_size` is sizeof *memory.
RaraResult rara_device_memory(const struct RaraDevice *device, struct RaraDeviceMemory *memory, size_t memory_size);

// Sets the most bytes of device memory that all scenes and renderers of a device may take together; 0, as in the
// beginning, for no limit but the device's. What would exceed it fails with RARA_ERROR_MEMORY before any of it is allocated,
// and the message says what to do. What is there already stays. Any thread may call this at any time.
RaraResult rara_device_set_memory_budget(const struct RaraDevice *device,
                                         uint64_t bytes);

// Decides what a frame needs, and allocates and compiles what is missing. The camera's picture is the viewport that
// rara_renderer_draw sets. A null `clip` clips nothing, null `settings` are the defaults.
//
// # Safety
// `renderer` and `scene` are alive and of one device; no other thread uses `renderer`; the other pointers are null or
// point to what they say; `frame` may be overwritten. The host has waited for the frames that RaraRenderer says.
RaraResult rara_renderer_configure(struct RaraRenderer *renderer,
                                   const struct RaraSceneBuffers *scene,
                                   const struct RaraCamera *camera,
                                   const struct RaraClip *clip,
                                   const struct RaraSettings *settings,
                                   struct RaraFrame **frame);

// Records a frame's stages up to the draw, outside any rendering scope. `depth` is null, or for a renderer whose
// RaraDepthDesc is readable the depths of what the host has already drawn, so that tiles leave out the splats behind it.
// RARA_ERROR_INVALID for a frame of another renderer, of another scene, that is prepared already, or that takes over from
// another one than the frame prepared last; nothing is recorded then, and the frame is of no more use.
//
// The part of the depth image under the viewport is copied, at VK_PIPELINE_STAGE_2_COPY_BIT by
// VK_ACCESS_2_TRANSFER_READ_BIT: the host's barrier before the call makes its depths visible to that, its barrier after the
// call waits for it.
//
// # Safety
// `cmd` is recording outside a rendering scope, and will be submitted to the device's queue, or never. `scene` is the
// one given to rara_renderer_configure, and lives until the commands have executed; so does the depth image, which is as
// its fields say and visible to the copy.
RaraResult rara_renderer_prepare(struct RaraRenderer *renderer,
                                 VkCommandBuffer cmd,
                                 const struct RaraSceneBuffers *scene,
                                 const struct RaraDepthImage *depth,
                                 struct RaraFrame *frame);

// Records a frame's splats inside the host's rendering scope, premultiplied and over what is there. `x` and `y` are the upper
// left corner of the camera's picture in the attachment, whole pixels; the viewport is set to that picture, upright where
// row 0 of the attachment is the upper one, whatever viewport the host has. The host's scissor holds. The call may be
// recorded more than once for a frame. RARA_ERROR_INVALID for another frame than the one that the renderer has prepared
// last, and where `x` or `y` is not finite.
//
// # Safety
// `cmd` is inside a rendering scope with the attachments of RaraRendererDesc and no others, one layer and no view mask;
// a scissor is set by vkCmdSetScissor; the commands of rara_renderer_prepare come before it.
RaraResult rara_renderer_draw(struct RaraRenderer *renderer,
                              VkCommandBuffer cmd,
                              float x,
                              float y,
                              const struct RaraFrame *frame);

// Records a frame's depths inside a rendering scope of their own, with a colour attachment of expected_depth_format
// and, if there is one, the same depth attachment. Where the host has cleared both channels to 0, red / green is the
// pixel's expected depth along the view axis, world units, and green its alpha. `x` and `y` are as for
// rara_renderer_draw.
//
// # Safety
// As for rara_renderer_draw, in such a scope.
RaraResult rara_renderer_draw_depth(struct RaraRenderer *renderer,
                                    VkCommandBuffer cmd,
                                    float x,
                                    float y,
                                    const struct RaraFrame *frame);

// Ends a frame, prepared or not; null is ignored. The memory of a frame that the device works on stays until it is done.
void rara_frame_destroy(struct RaraFrame *frame);

// Makes a picker beside a renderer, whose compiled pipelines it shares, and whose placement of this moment it takes. So many
// requests, from 1 to 16, may be unfinished at once.
RaraResult rara_picker_create(const struct RaraRenderer *renderer,
                              uint32_t in_flight,
                              struct RaraPicker **picker);

// Places the scene in the world, as rara_renderer_set_placement does for what is drawn.
RaraResult rara_picker_set_placement(struct RaraPicker *picker, const struct RaraPlacement *placement);

// Records the question what the pixels of a rectangle show most of, in the picture of a camera, outside a rendering scope. The
// part of the picture is drawn into memory of the picker's own, with the clip, layers and weights of the whole; nothing of the
// host's targets, of a renderer or of the scene changes, and nothing waits. The host's depth hides nothing from it. The first
// request compiles what no frame needs: make one that nobody waits for.
// RARA_ERROR_INVALID for a rectangle without pixels, or one that reaches out of the picture.
//
// # Safety
// As for rara_renderer_configure and rara_renderer_prepare, with requests in place of frames: of so many as
// rara_picker_create was told the first one has finished before one more is recorded, and all of them before the picker ends.
// `ticket` may be overwritten.
RaraResult rara_picker_record(struct RaraPicker *picker,
                              VkCommandBuffer cmd,
                              const struct RaraSceneBuffers *scene,
                              const struct RaraCamera *camera,
                              const struct RaraClip *clip,
                              const struct RaraSettings *settings,
                              int32_t x,
                              int32_t y,
                              uint32_t width,
                              uint32_t height,
                              struct RaraPickTicket *ticket);

// Writes the answer to a request: a pick for each pixel of the rectangle, row by row from the upper left. `*answered` is
// VK_TRUE then. It is VK_FALSE, and nothing is written, where there was no room for what the pixels show, for which later
// requests make it.
// RARA_ERROR_INVALID for another picker's request, for one whose memory a later one has taken, and where `pick_count` is not
// the number of pixels.
//
// # Safety
// `picker` is alive, and no other thread changes it; the submission in which the request was recorded has finished; `picks`
// has room for `pick_count`; `answered` may be overwritten.
RaraResult rara_picker_read(const struct RaraPicker *picker,
                            struct RaraPickTicket ticket,
                            struct RaraPick *picks,
                            size_t pick_count,
                            VkBool32 *answered);

// Ends a picker; null is ignored. The device is done with its requests.
void rara_picker_destroy(struct RaraPicker *picker);

// Loads a scene: 3DGS .ply (ascii or binary, spherical harmonics of degree 0 to 3), .compressed.ply, .splat, .ksplat, .spz,
// SOG (an archive, its folder or meta.json) or glTF with KHR_gaussian_splatting. The format is found by what is in the file.
//
// `path` is UTF-8, or on Unix whatever the file system takes.
RaraResult rara_gaussians_load(const char *path,
                               struct RaraGaussians **gaussians);

// Loads a scene that is in memory, such as an archive's entry, in any format that is one file. `name` stands for it in
// messages.
RaraResult rara_gaussians_load_from(const uint8_t *data,
                                    size_t size,
                                    const char *name,
                                    struct RaraGaussians **gaussians);

// Appends another scene to one, so that both are sorted and composited as one. Properties that both have
// stay, for rara_gaussians_select.
RaraResult rara_gaussians_append(struct RaraGaussians *gaussians, const struct RaraGaussians *other);

// Says whether Gaussians were trained antialiased, as by Mip-Splatting or gsplat's rasterize_mode antialiased: what the
// low-pass makes larger on the screen then gets no brighter for it. Files that say so are loaded so. It holds for a whole
// scene; what is appended to one is drawn like it. A scene that is on the device already stays as it is.
RaraResult rara_gaussians_set_antialiased(struct RaraGaussians *gaussians,
                                          VkBool32 antialiased);

// Describes a scene. `info_size` is sizeof *info.
RaraResult rara_gaussians_info(const struct RaraGaussians *gaussians, struct RaraGaussiansInfo *info, size_t info_size);

// Frees a scene's memory; null is ignored.
void rara_gaussians_destroy(struct RaraGaussians *gaussians);

// No memory; the host replaces the buffer and what follows. `staging_size` is sizeof *staging.
RaraResult rara_staging_default(struct RaraStaging *staging, size_t staging_size);

// Uploads a scene of one layer. Only this function, rara_scene_buffers_upload_layers and rara_renderer_channels submit to the
// host's queue and wait.
//
// # Safety
// `device` and `gaussians` are alive; nobody else uses the queue meanwhile; `scene` may be overwritten.
RaraResult rara_scene_buffers_upload(const struct RaraDevice *device,
                                     const struct RaraGaussians *gaussians,
                                     RaraShFormat sh_format,
                                     struct RaraSceneBuffers **scene);

// Bytes of staging memory that rara_scene_buffers_upload_with needs for a scene of one layer.
RaraResult rara_scene_buffers_staging_bytes(const struct RaraGaussians *gaussians,
                                            RaraShFormat sh_format,
                                            uint64_t *bytes);

// Uploads a scene of one layer by the host's own means: allocates its buffers, writes it into the host's staging memory
// and records the copies. Nothing is submitted and nothing waits, so that a scene can come or be replaced while frames
// are in flight. The calling thread converts the scene meanwhile; it need not be the one that draws.
//
// Synchronisation: the copies are ordered behind everything earlier in the queue, and nothing is needed after them,
// since rara_renderer_prepare begins with a barrier that waits for transfers. It may be recorded later into the same
// command buffer, or into one that is submitted later to the same queue. What is written to the staging memory reaches
// the device with the submission where the memory is host-coherent; else the host flushes the range before it submits.
//
// Lifetimes: the host leaves the staging range alone and keeps `*scene` alive until `cmd` has executed. A scene that is
// replaced lives until the last frame that was prepared with it has executed; `gaussians` may be destroyed at once. If
// `cmd` is never submitted, `*scene` must not be drawn. After an error nothing has been recorded.
//
// # Safety
// `device` and `gaussians` are alive. `cmd` is recording outside a rendering scope, and will be submitted to the
// device's queue, or never; no other thread uses its pool. `staging` is as its fields say, and neither the device nor
// anybody else uses its range. `scene` may be overwritten.
RaraResult rara_scene_buffers_upload_with(const struct RaraDevice *device,
                                          VkCommandBuffer cmd,
                                          const struct RaraStaging *staging,
                                          const struct RaraGaussians *gaussians,
                                          RaraShFormat sh_format,
                                          struct RaraSceneBuffers **scene);

// Bytes of device memory that a scene takes, 0 for null.
uint64_t rara_scene_buffers_bytes(const struct RaraSceneBuffers *scene);

// Frees a scene's device memory; null is ignored. The host has waited for the frames that use it.
//
// # Safety
// `scene` is null, or alive and not used any more, not even by the device.
void rara_scene_buffers_destroy(struct RaraSceneBuffers *scene);

// No Gaussians, of degree 0, in arrays without gaps. `arrays_size` is sizeof *arrays.
RaraResult rara_gaussian_arrays_default(struct RaraGaussianArrays *arrays, size_t arrays_size);

// Copies Gaussians from a host's arrays. RARA_ERROR_INVALID names the array and, where a number in it cannot be drawn (one
// that is not finite, a negative scale, a rotation that is no unit quaternion, an opacity that is not between 0 and 1), the
// element.
RaraResult rara_gaussians_from_arrays(const struct RaraGaussianArrays *arrays,
                                      struct RaraGaussians **gaussians);

// Loads a scene as rara_gaussians_load does, with what rara_gaussians_select will ask for: the properties that the file's
// `vertex` element has beside those of a Gaussian, such as labels, and that any of these predicates compares. Each takes 8
// bytes a Gaussian. RARA_ERROR_FORMAT where the file has no such property.
RaraResult rara_gaussians_load_with(const char *path,
                                    const char *const *predicates,
                                    size_t predicate_count,
                                    struct RaraGaussians **gaussians);

// Loads a scene that is in memory as rara_gaussians_load_from does, with properties as rara_gaussians_load_with does.
RaraResult rara_gaussians_load_from_with(const uint8_t *data,
                                         size_t size,
                                         const char *name,
                                         const char *const *predicates,
                                         size_t predicate_count,
                                         struct RaraGaussians **gaussians);

// Gives each Gaussian a number of the host's own, such as a label, for the predicates of rara_gaussians_select: a property
// of this name, in place of one that it had. `count` is that of the Gaussians. The values are copied; one that is no number
// fulfils no comparison.
RaraResult rara_gaussians_set_property(struct RaraGaussians *gaussians,
                                       const char *name,
                                       const double *values,
                                       size_t count);

// Takes the Gaussians that fulfil a predicate out of others: `gaussians` keeps the rest, and `*taken`, which the host
// destroys as any, has those that were taken; there may be none. Each becomes a layer of a scene, with a state (hidden,
// faded, moved) and a clip of its own. In that scene, Gaussians of both that are equally deep are drawn in the order in
// which they were before, whichever layer they are in, so that a selection by itself changes no picture. Either may be
// selected from again.
//
// `predicate` is what the program's `--select` takes: comparisons as "opacity>0.5", "size<=0.01", "red>0.6" and "label in
// 3,4,7..9", where label is a property of rara_gaussians_load_with or rara_gaussians_set_property, and
// "inside(sphere:0,0,0,1)", which takes any expression of rara_clip_parse; joined by `and`, `or`, `not` and ( ).
// RARA_ERROR_INVALID says what is wrong and in which column, and names a property that is not there.
//
// Clips and sizes are the scene's: `placement` is that of the layer that the Gaussians will be, and null leaves it where
// it was made. After an error `gaussians` is as it was.
RaraResult rara_gaussians_select(struct RaraGaussians *gaussians,
                                 const char *predicate,
                                 const struct RaraPlacement *placement,
                                 struct RaraGaussians **taken);

// The state of a layer that stands where it was made, visible and with the opacities of its Gaussians. `state_size` is
// sizeof *state.
RaraResult rara_layer_state_default(struct RaraLayerState *state, size_t state_size);

// A layer of Gaussians in the default state; `layer` keeps both pointers as they are. `layer_size` is sizeof *layer.
RaraResult rara_layer_default(struct RaraLayer *layer,
                              size_t layer_size,
                              const char *name,
                              const struct RaraGaussians *gaussians);

// Uploads a scene of several layers as rara_scene_buffers_upload does one of a single layer. The layers are sorted and
// blended together, wherever they reach into each other. Where two Gaussians are equally deep, the earlier layer's is in
// front; of those that rara_gaussians_select has divided the one is that was before the other.
//
// # Safety
// `device` is alive; `layers` points to `layer_count` layers, which are as their fields say and all of one struct_size;
// nobody else uses the queue meanwhile; `scene` may be overwritten.
RaraResult rara_scene_buffers_upload_layers(const struct RaraDevice *device,
                                            const struct RaraLayer *layers,
                                            size_t layer_count,
                                            RaraShFormat sh_format,
                                            struct RaraSceneBuffers **scene);

// Bytes of staging memory that rara_scene_buffers_upload_layers_with needs for a scene.
RaraResult rara_scene_buffers_staging_bytes_of_layers(const struct RaraLayer *layers,
                                                      size_t layer_count,
                                                      RaraShFormat sh_format,
                                                      uint64_t *bytes);

// Uploads a scene of several layers as rara_scene_buffers_upload_with does one of a single layer. `layers` and what they
// point to may be freed when it returns.
//
// # Safety
// As for rara_scene_buffers_upload_with and, for the layers, as for rara_scene_buffers_upload_layers.
RaraResult rara_scene_buffers_upload_layers_with(const struct RaraDevice *device,
                                                 VkCommandBuffer cmd,
                                                 const struct RaraStaging *staging,
                                                 const struct RaraLayer *layers,
                                                 size_t layer_count,
                                                 RaraShFormat sh_format,
                                                 struct RaraSceneBuffers **scene);

// The state of a layer, as it was uploaded or last set; its rotation has length one. `state_size` is sizeof *state.
RaraResult rara_scene_buffers_layer_state(const struct RaraSceneBuffers *scene,
                                          size_t index,
                                          struct RaraLayerState *state,
                                          size_t state_size);

// Sets the state of a layer: the next rara_renderer_configure of every renderer takes it, and frames that are already
// configured keep theirs, so that nothing has to be waited for. RARA_ERROR_INVALID for an opacity that is not 0 to 1 and
// for an impossible placement; the state then stays as it was.
RaraResult rara_scene_buffers_set_layer_state(struct RaraSceneBuffers *scene,
                                              size_t index,
                                              const struct RaraLayerState *state);

// Sets a clip for a layer alone, in place of the clip of rara_renderer_configure: a clip without planes keeps the whole
// layer. Null gives the layer the frame's clip again. The clip stands in the scene: neither
// the layer's placement nor that of rara_renderer_set_placement moves it, and the camera's planes are no part of it. It holds
// from the next rara_renderer_configure of every renderer on. RARA_ERROR_INVALID for what is no clip; the layer's clip then
// stays as it was.
RaraResult rara_scene_buffers_set_layer_clip(struct RaraSceneBuffers *scene,
                                             size_t index,
                                             const struct RaraClip *clip);

// How many layers a scene has, one or more; 0 for null.
size_t rara_scene_buffers_layer_count(const struct RaraSceneBuffers *scene);

// Describes a layer. Layers are numbered from 0, in the order in which they were given. `info_size` is sizeof *info.
RaraResult rara_scene_buffers_layer_info(const struct RaraSceneBuffers *scene,
                                         size_t index,
                                         struct RaraLayerInfo *info,
                                         size_t info_size);

// The number of the first layer of a name. RARA_ERROR_INVALID, which lists the names that there are, where no layer is called
// so; `index` is then left alone.
RaraResult rara_scene_buffers_layer_by_name(const struct RaraSceneBuffers *scene,
                                            const char *name,
                                            size_t *index);

// The default settings with a preset's precision. `settings_size` is sizeof *settings.
RaraResult rara_settings_default(struct RaraSettings *settings, size_t settings_size, RaraPreset preset);

// The default settings. `settings_size` is sizeof *settings.
RaraResult rara_bake_settings_default(struct RaraBakeSettings *settings, size_t settings_size);

// Makes Gaussians that show a cut without a clip, wherever they are drawn: those outside it are dropped, those that it
// leaves whole are kept, and each that it cuts is replaced by one with the mass, the mean and the covariance of what is left.
// A Gaussian has no edge, so that this is a preview: against the exact cut, 12 to 17 % of the light of cut Gaussians is off,
// where a cut by centres is off by 35 %. It needs no device; all processors work at it.
// Properties, for rara_gaussians_select, stay those of the Gaussians that they come from.
//
// Null `settings` are the defaults. `counts` says what has been done; it may be null, and `counts_size` is sizeof *counts.
RaraResult rara_gaussians_bake(const struct RaraGaussians *gaussians,
                               const struct RaraClip *clip,
                               const struct RaraBakeSettings *settings,
                               struct RaraGaussians **baked,
                               struct RaraBakeCounts *counts,
                               size_t counts_size);

// Channels of these quantities, of pictures of `width` x `height` pixels; the host gives `values`, with room for
// `value_count` numbers. `channels_size` is sizeof *channels.
RaraResult rara_channels_default(struct RaraChannels *channels,
                                 size_t channels_size,
                                 RaraAovs aovs,
                                 uint32_t width,
                                 uint32_t height);

// Draws what a frame's pixels are made of, and waits for it: depths, normals, layers, weights and counts, as the program's
// `--aov` does. It is for editors and measurements, not for each frame: every quantity takes a frame or more of its own, and
// the scene is uploaded for the call, for normals and layers in other colours once more. All of its memory is freed again.
//
// The renderer lends its device, its compiled pipelines and its placement; its frames, attachments and depths have no say,
// and stay as they are. The scene is given as layers because one that is on the device has no colours that could be changed:
// states and clips that were set there are given with them. What `settings` show is ignored.
//
// RARA_ERROR_INVALID where the sizes of `channels` are not the camera's, or too few or too many; after an error `values` are as
// they were.
//
// # Safety
// `renderer` is alive, and no other thread changes it; nobody else uses the queue meanwhile; `layers` points to
// `layer_count` layers, which are as their fields say and all of one struct_size; the other pointers are as for
// rara_renderer_configure; `channels` is as its fields say, and nobody else uses its values.
RaraResult rara_renderer_channels(const struct RaraRenderer *renderer,
                                  const struct RaraLayer *layers,
                                  size_t layer_count,
                                  const struct RaraCamera *camera,
                                  const struct RaraClip *clip,
                                  const struct RaraSettings *settings,
                                  const struct RaraChannels *channels);

// The statistics of a frame, to be asked for after waiting for it and before the next rara_renderer_prepare.
// `stats_size` is sizeof *stats.
RaraResult rara_renderer_stats(const struct RaraRenderer *renderer, struct RaraFrameStats *stats, size_t stats_size);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* RARA_H */
