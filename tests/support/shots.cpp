#include "support/shots.hpp"

#include "support/hard_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace tests
{

namespace
{

constexpr double k_rounding = 1e-6; // m, for float coordinates near 1
constexpr uint32_t k_rest_frames = 5;

voile::GridCloth sheet(const ShotScene& scene, const Shot& shot)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = shot.vertices;
    grid.width = grid.depth = shot.size;
    grid.transform = glm::rotate(moved({0.013f, scene.height, 0.007f}), 0.3f, glm::vec3(0, 1, 0)); // parallel to no
                                                                                                   // axis
    grid.velocity = {0, -shot.speed, 0};
    grid.integrator = voile::Integrator::verlet;
    voile::Fabric fabric = shot.fabric;
    for (float& stiffness : fabric.stretch_stiffness)
        stiffness *= shot.stiffness;
    fabric.thickness = shot.thickness;
    fabric.strain_limit = shot.strain_limit;
    grid.material = fabric;
    return grid;
}

std::vector<glm::dvec3> exact(const std::vector<glm::vec4>& values)
{
    return {values.begin(), values.end()};
}

class Run
{
public:
    Run(const ShotScene& scene, const Shot& shot)
        : scene_(scene), shot_(shot), id_(voile::engine::take(harness_.solver.add_cloth(sheet(scene, shot)))),
          crossings_(scene.mesh, harness_.solver.triangles(id_))
    {
        (void)voile::engine::take(harness_.solver.add_collider(scene.collider()));
        if (scene.ground)
            (void)voile::engine::take(harness_.solver.add_collider(voile::PlaneCollider{}));
        harness_.upload();
        now_ = exact(harness_.positions(id_));
    }

    void frame()
    {
        const uint32_t substeps =
            shot_.substeps > 0 ? shot_.substeps : harness_.solver.stable_substeps(k_shot_duration);
        const uint32_t parts = scene_.traced ? substeps : 1;
        const std::vector<glm::dvec3> before = now_;
        for (uint32_t part = 0; part < parts; ++part)
        {
            harness_.step({.duration = k_shot_duration / static_cast<float>(parts),
                           .substeps = substeps / parts,
                           .air_density = shot_.air_density});
            check(exact(harness_.positions(id_)));
        }
        double sum = 0;
        for (size_t i = 0; i < now_.size(); ++i)
            sum += glm::dot(now_[i] - before[i], now_[i] - before[i]);
        seen.speed = std::sqrt(sum / static_cast<double>(now_.size())) / static_cast<double>(k_shot_duration);
        seen.fastest = std::max({seen.fastest, seen.speed, velocity()});
    }

    // Records the cloth's current height and the intersections of the surfaces.
    void observe()
    {
        const auto lower = [](const glm::dvec3& a, const glm::dvec3& b) { return a.y < b.y; };
        seen.highest = std::max_element(now_.begin(), now_.end(), lower)->y;
        seen.at_end = crossings_.count(now_);
        seen.at_worst.collider_edges = std::max(seen.at_worst.collider_edges, seen.at_end.collider_edges);
        seen.at_worst.cloth_edges = std::max(seen.at_worst.cloth_edges, seen.at_end.cloth_edges);
        seen.at_worst.depth = std::max(seen.at_worst.depth, seen.at_end.depth);
    }

    [[nodiscard]] uint32_t penetrating() { return harness_.statistics().penetrating_vertices; }

    Seen seen{};

private:
    // m/s, root mean square. The displacement over a frame would miss oscillations within it.
    [[nodiscard]] double velocity()
    {
        const std::vector<glm::dvec3> velocities = exact(harness_.velocities(id_));
        double sum = 0;
        for (const glm::dvec3& v : velocities)
            sum += glm::dot(v, v);
        return std::sqrt(sum / static_cast<double>(velocities.size()));
    }

    void check(std::vector<glm::dvec3> next)
    {
        const voile::MeshDistance& exact_surface = crossings_.distance();
        for (size_t i = 0; i < next.size(); ++i)
        {
            REQUIRE(std::isfinite(next[i].x + next[i].y + next[i].z));
            if (scene_.ground)
                seen.deepest = std::max(seen.deepest, -next[i].y);
            if (exact_surface.closed())
                seen.deepest = std::max(seen.deepest, -exact_surface.nearest(next[i]).signed_distance);
            if (scene_.traced)
                seen.wrong += exact_surface.crossing(now_[i], next[i]).has_value();
            if (scene_.focus)
                seen.wrong += exact_surface.crossing(*scene_.focus, next[i]).has_value();
        }
        now_ = std::move(next);
    }

    const ShotScene& scene_;
    const Shot& shot_;
    ClothHarness harness_;
    voile::ClothId id_;
    CrossingCheck crossings_;
    std::vector<glm::dvec3> now_;
};

} // namespace

bool at_rest(const Seen& seen, const Shot& shot)
{
    return seen.speed * static_cast<double>(k_shot_duration) < static_cast<double>(shot.thickness) / 10;
}

Seen shoot(const ShotScene& scene, const Shot& shot)
{
    CAPTURE(scene.name);
    CAPTURE(shot.speed);
    CAPTURE(shot.thickness);
    Run run(scene, shot);
    uint32_t resting = 0; // frames
    uint32_t frame = 0;
    for (; frame < shot.frames && (!shot.until_rest || resting < k_rest_frames); ++frame)
    {
        run.frame();
        run.observe();
        resting = at_rest(run.seen, shot) ? resting + 1 : 0;
    }
    CHECK(run.seen.wrong == 0);
    CHECK(run.seen.deepest < k_rounding);
    CHECK(run.penetrating() == 0);
    // Its energy comes only from its fall, by at most its height and size.
    const double fall = 2 * 9.81 * static_cast<double>(scene.height + shot.size);
    CHECK(run.seen.fastest < std::sqrt(static_cast<double>(shot.speed * shot.speed) + fall));
    CHECK(run.seen.at_worst.count() == 0);
    MESSAGE(scene.name, ", ", shot.speed, " m/s, thickness ", shot.thickness, " m: edges of the collider through ",
            run.seen.at_worst.collider_edges, " triangles, of the cloth through ", run.seen.at_worst.cloth_edges,
            ", depth ", run.seen.at_worst.depth, " m; at the end ", run.seen.at_end.count(), ", depth ",
            run.seen.at_end.depth, " m, after ", frame, " frames: speed ", run.seen.speed, " m/s, highest ",
            run.seen.highest, " m");
    return run.seen;
}

ShotScene edge_of_a_box(bool formula)
{
    constexpr float k_middle = 0.45f;
    voile::BoxCollider box{.min = glm::vec3(-0.25f), .max = glm::vec3(0.25f)};
    box.transform = glm::rotate(moved({0, k_middle, 0}), std::numbers::pi_v<float> / 4, glm::vec3(0, 0, 1));
    ShotScene scene{.name = "edge of a mesh",
                    .mesh = voile::engine::make_box(box.min, box.max),
                    .height = k_middle + 0.5f,
                    .ground = true};
    transform_mesh(scene.mesh, box.transform);
    scene.top = k_middle + box.max.x * std::numbers::sqrt2_v<float>;
    if (!formula)
        return scene;
    scene.name = "edge of a box";
    scene.box = box;
    return scene;
}

} // namespace tests
