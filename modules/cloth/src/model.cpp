// Model: validation of cloths and analytic colliders, and their records. Meshes are in mesh_collider.cpp.
#include "model.hpp"

#include <cmath>
#include <cstddef>

namespace cloth
{

// What std430 makes of the shared structs, checked by spirv-val on its side.
static_assert(sizeof(shared::SpringClass) == 16);
static_assert(sizeof(shared::ClothRecord) == 48 + 16 * VOILE_SPRING_CLASSES);
static_assert(offsetof(shared::ClothRecord, springs) == 48);
static_assert(sizeof(shared::Chunk) == 8);
static_assert(sizeof(shared::ColliderRecord) == 64);
static_assert(offsetof(shared::ColliderRecord, shape) == 48);
static_assert(sizeof(shared::StagePush) == 32);
static_assert(sizeof(shared::StatisticsRecord) == 32);

namespace
{

constexpr uint32_t k_largest_side = 8192; // 67 million vertices: beyond what the buffers of any device hold

Result<void> validate(const Grid& grid)
{
    const auto bad = [&](const std::string& reason) { return invalid("cloth", grid.name, reason); };
    if (grid.columns < 2 || grid.rows < 2 || grid.columns > k_largest_side || grid.rows > k_largest_side)
        return bad("a grid of " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                   " vertices; each side needs 2 to " + std::to_string(k_largest_side));
    if (!std::isfinite(grid.width) || !std::isfinite(grid.depth) || grid.width <= 0 || grid.depth <= 0)
        return bad("its size is " + std::to_string(grid.width) + " x " + std::to_string(grid.depth) +
                   " m, must be finite and > 0");
    if (!finite(grid.transform))
        return bad("its transform is not finite");
    if (!finite(grid.velocity))
        return bad("its velocity is not finite");
    if (auto material = validate(grid.material); !material)
        return bad(material.error().message);
    const uint64_t vertices = uint64_t{grid.columns} * grid.rows;
    for (const uint32_t held : grid.held)
        if (held >= vertices)
            return bad("held vertex " + std::to_string(held) + " of " + std::to_string(vertices));
    return {};
}

shared::ClothRecord make_record(const Grid& grid, uint32_t first_vertex)
{
    const float along_row = grid.width / static_cast<float>(grid.columns - 1);
    const float along_column = grid.depth / static_cast<float>(grid.rows - 1);
    const float diagonal = std::hypot(along_row, along_column);
    const Material& m = grid.material;
    const auto spring = [](const Spring& s, float rest_length) {
        return shared::SpringClass{s.stiffness, s.damping, rest_length, 0};
    };

    shared::ClothRecord record{};
    record.first_vertex = first_vertex;
    record.columns = grid.columns;
    record.rows = grid.rows;
    record.thickness = m.thickness;
    record.static_friction = m.static_friction;
    record.kinetic_friction = m.kinetic_friction;
    record.linear_drag = m.linear_drag;
    record.drag_normal = m.air_drag_normal;
    record.drag_tangential = m.air_drag_tangential;
    record.border_share = m.border_share;
    record.springs[0] = spring(m.springs.structural_warp, along_row);
    record.springs[1] = spring(m.springs.structural_weft, along_column);
    record.springs[2] = record.springs[3] = spring(m.springs.shear, diagonal);
    record.springs[4] = spring(m.springs.bend_warp, 2 * along_row);
    record.springs[5] = spring(m.springs.bend_weft, 2 * along_column);
    record.springs[6] = record.springs[7] = spring(m.springs.diagonal_bend, 2 * diagonal);
    return record;
}

// Row sums of M^-1 K and M^-1 C for a vertex with all its neighbours (Gershgorin 1931). On a border masses and springs
// shrink alike; drag a vertex does not.
StabilityBound stability_bound(const shared::ClothRecord& record, const Material& material)
{
    double stiffness = 0;
    double damping = 0;
    for (const shared::SpringClass& spring : record.springs)
    {
        stiffness += 2.0 * static_cast<double>(spring.stiffness); // a class has two springs a vertex
        damping += 2.0 * static_cast<double>(spring.damping);
    }
    const auto mass = static_cast<double>(material.vertex_mass);
    const auto share = static_cast<double>(material.border_share);
    const double drag = static_cast<double>(material.linear_drag) / (share * share); // in a corner
    return {std::sqrt(2 * stiffness / mass), (2 * damping + drag) / mass};
}

ColliderId append(std::vector<shared::ColliderRecord>& colliders, const shared::ColliderRecord& record)
{
    colliders.push_back(record);
    return {static_cast<uint32_t>(colliders.size() - 1)};
}

} // namespace

Error invalid(const std::string& what, const std::string& name, const std::string& reason)
{
    return Error{what + " \"" + name + "\": " + reason};
}

bool finite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const glm::mat4& m)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row]))
                return false;
    return true;
}

Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction)
{
    if (!friction)
        return {};
    const float s = friction->static_coefficient;
    const float k = friction->kinetic_coefficient;
    if (!std::isfinite(s) || !std::isfinite(k) || k < 0 || s < k)
        return invalid("collider", name,
                       "friction " + std::to_string(s) + " static, " + std::to_string(k) +
                           " kinetic; needs static >= kinetic >= 0");
    return {};
}

