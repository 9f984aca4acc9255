// ClothHarness: a solver on the test device, stepped and read back.
#pragma once

#include "support/gpu_fixture.hpp"

#include "voile/solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

namespace tests
{

// A grid whose vertices are moved at random, so that no force vanishes by symmetry. Deterministic.
inline glm::mat4 tilted()
{
    glm::mat4 m(1.f);
    m[0] = {0.96f, 0.28f, 0, 0}; // a rotation (0.96, 0.28)
    m[1] = {-0.28f, 0.96f, 0, 0};
    m[3] = {0.1f, 2, -0.3f, 1};
    return m;
}

// The Material of a grid that has one, with its masses and springs.
inline voile::Material& raw(voile::GridCloth& grid)
{
    return std::get<voile::Material>(grid.material);
}
inline const voile::Material& raw(const voile::GridCloth& grid)
{
    return std::get<voile::Material>(grid.material);
}

// A moving sheet whose springs are all stretched or compressed: its transform scales positions but not rest lengths.
inline voile::GridCloth stretched_sheet(uint32_t columns, uint32_t rows)
{
    voile::GridCloth grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = 0.05f * static_cast<float>(columns - 1);
    grid.depth = 0.06f * static_cast<float>(rows - 1);
    grid.transform = tests::tilted();
    grid.transform[0] *= 1.1f;
    grid.transform[2] *= 0.9f;
    grid.velocity = {0.3f, -0.2f, 0.5f};
    grid.material = voile::reference_material();
    return grid;
}

// Values that were read back: at least one, all finite. std::max and comparisons drop a NaN, and a loop over nothing
// checks nothing; both fail the test here.
inline std::vector<glm::vec4> checked(std::vector<glm::vec4> values)
{
    if (values.empty())
        FAIL_CHECK("there are no vertices to read");
    const auto finite = [](const glm::vec4& v)
    { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    const auto bad = std::find_if_not(values.begin(), values.end(), finite);
    if (bad != values.end())
        FAIL_CHECK("vertex " << bad - values.begin() << " of " << values.size() << " is not finite");
    return values;
}

// All tests can run with commands that are used again: VOILE_TEST_REUSE=1. The harness waits for each step.
inline voile::SolverOptions with_reuse(voile::SolverOptions options)
{
    static const bool reuses = std::getenv("VOILE_TEST_REUSE") != nullptr;
    if (reuses && !options.command_reuse)
        options.command_reuse = {.queue_family = device().queue_family(), .steps_in_flight = 1};
    return options;
}

class ClothHarness : public GpuFixture
{
public:
    explicit ClothHarness(const voile::SolverOptions& options = {}, const voile::Handles& handles = test_handles())
        : solver(voile::engine::take(voile::Solver::create(handles, with_reuse(options))))
    {
    }

    void upload()
    {
        voile::Upload kept;
        run([&](VkCommandBuffer cmd) { kept = voile::engine::take(solver.record_upload(cmd)); });
    }

    void step(const voile::Step& step, uint32_t times = 1)
    {
        for (uint32_t i = 0; i < times; ++i)
            run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); });
    }

    voile::Statistics statistics()
    {
        run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record_statistics(cmd, 0)); });
        const voile::Statistics found = solver.statistics(0);
        CHECK(found.nan_vertices == expected_nan_vertices); // their energy is 0, and they do not penetrate
        return found;
    }

    std::vector<glm::vec4> positions(voile::ClothId cloth)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        return checked(read<glm::vec4>(streams.positions, streams.vertices, streams.offset));
    }

    std::vector<glm::vec4> velocities(voile::ClothId cloth)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        return checked(read<glm::vec4>(streams.velocities, streams.vertices, streams.offset));
    }

    std::vector<glm::vec4> normals(voile::ClothId cloth)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        return checked(read<glm::vec4>(streams.normals, streams.vertices, streams.offset));
    }

    // Overwrites the buffer's values, one per vertex.
    void write(VkBuffer buffer, VkDeviceSize offset, const std::vector<glm::vec4>& values)
    {
        constexpr size_t k_most = 4096; // of vec4, the limit of one update
        run(
            [&](VkCommandBuffer cmd)
            {
                for (size_t first = 0; first < values.size(); first += k_most)
                    solver.context().fn.vkCmdUpdateBuffer(cmd, buffer, offset + first * sizeof(glm::vec4),
                                                          std::min(k_most, values.size() - first) * sizeof(glm::vec4),
                                                          values.data() + first);
            });
    }
    void set_positions(voile::ClothId cloth, const std::vector<glm::vec4>& values)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        write(streams.positions, streams.offset, values);
    }
    void set_velocities(voile::ClothId cloth, const std::vector<glm::vec4>& values)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        write(streams.velocities, streams.offset, values);
    }

    voile::Solver solver;
    uint32_t expected_nan_vertices = 0; // in the statistics; positions() and the like accept none
};

inline bool same_bits(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
}

// ||a - b|| / ||b|| over all components.
inline double relative_error(const std::vector<glm::vec4>& a, const std::vector<glm::dvec3>& b)
{
    double difference = 0;
    double size = 0;
    for (size_t i = 0; i < b.size(); ++i)
    {
        const glm::dvec3 d = glm::dvec3(a[i]) - b[i];
        difference += glm::dot(d, d);
        size += glm::dot(b[i], b[i]);
    }
    return std::sqrt(difference / size);
}

} // namespace tests
