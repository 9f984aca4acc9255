// Grids: validation and the places of their vertices.
#include "model/model.hpp"

#include <cmath>

namespace voile
{

namespace
{

constexpr uint32_t k_largest_side = 8192; // 67 million vertices: beyond what the buffers of any device hold

Result<void> validate_shape(const GridCloth& grid)
{
    if (grid.columns < 2 || grid.rows < 2 || grid.columns > k_largest_side || grid.rows > k_largest_side)
        return invalid("cloth", grid.name,
                       "a grid of " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                           " vertices; each side needs 2 to " + std::to_string(k_largest_side));
    for (const float size : {grid.width, grid.depth})
        if (!(size >= k_least_cloth_size && size <= k_most_cloth_size))
            return invalid("cloth", grid.name,
                           "its size is " + std::to_string(grid.width) + " x " + std::to_string(grid.depth) +
                               " m, must be finite and > 0: 1e-4 to 1e5 m a side");
    return {};
}

glm::vec2 spacing_of(const GridCloth& grid)
{
    return {grid.width / static_cast<float>(grid.columns - 1), grid.depth / static_cast<float>(grid.rows - 1)};
}

std::vector<glm::dvec3> places(const GridCloth& grid)
{
    const glm::dmat4 transform = without_rounding(grid.transform);
    const glm::vec2 spacing = spacing_of(grid); // as the springs' rest lengths have it
    std::vector<glm::dvec3> result;
    result.reserve(size_t{grid.columns} * grid.rows);
    for (uint32_t row = 0; row < grid.rows; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column)
        {
            const double x = (column - 0.5 * (grid.columns - 1)) * static_cast<double>(spacing.x);
            const double z = (row - 0.5 * (grid.rows - 1)) * static_cast<double>(spacing.y);
            result.emplace_back(transform * glm::dvec4(x, 0, z, 1));
        }
    return result;
}

} // namespace

Result<ClothId> Model::add(const GridCloth& grid)
{
    if (auto valid = validate_shape(grid); !valid)
        return valid.error();
    const ClothInput input{grid.name,       grid.transform, grid.velocity,      grid.material,
                           grid.integrator, grid.pins,      grid.inverse_masses};
    const size_t first = positions.size();
    const size_t count = size_t{grid.columns} * grid.rows;
    if (auto valid = validate(input, count); !valid)
        return valid.error();
    if (first + count > UINT32_MAX / 2)
        return invalid("cloth", grid.name, "more than 2 147 483 647 vertices in one solver");
    const std::vector<glm::dvec3> world = places(grid);
    if (auto range = check_places(grid.name, world); !range)
        return range.error();

    ClothModel cloth;
    cloth.name = grid.name;
    cloth.material = grid.material;
    cloth.integrator = grid.integrator;
    cloth.spacing = spacing_of(grid);
    shared::ClothRecord record{};
    record.first_vertex = static_cast<uint32_t>(first);
    record.vertices = static_cast<uint32_t>(count);
    record.columns = grid.columns;
    record.rows = grid.rows;
    record.layers = grid.layers;
    apply_material(cloth, record);
    const auto index = static_cast<uint32_t>(cloths.size());
    cloths.push_back(std::move(cloth));
    records.push_back(record);
    append_state(*this, input, world, index);
    return ClothId{index};
}

} // namespace voile
