// Paths of vertices against spheres, capsules and boxes: no path crosses a solid, at any speed and angle, however thin
// it is, and no path that misses it is stopped. A double-precision query decides.
#include "reference/swept_reference.hpp"
#include "support/cloth_harness.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace
{

using tests::ClothHarness;

constexpr uint32_t k_side = 32; // of the cloth, in vertices
constexpr float k_step = 1.f / 600;

// A solid, and the targets of paths: points within `spread` of the segment between two points.
struct Solid
{
    std::string name;
    voile::Collider collider;
    glm::vec3 from;
    glm::vec3 to;
    glm::vec3 spread;
};

reference::SignedDistance distance_of(const voile::Collider& collider)
{
    if (const auto* sphere = std::get_if<voile::SphereCollider>(&collider))
        return [=](const glm::dvec3& p)
        { return reference::sphere_distance(glm::dvec3(sphere->center), static_cast<double>(sphere->radius), p); };
    if (const auto* capsule = std::get_if<voile::CapsuleCollider>(&collider))
        return [=](const glm::dvec3& p)
        {
            return reference::capsule_distance(glm::dvec3(capsule->from), glm::dvec3(capsule->to),
                                               static_cast<double>(capsule->radius), p);
        };
    const auto& box = std::get<voile::BoxCollider>(collider);
    return [=](const glm::dvec3& p) { return reference::box_distance(glm::dvec3(box.min), glm::dvec3(box.max), p); };
}

Solid plate(const std::string& name, float thickness)
{
    const glm::vec3 half(0.5f, 0.5f * thickness, 0.4f);
    return {name, voile::BoxCollider{.min = -half, .max = half}, glm::vec3(0), glm::vec3(0), half};
}

Solid capsule(const std::string& name, float radius)
{
    const voile::CapsuleCollider result{.from = {-0.3f, 0.1f, 0}, .to = {0.3f, -0.1f, 0.2f}, .radius = radius};
    return {name, result, result.from, result.to, glm::vec3(radius)};
}

Solid sphere(const std::string& name, float radius)
{
    return {name, voile::SphereCollider{.radius = radius}, glm::vec3(0), glm::vec3(0), glm::vec3(radius)};
}

// A path through the target, at an angle to one of the planes along two axes. It starts before the target, by a
// fraction of its displacement in the substep.
struct Shot
{
    glm::vec3 from;
    glm::vec3 velocity; // m/s
};

class Shots
{
public:
    Shots(const Solid& solid, uint32_t seed) : solid_(solid), random_(seed) {}

    Shot next()
    {
        std::uniform_real_distribution<float> unit(0, 1);
        const glm::vec3 aside = 2.f * glm::vec3(unit(random_), unit(random_), unit(random_)) - 1.f;
        const glm::vec3 target = glm::mix(solid_.from, solid_.to, unit(random_)) + aside * solid_.spread;
        const float speed = std::pow(10.f, 3 * unit(random_)); // 1 to 1000 m/s
        const float angle = std::pow(10.f, -3 * unit(random_)) * (unit(random_) < 0.5f ? 1.5f : -1.5f);
        const float around = 6.2831853f * unit(random_);
        const auto axis = static_cast<int>(random_() % 3);
        glm::vec3 direction(0);
        direction[axis] = std::sin(angle);
        direction[(axis + 1) % 3] = std::cos(angle) * std::cos(around);
        direction[(axis + 2) % 3] = std::cos(angle) * std::sin(around);
        return {target - unit(random_) * speed * k_step * direction, speed * direction};
    }

private:
    const Solid& solid_;
    std::mt19937 random_;
};

// Counts of outcomes.
struct Count
{
    uint32_t entering = 0;
    uint32_t clear = 0;
    uint32_t crossed = 0; // of paths that enter: on another side at the end
    uint32_t under = 0;   // of paths that enter: nearer to the surface than a substep may leave them
    uint32_t held = 0;    // of paths that miss: not at their destination
};

// Rounding of coordinates of about two meters, some ten of them.
constexpr double k_rounding = 2e-6;
// The nearest surface counts if it is on the side where the path entered: a cosine.
constexpr double k_same_side = 0.49;
constexpr double k_depenetration_speed = 0.75; // m/s
// On a needle of 1 mm a rounding of the position rotates the plane by 2e-4, and the path ends some 0.2 m farther.
constexpr double k_direction = 0.98;

// Judges a path in the solid's space and the position at which contact leaves the vertex.
void judge(const reference::SignedDistance& distance, double thickness, const glm::dvec3& from, const glm::dvec3& to,
           const glm::dvec3& x, Count& count)
{
    const double start = distance(from);
    if (start < 10 * k_rounding)
        return;
    const reference::Sweep path = reference::sweep(distance, from, to);
    if (path.deepest < -k_rounding)
    {
        ++count.entering;
        const double least = std::min({thickness, start, k_depenetration_speed * static_cast<double>(k_step)});
        count.under += distance(x) < k_direction * least - k_rounding;
        const auto normal = [&](const glm::dvec3& p) { return reference::normal_at(distance, p, k_rounding); };
        const bool same_side = glm::dot(normal(x), normal(from + path.entry * (to - from))) > k_same_side;
        count.crossed += !same_side && reference::sweep(distance, from, x).deepest < -k_rounding;
    }
    else if (path.deepest > k_rounding && distance(to) > thickness + k_rounding)
    {
        ++count.clear;
        count.held += glm::distance(x, to) > k_rounding;
    }
}

glm::dvec3 transformed(const glm::dmat4& matrix, const glm::dvec3& p)
{
    return glm::dvec3(matrix * glm::dvec4(p, 1));
}

struct Path
{
    glm::mat4 from{1.f}; // poses of the solids in the substep
    glm::mat4 to{1.f};
};

// All solids at the same position, each with one cloth per thickness on its own layer.
class Range
{
public:
    Range(std::span<const Solid> solids, std::span<const float> thicknesses)
    {
        for (uint32_t i = 0; i < solids.size(); ++i)
        {
            voile::Collider collider = solids[i].collider;
            std::visit([&](auto& description) { description.layers = 1u << i; }, collider);
            colliders_.push_back(voile::engine::take(harness_.solver.add_collider(collider)));
            for (const float thickness : thicknesses)
            {
                voile::GridCloth grid{.columns = k_side, .rows = k_side};
                voile::Material material; // no springs: vertices are independent
                material.thickness = thickness;
                grid.material = material;
                grid.layers = 1u << i;
                lanes_.push_back({solids[i], thickness, voile::engine::take(harness_.solver.add_cloth(grid)), {}, {}});
            }
        }
        harness_.upload();
    }

    // One substep in which the solids move along the path.
    void shoot(const Path& path)
    {
        step(path.from);
        for (Lane& lane : lanes_)
            set_paths(lane, path);
        step(path.to);
    }

    // The outcomes: one entry per solid and thickness.
    [[nodiscard]] std::vector<Count> results(const Path& path)
    {
        const glm::dmat4 back = glm::inverse(glm::dmat4(path.to));
        std::vector<Count> counts;
        for (const Lane& lane : lanes_)
        {
            const reference::SignedDistance distance = distance_of(lane.solid.collider);
            const auto x = harness_.positions(lane.cloth);
            Count& count = counts.emplace_back();
            for (size_t i = 0; i < x.size(); ++i)
                judge(distance, static_cast<double>(lane.thickness), lane.start[i], lane.end[i],
                      transformed(back, glm::dvec3(x[i])), count);
        }
        return counts;
    }

private:
    struct Lane
    {
        const Solid& solid;
        float thickness;
        voile::ClothId cloth;
        std::vector<glm::dvec3> start; // of the paths, in the solid's space
        std::vector<glm::dvec3> end;
    };

    void step(const glm::mat4& pose)
    {
        for (const voile::ColliderId collider : colliders_)
            REQUIRE(harness_.solver.move_collider(collider, pose));
        harness_.step({.duration = k_step, .substeps = 1, .gravity = glm::vec3(0), .air_density = 0});
    }

    // Sets the paths. They are straight in the solid's space, as contact treats them.
    void set_paths(Lane& lane, const Path& path)
    {
        std::vector<glm::vec4> x = harness_.positions(lane.cloth);
        std::vector<glm::vec4> v(x.size());
        Shots shots(lane.solid, 5);
        lane.start.clear();
        lane.end.clear();
        const glm::dmat4 back_from = glm::inverse(glm::dmat4(path.from));
        const glm::dmat4 back_to = glm::inverse(glm::dmat4(path.to));
        for (size_t i = 0; i < x.size(); ++i)
        {
            const Shot shot = shots.next();
            x[i] = glm::vec4(glm::vec3(path.from * glm::vec4(shot.from, 1)), x[i].w);
            const glm::vec3 end(path.to * glm::vec4(shot.from + k_step * shot.velocity, 1));
            v[i] = glm::vec4((end - glm::vec3(x[i])) / k_step, 0);
            const glm::dvec3 start(x[i]);
            lane.start.push_back(transformed(back_from, start));
            lane.end.push_back(transformed(back_to, start + static_cast<double>(k_step) * glm::dvec3(v[i])));
        }
        harness_.set_positions(lane.cloth, x);
        harness_.set_velocities(lane.cloth, v);
    }

    ClothHarness harness_{voile::SolverOptions{.feature_contact = false, .depenetration = false}};
    std::vector<voile::ColliderId> colliders_;
    std::vector<Lane> lanes_;
};

} // namespace

