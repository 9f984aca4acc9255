// ClothWorld and Sheet.
#include "voile/cloth_component.hpp"

namespace voile::component
{

ClothWorld::ClothWorld(const engine::Device& device, uint32_t slots, const SolverOptions& options)
    : solver_(engine::take(Solver::create(device.context().handles,
                                          [&]
                                          {
                                              SolverOptions result = options;
                                              result.statistics_slots = slots;
                                              return result;
                                          }()))),
      uploads_(slots)
{
}

void ClothWorld::record_compute(VkCommandBuffer cmd, const engine::FrameInfo& frame)
{
    // The slot's previous frame has completed: its staging memory and the buffers that it replaced can be freed.
    uploads_[frame.slot] = Upload();
    if (solver_.needs_upload())
        uploads_[frame.slot] = engine::take(solver_.record_upload(cmd));
    if (!frame.simulates)
        return;
    step.duration = frame.time_step;
    step.time = frame.time;
    {
        const gpu::LabelScope scope(solver_.context(), cmd, "cloth", frame.timestamps);
        engine::take(solver_.record(cmd, step, frame.timestamps));
    }
    if (collect_statistics)
        engine::take(solver_.record_statistics(cmd, frame.slot, intersections, frame.timestamps));
}

Sheet::Sheet(ClothWorld& world, engine::UploadBatch& uploads, const GridCloth& grid, const engine::Surface& surface)
    : Sheet(world, uploads, engine::take(world.solver().add_cloth(grid)), surface)
{
}

Sheet::Sheet(ClothWorld& world, engine::UploadBatch& uploads, ClothId cloth, const engine::Surface& surface)
    : world_(world), cloth_(cloth), surface_(surface),
      texture_coordinates_(uploads.buffer("cloth texture coordinates", world.solver().texture_coordinates(cloth_),
                                          VK_BUFFER_USAGE_VERTEX_BUFFER_BIT))
{
    const std::vector<glm::uvec3> triangles = world.solver().triangles(cloth_);
    indices_ = uploads.buffer("cloth indices", triangles, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    index_count_ = static_cast<uint32_t>(3 * triangles.size());
}

void Sheet::record_draw(VkCommandBuffer cmd, engine::View& view)
{
    const VertexStreams streams = world_.solver().vertices(cloth_);
    engine::Drawable drawable;
    drawable.positions = streams.positions;
    drawable.position_offset = streams.offset;
    drawable.normals = streams.normals;
    drawable.normal_offset = streams.offset;
    drawable.texture_coordinates = texture_coordinates_.handle();
    drawable.indices = indices_.handle();
    drawable.index_count = index_count_;
    drawable.surface = surface_;
    drawable.label = world_.solver().name(cloth_).c_str();
    view.draw(cmd, drawable);
}

engine::Surface fabric_surface(const glm::vec3& color, const glm::vec3& back_color, float size)
{
    constexpr float k_repeats = 10;
    constexpr float k_threads_per_repeat = 36;

    engine::Surface surface;
    surface.base_color = color;
    surface.back_color = back_color;
    surface.roughness = 0.75f;
    surface.sheen = 0.35f;
    surface.two_sided = true;
    surface.pattern_scale = k_repeats / size;
    surface.weave_scale = k_repeats * k_threads_per_repeat / size;
    surface.kind = engine::Surface::Kind::fabric;
    return surface;
}

} // namespace voile::component
