// Islands: cloths that may come near each other share a clock and a mean velocity (PairIsland). Others do not notice
// each other.
#include "support/opened_solver.hpp"
#include "support/pair_harness.hpp"

#include "shared/pair_layout.h"

#include <doctest/doctest.h>

#include <numeric>
#include <random>
#include <span>

namespace
{

using tests::at;
using tests::PairHarness;
using voile::engine::take;

constexpr voile::Step k_floating{.duration = 1.f / 60, .gravity = {0, 0, 0}, .air_density = 0};
constexpr voile::Step k_vacuum{.duration = 1.f / 60, .air_density = 0};

voile::GridCloth thick_sheet(uint32_t size, float thickness)
{
    voile::GridCloth sheet = tests::pair_sheet(size, size, 0.02f);
    voile::Fabric fabric = voile::cotton();
    fabric.thickness = thickness;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    sheet.material = fabric;
    return sheet;
}

// Two sheets 3.15 mm apart, of a thickness of 3 mm.
void add_stack(PairHarness& harness, const glm::vec3& position, const glm::vec3& velocity)
{
    for (const float height : {0.f, 0.00315f})
    {
        voile::GridCloth sheet = thick_sheet(6, 0.003f);
        sheet.transform = at(position + glm::vec3(0, height, 0));
        sheet.velocity = velocity;
        harness.add(sheet);
    }
}

// m/s, the largest deviation of a vertex from a velocity.
float deviation(PairHarness& harness, voile::ClothId cloth, const glm::vec3& velocity)
{
    float most = 0;
    for (const glm::vec4& v : harness.velocities(cloth))
        most = std::max(most, glm::length(glm::vec3(v) - velocity));
    return most;
}

float mean_height(PairHarness& harness, size_t cloth)
{
    float sum = 0;
    const auto x = harness.positions(harness.cloths[cloth]);
    for (const glm::vec4& p : x)
        sum += p.y;
    return sum / static_cast<float>(x.size());
}

// A pleat of six layers, 0.1 mm apart, of a sheet around `middle` along x.
std::vector<glm::vec4> folded(std::vector<glm::vec4> x, float middle)
{
    for (glm::vec4& p : x)
    {
        const float along = (p.x - middle + 0.11f) / 0.04f;
        const float layer = std::floor(along);
        const float in = along - layer;
        p.x = middle + 0.04f * (static_cast<int>(layer) % 2 == 0 ? in : 1 - in);
        p.y = 0.0001f * along;
    }
    return x;
}

uint64_t intersections_of_stack(PairHarness& harness, size_t first)
{
    return tests::count_pairs_both_ways(harness.exact(harness.cloths[first]), harness.exact(harness.cloths[first + 1]));
}

class IslandHarness : public PairHarness
{
public:
    // For each cloth, the first cloth of its island in the last search.
    std::vector<uint32_t> islands()
    {
        const auto records = read<voile::shared::PairIsland>(
            (*tests::opened(solver).device)[voile::buffer::pair_islands].handle(), cloths.size());
        std::vector<uint32_t> result;
        for (uint32_t i = 0; i < records.size(); ++i)
            result.push_back(i - records[i].before);
        return result;
    }
};

// Of points where those are neighbors that `are_near`.
template <typename AreNear>
std::vector<uint32_t> components(uint32_t count, const AreNear& are_near)
{
    std::vector<uint32_t> first(count);
    std::iota(first.begin(), first.end(), 0u);
    for (bool changed = true; changed;)
    {
        changed = false;
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t j = 0; j < i; ++j)
                if (first[i] != first[j] && are_near(i, j))
                {
                    std::replace(first.begin(), first.end(), std::max(first[i], first[j]),
                                 std::min(first[i], first[j]));
                    changed = true;
                }
    }
    return first;
}

} // namespace

