// Cloths and their lists, with offsets in the solver's buffers.
#include "solver/staged_cloths.hpp"

#include "solver/device_state.hpp"

#include "shared/contact_layout.h"
#include "shared/sleep_layout.h"

#include <vector>

namespace voile
{

namespace
{

void stage_cloth(Staging& staging, const ClothModel& cloth, uint32_t index, const OutputOptions& output)
{
    const uint32_t first = cloth.record.first_vertex;
    staging.add(buffer::start, first, cloth.start);
    staging.add(buffer::start_residuals, first, cloth.residuals);
    staging.add(buffer::positions, first, cloth.positions);
    staging.add(buffer::residuals, first, cloth.residuals);
    staging.add(buffer::velocities, first, cloth.velocities);
    staging.add_copy(buffer::normals, first, std::vector<glm::vec4>(cloth.record.vertices, glm::vec4(0, 1, 0, 0)));
    if (output.previous_positions)
        staging.add(buffer::previous_positions, first, cloth.positions);
    if (output.indices)
        staging.add_copy(buffer::indices, cloth.first_triangle, cloth_triangles(cloth));
    staging.add_copy(buffer::cloths, index, std::vector{cloth.record});
    staging.add_copy(buffer::limit_scales, index, std::vector{k_first_scale});
    shared::SleepRecord awake{};
    awake.island = index;
    staging.add_copy(buffer::sleeps, index, std::vector{awake});
    std::vector<uint32_t> votes(VOILE_VOTE_WORDS);
    votes[VOILE_VOTE_BEGAN] = 1;
    for (const buffer::Name name : k_depenetration_votes)
        staging.add_copy(name, index * uint64_t{VOILE_VOTE_WORDS}, votes);
}

// The lists of a mesh. Vertices count theirs from the first entries of all meshes.
void stage_lists(Staging& staging, const SharedRanges<MeshLists, k_list_arrays>::Placement& placement)
{
    const MeshLists& lists = *placement.owner;
    std::vector<shared::MeshVertex> vertices(lists.vertices.begin(), lists.vertices.end());
    for (shared::MeshVertex& vertex : vertices)
    {
        vertex.first_spring += static_cast<uint32_t>(placement.first[k_list_springs]);
        vertex.first_corner += static_cast<uint32_t>(placement.first[k_list_corners]);
    }
    staging.add_copy(buffer::mesh_vertices, placement.first[k_list_vertices], vertices);
    staging.add(buffer::mesh_springs, placement.first[k_list_springs], lists.springs);
    staging.add(buffer::mesh_corners, placement.first[k_list_corners], lists.corners);
    staging.add(buffer::membrane_corners, placement.first[k_list_corners], lists.membrane);
}

// The fans of a mesh. Vertices count theirs from the first entries of all meshes.
void stage_fans(Staging& staging, const SharedRanges<MeshFans, k_fan_arrays>::Placement& placement)
{
    const MeshFans& fans = *placement.owner;
    std::vector<shared::MeshFan> vertices(fans.vertices.begin(), fans.vertices.end());
    for (shared::MeshFan& fan : vertices)
    {
        fan.first_wedge += static_cast<uint32_t>(placement.first[k_fan_wedges]);
        fan.first_owner += static_cast<uint32_t>(placement.first[k_fan_owners]);
    }
    staging.add_copy(buffer::mesh_fans, placement.first[k_fan_vertices], vertices);
    staging.add(buffer::mesh_wedges, placement.first[k_fan_wedges], fans.wedges);
    staging.add(buffer::mesh_owners, placement.first[k_fan_owners], fans.owners);
}

// The levels of the strain limit on a cloth. Vertices and levels count theirs from the first entries of all cloths.
void stage_limit_levels(Staging& staging, const SharedRanges<LimitLevels, k_limit_arrays>::Placement& placement)
{
    const LimitLevels& listed = *placement.owner;
    std::vector<shared::LimitVertex> vertices(listed.vertices.begin(), listed.vertices.end());
    vertices.insert(vertices.end(), listed.wide.begin(), listed.wide.end());
    for (shared::LimitVertex& vertex : vertices)
    {
        vertex.first_level += static_cast<uint32_t>(placement.first[k_limit_levels]);
        vertex.first_parent += static_cast<uint32_t>(placement.first[k_limit_parents]);
    }
    std::vector<shared::LimitLevel> levels(listed.levels.begin(), listed.levels.end());
    for (shared::LimitLevel& level : levels)
        level.first_link += static_cast<uint32_t>(placement.first[k_limit_links]);
    staging.add_copy(buffer::limit_vertices, placement.first[k_limit_vertices], vertices);
    staging.add_copy(buffer::limit_levels, placement.first[k_limit_levels], levels);
    staging.add(buffer::limit_links, placement.first[k_limit_links], listed.links);
    staging.add(buffer::limit_parents, placement.first[k_limit_parents], listed.parents);
}

// The order of all cloths that collide with themselves, one after the other.
std::vector<glm::uvec2> pair_order(const Model& model)
{
    std::vector<glm::uvec2> order;
    for (const auto [index, cloth] : model.cloths)
        for (const uint32_t vertex : cloth.pair_order)
            order.emplace_back(cloth.record.first_vertex + vertex, index);
    return order;
}

} // namespace

void stage_cloths(Staging& staging, const Model& model, const OutputOptions& output)
{
    for (const auto [index, cloth] : model.cloths)
        if (!cloth.uploaded)
            stage_cloth(staging, cloth, index, output);
    staging.add_copy(buffer::pair_order, 0, pair_order(model));
    model.lists.for_each_new([&](const auto& placement) { stage_lists(staging, placement); });
    model.fans.for_each_new([&](const auto& placement) { stage_fans(staging, placement); });
    model.limit_levels.for_each_new([&](const auto& placement) { stage_limit_levels(staging, placement); });
    model.trees.for_each_new([&](const auto& placement)
                             { staging.add(buffer::cloth_leaves, placement.first[0], placement.owner->leaves); });
}

} // namespace voile
