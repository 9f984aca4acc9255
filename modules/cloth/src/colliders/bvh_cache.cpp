// Hierarchies that were built before.
#include "colliders/bvh_cache.hpp"

#include "geometry/content_hash.hpp"
#include "geometry/parallel.hpp"
#include "voile/descriptions.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>

namespace voile
{

namespace
{

uint64_t size_in_bytes(const Bvh& bvh)
{
    return sizeof(Bvh) + bvh.nodes.size() * sizeof(bvh.nodes[0]) + bvh.triangles.size() * sizeof(bvh.triangles[0]);
}

bool same_bits(const glm::vec3& a, const glm::vec3& b)
{
    return glm::floatBitsToUint(a) == glm::floatBitsToUint(b);
}

} // namespace

MeshKey make_mesh_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
{
    // The hash need not resist chosen collisions: a mesh that is found is compared.
    return {hash_bytes(std::as_bytes(triangles), hash_bytes(std::as_bytes(positions))), positions.size(),
            triangles.size()};
}

bool built_from(const Bvh& bvh, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
{
    if (bvh.triangles.size() != triangles.size())
        return false;
    constexpr size_t k_piece = 16384;
    std::atomic<bool> same = true;
    parallel_for(triangles.size(), k_piece,
                 [&](size_t first, size_t last)
                 {
                     for (size_t i = first; i < last && same; ++i)
                     {
                         const shared::BvhTriangle& kept = bvh.triangles[i];
                         const glm::uvec3& t = triangles[kept.index];
                         if (!same_bits(kept.a, positions[t.x]) || !same_bits(kept.b, positions[t.y]) ||
                             !same_bits(kept.c, positions[t.z]))
                             same = false;
                     }
                 });
    return same;
}

std::shared_ptr<const Bvh> BvhCache::get(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
{
    const MeshKey key = make_mesh_key(positions, triangles);
    std::shared_ptr<const Bvh> found = find(key);
    const bool usable = found && built_from(*found, positions, triangles); // without the mutex: it takes a while
    if (!usable)
    {
        auto built = std::make_shared<const Bvh>(build_bvh(positions, triangles));
        insert(key, built);
        return built;
    }
    const std::lock_guard lock(mutex_);
    ++counts_.hits;
    return found;
}

void BvhCache::set_limit(uint64_t bytes)
{
    const std::lock_guard lock(mutex_);
    limit_ = bytes;
    shrink();
}

BvhCache::Counts BvhCache::counts() const
{
    const std::lock_guard lock(mutex_);
    Counts result = counts_;
    result.entries = entries_.size();
    return result;
}

std::shared_ptr<const Bvh> BvhCache::find(const MeshKey& key)
{
    const std::lock_guard lock(mutex_);
    const auto found = index_.find(key);
    if (found == index_.end())
        return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->bvh;
}

void BvhCache::insert(const MeshKey& key, const std::shared_ptr<const Bvh>& bvh)
{
    const std::lock_guard lock(mutex_);
    ++counts_.builds;
    if (size_in_bytes(*bvh) > limit_) // all others would go for it, and it would go too
        return;
    if (const auto found = index_.find(key); found != index_.end()) // another thread's, or another mesh
        erase(found->second);
    entries_.push_front({key, bvh});
    index_[key] = entries_.begin();
    counts_.bytes += size_in_bytes(*bvh);
    shrink();
}

void BvhCache::erase(std::list<Entry>::iterator entry)
{
    counts_.bytes -= size_in_bytes(*entry->bvh);
    index_.erase(entry->key);
    entries_.erase(entry);
}

void BvhCache::shrink()
{
    while (counts_.bytes > limit_)
        erase(std::prev(entries_.end()));
}

BvhCache& bvh_cache()
{
    static BvhCache cache(k_default_hierarchy_cache_limit);
    return cache;
}

void set_hierarchy_cache_limit(uint64_t bytes)
{
    bvh_cache().set_limit(bytes);
}

} // namespace voile
