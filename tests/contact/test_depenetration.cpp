// Cloth that starts inside a solid leaves it slowly and in one piece, for meshes and analytic solids.
#include "reference/swept_reference.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/fabrics.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <variant>

namespace
{

using tests::ClothHarness;
using tests::collider;

constexpr glm::vec3 k_half(0.3f, 0.25f, 0.3f); // of boxes, m
constexpr float k_radius = 0.3f;
const voile::CapsuleCollider k_capsule{.from = {-0.2f, 0, 0}, .to = {0.2f, 0.05f, 0}, .radius = 0.15f};

struct Solid
{
    std::string name;
    voile::Collider collider;
    reference::SignedDistance distance;
};

reference::SignedDistance mesh_distance(const voile::engine::Mesh& mesh)
{
    return [exact = std::make_shared<voile::MeshDistance>(
                voile::engine::take(voile::MeshDistance::create(collider(mesh))))](const glm::dvec3& p)
    { return exact->nearest(p).signed_distance; };
}

// Observations of the vertices that start inside a solid.
struct Exit
{
    uint32_t inside = 0;      // at the start
    uint32_t left_inside = 0; // at the end
    float leaving = 0;        // m/s, the largest in the frame in which it left
    float stretch = 0;        // the largest until then
    float stretch_after = 0;  // at the end
    int frames = 0;           // until no vertex was inside
};

struct Start
{
    std::string name;
    uint32_t vertices;
    float size;       // m
    glm::vec3 middle; // m
    float tilt;       // rad
    float thickness;  // m
};

// Cloths that start in solids, each pair on its own layer.
class Watch
{
public:
    void add(const Solid& solid, const Start& start)
    {
        const uint32_t layers = 1u << lanes_.size();
        voile::GridCloth grid = tests::flat_sheet(start.vertices, start.size, 0);
        grid.transform = glm::rotate(tests::moved(start.middle), start.tilt, glm::vec3(0.8f, 0, 0.6f));
        grid.integrator = voile::Integrator::verlet;
        grid.layers = layers;
        tests::fabric_of(grid).thickness = start.thickness;
        voile::Collider collider = solid.collider;
        std::visit([&](auto& description) { description.layers = layers; }, collider);
        (void)voile::engine::take(harness_.solver.add_collider(collider));
        lanes_.push_back({solid, start, voile::engine::take(harness_.solver.add_cloth(grid)), {}, {}});
    }

    void run(int frames, const voile::Step& step)
    {
        harness_.upload();
        for (Lane& lane : lanes_)
        {
            lane.inside = inside_now(lane);
            lane.exit.inside = static_cast<uint32_t>(std::count(lane.inside.begin(), lane.inside.end(), true));
        }
        for (int frame = 1; frame <= frames; ++frame)
        {
            harness_.step(step);
            for (Lane& lane : lanes_)
                observe(lane, frame);
        }
    }

    struct Lane
    {
        Solid solid;
        Start start;
        voile::ClothId cloth;
        std::vector<bool> inside;
        Exit exit;
    };
    [[nodiscard]] const std::vector<Lane>& lanes() const { return lanes_; }

private:
    [[nodiscard]] std::vector<bool> inside_now(const Lane& lane)
    {
        std::vector<bool> inside;
        for (const glm::vec4& p : harness_.positions(lane.cloth))
            inside.push_back(lane.solid.distance(glm::dvec3(p)) < -1e-6);
        return inside;
    }

    void observe(Lane& lane, int frame)
    {
        const std::vector<bool> now = inside_now(lane);
        const auto x = harness_.positions(lane.cloth);
        const auto v = harness_.velocities(lane.cloth);
        Exit& exit = lane.exit;
        for (size_t i = 0; i < v.size(); ++i)
        {
            const float speed = glm::length(glm::vec3(v[i]));
            if (lane.inside[i] && !now[i])
                exit.leaving = std::max(exit.leaving, std::isfinite(speed) ? speed : INFINITY);
        }
        lane.inside = now;
        exit.left_inside = static_cast<uint32_t>(std::count(now.begin(), now.end(), true));
        if (exit.left_inside > 0)
            exit.frames = frame;
        exit.stretch_after = stretch(x, lane.start);
        exit.stretch = std::max(exit.stretch, exit.stretch_after);
    }

    // The largest stretch along rows and columns.
    static float stretch(const std::vector<glm::vec4>& x, const Start& start)
    {
        const float rest = start.size / static_cast<float>(start.vertices - 1);
        float most = 0;
        for (uint32_t i = 0; i < x.size(); ++i)
            for (const uint32_t other : {(i + 1) % start.vertices == 0 ? i : i + 1, i + start.vertices})
                if (other < x.size())
                    most = std::max(most, glm::distance(glm::vec3(x[i]), glm::vec3(x[other])) / rest - 1);
        return most;
    }

