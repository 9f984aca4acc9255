// Signed distance by the nearest feature's pseudonormal.
#include "voile/mesh_checks.hpp"

#include "colliders/mesh_input.hpp"
#include "geometry/bvh_query.hpp"
#include "geometry/closedness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace voile
{

namespace
{

// Normals for the sign of a distance, per triangle; edges and corners in the order of Feature.
struct TriangleNormals
{
    std::array<glm::dvec3, 7> normals{}; // indexed by Feature; only their direction counts
    std::array<bool, 7> boundary{};
};

glm::dvec3 face_normal(const MeshInput& mesh, const glm::uvec3& t)
{
    const glm::dvec3 a = mesh.positions[t.x];
    return glm::normalize(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

double corner_angle(const MeshInput& mesh, const glm::uvec3& t, int corner)
{
    const glm::dvec3 p = mesh.positions[t[corner]];
    const glm::dvec3 a = glm::normalize(glm::dvec3(mesh.positions[t[(corner + 1) % 3]]) - p);
    const glm::dvec3 b = glm::normalize(glm::dvec3(mesh.positions[t[(corner + 2) % 3]]) - p);
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

uint64_t edge_key(uint32_t a, uint32_t b)
{
    return uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

struct Edge
{
    glm::dvec3 normal{0.0};
    uint32_t triangles = 0;
};

std::vector<TriangleNormals> pseudonormals(const MeshInput& mesh)
{
    const std::vector<uint32_t> welded = weld(mesh.positions);
    std::unordered_map<uint64_t, Edge> edges;
    std::vector<glm::dvec3> corners(mesh.positions.size(), glm::dvec3(0));
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::dvec3 normal = face_normal(mesh, t);
        for (int i = 0; i < 3; ++i)
        {
            corners[welded[t[i]]] += corner_angle(mesh, t, i) * normal;
            Edge& edge = edges[edge_key(welded[t[i]], welded[t[(i + 1) % 3]])];
            edge.normal += normal;
            ++edge.triangles;
        }
    }
    std::vector<bool> on_boundary(mesh.positions.size());
    for (const auto& [key, edge] : edges)
        if (edge.triangles == 1)
            on_boundary[key >> 32] = on_boundary[key & 0xffffffffu] = true;

    std::vector<TriangleNormals> result;
    result.reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles)
    {
        TriangleNormals& entry = result.emplace_back();
        entry.normals[6] = face_normal(mesh, t);
        for (size_t i = 0; i < 3; ++i)
        {
            const auto corner = static_cast<int>(i);
            const uint32_t vertex = welded[t[corner]];
            const Edge& edge = edges[edge_key(vertex, welded[t[(corner + 1) % 3]])];
            entry.normals[i] = corners[vertex];
            entry.boundary[i] = on_boundary[vertex];
            entry.normals[3 + i] = edge.normal;
            entry.boundary[3 + i] = edge.triangles == 1;
        }
    }
    return result;
}

// Whether all triangles face the half space of their mean normal.
bool faces_one_way(const MeshInput& mesh)
{
    glm::dvec3 mean(0);
    for (const glm::uvec3& t : mesh.triangles)
        mean += face_normal(mesh, t);
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const glm::uvec3& t) { return glm::dot(face_normal(mesh, t), mean) > 0; });
}

// Of a triangle seen from the origin, signed by its winding (Van Oosterom and Strackee 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    return 2 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

} // namespace

struct MeshDistance::State
{
    MeshInput mesh;
    Bvh bvh;
    std::vector<TriangleNormals> normals;
    bool has_sides = false;
};

MeshDistance::MeshDistance(std::unique_ptr<State> state) : state_(std::move(state)) {}
MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

Result<MeshDistance> MeshDistance::create(const MeshCollider& collider)
{
    auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    auto state = std::make_unique<State>();
    state->mesh = std::move(mesh.value());
    state->bvh = build_bvh(state->mesh.positions, state->mesh.triangles);
    state->normals = pseudonormals(state->mesh);
    state->has_sides = state->mesh.closed || faces_one_way(state->mesh);
    return MeshDistance(std::move(state));
}

bool MeshDistance::closed() const
{
    return state_->mesh.closed;
}

bool MeshDistance::has_sides() const
{
    return state_->has_sides;
}

MeshDistance::Nearest MeshDistance::nearest(const glm::dvec3& point) const
{
    Nearest result;
    const glm::dvec3 origin(state_->mesh.origin);
    const glm::dvec3 local = point - origin;
    const auto found = nearest_point(state_->bvh, local, std::numeric_limits<double>::infinity());
    if (!found) // only where the point is not finite
        return result;
    const TriangleNormals& normals = state_->normals[found->triangle];
    const auto feature = static_cast<size_t>(found->feature);
    result.point = found->point + origin;
    result.on_boundary = normals.boundary[feature];
    const bool behind = glm::dot(local - found->point, normals.normals[feature]) < 0;
    result.signed_distance = behind ? -found->distance : found->distance;
    return result;
}

double MeshDistance::winding_number(const glm::dvec3& point) const
{
    const glm::dvec3 local = point - glm::dvec3(state_->mesh.origin);
    if (state_->mesh.closed)
        return line_winding(state_->bvh, local);
    double angles = 0;
    for (const shared::BvhTriangle& t : state_->bvh.triangles)
        angles += solid_angle(glm::dvec3(t.a) - local, glm::dvec3(t.b) - local, glm::dvec3(t.c) - local);
    return angles / (4 * std::numbers::pi);
}

std::optional<double> MeshDistance::crossing(const glm::dvec3& from, const glm::dvec3& to) const
{
    const auto hit = nearest_hit(state_->bvh, from - glm::dvec3(state_->mesh.origin), to - from, 1);
    return hit ? std::optional<double>(hit->t) : std::nullopt;
}

} // namespace voile
