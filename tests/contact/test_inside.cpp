// The inside test of depenetration, against winding numbers in double precision.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/odd_solids.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <array>
#include <cmath>
#include <random>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::joined;
using tests::spire;

} // namespace

TEST_CASE("the inside test is right at edges, at corners and in slivers")
{
    // Points on lines along the axes through vertices and edge midpoints, where a line hits several triangles at once,
    // and points near them, up to a few roundings. Vertices inside move.
    constexpr uint32_t k_side = 64;
    const voile::engine::Mesh meshes[] = {
        spire(), voile::engine::make_sphere({0, 0.5f, 0}, 0.5f, 20),
        voile::engine::make_box({-0.5f, 0, -0.25f}, {0.5f, 1, 0.75f}),
        joined(spire(), voile::engine::make_box({-0.5f, 0, -0.25f}, {0.5f, 1, 0.75f}))};
    std::mt19937 random(3);
    for (const voile::engine::Mesh& mesh : meshes)
        for (const bool deforms : {false, true})
        {
            if (deforms && mesh.triangles.size() > 100)
                continue;
            CAPTURE(mesh.triangles.size());
            voile::MeshCollider description = collider(mesh);
            const auto exact = voile::engine::take(voile::MeshDistance::create(description));
            description.deforms = deforms;
            ClothHarness harness({.feature_contact = false}); // only depenetration moves vertices
            voile::GridCloth grid{.columns = k_side, .rows = k_side};
            voile::Material material;
            material.thickness = 1e-5f;
            grid.material = material;
            const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
            (void)voile::engine::take(harness.solver.add_collider(description));
            harness.upload();
            std::vector<glm::vec4> points = harness.positions(id);
            std::uniform_real_distribution<float> within(-0.6f, 1.3f);
            for (size_t i = 0; i < points.size(); ++i)
            {
                const glm::uvec3& t = mesh.triangles[random() % mesh.triangles.size()];
                glm::vec3 p = mesh.positions[t.x];
                if (i % 2 == 0)
                    p = 0.5f * (p + mesh.positions[t.y]);
                const float jitter = std::array{0.f, 1e-7f, 1e-3f}[i % 3];
                p += jitter * glm::vec3(within(random), within(random), within(random));
                p[static_cast<int>(i / 3 % 3)] = within(random);
                points[i] = glm::vec4(p, points[i].w);
            }
            const voile::VertexStreams streams = harness.solver.vertices(id);
            harness.run(
                [&](VkCommandBuffer cmd)
                {
                    harness.solver.context().fn.vkCmdUpdateBuffer(cmd, streams.positions, streams.offset,
                                                                  points.size() * sizeof(glm::vec4), points.data());
                });
            harness.step({.substeps = 1, .gravity = glm::vec3(0), .air_density = 0}, 2); // the first step only votes
            const auto after = harness.positions(id);
            uint32_t wrong = 0;
            uint32_t inside = 0;
            for (size_t i = 0; i < points.size(); ++i)
            {
                const glm::dvec3 p(points[i]);
                if (std::abs(exact.nearest(p).signed_distance) < 2e-5) // left to contact
                    continue;
                const bool expected = exact.winding_number(p) > 0.5;
                inside += expected;
                // The vertex keeps the residual of its initial position.
                wrong += expected != (glm::distance(glm::vec3(after[i]), glm::vec3(points[i])) > 1e-6f);
            }
            CHECK(inside > 100);
            CHECK(wrong == 0);
        }
}
