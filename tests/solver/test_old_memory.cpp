// Solvers whose memory has what an earlier solver left there, as memory of a GPU often does.
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"
#include "support/hard_shapes.hpp"
#include "support/pair_harness.hpp"

#include "shared/pair_layout.h"

#include <doctest/doctest.h>

using tests::PairHarness;

namespace
{

struct Run
{
    std::vector<glm::vec4> positions;
    uint64_t searches = 0;
};

// A sheet falls on another one, a mesh swings beside them, a lump turns below, in memory full of that word.
Run run_in_memory_of(uint32_t word)
{
    tests::FillingAllocator memory(word);
    voile::Handles handles = tests::test_handles();
    handles.buffer_allocator = &memory;
    PairHarness harness({.intersections = true}, handles);
    for (const float upper : {0.f, 1.f})
    {
        voile::GridCloth sheet = tests::pair_sheet(12, 12, 0.02f);
        sheet.transform = tests::at({0.01f * upper, 0.02f * upper, 0}) * tests::turned(0.4f * upper, {0.1f, 1, 0});
        sheet.velocity = {0, -upper, 0};
        sheet.sleep_speed = 0.1f;
        std::get<voile::Fabric>(sheet.material).strain_limit = 0.1f * upper;
        harness.add(sheet);
    }
    const tests::ClothMesh triangles = tests::sheet(8, 8, 0.02f);
    voile::MeshCloth mesh = triangles.cloth();
    mesh.integrator = voile::Integrator::rk4;
    mesh.pins = {0};
    mesh.transform = tests::at({0.15f, 0, 0});
    harness.add(mesh);
    const voile::ColliderId lump =
        voile::engine::take(harness.solver.add_collider(tests::collider(tests::lump_with_ears(12))));
    harness.upload();
    Run result;
    for (int frame = 0; frame < 2; ++frame)
    {
        const auto turn = static_cast<float>(frame);
        REQUIRE(harness.solver.move_collider(lump, tests::at({0, -0.31f + 0.01f * turn, 0}) *
                                                       tests::turned(0.1f * turn, {0, 1, 0})));
        harness.step({.duration = 1.f / 60});
        result.searches += harness.statistics().pair_searches;
    }
    for (const voile::ClothId cloth : harness.cloths)
    {
        const std::vector<glm::vec4> positions = harness.positions(cloth);
        result.positions.insert(result.positions.end(), positions.begin(), positions.end());
    }
    return result;
}

} // namespace

// Small numbers are what an earlier solver leaves that counts passes: a word of PairMemory that says that in pass 20 a
// sweep was halved seven times, for example.
TEST_CASE("what memory has before an upload changes no bit")
{
    const Run nan = run_in_memory_of(tests::k_filled_nan);
    CHECK(nan.searches > 0);
    for (const uint32_t word : {1u, 20u << VOILE_PAIR_HALVING_BITS | 7u})
    {
        CAPTURE(word);
        const Run other = run_in_memory_of(word);
        CHECK(other.searches == nan.searches);
        CHECK(tests::same_bits(other.positions, nan.positions));
    }
}
