// The lists of pairs against all pairs of primitives. A step of one substep makes new lists of the state before it.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/opened_solver.hpp"
#include "support/random_cloths.hpp"

#include "shared/pair_layout.h"
#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace
{

namespace buffer = voile::buffer;
using voile::shared::PairBound;
using voile::shared::PairDispatch;
using voile::shared::PairSweep;

using Words = std::array<uint32_t, 5>; // the vertices of a pair in order, and whether they are two edges

struct Lists
{
    std::vector<PairSweep> sweeps;
    std::multiset<Words> pairs;
};

// Random crumples intersect. Their pairs are to be listed as all others.
voile::SolverOptions tangled(voile::SolverOptions options)
{
    options.untangling = false;
    return options;
}

class ListHarness : public tests::ClothHarness
{
public:
    explicit ListHarness(const voile::SolverOptions& options = {}) : ClothHarness(tangled(options)) {}

    template <typename T>
    std::vector<T> content(buffer::Name name, size_t count)
    {
        return read<T>((*tests::opened(solver).device)[name].handle(), count);
    }

    Lists lists()
    {
        step({.duration = 1e-4f, .substeps = 1, .gravity = {0, 0, 0}, .air_density = 0});
        Lists result;
        const auto vertices = tests::opened(solver).device->vertices;
        const auto bounds = content<PairBound>(buffer::pair_bounds, 2 + vertices);
        for (size_t i = 2; i < bounds.size(); ++i)
            result.sweeps.push_back(bounds[i].sweep);
        const auto passes = content<PairDispatch>(buffer::pair_passes, VOILE_PAIR_PASSES);
        const auto entries = content<uint32_t>(buffer::pair_entries, size_t{vertices} * VOILE_PAIRS);
        const auto pairs = content<glm::uvec4>(buffer::pairs, size_t{vertices} * VOILE_PAIRS);
        for (uint32_t k = 0; k < passes[VOILE_PAIR_MEET].entries; ++k)
        {
            const glm::uvec4& words = pairs[entries[k]];
            const uint32_t edges = words.x >> 31;
            result.pairs.insert({words.x & 0x7fffffffu, words.y, words.z, words.w, edges});
        }
        return result;
    }
};

// m: an upper bound of the distance from the origin to the convex hull of points, near it unless it is far above
// `least`. Gilbert 1966, "An iterative procedure for computing the minimum of a quadratic form on a convex set".
double distance_of_hull(const std::vector<glm::dvec3>& points, double least)
{
    glm::dvec3 p = points.front();
    for (int round = 0; round < 200; ++round)
    {
        const auto nearest =
            std::min_element(points.begin(), points.end(),
                             [&](const auto& a, const auto& b) { return glm::dot(a, p) < glm::dot(b, p); });
        const double size = glm::length(p);
        if (size < least || glm::dot(*nearest, p) >= least * size)
            return size;
        const glm::dvec3 d = *nearest - p;
        const double along = glm::dot(d, d);
        if (along == 0)
            return size;
        p += std::clamp(-glm::dot(p, d) / along, 0.0, 1.0) * d;
    }
    return glm::length(p);
}

// All primitives of some cloths, by vertices of the solver.
struct Primitives
{
    std::vector<glm::uvec3> triangles;
    std::vector<glm::uvec2> edges;
    std::vector<uint32_t> vertices;
};

void add_cloth(Primitives& all, const voile::Solver& solver, voile::ClothId cloth)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    const auto first = static_cast<uint32_t>(streams.offset / sizeof(glm::vec4));
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (const glm::uvec3& t : solver.triangles(cloth))
    {
        all.triangles.push_back(t + first);
        for (int k = 0; k < 3; ++k)
            edges.insert(std::minmax(t[k] + first, t[(k + 1) % 3] + first));
    }
    for (const auto& [a, b] : edges)
        all.edges.emplace_back(a, b);
    for (uint32_t i = 0; i < streams.vertices; ++i)
        all.vertices.push_back(first + i);
}

// m, half of it: what pack_half_sweep (sweep.glsl) has packed.
glm::dvec3 unpacked_sweep(uint32_t word)
{
    const double unit = std::ldexp(1.0, static_cast<int>(word >> 27 & 15u) - 22);
    const auto number = [&](int k) { return unit * (static_cast<int32_t>(word << (23 - 9 * k)) >> 23); };
    return {number(0), number(1), number(2)};
}

