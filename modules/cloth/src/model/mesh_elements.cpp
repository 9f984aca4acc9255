// Springs and hinges of a mesh, and the softening of what its slivers have too stiff.
#include "model/mesh_elements.hpp"

#include "geometry/offsets.hpp"
#include "geometry/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voile
{

namespace
{

// How many elements of a mesh may be called few: a hundredth; in small meshes the edges of four triangles, but no more
// than a twentieth. Of less than the edges of one triangle nothing is softened.
constexpr size_t k_few = 12;
constexpr size_t k_fewest = 3;
// How many times as stiff as all but a few an element may be. Against the mass they move, triangles go with 1 /
// height^2, all of bending with 1 / length^4 and folds with the angles too: nine in ten meshes whose vertices were put
// up to a quarter of their spacing aside have up to 5 and up to 22 times, slivers thousands and more.
constexpr double k_ahead = 8;
constexpr double k_bending_ahead = 64;

constexpr size_t k_element_piece = 8192; // elements or vertices per piece of work

// Cotangent of the angle at `at` between the ways to p and q.
double cotangent(const glm::dvec3& at, const glm::dvec3& p, const glm::dvec3& q)
{
    return glm::dot(p - at, q - at) / glm::length(glm::cross(p - at, q - at));
}

// A triangle seen from one of its edges.
struct Side
{
    uint32_t triangle;
    uint32_t corner; // of the triangle, where the side begins
    uint32_t opposite;
};

Side side_of(const SolidTriangles& triangles, uint32_t number)
{
    const uint32_t corner = number % 3;
    return {number / 3, corner, triangles.corners[number / 3][static_cast<int>((corner + 2) % 3)]};
}

// The sides of a vertex are those of the edges to higher vertices.
struct SidesOfVertices
{
    std::vector<uint32_t> first; // one per vertex, then their number
    // The edge's higher vertex in the upper half, 3 * triangle + corner in the lower one; in ascending order.
    UninitializedArray<uint64_t> sides;

    [[nodiscard]] std::span<const uint64_t> of(size_t vertex) const
    {
        return std::span(sides).subspan(first[vertex], first[vertex + 1] - first[vertex]);
    }
};

SidesOfVertices sides_of_vertices(size_t vertices, std::span<const glm::uvec3> triangles)
{
    const auto visit = [&](auto&& each)
    {
        for (uint32_t triangle = 0; triangle < triangles.size(); ++triangle)
            for (int corner = 0; corner < 3; ++corner)
            {
                const uint32_t a = triangles[triangle][corner];
                const uint32_t b = triangles[triangle][(corner + 1) % 3];
                each(std::min(a, b), std::max(a, b), 3 * triangle + static_cast<uint32_t>(corner));
            }
    };
    SidesOfVertices result{std::vector<uint32_t>(vertices + 1), UninitializedArray<uint64_t>(3 * triangles.size())};
    visit([&](uint32_t a, uint32_t, uint32_t) { ++result.first[a]; });
    counts_to_offsets(result.first);
    std::vector<uint32_t> next = result.first;
    visit([&](uint32_t a, uint32_t b, uint32_t side) { result.sides[next[a]++] = uint64_t{b} << 32 | side; });
    parallel_for(vertices, k_element_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t v = begin; v < end; ++v)
                         std::sort(result.sides.data() + result.first[v], result.sides.data() + result.first[v + 1]);
                 });
    return result;
}

// Calls visit(b, sides) for each edge from a vertex to a higher one, b.
template <typename Visit>
void for_each_edge(std::span<const uint64_t> sides, const Visit& visit)
{
    for (size_t first = 0; first < sides.size();)
    {
        const uint64_t b = sides[first] >> 32;
        size_t last = first + 1;
        while (last < sides.size() && sides[last] >> 32 == b)
            ++last;
        visit(static_cast<uint32_t>(b), sides.subspan(first, last - first));
        first = last;
    }
}

// Calls visit(first, second) for each pair of triangles at an edge.
template <typename Visit>
void for_each_hinge(const SolidTriangles& triangles, std::span<const uint64_t> sides, const Visit& visit)
{
    for (size_t i = 0; i < sides.size(); ++i)
        for (size_t j = i + 1; j < sides.size(); ++j)
        {
            const Side first = side_of(triangles, static_cast<uint32_t>(sides[i]));
            const Side second = side_of(triangles, static_cast<uint32_t>(sides[j]));
            if (first.opposite != second.opposite) // else two triangles back to back
                visit(first, second);
        }
}

