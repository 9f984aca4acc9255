// Adding mesh colliders.
#include "add_mesh.hpp"

#include "heart.hpp"
#include "height_field.hpp"
#include "timed_queue.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bench
{

namespace
{

// 2 million triangles, open: hills of 0.3 m on 10 m x 10 m.
voile::engine::Mesh make_terrain()
{
    constexpr uint32_t k_side = 1001; // vertices
    const auto height = [](uint32_t row, uint32_t column)
    {
        const float x = k_height_field_spacing * static_cast<float>(column);
        const float z = k_height_field_spacing * static_cast<float>(row);
        return 0.3f * std::sin(3 * x) * std::cos(2 * z) + 0.02f * std::sin(41 * x + 17 * z);
    };
    return make_height_field(k_side, height);
}

// 2 million triangles, closed: every edge has to be looked at.
voile::engine::Mesh make_ball()
{
    return voile::engine::make_sphere({0, 0, 0}, 1, 708);
}

constexpr AddCase k_meshes[] = {
    {"add-heart", "the reference scene's heart", scenes::make_reference_heart, 50},
    {"add-terrain", "an open mesh of 2 million triangles", make_terrain, 7},
    {"add-ball", "a closed mesh of 2 million triangles", make_ball, 7},
};

// Milliseconds.
double time_add(const voile::engine::Device& device, const voile::MeshCollider& collider)
{
    voile::Solver solver = voile::engine::take(voile::Solver::create(device.context().handles, {}));
    const auto begin = std::chrono::steady_clock::now();
    (void)voile::engine::take(solver.add_collider(collider));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

std::span<const AddCase> add_cases()
{
    return k_meshes;
}

const AddCase* find_add_case(std::string_view name)
{
    const auto* found =
        std::find_if(std::begin(k_meshes), std::end(k_meshes), [&](const AddCase& item) { return name == item.name; });
    return found != std::end(k_meshes) ? found : nullptr;
}

AddMeasurement measure_add(const voile::engine::Device& device, const AddCase& item)
{
    const voile::engine::Mesh mesh = item.make();
    const voile::MeshCollider collider{.positions = mesh.positions, .triangles = mesh.triangles};
    std::vector<double> built;
    std::vector<double> again;
    for (uint32_t i = 0; i < item.repetitions; ++i)
    {
        voile::set_hierarchy_cache_limit(0);
        voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
        built.push_back(time_add(device, collider));
        again.push_back(time_add(device, collider));
    }
    voile::set_hierarchy_cache_limit(0); // later measurements are to have the memory
    voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
    return {mesh.triangles.size(), quantile(built, 0.5), quantile(built, 0), quantile(again, 0.5)};
}

} // namespace bench
