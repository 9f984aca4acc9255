// The component interface: three hooks. The frame loop calls them in this order for every component of a scene.
#pragma once

#include "voile/gpu/recorder.hpp"

#include <glm/glm.hpp>

namespace voile::engine
{

// The data of a frame for all components. The time step is fixed: no component reads a clock.
struct FrameInfo
{
    uint64_t index = 0;                    // simulated frames since the start
    double time = 0;                       // s, at the start of this frame: the sum of the time steps before
    bool simulates = true;                 // false: the frame draws the state as it is; index and time do not advance
    float time_step = 1.f / 60;            // s
    uint32_t slot = 0;                     // index of the frame in flight, 0..slots-1; its previous use has completed
    gpu::Timestamps* timestamps = nullptr; // null when passes are not timed
};

// How a surface reflects light; metallic-roughness with the sheen of cloth.
struct Surface
{
    glm::vec3 base_color{0.8f}; // linear, 0..1
    glm::vec3 back_color{0.8f}; // linear; the color of the back side, for two-sided surfaces
    float roughness = 0.6f;     // perceptual, 0.05..1
    float metallic = 0;         // 0..1
    float sheen = 0;            // 0..1; strength of the fabric's grazing-angle sheen
    float weave_scale = 0;      // fabric: threads per unit of texture coordinate
    float pattern_scale = 0;    // fabric: repeats of its check per unit of texture coordinate
    float translucency = 0.1f;  // fabric: fraction of the sun's light that passes through, 0..1
    bool two_sided = false;     // lit from both sides, not culled
    enum class Weave : uint32_t // fabric: how its threads lie
    {
        plain, // warp and weft alternate
        twill, // warp over three wefts, in diagonals
        satin, // warp over four, scattered: smooth
        grain, // no threads: the pebbles of leather
        none,
    } weave = Weave::plain;
    enum class Pattern : uint32_t // fabric: of the colors of its threads
    {
        check,
        stripes, // along the weft
        none,
    } pattern = Pattern::check;
    enum class Kind : uint32_t
    {
        plain,
        fabric,
        ground
    } kind = Kind::plain;
};

// Stone slabs that fade into the horizon.
inline Surface ground_surface()
{
    Surface surface;
    surface.base_color = {0.36f, 0.34f, 0.31f};
    surface.roughness = 0.85f;
    surface.kind = Surface::Kind::ground;
    return surface;
}

// A triangle list drawn from separate vertex streams. A compute shader may write the normals.
struct Drawable
{
    VkBuffer positions = VK_NULL_HANDLE;           // 16 bytes per vertex: x y z (m) and an ignored float
    VkBuffer normals = VK_NULL_HANDLE;             // 16 bytes per vertex: unit normal and padding
    VkBuffer texture_coordinates = VK_NULL_HANDLE; // 8 bytes per vertex
    VkBuffer indices = VK_NULL_HANDLE;             // uint32
    VkDeviceSize position_offset = 0;              // bytes
    VkDeviceSize normal_offset = 0;                // bytes
    VkDeviceSize texture_coordinate_offset = 0;    // bytes
    VkDeviceSize index_offset = 0;                 // bytes
    uint32_t index_count = 0;
    glm::mat4 model{1.f}; // world from model
    Surface surface;
    const char* label = "mesh"; // shown in captures; a literal or a string that outlives the frame
};

// Straight lines, drawn over surfaces that they lie on. Used for debug drawing. Only camera views draw them.
struct Lines
{
    VkBuffer from = VK_NULL_HANDLE; // 16 bytes per line: x y z (m) and an ignored float
    VkBuffer to = VK_NULL_HANDLE;   // the other end, same layout; if `length` is set, the unit vector to it
    VkDeviceSize from_offset = 0;   // bytes
    VkDeviceSize to_offset = 0;     // bytes
    uint32_t count = 0;
    float length = 0; // m
    float width = 2;  // pixels
    glm::vec3 color{1.f};
    glm::mat4 model{1.f}; // world from model
    const char* label = "lines";
};

// Round dots. Only camera views draw them.
struct Dots
{
    VkBuffer positions = VK_NULL_HANDLE; // 16 bytes per dot: x y z (m) and an ignored float
    VkBuffer flags = VK_NULL_HANDLE;     // 16 bytes per dot, whose last float is a sum of bits; or a word per dot
    bool flag_words = false;             // the latter
    VkDeviceSize position_offset = 0;    // bytes
    VkDeviceSize flag_offset = 0;        // bytes
    uint32_t count = 0;
    uint32_t mask = 0; // draws the dots that have one of these bits; 0: all
    float size = 6;    // pixels
    glm::vec3 color{1.f};
    glm::mat4 model{1.f}; // world from model
    const char* label = "dots";
};

// One view of the scene being drawn: the shadow map's or the camera's. The renderer implements it and owns the
// pipelines. Components choose what to draw, never the pipeline.
class View
{
public:
    enum class Kind
    {
        shadow, // depth only, from the sun
        camera, // shaded
    };

    View(Kind kind, const glm::mat4& clip_from_world) : kind_(kind), clip_from_world_(clip_from_world) {}
    virtual ~View() = default;
    virtual void draw(VkCommandBuffer cmd, const Drawable& drawable) = 0;
    virtual void draw(VkCommandBuffer cmd, const Lines& lines) = 0;
    virtual void draw(VkCommandBuffer cmd, const Dots& dots) = 0;

    [[nodiscard]] Kind kind() const { return kind_; }
    [[nodiscard]] const glm::mat4& clip_from_world() const { return clip_from_world_; }

private:
    Kind kind_;
    glm::mat4 clip_from_world_;
};

// The constructor acquires resources, the destructor releases them.
class Component
{
public:
    virtual ~Component() = default;

    // Host work of the frame, before anything is recorded.
    virtual void update(const FrameInfo& /*frame*/) {}

    // Records compute and transfer commands, outside rendering. Its writes must be visible to vertex input when it
    // returns.
    virtual void record_compute(VkCommandBuffer /*cmd*/, const FrameInfo& /*frame*/) {}

    // Records draws, inside rendering. Called once per view.
    virtual void record_draw(VkCommandBuffer /*cmd*/, View& /*view*/) {}
};

} // namespace voile::engine
