// How near each other cloth is pressed: planes between primitives leave a part of the thickness, however long it takes.
#include "support/pair_harness.hpp"

#include "geometry/bvh_query.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <set>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr float k_thickness = 0.003f;
constexpr double k_least_part = 0.02; // k_least of meet_pairs.comp

// All primitives of some cloths.
struct Primitives
{
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
    std::set<std::pair<uint32_t, uint32_t>> edges;
};

Primitives primitives_of(PairHarness& harness)
{
    Primitives all;
    for (const voile::ClothId cloth : harness.cloths)
    {
        const auto first = static_cast<uint32_t>(all.positions.size());
        for (const glm::vec4& position : harness.positions(cloth))
            all.positions.emplace_back(position);
        for (const glm::uvec3& t : harness.solver.triangles(cloth))
        {
            all.triangles.push_back(t + first);
            for (int k = 0; k < 3; ++k)
                all.edges.insert(std::minmax(t[k] + first, t[(k + 1) % 3] + first));
        }
    }
    return all;
}

// m, from p to the segment from a to b.
double distance_from(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 along = b - a;
    return glm::distance(p, a + std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0) * along);
}

// m, of two segments: between their lines if they are nearest within both, else from an end.
double distance_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d)
{
    const glm::dvec3 u = b - a;
    const glm::dvec3 v = d - c;
    const double uu = glm::dot(u, u);
    const double uv = glm::dot(u, v);
    const double vv = glm::dot(v, v);
    const double area = uu * vv - uv * uv;
    const double s = (uv * glm::dot(v, a - c) - vv * glm::dot(u, a - c)) / area;
    const double t = (uu * glm::dot(v, a - c) - uv * glm::dot(u, a - c)) / area;
    if (area > 0 && s > 0 && s < 1 && t > 0 && t < 1)
        return glm::distance(a + s * u, c + t * v);
    return std::min(std::min(distance_from(a, c, d), distance_from(b, c, d)),
                    std::min(distance_from(c, a, b), distance_from(d, a, b)));
}

// m, of all pairs of primitives that share no vertex; what is farther than a thickness along an axis does not count.
double least_distance(const Primitives& all)
{
    const auto& x = all.positions;
    double least = std::numeric_limits<double>::infinity();
    const auto far = [](const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& from, const glm::dvec3& to)
    {
        constexpr double k_margin = k_thickness;
        return glm::any(glm::greaterThan(low, to + k_margin)) || glm::any(glm::greaterThan(from, high + k_margin));
    };
    for (auto first = all.edges.begin(); first != all.edges.end(); ++first)
        for (auto second = std::next(first); second != all.edges.end(); ++second)
        {
            const auto [a, b] = *first;
            const auto [c, d] = *second;
            const bool share = a == c || a == d || b == c || b == d;
            if (!share && !far(min(x[a], x[b]), max(x[a], x[b]), min(x[c], x[d]), max(x[c], x[d])))
                least = std::min(least, distance_of(x[a], x[b], x[c], x[d]));
        }
    for (const glm::uvec3& t : all.triangles)
    {
        const glm::dvec3 low = min(min(x[t.x], x[t.y]), x[t.z]);
        const glm::dvec3 high = max(max(x[t.x], x[t.y]), x[t.z]);
        for (uint32_t i = 0; i < x.size(); ++i)
            if (i != t.x && i != t.y && i != t.z && !far(low, high, x[i], x[i]))
                least = std::min(least, voile::nearest_on_triangle(x[i], x[t.x], x[t.y], x[t.z]).distance);
    }
    return least;
}

// Three sheets on the ground, a thousand times as heavy as usual.
void add_pressed_sheets(PairHarness& harness, voile::Integrator integrator)
{
    for (int i = 0; i < 3; ++i)
    {
        voile::GridCloth sheet = tests::pair_sheet(5, 5, 0.03f);
        voile::Fabric fabric = voile::cotton();
        fabric.thickness = k_thickness;
        sheet.material = fabric;
        sheet.integrator = integrator;
        const auto level = static_cast<float>(i);
        sheet.transform =
            at({0.003f * level, 0.01f + 0.005f * level, 0.002f * level}) * turned(0.4f * level, {0, 1, 0});
        harness.add(sheet);
    }
    take(harness.solver.add_collider(voile::PlaneCollider{}));
    harness.upload();
}

} // namespace

TEST_CASE("sheets that are pressed together keep a fiftieth of their thickness")
{
    for (const voile::Integrator integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
    {
        PairHarness harness;
        add_pressed_sheets(harness, integrator);
        // While an anchor moves, vertices lose what planes cut off their velocity (StepInput::driven).
        const voile::AnchorId anchor = take(harness.solver.add_anchor(glm::mat4(1)));
        voile::GridCloth elsewhere = tests::pair_sheet(2, 2, 0.1f);
        elsewhere.self_collision = false;
        elsewhere.transform = at({10, 1, 0});
        const voile::ClothId held = take(harness.solver.add_cloth(elsewhere));
        harness.upload();
        take(harness.solver.set_attachments(held, {voile::pin(0, anchor), voile::pin(1, anchor)}));
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 12; ++i)
        {
            take(harness.solver.move_anchor(anchor, at({0, 0.1f * static_cast<float>(i + 1), 0})));
            harness.step({.duration = 1.f / 60, .gravity = {0, -9810, 0}});
            if (i % 4 == 3)
                least = std::min(least, least_distance(primitives_of(harness)));
        }
        CHECK(least > 0.99 * k_least_part * static_cast<double>(k_thickness));
        CHECK(least < 1.1 * k_least_part * static_cast<double>(k_thickness)); // they are pressed
        CHECK(harness.statistics().forced_pairs == 0);
    }
}