shared::ColliderRecord make_collider_record(uint32_t kind, const std::optional<Friction>& friction)
{
    shared::ColliderRecord record{};
    record.kind = kind;
    if (friction)
    {
        record.flags = VOILE_COLLIDER_FRICTION;
        record.static_friction = friction->static_coefficient;
        record.kinetic_friction = friction->kinetic_coefficient;
    }
    return record;
}

Result<ClothId> Model::add(const Grid& grid)
{
    if (auto valid = validate(grid); !valid)
        return valid.error();
    const size_t first = positions.size();
    const size_t count = size_t{grid.columns} * grid.rows;
    if (first + count > UINT32_MAX / 2)
        return invalid("cloth", grid.name, "more than 2 147 483 647 vertices in one solver");

    const shared::ClothRecord record = make_record(grid, static_cast<uint32_t>(first));
    positions.reserve(first + count);
    for (uint32_t row = 0; row < grid.rows; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column)
        {
            const float u = static_cast<float>(column) / static_cast<float>(grid.columns - 1) - 0.5f;
            const float v = static_cast<float>(row) / static_cast<float>(grid.rows - 1) - 0.5f;
            const glm::vec4 place = grid.transform * glm::vec4(u * grid.width, 0, v * grid.depth, 1);
            const bool row_border = row == 0 || row + 1 == grid.rows;
            const bool column_border = column == 0 || column + 1 == grid.columns;
            const float share =
                (row_border ? grid.material.border_share : 1) * (column_border ? grid.material.border_share : 1);
            positions.emplace_back(glm::vec3(place), 1 / (grid.material.vertex_mass * share));
        }
    velocities.resize(first + count, glm::vec4(grid.velocity, 0));
    for (const uint32_t held : grid.held)
    {
        positions[first + held].w = 0;
        velocities[first + held] = glm::vec4(0);
    }
    cloths.push_back(record);
    cloth_names.push_back(grid.name);
    bounds.push_back(stability_bound(record, grid.material));
    return ClothId{static_cast<uint32_t>(cloths.size() - 1)};
}

Result<ColliderId> Model::add(const PlaneCollider& collider)
{
    if (!finite(collider.normal) || std::abs(glm::length(collider.normal) - 1) > 1e-3f)
        return invalid("collider", collider.name, "the plane's normal is not of unit length");
    if (!std::isfinite(collider.offset))
        return invalid("collider", collider.name, "the plane's offset is not finite");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_PLANE, collider.friction);
    record.shape = glm::vec4(glm::normalize(collider.normal), collider.offset);
    return append(colliders, record);
}

Result<ColliderId> Model::add(const SphereCollider& collider)
{
    if (!finite(collider.center))
        return invalid("collider", collider.name, "the sphere's centre is not finite");
    if (!std::isfinite(collider.radius) || collider.radius <= 0)
        return invalid("collider", collider.name,
                       "the sphere's radius is " + std::to_string(collider.radius) + " m, must be finite and > 0");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_SPHERE, collider.friction);
    record.shape = glm::vec4(collider.center, collider.radius);
    return append(colliders, record);
}

std::vector<shared::Chunk> make_chunks(const Model& model, uint32_t workgroup_size)
{
    std::vector<shared::Chunk> chunks;
    for (uint32_t cloth = 0; cloth < model.cloths.size(); ++cloth)
    {
        const uint32_t vertices = model.cloths[cloth].columns * model.cloths[cloth].rows;
        for (uint32_t first = 0; first < vertices; first += workgroup_size)
            chunks.push_back({cloth, first});
    }
    return chunks;
}

} // namespace cloth
