// A scene file (JSON) as plain structs, with the ranges of the cloth module (voile/ranges.hpp,
// voile/material_parameters.hpp). SI units, degrees for angles, y is up. A field that is std::optional or absent was
// not written in the file; its default belongs to whoever builds the scene.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/result.hpp"

#include "voile/engine/scene/component.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace viewer
{

constexpr uint32_t k_least_grid_vertices = 2;   // along a side
constexpr uint32_t k_most_grid_vertices = 8192; // along a side
constexpr uint32_t k_most_substeps = 1000;      // of a frame

// The location of an entry in the file, for messages.
struct Location
{
    uint32_t line = 0;
    std::string path; // "cloths[0].pins[2]"
};

// Scales, then rotates, then translates.
struct TransformEntry
{
    glm::vec3 translate{0.f}; // m
    glm::vec3 rotate{0.f};    // degrees about x, then y, then z
    float scale = 1.f;        // > 0, at most 1e6
};

// To and fro: amplitude * sin(2 pi t / period).
struct SwayEntry
{
    glm::vec3 amplitude{0.f}; // m
    float period = 1.f;       // s, > 0
};

// Rigid motion from the placed state on: a turn about `pivot`, which itself moves with `velocity` and sways.
struct MotionEntry
{
    glm::vec3 velocity{0.f}; // m/s
    glm::vec3 spin{0.f};     // degrees/s about x, then y, then z
    glm::vec3 pivot{0.f};    // m, in the scene, at time 0
    std::optional<SwayEntry> sway{};
    float ramp = 0.f;       // s, >= 0: how long it takes to reach its speed, from rest
    float reverse_at = 0.f; // s, >= 0: from then on it runs backward, to its start; 0: never
};

// Meshes of one topology, one a time step of 1/rate s.
struct FrameSequence
{
    std::filesystem::path pattern; // resolved; its file name holds %d or %04d once, for the frame's number
    float rate = 60.f;             // meshes per second, > 0
    bool loop = false;             // the first follows the last
    float ramp = 0.f;              // s, that of the motion
};

struct WindEntry
{
    glm::vec3 velocity{0.f};    // m/s
    float gust = 0.f;           // root mean square of the gusts as a fraction of the speed, 0..10
    float gust_length = 4.f;    // m, wavelength of the longest gusts, 0.01..1e6
    float air_density = 1.225f; // kg/m³, 0..1e5
};

struct StepEntry
{
    float rate = 60.f;                // frames per second of simulated time, 1..1000
    std::optional<uint32_t> substeps; // of a frame, 1..1000; absent: "auto", from stability
    uint32_t max_substeps = 2000;     // with "auto", 1..1000000
};

enum class Edge
{
    top,
    bottom,
    left,
    right
}; // row 0, last row, column 0, last column

// A parameter of a material, by its name in voile/material_parameters.hpp.
struct MaterialValue
{
    std::string name;
    std::vector<float> numbers; // one for all components, or one for each
};

// The names of presets.
inline constexpr const char* k_presets[] = {"silk", "cotton", "wool", "denim", "leather", "reference"};

// A preset, values, or a preset with some values replaced.
struct MaterialEntry
{
    std::optional<std::string> preset; // silk, cotton, wool, denim, leather or reference
    std::vector<MaterialValue> values;
    std::optional<voile::BendingModel> bending_model;
    Location location;

    [[nodiscard]] const MaterialValue* find(std::string_view name) const; // null: not written
};

// Flat in x and z, centerd on the origin. Vertex index = row * columns + column.
struct GridEntry
{
    uint32_t columns = 0; // along x, 2..8192
    uint32_t rows = 0;    // along z, 2..8192
    glm::vec2 size{0.f};  // m along x and z, > 0
};

struct CornerPin
{
    uint32_t corner = 0; // 0 to 3: row 0 column 0, row 0 last column, last row column 0, last row last column
};
struct EdgePin
{
    Edge edge = Edge::top;
};
struct VertexPin
{
    uint32_t vertex = 0; // of a grid: within its vertices, as the file has them
};
struct BoxPin
{
    glm::vec3 min{0.f}; // m, in the scene, against the vertices as they start
    glm::vec3 max{0.f};
};

struct PinEntry
{
    std::variant<CornerPin, EdgePin, VertexPin, BoxPin> at; // corners and edges on grids only
    std::optional<MotionEntry> motion;                      // absent: it stays where it is
    std::optional<uint32_t> follow;                         // the number of a mesh collider that it moves with
    std::optional<float> stiffness;                         // N/m, >= 0: a spring in place of a pin
    float damping = 0.f;                                    // N·s/m, >= 0, of that spring
    std::optional<float> max_distance;                      // m, >= 0, from the point
    float release_at = 0.f;                                 // s, >= 0: from then on it holds nothing; 0: never
    Location location;
};

// The names of weaves and patterns, in the order of their values.
inline constexpr const char* k_weaves[] = {"plain", "twill", "satin", "grain", "none"};
inline constexpr const char* k_patterns[] = {"check", "stripes", "none"};

// How a cloth is drawn. What is absent follows from the material's preset.
struct LookEntry
{
    std::optional<glm::vec3> color{};      // linear, 0..1
    std::optional<glm::vec3> back_color{}; // of the other side; absent beside `color`: darker
    std::optional<voile::engine::Surface::Weave> weave{};
    std::optional<voile::engine::Surface::Pattern> pattern{};
    std::optional<float> threads{};      // per meter, 1..1e5
    std::optional<float> roughness{};    // 0.05..1
    std::optional<float> sheen{};        // 0..1
    std::optional<float> translucency{}; // 0..1
};

struct ClothEntry
{
    std::string name;                                    // unique, fit for a file name; "cloth_0" ... where unnamed
    std::variant<GridEntry, std::filesystem::path> form; // a grid, or a mesh file (OBJ or PLY, resolved)
    TransformEntry transform;
    MaterialEntry material;
    LookEntry look;
    std::vector<PinEntry> pins;
    std::optional<float> tethers; // how far they let the cloth stretch, 0..10; absent: none
    glm::vec3 velocity{0.f};      // m/s at the start
    voile::Integrator integrator = voile::Integrator::rk4;
    bool self_collision = false;
    float sleep_speed = 0; // m/s, below which it falls asleep; 0: never
    uint32_t layers = 1;   // bits; it collides with colliders that share one, and with cloths that do if both have
                           // self_collision
    Location location;
};

struct MeshShape
{
    std::filesystem::path file; // OBJ or PLY, resolved; empty where `frames` alone gives the form. Beside `frames` it
                                // must have their topology, and where its vertices are counts nothing
};
struct PlaneShape
{
    float y = 0.f; // m
};
struct SphereShape
{
    glm::vec3 center{0.f}; // m
    float radius = 0.f;    // m, > 0
};
struct CapsuleShape // {"from": [...], "to": [...], "radius": r}
{
    glm::vec3 from{0.f}; // m, the centers of its two end spheres
    glm::vec3 to{0.f};
    float radius = 0.f; // m, > 0
};
struct BoxShape // {"min": [...], "max": [...]}
{
    glm::vec3 min{0.f}; // m, each below max's
    glm::vec3 max{0.f};
};

struct FrictionEntry
{
    float static_friction = 0.f; // >= kinetic_friction
    float kinetic_friction = 0.f;
};

// The side to which a mesh pushes. Default: a closed one outwards, an open one to where cloth comes from.
enum class MeshSides
{
    one, // to where its triangles face
    two  // to the side that cloth comes from
};

// How a collider is drawn. What is absent is that of stone; the ground has its own.
struct SolidLookEntry
{
    std::optional<glm::vec3> color{}; // linear, 0..1
    std::optional<float> roughness{}; // 0.05..1
    std::optional<float> metallic{};  // 0..1
};

struct ColliderEntry
{
    std::variant<MeshShape, PlaneShape, SphereShape, CapsuleShape, BoxShape> shape;
    bool placed = false; // "transform" was written
    TransformEntry transform;
    std::optional<MeshSides> sides; // with a mesh only
    uint32_t layers = 1;            // bits; it meets the cloths that share one
    std::optional<FrictionEntry> friction;
    std::optional<MotionEntry> motion;
    std::optional<FrameSequence> frames; // with a mesh only
    SolidLookEntry look;
    Location location;
};

struct CameraEntry
{
    glm::vec3 position{0.f}; // m
    glm::vec3 target{0.f};   // m, not at the position
    float fov = 40.f;        // vertical, degrees, 1..170
};

// A key that gives a member of voile::Step its value.
struct StepKey
{
    std::string member;
    Location location;
};

struct SceneFile
{
    std::filesystem::path path;
    std::string name;                    // the file's name without folder and extension
    glm::vec3 gravity{0.f, -9.81f, 0.f}; // m/s²
    WindEntry wind;
    StepEntry step;
    std::vector<ClothEntry> cloths; // at least one
    std::vector<ColliderEntry> colliders;
    std::optional<CameraEntry> camera; // absent: the viewer frames the scene itself
    std::vector<StepKey> step_keys;    // those that are written
};

// Parses a scene's text. `path` is for messages and for relative paths; no file is read.
// Errors are one line with the file, the line, the path of the key (cloths[0].grid.size) and the reason.
voile::Result<SceneFile> parse_scene(std::string_view text, const std::filesystem::path& path);

// Reads and parses a scene, and checks that the files it names are there.
voile::Result<SceneFile> load_scene(const std::filesystem::path& path);

// "FILE:LINE: PATH: REASON"
voile::Error error_at(const std::filesystem::path& file, const Location& location, const std::string& reason);
voile::Error error_at(const SceneFile& scene, const Location& location, const std::string& reason);
// The same for the key that gave the member of the step that the reason begins with: "step: gravity is ...".
voile::Error step_error(const SceneFile& scene, const std::string& reason);

// The meshes of a sequence in their order: from number 0 (or 1, if there is no 0) up to the last. Errors: there are
// none, one between them is missing, the pattern has no number.
voile::Result<std::vector<std::filesystem::path>> frame_files(const FrameSequence& sequence);

glm::mat4 matrix(const TransformEntry& transform);
// The time that a motion has got to: it starts at rest, speeds up evenly for `ramp`, and then runs at the usual rate.
double ramped(double seconds, float ramp);
// The displacement of points from time 0 to `seconds`; at 0 the identity.
glm::mat4 matrix(const MotionEntry& motion, double seconds);

// Folders that are searched for scenes by name, in this order: those of the environment variable VOILE_SCENES
// (separated by ':'), and beside the program ../scenes, scenes and ../share/voile/scenes.
std::vector<std::filesystem::path> scene_folders();

// The names of the scenes in the folders, each once, in alphabetical order.
std::vector<std::string> scene_names(const std::vector<std::filesystem::path>& folders = scene_folders());

// A scene by path, else by name in the folders. The error lists the names that there are.
voile::Result<std::filesystem::path> find_scene(const std::string& name,
                                                const std::vector<std::filesystem::path>& folders = scene_folders());

} // namespace viewer
