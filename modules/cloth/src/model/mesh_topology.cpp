// From triangles to springs and bending stencils.
#include "model/mesh_topology.hpp"

#include "geometry/closedness.hpp"
#include "geometry/parallel.hpp"
#include "model/mesh_elements.hpp"
#include "model/mesh_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voile
{

namespace
{

constexpr size_t k_topology_piece = 8192; // triangles or vertices per piece of work
constexpr size_t k_least_owned = 2048;    // vertices per thread, where threads go through all triangles or pairs

SolidTriangles solid_triangles(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles)
{
    SolidTriangles solid{std::vector(triangles.begin(), triangles.end()), std::vector<double>(triangles.size())};
    parallel_for(triangles.size(), k_topology_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t i = begin; i < end; ++i)
                         solid.areas[i] = solid_area(positions, triangles[i]);
                 });
    size_t kept = 0;
    for (size_t i = 0; i < triangles.size(); ++i)
        if (solid.areas[i] > 0)
        {
            solid.corners[kept] = triangles[i];
            solid.areas[kept++] = solid.areas[i];
        }
    solid.corners.resize(kept);
    solid.areas.resize(kept);
    return solid;
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

// Counts lists to where they begin. Returns the length of all.
uint32_t set_first(Vertices& vertices, uint32_t shared::MeshVertex::*first, uint32_t shared::MeshVertex::*count)
{
    uint32_t all = 0;
    for (shared::MeshVertex& vertex : vertices)
    {
        vertex.*first = all;
        all += vertex.*count;
    }
    return all;
}

// A vertex has its lower neighbors first. `pieces`: those of threads, which fill the lists of the vertices that they
// begin with: they find lower neighbors in the pieces up to their own.
UninitializedArray<shared::MeshSpring> fill_springs(Vertices& vertices, std::span<const glm::dvec3> positions,
                                                    std::span<const MeshPairs> pieces)
{
    const auto visit = [](const MeshPairs& pairs, auto&& each)
    {
        for (uint32_t a = pairs.begin; a < pairs.end; ++a)
            for (uint32_t i = pairs.first[a - pairs.begin]; i < pairs.first[a - pairs.begin + 1]; ++i)
                each(a, pairs.others[i], pairs.sums[i]);
    };
    // Calls each(vertex, neighbor, pair) for the lists of a piece's vertices, in their order.
    const auto visit_lists = [&](size_t piece, auto&& each)
    {
        const MeshPairs& own = pieces[piece];
        for (const MeshPairs& pairs : pieces.first(piece + 1))
            visit(pairs,
                  [&](uint32_t a, uint32_t b, const PairSums& pair)
                  {
                      if (own.owns(b))
                          each(b, a, pair);
                  });
        visit(own, each);
    };
    const auto for_each_piece = [&](auto&& body)
    {
        parallel_for(pieces.size(), 1,
                     [&](size_t begin, size_t end)
                     {
                         for (size_t piece = begin; piece < end; ++piece)
                             body(piece);
                     });
    };
    for_each_piece(
        [&](size_t piece)
        {
            visit_lists(piece, [&](uint32_t vertex, uint32_t, const PairSums& pair)
                        { vertices[vertex].springs += entries_of(pair); });
        });
    UninitializedArray<shared::MeshSpring> springs(
        set_first(vertices, &shared::MeshVertex::first_spring, &shared::MeshVertex::springs));
    for_each_piece(
        [&](size_t piece)
        {
            std::vector<uint32_t> next;
            for (uint32_t i = pieces[piece].begin; i < pieces[piece].end; ++i)
                next.push_back(vertices[i].first_spring);
            visit_lists(piece,
                        [&](uint32_t vertex, uint32_t other, const PairSums& pair)
                        {
                            const double length = glm::distance(positions[vertex], positions[other]);
                            uint32_t& entry = next[vertex - pieces[piece].begin];
                            add_entries(pair, other, static_cast<float>(length), &springs[entry]);
                            entry += entries_of(pair);
                        });
        });
    return springs;
}

struct Corners
{
    UninitializedArray<shared::MeshCorner> corners;
    UninitializedArray<shared::MembraneCorner> membrane; // one for each; zeros where there is none
};

// Each thread goes through all triangles and owns a range of vertices.
Corners fill_corners(Vertices& vertices, std::span<const glm::uvec3> triangles,
                     std::span<const MembraneTriangle> membrane)
{
    for (const glm::uvec3& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            ++vertices[t[corner]].corners;
    const uint32_t all = set_first(vertices, &shared::MeshVertex::first_corner, &shared::MeshVertex::corners);
    Corners result{UninitializedArray<shared::MeshCorner>(all), UninitializedArray<shared::MembraneCorner>(all)};
    parallel_for(vertices.size(), piece_per_thread(vertices.size(), k_least_owned),
                 [&](size_t begin, size_t end)
                 {
                     std::vector<uint32_t> next;
                     for (size_t i = begin; i < end; ++i)
                         next.push_back(vertices[i].first_corner);
                     for (size_t i = 0; i < triangles.size(); ++i)
                         for (int corner = 0; corner < 3; ++corner)
                         {
                             const glm::uvec3& t = triangles[i];
                             const uint32_t vertex = t[corner];
                             if (vertex < begin || vertex >= end)
                                 continue;
                             const uint32_t entry = next[vertex - begin]++;
                             result.corners[entry] = {t[(corner + 1) % 3], t[(corner + 2) % 3]};
                             result.membrane[entry] = membrane.empty() ? shared::MembraneCorner{}
                                                                       : make_membrane_corner(membrane[i], vertex);
                         }
                 });
    return result;
}

std::vector<double> areas_of(size_t vertices, const SolidTriangles& triangles)
{
    std::vector<double> areas(vertices);
    for (size_t i = 0; i < triangles.corners.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            areas[triangles.corners[i][corner]] += triangles.areas[i] / 3;
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
    const std::span<const shared::MeshVertex> vertices = mesh.lists.vertices;
    const auto visit_springs = [&](size_t i, auto&& visit)
    {
        for (uint32_t s = 0; s < vertices[i].springs; ++s)
        {
            const shared::MeshSpring& spring = mesh.lists.springs[vertices[i].first_spring + s];
            const bool opposite = (spring.neighbor & VOILE_OPPOSITE_BIT) != 0;
            visit(spring.neighbor & ~VOILE_OPPOSITE_BIT, opposite ? VOILE_CLASS_OPPOSITE : VOILE_CLASS_EDGE, spring);
        }
    };
    std::vector<Sums> sums(vertices.size());
    parallel_for(vertices.size(), k_topology_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t i = begin; i < end; ++i)
                         visit_springs(i,
                                       [&, &own = sums[i]](uint32_t, int kind, const shared::MeshSpring& spring)
                                       {
                                           const auto weight = static_cast<double>(spring.weight);
                                           own.opposite += kind == VOILE_CLASS_OPPOSITE ? weight : 0;
                                           own.uniform[kind] += weight > 0 ? 1 : 0;
                                           own.bending += std::abs(static_cast<double>(spring.bending));
                                       });
                 });
    const auto raise = [](double& bound, double value) { bound = std::max(bound, value); };
    struct Bounds
    {
        MeshTopology::Bounds fabric;
        MeshTopology::Bounds uniform;
    };
    std::vector<Bounds> pieces((vertices.size() + k_topology_piece - 1) / k_topology_piece);
    parallel_for(vertices.size(), k_topology_piece,
                 [&](size_t begin, size_t end)
                 {
                     Bounds& bounds = pieces[begin / k_topology_piece];
                     double* const uniform[] = {&bounds.uniform.edge, &bounds.uniform.opposite};
                     for (size_t i = begin; i < end; ++i)
                     {
                         visit_springs(i,
                                       [&](uint32_t j, int kind, const shared::MeshSpring& spring)
                                       {
                                           if (spring.weight > 0)
                                               raise(*uniform[kind], sums[i].uniform[kind] + sums[j].uniform[kind]);
                                           if (spring.weight > 0 && kind == VOILE_CLASS_OPPOSITE)
                                               raise(bounds.fabric.opposite, sums[i].opposite / mesh.areas[i] +
                                                                                 sums[j].opposite / mesh.areas[j]);
                                       });
                         if (mesh.areas[i] > 0)
                         {
                             raise(bounds.fabric.bending, 2 * sums[i].bending / mesh.areas[i]);
                             raise(bounds.uniform.bending, 2 * sums[i].bending);
                         }
                     }
                 });
    for (const Bounds& bounds : pieces)
    {
        raise(mesh.fabric.opposite, bounds.fabric.opposite);
        raise(mesh.fabric.bending, bounds.fabric.bending);
        raise(mesh.uniform.edge, bounds.uniform.edge);
        raise(mesh.uniform.opposite, bounds.uniform.opposite);
        raise(mesh.uniform.bending, bounds.uniform.bending);
    }
}

} // namespace

