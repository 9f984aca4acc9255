// Cloth that is twisted, stacked high, and crumpled with short lists.
#include "support/pair_harness.hpp"
#include "support/random_cloths.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr float k_spacing = 0.02f; // m
constexpr float k_tau = 2 * std::numbers::pi_v<float>;

// A strip along x whose ends are turned against each other, and let go.
class Strip : public PairHarness
{
public:
    Strip()
    {
        voile::GridCloth strip = tests::pair_sheet(k_columns, k_rows, k_spacing);
        add(strip);
        upload();
        for (size_t end = 0; end < 2; ++end)
            ends_[end] = take(solver.add_anchor(glm::mat4(1)));
        std::vector<voile::Attachment> pins;
        for (uint32_t row = 0; row < k_rows; ++row)
        {
            pins.push_back(voile::pin(k_columns * row, ends_[0]));
            pins.push_back(voile::pin(k_columns * row + k_columns - 1, ends_[1]));
        }
        take(solver.set_attachments(cloths[0], pins));
    }

    // Each end by half of that, and towards the middle.
    void twist(float turns, float nearer)
    {
        for (size_t end = 0; end < 2; ++end)
        {
            const float side = end == 0 ? -1.f : 1.f;
            take(solver.move_anchor(ends_[end], at({-0.5f * side * nearer, 0, 0}) *
                                                    turned(0.5f * side * k_tau * turns, {1, 0, 0})));
        }
    }

    void let_go() { take(solver.set_attachments(cloths[0], {})); }

private:
    static constexpr uint32_t k_columns = 42;
    static constexpr uint32_t k_rows = 6;

    voile::AnchorId ends_[2];
};

// A sheet, 100 m away, all of which moves towards its middle, and each vertex a little at random. The first of 15 steps
// that ends with an intersection.
int crumple(uint32_t capacity, bool self_collision)
{
    voile::SolverOptions options;
    options.tuning.pair_capacity = capacity;
    PairHarness harness(options);
    tests::Draw draw(4 + capacity);
    voile::GridCloth sheet = tests::pair_sheet(14, 14, k_spacing);
    const glm::vec3 away(100, -100, 100);
    sheet.transform = at(away) * turned(draw.uniform(0, 6), draw.direction());
    sheet.self_collision = self_collision;
    harness.add(sheet);
    harness.upload();
    std::vector<glm::vec4> v = harness.velocities(harness.cloths[0]);
    const std::vector<glm::vec4> x = harness.positions(harness.cloths[0]);
    const glm::vec3 normal = glm::mat3(sheet.transform) * glm::vec3(0, 1, 0);
    const glm::vec3 crease = draw.direction();
    for (size_t i = 0; i < v.size(); ++i)
    {
        const glm::vec3 from = glm::vec3(x[i]) - away;
        const float up = draw.uniform(25, 35) * std::abs(glm::dot(from, crease));
        v[i] = glm::vec4(up * normal - draw.uniform(5, 10) * from + 0.5f * draw.direction(), v[i].w);
    }
    harness.set_velocities(harness.cloths[0], v);
    return harness.first_intersection({.duration = 1.f / 60, .gravity = {0, 0, 0}, .air_density = 0}, 15);
}

// m, of the four vertices in the middle of a sheet of 4 x 4. A sheet may tilt, so that one of them may be below one of
// the sheet beneath, beside it.
float height_of_middle(PairHarness& harness, voile::ClothId cloth)
{
    const std::vector<glm::vec4> x = harness.positions(cloth);
    return 0.25f * (x[5].y + x[6].y + x[9].y + x[10].y);
}

} // namespace

TEST_CASE("a strip that is twisted by three turns and let go does not intersect itself")
{
    Strip strip;
    constexpr int k_frames = 28;
    const voile::Step step{.duration = 1.f / 60, .gravity = {0, 0, 0}};
    const auto twist = [&](int frame)
    {
        const float part = static_cast<float>(frame + 1) / k_frames;
        strip.twist(3 * part, 0.09f * part);
    };
    REQUIRE(strip.first_intersection(step, k_frames, twist) == -1);
    strip.let_go();
    CHECK(strip.first_intersection(step, 10) == -1);
    CHECK(strip.statistics().forced_pairs == 0);
}

TEST_CASE("fifty sheets on a sphere keep their order")
{
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.08f}));
    constexpr int k_sheets = 50;
    for (int i = 0; i < k_sheets; ++i)
    {
        voile::GridCloth sheet = tests::pair_sheet(4, 4, k_spacing);
        const auto level = static_cast<float>(i);
        sheet.transform = at({0, 0.088f + 0.0035f * level, 0}) * turned(0.3f * level, {0, 1, 0});
        harness.add(sheet);
    }
    harness.upload();
    harness.step({.duration = 1.f / 60}, 7); // the stack is closed after 5
    CHECK(harness.intersections() == 0);
    for (size_t i = 0; i + 1 < harness.cloths.size(); ++i)
        CHECK(height_of_middle(harness, harness.cloths[i]) < height_of_middle(harness, harness.cloths[i + 1]));
}

TEST_CASE("random crumples with lists of one and two pairs, 100 m away, do not intersect")
{
    for (const uint32_t capacity : {1u, 2u})
    {
        CAPTURE(capacity);
        CHECK(crumple(capacity, true) == -1);
        CHECK(crumple(capacity, false) >= 0);
    }
}
