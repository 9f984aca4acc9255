// Building a hierarchy by binned SAH, on all cores.
#include "geometry/bvh.hpp"

#include "geometry/bvh_split.hpp"
#include "geometry/parallel.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

namespace voile
{

namespace
{

constexpr size_t k_piece = 16384; // primitives that one thread makes at a time

// A range that becomes a node with everything below. A large one is split into two that any thread may take up; others
// are built by one thread. How many nodes come before is known once all are built: until then their indices are
// relative.
struct Subtree
{
    PrimitiveRange range;
    uint32_t depth = 1;                   // of its topmost node, the root's is 1
    std::unique_ptr<Subtree> left, right; // of a large one
    std::vector<shared::BvhNode> nodes;   // of others, depth first, indices from 0
    uint32_t deepest = 0;                 // node of `nodes`
    uint32_t link = 0;                    // how the parent refers to it: a leaf, or, at last, its first node's index
};

bool is_leaf(const Subtree& subtree)
{
    return (subtree.link & VOILE_BVH_LEAF_BIT) != 0;
}

shared::BvhNode make_node(const Box& left_box, uint32_t left, const Box& right_box, uint32_t right)
{
    return {left_box.min, left, left_box.max, 0, right_box.min, right, right_box.max, 0};
}

class Builder
{
public:
    Builder(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const BvhOptions& options)
        : positions_(positions), triangles_(triangles), leaf_size_(std::clamp(options.triangles_per_leaf, 1u, 4u)),
          subtree_size_(std::max(options.triangles_per_subtree, leaf_size_)), threads_(options.threads),
          primitives_(std::make_unique_for_overwrite<Primitive[]>(triangles.size())),
          scratch_(std::make_unique_for_overwrite<Primitive[]>(triangles.size()))
    {
    }

    Bvh build()
    {
        sorted_.resize(triangles_.size());
        Subtree root;
        root.range = make_primitives();
        waiting_.push_back(&root);
        run_together(thread_count(threads_, triangles_.size() / subtree_size_ + 1), [this] { work(); });
        assemble(root);
        return {std::move(nodes_), std::move(sorted_), depth_};
    }

private:
    // Boxes of pieces are joined in order: which zero a minimum of 0 and -0 is must not depend on chance.
    PrimitiveRange make_primitives()
    {
        PrimitiveRange all{{primitives_.get(), triangles_.size()}, {}, {}};
        std::vector<PrimitiveRange> pieces((triangles_.size() + k_piece - 1) / k_piece);
        parallel_for(
            triangles_.size(), k_piece,
            [&](size_t first, size_t last)
            {
                PrimitiveRange piece;
                for (size_t t = first; t < last; ++t)
                    piece.add(primitives_[t] = make_primitive(positions_, triangles_, static_cast<uint32_t>(t)));
                pieces[first / k_piece] = piece;
            },
            threads_);
        for (const PrimitiveRange& piece : pieces)
        {
            all.box.add(piece.box);
            all.centroids.add(piece.centroids);
        }
        return all;
    }

    // What each thread does: takes up subtrees until there are none, and none can come.
    void work()
    {
        Splitter splitter;
        std::unique_lock lock(mutex_);
        for (;;)
        {
            changed_.wait(lock, [this] { return !waiting_.empty() || unfinished_ == 0; });
            if (unfinished_ == 0)
                return;
            Subtree& subtree = *waiting_.front(); // the largest ones come first
            waiting_.pop_front();
            lock.unlock();
            process(splitter, subtree);
            lock.lock();
            finish(subtree);
        }
    }

    void process(Splitter& splitter, Subtree& subtree)
    {
        try
        {
            if (subtree.range.primitives.size() > subtree_size_)
                split(splitter, subtree);
            else if (subtree.depth > 1 && subtree.range.primitives.size() <= leaf_size_)
                subtree.link = add_leaf(subtree.range);
            else
                add_nodes(splitter, subtree);
        }
        catch (...) // out of memory: the others are not to wait for it
        {
            const std::lock_guard lock(mutex_);
            unfinished_ = 0;
            changed_.notify_all();
            throw;
        }
    }

    void finish(Subtree& subtree)
    {
        if (unfinished_ == 0) // another thread failed
            return;
        --unfinished_;
        if (subtree.left)
        {
            waiting_.push_back(subtree.left.get());
            waiting_.push_back(subtree.right.get());
            unfinished_ += 2;
        }
        changed_.notify_all();
    }

    void split(Splitter& splitter, Subtree& subtree)
    {
        const Splitter::Halves halves = splitter.split(subtree.range, scratch(subtree.range), subtree.depth);
        subtree.left = std::make_unique<Subtree>();
        subtree.right = std::make_unique<Subtree>();
        subtree.left->range = halves.left;
        subtree.right->range = halves.right;
        subtree.left->depth = subtree.right->depth = subtree.depth + 1;
    }

