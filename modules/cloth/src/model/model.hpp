// Model: the cloths and anchors of a solver on the host, in the layout that is uploaded.
#pragma once

#include "model/cloth_model.hpp"
#include "model/cloth_trees.hpp"
#include "model/device_limits.hpp"
#include "model/range_allocator.hpp"
#include "model/shared_ranges.hpp"
#include "model/slots.hpp"

#include <span>
#include <unordered_map>
#include <vector>

namespace voile
{

// A frame that the host moves.
struct Anchor
{
    glm::mat4 added{1.f}; // world from anchor, when it was added
    glm::mat4 from{1.f};  // at the end of the last step
    glm::mat4 to{1.f};    // at the end of the next one
    bool jumped = false;  // to where it is
};

// Without moving there. Of an anchor or the pose of a collider.
template <typename Pose>
void jump(Pose& pose)
{
    pose.from = pose.to;
    pose.jumped = true;
}

// The arrays of MeshLists that have ranges of their own; corners and membrane corners share one.
enum ListArray : size_t
{
    k_list_vertices,
    k_list_springs,
    k_list_corners,
    k_list_arrays
};

// Those of MeshFans.
enum FanArray : size_t
{
    k_fan_vertices,
    k_fan_wedges,
    k_fan_owners,
    k_fan_arrays
};

// Those of LimitLevels.
enum LimitArray : size_t
{
    k_limit_vertices,
    k_limit_levels,
    k_limit_links,
    k_limit_parents,
    k_limit_arrays
};

// All cloths of a solver, and the anchors of their attachments. Each cloth owns its arrays, and ranges of the solver's
// buffers for them.
struct Model
{
    Slots<ClothId, ClothModel> cloths;
    Slots<AnchorId, Anchor> anchors; // the first is the world
    RangeAllocator vertices;
    SharedRanges<MeshLists, k_list_arrays> lists;
    SharedRanges<MeshFans, k_fan_arrays> fans;
    SharedRanges<LimitLevels, k_limit_arrays> limit_levels;
    RangeAllocator triangles; // of cloths, in the index buffer
    bool indices = false;     // there is one: OutputOptions::indices
    ClothTrees trees;
    bool has_trees = false;  // of all cloths: SolverOptions::intersections
    bool untangles = true;   // cloths that collide with themselves have trees: SolverOptions::untangling
    uint64_t patches = 0;    // workgroups over all cloths, of workgroup_size vertices
    bool interleaved = true; // lists of meshes: SolverOptions::mesh_layout
    DeviceLimits limits;

    Model() { anchors.add(Anchor{}); }

    // Validate and add; unchanged on error.
    Result<ClothId> add(const GridCloth& grid);
    Result<ClothId> add(const MeshCloth& cloth);
    // Requires that the cloth exists.
    void remove(ClothId cloth);

    // Lists the levels of the strain limit on cloths that are not uploaded yet, if they need lists. Instances with the
    // same pins and masses share them.
    void list_limit_levels();

private:
    // A mesh's lists and fans as this solver uploads them; instances share them.
    std::shared_ptr<const MeshLists> uploaded_lists(const std::shared_ptr<const MeshTopology>& mesh);
    std::shared_ptr<const MeshFans> uploaded_fans(const std::shared_ptr<const MeshTopology>& mesh);
    Result<ClothId> append(ClothModel cloth, const ClothInput& input, std::span<const glm::dvec3> world_positions);

    std::unordered_map<const MeshTopology*, std::weak_ptr<const MeshLists>> lists_of_;
    std::unordered_map<const MeshTopology*, std::weak_ptr<const MeshFans>> fans_of_;
};

// Errors: an anchor that add_anchor did not give.
Result<void> check_anchor(const Model& model, AnchorId anchor);

// Errors: a vertex that does not exist or has two attachments, an anchor that does not exist, values out of range.
Result<void> validate_attachments(const Model& model, const ClothModel& cloth, std::span<const Attachment> attachments);

// Whether a vertex of the cloth is pinned.
bool has_pin(const ClothModel& cloth);

// The tethers of a cloth to its present pins, none without a pin; `index`: its slot. Errors: a value out of range.
Result<std::vector<shared::TetherRecord>> make_tethers(const ClothModel& cloth, uint32_t index, const Tethers& tethers);

// How many patches a grid or a mesh has: workgroups of `workgroup_size` vertices, none across two cloths.
uint64_t count_grid_patches(uint32_t columns, uint32_t rows, uint32_t workgroup_size);
uint64_t count_mesh_patches(uint64_t vertices, uint32_t workgroup_size);
uint64_t count_patches(const shared::ClothRecord& cloth, uint32_t workgroup_size);

} // namespace voile
