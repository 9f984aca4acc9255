// Ranges of the input: values outside are refused with a line that names them, and no extreme of the ranges makes a
// vertex that is not finite.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/ranges.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::moved;
using tests::reason;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

// Picks one of a few values, deterministically.
class Corners
{
public:
    explicit Corners(uint32_t seed) : engine_(seed) {}

    template <typename T>
    T one_of(std::initializer_list<T> values)
    {
        return *(values.begin() + engine_() % values.size());
    }
    bool coin() { return engine_() % 2 == 0; }
    glm::vec3 vector(float most)
    {
        const auto component = [&] { return one_of({-most, 0.f, most}); };
        const float x = component();
        const float y = component();
        return {x, y, component()};
    }

private:
    std::mt19937 engine_;
};

voile::ClothMaterial random_material(Corners& corners)
{
    voile::Fabric fabric;
    fabric.areal_density = corners.one_of({1e-3f, 0.15f, 1e3f});
    fabric.stretch_stiffness = {corners.one_of({1e-2f, 1e3f, 1e7f}), corners.one_of({1e-2f, 1e3f, 1e7f})};
    fabric.shear_stiffness = corners.one_of({0.f, 100.f, 1e7f});
    fabric.bending_stiffness = corners.one_of({0.f, 1e-5f, 1e3f});
    fabric.damping_ratio = corners.one_of({0.f, 0.02f, 1.f});
    fabric.thickness = corners.one_of({1e-5f, 0.005f, 10.f});
    fabric.kinetic_friction = corners.one_of({0.f, 0.4f, 100.f});
    fabric.static_friction = std::max(fabric.kinetic_friction, corners.one_of({0.5f, 100.f}));
    fabric.air_drag_normal = corners.one_of({0.f, 1.28f, 100.f});
    fabric.air_drag_tangential = corners.one_of({0.f, 0.05f, 100.f});
    fabric.strain_limit = corners.one_of({0.f, 1e-3f, 10.f});
    fabric.bending_model = corners.coin() ? voile::BendingModel::springs : voile::BendingModel::isometric;
    return fabric;
}

// At the limit of the positions, scaled to a millionth or to the whole range, or of typical size.
glm::mat4 random_transform(Corners& corners, float size)
{
    const float scale = std::min(corners.one_of({1e-6f, 1.f, 1.f, 1e3f, 1e9f}), voile::k_most_coordinate / size);
    const float room = std::max(voile::k_most_coordinate - scale * size, 0.f);
    return glm::scale(moved(corners.vector(corners.coin() ? room : 0.3f)), glm::vec3(scale));
}

voile::GridCloth random_grid(Corners& corners)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = 5;
    grid.width = corners.one_of({1e-4f, 1.f, 1e5f});
    grid.depth = corners.one_of({1e-4f, 1.f, 1e5f});
    grid.transform = random_transform(corners, std::max(grid.width, grid.depth));
    grid.velocity = corners.vector(voile::k_most_speed);
    grid.material = random_material(corners);
    grid.integrator = corners.coin() ? voile::Integrator::rk4 : voile::Integrator::verlet;
    if (corners.coin())
        grid.pins = {0, 4};
    if (corners.coin())
        grid.inverse_masses.assign(25, corners.one_of({1e-6f, 1.f, 1e9f}));
    return grid;
}

void add_colliders(voile::Solver& solver, Corners& corners)
{
    const float most = voile::k_most_coordinate;
    const float small = voile::k_least_collider_size;
    const auto add = [&](const voile::Collider& collider) { (void)voile::engine::take(solver.add_collider(collider)); };
    add(voile::SphereCollider{.center = corners.vector(0.1f), .radius = corners.one_of({small, 0.3f, 1e6f})});
    add(voile::SphereCollider{.center = corners.vector(most),
                              .radius = corners.one_of({small, voile::k_most_collider_size})});
    const glm::vec3 end = corners.vector(0.2f);
    add(voile::CapsuleCollider{.from = end, .to = corners.coin() ? end : corners.vector(most), .radius = small});
    add(voile::PlaneCollider{.offset = corners.one_of({-most, 0.f, most})});
    voile::BoxCollider box{.min = -corners.one_of({0.2f, most}) * glm::vec3(1)};
    box.max = corners.coin() ? box.min + glm::vec3(2 * small) : -box.min;
    if (box.min.x == -most)
        box.max = corners.coin() ? glm::vec3(0) : box.min + glm::vec3(1);
    add(box);
}

