// Irregular mesh colliders: inside-out, non-manifold, in several parts, with degenerate or duplicate triangles. They
// work or are refused with a reason. Meshes larger than the device's buffers are refused, too.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::flat_sheet;
using tests::moved;
using tests::reason;

constexpr float k_radius = 0.4f;         // m
constexpr float k_size = 0.3f;           // m, of a cloth
constexpr glm::vec3 k_start{0, 0.1f, 0}; // where cloths start to fall

void add(voile::engine::Mesh& mesh, const voile::engine::Mesh& part, bool turned)
{
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    for (const glm::uvec3& t : part.triangles)
        mesh.triangles.push_back(first + (turned ? glm::uvec3(t.x, t.z, t.y) : t));
}

voile::engine::Mesh turned(const voile::engine::Mesh& mesh)
{
    voile::engine::Mesh result;
    add(result, mesh, true);
    return result;
}

// A ball with its top at the origin.
voile::engine::Mesh ball(float x = 0)
{
    return voile::engine::make_sphere({x, -k_radius, 0}, k_radius, 24);
}

constexpr float k_thickness = 0.005f; // the Fabric's

void check_lies_flat(const std::vector<glm::vec4>& positions)
{
    float lowest = 1;
    float highest = -1;
    for (const glm::vec4& p : positions)
    {
        lowest = std::min(lowest, p.y);
        highest = std::max(highest, p.y);
    }
    CHECK(std::abs(lowest - k_thickness) < k_thickness / 10);
    CHECK(highest < 2 * k_thickness);
}

void check_lies_in_cavity(const std::vector<glm::vec4>& positions)
{
    float lowest = 1;
    float farthest = 0;
    for (const glm::vec4& p : positions)
    {
        lowest = std::min(lowest, p.y);
        farthest = std::max(farthest, glm::distance(glm::vec3(p), k_start));
    }
    CHECK(lowest < k_start.y - 0.9f * k_radius);
    CHECK(farthest < k_radius);
}

// The facets lie below the ball by up to 1 - cos(pi / 48) in each direction.
void check_lies_on_ball(const std::vector<glm::vec4>& positions, float x = 0)
{
    const glm::vec3 center(x, -k_radius, 0);
    float highest = -1;
    float nearest = 1;
    for (const glm::vec4& p : positions)
    {
        highest = std::max(highest, p.y);
        nearest = std::min(nearest, glm::distance(glm::vec3(p), center));
    }
    CHECK(highest > 0);
    CHECK(nearest > k_radius * 0.995f);
}

// A mesh, and the point on its top where a cloth falls at 3 m/s; y = 0 there.
struct Drop
{
    std::string name;
    voile::engine::Mesh mesh;
    voile::Sidedness sidedness = voile::Sidedness::automatic;
    float x = 0;
};

// The cloths 0.4 s later. All are at the same position, each on its own layer.
std::vector<std::vector<glm::vec4>> fallen(const std::vector<Drop>& drops, bool deforms)
{
    ClothHarness harness;
    std::vector<voile::ClothId> ids;
    for (const Drop& drop : drops)
    {
        voile::GridCloth grid = flat_sheet(10, k_size, 0);
        tests::fabric_of(grid).stretch_stiffness = {25, 25};
        tests::fabric_of(grid).shear_stiffness = 5;
        grid.integrator = voile::Integrator::verlet;
        grid.transform = moved(k_start + glm::vec3(drop.x, 0, 0));
        grid.velocity = {0, -3, 0};
        grid.layers = 1u << ids.size();
        voile::MeshCollider mesh = collider(drop.mesh);
        mesh.sidedness = drop.sidedness;
        mesh.deforms = deforms;
        mesh.layers = grid.layers;
        (void)voile::engine::take(harness.solver.add_collider(mesh));
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
    }
    harness.upload();
    harness.step({}, 24);
    CHECK(harness.statistics().nan_vertices == 0);
    std::vector<std::vector<glm::vec4>> result;
    for (const voile::ClothId id : ids)
        result.push_back(harness.positions(id));
    return result;
}

