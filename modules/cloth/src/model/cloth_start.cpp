// Positions, residuals and masses of a cloth at the start.
#include "model/cloth_model.hpp"

#include "geometry/rounding.hpp"

#include "shared/residual.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voile
{

namespace
{

// Of a vertex on a line of `count`, whatever the line across it is.
double border_factor(const shared::ClothRecord& record, int index, uint32_t count)
{
    return index == 0 || index + 1 == static_cast<int>(count) ? static_cast<double>(record.border_scale) : 1;
}

double vertex_scale(const shared::ClothRecord& record, int row, int column)
{
    return border_factor(record, row, record.rows) * border_factor(record, column, record.columns);
}

// The rounding error of a float position, packed as in fine_position.glsl.
glm::uvec2 residual_of(const glm::dvec3& position)
{
    const glm::vec3 x = rounded(position);
    const uint32_t unit = shared::residual_unit(x);
    const glm::dvec3 units = (position - glm::dvec3(x)) / double{std::bit_cast<float>(unit)};
    const glm::dvec3 fraction = glm::min(glm::round(units), 32767.0) + 32768.0;
    return shared::pack_fraction(glm::uvec3(fraction), unit);
}

// What the material's density is multiplied by: the vertex's area (m^2) for a Fabric, its fraction of an inner vertex's
// mass for a Material.
double mass_measure(const ClothModel& cloth, uint32_t vertex)
{
    const shared::ClothRecord& record = cloth.record;
    const bool fabric = std::holds_alternative<Fabric>(cloth.material);
    if (cloth.mesh)
        return fabric ? cloth.mesh->areas[vertex] : cloth.mesh->areas[vertex] > 0 ? 1 : 0;
    const double scale =
        vertex_scale(record, static_cast<int>(vertex / record.columns), static_cast<int>(vertex % record.columns));
    return fabric ? scale * static_cast<double>(cloth.spacing.x) * static_cast<double>(cloth.spacing.y) : scale;
}

// m, at the start.
float longest_edge(const ClothModel& cloth)
{
    if (!cloth.mesh)
        return glm::length(cloth.spacing); // the diagonal of a cell, whose triangles have it as a side
    float longest = 0;
    for (const glm::uvec3& t : cloth.mesh->triangles)
        for (int corner = 0; corner < 3; ++corner)
            longest = std::max(
                longest, glm::distance(glm::vec3(cloth.start[t[corner]]), glm::vec3(cloth.start[t[(corner + 1) % 3]])));
    return longest;
}

} // namespace

void set_start(ClothModel& cloth, const ClothInput& input, std::span<const glm::dvec3> world_positions)
{
    cloth.start.reserve(world_positions.size());
    cloth.residuals.reserve(world_positions.size());
    for (uint32_t i = 0; i < world_positions.size(); ++i)
    {
        const double measure = mass_measure(cloth, i);
        double inverse = measure > 0 ? 1 / measure : 0;
        if (!input.inverse_masses.empty())
        {
            inverse = measure > 0 ? static_cast<double>(input.inverse_masses[i]) : 0;
            cloth.own_inverse_mass = std::max(cloth.own_inverse_mass, inverse * measure);
        }
        cloth.start.emplace_back(glm::vec3(world_positions[i]), static_cast<float>(inverse));
        const float own = cloth.start.back().w;
        if (own > 0 && (cloth.heaviest == 0 || own < cloth.heaviest))
            cloth.heaviest = own;
        cloth.residuals.push_back(residual_of(world_positions[i]));
    }
    apply_material(cloth); // it depends on the masses
    cloth.velocity = input.velocity;
    cloth.positions.reserve(world_positions.size());
    cloth.velocities.reserve(world_positions.size());
    for (const glm::vec4& start : cloth.start)
    {
        const float inverse_mass = start.w * cloth.record.inverse_density;
        cloth.positions.emplace_back(glm::vec3(start), inverse_mass);
        cloth.velocities.emplace_back(inverse_mass > 0 ? input.velocity : glm::vec3(0), 0);
        const glm::dvec3 position(start);
        cloth.extent.join({position, position});
    }
    cloth.longest_edge = longest_edge(cloth);
    std::vector<bool> pinned(world_positions.size());
    for (const uint32_t vertex : input.pins)
    {
        if (pinned[vertex])
            continue;
        pinned[vertex] = true;
        cloth.positions[vertex].w = 0;
        cloth.velocities[vertex] = glm::vec4(0);
        cloth.attachments.push_back(pin(vertex));
    }
}

uint64_t count_triangles(const ClothModel& cloth)
{
    return cloth.mesh ? cloth.mesh->triangles.size()
                      : uint64_t{2} * (cloth.record.columns - 1) * (cloth.record.rows - 1);
}

std::vector<glm::uvec3> cloth_triangles(const ClothModel& cloth)
{
    if (cloth.mesh)
        return {cloth.mesh->triangles.begin(), cloth.mesh->triangles.end()};
    const shared::ClothRecord& record = cloth.record;
    std::vector<glm::uvec3> result;
    result.reserve(count_triangles(cloth));
    for (uint32_t row = 0; row + 1 < record.rows; ++row)
        for (uint32_t column = 0; column + 1 < record.columns; ++column)
        {
            const uint32_t corner = row * record.columns + column;
            const uint32_t below = corner + record.columns;
            result.emplace_back(corner, below, corner + 1);
            result.emplace_back(corner + 1, below, below + 1);
        }
    return result;
}

} // namespace voile
