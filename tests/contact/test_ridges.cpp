// Cloth that rests on edges alone, or is clamped between them: no vertex has a surface below it, all of the load is on
// features of colliders. It must not creep or vibrate.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/momenta.hpp"

#include "voile/engine/assets/mesh.hpp"
#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

// Prisms along z whose sharp upper edges are at height 0.
voile::engine::Mesh ridges()
{
    constexpr int k_each_side = 6;
    constexpr float k_spacing = 0.011f; // m
    voile::engine::Mesh mesh;
    for (int ridge = -k_each_side; ridge <= k_each_side; ++ridge)
    {
        const float x = k_spacing * static_cast<float>(ridge);
        const auto a = static_cast<uint32_t>(mesh.positions.size());
        for (const float z : {-0.1f, 0.1f})
            for (const glm::vec2& corner : {glm::vec2(0, 0), glm::vec2(-0.002f, -0.02f), glm::vec2(0.002f, -0.02f)})
                mesh.positions.push_back({x + corner.x, corner.y, z});
        for (const glm::uvec3& triangle :
             {glm::uvec3(0, 1, 4), glm::uvec3(0, 4, 3), glm::uvec3(0, 3, 5), glm::uvec3(0, 5, 2), glm::uvec3(1, 2, 5),
              glm::uvec3(1, 5, 4), glm::uvec3(0, 2, 1), glm::uvec3(3, 4, 5)})
            mesh.triangles.push_back(triangle + a);
    }
    return mesh;
}

struct Motion
{
    double speed = 0;          // m/s, of the center of mass at the end
    double kinetic_energy = 0; // J/kg, mean of the second half
    double stretch = 0;        // the most
};

// A square of 6 cm and 9 x 9 vertices, rotated about the vertical axis.
class Sheet
{
public:
    explicit Sheet(const voile::Fabric& fabric, float height)
    {
        voile::GridCloth grid = tests::flat_sheet(9, k_width, height);
        grid.material = fabric;
        grid.integrator = voile::Integrator::verlet;
        grid.transform = glm::rotate(grid.transform, 0.4f, glm::vec3(0, 1, 0));
        id_ = voile::engine::take(harness_.solver.add_cloth(grid));
        mass_ = double(k_width) * double(k_width) * double(fabric.areal_density);
    }
    [[nodiscard]] voile::Solver& solver() { return harness_.solver; }
    void upload() { harness_.upload(); }
    // `move`: called before each frame.
    template <typename Move>
    Motion run(uint32_t frames, const glm::vec3& gravity, const Move& move)
    {
        Motion result;
        for (uint32_t frame = 0; frame < frames; ++frame)
        {
            move(frame);
            harness_.step({.gravity = gravity});
            const voile::Statistics now = harness_.statistics();
            result.stretch = std::max(result.stretch, double(now.max_stretch));
            if (frame >= frames / 2)
                result.kinetic_energy += double(now.kinetic_energy) / mass_ / (frames - frames / 2);
            CHECK(now.penetrating_vertices == 0);
        }
        result.speed = glm::length(tests::momenta_of(harness_, id_).linear) / mass_;
        return result;
    }

private:
    static constexpr float k_width = 0.06f; // m
    tests::ClothHarness harness_;
    voile::ClothId id_;
    double mass_ = 0; // kg
};

} // namespace

TEST_CASE("cloth on sharp ridges alone is held on a slope")
{
    constexpr float k_slope = 0.4f; // rad; its tangent is 0.42, static friction is 0.6 at least
    for (const voile::Fabric& fabric : {voile::leather(), voile::denim(), voile::cotton()})
    {
        Sheet sheet(fabric, 1.02f * fabric.thickness);
        const voile::engine::Mesh mesh = ridges();
        (void)voile::engine::take(
            sheet.solver().add_collider(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
        sheet.upload();
        const Motion motion =
            sheet.run(30, 9.81f * glm::vec3(std::sin(k_slope), -std::cos(k_slope), 0), [](uint32_t) {});
        MESSAGE("speed ", motion.speed, " m/s, ", motion.kinetic_energy, " J/kg");
        CHECK(motion.speed < 1.2e-4);        // measured: 2.4e-5
        CHECK(motion.kinetic_energy < 2e-7); // measured: 4.8e-8
    }
}

// The upper bars come down between the lower ones, 2 mm farther than the cloth is thick.
TEST_CASE("cloth clamped between edges from both sides stays calm")
{
    constexpr float k_spacing = 0.02f;
    constexpr float k_half = 0.002f;
    constexpr float k_gap = 0.006f;
    const voile::Fabric fabric = voile::leather();
    const float above = 2 * fabric.thickness + k_gap;
    Sheet sheet(fabric, 1.02f * fabric.thickness);
    std::vector<voile::ColliderId> upper;
    for (int bar = -2; bar <= 2; ++bar)
    {
        const float x = k_spacing * static_cast<float>(bar);
        (void)voile::engine::take(sheet.solver().add_collider(
            voile::BoxCollider{.min = {x - k_half, -0.02f, -0.1f}, .max = {x + k_half, 0, 0.1f}}));
        const float between = x + 0.5f * k_spacing;
        upper.push_back(voile::engine::take(sheet.solver().add_collider(voile::BoxCollider{
            .min = {between - k_half, above, -0.1f}, .max = {between + k_half, above + 0.02f, 0.1f}})));
    }
    sheet.upload();
    const auto close = [&](uint32_t frame)
    {
        const float lowered = std::min(0.1f * static_cast<float>(frame + 1) / 60, 0.008f);
        for (const voile::ColliderId id : upper)
            voile::engine::take(sheet.solver().move_collider(id, glm::translate(glm::mat4(1), {0, -lowered, 0})));
    };
    const Motion motion = sheet.run(40, {0, -9.81f, 0}, close);
    MESSAGE(motion.kinetic_energy, " J/kg, stretch ", motion.stretch);
    CHECK(motion.kinetic_energy < 0.08); // measured: 0.018
    CHECK(motion.stretch < 0.1);         // measured: 0.029
}
