// Model: the host's copy of the cloths that were added to a solver, in the layout that is uploaded.
#pragma once

#include "model/cloth_model.hpp"
#include "model/device_limits.hpp"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"

#include <span>
#include <vector>

namespace voile
{

// All cloths of a solver, and the anchors of their attachments. Each cloth owns its arrays; an upload puts them
// together.
struct Model
{
    std::vector<ClothModel> cloths;
    std::vector<glm::mat4> anchors{glm::mat4(1)}; // where they were when they were added; the first is the world
    uint32_t vertices = 0;                        // of all cloths
    uint32_t mesh_vertices = 0;                   // of the meshes among them
    uint64_t patches = 0;                         // workgroups over all cloths, see make_patches
    bool interleaved = true;                      // lists of meshes: SolverOptions::mesh_layout
    DeviceLimits limits;

    // Append after validating; unchanged on error.
    Result<ClothId> add(const GridCloth& grid);
    Result<ClothId> add(const MeshCloth& cloth);

private:
    // A mesh's lists as this solver uploads them; instances share them.
    [[nodiscard]] std::shared_ptr<const MeshLists>
    uploaded_lists(const std::shared_ptr<const MeshTopology>& mesh) const;
    Result<ClothId> append(ClothModel cloth, const ClothInput& input, std::span<const glm::dvec3> places);
};

// The attachments of all cloths as records, pins first, and the tethers.
struct AttachmentLists
{
    std::vector<shared::AttachmentRecord> attachments;
    uint32_t pins = 0; // the first ones
    std::vector<shared::TetherRecord> tethers;
};
AttachmentLists make_attachment_lists(const Model& model);

// Errors: an anchor that add_anchor did not give.
Result<void> check_anchor(const Model& model, AnchorId anchor);

// Errors: a vertex that does not exist or has two attachments, an anchor that does not exist, values out of range.
Result<void> validate_attachments(const Model& model, uint32_t cloth, std::span<const Attachment> attachments);

// The tethers of a cloth by its present pins. Errors: no pin, a value out of range, no vertex that could be tethered.
Result<std::vector<shared::TetherRecord>> make_tethers(const Model& model, uint32_t cloth, const Tethers& tethers);

// The patches that cover all cloths with workgroups of `workgroup_size` vertices, none across two cloths. Those of
// cloths that use RK4 come first.
struct Patches
{
    std::vector<shared::Patch> patches;
    uint32_t rk4 = 0; // how many
};
Patches make_patches(const Model& model, uint32_t workgroup_size);

// How many of them a grid or a mesh has.
uint64_t count_grid_patches(uint32_t columns, uint32_t rows, uint32_t workgroup_size);
uint64_t count_mesh_patches(uint64_t vertices, uint32_t workgroup_size);

} // namespace voile
