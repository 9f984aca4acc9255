// Cases: the reference scene, sheets of the drape scene's fabric, and a hundred cloths beside one of the same size.
#include "cases.hpp"

#include "heart.hpp"
#include "icosphere.hpp"
#include "sheets.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/gpu/device.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

namespace bench
{

namespace
{

using Cloths = std::vector<voile::ClothId>;

template <uint32_t side>
Cloths add_reference_cloth(voile::Solver& solver)
{
    return {voile::engine::take(solver.add_cloth(reference_grid(side, 0, 0)))};
}

void add_mesh(voile::Solver& solver, const char* name, const voile::engine::Mesh& mesh)
{
    voile::MeshCollider collider;
    collider.name = name;
    collider.positions = mesh.positions;
    collider.triangles = mesh.triangles;
    collider.friction = voile::Friction{0.4f, 0.4f};
    (void)voile::engine::take(solver.add_collider(collider));
}

Cloths add_reference_scene(voile::Solver& solver)
{
    add_mesh(solver, "heart", scenes::make_reference_heart());
    add_mesh(solver, "ground", scenes::make_ground());
    return add_reference_cloth<128>(solver);
}

// A field of along x along cloths of side x side vertices, a spacing apart.
Cloths add_field(voile::Solver& solver, uint32_t along, uint32_t side, voile::Integrator integrator,
                 float sleep_speed = 0)
{
    Cloths cloths;
    for (uint32_t row = 0; row < along; ++row)
        for (uint32_t column = 0; column < along; ++column)
        {
            const float pitch = k_reference_spacing * static_cast<float>(side);
            voile::GridCloth grid =
                reference_grid(side, pitch * static_cast<float>(column), pitch * static_cast<float>(row));
            grid.name = "cloth " + std::to_string(cloths.size());
            grid.integrator = integrator;
            grid.sleep_speed = sleep_speed;
            cloths.push_back(voile::engine::take(solver.add_cloth(grid)));
        }
    return cloths;
}

Cloths add_hundred_cloths(voile::Solver& solver)
{
    return add_field(solver, 10, 13, voile::Integrator::rk4);
}

// 262,144 vertices.
template <uint32_t along, bool ground>
Cloths add_verlet_field(voile::Solver& solver)
{
    if (ground)
        (void)voile::engine::take(solver.add_collider(voile::PlaneCollider{}));
    return add_field(solver, along, 512 / along, voile::Integrator::verlet);
}

Cloths add_sleeping_field(voile::Solver& solver)
{
    constexpr float k_sleep_speed = 0.05f; // m/s
    (void)voile::engine::take(solver.add_collider(voile::PlaneCollider{}));
    return add_field(solver, 32, 16, voile::Integrator::verlet, k_sleep_speed);
}

template <uint32_t side>
Cloths add_drape_sheet(voile::Solver& solver)
{
    return {voile::engine::take(solver.add_cloth(drape_grid(side)))};
}

template <uint32_t side, bool self_collision>
Cloths add_verlet_sheet(voile::Solver& solver)
{
    return {voile::engine::take(solver.add_cloth(verlet_grid(side, self_collision)))};
}

template <uint32_t side, bool shuffled, bool isometric>
Cloths add_mesh_sheet(voile::Solver& solver)
{
    return {add_as_mesh(solver, drape_grid(side), shuffled,
                        isometric ? voile::BendingModel::isometric : voile::BendingModel::springs)};
}

template <uint32_t side, bool shuffled>
Cloths add_self_mesh_sheet(voile::Solver& solver)
{
    return {add_as_mesh(solver, verlet_grid(side, true), shuffled, voile::BendingModel::springs)};
}

// The sheet of 128 x 128 with one additional feature, to measure the feature's cost.
template <void (*change)(voile::Fabric&)>
Cloths add_changed_sheet(voile::Solver& solver)
{
    voile::GridCloth grid = drape_grid(128);
    change(std::get<voile::Fabric>(grid.material));
    return {voile::engine::take(solver.add_cloth(grid))};
}

void bend_isometrically(voile::Fabric& fabric)
{
    fabric.bending_model = voile::BendingModel::isometric;
}

void feel_air(voile::Fabric& fabric)
{
    fabric.air_drag_normal = 1.28f;
    fabric.air_drag_tangential = 0.05f;
}

void limit_strain(voile::Fabric& fabric)
{
    fabric.strain_limit = 0.05f;
}

// The sheet of 128 x 128 on a sphere.
template <uint32_t subdivisions>
Cloths add_icosphere(voile::Solver& solver)
{
    add_mesh(solver, "icosphere", case_icosphere(subdivisions));
    return {voile::engine::take(solver.add_cloth(drape_grid(128)))};
}

// Rough like a scan: no triangle lies in its neighbor's plane.
Cloths add_rough_sphere(voile::Solver& solver)
{
    constexpr float k_roughness = 0.004f; // m, in both directions; edges are 15 mm long
    voile::engine::Mesh mesh = case_icosphere(6);
    std::mt19937 random(1);
    for (glm::vec3& p : mesh.positions)
        p += glm::normalize(p) * k_roughness * (static_cast<float>(random()) / 0x1p31f - 1);
    add_mesh(solver, "rough sphere", mesh);
    return {voile::engine::take(solver.add_cloth(drape_grid(128)))};
}

// A sheet eight times as thick as the triangles' edges are long.
Cloths add_thick_sheet(voile::Solver& solver)
{
    add_mesh(solver, "icosphere", case_icosphere(8));
    voile::GridCloth grid = drape_grid(128);
    std::get<voile::Fabric>(grid.material).thickness = 0.03f;
    return {voile::engine::take(solver.add_cloth(grid))};
}

// The sheet on a box, hanging over its edges.
Cloths add_box(voile::Solver& solver)
{
    add_mesh(solver, "box", voile::engine::make_box({-0.6f, -1.2f, -0.6f}, {0.6f, 0.8f, 0.6f}));
    return {voile::engine::take(solver.add_cloth(drape_grid(128)))};
}

// The first row is pinned and moves. All other vertices have a tether to it, or a max-distance constraint.
template <bool tethers>
Cloths add_pinned_sheet(voile::Solver& solver)
{
    const voile::ClothId id = voile::engine::take(solver.add_cloth(drape_grid(128)));
    std::vector<voile::Attachment> attachments;
    for (uint32_t i = 0; i < 128 * 128; ++i)
        if (i < 128)
            attachments.push_back(voile::pin(i));
        else if (!tethers)
            attachments.push_back(voile::max_distance(i, 10));
    voile::engine::take(solver.set_attachments(id, attachments));
    if (tethers)
        voile::engine::take(solver.set_tethers(id, voile::Tethers{}));
    return {id};
}

constexpr uint32_t k_contact_frames = 42; // 0.7 s: the cloth lies on the heart, its rim still falls
constexpr uint32_t k_draped_frames = 150; // 2.5 s: most of it touches the heart or the ground

constexpr uint32_t k_sphere_frames = 90; // 1.5 s
constexpr uint32_t k_sleep_frames = 150; // 2.5 s: they have lain on the ground for half a second
constexpr uint32_t k_fallen_frames = 30; // 0.5 s: 4.9 m/s
constexpr uint32_t k_heap_frames = 90;

constexpr auto k_nearest = voile::ContactMethod::nearest_point;
// 20 m and more away from a sheet.
void add_capsules(voile::Solver& solver, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
    {
        const glm::vec3 from(20, 0, static_cast<float>(i));
        (void)voile::engine::take(
            solver.add_collider(voile::CapsuleCollider{.from = from, .to = from + glm::vec3(1, 1, 0)}));
    }
}

template <uint32_t count>
Cloths add_far_capsules(voile::Solver& solver)
{
    add_capsules(solver, count);
    return add_drape_sheet<128>(solver);
}

template <uint32_t count>
Cloths add_far_capsules_self(voile::Solver& solver)
{
    add_capsules(solver, count);
    return add_verlet_sheet<128, true>(solver);
}

constexpr float k_ground = -0.4f; // m

template <uint32_t side>
Cloths add_sheet_over_ground(voile::Solver& solver)
{
    (void)voile::engine::take(solver.add_collider(voile::PlaneCollider{.offset = k_ground}));
    return add_verlet_sheet<side, true>(solver);
}

template <uint32_t side>
std::vector<glm::vec4> upright_folds()
{
    return folds_upright_on(k_ground, side);
}

constexpr auto k_interleaved = voile::MeshLayout::interleaved;
constexpr auto k_ray = voile::ContactMethod::normal_ray;

constexpr Case k_cases[] = {
    {"reference-free", "the reference cloth, 128 x 128, falls freely", add_reference_cloth<128>},
    {"reference-contact", "the reference scene at 0.7 s: heart and ground, nearest point", add_reference_scene,
     k_nearest, k_contact_frames, true},
    {"reference-contact-normal-ray", "contact by rays along the vertex normals", add_reference_scene, k_ray,
     k_contact_frames, true},
    {"reference-draped", "the reference scene at 2.5 s: on the heart and on the ground, nearest point",
     add_reference_scene, k_nearest, k_draped_frames, true},
    {"grid-64", "the drape scene's sheet, 64 x 64, falls freely", add_drape_sheet<64>},
    {"grid-256", "256 x 256", add_drape_sheet<256>},
    {"grid-512", "512 x 512", add_drape_sheet<512>},
    {"grid-1024", "1024 x 1024", add_drape_sheet<1024>},
    {"grid-128", "128 x 128; the next cases add one feature each", add_drape_sheet<128>},
    {"verlet-128", "velocity Verlet instead of RK4", add_verlet_sheet<128, false>, k_nearest, 0, false, k_interleaved,
     0, 0, true},
    {"flat-self", "the same, which collides with itself, after a fall of 0.5 s", add_verlet_sheet<128, true>, k_nearest,
     k_fallen_frames, false, k_interleaved, 0, 0, true},
    {"verlet-512", "512 x 512 with velocity Verlet", add_verlet_sheet<512, false>, k_nearest, 0, false, k_interleaved,
     0, 0, true},
    {"flat-self-512", "the same, which collides with itself, after a fall of 0.5 s", add_verlet_sheet<512, true>,
     k_nearest, k_fallen_frames, false, k_interleaved, 0, 0, true},
    {"flat-self-mesh", "the sheet of flat-self as a mesh of triangles", add_self_mesh_sheet<128, false>, k_nearest,
     k_fallen_frames, false, k_interleaved, 0, 0, true, 12},
    {"flat-self-shuffled", "its vertices in random order", add_self_mesh_sheet<128, true>, k_nearest, k_fallen_frames,
     false, k_interleaved, 0, 0, true, 12},
    {"verlet-1024", "1024 x 1024 with velocity Verlet", add_verlet_sheet<1024, false>, k_nearest, 0, false,
     k_interleaved, 0, 0, true},
    {"isometric-128", "isometric bending instead of springs", add_changed_sheet<bend_isometrically>},
    {"air-128", "air drag", add_changed_sheet<feel_air>},
    {"gusts-128", "air drag in a wind with gusts", add_changed_sheet<feel_air>, k_nearest, 0, false, k_interleaved, 5,
     0.3f},
    {"strain-limit-128", "a strain limit of 5 %, once per frame", add_changed_sheet<limit_strain>},
    {"tethers-128", "a row of pins, a tether for every other vertex", add_pinned_sheet<true>},
    {"max-distance-128", "a row of pins, a max-distance constraint for every other vertex", add_pinned_sheet<false>},
    {"mesh-128", "the same sheet as a mesh of triangles", add_mesh_sheet<128, false, false>, k_nearest, 0, false,
     k_interleaved, 0, 0, false, 12},
    {"mesh-64", "the sheet of 64 x 64", add_mesh_sheet<64, false, false>, k_nearest, 0, false, k_interleaved, 0, 0,
     false, 12},
    {"mesh-256", "the sheet of 256 x 256", add_mesh_sheet<256, false, false>, k_nearest, 0, false, k_interleaved, 0, 0,
     false, 12},
    {"mesh-128-compact", "its lists of springs not interleaved", add_mesh_sheet<128, false, false>, k_nearest, 0, false,
     voile::MeshLayout::compact, 0, 0, false, 12},
    {"mesh-128-shuffled", "its vertices in random order", add_mesh_sheet<128, true, false>, k_nearest, 0, false,
     k_interleaved, 0, 0, false, 12},
    {"mesh-128-isometric", "isometric bending", add_mesh_sheet<128, false, true>, k_nearest, 0, false, k_interleaved, 0,
     0, false, 18},
    {"icosphere-1280", "the sheet of 128 x 128 after 1.5 s on a sphere of 1,280 triangles", add_icosphere<3>, k_nearest,
     k_sphere_frames, true, k_interleaved, 0, 0, false, 0, 3},
    {"icosphere-20480", "of 20,480", add_icosphere<5>, k_nearest, k_sphere_frames, true, k_interleaved, 0, 0, false, 0,
     5},
    {"icosphere-327680", "of 327,680", add_icosphere<7>, k_nearest, k_sphere_frames, true, k_interleaved, 0, 0, false,
     0, 7},
    {"icosphere-1310720", "of 1,310,720", add_icosphere<8>, k_nearest, k_sphere_frames, true, k_interleaved, 0, 0,
     false, 0, 8},
    {"box", "on a box of 12 triangles, with feature contact", add_box, k_nearest, k_sphere_frames, true},
    {"rough-sphere", "on a sphere of 81,920 triangles with a roughness of 4 mm, with feature contact", add_rough_sphere,
     k_nearest, k_sphere_frames, true},
    {"thick-sheet", "30 mm thick on a sphere of 1,310,720 triangles of 4 mm", add_thick_sheet, k_nearest,
     k_sphere_frames, true},
    {"capsules-1", "the drape scene's sheet falls freely, 20 m from a capsule", add_far_capsules<1>},
    {"capsules-100", "from 100", add_far_capsules<100>},
    {"capsules-1000", "from 1000", add_far_capsules<1000>},
    {"capsules-1000-self", "the sheet of flat-self, 20 m from 1000", add_far_capsules_self<1000>, k_nearest,
     k_fallen_frames, false, k_interleaved, 0, 0, true},
    {"heap-16384",
     "the sheet of 128 x 128 in folds that fell over each other, 1.5 s ago",
     add_sheet_over_ground<128>,
     k_nearest,
     k_heap_frames,
     true,
     k_interleaved,
     0,
     0,
     true,
     0,
     {},
     upright_folds<128>},
    {"heap-262144",
     "of 512 x 512",
     add_sheet_over_ground<512>,
     k_nearest,
     k_heap_frames,
     true,
     k_interleaved,
     0,
     0,
     true,
     0,
     {},
     upright_folds<512>},
    {"hundred-cloths", "100 cloths of 13 x 13 in one solver fall freely", add_hundred_cloths},
    {"one-cloth", "as many vertices in one cloth of 130 x 130", add_reference_cloth<130>},
    {"thousand-cloths", "1,024 cloths of 16 x 16 with Verlet fall freely", add_verlet_field<32, false>, k_nearest, 0,
     false, k_interleaved, 0, 0, true},
    {"one-cloth-512", "as many vertices in one cloth of 512 x 512", add_verlet_field<1, false>, k_nearest, 0, false,
     k_interleaved, 0, 0, true},
    {"thousand-on-ground", "the 1,024 cloths lie on a plane", add_verlet_field<32, true>, k_nearest, k_sphere_frames,
     true, k_interleaved, 0, 0, true},
    {"sleeping-1000",
     "they sleep there",
     add_sleeping_field,
     k_nearest,
     k_sleep_frames,
     true,
     k_interleaved,
     0,
     0,
     true,
     0,
     {},
     nullptr,
     true},
    {"one-on-ground", "the one cloth lies on it", add_verlet_field<1, true>, k_nearest, k_sphere_frames, true,
     k_interleaved, 0, 0, true},
};

} // namespace

voile::engine::Mesh case_icosphere(uint32_t subdivisions)
{
    return make_icosphere({0, 0, 0}, 0.8f, subdivisions);
}

std::span<const Case> cases()
{
    return k_cases;
}

const Case* find_case(std::string_view name)
{
    for (const Case& item : k_cases)
        if (name == item.name)
            return &item;
    return nullptr;
}

} // namespace bench
