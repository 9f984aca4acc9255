// The statistics file: its keys, missing values, the percentiles, the hash.
#include "samples/viewer/statistics_file.hpp"
#include "support/test_folder.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace
{

using Json = nlohmann::ordered_json;
using Keys = std::vector<std::string>;

Keys keys(const Json& object)
{
    Keys result;
    for (const auto& item : object.items())
        result.push_back(item.key());
    return result;
}

uint64_t hash(std::string_view text)
{
    viewer::StateHash state;
    state.add(std::as_bytes(std::span(text.data(), text.size())));
    return state.value();
}

viewer::Statistics measured()
{
    viewer::Statistics statistics;
    statistics.scene = "drape";
    statistics.device = "a \"device\"\nof two lines";
    statistics.driver = "1.2";
    statistics.frames = 2;
    statistics.summary.substeps_per_frame = 12;
    statistics.summary.vertices = 16384;
    statistics.summary.triangles = 32258;
    statistics.summary.last.max_stretch = 0.03;
    statistics.summary.last.penetrating_vertices = 0;
    statistics.summary.gpu_frame_ms = {1.0, 1.25};
    statistics.summary.gpu_pass_ms = {{"springs", 0.1}, {"contacts", 0.2}};
    statistics.summary.state_hash = 0x9fu;
    statistics.per_frame.resize(2);
    statistics.per_frame[1].frame = 1;
    statistics.per_frame[1].kinetic_energy = 0.5;
    return statistics;
}

} // namespace

TEST_CASE("the keys are those that scripts rely on, in their order")
{
    const Json json = Json::parse(viewer::statistics_text(measured()));
    CHECK(keys(json) == Keys{"scene", "device", "driver", "frames", "summary", "per_frame"});
    CHECK(keys(json["summary"]) == Keys{"substeps_per_frame", "vertices", "triangles", "last", "maxima", "gpu_ms",
                                        "cpu_record_ms", "state_hash"});
    const Keys measurements{"max_stretch",
                            "mean_stretch",
                            "kinetic_energy",
                            "penetrating_vertices",
                            "deepest_penetration",
                            "intersecting_cloth_pairs",
                            "intersecting_collider_pairs",
                            "uncertain_pairs",
                            "nan_vertices",
                            "contacts",
                            "candidates",
                            "contact_overflows",
                            "forced_pairs",
                            "tangled_pairs",
                            "pair_searches",
                            "sleeping_cloths"};
    CHECK(keys(json["summary"]["maxima"]) == measurements);
    Keys last = measurements;
    last.insert(last.end(), {"self_intersections", "verified"});
    CHECK(keys(json["summary"]["last"]) == last);
    CHECK(keys(json["summary"]["gpu_ms"]) == Keys{"frame", "cloth", "passes"});
    CHECK(keys(json["summary"]["gpu_ms"]["frame"]) == Keys{"median", "p95"});
    CHECK(keys(json["summary"]["gpu_ms"]["cloth"]) == Keys{"median", "p95"});
    CHECK(keys(json["summary"]["gpu_ms"]["passes"]) == Keys{"springs", "contacts"});
    CHECK(keys(json["summary"]["cpu_record_ms"]) == Keys{"median", "p95"});
    REQUIRE(json["per_frame"].size() == 2);
    CHECK(keys(json["per_frame"][0]) == Keys{"frame",
                                             "substeps",
                                             "max_stretch",
                                             "mean_stretch",
                                             "kinetic_energy",
                                             "penetrating_vertices",
                                             "deepest_penetration",
                                             "intersecting_cloth_pairs",
                                             "intersecting_collider_pairs",
                                             "uncertain_pairs",
                                             "nan_vertices",
                                             "contacts",
                                             "candidates",
                                             "contact_overflows",
                                             "forced_pairs",
                                             "tangled_pairs",
                                             "pair_searches",
                                             "sleeping_cloths",
                                             "gpu_frame_ms",
                                             "gpu_cloth_ms",
                                             "cpu_record_ms"});
}

TEST_CASE("values survive a round trip, and unmeasured ones are null")
{
    const Json json = Json::parse(viewer::statistics_text(measured()));
    CHECK(json["device"] == "a \"device\"\nof two lines");
    CHECK(json["frames"] == 2);
    const Json& summary = json["summary"];
    CHECK(summary["vertices"] == 16384);
    const Json& last = summary["last"];
    CHECK(last["max_stretch"] == 0.03);
    CHECK(last["mean_stretch"].is_null());
    CHECK(last["penetrating_vertices"] == 0);
    CHECK(last["self_intersections"].is_null());
    CHECK(last["verified"] == false);
    CHECK(summary["maxima"]["max_stretch"].is_null());
    CHECK(summary["gpu_ms"]["frame"]["p95"] == 1.25);
    CHECK(summary["gpu_ms"]["cloth"]["median"].is_null());
    CHECK(summary["gpu_ms"]["passes"]["contacts"] == 0.2);
    CHECK(summary["state_hash"] == "000000000000009f");
    CHECK(json["per_frame"][1]["frame"] == 1);
    CHECK(json["per_frame"][1]["kinetic_energy"] == 0.5);
    CHECK(json["per_frame"][1]["gpu_frame_ms"].is_null());
}