Hinge make_hinge(std::span<const glm::dvec3> positions, const Edge& edge, const Side& first, const Side& second)
{
    Hinge hinge{{edge.a, edge.b, first.opposite, second.opposite}, {}, {first.triangle, second.triangle}, 0};
    glm::dvec3 x[4];
    for (int i = 0; i < 4; ++i)
        x[i] = positions[hinge.corner[i]];
    const double c01 = cotangent(x[0], x[1], x[2]);
    const double c02 = cotangent(x[0], x[1], x[3]);
    const double c03 = cotangent(x[1], x[0], x[2]);
    const double c04 = cotangent(x[1], x[0], x[3]);
    hinge.factor[0] = c03 + c04;
    hinge.factor[1] = c01 + c02;
    hinge.factor[2] = -c01 - c03;
    hinge.factor[3] = -c02 - c04;
    return hinge;
}

// Where the edges and hinges of each vertex begin, then their numbers.
struct FirstElements
{
    std::vector<size_t> edges;
    std::vector<size_t> hinges;
};

FirstElements count_elements(const SidesOfVertices& sides, const SolidTriangles& triangles)
{
    const size_t vertices = sides.first.size() - 1;
    FirstElements first{std::vector<size_t>(vertices + 1), std::vector<size_t>(vertices + 1)};
    parallel_for(vertices, k_element_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t a = begin; a < end; ++a)
                         for_each_edge(sides.of(a),
                                       [&](uint32_t, std::span<const uint64_t> of_edge)
                                       {
                                           ++first.edges[a];
                                           for_each_hinge(triangles, of_edge,
                                                          [&](const Side&, const Side&) { ++first.hinges[a]; });
                                       });
                 });
    counts_to_offsets(first.edges);
    counts_to_offsets(first.hinges);
    return first;
}

// Fills the elements of consecutive edges, from the given indices on.
class ElementFiller
{
public:
    ElementFiller(std::span<const glm::dvec3> positions, const SolidTriangles& triangles, MeshElements& elements,
                  size_t edge, size_t hinge)
        : positions_(positions), triangles_(triangles), elements_(elements), edge_(edge), hinge_(hinge)
    {
        report_.shortest_edge = std::numeric_limits<float>::max();
    }

    void add(const Edge& edge, std::span<const uint64_t> sides)
    {
        const auto index = static_cast<uint32_t>(edge_++);
        elements_.edges[index] = edge;
        if (!elements_.triangles.empty())
            for (const uint64_t number : sides)
            {
                const Side side = side_of(triangles_, static_cast<uint32_t>(number));
                elements_.triangles[side.triangle].edge[side.corner] = index;
            }
        for_each_hinge(triangles_, sides,
                       [&](const Side& first, const Side& second)
                       {
                           // One bend spring for three edges a vertex, where a grid has two directions: two thirds of
                           // its B / area.
                           const double area = triangles_.areas[first.triangle] + triangles_.areas[second.triangle];
                           elements_.opposites[hinge_] = {first.opposite, second.opposite, 2.0 / 3 / area};
                           elements_.hinges[hinge_] = make_hinge(positions_, edge, first, second);
                           elements_.hinges[hinge_++].edge = index;
                       });
        const double length = glm::distance(positions_[edge.a], positions_[edge.b]);
        report_.boundary_edges += sides.size() == 1 ? 1 : 0;
        report_.non_manifold_edges += sides.size() > 2 ? 1 : 0;
        report_.shortest_edge = std::min(report_.shortest_edge, static_cast<float>(length));
    }

    [[nodiscard]] const MeshReport& report() const { return report_; } // of these edges

private:
    std::span<const glm::dvec3> positions_;
    const SolidTriangles& triangles_;
    MeshElements& elements_;
    size_t edge_;
    size_t hinge_;
    MeshReport report_;
};

// Stiffness over the mass of the lighter end.
double rate_of(const OppositeSpring& spring, std::span<const double> areas)
{
    return spring.weight / std::min(areas[spring.a], areas[spring.b]);
}

// Likewise, of the corner where it is largest: area / height^2 over the mass there.
double rate_of(const MembraneTriangle& t, std::span<const double> areas)
{
    double rate = 0;
    for (int i = 0; i < 3; ++i)
    {
        const double opposite = glm::distance(t.position[(i + 1) % 3], t.position[(i + 2) % 3]);
        rate = std::max(rate, opposite * opposite / (4 * t.area * areas[t.corner[i]]));
    }
    return rate;
}

// The largest rate that is left as it is.
double largest_rate(std::span<const double> rates, double ahead)
{
    const size_t few = std::max(rates.size() / 100, std::min(rates.size() / 20, k_few));
    if (few < k_fewest)
        return std::numeric_limits<double>::max();
    const double most = *std::max_element(rates.begin(), rates.end());
    const auto near = std::count_if(rates.begin(), rates.end(), [&](double rate) { return most <= ahead * rate; });
    if (static_cast<size_t>(near) > few) // the usual mesh
        return most;
    std::vector<double> ordered(rates.begin(), rates.end());
    const auto last = ordered.end() - 1 - static_cast<std::ptrdiff_t>(few);
    std::nth_element(ordered.begin(), last, ordered.end());
    const double bound = ahead * *last;
    double largest = *last;
    for (auto rate = last; rate != ordered.end(); ++rate) // the others are at most *last
        if (*rate <= bound)
            largest = std::max(largest, *rate);
    return largest;
}

