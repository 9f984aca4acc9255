// Pairs of vertices: which there are, and their sums.
#include "model/mesh_pairs.hpp"

#include "geometry/offsets.hpp"
#include "geometry/parallel.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace voile
{

namespace
{

constexpr size_t k_least_vertices = 2048; // per thread
constexpr size_t k_pair_piece = 8192;     // triangles per piece of work

// The side of a hinge that a triangle is on.
int side_of(const Hinge& hinge, uint32_t triangle)
{
    return hinge.triangle[0] == triangle ? 0 : 1;
}

// The vertex that the triangle on the given side does not have.
uint32_t apex_of(const Hinge& hinge, int side)
{
    return hinge.corner[3 - side];
}

// The hinges of each triangle.
class TriangleHinges
{
public:
    TriangleHinges(std::span<const Hinge> hinges, size_t triangles)
        : hinges_(hinges), first_(triangles + 1), indices_(2 * hinges.size()), vertices_(triangles)
    {
        for (const Hinge& hinge : hinges)
            for (const uint32_t triangle : hinge.triangle)
                ++first_[triangle];
        counts_to_offsets(first_);
        std::vector<uint32_t> next = first_;
        for (uint32_t i = 0; i < hinges.size(); ++i)
            for (const uint32_t triangle : hinges[i].triangle)
                indices_[next[triangle]++] = i;
        parallel_for(triangles, k_pair_piece,
                     [&](size_t begin, size_t end)
                     {
                         for (size_t t = begin; t < end; ++t)
                             vertices_[t] = vertices_of(t);
                     });
    }

    [[nodiscard]] uint32_t triangles() const { return static_cast<uint32_t>(vertices_.size()); }

    // Indices, in ascending order.
    [[nodiscard]] std::span<const uint32_t> of(size_t triangle) const
    {
        return std::span(indices_).subspan(first_[triangle], first_[triangle + 1] - first_[triangle]);
    }

    [[nodiscard]] const Hinge& operator[](uint32_t index) const { return hinges_[index]; }

    // Whether a pair of vertices of the triangle's hinges may be one of `pairs`.
    [[nodiscard]] bool nearby(size_t triangle, const MeshPairs& pairs) const
    {
        return vertices_[triangle].low < pairs.end && vertices_[triangle].high > pairs.begin;
    }

private:
    struct Range
    {
        uint32_t low = std::numeric_limits<uint32_t>::max();
        uint32_t high = 0;
    };

    [[nodiscard]] Range vertices_of(size_t triangle) const
    {
        Range range;
        for (const uint32_t index : of(triangle))
            for (const uint32_t vertex : hinges_[index].corner)
                range = {std::min(range.low, vertex), std::max(range.high, vertex)};
        return range;
    }

    std::span<const Hinge> hinges_;
    std::vector<uint32_t> first_; // one per triangle, then the length of indices_
    UninitializedArray<uint32_t> indices_;
    UninitializedArray<Range> vertices_; // lowest and highest one of a triangle's hinges
};

// Calls visit(low, high) for pairs of `pairs` that have any, some of them several times.
template <typename Visit>
void for_each_pair(const MeshElements& elements, const TriangleHinges& hinges, const MeshPairs& pairs,
                   const Visit& visit)
{
    const auto visit_own = [&](uint32_t a, uint32_t b)
    {
        if (pairs.owns(std::min(a, b)))
            visit(std::min(a, b), std::max(a, b));
    };
    for (const Edge& edge : elements.edges)
        visit_own(edge.a, edge.b);
    for (const OppositeSpring& spring : elements.opposites)
        visit_own(spring.a, spring.b);
    // Two folds of a triangle couple what either has: corners of the triangle, whose pairs have springs, the vertices
    // beyond, which are neighbors of these or opposite to them, and the two vertices beyond with each other.
    for (uint32_t t = 0; t < hinges.triangles(); ++t)
    {
        if (!hinges.nearby(t, pairs))
            continue;
        const std::span<const uint32_t> around = hinges.of(t);
        for (size_t i = 0; i < around.size(); ++i)
            for (size_t j = i + 1; j < around.size(); ++j)
            {
                const Hinge& one = hinges[around[i]];
                const Hinge& other = hinges[around[j]];
                const uint32_t a = apex_of(one, side_of(one, t));
                if (const uint32_t b = apex_of(other, side_of(other, t)); a != b)
                    visit_own(a, b);
            }
    }
}

void find_pairs(const MeshElements& elements, const TriangleHinges& hinges, MeshPairs& pairs)
{
    pairs.first.resize(pairs.end - pairs.begin + 1);
    for_each_pair(elements, hinges, pairs, [&](uint32_t low, uint32_t) { ++pairs.first[low - pairs.begin]; });
    counts_to_offsets(pairs.first);
    pairs.others.resize(pairs.first.back());
    std::vector<uint32_t> next = pairs.first;
    for_each_pair(elements, hinges, pairs,
                  [&](uint32_t low, uint32_t high) { pairs.others[next[low - pairs.begin]++] = high; });
    uint32_t kept = 0;
    uint32_t begin = 0;
    for (size_t a = 0; a + 1 < pairs.first.size(); ++a)
    {
        const uint32_t end = pairs.first[a + 1];
        const auto at = [&](uint32_t i) { return pairs.others.begin() + static_cast<std::ptrdiff_t>(i); };
        std::sort(at(begin), at(end));
        pairs.first[a] = kept;
        kept = static_cast<uint32_t>(std::unique_copy(at(begin), at(end), at(kept)) - pairs.others.begin());
        begin = end;
    }
    pairs.first.back() = kept;
    pairs.others.resize(kept);
    pairs.sums.resize(kept);
}

// The index of a pair that there is. Without branches on what is compared: as likely one way as the other.
uint32_t find(const MeshPairs& pairs, uint32_t low, uint32_t high)
{
    uint32_t at = pairs.first[low - pairs.begin];
    for (uint32_t count = pairs.first[low - pairs.begin + 1] - at; count > 1;)
    {
        const uint32_t half = count / 2;
        at += pairs.others[at + half - 1] < high ? half : 0;
        count -= half;
    }
    return at;
}

// Unit length, of the hinge's edge in the plane of the triangle on the given side.
glm::dvec3 normal_of(const Hinge& hinge, int side, std::span<const glm::dvec3> positions)
{
    const glm::dvec3& origin = positions[hinge.corner[0]];
    const glm::dvec3 along = positions[hinge.corner[1]] - origin;
    const double length = glm::length(along);
    const glm::dvec3 to_opposite = positions[hinge.corner[2 + side]] - origin;
    return glm::normalize(to_opposite - glm::dot(to_opposite, along) / (length * length) * along);
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
    // Adds to `pairs`.
    TriangleBending(const TriangleHinges& hinges, std::span<const glm::dvec3> positions, MeshPairs& pairs)
        : all_(hinges), positions_(positions), pairs_(pairs)
    {
    }

    void add(uint32_t triangle, double area)
    {
        find_hinges(triangle);
        find_sums();
        for (const LocalHinge& own : hinges_)
            for (const LocalHinge& other : hinges_)
                add(own, other, area);
        for (size_t i = 0; i < slots_.size(); ++i)
            if (slots_[i] != k_none)
                pairs_.sums[slots_[i]].bending = sums_[i];
    }

private:
    static constexpr uint32_t k_none = std::numeric_limits<uint32_t>::max();

    struct LocalHinge
    {
        std::array<uint32_t, 4> corner; // indices into vertices_
        const double* factor;
        glm::dvec3 normal;
    };

    void find_hinges(uint32_t triangle)
    {
        const std::span<const uint32_t> indices = all_.of(triangle);
        hinges_.resize(indices.size());
        vertices_.clear();
        for (size_t h = 0; h < indices.size(); ++h)
        {
            const Hinge& hinge = all_[indices[h]];
            hinges_[h].factor = hinge.factor;
            hinges_[h].normal = normal_of(hinge, side_of(hinge, triangle), positions_);
            for (size_t i = 0; i < 4; ++i)
            {
                const auto found = std::find(vertices_.begin(), vertices_.end(), hinge.corner[i]);
                hinges_[h].corner[i] = static_cast<uint32_t>(found - vertices_.begin());
                if (found == vertices_.end())
                    vertices_.push_back(hinge.corner[i]);
            }
        }
    }

    // The sums of all pairs so far: each is looked for once per triangle.
    void find_sums()
    {
        const size_t count = vertices_.size();
        if (numbers_.size() != count * count)
            number_pairs();
        size_t number = 0;
        for (size_t i = 0; i < count; ++i)
            for (size_t j = i + 1; j < count; ++j)
            {
                const auto [low, high] = std::minmax(vertices_[i], vertices_[j]);
                const uint32_t slot = pairs_.owns(low) ? find(pairs_, low, high) : k_none;
                slots_[number] = slot;
                sums_[number++] = slot != k_none ? pairs_.sums[slot].bending : 0;
            }
    }

    void number_pairs()
    {
        const size_t count = vertices_.size();
        const size_t pairs = count * (count - 1) / 2;
        slots_.resize(pairs);
        sums_.assign(pairs + count, 0);
        numbers_.resize(count * count);
        uint32_t number = 0;
        for (size_t i = 0; i < count; ++i)
        {
            for (size_t j = i + 1; j < count; ++j)
                numbers_[i * count + j] = numbers_[j * count + i] = number++;
            numbers_[i * count + i] = static_cast<uint32_t>(pairs + i);
        }
    }

    // Each pair comes twice, once either way round.
    void add(const LocalHinge& own, const LocalHinge& other, double area)
    {
        const double cosine = glm::dot(own.normal, other.normal);
        const double scale = cosine * cosine / (4 * area);
        for (size_t i = 0; i < 4; ++i)
        {
            const double row = 0.5 * scale * own.factor[i];
            const uint32_t* const numbers = &numbers_[own.corner[i] * vertices_.size()];
            for (size_t j = 0; j < 4; ++j)
                sums_[numbers[other.corner[j]]] += row * other.factor[j];
        }
    }

    const TriangleHinges& all_;
    std::span<const glm::dvec3> positions_;
    MeshPairs& pairs_;
    std::vector<LocalHinge> hinges_; // of a triangle
    std::vector<uint32_t> vertices_; // of these
    std::vector<uint32_t> numbers_;  // of the pairs of vertices_, then those of a vertex with itself
    std::vector<uint32_t> slots_;    // the index of each pair; k_none: another thread has it
    std::vector<double> sums_;       // by number, so far; not used of a vertex with itself
};

void fill_pairs(const MeshElements& elements, const TriangleHinges& hinges, std::span<const glm::dvec3> positions,
                const SolidTriangles& triangles, MeshPairs& pairs)
{
    find_pairs(elements, hinges, pairs);
    for (const Edge& edge : elements.edges)
        if (pairs.owns(edge.a))
            pairs.sums[find(pairs, edge.a, edge.b)].edge += 1;
    for (const OppositeSpring& spring : elements.opposites)
        if (const auto [low, high] = std::minmax(spring.a, spring.b); pairs.owns(low))
            pairs.sums[find(pairs, low, high)].opposite += spring.weight;
    if (hinges.triangles() == 0)
        return;
    for (PairSums& sums : pairs.sums)
        if (sums.edge == 0 && sums.opposite == 0)
            sums.bending = -0.0; // the sum of zeros below 0 is one
    TriangleBending bending(hinges, positions, pairs);
    for (uint32_t t = 0; t < hinges.triangles(); ++t)
        if (hinges.nearby(t, pairs))
            bending.add(t, triangles.areas[t]);
}

} // namespace

std::vector<MeshPairs> make_pairs(const MeshElements& elements, std::span<const glm::dvec3> positions,
                                  const SolidTriangles& triangles, bool isometric)
{
    const TriangleHinges hinges =
        isometric ? TriangleHinges(elements.hinges, triangles.corners.size()) : TriangleHinges({}, 0);
    const size_t piece = piece_per_thread(positions.size(), k_least_vertices);
    std::vector<MeshPairs> pieces((positions.size() + piece - 1) / piece);
    parallel_for(positions.size(), piece,
                 [&](size_t begin, size_t end)
                 {
                     MeshPairs& pairs = pieces[begin / piece];
                     pairs.begin = static_cast<uint32_t>(begin);
                     pairs.end = static_cast<uint32_t>(end);
                     fill_pairs(elements, hinges, positions, triangles, pairs);
                 });
    return pieces;
}

} // namespace voile
