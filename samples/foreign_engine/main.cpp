// A sheet of cotton falls on a ball, in an engine that is not Voile's. Writes sheet.ply, or the file named.
#include "engine.hpp"

#include <voile/cloth.hpp>

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace
{

// Nothing is thrown by the module: a Result holds a value or the reason why there is none.
template <typename T>
T take(voile::Result<T> result)
{
    if (!result)
        throw std::runtime_error(result.error().message);
    if constexpr (!std::is_void_v<T>)
        return std::move(result).value();
}

// Positions are vec4 per vertex; the fourth number is the inverse mass. The host owns the triangles.
void write_ply(std::ostream& file, const std::vector<float>& positions, const std::vector<voile::UVec3>& triangles)
{
    file << "ply\nformat ascii 1.0\nelement vertex " << positions.size() / 4
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << triangles.size()
         << "\nproperty list uchar uint vertex_indices\nend_header\n";
    for (size_t i = 0; i < positions.size(); i += 4)
        file << positions[i] << ' ' << positions[i + 1] << ' ' << positions[i + 2] << '\n';
    for (const voile::UVec3& triangle : triangles)
        file << "3 " << triangle.x << ' ' << triangle.y << ' ' << triangle.z << '\n';
}

void run(const std::string& path)
{
    std::ofstream file(path); // before the simulation: a wrong path is reported at once
    if (!file)
        throw std::runtime_error("cannot write " + path);
    std::fprintf(stderr, "preparing: compiling pipelines may take seconds\n");
    foreign::Engine engine;
    // The module borrows these handles: they outlive the solver, its uploads and its snapshots.
    voile::Solver solver = take(voile::Solver::create({.instance = engine.instance(),
                                                       .physical_device = engine.physical_device(),
                                                       .device = engine.device(),
                                                       .get_instance_proc_addr = engine.get_instance_proc_addr()},
                                                      {.statistics_slots = foreign::Engine::k_slots}));

    voile::GridCloth grid{.columns = 25, .rows = 25, .material = voile::cotton()};
    grid.integrator = voile::Integrator::verlet;
    grid.transform[3] = {0, 0.8f, 0, 1};
    const voile::ClothId sheet = take(solver.add_cloth(grid)); // copied and checked; the GPU does nothing yet
    take(solver.add_collider(voile::SphereCollider{.center = {0, 0.4f, 0}, .radius = 0.3f}));
    take(solver.add_collider(voile::PlaneCollider{}));
    // Staging memory and replaced buffers, one per frame in flight: each lives until its frame has completed.
    std::array<voile::Upload, foreign::Engine::k_slots> uploads;
    const foreign::IdleGuard idle(engine); // nothing above is destroyed while the GPU uses it, also after an error
    for (int frame = 0; frame < 50; ++frame)
    {
        const VkCommandBuffer cmd = engine.begin_frame(); // the frame that used this slot has completed
        uploads[engine.slot()] = {};
        if (solver.needs_upload())
            uploads[engine.slot()] = take(solver.record_upload(cmd));
        take(solver.record(cmd, {.duration = 1.f / 60}));
        take(solver.record_statistics(cmd, engine.slot()));
        engine.submit_frame(); // before this an engine draws from solver.vertices(sheet): no barrier, no copy
    }
    engine.wait_idle();
    const voile::Statistics statistics = solver.statistics(engine.slot());
    std::printf("%u vertices touch, %u are inside\n", statistics.contacts, statistics.penetrating_vertices);
    if (statistics.contacts == 0 || statistics.nan_vertices > 0)
        throw std::runtime_error("the sheet is not on the ball");
    const voile::VertexStreams vertices = solver.vertices(sheet);
    write_ply(file, engine.read(vertices.positions, vertices.offset, size_t{4} * vertices.vertices),
              solver.triangles(sheet));
    if (!file.flush())
        throw std::runtime_error("cannot write " + path);
    std::printf("wrote %s\n", path.c_str());
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        const std::string last = argc > 1 ? argv[argc - 1] : "sheet.ply";
        if (last == "--help")
            return std::puts("usage: foreign_engine [FILE]") < 0 ? 1 : 0;
        if (argc > 2 || last.starts_with('-'))
            throw std::runtime_error("unknown argument '" + last + "'\nusage: foreign_engine [FILE]");
        run(last);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "foreign_engine: %s\n", error.what());
        return 1;
    }
}