    ClothHarness harness_;
    std::vector<Lane> lanes_;
};

std::vector<Solid> solids()
{
    const auto with_mesh = [](const std::string& name, const voile::engine::Mesh& mesh) {
        return Solid{name, collider(mesh), mesh_distance(mesh)};
    };
    static const voile::engine::Mesh box = voile::engine::make_box(-k_half, k_half);
    static const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, k_radius, 16);
    return {{"box", voile::BoxCollider{.min = -k_half, .max = k_half},
             [](const glm::dvec3& p) { return reference::box_distance(-glm::dvec3(k_half), glm::dvec3(k_half), p); }},
            {"sphere", voile::SphereCollider{.radius = k_radius},
             [](const glm::dvec3& p) {
                 return reference::sphere_distance({0, 0, 0}, static_cast<double>(k_radius), p);
             }},
            {"capsule", k_capsule,
             [](const glm::dvec3& p)
             {
                 return reference::capsule_distance(glm::dvec3(k_capsule.from), glm::dvec3(k_capsule.to),
                                                    static_cast<double>(k_capsule.radius), p);
             }},
            {"plane", voile::PlaneCollider{}, [](const glm::dvec3& p) { return p.y; }},
            with_mesh("mesh box", box),
            with_mesh("mesh ball", ball)};
}

// With `flats` around the y axis and `rings` from pole to pole, few enough for feature edges and vertices.
voile::engine::Mesh ellipsoid(const glm::dvec3& radii, uint32_t flats, uint32_t rings)
{
    voile::engine::Mesh mesh;
    const auto add = [&](double polar, double around)
    {
        const glm::dvec3 unit(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
        mesh.positions.emplace_back(radii * unit);
    };
    const auto at = [&](uint32_t ring, uint32_t flat) { return 1 + (ring - 1) * flats + flat % flats; };
    add(0, 0);
    for (uint32_t ring = 1; ring < rings; ++ring)
        for (uint32_t flat = 0; flat < flats; ++flat)
            add(ring * std::numbers::pi / rings, flat * 2 * std::numbers::pi / flats);
    add(std::numbers::pi, 0);
    const uint32_t last = at(rings, 0);
    for (uint32_t flat = 0; flat < flats; ++flat)
    {
        mesh.triangles.emplace_back(0, at(1, flat + 1), at(1, flat));
        mesh.triangles.emplace_back(last, at(rings - 1, flat), at(rings - 1, flat + 1));
        for (uint32_t ring = 1; ring + 1 < rings; ++ring)
        {
            mesh.triangles.emplace_back(at(ring, flat), at(ring, flat + 1), at(ring + 1, flat));
            mesh.triangles.emplace_back(at(ring, flat + 1), at(ring + 1, flat + 1), at(ring + 1, flat));
        }
    }
    return mesh;
}

} // namespace

TEST_CASE("cloth that starts inside a solid leaves it at 2 m/s at most, in one piece")
{
    const Start starts[] = {{"in the middle", 12, 0.9f, {0.01f, -0.01f, 0.02f}, 0, 5e-3f},
                            {"within", 6, 0.15f, {0.03f, -0.1f, -0.02f}, 0.3f, 5e-3f},
                            {"upright", 8, 0.4f, {0.02f, 0.02f, 0.01f}, 1.5f, 1e-3f}};
    Watch watch;
    for (const Solid& solid : solids())
        for (const Start& start : starts)
            if (solid.name != "plane" || start.name == "upright") // under a plane every displacement is upward
                watch.add(solid, start);
    watch.run(45, {.gravity = glm::vec3(0)});
    for (const Watch::Lane& lane : watch.lanes())
    {
        const Exit& exit = lane.exit;
        CAPTURE(lane.solid.name);
        CAPTURE(lane.start.name);
        MESSAGE(lane.solid.name << ", " << lane.start.name << ": out after " << exit.frames << " frames at "
                                << exit.leaving << " m/s, stretch " << exit.stretch << ", then " << exit.stretch_after);
        CHECK(exit.inside > 0);
        CHECK(exit.left_inside == 0);
        CHECK(exit.leaving < 2);
        CHECK(exit.stretch < 0.4f); // measured 0.28 upright in the capsule, else 0.08; 0.5 and more tears
        CHECK(exit.stretch_after < 0.03f);
    }
}

