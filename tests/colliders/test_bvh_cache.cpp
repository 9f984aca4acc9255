// The cache of hierarchies: hits and misses, its size limit, and its use by several threads.
#include "colliders/bvh_cache.hpp"
#include "colliders/collider_model.hpp"
#include "support/bvh_checks.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <thread>

namespace
{

constexpr uint64_t k_plenty = uint64_t{1} << 30;

voile::engine::Mesh sphere(float radius)
{
    return voile::engine::make_sphere({0, 0, 0}, radius, 12);
}

std::shared_ptr<const voile::Bvh> get(voile::BvhCache& cache, const voile::engine::Mesh& mesh)
{
    return cache.get(mesh.positions, mesh.triangles);
}

uint64_t bytes_of(const voile::Bvh& bvh)
{
    return sizeof(bvh) + bvh.nodes.size() * sizeof(bvh.nodes[0]) + bvh.triangles.size() * sizeof(bvh.triangles[0]);
}

} // namespace

TEST_CASE("a cached hierarchy is not built again and equals a newly built one")
{
    voile::BvhCache cache(k_plenty);
    const voile::engine::Mesh mesh = sphere(1);
    const auto first = get(cache, mesh);
    const voile::engine::Mesh twin = mesh; // in other memory
    const auto second = get(cache, twin);
    CHECK(first == second);
    CHECK(same_bits(*second, voile::build_bvh(mesh.positions, mesh.triangles)));
    CHECK(cache.counts().builds == 1);
    CHECK(cache.counts().hits == 1);
    CHECK(cache.counts().entries == 1);
    CHECK(cache.counts().bytes == bytes_of(*first));
}

TEST_CASE("any change of a mesh causes a rebuild")
{
    voile::BvhCache cache(k_plenty);
    const voile::engine::Mesh mesh = sphere(1);
    (void)get(cache, mesh);
    voile::engine::Mesh changed = mesh;
    SUBCASE("the last bit of a coordinate")
    {
        float& x = changed.positions[changed.triangles.back().z].x;
        x = std::nextafter(x, 2.f);
    }
    SUBCASE("the sign of a zero")
    {
        changed.positions[changed.triangles[0].x].x = 0.f;
        (void)get(cache, changed);
        changed.positions[changed.triangles[0].x].x = -0.f;
    }
    SUBCASE("a flipped triangle")
    {
        std::swap(changed.triangles[5].y, changed.triangles[5].z);
    }
    SUBCASE("one triangle fewer")
    {
        changed.triangles.pop_back();
    }
    SUBCASE("two triangles swapped")
    {
        std::swap(changed.triangles[3], changed.triangles[40]);
    }
    const voile::BvhCache::Counts before = cache.counts();
    const auto bvh = get(cache, changed);
    CHECK(cache.counts().builds == before.builds + 1);
    CHECK(cache.counts().hits == before.hits);
    CHECK(same_bits(*bvh, voile::build_bvh(changed.positions, changed.triangles)));
}

TEST_CASE("a cache hit compares the whole mesh, in case two keys are equal")
{
    const voile::engine::Mesh mesh = sphere(1);
    const voile::Bvh bvh = voile::build_bvh(mesh.positions, mesh.triangles);
    CHECK(voile::built_from(bvh, mesh.positions, mesh.triangles));
    for (const int corner : {0, 1, 2})
    {
        voile::engine::Mesh moved = mesh;
        moved.positions[moved.triangles.back()[corner]].y += 1e-3f;
        CHECK_FALSE(voile::built_from(bvh, moved.positions, moved.triangles));
    }
    voile::engine::Mesh shorter = mesh;
    shorter.triangles.pop_back();
    CHECK_FALSE(voile::built_from(bvh, shorter.positions, shorter.triangles));
}