    void add_nodes(Splitter& splitter, Subtree& subtree)
    {
        const PrimitiveRange& range = subtree.range;
        subtree.nodes.reserve(range.primitives.size());
        if (range.primitives.size() > leaf_size_)
        {
            add_node(splitter, subtree, range, subtree.depth);
            return;
        }
        const uint32_t leaf = add_leaf(range); // the whole mesh is one
        subtree.nodes.push_back(make_node(range.box, leaf, {}, leaf));
        subtree.deepest = 1;
    }

    // `depth` counts this node. Returns its index.
    uint32_t add_node(Splitter& splitter, Subtree& subtree, const PrimitiveRange& range, uint32_t depth)
    {
        subtree.deepest = std::max(subtree.deepest, depth);
        const auto index = static_cast<uint32_t>(subtree.nodes.size());
        subtree.nodes.emplace_back();
        const Splitter::Halves halves = splitter.split(range, scratch(range), depth);
        const uint32_t left = add_child(splitter, subtree, halves.left, depth + 1);
        const uint32_t right = add_child(splitter, subtree, halves.right, depth + 1);
        subtree.nodes[index] = make_node(halves.left.box, left, halves.right.box, right);
        return index;
    }

    uint32_t add_child(Splitter& splitter, Subtree& subtree, const PrimitiveRange& range, uint32_t depth)
    {
        return range.primitives.size() <= leaf_size_ ? add_leaf(range) : add_node(splitter, subtree, range, depth);
    }

    // The primitives are in the order of the leaves where they are.
    uint32_t add_leaf(const PrimitiveRange& range)
    {
        const size_t first = offset(range);
        for (size_t i = 0; i < range.primitives.size(); ++i)
        {
            const uint32_t index = range.primitives[i].triangle;
            const glm::uvec3& t = triangles_[index];
            sorted_[first + i] = {positions_[t.x], index, positions_[t.y], 0, positions_[t.z], 0};
        }
        return VOILE_BVH_LEAF_BIT | static_cast<uint32_t>(range.primitives.size() - 1) << VOILE_BVH_COUNT_SHIFT |
               static_cast<uint32_t>(first);
    }

    [[nodiscard]] size_t offset(const PrimitiveRange& range) const
    {
        return static_cast<size_t>(range.primitives.data() - primitives_.get());
    }

    [[nodiscard]] std::span<Primitive> scratch(const PrimitiveRange& range) const
    {
        return {scratch_.get() + offset(range), range.primitives.size()};
    }

    void assemble(Subtree& root)
    {
        uint32_t nodes = 0;
        std::vector<const Subtree*> built;
        place(root, nodes, built);
        nodes_.resize(nodes);
        join(root);
        parallel_for(
            built.size(), 1, [&](size_t first, size_t) { copy(*built[first]); }, threads_);
    }

    // Gives every subtree the index of its first node, depth first.
    void place(Subtree& subtree, uint32_t& next, std::vector<const Subtree*>& built)
    {
        if (is_leaf(subtree))
            return;
        subtree.link = next;
        if (subtree.left)
        {
            ++next;
            place(*subtree.left, next, built);
            place(*subtree.right, next, built);
            return;
        }
        next += static_cast<uint32_t>(subtree.nodes.size());
        depth_ = std::max(depth_, subtree.deepest);
        built.push_back(&subtree);
    }

    // The nodes above what single threads built.
    void join(const Subtree& subtree)
    {
        if (!subtree.left)
            return;
        const Subtree& left = *subtree.left;
        const Subtree& right = *subtree.right;
        nodes_[subtree.link] = make_node(left.range.box, left.link, right.range.box, right.link);
        depth_ = std::max(depth_, subtree.depth);
        join(left);
        join(right);
    }

    void copy(const Subtree& subtree)
    {
        const auto absolute = [&](uint32_t child)
        { return (child & VOILE_BVH_LEAF_BIT) != 0 ? child : child + subtree.link; };
        for (size_t i = 0; i < subtree.nodes.size(); ++i)
        {
            shared::BvhNode& node = nodes_[subtree.link + i] = subtree.nodes[i];
            node.left = absolute(node.left);
            node.right = absolute(node.right);
        }
    }

    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
    uint32_t leaf_size_;
    uint32_t subtree_size_;
    uint32_t threads_; // at most; 0: one per core
    std::unique_ptr<Primitive[]> primitives_;
    std::unique_ptr<Primitive[]> scratch_;
    std::vector<shared::BvhNode> nodes_;
    std::vector<shared::BvhTriangle> sorted_;
    uint32_t depth_ = 0;

    std::mutex mutex_; // of the following
    std::condition_variable changed_;
    std::deque<Subtree*> waiting_;
    size_t unfinished_ = 1; // subtrees that wait or are worked on; 0 too where one failed
};

} // namespace

Bvh build_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const BvhOptions& options)
{
    return Builder(positions, triangles, options).build();
}

} // namespace voile
