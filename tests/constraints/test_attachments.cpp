// Attachments, anchors and tethers: pins that move and change, springs, maximum distances, backstops, and what they
// refuse.
#include "support/airless_sheet.hpp"
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace
{

using tests::airless_sheet;
using tests::ClothHarness;

glm::mat4 at(const glm::vec3& position, float degrees = 0)
{
    glm::mat4 m(1.f);
    const float angle = degrees * 3.14159265f / 180;
    m[0] = {std::cos(angle), 0, -std::sin(angle), 0};
    m[2] = {std::sin(angle), 0, std::cos(angle), 0};
    m[3] = glm::vec4(position, 1);
    return m;
}

std::string message(const voile::Result<void>& result)
{
    return result ? "" : result.error().message;
}

} // namespace

TEST_CASE("pins follow an anchor exactly, move with its velocity, and stop with it")
{
    for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        CAPTURE(int(integrator));
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(8);
        grid.integrator = integrator;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        const voile::AnchorId rod = voile::engine::take(harness.solver.add_anchor(at({0, 2, -0.5f})));
        std::vector<voile::Attachment> attachments;
        for (uint32_t column = 0; column < 8; ++column)
        {
            voile::Attachment attachment = voile::pin(column, rod);
            if (column % 2 == 0) // the others stay where they are as seen from the rod
                attachment.position = glm::vec3(static_cast<float>(column) / 7 - 0.5f, 0, 0);
            attachments.push_back(attachment);
        }
        voile::engine::take(harness.solver.set_attachments(id, attachments));
        harness.upload();
        for (int frame = 1; frame <= 30; ++frame)
        {
            const glm::vec3 position(0.02f * static_cast<float>(frame), 2, -0.5f);
            const glm::mat4 transform = at(position, 2 * static_cast<float>(frame));
            voile::engine::take(harness.solver.move_anchor(rod, transform));
            const auto before = harness.positions(id);
            harness.step({});
            const auto x = harness.positions(id);
            const auto v = harness.velocities(id);
            for (uint32_t column = 0; column < 8; ++column)
            {
                const glm::vec3 expected = transform * glm::vec4(static_cast<float>(column) / 7 - 0.5f, 0, 0, 1);
                // Each step adds its velocity substep by substep: their rounding, 2^-24 of 2 m each. A pin that goes on
                // from where it is keeps that of the steps before.
                const double substeps = harness.solver.stable_substeps(1.f / 60);
                const double bound = 2 * std::exp2(-24) * substeps * (column % 2 == 0 ? 1 : frame);
                CHECK(static_cast<double>(glm::distance(glm::vec3(x[column]), expected)) < bound);
                CHECK(static_cast<double>(glm::distance(glm::vec3(v[column]),
                                                        60.f * (expected - glm::vec3(before[column])))) < 60 * bound);
                CHECK(x[column].w == 0);
            }
        }
        harness.step({}, 2); // the rod rests
        const auto x = harness.positions(id);
        harness.step({});
        for (uint32_t column = 0; column < 8; ++column)
        {
            CHECK(harness.velocities(id)[column] == glm::vec4(0));
            CHECK(harness.positions(id)[column] == x[column]);
        }
        CHECK(harness.statistics().nan_vertices == 0);
    }
}

TEST_CASE("attachments are made by functions that name them")
{
    constexpr float k_infinity = std::numeric_limits<float>::infinity();
    const voile::AnchorId hand{3};
    const voile::Attachment pin = voile::pin(7, hand, {1, 2, 3});
    CHECK(pin.vertex == 7);
    CHECK(pin.anchor == hand);
    CHECK(pin.position == glm::vec3(1, 2, 3));
    CHECK(pin.stiffness == k_infinity);
    CHECK(!voile::pin(7).anchor);
    CHECK(!voile::pin(7, hand).position);

    const voile::Attachment spring = voile::spring(2, 200, 0.5f).to(hand).at({0, 1, 0});
    CHECK(spring.vertex == 2);
    CHECK(spring.stiffness == 200);
    CHECK(spring.damping == 0.5f);
    CHECK(spring.anchor == hand);
    CHECK(spring.position == glm::vec3(0, 1, 0));
    CHECK(spring.max_distance == k_infinity);

    const voile::Attachment limit = voile::max_distance(5, 0.1f).with_backstop({0, 0, 1}, 0.02f);
    CHECK(limit.stiffness == 0);
    CHECK(limit.max_distance == 0.1f);
    CHECK(limit.backstop_normal == glm::vec3(0, 0, 1));
    CHECK(limit.backstop == 0.02f);
    const voile::Attachment plane = voile::backstop(5, {0, 0, 1}, 0.02f).with_max_distance(0.1f);
    CHECK(plane.stiffness == limit.stiffness);
    CHECK(plane.max_distance == limit.max_distance);
    CHECK(plane.backstop == limit.backstop);
}

