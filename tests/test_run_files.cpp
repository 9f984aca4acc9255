// The statistics file and the film.
#include "test_folder.hpp"

#include "samples/viewer/film.hpp"
#include "samples/viewer/json_tree.hpp"
#include "samples/viewer/statistics_file.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

TEST_CASE("statistics have the keys that scripts read")
{
    viewer::Statistics statistics;
    statistics.device = "a \"quoted\" card";
    statistics.frames = 1;
    statistics.summary.vertices = 16;
    statistics.summary.max_stretch = 0.25;
    statistics.summary.state_hash = 0x9f;
    statistics.summary.gpu_pass_ms = {{"cloth contact", 0.5}};
    statistics.per_frame.emplace_back().substeps = 12;
    const auto json = viewer::parse_json(viewer::statistics_text(statistics), "s.json");
    REQUIRE(json);
    const viewer::JsonNode& root = json.value();
    for (const char* key : {"device", "driver", "frames", "summary", "per_frame"})
        CHECK(root.find(key) != nullptr);
    CHECK(root.find("device")->text == statistics.device);
    const viewer::JsonNode& summary = *root.find("summary");
    for (const char* key : {"substeps_per_frame", "vertices", "triangles", "max_stretch", "mean_stretch",
                            "kinetic_energy", "penetrating_vertices", "deepest_penetration", "self_intersections",
                            "nan_vertices", "contact_overflows", "gpu_ms", "cpu_record_ms", "state_hash"})
    {
        CAPTURE(key);
        CHECK(summary.find(key) != nullptr);
    }
    CHECK(summary.find("max_stretch")->number == 0.25);
    CHECK(summary.find("state_hash")->text == "000000000000009f");
    CHECK(summary.find("kinetic_energy")->kind == viewer::JsonNode::Kind::null); // not measured
    const viewer::JsonNode& gpu = *summary.find("gpu_ms");
    CHECK(gpu.find("frame")->find("median") != nullptr);
    CHECK(gpu.find("cloth")->find("p95") != nullptr);
    CHECK(gpu.find("passes")->find("cloth contact")->number == 0.5);
    CHECK(root.find("per_frame")->items.front().find("frame")->number == 0);
}

TEST_CASE("medians and percentiles of known values")
{
    const std::vector<double> values{5, 1, 4, 2, 3};
    CHECK(viewer::median(values) == 3);
    CHECK(viewer::median(std::vector<double>{4, 1, 2, 3}) == 2.5);
    std::vector<double> hundred;
    for (int i = 100; i > 0; --i)
        hundred.push_back(i);
    CHECK(viewer::p95(hundred) == 95);
    CHECK(viewer::p95(std::vector<double>{7}) == 7);
    CHECK(std::isnan(viewer::median({})));
    CHECK(viewer::median(std::vector<double>{1, viewer::k_not_measured, 3}) == 2);
}

TEST_CASE("the state hash is FNV-1a")
{
    // The published vectors of the 64-bit variant.
    const auto hash = [](const std::string& text)
    {
        viewer::StateHash result;
        result.add(std::as_bytes(std::span(text.data(), text.size())));
        return result.value();
    };
    CHECK(hash("") == 0xcbf29ce484222325u);
    CHECK(hash("a") == 0xaf63dc4c8601ec8cu);
    CHECK(hash("foobar") == 0x85944171f73967e8u);
}

TEST_CASE("a film has the frames that were added")
{
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0 || std::system("ffprobe -version >/dev/null 2>&1") != 0)
        return;
    const TestFolder folder;
    auto film = viewer::FilmWriter::create(folder / "f.mp4", {.width = 63, .height = 32, .rate = 30});
    REQUIRE_MESSAGE(film, film.error().message);
    for (int i = 0; i < 5; ++i)
        REQUIRE(film.value().add(std::vector<uint8_t>(63 * 32 * 4, static_cast<uint8_t>(50 * i))));
    CHECK_FALSE(film.value().add(std::vector<uint8_t>(10)));
    REQUIRE(film.value().finish());
    const std::string listing = (folder / "listing").string();
    const std::string probe = "ffprobe -v error -count_frames -select_streams v -show_entries "
                              "stream=width,height,nb_read_frames -of csv=p=0 " +
                              (folder / "f.mp4").string() + " >" + listing;
    REQUIRE(std::system(probe.c_str()) == 0);
    std::string text;
    std::ifstream(listing) >> text;
    CHECK(text == "64,32,5"); // an odd side is padded
}

TEST_CASE("a film that cannot be made is refused in one line, and an unfinished one leaves nothing")
{
    const TestFolder folder;
    const auto no_program =
        viewer::FilmWriter::create(folder / "f.mp4", {.width = 64, .height = 32, .program = "no-such-encoder"});
    REQUIRE_FALSE(no_program);
    CHECK(no_program.error().message.find("no-such-encoder") != std::string::npos);
    CHECK(no_program.error().message.find('\n') == std::string::npos);
    CHECK_FALSE(viewer::FilmWriter::create(folder / "f.mp4", {.width = 0, .height = 32}));
    CHECK_FALSE(viewer::FilmWriter::create(folder / "nowhere/f.mp4", {.width = 64, .height = 32}));
    if (std::system("ffmpeg -version >/dev/null 2>&1") == 0)
    {
        auto film = viewer::FilmWriter::create(folder / "f.mp4", {.width = 64, .height = 32});
        REQUIRE(film);
        REQUIRE(film.value().add(std::vector<uint8_t>(64 * 32 * 4)));
    }
    CHECK(folder.is_empty());
}
