// Coulomb friction around a drum: T2 / T1 = exp(mu phi) for a sliding strap and at the onset of sliding.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"
#include "support/hard_shapes.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace physics
{

namespace
{

constexpr double k_friction = 0.3;
constexpr double k_radius = 0.1; // m, of the drum's corners
constexpr double k_thickness = 0.002;
constexpr double k_around = k_radius + k_thickness; // m, radius of the strap's vertices
constexpr double k_stretch = 4000;                  // N/m
constexpr double k_density = 0.05;                  // kg/m^2: the part on the drum weighs 0.4 % of the lighter weight
constexpr double k_light = 4;                       // kg per meter of width
constexpr uint32_t k_straight = 8;                  // hanging links on either side

const char* const k_remark =
    "A strap starts in the shape and with the tensions of its equilibrium or motion, so that its weights do not "
    "bounce. One strap has weights of 1 : 4 and slides. Its ratio of tensions follows from the stretch of the four "
    "links next to each weight, averaged over 0.1 s, and independently of the stretch from the acceleration a of the "
    "weights: m2 (g - a) / m1 (g + a). Nine others have weights of 1 : 2.40 to 1 : 2.72 in steps of 0.04 (coarse: "
    "three, 1 : 2.52 to 1 : 2.60). The ratio "
    "that begins to slip is the middle between the last that stays and the next, so it is known to 0.8 %. Strap and "
    "drum have corners: n links on the half circle give (1 + mu tan(d/2)) / (1 - mu tan(d/2)) per vertex with d = π / "
    "n, in total 0.15 % more at 24 links and 0.04 % at 48. The vertices lie on the flats of the drum, whose normals "
    "deviate by up to π / segments from the circle's: 1.4° at 128 segments. This averages out over a path of one "
    "segment and shows as jolts in the stretch. The thickness moves the strap outward and has no other effect. The "
    "part of a strap on the drum weighs 0.4 % of the lighter weight. The drum's triangles are 0.4 m long and 5 or 1.2 "
    "mm wide, like the cylinders of modeling programs.";

// A strap one link wide over the upper half of the drum, a weight at each end, stretched by its tensions.
struct Strap
{
    uint32_t links = 0; // on the drum
    double weights = 1; // heavy : light
    double link = 0;    // m, unstretched
    double across = 0;  // m along z
    voile::ClothId id{};

    [[nodiscard]] uint32_t all_links() const { return links + 2 * k_straight; }
    [[nodiscard]] double heavy() const { return weights * k_light; }
    // m/s^2 of the heavy weight, downward.
    [[nodiscard]] double acceleration() const
    {
        const double ratio = std::exp(k_friction * std::numbers::pi);
        return std::max(0.0, k_gravity * (heavy() - k_light * ratio) / (heavy() + k_light * ratio));
    }
};

// At rest and in motion: from the light weight's tension to the heavy one's by equal factors.
std::vector<double> tensions(const Strap& strap)
{
    const double first = k_light * (k_gravity + strap.acceleration());
    const double last = strap.heavy() * (k_gravity - strap.acceleration());
    std::vector<double> result;
    for (uint32_t i = 0; i < strap.all_links(); ++i)
    {
        const double on = std::clamp(static_cast<double>(i) - k_straight + 0.5, 0.0, static_cast<double>(strap.links));
        result.push_back(first * std::pow(last / first, on / strap.links));
    }
    return result;
}

double angle_of(double chord)
{
    return 2 * std::asin(chord / (2 * k_around));
}

// The link length with which the stretched strap's vertices fit on half the circle.
double fitting_link(const Strap& strap)
{
    const std::vector<double> tension = tensions(strap);
    double link = std::numbers::pi * k_around / strap.links;
    for (int i = 0; i < 30; ++i)
    {
        double angle = 0;
        for (uint32_t j = 0; j < strap.links; ++j)
            angle += angle_of(link * (1 + tension[k_straight + j] / k_stretch));
        link *= std::numbers::pi / angle;
    }
    return link;
}

// Along the strap from the light weight at the +x side, first one edge and then the other.
std::vector<glm::dvec3> stretched(const Strap& strap)
{
    const std::vector<double> tension = tensions(strap);
    std::vector<glm::dvec2> line{{k_around, 0}};
    for (uint32_t i = k_straight; i-- > 0;)
        line.insert(line.begin(), line.front() - glm::dvec2(0, strap.link * (1 + tension[i] / k_stretch)));
    double angle = 0;
    for (uint32_t i = k_straight; i < strap.all_links(); ++i)
    {
        const double length = strap.link * (1 + tension[i] / k_stretch);
        if (i >= k_straight + strap.links)
        {
            line.push_back(line.back() - glm::dvec2(0, length));
            continue;
        }
        angle += angle_of(length);
        line.emplace_back(k_around * std::cos(angle), k_around * std::sin(angle));
    }
    std::vector<glm::dvec3> result;
    for (const double side : {-0.5, 0.5})
        for (const glm::dvec2& p : line)
            result.emplace_back(p, strap.across + side * strap.link);
    return result;
}

void add(Rig& rig, Strap& strap)
{
    strap.link = fitting_link(strap);
    voile::Fabric fabric = plain_fabric(k_stretch);
    fabric.areal_density = static_cast<float>(k_density);
    fabric.thickness = static_cast<float>(k_thickness);
    fabric.static_friction = fabric.kinetic_friction = static_cast<float>(k_friction);
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = strap.all_links() + 1;
    grid.rows = 2;
    grid.width = static_cast<float>(strap.link * strap.all_links());
    grid.depth = static_cast<float>(strap.link);
    grid.material = fabric;
    grid.inverse_masses.assign(size_t{2} * grid.columns, static_cast<float>(2 / (k_density * strap.link * strap.link)));
    for (const size_t first : {size_t{0}, size_t{grid.columns}})
    {
        grid.inverse_masses[first] = static_cast<float>(2 / (k_light * strap.link));
        grid.inverse_masses[first + strap.all_links()] = static_cast<float>(2 / (strap.heavy() * strap.link));
    }
    strap.id = voile::engine::take(rig.solver.add_cloth(grid));
}

// Observations of a strap from `before` to `after`, with the stretch summed over samples in between.
struct Watch
{
    double light_stretch = 0; // of the four links next to the light weight, m
    double heavy_stretch = 0;
    double start = 0; // m, height of the heavy weight
    double end = 0;
    double start_speed = 0; // m/s upward
    double end_speed = 0;
};

void sample(Rig& rig, const Strap& strap, Watch& watch)
{
    const auto x = rig.positions(strap.id);
    const size_t last = strap.all_links();
    watch.light_stretch += glm::distance(x[0], x[4]) - 4 * strap.link;
    watch.heavy_stretch += glm::distance(x[last], x[last - 4]) - 4 * strap.link;
    watch.end = x[last].y;
    watch.end_speed = rig.velocities(strap.id)[last].y;
}

constexpr float k_sample = 0.01f; // s
constexpr uint32_t k_samples = 10;

std::vector<Watch> watch(Rig& rig, const std::vector<Strap>& straps)
{
    const voile::Step step{.duration = k_sample, .max_substeps = 100000};
    rig.step(step, 2); // disturbances at the start from rounding and the drum's corners
    std::vector<Watch> result(straps.size());
    for (size_t i = 0; i < straps.size(); ++i)
    {
        sample(rig, straps[i], result[i]);
        result[i] = {.start = result[i].end, .start_speed = result[i].end_speed};
    }
    for (uint32_t k = 0; k < k_samples; ++k)
    {
        rig.step(step);
        for (size_t i = 0; i < straps.size(); ++i)
            sample(rig, straps[i], result[i]);
    }
    return result;
}

// One strap that slides, and one for each of these ratios of weights.
constexpr double k_sliding = 4;
constexpr double k_interval = 0.04;

uint32_t links_on_drum(Detail detail)
{
    return detail == Detail::fine ? 48 : 24;
}

std::vector<Strap> straps_side_by_side(Detail detail)
{
    constexpr double k_apart = 0.03; // m
    // Three suffice for the target of 2 %: a ratio that meets it lies between the first and the last.
    const double lowest = detail == Detail::fine ? 2.40 : 2.52;
    const uint32_t ratios = detail == Detail::fine ? 9 : 3;
    const uint32_t links = links_on_drum(detail);
    std::vector<Strap> result{{.links = links, .weights = k_sliding}};
    for (uint32_t i = 0; i < ratios; ++i)
        result.push_back({.links = links, .weights = lowest + k_interval * i, .across = k_apart * (i + 1)});
    return result;
}

// The ratio from which straps slip: the middle between one that stays and the next.
double slipping_ratio(const std::vector<Strap>& straps, const std::vector<Watch>& seen)
{
    for (size_t i = 1; i < straps.size(); ++i)
        if (seen[i].start - seen[i].end > 1e-4)
            return i == 1 ? 0 : straps[i].weights - 0.5 * k_interval;
    return 0;
}

struct Ratios
{
    double tension = 0;
    double acceleration = 0;
    double slipping = 0;
};

Ratios ratios(Detail detail, uint32_t segments)
{
    Rig rig;
    std::vector<Strap> straps = straps_side_by_side(detail);
    for (Strap& strap : straps)
        add(rig, strap);
    const voile::engine::Mesh mesh = tests::closed_cylinder(k_radius, -0.05, straps.back().across + 0.05, segments);
    (void)voile::engine::take(
        rig.solver.add_collider(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
    rig.upload();
    for (const Strap& strap : straps)
        rig.set_positions(strap.id, stretched(strap));
    const std::vector<Watch> seen = watch(rig, straps);
    const Watch& sliding = seen.front();
    const double a = (sliding.start_speed - sliding.end_speed) / (k_samples * static_cast<double>(k_sample));
    return {sliding.heavy_stretch / sliding.light_stretch, k_sliding * (k_gravity - a) / (k_gravity + a),
            slipping_ratio(straps, seen)};
}

} // namespace

CaseResult strap(Detail detail)
{
    CaseResult result;
    const double exact = std::exp(k_friction * std::numbers::pi);
    for (const uint32_t segments : {128u, 512u})
    {
        const Ratios found = ratios(detail, segments);
        const std::string of = ", drum of " + std::to_string(segments);
        const std::string size = std::to_string(links_on_drum(detail)) + " links";
        result.measurements.push_back({"T2 / T1 from the stretch, sliding" + of, size, found.tension, exact, 0.02});
        result.measurements.push_back({"T2 / T1 from the acceleration, sliding" + of, size, found.acceleration, exact,
                                       Target{0.015, 0.008}.at(detail)});
        result.measurements.push_back({"ratio of weights that begins to slip" + of, size, found.slipping, exact, 0.02});
    }
    result.remark = k_remark;
    return result;
}

} // namespace physics
