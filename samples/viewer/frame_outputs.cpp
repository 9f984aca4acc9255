// FrameOutputs: copies while recording, files once the device is done.
#include "samples/viewer/frame_outputs.hpp"

#include "voile/engine/assets/words.hpp"
#include "voile/gpu/recorder.hpp"

#include <cmath>

namespace viewer
{
namespace
{

voile::Result<void> make_folder(const std::filesystem::path& folder)
{
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem || !std::filesystem::is_directory(folder))
        return voile::Error{"--out: " + voile::engine::path_text(folder) + ": cannot make the folder: " +
                            (problem ? problem.message() : "a file of that name is in the way")};
    // Folders can be there and still not take files.
    const auto probe = voile::engine::AtomicFile::create(folder / "frame_0000.png");
    if (!probe)
        return voile::Error{"--out: " + probe.error().message};
    return {};
}

std::filesystem::path picture_name(uint64_t frame)
{
    std::string number = std::to_string(frame);
    if (number.size() < 4)
        number.insert(0, 4 - number.size(), '0');
    return "frame_" + number + ".png";
}

} // namespace

voile::Result<FrameOutputs> FrameOutputs::create(voile::engine::App& app, const Stage& stage, const SceneFile& scene,
                                                 const Options& options)
{
    FrameOutputs outputs;
    outputs.app_ = &app;
    outputs.folder_ = options.out;
    outputs.every_ = options.every;
    outputs.film_path_ = options.video;
    outputs.solver_ = &stage.world->solver();
    if (options.out)
    {
        if (auto made = make_folder(*options.out); !made)
            return made.error();
    }
    if (options.video)
    {
        auto film =
            FilmWriter::create(*options.video, {options.width, options.height, static_cast<double>(scene.step.rate)});
        if (!film)
            return film.error();
        outputs.film_.emplace(std::move(film.value()));
    }
    if (options.out || options.video)
        outputs.pictures_.emplace(app.device(), VkExtent2D{options.width, options.height}, app.slots());
    if (options.export_file && options.export_format == ExportFormat::point_cache)
    {
        if (auto made = outputs.create_caches(app, stage, options); !made)
            return made.error();
    }
    return outputs;
}

voile::Result<void> FrameOutputs::create_caches(voile::engine::App& app, const Stage& stage, const Options& options)
{
    std::vector<std::string> names;
    for (const StageCloth& cloth : stage.cloths)
        names.push_back(cloth.name);
    const std::vector<std::filesystem::path> paths = export_paths(*options.export_file, names);
    for (size_t i = 0; i < paths.size(); ++i)
    {
        auto writer = PointCacheWriter::create(paths[i], static_cast<uint32_t>(stage.cloths[i].start.size()));
        if (!writer)
            return writer.error();
        caches_.push_back({std::move(writer.value()), paths[i], stage.cloths[i].id});
    }
    for (uint32_t slot = 0; slot < app.slots(); ++slot)
    {
        auto buffer = voile::gpu::create_buffer(app.device().context(), "positions readback",
                                                solver_->vertex_count() * sizeof(glm::vec4),
                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, voile::Memory::readback);
        if (!buffer)
            return buffer.error();
        positions_.push_back(std::move(buffer.value()));
    }
    return {};
}

bool FrameOutputs::wants_picture(const voile::engine::FrameInfo& frame) const
{
    return film_ || (folder_ && frame.index % every_ == 0);
}

void FrameOutputs::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) const
{
    if (wants_picture(frame))
        pictures_->record(cmd, app_->renderer().color(), frame.slot);
    if (caches_.empty())
        return;
    const voile::gpu::Context& context = app_->device().context();
    const voile::gpu::LabelScope scope(context, cmd, "positions readback");
    const voile::VertexStreams streams = solver_->vertices(caches_.front().cloth);
    const VkBufferCopy region{0, 0, positions_[frame.slot].size()};
    context.fn.vkCmdCopyBuffer(cmd, streams.positions, positions_[frame.slot].handle(), 1, &region);
    voile::gpu::Recorder(context, cmd)
        .barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_HOST_BIT_KHR,
                 VK_ACCESS_2_HOST_READ_BIT_KHR);
}

voile::Result<void> FrameOutputs::write(const voile::engine::FrameInfo& frame)
{
    if (wants_picture(frame))
    {
        const voile::engine::Picture picture = pictures_->picture(frame.slot);
        if (folder_ && frame.index % every_ == 0)
        {
            if (auto saved = voile::engine::save_png(*folder_ / picture_name(frame.index), picture); !saved)
                return saved;
            ++pictures_written_;
        }
        if (film_)
        {
            if (auto added = film_->add(picture.rgba); !added)
                return added;
        }
    }
    for (Cache& cache : caches_)
    {
        const voile::VertexStreams streams = solver_->vertices(cache.cloth);
        const voile::gpu::Buffer& buffer = positions_[frame.slot];
        buffer.invalidate();
        const auto* values = reinterpret_cast<const glm::vec4*>(buffer.mapped().data() + streams.offset);
        const std::vector<glm::vec3> positions(values, values + streams.vertices);
        if (auto appended = cache.writer.append(positions); !appended)
            return appended;
    }
    return {};
}

void Outcome::add(const voile::Result<void>& result, std::string what)
{
    if (result)
        written.push_back(std::move(what));
    else if (!failure)
        failure = result.error();
}

void FrameOutputs::finish(Outcome& outcome)
{
    if (folder_ && pictures_written_ > 0)
        outcome.add({}, std::to_string(pictures_written_) + " pictures in " + written_name(*folder_));
    if (film_)
        outcome.add(film_->finish(), written_name(*film_path_));
    for (Cache& cache : caches_)
        outcome.add(cache.writer.finish(), written_name(cache.path));
}

std::string written_name(const std::filesystem::path& path)
{
    constexpr size_t k_longest = 4096; // bytes: scripts may read it, and no path is longer
    return voile::engine::path_text(path, k_longest);
}

} // namespace viewer
