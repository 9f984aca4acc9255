// A scene as JSON: one function per kind of entry, in the order of the parsers.
#include "samples/viewer/scene_writer.hpp"

#include "samples/viewer/text.hpp"

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/material_parameters.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// As people write it: 0.2, not 0.20000000298. Reading it gives the same float.
Json number(float value)
{
    const double shortest = std::strtod(number_text(value).c_str(), nullptr);
    return static_cast<float>(shortest) == value ? Json(shortest) : Json(static_cast<double>(value));
}

Json vector(const glm::vec3& v)
{
    return Json::array({number(v.x), number(v.y), number(v.z)});
}

Json relative_path(const fs::path& file, const fs::path& folder)
{
    const fs::path from_folder = fs::absolute(file).lexically_relative(fs::absolute(folder.empty() ? "." : folder));
    return (from_folder.empty() ? fs::absolute(file) : from_folder).generic_string();
}

template <typename T>
void add(Json& json, const char* key, const T& value, const T& unless, const Json& text)
{
    if (value != unless)
        json[key] = text;
}

void add(Json& json, const char* key, float value, float unless)
{
    add(json, key, value, unless, number(value));
}

void add(Json& json, const char* key, const glm::vec3& value, const glm::vec3& unless)
{
    add(json, key, value, unless, vector(value));
}

Json layers(uint32_t bits)
{
    Json list = Json::array();
    for (uint32_t layer = 0; layer < 32; ++layer)
        if ((bits >> layer & 1) != 0)
            list.push_back(layer);
    return list;
}

Json transform(const TransformEntry& entry)
{
    Json json = Json::object();
    add(json, "translate", entry.translate, glm::vec3(0));
    add(json, "rotate", entry.rotate, glm::vec3(0));
    add(json, "scale", entry.scale, 1);
    return json;
}

Json motion(const MotionEntry& entry)
{
    Json json = Json::object();
    add(json, "velocity", entry.velocity, glm::vec3(0));
    add(json, "spin", entry.spin, glm::vec3(0));
    add(json, "pivot", entry.pivot, glm::vec3(0));
    add(json, "ramp", entry.ramp, 0);
    add(json, "reverse_at", entry.reverse_at, 0);
    if (entry.sway)
        json["sway"] = {{"amplitude", vector(entry.sway->amplitude)}, {"period", number(entry.sway->period)}};
    return json;
}

Json material(const MaterialEntry& entry)
{
    if (entry.preset && entry.values.empty() && !entry.bending_model)
        return *entry.preset;
    Json json = Json::object();
    if (entry.preset)
        json["preset"] = *entry.preset;
    for (const MaterialValue& value : entry.values)
    {
        Json numbers = Json::array();
        for (const float n : value.numbers)
            numbers.push_back(number(n));
        json[value.name] = value.numbers.size() == 1 ? numbers[0] : numbers;
    }
    if (entry.bending_model)
        json["bending_model"] = voile::k_bending_models[static_cast<size_t>(*entry.bending_model)];
    return json;
}

Json pin_position(const PinEntry& pin)
{
    constexpr const char* k_edges[] = {"edge:top", "edge:bottom", "edge:left", "edge:right"}; // in the order of Edge
    if (const auto* corner = std::get_if<CornerPin>(&pin.at))
        return "corner:" + std::to_string(corner->corner);
    if (const auto* edge = std::get_if<EdgePin>(&pin.at))
        return k_edges[static_cast<size_t>(edge->edge)];
    if (const auto* vertex = std::get_if<VertexPin>(&pin.at))
        return "vertex:" + std::to_string(vertex->vertex);
    const auto& box = std::get<BoxPin>(pin.at);
    return {{"box", {{"min", vector(box.min)}, {"max", vector(box.max)}}}};
}

Json pin(const PinEntry& entry)
{
    if (!entry.motion && !entry.follow && !entry.stiffness && !entry.max_distance && entry.release_at == 0)
        return pin_position(entry);
    Json json{{"at", pin_position(entry)}};
    if (entry.motion)
        json["motion"] = motion(*entry.motion);
    if (entry.follow)
        json["follow"] = *entry.follow;
    if (entry.stiffness)
        json["stiffness"] = number(*entry.stiffness);
    add(json, "damping", entry.damping, 0);
    if (entry.max_distance)
        json["max_distance"] = number(*entry.max_distance);
    add(json, "release_at", entry.release_at, 0);
    return json;
}

Json look(const LookEntry& entry)
{
    Json json = Json::object();
    const auto add_number = [&](const char* key, const std::optional<float>& value)
    {
        if (value)
            json[key] = number(*value);
    };
    if (entry.color)
        json["color"] = vector(*entry.color);
    if (entry.back_color)
        json["back_color"] = vector(*entry.back_color);
    if (entry.weave)
        json["weave"] = k_weaves[static_cast<size_t>(*entry.weave)];
    if (entry.pattern)
        json["pattern"] = k_patterns[static_cast<size_t>(*entry.pattern)];
    add_number("threads", entry.threads);
    add_number("roughness", entry.roughness);
    add_number("sheen", entry.sheen);
    add_number("translucency", entry.translucency);
    return json;
}

