// A scene as a whole: reading, the top-level keys, and the files that it names.
#include "samples/viewer/scene_file.hpp"

#include "samples/viewer/scene_parse.hpp"

#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/words.hpp"
#include "voile/ranges.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

constexpr uint64_t k_largest_file = uint64_t{16} << 20; // bytes; scenes are written by hand

voile::Result<std::string> read_text(const fs::path& path)
{
    std::error_code problem;
    const fs::file_type type = fs::status(path, problem).type();
    if (type == fs::file_type::not_found)
        return voile::Error{voile::engine::path_text(path) + ": the file does not exist"};
    if (type == fs::file_type::directory)
        return voile::Error{voile::engine::path_text(path) + ": this is a folder, not a scene file"};
    return voile::engine::read_file(path, k_largest_file);
}

void parse_step(SceneReader& reader, const Field& field, StepEntry& step)
{
    if (!reader.object(field, {"rate", "substeps", "max_substeps"}))
        return;
    reader.read(SceneReader::child(field, "rate"), Range{1, 1000}, step.rate);
    reader.read_integer(SceneReader::child(field, "max_substeps"), 1, voile::k_most_substeps, step.max_substeps);
    const Field substeps = SceneReader::child(field, "substeps");
    if (!substeps || reader.failed())
        return;
    if (substeps.node->kind == JsonNode::Kind::string && substeps.node->text == "auto")
        return;
    if (substeps.node->kind != JsonNode::Kind::number)
        return reader.fail(substeps, "is neither \"auto\" nor a whole number within 1 to 1000");
    uint32_t count = 0;
    reader.read_integer(substeps, 1, k_most_substeps, count);
    step.substeps = count;
}

void parse_camera(SceneReader& reader, const Field& field, std::optional<CameraEntry>& camera)
{
    if (!reader.object(field, {"position", "target", "fov"}))
        return;
    CameraEntry entry;
    reader.read(reader.required(field, "position"), k_any, entry.position);
    reader.read(reader.required(field, "target"), k_any, entry.target);
    reader.read(SceneReader::child(field, "fov"), Range{1, 170}, entry.fov);
    if (!reader.failed() && entry.position == entry.target)
        reader.fail(field, "has its target where its position is");
    camera = entry;
}

void parse_cloths(ParseContext& context, const Field& root, std::vector<ClothEntry>& cloths)
{
    SceneReader& reader = context.reader;
    const Field field = reader.required(root, "cloths");
    if (!reader.array(field))
        return;
    if (field.node->items.empty())
        reader.fail(field, "is empty; a scene needs a cloth");
    std::set<std::string> names;
    for (size_t i = 0; i < field.node->items.size() && !reader.failed(); ++i)
    {
        cloths.push_back(parse_cloth(context, SceneReader::item(field, i), i));
        if (!names.insert(cloths.back().name).second)
            reader.fail(SceneReader::item(field, i),
                        "has the name " + in_quotes(cloths.back().name) + " of another cloth");
    }
}

void parse_colliders(ParseContext& context, const Field& field, std::vector<ColliderEntry>& colliders)
{
    if (!context.reader.array(field))
        return;
    for (size_t i = 0; i < field.node->items.size() && !context.reader.failed(); ++i)
        colliders.push_back(parse_collider(context, SceneReader::item(field, i)));
}

// XYZ as in the file: about x first, then y, then z.
glm::mat4 rotation(const glm::vec3& degrees)
{
    glm::mat4 result = glm::rotate(glm::mat4(1.f), glm::radians(degrees.z), glm::vec3(0.f, 0.f, 1.f));
    result = glm::rotate(result, glm::radians(degrees.y), glm::vec3(0.f, 1.f, 0.f));
    return glm::rotate(result, glm::radians(degrees.x), glm::vec3(1.f, 0.f, 0.f));
}

voile::Result<void> check_file(const SceneFile& scene, const Location& entry, const fs::path& file)
{
    std::error_code problem;
    const fs::file_type type = fs::status(file, problem).type();
    if (type == fs::file_type::regular)
        return {};
    const char* reason = type == fs::file_type::directory   ? " is a folder"
                         : type == fs::file_type::not_found ? " does not exist"
                                                            : " is not a regular file";
    return error_at(scene, {entry.line, entry.path + ".mesh"}, voile::engine::path_text(file) + reason);
}

