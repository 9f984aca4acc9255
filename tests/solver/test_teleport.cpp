// A character that is teleported with its cloths, anchors and colliders goes on as if it had been there before.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace
{

using tests::ClothHarness;
using voile::engine::take;

// A cape on the back of a capsule.
class Caped : public ClothHarness
{
public:
    Caped(bool self_collision, bool pins_have_positions, bool mesh)
    {
        constexpr uint32_t k_columns = 10;
        voile::GridCloth grid = tests::flat_sheet(k_columns, 0.4f, 0);
        grid.self_collision = self_collision;
        grid.integrator = voile::Integrator::verlet;
        grid.transform = tests::moved({0, 1, 0.15f}) * glm::rotate(glm::mat4(1), glm::radians(90.f), {1, 0, 0});
        cape = take(solver.add_cloth(grid));
        anchor = take(solver.add_anchor(tests::moved({0, 1.2f, 0})));
        if (mesh)
            body = take(solver.add_collider(tests::collider(body_mesh_)));
        else
            body = take(
                solver.add_collider(voile::CapsuleCollider{.from = {0, 0.3f, 0}, .to = {0, 1.3f, 0}, .radius = 0.12f}));
        std::vector<voile::Attachment> pins;
        for (uint32_t column = 0; column < k_columns; ++column)
        {
            const float x = 0.4f * (static_cast<float>(column) / (k_columns - 1) - 0.5f);
            pins.push_back(pins_have_positions ? voile::pin(column, anchor, {x, 0, 0.15f})
                                               : voile::pin(column, anchor));
        }
        take(solver.set_attachments(cape, pins));
        upload();
    }

    // With the character, which stood at the origin.
    void teleport(const glm::mat4& to)
    {
        take(solver.teleport(cape, to));
        take(solver.teleport(anchor, to * tests::moved({0, 1.2f, 0})));
        take(solver.teleport(body, to));
    }

    voile::ClothId cape;
    voile::AnchorId anchor;
    voile::ColliderId body;

private:
    voile::engine::Mesh body_mesh_ = voile::engine::make_box({-0.15f, 0.2f, -0.1f}, {0.15f, 1.25f, 0.13f});
};

// m, between a cape and another one moved by `to`.
float difference(Caped& a, Caped& b, const glm::mat4& to)
{
    const std::vector<glm::vec4> x = a.positions(a.cape);
    const std::vector<glm::vec4> y = b.positions(b.cape);
    float most = 0;
    for (size_t i = 0; i < x.size(); ++i)
        most = std::max(most, glm::distance(glm::vec3(x[i]), glm::vec3(to * glm::vec4(glm::vec3(y[i]), 1))));
    return most;
}

float fastest(Caped& a)
{
    float speed = 0;
    for (const glm::vec4& v : a.velocities(a.cape))
        speed = std::max(speed, glm::length(glm::vec3(v)));
    return speed;
}

} // namespace

TEST_CASE("a dressed character that is teleported is there at once, and its cloth hangs as before")
{
    const glm::mat4 to = tests::moved({50, 2, 20}) * glm::rotate(glm::mat4(1), 1.2f, {0, 1, 0});
    struct Dress
    {
        bool self_collision;
        bool pins_have_positions;
        bool mesh;
        uint32_t substeps; // at most
    };
    for (const Dress dress : {Dress{false, true, false, 8}, Dress{true, true, true, 8}, Dress{true, false, false, 2000},
                              Dress{false, false, true, 2000}})
    {
        CAPTURE(dress.self_collision);
        CAPTURE(dress.pins_have_positions);
        CAPTURE(dress.mesh);
        CAPTURE(dress.substeps);
        Caped jumps(dress.self_collision, dress.pins_have_positions, dress.mesh);
        Caped stays(dress.self_collision, dress.pins_have_positions, dress.mesh);
        const voile::Step step{.max_substeps = dress.substeps, .air_density = 0};
        for (int i = 0; i < 20; ++i)
            for (Caped* character : {&jumps, &stays})
                character->step(step);
        jumps.teleport(to);
        float farthest = 0;
        float speed = 0;
        for (int i = 0; i < 12; ++i)
        {
            for (Caped* character : {&jumps, &stays})
                character->step(step);
            farthest = std::max(farthest, difference(jumps, stays, to));
            speed = std::max(speed, fastest(jumps) - fastest(stays));
        }
        MESSAGE("farthest " << farthest << " m, faster by " << speed << " m/s");
        CHECK(farthest < 2e-3f);
        CHECK(speed < 0.05f);
    }
}

TEST_CASE("what is teleported refuses what it would refuse to move to")
{
    Caped character(false, true, false);
    glm::mat4 bad(1);
    bad[0][0] = 2;
    CHECK(!character.solver.teleport(character.body, bad));
    bad[3].x = 2e6f;
    CHECK(!character.solver.teleport(character.anchor, bad));
    CHECK(!character.solver.teleport(voile::AnchorId{}, glm::mat4(1)));
    CHECK(!character.solver.teleport(voile::ColliderId{}, glm::mat4(1)));
}
