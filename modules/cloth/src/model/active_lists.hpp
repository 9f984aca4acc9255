// ActiveLists: the patches, attachments and tethers that the dispatches of a step work on, ordered by batch.
#pragma once

#include "geometry/padded_tree.hpp"
#include "model/model.hpp"

#include "shared/step_layout.h"

#include <array>
#include <functional>
#include <vector>

namespace voile
{

struct EntryRange
{
    uint32_t first = 0;
    uint32_t count = 0;
};

// A batch: the cloths of a level that use the same integrator. It has dispatches of its own, so that the passes of a
// cloth do not depend on others. Level 0 comes first, and within a level RK4.
struct Batch
{
    uint32_t level = 0;
    Integrator integrator = Integrator::rk4;
};
constexpr Batch batch_at(uint32_t index)
{
    return {index / 2, index % 2 == 0 ? Integrator::rk4 : Integrator::verlet};
}

// The entries of a batch.
struct BatchLists
{
    EntryRange patches;
    bool meshes = false;    // any patch is of a mesh
    EntryRange attachments; // others than pins
    EntryRange tethers;
};

// Of the active cloths.
struct ActiveLists
{
    std::array<BatchLists, VOILE_SUBSTEP_BATCHES> batches;
    std::vector<shared::Patch> patches;
    std::vector<shared::AttachmentRecord> attachments;
    uint32_t pins = 0;       // the first ones, of all levels
    EntryRange resting_pins; // the last ones, of cloths that are disabled
    std::vector<shared::TetherRecord> tethers;

    std::vector<shared::TreeRecord> trees; // of cloths that have one, ordered by depth
    TreeCounts tree_counts{};

    [[nodiscard]] uint32_t patch_count() const { return static_cast<uint32_t>(patches.size()); }
};

// Whether a cloth takes part in steps.
inline bool is_active(const ClothModel& cloth)
{
    return cloth.uploaded && cloth.enabled;
}

// Room for the anchors, and for the attachments and tethers of all cloths.
struct AttachmentCounts
{
    uint64_t anchors = 0;
    uint64_t attachments = 0;
    uint64_t tethers = 0;
};
AttachmentCounts count_attachments(const Model& model);

// The level of a cloth: the assigned one, or that of a plan.
using LevelOf = std::function<uint32_t(const ClothModel&)>;
inline bool is_in_batch(const ClothModel& cloth, const Batch& batch, const LevelOf& level_of)
{
    return is_active(cloth) && level_of(cloth) == batch.level && cloth.integrator == batch.integrator;
}
inline uint32_t assigned_level(const ClothModel& cloth)
{
    return cloth.level;
}

// None allocates if the lists have the capacity.
void list_patches(const Model& model, const LevelOf& level_of, uint32_t workgroup_size, ActiveLists& lists);
void list_trees(const Model& model, ActiveLists& lists);
void list_attachments(const Model& model, const LevelOf& level_of, ActiveLists& lists);

} // namespace voile