voile::Result<void> check_files(const SceneFile& scene)
{
    for (const ClothEntry& cloth : scene.cloths)
    {
        if (const auto* mesh = std::get_if<fs::path>(&cloth.form))
        {
            if (auto result = check_file(scene, cloth.location, *mesh); !result)
                return result;
        }
    }
    for (const ColliderEntry& collider : scene.colliders)
    {
        const auto* mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh != nullptr && !mesh->file.empty())
        {
            if (auto result = check_file(scene, collider.location, mesh->file); !result)
                return result;
        }
        if (!collider.frames)
            continue;
        if (auto files = frame_files(*collider.frames); !files)
            return error_at(scene, {collider.location.line, collider.location.path + ".frames"}, files.error().message);
    }
    return {};
}

std::vector<StepKey> find_step_keys(const Field& root)
{
    const Field wind = SceneReader::child(root, "wind");
    const Field step = SceneReader::child(root, "step");
    std::vector<StepKey> keys;
    const auto add = [&](const char* member, const Field& field)
    {
        if (field)
            keys.push_back({member, location_of(field)});
    };
    add("gravity", SceneReader::child(root, "gravity"));
    add("wind", SceneReader::child(wind, "velocity"));
    add("gust", SceneReader::child(wind, "gust"));
    add("gust_length", SceneReader::child(wind, "gust_length"));
    add("air_density", SceneReader::child(wind, "air_density"));
    add("max_substeps", SceneReader::child(step, "max_substeps"));
    add("duration", SceneReader::child(step, "rate"));
    add("substeps", SceneReader::child(step, "substeps"));
    return keys;
}

fs::path frame_path(const fs::path& pattern, uint32_t number)
{
    std::string name = pattern.filename().string();
    const size_t percent = name.find('%');
    const size_t end = name.find('d', percent);
    if (percent == std::string::npos || end == std::string::npos)
        return pattern;
    const size_t width = end > percent + 1 ? static_cast<size_t>(std::atoi(name.c_str() + percent + 1)) : 0;
    std::string digits = std::to_string(number);
    if (digits.size() < width)
        digits.insert(0, width - digits.size(), '0');
    return pattern.parent_path() / name.replace(percent, end - percent + 1, digits);
}

// The numbers for which there is a file.
std::set<uint32_t> frame_numbers(const fs::path& pattern)
{
    std::set<uint32_t> numbers;
    const size_t percent = pattern.filename().string().find('%');
    std::error_code problem;
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem))
    {
        const std::string name = entry->path().filename().string();
        uint32_t number = 0;
        if (percent < name.size() &&
            std::from_chars(name.data() + percent, name.data() + name.size(), number).ec == std::errc{} &&
            frame_path(pattern, number).filename() == name && entry->is_regular_file(problem))
            numbers.insert(number);
    }
    return numbers;
}

} // namespace

voile::Result<SceneFile> parse_scene(std::string_view text, const fs::path& path)
{
    const voile::Result<JsonNode> tree = parse_json(text, voile::engine::path_text(path));
    if (!tree)
        return tree.error();
    SceneReader reader(voile::engine::path_text(path));
    ParseContext context{reader, path.parent_path()};
    SceneFile scene;
    scene.path = path;
    scene.name = path.stem().string();
    const Field root{&tree.value(), ""};
    if (reader.object(root, {"gravity", "wind", "step", "cloths", "colliders", "camera"}))
    {
        reader.read(SceneReader::child(root, "gravity"), within(voile::k_most_gravity), scene.gravity);
        if (const Field wind = SceneReader::child(root, "wind");
            reader.object(wind, {"velocity", "gust", "gust_length", "air_density"}))
        {
            reader.read(SceneReader::child(wind, "velocity"), within(voile::k_most_wind), scene.wind.velocity);
            reader.read(SceneReader::child(wind, "gust"), between(0, voile::k_most_gust), scene.wind.gust);
            reader.read(SceneReader::child(wind, "gust_length"),
                        between(voile::k_least_gust_length, voile::k_most_gust_length), scene.wind.gust_length);
            reader.read(SceneReader::child(wind, "air_density"), between(0, voile::k_most_air_density),
                        scene.wind.air_density);
        }
        parse_step(reader, SceneReader::child(root, "step"), scene.step);
        parse_cloths(context, root, scene.cloths);
        parse_colliders(context, SceneReader::child(root, "colliders"), scene.colliders);
        parse_camera(reader, SceneReader::child(root, "camera"), scene.camera);
    }
    if (reader.failed())
        return reader.error();
    scene.step_keys = find_step_keys(root);
    return scene;
}

