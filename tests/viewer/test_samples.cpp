// The samples run without a display, report progress, and their results are right.
#include "support/test_folder.hpp"
#include "support/test_paths.hpp"

#include "voile/engine/assets/image_file.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace
{

// What a sample prints.
std::string output_of(const char* name, const char* arguments, const TestFolder& folder)
{
    const std::string command =
        "cd " + folder.path().string() + " && '" + tests::program(name).string() + "' " + arguments + " > output.txt";
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream file(folder / "output.txt");
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

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
    const TestFolder folder;
    for (const char* name : {"own_component", "skinned"})
        for (const char* arguments : {"--headles", "--headless abc", "--headless 0", "--headless 9x", "--headless 9 9"})
        {
            CAPTURE(arguments);
            const std::string command = "cd " + folder.path().string() + " && '" + tests::program(name).string() +
                                        "' " + arguments + " 2> errors.txt";
            CHECK(std::system(command.c_str()) != 0);
            std::ifstream file(folder / "errors.txt");
            std::string line;
            std::getline(file, line);
            CHECK(line.find(std::string(name) + ": ") == 0);
            CHECK(line.find(arguments == std::string("--headless abc") ? "'abc'" : "") != std::string::npos);
        }
}

TEST_CASE("own_component swings a ball through a curtain")
{
    const TestFolder folder;
    const std::string output = output_of("own_component", "--headless 45", folder);
    CHECK(output.find("frame  10 of 45") != std::string::npos);
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
    const std::string output = output_of("skinned", "--headless 30", folder);
    unsigned contacts = 0;
    unsigned inside = 1;
    REQUIRE(std::sscanf(output.substr(output.find(" vertices touch") - 3).c_str(),
                        "%u vertices touch the arm, %u are inside", &contacts, &inside) == 2);
    CHECK(contacts > 30); // measured: 102
    CHECK(inside == 0);
    CHECK(fraction_of(folder / "skinned.png", [](const uint8_t* p) { return p[1] > p[0] + 10 && p[1] > p[2]; }) > 0.02);
}

TEST_CASE("batch measures bending stiffness as the cantilever test does")
{
    const TestFolder folder;
    std::istringstream output(output_of("batch", "2>/dev/null", folder));
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
