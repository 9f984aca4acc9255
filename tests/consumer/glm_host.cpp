// A sheet falls on a turning box, and a file takes its positions. Compiled with several settings of GLM, which must not
// matter: the host's own matrices may be aligned, its quaternions ordered otherwise, its functions left-handed.
#include "falling_sheet.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <fstream>

namespace
{

// Functions of GLM in double and float, as the module may use them too: a linker keeps one of each name.
glm::mat4 turned(float angle)
{
    const glm::dmat3 exact(glm::dmat4(glm::rotate(glm::mat4(1), angle, glm::vec3(0, 1, 0))));
    const glm::dquat rotation = glm::normalize(glm::quat_cast(exact));
    return glm::mat4(glm::dmat4(glm::mat4_cast(glm::slerp(rotation, rotation, 0.5))));
}

template <typename T>
T take(voile::Result<T> result)
{
    if (!result)
    {
        std::fprintf(stderr, "%s\n", result.error().message.c_str());
        std::exit(1);
    }
    return std::move(result).value();
}

} // namespace

int main(int, char** argv)
{
    foreign::Engine engine;
    voile::Upload upload; // outlives the solver, whose allocator it keeps
    voile::Solver solver = take(voile::Solver::create(handles_of(engine), {}));
    voile::GridCloth grid{.columns = 12, .rows = 12, .material = voile::cotton()};
    grid.transform = glm::translate(glm::mat4(1), glm::vec3(0, 0.52f, 0)); // the host's own type
    grid.velocity = glm::vec3(0, -0.5f, 0);
    const voile::ClothId sheet = take(solver.add_cloth(grid));
    const voile::ColliderId box = take(solver.add_collider(voile::BoxCollider{}));
    // A mesh: arrays have the module's layout.
    const std::vector<voile::Vec3> positions{{-2, 0.3f, -2}, {2, 0.3f, -2}, {2, 0.3f, 2}, {-2, 0.3f, 2}};
    const std::vector<voile::UVec3> triangles{{0, 2, 1}, {0, 3, 2}};
    take(solver.add_collider(voile::MeshCollider{.positions = positions, .triangles = triangles}));
    for (int frame = 0; frame < 6; ++frame)
    {
        const VkCommandBuffer cmd = engine.begin_frame();
        if (solver.needs_upload())
            upload = take(solver.record_upload(cmd));
        if (const auto moved = solver.move_collider(box, turned(0.3f + 0.1f * static_cast<float>(frame))); !moved)
            return std::fprintf(stderr, "%s\n", moved.error().message.c_str()), 1;
        if (const auto recorded = solver.record(cmd, {.duration = 1.f / 60, .gravity = glm::vec3(0, -9.81f, 0)});
            !recorded)
            return std::fprintf(stderr, "%s\n", recorded.error().message.c_str()), 1;
        engine.submit_frame();
    }
    engine.wait_idle();
    const voile::VertexStreams streams = solver.vertices(sheet);
    const std::vector<float> state = engine.read(streams.positions, streams.offset, size_t{4} * streams.vertices);
    std::ofstream(argv[1], std::ios::binary)
        .write(reinterpret_cast<const char*>(state.data()), static_cast<std::streamsize>(state.size() * sizeof(float)));
    std::printf("%zu bytes per vec3, %zu per voile::Vec3; y of the middle %g\n", sizeof(glm::vec3), sizeof(voile::Vec3),
                static_cast<double>(state[4 * 66 + 1]));
    return 0;
}
