// Colliders, transforms and motions of a scene file.
#include "samples/viewer/scene_parse.hpp"

#include "voile/ranges.hpp"

#include <cctype>

namespace viewer
{
namespace
{

const Range k_position = within(voile::k_most_coordinate);
const Range k_radius = between(voile::k_least_collider_size, voile::k_most_collider_size);
const Range k_friction = between(0, voile::k_most_friction);
const Range k_scale{0, static_cast<double>(voile::k_most_coordinate), true}; // of a mesh of 1 m

PlaneShape parse_plane(SceneReader& reader, const Field& field)
{
    PlaneShape plane;
    if (reader.object(field, {"y"}))
        reader.read(reader.required(field, "y"), k_position, plane.y);
    return plane;
}

SphereShape parse_sphere(SceneReader& reader, const Field& field)
{
    SphereShape sphere;
    if (!reader.object(field, {"center", "radius"}))
        return sphere;
    reader.read(reader.required(field, "center"), k_position, sphere.center);
    reader.read(reader.required(field, "radius"), k_radius, sphere.radius);
    return sphere;
}

CapsuleShape parse_capsule(SceneReader& reader, const Field& field)
{
    CapsuleShape capsule;
    if (!reader.object(field, {"from", "to", "radius"}))
        return capsule;
    reader.read(reader.required(field, "from"), k_position, capsule.from);
    reader.read(reader.required(field, "to"), k_position, capsule.to);
    reader.read(reader.required(field, "radius"), k_radius, capsule.radius);
    return capsule;
}

BoxShape parse_box(SceneReader& reader, const Field& field)
{
    BoxShape box;
    if (!reader.object(field, {"min", "max"}))
        return box;
    reader.read(reader.required(field, "min"), k_position, box.min);
    reader.read(reader.required(field, "max"), k_position, box.max);
    if (!reader.failed() && !glm::all(glm::lessThan(box.min, box.max)))
        reader.fail(field, "is empty: each number of min must be below that of max");
    return box;
}

// Two coefficients, or one number for both.
FrictionEntry parse_friction(SceneReader& reader, const Field& field)
{
    FrictionEntry friction;
    if (field.node->kind == JsonNode::Kind::number)
    {
        reader.read(field, k_friction, friction.static_friction);
        friction.kinetic_friction = friction.static_friction;
        return friction;
    }
    if (field.node->kind != JsonNode::Kind::object)
        reader.fail(field, std::string("is ") + describe(field.node->kind) + "; expected a number or an object");
    if (!reader.object(field, {"static", "kinetic"}))
        return friction;
    reader.read(reader.required(field, "static"), k_friction, friction.static_friction);
    reader.read(reader.required(field, "kinetic"), k_friction, friction.kinetic_friction);
    if (friction.kinetic_friction > friction.static_friction)
        reader.fail(field, "has a kinetic coefficient above the static one");
    return friction;
}

// One %d or %04d in the file's name, and no other %.
bool is_frame_pattern(const std::string& name)
{
    const size_t percent = name.find('%');
    if (percent == std::string::npos || name.find('%', percent + 1) != std::string::npos)
        return false;
    size_t end = percent + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0)
        ++end;
    // More than two digits of width are useless, and would allow gigabytes of zeros.
    const bool width_ok = end == percent + 1 || (name[percent + 1] == '0' && end - percent <= 3);
    return width_ok && end < name.size() && name[end] == 'd';
}

// `holder` has "frames" and perhaps "rate": the collider itself, or its motion.
void parse_frames(ParseContext& context, const Field& holder, ColliderEntry& collider)
{
    SceneReader& reader = context.reader;
    const Field frames = SceneReader::child(holder, "frames");
    if (!frames)
    {
        for (const char* key : {"rate", "loop"})
            if (const Field alone = SceneReader::child(holder, key))
                reader.fail(alone, "needs \"frames\" beside it");
        return;
    }
    if (collider.frames)
        return reader.fail(frames, "is given twice: in the collider and in its motion");
    FrameSequence sequence;
    sequence.pattern = parse_mesh_path(context, frames);
    if (!reader.failed() && !is_frame_pattern(sequence.pattern.filename().string()))
        reader.fail(frames, "is " + in_quotes(frames.node->text) + "; a file name with one %d or %04d is expected");
    reader.read(SceneReader::child(holder, "rate"), Range{0, 1000, true}, sequence.rate);
    reader.read(SceneReader::child(holder, "loop"), sequence.loop);
    collider.frames = sequence;
}

void parse_shape(ParseContext& context, const Field& field, ColliderEntry& collider)
{
    SceneReader& reader = context.reader;
    Field shape;
    for (const char* key : {"mesh", "plane", "sphere", "capsule", "box"})
    {
        const Field candidate = SceneReader::child(field, key);
        if (candidate && shape)
            return reader.fail(field, "has both \"" + shape.path.substr(field.path.size() + 1) + "\" and \"" + key +
                                          "\"; it needs one of them");
        if (candidate)
            shape = candidate;
    }
    const std::string key = shape ? shape.path.substr(field.path.size() + 1) : "";
    if (key == "mesh")
        collider.shape = MeshShape{parse_mesh_path(context, shape)};
    else if (key == "plane")
        collider.shape = parse_plane(reader, shape);
    else if (key == "sphere")
        collider.shape = parse_sphere(reader, shape);
    else if (key == "capsule")
        collider.shape = parse_capsule(reader, shape);
    else if (key == "box")
        collider.shape = parse_box(reader, shape);
    else if (!collider.frames)
        reader.fail(field, "has no shape: mesh, plane, sphere, capsule, box or frames");
    if (collider.frames && shape && key != "mesh")
        reader.fail(field, "has \"frames\", which deform a mesh, and a " + key);
}

MotionEntry read_motion(SceneReader& reader, const Field& field)
{
    MotionEntry motion;
    reader.read(SceneReader::child(field, "velocity"), within(voile::k_most_speed), motion.velocity);
    reader.read(SceneReader::child(field, "spin"), k_any, motion.spin);
    reader.read(SceneReader::child(field, "pivot"), k_position, motion.pivot);
    reader.read(SceneReader::child(field, "ramp"), k_duration, motion.ramp);
    reader.read(SceneReader::child(field, "reverse_at"), k_duration, motion.reverse_at);
    if (const Field sway = SceneReader::child(field, "sway"); reader.object(sway, {"amplitude", "period"}))
    {
        motion.sway.emplace();
        reader.read(reader.required(sway, "amplitude"), k_position, motion.sway->amplitude);
        reader.read(reader.required(sway, "period"), k_positive, motion.sway->period);
    }
    return motion;
}

} // namespace

