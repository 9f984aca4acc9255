// The entries of a scene file, one function each. Internal to the viewer's parts.
#pragma once

#include "samples/viewer/scene_file.hpp"
#include "samples/viewer/scene_reader.hpp"

namespace viewer
{

struct ParseContext
{
    SceneReader& reader;
    std::filesystem::path folder; // that paths are relative to
};

inline Location location_of(const Field& field)
{
    return {field.line(), field.path};
}

// They report through the reader; what they return is meaningless once it has failed.
ClothEntry parse_cloth(ParseContext& context, const Field& field, size_t index);
ColliderEntry parse_collider(ParseContext& context, const Field& field);
LookEntry parse_look(SceneReader& reader, const Field& field);
SolidLookEntry parse_solid_look(SceneReader& reader, const Field& field);
MaterialEntry parse_material(SceneReader& reader, const Field& field);
PinEntry parse_pin(SceneReader& reader, const Field& field, const GridEntry* grid);
TransformEntry parse_transform(SceneReader& reader, const Field& field);
MotionEntry parse_motion(SceneReader& reader, const Field& field);
// The bits of a list of numbers from 0 to 31; left as they are where the field is absent.
void parse_layers(SceneReader& reader, const Field& field, uint32_t& layers);
// A resolved path that ends in .obj or .ply.
std::filesystem::path parse_mesh_path(ParseContext& context, const Field& field);

} // namespace viewer