voile::Result<SceneFile> load_scene(const fs::path& path)
{
    const voile::Result<std::string> text = read_text(path);
    if (!text)
        return text.error();
    voile::Result<SceneFile> scene = parse_scene(text.value(), path);
    if (!scene)
        return scene;
    if (const voile::Result<void> files = check_files(scene.value()); !files)
        return files.error();
    return scene;
}

voile::Error error_at(const fs::path& file, const Location& location, const std::string& reason)
{
    return voile::Error{voile::engine::path_text(file) + ":" + std::to_string(location.line) + ": " + location.path +
                        ": " + reason};
}

voile::Error error_at(const SceneFile& scene, const Location& location, const std::string& reason)
{
    return error_at(scene.path, location, reason);
}

voile::Error step_error(const SceneFile& scene, const std::string& reason)
{
    for (const StepKey& key : scene.step_keys)
        if (reason.starts_with("step: " + key.member + " "))
            return error_at(scene, key.location, reason);
    return voile::Error{voile::engine::path_text(scene.path) + ": " + reason};
}

voile::Result<std::vector<fs::path>> frame_files(const FrameSequence& sequence)
{
    if (frame_path(sequence.pattern, 0) == frame_path(sequence.pattern, 1))
        return voile::Error{voile::engine::path_text(sequence.pattern) + ": has no %d or %04d for the frame's number"};
    const std::set<uint32_t> numbers = frame_numbers(sequence.pattern);
    if (!numbers.contains(0) && !numbers.contains(1))
        return voile::Error{voile::engine::path_text(sequence.pattern) + ": there is no frame 0 and no frame 1"};
    std::vector<fs::path> files;
    for (uint32_t number = numbers.contains(0) ? 0 : 1; number <= *numbers.rbegin(); ++number)
    {
        files.push_back(frame_path(sequence.pattern, number));
        if (!numbers.contains(number))
            return voile::Error{
                voile::engine::path_text(files.back()) + " is missing, but " +
                voile::engine::path_text(frame_path(sequence.pattern, *numbers.upper_bound(number)).filename()) +
                " is there"};
    }
    return files;
}

glm::mat4 matrix(const TransformEntry& transform)
{
    const glm::mat4 moved = glm::translate(glm::mat4(1.f), transform.translate);
    return glm::scale(moved * rotation(transform.rotate), glm::vec3(transform.scale));
}

double ramped(double seconds, float ramp)
{
    const auto length = static_cast<double>(ramp);
    if (length <= 0)
        return seconds;
    return seconds < length ? 0.5 * std::max(seconds, 0.0) * seconds / length : seconds - 0.5 * length;
}

glm::mat4 matrix(const MotionEntry& motion, double scene_seconds)
{
    const auto reverse_at = static_cast<double>(motion.reverse_at);
    const double elapsed =
        reverse_at > 0 && scene_seconds > reverse_at ? std::max(2 * reverse_at - scene_seconds, 0.0) : scene_seconds;
    const double seconds = ramped(elapsed, motion.ramp);
    const auto time = static_cast<float>(seconds);
    const glm::mat4 back = glm::translate(glm::mat4(1.f), -motion.pivot);
    glm::vec3 moved = motion.velocity * time;
    if (motion.sway)
    {
        const double phase = 2 * std::numbers::pi * seconds / static_cast<double>(motion.sway->period);
        moved += motion.sway->amplitude * static_cast<float>(std::sin(phase));
    }
    return glm::translate(glm::mat4(1.f), motion.pivot + moved) * rotation(motion.spin * time) * back;
}

} // namespace viewer
