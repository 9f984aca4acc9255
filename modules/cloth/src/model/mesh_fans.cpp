// Triangles and edges by their owners. Where three triangles meet at an edge, it still has one owner, and is listed
// once.
#include "model/mesh_fans.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace voile
{

namespace
{

using shared::MeshCorner;
using shared::MeshWedge;

constexpr size_t k_fan_piece = 4096; // vertices

// The fan of one vertex.
class Fan
{
public:
    Fan(const MeshLists& lists, uint32_t vertex)
    {
        const shared::MeshVertex& list = lists.vertices[vertex];
        const std::span corners(lists.corners.data() + list.first_corner, list.corners);
        for (const MeshCorner& corner : corners)
        {
            neighbors_.insert(neighbors_.end(), {corner.b, corner.c});
            if (corner.b > vertex && corner.c > vertex)
                wedges_.push_back({corner.b, corner.c});
        }
        std::ranges::sort(neighbors_);
        neighbors_.erase(std::unique(neighbors_.begin(), neighbors_.end()), neighbors_.end());
        const auto higher = std::ranges::upper_bound(neighbors_, vertex);
        lower_ = std::span(neighbors_.begin(), higher);
        add_spokes(std::span(higher, neighbors_.end()));
        if (wedges_.empty() && !corners.empty())
            wedges_.push_back({vertex, vertex});
    }

    [[nodiscard]] std::span<const MeshWedge> wedges() const { return wedges_; }
    [[nodiscard]] std::span<const uint32_t> owners() const { return lower_; }

private:
    void add_spokes(std::span<const uint32_t> ends)
    {
        std::vector<uint32_t> left(ends.begin(), ends.end());
        const auto take = [&](uint32_t& end)
        {
            const auto found = std::ranges::lower_bound(left, end);
            if (found == left.end() || *found != end)
                return;
            left.erase(found);
            end |= VOILE_SPOKE_BIT;
        };
        for (MeshWedge& wedge : wedges_)
        {
            take(wedge.b);
            take(wedge.c);
        }
        for (const uint32_t end : left)
            wedges_.push_back({end | VOILE_SPOKE_BIT, end});
    }

    std::vector<uint32_t> neighbors_;
    std::span<const uint32_t> lower_;
    std::vector<MeshWedge> wedges_;
};

template <typename T>
SharedArray<T> joined(const std::vector<std::vector<T>>& pieces)
{
    std::vector<T> all;
    for (const std::vector<T>& piece : pieces)
        all.insert(all.end(), piece.begin(), piece.end());
    return all;
}

} // namespace

MeshFans make_mesh_fans(const MeshLists& lists)
{
    const size_t count = lists.vertices.size();
    const size_t pieces = (count + k_fan_piece - 1) / k_fan_piece;
    std::vector<shared::MeshFan> vertices(count);
    std::vector<std::vector<MeshWedge>> wedges(pieces);
    std::vector<std::vector<uint32_t>> owners(pieces);
    parallel_for(count, k_fan_piece,
                 [&](size_t begin, size_t end)
                 {
                     std::vector<MeshWedge>& own_wedges = wedges[begin / k_fan_piece];
                     std::vector<uint32_t>& own_owners = owners[begin / k_fan_piece];
                     for (size_t i = begin; i < end; ++i)
                     {
                         const Fan fan(lists, static_cast<uint32_t>(i));
                         vertices[i].wedges = static_cast<uint32_t>(fan.wedges().size());
                         vertices[i].owners = static_cast<uint32_t>(fan.owners().size());
                         own_wedges.insert(own_wedges.end(), fan.wedges().begin(), fan.wedges().end());
                         own_owners.insert(own_owners.end(), fan.owners().begin(), fan.owners().end());
                     }
                 });
    uint32_t wedge = 0;
    uint32_t owner = 0;
    for (shared::MeshFan& fan : vertices)
    {
        fan.first_wedge = std::exchange(wedge, wedge + fan.wedges);
        fan.first_owner = std::exchange(owner, owner + fan.owners);
    }
    return {std::move(vertices), joined(wedges), joined(owners)};
}

} // namespace voile
