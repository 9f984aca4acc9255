// Solver: cloths and colliders on the GPU, advanced by dispatches recorded into the host's command buffer.
//
//   auto solver = cloth::Solver::create(handles, {});           // borrowed handles, see requirements()
//   auto sheet  = solver.value().add_cloth({...});              // copied and validated
//   auto ball   = solver.value().add_collider(cloth::SphereCollider{...});
//   auto upload = solver.value().record_upload(cmd);            // keep until cmd has completed
//   each frame:   solver.value().record(cmd, {.duration = 1.f / 60});
//                 draw solver.value().vertices(sheet.value())   // the same buffers that were written
//
// Buffers (one entry a vertex of all cloths, unless said otherwise) and who touches them:
//   buffer            format                 written by             read by
//   positions         vec4 x y z 1/mass      contact, stage 4       stage 1, contact, normals, statistics, drawing
//   velocities        vec4, w: touches       contact, stage 4       stage 1, statistics
//   stage A, stage B  vec4 x and v each      stages 1-4             stages 2-4, contact
//   sums              vec4 x and v each      stages 1-3             stages 2-4
//   normals           vec4                   normals                drawing
//   cloths, chunks    ClothRecord, Chunk     upload                 all
//   colliders, nodes, triangles              upload                 contact, statistics
//   partials, result  StatisticsRecord       statistics             the host (result)
#pragma once

#include "cloth/descriptions.hpp"
#include "cloth/statistics.hpp"

#include "gpu/context.hpp"
#include "gpu/recorder.hpp"

#include <memory>
#include <vector>

namespace cloth
{

// What the host must switch on when it makes its device.
struct Requirements
{
    uint32_t api_version = VK_API_VERSION_1_2;
    std::vector<const char*> device_extensions; // VK_KHR_synchronization2
    bool synchronization2 = true;               // VkPhysicalDeviceSynchronization2FeaturesKHR
};
Requirements requirements();

enum class ContactMethod
{
    normal_ray,    // a ray along the vertex normal and its opposite, the nearest hit
    nearest_point, // the nearest point of the mesh
};

struct SolverOptions
{
    uint32_t workgroup_size = 128; // power of two, 1 to the device's limit
    uint32_t statistics_slots = 2; // frames in flight whose statistics can be waited for, 1..16
    ContactMethod contact_method = ContactMethod::nearest_point; // how the surface within the thickness is found
};

// One call of record: `substeps` RK4 steps of duration / substeps each.
struct Step
{
    float duration = 1.f / 60;       // s, > 0
    uint32_t substeps = 0;           // 0: stable_substeps(duration)
    glm::vec3 gravity{0, -9.81f, 0}; // m/s^2
    glm::vec3 wind{0.f};             // m/s
    float air_density = 1.225f;      // kg/m^3
};

// Staging memory and the buffers that an upload replaced. Destroy it once the command buffer has completed.
class Upload
{
public:
    Upload();
    ~Upload();
    Upload(Upload&&) noexcept;
    Upload& operator=(Upload&&) noexcept;

private:
    friend class Solver;
    struct Contents;
    std::unique_ptr<Contents> contents_;
};

// Where a cloth's vertices lie in the solver's buffers. Valid until the next record_upload that follows an addition.
struct VertexStreams
{
    VkBuffer positions = VK_NULL_HANDLE;  // vec4: x y z (m) and inverse mass (1/kg)
    VkBuffer velocities = VK_NULL_HANDLE; // vec4: x y z (m/s) and 1 where the vertex touches a collider
    VkBuffer normals = VK_NULL_HANDLE;    // vec4: unit normal and 0
    VkDeviceSize offset = 0;              // bytes, of the first vertex, in each of them
    uint32_t vertices = 0;
};

class Solver
{
public:
    // Compiles the kernels. Errors: null handles, a device without what requirements() lists, options out of range.
    static Result<Solver> create(const gpu::Handles& handles, const SolverOptions& options);
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    // Copy and validate; nothing changes on the GPU before record_upload. Errors name the input and the value: a grid
    // smaller than 2 x 2, a material out of range, a held vertex that does not exist, a coordinate that is not finite,
    // an index beyond the positions, a mesh without a triangle that has area, more than the device's buffers hold.
    Result<ClothId> add_cloth(const Grid& grid);
    Result<ColliderId> add_collider(const MeshCollider& collider);
    Result<ColliderId> add_collider(const PlaneCollider& collider);
    Result<ColliderId> add_collider(const SphereCollider& collider);

    // True if something was added since the last upload.
    [[nodiscard]] bool needs_upload() const;

    // Allocates buffers for everything added, records their upload, and copies over the state of the cloths that were
    // there before. Begins and ends like record. Errors: out of device memory, larger than the device's buffers; the
    // solver then stays as it was.
    Result<Upload> record_upload(VkCommandBuffer cmd);

    // Records the passes of one step. Never allocates, submits, waits or reads a clock. Outside rendering.
    // Begins: earlier reads of the vertex streams by vertex input, and transfers, are waited for here; earlier uploads
    // too. Ends: writes are visible to vertex input, compute and transfer reads that follow. Nothing is recorded before
    // the first record_upload, or without cloths.
    void record(VkCommandBuffer cmd, const Step& step, gpu::Timestamps* timestamps = nullptr) const;
    void record(gpu::Recorder& recorder, const Step& step) const;

    // Records the reduction of the statistics into `slot`, to be read once the submission has completed.
    void record_statistics(VkCommandBuffer cmd, uint32_t slot, gpu::Timestamps* timestamps = nullptr) const;
    [[nodiscard]] Statistics statistics(uint32_t slot) const;

    // The fewest substeps with which RK4 is stable for every cloth added, with a margin of 10 %. From the row sums of
    // M^-1 K and M^-1 C (Gershgorin 1931): omega^2 <= max 2 sum k / m with omega h <= 2.83, and max 2 sum c / m * h
    // <= 2.78.
    [[nodiscard]] uint32_t stable_substeps(float duration) const;

    [[nodiscard]] VertexStreams vertices(ClothId cloth) const;
    // Triangles of a cloth as the normals see them, indices within the cloth; counter-clockwise seen from +y when flat.
    [[nodiscard]] std::vector<glm::uvec3> triangles(ClothId cloth) const;
    // One a vertex: column / (columns - 1), row / (rows - 1), scaled to metres of fabric.
    [[nodiscard]] std::vector<glm::vec2> texture_coordinates(ClothId cloth) const;
    [[nodiscard]] const std::string& name(ClothId cloth) const;

    [[nodiscard]] const gpu::Context& context() const;
    [[nodiscard]] uint32_t vertex_count() const;               // of all cloths
    [[nodiscard]] uint32_t triangle_count() const;             // of all cloths
    [[nodiscard]] uint32_t dispatches(const Step& step) const; // that record makes

private:
    struct State;
    explicit Solver(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace cloth
