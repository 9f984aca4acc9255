// Cooked colliders as bytes.
#include "colliders/cooked_collider.hpp"

#include "geometry/cooked_file.hpp"
#include "model/range_checks.hpp"

#include <limits>

namespace voile
{

namespace
{

struct Head
{
    glm::mat4 transform;
    glm::vec3 origin;
    uint32_t closed;
    uint64_t nodes;
    uint64_t triangles;
    uint32_t depth;
    uint32_t padding;
    uint64_t padding_1;
};
static_assert(sizeof(Head) == 64 + 16 + 32);

constexpr float k_most_offset = 4 * k_most_coordinate; // m, from an origin within the mesh

bool within_mesh(const glm::vec3& p)
{
    return within(p, k_most_offset);
}

// A root with one child has an empty box, min above max, for the other.
bool is_box(const glm::vec3& min, const glm::vec3& max, bool may_be_none)
{
    if (may_be_none && min.x > max.x)
        return min == glm::vec3(std::numeric_limits<float>::infinity()) && max == -min;
    return within_mesh(min) && within_mesh(max) && glm::all(glm::lessThanEqual(min, max));
}

const char* problem_of(const CookedCollider::State& state)
{
    const Bvh& bvh = *state.hierarchy;
    if (!finite(state.transform) || !within(state.origin, 2 * k_most_coordinate))
        return "a collider's origin is out of range";
    if (!is_depth_first(bvh))
        return "a hierarchy is not one tree over its triangles";
    const shared::BvhNode* root = bvh.nodes.data();
    if (!all_of(bvh.nodes,
                [&](const shared::BvhNode& node) {
                    return is_box(node.left_min, node.left_max, false) &&
                           is_box(node.right_min, node.right_max, &node == root);
                }))
        return "a box of a hierarchy is out of range";
    if (!all_of(bvh.triangles, [&](const shared::BvhTriangle& t)
                { return t.index < bvh.triangles.size() && within_mesh(t.a) && within_mesh(t.b) && within_mesh(t.c); }))
        return "a triangle of a hierarchy is out of range";
    return nullptr;
}

// Follows a hierarchy from its root, depth first, and counts what must come next.
class DepthFirst
{
public:
    explicit DepthFirst(const Bvh& bvh) : bvh_(bvh) {}

    bool run()
    {
        if (bvh_.nodes.empty() || bvh_.triangles.empty())
            return false;
        struct Waiting
        {
            uint32_t child;
            uint32_t depth;
        };
        std::vector<Waiting> waiting{{0, 1}};
        while (!waiting.empty())
        {
            const auto [child, depth] = waiting.back();
            waiting.pop_back();
            if ((child & VOILE_BVH_LEAF_BIT) != 0)
            {
                if (!take_leaf(child))
                    return false;
                continue;
            }
            if (child != next_node_ || child >= bvh_.nodes.size() || depth > VOILE_BVH_MAX_DEPTH)
                return false;
            const shared::BvhNode& node = bvh_.nodes[next_node_++];
            const bool single = child == 0 && node.right_min.x > node.right_max.x;
            if (single && (node.right != node.left || (node.left & VOILE_BVH_LEAF_BIT) == 0))
                return false;
            if (!single)
                waiting.push_back({node.right, depth + 1});
            waiting.push_back({node.left, depth + 1});
        }
        return next_node_ == bvh_.nodes.size() && next_triangle_ == bvh_.triangles.size();
    }

private:
    bool take_leaf(uint32_t leaf)
    {
        if ((leaf & VOILE_BVH_FIRST_MASK) != next_triangle_)
            return false;
        next_triangle_ += (leaf >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK) + 1;
        return next_triangle_ <= bvh_.triangles.size();
    }

    const Bvh& bvh_;
    uint32_t next_node_ = 0;
    size_t next_triangle_ = 0;
};

} // namespace

bool is_depth_first(const Bvh& bvh)
{
    return DepthFirst(bvh).run();
}

std::vector<std::byte> CookedCollider::bytes() const
{
    if (!state_)
        return {};
    const Bvh& bvh = *state_->hierarchy;
    CookedWriter writer(CookedKind::collider);
    writer.add(Head{state_->transform, state_->origin, state_->closed ? 1u : 0u, bvh.nodes.size(), bvh.triangles.size(),
                    bvh.depth, 0, 0});
    writer.add(std::span(bvh.nodes));
    writer.add(std::span(bvh.triangles));
    return writer.finish();
}

Result<CookedCollider> CookedCollider::load(std::span<const std::byte> given, std::shared_ptr<const void> owner,
                                            const Jobs& jobs)
{
    const JobScope scope(jobs);
    const CookedBytes kept = keep_cooked(given, std::move(owner));
    auto reader = CookedReader::open(kept.bytes, CookedKind::collider);
    if (!reader)
        return reader.error();
    const auto head = reader.value().take<Head>();
    Bvh bvh;
    bvh.nodes = {reader.value().take<shared::BvhNode>(head.nodes), kept.owner};
    bvh.triangles = {reader.value().take<shared::BvhTriangle>(head.triangles), kept.owner};
    bvh.depth = head.depth;
    if (!reader.value().ok())
        return Error{"cooked data: a collider's arrays have other lengths than its header states"};
    if (head.closed > 1 || head.depth > VOILE_BVH_MAX_DEPTH || head.nodes > VOILE_BVH_FIRST_MASK ||
        head.triangles > VOILE_BVH_FIRST_MASK)
        return Error{"cooked data: a collider of these sizes does not exist"};
    auto state = std::make_shared<State>();
    state->transform = head.transform;
    state->origin = head.origin;
    state->closed = head.closed != 0;
    state->hierarchy = std::make_shared<const Bvh>(std::move(bvh));
    if (const char* problem = problem_of(*state))
        return Error{std::string("cooked data: ") + problem};
    return CookedCollider(std::move(state));
}

uint32_t CookedCollider::triangles() const
{
    return state_ ? static_cast<uint32_t>(state_->hierarchy->triangles.size()) : 0;
}

} // namespace voile
