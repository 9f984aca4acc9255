// AnimationExports: copies while recording, samples once the device is done.
#include "samples/viewer/animation_exports.hpp"

#include "samples/viewer/exports.hpp"

#include "voile/gpu/recorder.hpp"

namespace viewer
{

voile::Result<AnimationExports> AnimationExports::create(voile::engine::App& app, const Stage& stage,
                                                         const ExportScene& scene, const SceneFile& file,
                                                         const Options& options)
{
    AnimationExports exports(app, stage, scene);
    const size_t objects = options.export_colliders ? scene.objects().size() : stage.cloths.size();
    for (const ExportTarget& target : options.exports)
    {
        voile::Result<void> added;
        if (target.format == ExportFormat::point_cache)
            added = exports.add_caches(target.path, objects, static_cast<double>(file.step.rate));
        else if (target.format == ExportFormat::usd)
            added = exports.add_animation(target.path, file);
        if (!added)
            return added.error();
    }
    if (!exports.caches_.empty() || !exports.animations_.empty())
        if (auto made = exports.add_readback(); !made)
            return made.error();
    return exports;
}

voile::Result<void> AnimationExports::add_caches(const std::filesystem::path& path, size_t objects, double rate)
{
    std::vector<std::string> names;
    for (size_t i = 0; i < objects; ++i)
        names.push_back(scene_->objects()[i].surface.name);
    const std::vector<std::filesystem::path> paths = export_paths(path, names);
    for (size_t i = 0; i < objects; ++i)
    {
        const ExportObject& object = scene_->objects()[i];
        if (object.motion == SurfaceMotion::still)
            continue;
        const std::vector<glm::vec3>& start = object.surface.positions;
        auto writer = PointCacheWriter::create(paths[i], {.points = static_cast<uint32_t>(start.size()), .rate = rate});
        if (!writer)
            return writer.error();
        if (auto appended = writer.value().append(start); !appended)
            return appended;
        caches_.push_back({std::move(writer.value()), paths[i], i});
    }
    return {};
}

voile::Result<void> AnimationExports::add_animation(const std::filesystem::path& path, const SceneFile& file)
{
    std::vector<UsdMesh> meshes;
    for (const ExportObject& object : scene_->objects())
        meshes.push_back({object.surface, object.motion, !object.solid});
    auto writer = UsdWriter::create(path, {file.name, static_cast<double>(file.step.rate)}, std::move(meshes));
    if (!writer)
        return writer.error();
    animations_.push_back({std::move(writer.value()), path});
    return {};
}

voile::Result<void> AnimationExports::add_readback()
{
    for (uint32_t slot = 0; slot < app_->slots(); ++slot)
    {
        auto buffer = voile::gpu::create_buffer(app_->device().context(), "positions readback",
                                                stage_->world->solver().vertex_count() * sizeof(glm::vec4),
                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, voile::Memory::readback);
        if (!buffer)
            return buffer.error();
        readback_.push_back(std::move(buffer.value()));
    }
    return {};
}

void AnimationExports::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) const
{
    if (readback_.empty())
        return;
    const voile::gpu::Context& context = app_->device().context();
    const voile::gpu::LabelScope scope(context, cmd, "positions readback");
    const voile::VertexStreams streams = stage_->world->solver().vertices(stage_->cloths.front().id);
    const VkBufferCopy region{0, 0, readback_[frame.slot].size()};
    context.fn.vkCmdCopyBuffer(cmd, streams.positions, readback_[frame.slot].handle(), 1, &region);
    voile::gpu::Recorder(context, cmd)
        .barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_HOST_BIT_KHR,
                 VK_ACCESS_2_HOST_READ_BIT_KHR);
}

std::vector<glm::vec3> AnimationExports::positions(size_t object, const voile::engine::FrameInfo& frame,
                                                   double seconds) const
{
    if (object >= stage_->cloths.size())
        return scene_->positions(scene_->objects()[object], seconds);
    const voile::VertexStreams streams = stage_->world->solver().vertices(stage_->cloths[object].id);
    const auto* values = reinterpret_cast<const glm::vec4*>(readback_[frame.slot].mapped().data() + streams.offset);
    return {values, values + streams.vertices};
}

voile::Result<void> AnimationExports::append(size_t object, const std::vector<glm::vec3>& positions,
                                             const glm::mat4& pose)
{
    for (Cache& cache : caches_)
        if (cache.object == object)
            if (auto appended = cache.writer.append(positions); !appended)
                return appended;
    for (Animation& animation : animations_)
    {
        if (scene_->objects()[object].motion == SurfaceMotion::rigid)
            animation.writer.append(object, pose);
        else if (auto appended = animation.writer.append(object, positions); !appended)
            return appended;
    }
    return {};
}

voile::Result<void> AnimationExports::write(const voile::engine::FrameInfo& frame)
{
    if (readback_.empty())
        return {};
    readback_[frame.slot].invalidate();
    const double seconds = frame.time + static_cast<double>(frame.time_step);
    for (size_t i = 0; i < scene_->objects().size(); ++i)
    {
        const ExportObject& object = scene_->objects()[i];
        if (object.motion == SurfaceMotion::still)
            continue;
        const glm::mat4 pose = object.solid ? scene_->pose(object, seconds) : glm::mat4(1);
        if (auto appended = append(i, positions(i, frame, seconds), pose); !appended)
            return appended;
    }
    return {};
}

void AnimationExports::finish(Outcome& outcome)
{
    for (Cache& cache : caches_)
        outcome.add(cache.writer.finish(), written_name(cache.path));
    for (Animation& animation : animations_)
        outcome.add(animation.writer.finish(), written_name(animation.path));
}

} // namespace viewer
