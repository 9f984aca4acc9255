// The look of a cloth in a scene file.
#include "samples/viewer/scene_parse.hpp"

#include <charconv>
#include <cmath>

namespace viewer
{
namespace
{

// IEC 61966-2-1.
float linear(uint32_t byte)
{
    const float s = static_cast<float>(byte) / 255;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

// "#rrggbb" in sRGB, or three numbers that are linear.
void parse_color(SceneReader& reader, const Field& field, std::optional<glm::vec3>& color)
{
    if (!field || reader.failed())
        return;
    if (field.node->kind != JsonNode::Kind::string)
    {
        glm::vec3 numbers(0.f);
        reader.read(field, Range{0, 1}, numbers);
        color = numbers;
        return;
    }
    const std::string& text = field.node->text;
    uint32_t rgb = 0;
    const auto [stop, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), rgb, 16);
    if (text.size() != 7 || text[0] != '#' || problem != std::errc{} || stop != text.data() + text.size())
        return reader.fail(field, "is " + in_quotes(text) + "; a color is \"#rrggbb\" or three numbers from 0 to 1");
    color = glm::vec3(linear(rgb >> 16), linear(rgb >> 8 & 255u), linear(rgb & 255u));
}

} // namespace

LookEntry parse_look(SceneReader& reader, const Field& field)
{
    LookEntry look;
    if (!reader.object(field,
                       {"color", "back_color", "weave", "pattern", "threads", "roughness", "sheen", "translucency"}))
        return look;
    parse_color(reader, SceneReader::child(field, "color"), look.color);
    parse_color(reader, SceneReader::child(field, "back_color"), look.back_color);
    if (const auto word = reader.read_word(SceneReader::child(field, "weave"), "a weave", k_weaves))
        look.weave = static_cast<voile::engine::Surface::Weave>(*word);
    if (const auto word = reader.read_word(SceneReader::child(field, "pattern"), "a pattern", k_patterns))
        look.pattern = static_cast<voile::engine::Surface::Pattern>(*word);
    reader.read(SceneReader::child(field, "threads"), Range{1, 1e5}, look.threads);
    reader.read(SceneReader::child(field, "roughness"), Range{0.05, 1}, look.roughness);
    reader.read(SceneReader::child(field, "sheen"), Range{0, 1}, look.sheen);
    reader.read(SceneReader::child(field, "translucency"), Range{0, 1}, look.translucency);
    return look;
}

SolidLookEntry parse_solid_look(SceneReader& reader, const Field& field)
{
    SolidLookEntry look;
    if (!reader.object(field, {"color", "roughness", "metallic"}))
        return look;
    parse_color(reader, SceneReader::child(field, "color"), look.color);
    reader.read(SceneReader::child(field, "roughness"), Range{0.05, 1}, look.roughness);
    reader.read(SceneReader::child(field, "metallic"), Range{0, 1}, look.metallic);
    return look;
}

} // namespace viewer