TEST_CASE("pins change at run time, and released vertices fall")
{
    ClothHarness harness;
    voile::GridCloth grid = airless_sheet(6);
    grid.pins = {0, 5, 5};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    const float mass = 1 / harness.positions(id)[1].w;
    harness.step({}, 10);
    CHECK(harness.positions(id)[0] == glm::vec4(-0.5f, 2, -0.5f, 0));
    CHECK(harness.positions(id)[5] == glm::vec4(0.5f, 2, -0.5f, 0));

    const auto there = harness.positions(id)[35];
    voile::engine::take(harness.solver.set_attachments(id, {voile::pin(35)}));
    CHECK_FALSE(harness.solver.needs_upload());
    harness.step({}, 20);
    CHECK(glm::vec3(harness.positions(id)[35]) == glm::vec3(there)); // where it was when it was pinned
    CHECK(harness.positions(id)[0].y < 1.9f);
    CHECK(1 / harness.positions(id)[0].w == tests::close_to(mass / 2, 1e-7)); // a corner again

    voile::engine::take(harness.solver.set_attachments(id, {}));
    const float height = harness.positions(id)[35].y;
    harness.step({}, 10);
    CHECK(harness.positions(id)[35].y < height - 0.05f);
}

TEST_CASE("attachments, tethers and anchors beyond the capacity hold from the next step on")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(airless_sheet(10)));
    harness.upload();
    harness.step({}, 3);
    constexpr uint32_t k_anchors = 40;
    std::vector<voile::Attachment> all;
    for (uint32_t i = 0; i < k_anchors; ++i)
        all.push_back(voile::pin(i, voile::engine::take(harness.solver.add_anchor(at({0, 0, 0})))));
    for (uint32_t i = k_anchors; i < 99; ++i)
        all.push_back(voile::pin(i));
    // A command buffer that was recorded before uses the former buffers.
    const auto x = harness.positions(id);
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            voile::engine::take(harness.solver.record(cmd, {}));
            voile::engine::take(harness.solver.set_attachments(id, all));
            voile::engine::take(harness.solver.set_tethers(id, voile::Tethers{}));
        });
    CHECK_FALSE(harness.solver.needs_upload());
    const auto y = harness.positions(id);
    CHECK(y[50].y < x[50].y - 1e-3f);
    for (uint32_t i = 0; i < k_anchors; ++i)
        voile::engine::take(harness.solver.move_anchor(*all[i].anchor, at({0, 0.001f * static_cast<float>(i), 0})));
    harness.step({}, 30);
    const auto z = harness.positions(id);
    for (uint32_t i = 0; i < 99; ++i)
    {
        const float raised = i < k_anchors ? 0.001f * static_cast<float>(i) : 0;
        CHECK(z[i].x == y[i].x);
        CHECK(std::abs(z[i].y - y[i].y - raised) < 5e-7f);
    }
    CHECK(z[99].w > 0);
    const float diagonal = glm::distance(glm::vec3(x[99]), glm::vec3(x[88]));
    CHECK(glm::distance(glm::vec3(z[99]), glm::vec3(z[88])) < 1.001f * diagonal);
    harness.upload(); // takes the former buffers
    harness.step({}, 2);
}

