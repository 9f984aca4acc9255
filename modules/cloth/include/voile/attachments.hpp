// Attachments keep vertices of a cloth in place, or near a point. The host sets them with Solver::set_attachments and
// may change them while the cloth moves.
//
//   solver.set_attachments(flag, {pin(0), pin(63)});
//   solver.set_attachments(curtain, {pin(0).to(rod), spring(31, 200).to(rod)});
//   solver.set_attachments(cape, {max_distance(7, 0.05f).with_backstop({0, 0, 1}, 0.01f).to(spine)});
#pragma once

#include "voile/export.hpp"
#include "voile/ids.hpp"
#include "voile/math.hpp"

#include <cstdint>
#include <limits>
#include <optional>

namespace voile
{

// Attaches one vertex to a point of the world, or of an anchor that the host moves. A vertex has at most one
// attachment. The functions below make attachments; members that they do not set keep their defaults.
struct Attachment
{
    // Index within the cloth.
    uint32_t vertex = 0;

    // The frame of `position` and `backstop_normal`. Default: the world.
    std::optional<AnchorId> anchor{};

    // The point, m in the anchor's space, -1e6..1e6. In the world, with the anchor where it was added: -2e6..2e6.
    // Default: where the vertex was at the start, moved as the anchor has moved since it was added. A pin without a
    // position begins where the vertex is and moves by the motion of its anchor in each step of the cloth. It stays
    // behind if the anchor moves while the cloth is disabled. After reset, teleport and record_restore it begins where
    // these put the vertex. Give a pin a position if it must be exact after these.
    std::optional<Vec3> position{};

    // Pull towards the point, N/m, 0..1e9. Infinite, the default, makes a pin: the vertex has no inverse mass and
    // follows the anchor exactly. A spring is integrated implicitly (backward Euler; under RK4 it loses half as much
    // energy) and is stable at any stiffness. At rest its vertex has no velocity, unless a collider keeps it from where
    // the spring pulls it. Under Verlet that velocity is half a substep old.
    float stiffness = std::numeric_limits<float>::infinity();

    // Damping of the spring, N s/m, 0..1e6, against the point's velocity.
    float damping = 0;

    // Largest distance from the point, m, >= 0. Infinite, the default: no limit.
    float max_distance = std::numeric_limits<float>::infinity();

    // Unit normal of the backstop, in the anchor's space. The vertex stays in front of a plane that lies `backstop`
    // behind the point; the normal points to the front. Zero, the default: no backstop.
    Vec3 backstop_normal{0.f};
    float backstop = 0; // m, -1e6..1e6

    // Copies of the attachment: to an anchor; at a point (m, in the anchor's space); with a limit; with a backstop.
    [[nodiscard]] VOILE_API Attachment to(AnchorId frame) const;
    [[nodiscard]] VOILE_API Attachment at(const Vec3& point) const;
    [[nodiscard]] VOILE_API Attachment with_max_distance(float distance) const;
    [[nodiscard]] VOILE_API Attachment with_backstop(const Vec3& normal, float distance) const;
};

// The vertex stays where it is.
[[nodiscard]] VOILE_API Attachment pin(uint32_t vertex);
// The vertex follows the anchor: from where it is, or at a point in the anchor's space (m).
[[nodiscard]] VOILE_API Attachment pin(uint32_t vertex, AnchorId anchor);
[[nodiscard]] VOILE_API Attachment pin(uint32_t vertex, AnchorId anchor, const Vec3& position);

// A spring pulls the vertex to the point. N/m, N s/m.
[[nodiscard]] VOILE_API Attachment spring(uint32_t vertex, float stiffness, float damping = 0);

// The vertex moves freely within `distance` (m) of the point.
[[nodiscard]] VOILE_API Attachment max_distance(uint32_t vertex, float distance);

// The vertex moves freely in front of a plane `distance` (m) behind the point. `normal` is of unit length.
[[nodiscard]] VOILE_API Attachment backstop(uint32_t vertex, const Vec3& normal, float distance);

// Tethers limit the distance from each vertex to the pins. The limit is the length of the cloth at rest between them,
// times (1 + stretch) (Kim, Chentanez and Müller 2012, "Long range attachments"). Pins that are connected by edges form
// a group. A vertex has one tether to the nearest pin of each group, up to four. A vertex that starts beyond its limit
// moves no farther away, and its springs pull it back. If two pins move farther apart than both tethers of a vertex
// allow, both tethers grow in proportion until their ranges meet.
struct Tethers
{
    float stretch = 0; // 0..10
};

} // namespace voile
