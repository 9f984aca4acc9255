#include "samples/viewer/film.hpp"

#include "samples/viewer/child_process.hpp"

#include "voile/engine/assets/words.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

voile::Error film_error(const fs::path& path, const std::string& reason)
{
    return voile::Error{voile::engine::path_text(path) + ": no film: " + reason};
}

std::vector<std::string> encoder_arguments(const FilmSettings& settings, const fs::path& file)
{
    std::ostringstream rate;
    rate.imbue(std::locale::classic());
    rate << settings.rate;
    const std::string size = std::to_string(settings.width) + "x" + std::to_string(settings.height);
    // 4:2:0 needs even sides. Players take films of this kind for BT.709: so they are converted to it, and say it.
    const std::string filter = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
    return {settings.program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
            // What comes in:
            "-f", "rawvideo", "-pixel_format", "rgba", "-video_size", size, "-framerate", rate.str(), "-i", "pipe:0",
            // What goes out. "file:" keeps a name with a colon from being read as a protocol:
            "-an", "-vf", filter, "-c:v", "libx264", "-preset", "medium", "-crf", "18", "-colorspace", "bt709",
            "-color_primaries", "bt709", "-color_trc", "bt709", "-movflags", "+faststart", "-f", "mp4",
            "file:" + file.string()};
}

void close_descriptor(int& descriptor)
{
    if (descriptor >= 0)
        (void)::close(std::exchange(descriptor, -1));
}

// The first thing that it said is the cause, the rest is what follows from it.
std::string first_line(std::FILE* file)
{
    std::array<char, 512> line{};
    std::rewind(file);
    if (std::fgets(line.data(), static_cast<int>(line.size()), file) == nullptr)
        return {};
    std::string text = line.data();
    text.resize(text.find_last_not_of(" \r\n") + 1);
    return text;
}

} // namespace

voile::Result<FilmWriter> FilmWriter::create(const fs::path& path, const FilmSettings& settings)
{
    if (settings.width == 0 || settings.height == 0)
        return film_error(path, "a picture without pixels");
    if (!std::isfinite(settings.rate) || settings.rate <= 0)
        return film_error(path, "the frame rate is not positive");
    const voile::Result<fs::path> target = voile::engine::resolve_target(path);
    if (!target)
        return target.error();

    FilmWriter film;
    film.path_ = path;
    film.target_ = target.value();
    film.frame_bytes_ = size_t{4} * settings.width * settings.height;
    film.messages_ = std::tmpfile();
    if (film.messages_ == nullptr)
        return film_error(path, std::string("no temporary file: ") + std::strerror(errno));
    // The encoder gets it as its standard error alone.
    (void)::fcntl(::fileno(film.messages_), F_SETFD, FD_CLOEXEC);

    // A socket and not a pipe: sending can leave out SIGPIPE by the call, a pipe only for the whole process.
    std::array<int, 2> ends{-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return film_error(path, std::string("no socket: ") + std::strerror(errno));
    film.socket_ = ends[0];
    film.temporary_ = voile::engine::TemporaryFile(film.target_);
    const int problem = start_program(encoder_arguments(settings, film.temporary_.path()),
                                      {.input = ends[1], .errors = ::fileno(film.messages_)}, film.encoder_);
    close_descriptor(ends[1]);
    if (problem == 0)
    {
        film.encoder_cleanup_ = std::make_unique<voile::engine::Cleanup>(
            [encoder = film.encoder_]
            {
                (void)::kill(-encoder, SIGKILL);
                (void)::waitpid(encoder, nullptr, 0); // it makes no file any more
            });
        return film;
    }
    film.encoder_ = -1;
    if (is_missing(problem, settings.program))
        return film_error(path, settings.program + " is not installed (or not in PATH)");
    return film_error(path, settings.program + " cannot be started: " + std::strerror(problem));
}

FilmWriter::~FilmWriter()
{
    discard();
}

FilmWriter::FilmWriter(FilmWriter&& other) noexcept
    : path_(std::move(other.path_)), target_(std::move(other.target_)), temporary_(std::move(other.temporary_)),
      frame_bytes_(other.frame_bytes_), frames_(other.frames_), encoder_(std::exchange(other.encoder_, -1)),
      encoder_cleanup_(std::move(other.encoder_cleanup_)), socket_(std::exchange(other.socket_, -1)),
      messages_(std::exchange(other.messages_, nullptr))
{
}

int FilmWriter::wait_for_encoder()
{
    close_descriptor(socket_);
    const int status = wait_for_program(std::exchange(encoder_, -1));
    encoder_cleanup_.reset();
    return status;
}

void FilmWriter::discard() noexcept
{
    if (encoder_ > 0)
        (void)::kill(-encoder_, SIGKILL); // its group: it may be a script that started others
    (void)wait_for_encoder();
    if (messages_ != nullptr)
        (void)std::fclose(std::exchange(messages_, nullptr));
    temporary_.remove();
}

voile::Error FilmWriter::encoder_error()
{
    const std::string said = messages_ != nullptr ? first_line(messages_) : "";
    const voile::Error error = film_error(path_, said.empty() ? "the encoder left early" : "the encoder says: " + said);
    discard();
    return error;
}

voile::Result<void> FilmWriter::add(std::span<const uint8_t> rgba)
{
    if (socket_ < 0)
        return film_error(path_, "the film was ended already");
    if (rgba.size() != frame_bytes_)
        return film_error(path_, "a frame of " + std::to_string(rgba.size()) + " bytes instead of " +
                                     std::to_string(frame_bytes_));
    while (!rgba.empty())
    {
        const ssize_t sent = ::send(socket_, rgba.data(), rgba.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent < 0)
        {
            (void)wait_for_encoder(); // so that all of its words are there
            return encoder_error();
        }
        rgba = rgba.subspan(static_cast<size_t>(sent));
    }
    ++frames_;
    return {};
}

voile::Result<void> FilmWriter::finish()
{
    if (socket_ < 0)
        return film_error(path_, "the film was ended already");
    if (frames_ == 0)
    {
        discard();
        return film_error(path_, "there are no frames");
    }
    const int status = wait_for_encoder();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return encoder_error();
    voile::Result<void> completed = temporary_.complete(target_);
    discard();
    return completed;
}

} // namespace viewer
