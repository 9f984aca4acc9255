// Threads that share the forces of a mesh's vertex (Tuning::sharing_vertices).
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include "voile/fabrics.hpp"

#include <bit>
#include <limits>
#include <span>
#include <variant>

namespace
{

using Bits = std::vector<glm::uvec4>;

constexpr voile::Step k_step{.substeps = 12, .wind = {3, 1, -2}, .gust = 1};

// Of positions and velocities after some steps.
Bits bits_of(tests::ClothHarness& harness, std::span<const voile::ClothId> cloths)
{
    harness.upload();
    harness.step(k_step, 6);
    Bits bits;
    for (const voile::ClothId cloth : cloths)
        for (const auto& values : {harness.positions(cloth), harness.velocities(cloth)})
            for (const glm::vec4& value : values)
                bits.push_back(std::bit_cast<glm::uvec4>(value));
    return bits;
}

voile::SolverOptions sharing(uint32_t vertices)
{
    voile::SolverOptions options;
    options.tuning.sharing_vertices = vertices;
    return options;
}

constexpr uint32_t k_never = 1; // a cloth has more vertices
constexpr uint32_t k_always = std::numeric_limits<uint32_t>::max();

// Bits of a mesh of two patches, the second almost empty, and of a grid.
Bits bits_after(uint32_t sharing_vertices, voile::Integrator integrator, voile::BendingModel bending)
{
    tests::ClothHarness harness(sharing(sharing_vertices));
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
    return bits_of(harness, ids);
}

// Of grids of all widths with springs of all kinds.
Bits bits_of_grids(uint32_t sharing_vertices, voile::Integrator integrator)
{
    tests::ClothHarness harness(sharing(sharing_vertices));
    std::vector<voile::ClothId> ids;
    voile::Fabric springs = voile::leather();
    voile::Fabric isometric = springs;
    isometric.bending_model = voile::BendingModel::isometric;
    for (uint32_t columns = 2; columns < 7; ++columns)
        for (const std::variant<voile::Fabric, voile::Material>& material :
             {std::variant<voile::Fabric, voile::Material>(springs), {isometric}, {voile::reference_material()}})
        {
            voile::GridCloth grid;
            grid.columns = columns;
            grid.rows = 8 - columns;
            grid.material = material;
            grid.integrator = integrator;
            ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
            voile::engine::take(harness.solver.set_attachments(ids.back(), {voile::pin(0)}));
        }
    return bits_of(harness, ids);
}

} // namespace

TEST_CASE("threads that share the forces of a vertex leave the bits of one thread")
{
    for (const voile::Integrator integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        for (const voile::BendingModel bending : {voile::BendingModel::springs, voile::BendingModel::isometric})
        {
            CAPTURE(static_cast<int>(integrator));
            CAPTURE(static_cast<int>(bending));
            CHECK(bits_after(k_always, integrator, bending) == bits_after(k_never, integrator, bending));
        }
}

// A CPU device takes the neighbors of a grid in a loop. With threads that share forces it has the code of GPUs.
TEST_CASE("the neighbors of a grid's vertex leave the same bits in a loop and one by one")
{
    constexpr uint32_t k_default = 0;
    for (const voile::Integrator integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
    {
        CAPTURE(static_cast<int>(integrator));
        CHECK(bits_of_grids(k_default, integrator) == bits_of_grids(k_never, integrator));
    }
}