TEST_CASE("the text is JSON for any value")
{
    viewer::Statistics statistics = measured();
    statistics.device = "not UTF-8: \xff\xfe";
    statistics.summary.last.kinetic_energy = std::numeric_limits<double>::infinity();
    statistics.summary.last.max_stretch = std::nan("");
    const Json json = Json::parse(viewer::statistics_text(statistics));
    CHECK(json["summary"]["last"]["kinetic_energy"].is_null());
    CHECK(json["summary"]["last"]["max_stretch"].is_null());
    const Json empty = Json::parse(viewer::statistics_text({}));
    CHECK(empty["per_frame"] == Json::array());
    CHECK(empty["summary"]["gpu_ms"]["passes"] == Json::object());
}

TEST_CASE("maxima are taken value by value, and leave out what was not measured")
{
    viewer::Measurements a;
    a.max_stretch = 0.5;
    a.contacts = 3;
    a.intersections.cloth = 0;
    viewer::Measurements b;
    b.max_stretch = 0.25;
    b.mean_stretch = 0.1;
    b.contacts = 7;
    b.nan_vertices = 0;
    for (const viewer::Measurements& both : {viewer::larger_of(a, b), viewer::larger_of(b, a)})
    {
        CHECK(both.max_stretch == 0.5);
        CHECK(both.mean_stretch == 0.1);
        CHECK(std::isnan(both.kinetic_energy));
        CHECK(both.contacts == 7u);
        CHECK(both.nan_vertices == 0u);
        CHECK(both.intersections.cloth == 0u);
        CHECK_FALSE(both.intersections.collider.has_value());
    }
}

TEST_CASE("percentiles of known data are right")
{
    std::vector<double> hundred;
    for (int i = 100; i >= 1; --i)
        hundred.push_back(i);
    CHECK(viewer::median(hundred) == 50.5);
    CHECK(viewer::p95(hundred) == 95);
    CHECK(viewer::median(std::vector<double>{3, 1, 2}) == 2);
    CHECK(viewer::p95(std::vector<double>{3, 1, 2}) == 3);
    CHECK(viewer::median(std::vector<double>{7}) == 7);
    CHECK(viewer::p95(std::vector<double>{7}) == 7);
    hundred.resize(20); // 100 down to 81
    CHECK(viewer::p95(hundred) == 99);
    hundred.push_back(std::nan(""));
    hundred.push_back(std::numeric_limits<double>::infinity());
    CHECK(viewer::median(hundred) == 90.5);
    const viewer::Percentiles both = viewer::percentiles(hundred);
    CHECK(both.median == 90.5);
    CHECK(both.p95 == 99);
    CHECK(std::isnan(viewer::median({})));
    CHECK(std::isnan(viewer::p95(std::vector<double>{std::nan("")})));
}

// From the authors' test suite, draft-eastlake-fnv, 64-bit FNV-1a.
TEST_CASE("the state's hash is FNV-1a")
{
    CHECK(hash("") == 0xcbf29ce484222325u);
    CHECK(hash("a") == 0xaf63dc4c8601ec8cu);
    CHECK(hash("b") == 0xaf63df4c8601f1a5u);
    CHECK(hash("foo") == 0xdcb27518fed9d577u);
    CHECK(hash("foobar") == 0x85944171f73967e8u);
    CHECK(viewer::hash_text(hash("a")) == "af63dc4c8601ec8c");
    CHECK(viewer::hash_text(0) == "0000000000000000");

    viewer::StateHash whole;
    const std::vector<glm::vec3> values = {{1, 2, 3}, {4, 5, 6}};
    whole.add(values);
    viewer::StateHash halves;
    halves.add(std::span(values).first(1));
    halves.add(std::span(values).last(1));
    CHECK(halves.value() == whole.value());
    const auto one = [](float x)
    {
        viewer::StateHash state;
        const glm::vec3 value{x, 0, 0};
        state.add(std::span(&value, 1));
        return state.value();
    };
    CHECK(one(0.f) != one(-0.f));
}

TEST_CASE("the file is written whole or not at all")
{
    const TestFolder folder;
    REQUIRE(viewer::save_statistics(folder / "s.json", measured()));
    CHECK(folder.read("s.json") == viewer::statistics_text(measured()));
    CHECK(folder.entries() == 1);
    const auto failed = viewer::save_statistics(folder / "missing" / "s.json", measured());
    REQUIRE_FALSE(failed);
    CHECK(failed.error().message.starts_with((folder / "missing" / "s.json").string() + ": cannot be written: "));
    CHECK(folder.entries() == 1);
}
