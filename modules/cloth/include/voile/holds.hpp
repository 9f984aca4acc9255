// Holds and tethers: what keeps vertices of a cloth in place, or near one. Both can change while the cloth moves.
#pragma once

#include "voile/ids.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <optional>

namespace voile
{

// What holds one vertex: a pin, a spring, a leash with a backstop, or the last two together. At most one a vertex.
struct Hold
{
    uint32_t vertex = 0;
    std::optional<AnchorId> anchor{}; // none: the world
    std::optional<glm::vec3> place{}; // m, in the anchor's space, -1e6..1e6, and in the world as the anchor was added
                                      // -2e6..2e6. None: a pin stays where the vertex is when it is set; other holds
                                      // take the vertex's place at the start, moved as the anchor has moved
    // N/m, 0..1e9. Infinite: a pin; the vertex has no inverse mass and follows the anchor exactly. Finite: a spring,
    // advanced implicitly (backward Euler), so that any stiffness is stable.
    float stiffness = std::numeric_limits<float>::infinity();
    float damping = 0; // N s/m, 0..1e6, against the place's velocity; of a spring
    // m, >= 0, also infinite: how far the vertex may go from the place.
    float max_distance = std::numeric_limits<float>::infinity();
    // Unit length in the anchor's space, or 0 for no backstop: the vertex stays on this side of the plane that lies
    // `backstop` m behind the place.
    glm::vec3 backstop_normal{0.f};
    float backstop = 0; // m, -1e6..1e6
};

// Long-range attachments: a vertex goes no farther from a pin than the length of the unstretched cloth between them,
// times (1 + stretch) (Kim, Chentanez and Müller 2012, "Long range attachments"). Each vertex has one to the nearest
// pin of each of up to four groups of pins that hang together by edges. A vertex that starts beyond goes no farther,
// and comes back by its springs. Where two of its pins are farther apart than both tethers together, both grow in
// proportion until they meet.
struct Tethers
{
    float stretch = 0; // 0..10
};

} // namespace voile
