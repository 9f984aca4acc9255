// The hard cases of contact: cloth shot at thin, pointed and hollow shapes. No vertex may be on a wrong side at any
// time, no edge of either may be through the other at the end of a frame, and cloth that can rest must come to rest.
#include "support/hard_shapes.hpp"
#include "support/shots.hpp"

#include <numbers>

namespace
{

using tests::moved;
using tests::Seen;
using tests::Shot;
using Scene = tests::ShotScene;
using tests::edge_of_a_box;

constexpr float k_thick = 0.003f; // cotton's
constexpr float k_thin = 0.001f;
const Shot k_shots[] = {{24, 1.2f, 5, k_thick, 8}, {24, 1.2f, 20, k_thin, 5}, {24, 1.2f, 60, k_thin, 4}};
const Shot k_drop = {20, 1, 5, k_thick, 0, 1.225f};
const Shot k_small_drop = {16, 0.8f, 5, k_thick, 0, 1.225f};
constexpr float k_dense_air = 6; // kg/m^3; hanging parts soon stop swinging in it, but cloth slides slowly

void shoot(const Scene& scene)
{
    for (const Shot& shot : k_shots)
        (void)tests::shoot(scene, shot);
}

// `frames`: at most, until the hanging parts have stopped swinging.
void let_rest(const Scene& scene, uint32_t frames, float air_density = k_drop.air_density, Shot drop = k_drop)
{
    CAPTURE(scene.name);
    drop.frames = frames;
    drop.until_rest = true;
    drop.air_density = air_density;
    const Seen seen = tests::shoot(scene, drop);
    CHECK(tests::at_rest(seen, drop));
    if (scene.top)
        CHECK(seen.highest > static_cast<double>(*scene.top));
}

Scene pair_of_triangles(const std::string& name, float width)
{
    return {.name = name, .mesh = tests::triangle_pair(width), .height = 0.15f, .traced = true, .top = 0.f};
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
    tests::transform_mesh(scene.mesh,
                          glm::rotate(moved({0.5f, 0.3f, 0}), std::numbers::pi_v<float> / 2, glm::vec3(0, 0, 1)));
    scene.top = 0.3f;
    return scene;
}

Scene round_bowl()
{
    return {.name = "round bowl", .mesh = tests::round_bowl(1.6f), .height = 0.7f, .focus = glm::dvec3(0, 1.6, 0)};
}

Scene corner()
{
    return {.name = "corner", .mesh = tests::corner_bowl(3.6f), .height = 1.55f, .focus = glm::dvec3(0, 2, 0)};
}

// A scene that is observed for long is not traced in every substep.
Scene at_length(Scene scene)
{
    scene.traced = false;
    return scene;
}

} // namespace

TEST_CASE("cloth shot at two triangles of one square meter in all")
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

TEST_CASE("cloth shot at a horizontal needle")
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

// Its vertices are 10 cm apart, and the mesh bends within that although it is smooth.
TEST_CASE("coarse cloth lies on a dense mesh")
{
    const Scene scene{.name = "lump", .mesh = tests::lump_with_ears(80), .height = 0.6f};
    (void)tests::shoot(scene, {.vertices = 12, .size = 1.1f, .thickness = k_thick, .frames = 30, .stiffness = 1});
}

TEST_CASE("cloth comes to rest on two triangles")
{
    let_rest(pair_of_triangles("square of 1 m", 1), 70, k_dense_air);
}

TEST_CASE("cloth comes to rest on a needle")
{
    Scene upright = upright_needle();
    upright.top.reset(); // all of it hangs from one point, which can come through
    let_rest(at_length(upright), 240);
    let_rest(at_length(lying_needle()), 110, k_dense_air, k_small_drop);
}

TEST_CASE("cloth comes to rest on the edge of a box")
{
    let_rest(at_length(edge_of_a_box(false)), 160, k_dense_air, k_small_drop);
}

TEST_CASE("cloth comes to rest in a bowl")
{
    let_rest(round_bowl(), 90);
    let_rest(corner(), 200, k_drop.air_density, k_small_drop);
}
