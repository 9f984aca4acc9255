// Moving pins and solids.
#include "samples/viewer/motions.hpp"

#include "engine/gpu/device.hpp"

namespace viewer
{

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
