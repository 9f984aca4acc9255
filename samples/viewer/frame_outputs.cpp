// FrameOutputs: copies while recording, files once the device is done.
#include "samples/viewer/frame_outputs.hpp"

#include "voile/engine/assets/words.hpp"

namespace viewer
{
namespace
{

std::filesystem::path picture_name(uint64_t frame)
{
    std::string number = std::to_string(frame);
    if (number.size() < 4)
        number.insert(0, 4 - number.size(), '0');
    return "frame_" + number + ".png";
}

} // namespace

voile::Result<void> make_picture_folder(const std::filesystem::path& folder)
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

voile::Result<FrameOutputs> FrameOutputs::create(voile::engine::App& app, double rate, const Options& options)
{
    FrameOutputs outputs;
    outputs.app_ = &app;
    outputs.folder_ = options.out;
    outputs.every_ = options.every;
    outputs.film_path_ = options.video;
    outputs.png_.resize(app.slots());
    if (options.video)
    {
        auto film = FilmWriter::create(*options.video, {options.width, options.height, rate});
        if (!film)
            return film.error();
        outputs.film_.emplace(std::move(film.value()));
    }
    if (options.out || options.video)
        outputs.pictures_.emplace(app.device(), VkExtent2D{options.width, options.height}, app.slots());
    return outputs;
}

bool FrameOutputs::wants_png(const voile::engine::FrameInfo& frame) const
{
    return folder_ && (frame.index % every_ == 0 || next_is_last_);
}

bool FrameOutputs::wants_picture(const voile::engine::FrameInfo& frame) const
{
    return film_ || wants_png(frame);
}

void FrameOutputs::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame)
{
    png_[frame.slot] = wants_png(frame);
    if (wants_picture(frame))
        pictures_->record(cmd, app_->renderer().color(), frame.slot);
}

voile::Result<void> FrameOutputs::save(uint64_t frame, const voile::engine::Picture& picture)
{
    if (auto saved = voile::engine::save_png(*folder_ / picture_name(frame), picture); !saved)
        return saved;
    ++pictures_written_;
    last_saved_ = true;
    return {};
}

voile::Result<void> FrameOutputs::write(const voile::engine::FrameInfo& frame)
{
    last_ = frame.index;
    last_saved_ = false;
    if (png_[frame.slot])
        if (auto saved = save(frame.index, pictures_->picture(frame.slot)); !saved)
            return saved;
    return film_ ? film_->add(pictures_->picture(frame.slot).rgba) : voile::Result<void>();
}

// The renderer still has the picture of the last frame that it drew, and in a window it draws every frame.
voile::Result<void> FrameOutputs::save_last()
{
    voile::engine::FrameRing ring(app_->device(), 1);
    const voile::engine::FrameRing::Frame frame = ring.begin();
    pictures_->record(frame.cmd, app_->renderer().color(), 0);
    ring.submit(frame);
    ring.wait_all();
    return save(*last_, pictures_->picture(0));
}

void FrameOutputs::finish(Outcome& outcome)
{
    voile::Result<void> saved;
    if (folder_ && last_ && !last_saved_ && app_->has_window())
        saved = save_last();
    if (folder_ && (pictures_written_ > 0 || !saved))
        outcome.add(saved, std::to_string(pictures_written_) +
                               (pictures_written_ == 1 ? " picture in " : " pictures in ") + written_name(*folder_));
    if (film_)
        outcome.add(film_->finish(), written_name(*film_path_));
}

} // namespace viewer