// Two stacks fly apart, two others fall: one beside sheets that hang from pins, one beside cloth that is crowded. As
// one island they deviate by up to 7 m/s. Where lists have no room, the clock stops.
TEST_CASE(
    "stacks of sheets that fly apart, beside cloth that hangs or is crowded, keep their velocities and fall freely")
{
    PairHarness harness;
    const std::pair<glm::vec3, float> stacks[] = {
        {{0, 0.15f, 0}, 5.f}, {{0, -0.15f, 0}, -2.5f}, {{3, 0, 0}, 0.f}, {{6, 0, 0}, -8.f}};
    for (const auto& [position, speed] : stacks)
        add_stack(harness, position, {0, speed, 0});
    for (const float height : {0.f, 0.00315f})
    {
        voile::GridCloth pinned = thick_sheet(12, 0.003f);
        pinned.transform = at({4.5f, height, 0});
        for (uint32_t i = 0; i < 12; ++i)
            pinned.pins.push_back(i);
        harness.add(pinned);
    }
    voile::GridCloth crowded = thick_sheet(12, 0.003f);
    crowded.transform = at({9, 0, 0});
    for (uint32_t i = 0; i < 12; ++i)
        crowded.pins.push_back(12 * i);
    const voile::ClothId pleat = harness.add(crowded);
    harness.upload();
    harness.set_positions(pleat, folded(harness.positions(pleat), 9));
    harness.step(k_vacuum, 12);
    for (size_t i = 0; i < 8; ++i)
    {
        CAPTURE(i);
        CHECK(deviation(harness, harness.cloths[i], {0, stacks[i / 2].second - 9.81f / 5, 0}) < 1e-3f);
    }
    for (size_t i = 0; i < 4; ++i)
        CHECK(intersections_of_stack(harness, 2 * i) == 0);
}

// Neighbors are within 1 mm of each other, others at least 8 cm away: four ranges of lists are 3.6 cm.
TEST_CASE("islands are the cloths that may reach each other, whatever their order")
{
    constexpr uint32_t k_count = 150;
    std::mt19937 random(7);
    std::vector<glm::ivec2> places;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            places.emplace_back(i, j);
    std::shuffle(places.begin(), places.end(), random);
    IslandHarness harness;
    for (uint32_t i = 0; i < k_count; ++i)
    {
        voile::GridCloth sheet = thick_sheet(3, 0.001f);
        // A place is 0.12 m long, a sheet 0.04 m, and one of two neighbors along x reaches the other.
        sheet.width = places[i].x % 3 == 0 ? 0.199f : 0.04f;
        sheet.transform = at({0.12f * static_cast<float>(places[i].x), 0, 0.12f * static_cast<float>(places[i].y)});
        harness.add(sheet);
    }
    harness.upload();
    harness.step(k_floating);
    const auto are_near = [&](uint32_t i, uint32_t j)
    {
        const glm::ivec2 a = places[i];
        const glm::ivec2 b = places[j];
        return a.y == b.y && std::abs(a.x - b.x) == 1 && (a.x % 3 == 0 || b.x % 3 == 0);
    };
    const std::vector<uint32_t> expected = components(k_count, are_near);
    CHECK(harness.islands() == expected);
    CHECK(std::ranges::count_if(expected, [&](const uint32_t& first)
                                { return first != static_cast<uint32_t>(&first - expected.data()); }) > 30);
}

// The way of an island, not that of a cloth, decides what comes near: the second sheet rests, but its island moves.
TEST_CASE("what an island may be carried to belongs to it")
{
    IslandHarness harness;
    for (const auto& [x, speed] : {std::pair(0.f, 30.f), {0.161f, 0.f}, {0.161f + 0.161f + 0.042f, 0.f}})
    {
        voile::GridCloth sheet = thick_sheet(9, 0.001f);
        sheet.transform = at({x, 0, 0});
        sheet.velocity = {speed, 0, 0};
        harness.add(sheet);
    }
    harness.upload();
    voile::Step step = k_floating;
    step.duration = 1e-4f;
    step.substeps = 1;
    harness.step(step);
    CHECK(harness.islands() == std::vector<uint32_t>{0, 0, 0});
}

TEST_CASE("cloths of other layers are no island")
{
    IslandHarness harness;
    for (const uint32_t layers : {1u, 2u, 1u, 3u})
    {
        voile::GridCloth sheet = thick_sheet(4, 0.001f);
        sheet.layers = layers;
        sheet.transform = at({layers == 3 ? 1.f : 0.f, 0.0001f * static_cast<float>(harness.cloths.size()), 0});
        harness.add(sheet);
    }
    harness.upload();
    harness.step(k_floating);
    CHECK(harness.islands() == std::vector<uint32_t>{0, 1, 0, 3});
}

// Islands become one before their cloths meet, and part again.
TEST_CASE("islands that fly through each other's path at any speed do not intersect")
{
    for (const float speed : {3.f, 20.f, 100.f})
    {
        PairHarness harness;
        const float far = 0.0123f + 1.5f * speed / 60;
        add_stack(harness, {0, far, 0}, {0, -speed, 0});
        add_stack(harness, {0.003f, -far, 0.002f}, {0, speed, 0});
        harness.upload();
        CAPTURE(speed);
        CHECK(harness.first_intersection(k_floating, 6) == -1);
        CHECK(mean_height(harness, 0) > mean_height(harness, 3));
        for (const voile::ClothId cloth : harness.cloths)
            CHECK(deviation(harness, cloth, {0, 0, 0}) < 1.2f * speed);
    }
}
