// Threads that share the forces of a mesh's vertex (Tuning::sharing_vertices).
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include "voile/fabrics.hpp"

#include <bit>
#include <limits>

namespace
{

// Bits of positions and velocities of a mesh of two patches, the second almost empty, and of a grid.
std::vector<glm::uvec4> bits_after(uint32_t sharing_vertices, voile::Integrator integrator, voile::BendingModel bending)
{
    voile::SolverOptions options;
    options.tuning.sharing_vertices = sharing_vertices;
    tests::ClothHarness harness(options);
    const tests::ClothMesh mesh = tests::jittered_sheet(13, 10);
    voile::Fabric fabric = voile::cotton(); // feels air
    fabric.bending_model = bending;
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = fabric;
    cloth.integrator = integrator;
    voile::GridCloth grid;
    grid.columns = grid.rows = 9;
    grid.material = fabric;
    grid.integrator = integrator;
    const std::array<voile::ClothId, 2> ids{voile::engine::take(harness.solver.add_cloth(cloth)),
                                            voile::engine::take(harness.solver.add_cloth(grid))};
    voile::engine::take(harness.solver.set_attachments(ids[0], {voile::pin(0), voile::pin(12)}));
    harness.upload();
    harness.step({.substeps = 12, .wind = {3, 1, -2}, .gust = 1}, 6);
    std::vector<glm::uvec4> result;
    for (const voile::ClothId id : ids)
        for (const auto& values : {harness.positions(id), harness.velocities(id)})
            for (const glm::vec4& value : values)
                result.push_back(std::bit_cast<glm::uvec4>(value));
    return result;
}

} // namespace

TEST_CASE("threads that share the forces of a vertex leave the bits of one thread")
{
    constexpr uint32_t k_never = 1; // a cloth has more vertices
    constexpr uint32_t k_always = std::numeric_limits<uint32_t>::max();
    for (const voile::Integrator integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        for (const voile::BendingModel bending : {voile::BendingModel::springs, voile::BendingModel::isometric})
        {
            CAPTURE(static_cast<int>(integrator));
            CAPTURE(static_cast<int>(bending));
            CHECK(bits_after(k_always, integrator, bending) == bits_after(k_never, integrator, bending));
        }
}