namespace
{

// Two sheets, each pierced by a solid on its layer.
struct Observed
{
    float stretch = 0;              // the largest
    std::array<float, 2> fastest{}; // m/s, of any vertex
};

Observed watch(ClothHarness& harness, const std::array<voile::ClothId, 2>& sheets, const voile::Step& step, int frames)
{
    harness.upload();
    Observed seen;
    for (int frame = 0; frame < frames; ++frame)
    {
        harness.step(step);
        seen.stretch = std::max(seen.stretch, harness.statistics().max_stretch);
        for (size_t i = 0; i < sheets.size(); ++i)
            for (const glm::vec4& v : harness.velocities(sheets[i]))
            {
                const float speed = glm::length(glm::vec3(v));
                seen.fastest[i] = std::max(seen.fastest[i], std::isfinite(speed) ? speed : INFINITY);
            }
    }
    MESSAGE("at most " << seen.fastest[0] << " and " << seen.fastest[1] << " m/s, stretch " << seen.stretch);
    return seen;
}

} // namespace

// Both were torn: one part of the sheet left on one side, the rest on the other.
TEST_CASE("a tilted sheet that a solid pierces comes out on one side")
{
    const glm::vec3 axis = glm::normalize(glm::vec3(-0.2291f, 0.2864f, -0.9303f));
    voile::GridCloth across_box = tests::flat_sheet(13, 1, 0);
    across_box.width = 0.6494f;
    across_box.depth = 0.4916f;
    across_box.transform =
        glm::mat4(glm::vec4(-0.743896f, -0.624825f, 0.237092f, 0), glm::vec4(0.383263f, -0.689502f, -0.614570f, 0),
                  glm::vec4(0.547474f, -0.366308f, 0.752390f, 0), glm::vec4(0.033294f, 0.081292f, -0.026945f, 1));
    across_box.material = voile::wool();
    across_box.integrator = voile::Integrator::verlet;
    across_box.layers = 1;
    voile::GridCloth across_capsule = across_box;
    across_capsule.columns = 11;
    across_capsule.rows = 7;
    across_capsule.width = 0.7082f;
    across_capsule.depth = 0.5571f;
    across_capsule.transform =
        glm::mat4(glm::vec4(0.172516f, -0.540891f, -0.823210f, 0), glm::vec4(0.619035f, -0.590540f, 0.517743f, 0),
                  glm::vec4(-0.766182f, -0.598915f, 0.232953f, 0), glm::vec4(0.064158f, -0.062362f, 0.060259f, 1));
    across_capsule.material = voile::silk();
    across_capsule.layers = 2;
    ClothHarness harness;
    const std::array sheets{voile::engine::take(harness.solver.add_cloth(across_box)),
                            voile::engine::take(harness.solver.add_cloth(across_capsule))};
    const glm::vec3 half(0.254353f, 0.582220f, 0.311683f);
    (void)voile::engine::take(harness.solver.add_collider(voile::BoxCollider{
        .min = -half, .max = half, .transform = glm::rotate(glm::mat4(1), 0.0422239f, axis), .layers = 1}));
    (void)voile::engine::take(harness.solver.add_collider(voile::CapsuleCollider{
        .from = {-0.540726f, 0.1f, 0}, .to = {0.540726f, -0.1f, 0.2f}, .radius = 0.217979f, .layers = 2}));
    const Observed seen = watch(harness, sheets, {}, 60);
    CHECK(harness.statistics().penetrating_vertices == 0);
    CHECK(seen.stretch < 0.4f);                            // measured 0.148; 4.4 when torn
    CHECK(std::max(seen.fastest[0], seen.fastest[1]) < 8); // measured 2.9; 146 when torn
}

