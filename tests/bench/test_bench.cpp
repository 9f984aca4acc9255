// Files of the benchmark's results: reading, comparing, plotting.
#include "frame_plot.hpp"
#include "peers.hpp"
#include "results_file.hpp"

#include "support/test_folder.hpp"
#include "support/test_paths.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

namespace
{

const std::string k_header = "device,driver,case,substeps_per_frame,gpu_us_per_substep_median,gpu_us_per_substep_p95,"
                             "record_us_per_frame_median\n";

std::vector<bench::CaseResult> read(const TestFolder& folder, const std::string& rows)
{
    const auto results = bench::read_results(folder.write("r.csv", k_header + rows));
    REQUIRE(results);
    return results.value();
}

std::string error_of(const TestFolder& folder, const std::string& text)
{
    const auto path = folder.write("bad.csv", text);
    const auto results = bench::read_results(path);
    REQUIRE(!results);
    const std::string& message = results.error().message;
    REQUIRE(message.starts_with(path.string() + ":"));
    return message.substr(path.string().size() + 1);
}

bench::CaseResult result(const std::string& name, double median, double p95, double substeps = 1)
{
    return {"a GPU", name, substeps, median, p95, {}};
}

// The cases of the plot, with frames of 1 to 6 ms.
std::vector<bench::CaseResult> drape_results()
{
    std::vector<bench::CaseResult> results;
    for (const char* name : {"drape-128-verlet", "drape-128-self", "drape-256-verlet", "drape-256-self",
                             "drape-512-verlet", "drape-512-self"})
        results.push_back(result(name, 10 * static_cast<double>(results.size() + 1), 100, 100));
    return results;
}

size_t count(const std::string& text, const std::string& part)
{
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

} // namespace

TEST_CASE("results are read with quoted devices, and the last row of a case counts")
{
    const TestFolder folder;
    const auto results = read(folder, "\"llvmpipe (LLVM 15, \"\"256\"\" bits)\",x,fall,8,10.5,12,7.25\n"
                                      "GPU,x,refit,1,2,3,\r\n\n"
                                      "GPU,x,fall,50,4,5,6\n");
    REQUIRE(results.size() == 2);
    CHECK(results[0].name == "fall");
    CHECK(results[0].device == "GPU");
    CHECK(results[0].substeps == 50);
    CHECK(results[0].median == 4);
    CHECK(results[0].p95 == 5);
    CHECK(results[0].record == 6);
    CHECK(results[0].frame() == 0.2);
    CHECK(results[0].noise() == 0.25);
    CHECK(results[1].name == "refit");
    CHECK(!results[1].record);
    CHECK(read(folder, "\"llvmpipe (LLVM 15, \"\"256\"\" bits)\",x,fall,8,10.5,12,7.25\n")[0].device ==
          "llvmpipe (LLVM 15, \"256\" bits)");
}

TEST_CASE("a file of results that is missing or broken is an error with its line")
{
    const TestFolder folder;
    const auto missing = bench::read_results(folder / "none.csv");
    REQUIRE(!missing);
    CHECK(missing.error().message == (folder / "none.csv").string() + ": cannot be read, or is empty");
    CHECK(error_of(folder, "") == " cannot be read, or is empty");
    CHECK(error_of(folder, "device,case\n") == "1: no column substeps_per_frame");
    CHECK(error_of(folder, k_header + "GPU,x,fall,8,1,1\n") == "2: 6 fields instead of 7");
    CHECK(error_of(folder, k_header + "GPU,x,fall,8,1,1,1\nGPU,x,fall,8,,1,1\n") == "3: case fall has no times");
    CHECK(error_of(folder, k_header + "GPU,x,fall,8,0,1,1\n") == "2: case fall has no times");
    CHECK(error_of(folder, k_header + "GPU,x,fall,8,1us,1,1\n") == "2: case fall has no times");
    CHECK(error_of(folder, k_header + "\"GPU,x,fall,8,1,1,1\n") == "2: a quote is not closed");
}

TEST_CASE("two files are compared by exact ratios, with the cases of one alone")
{
    const auto comparisons = bench::compare({result("gone", 1, 1), result("fall", 8, 8), result("drape", 400, 400)},
                                            {result("drape", 300, 300), result("fall", 8, 8), result("new", 2, 2)});
    REQUIRE(comparisons.size() == 4);
    CHECK(comparisons[0].name == "gone");
    CHECK(!comparisons[0].b);
    CHECK(comparisons[1].ratio() == 1);
    CHECK(comparisons[2].name == "drape");
    CHECK(comparisons[2].ratio() == 0.75);
    CHECK(comparisons[3].name == "new");
    CHECK(!comparisons[3].a);
    const std::string table = bench::comparison_table(comparisons);
    CHECK(table == "A  a GPU\nB  a GPU\n\n"
                   "case, us per substep                    A          B      B / A  beyond noise\n"
                   "gone                                 1.00          -          -  in A alone\n"
                   "fall                                 8.00       8.00          1\n"
                   "drape                                 400        300       0.75  faster\n"
                   "new                                     -       2.00          -  in B alone\n");
    CHECK(bench::comparison_table(bench::compare({}, {})).find("no case") != std::string::npos);
}

TEST_CASE("a change counts if it is larger than both measurements vary")
{
    const auto counts = [](const bench::CaseResult& a, const bench::CaseResult& b)
    { return bench::compare({a}, {b})[0].is_beyond_noise(); };
    CHECK(counts(result("c", 10, 10.4), result("c", 11, 11)));
    CHECK(!counts(result("c", 10, 11.1), result("c", 11, 11)));
    CHECK(!counts(result("c", 10, 10), result("c", 11, 12.2)));
    CHECK(counts(result("c", 11, 11), result("c", 10, 10))); // the other way around
    CHECK(!counts(result("c", 1000, 1000), result("c", 1009, 1009)));
    CHECK(counts(result("c", 1000, 1000), result("c", 1011, 1011)));
}

TEST_CASE("the plot has a bar for each solver that did not fail, and a goal for each of Voile's")
{
    auto results = drape_results();
    const auto svg = bench::plot_frames(results);
    REQUIRE(svg);
    size_t measured = 0;
    size_t failed = 0;
    for (const bench::Peer& peer : bench::peers())
        for (const double frame : peer.frames)
            ++(frame > 0 ? measured : failed);
    CHECK(measured == 16);
    CHECK(failed == 2);
    CHECK(count(svg.value(), "<rect") == 1 + measured + 6 + 6); // the background first
    CHECK(count(svg.value(), ">failed<") == failed);
    for (const char* time : {">1 ms<", ">2 ms<", ">3 ms<", ">4 ms<", ">5 ms<", ">6 ms<"})
        CHECK(count(svg.value(), time) == 1);
    CHECK(svg.value().find("on a GPU") != std::string::npos);
    CHECK(count(svg.value(), "<text") == count(svg.value(), "</text>"));
    CHECK(svg.value().ends_with("</svg>\n"));

    results.pop_back();
    const auto incomplete = bench::plot_frames(results);
    REQUIRE(!incomplete);
    CHECK(incomplete.error().message == "the plot needs case drape-512-self");
}

TEST_CASE("docs/frames.svg shows the results of bench/results (VOILE_WRITE_DOCS=1 writes it)")
{
    const auto results = bench::read_results(tests::source("bench/results/nvidia-h200.csv"));
    REQUIRE(results);
    const auto svg = bench::plot_frames(results.value());
    REQUIRE(svg);
    const auto path = tests::source("docs/frames.svg");
    if (std::getenv("VOILE_WRITE_DOCS") != nullptr)
        std::ofstream(path, std::ios::binary) << svg.value();
    std::ifstream file(path, std::ios::binary);
    CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == svg.value());
}

TEST_CASE("the report of peers has a row for each, and how they were measured")
{
    const std::string report = bench::peer_report();
    CHECK(report.find("Newton, explicit mass-spring                          3.2        6.5       69.0\n") !=
          std::string::npos);
    CHECK(report.find("Newton, VBD, with self-collision                     54.0      314.0     failed\n") !=
          std::string::npos);
    CHECK(report.find("How they were taken") != std::string::npos);
}
