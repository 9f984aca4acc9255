// The frames of the fabric at the vertices of a mesh, and the links of meshes and grids.
#include "model/limit_graph.hpp"

#include "model/cloth_model.hpp"

#include "shared/grid_springs.h"

#include <array>
#include <cmath>
#include <numeric>

namespace voile
{

namespace
{

// Around a vertex of a mesh: the direction of the warp and of the surface.
struct Frame
{
    glm::dvec3 warp{1, 0, 0};
    glm::dvec3 weft{0, 0, 1};
    glm::dvec3 normal{0, 1, 0};

    [[nodiscard]] FabricOffset offset_of(const glm::dvec3& v) const { return {glm::dot(v, warp), glm::dot(v, weft)}; }
};

glm::dvec3 any_across(const glm::dvec3& n)
{
    const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(axis - glm::dot(axis, n) * n);
}

Frame make_frame(const glm::dvec3& normal, const glm::dvec3& warp)
{
    Frame frame;
    if (glm::dot(normal, normal) > 0)
        frame.normal = glm::normalize(normal);
    const glm::dvec3 along = warp - glm::dot(warp, frame.normal) * frame.normal;
    const bool has_direction = glm::dot(along, along) > 1e-6 * glm::dot(warp, warp) && glm::dot(warp, warp) > 0;
    frame.warp = has_direction ? glm::normalize(along) : any_across(frame.normal);
    frame.weft = glm::cross(frame.normal, frame.warp);
    return frame;
}

std::vector<Frame> mesh_frames(const MeshTopology& mesh, std::span<const glm::dvec3> x)
{
    std::vector<glm::dvec3> normals(x.size(), glm::dvec3(0));
    std::vector<glm::dvec3> warps(x.size(), glm::dvec3(0));
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            normals[t[corner]] += glm::cross(x[t.y] - x[t.x], x[t.z] - x[t.x]);
    for (const MembraneTriangle& t : mesh.membrane)
    {
        const glm::dvec3 b = x[t.corner[1]] - x[t.corner[0]];
        const glm::dvec3 c = x[t.corner[2]] - x[t.corner[0]];
        const glm::dvec2 to_b = t.position[1] - t.position[0];
        const glm::dvec2 to_c = t.position[2] - t.position[0];
        for (const uint32_t corner : t.corner) // the gradient of the first coordinate, times twice the area
            warps[corner] += b * to_c.y - c * to_b.y;
    }
    std::vector<Frame> frames;
    frames.reserve(x.size());
    for (size_t i = 0; i < x.size(); ++i)
        frames.push_back(make_frame(normals[i], warps[i]));
    return frames;
}

// Along an edge: as long as it is, however the surface bends over it.
LimitGraphLink edge_link(uint32_t to, const Frame& from_frame, const Frame& to_frame, const glm::dvec3& edge,
                         double length)
{
    LimitGraphLink link{to, from_frame.offset_of(edge), FabricOffset(1), length};
    link.offset = std::abs(link.offset) > 0 ? link.offset * (length / std::abs(link.offset)) : FabricOffset(length);
    // Turned with the normal about the axis across both.
    const glm::dvec3 across = glm::cross(to_frame.normal, from_frame.normal);
    const double cosine = glm::dot(to_frame.normal, from_frame.normal);
    const glm::dvec3& w = to_frame.warp;
    const glm::dvec3 turned =
        cosine > -0.99 ? cosine * w + glm::cross(across, w) + across * (glm::dot(across, w) / (1 + cosine)) : w;
    const FabricOffset turn = from_frame.offset_of(turned);
    link.turn = std::abs(turn) > 0 ? turn / std::abs(turn) : FabricOffset(1);
    return link;
}

LimitGraph mesh_graph(const ClothModel& cloth)
{
    const MeshTopology& mesh = *cloth.mesh;
    std::vector<glm::dvec3> x;
    x.reserve(cloth.start.size());
    for (const glm::vec4& p : cloth.start)
        x.emplace_back(glm::vec3(p));
    const std::vector<Frame> frames = mesh_frames(mesh, x);
    LimitGraph graph;
    for (uint32_t i = 0; i < x.size(); ++i)
    {
        graph.first.push_back(static_cast<uint32_t>(graph.links.size()));
        const shared::MeshVertex& list = mesh.lists.vertices[i];
        for (const shared::MeshSpring& spring : std::span(mesh.lists.springs.data() + list.first_spring, list.springs))
            if ((spring.neighbor & VOILE_OPPOSITE_BIT) == 0)
                graph.links.push_back(edge_link(spring.neighbor, frames[i], frames[spring.neighbor],
                                                x[spring.neighbor] - x[i], static_cast<double>(spring.rest_length)));
    }
    graph.first.push_back(static_cast<uint32_t>(graph.links.size()));
    return graph;
}

LimitGraph grid_graph(const ClothModel& cloth)
{
    const auto columns = static_cast<int>(cloth.record.columns);
    const auto rows = static_cast<int>(cloth.record.rows);
    using glm::ivec2;
    constexpr std::array<ivec2, VOILE_SPRING_CLASSES> k_offsets{VOILE_SPRING_OFFSETS};
    constexpr size_t k_classes = 4; // structural and shear springs
    LimitGraph graph;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
        {
            graph.first.push_back(static_cast<uint32_t>(graph.links.size()));
            for (size_t k = 0; k < 2 * k_classes; ++k)
            {
                const ivec2 step = (k < k_classes ? 1 : -1) * k_offsets[k % k_classes];
                const ivec2 to = ivec2(column, row) + step;
                if (to.x < 0 || to.y < 0 || to.x >= columns || to.y >= rows ||
                    cloth.record.springs[k % k_classes].stiffness == 0)
                    continue;
                const glm::dvec2 along = glm::dvec2(step) * glm::dvec2(cloth.spacing);
                const FabricOffset offset(along.x, along.y);
                graph.links.push_back({static_cast<uint32_t>(to.y * columns + to.x), offset, 1, std::abs(offset)});
            }
        }
    graph.first.push_back(static_cast<uint32_t>(graph.links.size()));
    return graph;
}

} // namespace

LimitGraph make_limit_graph(const ClothModel& cloth)
{
    LimitGraph graph = cloth.mesh ? mesh_graph(cloth) : grid_graph(cloth);
    graph.vertices.resize(cloth.record.vertices);
    std::iota(graph.vertices.begin(), graph.vertices.end(), 0u);
    graph.masses.reserve(cloth.start.size());
    for (const glm::vec4& start : cloth.start)
        graph.masses.push_back(start.w > 0 ? 1 / static_cast<double>(start.w) : 0);
    return graph;
}

} // namespace voile