// Like a character: overlapping capsules, a head in a helmet. One solid held what another released (664 m/s).
TEST_CASE("cloth inside overlapping solids leaves all of them in one piece")
{
    using voile::Collider;
    const voile::engine::Mesh ball = ellipsoid({0.35, 0.35, 0.35}, 16, 10);
    voile::engine::Mesh other = ball;
    for (glm::vec3& p : other.positions)
        p.x += 0.1f;
    const std::array<std::array<Collider, 2>, 4> pairs{
        {{voile::CapsuleCollider{.from = {0, -0.4f, 0}, .to = {0, 0.4f, 0}, .radius = 0.3f},
          voile::CapsuleCollider{.from = {-0.5f, 0.05f, 0}, .to = {0.5f, 0.05f, 0}, .radius = 0.25f}},
         {voile::SphereCollider{.center = {-0.05f, 0, 0}, .radius = 0.35f},
          voile::SphereCollider{.center = {0.05f, 0, 0}, .radius = 0.35f}},
         {voile::BoxCollider{.min = glm::vec3(-0.3f), .max = glm::vec3(0.3f)},
          voile::SphereCollider{.center = {0.1f, 0, 0}, .radius = 0.35f}},
         {tests::collider(ball), tests::collider(other)}}};
    ClothHarness harness;
    std::vector<voile::ClothId> sheets;
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        voile::GridCloth grid = tests::flat_sheet(10, 0.4f, 0);
        grid.transform = glm::rotate(glm::mat4(1), 0.5f, {0, 0, 1});
        grid.integrator = i % 2 == 0 ? voile::Integrator::rk4 : voile::Integrator::verlet;
        grid.layers = 1u << i;
        sheets.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
        for (const Collider& collider : pairs[i])
        {
            Collider layered = collider;
            std::visit([&](auto& c) { c.layers = 1u << i; }, layered);
            (void)voile::engine::take(harness.solver.add_collider(layered));
        }
    }
    harness.upload();
    REQUIRE(harness.statistics().penetrating_vertices == 400);
    float stretch = 0;
    std::vector<float> fastest(sheets.size());
    for (int frame = 0; frame < 45; ++frame)
    {
        harness.step({.gravity = glm::vec3(0)});
        stretch = std::max(stretch, harness.statistics().max_stretch);
        for (size_t i = 0; i < sheets.size(); ++i)
            for (const glm::vec4& v : harness.velocities(sheets[i]))
                fastest[i] = std::max(fastest[i], glm::length(glm::vec3(v)));
    }
    CHECK(harness.statistics().penetrating_vertices == 0);
    CHECK(stretch < 0.05f); // measured 0.012; 9.4 if one solid holds it
    for (size_t i = 0; i < sheets.size(); ++i)
    {
        CAPTURE(i);
        CHECK(fastest[i] < 2.5f); // m/s; measured 2.2
    }
    MESSAGE("stretch " << stretch << ", " << fastest[0] << ", " << fastest[1] << ", " << fastest[2] << " and "
                       << fastest[3] << " m/s");
}

// Parts that hooked around the edges were stretched until they snapped free.
TEST_CASE("edges of a solid do not catch a sheet that leaves it")
{
    voile::GridCloth on_box = tests::flat_sheet(8, 1, 0);
    on_box.rows = 13;
    on_box.width = 0.719361f;
    on_box.depth = 1.481635f;
    on_box.transform =
        glm::mat4(glm::vec4(0.957665f, -0.145556f, -0.248376f, 0), glm::vec4(0.165224f, 0.984420f, 0.060155f, 0),
                  glm::vec4(0.235750f, -0.098647f, 0.966794f, 0), glm::vec4(0.052718f, -0.066637f, -0.042403f, 1));
    on_box.material = voile::wool();
    on_box.layers = 1;
    voile::GridCloth on_mesh = on_box;
    on_mesh.columns = 7;
    on_mesh.rows = 10;
    on_mesh.width = 0.603536f;
    on_mesh.depth = 1.290141f;
    on_mesh.transform =
        glm::mat4(glm::vec4(0.567946f, -0.231392f, 0.789871f, 0), glm::vec4(0.755509f, 0.527326f, -0.388759f, 0),
                  glm::vec4(-0.326564f, 0.817548f, 0.474311f, 0), glm::vec4(-0.067641f, -0.002936f, -0.000485f, 1));
    on_mesh.layers = 2;
    ClothHarness harness;
    const std::array sheets{voile::engine::take(harness.solver.add_cloth(on_box)),
                            voile::engine::take(harness.solver.add_cloth(on_mesh))};
    const glm::vec3 half(0.308171f, 0.208842f, 0.276171f);
    const glm::vec3 axis = glm::normalize(glm::vec3(0.266085f, 0.811191f, -0.520738f));
    (void)voile::engine::take(harness.solver.add_collider(voile::BoxCollider{
        .min = -half, .max = half, .transform = glm::rotate(glm::mat4(1), 1.454281f, axis), .layers = 1}));
    const voile::engine::Mesh mesh = ellipsoid({0.315167, 0.197726, 0.174327}, 11, 4);
    (void)voile::engine::take(harness.solver.add_collider(
        voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles, .layers = 2}));
    const Observed seen = watch(harness, sheets, {.gravity = glm::vec3(0)}, 40);
    CHECK(harness.statistics().penetrating_vertices == 0);
    CHECK(seen.stretch < 0.15f); // held back: 0.27
    CHECK(seen.fastest[0] < 2);  // held back: 4.4
    CHECK(seen.fastest[1] < 2);  // held back: 4.0
}