glm::mat4 random_teleport(Corners& corners)
{
    const float scale = corners.one_of({-voile::k_most_scale, 0.f, voile::k_most_scale});
    return glm::scale(moved(corners.vector(2 * voile::k_most_coordinate)), glm::vec3(scale));
}

// A sheet on springs, one on max-distance constraints and one pinned, all three on a moving anchor.
class Attached
{
public:
    Attached(voile::Solver& solver, Corners& corners)
        : scale_(corners.one_of({1e-3f, 1.f, voile::k_most_scale})),
          anchor_(voile::engine::take(solver.add_anchor(glm::scale(glm::mat4(1), glm::vec3(scale_)))))
    {
        voile::Attachment spring;
        spring.stiffness = voile::k_most_attachment_stiffness;
        spring.damping = corners.one_of({0.f, voile::k_most_attachment_damping});
        voile::Attachment limit;
        limit.stiffness = 0;
        limit.max_distance = 0;
        limit.backstop_normal = {0, 1, 0};
        limit.backstop = corners.one_of({-voile::k_most_coordinate, 0.f, voile::k_most_coordinate});
        for (voile::Attachment attachment : {spring, limit, voile::Attachment{}})
        {
            attachment.anchor = anchor_;
            if (corners.coin())
                attachment.position = corners.vector(voile::k_most_coordinate / std::max(scale_, 1.f));
            voile::GridCloth grid = flat_sheet(4, 1, 0);
            grid.material = random_material(corners);
            ids_.push_back(voile::engine::take(solver.add_cloth(grid)));
            voile::engine::take(solver.set_attachments(ids_.back(), {&attachment, 1}));
        }
    }

    // As fast as the host may move it within the world.
    void move(voile::Solver& solver, Corners& corners, float duration)
    {
        const glm::vec3 bound(voile::k_most_coordinate);
        origin_ = glm::clamp(origin_ + corners.vector(voile::k_most_speed * duration), -bound, bound);
        voile::engine::take(solver.move_anchor(anchor_, glm::scale(moved(origin_), glm::vec3(scale_))));
        for (const voile::ClothId id : ids_)
            voile::engine::take(solver.reset(id));
    }

private:
    glm::vec3 origin_{0.f};
    float scale_; // of the anchor's space
    voile::AnchorId anchor_;
    std::vector<voile::ClothId> ids_;
};

voile::Step random_step(Corners& corners)
{
    voile::Step step;
    step.duration = corners.one_of({voile::k_least_duration, 1.f / 60, voile::k_most_duration});
    step.substeps = corners.one_of({0u, 1u, 5u});
    step.max_substeps = corners.one_of({1u, 6u});
    step.gravity = corners.vector(voile::k_most_gravity);
    step.wind = corners.vector(voile::k_most_wind);
    step.gust = corners.one_of({0.f, voile::k_most_gust});
    step.gust_length = corners.one_of({voile::k_least_gust_length, 4.f, voile::k_most_gust_length});
    step.time = corners.one_of({-voile::k_most_time, 0.0, voile::k_most_time});
    step.air_density = corners.one_of({0.f, 1.225f, voile::k_most_air_density});
    return step;
}

} // namespace

