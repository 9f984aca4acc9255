// The samples run without a display, report progress, and their results are right.
#include "support/sample_run.hpp"
#include "support/test_folder.hpp"

#include "voile/engine/assets/image_file.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace
{

constexpr std::array<const char*, 6> k_samples = {"hello_cloth", "own_component", "skinned",
                                                  "batch",       "async_compute", "foreign_engine"};

// The part of a picture's pixels that satisfies a condition.
template <typename Is>
double fraction_of(const std::filesystem::path& path, const Is& is)
{
    const auto picture = voile::engine::load_png(path);
    REQUIRE_MESSAGE(picture, picture.error().message);
    size_t count = 0;
    for (size_t i = 0; i < picture.value().rgba.size(); i += 4)
        count += is(&picture.value().rgba[i]) ? 1 : 0;
    return static_cast<double>(count) / (static_cast<double>(picture.value().rgba.size()) / 4);
}

// The height that the end of a heavy elastica loses, as a fraction of its length: theta'' = -gamma (1 - s) cos(theta),
// theta(0) = 0, theta'(1) = 0 (Bickley 1934, "The heavy elastica"), by shooting with steps of the midpoint rule.
double cantilever_drop(double gamma)
{
    constexpr int k_steps = 2000;
    const auto shoot = [&](double curvature, double& drop)
    {
        double theta = 0;
        drop = 0;
        for (int i = 0; i < k_steps; ++i)
        {
            const double h = 1.0 / k_steps;
            const double s = i * h;
            const double middle = theta + h / 2 * curvature;
            drop += h * std::sin(middle);
            theta += h * (curvature - h / 2 * gamma * (1 - s) * std::cos(theta));
            curvature -= h * gamma * (1 - s - h / 2) * std::cos(middle);
        }
        return curvature;
    };
    double low = 0;
    double high = gamma / 2; // a straight beam's
    double drop = 0;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = (low + high) / 2;
        (shoot(middle, drop) > 0 ? high : low) = middle;
    }
    return drop;
}

} // namespace

TEST_CASE("the shooting method gives the known drops of a heavy elastica")
{
    CHECK(cantilever_drop(1) == doctest::Approx(0.1235).epsilon(1e-3));
    CHECK(cantilever_drop(5) == doctest::Approx(0.4959).epsilon(1e-3));
}

TEST_CASE("samples refuse arguments that are none of theirs")
{
    struct Case
    {
        const char* arguments;
        const char* reason;
    };
    const std::vector<Case> headless = {
        {"--headles", "unknown argument '--headles'"},
        {"a b c", "unknown argument 'a'"},
        {"0", "unknown argument '0'"},
        {"--headless abc", "FRAMES: 'abc' is not a whole number from 1 to 1000000"},
        {"--headless 0", "FRAMES: '0' is not a whole number from 1 to 1000000"},
        {"--headless -1", "FRAMES: '-1' is not a whole number from 1 to 1000000"},
        {"--headless 9x", "FRAMES: '9x' is not a whole number from 1 to 1000000"},
        {"--headless 1000001", "FRAMES: '1000001' is not a whole number from 1 to 1000000"},
        {"--headless 9 8", "unknown argument '8'"}};
    const std::vector<Case> none = {{"--bogus", "unknown argument '--bogus'"}, {"a b c", "unknown argument 'a'"}};
    const std::vector<Case> file = {{"--bogus", "unknown argument '--bogus'"}, {"a.ply b", "unknown argument 'b'"}};
    const TestFolder folder;
    for (const auto& sample :
         {std::pair{"hello_cloth", headless}, std::pair{"own_component", headless}, std::pair{"skinned", headless},
          std::pair{"batch", none}, std::pair{"async_compute", none}, std::pair{"foreign_engine", file}})
        for (const Case& of : sample.second)
        {
            const char* name = sample.first;
            CAPTURE(name);
            CAPTURE(of.arguments);
            const SampleRun run = run_sample(folder, name, of.arguments);
            CHECK(run.status == 1);
            CHECK(run.output.empty());
            REQUIRE(run.errors.size() >= 2);
            CHECK(run.errors[0].text == std::string(name) + ": " + of.reason);
            CHECK(run.errors[1].text.starts_with("usage: " + std::string(name)));
        }
    CHECK(folder.entries() == 1); // output.txt
}

TEST_CASE("samples print their usage")
{
    const TestFolder folder;
    for (const char* name : k_samples)
    {
        CAPTURE(name);
        const SampleRun run = run_sample(folder, name, "--help");
        CHECK(run.status == 0);
        CHECK(run.errors.empty());
        CHECK(run.output.starts_with("usage: " + std::string(name)));
    }
    CHECK(folder.entries() == 1); // output.txt
}

