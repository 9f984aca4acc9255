// The hard cases of contact: cloth that is shot at thin, pointed and hollow things, and a lump that spins under a
// sheet. Nothing may get to a wrong side at any time, and what can rest must come to rest.
#include "cloth_harness.hpp"
#include "collider_scenes.hpp"
#include "crossing_checks.hpp"
#include "hard_shapes.hpp"

#include "cloth/fabrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace
{

using tests::ClothHarness;
using tests::moved;

constexpr float k_duration = 1.f / 60; // s, of a frame
constexpr double k_rounding = 1e-6;    // m, of coordinates near 1 in float

struct Scene
{
    std::string name;
    engine::Mesh mesh;                       // the collider, in the world
    std::optional<cloth::BoxCollider> box{}; // given in place of the mesh
    float height = 0;                        // m, where the cloth starts
    bool ground = false;                     // a plane at y = 0
    bool traced = false;               // read after each substep: what is thin can be jumped over, and gone around
    std::optional<glm::dvec3> focus{}; // of a bowl: all that it holds is in sight from here
    std::optional<float> top{};        // m: some of the cloth comes to rest above this
    bool apart_when_slow = false;      // the slowest shot never cuts the collider, nor it the cloth
    bool apart_at_rest = false;        // nor what came to rest

    [[nodiscard]] cloth::Collider collider() const
    {
        return box ? cloth::Collider(*box) : cloth::Collider(tests::collider(mesh));
    }
};

struct Shot
{
    uint32_t vertices = 0; // along each side
    float size = 0;        // m
    float speed = 0;       // m/s, downwards
    float thickness = 0;   // m
    uint32_t frames = 0;
    float air_density = 0;   // kg/m^3
    float stiffness = 0.25f; // of cotton's: half its substeps, of 3 cm each at 60 m/s
    uint32_t substeps = 0;   // a frame; 0: as many as it takes
    float strain_limit = 0;  // 0: none
    cloth::Fabric fabric = cloth::cotton();
};

constexpr float k_thick = 0.003f; // cotton's
constexpr float k_thin = 0.001f;
constexpr float k_slow = 5; // m/s; from 20 m/s on edges may cut, and where they do they stay
const Shot k_shots[] = {
    {64, 2, 5, k_thick, 12}, {64, 2, 20, k_thin, 8}, {64, 2, 60, k_thick, 6}, {64, 2, 60, k_thin, 6}};
const Shot k_drop = {32, 1, 5, k_thick, 0, 1.225f};

cloth::Grid sheet(const Scene& scene, const Shot& shot)
{
    cloth::Grid grid;
    grid.columns = grid.rows = shot.vertices;
    grid.width = grid.depth = shot.size;
    grid.transform = glm::rotate(moved({0.013f, scene.height, 0.007f}), 0.3f, glm::vec3(0, 1, 0)); // along nothing
    grid.velocity = {0, -shot.speed, 0};
    grid.integrator = cloth::Integrator::verlet;
    cloth::Fabric fabric = shot.fabric;
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

// The worst that was seen in a run.
struct Seen
{
    uint64_t wrong = 0; // vertices that went through, or out
    double deepest = 0; // m, of a vertex below a closed surface or the ground
    double speed = 0;   // m/s, root mean square of the way over the last frame
    double fastest = 0; // of all frames, and of the velocities at their ends
    double highest = 0; // m, at the end
    tests::Crossings at_worst;
    tests::Crossings at_end;
};

class Run
{
public:
    Run(const Scene& scene, const Shot& shot)
        : scene_(scene), shot_(shot), id_(engine::take(harness_.solver.add_cloth(sheet(scene, shot)))),
          crossings_(scene.mesh, harness_.solver.triangles(id_))
    {
        (void)engine::take(harness_.solver.add_collider(scene.collider()));
        if (scene.ground)
            (void)engine::take(harness_.solver.add_collider(cloth::PlaneCollider{}));
        harness_.upload();
        now_ = exact(harness_.positions(id_));
    }

    void frame()
    {
        const uint32_t substeps = shot_.substeps > 0 ? shot_.substeps : harness_.solver.stable_substeps(k_duration);
        const uint32_t parts = scene_.traced ? substeps : 1;
        const std::vector<glm::dvec3> before = now_;
        for (uint32_t part = 0; part < parts; ++part)
        {
            harness_.step({.duration = k_duration / static_cast<float>(parts),
                           .substeps = substeps / parts,
                           .air_density = shot_.air_density});
            check(exact(harness_.positions(id_)));
        }
        double sum = 0;
        for (size_t i = 0; i < now_.size(); ++i)
            sum += glm::dot(now_[i] - before[i], now_[i] - before[i]);
        seen.speed = std::sqrt(sum / static_cast<double>(now_.size())) / static_cast<double>(k_duration);
        seen.fastest = std::max({seen.fastest, seen.speed, velocity()});
    }

    // How high the cloth reaches now, and what the surfaces do to each other.
    void look()
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
    // m/s, root mean square. Not each way of a frame shows what swings to and fro in it.
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
        const cloth::MeshDistance& exact_surface = crossings_.distance();
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

    const Scene& scene_;
    const Shot& shot_;
    ClothHarness harness_;
    cloth::ClothId id_;
    tests::CrossingCheck crossings_;
    std::vector<glm::dvec3> now_;
};

// Runs a scene and checks what must hold in each.
Seen shoot(const Scene& scene, const Shot& shot)
{
    CAPTURE(scene.name);
    CAPTURE(shot.speed);
    CAPTURE(shot.thickness);
    Run run(scene, shot);
    for (uint32_t frame = 0; frame < shot.frames; ++frame)
    {
        run.frame();
        run.look();
    }
    CHECK(run.seen.wrong == 0);
    CHECK(run.seen.deepest < k_rounding);
    CHECK(run.penetrating() == 0);
    // Nothing gives it energy but its fall, of no more than its height and size.
    const double fall = 2 * 9.81 * static_cast<double>(scene.height + shot.size);
    CHECK(run.seen.fastest < std::sqrt(static_cast<double>(shot.speed * shot.speed) + fall));
    if (scene.apart_when_slow && shot.speed <= k_slow)
        CHECK(run.seen.at_worst.count() == 0);
    MESSAGE(scene.name, ", ", shot.speed, " m/s, thickness ", shot.thickness, " m: edges of the collider through ",
            run.seen.at_worst.collider_edges, " triangles, of the cloth through ", run.seen.at_worst.cloth_edges,
            ", depth ", run.seen.at_worst.depth, " m; at the end ", run.seen.at_end.count(), ", depth ",
            run.seen.at_end.depth, " m, speed ", run.seen.speed, " m/s, highest ", run.seen.highest, " m");
    return run.seen;
}

void shoot(const Scene& scene)
{
    for (const Shot& shot : k_shots)
        (void)shoot(scene, shot);
}

// `frames`: until what hangs has ceased to swing.
void let_rest(const Scene& scene, uint32_t frames)
{
    CAPTURE(scene.name);
    Shot drop = k_drop;
    drop.frames = frames;
    const Seen seen = shoot(scene, drop);
    // In a frame it goes less than what it may lie too deep.
    CHECK(seen.speed * static_cast<double>(k_duration) < static_cast<double>(drop.thickness) / 10);
    if (scene.top)
        CHECK(seen.highest > static_cast<double>(*scene.top));
    if (scene.apart_at_rest)
        CHECK(seen.at_end.count() == 0);
}

Scene pair_of_triangles(const std::string& name, float width)
{
    return {.name = name,
            .mesh = tests::triangle_pair(width),
            .height = 0.15f,
            .traced = true,
            .top = 0.f,
            .apart_when_slow = width < 0.1f,
            .apart_at_rest = true};
}

Scene upright_needle()
{
    return {.name = "upright needle",
            .mesh = tests::needle(0.5f, 0.02f),
            .height = 0.65f,
            .ground = true,
            .traced = true,
            .top = 0.5f};
}

Scene lying_needle()
{
    Scene scene{
        .name = "lying needle", .mesh = tests::needle(1, 0.02f), .height = 0.45f, .ground = true, .traced = true};
    tests::place(scene.mesh, glm::rotate(moved({0.5f, 0.3f, 0}), std::numbers::pi_v<float> / 2, glm::vec3(0, 0, 1)));
    scene.top = 0.3f;
    scene.apart_at_rest = true;
    return scene;
}

// A cube of 0.5 m on its edge, 0.1 m above the ground.
Scene edge_of_a_box(bool formula)
{
    constexpr float k_middle = 0.45f;
    cloth::BoxCollider box{.min = glm::vec3(-0.25f), .max = glm::vec3(0.25f)};
    box.transform = glm::rotate(moved({0, k_middle, 0}), std::numbers::pi_v<float> / 4, glm::vec3(0, 0, 1));
    Scene scene{.name = "edge of a mesh",
                .mesh = engine::make_box(box.min, box.max),
                .height = k_middle + 0.5f,
                .ground = true,
                .apart_when_slow = true,
                .apart_at_rest = true};
    tests::place(scene.mesh, box.transform);
    scene.top = k_middle + box.max.x * std::numbers::sqrt2_v<float>;
    if (!formula)
        return scene;
    scene.name = "edge of a box";
    scene.box = box;
    return scene;
}

Scene round_bowl()
{
    return {.name = "round bowl", .mesh = tests::round_bowl(1.6f), .height = 1, .focus = glm::dvec3(0, 1.6, 0)};
}

Scene corner()
{
    return {.name = "corner", .mesh = tests::corner_bowl(3.6f), .height = 2.05f, .focus = glm::dvec3(0, 2, 0)};
}

// What is watched for long need not be traced all the time.
Scene at_length(Scene scene)
{
    scene.traced = false;
    return scene;
}

} // namespace

TEST_CASE("cloth shot at two triangles, a square metre together")
{
    shoot(pair_of_triangles("square of 1 m", 1));
}

TEST_CASE("cloth shot at two triangles, a strip of 2 cm")
{
    shoot(pair_of_triangles("strip of 2 cm", 0.02f));
}

TEST_CASE("cloth shot at the point of a needle")
{
    shoot(upright_needle());
}

TEST_CASE("cloth shot at a needle that lies in its way")
{
    shoot(lying_needle());
}

TEST_CASE("cloth shot at the edge of a box of triangles")
{
    shoot(edge_of_a_box(false));
}

TEST_CASE("cloth shot at the edge of a box with a formula")
{
    shoot(edge_of_a_box(true));
}

TEST_CASE("cloth shot into a round bowl")
{
    shoot(round_bowl());
}

TEST_CASE("cloth shot into the corner of three squares")
{
    shoot(corner());
}

TEST_CASE("cloth comes to rest on two triangles")
{
    let_rest(pair_of_triangles("square of 1 m", 1), 120);
}

TEST_CASE("cloth comes to rest on a needle")
{
    Scene upright = upright_needle();
    upright.top.reset(); // all of it hangs from one point, which can come through
    let_rest(at_length(upright), 240);
    let_rest(at_length(lying_needle()), 210);
}

TEST_CASE("cloth comes to rest on the edge of a box")
{
    let_rest(at_length(edge_of_a_box(false)), 270);
}

TEST_CASE("cloth comes to rest in a bowl")
{
    let_rest(round_bowl(), 60);
    let_rest(corner(), 150);
}

// Velocity Verlet with 20 substeps of the 73 that cotton needs, stretched to four times its length; and with few or
// most of them.
TEST_CASE("cloth that is softened gains no energy when it is shot at an edge")
{
    for (const uint32_t substeps : {10u, 20u, 56u})
        (void)shoot(edge_of_a_box(false), {64, 2, 60, k_thick, 6, 0, 1, substeps});
}

TEST_CASE("cloth that is softened and has a strain limit gains no energy when it is shot at an edge")
{
    for (const uint32_t substeps : {5u, 10u, 20u})
        (void)shoot(edge_of_a_box(false), {.vertices = 64,
                                           .size = 2,
                                           .speed = 60,
                                           .thickness = k_thick,
                                           .frames = 6,
                                           .stiffness = 1,
                                           .substeps = substeps,
                                           .strain_limit = 0.1f});
}

// 1 m in 20 substeps of the 116 that silk needs; no damping of its own, in 20 of 68.
TEST_CASE("silk and undamped cloth that are softened gain no energy when they are shot at an edge")
{
    Shot shot{.vertices = 48, .size = 1, .speed = 40, .thickness = 0.002f, .frames = 8, .stiffness = 1, .substeps = 20};
    shot.fabric = cloth::silk();
    (void)shoot(edge_of_a_box(false), shot);
    shot.strain_limit = 0.1f;
    (void)shoot(edge_of_a_box(false), shot);
    shot = {.vertices = 64, .size = 2, .speed = 60, .thickness = k_thick, .frames = 6, .stiffness = 1, .substeps = 20};
    shot.fabric.damping_ratio = 0;
    (void)shoot(edge_of_a_box(false), shot);
}