// m: where a vertex is at an end of its sweep, at the beginning or the end of the clock.
glm::dvec3 position_on(const PairSweep& sweep, int end, int clock)
{
    return glm::dvec3(sweep.from) + static_cast<double>(end) * glm::dvec3(sweep.sweep) +
           2.0 * clock * unpacked_sweep(sweep.carry);
}

// Of two sides, no list of which has the pair: whether they can meet.
bool may_meet(const std::vector<PairSweep>& sweeps, std::span<const uint32_t> a, std::span<const uint32_t> b)
{
    double reach_a = 0;
    double reach_b = 0;
    std::vector<glm::dvec3> differences;
    for (const uint32_t i : a)
        reach_a = std::max(reach_a, static_cast<double>(sweeps[i].reach));
    for (const uint32_t i : b)
        reach_b = std::max(reach_b, static_cast<double>(sweeps[i].reach));
    for (const uint32_t i : a)
        for (const uint32_t j : b)
            for (int k = 0; k < 8; ++k)
                differences.push_back(position_on(sweeps[i], k & 1, k >> 2) -
                                      position_on(sweeps[j], (k >> 1) & 1, k >> 2));
    const double least = reach_a + reach_b;
    return distance_of_hull(differences, least) < least;
}

struct Found
{
    uint32_t listed = 0;
    uint32_t meetings = 0; // unlisted pairs that may meet
    uint32_t one_sided = 0;
};

void check_pair(const Lists& lists, const Words& words, Found& found)
{
    const size_t sides = lists.pairs.count(words);
    found.listed += sides > 0 ? 1 : 0;
    found.one_sided += sides == 1 || sides > 2 ? 1 : 0;
    const size_t first = words[4] != 0 ? 2 : 1;
    const std::span<const uint32_t> vertices(words.data(), 4);
    if (sides == 0 && may_meet(lists.sweeps, vertices.first(first), vertices.subspan(first)))
        ++found.meetings;
}

Found check_all(const Lists& lists, const Primitives& all)
{
    Found found;
    for (const uint32_t v : all.vertices)
        for (glm::uvec3 t : all.triangles)
        {
            if (t.x == v || t.y == v || t.z == v)
                continue;
            std::sort(&t.x, &t.x + 3);
            check_pair(lists, {v, t.x, t.y, t.z, 0}, found);
        }
    for (size_t i = 0; i < all.edges.size(); ++i)
        for (size_t j = 0; j < i; ++j)
        {
            const glm::uvec2 a =
                std::min(all.edges[i].x, all.edges[j].x) == all.edges[i].x ? all.edges[i] : all.edges[j];
            const glm::uvec2 b = a == all.edges[i] ? all.edges[j] : all.edges[i];
            if (a.x != b.x && a.x != b.y && a.y != b.x && a.y != b.y)
                check_pair(lists, {a.x, a.y, b.x, b.y, 1}, found);
        }
    return found;
}

voile::GridCloth grid(uint32_t columns, uint32_t rows)
{
    voile::Fabric fabric = voile::cotton();
    fabric.thickness = 0.004f;
    voile::GridCloth cloth;
    cloth.columns = columns;
    cloth.rows = rows;
    cloth.width = 0.02f * static_cast<float>(columns - 1);
    cloth.depth = 0.02f * static_cast<float>(rows - 1);
    cloth.material = fabric;
    cloth.integrator = voile::Integrator::verlet;
    cloth.self_collision = true;
    return cloth;
}

// Waves of the cloth across it, and along it in a random part. Vertices move at random.
void crumple(ListHarness& harness, voile::ClothId cloth, tests::Draw& draw, float amount)
{
    std::vector<glm::vec4> x = harness.positions(cloth);
    std::vector<glm::vec4> v = harness.velocities(cloth);
    const float bend = draw.uniform(30, 60);
    const float slide = draw.uniform(0.6f, 1);
    const glm::vec3 together = draw.uniform(0, 3) * draw.direction();
    for (size_t i = 0; i < x.size(); ++i)
    {
        const float along = bend * x[i].x;
        x[i].y += amount * 0.03f * std::sin(along + 20 * x[i].z);
        x[i].x += 0.05f * amount * slide * std::sin(1.3f * along);
        const glm::vec3 noise = amount * 0.002f * draw.direction();
        const glm::vec3 velocity = together + amount * draw.uniform(0, 1) * draw.direction();
        x[i] += glm::vec4(noise, 0);
        v[i] = glm::vec4(velocity, v[i].w);
    }
    harness.set_positions(cloth, x);
    harness.set_velocities(cloth, v);
}

