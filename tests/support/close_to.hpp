// Comparisons with a tolerance relative to the expected value alone. doctest::Approx has a scale of 1, which its
// epsilon also multiplies: with an expected value of 1 mm and an epsilon of 2 % everything up to 2 cm passes.
#pragma once

#include <doctest/doctest.h>

namespace tests
{

// value == close_to(expected, relative): |value - expected| < relative * the larger of both. False for NaN. Always
// false for an expected value of 0: compare that with an absolute tolerance.
inline doctest::Approx close_to(double expected, double relative)
{
    return doctest::Approx(expected).epsilon(relative).scale(0);
}

} // namespace tests