TEST_CASE("a pin without a position stays behind with its cloth, one with a position does not")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(airless_sheet(4)));
    const voile::AnchorId rod = voile::engine::take(harness.solver.add_anchor(at({0, 2, -0.5f})));
    REQUIRE(harness.solver.set_attachments(id, {voile::pin(0, rod), voile::pin(3, rod, {0.5f, 0, 0})}));
    harness.upload();
    harness.step({}, 2);
    const auto pins = [&]
    {
        const auto x = harness.positions(id);
        return std::array{glm::vec3(x[0]), glm::vec3(x[3])};
    };
    const auto near = [](const glm::vec3& a, const glm::vec3& b) { return glm::distance(a, b) < 1e-6f; };
    const auto move_to = [&](const glm::vec3& position)
    {
        REQUIRE(harness.solver.move_anchor(rod, at(position)));
        harness.step({});
    };
    const glm::vec3 first(-0.5f, 2, -0.5f);
    const glm::vec3 second(0.5f, 2, -0.5f);
    const glm::vec3 x(1, 0, 0);
    move_to(x + glm::vec3(0, 2, -0.5f));
    CHECK(near(pins()[0], first + x));
    CHECK(near(pins()[1], second + x));

    // Moved while the cloth is disabled.
    REQUIRE(harness.solver.set_enabled(id, false));
    move_to(3.f * x + glm::vec3(0, 2, -0.5f));
    REQUIRE(harness.solver.set_enabled(id, true));
    harness.step({});
    CHECK(near(pins()[0], first + x));
    CHECK(near(pins()[1], second + 3.f * x));
    move_to(4.f * x + glm::vec3(0, 2, -0.5f)); // by 1 m
    CHECK(near(pins()[0], first + 2.f * x));
    CHECK(near(pins()[1], second + 4.f * x));

    // It begins where a reset puts it.
    REQUIRE(harness.solver.reset(id));
    harness.step({});
    CHECK(near(pins()[0], first));
    CHECK(near(pins()[1], second + 4.f * x));
}

TEST_CASE("a max-distance constraint keeps a vertex near a moving point, a backstop in front of it")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(airless_sheet(12)));
    const voile::AnchorId body = voile::engine::take(harness.solver.add_anchor(at({0, 2, 0})));
    std::vector<voile::Attachment> attachments;
    for (uint32_t i = 0; i < 144; ++i)
        attachments.push_back(voile::max_distance(i, 0.1f).with_backstop({0, 1, 0}, 0.03f).to(body));
    voile::engine::take(harness.solver.set_attachments(id, attachments));
    harness.upload();
    const auto start = harness.positions(id);
    double deepest = 0;
    for (int frame = 1; frame <= 60; ++frame)
    {
        const float t = static_cast<float>(frame) / 60;
        const glm::vec3 position(0.3f * std::sin(6 * t), 2 + 0.2f * std::sin(9 * t), 0);
        voile::engine::take(harness.solver.move_anchor(body, at(position)));
        harness.step({});
        const auto x = harness.positions(id);
        for (uint32_t i = 0; i < 144; ++i)
        {
            const glm::vec3 pose = glm::vec3(start[i]) - glm::vec3(0, 2, 0) + position;
            CHECK(glm::distance(glm::vec3(x[i]), pose) < 0.1f + 1e-5f);
            CHECK(x[i].y - pose.y > -0.03f - 1e-5f);
            deepest = std::max(deepest, static_cast<double>(pose.y - x[i].y));
        }
    }
    CHECK(deepest > 0.0299); // it did hang in the backstop
}

TEST_CASE("tethers keep a soft hanging cloth at its length")
{
    for (const bool tethered : {false, true})
    {
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(16);
        voile::Fabric soft;
        soft.stretch_stiffness = {3, 3}; // rho g L / 2k = 25 %
        soft.shear_stiffness = 1;
        soft.damping_ratio = 0.3f;
        grid.material = soft;
        for (uint32_t column = 0; column < 16; ++column)
            grid.pins.push_back(column);
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        if (tethered)
            voile::engine::take(harness.solver.set_tethers(id, voile::Tethers{.stretch = 0.02f}));
        harness.upload();
        harness.step({}, 180);
        double longest = 0;
        const auto x = harness.positions(id);
        for (uint32_t column = 0; column < 16; ++column)
            longest =
                std::max(longest, static_cast<double>(glm::distance(glm::vec3(x[column]), glm::vec3(x[240 + column]))));
        if (tethered)
            CHECK(longest < 1.02 + 1e-4);
        else
            CHECK(longest > 1.15);
    }
}

