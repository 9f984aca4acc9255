// Cloths and pins of a scene file.
#include "samples/viewer/scene_parse.hpp"

#include "voile/gpu/printable.hpp"
#include "voile/ranges.hpp"

#include <charconv>
#include <optional>

namespace viewer
{
namespace
{

constexpr uint32_t k_most_collider_number = 1'000'000;

GridEntry parse_grid(SceneReader& reader, const Field& field)
{
    GridEntry grid;
    if (!reader.object(field, {"vertices", "size"}))
        return grid;
    const Field vertices = reader.required(field, "vertices");
    if (reader.array(vertices, 2))
    {
        reader.read_integer(SceneReader::item(vertices, 0), k_least_grid_vertices, k_most_grid_vertices, grid.columns);
        reader.read_integer(SceneReader::item(vertices, 1), k_least_grid_vertices, k_most_grid_vertices, grid.rows);
    }
    reader.read(reader.required(field, "size"), between(voile::k_least_cloth_size, voile::k_most_cloth_size),
                grid.size);
    return grid;
}

// The N of "corner:N".
std::optional<uint32_t> parse_index(const std::string& text)
{
    uint32_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    return problem == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

void parse_corner(SceneReader& reader, const Field& field, const std::string& rest, PinEntry& pin)
{
    const std::optional<uint32_t> corner = parse_index(rest);
    if (!corner || *corner > 3)
        return reader.fail(field, "is " + in_quotes("corner:" + rest) + "; a corner is 0, 1, 2 or 3");
    pin.at = CornerPin{*corner};
}

void parse_edge(SceneReader& reader, const Field& field, const std::string& rest, PinEntry& pin)
{
    constexpr const char* k_names[] = {"top", "bottom", "left", "right"}; // in the order of Edge
    for (int i = 0; i < 4; ++i)
    {
        if (rest == k_names[i])
        {
            pin.at = EdgePin{static_cast<Edge>(i)};
            return;
        }
    }
    reader.fail(field, "is " + in_quotes("edge:" + rest) + "; an edge is top, bottom, left or right");
}

void parse_vertex(SceneReader& reader, const Field& field, const std::string& rest, const GridEntry* grid,
                  PinEntry& pin)
{
    const std::optional<uint32_t> vertex = parse_index(rest);
    if (!vertex)
        return reader.fail(field, "is " + in_quotes("vertex:" + rest) + "; a vertex is a whole number from 0");
    if (grid != nullptr && *vertex >= grid->columns * grid->rows)
        return reader.fail(field, "is " + in_quotes("vertex:" + rest) + ", but the grid has " +
                                      std::to_string(grid->columns * grid->rows) + " vertices, counted from 0");
    pin.at = VertexPin{*vertex};
}

void parse_pin_text(SceneReader& reader, const Field& field, const GridEntry* grid, PinEntry& pin)
{
    std::string text;
    reader.read(field, text);
    if (reader.failed())
        return;
    const size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
    if ((kind == "corner" || kind == "edge") && grid == nullptr)
        reader.fail(field, "is " + in_quotes(text) + ", but only a grid has corners and edges");
    else if (kind == "corner")
        parse_corner(reader, field, rest, pin);
    else if (kind == "edge")
        parse_edge(reader, field, rest, pin);
    else if (kind == "vertex")
        parse_vertex(reader, field, rest, grid, pin);
    else
        reader.fail(field, "is " + in_quotes(text) + "; a pin is corner:N, edge:NAME, vertex:N or a box");
}

void parse_pin_box(SceneReader& reader, const Field& field, PinEntry& pin)
{
    BoxPin box;
    if (!reader.object(field, {"min", "max"}))
        return;
    reader.read(reader.required(field, "min"), k_any, box.min);
    reader.read(reader.required(field, "max"), k_any, box.max);
    if (!reader.failed() && glm::any(glm::greaterThan(box.min, box.max)))
        reader.fail(field, "has a min above its max");
    pin.at = box;
}

void parse_pin_position(SceneReader& reader, const Field& field, const GridEntry* grid, PinEntry& pin)
{
    if (!field || reader.failed())
        return;
    if (field.node->kind == JsonNode::Kind::string)
        return parse_pin_text(reader, field, grid, pin);
    if (field.node->kind != JsonNode::Kind::object)
        return reader.fail(field, std::string("is ") + describe(field.node->kind) +
                                      "; expected corner:N, edge:NAME, vertex:N or a box");
    if (reader.object(field, {"box"}))
        parse_pin_box(reader, reader.required(field, "box"), pin);
}

void check_name(SceneReader& reader, const Field& field, const std::string& name)
{
    // It becomes a part of file names and of messages.
    constexpr size_t k_longest_name = 100; // bytes
    if (name.size() > k_longest_name)
        reader.fail(field, "is " + in_quotes(name) + "; a name has at most 100 bytes");
    if (name.find_first_of("/\\") != std::string::npos || voile::gpu::printable(name, k_longest_name) != name)
        reader.fail(field, "is " + in_quotes(name) + "; a name holds no slash and no control character");
}

} // namespace

PinEntry parse_pin(SceneReader& reader, const Field& field, const GridEntry* grid)
{
    PinEntry pin;
    pin.location = location_of(field);
    const bool is_object = field && field.node->kind == JsonNode::Kind::object;
    const auto has = [&](const char* key) { return field.node->find(key) != nullptr; };
    if (is_object && (has("at") || has("motion") || has("stiffness") || has("damping") || has("max_distance") ||
                      has("follow") || has("release_at")))
    {
        if (has("box"))
        {
            reader.fail(field, "has \"box\" beside other keys; put it under \"at\": {\"at\": {\"box\": ...}, ...}");
            return pin;
        }
        if (!reader.object(field, {"at", "motion", "follow", "stiffness", "damping", "max_distance", "release_at"}))
            return pin;
        parse_pin_position(reader, reader.required(field, "at"), grid, pin);
        reader.read(SceneReader::child(field, "stiffness"), between(0, voile::k_most_attachment_stiffness),
                    pin.stiffness);
        reader.read(SceneReader::child(field, "damping"), between(0, voile::k_most_attachment_damping), pin.damping);
        reader.read(SceneReader::child(field, "max_distance"), k_not_negative, pin.max_distance);
        reader.read(SceneReader::child(field, "release_at"), k_duration, pin.release_at);
        if (!reader.failed() && has("damping") && !has("stiffness"))
            reader.fail(SceneReader::child(field, "damping"), "is a spring's; it needs a \"stiffness\"");
        if (const Field motion = SceneReader::child(field, "motion"))
            pin.motion = parse_motion(reader, motion);
        if (const Field follow = SceneReader::child(field, "follow"))
        {
            if (pin.motion)
                reader.fail(field, "has both \"motion\" and \"follow\"");
            reader.read_integer(follow, 0, k_most_collider_number, pin.follow.emplace());
        }
        return pin;
    }
    if (is_object &&
        !reader.object(field, {"box", "at", "motion", "follow", "stiffness", "damping", "max_distance", "release_at"}))
        return pin;
    parse_pin_position(reader, field, grid, pin);
    return pin;
}

ClothEntry parse_cloth(ParseContext& context, const Field& field, size_t index)
{
    SceneReader& reader = context.reader;
    ClothEntry cloth;
    cloth.location = location_of(field);
    if (!reader.object(field, {"name", "grid", "mesh", "transform", "material", "pins", "tethers", "velocity",
                               "integrator", "self_collision", "sleep_speed", "layers", "look"}))
        return cloth;
    cloth.name = "cloth_" + std::to_string(index);
    const Field name = SceneReader::child(field, "name");
    reader.read(name, cloth.name);
    check_name(reader, name, cloth.name);

    const Field grid = SceneReader::child(field, "grid");
    const Field mesh = SceneReader::child(field, "mesh");
    if (static_cast<bool>(grid) == static_cast<bool>(mesh))
        reader.fail(field, grid ? "has both \"grid\" and \"mesh\"" : "has neither \"grid\" nor \"mesh\"");
    else if (grid)
        cloth.form = parse_grid(reader, grid);
    else
        cloth.form = parse_mesh_path(context, mesh);

    cloth.transform = parse_transform(reader, SceneReader::child(field, "transform"));
    cloth.material = parse_material(reader, SceneReader::child(field, "material"));
    cloth.look = parse_look(reader, SceneReader::child(field, "look"));
    const Field pins = SceneReader::child(field, "pins");
    if (reader.array(pins))
    {
        for (size_t i = 0; i < pins.node->items.size(); ++i)
            cloth.pins.push_back(parse_pin(reader, SceneReader::item(pins, i), std::get_if<GridEntry>(&cloth.form)));
    }
    if (const Field tethers = SceneReader::child(field, "tethers"); reader.object(tethers, {"stretch"}))
    {
        cloth.tethers = 0.f;
        reader.read(SceneReader::child(tethers, "stretch"), Range{0, 10}, cloth.tethers);
    }
    reader.read(SceneReader::child(field, "velocity"), within(voile::k_most_speed), cloth.velocity);
    if (const auto word = reader.read_word(SceneReader::child(field, "integrator"), "an integrator", {"rk4", "verlet"}))
        cloth.integrator = static_cast<voile::Integrator>(*word);
    reader.read(SceneReader::child(field, "self_collision"), cloth.self_collision);
    reader.read(SceneReader::child(field, "sleep_speed"), Range{0, voile::k_most_sleep_speed}, cloth.sleep_speed);
    parse_layers(reader, SceneReader::child(field, "layers"), cloth.layers);
    return cloth;
}

} // namespace viewer
