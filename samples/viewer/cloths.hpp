// The cloths of a scene file, added to a solver.
#pragma once

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
};

struct AddedCloth
{
    voile::ClothId id;
    Surface surface; // before the first step, without normals
    std::vector<MovingPin> moving_pins;
};

// Reads the mesh, if it has one, and adds the cloth with its pins and tethers. Irregularities of a mesh go to
// standard error, in one line. Errors name the file and the position in it.
voile::Result<AddedCloth> add_cloth(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                    const Options& options);

} // namespace viewer
