// ActiveLists: the patches, attachments and tethers that the dispatches of a step work on, ordered by level.
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

// The entries of cloths that take the same number of substeps.
struct LevelLists
{
    EntryRange patches;
    uint32_t rk4_patches = 0; // the first ones; the others use Verlet
    EntryRange attachments;   // others than pins
    EntryRange tethers;
};

// Of the active cloths, level 0 first.
struct ActiveLists
{
    std::array<LevelLists, VOILE_SUBSTEP_LEVELS> levels;
    std::vector<shared::Patch> patches;
    std::vector<shared::AttachmentRecord> attachments;
    uint32_t pins = 0;       // the first ones, of all levels
    EntryRange resting_pins; // the last ones, of cloths that are disabled
    std::vector<shared::TetherRecord> tethers;

    std::vector<shared::TreeRecord> trees; // ordered by depth; none without SolverOptions::intersections
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
inline uint32_t assigned_level(const ClothModel& cloth)
{
    return cloth.level;
}

// None allocates if the lists have the capacity.
void list_patches(const Model& model, const LevelOf& level_of, uint32_t workgroup_size, ActiveLists& lists);
void list_trees(const Model& model, ActiveLists& lists);
void list_attachments(const Model& model, const LevelOf& level_of, ActiveLists& lists);

} // namespace voile
