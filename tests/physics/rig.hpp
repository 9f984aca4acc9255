// Rig: a solver with its own device. Steps it, reads it back, and brings it to rest.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/frames.hpp"
#include "voile/solver.hpp"

#include <functional>
#include <vector>

namespace physics
{

constexpr double k_gravity = 9.81;

class Rig
{
public:
    Rig();

    void upload();
    void step(const voile::Step& step, uint32_t times = 1);
    std::vector<glm::dvec3> positions(voile::ClothId cloth);
    std::vector<glm::dvec3> velocities(voile::ClothId cloth);
    double kinetic_energy(); // J, of all cloths

    // Sets the vertex positions, at rest. Springs keep their rest lengths.
    void set_positions(voile::ClothId cloth, const std::vector<glm::dvec3>& positions);
    // Sets all velocities to zero.
    void stop(voile::ClothId cloth);

    // Kinetic damping (Cundall 1976): steps, and stops the cloth whenever its kinetic energy has passed a peak, until a
    // peak is less than `rest` of the highest one. Throws if that takes more than `most` steps. No force is added, so
    // the rest state is the static solution. Steps last between half and all of the given duration.
    void settle(voile::ClothId cloth, const voile::Step& step, uint32_t most, double rest = 1e-8);

    voile::Solver solver;

private:
    void run(const std::function<void(VkCommandBuffer)>& record);
    std::vector<glm::dvec3> read(VkBuffer buffer, const voile::VertexStreams& streams);

    voile::engine::FrameRing frames_;
};

} // namespace physics
