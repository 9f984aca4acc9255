// The frame loop as a whole: what it costs the host in steady state.
#include "bench/allocations.hpp"

#include "component/cloth_component.hpp"
#include "engine/app/app.hpp"
#include "engine/assets/shapes.hpp"
#include "engine/scene/deforming_mesh.hpp"
#include "engine/scene/static_mesh.hpp"

#include <doctest/doctest.h>

TEST_CASE("no heap allocation in a frame after the first ones")
{
    // Without validation: the layer's allocations would count.
    engine::App app({.extent = {64, 36}, .headless = true, .timestamps = true});
    auto& world = app.scene().add("cloth").add<cloth::component::ClothWorld>(app.device(), app.slots());
    world.collect_statistics = true;
    world.add_collider(cloth::PlaneCollider{});
    app.scene().add("sheet").add<cloth::component::Sheet>(world, app.uploads(), cloth::Grid{.columns = 8, .rows = 8},
                                                          cloth::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    app.scene().add("ground").add<engine::StaticMesh>(app.uploads(), engine::make_ground(10), engine::ground_surface());
    const engine::Mesh ball = engine::make_sphere({0, 1, 0}, 0.5f, 8);
    auto& deforming =
        app.scene().add("ball").add<engine::DeformingMesh>(app.uploads(), app.slots(), ball, engine::Surface{});
    for (int i = 0; i < 4; ++i) // uploads, both slots, the driver's own first uses
        REQUIRE(app.frame());
    const uint64_t before = bench::allocations();
    CHECK(before > 0); // it counts
    for (int i = 0; i < 8; ++i)
    {
        deforming.set_positions(ball.positions);
        REQUIRE(app.frame());
    }
    CHECK(bench::allocations() - before == 0);
    app.finish();
}
