// Intersections of cloths and colliders: the count on the GPU equals an exact count on the CPU.
#include "support/collider_scenes.hpp"
#include "support/intersection_harness.hpp"

#include "colliders/collider_motion.hpp"
#include "colliders/mesh_input.hpp"
#include "voile/engine/assets/shapes.hpp"

#include <cmath>

using tests::IntersectionHarness;

namespace
{

constexpr voile::Step k_short{.duration = 1e-6f, .substeps = 1};

// A vertex of a collider in the world as statistics.hpp defines it: every operation rounds to float.
glm::vec3 cross_rounded(const glm::vec3& a, const glm::vec3& b)
{
    return glm::vec3(a.y * b.z, a.z * b.x, a.x * b.y) - glm::vec3(a.z * b.y, a.x * b.z, a.y * b.x);
}

glm::vec3 posed(const voile::shared::ColliderMotion& motion, const glm::vec3& v)
{
    const glm::vec3 axis(motion.rotation_to);
    const glm::vec3 inner = cross_rounded(axis, v) + motion.rotation_to.w * v;
    const glm::vec3 turned = v + 2.f * cross_rounded(axis, inner);
    return motion.origin + (motion.offset_to + turned);
}

// The motion of a collider that was added at `placement` and takes its first step.
voile::shared::ColliderMotion motion_of(const glm::dvec3& origin, const glm::mat4& placement, const glm::mat4& pose)
{
    voile::ColliderModel model;
    model.origin = origin;
    model.placement = placement;
    model.pose.to = pose;
    return voile::make_motion(model);
}

// A mesh collider as the solver has it, at the pose at which it was added or moved by `pose`.
tests::ExactMesh exact_mesh_of(const voile::MeshCollider& collider, const std::optional<glm::mat4>& pose = {})
{
    const voile::MeshInput mesh = voile::engine::take(voile::prepare_mesh(collider));
    std::vector<glm::vec3> world;
    for (const glm::vec3& p : mesh.positions)
        world.push_back(pose ? posed(motion_of(mesh.origin, glm::mat4(1), *pose), p) : mesh.origin + p);
    return tests::exact_mesh(world, mesh.triangles, !collider.deforms);
}

// Each face is cut between its two corners with an even number of upper coordinates.
tests::ExactMesh exact_box(const voile::BoxCollider& box, bool moved)
{
    const glm::dvec3 origin = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    const glm::vec3 half(0.5 * (glm::dvec3(box.max) - glm::dvec3(box.min)));
    std::vector<glm::vec3> corners;
    for (uint32_t k = 0; k < 8; ++k)
    {
        const glm::vec3 v = half * glm::vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
        corners.push_back(moved ? posed(motion_of(origin, box.transform, glm::mat4(1)), v) : glm::vec3(origin) + v);
    }
    return tests::exact_mesh(corners, {{0, 3, 1},
                                       {0, 3, 2},
                                       {4 ^ 1, 4 ^ 2, 4},
                                       {5, 6, 7},
                                       {0, 5, 1},
                                       {0, 5, 4},
                                       {3, 6, 2},
                                       {3, 6, 7},
                                       {0, 6, 2},
                                       {0, 6, 4},
                                       {3, 5, 1},
                                       {3, 5, 7}});
}

uint64_t check(IntersectionHarness& harness, voile::ClothId cloth, const tests::ExactMesh& collider)
{
    const voile::IntersectionCounts found = harness.counts();
    CHECK(found.uncertain_pairs == 0);
    CHECK(found.collider_pairs == tests::count_pairs_both_ways(harness.exact(cloth), collider));
    return found.collider_pairs;
}

// Flat, crumpled, and of few large triangles, through a collider of about 1 m at the origin.
std::vector<std::vector<glm::vec3>> positions_through(const std::vector<glm::vec4>& flat, const glm::vec3& center = {})
{
    std::vector<std::vector<glm::vec3>> result(3);
    for (const glm::vec4& p : flat)
    {
        result[0].push_back(center + 0.9f * glm::vec3(p.x, 0.05f, p.z));
        result[1].push_back(center + glm::vec3(0, p.x, 0.5f * p.z)); // along the axes
    }
    result[2] = tests::random_positions(flat.size(), 6, 0.6f, center);
    return result;
}

double distance_to_triangle(const glm::dvec3& p, const tests::TriangleCorners& t)
{
    const auto to_edge = [&](size_t i)
    {
        const glm::dvec3 a(t[i]);
        const glm::dvec3 d = glm::dvec3(t[(i + 1) % 3]) - a;
        return glm::distance(p, a + glm::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0) * d);
    };
    double nearest = std::min({to_edge(0), to_edge(1), to_edge(2)});
    const glm::dvec3 a(t[0]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(t[1]) - a, glm::dvec3(t[2]) - a);
    const glm::dvec3 foot = p - glm::dot(p - a, normal) / glm::dot(normal, normal) * normal;
    bool inside = true;
    for (size_t i = 0; i < 3; ++i)
        inside = inside && glm::dot(glm::cross(glm::dvec3(t[(i + 1) % 3]) - glm::dvec3(t[i]), foot - glm::dvec3(t[i])),
                                    normal) >= 0;
    return inside ? std::min(nearest, glm::distance(p, foot)) : nearest;
}

