// Springs and hinges of a mesh, and the softening of what its slivers have too stiff.
#include "model/mesh_elements.hpp"

#include "geometry/counting_sort.hpp"

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

// Cotangent of the angle at `at` between the ways to p and q.
double cotangent(const glm::dvec3& at, const glm::dvec3& p, const glm::dvec3& q)
{
    return glm::dot(p - at, q - at) / glm::length(glm::cross(p - at, q - at));
}

Hinge make_hinge(std::span<const glm::dvec3> positions, const MeshSide& first, const MeshSide& second)
{
    Hinge hinge{};
    const uint32_t corners[4] = {first.a, first.b, first.opposite, second.opposite};
    glm::dvec3 x[4];
    for (int i = 0; i < 4; ++i)
    {
        hinge.corner[i] = corners[i];
        x[i] = positions[corners[i]];
    }
    const double c01 = cotangent(x[0], x[1], x[2]);
    const double c02 = cotangent(x[0], x[1], x[3]);
    const double c03 = cotangent(x[1], x[0], x[2]);
    const double c04 = cotangent(x[1], x[0], x[3]);
    hinge.factor[0] = c03 + c04;
    hinge.factor[1] = c01 + c02;
    hinge.factor[2] = -c01 - c03;
    hinge.factor[3] = -c02 - c04;
    const glm::dvec3 along = x[1] - x[0];
    const double length = glm::length(along);
    for (int side = 0; side < 2; ++side)
    {
        const glm::dvec3 to_opposite = x[2 + side] - x[0];
        hinge.normal[side] = glm::normalize(to_opposite - glm::dot(to_opposite, along) / (length * length) * along);
        hinge.areas[side] = side == 0 ? first.area : second.area;
        hinge.triangle[side] = side == 0 ? first.triangle : second.triangle;
    }
    return hinge;
}

// Stiffness over the mass of the lighter end.
double rate_of(const ElementSpring& spring, std::span<const double> areas)
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
double largest_rate(std::vector<double> rates, double ahead)
{
    const size_t few = std::max(rates.size() / 100, std::min(rates.size() / 20, k_few));
    if (few < k_fewest)
        return std::numeric_limits<double>::max();
    const auto last = rates.end() - 1 - static_cast<std::ptrdiff_t>(few);
    std::nth_element(rates.begin(), last, rates.end());
    const double bound = ahead * *last;
    double largest = *last;
    for (auto rate = last; rate != rates.end(); ++rate) // the others are at most *last
        if (*rate <= bound)
            largest = std::max(largest, *rate);
    return largest;
}

// Likewise, of the corner where it is largest: what the fold alone has of the row sums of the bending form.
double rate_of(const Hinge& hinge, std::span<const double> areas)
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
    return rate * (1 / hinge.areas[0] + 1 / hinge.areas[1]) / 4;
}

void soften(ElementSpring& spring, double scale)
{
    spring.weight *= scale;
}

void soften(MembraneTriangle& triangle, double scale)
{
    triangle.weight *= scale;
}

void add_edges(const MembraneTriangle& triangle, std::vector<uint32_t>& edges)
{
    edges.insert(edges.end(), std::begin(triangle.edge), std::end(triangle.edge));
}

template <typename Element>
void add_edges(const Element& element, std::vector<uint32_t>& edges)
{
    edges.push_back(element.edge);
}

void soften(Hinge& hinge, double scale)
{
    for (double& factor : hinge.factor)
        factor *= std::sqrt(scale);
}

// Adds the edges of softened elements to `edges`.
template <typename Element>
void soften_stiffest(std::vector<Element>& elements, std::span<const double> areas, double ahead,
                     std::vector<uint32_t>& edges)
{
    std::vector<double> rates;
    rates.reserve(elements.size());
    for (const Element& element : elements)
        rates.push_back(rate_of(element, areas));
    const double largest = largest_rate(rates, ahead);
    for (size_t i = 0; i < elements.size(); ++i)
        if (rates[i] > largest)
        {
            soften(elements[i], largest / rates[i]);
            add_edges(elements[i], edges);
        }
}

} // namespace

double triangle_area(std::span<const glm::dvec3> x, const glm::uvec3& t)
{
    const glm::dvec3 a(x[t.x]);
    return 0.5 * glm::length(glm::cross(x[t.y] - a, x[t.z] - a));
}

std::vector<MeshSide> sides_of(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles)
{
    std::vector<MeshSide> sides;
    sides.reserve(3 * triangles.size());
    for (uint32_t triangle = 0; triangle < triangles.size(); ++triangle)
    {
        const glm::uvec3& t = triangles[triangle];
        const double area = triangle_area(positions, t);
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t a = t[corner];
            const uint32_t b = t[(corner + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t[(corner + 2) % 3], triangle, corner, area});
        }
    }
    sort_by_two_keys(
        sides, positions.size(), [](const MeshSide& side) { return side.a; },
        [](const MeshSide& side) { return side.b; });
    return sides;
}

void add_edge(std::span<const glm::dvec3> positions, std::span<const MeshSide> sides, MeshElements& elements)
{
    const auto index = static_cast<uint32_t>(elements.edges.size());
    elements.edges.push_back({sides[0].a, sides[0].b, 1, index});
    if (!elements.triangles.empty())
        for (const MeshSide& side : sides)
            elements.triangles[side.triangle].edge[side.corner] = index;
    for (size_t i = 0; i < sides.size(); ++i)
        for (size_t j = i + 1; j < sides.size(); ++j)
        {
            if (sides[i].opposite == sides[j].opposite) // two triangles back to back
                continue;
            // One bend spring for three edges a vertex, where a grid has two directions: two thirds of its B / area.
            elements.opposites.push_back(
                {sides[i].opposite, sides[j].opposite, 2.0 / 3 / (sides[i].area + sides[j].area), index});
            elements.hinges.push_back(make_hinge(positions, sides[i], sides[j]));
            elements.hinges.back().edge = index;
        }
}

uint32_t soften_slivers(MeshElements& elements, std::span<const double> areas, bool uniform_masses)
{
    std::vector<uint32_t> edges;
    if (uniform_masses)
        soften_stiffest(elements.hinges, std::vector<double>(areas.size(), 1.0), k_bending_ahead, edges);
    else
    {
        soften_stiffest(elements.triangles, areas, k_ahead, edges);
        soften_stiffest(elements.opposites, areas, k_bending_ahead, edges);
        soften_stiffest(elements.hinges, areas, k_bending_ahead, edges);
    }
    std::sort(edges.begin(), edges.end());
    return static_cast<uint32_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

} // namespace voile
