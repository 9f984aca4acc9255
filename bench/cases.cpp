// Cases: the reference scene, sheets of the drape scene's fabric, and many cloths against one.
#include "cases.hpp"

#include "heart.hpp"

#include "engine/gpu/device.hpp"

#include <string>

namespace bench
{

namespace
{

using Cloths = std::vector<cloth::ClothId>;

constexpr float k_reference_spacing = 0.08f; // m

// The reference scene's cloth: flat at y = 4.8, its first corner at x, z.
cloth::Grid reference_grid(uint32_t side, float x, float z)
{
    const float size = k_reference_spacing * static_cast<float>(side - 1);
    cloth::Grid grid;
    grid.columns = side;
    grid.rows = side;
    grid.width = size;
    grid.depth = size;
    grid.transform[3] = {x + size / 2, 4.8f, z + size / 2, 1};
    grid.material = cloth::reference_material();
    return grid;
}

template <uint32_t side>
Cloths add_reference_cloth(cloth::Solver& solver)
{
    return {engine::take(solver.add_cloth(reference_grid(side, 0, 0)))};
}

void add_mesh(cloth::Solver& solver, const char* name, const engine::Mesh& mesh)
{
    cloth::MeshCollider collider;
    collider.name = name;
    collider.positions = mesh.positions;
    collider.triangles = mesh.triangles;
    collider.friction = cloth::Friction{0.4f, 0.4f};
    (void)engine::take(solver.add_collider(collider));
}

Cloths add_reference_scene(cloth::Solver& solver)
{
    add_mesh(solver, "heart", scenes::make_reference_heart());
    add_mesh(solver, "ground", scenes::make_ground());
    return add_reference_cloth<128>(solver);
}

// A 10 x 10 field, a spacing apart.
Cloths add_hundred_cloths(cloth::Solver& solver)
{
    constexpr uint32_t k_along = 10;
    constexpr uint32_t k_side = 13;
    Cloths cloths;
    for (uint32_t row = 0; row < k_along; ++row)
        for (uint32_t column = 0; column < k_along; ++column)
        {
            const float pitch = k_reference_spacing * k_side;
            cloth::Grid grid =
                reference_grid(k_side, pitch * static_cast<float>(column), pitch * static_cast<float>(row));
            grid.name = "cloth " + std::to_string(cloths.size());
            cloths.push_back(engine::take(solver.add_cloth(grid)));
        }
    return cloths;
}

// The drape scene's sheet: 2.4 m square, no air.
template <uint32_t side>
Cloths add_drape_sheet(cloth::Solver& solver)
{
    constexpr float k_size = 2.4f;
    cloth::Fabric fabric;
    fabric.areal_density = 0.3f;
    fabric.stretch_stiffness = {1000, 1000};
    fabric.shear_stiffness = 333;
    fabric.bending_stiffness = 2e-5f;
    fabric.thickness = 0.005f;
    fabric.static_friction = 0.4f;
    fabric.kinetic_friction = 0.4f;
    fabric.air_drag_normal = 0;
    fabric.air_drag_tangential = 0;

    cloth::Grid grid;
    grid.columns = side;
    grid.rows = side;
    grid.width = k_size;
    grid.depth = k_size;
    grid.transform[3] = {0, 0.85f, 0, 1};
    grid.material = fabric;
    return {engine::take(solver.add_cloth(grid))};
}

constexpr uint32_t k_contact_frames = 42; // 0.7 s: the cloth lies on the heart, its rim still falls
constexpr uint32_t k_draped_frames = 150; // 2.5 s: most of it touches the heart or the ground

constexpr auto k_nearest = cloth::ContactMethod::nearest_point;
constexpr auto k_ray = cloth::ContactMethod::normal_ray;

constexpr Case k_cases[] = {
    {"reference-free", "the reference cloth, 128 x 128, falls freely", add_reference_cloth<128>},
    {"reference-contact", "the reference scene at 0.7 s: heart and ground, nearest point", add_reference_scene,
     k_nearest, k_contact_frames, true},
    {"reference-contact-normal-ray", "the same with rays along the vertex normals", add_reference_scene, k_ray,
     k_contact_frames, true},
    {"reference-draped", "the reference scene at 2.5 s: on the heart and on the ground, nearest point",
     add_reference_scene, k_nearest, k_draped_frames, true},
    {"grid-64", "the drape scene's sheet, 64 x 64, falls freely", add_drape_sheet<64>},
    {"grid-256", "256 x 256", add_drape_sheet<256>},
    {"grid-512", "512 x 512", add_drape_sheet<512>},
    {"grid-1024", "1024 x 1024", add_drape_sheet<1024>},
    {"hundred-cloths", "100 cloths of 13 x 13 in one solver fall freely", add_hundred_cloths},
    {"one-cloth", "as many vertices in one cloth of 130 x 130", add_reference_cloth<130>},
};

} // namespace

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
