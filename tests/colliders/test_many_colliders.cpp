// Many colliders: distant ones change no bit of the result, and near ones are never missed, however fast.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <cstring>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::deforming;
using tests::flat_sheet;
using tests::moved;

struct Shot
{
    const char* name;
    float speed;       // m/s, of the falling cloths
    float spin;        // rad per step, of the box and the mesh
    float flight;      // m per step, of the capsule
    uint32_t substeps; // per step
};

// Two cloths that fall onto all kinds of colliders, some of which move, turn and deform.
class Scene : public ClothHarness
{
public:
    Scene(bool many, bool self_collision)
    {
        for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        {
            const float height = self_collision && integrator == voile::Integrator::rk4 ? 0.8f : 0.75f;
            voile::GridCloth grid = flat_sheet(10, 0.7f, height);
            grid.integrator = integrator;
            grid.self_collision = self_collision;
            cloths.push_back(voile::engine::take(solver.add_cloth(grid)));
        }
        add_colliders(many, 70); // so that the near colliders are not in the first word of bits
        capsule_ = voile::engine::take(solver.add_collider(
            voile::CapsuleCollider{.from = {-0.4f, 0.5f, 0.2f}, .to = {-0.2f, 0.5f, -0.3f}, .radius = 0.02f}));
        box_ =
            voile::engine::take(solver.add_collider(voile::BoxCollider{.min = {0, 0, 0}, .max = {0.3f, 0.6f, 0.2f}}));
        mesh_ = voile::engine::take(solver.add_collider(collider(ball_)));
        soft_ = voile::engine::take(solver.add_collider(deforming(bump_)));
        (void)voile::engine::take(solver.add_collider(voile::PlaneCollider{}));
        add_colliders(many, 30);
        upload();
    }

    void run(const Shot& shot, int frame)
    {
        const auto t = static_cast<float>(frame);
        REQUIRE(solver.move_collider(capsule_, moved({shot.flight * t, 0, 0})));
        const glm::mat4 turn = glm::rotate(glm::mat4(1.f), shot.spin * t, glm::vec3(0, 1, 0));
        REQUIRE(solver.move_collider(box_, turn));
        REQUIRE(solver.move_collider(mesh_, turn));
        std::vector<glm::vec3> positions = bump_.positions;
        for (glm::vec3& p : positions)
            p.y *= 1 + 0.1f * t;
        REQUIRE(solver.deform_collider(soft_, positions));
        step({.substeps = shot.substeps});
    }

    std::vector<voile::ClothId> cloths;

private:
    void add_colliders(bool many, int count)
    {
        for (int i = 0; many && i < count; ++i)
        {
            const glm::vec3 position(20, 0, static_cast<float>(i));
            (void)voile::engine::take(
                i % 3 > 0 ? solver.add_collider(voile::CapsuleCollider{.from = position, .to = position + 1.f})
                          : solver.add_collider(voile::SphereCollider{.center = position}));
        }
    }

    voile::engine::Mesh ball_ = voile::engine::make_sphere({0.1f, 0.3f, -0.2f}, 0.2f, 10);
    voile::engine::Mesh bump_ = voile::engine::make_sphere({-0.2f, 0.1f, 0.2f}, 0.2f, 8);
    voile::ColliderId capsule_;
    voile::ColliderId box_;
    voile::ColliderId mesh_;
    voile::ColliderId soft_;
};

// `pushed`: vertices in contact, at least.
void check_distant_colliders(bool self_collision, uint32_t pushed)
{
    Scene alone(false, self_collision);
    Scene many(true, self_collision);
    for (const Shot& shot : {Shot{"slow", 3, 0.1f, 0.01f, 20}, Shot{"fast cloth", 300, 0.3f, 0, 20},
                             Shot{"fast colliders", 10, 2.5f, 0.4f, 17}, Shot{"one substep", 20, 1.5f, 0.2f, 1}})
    {
        CAPTURE(std::string(shot.name));
        uint32_t contacts = 0;
        for (Scene* scene : {&alone, &many})
            for (const voile::ClothId cloth : scene->cloths)
            {
                REQUIRE(scene->solver.reset(cloth));
                REQUIRE(scene->solver.set_velocity(cloth, {0.1f * shot.speed, -shot.speed, 0}));
            }
        for (int frame = 0; frame < 4; ++frame)
        {
            alone.run(shot, frame);
            many.run(shot, frame);
            for (size_t i = 0; i < alone.cloths.size(); ++i)
            {
                const auto x = alone.positions(alone.cloths[i]);
                const auto v = alone.velocities(alone.cloths[i]);
                const auto many_x = many.positions(many.cloths[i]);
                const auto many_v = many.velocities(many.cloths[i]);
                CHECK(std::memcmp(x.data(), many_x.data(), x.size() * sizeof(glm::vec4)) == 0);
                CHECK(std::memcmp(v.data(), many_v.data(), v.size() * sizeof(glm::vec4)) == 0);
            }
            const voile::Statistics found = many.statistics();
            CHECK(found.penetrating_vertices == alone.statistics().penetrating_vertices);
            contacts = std::max(contacts, found.contacts);
        }
        CHECK(contacts > pushed);
    }
}

} // namespace

TEST_CASE("a hundred distant colliders change no bit of the result")
{
    check_distant_colliders(false, 20);
}

TEST_CASE("nor of cloths that collide with themselves and each other")
{
    check_distant_colliders(true, 20);
}
