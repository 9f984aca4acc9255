// Pairs of vertices: which there are, and their sums.
#include "model/mesh_pairs.hpp"

#include "geometry/counting_sort.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace voile
{

namespace
{

// A hinge as one of its triangles has it.
struct TriangleHinge
{
    const Hinge* hinge;
    int side;

    // The vertex that the triangle does not have.
    [[nodiscard]] uint32_t apex() const { return hinge->corner[3 - side]; }
};

// The hinges of each triangle, in their order.
struct TriangleHinges
{
    std::vector<uint32_t> first; // one per triangle, then their number
    std::vector<TriangleHinge> hinges;

    [[nodiscard]] std::span<const TriangleHinge> of(size_t triangle) const
    {
        return std::span(hinges).subspan(first[triangle], first[triangle + 1] - first[triangle]);
    }
};

TriangleHinges hinges_of_triangles(std::span<const Hinge> hinges, size_t triangles)
{
    TriangleHinges result;
    result.first.resize(triangles + 1);
    for (const Hinge& hinge : hinges)
        for (const uint32_t triangle : hinge.triangle)
            ++result.first[triangle];
    counts_to_offsets(result.first);
    result.hinges.resize(2 * hinges.size());
    std::vector<uint32_t> next = result.first;
    for (const Hinge& hinge : hinges)
        for (int side = 0; side < 2; ++side)
            result.hinges[next[hinge.triangle[side]]++] = {&hinge, side};
    return result;
}

struct Ends
{
    uint32_t low;
    uint32_t high;

    friend bool operator==(const Ends&, const Ends&) = default;
};

Ends ends_of(uint32_t a, uint32_t b)
{
    return {std::min(a, b), std::max(a, b)};
}

// Two folds of a triangle couple what either has: corners of the triangle, whose pairs have springs, the vertices
// beyond, which are neighbors of these or opposite to them, and the two vertices beyond with each other.
void add_bending_ends(const TriangleHinges& hinges, size_t triangles, std::vector<Ends>& ends)
{
    for (size_t t = 0; t < triangles; ++t)
    {
        const std::span<const TriangleHinge> around = hinges.of(t);
        for (size_t i = 0; i < around.size(); ++i)
            for (size_t j = i + 1; j < around.size(); ++j)
                if (around[i].apex() != around[j].apex())
                    ends.push_back(ends_of(around[i].apex(), around[j].apex()));
    }
}

MeshPairs pairs_between(std::vector<Ends> ends, size_t vertices)
{
    sort_by_two_keys(
        ends, vertices, [](const Ends& e) { return e.low; }, [](const Ends& e) { return e.high; });
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    MeshPairs pairs;
    pairs.first.resize(vertices + 1);
    pairs.others.reserve(ends.size());
    for (const Ends& e : ends)
    {
        ++pairs.first[e.low];
        pairs.others.push_back(e.high);
    }
    counts_to_offsets(pairs.first);
    pairs.sums.resize(ends.size());
    return pairs;
}

// The index of a pair that there is.
uint32_t find(const MeshPairs& pairs, uint32_t a, uint32_t b)
{
    const auto [low, high] = ends_of(a, b);
    const auto begin = pairs.others.begin() + pairs.first[low];
    const auto end = pairs.others.begin() + pairs.first[low + 1];
    return static_cast<uint32_t>(std::lower_bound(begin, end, high) - pairs.others.begin());
}

// The isometric model of one triangle. Its curvature is S = sum over its hinges of (fold / 2A) m m^T, m the side's
// normal in the plane (Grinspun et al. 2006, "Computing discrete shape operators on general meshes", equation 2 with
// the angle shared by both triangles), its energy 1/2 B A |S|^2: a quadratic form with constant coefficients, as in
// Bergou et al. 2006. Their own sum over hinges alone resists a bend across the strip less where the strip is bent
// along (a Poisson ratio of -1/3, which lets a narrow cantilever hang 12 % too low); this one is exact for every state
// of constant curvature.
class TriangleBending
{
public:
    explicit TriangleBending(MeshPairs& pairs) : pairs_(pairs) {}

    void add(std::span<const TriangleHinge> hinges)
    {
        find_pairs(hinges);
        for (size_t h = 0; h < hinges.size(); ++h)
            for (size_t g = 0; g < hinges.size(); ++g)
                add(hinges[h], local_[h], hinges[g], local_[g]);
        for (size_t i = 0; i < slots_.size(); ++i)
            pairs_.sums[slots_[i]].bending = sums_[i];
    }

private:
    using Corners = std::array<uint32_t, 4>; // of a hinge, as indices into vertices_

    // The vertices of all hinges, and the pairs of these: each is looked for once per triangle.
    void find_pairs(std::span<const TriangleHinge> hinges)
    {
        vertices_.clear();
        local_.clear();
        for (const TriangleHinge& h : hinges)
        {
            Corners& corners = local_.emplace_back();
            for (size_t i = 0; i < 4; ++i)
            {
                const uint32_t vertex = h.hinge->corner[i];
                const auto found = std::find(vertices_.begin(), vertices_.end(), vertex);
                corners[i] = static_cast<uint32_t>(found - vertices_.begin());
                if (found == vertices_.end())
                    vertices_.push_back(vertex);
            }
        }
        slots_.clear();
        sums_.clear();
        numbers_.resize(vertices_.size() * vertices_.size());
        for (size_t i = 0; i < vertices_.size(); ++i)
            for (size_t j = i + 1; j < vertices_.size(); ++j)
            {
                number(i, j) = number(j, i) = static_cast<uint32_t>(slots_.size());
                slots_.push_back(find(pairs_, vertices_[i], vertices_[j]));
                sums_.push_back(pairs_.sums[slots_.back()].bending);
            }
    }

    uint32_t& number(size_t i, size_t j) { return numbers_[i * vertices_.size() + j]; }

    void add(const TriangleHinge& own, const Corners& own_corners, const TriangleHinge& other,
             const Corners& other_corners)
    {
        const double cosine = glm::dot(own.hinge->normal[own.side], other.hinge->normal[other.side]);
        const double scale = cosine * cosine / (4 * own.hinge->areas[own.side]);
        for (size_t i = 0; i < 4; ++i)
        {
            const double row = 0.5 * scale * own.hinge->factor[i];
            for (size_t j = 0; j < 4; ++j)
                if (own_corners[i] != other_corners[j]) // each pair comes twice, once either way round
                    sums_[number(own_corners[i], other_corners[j])] += row * other.hinge->factor[j];
        }
    }

    MeshPairs& pairs_;
    std::vector<uint32_t> vertices_; // of the hinges of a triangle
    std::vector<Corners> local_;     // of these, one per hinge
    std::vector<uint32_t> numbers_;  // of the pairs of vertices_
    std::vector<uint32_t> slots_;    // the index of each pair
    std::vector<double> sums_;       // its sum so far
};

} // namespace

MeshPairs make_pairs(const MeshElements& elements, size_t vertices, size_t triangles, bool isometric)
{
    const TriangleHinges hinges =
        isometric ? hinges_of_triangles(elements.hinges, triangles) : TriangleHinges{std::vector<uint32_t>(), {}};
    std::vector<Ends> ends;
    ends.reserve(elements.edges.size() + elements.opposites.size() + (isometric ? 3 * triangles : 0));
    for (const ElementSpring& spring : elements.edges)
        ends.push_back(ends_of(spring.a, spring.b));
    for (const ElementSpring& spring : elements.opposites)
        ends.push_back(ends_of(spring.a, spring.b));
    if (isometric)
        add_bending_ends(hinges, triangles, ends);

    MeshPairs pairs = pairs_between(std::move(ends), vertices);
    for (const ElementSpring& spring : elements.edges)
        pairs.sums[find(pairs, spring.a, spring.b)].edge += spring.weight;
    for (const ElementSpring& spring : elements.opposites)
        pairs.sums[find(pairs, spring.a, spring.b)].opposite += spring.weight;
    if (isometric)
    {
        for (PairSums& sums : pairs.sums)
            if (sums.edge == 0 && sums.opposite == 0)
                sums.bending = -0.0; // the sum of zeros below 0 is one
        TriangleBending bending(pairs);
        for (size_t t = 0; t < triangles; ++t)
            bending.add(hinges.of(t));
    }
    return pairs;
}

} // namespace voile