TEST_CASE("a step out of range is refused by name, and nothing is recorded")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(4, 0.3f, 0)));
    harness.upload();
    const auto start = harness.positions(id);
    voile::engine::take(harness.solver.set_velocity(id, {3, 0, 0}));
    struct Case
    {
        voile::Step step;
        std::string message;
    };
    const Case cases[] = {
        {{.duration = 0}, "duration is 0 s, must be 1e-06 to 10"},
        {{.duration = -1}, "duration is -1 s, must be 1e-06 to 10"},
        {{.duration = k_nan}, "duration is nan s, must be 1e-06 to 10"},
        {{.duration = k_infinity}, "duration is inf s, must be 1e-06 to 10"},
        {{.substeps = 1'000'001}, "substeps is 1000001, must be 0 to 1000000"},
        {{.max_substeps = 0}, "max_substeps is 0, must be 1 to 1000000"},
        {{.softened_strain_limit = 1e-4f}, "softened_strain_limit is 0.0001, must be 0.001 to 10, or 0 for none"},
        {{.softened_strain_limit = k_nan}, "softened_strain_limit is nan, must be 0.001 to 10, or 0 for none"},
        {{.gravity = {0, -1e30f, 0}}, "gravity is (0, -1e+30, 0) m/s^2, each must be -10000 to 10000"},
        {{.gravity = {0, k_nan, 0}}, "gravity is (0, nan, 0) m/s^2, each must be -10000 to 10000"},
        {{.wind = {1e20f, 0, 0}}, "wind is (1e+20, 0, 0) m/s, each must be -1000 to 1000"},
        {{.gust = -0.1f}, "gust is -0.1, must be 0 to 10"},
        {{.gust_length = 1e-38f}, "gust_length is 1e-38 m, must be 0.01 to 1e+06"},
        {{.gust_length = 0}, "gust_length is 0 m, must be 0.01 to 1e+06"},
        {{.time = std::numeric_limits<double>::infinity()}, "time is inf s, must be -1e+09 to 1e+09"},
        {{.air_density = -1}, "air_density is -1 kg/m^3, must be 0 to 100000"},
    };
    for (const Case& c : cases)
    {
        CHECK(reason(voile::validate(c.step)) == "step: " + c.message);
        harness.run([&](VkCommandBuffer cmd)
                    { CHECK(reason(harness.solver.record(cmd, c.step)) == "step: " + c.message); });
        CHECK(harness.solver.dispatches(c.step) == 0);
        CHECK(harness.solver.stability(id, c.step).used == 0);
    }
    CHECK(harness.solver.stable_substeps(k_nan) == 0);
    CHECK(harness.solver.stable_substeps(-1) == 0);
    const auto after = harness.positions(id);
    for (size_t i = 0; i < start.size(); ++i)
        CHECK(after[i] == start[i]);
    harness.step({.gravity = glm::vec3(0)}); // pending changes are still pending
    CHECK(harness.velocities(id)[5].x == tests::close_to(3, 1e-5));
}

