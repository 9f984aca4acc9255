// The energy and momentum of a cloth's state by the reference's formulas, for tests of energy balance.
#pragma once

#include "reference/cloth_reference.hpp"
#include "reference/mesh_reference.hpp"
#include "support/cloth_harness.hpp"

#include <algorithm>

namespace tests
{

// The grid with its Fabric converted to a Material, which the reference takes.
inline voile::GridCloth with_springs(const voile::GridCloth& grid)
{
    voile::GridCloth raw = grid;
    if (const auto* fabric = std::get_if<voile::Fabric>(&grid.material))
        raw.material = voile::make_material(*fabric, grid.width / static_cast<float>(grid.columns - 1),
                                            grid.depth / static_cast<float>(grid.rows - 1));
    return raw;
}

// The energy of the isometric model on a grid, J: B / 2 times the squared second differences along rows and columns
// plus twice the squared twist of each cell, over areas.
inline double bending_energy(const voile::GridCloth& raw, const std::vector<glm::dvec3>& x)
{
    const auto& material = std::get<voile::Material>(raw.material);
    const double a = static_cast<double>(raw.width) / (raw.columns - 1);
    const double b = static_cast<double>(raw.depth) / (raw.rows - 1);
    const auto at = [&](uint32_t row, uint32_t column) { return x[size_t{row} * raw.columns + column]; };
    const auto border = [&](uint32_t i, uint32_t count)
    { return i == 0 || i + 1 == count ? static_cast<double>(material.border_scale) : 1; };
    double sum = 0;
    for (uint32_t r = 0; r < raw.rows; ++r)
        for (uint32_t c = 0; c < raw.columns; ++c)
        {
            const auto squared = [](const glm::dvec3& d) { return glm::dot(d, d); };
            if (c > 0 && c + 1 < raw.columns)
                sum += border(r, raw.rows) * b / (a * a * a) * squared(at(r, c - 1) - 2.0 * at(r, c) + at(r, c + 1));
            if (r > 0 && r + 1 < raw.rows)
                sum += border(c, raw.columns) * a / (b * b * b) * squared(at(r - 1, c) - 2.0 * at(r, c) + at(r + 1, c));
            if (r + 1 < raw.rows && c + 1 < raw.columns)
                sum += 2 / (a * b) * squared(at(r, c) - at(r, c + 1) - at(r + 1, c) + at(r + 1, c + 1));
        }
    return 0.5 * static_cast<double>(material.bending_stiffness) * sum;
}

// A grid's reference with the energy of isometric bending, which reference::Cloth lacks.
struct GridReference : reference::Cloth
{
    explicit GridReference(const voile::GridCloth& grid) : reference::Cloth(with_springs(grid)), raw(with_springs(grid))
    {
    }

    [[nodiscard]] double energy(const reference::Environment& environment) const
    {
        return reference::Cloth::energy(environment) + bending_energy(raw, state.x);
    }

    // Scales the elastic energy like a step that is too long for it.
    void soften(double stiffness)
    {
        for (reference::Spring& spring : springs)
            spring.stiffness *= stiffness;
        std::get<voile::Material>(raw.material).bending_stiffness *= static_cast<float>(stiffness);
    }

    voile::GridCloth raw;
};

inline GridReference reference_of(const voile::GridCloth& grid)
{
    return GridReference(grid);
}

inline reference::MeshCloth reference_of(const voile::MeshCloth& mesh)
{
    return reference::MeshCloth(mesh);
}

// Kinetic, elastic and potential energy, J, of the cloth's current state on the device.
template <typename Reference>
double energy_of(ClothHarness& harness, voile::ClothId id, Reference& reference, const glm::dvec3& gravity)
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
inline glm::dvec3 mean_velocity(ClothHarness& harness, voile::ClothId id)
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