TransformEntry parse_transform(SceneReader& reader, const Field& field)
{
    TransformEntry transform;
    if (!reader.object(field, {"translate", "rotate", "scale"}))
        return transform;
    reader.read(SceneReader::child(field, "translate"), k_position, transform.translate);
    reader.read(SceneReader::child(field, "rotate"), k_any, transform.rotate);
    reader.read(SceneReader::child(field, "scale"), k_scale, transform.scale);
    return transform;
}

MotionEntry parse_motion(SceneReader& reader, const Field& field)
{
    if (!reader.object(field, {"velocity", "spin", "pivot", "sway", "ramp", "reverse_at"}))
        return {};
    return read_motion(reader, field);
}

void parse_layers(SceneReader& reader, const Field& field, uint32_t& layers)
{
    if (!reader.array(field))
        return;
    layers = 0;
    for (size_t i = 0; i < field.node->items.size(); ++i)
    {
        uint32_t layer = 0;
        reader.read_integer(SceneReader::item(field, i), 0, 31, layer);
        layers |= 1u << layer;
    }
}

std::filesystem::path parse_mesh_path(ParseContext& context, const Field& field)
{
    std::string text;
    context.reader.read(field, text);
    if (context.reader.failed() || !field)
        return {};
    const std::string extension = lower_extension(text);
    if (extension != ".obj" && extension != ".ply")
        context.reader.fail(field, "is " + in_quotes(text) + "; expected a file that ends in .obj or .ply");
    return (context.folder / text).lexically_normal();
}

ColliderEntry parse_collider(ParseContext& context, const Field& field)
{
    SceneReader& reader = context.reader;
    ColliderEntry collider;
    collider.location = location_of(field);
    if (!reader.object(field, {"mesh", "plane", "sphere", "capsule", "box", "transform", "friction", "motion", "frames",
                               "rate", "loop", "look", "sides", "layers"}))
        return collider;
    parse_frames(context, field, collider);
    const Field motion = SceneReader::child(field, "motion");
    if (reader.object(motion, {"velocity", "spin", "pivot", "sway", "ramp", "reverse_at", "frames", "rate", "loop"}))
    {
        parse_frames(context, motion, collider);
        collider.motion = read_motion(reader, motion);
        if (collider.frames)
            collider.frames->ramp = collider.motion->ramp;
    }
    parse_shape(context, field, collider);
    const Field transform = SceneReader::child(field, "transform");
    collider.placed = static_cast<bool>(transform);
    collider.transform = parse_transform(reader, transform);
    if (const Field friction = SceneReader::child(field, "friction"); friction && !reader.failed())
        collider.friction = parse_friction(reader, friction);
    collider.look = parse_solid_look(reader, SceneReader::child(field, "look"));
    parse_layers(reader, SceneReader::child(field, "layers"), collider.layers);
    const Field sides = SceneReader::child(field, "sides");
    if (const auto word = reader.read_word(sides, "a choice of sides", {"one", "two"}))
        collider.sides = static_cast<MeshSides>(*word);
    if (collider.sides && !std::holds_alternative<MeshShape>(collider.shape))
        reader.fail(sides, "is a mesh's; every other shape pushes outwards");
    return collider;
}

} // namespace viewer
