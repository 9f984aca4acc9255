// What moves by rule in a scene: pins and solids.
#pragma once

#include "samples/viewer/cloths.hpp"
#include "samples/viewer/frame_sequence.hpp"

#include "voile/engine/scene/deforming_mesh.hpp"

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace viewer
{

// What is drawn of a solid.
struct DrawnPart
{
    voile::engine::DrawnMesh* mesh = nullptr; // owned by the scene
    glm::mat4 placed{1.f};                    // world from mesh, at time 0
};

// A solid that moves, in the solver and in the picture.
struct MovingSolid
{
    size_t solid = 0; // its number among the stage's
    voile::ColliderId collider;
    MotionEntry motion;
    std::vector<DrawnPart> parts;
    glm::mat4 pose{1.f}; // from where it was added to where it is after the frames so far
    Location location;   // of the solid, in the scene file; line 0: of the command line
};

// A solid that deforms. It may move, too.
struct DeformingSolid
{
    size_t solid = 0;
    voile::ColliderId collider;
    std::shared_ptr<const MeshSequence> frames;
    voile::engine::DeformingMesh* body = nullptr; // owned by the scene
    std::vector<glm::vec3> positions;             // m, in its mesh's space, after the frames so far
    glm::mat4 placed{1.f};                        // world from mesh, at time 0
    Location location;                            // of the solid, in the scene file
};

// Moves pins and solids to their poses at the frame's end, in `update`. The solver moves them there during its step,
// and the picture shows the result. Nothing moves while nothing is simulated. Where the solver refuses a pose, `update`
// throws StartupError, which names the scene file and the entry of the motion.
class Motions : public voile::engine::Component
{
public:
    Motions(voile::Solver& solver, std::filesystem::path scene) : solver_(solver), scene_(std::move(scene)) {}

    std::vector<MovingPin> pins;
    std::vector<FollowingPin> following;
    std::vector<ReleasedPins> releases;
    std::vector<MovingSolid> solids;       // by their numbers, ascending
    std::vector<DeformingSolid> deforming; // by their numbers, ascending

    // The motion of a solid from its start to the frames so far.
    [[nodiscard]] glm::mat4 pose(size_t solid) const;
    // The vertices of a solid that deforms after the frames so far, in its mesh's space; null for any other.
    [[nodiscard]] const std::vector<glm::vec3>* positions(size_t solid) const;

    void update(const voile::engine::FrameInfo& frame) override;

private:
    void follow(const FollowingPin& pin);
    void release(const ReleasedPins& released);
    void deform(DeformingSolid& solid, const voile::engine::FrameInfo& frame);
    // `member` of the entry at `location` gave the pose.
    void expect(const voile::Result<void>& moved, const Location& location, const char* member) const;

    voile::Solver& solver_;
    std::filesystem::path scene_;
};

} // namespace viewer
