// Passes over the patches of cloths that are awake, among others that sleep.
#include "support/cloth_meshes.hpp"
#include "support/sleep_checks.hpp"

#include "voile/fabrics.hpp"

#include <vector>

namespace
{

using tests::ClothHarness;
using tests::moved;
using tests::same_bits;
using tests::sleeping;
using voile::engine::take;

constexpr uint32_t k_cloths = 24;
constexpr uint32_t k_balls = 10; // with more than eight colliders they are listed by patch

bool never_sleeps(uint32_t i)
{
    return i % 5 == 1 || i % 7 == 3;
}

// Flat sheets in a row: those that may sleep lie on the ground, the others fall onto a bar above it. Grids and meshes
// of several sizes, both integrators, soft and stiff ones that take different numbers of substeps.
class Row
{
public:
    Row(const voile::SolverOptions& options, bool may_sleep) : harness_(options)
    {
        for (uint32_t i = 0; i < k_cloths; ++i)
            ids_.push_back(add_cloth(i, may_sleep));
        take(harness_.solver.add_collider(voile::PlaneCollider{}));
        take(harness_.solver.add_collider(
            voile::CapsuleCollider{.from = {-1, 0.1f, 0.05f}, .to = {20, 0.1f, 0.05f}, .radius = 0.02f}));
        for (uint32_t i = 0; i < k_balls; ++i)
            take(harness_.solver.add_collider(
                voile::SphereCollider{.center = {1.5f * static_cast<float>(i), 0.2f, 0.02f}, .radius = 0.02f}));
        harness_.upload();
    }

    ClothHarness& harness() { return harness_; }
    const std::vector<voile::ClothId>& ids() const { return ids_; }

private:
    voile::ClothId add_cloth(uint32_t i, bool may_sleep)
    {
        const uint32_t side = 4 + i % 4 * 2;
        const float spacing = 0.11f / static_cast<float>(side - 1);
        const bool still = !never_sleeps(i);
        const glm::mat4 transform = moved({0.4f * static_cast<float>(i), still ? 0.003f : 0.14f, still ? 0.2f : 0.0f});
        const auto complete = [&](auto description)
        {
            description.transform = transform * description.transform;
            description.integrator = i % 2 == 0 ? voile::Integrator::verlet : voile::Integrator::rk4;
            description.sleep_speed = still && may_sleep ? 0.05f : 0;
            voile::Fabric fabric = voile::cotton();
            const float stiffness = i % 3 == 0 ? 1.f : 20.f;
            fabric.stretch_stiffness = {stiffness, stiffness};
            fabric.shear_stiffness = stiffness / 5;
            fabric.thickness = 0.003f;
            description.material = fabric;
            return take(harness_.solver.add_cloth(description));
        };
        if (i % 4 == 2)
            return complete(tests::sheet(side, side, spacing).cloth());
        voile::GridCloth grid = tests::flat_sheet(side, 0.11f, 0);
        grid.transform = moved({0.055f, 0, 0.055f});
        return complete(grid);
    }

    ClothHarness harness_;
    std::vector<voile::ClothId> ids_;
};

} // namespace

TEST_CASE("cloths that are awake move among those that sleep as among those that cannot, to the bit")
{
    const voile::SolverOptions options{.tuning = {.workgroup_size = 32}}; // threads list several patches
    Row sleepy(options, true);
    Row sleepless(options, false);
    uint32_t may_sleep = 0;
    for (uint32_t i = 0; i < k_cloths; ++i)
        may_sleep += never_sleeps(i) ? 0 : 1;
    for (int frame = 0; frame < 34; ++frame)
    {
        sleepy.harness().step({});
        sleepless.harness().step({});
    }
    CHECK(sleeping(sleepy.harness()) == may_sleep);
    CHECK(sleeping(sleepless.harness()) == 0);
    CHECK(sleepy.harness().statistics().contacts > 0);
    for (uint32_t i = 0; i < k_cloths; ++i)
    {
        if (!never_sleeps(i))
            continue;
        CAPTURE(i);
        CHECK(
            same_bits(sleepy.harness().positions(sleepy.ids()[i]), sleepless.harness().positions(sleepless.ids()[i])));
        CHECK(tests::fastest(sleepy.harness().velocities(sleepy.ids()[i])) > 0);
    }
}
