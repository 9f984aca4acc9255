// Grids: validation and the positions of their vertices.
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

// A grid on a line or in a point has no normals, and its springs have no direction.
Result<void> check_flat(const GridCloth& grid)
{
    const glm::dvec3 x(grid.transform[0]);
    const glm::dvec3 z(grid.transform[2]);
    const double least = k_least_grid_scale;
    const double product = glm::length(x) * glm::length(z);
    if (glm::length(x) >= least && glm::length(z) >= least && glm::length(glm::cross(x, z)) > 1e-6 * product)
        return {};
    return invalid("cloth", grid.name,
                   "its transform takes the axes x and z to " + text(glm::vec3(x)) + " and " + text(glm::vec3(z)) +
                       ", they must be at least " + text(k_least_grid_scale) + " long and not parallel");
}

glm::vec2 spacing_of(const GridCloth& grid)
{
    return {grid.width / static_cast<float>(grid.columns - 1), grid.depth / static_cast<float>(grid.rows - 1)};
}

std::vector<glm::dvec3> world_positions(const GridCloth& grid)
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
    const ClothInput input{grid.name,       grid.transform, grid.velocity,       grid.material,
                           grid.integrator, grid.pins,      grid.inverse_masses, grid.sleep_speed};
    const size_t count = size_t{grid.columns} * grid.rows;
    if (auto valid = validate(input, count); !valid)
        return valid.error();
    if (auto flat = check_flat(grid); !flat)
        return flat.error();
    const std::vector<glm::dvec3> world = world_positions(grid);
    if (auto range = check_world_positions(grid.name, world); !range)
        return range.error();

    ClothModel cloth;
    cloth.name = grid.name;
    cloth.material = grid.material;
    cloth.integrator = grid.integrator;
    cloth.spacing = spacing_of(grid);
    cloth.record.columns = grid.columns;
    cloth.record.rows = grid.rows;
    cloth.record.layers = grid.layers;
    cloth.self_collision = grid.self_collision;
    return append(std::move(cloth), input, world);
}

} // namespace voile