// The distance of points of the segment is convex, so a search by thirds finds the smallest one.
double distance_to_segment(const glm::dvec3& from, const glm::dvec3& to, const tests::TriangleCorners& t)
{
    double low = 0;
    double high = 1;
    const auto at = [&](double s) { return distance_to_triangle(glm::mix(from, to, s), t); };
    for (int i = 0; i < 100; ++i)
    {
        const double third = (high - low) / 3;
        (at(low + third) < at(high - third) ? high : low) += at(low + third) < at(high - third) ? -third : third;
    }
    return at(low);
}

template <typename Meets>
uint64_t count_triangles(const tests::ExactMesh& mesh, const Meets& meets)
{
    return static_cast<uint64_t>(std::count_if(
        mesh.triangles.begin(), mesh.triangles.end(),
        [&](const glm::uvec3& t) {
            return meets(tests::TriangleCorners{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
        }));
}

} // namespace

TEST_CASE("a sheet through a rigid mesh, closed or open, intersects it as an exact count says")
{
    // Spheres have a seam of coincident vertices.
    const voile::engine::Mesh sphere = voile::engine::make_sphere({0.1f, 0.02f, 0}, 0.4f, 12);
    voile::engine::Mesh open;
    const tests::ClothMesh sheet = tests::jittered_sheet(9, 9);
    open.triangles = sheet.triangles;
    for (const glm::vec3& p : sheet.positions)
        open.positions.emplace_back(2.f * p.x - 0.4f, p.z - 0.2f, p.y + 0.9f * p.x - 0.2f);
    for (const voile::engine::Mesh* mesh : {&sphere, static_cast<const voile::engine::Mesh*>(&open)})
        for (const float distance : {0.f, 10000.f})
        {
            voile::MeshCollider collider = tests::collider(*mesh);
            collider.transform = tests::moved({distance, 0, -distance});
            IntersectionHarness harness;
            const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(tests::flat_grid(9, 12)));
            voile::engine::take(harness.solver.add_collider(collider));
            harness.upload();
            for (const auto& positions : positions_through(harness.positions(cloth), {distance, 0, -distance}))
            {
                harness.place(cloth, positions);
                CHECK(check(harness, cloth, exact_mesh_of(collider)) > 20);
            }
        }
}

