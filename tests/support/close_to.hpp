// Comparisons with a tolerance that is relative to the expected value alone. doctest::Approx has a scale of 1: its
// epsilon allows that much of 1, too, so that of an expected value of 1 mm and an epsilon of 2 % everything up to 2 cm
// passes.
#pragma once

#include <doctest/doctest.h>

namespace tests
{

// value == close_to(expected, relative): |value - expected| < relative * the larger of both. False for NaN. An expected
// value of 0 never is: compare that with an absolute tolerance.
inline doctest::Approx close_to(double expected, double relative)
{
    return doctest::Approx(expected).epsilon(relative).scale(0);
}

} // namespace tests
