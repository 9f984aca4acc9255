// IntersectionHarness: counts intersections on the GPU and exactly on the CPU.
#pragma once

#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/exact_intersections.hpp"

#include <random>

namespace tests
{

inline voile::SolverOptions with_intersections()
{
    voile::SolverOptions options;
    options.intersections = true;
    return options;
}

class IntersectionHarness : public ClothHarness
{
public:
    explicit IntersectionHarness(const voile::SolverOptions& options = with_intersections()) : ClothHarness(options) {}

    voile::IntersectionCounts counts()
    {
        run([&](VkCommandBuffer cmd)
            { voile::engine::take(solver.record_statistics(cmd, 0, voile::Intersections::counted)); });
        const voile::Statistics statistics = solver.statistics(0);
        REQUIRE(statistics.intersections.has_value());
        return *statistics.intersections;
    }

    // Per vertex what it intersects.
    std::vector<uint32_t> marks(voile::ClothId cloth)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        return read<uint32_t>(streams.intersections, streams.vertices, streams.intersection_offset);
    }

    // Puts the vertices where `positions` says, on the GPU.
    void place(voile::ClothId cloth, const std::vector<glm::vec3>& positions)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        std::vector<glm::vec4> values;
        values.reserve(positions.size());
        for (const glm::vec3& p : positions)
            values.emplace_back(p, 1);
        write(streams.positions, streams.offset, values);
    }

    // The cloth as the GPU has it.
    ExactMesh exact(voile::ClothId cloth)
    {
        const std::vector<glm::vec4> values = positions(cloth);
        return exact_mesh({values.begin(), values.end()}, solver.triangles(cloth));
    }
};

inline voile::GridCloth flat_grid(uint32_t columns, uint32_t rows, const glm::vec3& center = {})
{
    voile::GridCloth grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = 0.125f * static_cast<float>(columns - 1);
    grid.depth = 0.125f * static_cast<float>(rows - 1);
    grid.transform[3] = glm::vec4(center, 1);
    return grid;
}

// In a cube.
inline std::vector<glm::vec3> random_positions(size_t count, uint32_t seed, float size, const glm::vec3& center = {})
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(-size, size);
    std::vector<glm::vec3> result;
    result.reserve(count);
    while (result.size() < count)
    {
        const float x = coordinate(random);
        const float y = coordinate(random);
        result.push_back(center + glm::vec3(x, y, coordinate(random)));
    }
    return result;
}

} // namespace tests