Json look(const SolidLookEntry& entry)
{
    Json json = Json::object();
    if (entry.color)
        json["color"] = vector(*entry.color);
    if (entry.roughness)
        json["roughness"] = number(*entry.roughness);
    if (entry.metallic)
        json["metallic"] = number(*entry.metallic);
    return json;
}

Json cloth(const ClothEntry& entry, const fs::path& folder)
{
    const ClothEntry plain;
    Json json{{"name", entry.name}};
    if (const auto* grid = std::get_if<GridEntry>(&entry.form))
        json["grid"] = {{"vertices", {grid->columns, grid->rows}},
                        {"size", {number(grid->size.x), number(grid->size.y)}}};
    else
        json["mesh"] = relative_path(std::get<fs::path>(entry.form), folder);
    if (const Json placed = transform(entry.transform); !placed.empty())
        json["transform"] = placed;
    if (const Json fabric = material(entry.material); !fabric.empty())
        json["material"] = fabric;
    for (const PinEntry& one : entry.pins)
        json["pins"].push_back(pin(one));
    if (entry.tethers)
        json["tethers"] = {{"stretch", number(*entry.tethers)}};
    add(json, "velocity", entry.velocity, plain.velocity);
    add(json, "integrator", entry.integrator, plain.integrator, "verlet");
    add(json, "self_collision", entry.self_collision, plain.self_collision, entry.self_collision);
    add(json, "sleep_speed", entry.sleep_speed, plain.sleep_speed);
    add(json, "layers", entry.layers, plain.layers, layers(entry.layers));
    if (const Json drawn = look(entry.look); !drawn.empty())
        json["look"] = drawn;
    return json;
}

void add_shape(const ColliderEntry& entry, const fs::path& folder, Json& json)
{
    if (const auto* plane = std::get_if<PlaneShape>(&entry.shape))
        json["plane"] = {{"y", number(plane->y)}};
    else if (const auto* sphere = std::get_if<SphereShape>(&entry.shape))
        json["sphere"] = {{"center", vector(sphere->center)}, {"radius", number(sphere->radius)}};
    else if (const auto* capsule = std::get_if<CapsuleShape>(&entry.shape))
        json["capsule"] = {
            {"from", vector(capsule->from)}, {"to", vector(capsule->to)}, {"radius", number(capsule->radius)}};
    else if (const auto* box = std::get_if<BoxShape>(&entry.shape))
        json["box"] = {{"min", vector(box->min)}, {"max", vector(box->max)}};
    else if (const auto& mesh = std::get<MeshShape>(entry.shape); !mesh.file.empty())
        json["mesh"] = relative_path(mesh.file, folder);
}

Json collider(const ColliderEntry& entry, const fs::path& folder)
{
    Json json = Json::object();
    add_shape(entry, folder, json);
    if (entry.placed)
        json["transform"] = transform(entry.transform);
    if (entry.friction)
        json["friction"] = {{"static", number(entry.friction->static_friction)},
                            {"kinetic", number(entry.friction->kinetic_friction)}};
    if (entry.motion)
        json["motion"] = motion(*entry.motion);
    if (entry.frames)
    {
        json["frames"] = relative_path(entry.frames->pattern, folder);
        json["rate"] = number(entry.frames->rate);
        add(json, "loop", entry.frames->loop, false, true);
    }
    if (entry.sides)
        json["sides"] = *entry.sides == MeshSides::one ? "one" : "two";
    if (entry.layers != ColliderEntry{}.layers)
        json["layers"] = layers(entry.layers);
    if (const Json drawn = look(entry.look); !drawn.empty())
        json["look"] = drawn;
    return json;
}

Json wind(const WindEntry& entry)
{
    const WindEntry calm;
    Json json = Json::object();
    add(json, "velocity", entry.velocity, calm.velocity);
    add(json, "gust", entry.gust, calm.gust);
    add(json, "gust_length", entry.gust_length, calm.gust_length);
    add(json, "air_density", entry.air_density, calm.air_density);
    return json;
}

Json step(const StepEntry& entry)
{
    const StepEntry usual;
    Json json = Json::object();
    add(json, "rate", entry.rate, usual.rate);
    if (entry.substeps)
        json["substeps"] = *entry.substeps;
    if (entry.max_substeps != usual.max_substeps)
        json["max_substeps"] = entry.max_substeps;
    return json;
}

} // namespace

std::string scene_text(const SceneFile& scene, const fs::path& folder)
{
    Json json = Json::object();
    json["gravity"] = vector(scene.gravity);
    if (const Json blows = wind(scene.wind); !blows.empty())
        json["wind"] = blows;
    if (const Json steps = step(scene.step); !steps.empty())
        json["step"] = steps;
    for (const ClothEntry& entry : scene.cloths)
        json["cloths"].push_back(cloth(entry, folder));
    for (const ColliderEntry& entry : scene.colliders)
        json["colliders"].push_back(collider(entry, folder));
    if (scene.camera)
        json["camera"] = {{"position", vector(scene.camera->position)},
                          {"target", vector(scene.camera->target)},
                          {"fov", number(scene.camera->fov)}};
    return json.dump(2) + "\n";
}

voile::Result<void> save_scene(const SceneFile& scene, const fs::path& path)
{
    auto file = voile::engine::AtomicFile::create(path);
    if (!file)
        return file.error();
    file.value().write(scene_text(scene, path.parent_path()));
    return file.value().commit();
}

} // namespace viewer