TEST_CASE_FIXTURE(IntersectionHarness, "a collider that moved intersects cloth where it is at the end of the step")
{
    const voile::engine::Mesh sphere = voile::engine::make_sphere({0.1f, 0.02f, 0}, 0.4f, 12);
    const voile::MeshCollider collider = tests::collider(sphere);
    const voile::ClothId cloth = voile::engine::take(solver.add_cloth(tests::flat_grid(9, 12)));
    upload();
    const std::vector<glm::vec4> flat = positions(cloth);
    const glm::mat4 translation = tests::moved({3, -0.25f, 0.7f});
    for (const glm::mat4& pose : {translation, glm::rotate(translation, 2.f, glm::normalize(glm::vec3(1, 2, -0.5f)))})
    {
        const voile::ColliderId moving = voile::engine::take(solver.add_collider(collider));
        upload();
        voile::engine::take(solver.move_collider(moving, pose));
        step(k_short);
        for (const auto& points : positions_through(flat, {3, -0.25f, 0.7f}))
        {
            place(cloth, points);
            CHECK(check(*this, cloth, exact_mesh_of(collider, pose)) > 50);
        }
        voile::engine::take(solver.remove(moving));
        step(k_short);
    }
}

TEST_CASE_FIXTURE(IntersectionHarness, "a deforming collider intersects cloth where its vertices are")
{
    voile::engine::Mesh mesh = voile::engine::make_sphere({0, 0, 0}, 0.5f, 10);
    const auto on_lattice = [](glm::vec3 p) { return glm::round(p * 1024.f) / 1024.f; }; // exact in every space
    for (glm::vec3& p : mesh.positions)
        p = on_lattice(p);
    const voile::ClothId cloth = voile::engine::take(solver.add_cloth(tests::flat_grid(9, 12)));
    const voile::ColliderId collider = voile::engine::take(solver.add_collider(tests::deforming(mesh)));
    upload();
    const std::vector<glm::vec4> flat = positions(cloth);
    for (const float stretch : {1.f, 0.75f, 1.5f})
    {
        std::vector<glm::vec3> deformed;
        for (const glm::vec3& p : mesh.positions)
            deformed.push_back(on_lattice({p.x * stretch, p.y, p.z + 0.25f * p.x * p.x}));
        if (stretch != 1)
        {
            voile::engine::take(solver.deform_collider(collider, deformed));
            step(k_short);
        }
        const std::vector<glm::vec3>& now = stretch != 1 ? deformed : mesh.positions;
        const voile::MeshInput input = voile::engine::take(voile::prepare_mesh(tests::deforming(mesh)));
        for (const auto& points : positions_through(flat))
        {
            place(cloth, points);
            CHECK(check(*this, cloth, tests::exact_mesh(now, input.triangles)) > 50);
        }
    }
}

TEST_CASE("a sheet through a box intersects its twelve triangles")
{
    voile::BoxCollider box{.min = {-0.5f, -0.25f, -0.375f}, .max = {0.25f, 0.25f, 0.375f}};
    for (const bool turned : {false, true})
    {
        if (turned)
            box.transform =
                glm::rotate(tests::moved({0.05f, -0.03f, 0.02f}), 0.7f, glm::normalize(glm::vec3(1, -1, 3)));
        IntersectionHarness harness;
        const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(tests::flat_grid(9, 12)));
        voile::engine::take(harness.solver.add_collider(box));
        harness.upload();
        // From before the step: rounding in it may leave 1e-19 m in place of 0, which is too small beside the box.
        const std::vector<glm::vec4> flat = harness.positions(cloth);
        harness.step(k_short);
        for (const auto& positions : positions_through(flat))
        {
            harness.place(cloth, positions);
            CHECK(check(harness, cloth, exact_box(box, turned)) > 20);
        }
    }
}

