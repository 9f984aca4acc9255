// What a cloth's state is worth in energy and momentum, by the reference's formulas, for tests of energy balance.
#pragma once

#include "cloth_harness.hpp"
#include "reference/cloth_reference.hpp"
#include "reference/mesh_reference.hpp"

#include <algorithm>

namespace tests
{

// A grid with its springs given outright: what the reference takes.
inline cloth::Grid with_springs(const cloth::Grid& grid)
{
    cloth::Grid raw = grid;
    if (const auto* fabric = std::get_if<cloth::Fabric>(&grid.material))
        raw.material = cloth::make_material(*fabric, grid.width / static_cast<float>(grid.columns - 1),
                                            grid.depth / static_cast<float>(grid.rows - 1));
    return raw;
}

inline reference::Cloth reference_of(const cloth::Grid& grid)
{
    return reference::Cloth(with_springs(grid));
}

inline reference::MeshCloth reference_of(const cloth::MeshCloth& mesh)
{
    return reference::MeshCloth(mesh);
}

// Kinetic, elastic and potential energy, J, of the cloth's present state on the device.
template <typename Reference>
double energy_of(ClothHarness& harness, cloth::ClothId id, Reference& reference, const glm::dvec3& gravity)
{
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    for (size_t i = 0; i < x.size(); ++i)
    {
        reference.state.x[i] = glm::dvec3(x[i]);
        reference.state.v[i] = glm::dvec3(v[i]);
    }
    return reference.energy({.gravity = gravity});
}

// m/s, of the center of mass.
inline glm::dvec3 mean_velocity(ClothHarness& harness, cloth::ClothId id)
{
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    glm::dvec3 momentum(0);
    double mass = 0;
    for (size_t i = 0; i < x.size(); ++i)
        if (x[i].w > 0)
        {
            momentum += glm::dvec3(v[i]) / static_cast<double>(x[i].w);
            mass += 1 / static_cast<double>(x[i].w);
        }
    return momentum / mass;
}

} // namespace tests
