// Levels of substeps: a cloth that needs fewer substeps than another takes fewer, and moves as it does alone.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <array>
#include <set>

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::moved;
using tests::same_bits;
using voile::engine::take;

constexpr float k_frame = 1.f / 60; // s

// On GPUs cloths as small as these would share a level.
voile::SolverOptions with_levels()
{
    voile::SolverOptions options;
    options.tuning.dispatch_vertices = 1;
    return options;
}

// A sheet with all kinds of attachments and colliders of its own, at a position and on a layer of its own.
struct Place
{
    float stiffness = 1; // times that of the default fabric; substeps grow with its root
    voile::Integrator integrator = voile::Integrator::verlet;
    bool mesh = false;
};

constexpr std::array k_places = {
    Place{.stiffness = 64, .integrator = voile::Integrator::rk4},
    Place{.stiffness = 1},
    Place{.stiffness = 4, .mesh = true},
    Place{.stiffness = 1, .integrator = voile::Integrator::rk4, .mesh = true},
    Place{.stiffness = 3},
};

class Row
{
public:
    explicit Row(ClothHarness& harness, float strain_limit = 0) : solver_(harness.solver), strain_limit_(strain_limit)
    {
    }

    voile::ClothId add(size_t index)
    {
        const Place& place = k_places[index];
        layers_ = 1u << index;
        x_ = 5 * static_cast<float>(index);
        voile::Fabric fabric;
        for (float& stiffness : fabric.stretch_stiffness)
            stiffness *= place.stiffness;
        fabric.strain_limit = index % 2 == 0 ? strain_limit_ : 0; // a cloth without one is as without the others
        const voile::ClothId cloth = place.mesh ? add_mesh(place, fabric) : add_grid(place, fabric);
        take(solver_.set_attachments(cloth,
                                     {voile::pin(0), voile::spring(10, 3, 0.01f), voile::max_distance(60, 0.02f)}));
        take(solver_.set_tethers(cloth, voile::Tethers{.stretch = 0.1f}));
        add_colliders();
        return cloth;
    }

    void move(float time)
    {
        for (size_t i = 0; i < balls_.size(); ++i)
            take(solver_.move_collider(balls_[i], moved({0, 0.3f * time, 0})));
    }

private:
    voile::ClothId add_grid(const Place& place, const voile::Fabric& fabric)
    {
        voile::GridCloth grid = flat_sheet(14, 0.6f, 0);
        grid.material = fabric;
        grid.transform = moved({x_, 0.965f, 0});
        grid.integrator = place.integrator;
        grid.layers = layers_;
        return take(solver_.add_cloth(grid));
    }

    voile::ClothId add_mesh(const Place& place, const voile::Fabric& fabric)
    {
        const tests::ClothMesh sheet = tests::sheet(14, 13, 0.045f);
        voile::MeshCloth mesh = sheet.cloth();
        mesh.material = fabric;
        mesh.transform = moved({x_ - 0.3f, 0.965f, -0.3f});
        mesh.integrator = place.integrator;
        mesh.layers = layers_;
        return take(solver_.add_cloth(mesh));
    }

    // A ball that rises, a table with corners and edges, and the ground.
    void add_colliders()
    {
        balls_.push_back(take(solver_.add_collider(
            voile::SphereCollider{.center = {x_ + 0.1f, 0.85f, 0}, .radius = 0.1f, .layers = layers_})));
        const voile::engine::Mesh table = voile::engine::make_box({x_ - 0.3f, 0.6f, -0.1f}, {x_ - 0.1f, 0.95f, 0.1f});
        voile::MeshCollider mesh = tests::collider(table);
        mesh.layers = layers_;
        take(solver_.add_collider(mesh));
        take(solver_.add_collider(voile::PlaneCollider{.offset = 0.8f, .layers = layers_}));
    }

    voile::Solver& solver_;
    std::vector<voile::ColliderId> balls_;
    float strain_limit_ = 0;
    float x_ = 0;
    uint32_t layers_ = 1;
};

constexpr uint32_t k_frames = 4;

voile::Step frame(uint32_t index)
{
    voile::Step step;
    step.duration = k_frame;
    step.wind = {2, 0, 1};
    step.gust = 0.4f;
    step.time = static_cast<double>(index) * static_cast<double>(k_frame);
    return step;
}

// The first two cloths of a row, uploaded.
struct StiffAndSoft
{
    StiffAndSoft() { harness.upload(); }

    ClothHarness harness{with_levels()};
    Row row{harness};
    voile::ClothId stiff = row.add(0);
    voile::ClothId soft = row.add(1);
};

} // namespace