TEST_CASE("positions, velocities and frames out of range are refused by name")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const auto grid = [&](const std::function<void(voile::GridCloth&)>& spoil)
    {
        voile::GridCloth description = flat_sheet(3, 1, 0);
        spoil(description);
        return reason(solver.add_cloth(description));
    };
    CHECK(grid(
              [](auto& g) {
                  g.velocity = {0, 1e20f, 0};
              }) == "cloth \"cloth\": velocity is (0, 1e+20, 0) m/s, each must be -10000 to 10000");
    CHECK(grid([](auto& g) { g.transform[0].x = 1e18f; }) ==
          "cloth \"cloth\": its transform takes vertex 0 to (-5e+17, 0, -0.5), each must be -1e+06 to 1e+06 m");
    CHECK(grid([](auto& g) { g.transform[3].z = k_nan; }) == "cloth \"cloth\": its transform is not finite");
    CHECK(grid([](auto& g) { g.transform[3].w = 2; }) == "cloth \"cloth\": its transform's last row is not 0 0 0 1");

    const char* const flattened = ", they must be at least 1e-07 long and not parallel";
    CHECK(grid(
              [](auto& g) {
                  g.transform[0] = {0, 0, 0, 0};
              }) ==
          std::string("cloth \"cloth\": its transform takes the axes x and z to (0, 0, 0) and (0, 0, 1)") + flattened);
    CHECK(grid([](auto& g) { g.transform[2] = 2.f * g.transform[0]; }) ==
          std::string("cloth \"cloth\": its transform takes the axes x and z to (1, 0, 0) and (2, 0, 0)") + flattened);

    CHECK(grid([](auto& g) { g.integrator = static_cast<voile::Integrator>(9); }) ==
          "cloth \"cloth\": integrator is 9, must be rk4 or verlet");
    CHECK(grid([](auto& g) { g.material = voile::Fabric{.bending_model = static_cast<voile::BendingModel>(7)}; }) ==
          "cloth \"cloth\": fabric: bending_model is 7, must be springs or isometric");

    const voile::ClothId id = voile::engine::take(solver.add_cloth(flat_sheet(3, 1, 0)));
    CHECK(reason(solver.set_velocity(id, {1e20f, 0, 0})) ==
          "cloth \"cloth\": velocity is (1e+20, 0, 0) m/s, each must be -10000 to 10000");
    CHECK(reason(solver.teleport(id, glm::scale(glm::mat4(1), glm::vec3(1e18f)))) ==
          "cloth \"cloth\": an axis of its transform is (1e+18, 0, 0), each must be -1000 to 1000");
    CHECK(reason(solver.teleport(id, moved({0, 1e7f, 0}))) ==
          "cloth \"cloth\": its transform's translation is (0, 1e+07, 0) m, each must be -2e+06 to 2e+06");
    CHECK(reason(solver.add_anchor(moved({1e7f, 0, 0}))) ==
          "anchor: its transform's translation is (1e+07, 0, 0) m, each must be -1e+06 to 1e+06");
    CHECK(reason(solver.add_anchor(glm::scale(glm::mat4(1), glm::vec3(1e-5f)))) ==
          "anchor: its transform's determinant is 1e-15, must be 1e-09 to 1e+09");

    const auto refused = [&](const voile::Collider& collider) { return reason(solver.add_collider(collider)); };
    CHECK(refused(voile::SphereCollider{.center = {1e18f, 0, 0}}) ==
          "collider \"sphere\": center is (1e+18, 0, 0) m, each must be -1e+06 to 1e+06");
    CHECK(refused(voile::SphereCollider{.radius = 1e18f}) ==
          "collider \"sphere\": radius is 1e+18 m, must be 0.0001 to 2e+06");
    CHECK(refused(voile::CapsuleCollider{.radius = 0}) ==
          "collider \"capsule\": radius is 0 m, must be 0.0001 to 2e+06");
    CHECK(refused(voile::PlaneCollider{.normal = {0, 2, 0}}) ==
          "collider \"plane\": the plane's normal (0, 2, 0) is not of unit length");
    CHECK(refused(voile::PlaneCollider{.offset = k_infinity}) ==
          "collider \"plane\": offset is inf m, must be -1e+06 to 1e+06");
    CHECK(refused(voile::BoxCollider{.max = {0.5f, 0.5f, 2e6f}}) ==
          "collider \"box\": max is (0.5, 0.5, 2e+06) m, each must be -1e+06 to 1e+06");
    CHECK(refused(voile::BoxCollider{.max = {0.5f, -0.5f, 0.5f}}) ==
          "collider \"box\": the side along y is 0 m, must be 0.0001 to 2e+06");
    CHECK(refused(voile::BoxCollider{.transform = moved({0, 0, -3e6f})}) ==
          "collider \"box\": a corner is (-0.5, -0.5, -3e+06) m, each must be -1e+06 to 1e+06");
    CHECK(refused(voile::BoxCollider{.transform = moved({1e6f, 0, 0})}) ==
          "collider \"box\": a corner is (1e+06, -0.5, -0.5) m, each must be -1e+06 to 1e+06");
    CHECK(refused(voile::SphereCollider{.friction = voile::Friction{200, 0.1f}}) ==
          "collider \"sphere\": static_friction is 200, must be 0 to 100");
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    const std::vector<glm::uvec3> triangle{{0, 1, 2}};
    const std::vector<glm::vec2> coordinates{{0, 0}, {k_nan, 0}, {0, 1}};
    CHECK(reason(solver.add_cloth(
              voile::MeshCloth{.positions = corners, .triangles = triangle, .texture_coordinates = coordinates})) ==
          "cloth \"cloth\": texture coordinate 1 is nan 0.000000, must be within 1e6");
    CHECK(refused(voile::MeshCollider{
              .positions = corners, .triangles = triangle, .transform = glm::scale(glm::mat4(1), glm::vec3(1e18f))}) ==
          "collider \"mesh\": its transform takes position 1 to (1e+18, 0, 0), each must be -1e+06 to 1e+06 m");
    CHECK(refused(voile::MeshCollider{
              .positions = corners, .triangles = triangle, .sidedness = static_cast<voile::Sidedness>(9)}) ==
          "collider \"mesh\": sidedness is 9, must be automatic, one_sided or two_sided");

    const voile::ColliderId ball = voile::engine::take(solver.add_collider(voile::SphereCollider{}));
    CHECK(reason(solver.move_collider(ball, moved({0, 2e6f, 0}))) ==
          "collider 0: its center is (0, 2e+06, 0) m, each must be -1e+06 to 1e+06");
    const voile::ColliderId sheet = voile::engine::take(
        solver.add_collider(voile::MeshCollider{.positions = corners, .triangles = triangle, .deforms = true}));
    const std::vector<glm::vec3> far{{0, 0, 0}, {1, 0, 0}, {0, 0, 1e9f}};
    CHECK(reason(solver.deform_collider(sheet, far)) ==
          "collider 1: position 2 is at (0, 0, 1e+09), each must be -1e+06 to 1e+06 m");
}