TEST_CASE("triangles that touch a sphere, a capsule or a half space are counted")
{
    const glm::vec3 from(-0.3f, -0.1f, 0.2f);
    const glm::vec3 to(0.25f, 0.2f, -0.1f);
    const glm::vec3 up = glm::normalize(glm::vec3(1, 2, 3));
    const voile::Collider colliders[] = {voile::SphereCollider{.center = from, .radius = 0.35f},
                                         voile::CapsuleCollider{.from = from, .to = to, .radius = 0.15f},
                                         voile::PlaneCollider{.normal = up, .offset = -0.125f}};
    for (size_t kind = 0; kind < 3; ++kind)
        for (const bool moved : {false, true})
        {
            IntersectionHarness harness;
            const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(tests::flat_grid(21, 22)));
            const voile::ColliderId collider = voile::engine::take(harness.solver.add_collider(colliders[kind]));
            harness.upload();
            const std::vector<glm::vec4> flat = harness.positions(cloth);
            const glm::mat4 pose =
                moved ? glm::rotate(tests::moved({0.1f, 0.2f, -0.1f}), 1.f, glm::vec3(0, 1, 0)) : glm::mat4(1);
            if (moved)
                voile::engine::take(harness.solver.move_collider(collider, pose));
            harness.step(k_short);
            const glm::dmat4 world(pose);
            const glm::dvec3 a(world * glm::dvec4(from, 1));
            const glm::dvec3 b(world * glm::dvec4(to, 1));
            const glm::dvec3 back_up = glm::dmat3(world) * glm::dvec3(up);
            const double offset = -0.125 + glm::dot(back_up, glm::dvec3(world[3]));
            const auto meets = [&](const tests::TriangleCorners& t)
            {
                if (kind == 0)
                    return distance_to_triangle(a, t) <= 0.35;
                if (kind == 1)
                    return distance_to_segment(a, b, t) <= 0.15;
                return std::any_of(t.begin(), t.end(),
                                   [&](const glm::vec3& p) { return glm::dot(back_up, glm::dvec3(p)) <= offset; });
            };
            for (const auto& positions : positions_through(flat))
            {
                harness.place(cloth, positions);
                const voile::IntersectionCounts found = harness.counts();
                const uint64_t expected = count_triangles(harness.exact(cloth), meets);
                CHECK(expected > 5);
                CHECK(expected < 40 * 21);
                CHECK(found.uncertain_pairs == 0);
                CHECK(found.collider_pairs == expected);
            }
        }
}

TEST_CASE_FIXTURE(IntersectionHarness, "a triangle that touches a solid to within rounding is uncertain, and counts")
{
    const voile::ClothId cloth = voile::engine::take(solver.add_cloth(tests::flat_grid(3, 3)));
    voile::engine::take(solver.add_collider(voile::SphereCollider{.center = {0.01f, 1, 0.02f}, .radius = 1}));
    upload();
    CHECK(counts().uncertain_pairs == 1);
    CHECK(counts().collider_pairs == 1);
    const std::vector<glm::vec4> flat = positions(cloth);
    for (const float height : {1e-5f, -1e-5f})
    {
        std::vector<glm::vec3> points;
        for (const glm::vec4& p : flat)
            points.emplace_back(p.x, height, p.z);
        place(cloth, points);
        CHECK(counts().uncertain_pairs == 0);
        CHECK(counts().collider_pairs == (height > 0 ? 1 : 0));
    }
}

TEST_CASE_FIXTURE(IntersectionHarness,
                  "one vertex pushed a micrometer through a collider is seen, unless no layer is shared")
{
    const voile::engine::Mesh mesh = voile::engine::make_box({-1, 0.5f, -1}, {1, 0.75f, 1});
    const voile::ClothId cloth = voile::engine::take(solver.add_cloth(tests::flat_grid(9, 9, {0.01f, 0.755f, 0.02f})));
    const voile::ColliderId collider = voile::engine::take(solver.add_collider(tests::collider(mesh)));
    upload();
    CHECK(counts().collider_pairs == 0);
    const std::vector<glm::vec4> flat = positions(cloth);
    std::vector<glm::vec3> points(flat.begin(), flat.end());
    points[40].y = 0.75f + 1e-6f;
    place(cloth, points);
    CHECK(counts().collider_pairs == 0);
    points[40].y = 0.75f - 1e-6f;
    place(cloth, points);
    CHECK(check(*this, cloth, exact_mesh_of(tests::collider(mesh))) == 6);
    const std::vector<uint32_t> marked = marks(cloth);
    CHECK(marked[40] == 2);
    CHECK(std::count(marked.begin(), marked.end(), 2u) == 7);
    voile::engine::take(solver.set_layers(collider, 2));
    step(k_short); // takes effect with a step
    place(cloth, points);
    CHECK(counts().collider_pairs == 0);
    CHECK(marks(cloth)[40] == 0);
}