// Eight layers, half a millimeter from each other, that move at random. Returns their primitives.
Primitives add_layers(ListHarness& harness)
{
    Primitives all;
    tests::Draw draw(7);
    std::vector<voile::ClothId> cloths;
    for (int layer = 0; layer < 8; ++layer)
    {
        voile::GridCloth cloth = grid(8, 5);
        cloth.transform[3] = {0.003f * static_cast<float>(layer), 0.0005f * static_cast<float>(layer), 0, 1};
        cloths.push_back(voile::engine::take(harness.solver.add_cloth(cloth)));
    }
    harness.upload();
    for (const voile::ClothId cloth : cloths)
        add_cloth(all, harness.solver, cloth);
    for (const voile::ClothId cloth : cloths)
    {
        std::vector<glm::vec4> v = harness.velocities(cloth);
        for (glm::vec4& velocity : v)
            velocity = glm::vec4(draw.uniform(0, 0.2f) * draw.direction(), velocity.w);
        harness.set_velocities(cloth, v);
    }
    return all;
}

} // namespace

TEST_CASE("two primitives that no list has cannot meet while vertices stay within reach of their sweeps")
{
    Found sum;
    for (uint32_t seed = 1; seed <= 6; ++seed)
    {
        tests::Draw draw(seed);
        ListHarness harness;
        if (seed % 3 == 0) // what is near it is not carried
            (void)voile::engine::take(
                harness.solver.add_collider(voile::SphereCollider{.center = {0.3f, 0, 0}, .radius = 0.02f}));
        std::vector<voile::ClothId> cloths;
        const glm::vec4 origin(seed > 4 ? glm::vec3(100, 0, -70) : glm::vec3(0), 1); // far away numbers are coarser
        voile::GridCloth sheet = grid(12, 9);
        sheet.transform[3] = origin;
        cloths.push_back(voile::engine::take(harness.solver.add_cloth(sheet)));
        const tests::ClothMesh shape = tests::jittered_sheet(7, 7);
        voile::MeshCloth mesh = shape.cloth();
        mesh.transform[0].x = mesh.transform[1].y = mesh.transform[2].z = 0.4f;
        mesh.transform[3] = origin;
        mesh.material = sheet.material;
        mesh.integrator = voile::Integrator::verlet;
        mesh.self_collision = true;
        if (seed % 2 == 0)
            cloths.push_back(voile::engine::take(harness.solver.add_cloth(mesh)));
        harness.upload();
        Primitives all;
        for (const voile::ClothId cloth : cloths)
        {
            crumple(harness, cloth, draw, seed <= 2 ? 0.5f : 1);
            add_cloth(all, harness.solver, cloth);
        }
        const Found found = check_all(harness.lists(), all);
        CHECK(found.meetings == 0);
        CHECK(found.one_sided == 0);
        sum.listed += found.listed;
        MESSAGE("seed " << seed << ": " << found.listed << " pairs");
    }
    CHECK(sum.listed > 1000);
}

TEST_CASE("lists that overflow leave out the farthest pairs, and what they leave out cannot meet")
{
    const std::array<glm::uvec2, 4> cases{
        {{32, 0}, {32, 8}, {6, 8}, {1, 0}}}; // the capacity of a list, threads or default
    for (const glm::uvec2& of : cases)
    {
        CAPTURE(of.x);
        CAPTURE(of.y);
        voile::SolverOptions options;
        options.tuning.pair_capacity = of.x;
        options.tuning.feature_threads = of.y;
        ListHarness harness(options);
        const Primitives all = add_layers(harness);
        const Lists lists = harness.lists();
        const Found found = check_all(lists, all);
        CHECK(found.meetings == 0);
        CHECK(found.one_sided == 0);
        const auto moving = std::count_if(lists.sweeps.begin(), lists.sweeps.end(),
                                          [](const PairSweep& sweep) { return sweep.reach > 0; });
        MESSAGE(found.listed << " pairs, " << moving << " of " << lists.sweeps.size() << " vertices may move");
        CHECK(found.listed > 3 * of.x);
    }
}

