// FrameOutputs: copies while recording, files once the device is done.
#include "samples/viewer/frame_outputs.hpp"

#include "voile/engine/assets/words.hpp"

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

voile::Result<FrameOutputs> FrameOutputs::create(voile::engine::App& app, double rate, const Options& options)
{
    FrameOutputs outputs;
    outputs.app_ = &app;
    outputs.folder_ = options.out;
    outputs.every_ = options.every;
    outputs.film_path_ = options.video;
    if (options.out)
    {
        if (auto made = make_folder(*options.out); !made)
            return made.error();
    }
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

bool FrameOutputs::wants_picture(const voile::engine::FrameInfo& frame) const
{
    return film_ || (folder_ && frame.index % every_ == 0);
}

void FrameOutputs::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) const
{
    if (wants_picture(frame))
        pictures_->record(cmd, app_->renderer().color(), frame.slot);
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
    return {};
}

void FrameOutputs::finish(Outcome& outcome)
{
    if (folder_ && pictures_written_ > 0)
        outcome.add({}, std::to_string(pictures_written_) + " pictures in " + written_name(*folder_));
    if (film_)
        outcome.add(film_->finish(), written_name(*film_path_));
}

} // namespace viewer
