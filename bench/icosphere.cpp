// Spheres of 20 * 4^n triangles, and the number of nodes that a query of their hierarchy visits.
#include "icosphere.hpp"

#include "geometry/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace bench
{

namespace
{

// On the unit sphere.
voile::engine::Mesh make_icosahedron()
{
    constexpr float k_golden = std::numbers::phi_v<float>;
    voile::engine::Mesh mesh;
    for (const float a : {-1.f, 1.f})
        for (const float b : {-k_golden, k_golden})
        {
            mesh.positions.push_back(glm::normalize(glm::vec3(0, a, b)));
            mesh.positions.push_back(glm::normalize(glm::vec3(a, b, 0)));
            mesh.positions.push_back(glm::normalize(glm::vec3(b, 0, a)));
        }
    // The faces are the triples of vertices whose distances equal the edge length.
    const float edge = 2 / glm::length(glm::vec3(0, 1, k_golden));
    const auto joined = [&](uint32_t i, uint32_t j)
    { return std::abs(glm::distance(mesh.positions[i], mesh.positions[j]) - edge) < 1e-3f; };
    for (uint32_t i = 0; i < 12; ++i)
        for (uint32_t j = i + 1; j < 12; ++j)
            for (uint32_t k = j + 1; k < 12; ++k)
            {
                if (!joined(i, j) || !joined(j, k) || !joined(k, i))
                    continue;
                const glm::vec3 normal =
                    glm::cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
                const bool outward = glm::dot(normal, mesh.positions[i]) > 0;
                mesh.triangles.emplace_back(i, outward ? j : k, outward ? k : j);
            }
    return mesh;
}

void subdivide(voile::engine::Mesh& mesh)
{
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t i, uint32_t j)
    {
        const auto [entry, added] =
            middles.try_emplace(std::minmax(i, j), static_cast<uint32_t>(mesh.positions.size()));
        if (added)
            mesh.positions.push_back(glm::normalize(mesh.positions[i] + mesh.positions[j]));
        return entry->second;
    };
    std::vector<glm::uvec3> triangles;
    triangles.reserve(4 * mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::uvec3 m(middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x));
        triangles.emplace_back(t.x, m.x, m.z);
        triangles.emplace_back(m.x, t.y, m.y);
        triangles.emplace_back(m.z, m.y, t.z);
        triangles.push_back(m);
    }
    mesh.triangles = std::move(triangles);
}

bool overlap(const glm::vec3& a_min, const glm::vec3& a_max, const glm::vec3& b_min, const glm::vec3& b_max)
{
    return glm::all(glm::lessThanEqual(a_min, b_max)) && glm::all(glm::lessThanEqual(b_min, a_max));
}

} // namespace

voile::engine::Mesh make_icosphere(const glm::vec3& center, float radius, uint32_t subdivisions)
{
    voile::engine::Mesh mesh = make_icosahedron();
    for (uint32_t i = 0; i < subdivisions; ++i)
        subdivide(mesh);
    for (glm::vec3& p : mesh.positions)
        p = center + radius * p;
    return mesh;
}

double node_visits(const voile::engine::Mesh& mesh, std::span<const glm::vec4> positions, float radius)
{
    const voile::Bvh bvh = voile::build_bvh(mesh.positions, mesh.triangles);
    uint64_t visits = 0;
    std::vector<uint32_t> stack;
    for (const glm::vec4& p : positions)
    {
        const glm::vec3 min = glm::vec3(p) - radius;
        const glm::vec3 max = glm::vec3(p) + radius;
        stack.assign(1, 0);
        while (!stack.empty())
        {
            const voile::shared::BvhNode& node = bvh.nodes[stack.back()];
            stack.pop_back();
            ++visits;
            if (overlap(min, max, node.left_min, node.left_max) && (node.left & VOILE_BVH_LEAF_BIT) == 0)
                stack.push_back(node.left);
            if (overlap(min, max, node.right_min, node.right_max) && (node.right & VOILE_BVH_LEAF_BIT) == 0)
                stack.push_back(node.right);
        }
    }
    return static_cast<double>(visits) / static_cast<double>(positions.size());
}

} // namespace bench
