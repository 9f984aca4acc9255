// Triangulates, cleans, computes normals and joins vertices.
#include "assets/mesh_builder.hpp"

#include "voile/engine/assets/normals.hpp"
#include "voile/engine/assets/triangulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_set>

namespace voile::engine
{

namespace
{

using Triangle = std::array<Corner, 3>;

const glm::vec3& position_of(const Polygons& polygons, const Corner& corner)
{
    return polygons.positions[static_cast<size_t>(corner.position)];
}

void add_face(const Polygons& polygons, std::span<const Corner> face, std::vector<Triangle>& triangles)
{
    std::vector<glm::vec3> outline;
    outline.reserve(face.size());
    for (const Corner& corner : face)
        outline.push_back(position_of(polygons, corner));
    for (const glm::uvec3& t : triangulate(outline))
        triangles.push_back({face[t.x], face[t.y], face[t.z]});
}

std::vector<Triangle> cut_faces(const Polygons& polygons, MeshReport& report)
{
    std::vector<Triangle> triangles;
    triangles.reserve(polygons.corners.size() - 2 * polygons.face_sizes.size());
    std::span<const Corner> corners = polygons.corners;
    for (const uint32_t size : polygons.face_sizes)
    {
        if (size == 3)
            triangles.push_back({corners[0], corners[1], corners[2]});
        else
            add_face(polygons, corners.first(size), triangles);
        report.polygons_triangulated += size == 3 ? 0 : 1;
        corners = corners.subspan(size);
    }
    return triangles;
}

// For each position, the first one with the same coordinates: files repeat positions along seams.
std::vector<uint32_t> find_equal_positions(const std::vector<glm::vec3>& positions)
{
    const auto key = [&](uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<uint32_t> first(positions.size());
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

// A triangle is degenerate if floats cannot distinguish it from a line: its height over the longest edge is within the
// rounding of a coordinate as large as the mesh's largest. Any higher triangle is kept, however thin.
double least_height(const std::vector<glm::vec3>& positions)
{
    float largest = 0;
    for (const glm::vec3& p : positions)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return std::ldexp(double{largest}, -22);
}

bool is_degenerate(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double least_height)
{
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    return glm::length(glm::cross(b - a, c - a)) <= least_height * longest;
}

struct HashIndices
{
    size_t operator()(const std::array<uint32_t, 3>& i) const
    {
        return static_cast<size_t>(
            ((i[0] * 0x9E3779B97F4A7C15u + i[1]) * 0x9E3779B97F4A7C15u + i[2]) * 0x9E3779B97F4A7C15u >> 20);
    }
};

// Drops triangles without area, and triangles on the same three points as an earlier one, in either winding: two faces
// back to back are useless for collision and flicker when drawn.
void clean(const Polygons& polygons, std::vector<Triangle>& triangles, MeshReport& report)
{
    const double least = least_height(polygons.positions);
    const std::vector<uint32_t> first = find_equal_positions(polygons.positions);
    std::unordered_set<std::array<uint32_t, 3>, HashIndices> seen(triangles.size());
    const auto is_dropped = [&](const Triangle& t)
    {
        if (is_degenerate(position_of(polygons, t[0]), position_of(polygons, t[1]), position_of(polygons, t[2]), least))
        {
            ++report.degenerate_triangles;
            return true;
        }
        std::array<uint32_t, 3> points{};
        for (size_t i = 0; i < 3; ++i)
            points[i] = first[static_cast<size_t>(t[i].position)];
        std::sort(points.begin(), points.end());
        const bool is_new = seen.insert(points).second;
        report.duplicate_triangles += is_new ? 0 : 1;
        return !is_new;
    };
    std::erase_if(triangles, is_dropped);
}

// One normal per position.
std::vector<glm::vec3> compute_normals(const Polygons& polygons, const std::vector<Triangle>& triangles)
{
    std::vector<glm::uvec3> indices;
    indices.reserve(triangles.size());
    for (const Triangle& t : triangles)
        indices.emplace_back(t[0].position, t[1].position, t[2].position);
    std::vector<glm::dvec3> sums;
    sum_normals(polygons.positions, indices, sums);
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums)
        normals.push_back(unit_normal(sum));
    return normals;
}

// Uses the file's normals if every corner has one of nonzero length.
void settle_normals(Polygons& polygons, std::vector<Triangle>& triangles, MeshReport& report)
{
    const auto length = [](const glm::vec3& v) { return glm::length(glm::dvec3(v)); }; // the square may overflow a
                                                                                       // float
    const auto has_normal = [&](const Corner& c)
    { return c.normal >= 0 && length(polygons.normals[static_cast<size_t>(c.normal)]) > 1e-6; };
    report.normals_computed =
        !std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return std::all_of(t.begin(), t.end(), has_normal); });
    if (report.normals_computed)
    {
        polygons.normals = compute_normals(polygons, triangles);
        for (Triangle& t : triangles)
            for (Corner& corner : t)
                corner.normal = corner.position;
    }
    else
        for (glm::vec3& normal : polygons.normals)
            normal = glm::dvec3(normal) / std::max(length(normal), 1e-6);
}

Mesh assemble(const Polygons& polygons, const std::vector<Triangle>& triangles)
{
    std::vector<Corner> vertices; // each combination once
    vertices.reserve(3 * triangles.size());
    for (const Triangle& t : triangles)
        vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    Mesh mesh;
    for (const Corner& vertex : vertices)
    {
        const int32_t texture = vertex.texture_coordinate;
        mesh.positions.push_back(position_of(polygons, vertex));
        mesh.normals.push_back(polygons.normals[static_cast<size_t>(vertex.normal)]);
        mesh.texture_coordinates.push_back(texture < 0 ? glm::vec2(0.f)
                                                       : polygons.texture_coordinates[static_cast<size_t>(texture)]);
    }
    const auto index_of = [&](const Corner& corner)
    {
        const auto found = std::lower_bound(vertices.begin(), vertices.end(), corner);
        return static_cast<uint32_t>(found - vertices.begin());
    };
    for (const Triangle& t : triangles)
        mesh.triangles.emplace_back(index_of(t[0]), index_of(t[1]), index_of(t[2]));
    return mesh;
}

TextureMap texture_map(const Polygons& polygons, const std::vector<Triangle>& triangles)
{
    TextureMap map;
    for (const Triangle& t : triangles)
    {
        if (std::any_of(t.begin(), t.end(), [](const Corner& corner) { return corner.texture_coordinate < 0; }))
            return {};
        map.triangles.emplace_back(t[0].texture_coordinate, t[1].texture_coordinate, t[2].texture_coordinate);
    }
    map.coordinates = polygons.texture_coordinates;
    return map;
}

Mesh assemble_positions(const Polygons& polygons, const std::vector<Triangle>& triangles)
{
    Mesh mesh;
    mesh.positions = polygons.positions;
    mesh.normals = polygons.normals; // computed: one per position
    mesh.texture_coordinates.resize(polygons.positions.size(), glm::vec2(0.f));
    std::vector<bool> placed(polygons.positions.size());
    for (const Triangle& t : triangles)
        for (const Corner& corner : t)
        {
            const auto position = static_cast<size_t>(corner.position);
            if (corner.texture_coordinate < 0 || placed[position])
                continue;
            placed[position] = true;
            mesh.texture_coordinates[position] =
                polygons.texture_coordinates[static_cast<size_t>(corner.texture_coordinate)];
        }
    for (const Triangle& t : triangles)
        mesh.triangles.emplace_back(t[0].position, t[1].position, t[2].position);
    mesh.texture_map = texture_map(polygons, triangles);
    return mesh;
}

Mesh assemble_faces(Polygons polygons)
{
    Mesh mesh;
    const Corner* face = polygons.corners.data();
    for (const uint32_t size : polygons.face_sizes)
    {
        for (uint32_t i = 2; i < size; ++i)
            mesh.triangles.emplace_back(face[0].position, face[i - 1].position, face[i].position);
        face += size;
    }
    mesh.positions = std::move(polygons.positions);
    return mesh;
}

} // namespace

Result<Mesh> build_mesh(Polygons polygons, const std::string& name, MeshReport* report, MeshVertices vertices)
{
    if (vertices == MeshVertices::faces)
        return assemble_faces(std::move(polygons));
    MeshReport changes;
    std::vector<Triangle> triangles = cut_faces(polygons, changes);
    const size_t count = triangles.size();
    clean(polygons, triangles, changes);
    if (triangles.empty())
        return Error{name + ": no triangles left, all " + std::to_string(count) + " are degenerate"};
    if (vertices == MeshVertices::positions)
    {
        for (Triangle& t : triangles)
            for (Corner& corner : t)
                corner.normal = -1;
    }
    settle_normals(polygons, triangles, changes);
    if (report != nullptr)
        *report = changes;
    return vertices == MeshVertices::positions ? assemble_positions(polygons, triangles)
                                               : assemble(polygons, triangles);
}

} // namespace voile::engine
