// Moving pins and solids.
#include "samples/viewer/motions.hpp"

#include "engine/gpu/device.hpp"

namespace viewer
{

glm::mat4 Motions::pose(size_t solid) const
{
    for (const MovingSolid& moving : solids)
        if (moving.solid == solid)
            return moving.pose;
    return glm::mat4(1);
}

void Motions::update(const engine::FrameInfo& frame)
{
    const double end = frame.time + static_cast<double>(frame.time_step);
    for (const MovingPin& pin : pins)
        engine::take(solver_.move_anchor(pin.anchor, matrix(pin.motion, end)));
    for (MovingSolid& solid : solids)
    {
        solid.pose = matrix(solid.motion, end);
        engine::take(solver_.move_collider(solid.collider, solid.pose));
        solid.body->set_model(solid.pose * solid.placed);
    }
}

} // namespace viewer