TEST_CASE("samples say that they prepare before they look for a device")
{
    const TestFolder folder;
    for (const char* name : k_samples)
    {
        CAPTURE(name);
        const bool headless = std::string(name) != "batch" && std::string(name) != "async_compute" &&
                              std::string(name) != "foreign_engine";
        const SampleRun run = run_sample(folder, name, headless ? "--headless" : "",
                                         "VK_DRIVER_FILES=/none.json VK_ICD_FILENAMES=/none.json");
        CHECK(run.status == 1);
        REQUIRE(run.errors.size() >= 2);
        CHECK(run.errors[0].text.starts_with("preparing"));
        CHECK(run.errors.back().text.starts_with(std::string(name) + ": "));
    }
}

TEST_CASE("samples report a picture that they cannot write before they simulate")
{
    for (const char* name : {"hello_cloth", "own_component", "skinned"})
    {
        CAPTURE(name);
        const TestFolder folder;
        std::filesystem::create_directory(folder / (std::string(name) + ".png"));
        const SampleRun run = run_sample(folder, name, "--headless 2");
        CHECK(run.status == 1);
        REQUIRE(run.errors.size() == 2); // no frame
        CHECK(run.errors[1].text.find(std::string(name) + ".png: cannot be written: ") != std::string::npos);
    }
}

TEST_CASE("foreign_engine reports an output that it cannot write before it simulates")
{
    const TestFolder folder;
    const SampleRun run = run_sample(folder, "foreign_engine", "missing/sheet.ply");
    CHECK(run.status == 1);
    CHECK(run.output.empty());
    REQUIRE(run.errors.size() == 1);
    CHECK(run.errors[0].text == "foreign_engine: cannot write missing/sheet.ply");
}

TEST_CASE("own_component swings a ball through a curtain")
{
    const TestFolder folder;
    const SampleRun run = run_sample(folder, "own_component", "--headless 45");
    check_progress(run);
    const std::string& output = run.output;
    CHECK(output.find("wrote own_component.png\n") != std::string::npos);
    REQUIRE(output.find("at most") != std::string::npos);
    unsigned contacts = 0;
    REQUIRE(std::sscanf(output.substr(output.find("at most")).c_str(), "at most %u", &contacts) == 1);
    CHECK(contacts > 20); // measured: 71
    // The ball is the only yellow thing, the curtain the only saturated blue one.
    CHECK(fraction_of(folder / "own_component.png", [](const uint8_t* p) { return 2 * p[0] > 3 * p[2]; }) > 0.003);
    CHECK(fraction_of(folder / "own_component.png", [](const uint8_t* p) { return p[2] > 2 * p[0]; }) > 0.01);
}

TEST_CASE("skinned puts a sleeve on an arm that bends")
{
    const TestFolder folder;
    const SampleRun run = run_sample(folder, "skinned", "--headless 25");
    check_progress(run);
    const std::string& output = run.output;
    CHECK(output.find("wrote skinned.png\n") != std::string::npos);
    REQUIRE(output.find(" vertices touch") != std::string::npos);
    unsigned contacts = 0;
    unsigned inside = 1;
    REQUIRE(std::sscanf(output.substr(output.find(" vertices touch") - 3).c_str(),
                        "%u vertices touch the arm, %u are inside", &contacts, &inside) == 2);
    CHECK(contacts > 30); // measured: 49
    CHECK(inside == 0);
    CHECK(fraction_of(folder / "skinned.png", [](const uint8_t* p) { return p[1] > p[0] + 10 && p[1] > p[2]; }) > 0.02);
}

TEST_CASE("batch measures bending stiffness as the cantilever test does")
{
    const TestFolder folder;
    const SampleRun run = run_sample(folder, "batch", "");
    check_progress(run);
    std::istringstream output(run.output);
    std::string line;
    REQUIRE(std::getline(output, line));
    CHECK(line == "fabric,bending,drop");
    constexpr double k_length = 0.125; // m
    int stiff = 0;
    while (std::getline(output, line))
    {
        char name[16] = {};
        double bending = 0;
        double drop = 0;
        REQUIRE(std::sscanf(line.c_str(), "%15[a-z],%lf,%lf", name, &bending, &drop) == 3);
        if (bending < 64)
            continue; // limp strips come to rest later
        const std::string fabric = name;
        const voile::Fabric preset = fabric == "silk"     ? voile::silk()
                                     : fabric == "cotton" ? voile::cotton()
                                     : fabric == "wool"   ? voile::wool()
                                     : fabric == "denim"  ? voile::denim()
                                                          : voile::leather();
        const double gamma = static_cast<double>(preset.areal_density) * 9.81 * k_length * k_length * k_length /
                             (bending * static_cast<double>(preset.bending_stiffness));
        CAPTURE(line);
        CHECK(drop == doctest::Approx(cantilever_drop(gamma)).epsilon(0.04));
        ++stiff;
    }
    CHECK(stiff == 5);
}
