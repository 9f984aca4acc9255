// The frame loop: its host cost in steady state.
#include "bench/allocations.hpp"

#include "voile/cloth_component.hpp"
#include "voile/engine/app/app.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/scene/deforming_mesh.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <doctest/doctest.h>

TEST_CASE("frames after the first few allocate nothing on the heap")
{
    // Without validation: the layer's allocations would be counted.
    voile::engine::App app({.extent = {64, 36}, .headless = true, .timestamps = true});
    auto& world = app.scene().add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    world.collect_statistics = true;
    world.add_collider(voile::PlaneCollider{});
    app.scene().add("sheet").add<voile::component::Sheet>(world, app.uploads(),
                                                          voile::GridCloth{.columns = 8, .rows = 8},
                                                          voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    voile::Fabric stiff;
    for (float& stiffness : stiff.stretch_stiffness)
        stiffness *= 400;
    app.scene().add("stiff").add<voile::component::Sheet>(world, app.uploads(),
                                                          voile::GridCloth{.columns = 8, .rows = 8, .material = stiff},
                                                          voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    app.scene().add("ground").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_ground(10),
                                                             voile::engine::ground_surface());
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 1, 0}, 0.5f, 8);
    auto& deforming = app.scene().add("ball").add<voile::engine::DeformingMesh>(app.uploads(), app.slots(), ball,
                                                                                voile::engine::Surface{});
    for (int i = 0; i < 4; ++i) // uploads, both slots, the driver's own first uses
        REQUIRE(app.frame());
    const uint64_t before = bench::allocations();
    CHECK(before > 0); // the counter works
    for (int i = 0; i < 8; ++i)
    {
        deforming.set_positions(ball.positions);
        world.step.max_substeps = i % 2 == 0 ? 1 : 2000; // the sheets take the same number of substeps, or do not
        REQUIRE(app.frame());
    }
    CHECK(bench::allocations() - before == 0);
    app.finish();
}