// Two squares that share a line, and a wall that hangs down from it: three triangles at each edge of that line.
voile::engine::Mesh ridge_with_a_wall()
{
    voile::engine::Mesh mesh;
    mesh.positions = {{-1, 0, -1}, {0, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {0, -1, -1}, {0, -1, 1}};
    mesh.triangles = {{0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {1, 4, 6}, {6, 4, 7}};
    return mesh;
}

// A ground with additional triangles.
voile::engine::Mesh ground_and(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions = {})
{
    voile::engine::Mesh mesh = voile::engine::make_ground(1);
    mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    return mesh;
}

// A ball with a duplicate triangle. It counts as open.
voile::engine::Mesh ball_and_a_triangle()
{
    voile::engine::Mesh mesh = ball();
    mesh.triangles.push_back(mesh.triangles[3]);
    return mesh;
}

voile::engine::Mesh two_balls(bool second_turned)
{
    voile::engine::Mesh mesh = ball(-0.5f);
    add(mesh, ball(0.5f), second_turned);
    return mesh;
}

// Most of their volume is inside-out.
voile::engine::Mesh three_balls()
{
    voile::engine::Mesh mesh = turned(ball(-1));
    add(mesh, ball(), false);
    add(mesh, ball(1), true);
    return mesh;
}

// A hollow ball around the start of the cloths, its cavity as large as other balls, and an inside-out ball beside it.
voile::engine::Mesh hollow_ball_and_ball()
{
    voile::engine::Mesh mesh = voile::engine::make_sphere(k_start, 1.25f * k_radius, 24);
    add(mesh, voile::engine::make_sphere(k_start, k_radius, 24), true);
    add(mesh, ball(1), true);
    return mesh;
}

// A ball with its top at the origin and a cavity.
voile::engine::Mesh hollow_ball()
{
    voile::engine::Mesh mesh = ball();
    add(mesh, voile::engine::make_sphere({0, -k_radius, 0}, 0.5f * k_radius, 24), true);
    return mesh;
}

// The functions of the tests' handles, but for a device that binds at most one MiB.
VKAPI_ATTR void VKAPI_CALL properties_of_small_buffers(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties)
{
    const voile::Handles& handles = tests::device().context().handles;
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
        handles.get_instance_proc_addr(handles.instance, "vkGetPhysicalDeviceProperties"));
    get(device, properties);
    properties->limits.maxStorageBufferRange = 1u << 20;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL find_function(VkInstance instance, const char* name)
{
    if (std::string_view(name) == "vkGetPhysicalDeviceProperties")
        return reinterpret_cast<PFN_vkVoidFunction>(properties_of_small_buffers);
    return tests::test_handles().get_instance_proc_addr(instance, name);
}

} // namespace

TEST_CASE("a collider larger than the device's buffers is refused, and the others keep working")
{
    voile::Handles handles = tests::test_handles();
    handles.get_instance_proc_addr = find_function;
    voile::Solver solver = voile::engine::take(voile::Solver::create(handles, {}));
    const voile::engine::Mesh small = voile::engine::make_sphere({0, 0, 0}, 1, 16);
    const voile::engine::Mesh large = voile::engine::make_sphere({0, 0, 0}, 1, 120); // 57,120 triangles
    CHECK(reason(solver.add_collider(collider(large))) ==
          "collider \"mesh\": 57120 triangles need buffers of 3 MiB, the device binds at most 1 MiB");
    CHECK(reason(solver.add_collider(tests::deforming(large))) ==
          "collider \"mesh\": 57120 triangles need buffers of 5 MiB, the device binds at most 1 MiB");
    CHECK(!solver.needs_upload());
    // Together they are too large, too: 11,400 triangles of 48 bytes each.
    const voile::engine::Mesh half = voile::engine::make_sphere({0, 0, 0}, 1, 54);
    CHECK(reason(solver.add_collider(collider(half))) == "accepted");
    CHECK(reason(solver.add_collider(collider(half))) ==
          "collider \"mesh\": 11448 triangles need buffers of 2 MiB, the device binds at most 1 MiB");
    CHECK(reason(solver.add_collider(collider(small))) == "accepted");
    CHECK(solver.needs_upload());
}

TEST_CASE("cloth rests on irregular balls")
{
    const std::vector<Drop> drops = {
        {.name = "inside-out", .mesh = turned(ball())},
        {.name = "a triangle twice", .mesh = ball_and_a_triangle()},
        {.name = "the first of two", .mesh = two_balls(false), .x = -0.5f},
        {.name = "the second of two", .mesh = two_balls(false), .x = 0.5f},
        {.name = "both inside-out", .mesh = turned(two_balls(false)), .x = 0.5f},
    };
    for (const bool deforms : {false, true})
    {
        const auto cloths = fallen(drops, deforms);
        for (size_t i = 0; i < drops.size(); ++i)
        {
            CAPTURE(drops[i].name);
            CAPTURE(deforms);
            check_lies_on_ball(cloths[i], drops[i].x);
        }
    }
}

TEST_CASE("cloth rests on a mesh with inside-out and hollow parts")
{
    const std::vector<Drop> drops = {
        {.name = "in a cavity", .mesh = hollow_ball_and_ball()},
        {.name = "beside the hollow one", .mesh = hollow_ball_and_ball(), .x = 1},
        {.name = "the right one of two", .mesh = two_balls(true), .x = -0.5f},
        {.name = "the inside-out one of two", .mesh = two_balls(true), .x = 0.5f},
        {.name = "the first of three", .mesh = three_balls(), .x = -1},
        {.name = "the right one of three", .mesh = three_balls()},
        {.name = "the last of three", .mesh = three_balls(), .x = 1},
        {.name = "a hollow ball", .mesh = hollow_ball()},
        {.name = "a hollow ball, inside-out", .mesh = turned(hollow_ball())},
    };
    for (const bool deforms : {false, true})
    {
        const auto cloths = fallen(drops, deforms);
        check_lies_in_cavity(cloths[0]);
        for (size_t i = 1; i < drops.size(); ++i)
        {
            CAPTURE(drops[i].name);
            CAPTURE(deforms);
            check_lies_on_ball(cloths[i], drops[i].x);
        }
    }
}

TEST_CASE("cloth rests on irregular grounds")
{
    const voile::engine::Mesh plain = voile::engine::make_ground(1);
    const glm::uvec3 first = plain.triangles[0];
    const std::vector<Drop> drops = {
        {.name = "faces down",
         .mesh = turned(plain),
         .sidedness = voile::Sidedness::one_sided}, // the cloth passes through its back
        {.name = "one side", .mesh = plain, .sidedness = voile::Sidedness::one_sided},
        {.name = "the other way round", .mesh = turned(plain)},
        {.name = "three triangles at an edge", .mesh = ridge_with_a_wall()},
        {.name = "three at an edge, two sides", .mesh = ridge_with_a_wall(), .sidedness = voile::Sidedness::two_sided},
        {.name = "a point and lines", .mesh = ground_and({{0, 0, 0}, {0, 1, 1}, {0, 3, 4}}, {{0, 0, 0}})},
        {.name = "a triangle twice", .mesh = ground_and({first})},
        {.name = "a triangle twice, once turned", .mesh = ground_and({{first.x, first.z, first.y}})},
        {.name = "vertices without triangles", .mesh = ground_and({}, {{0, 0.05f, 0}, {0, 1e6f, 0}})},
    };
    for (const bool deforms : {false, true})
    {
        const auto cloths = fallen(drops, deforms);
        for (const glm::vec4& p : cloths[0])
            CHECK(p.y < -0.5f);
        for (size_t i = 1; i < drops.size(); ++i)
        {
            CAPTURE(drops[i].name);
            CAPTURE(deforms);
            check_lies_flat(cloths[i]);
        }
    }
}

TEST_CASE("meshes that form no surface are refused with a reason")
{
    ClothHarness harness;
    const auto refused = [&](const voile::engine::Mesh& mesh)
    {
        const std::string still = reason(harness.solver.add_collider(collider(mesh)));
        CHECK(reason(harness.solver.add_collider(tests::deforming(mesh))) == still);
        return still;
    };
    const voile::engine::Mesh ground = voile::engine::make_ground(1);
    voile::engine::Mesh mesh = ground;
    mesh.triangles.clear();
    CHECK(refused(mesh) == "collider \"mesh\": the mesh has no triangles");
    mesh.triangles = {{0, 1, 1}, {2, 2, 2}};
    CHECK(refused(mesh) == "collider \"mesh\": none of its 2 triangles has an area");
    mesh.triangles = {{0, 2, 4}};
    CHECK(refused(mesh) == "collider \"mesh\": triangle 0 refers to position 4 of 4");
    mesh = ground;
    mesh.positions.emplace_back(0, std::numeric_limits<float>::quiet_NaN(), 0);
    CHECK(refused(mesh) == "collider \"mesh\": position 4 is not finite");
    CHECK(!harness.solver.needs_upload());
}