TEST_CASE("a mesh cloth with triangles out of range is refused by name")
{
    ClothHarness harness;
    // A quad, and above it a triangle with two sides of these lengths.
    const auto add = [&](float scale, float short_side, float long_side)
    {
        const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0},         {0, 0, 1},         {1, 0, 1},
                                               {0, 1, 0}, {long_side, 1, 0}, {0, 1, short_side}};
        const std::vector<glm::uvec3> triangles{{0, 2, 1}, {1, 2, 3}, {4, 6, 5}};
        return reason(harness.solver.add_cloth(voile::MeshCloth{
            .positions = positions, .triangles = triangles, .transform = glm::scale(glm::mat4(1), glm::vec3(scale))}));
    };
    CHECK(add(1e-8f, 1, 1) ==
          "cloth \"cloth\": the longest side of triangle 0 is 1.41421e-08 m, must be 0.0001 to 100000");
    CHECK(add(1, 1e-6f, 1e-6f) ==
          "cloth \"cloth\": the longest side of triangle 2 is 1.41421e-06 m, must be 0.0001 to 100000");
    CHECK(add(3e5f, 1, 1) == "cloth \"cloth\": the longest side of triangle 0 is 424264 m, must be 0.0001 to 100000");
    CHECK(add(1, 1e-6f, 1e-3f) == "accepted");
    CHECK(add(1, 0, 1e-6f) == "accepted"); // without area
    CHECK(add(1e-4f, 1, 1) == "accepted");
}

TEST_CASE("mesh cloths of the smallest triangles, and slivers of them, stay finite in frames")
{
    for (const uint32_t seed : {3u, 5u, 8u, 21u})
    {
        CAPTURE(seed);
        Corners corners(seed);
        ClothHarness harness;
        std::vector<voile::ClothId> ids;
        for (const float height : {1.f, 1e-2f, 3e-4f})
            for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
            {
                const std::vector<glm::vec3> positions{
                    {0, 0, 0}, {1, 0, 0}, {0, 0, height}, {1, 0, height}, {0.5f, 0, -1e-4f}};
                const std::vector<glm::uvec3> triangles{{0, 2, 1}, {1, 2, 3}, {0, 1, 4}}; // the last has no area
                voile::MeshCloth mesh;
                mesh.positions = positions;
                mesh.triangles = triangles;
                mesh.transform = glm::scale(moved(corners.vector(0.3f)), glm::vec3(1.001e-4f));
                mesh.velocity = corners.vector(corners.one_of({0.f, voile::k_most_speed}));
                mesh.material = random_material(corners);
                mesh.integrator = integrator;
                ids.push_back(voile::engine::take(harness.solver.add_cloth(mesh)));
                CHECK(harness.solver.mesh_report(ids.back()).degenerate_triangles == 1);
            }
        (void)voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.3f}));
        harness.upload();
        for (int round = 0; round < 12; ++round)
        {
            CAPTURE(round);
            for (const voile::ClothId id : ids)
                voile::engine::take(harness.solver.reset(id));
            voile::Step step = random_step(corners);
            step.duration = std::min(step.duration, 1.f / 60);
            harness.step(step, 3);
            CHECK(harness.statistics().nan_vertices == 0);
        }
    }
}

TEST_CASE("no extreme of the ranges makes a vertex that is not finite")
{
    for (const uint32_t seed : {2u, 6u, 13u})
    {
        CAPTURE(seed);
        Corners corners(seed);
        ClothHarness harness;
        voile::Solver& solver = harness.solver;
        std::vector<voile::ClothId> ids;
        for (int i = 0; i < 12; ++i)
            ids.push_back(voile::engine::take(solver.add_cloth(random_grid(corners))));
        add_colliders(solver, corners);
        Attached attached(solver, corners);
        harness.upload();
        for (int round = 0; round < 8; ++round)
        {
            CAPTURE(round);
            for (const voile::ClothId id : ids)
            {
                voile::engine::take(solver.reset(id));
                if (corners.coin())
                    voile::engine::take(solver.set_velocity(id, corners.vector(voile::k_most_speed)));
                if (corners.coin())
                    voile::engine::take(solver.teleport(id, random_teleport(corners)));
            }
            const voile::Step step = random_step(corners);
            attached.move(solver, corners, step.duration);
            harness.step(step, 3);
            CHECK(harness.statistics().nan_vertices == 0);
        }
    }
}
