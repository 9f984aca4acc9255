// How far a patch slides down an incline under the module's friction law (friction.glsl).
#pragma once

#include <algorithm>
#include <cmath>

namespace tests
{

// m, from rest in `time` s down a slope of `angle` rad, without drag. The coefficient falls from static to kinetic
// while the speed rises to 1 mm/s: until then v' = g (sin - mu(v) cos) is linear in v, afterward constant.
inline double slide_distance(double angle, double static_friction, double kinetic_friction, double time)
{
    constexpr double k_gravity = 9.81;
    constexpr double k_range = 1e-3; // m/s
    const double start = k_gravity * (std::sin(angle) - static_friction * std::cos(angle));
    const double end = k_gravity * (std::sin(angle) - kinetic_friction * std::cos(angle));
    if (start <= 0)
        return 0;
    const double rate = (end - start) / k_range; // 1/s
    const double slow = std::min(time, rate > 0 ? std::log(end / start) / rate : k_range / start);
    const double crept = rate > 0 ? start / rate * (std::expm1(rate * slow) / rate - slow) : start * slow * slow / 2;
    const double left = time - slow;
    return crept + k_range * left + end * left * left / 2;
}

} // namespace tests
