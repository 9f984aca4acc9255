// SolverOptions: what a Solver is created with.
#pragma once

#include "voile/handles.hpp"
#include "voile/jobs.hpp"
#include "voile/output.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace voile
{

// How contact finds the surface of a mesh within the thickness of a cloth.
enum class ContactMethod
{
    normal_ray,    // a ray along the vertex normal and its opposite, the nearest hit
    nearest_point, // the nearest point of the mesh
};

// How the lists of mesh vertices are laid out in memory.
enum class MeshLayout
{
    compact,     // list by list
    interleaved, // the lists of a workgroup's vertices entry by entry, so that its reads coalesce
};

// Parameters of the implementation, for measurements and comparisons. Hosts keep the defaults.
struct Tuning
{
    // Invocations per workgroup. A power of two, from 1 to what the device's limits on invocations and shared memory
    // allow; each invocation takes 125 bytes of shared memory. A dispatch has at most maxComputeWorkGroupCount
    // workgroups.
    uint32_t workgroup_size = 128;

    // Invocations per vertex in feature contact. They share the triangles of the vertex. A power of two up to
    // workgroup_size. 0: eight, or one on CPU devices.
    uint32_t feature_threads = 0;

    // Invocations per vertex when features near the cloth are listed. They share its triangles and edges, and its
    // contacts are merged in another order. A power of two up to workgroup_size. 0: eight, or on CPU devices
    // two, and four from 2,048 features of all colliders on.
    uint32_t listing_threads = 0;

    // The room for features near the cloth, as a mean number per vertex, at most 128, 112 bytes each. None: 8 per
    // vertex and 65,536 more in total, but no more than 128 per vertex. If the room does not suffice, features are
    // listed again for a shorter time or for fewer vertices. The other vertices find their features in every substep,
    // which is slower and merges contacts in another order. Two equal runs are bit-identical.
    std::optional<uint32_t> feature_items{};

    // Up to this number of vertices in the cloths that take the same substeps with one integrator, four invocations
    // share the forces of a mesh's vertex. More vertices keep a GPU busy with one each. Results are equal to the bit,
    // whatever the number. 0: 20,000, or none on CPU devices, which sum up forces in another order then. None also
    // where workgroups have less than four times workgroup_size invocations, or shared memory less than 128 bytes times
    // that.
    uint32_t sharing_vertices = 0;

    // The cost of a substep's dispatches without any vertices, as the number of vertices whose substep takes as long.
    // Cloths that need fewer substeps than others get their own dispatches if these cost less than the substeps that
    // they save. 0: 100,000, or 256 on CPU devices.
    uint32_t dispatch_vertices = 0;

    // The most near pairs that a vertex lists for the primitives that it owns, if its cloth collides with itself,
    // 1..32. A vertex with more near pairs keeps the nearest, and its moves from one search to the next are limited to
    // shorter ones.
    uint32_t pair_capacity = 32;

    // From this number of vertices with self-collision on, a separate pass sifts candidates before each search for near
    // pairs, for vertices that have few. Results are equal. 0: 32,768, or no sifting on CPU devices.
    uint32_t sifting_vertices = 0;

    // A search for near pairs is for all cloths with self_collision. It is due when so many vertices want one because
    // their moves are used up (pair_capacity), or after four passes of contact between cloths if fewer do; these stay
    // where they are meanwhile. While any collider or anchor moves none waits, nor does what is fast or has no near
    // pair. 0: one in 1,024 of the vertices with self_collision, at least one. If most wait and lists are short, stacks
    // at rest keep up to three times the energy, and cloths that hit each other lose up to 8 % more of their momentum.
    uint32_t waiting_vertices = 0;

    // s. Two Verlet substeps within this time share one query for contact with colliders. Between two queries a vertex
    // stays above the plane of the surface that it last touched, with friction. 0: a query in every substep. RK4,
    // normal_ray, and cloths whose near pairs are resolved in every substep always query in every substep.
    float contact_interval = 0.5e-3f;

    ContactMethod contact_method = ContactMethod::nearest_point;
    MeshLayout mesh_layout = MeshLayout::interleaved;
};

// SPIR-V that replaces the module's own, for work on its shaders. It must keep the file's bindings, push constants,
// specialization constants and structs.
struct ShaderReplacement
{
    std::string_view file;           // of shaders/cloth, without folders: "contact.comp"
    std::span<const uint32_t> spirv; // read during Solver::create
};

// Steps with the same passes reuse the same commands, so recording takes the host a few microseconds. The solver keeps
// the commands in secondary command buffers. Results are bit-identical.
//
// The passes stay the same when gravity, wind, time, motions or vertices of deforming meshes change. They change when
// cloths or colliders come, go or move for the first time, when the number of substeps changes, when gusts begin or
// end, and when buffers grow. Materials and durations change them if they lead to a different number of substeps or
// different intervals between queries. After a change, commands are reused from the third step of each command buffer
// on.
//
// record then
// - takes primary command buffers of the queue family, with no query and no conditional rendering active. Submit each
//   at most once: later calls of record invalidate it;
// - allocates when passes change.
// Steps with timestamps, and steps through a Recorder with a split, are each recorded anew.
struct CommandReuse
{
    uint32_t queue_family = 0; // of the command buffers that record takes

    // How many calls of record may be in flight, 1..16. With two frames in flight, that is two for one call per frame
    // and four for two calls per frame. The current call counts: when record is called for step n, the command buffer
    // of step n - steps_in_flight has completed, or is never submitted. With lifetime_checks, record returns an error
    // if the GPU still executes that command buffer; validation layers also report one that still waits in a queue.
    uint32_t steps_in_flight = 2;
};

struct SolverOptions
{
    uint32_t statistics_slots = 2; // slots for the statistics of frames in flight, 1..16

    // Corners and edges of colliders also collide with the triangles and edges of cloths (docs/contact.md). A collider
    // with features that can protrude between the vertices of a cloth costs two more passes per substep, and 176 bytes
    // of device memory per vertex and 112 per item (Tuning::feature_items).
    bool feature_contact = true;

    // Vertices that are inside a collider at the start of a step are moved out along a smooth field. Without this, they
    // are moved straight to the nearest surface, and those inside a mesh stay there.
    bool depenetration = true;

    // Cloths with self_collision that intersect each other or themselves when a step starts are pulled apart
    // (docs/self-collision.md). Costs 80 to 160 bytes of device memory per triangle of such a cloth, and a query per
    // step. Without this, the parts that intersect are held as they are.
    bool untangling = true;

    // None: vertex input reads the streams. A queue without graphics has no vertex input: on such a queue, name the
    // host's own stages, or HostScopes{} for none. Semaphores order other queues.
    std::optional<HostScopes> host_scopes{};

    // Keeps hierarchies of cloths, so that record_statistics can count intersections. Costs 80 to 160 bytes of device
    // memory per triangle of a cloth, 4 per triangle of a rigid mesh, and time when a cloth is added; steps cost the
    // same.
    bool intersections = false;

    OutputOptions output{}; // optional contents of the vertex streams
    // Destroying a Solver or an Upload while the GPU executes its commands ends the program with a line on stderr.
    // None: on if the module was compiled without NDEBUG.
    std::optional<bool> lifetime_checks{};
    std::optional<CommandReuse> command_reuse{}; // none: each step is recorded anew
    Tuning tuning{};
    Jobs jobs{}; // the host's job system, for create, add_cloth, add_collider and record_upload (voile/jobs.hpp)
    std::span<const ShaderReplacement> shaders{}; // read during Solver::create
};

} // namespace voile