TEST_CASE("no path crosses an analytic solid, however fast, flat or thin, and no path that misses it is stopped")
{
    const Solid solids[] = {
        plate("plate of 0.1 mm", 1e-4f),  plate("plate of 2 mm", 2e-3f), plate("plate of 5 cm", 0.05f),
        plate("block of 1 m", 1),         sphere("ball of 1 mm", 1e-3f), sphere("ball of 30 cm", 0.3f),
        capsule("needle of 1 mm", 1e-3f), capsule("rod of 10 cm", 0.1f),
    };
    constexpr float k_thicknesses[] = {1e-3f, 5e-3f, 0.05f};
    const glm::mat4 there = glm::translate(glm::mat4(1.f), {0.3f, 0.1f, -0.2f});
    const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1.f), {0.1f, 0.4f, 0}), 0.7f, {0.6f, 0, 0.8f});
    Range range(solids, k_thicknesses);
    uint32_t clear = 0;
    for (const Path& path : {Path{}, Path{there, turned}})
    {
        range.shoot(path);
        const std::vector<Count> counts = range.results(path);
        for (size_t i = 0; i < counts.size(); ++i)
        {
            CAPTURE(solids[i / std::size(k_thicknesses)].name);
            CAPTURE(k_thicknesses[i % std::size(k_thicknesses)]);
            CHECK(counts[i].entering > 100);
            CHECK(counts[i].crossed == 0);
            CHECK(counts[i].under == 0);
            CHECK(counts[i].held == 0);
            clear += counts[i].clear;
        }
    }
    CHECK(clear > 1000);
}
