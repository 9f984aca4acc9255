// Model: adding and removing cloths, and validation for all kinds of cloth.
#include "model/model.hpp"

#include "model/pair_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace voile
{

static_assert(k_most_coordinate == static_cast<float>(VOILE_MOST_COORDINATE));
static_assert(k_most_speed == static_cast<float>(VOILE_MOST_SPEED));

Result<void> check_room(const DeviceLimits& limits, const std::string& what, const std::string& name,
                        const std::string& contents, uint64_t bytes)
{
    if (bytes <= limits.max_buffer_bytes)
        return {};
    const uint64_t needed = (bytes + (1u << 20) - 1) >> 20;
    return invalid(what, name,
                   contents + " need buffers of " + std::to_string(needed) + " MiB, the device binds at most " +
                       std::to_string(limits.max_buffer_bytes >> 20) + " MiB");
}

Result<void> check_world_positions(const std::string& cloth, std::span<const glm::dvec3> world)
{
    const std::vector<glm::vec3> rounded(world.begin(), world.end());
    return check_positions(subject("cloth", cloth), rounded, "its transform takes vertex ", " to ");
}

glm::dmat4 without_rounding(const glm::mat4& transform)
{
    constexpr double k_rounding = 1e-6;
    glm::dmat3 m(transform);
    const glm::dmat3 strain = glm::transpose(m) * m - glm::dmat3(1);
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(strain[column][row]));
    if (!(largest < k_rounding))
        return glm::dmat4(transform);
    m = 0.5 *
        (m + glm::inverse(glm::transpose(m))); // Newton's iteration for the polar factor (Higham 1986); 1e-13 left
    glm::dmat4 result(m);
    result[3] = glm::dvec4(transform[3]);
    return result;
}

Result<void> check_dispatch(const DeviceLimits& limits, const std::string& what, const std::string& name,
                            const std::string& contents, uint64_t workgroups)
{
    if (workgroups <= limits.max_workgroups)
        return {};
    return invalid(what, name,
                   contents + " " + std::to_string(workgroups) + " workgroups of " +
                       std::to_string(limits.workgroup_size) + ", the device dispatches at most " +
                       std::to_string(limits.max_workgroups) + "; a larger Tuning::workgroup_size needs fewer");
}

Result<ClothId> Model::append(ClothModel cloth, const ClothInput& input, std::span<const glm::dvec3> world_positions)
{
    if (vertices.end_with(world_positions.size()) > UINT32_MAX / 2)
        return invalid("cloth", cloth.name, "more than 2 147 483 647 vertices in one solver");
    shared::ClothRecord& record = cloth.record;
    record.vertices = static_cast<uint32_t>(world_positions.size());
    if (has_trees || (untangles && cloth.self_collision))
        if (auto added = trees.add(cloth, world_positions, limits); !added)
            return added.error();
    record.first_vertex = static_cast<uint32_t>(vertices.allocate(world_positions.size()));
    if (cloth.lists)
    {
        const MeshLists& mesh = *cloth.lists;
        const auto& placement =
            lists.acquire(cloth.lists, {mesh.vertices.size(), mesh.springs.size(), mesh.corners.size()});
        record.first_list = static_cast<uint32_t>(placement.first[k_list_vertices]);
    }
    if (cloth.fans)
    {
        const MeshFans& mesh = *cloth.fans;
        const auto& placement =
            fans.acquire(cloth.fans, {mesh.vertices.size(), mesh.wedges.size(), mesh.owners.size()});
        record.first_fan = static_cast<uint32_t>(placement.first[k_fan_vertices]);
    }
    if (indices)
        cloth.first_triangle = triangles.allocate(count_triangles(cloth));
    record.sleep_speed = input.sleep_speed;
    record.first_limit = VOILE_NO_LIMIT_LEVELS;
    apply_material(cloth);
    set_start(cloth, input, world_positions);
    if (cloth.self_collision)
        cloth.pair_order = make_pair_order(cloth.start);
    patches += count_patches(record, limits.workgroup_size);
    return cloths.add(std::move(cloth));
}

void Model::remove(ClothId id)
{
    const ClothModel& cloth = *cloths.find(id);
    vertices.release(cloth.record.first_vertex, cloth.record.vertices);
    lists.release(cloth.lists.get());
    fans.release(cloth.fans.get());
    limit_levels.release(cloth.limit_levels.get());
    trees.remove(cloth);
    if (indices)
        triangles.release(cloth.first_triangle, count_triangles(cloth));
    patches -= count_patches(cloth.record, limits.workgroup_size);
    cloths.remove(id);
}

namespace
{

// What the levels of a cloth depend on: instances have the same.
struct LimitShape
{
    const MeshTopology* mesh;
    uint32_t columns;
    uint32_t rows;
    float spacing_x; // m
    float spacing_y;
    std::array<bool, VOILE_SPRING_CLASSES> springs; // that it has
    std::vector<float> inverse_masses;              // of the vertices, if the host gave them
    std::vector<uint32_t> pins;

    auto operator<=>(const LimitShape&) const = default;
};

LimitShape limit_shape(const ClothModel& cloth)
{
    LimitShape shape{
        cloth.mesh.get(),      cloth.record.columns, cloth.record.rows, cloth.spacing.x, cloth.spacing.y, {}, {},
        pinned_vertices(cloth)};
    for (size_t i = 0; i < shape.springs.size(); ++i)
        shape.springs[i] = cloth.record.springs[i].stiffness > 0;
    if (cloth.own_inverse_mass > 0)
        for (const glm::vec4& start : cloth.start)
            shape.inverse_masses.push_back(start.w);
    return shape;
}

} // namespace

void Model::list_limit_levels()
{
    std::map<LimitShape, std::shared_ptr<const LimitLevels>> made;
    for (auto [index, cloth] : cloths)
    {
        if (cloth.uploaded || cloth.limit_levels || !needs_limit_levels(cloth))
            continue;
        std::shared_ptr<const LimitLevels>& levels = made[limit_shape(cloth)];
        if (!levels)
            levels = std::make_shared<const LimitLevels>(make_limit_levels(cloth));
        cloth.limit_levels = levels;
        const auto& placement =
            limit_levels.acquire(levels, {levels->vertices.size() + levels->wide.size(), levels->levels.size(),
                                          levels->links.size(), levels->parents.size()});
        cloth.record.first_limit = static_cast<uint32_t>(placement.first[k_limit_vertices]);
        set_strain_spacing(cloth);
    }
}

} // namespace voile
