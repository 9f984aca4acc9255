// Parts of meshes: connectivity, nesting, and the parts that are flipped.
#include "colliders/mesh_input.hpp"
#include "geometry/closedness.hpp"
#include "geometry/mesh_parts.hpp"
#include "support/close_to.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>

namespace
{

// A ball of a mesh, and whether it is inside-out.
struct Part
{
    glm::vec3 center{0.f};
    float radius = 1;
    bool inside_out = false;
};

voile::engine::Mesh mesh_of(const std::vector<Part>& parts, uint32_t rings = 12)
{
    voile::engine::Mesh mesh;
    for (const Part& part : parts)
    {
        const voile::engine::Mesh ball = voile::engine::make_sphere(part.center, part.radius, rings);
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), ball.positions.begin(), ball.positions.end());
        for (const glm::uvec3& t : ball.triangles)
            mesh.triangles.push_back(first + (part.inside_out ? glm::uvec3(t.x, t.z, t.y) : t));
    }
    return mesh;
}

voile::MeshParts parts_of(const voile::engine::Mesh& mesh)
{
    return voile::find_parts(voile::weld(mesh.positions), mesh.triangles);
}

double volume_of(const voile::engine::Mesh& mesh, size_t first, size_t last)
{
    double sum = 0;
    for (size_t t = first; t < last; ++t)
    {
        const glm::uvec3& v = mesh.triangles[t];
        sum += glm::dot(glm::dvec3(mesh.positions[v.x]),
                        glm::cross(glm::dvec3(mesh.positions[v.y]), glm::dvec3(mesh.positions[v.z]))) /
               6;
    }
    return sum;
}

// One letter per part: o if it ends up facing outward, i if inward.
std::string faces(const std::vector<Part>& parts)
{
    voile::engine::Mesh mesh = mesh_of(parts);
    voile::face_outwards(mesh.positions, voile::weld(mesh.positions), mesh.triangles);
    const size_t each = mesh.triangles.size() / parts.size();
    std::string result;
    for (size_t part = 0; part < parts.size(); ++part)
        result += volume_of(mesh, part * each, (part + 1) * each) > 0 ? 'o' : 'i';
    return result;
}

// Reorders the same triangles and vertices.
void shuffle(voile::engine::Mesh& mesh, uint32_t seed)
{
    std::mt19937 random(seed);
    std::vector<uint32_t> new_indices(mesh.positions.size());
    for (uint32_t i = 0; i < new_indices.size(); ++i)
        new_indices[i] = i;
    std::shuffle(new_indices.begin(), new_indices.end(), random);
    const std::vector<glm::vec3> positions = mesh.positions;
    for (uint32_t i = 0; i < new_indices.size(); ++i)
        mesh.positions[new_indices[i]] = positions[i];
    for (glm::uvec3& t : mesh.triangles)
        t = {new_indices[t.x], new_indices[t.y], new_indices[t.z]};
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
}

voile::MeshDistance distance_to(const voile::engine::Mesh& mesh, bool deforms)
{
    const voile::MeshCollider collider{.positions = mesh.positions, .triangles = mesh.triangles, .deforms = deforms};
    return std::move(voile::MeshDistance::create(collider).value());
}

constexpr glm::vec3 k_left{-3, 0, 0};
constexpr glm::vec3 k_right{3, 0, 0};

} // namespace

TEST_CASE("triangles that share a vertex or its position are one part")
{
    voile::engine::Mesh mesh = mesh_of({{}});
    CHECK(parts_of(mesh).count == 1);
    CHECK(parts_of(mesh).of_triangles.empty());
    mesh.positions.insert(mesh.positions.begin(), glm::vec3(9)); // without a triangle
    for (glm::uvec3& t : mesh.triangles)
        t += 1u;
    CHECK(parts_of(mesh).count == 1);
    CHECK(parts_of(mesh).of_triangles.empty());

    mesh = mesh_of({{k_left}, {k_right}, {{}, 0.5f}});
    const voile::MeshParts parts = parts_of(mesh);
    REQUIRE(parts.count == 3);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        CHECK(parts.of_triangles[t] == 3 * t / mesh.triangles.size());
    shuffle(mesh, 1);
    CHECK(parts_of(mesh).count == 3);

    voile::engine::Mesh tips = voile::engine::make_box(glm::vec3(0), glm::vec3(1));
    const voile::engine::Mesh other =
        voile::engine::make_box(glm::vec3(1), glm::vec3(2)); // a corner is shared with the first
    const auto first = static_cast<uint32_t>(tips.positions.size());
    tips.positions.insert(tips.positions.end(), other.positions.begin(), other.positions.end());
    for (const glm::uvec3& t : other.triangles)
        tips.triangles.push_back(first + t);
    CHECK(parts_of(tips).count == 1);
}

