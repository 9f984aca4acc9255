// The cases of the report. Each runs at one of two resolutions and returns its results with the exact values.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace physics
{

enum class Detail
{
    coarse,
    fine,
};

// The target of a quantity, one value for the coarse resolution and one for the fine.
struct Target
{
    double coarse = 0;
    double fine = 0;

    [[nodiscard]] double at(Detail detail) const { return detail == Detail::fine ? fine : coarse; }
};

// One number. A band has a lowest and a highest value instead of an exact one.
struct Measurement
{
    std::string quantity;
    std::string resolution;
    double value = 0;
    double exact = 0;
    // |value / exact - 1|, or |value - exact| if the exact value is 0. At most five times the measured error (for a
    // group of similar quantities: the largest).
    double target = 0;
    double low = 0;
    double high = 0;   // of a band; 0: no band
    double change = 0; // largest difference between both resolutions; 0: not checked
    bool known = true; // false: there is no reference value

    [[nodiscard]] bool band() const { return high > 0; }
    [[nodiscard]] double error() const
    {
        if (!known)
            return 0;
        if (band())
            return value < low ? low - value : value > high ? value - high : 0;
        return exact == 0 ? std::abs(value) : std::abs(value / exact - 1);
    }
    [[nodiscard]] bool good() const { return std::isfinite(value) && error() <= target; }
};

struct Curve
{
    std::string name;
    std::vector<double> x;
    std::vector<double> y;
    bool points = false; // dots instead of a line
};

struct Plot
{
    std::string file; // without extension
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<Curve> curves;
    bool logarithmic = false; // both axes
    bool even = false;        // the same scale on both axes
};

struct CaseResult
{
    std::vector<Measurement> measurements;
    std::vector<Plot> plots;
    std::string remark;
};

struct Case
{
    const char* name;
    const char* setup; // one sentence
    CaseResult (*run)(Detail detail);
};

// In the order of the report.
const std::vector<Case>& all_cases();

// integration.cpp
CaseResult free_fall(Detail detail);
CaseResult order(Detail detail);
CaseResult spring_pair(Detail detail);
CaseResult energy(Detail detail);
// statics.cpp
CaseResult hanging_sheet(Detail detail);
CaseResult catenary(Detail detail);
// cantilever.cpp
CaseResult cantilever_grid(Detail detail);
CaseResult cantilever_mesh(Detail detail);
// dynamics.cpp
CaseResult hanging_chain(Detail detail);
CaseResult terminal_speed(Detail detail);
// incline.cpp
CaseResult incline(Detail detail);
// strap.cpp
CaseResult strap(Detail detail);
// drape.cpp
CaseResult drape(Detail detail);
CaseResult coarse_drape(); // takes seconds, far from converged

} // namespace physics
