#include "model/cloth_trees.hpp"

#include <algorithm>
#include <vector>

namespace voile
{

namespace
{

// A grid lies flat, with its vertices at whole numbers, so that grids of one size share a tree.
PaddedTree make_grid_tree(const ClothModel& cloth)
{
    std::vector<glm::vec3> flat;
    flat.reserve(cloth.record.vertices);
    for (uint32_t row = 0; row < cloth.record.rows; ++row)
        for (uint32_t column = 0; column < cloth.record.columns; ++column)
            flat.emplace_back(column, row, 0);
    return build_padded_tree(flat, cloth_triangles(cloth), PaddedSplit::widest);
}

PaddedTree make_mesh_tree(const ClothModel& cloth, std::span<const glm::dvec3> positions)
{
    return build_padded_tree(std::vector<glm::vec3>(positions.begin(), positions.end()), cloth_triangles(cloth));
}

uint64_t boxes_of(uint64_t leaves)
{
    return 2 * leaves - 1 + k_box_alignment;
}

} // namespace

std::shared_ptr<const PaddedTree> ClothTrees::tree_of(const ClothModel& cloth, std::span<const glm::dvec3> positions)
{
    std::weak_ptr<const PaddedTree>& kept = trees_[{cloth.mesh.get(), {cloth.record.columns, cloth.record.rows}}];
    if (auto made = kept.lock())
        return made;
    std::erase_if(trees_, [&](const auto& entry) { return &entry.second != &kept && entry.second.expired(); });
    auto made =
        std::make_shared<const PaddedTree>(cloth.mesh ? make_mesh_tree(cloth, positions) : make_grid_tree(cloth));
    kept = made;
    return made;
}

Result<void> ClothTrees::add(ClothModel& cloth, std::span<const glm::dvec3> positions, const DeviceLimits& limits)
{
    const uint64_t triangles = count_triangles(cloth);
    const uint64_t leaves = uint64_t{1} << padded_levels(static_cast<uint32_t>(triangles));
    const uint64_t bytes = std::max(boxes_.end_with(boxes_of(leaves)) * sizeof(shared::PaddedBox),
                                    leaves_.end_with(0, leaves) * sizeof(shared::PaddedLeaf));
    if (auto room = check_room(limits, "cloth", cloth.name,
                               "the hierarchy of " + std::to_string(triangles) + " triangles", bytes);
        !room)
        return room;
    cloth.tree = tree_of(cloth, positions);
    leaves_.acquire(cloth.tree, {cloth.tree->leaves.size()});
    cloth.first_boxes = boxes_.allocate(boxes_of(cloth.tree->leaves.size()));
    return {};
}

void ClothTrees::remove(const ClothModel& cloth)
{
    if (!cloth.tree)
        return;
    leaves_.release(cloth.tree.get());
    boxes_.release(cloth.first_boxes, boxes_of(cloth.tree->leaves.size()));
}

shared::TreeRecord ClothTrees::record(const ClothModel& cloth, uint32_t index) const
{
    shared::TreeRecord tree{};
    tree.first_box = aligned_first_box(static_cast<uint32_t>(cloth.first_boxes));
    tree.first_leaf = static_cast<uint32_t>(leaves_.find(cloth.tree.get())->first[0]);
    tree.first_from = tree.first_to = cloth.record.first_vertex;
    tree.triangles = cloth.tree->triangles;
    tree.cloth = index;
    return tree;
}

} // namespace voile
