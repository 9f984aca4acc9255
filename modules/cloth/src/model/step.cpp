// Step: validation.
#include "voile/step.hpp"

#include "model/range_checks.hpp"

#include <cmath>

namespace voile
{

namespace
{

Result<void> check_count(const char* name, uint32_t value, uint32_t least)
{
    if (value >= least && value <= k_most_substeps)
        return {};
    return Error{std::string("step: ") + name + " is " + std::to_string(value) + ", must be " + std::to_string(least) +
                 " to " + std::to_string(k_most_substeps)};
}

} // namespace

Result<void> validate(const Step& step)
{
    const std::string what = "step";
    const Range ranges[] = {
        {"duration", step.duration, k_least_duration, k_most_duration, " s"},
        {"gust", step.gust, 0, k_most_gust},
        {"gust_length", step.gust_length, k_least_gust_length, k_most_gust_length, " m"},
        {"air_density", step.air_density, 0, k_most_air_density, " kg/m^3"},
    };
    for (const Range& range : ranges)
        if (auto result = check(what, range); !result)
            return result;
    if (const Range limit{"softened_strain_limit", step.softened_strain_limit, k_least_strain_limit,
                          k_most_strain_limit};
        step.softened_strain_limit != 0)
        if (auto result = check(what, limit); !result)
            return Error{result.error().message + ", or 0 for none"};
    if (auto result = check(what, "gravity", step.gravity, k_most_gravity, " m/s^2"); !result)
        return result;
    if (auto result = check(what, "wind", step.wind, k_most_wind, " m/s"); !result)
        return result;
    if (!(std::abs(step.time) <= k_most_time)) // a float would show another time than it is
        return Error{"step: time is " + std::to_string(step.time) + " s, must be -1e+09 to 1e+09"};
    if (auto result = check_count("substeps", step.substeps, 0); !result)
        return result;
    return check_count("max_substeps", step.max_substeps, 1);
}

} // namespace voile