TEST_CASE("folds are not flat, however sharp they are: what lists leave out there cannot meet")
{
    for (const float angle : {0.01f, 0.03f, 0.06f, 0.09f, 0.2f}) // of each half
    {
        CAPTURE(angle);
        ListHarness harness;
        const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(grid(12, 9)));
        harness.upload();
        std::vector<glm::vec4> x = harness.positions(cloth);
        for (glm::vec4& p : x)
            p = glm::vec4(p.x, std::sin(angle) * p.z, std::cos(angle) * std::abs(p.z), p.w);
        harness.set_positions(cloth, x);
        Primitives all;
        add_cloth(all, harness.solver, cloth);
        const Found found = check_all(harness.lists(), all);
        CHECK(found.meetings == 0);
        CHECK(found.one_sided == 0);
    }
}

TEST_CASE("a flat sheet that moves in any direction has no pairs, and its vertices may move")
{
    for (const glm::vec3& velocity : {glm::vec3(0), glm::vec3(0, -5, 0), glm::vec3(2, 0, 1)})
    {
        ListHarness harness;
        voile::GridCloth cloth = grid(20, 17);
        cloth.velocity = velocity;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(cloth));
        harness.upload();
        const Lists lists = harness.lists();
        CHECK(lists.pairs.empty());
        const float range = tests::opened(harness.solver).model.cloths.find(id)->record.pair_range;
        for (const PairSweep& sweep : lists.sweeps)
            CHECK(sweep.reach >= 0.99f * VOILE_PAIR_APPROACH * VOILE_FLAT_RANGE * range);
    }
}

TEST_CASE("crumpled cloths move equally in every run, and whether candidates are sifted or not")
{
    std::vector<glm::vec4> first;
    for (int run = 0; run < 3; ++run)
    {
        voile::SolverOptions options;
        options.tuning.sifting_vertices = run < 2 ? 0 : 1;
        ListHarness harness(options);
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
        voile::GridCloth cloth = grid(14, 12);
        cloth.transform[3] = {0, 0.03f, 0, 1};
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(cloth));
        harness.upload();
        tests::Draw draw(3);
        crumple(harness, id, draw, 0.7f);
        harness.step({.duration = 1.f / 60}, 6);
        if (run == 0)
            first = harness.positions(id);
        else
            CHECK(tests::same_bits(first, harness.positions(id)));
    }
}

TEST_CASE("what lists of vertices with a hundred triangles leave out cannot meet")
{
    constexpr uint32_t k_triangles = 100;
    constexpr float k_radius = 0.15f; // m
    std::vector<glm::vec3> positions{{0, 0, 0}};
    std::vector<glm::uvec3> triangles;
    for (uint32_t i = 0; i < k_triangles; ++i)
    {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / k_triangles;
        positions.push_back(k_radius * glm::vec3(std::cos(angle), 0, std::sin(angle)));
        triangles.emplace_back(0, 1 + (i + 1) % k_triangles, 1 + i);
    }
    ListHarness harness;
    Primitives all;
    std::vector<voile::ClothId> cloths;
    for (const float side : {-1.f, 1.f})
    {
        voile::MeshCloth fan;
        fan.positions = positions;
        fan.triangles = triangles;
        fan.material = voile::cotton();
        fan.integrator = voile::Integrator::verlet;
        fan.self_collision = true;
        fan.velocity = {0, side, 0};
        fan.transform[3] = {0.002f * side, -0.003f * side, 0.001f * side, 1};
        fan.transform[2].y = 0.02f * side;
        cloths.push_back(voile::engine::take(harness.solver.add_cloth(fan)));
    }
    harness.upload();
    for (const voile::ClothId cloth : cloths)
        add_cloth(all, harness.solver, cloth);
    const Found found = check_all(harness.lists(), all);
    CHECK(found.listed > 50);
    CHECK(found.meetings == 0);
    CHECK(found.one_sided == 0);
}
