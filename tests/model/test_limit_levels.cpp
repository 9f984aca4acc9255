// The listed levels of the strain limit: which vertices they have, how far these are from each other over the cloth,
// and what moves with them.
#include "model/limit_levels.hpp"

#include "geometry/parallel.hpp"
#include "model/model.hpp"

#include "support/backward_jobs.hpp"
#include "support/cloth_meshes.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace
{

using voile::LimitLevels;

voile::ClothModel* added(voile::Model& model, const tests::ClothMesh& mesh, std::vector<uint32_t> pins = {})
{
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = voile::cotton();
    cloth.pins = std::move(pins);
    const auto id = model.add(cloth);
    REQUIRE(id);
    return model.cloths.find(id.value());
}

// Calls each(level, vertex, link) for all links of the levels above the first.
template <typename Each>
void for_each_link(const LimitLevels& levels, const Each& each)
{
    for (uint32_t v = 0; v < levels.vertices.size(); ++v)
        for (uint32_t l = 1; l <= levels.vertices[v].top; ++l)
        {
            const voile::shared::LimitLevel& level = levels.levels[levels.vertices[v].first_level + l];
            for (uint32_t k = 0; k < level.links; ++k)
                each(l, v, levels.links[level.first_link + k]);
        }
}

// A strip of a cylinder around the y axis, not closed, flat in y.
tests::ClothMesh bent_sheet(uint32_t columns, uint32_t rows, float spacing, float radius)
{
    tests::ClothMesh mesh = tests::sheet(columns, rows, spacing);
    for (glm::vec3& p : mesh.positions)
        p = {radius * std::cos(p.x / radius), p.z, radius * std::sin(p.x / radius)};
    return mesh;
}

} // namespace

TEST_CASE("levels of a strain limit have ever fewer vertices, links that both ends have, and parents for all others")
{
    for (const tests::ClothMesh& mesh :
         {tests::jittered_sheet(23, 17), tests::torus(30, 14), tests::sheet(40, 3, 0.05f)})
    {
        voile::Model model;
        const LimitLevels levels = voile::make_limit_levels(*added(model, mesh));
        CHECK(levels.count >= 4);
        std::vector<size_t> on_level(levels.count);
        for (const voile::shared::LimitVertex& vertex : levels.vertices)
            for (uint32_t l = 0; l <= vertex.top; ++l)
                ++on_level[l];
        for (size_t l = 1; l < on_level.size(); ++l)
            CHECK(on_level[l] < 0.6 * static_cast<double>(on_level[l - 1]) + 2);
        std::map<std::tuple<uint32_t, uint32_t, uint32_t>, std::pair<float, float>> links;
        for_each_link(levels,
                      [&](uint32_t l, uint32_t v, const voile::shared::LimitLink& link) {
                          links[{l, v, link.neighbor}] = {link.rest_length, link.shear};
                      });
        for (const auto& [ends, link] : links)
        {
            const auto [l, a, b] = ends;
            CHECK(links.at({l, b, a}) == link);
        }
        for (const voile::shared::LimitVertex& vertex : levels.vertices)
        {
            if (vertex.top + 1 == levels.count)
                continue;
            float sum = 0;
            for (uint32_t k = 0; k < vertex.parents; ++k)
            {
                const voile::shared::LimitParent& parent = levels.parents[vertex.first_parent + k];
                CHECK(levels.vertices[parent.vertex].top > vertex.top);
                CHECK(parent.weight > 0);
                sum += parent.weight;
            }
            CHECK(std::abs(sum - 1) < 1e-5f);
        }
    }
}