TEST_CASE("the cache keeps its limit and evicts the least recently used hierarchy")
{
    const voile::engine::Mesh meshes[] = {sphere(1), sphere(2), sphere(3)};
    const uint64_t one = bytes_of(voile::build_bvh(meshes[0].positions, meshes[0].triangles));
    voile::BvhCache cache(one * 5 / 2); // room for two hierarchies, which differ by a few nodes
    const auto kept = get(cache, meshes[0]);
    (void)get(cache, meshes[1]);
    (void)get(cache, meshes[0]);
    (void)get(cache, meshes[2]); // evicts 1: 0 was used since
    CHECK(cache.counts().entries == 2);
    CHECK(cache.counts().bytes <= one * 5 / 2);
    CHECK(cache.counts().builds == 3);
    (void)get(cache, meshes[0]);
    CHECK(cache.counts().builds == 3);
    (void)get(cache, meshes[1]);
    CHECK(cache.counts().builds == 4);

    cache.set_limit(one / 2);
    CHECK(cache.counts().entries == 0);
    CHECK(cache.counts().bytes == 0);
    (void)get(cache, meshes[0]); // larger than the limit: not kept, and no error
    CHECK(cache.counts().entries == 0);
    CHECK(same_bits(*kept, voile::build_bvh(meshes[0].positions, meshes[0].triangles))); // the holder keeps it alive
}

TEST_CASE("several threads may query the cache while others change its limit")
{
    voile::BvhCache cache(k_plenty);
    const std::vector<voile::engine::Mesh> meshes{sphere(1), sphere(2), sphere(3), sphere(4)};
    std::vector<voile::Bvh> expected;
    for (const voile::engine::Mesh& mesh : meshes)
        expected.push_back(voile::build_bvh(mesh.positions, mesh.triangles));
    constexpr uint32_t k_threads = 4;
    constexpr uint32_t k_rounds = 50;
    std::vector<uint32_t> wrong(k_threads);
    {
        std::vector<std::jthread> threads;
        for (uint32_t thread = 0; thread < k_threads; ++thread)
            threads.emplace_back(
                [&, thread]
                {
                    for (uint32_t i = 0; i < k_rounds; ++i)
                    {
                        const size_t mesh = (i * (thread + 1) + thread) % meshes.size();
                        wrong[thread] += same_bits(*get(cache, meshes[mesh]), expected[mesh]) ? 0 : 1;
                        if (thread == 0)
                            cache.set_limit(bytes_of(expected[0]) * (i % 6));
                    }
                });
    }
    CHECK(wrong == std::vector<uint32_t>(k_threads));
    CHECK(cache.counts().builds + cache.counts().hits == k_threads * k_rounds);
}

TEST_CASE("colliders of all solvers share one cache, and a changed vertex or scale causes a rebuild")
{
    voile::BvhCache& cache = voile::bvh_cache();
    voile::set_hierarchy_cache_limit(0);
    voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
    voile::engine::Mesh mesh = sphere(0.7f);
    const auto collider = [&] { return voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}; };
    const uint64_t before = cache.counts().builds;
    const auto builds = [&] { return cache.counts().builds - before; };

    voile::ColliderModels one;
    REQUIRE(one.add(collider()));
    CHECK(builds() == 1);
    REQUIRE(one.add(collider()));
    voile::ColliderModels other;
    REQUIRE(other.add(collider()));
    CHECK(builds() == 1);
    CHECK(one.colliders.size() == 2);
    CHECK(one.hierarchies.end(voile::k_hierarchy_nodes) == other.hierarchies.end(voile::k_hierarchy_nodes)); // shared
    CHECK(one.colliders.at(0)->hierarchy == other.colliders.at(0)->hierarchy);

    mesh.positions[7].x += 0.01f;
    REQUIRE(other.add(collider()));
    CHECK(builds() == 2);
    voile::MeshCollider moved = collider();
    moved.transform[3].x = 1;
    REQUIRE(other.add(moved)); // relative to its center it is equal
    CHECK(builds() == 2);
    moved.transform[0].x = 1.5f;
    REQUIRE(other.add(moved));
    CHECK(builds() == 3);

    voile::set_hierarchy_cache_limit(0);
    CHECK(cache.counts().entries == 0);
    REQUIRE(other.add(collider()));
    CHECK(builds() == 4);
    voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
}
