// The figure: its surface, its bones and its gait.
#include "figure.hpp"

#include "even_mesh.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scenes
{

namespace
{

using Matrix = glm::dmat4;
using glm::dvec3;

constexpr double k_pi = std::numbers::pi;

// Bones, each with the point that it turns about, at rest.
enum Bone : uint32_t
{
    pelvis,
    chest,
    head,
    left_arm, // +x
    left_forearm,
    right_arm,
    right_forearm,
    left_thigh,
    left_shin,
    left_foot,
    right_thigh,
    right_shin,
    right_foot,
    bone_count
};

constexpr dvec3 k_waist{0, 1.06, -0.01};
constexpr dvec3 k_neck{0, 1.46, -0.015};
constexpr dvec3 k_shoulder{0.165, 1.37, -0.015};
constexpr dvec3 k_elbow{0.25, 1.11, -0.02};
constexpr dvec3 k_wrist{0.30, 0.88, 0.03};
constexpr dvec3 k_hip{0.085, 0.92, 0};
constexpr dvec3 k_knee{0.095, 0.50, 0.012};
constexpr dvec3 k_ankle{0.1, 0.09, -0.015};

constexpr dvec3 mirrored(const dvec3& p)
{
    return {-p.x, p.y, p.z};
}

// A cone with round ends.
struct Limb
{
    Bone bone;
    dvec3 from;
    dvec3 to;
    double from_radius;
    double to_radius;
};

// The left half; limbs of the middle are their own mirror images.
constexpr std::array k_limbs{
    Limb{pelvis, {-0.07, 0.94, -0.015}, {0.07, 0.94, -0.015}, 0.105, 0.105},
    Limb{pelvis, {-0.045, 1.06, -0.008}, {0.045, 1.06, -0.008}, 0.088, 0.088},
    Limb{chest, {-0.05, 1.15, -0.008}, {0.05, 1.15, -0.008}, 0.086, 0.086},
    Limb{chest, {-0.07, 1.26, -0.006}, {0.07, 1.26, -0.006}, 0.094, 0.094},
    Limb{chest, {-0.13, 1.375, -0.02}, {0.13, 1.375, -0.02}, 0.055, 0.055},
    Limb{head, {0, 1.42, -0.015}, {0, 1.52, 0.005}, 0.05, 0.045},
    Limb{head, {0, 1.585, 0.02}, {0, 1.63, 0.01}, 0.078, 0.09},
    Limb{left_arm, k_shoulder, k_elbow, 0.047, 0.036},
    Limb{left_forearm, k_elbow, k_wrist, 0.035, 0.026},
    Limb{left_forearm, {0.303, 0.865, 0.033}, {0.312, 0.78, 0.05}, 0.03, 0.022},
    Limb{left_thigh, k_hip, k_knee, 0.088, 0.054},
    Limb{left_shin, k_knee, {0.098, 0.36, -0.012}, 0.052, 0.05},
    Limb{left_shin, {0.098, 0.36, -0.012}, k_ankle, 0.05, 0.036},
    Limb{left_foot, {0.1, 0.045, -0.035}, {0.11, 0.035, 0.12}, 0.042, 0.032},
};

constexpr Bone mirrored(Bone bone)
{
    constexpr uint32_t k_arm = right_arm - left_arm;
    constexpr uint32_t k_leg = right_thigh - left_thigh;
    if (bone >= left_thigh)
        return static_cast<Bone>(bone + k_leg);
    return bone >= left_arm ? static_cast<Bone>(bone + k_arm) : bone;
}

// The distance to a cone with round ends (Quilez, "Distance functions": round cone).
double distance_to(const Limb& limb, const dvec3& p)
{
    const dvec3 along = limb.to - limb.from;
    const double l2 = glm::dot(along, along);
    const double shrink = limb.from_radius - limb.to_radius;
    const double a2 = l2 - shrink * shrink;
    const dvec3 pa = p - limb.from;
    const double y = glm::dot(pa, along);
    const double z = y - l2;
    const dvec3 across = pa * l2 - along * y;
    const double x2 = glm::dot(across, across);
    const double k = std::copysign(1., shrink) * shrink * shrink * x2;
    if (std::copysign(1., z) * a2 * z * z * l2 > k)
        return std::sqrt(x2 + z * z * l2) / l2 - limb.to_radius;
    if (std::copysign(1., y) * a2 * y * y * l2 < k)
        return std::sqrt(x2 + y * y * l2) / l2 - limb.from_radius;
    return (std::sqrt(x2 * a2 / l2) + y * shrink) / l2 - limb.from_radius;
}

// The distances to the limbs of each bone.
std::array<double, bone_count> bone_distances(const dvec3& p)
{
    std::array<double, bone_count> result;
    result.fill(10);
    for (const Limb& limb : k_limbs)
    {
        result[limb.bone] = std::min(result[limb.bone], distance_to(limb, p));
        const Bone other = mirrored(limb.bone);
        result[other] = std::min(result[other], distance_to(limb, mirrored(p)));
    }
    return result;
}

// A smooth union by the exponential mean: negative inside.
double field(const dvec3& p)
{
    constexpr double k_blend = 0.018; // m
    double sum = 0;
    for (const Limb& limb : k_limbs)
    {
        sum += std::exp(-distance_to(limb, p) / k_blend);
        if (mirrored(limb.bone) != limb.bone)
            sum += std::exp(-distance_to(limb, mirrored(p)) / k_blend);
    }
    return -k_blend * std::log(sum);
}

dvec3 gradient(const dvec3& p)
{
    constexpr double h = 1e-5;
    const auto slope = [&](const dvec3& d) { return (field(p + d) - field(p - d)) / (2 * h); };
    return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

dvec3 on_surface(const dvec3& start)
{
    dvec3 p = start;
    for (int i = 0; i < 4; ++i)
    {
        const dvec3 g = gradient(p);
        p -= field(p) * g / std::max(glm::dot(g, g), 0.1);
    }
    return p;
}

// The surface as a mesh of one vertex in each cell of a grid that it passes (Gibson 1998, "Constrained elastic surface
// nets").
class SurfaceNet
{
public:
    SurfaceNet() : inside_(static_cast<size_t>(k_cells.x) * k_cells.y * k_cells.z), vertices_(inside_.size(), k_none)
    {
        for_each_cell([&](const glm::ivec3& at) { inside_[index(at)] = field(point(at)) < 0; });
        for_each_cell([&](const glm::ivec3& at) { add_faces(at); });
    }

    EvenMesh mesh;

private:
    static constexpr double k_cell = 0.024; // m
    static constexpr glm::ivec3 k_cells{32, 76, 20};
    static constexpr dvec3 k_low{-0.372, -0.03, -0.2};
    static constexpr uint32_t k_none = ~0u;

    static size_t index(const glm::ivec3& at)
    {
        return static_cast<size_t>((at.z * k_cells.y + at.y) * k_cells.x + at.x);
    }
    static dvec3 point(const glm::ivec3& at) { return k_low + k_cell * dvec3(at); }

    template <typename Function>
    static void for_each_cell(Function function)
    {
        for (int z = 0; z < k_cells.z; ++z)
            for (int y = 0; y < k_cells.y; ++y)
                for (int x = 0; x < k_cells.x; ++x)
                    function(glm::ivec3(x, y, z));
    }

    // The vertex of the cell whose lowest corner is `at`.
    uint32_t vertex(const glm::ivec3& at)
    {
        uint32_t& number = vertices_[index(at)];
        if (number == k_none)
        {
            number = static_cast<uint32_t>(mesh.points.size());
            mesh.points.push_back(on_surface(point(at) + 0.5 * k_cell));
        }
        return number;
    }

    // One square around each edge of the grid that the surface crosses.
    void add_faces(const glm::ivec3& at)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            glm::ivec3 end = at;
            if (++end[axis] >= k_cells[axis] || inside_[index(at)] == inside_[index(end)])
                continue;
            glm::ivec3 u(0);
            glm::ivec3 v(0);
            u[(axis + 1) % 3] = 1;
            v[(axis + 2) % 3] = 1;
            const std::array square{vertex(at - u - v), vertex(at - v), vertex(at), vertex(at - u)};
            const bool outward = inside_[index(at)];
            mesh.triangles.emplace_back(square[0], square[outward ? 1 : 2], square[outward ? 2 : 1]);
            mesh.triangles.emplace_back(square[0], square[outward ? 2 : 3], square[outward ? 3 : 2]);
        }
    }

    std::vector<bool> inside_;
    std::vector<uint32_t> vertices_;
};

Matrix moved(const dvec3& by)
{
    return glm::translate(Matrix(1.), by);
}

Matrix turned_about(const dvec3& point, double angle, const dvec3& axis)
{
    return moved(point) * glm::rotate(Matrix(1.), angle, axis) * moved(-point);
}

constexpr dvec3 k_x{1, 0, 0};
constexpr dvec3 k_y{0, 1, 0};
constexpr dvec3 k_z{0, 0, 1};

using Pose = std::array<Matrix, bone_count>; // world from rest

constexpr double k_cycle = static_cast<double>(k_walk_frames) / k_walk_rate; // s
constexpr double k_stance = 0.6;                                             // of the cycle, a foot stands

Matrix carried_back(double seconds)
{
    return turned_about({-k_walk_radius, 0, 0}, glm::radians(k_walk_spin) * seconds, k_y);
}

// The movement of a foot at a phase of its own: it stands from 0 to k_stance, in the middle of which it is as at rest.
// The figure moves on, so the foot goes back on the circle.
Matrix foot_at(double phase, const dvec3& ankle)
{
    const double half = 0.5 * k_stance * k_cycle;
    if (phase < k_stance)
        return carried_back(phase * k_cycle - half);
    const double t = (phase - k_stance) / (1 - k_stance);
    const double eased = t * t * (3 - 2 * t);
    const double lift = 0.085 * std::sin(k_pi * t) * std::sin(k_pi * t);
    const double pitch = 0.55 * std::sin(k_pi * t) * std::cos(0.5 * k_pi * t);
    return moved({0, lift, 0}) * carried_back(half - 2 * half * eased) * turned_about(ankle, pitch, k_x);
}

// Bends a leg so that its ankle is where the foot takes it. `side`: 1 left, -1 right.
void set_leg(Pose& pose, double side, double phase)
{
    const auto at = [&](const dvec3& p) { return side > 0 ? p : mirrored(p); };
    const Bone thigh = side > 0 ? left_thigh : right_thigh;
    const Matrix foot = foot_at(phase, at(k_ankle));
    const dvec3 hip(pose[pelvis] * glm::dvec4(at(k_hip), 1));
    const dvec3 ankle(foot * glm::dvec4(at(k_ankle), 1));
    const double upper = glm::distance(k_hip, k_knee);
    const double lower = glm::distance(k_knee, k_ankle);
    const dvec3 line = ankle - hip;
    const double length = std::min(glm::length(line), 0.999 * (upper + lower));
    const dvec3 down = glm::normalize(line);
    const dvec3 forward = glm::normalize(k_z - glm::dot(k_z, down) * down);
    const double along = (upper * upper - lower * lower + length * length) / (2 * length);
    const double bent = std::sqrt(std::max(upper * upper - along * along, 0.));
    const dvec3 knee = hip + along * down + bent * forward;
    // From a bone at rest to one between two points: the shortest turn.
    const auto placed = [](const dvec3& from, const dvec3& to, const dvec3& new_from, const dvec3& new_to)
    {
        const dvec3 a = glm::normalize(to - from);
        const dvec3 b = glm::normalize(new_to - new_from);
        const dvec3 axis = glm::cross(a, b);
        const double sine = glm::length(axis);
        const Matrix turn =
            sine > 1e-9 ? glm::rotate(Matrix(1.), std::atan2(sine, glm::dot(a, b)), axis / sine) : Matrix(1.);
        return moved(new_from) * turn * moved(-from);
    };
    pose[thigh] = placed(at(k_hip), at(k_knee), hip, knee);
    pose[thigh + 1] = placed(at(k_knee), at(k_ankle), knee, knee + lower * glm::normalize(ankle - knee));
    pose[thigh + 2] = foot;
}

// Swings forward while the other side's leg does.
void set_arm(Pose& pose, double side, double swing)
{
    const auto at = [&](const dvec3& p) { return side > 0 ? p : mirrored(p); };
    const Bone arm = side > 0 ? left_arm : right_arm;
    pose[arm] = pose[chest] * turned_about(at(k_shoulder), -0.24 * swing - 0.06, k_x) *
                turned_about(at(k_shoulder), 0.14 * side, k_z);
    pose[arm + 1] = pose[arm] * turned_about(at(k_elbow), -0.25 - 0.15 * swing, k_x);
}

// The left foot stands first.
Pose pose_at(double phase)
{
    const double angle = 2 * k_pi * (phase - 0.5 * k_stance); // 0: the left foot is below the hip
    Pose pose;
    const dvec3 shift(0.018 * std::cos(angle), -0.022 - 0.014 * std::cos(2 * angle + k_pi), 0);
    pose[pelvis] = moved(shift) * turned_about(k_waist, 0.09 * std::sin(angle), k_y) *
                   turned_about(k_waist, 0.03 * std::cos(angle), k_z);
    pose[chest] = moved(shift) * turned_about(k_waist, 0.04, k_x) * turned_about(k_waist, -0.08 * std::sin(angle), k_y);
    pose[head] = pose[chest] * turned_about(k_neck, 0.07 * std::sin(angle), k_y) * turned_about(k_neck, -0.04, k_x);
    set_arm(pose, 1, std::sin(angle));
    set_arm(pose, -1, -std::sin(angle));
    set_leg(pose, 1, phase);
    set_leg(pose, -1, std::fmod(phase + 0.5, 1.));
    return pose;
}

} // namespace

