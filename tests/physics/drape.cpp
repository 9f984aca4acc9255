// Cusick's drape test: a disc of cloth of 30 cm is held between discs of 18 cm, and the rest hangs. The drape
// coefficient is the fraction of the overhang's area that its shadow from above still covers.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include "voile/fabrics.hpp"

#include <algorithm>
#include <numbers>

namespace physics
{

namespace
{

constexpr double k_support = 0.09; // m, radii
constexpr double k_cloth = 0.15;

struct Disc
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<uint32_t> pins;
};

// Rings of an equilateral lattice made round: ring n has 6 n evenly spaced vertices. The two innermost rings are
// pinned. Vertices farther inside would not move.
class DiscMaker
{
public:
    // `overhang` rings are free. The support's edge is midway between the two pinned rings, like a cantilever's clamp.
    explicit DiscMaker(uint32_t overhang)
    {
        const double spacing = (k_cloth - k_support) / (overhang + 0.5);
        const auto last_held = static_cast<uint32_t>(std::lround(k_support / spacing + 0.5));
        first_ring_ = last_held - 1;
        for (uint32_t n = first_ring_; n <= last_held + overhang; ++n)
            add_ring(n, k_support + spacing * (static_cast<double>(n) - last_held + 0.5));
        for (uint32_t i = 0; i < vertex(last_held + 1, 0); ++i)
            disc_.pins.push_back(i);
    }

    [[nodiscard]] const Disc& disc() const { return disc_; }

private:
    // Vertex k of a ring, modulo the ring's count.
    [[nodiscard]] uint32_t vertex(uint32_t ring, uint32_t k) const
    {
        return 3 * (ring * (ring - 1) - first_ring_ * (first_ring_ - 1)) + k % (6 * ring);
    }

    void add_ring(uint32_t n, double radius)
    {
        for (uint32_t k = 0; k < 6 * n; ++k)
        {
            const double angle = 2 * std::numbers::pi * k / (6.0 * n);
            disc_.positions.emplace_back(radius * std::sin(angle), 0, radius * std::cos(angle));
        }
        for (uint32_t sector = 0; n > first_ring_ && sector < 6; ++sector)
            for (uint32_t k = 0; k < n; ++k)
            {
                const uint32_t outer = sector * n + k;
                const uint32_t inner = sector * (n - 1) + k;
                disc_.triangles.emplace_back(vertex(n, outer), vertex(n, outer + 1), vertex(n - 1, inner));
                if (k + 1 < n)
                    disc_.triangles.emplace_back(vertex(n, outer + 1), vertex(n - 1, inner + 1), vertex(n - 1, inner));
            }
    }

    Disc disc_;
    uint32_t first_ring_ = 0;
};

constexpr size_t k_rays = 720;

// The extent of the shadow from the axis in each of `k_rays` directions: its outermost edge.
std::vector<double> outline(const Disc& disc, const std::vector<glm::dvec3>& x)
{
    std::vector<double> radii(k_rays, k_support);
    for (const glm::uvec3& t : disc.triangles)
        for (int side = 0; side < 3; ++side)
        {
            const glm::dvec2 a(x[t[side]].x, x[t[side]].z);
            const glm::dvec2 b(x[t[(side + 1) % 3]].x, x[t[(side + 1) % 3]].z);
            if (std::min(glm::length(a), glm::length(b)) < 0.5 * k_support)
                continue;
            const double step = 2 * std::numbers::pi / k_rays;
            const double from = std::atan2(a.y, a.x);
            const double turn = std::remainder(std::atan2(b.y, b.x) - from, 2 * std::numbers::pi);
            const double low = std::min(from, from + turn);
            const double high = std::max(from, from + turn);
            for (auto ray = static_cast<long>(std::ceil(low / step)); static_cast<double>(ray) * step <= high; ++ray)
            {
                const double angle = static_cast<double>(ray) * step;
                const glm::dvec2 d(std::cos(angle), std::sin(angle));
                const double across = d.x * (b.y - a.y) - d.y * (b.x - a.x);
                if (std::abs(across) < 1e-12)
                    continue;
                double& radius = radii[static_cast<size_t>(ray + 2 * static_cast<long>(k_rays)) % k_rays];
                radius = std::max(radius, (a.x * b.y - a.y * b.x) / across);
            }
        }
    return radii;
}

double coefficient(const std::vector<double>& radii)
{
    double squares = 0;
    for (const double r : radii)
        squares += r * r / static_cast<double>(k_rays);
    return (squares - k_support * k_support) / (k_cloth * k_cloth - k_support * k_support);
}

// The number of waves of the outline: how often it crosses its mean outward.
uint32_t waves(const std::vector<double>& radii)
{
    double mean = 0;
    for (const double r : radii)
        mean += r / static_cast<double>(k_rays);
    uint32_t count = 0;
    for (size_t i = 0; i < k_rays; ++i)
        count += radii[i] < mean && radii[(i + 1) % k_rays] >= mean ? 1 : 0;
    return count;
}

// The start: the edge is raised in waves of several counts. A flat disc has no preferred folds.
std::vector<glm::dvec3> slightly_waved(const Disc& disc)
{
    std::vector<glm::dvec3> x(disc.positions.begin(), disc.positions.end());
    for (size_t i = disc.pins.size(); i < x.size(); ++i)
    {
        const double out = (glm::length(x[i]) - k_support) / (k_cloth - k_support);
        const double angle = std::atan2(x[i].z, x[i].x);
        x[i].y = 1e-3 * out * out *
                 (std::cos(4 * angle + 1) + std::cos(5 * angle) + std::sin(6 * angle + 2) + std::sin(7 * angle));
    }
    return x;
}

std::vector<double> draped(const voile::Fabric& fabric, uint32_t overhang)
{
    const Disc disc = DiscMaker(overhang).disc();
    voile::MeshCloth mesh;
    mesh.positions = disc.positions;
    mesh.triangles = disc.triangles;
    mesh.pins = disc.pins;
    mesh.integrator = voile::Integrator::verlet;
    mesh.material = fabric;
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(mesh));
    rig.upload();
    rig.set_positions(id, slightly_waved(disc));
    rig.settle(id, {.duration = 0.01f}, 300, overhang < 10 ? 1e-5 : 1e-7);
    return outline(disc, rig.positions(id));
}

