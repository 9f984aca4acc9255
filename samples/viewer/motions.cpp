// Moving pins and solids.
#include "samples/viewer/motions.hpp"

#include "engine/gpu/device.hpp"

namespace viewer
{
namespace
{

double end_of(const engine::FrameInfo& frame)
{
    return frame.time + static_cast<double>(frame.time_step);
}

} // namespace

glm::mat4 Motions::pose(size_t solid) const
{
    for (const MovingSolid& moving : solids)
        if (moving.solid == solid)
            return moving.pose;
    return glm::mat4(1);
}

const std::vector<glm::vec3>* Motions::positions(size_t solid) const
{
    for (const DeformingSolid& deformed : deforming)
        if (deformed.solid == solid)
            return &deformed.positions;
    return nullptr;
}

void Motions::deform(DeformingSolid& solid, const engine::FrameInfo& frame)
{
    if (frame.time >= solid.frames->duration()) // it rests at its last
        return;
    solid.frames->positions_at(end_of(frame), solid.positions);
    engine::take(solver_.deform_collider(solid.collider, solid.positions));
    solid.body->set_positions(solid.positions);
}

void Motions::update(const engine::FrameInfo& frame)
{
    const double end = end_of(frame);
    for (const MovingPin& pin : pins)
        engine::take(solver_.move_anchor(pin.anchor, matrix(pin.motion, end)));
    for (MovingSolid& solid : solids)
    {
        solid.pose = matrix(solid.motion, end);
        engine::take(solver_.move_collider(solid.collider, solid.pose));
        solid.body->set_model(solid.pose * solid.placed);
    }
    for (DeformingSolid& solid : deforming)
        deform(solid, frame);
}

} // namespace viewer
