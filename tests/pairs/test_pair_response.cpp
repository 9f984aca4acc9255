// Momentum, friction, and changes while cloths collide.
#include "support/close_to.hpp"
#include "support/momenta.hpp"
#include "support/pair_harness.hpp"

#include <doctest/doctest.h>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

glm::dvec3 mean(const std::vector<glm::vec4>& positions)
{
    glm::dvec3 sum(0);
    for (const glm::vec4& p : positions)
        sum += glm::dvec3(p);
    return sum / static_cast<double>(positions.size());
}

constexpr double k_static = 0.5;
constexpr double k_kinetic = 0.4;

// A sheet on another one whose vertices are all pinned, on a plane of that inclination.
class Incline : public PairHarness
{
public:
    explicit Incline(float angle, voile::Integrator integrator = voile::Integrator::verlet, float spacing = 0.02f,
                     const glm::vec2& shift = {-3, 0}) // in spacings
        : angle_(angle)
    {
        voile::GridCloth lower = tests::pair_sheet(14, 8, spacing);
        voile::GridCloth upper = tests::pair_sheet(5, 5, spacing);
        for (voile::GridCloth* sheet : {&lower, &upper})
        {
            sheet->integrator = integrator;
            auto& fabric = std::get<voile::Fabric>(sheet->material);
            fabric.static_friction = static_cast<float>(k_static);
            fabric.kinetic_friction = static_cast<float>(k_kinetic);
            fabric.air_drag_normal = fabric.air_drag_tangential = 0;
        }
        for (uint32_t i = 0; i < 14 * 8; ++i)
            lower.pins.push_back(i);
        lower.transform = turned(-angle, {0, 0, 1});
        upper.transform = lower.transform * at({spacing * shift.x, 0.0031f, spacing * shift.y});
        add(lower);
        add(upper);
        upload();
        start_ = mean(positions(cloths[1]));
    }

    // m, downhill
    double slid()
    {
        const auto angle = static_cast<double>(angle_);
        const glm::dvec3 downhill(std::cos(angle), -std::sin(angle), 0);
        return glm::dot(mean(positions(cloths[1])) - start_, downhill);
    }

private:
    float angle_;
    glm::dvec3 start_{0};
};

} // namespace

TEST_CASE("two sheets that collide in free flight keep their momentum")
{
    PairHarness harness;
    for (const float side : {-1.f, 1.f})
    {
        voile::GridCloth sheet = tests::pair_sheet(10, 10, 0.02f);
        sheet.transform = at({0.02f * side, 0.02f * side, 0}) * turned(0.2f * side, {0.1f, 1, 0.2f});
        sheet.velocity = {0, -0.5f * side, 0};
        harness.add(sheet);
    }
    harness.upload();
    const voile::Step step{.duration = 1.f / 60, .gravity = {0, 0, 0}, .air_density = 0};
    const tests::Momenta before = tests::momenta_of(harness);
    harness.step(step, 12);
    const tests::Momenta after = tests::momenta_of(harness);
    CHECK(after.speeds < 0.8 * before.speeds); // they have met
    CHECK(glm::length(after.linear - before.linear) < 5e-6 * before.speeds);
}

TEST_CASE("cloth slides down on cloth as Coulomb's law says")
{
    for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
    {
        CAPTURE(integrator);
        const double angle = std::atan(0.8);
        Incline incline(static_cast<float>(angle), integrator);
        incline.step({.duration = 1.f / 60}, 15);
        const double t = 0.25;
        const double expected = 0.5 * 9.81 * (std::sin(angle) - k_kinetic * std::cos(angle)) * t * t;
        CHECK(incline.slid() == tests::close_to(expected, 0.01)); // measured: 0.1 %
        CHECK(incline.intersections() == 0);
    }
}

TEST_CASE("cloth that slides fast on cloth is slowed as Coulomb's law says")
{
    for (const auto& scene : {std::pair(1.f, 0.02f), {1.5f, 0.03f}})
    {
        const float speed = scene.first;
        const float spacing = scene.second;
        CAPTURE(speed);
        Incline incline(0, voile::Integrator::verlet, spacing);
        take(incline.solver.set_velocity(incline.cloths[1], {speed, 0, 0}));
        const auto velocity = [&] { return mean(incline.velocities(incline.cloths[1])).x; };
        incline.step({.duration = 1.f / 60});
        const double before = velocity();
        incline.step({.duration = 1.f / 60}, 3);
        const double expected = k_kinetic * 9.81 * 3 / 60;
        CHECK(before - velocity() == tests::close_to(expected, 0.01)); // measured: 0.1 %; it was 1.1 and 1.3 times
    }
}

TEST_CASE("cloth sticks on cloth up to nine tenths of static friction")
{
    for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        for (const float slope : {0.1f, 0.45f})
        {
            CAPTURE(integrator);
            CAPTURE(slope);
            Incline incline(std::atan(slope), integrator);
            incline.step({.duration = 1.f / 60}, 12);
            const double before = incline.slid();
            incline.step({.duration = 1.f / 60}, 12);
            CHECK(std::abs(incline.slid() - before) < 0.2 * 1e-4); // m, 0.1 mm/s
        }
}

