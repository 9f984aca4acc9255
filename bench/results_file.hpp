// Reading the CSV files that cloth_bench writes (report.hpp), and comparing two of them.
#pragma once

#include "voile/result.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bench
{

// One case of one device.
struct CaseResult
{
    std::string device;
    std::string name;
    double substeps = 0;          // per frame
    double median = 0;            // us per substep
    double p95 = 0;               // us per substep
    std::optional<double> record; // us per frame of the host; none where it was not measured

    [[nodiscard]] double frame() const { return median * substeps / 1000; } // ms
    // The fraction by which the measurement varies from one repetition to another.
    [[nodiscard]] double noise() const { return p95 / median - 1; }
};

// The cases of a file in their order. Of a case that is in it more than once, the last row counts. Errors: the file
// cannot be read, lacks a column, or a line has other fields than its columns or no times; with the line's number.
voile::Result<std::vector<CaseResult>> read_results(const std::filesystem::path& path);

// A case in two files; one is missing where it is in one file alone.
struct Comparison
{
    std::string name;
    std::optional<CaseResult> a;
    std::optional<CaseResult> b;

    [[nodiscard]] double ratio() const { return b->median / a->median; } // if both are there
    // Whether the ratio differs from 1 by more than both measurements vary, and by more than 1 %.
    [[nodiscard]] bool is_beyond_noise() const;
};

// The cases of `a` in their order, then those of `b` alone.
std::vector<Comparison> compare(const std::vector<CaseResult>& a, const std::vector<CaseResult>& b);

// The table that --compare prints, with the devices in its first lines.
std::string comparison_table(const std::vector<Comparison>& comparisons);

} // namespace bench
