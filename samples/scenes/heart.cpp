// The two hearts as maps of a sphere, and the ground.
#include "heart.hpp"

#include "even_mesh.hpp"

#include <cmath>

namespace scenes
{

namespace
{

// The reference heart's box, in meters.
constexpr glm::dvec3 k_box_min{3.385, 1.507, 5.958};
constexpr glm::dvec3 k_box_max{6.615, 4.534, 8.042};

// The reference heart is an ellipsoid whose columns along y are pushed up, the farther out the more. A cleft is pressed
// into the top, and the depth swells with the height. The constants are fitted to the scene's widths and depths. At the
// end the mesh is stretched by a few hundredths to fill the box.
constexpr double k_half_width = 1.615;
constexpr double k_half_height = 1.6283;
constexpr double k_half_depth = 1.042;
constexpr double k_rise = 0.2312;       // slope of the columns' push, far from the middle
constexpr double k_rounding = 0.4805;   // half-width over which the push is rounded in the middle
constexpr double k_upward_bow = 0.0787; // the quadratic part of the push
constexpr double k_cleft = 0.8916;      // depth pressed into the top
constexpr double k_cleft_width = 0.7237;
constexpr double k_swell = 0.2471; // growth of the depth with height
constexpr double k_swell_square = 0.5096;
constexpr double k_middle = 1.4599; // height around which the depth swells, from the ellipsoid's bottom, minus its half

double push(double x)
{
    return k_rise * (std::hypot(x, k_rounding) - k_rounding) + k_upward_bow * x * x;
}

double cleft(double x)
{
    return k_cleft * std::exp(-x * x / (k_cleft_width * k_cleft_width));
}

double swell(double y)
{
    const double t = (y + k_half_height) / k_middle - 1.; // -1 at the bottom, about 1 at the top
    return 1. + k_swell * t + k_swell_square * t * t;
}

// The cleft has no effect at the bottom (s = -1) and its full effect at the top (s = 1).
double height_of(double x, double s)
{
    return push(x) + k_half_height * s - cleft(x) * 0.25 * (1. + s) * (1. + s);
}

// The inverse of height_of in s, by Newton's method: it grows with s, and its curvature is small.
double column_of(double x, double y)
{
    double s = (y - push(x)) / k_half_height;
    for (int i = 0; i < 8; ++i)
        s -= (height_of(x, s) - y) / (k_half_height - cleft(x) * 0.5 * (1. + s));
    return s;
}

glm::dvec3 reference_from_sphere(const glm::dvec3& s)
{
    const double x = k_half_width * s.x;
    const double y = height_of(x, s.y);
    return {x, y, k_half_depth * s.z * swell(y)};
}

glm::dvec3 reference_from_space(const glm::dvec3& p)
{
    const glm::dvec3 s(p.x / k_half_width, column_of(p.x, p.y), p.z / (k_half_depth * swell(p.y)));
    return reference_from_sphere(glm::normalize(s));
}

void stretch_to_box(voile::engine::Mesh& mesh, const glm::dvec3& min, const glm::dvec3& max)
{
    const voile::engine::Bounds box = voile::engine::bounds(mesh);
    const glm::dvec3 from = box.min;
    const glm::dvec3 size = glm::dvec3(box.max) - from;
    for (glm::vec3& p : mesh.positions)
        p = glm::clamp(min + (glm::dvec3(p) - from) / size * (max - min), min, max);
}

// Along the unit vector u the cube root of the drape heart's equation is q r^2 - c r^(5/3) - 1 = 0, which has one
// positive root: the heart is star-shaped around the origin.
glm::dvec3 drape_from_space(const glm::dvec3& p)
{
    const glm::dvec3 u = glm::normalize(p);
    const double q = u.x * u.x + u.y * u.y + 9. / 4. * u.z * u.z;
    const double c = std::cbrt((u.x * u.x + 9. / 80. * u.z * u.z) * u.y * u.y * u.y);
    double inside = 0.;
    double outside = 2.;
    for (int i = 0; i < 60; ++i)
    {
        const double r = 0.5 * (inside + outside);
        const bool is_inside = q * r * r - c * std::pow(r, 5. / 3.) < 1.;
        (is_inside ? inside : outside) = r;
    }
    return 0.5 * (inside + outside) * u;
}

} // namespace

voile::engine::Mesh make_reference_heart()
{
    voile::engine::Mesh mesh = make_even_mesh({reference_from_sphere, reference_from_space});
    stretch_to_box(mesh, k_box_min, k_box_max);
    return mesh;
}

voile::engine::Mesh make_drape_heart()
{
    voile::engine::Mesh mesh = make_even_mesh({drape_from_space, drape_from_space});
    for (glm::vec3& p : mesh.positions)
        p *= 0.6f;
    return mesh;
}

voile::engine::Mesh make_ground()
{
    constexpr uint32_t k_side = 50; // vertices
    constexpr double k_size = 100.; // meters
    constexpr double k_center = 5.08;
    voile::engine::Mesh mesh;
    const auto coordinate = [](uint32_t i)
    { return static_cast<float>(k_center + k_size * (static_cast<double>(i) / (k_side - 1) - 0.5)); };
    for (uint32_t row = 0; row < k_side; ++row)
        for (uint32_t column = 0; column < k_side; ++column)
            mesh.positions.emplace_back(coordinate(column), 0.f, coordinate(row));
    for (uint32_t row = 0; row + 1 < k_side; ++row)
        for (uint32_t column = 0; column + 1 < k_side; ++column)
        {
            const uint32_t i = row * k_side + column;
            mesh.triangles.emplace_back(i, i + k_side, i + 1);
            mesh.triangles.emplace_back(i + 1, i + k_side, i + k_side + 1);
        }
    return mesh;
}

} // namespace scenes
