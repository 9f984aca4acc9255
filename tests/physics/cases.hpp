// The cases of the report card: each is run at one of two resolutions and says what it found beside what is exact.
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

// Of a quantity that has one value at the coarser resolution and another at the finer one.
struct Target
{
    double coarse = 0;
    double fine = 0;

    [[nodiscard]] double at(Detail detail) const { return detail == Detail::fine ? fine : coarse; }
};

// One number. A band has no exact value, but a lowest and a highest one.
struct Measurement
{
    std::string quantity;
    std::string resolution;
    double value = 0;
    double exact = 0;
    // |value / exact - 1|, or |value - exact| where the exact is 0; at most five times what was measured (of quantities
    // of a kind: the largest).
    double target = 0;
    double low = 0;
    double high = 0;   // of a band; 0: not a band
    double change = 0; // how much both resolutions may differ; 0: not looked at
    bool known = true; // false: there is nothing to hold the value against

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
    bool points = false; // dots in place of a line
};

struct Plot
{
    std::string file; // without its extension
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
    const char* setup; // what is done, a sentence
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
CaseResult coarse_drape(); // in seconds, far from converged

} // namespace physics