TEST_CASE("tethers measure distances along the cloth")
{
    // Pinned at one corner: the far corner is a diagonal away, over a triangulated grid too.
    ClothHarness harness;
    voile::GridCloth grid = airless_sheet(33);
    std::get<voile::Fabric>(grid.material).stretch_stiffness = {0.05f, 0.05f};
    std::get<voile::Fabric>(grid.material).shear_stiffness = 0.01f;
    grid.pins = {0};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    voile::engine::take(harness.solver.set_tethers(id, voile::Tethers{}));
    harness.upload();
    harness.step({}, 300);
    const auto x = harness.positions(id);
    const double diagonal = std::sqrt(2.0);
    const auto hangs = static_cast<double>(glm::distance(glm::vec3(x[0]), glm::vec3(x[33 * 33 - 1])));
    CHECK(hangs < diagonal * 1.01); // fast marching: its front is exact but for the first triangles' fans
    CHECK(hangs > diagonal * 0.97);
}

TEST_CASE("attachments and tethers refuse bad input, and nothing changes")
{
    ClothHarness harness;
    voile::GridCloth grid = airless_sheet(4);
    grid.name = "flag";
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const auto refused = [&](const voile::Attachment& attachment)
    {
        const std::string reason = message(harness.solver.set_attachments(id, {&attachment, 1}));
        CHECK(harness.solver.attachments(id).empty());
        return reason;
    };
    CHECK(refused({.vertex = 16}) == "cloth \"flag\": attached vertex 16 of 16");
    CHECK(refused({.vertex = 3, .anchor = voile::AnchorId{7}}) ==
          "cloth \"flag\": the attachment of vertex 3: anchor 7 does not exist");
    CHECK(refused({.vertex = 1, .position = glm::vec3(NAN)}) ==
          "cloth \"flag\": the attachment of vertex 1: position is (nan, nan, nan) m, each must be -1e+06 to 1e+06");
    CHECK(refused({.vertex = 1, .stiffness = -1}) ==
          "cloth \"flag\": the attachment of vertex 1: stiffness is -1 N/m, must be 0 to 1e+09, or infinite for a pin");
    CHECK(refused({.vertex = 1, .damping = INFINITY}).find("damping is inf") != std::string::npos);
    CHECK(refused({.vertex = 1, .max_distance = -2}).find("max_distance is -2") != std::string::npos);
    CHECK(refused({.vertex = 1, .backstop_normal = {0, 2, 0}})
              .find("its backstop's normal (0, 2, 0) is not of unit length") != std::string::npos);
    CHECK(message(harness.solver.set_attachments(id, {voile::pin(2), voile::spring(2, 9)})) ==
          "cloth \"flag\": vertex 2 has two attachments");

    CHECK(message(harness.solver.set_tethers(id, voile::Tethers{})) ==
          "cloth \"flag\": tethers need a pin, and it has none");
    voile::engine::take(harness.solver.set_attachments(id, {voile::pin(0)}));
    CHECK(message(harness.solver.set_tethers(id, voile::Tethers{.stretch = -1})).find("must be 0 to 10") !=
          std::string::npos);
    voile::engine::take(harness.solver.set_tethers(id, voile::Tethers{}));
    CHECK(harness.solver.attachments(id).size() == 1);
    glm::mat4 flat(1.f);
    flat[2] = {};
    CHECK(harness.solver.add_anchor(flat).error().message ==
          "anchor: its transform's determinant is 0, must be 1e-09 to 1e+09");
    CHECK(harness.solver.add_anchor(glm::mat4(NAN)).error().message == "anchor: its transform is not finite");
    CHECK(message(harness.solver.move_anchor({0}, glm::mat4(1.f))) == "anchor 0 does not exist");
}

TEST_CASE("vertices are attached to a collider's surface")
{
    ClothHarness harness;
    voile::GridCloth grid = airless_sheet(20);
    grid.transform[3] = {0, 0.5f, 0, 1};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::ColliderId ball =
        voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.center = {0, 0.2f, 0}, .radius = 0.3f}));
    const auto attachments = voile::engine::take(harness.solver.attachments_on_surface(id, ball, 0.02f));
    CHECK(attachments.size() > 3);
    CHECK(attachments.size() < 100);
    voile::engine::take(harness.solver.set_attachments(id, attachments));
    harness.upload();
    harness.step({}, 30);
    const auto x = harness.positions(id);
    for (const voile::Attachment& attachment : attachments)
        CHECK(static_cast<double>(glm::distance(glm::vec3(x[attachment.vertex]), glm::vec3(0, 0.2f, 0))) ==
              tests::close_to(0.3, 6e-7));
    CHECK_FALSE(harness.solver.attachments_on_surface(id, ball, 0).has_value());
}
