// Hierarchies that were built before, so that a mesh that is added again needs no building.
#pragma once

#include "geometry/bvh.hpp"
#include "geometry/content_hash.hpp"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace voile
{

// Of the contents of a mesh: their hashes, and its sizes.
struct MeshKey
{
    ContentHash contents;
    size_t positions = 0;
    size_t triangles = 0;

    bool operator==(const MeshKey&) const = default;
};
MeshKey make_mesh_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

// Whether every triangle of the hierarchy lies, to the bit, where the mesh has it: as many triangles are then the same.
bool built_from(const Bvh& bvh, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

// Holds the hierarchies used last, whose nodes and triangles take at most `limit` bytes. Thread-safe; two threads that
// ask for the same new mesh at once both build it.
class BvhCache
{
public:
    explicit BvhCache(uint64_t limit) : limit_(limit) {}

    // The hierarchy over a mesh, for which build_bvh's conditions hold.
    std::shared_ptr<const Bvh> get(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

    void set_limit(uint64_t bytes);

    struct Counts
    {
        uint64_t builds = 0; // since the start
        uint64_t hits = 0;   // since the start, calls that found the hierarchy
        size_t entries = 0;  // now
        uint64_t bytes = 0;  // now
    };
    [[nodiscard]] Counts counts() const;

private:
    struct Entry
    {
        MeshKey key;
        std::shared_ptr<const Bvh> bvh;
    };
    struct Hash
    {
        size_t operator()(const MeshKey& key) const { return static_cast<size_t>(key.contents.low); }
    };
    std::shared_ptr<const Bvh> find(const MeshKey& key);
    void insert(const MeshKey& key, const std::shared_ptr<const Bvh>& bvh);
    void erase(std::list<Entry>::iterator entry); // these two with the mutex held
    void shrink();

    mutable std::mutex mutex_; // of the following
    uint64_t limit_;
    Counts counts_;
    std::list<Entry> entries_; // the one used last first
    std::unordered_map<MeshKey, std::list<Entry>::iterator, Hash> index_;
};

// The cache of the process, for all solvers.
BvhCache& bvh_cache();

} // namespace voile