TEST_CASE("cloths of different stiffness take different substeps, and each moves as it does alone, to the bit")
{
    float strain_limit = 0;
    SUBCASE("without a strain limit") {}
    SUBCASE("with a strain limit")
    {
        strain_limit = 0.02f;
    }
    ClothHarness harness(with_levels());
    Row row(harness, strain_limit);
    std::vector<voile::ClothId> cloths;
    for (size_t i = 0; i < k_places.size(); ++i)
        cloths.push_back(row.add(i));
    harness.upload();
    std::vector<uint32_t> used;
    for (const voile::ClothId cloth : cloths)
    {
        const voile::Stability stability = harness.solver.stability(cloth, frame(0));
        CHECK(stability.used >= stability.needed);
        CHECK(stability.stiffness_scale == 1);
        used.push_back(stability.used);
    }
    CHECK(used[0] >= 4 * used[1]);
    CHECK(std::set(used.begin(), used.end()).size() >= 3);
    for (uint32_t i = 0; i < k_frames; ++i)
    {
        row.move(static_cast<float>(i) * k_frame);
        harness.step(frame(i));
    }
    CHECK(harness.statistics().contacts > 20);

    for (size_t i = 0; i < k_places.size(); ++i)
    {
        CAPTURE(i);
        ClothHarness alone(with_levels());
        Row single(alone, strain_limit);
        const voile::ClothId cloth = single.add(i);
        alone.upload();
        for (uint32_t j = 0; j < k_frames; ++j)
        {
            single.move(static_cast<float>(j) * k_frame);
            voile::Step step = frame(j);
            step.substeps = used[i];
            alone.step(step);
        }
        CHECK(same_bits(harness.positions(cloths[i]), alone.positions(cloth)));
        CHECK(same_bits(harness.velocities(cloths[i]), alone.velocities(cloth)));
    }
}

TEST_CASE_FIXTURE(StiffAndSoft, "substeps of a step hold for every cloth")
{
    CHECK(harness.solver.stability(stiff, {.substeps = 7}).used == 7);
    CHECK(harness.solver.stability(soft, {.substeps = 7}).used == 7);
    const uint32_t most = harness.solver.stability(stiff, {}).used;
    CHECK(most >= harness.solver.stable_substeps(k_frame));
    CHECK(harness.solver.stability(soft, {.substeps = most}).used == most);
    CHECK(harness.solver.stability(soft, {.max_substeps = 1}).used == 1);
}

TEST_CASE_FIXTURE(StiffAndSoft, "levels follow the duration, the material and what is enabled from step to step")
{
    const voile::Step usual = frame(0);
    voile::Step brief = usual;
    brief.duration = 1e-5f; // one substep is enough for each
    const uint32_t two_levels = harness.solver.dispatches(usual);
    for (uint32_t i = 0; i < 4; ++i)
    {
        harness.step(i % 2 == 0 ? usual : brief);
        CHECK(harness.solver.dispatches(usual) == two_levels); // the same from step to step
        CHECK(harness.solver.stability(soft, brief).used == 1);
    }
    take(harness.solver.set_enabled(stiff, false));
    CHECK(harness.solver.dispatches(usual) * 3 < two_levels);
    harness.step(usual, 2);
    take(harness.solver.set_enabled(stiff, true));
    harness.step(usual, 2);
    voile::Fabric fabric;
    for (float& stiffness : fabric.stretch_stiffness)
        stiffness *= 64;
    take(harness.solver.set_material(soft, fabric));
    CHECK(harness.solver.stability(soft, usual).used * 2 > harness.solver.stability(stiff, usual).used);
    harness.step(usual, 4);
    CHECK(harness.statistics().max_stretch < 1.3f);
}

TEST_CASE("a budget of substeps is kept, and what it costs in stiffness is named")
{
    ClothHarness harness(with_levels());
    Row row(harness);
    std::vector<voile::ClothId> cloths;
    for (size_t i = 0; i < k_places.size(); ++i)
        cloths.push_back(row.add(i));
    harness.upload();
    const auto sum = [&](const voile::Step& step)
    {
        uint64_t result = 0;
        for (const voile::ClothId cloth : cloths)
            result += uint64_t{harness.solver.vertices(cloth).vertices} * harness.solver.stability(cloth, step).used;
        return result;
    };
    voile::Step step = frame(0);
    const uint64_t whole = sum(step);
    for (const double fraction : {0.9, 0.5, 0.2, 0.05})
    {
        CAPTURE(fraction);
        step.max_vertex_substeps = static_cast<uint64_t>(fraction * static_cast<double>(whole));
        CHECK(sum(step) <= step.max_vertex_substeps);
        CHECK(2 * sum(step) > step.max_vertex_substeps);
        bool softened = false;
        for (const voile::ClothId cloth : cloths)
        {
            const voile::Stability stability = harness.solver.stability(cloth, step);
            softened |= stability.stiffness_scale < 1;
            CHECK((stability.stiffness_scale < 1 || stability.damping_scale < 1) ==
                  (stability.used < stability.needed));
            CHECK(stability.load <= 0.95f);
        }
        CHECK(softened);
        harness.step(step, 4);
        (void)harness.statistics(); // nothing blows up
    }
}
