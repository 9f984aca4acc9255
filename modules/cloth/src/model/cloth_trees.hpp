// The hierarchies of cloths: leaves that instances share, and a range of boxes per cloth.
#pragma once

#include "geometry/padded_tree.hpp"
#include "model/cloth_model.hpp"
#include "model/device_limits.hpp"
#include "model/shared_ranges.hpp"

#include <map>
#include <memory>
#include <span>
#include <utility>

namespace voile
{

class ClothTrees
{
public:
    // Makes the tree of a cloth, or shares that of another instance of its mesh or of a grid of the same size, and its
    // ranges. Errors: more boxes than the device can bind.
    Result<void> add(ClothModel& cloth, std::span<const glm::dvec3> positions, const DeviceLimits& limits);
    void remove(const ClothModel& cloth);

    // The cloth's tree in the solver's buffers. Requires add. `index`: of the cloth.
    [[nodiscard]] shared::TreeRecord record(const ClothModel& cloth, uint32_t index) const;

    // Entries that the buffers need.
    [[nodiscard]] uint64_t leaves() const { return leaves_.end(0); }
    [[nodiscard]] uint64_t boxes() const { return boxes_.end(); }

    template <typename Use>
    void for_each_new(const Use& use) const
    {
        leaves_.for_each_new(use);
    }
    void mark_uploaded() { leaves_.mark_uploaded(); }

private:
    using Shape = std::pair<const MeshTopology*, std::pair<uint32_t, uint32_t>>; // a mesh, or a grid of that size
    std::shared_ptr<const PaddedTree> tree_of(const ClothModel& cloth, std::span<const glm::dvec3> positions);

    SharedRanges<PaddedTree, 1> leaves_;
    RangeAllocator boxes_;
    std::map<Shape, std::weak_ptr<const PaddedTree>> trees_; // who holds a mesh's tree holds the mesh
};

} // namespace voile