// Likewise, of the corner where it is largest: what the fold alone has of the row sums of the bending form.
double rate_of(const Hinge& hinge, const SolidTriangles& triangles, std::span<const double> areas)
{
    double sum = 0;
    for (const double factor : hinge.factor)
        sum += std::abs(factor);
    double rate = 0;
    for (int i = 0; i < 4; ++i)
    {
        const double own = std::abs(hinge.factor[i]);
        rate = std::max(rate, own * (sum - own) / areas[hinge.corner[i]]);
    }
    return rate * (1 / triangles.areas[hinge.triangle[0]] + 1 / triangles.areas[hinge.triangle[1]]) / 4;
}

void soften(OppositeSpring& spring, double scale)
{
    spring.weight *= scale;
}

void soften(MembraneTriangle& triangle, double scale)
{
    triangle.weight *= scale;
}

void soften(Hinge& hinge, double scale)
{
    for (double& factor : hinge.factor)
        factor *= std::sqrt(scale);
}

// Returns the indices of the elements that it softens. `rate`: of an element.
template <typename Element, typename Rate>
std::vector<size_t> soften_stiffest(UninitializedArray<Element>& elements, double ahead, const Rate& rate)
{
    UninitializedArray<double> rates(elements.size());
    parallel_for(elements.size(), k_element_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t i = begin; i < end; ++i)
                         rates[i] = rate(elements[i]);
                 });
    const double largest = largest_rate(rates, ahead);
    std::vector<size_t> softened;
    for (size_t i = 0; i < elements.size(); ++i)
        if (rates[i] > largest)
        {
            soften(elements[i], largest / rates[i]);
            softened.push_back(i);
        }
    return softened;
}

} // namespace

MeshElements make_elements(std::span<const glm::dvec3> positions, const SolidTriangles& triangles,
                           const FabricCoordinates* fabric, MeshReport& report)
{
    MeshElements elements;
    if (fabric)
    {
        elements.triangles = UninitializedArray<MembraneTriangle>(triangles.corners.size());
        parallel_for(triangles.corners.size(), k_element_piece,
                     [&](size_t begin, size_t end)
                     {
                         for (size_t i = begin; i < end; ++i)
                             elements.triangles[i] = make_membrane_triangle(positions, triangles.corners[i], *fabric);
                     });
    }
    const SidesOfVertices sides = sides_of_vertices(positions.size(), triangles.corners);
    const FirstElements first = count_elements(sides, triangles);
    elements.edges = UninitializedArray<Edge>(first.edges.back());
    elements.opposites = UninitializedArray<OppositeSpring>(first.hinges.back());
    elements.hinges = UninitializedArray<Hinge>(first.hinges.back());
    std::vector<MeshReport> reports((positions.size() + k_element_piece - 1) / k_element_piece);
    parallel_for(positions.size(), k_element_piece,
                 [&](size_t begin, size_t end)
                 {
                     ElementFiller filler(positions, triangles, elements, first.edges[begin], first.hinges[begin]);
                     for (size_t a = begin; a < end; ++a)
                         for_each_edge(sides.of(a),
                                       [&](uint32_t b, std::span<const uint64_t> of_edge) {
                                           filler.add({static_cast<uint32_t>(a), b}, of_edge);
                                       });
                     reports[begin / k_element_piece] = filler.report();
                 });
    report.shortest_edge = std::numeric_limits<float>::max();
    for (const MeshReport& part : reports)
    {
        report.boundary_edges += part.boundary_edges;
        report.non_manifold_edges += part.non_manifold_edges;
        report.shortest_edge = std::min(report.shortest_edge, part.shortest_edge);
    }
    return elements;
}

uint32_t soften_slivers(MeshElements& elements, const SolidTriangles& triangles, std::span<const double> areas,
                        bool uniform_masses)
{
    const std::vector<double> ones(uniform_masses ? areas.size() : 0, 1.0);
    const std::span<const double> measures = uniform_masses ? ones : areas;
    const auto rate = [&](const auto& element) { return rate_of(element, areas); };
    std::vector<uint32_t> edges;
    if (!uniform_masses)
    {
        for (const size_t i : soften_stiffest(elements.triangles, k_ahead, rate))
            edges.insert(edges.end(), std::begin(elements.triangles[i].edge), std::end(elements.triangles[i].edge));
        for (const size_t i : soften_stiffest(elements.opposites, k_bending_ahead, rate))
            edges.push_back(elements.hinges[i].edge);
    }
    for (const size_t i : soften_stiffest(elements.hinges, k_bending_ahead,
                                          [&](const Hinge& hinge) { return rate_of(hinge, triangles, measures); }))
        edges.push_back(elements.hinges[i].edge);
    std::sort(edges.begin(), edges.end());
    return static_cast<uint32_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

} // namespace voile
