// Films: five small frames through the encoder and back, and every way in which it can go wrong.
#include "samples/viewer/film.hpp"
#include "support/test_folder.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <sys/wait.h>
#include <utility>
#include <vector>

namespace
{

namespace fs = std::filesystem;

bool installed(const std::string& program)
{
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const std::string& command)
{
    std::string text;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 256> block{};
    while (std::fgets(block.data(), static_cast<int>(block.size()), pipe) != nullptr)
        text += block.data();
    CHECK(::pclose(pipe) == 0);
    return text;
}

std::string probe(const std::string& entries, const fs::path& film)
{
    return output_of("ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=" + entries +
                     " -of csv=p=0 '" + film.string() + "'");
}

std::vector<uint8_t> frame(uint32_t width, uint32_t height, uint8_t red)
{
    std::vector<uint8_t> pixels(size_t{4} * width * height, 255);
    for (size_t i = 0; i < pixels.size(); i += 4)
    {
        pixels[i] = red;
        pixels[i + 1] = 20;
        pixels[i + 2] = 40;
    }
    return pixels;
}

// A program that replaces the encoder.
std::string stand_in(const TestFolder& folder, const std::string& script)
{
    folder.write("encoder", "#!/bin/sh\n" + script + "\n");
    fs::permissions(folder / "encoder", fs::perms::owner_all);
    return (folder / "encoder").string();
}

// ctest counts a case with this message as skipped (tests/CMakeLists.txt).
bool lacks_ffmpeg()
{
    if (installed("ffmpeg") && installed("ffprobe"))
        return false;
    MESSAGE("skipped: ffmpeg is not installed");
    return true;
}

bool no_children_left()
{
    return ::waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD;
}

} // namespace

TEST_CASE("five frames become a film of five frames of the right size")
{
    if (lacks_ffmpeg())
        return;
    const TestFolder folder;
    const fs::path path = folder / "a film: $(touch x); 'quoted.mp4";
    auto film = viewer::FilmWriter::create(path, {64, 48, 30});
    REQUIRE_MESSAGE(film, film.error().message);
    for (uint8_t i = 0; i < 5; ++i)
        REQUIRE(film.value().add(frame(64, 48, static_cast<uint8_t>(40 * i))));
    CHECK_FALSE(fs::exists(path)); // it is not complete
    const auto finished = film.value().finish();
    REQUIRE_MESSAGE(finished, finished.error().message);
    CHECK(folder.entries() == 1);
    CHECK(no_children_left());
    fs::rename(path, folder / "film.mp4");
    CHECK(probe("codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames", folder / "film.mp4") ==
          "h264,64,48,yuv420p,30/1,5\n");
    CHECK_FALSE(film.value().add(frame(64, 48, 0)));
    CHECK_FALSE(film.value().finish());
}

TEST_CASE("an odd size is padded to an even one")
{
    if (lacks_ffmpeg())
        return;
    const TestFolder folder;
    auto film = viewer::FilmWriter::create(folder / "odd.mp4", {33, 17, 60});
    REQUIRE(film);
    REQUIRE(film.value().add(frame(33, 17, 200)));
    REQUIRE(film.value().finish());
    CHECK(probe("width,height,nb_read_frames", folder / "odd.mp4") == "34,18,1\n");
}

TEST_CASE("an encoder that is missing or cannot be started gives one clear line")
{
    const TestFolder folder;
    const std::string path = (folder / "a.mp4").string();
    const auto missing = viewer::FilmWriter::create(path, {8, 8, 60, "no_such_encoder"});
    REQUIRE_FALSE(missing);
    CHECK(missing.error().message == path + ": no film: no_such_encoder is not installed (or not in PATH)");
    const auto denied = viewer::FilmWriter::create(path, {8, 8, 60, folder.path().string()});
    REQUIRE_FALSE(denied);
    CHECK(denied.error().message ==
          path + ": no film: " + folder.path().string() + " cannot be started: Permission denied");
    CHECK(folder.entries() == 0);
    CHECK(no_children_left());
}

