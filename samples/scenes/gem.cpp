// An icosahedron with its faces split in four, and its soft counterpart.
#include "gem.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace scenes
{

namespace
{

constexpr float k_corner = 0.4f;   // m, from the origin
constexpr float k_between = 0.36f; // m

using Face = std::array<glm::vec3, 3>; // unit vectors

std::array<Face, 20> icosahedron()
{
    const float g = 0.5f * (1 + std::sqrt(5.f)); // the golden ratio
    const std::array<glm::vec3, 12> corners{{{-1, g, 0},
                                             {1, g, 0},
                                             {-1, -g, 0},
                                             {1, -g, 0},
                                             {0, -1, g},
                                             {0, 1, g},
                                             {0, -1, -g},
                                             {0, 1, -g},
                                             {g, 0, -1},
                                             {g, 0, 1},
                                             {-g, 0, -1},
                                             {-g, 0, 1}}};
    constexpr std::array<std::array<size_t, 3>, 20> k_faces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    std::array<Face, 20> faces;
    for (size_t f = 0; f < faces.size(); ++f)
        for (size_t i = 0; i < 3; ++i)
            faces[f][i] = glm::normalize(corners[k_faces[f][i]]);
    return faces;
}

void add_face(voile::engine::Mesh& mesh, const Face& face)
{
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), face.begin(), face.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
}

} // namespace

voile::engine::Mesh make_gem()
{
    voile::engine::Mesh mesh;
    for (const Face& face : icosahedron())
    {
        Face between;
        for (size_t i = 0; i < 3; ++i)
            between[i] = k_between * glm::normalize(face[i] + face[(i + 1) % 3]);
        for (size_t i = 0; i < 3; ++i)
            add_face(mesh, {k_corner * face[i], between[i], between[(i + 2) % 3]});
        add_face(mesh, between);
    }
    return mesh;
}

voile::engine::Mesh make_jelly(double seconds)
{
    const double around = 2 * std::numbers::pi * seconds;
    const auto height = static_cast<float>(0.83 + 0.17 * std::cos(around / 1.6)); // fraction of the gem's
    const auto sway = static_cast<float>(0.35 * std::sin(around / 2.5));          // 1/m
    voile::engine::Mesh mesh = make_gem();
    for (glm::vec3& p : mesh.positions)
    {
        const float y = height * (p.y + k_corner);
        p = {p.x / std::sqrt(height) + sway * y * y, y, p.z / std::sqrt(height)};
    }
    return mesh;
}

} // namespace scenes
