// Moving pins and solids.
#include "samples/viewer/motions.hpp"

#include "voile/engine/gpu/device.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

// Null if it is not there.
template <typename S>
const S* find_solid(const std::vector<S>& solids, size_t number)
{
    const auto found = std::ranges::lower_bound(solids, number, {}, &S::solid);
    return found != solids.end() && found->solid == number ? &*found : nullptr;
}

double end_of(const voile::engine::FrameInfo& frame)
{
    return frame.time + static_cast<double>(frame.time_step);
}

} // namespace

glm::mat4 Motions::pose(size_t solid) const
{
    const MovingSolid* moving = find_solid(solids, solid);
    return moving != nullptr ? moving->pose : glm::mat4(1);
}

const std::vector<glm::vec3>* Motions::positions(size_t solid) const
{
    const DeformingSolid* deformed = find_solid(deforming, solid);
    return deformed != nullptr ? &deformed->positions : nullptr;
}

void Motions::expect(const voile::Result<void>& moved, const Location& location, const char* member) const
{
    if (moved)
        return;
    const std::string& reason = moved.error().message;
    throw voile::engine::StartupError(
        location.line > 0 ? error_at(scene_, {location.line, location.path + member}, reason).message : reason);
}

void Motions::deform(DeformingSolid& solid, const voile::engine::FrameInfo& frame)
{
    if (frame.time >= solid.frames->duration()) // it rests at its last
        return;
    solid.frames->positions_at(end_of(frame), solid.positions);
    expect(solver_.deform_collider(solid.collider, solid.positions), solid.location, ".frames");
    solid.body->set_positions(solid.positions);
}

// After its solid has moved and deformed.
void Motions::follow(const FollowingPin& pin)
{
    glm::mat4 frame = pin.frame;
    if (const DeformingSolid* solid = find_solid(deforming, pin.solid))
    {
        const auto corner = [&](int i)
        { return glm::vec3(solid->placed * glm::vec4(solid->positions[pin.triangle[i]], 1)); };
        frame = triangle_frame(corner(0), corner(1), corner(2));
    }
    expect(solver_.move_anchor(pin.anchor, pose(pin.solid) * frame), pin.location, ".follow");
}

void Motions::release(const ReleasedPins& released)
{
    std::vector<voile::Attachment> attachments = solver_.attachments(released.cloth);
    std::erase_if(attachments, [&](const voile::Attachment& attachment)
                  { return std::ranges::find(released.vertices, attachment.vertex) != released.vertices.end(); });
    expect(solver_.set_attachments(released.cloth, attachments), released.location, ".release_at");
}

void Motions::update(const voile::engine::FrameInfo& frame)
{
    if (!frame.simulates)
        return;
    const double end = end_of(frame);
    for (const MovingPin& pin : pins)
        expect(solver_.move_anchor(pin.anchor, matrix(pin.motion, end)), pin.location, ".motion");
    for (MovingSolid& solid : solids)
    {
        solid.pose = matrix(solid.motion, end);
        expect(solver_.move_collider(solid.collider, solid.pose), solid.location, ".motion");
        for (const DrawnPart& part : solid.parts)
            part.mesh->set_model(solid.pose * part.placed);
    }
    for (DeformingSolid& solid : deforming)
        deform(solid, frame);
    for (const FollowingPin& pin : following)
        follow(pin);
    constexpr double k_rounding = 1e-9; // s, of the frame's time
    const auto is_due = [&](const ReleasedPins& released) { return frame.time + k_rounding >= released.at; };
    for (const ReleasedPins& released : releases)
        if (is_due(released))
            release(released);
    std::erase_if(releases, is_due);
}

} // namespace viewer