Figure::Figure()
{
    SurfaceNet net;
    net.mesh.is_fixed.assign(net.mesh.points.size(), false);
    constexpr int k_rounds = 12;
    even_out(net.mesh, on_surface, k_rounds);
    rest_.positions.assign(net.mesh.points.begin(), net.mesh.points.end());
    rest_.triangles = std::move(net.mesh.triangles);
    for (const dvec3& p : net.mesh.points)
    {
        constexpr double k_blend = 0.02; // m
        const std::array distances = bone_distances(p);
        std::array<uint32_t, bone_count> order;
        for (uint32_t i = 0; i < bone_count; ++i)
            order[i] = i;
        std::ranges::sort(order, {}, [&](uint32_t bone) { return distances[bone]; });
        Skin skin;
        double sum = 0;
        for (size_t i = 0; i < k_weights; ++i)
        {
            skin.bones[i] = order[i];
            skin.weights[i] = std::exp((distances[order[0]] - distances[order[i]]) / k_blend);
            sum += skin.weights[i];
        }
        for (double& weight : skin.weights)
            weight /= sum;
        skin_.push_back(skin);
    }
}

voile::engine::Mesh Figure::at(double phase) const
{
    const Pose pose = pose_at(phase);
    voile::engine::Mesh mesh;
    mesh.triangles = rest_.triangles;
    for (size_t i = 0; i < skin_.size(); ++i)
    {
        dvec3 sum(0);
        for (size_t k = 0; k < k_weights; ++k)
            sum += skin_[i].weights[k] * dvec3(pose[skin_[i].bones[k]] * glm::dvec4(dvec3(rest_.positions[i]), 1));
        mesh.positions.emplace_back(sum);
    }
    return mesh;
}

} // namespace scenes