TEST_CASE("the vertices on wide levels of a strain limit are listed, the widest level first")
{
    for (const uint32_t side : {3u, 12u, 45u})
    {
        CAPTURE(side);
        voile::Model model;
        const LimitLevels levels = voile::make_limit_levels(*added(model, tests::sheet(side, side, 0.05f)));
        std::vector<size_t> on_level(levels.count);
        for (const voile::shared::LimitVertex& vertex : levels.vertices)
            for (uint32_t l = 0; l <= vertex.top; ++l)
                ++on_level[l];
        REQUIRE(levels.narrow > 0);
        REQUIRE(levels.narrow <= levels.count);
        for (uint32_t l = 1; l < levels.count; ++l)
            CHECK((on_level[l] <= VOILE_LIMIT_COARSE_VERTICES) == (l >= levels.narrow));
        const size_t wide = levels.narrow < levels.count ? on_level[levels.narrow] : 0;
        REQUIRE(levels.wide.size() == std::min<size_t>(levels.vertices.size(), VOILE_LIMIT_COARSE_VERTICES));
        for (uint32_t k = 0; k < wide; ++k)
        {
            const voile::shared::LimitVertex& vertex = levels.vertices[levels.wide[k].other];
            CHECK(vertex.other == k);
            CHECK(vertex.top == levels.wide[k].top);
            CHECK(vertex.first_level == levels.wide[k].first_level);
            CHECK(vertex.first_parent == levels.wide[k].first_parent);
            CHECK((k == 0 || vertex.top <= levels.wide[k - 1].top));
            CHECK(vertex.top >= levels.narrow);
        }
        for (size_t k = wide; k < levels.wide.size(); ++k)
            CHECK(levels.wide[k].top == 0);
    }
}

TEST_CASE("a level of a strain limit has the mass of the cloth")
{
    voile::Model model;
    const voile::ClothModel& cloth = *added(model, tests::jittered_sheet(23, 17));
    const LimitLevels levels = voile::make_limit_levels(cloth);
    for (uint32_t l = 0; l < levels.count; ++l)
    {
        double mass = 0;
        for (const voile::shared::LimitVertex& vertex : levels.vertices)
            if (l <= vertex.top)
                mass += 1 / static_cast<double>(levels.levels[vertex.first_level + l].inverse_mass);
        double all = 0;
        for (const glm::vec4& start : cloth.start)
            all += 1 / static_cast<double>(start.w);
        CHECK(std::abs(mass - all) < 1e-5 * all);
    }
}

// Measured: 3e-7 flat, 8e-4 on a cylinder (whose chords are up to 36 % shorter).
TEST_CASE("links of a strain limit are as long as the cloth between their ends, however it is bent at rest")
{
    constexpr float k_spacing = 0.05f;
    for (const bool bent : {false, true})
    {
        const tests::ClothMesh flat = tests::sheet(33, 15, k_spacing);
        voile::Model model;
        const LimitLevels levels =
            voile::make_limit_levels(*added(model, bent ? bent_sheet(33, 15, k_spacing, 0.3f) : flat));
        double longest = 0;
        double worst = 0;
        for_each_link(levels,
                      [&](uint32_t, uint32_t v, const voile::shared::LimitLink& link)
                      {
                          const auto distance =
                              static_cast<double>(glm::distance(flat.positions[v], flat.positions[link.neighbor]));
                          longest = std::max(longest, distance);
                          // Paths may be taken for longer where none is straight, never for shorter.
                          CHECK(static_cast<double>(link.rest_length) < 1.42 * distance);
                          worst = std::max(worst, 1 - static_cast<double>(link.rest_length) / distance);
                      });
        CHECK(longest > 0.5);
        CHECK(worst < (bent ? 4e-3 : 1e-6));
    }
}

// A sheet that is cut from one side almost to the other: its halves may part, so nothing links them across the cut.
TEST_CASE("no link of a strain limit holds a cut together")
{
    tests::ClothMesh mesh = tests::sheet(31, 31, 0.03f);
    constexpr uint32_t k_cut = 15; // between the columns 15 and 16
    constexpr float k_end = 26;    // row
    std::erase_if(mesh.triangles,
                  [&](const glm::uvec3& t)
                  {
                      const auto [low, high] = std::minmax({t.x % 31, t.y % 31, t.z % 31});
                      return low == k_cut && high == k_cut + 1 && t.x / 31 < 27 && t.y / 31 < 27 && t.z / 31 < 27;
                  });
    voile::Model model;
    const LimitLevels levels = voile::make_limit_levels(*added(model, mesh));
    for_each_link(levels,
                  [&](uint32_t, uint32_t v, const voile::shared::LimitLink& link)
                  {
                      const glm::vec3 from = mesh.positions[v] / 0.03f;
                      const glm::vec3 to = mesh.positions[link.neighbor] / 0.03f;
                      const float part = (k_cut + 0.5f - from.x) / (to.x - from.x);
                      if (!(part > 0 && part < 1) || from.z + part * (to.z - from.z) >= k_end)
                          return;
                      const glm::vec3 end(k_cut + 0.5f, 0, k_end);
                      const float around = 0.03f * (glm::distance(from, end) + glm::distance(to, end));
                      CHECK(link.rest_length > around / 1.35f);
                  });
}

