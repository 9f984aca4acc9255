// Checks of a state on the host in double precision, for tests and tools. The simulation does not use them.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/math.hpp"

#include <memory>
#include <optional>

namespace voile
{

// The signed distance of points from a collider's mesh.
class VOILE_API MeshDistance
{
public:
    // Copies the mesh. Errors: those of Solver::add_collider.
    static Result<MeshDistance> create(const MeshCollider& collider);
    ~MeshDistance();
    MeshDistance(MeshDistance&&) noexcept;
    MeshDistance& operator=(MeshDistance&&) noexcept;

    // Whether the mesh encloses a volume.
    [[nodiscard]] bool closed() const;
    // Whether signs are meaningful: the mesh is closed, or open with all triangles facing the same half space (a
    // ground, a height field). Any other open mesh has no inside.
    [[nodiscard]] bool has_sides() const;

    struct Nearest
    {
        DVec3 point{0.0};           // on the mesh, m
        double signed_distance = 0; // m; negative inside a closed mesh, or behind an open one
        bool on_boundary = false;   // the point is on an edge of only one triangle, where the sign means little
    };
    // The nearest point of the mesh. The sign follows from the angle-weighted normal of the triangle, edge or vertex at
    // that point (Bærentzen and Aanæs 2005, "Signed distance computation using the angle weighted pseudonormal"). If
    // the mesh intersects itself, or its parts lie in each other, use winding_number to decide what is inside.
    [[nodiscard]] Nearest nearest(const DVec3& point) const;

    // How often the mesh winds around the point (Jacobson, Kavan and Sorkine-Hornung 2013, "Robust inside-outside
    // segmentation using generalized winding numbers"): 1 inside a closed mesh, 0 outside, negative inside an
    // inside-out one, and near 1 and 0 for a mesh with small holes. For a closed mesh it is a whole number, even if the
    // mesh intersects itself, and the hierarchy finds it. For an open mesh it is a sum over every triangle.
    [[nodiscard]] double winding_number(const DVec3& point) const;

    // Where the segment first crosses the mesh, as a fraction of its length.
    [[nodiscard]] std::optional<double> crossing(const DVec3& from, const DVec3& to) const;

private:
    struct State;
    explicit MeshDistance(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Number of pairs of triangles without a common corner that have a point in common, decided without rounding. Triangles
// that touch count. Triangles in one plane do not; Solver::record_statistics counts their overlapping edges
// (IntersectionCounts). Indices must be within `positions`; triangles with a corner that is not finite are left out.
VOILE_API uint64_t count_self_intersections(std::span<const Vec3> positions, std::span<const UVec3> triangles);

} // namespace voile
