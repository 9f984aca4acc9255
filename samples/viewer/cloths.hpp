// The cloths of a scene file, added to a solver.
#pragma once

#include "samples/viewer/colliders.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/scene_file.hpp"
#include "samples/viewer/surface.hpp"

#include "voile/solver.hpp"

namespace viewer
{

// Pins that move together.
struct MovingPin
{
    voile::AnchorId anchor; // the identity at time 0
    MotionEntry motion;
    Location location; // of the pin, in the scene file
};

// A pinned vertex that goes with a triangle of a mesh collider.
struct FollowingPin
{
    voile::AnchorId anchor; // the triangle's frame in the scene
    size_t solid = 0;       // its number among the stage's
    glm::uvec3 triangle{0};
    glm::mat4 frame{1.f}; // at time 0
    Location location;    // of the pin, in the scene file
};

// Pinned vertices of a cloth that are let go at the same time.
struct ReleasedPins
{
    voile::ClothId cloth;
    std::vector<uint32_t> vertices;
    double at = 0;     // s
    Location location; // of the pin, in the scene file
};

struct AddedCloth
{
    voile::ClothId id;
    Surface surface; // before the first step, without normals
    std::vector<MovingPin> moving_pins;
    std::vector<FollowingPin> following_pins;
    std::vector<ReleasedPins> released_pins;
};

// Reads the mesh, if it has one, and adds the cloth with its pins and tethers. Irregularities of a mesh go to
// standard error, in one line. Errors name the file and the position in it.
voile::Result<AddedCloth> add_cloth(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                    const std::vector<Solid>& solids, const Options& options);

// Of a triangle: its first corner, its first edge and its normal. Rigid.
glm::mat4 triangle_frame(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

} // namespace viewer
