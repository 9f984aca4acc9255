// From triangles to springs and bending stencils.
#include "model/mesh_topology.hpp"

#include "geometry/closedness.hpp"
#include "model/mesh_elements.hpp"
#include "model/mesh_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace voile
{

namespace
{

// A triangle is degenerate if its height is 0 within the precision of float.
bool degenerate(std::span<const glm::dvec3> x, const glm::uvec3& t)
{
    const double longest =
        std::max({glm::distance(x[t.x], x[t.y]), glm::distance(x[t.y], x[t.z]), glm::distance(x[t.z], x[t.x])});
    return triangle_area(x, t) <= 1e-6 * longest * longest;
}

// `fabric`: of the membrane; none: springs along the edges.
MeshElements elements_of(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                         const FabricCoordinates* fabric, MeshReport& report)
{
    const std::vector<MeshSide> sides = sides_of(positions, triangles);
    MeshElements elements;
    const size_t pairs_of_sides = sides.size() / 2; // as many edges and folds as a closed surface has, or so
    elements.edges.reserve(pairs_of_sides + pairs_of_sides / 16);
    elements.opposites.reserve(pairs_of_sides);
    elements.hinges.reserve(pairs_of_sides);
    if (fabric)
    {
        elements.triangles.reserve(triangles.size());
        for (const glm::uvec3& t : triangles)
            elements.triangles.push_back(make_membrane_triangle(positions, t, *fabric));
    }
    for (size_t first = 0; first < sides.size();)
    {
        size_t last = first + 1;
        while (last < sides.size() && sides[last].key() == sides[first].key())
            ++last;
        const double length = glm::distance(positions[sides[first].a], positions[sides[first].b]);
        add_edge(positions, std::span(sides).subspan(first, last - first), elements);
        report.boundary_edges += last - first == 1 ? 1 : 0;
        report.non_manifold_edges += last - first > 2 ? 1 : 0;
        report.shortest_edge = std::min(report.shortest_edge, static_cast<float>(length));
        first = last;
    }
    return elements;
}

uint32_t count_components(size_t vertices, std::span<const glm::uvec3> triangles)
{
    std::vector<uint32_t> parent(vertices);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t i)
    {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<bool> used(vertices);
    for (const glm::uvec3& t : triangles)
    {
        parent[root(t.y)] = root(t.x);
        parent[root(t.z)] = root(t.x);
        used[t.x] = used[t.y] = used[t.z] = true;
    }
    uint32_t components = 0;
    for (uint32_t i = 0; i < vertices; ++i)
        components += used[i] && root(i) == i ? 1 : 0;
    return components;
}

// The entries of a pair at the list of either end: one, or two where an edge's ends are opposite to another edge as
// well.
uint32_t entries_of(const PairSums& pair)
{
    return pair.edge > 0 && pair.opposite > 0 ? 2 : 1;
}

void add_entries(const PairSums& pair, uint32_t other, float rest_length, shared::MeshSpring* entry)
{
    if (pair.edge > 0)
        *entry++ = {other, rest_length, static_cast<float>(pair.edge), static_cast<float>(pair.bending)};
    if (pair.opposite > 0 || pair.edge == 0)
        *entry = {other | VOILE_OPPOSITE_BIT, rest_length, static_cast<float>(pair.opposite),
                  pair.edge > 0 ? 0 : static_cast<float>(pair.bending)};
}

using Vertices = std::vector<shared::MeshVertex>;

// Counts lists to where they begin. Returns that of each vertex, to be counted on while lists are filled; the last one
// is the length of all.
std::vector<uint32_t> set_first(Vertices& vertices, uint32_t shared::MeshVertex::*first,
                                uint32_t shared::MeshVertex::*count)
{
    std::vector<uint32_t> next;
    next.reserve(vertices.size() + 1);
    uint32_t all = 0;
    for (shared::MeshVertex& vertex : vertices)
    {
        next.push_back(vertex.*first = all);
        all += vertex.*count;
    }
    next.push_back(all);
    return next;
}

// A vertex has its lower neighbors first.
std::vector<shared::MeshSpring> fill_springs(Vertices& vertices, std::span<const glm::dvec3> positions,
                                             const MeshPairs& pairs)
{
    const auto visit = [&](auto&& each)
    {
        for (uint32_t a = 0; a < positions.size(); ++a)
            for (uint32_t i = pairs.first[a]; i < pairs.first[a + 1]; ++i)
                each(a, pairs.others[i], pairs.sums[i]);
    };
    visit(
        [&](uint32_t a, uint32_t b, const PairSums& pair)
        {
            vertices[a].springs += entries_of(pair);
            vertices[b].springs += entries_of(pair);
        });
    std::vector<uint32_t> next = set_first(vertices, &shared::MeshVertex::first_spring, &shared::MeshVertex::springs);
    std::vector<shared::MeshSpring> springs(next.back());
    const auto put = [&](uint32_t vertex, uint32_t other, const PairSums& pair, float length)
    {
        add_entries(pair, other, length, &springs[next[vertex]]);
        next[vertex] += entries_of(pair);
    };
    const auto length_of = [&](uint32_t a, uint32_t b)
    { return static_cast<float>(glm::distance(positions[a], positions[b])); };
    visit([&](uint32_t a, uint32_t b, const PairSums& pair) { put(b, a, pair, length_of(a, b)); });
    visit([&](uint32_t a, uint32_t b, const PairSums& pair) { put(a, b, pair, length_of(a, b)); });
    return springs;
}

struct Corners
{
    std::vector<shared::MeshCorner> corners;
    std::vector<shared::MembraneCorner> membrane; // one for each; zeros where there is none
};

Corners fill_corners(Vertices& vertices, std::span<const glm::uvec3> triangles,
                     std::span<const MembraneTriangle> membrane)
{
    for (const glm::uvec3& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            ++vertices[t[corner]].corners;
    std::vector<uint32_t> next = set_first(vertices, &shared::MeshVertex::first_corner, &shared::MeshVertex::corners);
    Corners result{std::vector<shared::MeshCorner>(next.back()), std::vector<shared::MembraneCorner>(next.back())};
    for (size_t i = 0; i < triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
        {
            const glm::uvec3& t = triangles[i];
            const uint32_t entry = next[t[corner]]++;
            result.corners[entry] = {t[(corner + 1) % 3], t[(corner + 2) % 3]};
            if (!membrane.empty())
                result.membrane[entry] = make_membrane_corner(membrane[i], t[corner]);
        }
    return result;
}

std::vector<double> areas_of(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles)
{
    std::vector<double> areas(positions.size());
    for (const glm::uvec3& t : triangles)
    {
        const double third = triangle_area(positions, t) / 3;
        for (int corner = 0; corner < 3; ++corner)
            areas[t[corner]] += third;
    }
    return areas;
}

uint32_t count_coincident(std::span<const glm::dvec3> positions, std::span<const double> areas)
{
    std::vector<glm::vec3> offsets; // from one vertex: far from the origin neighbors would be equal as floats
    offsets.reserve(positions.size());
    for (const glm::dvec3& x : positions)
        offsets.emplace_back(x - positions.front());
    const std::vector<uint32_t> welded = weld(offsets);
    uint32_t count = 0;
    for (uint32_t i = 0; i < welded.size(); ++i)
        count += welded[i] != i && areas[i] > 0 ? 1 : 0;
    return count;
}

// Bounds for every shape that the mesh can take (see grid_rates). Springs share their ends: a spring is
// assigned as much of a vertex's mass as it has of the stiffness there. Then the fastest mode of the whole is at most
// that of the fastest spring alone (the element eigenvalue theorem, Irons and Treharne 1971), stiffness over mass at
// one end plus the same at the other.
void find_bounds(MeshTopology& mesh)
{
    struct Sums // of a vertex
    {
        double opposite = 0;        // weights
        double uniform[2] = {0, 0}; // by kind: edges, opposite vertices
        double bending = 0;
    };
    std::vector<Sums> sums(mesh.lists.vertices.size());
    const auto visit_springs = [&](auto&& visit)
    {
        for (size_t i = 0; i < mesh.lists.vertices.size(); ++i)
            for (uint32_t s = 0; s < mesh.lists.vertices[i].springs; ++s)
            {
                const shared::MeshSpring& spring = mesh.lists.springs[mesh.lists.vertices[i].first_spring + s];
                const bool opposite = (spring.neighbor & VOILE_OPPOSITE_BIT) != 0;
                visit(i, spring.neighbor & ~VOILE_OPPOSITE_BIT, opposite ? VOILE_CLASS_OPPOSITE : VOILE_CLASS_EDGE,
                      spring);
            }
    };
    visit_springs(
        [&](size_t i, uint32_t, int kind, const shared::MeshSpring& spring)
        {
            sums[i].opposite += kind == VOILE_CLASS_OPPOSITE ? static_cast<double>(spring.weight) : 0;
            sums[i].uniform[kind] += spring.weight > 0 ? 1 : 0;
            sums[i].bending += std::abs(static_cast<double>(spring.bending));
        });
    double* const uniform[] = {&mesh.uniform.edge, &mesh.uniform.opposite};
    const auto raise = [](double& bound, double value) { bound = std::max(bound, value); };
    visit_springs(
        [&](size_t i, uint32_t j, int kind, const shared::MeshSpring& spring)
        {
            if (spring.weight > 0)
                raise(*uniform[kind], sums[i].uniform[kind] + sums[j].uniform[kind]);
            if (spring.weight > 0 && kind == VOILE_CLASS_OPPOSITE)
                raise(mesh.fabric.opposite, sums[i].opposite / mesh.areas[i] + sums[j].opposite / mesh.areas[j]);
        });
    for (size_t i = 0; i < mesh.lists.vertices.size(); ++i)
        if (mesh.areas[i] > 0)
        {
            raise(mesh.fabric.bending, 2 * sums[i].bending / mesh.areas[i]);
            raise(mesh.uniform.bending, 2 * sums[i].bending);
        }
}

} // namespace

MeshTopology make_mesh_topology(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                                const FabricCoordinates& fabric, bool isometric, bool uniform_masses)
{
    std::vector<glm::uvec3> solid;
    solid.reserve(triangles.size());
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(solid),
                 [&](const glm::uvec3& t) { return !degenerate(positions, t); });
    MeshTopology mesh;
    mesh.isometric = isometric;
    mesh.uniform_masses = uniform_masses;
    mesh.report.degenerate_triangles = static_cast<uint32_t>(triangles.size() - solid.size());
    mesh.report.components = count_components(positions.size(), solid);
    mesh.report.shortest_edge = std::numeric_limits<float>::max();
    mesh.areas = areas_of(positions, solid);
    for (const double area : mesh.areas)
    {
        mesh.report.isolated_vertices += area > 0 ? 0 : 1;
        mesh.mean_area += area;
    }
    mesh.mean_area /= static_cast<double>(std::max<size_t>(positions.size() - mesh.report.isolated_vertices, 1));
    mesh.report.coincident_vertices = count_coincident(positions, mesh.areas);

    MeshElements elements = elements_of(positions, solid, uniform_masses ? nullptr : &fabric, mesh.report);
    mesh.report.softened_edges = soften_slivers(elements, mesh.areas, uniform_masses);
    Vertices vertices(positions.size());
    mesh.lists.springs =
        fill_springs(vertices, positions, make_pairs(elements, positions.size(), solid.size(), isometric));
    Corners corners = fill_corners(vertices, solid, elements.triangles);
    mesh.lists.corners = std::move(corners.corners);
    mesh.lists.membrane = std::move(corners.membrane);
    mesh.lists.vertices = std::move(vertices);
    mesh.membrane = std::move(elements.triangles);
    mesh.triangles = std::vector(triangles.begin(), triangles.end());
    const std::span<const glm::vec2> coordinates = fabric.texture.empty() ? fabric.projected : fabric.texture;
    mesh.texture_coordinates = std::vector(coordinates.begin(), coordinates.end());
    find_bounds(mesh);
    return mesh;
}

} // namespace voile
