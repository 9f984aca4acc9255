// Many cloths in one solver, to compare materials: strips of every preset, each with three bending stiffnesses, stand
// off a table by 12.5 cm. All of them share the same dispatches, so fifteen cost about what one of the same size costs.
// Prints a table: how far the free end drops, as a fraction of the strip's length. Standards for fabrics measure
// bending stiffness this way (the cantilever test of Peirce 1930).
#include "engine.hpp"
#include "take.hpp"

#include "samples/arguments.hpp"
#include "samples/progress.hpp"

#include <voile/cloth.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace
{

constexpr uint32_t k_columns = 14; // vertices along the strip
constexpr uint32_t k_rows = 4;
constexpr uint32_t k_clamped = 2;  // columns that the table holds
constexpr float k_spacing = 0.01f; // m, between vertices
constexpr float k_distance = 0.1f; // m, between strips; they do not touch
constexpr int k_frames = 150;      // of 1/60 s

struct Variant
{
    const char* fabric;
    float bending; // times the preset's
    voile::ClothId cloth;
};

voile::GridCloth strip(voile::Fabric fabric, float bending, glm::vec3 at)
{
    fabric.bending_stiffness *= bending;
    fabric.bending_model = voile::BendingModel::isometric; // which follows a cantilever
    voile::GridCloth grid{.columns = k_columns, .rows = k_rows, .material = fabric};
    grid.width = k_spacing * (k_columns - 1);
    grid.depth = k_spacing * (k_rows - 1);
    grid.integrator = voile::Integrator::verlet;
    grid.transform[3] = glm::vec4(at, 1);
    for (uint32_t row = 0; row < k_rows; ++row)
        for (uint32_t column = 0; column < k_clamped; ++column)
            grid.pins.push_back(row * k_columns + column);
    return grid;
}

std::vector<Variant> add_variants(voile::Solver& solver)
{
    const std::array<std::pair<const char*, voile::Fabric>, 5> fabrics = {{{"silk", voile::silk()},
                                                                           {"cotton", voile::cotton()},
                                                                           {"wool", voile::wool()},
                                                                           {"denim", voile::denim()},
                                                                           {"leather", voile::leather()}}};
    std::vector<Variant> variants;
    for (const auto& [name, fabric] : fabrics)
        for (const float bending : {1.f, 8.f, 64.f})
        {
            const glm::vec3 at(0, 0, k_distance * static_cast<float>(variants.size()));
            variants.push_back({name, bending, take(solver.add_cloth(strip(fabric, bending, at)))});
        }
    return variants;
}

// The strip starts flat at a height of 0. Its clamp ends halfway between the last clamped column and the one before:
// the last one bends for half a spacing on each side.
double drop(const std::vector<float>& positions)
{
    double height = 0;
    for (uint32_t row = 0; row < k_rows; ++row)
        height += static_cast<double>(positions[4 * (row * k_columns + k_columns - 1) + 1]) / k_rows;
    return -height / (static_cast<double>(k_spacing) * (k_columns - k_clamped + 0.5));
}

void run()
{
    samples::Progress progress(k_frames);
    foreign::Engine engine;
    voile::Solver solver = take(voile::Solver::create({.instance = engine.instance(),
                                                       .physical_device = engine.physical_device(),
                                                       .device = engine.device(),
                                                       .get_instance_proc_addr = engine.get_instance_proc_addr()},
                                                      {}));
    const std::vector<Variant> variants = add_variants(solver);
    voile::Upload upload;
    const foreign::IdleGuard idle(engine);
    for (int frame = 0; frame < k_frames; ++frame)
    {
        const VkCommandBuffer cmd = engine.begin_frame();
        if (solver.needs_upload())
            upload = take(solver.record_upload(cmd));
        // Dense air brings the strips to rest sooner. It has no effect at rest.
        take(solver.record(cmd, {.duration = 1.f / 60, .air_density = 20}));
        engine.submit_frame();
        progress.update(static_cast<uint64_t>(frame) + 1);
    }
    engine.wait_idle();
    std::printf("fabric,bending,drop\n");
    for (const Variant& variant : variants)
    {
        const voile::VertexStreams vertices = solver.vertices(variant.cloth);
        std::printf("%s,%g,%.3f\n", variant.fabric, static_cast<double>(variant.bending),
                    drop(engine.read(vertices.positions, vertices.offset, size_t{4} * vertices.vertices)));
    }
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        if (samples::parse_no_arguments("batch", argc, argv))
            run();
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "batch: %s\n", error.what());
        return 1;
    }
}
