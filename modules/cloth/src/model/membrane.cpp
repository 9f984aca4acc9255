// Triangles at rest, springs from a fabric, and the stability bound of both.
#include "model/membrane.hpp"

#include "geometry/parallel.hpp"
#include "model/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace voile
{

namespace
{

// Of the coordinates' triangle: below it rounding decides where the fabric runs.
constexpr double k_least_area = 1e-6;              // times the longest side squared
constexpr size_t k_membrane_piece = 8192;          // triangles per piece of work
constexpr size_t k_least_membrane_vertices = 2048; // vertices per thread

// The direction in the triangle along which the first coordinate alone grows; 0 where the coordinates have no area.
glm::dvec3 growing(const glm::dvec3 (&x)[3], std::span<const glm::vec2> coordinates, const glm::uvec3& t)
{
    const glm::dvec2 at(coordinates[t.x]);
    const glm::dvec2 b = glm::dvec2(coordinates[t.y]) - at;
    const glm::dvec2 c = glm::dvec2(coordinates[t.z]) - at;
    const double area = b.x * c.y - b.y * c.x;
    if (std::abs(area) <= k_least_area * std::max(glm::dot(b, b), glm::dot(c, c)))
        return glm::dvec3(0);
    return ((x[1] - x[0]) * c.y - (x[2] - x[0]) * b.y) / area;
}

glm::dvec3 warp_of(const glm::dvec3 (&x)[3], const glm::uvec3& t, const FabricCoordinates& fabric)
{
    if (!fabric.texture.empty())
        if (const glm::dvec3 warp = growing(x, fabric.texture, t); warp != glm::dvec3(0))
            return glm::normalize(warp);
    if (const glm::dvec3 warp = growing(x, fabric.projected, t); warp != glm::dvec3(0))
        return glm::normalize(warp);
    const glm::dvec3 normal = glm::normalize(glm::cross(x[1] - x[0], x[2] - x[0]));
    return glm::normalize(fabric.view - glm::dot(fabric.view, normal) * normal); // it is seen from the side
}

glm::uvec3 from_largest_angle(std::span<const glm::dvec3> x, const glm::uvec3& t)
{
    int first = 0;
    double longest = 0;
    for (int i = 0; i < 3; ++i)
        if (const double opposite = glm::distance(x[t[(i + 1) % 3]], x[t[(i + 2) % 3]]); opposite > longest)
        {
            longest = opposite;
            first = i;
        }
    return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

// Of a corner's barycentric coordinate, 1/m.
glm::dvec2 gradient(const MembraneTriangle& triangle, size_t corner)
{
    const glm::dvec2 opposite = triangle.position[(corner + 2) % 3] - triangle.position[(corner + 1) % 3];
    return glm::dvec2(-opposite.y, opposite.x) / (2 * triangle.area);
}

} // namespace

MembraneTriangle make_membrane_triangle(std::span<const glm::dvec3> positions, const glm::uvec3& given,
                                        const FabricCoordinates& fabric)
{
    // From the corner with the largest angle, between the two shorter edges, whose differences are rounded least.
    const glm::uvec3 corners = from_largest_angle(positions, given);
    const glm::dvec3 x[] = {positions[corners.x], positions[corners.y], positions[corners.z]};
    const glm::dvec3 across = glm::cross(x[1] - x[0], x[2] - x[0]);
    const glm::dvec3 warp = warp_of(x, corners, fabric);
    const glm::dvec3 weft = glm::cross(glm::normalize(across), warp);
    MembraneTriangle triangle{};
    triangle.area = triangle.weight = 0.5 * glm::length(across);
    for (int i = 0; i < 3; ++i)
    {
        triangle.corner[i] = corners[i];
        triangle.position[i] = {glm::dot(x[i] - x[0], warp), glm::dot(x[i] - x[0], weft)};
    }
    return triangle;
}

shared::MembraneCorner make_membrane_corner(const MembraneTriangle& triangle, uint32_t vertex)
{
    const uint32_t corner = vertex == triangle.corner[0] ? 0 : vertex == triangle.corner[1] ? 1 : 2;
    return {glm::vec2(gradient(triangle, 1)), glm::vec2(gradient(triangle, 2)), static_cast<float>(triangle.weight),
            corner};
}

MembraneSprings make_membrane_springs(const Fabric& fabric, double spacing)
{
    // A square cell of area a^2 has a spring of length a each way and two diagonals of sqrt(2) a.
    const auto a = static_cast<float>(spacing);
    const SpringSet springs = make_material(fabric, a, a).springs;
    return {springs.structural_warp, springs.structural_weft, {2 * springs.shear.stiffness, 2 * springs.shear.damping}};
}

// The energy of a spring along d is at most its tangent plus 1/2 stiffness |F' d|^2 in any shape, so a triangle is at
// most as stiff as weight * g_i . M g_j between its corners i and j along each axis, with g their gradients and M the
// sum of stiffness * d d^T. Triangles share corners: a triangle is assigned as much of a vertex's mass as it
// has of the stiffness there. Then the fastest mode of the whole is at most that of the fastest triangle alone (the
// element eigenvalue theorem, Irons and Treharne 1971).
std::vector<double> membrane_rates(std::span<const MembraneTriangle> triangles, std::span<const double> areas,
                                   std::span<const MembraneConstants> constants)
{
    std::vector<glm::dvec2> along; // per kind of constants, the sum of those along warp and along weft
    for (const MembraneConstants& c : constants)
        along.emplace_back(c.warp + c.diagonal, c.weft + c.diagonal);
    const auto stiffness = [](const glm::dvec2& m, const MembraneTriangle& t, const glm::dvec2& g)
    { return t.weight * (m.x * g.x * g.x + m.y * g.y * g.y); };
    const size_t kinds = constants.size();
    std::vector<double> sums(areas.size() * kinds);
    // Each thread goes through all triangles and owns a range of vertices.
    parallel_for(areas.size(), piece_per_thread(areas.size(), k_least_membrane_vertices),
                 [&](size_t begin, size_t end)
                 {
                     for (const MembraneTriangle& t : triangles)
                         for (size_t i = 0; i < 3; ++i)
                             if (begin <= t.corner[i] && t.corner[i] < end)
                             {
                                 const glm::dvec2 g = gradient(t, i);
                                 for (size_t kind = 0; kind < kinds; ++kind)
                                     sums[t.corner[i] * kinds + kind] += stiffness(along[kind], t, g);
                             }
                 });
    const auto largest_of = [&](std::span<const MembraneTriangle> some)
    {
        std::vector<double> largest(kinds);
        for (const MembraneTriangle& t : some)
        {
            const std::array g{gradient(t, 0), gradient(t, 1), gradient(t, 2)};
            for (size_t kind = 0; kind < kinds; ++kind)
            {
                const glm::dvec2& m = along[kind];
                glm::dmat2 mobility(0); // sum of g g^T over mass
                for (size_t i = 0; i < 3; ++i)
                    if (const double own = stiffness(m, t, g[i]); own > 0)
                        mobility += glm::outerProduct(g[i], g[i]) *
                                    (sums[t.corner[i] * kinds + kind] / (own * areas[t.corner[i]]));
                const double xx = m.x * mobility[0].x;
                const double yy = m.y * mobility[1].y;
                constexpr double k_rounding = 1 + 1e-9;
                if (t.weight * (xx + yy) * k_rounding < largest[kind]) // no eigenvalue is above the trace
                    continue;
                largest[kind] = std::max(largest[kind],
                                         t.weight * largest_eigenvalue(xx, std::sqrt(m.x * m.y) * mobility[0].y, yy));
            }
        }
        return largest;
    };
    std::vector<std::vector<double>> pieces((triangles.size() + k_membrane_piece - 1) / k_membrane_piece);
    parallel_for(triangles.size(), k_membrane_piece,
                 [&](size_t begin, size_t end)
                 { pieces[begin / k_membrane_piece] = largest_of(triangles.subspan(begin, end - begin)); });
    std::vector<double> largest(kinds);
    for (const std::vector<double>& piece : pieces)
        for (size_t kind = 0; kind < kinds; ++kind)
            largest[kind] = std::max(largest[kind], piece[kind]);
    return largest;
}

} // namespace voile
