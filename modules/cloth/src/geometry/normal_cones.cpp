// Cones of normals: merging, of a tree's nodes, and around triangles and edges.
#include "geometry/normal_cones.hpp"

#include "geometry/bvh_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace voile
{

namespace
{

constexpr float k_pi = std::numbers::pi_v<float>;

float diagonal(const Box& box)
{
    return glm::distance(box.min, box.max);
}

bool overlap(const Box& a, const Box& b)
{
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// A child of a node: a subtree or a leaf.
struct Child
{
    Box box;
    uint32_t reference = 0;
    uint32_t cone = 0; // index

    [[nodiscard]] bool is_leaf() const { return (reference & VOILE_BVH_LEAF_BIT) != 0; }
    [[nodiscard]] bool exists() const { return box.min.x <= box.max.x; }
    [[nodiscard]] uint32_t first() const { return reference & VOILE_BVH_FIRST_MASK; }
    [[nodiscard]] uint32_t last() const
    {
        return first() + (reference >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK);
    }
};

std::array<Child, 2> children(const MeshTree& tree, uint32_t n)
{
    const shared::BvhNode& node = tree.nodes[n];
    return {Child{{node.left_min, node.left_max}, node.left, 2 * n},
            Child{{node.right_min, node.right_max}, node.right, 2 * n + 1}};
}

class Walker
{
public:
    Walker(const MeshTree& tree, float width, float enough)
        : tree_(tree), width_(width), enough_(enough), cones_(2 * tree.nodes.size()), result_(tree.triangles.size())
    {
        for (size_t n = tree.nodes.size(); n-- > 0;) // children come after their parents
            for (const Child& child : children(tree, static_cast<uint32_t>(n)))
                if (child.exists())
                    cones_[child.cone] = cone_of(child);
    }

    std::vector<Surroundings> run()
    {
        visit_node(0);
        return std::move(result_);
    }

private:
    [[nodiscard]] Cone cone_of(const Child& child) const
    {
        if (!child.is_leaf())
            return merge(cones_[2 * size_t{child.reference}], cones_[2 * size_t{child.reference} + 1]);
        Cone cone;
        for (uint32_t t = child.first(); t <= child.last(); ++t)
            cone = merge(cone, {unit_normal(tree_.triangles[t]), 0});
        return cone;
    }

    void visit_node(uint32_t n)
    {
        for (const Child& child : children(tree_, n))
        {
            if (!child.exists())
                continue;
            if (child.is_leaf() || diagonal(child.box) <= width_ / 2)
                mark(child, find_surroundings(child));
            else
                visit_node(child.reference);
        }
    }

    [[nodiscard]] Surroundings find_surroundings(const Child& child) const
    {
        const glm::vec3 margin(width_ / 4);
        Cone cone = cones_[child.cone];
        gather(0, {child.box.min - margin, child.box.max + margin}, cone);
        Surroundings result{cone.angle, diagonal(child.box) <= width_ / 2};
        if (child.is_leaf())
            for (uint32_t t = child.first(); t <= child.last(); ++t)
                result.narrow |= smallest_height(tree_.triangles[t]) <= width_ / 2;
        return result;
    }

    void gather(uint32_t n, const Box& box, Cone& cone) const
    {
        for (const Child& child : children(tree_, n))
        {
            if (cone.angle > enough_ || !child.exists() || !overlap(child.box, box))
                continue;
            if (child.is_leaf())
                gather_leaf(child, box, cone);
            else if (diagonal(child.box) <= width_ / 4)
                cone = merge(cone, cones_[child.cone]);
            else
                gather(child.reference, box, cone);
        }
    }

    void gather_leaf(const Child& leaf, const Box& box, Cone& cone) const
    {
        for (uint32_t t = leaf.first(); t <= leaf.last(); ++t)
        {
            const shared::BvhTriangle& triangle = tree_.triangles[t];
            Box own;
            for (const glm::vec3& p : {triangle.a, triangle.b, triangle.c})
                own.add(p);
            if (overlap(own, box))
                cone = merge(cone, {unit_normal(triangle), 0});
        }
    }

    void mark(const Child& child, const Surroundings& value)
    {
        if (child.is_leaf())
        {
            std::fill(result_.begin() + child.first(), result_.begin() + child.last() + 1, value);
            return;
        }
        for (const Child& below : children(tree_, child.reference))
            if (below.exists())
                mark(below, value);
    }

    [[nodiscard]] static float smallest_height(const shared::BvhTriangle& t)
    {
        const float longest = std::max({glm::distance(t.a, t.b), glm::distance(t.b, t.c), glm::distance(t.c, t.a)});
        return glm::length(glm::cross(t.b - t.a, t.c - t.a)) / longest;
    }

    MeshTree tree_;
    float width_;
    float enough_;
    std::vector<Cone> cones_; // of the left and the right child of each node
    std::vector<Surroundings> result_;
};

// The fan of normals about an edge.
class Fan
{
public:
    Fan(const MeshTree& tree, const glm::vec3& a, const glm::vec3& b, float radius, float enough)
        : tree_(tree), origin_(a), direction_(glm::normalize(b - a)), length_(glm::distance(a, b)), radius_(radius),
          enough_(enough)
    {
        box_.add(a);
        box_.add(b);
        box_.min -= radius;
        box_.max += radius;
    }

    float run()
    {
        gather(0);
        return cone_.angle;
    }

private:
    void gather(uint32_t n)
    {
        for (const Child& child : children(tree_, n))
        {
            if (cone_.angle > enough_ || !child.exists() || !overlap(child.box, box_))
                continue;
            if (!child.is_leaf())
                gather(child.reference);
            else
                for (uint32_t t = child.first(); t <= child.last(); ++t)
                    add(tree_.triangles[t]);
        }
    }

    void add(const shared::BvhTriangle& triangle)
    {
        constexpr float k_along = 0.5f; // the sine of 30 degrees: a normal nearer to the edge than this faces along it
        const glm::vec3 normal = unit_normal(triangle);
        const glm::vec3 across = normal - glm::dot(normal, direction_) * direction_;
        if (glm::length(across) >= k_along && is_beside(triangle))
            cone_ = merge(cone_, {glm::normalize(across), 0});
    }

    // Seen along the edge, where it is a point, a triangle that does not face along it is about as far as its nearest
    // side.
    [[nodiscard]] bool is_beside(const shared::BvhTriangle& triangle) const
    {
        const std::array<glm::vec3, 3> corners{triangle.a - origin_, triangle.b - origin_, triangle.c - origin_};
        const std::array<float, 3> along{glm::dot(corners[0], direction_), glm::dot(corners[1], direction_),
                                         glm::dot(corners[2], direction_)};
        if (*std::max_element(along.begin(), along.end()) <= 0 ||
            *std::min_element(along.begin(), along.end()) >= length_)
            return false;
        float nearest = std::numeric_limits<float>::infinity();
        for (size_t i = 0; i < 3; ++i)
        {
            const size_t next = (i + 1) % 3;
            const glm::vec3 from = corners[i] - along[i] * direction_;
            const glm::vec3 side = corners[next] - along[next] * direction_ - from;
            const float t = std::clamp(-glm::dot(from, side) / std::max(glm::dot(side, side), 1e-30f), 0.f, 1.f);
            nearest = std::min(nearest, glm::length(from + t * side));
        }
        return nearest < radius_;
    }

    MeshTree tree_;
    glm::vec3 origin_;
    glm::vec3 direction_;
    float length_;
    float radius_;
    float enough_;
    Box box_;
    Cone cone_;
};

} // namespace

float turn_about(const MeshTree& tree, const glm::vec3& a, const glm::vec3& b, float radius, float enough)
{
    return Fan(tree, a, b, radius, enough).run();
}

glm::vec3 unit_normal(const shared::BvhTriangle& triangle)
{
    return glm::normalize(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
}

Cone merge(const Cone& a, const Cone& b)
{
    if (a.angle < 0)
        return b;
    if (b.angle < 0)
        return a;
    const float between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.f, 1.f));
    if (between + b.angle <= a.angle)
        return a;
    if (between + a.angle <= b.angle)
        return b;
    const float angle = 0.5f * (a.angle + b.angle + between);
    const glm::vec3 aside = b.axis - glm::dot(a.axis, b.axis) * a.axis;
    const float sine = glm::length(aside);
    if (angle >= k_pi || sine < 1e-6f)
        return {a.axis, between < 1 ? std::max(a.angle, b.angle) : k_pi};
    const float turn = angle - a.angle;
    return {glm::normalize(std::cos(turn) * a.axis + std::sin(turn) / sine * aside), angle};
}

std::vector<Surroundings> surroundings(const MeshTree& tree, float width, float enough)
{
    return Walker(tree, width, enough).run();
}

} // namespace voile
