// PairHarness: cloths that collide with themselves and each other, and the exact count of their intersections.
#pragma once

#include "support/cloth_harness.hpp"
#include "support/exact_intersections.hpp"
#include "support/momenta.hpp"

#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <numbers>
#include <utility>
#include <vector>

namespace tests
{

class PairHarness : public ClothHarness
{
public:
    explicit PairHarness(const voile::SolverOptions& options = {}, const voile::Handles& handles = test_handles())
        : ClothHarness(options, handles)
    {
    }

    template <typename Cloth>
    voile::ClothId add(const Cloth& cloth)
    {
        cloths.push_back(voile::engine::take(solver.add_cloth(cloth)));
        return cloths.back();
    }

    ExactMesh exact(voile::ClothId cloth)
    {
        const std::vector<glm::vec4> values = positions(cloth);
        return exact_mesh({values.begin(), values.end()}, solver.triangles(cloth));
    }

    // Of each cloth with itself and with the others.
    uint64_t intersections()
    {
        std::vector<ExactMesh> meshes;
        for (const voile::ClothId cloth : cloths)
            meshes.push_back(exact(cloth));
        uint64_t count = 0;
        for (size_t i = 0; i < meshes.size(); ++i)
            for (size_t k = i; k < meshes.size(); ++k)
                count += k == i ? count_pairs(meshes[i], meshes[i]) : count_pairs_both_ways(meshes[i], meshes[k]);
        return count;
    }

    // Steps, and counts after each. `before`: called with the number of each step. The first step that ends with an
    // intersection, or -1.
    template <typename Before>
    int first_intersection(const voile::Step& step, int steps, const Before& before)
    {
        for (int i = 0; i < steps; ++i)
        {
            before(i);
            this->step(step);
            if (intersections() > 0)
                return i;
        }
        return -1;
    }
    int first_intersection(const voile::Step& step, int steps)
    {
        return first_intersection(step, steps, [](int) {});
    }

    std::vector<voile::ClothId> cloths;
};

// Of all cloths together; the angular momenta are about their own centers and not summed.
inline Momenta momenta_of(PairHarness& harness)
{
    Momenta sum;
    for (const voile::ClothId cloth : harness.cloths)
    {
        const Momenta of = momenta_of(harness, cloth);
        sum.linear += of.linear;
        sum.moment += of.moment;
        sum.speeds += of.speeds;
    }
    return sum;
}

// A grid of cotton that collides with itself, flat in x and z around the origin.
inline voile::GridCloth pair_sheet(uint32_t columns, uint32_t rows, float spacing)
{
    voile::GridCloth grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = spacing * static_cast<float>(columns - 1);
    grid.depth = spacing * static_cast<float>(rows - 1);
    grid.material = voile::cotton();
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = true;
    return grid;
}

inline glm::mat4 at(const glm::vec3& position)
{
    return glm::translate(glm::mat4(1.f), position);
}

inline glm::mat4 turned(float radians, const glm::vec3& axis)
{
    return glm::rotate(glm::mat4(1.f), radians, axis);
}

} // namespace tests