double longest_side(std::span<const glm::dvec3> x, const glm::uvec3& t)
{
    return std::max({glm::distance(x[t.x], x[t.y]), glm::distance(x[t.y], x[t.z]), glm::distance(x[t.z], x[t.x])});
}

double solid_area(std::span<const glm::dvec3> x, const glm::uvec3& t, double least_side)
{
    const double area = 0.5 * glm::length(glm::cross(x[t.y] - x[t.x], x[t.z] - x[t.x]));
    const double longest = longest_side(x, t);
    return area <= 1e-6 * longest * std::max(longest, least_side) ? 0 : area;
}

MeshTopology make_mesh_topology(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                                const FabricCoordinates& fabric, bool isometric, bool uniform_masses)
{
    const SolidTriangles solid = solid_triangles(positions, triangles);
    MeshTopology mesh;
    mesh.isometric = isometric;
    mesh.uniform_masses = uniform_masses;
    mesh.report.degenerate_triangles = static_cast<uint32_t>(triangles.size() - solid.corners.size());
    mesh.report.components = count_components(positions.size(), solid.corners);
    mesh.areas = areas_of(positions.size(), solid);
    for (const double area : mesh.areas)
    {
        mesh.report.isolated_vertices += area > 0 ? 0 : 1;
        mesh.mean_area += area;
    }
    mesh.mean_area /= static_cast<double>(std::max<size_t>(positions.size() - mesh.report.isolated_vertices, 1));
    mesh.report.coincident_vertices = count_coincident(positions, mesh.areas);

    MeshElements elements = make_elements(positions, solid, uniform_masses ? nullptr : &fabric, mesh.report);
    mesh.report.softened_edges = soften_slivers(elements, solid, mesh.areas, uniform_masses);
    Vertices vertices(positions.size());
    mesh.lists.springs = fill_springs(vertices, positions, make_pairs(elements, positions, solid, isometric));
    Corners corners = fill_corners(vertices, solid.corners, elements.triangles);
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