TEST_CASE("pins are on all levels of a strain limit, or near one that is")
{
    const tests::ClothMesh mesh = tests::jittered_sheet(40, 40);
    for (const std::vector<uint32_t>& pins : {std::vector<uint32_t>{3 * 40 + 7, 29 * 40 + 31}, {0, 1, 2, 39, 1000}})
    {
        voile::Model model;
        const LimitLevels levels = voile::make_limit_levels(*added(model, mesh, pins));
        uint32_t highest = 0;
        for (const uint32_t pin : pins)
            highest = std::max(highest, levels.vertices[pin].top);
        CHECK(highest + 1 == levels.count);
        CHECK(levels.vertices[pins[0]].top + 2 >= levels.count); // the first of neighbors stays
    }
}

TEST_CASE("the levels of a strain limit do not depend on the number of threads")
{
    const tests::ClothMesh mesh = tests::jittered_sheet(70, 60);
    voile::Model model;
    const voile::ClothModel& cloth = *added(model, mesh, {0, 69});
    const LimitLevels expected = voile::make_limit_levels(cloth);
    uint32_t tasks = 0;
    const voile::JobScope scope({.run = tests::run_backwards, .user = &tasks, .workers = 5});
    const LimitLevels found = voile::make_limit_levels(cloth);
    const auto same = [](const auto& a, const auto& b)
    { return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())) == 0; };
    CHECK(same(found.vertices, expected.vertices));
    CHECK(same(found.levels, expected.levels));
    CHECK(same(found.links, expected.links));
    CHECK(same(found.parents, expected.parents));
    CHECK(tasks > 0);
}

TEST_CASE("instances with the same pins and masses share the levels of their strain limit")
{
    const tests::ClothMesh mesh = tests::jittered_sheet(12, 9);
    voile::Model model;
    auto cooked = voile::cook(mesh.cloth());
    REQUIRE(cooked);
    for (const std::vector<uint32_t>& pins : {std::vector<uint32_t>{0}, {0}, {11}})
    {
        voile::MeshCloth instance;
        instance.cooked = cooked.value();
        instance.pins = pins;
        REQUIRE(model.add(instance));
    }
    model.list_limit_levels();
    CHECK(model.limit_levels.end(voile::k_limit_vertices) ==
          4 * mesh.positions.size()); // two cloths, and as many entries for wide levels
    voile::MeshCloth heavy;
    heavy.cooked = cooked.value();
    heavy.pins = std::vector<uint32_t>{0};
    std::vector<float> inverse_masses(mesh.positions.size(), 100);
    inverse_masses[5] = 0; // as if pinned
    heavy.inverse_masses = inverse_masses;
    const auto id = model.add(heavy);
    REQUIRE(id);
    model.list_limit_levels();
    CHECK(model.limit_levels.end(voile::k_limit_vertices) == 6 * mesh.positions.size());
    CHECK(voile::pinned_vertices(*model.cloths.find(id.value())) == std::vector<uint32_t>{0, 5});
}

TEST_CASE("a grid has levels in lists only if it has pins between its lines")
{
    voile::Model model;
    const auto needs = [&](std::vector<uint32_t> pins)
    {
        voile::GridCloth grid;
        grid.columns = grid.rows = 20;
        grid.material = voile::cotton();
        grid.pins = std::move(pins);
        const auto id = model.add(grid);
        REQUIRE(id);
        return voile::needs_limit_levels(*model.cloths.find(id.value()));
    };
    std::vector<uint32_t> top;
    for (uint32_t i = 0; i < 20; ++i)
        top.push_back(i);
    CHECK_FALSE(needs({}));
    CHECK_FALSE(needs({0, 19}));
    CHECK_FALSE(needs(top));
    CHECK(needs({3, 16}));
    CHECK(needs({7 * 20 + 9}));
}