TEST_CASE("a part lies in another only if all of it does")
{
    const auto enclosing = [](const std::vector<Part>& parts)
    {
        const voile::engine::Mesh mesh = mesh_of(parts);
        return voile::enclosing_parts(mesh.positions, mesh.triangles, parts_of(mesh));
    };
    using Lists = std::vector<std::vector<uint32_t>>;
    CHECK(enclosing({{k_left}, {k_right}}) == Lists{{}, {}});
    CHECK(enclosing({{{}, 3}, {{}, 2}, {{}, 1}}) == Lists{{}, {0}, {0, 1}});
    CHECK(enclosing({{{}, 1}, {{}, 3, true}, {{}, 2}}) == Lists{{1, 2}, {}, {1}});
    CHECK(enclosing({{{}, 3}, {{2.5f, 0, 0}}}) == Lists{{}, {}});             // intersecting
    CHECK(enclosing({{{}, 3}, {{2.1f, 2.1f, 0}, 0.5f}}) == Lists{{}, {}});    // in its box, and pokes out
    CHECK(enclosing({{{}, 3}, {{1.9f, 1.9f, 1.9f}, 0.5f}}) == Lists{{}, {}}); // in its box, and beside it
    CHECK(enclosing({{{}, 3}, {{1.3f, 1.3f, 1.3f}, 0.2f}}) == Lists{{}, {0}});
    CHECK(enclosing({{{}, 3}, {k_left * 0.5f}, {k_right * 0.5f}}) == Lists{{}, {0}, {0}});
}

TEST_CASE("inside-out parts are flipped, and cavities are kept")
{
    const glm::vec3 o(0);
    CHECK(faces({{o, 1, true}}) == "o");
    CHECK(faces({{k_left}, {k_right, 1, true}}) == "oo");
    CHECK(faces({{k_left, 2, true}, {k_right}}) == "oo"); // more volume inside-out than not
    CHECK(faces({{k_left, 1, true}, {o}, {k_right, 1, true}}) == "ooo");
    CHECK(faces({{o, 2}, {o, 1, true}}) == "oi"); // hollow
    CHECK(faces({{o, 1, true}, {o, 2}}) == "io");
    CHECK(faces({{o, 2, true}, {o, 1}}) == "oi");                // hollow, entirely inside-out
    CHECK(faces({{o, 2}, {o, 1}}) == "oo");                      // solid in solid
    CHECK(faces({{o, 2, true}, {o, 1, true}}) == "oo");          // the same, both inside-out
    CHECK(faces({{o, 3}, {o, 2, true}, {o, 1, true}}) == "oio"); // inside-out in a cavity
    CHECK(faces({{o, 3}, {o, 2, true}, {o, 1}}) == "oio");
    CHECK(faces({{o, 3, true}, {o, 2}, {o, 1, true}}) == "oio");
    CHECK(faces({{o, 2}, {o, 1, true}, {2.f * k_right, 1, true}}) == "oio");
    CHECK(faces({{o, 2}, {{1.9f, 0, 0}, 1, true}}) == "oo"); // half outside: not a cavity
}

TEST_CASE("the flipped parts do not depend on positions, sizes and orders")
{
    std::mt19937 random(3);
    std::uniform_real_distribution<float> real(-1, 1);
    for (uint32_t i = 0; i < 100; ++i)
    {
        const glm::vec3 center = 10.f * glm::vec3(real(random), real(random), real(random));
        const float size = std::exp2(8 * real(random));
        const bool ball_inside_out = i % 2 == 0;
        voile::engine::Mesh mesh = mesh_of({{center, size},
                                            {center, 0.5f * size, true},
                                            {center + glm::vec3(2.5f * size, 0, 0), size, ball_inside_out}},
                                           8);
        shuffle(mesh, i);
        voile::face_outwards(mesh.positions, voile::weld(mesh.positions), mesh.triangles);
        const double expected = volume_of(mesh_of({{{}, size}}, 8), 0, mesh_of({{{}, size}}, 8).triangles.size());
        CHECK(volume_of(mesh, 0, mesh.triangles.size()) == tests::close_to(expected * (2 - 0.125), 2e-4));
    }
}

TEST_CASE("distances have the signs of the parts")
{
    voile::engine::Mesh mesh = mesh_of({{k_left, 2}, {k_left, 1, true}, {k_right, 1, true}}, 24);
    for (const bool deforms : {false, true})
    {
        const voile::MeshDistance distance = distance_to(mesh, deforms);
        CHECK(distance.closed());
        CHECK(distance.nearest({-3, 0.5, 0}).signed_distance == tests::close_to(0.5, 0.01));
        CHECK(distance.nearest({-3, 1.4, 0}).signed_distance == tests::close_to(-0.4, 1e-9));
        CHECK(distance.nearest({-3, 2.5, 0}).signed_distance == tests::close_to(0.5, 0.01));
        CHECK(distance.nearest({3, 0.5, 0}).signed_distance == tests::close_to(-0.5, 0.01));
        CHECK(std::abs(distance.winding_number({-3, 0, 0})) < 1e-9);
        CHECK(distance.winding_number({3, 0, 0}) == tests::close_to(1, 1e-9));
    }
    mesh.triangles.pop_back(); // one part is open now, so the whole mesh is, and nothing is flipped
    const voile::MeshDistance distance = distance_to(mesh, false);
    CHECK_FALSE(distance.closed());
    CHECK_FALSE(distance.has_sides());
    CHECK(distance.nearest({3, 0.5, 0}).signed_distance > 0);
}