// Up to 40 pairs have the same nearest points there, and push along as many directions if nothing prevents it.
TEST_CASE("cloth whose vertices lie above vertices sticks on cloth")
{
    for (const float off : {0.f, 0.0004f})
    {
        CAPTURE(off);
        Incline incline(std::atan(0.4f), voile::Integrator::verlet, 0.03f, {-2.5f + off / 0.03f, 0.5f});
        incline.step({.duration = 1.f / 60}, 12);
        const double before = incline.slid();
        incline.step({.duration = 1.f / 60}, 12);
        CHECK(std::abs(incline.slid() - before) < 0.2 * 2e-3); // m, 2 mm/s; it slid at 13 mm/s
    }
}

namespace
{

// Sheets on a plane. Each is shifted and turned against the one below, by 5 mm and 0.2 rad for a shift of 1.
class Stack : public PairHarness
{
public:
    Stack(const voile::GridCloth& sheet, int layers, float shift)
    {
        (void)take(solver.add_collider(voile::PlaneCollider{}));
        const float thickness = std::get<voile::Fabric>(sheet.material).thickness;
        for (int layer = 0; layer < layers; ++layer)
        {
            const auto above = static_cast<float>(layer);
            voile::GridCloth next = sheet;
            next.transform = at({0.004f * shift * above, thickness * (1 + 1.0005f * above), 0.003f * shift * above}) *
                             turned(0.2f * shift * above, {0, 1, 0});
            add(next);
        }
        upload();
    }

    // J/kg; vertices have equal masses.
    double energy()
    {
        double sum = 0;
        size_t count = 0;
        for (const voile::ClothId cloth : cloths)
            for (const glm::vec4& velocity : velocities(cloth))
            {
                const glm::dvec3 v(velocity);
                sum += 0.5 * glm::dot(v, v);
                ++count;
            }
        return sum / static_cast<double>(count);
    }
};

} // namespace

// Its substeps of 1 ms take up all of RK4's stability region: springs reverse fast motion within one, and impulses that
// came after the substep would drive what they should stop.
TEST_CASE("layers of cloth on a plane come to rest, and do not creep")
{
    voile::Fabric fabric = voile::leather();
    fabric.thickness = 0.008f;
    for (float* stiffness : {&fabric.stretch_stiffness[0], &fabric.stretch_stiffness[1], &fabric.shear_stiffness})
        *stiffness *= 0.1f;
    voile::GridCloth sheet = tests::pair_sheet(7, 7, 0.02f);
    sheet.material = fabric;
    for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
    {
        CAPTURE(integrator);
        sheet.integrator = integrator;
        Stack stack(sheet, 4, 1);
        stack.step({.duration = 1.f / 60}, 15);
        const glm::dvec3 start = mean(stack.positions(stack.cloths.back()));
        stack.step({.duration = 1.f / 60}, 15);
        const glm::dvec3 moved = mean(stack.positions(stack.cloths.back())) - start;
        CHECK(stack.energy() < 1e-4);
        CHECK(glm::length(glm::dvec2(moved.x, moved.z)) < 1.5e-4);
    }
}

// Vertices above vertices are in more pairs than lists have room for.
TEST_CASE("equal sheets exactly above each other come to rest")
{
    voile::Fabric fabric = voile::wool();
    fabric.thickness = 0.004f;
    voile::GridCloth sheet = tests::pair_sheet(8, 8, 0.024f);
    sheet.material = fabric;
    sheet.integrator = voile::Integrator::verlet;
    Stack stack(sheet, 3, 0);
    stack.step({.duration = 1.f / 60}, 30);
    CHECK(stack.energy() < 1e-4); // 3e-4 if lists prefer no kind of pairs
}

TEST_CASE("steps after restoring a snapshot equal those after saving it, while sheets collide")
{
    Incline incline(std::atan(0.8f));
    incline.step({.duration = 1.f / 60}, 4);
    const voile::Snapshot snapshot = take(incline.solver.create_snapshot());
    incline.run([&](VkCommandBuffer cmd) { take(incline.solver.record_save(cmd, snapshot)); });
    incline.step({.duration = 1.f / 60}, 4);
    const std::vector<glm::vec4> after_saving = incline.positions(incline.cloths[1]);
    incline.run([&](VkCommandBuffer cmd) { take(incline.solver.record_restore(cmd, snapshot)); });
    incline.step({.duration = 1.f / 60}, 4);
    CHECK(tests::same_bits(after_saving, incline.positions(incline.cloths[1])));
}

TEST_CASE("changes while sheets collide lead to no intersections")
{
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::PlaneCollider{}));
    for (const float level : {0.004f, 0.01f, 0.016f})
    {
        voile::GridCloth sheet = tests::pair_sheet(9, 9, 0.02f);
        sheet.transform = at({0, level, 0}) * turned(50 * level, {0, 1, 0});
        harness.add(sheet);
    }
    harness.upload();
    const auto change = [&](int frame)
    {
        if (frame == 3)
            take(harness.solver.set_material(harness.cloths[1], voile::leather()));
        if (frame == 6)
            take(harness.solver.set_velocity(harness.cloths[2], {0.5f, -2, 0}));
        if (frame == 9)
            take(harness.solver.teleport(harness.cloths[2], at({0, 0.05f, 0})));
        if (frame == 12)
            take(harness.solver.set_enabled(harness.cloths[2], false));
        if (frame == 14)
            take(harness.solver.set_enabled(harness.cloths[2], true));
        if (frame == 17)
            take(harness.solver.set_material(harness.cloths[1], voile::silk()));
    };
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 24, change) == -1);
    CHECK(harness.statistics().forced_pairs == 0);
}