TEST_CASE("a bad size, rate, folder or frame is refused, and nothing is left behind")
{
    const TestFolder folder;
    const std::string path = (folder / "a.mp4").string();
    const std::string program = "cat"; // any that is there
    const auto refused = [&](const std::string& file, viewer::FilmSettings settings)
    {
        settings.program = program;
        const auto film = viewer::FilmWriter::create(file, settings);
        return film ? "accepted" : film.error().message;
    };
    CHECK(refused(path, {0, 8, 60}) == path + ": no film: a picture without pixels");
    CHECK(refused(path, {8, 8, 0}) == path + ": no film: the frame rate is not positive");
    const std::string lost = (folder / "missing" / "a.mp4").string();
    CHECK(refused(lost, {8, 8, 60}) ==
          lost + ": cannot be written: there is no folder " + (folder / "missing").string());
    CHECK(refused(folder.path().string(), {8, 8, 60}) ==
          folder.path().string() + ": cannot be written: it is a folder");
    {
        auto film = viewer::FilmWriter::create(path, {8, 8, 60, stand_in(folder, "cat >/dev/null")});
        REQUIRE(film);
        const auto wrong = film.value().add(std::vector<uint8_t>(8));
        REQUIRE_FALSE(wrong);
        CHECK(wrong.error().message == path + ": no film: a frame of 8 bytes instead of 256");
        const auto none = film.value().finish();
        REQUIRE_FALSE(none);
        CHECK(none.error().message == path + ": no film: there are no frames");
    }
    fs::remove(folder / "encoder");
    CHECK(folder.entries() == 0);
    CHECK(no_children_left());
}

TEST_CASE("an encoder that exits early is an error with its message, not the end of the program")
{
    const TestFolder folder;
    const std::string path = (folder / "a.mp4").string();
    // Its last argument is the file: half a film, which must not stay.
    const std::string script = "for file; do :; done; echo half >\"${file#file:}\"; echo 'disk full' >&2; "
                               "echo 'and so on' >&2; exit 1";
    auto film = viewer::FilmWriter::create(path, {512, 512, 60, stand_in(folder, script)});
    REQUIRE(film);
    voile::Result<void> added;
    for (int i = 0; i < 100 && added; ++i)
        added = film.value().add(frame(512, 512, 0));
    REQUIRE_FALSE(added);
    CHECK(added.error().message == path + ": no film: the encoder says: disk full");
    CHECK_FALSE(film.value().finish());
    CHECK(no_children_left());
    fs::remove(folder / "encoder");
    CHECK(folder.entries() == 0);
}

TEST_CASE("an encoder that fails silently at the end leaves no film")
{
    const TestFolder folder;
    const std::string path = (folder / "a.mp4").string();
    const std::string script = "for file; do :; done; cat >\"${file#file:}\"; exit 3";
    auto film = viewer::FilmWriter::create(path, {8, 8, 60, stand_in(folder, script)});
    REQUIRE(film);
    REQUIRE(film.value().add(frame(8, 8, 0)));
    const auto finished = film.value().finish();
    REQUIRE_FALSE(finished);
    CHECK(finished.error().message == path + ": no film: the encoder left early");
    CHECK(no_children_left());
    fs::remove(folder / "encoder");
    CHECK(folder.entries() == 0);
}

TEST_CASE("a canceled film stops its encoder and leaves nothing behind")
{
    const TestFolder folder;
    const std::string script = "for file; do :; done; cat >\"${file#file:}\"; :";
    const std::string program = stand_in(folder, script);
    {
        auto film = viewer::FilmWriter::create(folder / "a.mp4", {8, 8, 60, program});
        REQUIRE(film);
        REQUIRE(film.value().add(frame(8, 8, 0)));
        viewer::FilmWriter moved = std::move(film.value());
        REQUIRE(moved.add(frame(8, 8, 0)));
    }
    CHECK(no_children_left());
    fs::remove(folder / "encoder");
    CHECK(folder.entries() == 0);
}
