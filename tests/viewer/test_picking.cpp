// Picking of vertices, and the history of the panel's plots.
#include "samples/viewer/frame_history.hpp"
#include "samples/viewer/picking.hpp"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace
{

constexpr voile::engine::Camera k_camera{.position = {0, 0, 2}, .target = {0, 0, 0}, .fov = 90};

} // namespace

TEST_CASE("the nearest free corner of the first triangle under the cursor is picked")
{
    // Two squares that face the camera, at z = 0 and behind it at z = -1.
    const std::array<glm::vec4, 8> positions{{{-1, -1, 0, 1},
                                              {1, -1, 0, 1},
                                              {-1, 1, 0, 1},
                                              {1, 1, 0, 0}, // pinned
                                              {-3, -3, -1, 1},
                                              {3, -3, -1, 1},
                                              {-3, 3, -1, 1},
                                              {3, 3, -1, 1}}};
    const std::array<glm::uvec3, 4> triangles{{{4, 5, 6}, {5, 7, 6}, {0, 1, 2}, {1, 3, 2}}};
    // At 90°, a cursor at the fraction x of the width looks at 2 (2 x - 1) in the plane z = 0.
    const auto pick = [&](float x, float y) {
        return viewer::pick_vertex(viewer::ray_through(k_camera, {x, y}, 1), positions, triangles);
    };
    REQUIRE(pick(0.3f, 0.7f));
    CHECK(pick(0.3f, 0.7f)->vertex == 0); // x = y = -0.8
    CHECK(pick(0.7f, 0.72f)->vertex == 1);
    CHECK(pick(0.28f, 0.3f)->vertex == 2);
    CHECK(pick(0.7f, 0.35f)->vertex == 1); // 3 is nearer, and pinned
    CHECK(pick(0.8f, 0.9f)->vertex == 5);  // beside the first square
    CHECK_FALSE(viewer::pick_vertex({{0, 0, 2}, {0, 0, 1}}, positions, triangles).has_value()); // behind the camera
    CHECK(pick(0.3f, 0.7f)->distance == doctest::Approx(std::sqrt(4 + 2 * 0.64)));
}

TEST_CASE("the distance to a mesh is that along the ray, where its matrix places it")
{
    const std::array<glm::vec3, 3> positions{{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
    const std::array<glm::uvec3, 1> triangles{{{0, 1, 2}}};
    const viewer::Ray ray = viewer::ray_through(k_camera, {0.5f, 0.5f}, 1);
    const auto distance = [&](const glm::mat4& placed)
    { return viewer::hit_distance(ray, placed, positions, triangles); };
    CHECK(distance(glm::mat4(1)) == doctest::Approx(2));
    CHECK(distance(glm::scale(glm::translate(glm::mat4(1), {0, 0, -3}), glm::vec3(0.1f))) == doctest::Approx(5));
    CHECK_FALSE(distance(glm::translate(glm::mat4(1), {2, 0, 0})).has_value()); // beside the ray
    CHECK_FALSE(distance(glm::translate(glm::mat4(1), {0, 0, 3})).has_value()); // behind the camera
}

TEST_CASE("a point follows the cursor in the plane that faces the camera")
{
    const glm::vec3 point(0.5f, 0.25f, -1);
    const glm::vec3 moved = viewer::point_in_plane(k_camera, viewer::ray_through(k_camera, {0.75f, 0.5f}, 2), point);
    CHECK(moved.x == doctest::Approx(3)); // half of half the width, which is 2 * 3 m there
    CHECK(moved.y == doctest::Approx(0));
    CHECK(moved.z == doctest::Approx(-1));
}

TEST_CASE("the history of frames keeps four seconds and knows the longest passes")
{
    viewer::FrameHistory history;
    const std::array<voile::gpu::PassTime, 4> times{{{"frame", 9}, {"cloth", 5}, {"contact", 1}, {"scene", 4}}};
    const std::array<voile::gpu::PassTime, 2> later{{{"frame", 3}, {"normals", 2}}};
    history.add(times, 1);
    CHECK(history.names() == std::vector<std::string>{"contact", "scene"});
    CHECK(history.longest(1) == std::vector<size_t>{1});
    history.add(later, 2);
    CHECK(history.mean(1) == 2);
    CHECK(history.mean(2) == 1);
    CHECK(history.samples().front().frame_ms == 9);
    CHECK(history.samples().back().energy == 2);
    CHECK(history.usual_most() == doctest::Approx(3.3)); // not 9, which one of two takes
    for (size_t i = 0; i < viewer::FrameHistory::k_frames; ++i)
        history.add(later, 3);
    CHECK(history.samples().size() == viewer::FrameHistory::k_frames);
    CHECK(history.mean(1) == 0);
}