// Measured values of the preset's fabric, or of others of its class. fabrics.cpp names the sources.
struct Reference
{
    const char* fabric;
    double measured;      // %, of the fabric with the preset's density and bending; 0: none
    double low;           // %, of a class of fabrics; 0: none
    double high;          // %
    double target;        // of `measured`, relative, with the report's rings
    double coarse_target; // with four rings
};
constexpr Reference k_references[] = {{"silk", 0, 20, 40, 0, 0},
                                      {"cotton", 82.9, 0, 0, 0.04, 0.2},
                                      {"wool", 49.8, 0, 0, 0.25, 0.3},
                                      {"denim", 0, 0, 0, 0, 0},
                                      {"leather", 0, 47.35, 69.9, 0, 0}};

Curve closed_curve(const char* name, const std::vector<double>& radii)
{
    Curve curve{name, {}, {}, false};
    for (size_t i = 0; i <= k_rays; ++i)
    {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / k_rays;
        curve.x.push_back(radii[i % k_rays] * std::cos(angle));
        curve.y.push_back(radii[i % k_rays] * std::sin(angle));
    }
    return curve;
}

} // namespace

namespace
{

Measurement measurement(const Reference& reference, const std::vector<double>& radii, uint32_t overhang, double target)
{
    Measurement m;
    m.quantity = std::string(reference.fabric) + ", drape coefficient, % (" + std::to_string(waves(radii)) + " waves)";
    m.resolution = std::to_string(overhang) + " free rings";
    m.value = 100 * coefficient(radii);
    m.exact = reference.measured;
    m.target = target;
    m.low = reference.low;
    m.high = reference.high;
    m.known = m.exact > 0 || m.band();
    return m;
}

enum class Fabrics
{
    all,
    with_reference, // with a measured value or a band, by the targets of four rings
};

CaseResult drape_with(uint32_t overhang, Fabrics fabrics)
{
    CaseResult result;
    Plot plot{"drape", "Cusick drape from above", "x, m", "z, m", {}, false, true};
    plot.curves.push_back(closed_curve("support", std::vector<double>(k_rays, k_support)));
    for (const Reference& reference : k_references)
    {
        if (fabrics == Fabrics::with_reference && reference.measured == 0 && reference.high == 0)
            continue;
        const auto radii = draped(*voile::find_fabric(reference.fabric), overhang);
        result.measurements.push_back(measurement(
            reference, radii, overhang, fabrics == Fabrics::all ? reference.target : reference.coarse_target));
        plot.curves.push_back(closed_curve(reference.fabric, radii));
    }
    result.plots.push_back(plot);
    return result;
}

} // namespace

CaseResult drape(Detail detail)
{
    CaseResult result = drape_with(detail == Detail::fine ? 12 : 10, Fabrics::all);
    for (Measurement& m : result.measurements)
        m.change = 3;
    result.remark =
        "Cotton and wool are compared with the drape coefficient measured on the fabric that their density and bending "
        "come from: cotton broad and wool tropical of Matsudaira et al. 2015 (Journal of Textile Engineering 61(6), "
        "69-73, table 2, as transcribed in public). Their waves are not compared: 2 were counted on that cotton and 5 "
        "on that wool, whose bending differs between warp and weft. Here all presets start from the same 4 to 7. "
        "Silk's band is a range quoted for woven silks (Matsudaira and Yang 2003). Leather's is that of four sheep "
        "leathers (Memon et al. 2021), and its bending was chosen to fit it. No coefficient was found for a washed 11 "
        "oz denim. The mesh is a ring lattice with edges across warp and weft in most places. Strain is uniform in a "
        "triangle. If shear varies within a fold, a mesh of large triangles is too stiff, the more the stiffer stretch "
        "is relative to shear. Silk shows this most of the presets: its stretch is 80 times as stiff.";
    return result;
}

CaseResult coarse_drape()
{
    return drape_with(4, Fabrics::with_reference);
}

} // namespace physics
