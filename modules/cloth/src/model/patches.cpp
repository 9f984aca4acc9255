// What each workgroup works on: tiles of grids, runs of a mesh's vertices; and the trees of cloths.
#include "model/active_lists.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace voile
{

namespace
{

// How many columns of a grid a workgroup works on, unless it or the grid is smaller; bench/NOTES.md has others.
constexpr uint32_t k_tile_width = 32;

uint32_t tile_width(uint32_t columns, uint32_t workgroup_size)
{
    return std::min(std::bit_ceil(std::min(columns, k_tile_width)), workgroup_size);
}

void add_tiles(const shared::ClothRecord& record, uint32_t cloth, uint32_t workgroup_size,
               std::vector<shared::Patch>& patches)
{
    const uint32_t width = tile_width(record.columns, workgroup_size);
    const uint32_t height = workgroup_size / width;
    for (uint32_t row = 0; row < record.rows; row += height)
        for (uint32_t column = 0; column < record.columns; column += width)
            patches.push_back({cloth, record.first_vertex, record.columns, record.rows, column, row,
                               static_cast<uint32_t>(std::countr_zero(width)), 0});
}

void add_patches(const ClothModel& cloth, uint32_t index, uint32_t workgroup_size, std::vector<shared::Patch>& patches)
{
    const shared::ClothRecord& record = cloth.record;
    if (record.columns > 0)
        return add_tiles(record, index, workgroup_size, patches);
    for (uint32_t first = 0; first < record.vertices; first += workgroup_size)
        patches.push_back({index, record.first_vertex, 0, record.vertices, first, 0, 0, 0});
}

} // namespace

uint64_t count_grid_patches(uint32_t columns, uint32_t rows, uint32_t workgroup_size)
{
    const uint64_t width = tile_width(columns, workgroup_size);
    const uint64_t height = workgroup_size / width;
    return (columns + width - 1) / width * ((rows + height - 1) / height);
}

uint64_t count_patches(const shared::ClothRecord& cloth, uint32_t workgroup_size)
{
    return cloth.columns > 0 ? count_grid_patches(cloth.columns, cloth.rows, workgroup_size)
                             : count_mesh_patches(cloth.vertices, workgroup_size);
}

uint64_t count_mesh_patches(uint64_t vertices, uint32_t workgroup_size)
{
    return (vertices + workgroup_size - 1) / workgroup_size;
}

void list_trees(const Model& model, ActiveLists& lists)
{
    lists.trees.clear();
    lists.tree_counts = {};
    for (const auto [index, cloth] : model.cloths)
        if (is_active(cloth) && cloth.tree)
        {
            lists.trees.push_back(model.trees.record(cloth, index));
            ++lists.tree_counts[cloth.tree->levels];
        }
    std::ranges::sort(lists.trees, {},
                      [](const shared::TreeRecord& tree)
                      { return std::pair(padded_levels(tree.triangles), tree.cloth); });
}

void list_patches(const Model& model, const LevelOf& level_of, uint32_t workgroup_size, ActiveLists& lists)
{
    lists.patches.clear();
    for (uint32_t i = 0; i < VOILE_SUBSTEP_BATCHES; ++i)
    {
        EntryRange& patches = lists.batches[i].patches;
        lists.batches[i].meshes = false;
        patches.first = lists.patch_count();
        for (const auto [index, cloth] : model.cloths)
            if (is_in_batch(cloth, batch_at(i), level_of))
            {
                add_patches(cloth, index, workgroup_size, lists.patches);
                lists.batches[i].meshes |= cloth.record.columns == 0;
            }
        patches.count = lists.patch_count() - patches.first;
    }
}

} // namespace voile
